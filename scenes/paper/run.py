#!/usr/bin/env python3
"""The paper's figures: runs the studies of this folder, keeps their data in docs/evidence/paper, fills the tables of docs/verification/paper.md
and draws the pictures.

Usage: python3 scenes/paper/run.py            all of it, with `cargo run --release`; goes on where it was interrupted
       python3 scenes/paper/run.py --thin     short runs of every case and nothing kept: does it all still run?
       python3 scenes/paper/run.py --check    are the tables of docs/verification/paper.md those of the data?
       python3 scenes/paper/run.py --again FIGURE …   run these figures again at full length: does the data still hold?
       python3 scenes/paper/run.py --times    the times alone: on a machine that does nothing else
       python3 scenes/paper/run.py --column   the runs of §4.3 that docs/evidence/paper/ensemble.csv lacks; without the file, all
       python3 scenes/paper/run.py --draw     pictures and tables from the data, without a run

Needs python 3.9 or later; matplotlib for the pictures only.
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

import ensemble
import results
import tables
import times

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
DATA = ROOT / "docs" / "evidence" / "paper"
TEXT = ROOT / "docs" / "verification" / "paper.md"
# What makes a study short: the first moments, and for the collision a longer step.
SHORT = {"fig3": ["time.step_s=1e-5"]}
SHORT_OTHERS = ["time.end_s=0.024", "output.history_rows=6"]

# What a case is compared by when it runs again: the part by which numbers may differ, and the size below which they are rounding.
NUMBERS = ("step_s", "along_end", "along_max", "size_max", "along_late", "size_late", "energy_gain", "h")
SAME, NOTHING = 0.01, 1e-9


def build():
    subprocess.run(["cargo", "build", "--release", "--quiet", "--bin", "ndda"], cwd=ROOT, check=True)
    return ROOT / "target" / "release" / "ndda"


def study(program, name, out, extra=(), jobs=1):
    """Runs a study; a case that fails is part of what is found."""
    command = [program, "study", HERE / f"{name}.ron", "--out", out / name, "--quiet", "--jobs", str(jobs)]
    # Errors are compared with closed forms here, not labels.
    command += ["--second-runs", "never"]
    command += [part for one in extra for part in ("--set", one)]
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.DEVNULL)
    if done.returncode != 0:
        raise SystemExit(f"{name}: ndda study ended with {done.returncode}")
    return results.gather(out / name, name)


def full(program):
    DATA.mkdir(parents=True, exist_ok=True)
    cases = []
    for name in results.FIGURES:
        rows, curves = study(program, name, ROOT / "out" / "paper")
        results.write_curves(DATA / f"{name}.csv", curves)
        cases += rows
        print(f"{name}: {len(rows)} cases", flush=True)
    results.write_rows(DATA / "cases.csv", cases)


def time(program):
    """Times are measured on files in memory where there are any: a disk that keeps runs waiting is no part of a scheme."""
    memory = Path("/dev/shm")
    with tempfile.TemporaryDirectory(dir=memory if memory.is_dir() else None) as folder:
        timed = times.measure_all(program, HERE, Path(folder) / "run")
    results.write_rows(DATA / "times.csv", timed, times.COLUMNS)


def thin(program):
    """Every case for its first moments."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder)
        for name in results.FIGURES:
            rows, _ = study(program, name, out, SHORT.get(name, SHORT_OTHERS), jobs=2)
            stopped = [row for row in rows if row["status"] != "done"]
            print(f"{name}: {len(rows)} cases, {len(stopped)} stopped")
            if any((row["figure"], row["scheme"]) != ("fig5", "GeneralizedAlpha") for row in stopped):
                raise SystemExit(f"{name}: {stopped}")


def again(program, names):
    """Runs figures at full length, and says which cases are no longer as they are kept."""
    kept = {key(row): row for row in results.read_rows(DATA / "cases.csv")}
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            rows, _ = study(program, name, Path(folder), jobs=2)
            faults += [f"{' '.join(key(row))}: {column} was {kept[key(row)][column]}, is {row[column]}" for row in rows for column in changed(kept[key(row)], row)]
            print(f"{name}: {len(rows)} cases run again", flush=True)
    if faults:
        raise SystemExit("\n".join(faults) + "\ndocs/evidence/paper/cases.csv is out of date: scenes/paper/run.py writes it anew")


def key(row):
    return row["figure"], row["varied"], row["scheme"], row["start"]


def changed(old, new):
    """Columns that differ by more than rounding lets them."""
    found = [] if old["status"] == new["status"] else ["status"]
    for column in NUMBERS if not found else []:
        if old[column] == new.get(column, ""):
            continue
        before, now = float(old[column]), float(new[column])
        if abs(before - now) > SAME * abs(before) and max(abs(before), abs(now)) > NOTHING:
            found.append(column)
    return found


def text():
    """docs/verification/paper.md as it is, and as the data says."""
    now = TEXT.read_text(encoding="utf-8")
    return now, tables.fill(now, *(results.read_rows(DATA / name) for name in ("cases.csv", "times.csv", "ensemble.csv")))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("--thin", "--check", "--times", "--column", "--draw"):
        parser.add_argument(name, action="store_true")
    parser.add_argument("--again", nargs="+", choices=results.FIGURES, metavar="FIGURE")
    asked = parser.parse_args()
    if asked.again:
        return again(build(), asked.again)
    if asked.thin:
        return thin(build())
    if asked.column:
        ensemble.measure(build(), HERE.parent, DATA / "ensemble.csv")
        TEXT.write_text(text()[1], encoding="utf-8")
        return None
    if not (asked.check or asked.draw):
        program = build()
        if not asked.times:
            full(program)
        time(program)
    now, made = text()
    if asked.check:
        return None if now == made else "docs/verification/paper.md: its tables are not those of docs/evidence/paper: run scenes/paper/run.py --draw"
    TEXT.write_text(made, encoding="utf-8")
    import draw

    draw.draw(DATA)
    return None


if __name__ == "__main__":
    sys.exit(main())
