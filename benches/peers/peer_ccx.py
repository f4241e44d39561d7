"""The collision of problems.py in CalculiX: peer_ccx.py PROBLEM.json SETTING.json prints its state at the end.

Each cube is a mesh of eight-node bricks; contact is a penalty between faces, pressure = slope · overlap."""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import timed

YOUNG_PA, POISSON = 20e9, 0.25


def main():
    problem, setting = (json.loads(Path(path).read_text()) for path in sys.argv[1:3])
    grids = [grid(body, setting["cells"], first) for first, body in bodies_with_first_nodes(problem, setting["cells"])]
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "run.inp").write_text(deck(problem, setting, grids))
        ended = timed.run(["ccx", "run"], cwd=folder)
        printed = Path(folder, "run.dat").read_text() if Path(folder, "run.dat").exists() else ""
    velocities = last_velocities(printed, problem["end_s"])
    if ended.code or not velocities:
        sys.exit(f"ccx stopped: {ended.out[-400:]}")
    print(
        json.dumps(
            {
                "version": version(),
                "steps": round(problem["end_s"] / setting["step_s"]),
                "step_cpu_s": ended.cpu_s,
                "step_wall_s": ended.wall_s,
                "cpu_s": ended.cpu_s,
                "wall_s": ended.wall_s,
                "energies_j": [],
                "corners_m": [],
                "centres_m": [],
                "velocities_m_s": [mean_velocity(nodes, weights, velocities) for nodes, weights, _ in grids],
            }
        )
    )


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
        for k in range(cells)
        for j in range(cells)
        for i in range(cells)
    ]
    return nodes, weights, bricks


def share(place, cells):
    """Of a mass that the bricks share evenly among their corners."""
    weight = 1 / cells**3
    for p in place:
        weight *= 0.5 if p in (0, cells) else 1.0
    return weight


def deck(problem, setting, grids):
    (speed_a, *_), (speed_b, *_) = (body["velocity_m_s"] for body in problem["bodies"])
    steps = round(problem["end_s"] / setting["step_s"])
    # Faces of a brick: S4 looks to +x, S6 to -x.
    cells, bricks = setting["cells"], len(grids[0][2])
    cubes = cube_lines("A", grids[0], 1, "S4", range(cells - 1, bricks, cells))
    cubes += cube_lines("B", grids[1], 1 + bricks, "S6", range(0, bricks, cells))
    return (
        "\n".join(cubes)
        + f"""
*MATERIAL, NAME=ROCK
*ELASTIC
{YOUNG_PA:g}, {POISSON:g}
*DENSITY
{problem["density_kg_m3"]:g}
*SOLID SECTION, ELSET=EA, MATERIAL=ROCK
*SOLID SECTION, ELSET=EB, MATERIAL=ROCK
*SURFACE INTERACTION, NAME=TOUCH
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
{setting["slope_pa_m"]:g}
*CONTACT PAIR, INTERACTION=TOUCH, TYPE={setting["pair"]}
SA, SB
*INITIAL CONDITIONS, TYPE=VELOCITY
NA, 1, {speed_a:g}
NB, 1, {speed_b:g}
*STEP, NLGEOM, INC=1000000
*DYNAMIC, DIRECT
{setting["step_s"]:g}, {problem["end_s"]:g}
*NODE PRINT, NSET=NA, FREQUENCY={steps}
V
*NODE PRINT, NSET=NB, FREQUENCY={steps}
V
*END STEP
"""
    )


def cube_lines(name, grid, first, face, touching):
    """Nodes, elements from number `first` on, and the surface that their `touching` ones have."""
    nodes, _, bricks = grid
    lines = [f"*NODE, NSET=N{name}", *(f"{n}, {p[0]:.17g}, {p[1]:.17g}, {p[2]:.17g}" for n, p in nodes.items())]
    lines += [f"*ELEMENT, TYPE=C3D8, ELSET=E{name}"]
    lines += [f"{first + i}, {', '.join(map(str, brick))}" for i, brick in enumerate(bricks)]
    return [*lines, f"*SURFACE, NAME=S{name}", *(f"{first + i}, {face}" for i in touching)]


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
