#!/usr/bin/env python3
"""Whole runs that docs/verification/performance.md tells of: steps, processor time, memory and label.

  docs/evidence/runs.py [NDDA] [--only TEXT]    (default: target/release/ndda, all runs)

Runs each on one thread and keeps a row of it in docs/evidence/runs/runs.csv; docs/evidence/performance.py writes the tables of the page. All of them take half an hour of processor time.
"""

import argparse
import csv
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "benches"))
import track

KEPT = ROOT / "docs" / "evidence" / "runs" / "runs.csv"
COLUMNS = ["table", "what", "scene", "settings", "blocks", "steps", "rest", "processor_s", "memory_mb", "gained", "deepest", "label", "processor", "commit"]

PILE = ["time.end_s=0.7", "output.history_rows=14", "output.frames=1", "rock[0].fill=Fewest"]


def pile(step_s, penalty_pa, body):
    return [*PILE, f"time.step_s={step_s}", f"contact.penalty_pa={penalty_pa}", f"rock[0].body={body}"]


# Table, words, scene, settings.
RUNS = [
    ("jobs", "a tunnel in three headings with 210 cables, elastic", "works/tunnel_2000_blocks", []),
    ("jobs", "a tunnel in elastic blocks, k₀ = 1.5", "works/tunnel_k0", []),
    ("jobs", "a column of drums on a shaken base", "works/drums_shaken", []),
    ("jobs", "a boulder on terrain of 20 000 triangles", "works/boulder_terrain", []),
    ("jobs", "a slope from three joint sets, rigid", "works/slope_1100_blocks", ["time.end_s=4e-3"]),
    ("jobs", "a pillar of Voronoi cells collapses", "works/voronoi_collapse", []),
    ("jobs", "joint sets of Fisher scatter, rigid", "works/fisher_blocks", []),
    ("pile", "4 ms, 12 MPa, elastic", "pile_1000", pile("4e-3", "12e6", "Elastic")),
    ("pile", "3 ms, 22 MPa, elastic", "pile_1000", pile("3e-3", "22e6", "Elastic")),
    ("pile", "2 ms, 50 MPa, elastic", "pile_1000", pile("2e-3", "50e6", "Elastic")),
    ("pile", "2 ms, 50 MPa, affine", "pile_1000", pile("2e-3", "50e6", "Affine")),
    ("pile", "2 ms, 50 MPa, rigid", "pile_1000", pile("2e-3", "50e6", "Rigid")),
]


def measured(ndda, where, run):
    """The row of a run."""
    table, what, scene, settings = run
    with tempfile.TemporaryDirectory() as folder:
        command = [ndda, "run", str(ROOT / "scenes" / f"{scene}.ron"), "--out", f"{folder}/out", "--threads", "1", "--sensitivity", "never"]
        for setting in settings:
            command += ["--set", setting]
        done = subprocess.run(command, check=False, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        file = Path(folder, "out", "summary.json")
        if not file.exists():
            raise SystemExit(f"{' '.join(command)}: {done.stderr}")
        summary = json.loads(file.read_text(encoding="utf-8"))
        log = Path(folder, "out", "run.log").read_text(encoding="utf-8")
    # Before time begins by the log, in stages by the table.
    rest = re.findall(r"\] settled in (\d+) steps", log) + re.findall(r"at rest after (\d+) steps? more", done.stdout)
    machine, invariants = summary["machine"], summary["invariants"]
    return {
        "table": table,
        "what": what,
        "scene": scene,
        "settings": " ".join(settings),
        "blocks": summary["counts"]["blocks"],
        "steps": summary["steps"],
        "rest": " + ".join(rest),
        "processor_s": f"{machine['processor_time_s']:.3g}",
        "memory_mb": f"{machine['peak_memory_b'] / 1e6:.0f}",
        "gained": f"{invariants['energy_gain']:.1e}",
        "deepest": f"{invariants['max_penetration_ratio']:.2f}",
        "label": summary["label"]["word"],
        **where,
    }


def rows():
    """All rows that are kept, in the order of the runs."""
    if not KEPT.exists():
        return []
    with KEPT.open(newline="", encoding="utf-8") as file:
        kept = {(row["table"], row["what"]): row for row in csv.DictReader(file)}
    return [kept[run[:2]] for run in RUNS if run[:2] in kept]


def keep(row):
    """Puts a row in the place of an older one."""
    kept = {(old["table"], old["what"]): old for old in rows()} | {(row["table"], row["what"]): row}
    KEPT.parent.mkdir(parents=True, exist_ok=True)
    with KEPT.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(kept[run[:2]] for run in RUNS if run[:2] in kept)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("ndda", nargs="?", default=str(ROOT / "target" / "release" / "ndda"))
    parser.add_argument("--only", default="", metavar="TEXT")
    options = parser.parse_args()
    where = {"processor": track.processor(), "commit": track.commit(ROOT)}
    for run in (run for run in RUNS if options.only in " ".join(run[:3])):
        row = measured(options.ndda, where, run)
        keep(row)
        print(row["what"], row["processor_s"], "s", flush=True)


if __name__ == "__main__":
    main()
