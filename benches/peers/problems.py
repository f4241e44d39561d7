"""The problems that all programs are given, their answers, and how far off a program's result is."""

import math

DENSITY_KG_M3 = 2650.0
GRAVITY_M_S2 = 9.8
ROOT_HALF = math.sqrt(0.5)
NAMES = ("ramp", "ramp_phi35", "collision", "pile_125", "pile_512")
# Between these times a pile's energy is looked at.
PILE_SAMPLES = 14


def problem(name):
    """What a program is given: supports, which do not move, and bodies by corners relative to their mass centre."""
    if name == "collision":
        bodies = [cube("A", (0.5, 0.5, 0.5), (1.0, 0.0, 0.0)), cube("B", (1.52, 0.5, 0.5), (0.0, 0.0, 0.0))]
        return frame(name, 0.2, 0.0, 0.0, [], bodies, restitution=1.0)
    if name.startswith("ramp"):
        friction = math.tan(math.radians(35)) if name == "ramp_phi35" else 0.0
        return frame(name, 0.5, GRAVITY_M_S2, friction, [ramp()], [prism()])
    return pile(name, round(int(name.split("_")[1]) ** (1 / 3)))


def frame(name, end_s, gravity, friction, supports, bodies, restitution=0.0, samples=1):
    return {
        "name": name,
        "end_s": end_s,
        "gravity_m_s2": [0.0, 0.0, -gravity],
        "density_kg_m3": DENSITY_KG_M3,
        "friction": friction,
        "restitution": restitution,
        "supports": supports,
        "bodies": bodies,
        "samples": samples,
    }


def cube(name, centre, velocity=(0.0, 0.0, 0.0)):
    corners = [[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
    return {
        "name": name,
        "centre_m": list(centre),
        "corners_m": corners,
        "half_m": [0.5, 0.5, 0.5],
        "velocity_m_s": list(velocity),
    }


def ramp():
    """A wedge whose slope of 45° falls towards +x; a program may take the half-space under the slope instead."""
    corners = [[x, y, z] for x, z in ((0.0, 0.0), (1.5, 0.0), (0.0, 1.5)) for y in (-0.3, 0.3)]
    return {
        "name": "ramp",
        "corners_m": corners,
        "plane": {"point_m": [1.5, 0.0, 0.0], "normal": [ROOT_HALF, 0.0, ROOT_HALF]},
    }


def prism():
    """A flat triangular prism that lies on the slope, 0.3 m below its top, one edge pointing uphill."""
    outline = ((0.1, -0.15), (0.1, 0.15), (-0.2, 0.0))
    base = (0.3 * ROOT_HALF, 0.0, 1.5 - 0.3 * ROOT_HALF)
    world = [
        [base[0] + ROOT_HALF * (x + z), base[1] + y, base[2] + ROOT_HALF * (z - x)]
        for x, y in outline
        for z in (0.0, 0.06)
    ]
    centre = mean(world)
    corners = [[p - c for p, c in zip(point, centre)] for point in world]
    return {"name": "prism", "centre_m": centre, "corners_m": corners, "half_m": None, "velocity_m_s": [0.0, 0.0, 0.0]}


def pile(name, edge):
    """edge³ cubes, face to face, 0.2 m above a ridge in a walled box."""
    half, wall = edge / 2, edge / 2 + 2
    ridge = [[x, y, z] for x, z in ((-1.0, 0.0), (1.0, 0.0), (0.1, 0.7)) for y in (-wall, wall)]
    supports = [{"name": "ridge", "corners_m": ridge, "plane": None}]
    for side, point, normal in (
        ("floor", (0, 0, 0), (0, 0, 1)),
        ("west", (-wall, 0, 0), (1, 0, 0)),
        ("east", (wall, 0, 0), (-1, 0, 0)),
        ("south", (0, -wall, 0), (0, 1, 0)),
        ("north", (0, wall, 0), (0, -1, 0)),
    ):
        plane = {"point_m": [float(c) for c in point], "normal": [float(c) for c in normal]}
        supports.append({"name": side, "corners_m": None, "plane": plane})
    places = [(i, j, k) for k in range(edge) for j in range(edge) for i in range(edge)]
    bodies = [cube(f"cube_{n:04}", (i + 0.5 - half, j + 0.5 - half, k + 1.4)) for n, (i, j, k) in enumerate(places, 1)]
    friction = math.tan(math.radians(30))
    return frame(name, 0.7, GRAVITY_M_S2, friction, supports, bodies, samples=PILE_SAMPLES)


def judge(problem, state):
    """Error, what it is, and further figures of a program's state at the end."""
    if problem["name"] == "collision":
        return collision_error(state), "largest speed off (0, 1) m/s, over 1 m/s", {}
    if problem["name"].startswith("ramp"):
        return ramp_error(problem, state)
    gain, figures = pile_figures(problem, state)
    return gain, "energy gained, over the potential energy that was lost; no closed form", figures


def collision_error(state):
    exact = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0))
    return max(math.dist(v, e) for v, e in zip(state["velocities_m_s"], exact))


def ramp_error(problem, state):
    moved = [now - before for now, before in zip(state["centres_m"][0], problem["bodies"][0]["centre_m"])]
    along, away = ROOT_HALF * (moved[0] - moved[2]), ROOT_HALF * (moved[0] + moved[2])
    exact = 0.5 * ROOT_HALF * (1 - problem["friction"]) * GRAVITY_M_S2 * problem["end_s"] ** 2
    return abs(along / exact - 1), "way along the slope, over ½ (sin α − tan φ cos α) g t², − 1", {"off_slope_m": away}


def pile_figures(problem, state):
    energies, bodies = state["energies_j"], state["corners_m"]
    mass = DENSITY_KG_M3 * len(bodies)
    height = mean([mean(corners) for corners in bodies])[2]
    lost = mass * GRAVITY_M_S2 * (mean([b["centre_m"] for b in problem["bodies"]])[2] - height)
    risen, lowest = 0.0, energies[0]
    for energy in energies:
        lowest = min(lowest, energy)
        risen = max(risen, energy - lowest)
    return risen / lost if lost > 0 else math.inf, {"height_m": height, "depth_m": deepest_corner(problem, bodies)}


def deepest_corner(problem, bodies):
    """How deep a cube's corner is inside another cube or beyond a wall at the end [m]; edges that cross are not seen."""
    grid = {}
    for number, corners in enumerate(bodies):
        grid.setdefault(cell(mean(corners)), []).append(number)
    deepest = 0.0
    for number, corners in enumerate(bodies):
        for point in corners:
            for other in neighbours(grid, cell(point)):
                if other != number:
                    deepest = max(deepest, depth_in_cube(point, bodies[other]))
            for support in problem["supports"]:
                deepest = max(deepest, depth_behind(point, support["plane"]))
    return deepest


def depth_in_cube(point, corners):
    """Corners in the order of `cube`: 0 and 4, 2, 1 are the ends of its edges along x, y, z."""
    depth = math.inf
    for end in (4, 2, 1):
        edge = [b - a for a, b in zip(corners[0], corners[end])]
        length = math.hypot(*edge)
        along = sum((p - a) * e for p, a, e in zip(point, corners[0], edge)) / length
        depth = min(depth, along, length - along)
    return depth


def depth_behind(point, plane):
    return -sum((p - o) * n for p, o, n in zip(point, plane["point_m"], plane["normal"])) if plane else 0.0


def cell(point):
    return tuple(math.floor(c) for c in point)


def neighbours(grid, at):
    for i in (-1, 0, 1):
        for j in (-1, 0, 1):
            for k in (-1, 0, 1):
                yield from grid.get((at[0] + i, at[1] + j, at[2] + k), ())


def mean(points):
    return [sum(c) / len(points) for c in zip(*points)]
