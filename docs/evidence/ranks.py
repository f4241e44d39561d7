#!/usr/bin/env python3
"""Steps of one process and of ranks by MPI on this machine: prints the table of docs/verification/performance.md.

Usage: docs/evidence/ranks.py NDDA NDDA_MPI [REPEATS]

A step is the difference of wall times between a longer and a shorter run over the difference of steps, the median over REPEATS (5), the
programs taking turns; memory is that of the largest process. What is handed on in a step is counted by nobody: see the guide."""
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# Scene, what is set, steps of the shorter and of the longer run.
SCENES = [
    ("pile of 1000 elastic cubes", "scenes/pile_1000.ron", [], "2.5e-4", (20, 60)),
    ("10 648 cubes", "scenes/extreme/blocks.ron", ["rock.rock.domain.max_m=(22,22,22)"], "2e-4", (4, 14)),
]
WAYS = [("1 process, 1 thread", 0, 1), ("1 process, 2 threads", 0, 2), ("1 rank, 1 thread", 1, 1), ("2 ranks, 1 thread", 2, 1)]


def run(programs, way, scene, sets, step_s, steps, out):
    """Wall time of stepping [s], memory of the largest process [MB], and what the state is known by."""
    _, ranks, threads = way
    ndda, ndda_mpi = programs
    mpirun = ["mpirun", "--allow-run-as-root", "--oversubscribe", "--bind-to", "none", "-n", str(ranks), ndda_mpi]
    command = (mpirun if ranks else [ndda]) + ["run", scene, "--out", out, "--force", "--quiet", "--sensitivity", "never"]
    command += ["--threads", str(threads), "--set", f"time.end_s={steps * float(step_s)}"]
    for value in sets + ["output.frames=0", "output.history_rows=1"]:
        command += ["--set", value]
    started = time.monotonic()
    child = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    assert os.waitstatus_to_exitcode(status) in (0, 1), command
    summary = json.loads((Path(out) / "summary.json").read_text(encoding="utf-8"))
    return time.monotonic() - started, usage.ru_maxrss / 1000, summary["state_crc32"]


def main():
    programs, repeats = sys.argv[1:3], int(sys.argv[3]) if len(sys.argv) > 3 else 5
    print("| scene | " + " | ".join(way[0] for way in WAYS) + " |")
    print("|---|" + "---|" * len(WAYS))
    with tempfile.TemporaryDirectory() as out:
        for name, scene, sets, step_s, (few, many) in SCENES:
            times, states = {way: [] for way in WAYS}, set()
            for _ in range(repeats):
                for way in WAYS:
                    short, _, _ = run(programs, way, scene, sets, step_s, few, out)
                    long, memory, state = run(programs, way, scene, sets, step_s, many, out)
                    times[way].append((1000 * (long - short) / (many - few), memory))
                    states.add(state)
            assert len(states) == 1, "the bits differ"
            cells = [
                f"{statistics.median(t for t, _ in times[way]):.3g} ms, {max(m for _, m in times[way]):.0f} MB" for way in WAYS
            ]
            print(f"| {name} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
