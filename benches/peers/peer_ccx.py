"""The collision of problems.py in CalculiX: peer_ccx.py PROBLEM.json SETTING.json runs ccx and prints its state at the end.

Each cube is a mesh of eight-node bricks; contact is a penalty between faces, pressure = slope · overlap."""
import json
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

YOUNG_PA, POISSON = 20e9, 0.25


def main():
    problem, setting = (json.load(open(path)) for path in sys.argv[1:3])
    grids = [grid(body, setting["cells"], first) for first, body in bodies_with_first_nodes(problem, setting["cells"])]
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "run.inp").write_text(deck(problem, setting, grids))
        wall = time.perf_counter()
        run = subprocess.Popen(["ccx", "run"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        said = run.stdout.read()
        _, status, usage = os.wait4(run.pid, 0)
        wall_s, cpu_s = time.perf_counter() - wall, usage.ru_utime + usage.ru_stime
        printed = Path(folder, "run.dat").read_text() if Path(folder, "run.dat").exists() else ""
    velocities = last_velocities(printed, problem["end_s"])
    if status or not velocities:
        sys.exit(f"ccx stopped: {said[-400:]}")
    print(json.dumps({
        "version": version(), "steps": round(problem["end_s"] / setting["step_s"]), "step_cpu_s": cpu_s, "step_wall_s": wall_s,
        "process_cpu_s": cpu_s, "process_wall_s": wall_s, "energies_j": [], "corners_m": [], "centres_m": [],
        "velocities_m_s": [mean_velocity(nodes, weights, velocities) for nodes, weights, _ in grids],
    }))


def version():
    return re.search(r"Version (\S+)", subprocess.run(["ccx", "-v"], capture_output=True, text=True).stdout).group(1)


def bodies_with_first_nodes(problem, cells):
    return [(1 + i * (cells + 1) ** 3, body) for i, body in enumerate(problem["bodies"])]


def grid(body, cells, first):
    """Nodes with their places, their shares of the mass, and bricks with their nodes."""
    at = [(i, j, k) for k in range(cells + 1) for j in range(cells + 1) for i in range(cells + 1)]
    number = {place: first + n for n, place in enumerate(at)}
    corner = [c - h for c, h in zip(body["centre_m"], body["half_m"])]
    nodes = {number[p]: [c + 2 * h * q / cells for c, h, q in zip(corner, body["half_m"], p)] for p in at}
    weights = {number[p]: share(p, cells) for p in at}
    around = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
    bricks = [
        [number[i + a, j + b, k + c] for a, b, c in around]
        for k in range(cells) for j in range(cells) for i in range(cells)
    ]
    return nodes, weights, bricks


def share(place, cells):
    """Of a mass that the bricks share evenly among their corners."""
    weight = 1 / cells**3
    for p in place:
        weight *= 0.5 if p in (0, cells) else 1.0
    return weight


def deck(problem, setting, grids):
    lines, first = [], 1
    for name, (nodes, _, bricks) in zip("AB", grids):
        lines += [f"*NODE, NSET=N{name}"] + [f"{n}, {p[0]:.17g}, {p[1]:.17g}, {p[2]:.17g}" for n, p in nodes.items()]
        lines += [f"*ELEMENT, TYPE=C3D8, ELSET=E{name}"]
        lines += [f"{first + i}, {', '.join(map(str, brick))}" for i, brick in enumerate(bricks)]
        # Faces of a brick: S4 looks to +x, S6 to -x.
        column = 1 if name == "B" else setting["cells"]
        lines += [f"*SURFACE, NAME=S{name}"]
        lines += [
            f"{first + i}, {'S6' if name == 'B' else 'S4'}"
            for i in range(len(bricks)) if i % setting["cells"] + 1 == column
        ]
        first += len(bricks)
    bodies, steps = problem["bodies"], round(problem["end_s"] / setting["step_s"])
    lines += [
        "*MATERIAL, NAME=ROCK", "*ELASTIC", f"{YOUNG_PA:g}, {POISSON:g}", "*DENSITY", f"{problem['density_kg_m3']:g}",
        "*SOLID SECTION, ELSET=EA, MATERIAL=ROCK", "*SOLID SECTION, ELSET=EB, MATERIAL=ROCK",
        "*SURFACE INTERACTION, NAME=TOUCH", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{setting['slope_pa_m']:g}",
        f"*CONTACT PAIR, INTERACTION=TOUCH, TYPE={setting['pair']}", "SA, SB",
        "*INITIAL CONDITIONS, TYPE=VELOCITY", f"NA, 1, {bodies[0]['velocity_m_s'][0]:g}", f"NB, 1, {bodies[1]['velocity_m_s'][0]:g}",
        "*STEP, NLGEOM, INC=1000000", "*DYNAMIC, DIRECT", f"{setting['step_s']:g}, {problem['end_s']:g}",
        f"*NODE PRINT, NSET=NA, FREQUENCY={steps}", "V", f"*NODE PRINT, NSET=NB, FREQUENCY={steps}", "V", "*END STEP",
    ]
    return "\n".join(lines) + "\n"


def last_velocities(printed, end_s):
    """Velocity of each node at the end [m/s]."""
    velocities, wanted = {}, False
    for line in printed.splitlines():
        if "velocities" in line:
            wanted = abs(float(re.search(r"time\s+(\S+)", line).group(1)) / end_s - 1) < 1e-6
        elif wanted and len(words := line.split()) == 4:
            velocities[int(words[0])] = [float(word) for word in words[1:]]
    return velocities


def mean_velocity(nodes, weights, velocities):
    return [sum(weights[n] * velocities[n][axis] for n in nodes) for axis in range(3)]


if __name__ == "__main__":
    main()
