#!/usr/bin/env python3
"""Writes the tables of docs/verification/performance.md from what is kept of measurements.

  docs/evidence/performance.py                             from docs/evidence/{performance,runs,scale}/*.csv and benches/figures.json
  docs/evidence/performance.py --measure limits ranks      runs these benches of the workspace first, and keeps what they print
  docs/evidence/performance.py --check                     fails where the page does not say what is kept

The benches print lines of tab-separated cells: the name of a table, then its header, then its rows.
"""

import argparse
import csv
import subprocess
import sys
from pathlib import Path

from error_and_time import between, read, table

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "verification" / "performance.md"
KEPT = ROOT / "docs" / "evidence" / "performance"
sys.path.insert(0, str(ROOT / "benches"))
import runs
import scale
import track

BENCHES = ["limits", "ranks"]


def measure(bench):
    """Runs a bench and keeps its lines."""
    command = ["cargo", "bench", "--locked", "--quiet", "-p", "ndda-suite", "--bench", bench]
    done = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True)
    rows = [line.split("\t") for line in done.stdout.splitlines() if "\t" in line]
    rows.append(["of", "processor", "commit"])
    rows.append(["of", track.processor(), track.commit(ROOT)])
    KEPT.mkdir(parents=True, exist_ok=True)
    with (KEPT / f"{bench}.csv").open("w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows(rows)


def tables(bench):
    """Tables of a bench by name, header first."""
    found = {}
    path = KEPT / f"{bench}.csv"
    if path.exists():
        with path.open(newline="", encoding="utf-8") as file:
            for name, *cells in csv.reader(file):
                found.setdefault(name, []).append(cells)
    return found


def of_bench(bench, name):
    """One table, and what it was measured on."""
    found = tables(bench)
    if name not in found:
        return "Not measured yet."
    (header, *rows), (processor, commit) = found[name], found["of"][1]
    return f"{table(header, rows)}\n\nOn {processor}, at {commit}."


def of_scale():
    """What steps cost over size, and the exponents."""
    rows = read(scale.TABLE)
    columns = ["scene", "blocks", "tets", "threads", "step_ms", "contact_ms", "blocks_ms", "processor_ms", "candidate_pairs", "contact_pairs", "peak_memory_mb"]
    header = ["scene", "blocks", "tetrahedra", "threads", "step [ms]", "contact [ms]", "blocks [ms]", "processor [ms]", "candidates", "in contact", "memory [MB]"]
    sizes = table(header, [[row[column] for column in columns] for row in rows])

    def exponents(scene, threads, rows):
        found = (scale.slope(rows, column) for column in ("step_ms", "processor_ms", "peak_memory_mb", "candidate_pairs", "contact_pairs"))
        return [scene, str(threads), f"{rows[0]['tets']} to {rows[-1]['tets']}", *("–" if value is None else f"{value:.2f}" for value in found)]

    header = ["scene", "threads", "tetrahedra", "step", "processor", "memory", "candidates", "in contact"]
    slopes = table(header, [exponents(*name, rows) for name, rows in scale.series().items()])
    machines = "; ".join(dict.fromkeys(f"{row['processor']}, at {row['commit']}" for row in rows))
    return f"{sizes}\n\nExponents over size, of the line through all sizes:\n\n{slopes}\n\nOn {machines}."


def of_runs(name, columns, header):
    """Rows of runs, and what they were measured on."""
    rows = [row for row in runs.rows() if row["table"] == name]
    machines = "; ".join(dict.fromkeys(f"{row['processor']}, at {row['commit']}" for row in rows))
    cells = [[f"`{row[column]}`" if column in ("scene", "settings") and row[column] else row[column] or "–" for column in columns] for row in rows]
    return f"{table(header, cells)}\n\nOn {machines}."


def of_track():
    """The last counts of each crate."""
    records, parts = track.load(), []
    for crate in track.crates(ROOT):
        record = track.last(records, "instructions", crate)
        if record:
            rows = [[name, f"{count:,}".replace(",", " ")] for name, count in record["instructions"][crate].items()]
            parts.append(f"`{crate}` at {record['commit']}, {record['rustc']}:\n\n{table(['bench', 'instructions'], rows)}")
    return "\n\n".join(parts)


def written(text):
    """The page with all tables as they are kept."""
    for name in ("machine", "kernel", "solve", "step"):
        text = between(text, name, of_bench("limits", name))
    text = between(text, "ranks", of_bench("ranks", "ranks"))
    columns = ["what", "scene", "settings", "blocks", "rest", "steps", "processor_s", "memory_mb", "label"]
    header = ["job", "scene", "set", "blocks", "steps to rest", "steps of time", "processor [s]", "memory [MB]", "label"]
    text = between(text, "jobs", of_runs("jobs", columns, header))
    columns = ["what", "processor_s", "gained", "deepest"]
    header = ["step, penalty, cubes", "processor [s]", "energy gained, 14 rows", "deepest, over a tetrahedron's height"]
    text = between(text, "pile", of_runs("pile", columns, header))
    return between(between(text, "scale", of_scale()), "track", of_track())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--measure", nargs="+", choices=BENCHES, default=[])
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    for bench in options.measure:
        measure(bench)
    now = PAGE.read_text(encoding="utf-8")
    made = written(now)
    if options.check:
        return None if made == now else "docs/verification/performance.md is out of date: docs/evidence/performance.py writes it anew"
    PAGE.write_text(made, encoding="utf-8")
    return None


if __name__ == "__main__":
    sys.exit(main())
