#!/usr/bin/env python3
"""Checks docs/guide/recipes.md: what it quotes is what the files say, and every recipe runs on the results of a run.

Usage: recipes.py OUTDIR [BOTH]     (BOTH: a run with tables as CSV and Parquet; exit 0: all well, 1: not, 3: packages are missing, only quotes and syntax were checked)
"""

import csv
import importlib.util
import json
import math
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

DOCS = Path(__file__).parent.parent / "docs"
RECIPES = DOCS / "recipes"
PACKAGES = ("numpy", "pandas", "matplotlib", "meshio", "pyvista", "pyarrow")
# Need ParaView, which no package index has.
PARAVIEW = {"paraview_series.py", "paraview_gallery.py"}
MOST_LINES = 30
RAN = set()


class Failure(Exception):
    """What is wrong with a recipe."""


def require(condition, message):
    if not condition:
        raise Failure(message)


def check_quotes():
    """Every file is quoted, word for word, after the line that links to it."""
    page = (DOCS / "guide" / "recipes.md").read_text(encoding="utf-8")
    quoted = dict(re.findall(r"\]\(\.\./recipes/(\w+\.py)\)[^\n]*\n(?:[^\n]+\n)*\n```python\n(.*?)```", page, re.DOTALL))
    files = {path.name: path.read_text(encoding="utf-8") for path in RECIPES.glob("*.py")}
    require(quoted.keys() == files.keys(), f"recipes.md quotes {sorted(quoted)}, there are {sorted(files)}")
    for name, text in files.items():
        require(quoted[name] == text, f"recipes.md does not quote {name} as it is")
        require(text.count("\n") <= MOST_LINES, f"{name} has more than {MOST_LINES} lines")
        compile(text, name, "exec")


def run(name, *arguments):
    """What a recipe prints."""
    RAN.add(name)
    command = [sys.executable, str(RECIPES / name), *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=False)
    require(done.returncode == 0, f"{name} ended with {done.returncode}:\n{done.stderr}")
    require(done.stdout.strip(), f"{name} printed nothing")
    return done.stdout


def numbers_at_end(text, count):
    """The last lines that are numbers only, as columns of a table."""
    rows = [line.split() for line in text.splitlines()]
    return [[float(cell) for cell in row] for row in rows if len(row) == count and re.fullmatch(r"[\d.e+-]+", row[0])]


def check_energies(folder, scratch):
    """The picture, and the number against the same column read without pandas."""
    picture = scratch / "energies.png"
    said = run("energies.py", folder, picture)
    with open(folder / "history.csv", newline="", encoding="utf-8") as file:
        largest = max(float(row["kinetic_j"]) for row in csv.DictReader(file))
    require(f" {largest:.6g} J " in said, f"energies.py says '{said.strip()}', history.csv has {largest:.6g} J")
    require(picture.read_bytes().startswith(b"\x89PNG"), "energies.py drew no picture")


def check_blocks(folder):
    """Volume and speed of every block against the summary, which the program wrote by itself."""
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    blocks = list(summary["blocks"].values())
    rows = numbers_at_end(run("block_speeds.py", folder), 4)
    require(len(rows) == len(blocks), f"block_speeds.py lists {len(rows)} blocks of {len(blocks)}")
    for (_, number, volume, speed), block in zip(rows, blocks):
        require(volume > 0, f"block {number:.0f} has a volume of {volume} m³")
        # The mean of speeds is at least the speed of the mean.
        mean = math.hypot(*block["velocity"])
        require(speed >= 0.999 * mean, f"block {number:.0f}: {speed} m/s, in summary.json {mean}")
    listed = numbers_at_end(run("farthest_blocks.py", folder), 2)
    require(len(listed) == min(10, len(blocks)), f"farthest_blocks.py lists {len(listed)} blocks of {len(blocks)}")
    farthest = max(math.hypot(*monitor["displacement"]) for monitor in summary["monitors"].values())
    require(listed[0][1] >= 0.999 * farthest, f"farthest_blocks.py: {listed[0][1]} m, a monitor moved by {farthest} m")
    print(f"{len(rows)} blocks, the farthest moved by {listed[0][1]:.6g} m")


def check_comparison(folder):
    """A run is no distance from itself."""
    for line in run("compare.py", folder, folder).splitlines():
        require(" 0.00e+00 " in line, f"a run differs from itself: {line}")


def check_parquet(folder):
    """The tables in columns are those in lines."""
    import pandas

    for name in ("history", "contacts"):
        lines, columns = pandas.read_csv(folder / f"{name}.csv"), pandas.read_parquet(folder / f"{name}.parquet")
        require(list(lines.columns) == list(columns.columns), f"{name}.parquet has other columns than {name}.csv")
        require(len(lines) > 1 and (lines.to_numpy() == columns.to_numpy()).all(), f"{name}.parquet has other numbers")
    print("Parquet and CSV hold the same numbers")


def check_paraview(folder, scratch):
    """What the scripts for ParaView draw, where there is one; else False."""
    program = [shutil.which(name) for name in ("xvfb-run", "pvpython")]
    if None in program:
        return False
    run = scratch / "run"
    shutil.copytree(folder, run)
    for name, arguments in (("paraview_series.py", (run, scratch / "frames")), ("paraview_gallery.py", (run,))):
        command = [program[0], "-a", program[1], str(RECIPES / name), *map(str, arguments)]
        done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=False, timeout=300)
        require(done.returncode == 0, f"{name} ended with {done.returncode}:\n{done.stderr}")
        warned = [line for line in done.stderr.splitlines() if "ERR|" in line or "WARN|" in line]
        require(not warned, f"ParaView warns in {name}: {warned}")
    frames = len(re.findall("<DataSet ", (run / "fields.pvd").read_text()))
    require(len(list((scratch / "frames").glob("*.png"))) == frames, "paraview_series.py drew another number of frames")
    state = (run / "view.pvsm").read_text()
    require('type="RenderView"' in state and 'type="PVDReader"' in state, "paraview_gallery.py saved no view")
    return True


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__.strip())
    check_quotes()
    missing = [name for name in PACKAGES if importlib.util.find_spec(name) is None]
    if missing:
        print("SKIPPED: recipes were not run, for want of", ", ".join(missing))
        sys.exit(3)
    folder = Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as scratch:
        check_energies(folder, Path(scratch))
        drawn = check_paraview(folder, Path(scratch))
    check_blocks(folder)
    check_comparison(folder)
    untried = {path.name for path in RECIPES.glob("*.py")} - RAN - PARAVIEW
    require(not untried, f"not tried: {sorted(untried)}")
    if len(sys.argv) == 3:
        check_parquet(Path(sys.argv[2]))
    print(f"{len(RAN)} recipes ran; those for ParaView", "did, too" if drawn else "were only compiled, for want of pvpython")


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        sys.exit(f"recipes.py: {failure}")
