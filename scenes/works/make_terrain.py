"""Writes rockfall.asc, a mountain side for rockfall.ron: a cliff above a talus with a gully, a road on a bench, and meadows below.

    python3 scenes/works/make_terrain.py
"""

import math
import pathlib

COUNT = 101
STEP_M = 3

# Distance from the western edge, and height there [m].
PROFILE = [
    (0, 125), (25, 119), (37, 92), (48, 80), (90, 56), (130, 39), (170, 27), (189, 23), (193, 22.5), (205, 22.3),
    (208, 20.6), (240, 16.5), (270, 15), (310, 14.5),
]


def between(x):
    """Height of the profile, smooth between its points (Catmull and Rom's tangents)."""
    k = next(k for k in range(len(PROFILE) - 1) if x <= PROFILE[k + 1][0])
    (x0, z0), (x1, z1) = PROFILE[k], PROFILE[k + 1]

    def slope(i):
        a, b = PROFILE[max(i - 1, 0)], PROFILE[min(i + 1, len(PROFILE) - 1)]
        return (b[1] - a[1]) / (b[0] - a[0])

    t, h = (x - x0) / (x1 - x0), x1 - x0
    return (
        z0 * (1 + 2 * t) * (1 - t) ** 2
        + z1 * t * t * (3 - 2 * t)
        + h * slope(k) * t * (1 - t) ** 2
        - h * slope(k + 1) * t * t * (1 - t)
    )


def height(x, y):
    """Height of the ground [m]."""
    edge = 5 * math.sin(y / 31) + 2.5 * math.sin(y / 13 + 1)
    z = between(min(max(x + edge * math.exp(-((x - 32) / 45) ** 2), 0), 309))
    on_talus = 1 / (1 + math.exp(-(x - 45) / 6)) / (1 + math.exp((x - 182) / 4))
    gully = 150 + 18 * math.sin(x / 42)
    z -= 4.5 * on_talus * math.exp(-((y - gully) / 11) ** 2)
    z += 3.0 * on_talus * math.sin(y / 27 + x / 90)
    rough = math.sin(1.31 * x + 0.7 * y) + math.sin(0.83 * x - 1.17 * y + 2) + math.sin(2.3 * y + 0.37 * x)
    is_road = 1 / (1 + math.exp(-(x - 191) / 0.8)) / (1 + math.exp((x - 207) / 0.8))
    return z + 0.13 * rough * (1 - is_road)


lines = [f"ncols {COUNT}", f"nrows {COUNT}", "xllcenter 0", "yllcenter 0", f"cellsize {STEP_M}", "NODATA_value -9999"]
for row in reversed(range(COUNT)):
    lines.append(" ".join(f"{height(column * STEP_M, row * STEP_M):.2f}" for column in range(COUNT)))
pathlib.Path(__file__).with_name("rockfall.asc").write_text("\n".join(lines) + "\n")
