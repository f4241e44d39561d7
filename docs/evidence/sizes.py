#!/usr/bin/env python3
"""Time and memory over size (X21): 1 to 1e5 blocks, and one block of up to 1e6 tetrahedra.

  docs/evidence/sizes.py [--most SECONDS] [NDDA]     (default: 600 s a run, target/release/ndda)

Runs scenes/extreme/blocks.ron and one_block.ron on one thread at each size and writes docs/evidence/sizes/sizes.csv: processor time of
the whole run, set-up included, peak memory, and both per tetrahedron. Prints the slope of time and memory over tetrahedra in
log-log, between each size and the next. A run that takes longer than asked for is left out, and said.
"""
import argparse
import csv
import json
import math
import resource
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TABLE = ROOT / "docs" / "evidence" / "sizes" / "sizes.csv"
BLOCKS = [(1, 1, 1), (1, 1, 2), (5, 5, 5), (10, 10, 10), (22, 22, 22), (46, 46, 47)]
CELLS = [2, 6, 12, 25, 55]


def settings():
    """Scene and settings of each size."""
    for sides in BLOCKS:
        fixed = ["rock.rock.fixed=[]"] if sides[2] == 1 else []
        yield "blocks", [f"rock.rock.domain.max_m={sides}".replace(" ", ""), *fixed]
    for cells in CELLS:
        yield "one_block", [f"blocks.block.shape.cells=({cells},{cells},{cells})"]


def run(ndda, scene, chosen, most_s):
    """Blocks, tetrahedra, steps, processor time [s] and peak memory [MB] of a run; nothing if it takes too long."""
    with tempfile.TemporaryDirectory() as folder:
        command = [ndda, "run", str(ROOT / "scenes" / "extreme" / f"{scene}.ron"), "--out", f"{folder}/out", "--quiet", "--threads", "1"]
        for setting in chosen:
            command += ["--set", setting]
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        try:
            subprocess.run(command, check=True, timeout=most_s)
        except subprocess.TimeoutExpired:
            return None
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        summary = json.loads(Path(folder, "out", "summary.json").read_text(encoding="utf-8"))
    time_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    counts = summary["counts"]
    memory = summary["machine"]["peak_memory_b"] / 1e6
    return counts["blocks"], counts["tets"], summary["steps"], time_s, memory


def slopes(rows):
    """Exponents of time and memory between neighbouring sizes of a scene."""
    for (name, _, tets, _, time, memory), (other, _, more, _, later, larger) in zip(rows, rows[1:]):
        if name == other:
            base = math.log(more / tets)
            yield name, tets, more, math.log(later / time) / base, math.log(larger / memory) / base


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--most", type=float, default=600.0, metavar="SECONDS")
    parser.add_argument("ndda", nargs="?", default=str(ROOT / "target" / "release" / "ndda"))
    options = parser.parse_args()
    rows = []
    for scene, chosen in settings():
        found = run(options.ndda, scene, chosen, options.most)
        if found is None:
            print(f"{scene} {' '.join(chosen)}: more than {options.most:.0f} s")
            continue
        rows.append((scene, *found))
        print(*rows[-1], flush=True)
    TABLE.parent.mkdir(parents=True, exist_ok=True)
    with TABLE.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["scene", "blocks", "tets", "steps", "processor_s", "peak_memory_mb", "ms_per_tet", "kb_per_tet"])
        for row in rows:
            name, blocks, tets, steps, time_s, memory = row
            writer.writerow([name, blocks, tets, steps, f"{time_s:.3f}", f"{memory:.1f}", f"{1e3 * time_s / tets:.4f}", f"{1e3 * memory / tets:.3f}"])
    for name, tets, more, time, memory in slopes(rows):
        print(f"{name}: {tets} to {more} tets: time grows as size^{time:.2f}, memory as size^{memory:.2f}")


if __name__ == "__main__":
    main()
