#!/usr/bin/env python3
"""Steps and memory of one process and of ranks by MPI: prints the table of docs/verification/performance.md.

Usage: docs/evidence/ranks.py NDDA NDDA_MPI

A step is the difference of wall times of a longer and a shorter run, each the quickest of three, over the difference of steps; the ways take turns.
Memory is that of the largest process. States must have the same bits."""
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CUBES = "".join(
    f'(name: "cube_{i}{j}{k}", material: "rock", shape: Box(size_m: (1, 1, 1), cells: (10, 10, 10)), at_m: ({i}, {j}, {k})),'
    for i in range(2)
    for j in range(2)
    for k in range(2)
)
EIGHT = f"""(title: "Eight finely meshed cubes", time: (step_s: 1e-4, end_s: 1e-2), gravity_m_s2: (0, 0, -9.81),
    materials: [(name: "rock", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
    blocks: [(name: "floor", material: "rock", body: Fixed, shape: Box(size_m: (4, 4, 1), cells: (4, 4, 1)), at_m: (-1, -1, -1)), {CUBES}],
    contact: Potential(penalty_pa: 1e9, potential: Smooth(), friction: (friction_deg: 30)))"""
# Name, file, step, steps of the shorter and of the longer run.
SCENES = [
    ("eight cubes of 6000 tetrahedra", "eight.ron", 1e-4, (5, 25)),
    ("pile of 1000 cubes of 12", ROOT / "scenes/pile_1000.ron", 2.5e-4, (20, 80)),
]
# Ranks, or none, and threads of each.
WAYS = [(0, 1), (0, 2), (2, 1)]


def run(programs, ranks, threads, scene, end_s, out):
    """Wall time [s], memory of the largest [MB], and what the results are known by."""
    mpirun = ["mpirun", "--allow-run-as-root", "--oversubscribe", "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1"]
    command = mpirun + ["-n", str(ranks), programs[1]] if ranks else [programs[0]]
    command += ["run", str(scene), "--out", out, "--force", "--quiet", "--sensitivity", "never", "--threads", str(threads)]
    for value in (f"time.end_s={end_s}", "output.frames=0", "output.history_rows=1"):
        command += ["--set", value]
    started = time.monotonic()
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    wall_s = time.monotonic() - started
    assert os.waitstatus_to_exitcode(status) in (0, 1), command
    summary = json.loads((Path(out) / "summary.json").read_text(encoding="utf-8"))
    return wall_s, usage.ru_maxrss / 1000, summary["state_crc32"]


def main():
    programs = [str(Path(program).resolve()) for program in sys.argv[1:3]]
    print("| scene | ranks | threads | step [ms] | memory [MB] |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "eight.ron").write_text(EIGHT, encoding="utf-8")
        for name, scene, step_s, counts in SCENES:
            found, states = {}, set()
            for _ in range(3):
                for way in WAYS:
                    both = [run(programs, *way, Path(folder) / scene, steps * step_s, f"{folder}/out") for steps in counts]
                    found.setdefault(way, []).append(both)
                    states.add(both[1][2])
            assert len(states) == 1, "the bits differ"
            for (ranks, threads), rows in found.items():
                short, long = (min(row[k][0] for row in rows) for k in (0, 1))
                step_ms, memory = 1000 * (long - short) / (counts[1] - counts[0]), max(row[1][1] for row in rows)
                print(f"| {name} | {ranks or 'no MPI'} | {threads} | {step_ms:.1f} | {memory:.0f} |", flush=True)


if __name__ == "__main__":
    main()
