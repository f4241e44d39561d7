#!/usr/bin/env python3
"""Processor time and memory of one process and of ranks by MPI: prints the table of docs/verification/performance.md.

Usage: docs/evidence/ranks.py NDDA NDDA_MPI

A step is the difference of a longer and a shorter run over the difference of steps, in processor time of each process: on a machine that does other
work as well, ranks wait for each other, and elapsed time says little. Memory is that of the largest process. History rows and states must have the same bits."""
import json
import os
import subprocess
import sys
import tempfile
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
# Name, file, step, steps of the shorter and of the longer run, numbers of ranks; 0 is a process without MPI.
SCENES = [
    ("eight cubes of 6000 tetrahedra", "eight.ron", 1e-4, (5, 25), (0, 2, 4)),
    ("pile of 1000 cubes of 12", ROOT / "scenes/pile_1000.ron", 2.5e-4, (20, 80), (0, 2, 3)),
]


def run(programs, ranks, scene, end_s, out):
    """Processor time of a process [s], memory of the largest [MB], and what the results are known by."""
    mpirun = ["mpirun", "--allow-run-as-root", "--oversubscribe", "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1"]
    command = mpirun + ["-n", str(ranks), programs[1]] if ranks else [programs[0]]
    command += ["run", str(scene), "--out", out, "--force", "--quiet", "--sensitivity", "never", "--threads", "1"]
    for value in (f"time.end_s={end_s}", "output.frames=0", "output.history_rows=1"):
        command += ["--set", value]
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    assert os.waitstatus_to_exitcode(status) in (0, 1), command
    summary = json.loads((Path(out) / "summary.json").read_text(encoding="utf-8"))
    known = (summary["state_crc32"], (Path(out) / "history.csv").read_bytes())
    return (usage.ru_utime + usage.ru_stime) / max(ranks, 1), usage.ru_maxrss / 1000, known


def main():
    programs = [str(Path(program).resolve()) for program in sys.argv[1:3]]
    print("| scene | ranks | ms of processor a step and rank | over one process | memory [MB] |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "eight.ron").write_text(EIGHT, encoding="utf-8")
        for name, scene, step_s, (few, many), sizes in SCENES:
            first = None
            for ranks in sizes:
                results = [run(programs, ranks, Path(folder) / scene, steps * step_s, f"{folder}/out") for steps in (few, many)]
                step_ms = 1000 * (results[1][0] - results[0][0]) / (many - few)
                first = first or (step_ms, results[1][2])
                assert first[1] == results[1][2], "the bits differ"
                label = ranks or "none"
                print(f"| {name} | {label} | {step_ms:.1f} | {step_ms / first[0]:.2f} | {results[1][1]:.0f} |", flush=True)


if __name__ == "__main__":
    main()
