#!/usr/bin/env python3
"""Time and memory over size: 1 to 1e5 blocks, and one block of up to 1e6 tetrahedra.

  docs/evidence/sizes.py [--largest TETS] [NDDA]     (default: 1e6 tetrahedra, target/release/ndda)

Runs scenes/extreme/blocks.ron and one_block.ron on one thread at each size and writes docs/evidence/sizes/sizes.csv: processor time of
the whole run, set-up included, peak memory, and both per tetrahedron. Prints the slope of time and memory over tetrahedra in
log-log, between each size and the next. The largest of all, 1e5 blocks, wants 1.5 GB and some minutes.
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
# The first two are over in no time, most of which is that of starting a program.
BLOCKS = [(1, 1, 1), (1, 1, 2), (5, 5, 5), (10, 10, 10), (22, 22, 22), (46, 46, 47)]
CELLS = [2, 6, 12, 25, 55]


def settings(largest):
    """Scene and settings of each size of up to so many tetrahedra."""
    # Few steps: what is measured is how they grow.
    for sides in (sides for sides in BLOCKS if 6 * math.prod(sides) <= largest):
        fixed = ["rock.rock.fixed=[]"] if sides[2] == 1 else []
        yield "blocks", [f"rock.rock.domain.max_m={sides}".replace(" ", ""), "time.end_s=6e-4", *fixed]
    for cells in (cells for cells in CELLS if 6 * cells**3 <= largest):
        yield "one_block", [f"blocks.block.shape.cells=({cells},{cells},{cells})", "time.end_s=3e-3"]


def run(ndda, scene, chosen):
    """Blocks, tetrahedra, steps, processor time [s] and peak memory [MB] of a run."""
    with tempfile.TemporaryDirectory() as folder:
        command = [ndda, "run", str(ROOT / "scenes" / "extreme" / f"{scene}.ron"), "--out", f"{folder}/out", "--quiet", "--threads", "1"]
        for setting in chosen:
            command += ["--set", setting]
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(command, check=True)
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
    parser.add_argument("--largest", type=float, default=1e6, metavar="TETS")
    parser.add_argument("ndda", nargs="?", default=str(ROOT / "target" / "release" / "ndda"))
    options = parser.parse_args()
    rows = []
    for scene, chosen in settings(options.largest):
        rows.append((scene, *run(options.ndda, scene, chosen)))
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
