#!/usr/bin/env python3
"""Cost of a step, memory, and pairs in a step over size: 125 to 1e5 blocks, and one block of up to 1e6 tetrahedra.

  docs/evidence/scale.py [--threads N ...] [--smallest TETS] [--largest TETS] [--again] [NDDA]
  docs/evidence/scale.py --draw        (needs matplotlib, which is installed under target/ where it is missing)

Defaults: 1 and 2 threads, up to 1e6 tetrahedra, target/release/ndda. A size is run with two numbers of steps: their difference is what
steps cost, without reading, setting up and making the first list of pairs; by the clock (step_ms and its stages) and by the processor
(processor_ms, of all threads). Each size is kept in docs/evidence/scale/scale.csv once it is
done, and passed over the next time unless --again is given, so that a run which was interrupted goes on. 1e5 blocks want 2.4 GB and
minutes. Prints slopes in log-log; --draw draws docs/evidence/scale/scale.png.
"""
import argparse
import csv
import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
import plots
from sizes import BLOCKS, CELLS

FOLDER = ROOT / "docs" / "evidence" / "scale"
TABLE = FOLDER / "scale.csv"
STAGES = ("contact", "blocks", "ledger")
COLUMNS = ["scene", "blocks", "tets", "threads", "step_ms", *(f"{stage}_ms" for stage in STAGES), "processor_ms", "setup_s", "peak_memory_mb", "candidate_pairs", "contact_pairs", "processor", "commit"]
# Steps of the shorter and of the longer run; in the first, blocks meet.
STEPS = {"blocks": (5, 15), "one_block": (2, 6), "one_block_direct": (2, 12)}
# So many times more of them in a small block, whose steps are over in no time.
MORE = 20
STEP_S = {"blocks": 2e-4, "one_block": 1e-3, "one_block_direct": 1e-3}
# Up to here sizes are small: a run is repeated, and the quickest taken.
SMALL, REPEATS = 2e4, 3
# The factor of a larger block does not fit.
MOST_DIRECT = 1e5


def cases(smallest, largest):
    """Scene, tetrahedra and settings of each size."""
    for sides in BLOCKS:
        tets = 6 * math.prod(sides)
        # The smallest sizes are over in no time, most of which is no step's.
        if sides[0] > 1 and smallest <= tets <= largest:
            yield "blocks", tets, [f"rock.rock.domain.max_m={sides}".replace(" ", "")]
    for cells in CELLS[1:]:
        tets, shape = 6 * cells**3, f"blocks.block.shape.cells=({cells},{cells},{cells})"
        if smallest <= tets <= largest:
            yield "one_block", tets, [shape]
            if tets <= MOST_DIRECT:
                yield "one_block_direct", tets, [shape, "time.solver=Cholesky"]


def summary(ndda, scene, settings, threads, steps):
    """What a run says of itself; its files are in memory where there is room for them."""
    memory = Path("/dev/shm")
    with tempfile.TemporaryDirectory(dir=memory if memory.is_dir() else None) as folder:
        file = ROOT / "scenes" / "extreme" / f"{scene.removesuffix('_direct')}.ron"
        command = [ndda, "run", str(file), "--out", f"{folder}/out", "--quiet", "--threads", str(threads)]
        for setting in [*settings, f"time.end_s={steps * STEP_S[scene]:.6g}", "output.history_rows=1"]:
            command += ["--set", setting]
        subprocess.run(command, check=True)
        return json.loads(Path(folder, "out", "summary.json").read_text(encoding="utf-8"))


def measure(ndda, scene, tets, settings, threads):
    """A row of the table."""
    quickest, processor_s = [], []
    short, long = STEPS[scene]
    for steps in (short, long * (MORE if scene != "blocks" and tets <= SMALL else 1)):
        runs = [summary(ndda, scene, settings, threads, steps) for _ in range(REPEATS if tets <= SMALL else 1)]
        quickest.append(min(runs, key=lambda run: sum(run["stages_s"][stage] for stage in STAGES)))
        processor_s.append(min(run["machine"]["processor_time_s"] for run in runs))
    short, long = quickest
    steps = long["steps"] - short["steps"]
    stages = [1e3 * (long["stages_s"][stage] - short["stages_s"][stage]) / steps for stage in STAGES]
    processor = 1e3 * (processor_s[1] - processor_s[0]) / steps
    pairs = [(long["counts"][name] - short["counts"][name]) / steps for name in ("candidate_pairs_total", "clips_total")]
    counts, machine = long["counts"], long["machine"]
    numbers = [f"{number:.4g}" for number in (sum(stages), *stages, processor, long["stages_s"]["setup"], machine["peak_memory_b"] / 1e6)]
    numbers += [f"{number:.0f}" for number in pairs]
    of = [f"{machine['processor']}, {os.cpu_count()} cores", machine["commit"]]
    return dict(zip(COLUMNS, [scene, counts["blocks"], counts["tets"], threads, *numbers, *of]))


def key(row):
    """Order of the table, and what makes two rows the same."""
    return row["scene"], int(row["threads"]), int(row["tets"])


def load():
    if not TABLE.exists():
        return {}
    with TABLE.open(newline="", encoding="utf-8") as file:
        return {key(row): row for row in csv.DictReader(file)}


def keep(row):
    """Adds a row, or puts it in the place of an older one; the file is whole at any time."""
    rows = load() | {key(row): row}
    FOLDER.mkdir(parents=True, exist_ok=True)
    new = TABLE.with_suffix(".tmp")
    with new.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(rows[name] for name in sorted(rows))
    new.replace(TABLE)


def series():
    """Rows by scene and threads, by size."""
    found = {}
    for name, row in sorted(load().items()):
        found.setdefault(name[:2], []).append(row)
    return found


def slope(rows, column):
    """Exponent of the line through the logarithms of a column over tetrahedra, by least squares; none for what is zero."""
    points = [(math.log(float(row["tets"])), float(row[column])) for row in rows]
    points = [(x, math.log(y)) for x, y in points if y > 0]
    if len(points) < 2:
        return None
    mean_x, mean_y = (sum(axis) / len(points) for axis in zip(*points))
    return sum((x - mean_x) * (y - mean_y) for x, y in points) / sum((x - mean_x) ** 2 for x, _ in points)


def grows(rows, column):
    """The exponent in words."""
    exponent = slope(rows, column)
    return "" if exponent is None else f": size^{exponent:.2f}"


def draw():
    plots.need_matplotlib()
    figure, axes = plots.panels(2, 2, (9, 6.4))
    # Memory and pairs are those of any number of threads, and the most threads have the largest sizes.
    most = max(threads for _, threads in series())
    for (scene, threads), rows in series().items():
        tets = [int(row["tets"]) for row in rows]
        label = f"{scene}, {threads} thread{'s' * (threads > 1)}"
        axes[0 if scene == "blocks" else 1].loglog(tets, [float(row["step_ms"]) for row in rows], ".-", label=f"{label}{grows(rows, 'step_ms')}")
        if threads == most:
            axes[2].loglog(tets, [float(row["peak_memory_mb"]) for row in rows], ".-", label=f"{scene}{grows(rows, 'peak_memory_mb')}")
        if scene == "blocks" and threads == most:
            for column, name in (("candidate_pairs", "candidates"), ("contact_pairs", "in contact")):
                axes[3].loglog(tets, [float(row[column]) for row in rows], ".-", label=f"{name}{grows(rows, column)}")
    titles = [("step of many blocks", "ms"), ("step of one block", "ms"), ("most memory", "MB"), ("pairs in a step, many blocks", "pairs")]
    for ax, (title, unit) in zip(axes, titles):
        plots.finish(ax, title, "tetrahedra", unit)
    plots.save(figure, FOLDER / "scale.png")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--smallest", type=float, default=0, metavar="TETS")
    parser.add_argument("--largest", type=float, default=1e6, metavar="TETS")
    parser.add_argument("--again", action="store_true", help="measure what is in the table, too")
    parser.add_argument("--draw", action="store_true", help="draw what is in the table")
    parser.add_argument("ndda", nargs="?", default=str(ROOT / "target" / "release" / "ndda"))
    options = parser.parse_args()
    if options.draw:
        return draw()
    for scene, tets, settings in cases(options.smallest, options.largest):
        for threads in options.threads:
            if options.again or (scene, threads, tets) not in load():
                row = measure(options.ndda, scene, tets, settings, threads)
                keep(row)
                print(*list(row.values())[:-2], flush=True)
    for (scene, threads), rows in series().items():
        print(f"{scene}, {threads} thread(s): step{grows(rows, 'step_ms')}, memory{grows(rows, 'peak_memory_mb')}")


if __name__ == "__main__":
    main()
