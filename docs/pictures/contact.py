#!/usr/bin/env python3
"""Draws docs/pictures/contact_*.png, the drawings of docs/theory/contact.md, in the plane: triangles for tetrahedra.

Needs numpy and matplotlib. Usage: python3 docs/pictures/contact.py
"""
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Polygon

HERE = Path(__file__).resolve().parent
A_COLOR, B_COLOR, INK = "#c9a66b", "#7f9dbb", "#333333"
plt.rcParams.update({"font.size": 10, "figure.dpi": 150})


def barycentric(corners, x, y):
    matrix = np.vstack([np.array(corners).T, np.ones(3)])
    return np.tensordot(np.linalg.inv(matrix), np.stack([x, y, np.ones_like(x)]), axes=1)


def axes(count, width, height):
    figure, all_axes = plt.subplots(1, count, figsize=(width, height), constrained_layout=True)
    for axis in all_axes:
        axis.set_aspect("equal")
        axis.axis("off")
    return figure, all_axes


def save(figure, name):
    figure.savefig(HERE / name)
    plt.close(figure)


def outline(axis, corners, color, **more):
    axis.add_patch(Polygon(corners, closed=True, fill=False, edgecolor=color, linewidth=1.6, **more))


def arrows(axis, start, end, normal, lengths, color):
    for t, length in lengths:
        x = np.array(start) + t * (np.array(end) - np.array(start))
        axis.annotate("", x + length * np.array(normal), x, arrowprops={"arrowstyle": "-|>", "color": color, "lw": 1.2})


def cancellation():
    """An inner face of A in B: what one element gives the other takes back."""
    figure, (left, right) = axes(2, 8.4, 3.4)
    b = [(-0.3, -0.9), (2.3, -0.9), (2.3, 0.45), (-0.3, 0.45)]
    first, second = [(0, 1.4), (0, 0), (1, 0)], [(0, 1.4), (1, 0), (2, 1.4)]
    for axis in (left, right):
        axis.add_patch(Polygon(b, facecolor=B_COLOR, alpha=0.25, edgecolor=B_COLOR, linewidth=1.6))
        axis.text(2.05, -0.75, "B", color=B_COLOR, weight="bold", size=13)
        axis.set_xlim(-0.4, 2.5)
        axis.set_ylim(-1.0, 1.6)
    for corners in (first, second):
        left.add_patch(Polygon(corners, facecolor=A_COLOR, alpha=0.25, edgecolor=A_COLOR, linewidth=1.6))
    along = np.array([1, -1.4]) / np.hypot(1, 1.4)
    normal = np.array([-along[1], along[0]])
    lengths = [(0.74, 0.14), (0.83, 0.24), (0.92, 0.14)]
    arrows(left, (0, 1.4), (1, 0), normal, lengths, "#b03a2e")
    arrows(left, (0, 1.4), (1, 0), -normal, lengths, "#1e8449")
    left.text(0.25, 0.75, "$A_1$", color=INK)
    left.text(1.0, 0.85, "$A_2$", color=INK)
    left.set_title("all elements: −φ n of $A_1$ and of $A_2$ on their common face", size=10)
    right.add_patch(Polygon([(0, 1.4), (0, 0), (1, 0), (2, 1.4)], facecolor=A_COLOR, alpha=0.25, edgecolor=A_COLOR, linewidth=1.6))
    arrows(right, (0, 0), (1, 0), (0, 1), [(0.3, 0.34), (0.5, 0.38), (0.7, 0.36), (0.9, 0.26)], INK)
    edge = np.array([1, 1.4]) / np.hypot(1, 1.4)
    arrows(right, (1, 0), (2, 1.4), (-edge[1], edge[0]), [(0.15, 0.17), (0.24, 0.09)], INK)
    arrows(right, (0, 0), (0, 1.4), (1, 0), [(0.08, 0.2), (0.2, 0.12)], INK)
    right.text(0.75, 0.85, "A", color=INK, weight="bold", size=13)
    right.set_title("what is left: boundary against elements", size=10)
    save(figure, "contact_cancellation.png")


def regions():
    """The kinks of φ split what is inside."""
    figure, (left, right) = axes(2, 8.4, 3.6)
    tet = [(0, 0), (2, 0.1), (0.8, 1.7)]
    x, y = np.meshgrid(np.linspace(-0.2, 2.2, 500), np.linspace(-0.4, 1.8, 460))
    smallest = barycentric(tet, x, y)
    phi = np.where(smallest.min(axis=0) >= 0, 3 * smallest.min(axis=0), np.nan)
    left.contourf(x, y, phi, levels=np.linspace(0, 1, 11), cmap="Blues")
    outline(left, tet, B_COLOR)
    left.set_title("φ of an element: 0 on its faces, 1 at its centroid", size=10)
    center = np.mean(tet, axis=0)
    colors = ["#d98880", "#7dcea0", "#f7dc6f"]
    start, end = np.array([-0.15, 0.62]), np.array([2.1, 0.38])
    for k in range(3):
        part = [center, tet[(k + 1) % 3], tet[(k + 2) % 3]]
        right.add_patch(Polygon(part, facecolor=colors[k], alpha=0.35, edgecolor="none"))
    outline(right, tet, B_COLOR)
    right.plot(*np.stack([start, end]).T, color=INK, lw=1)
    s = np.linspace(0, 1, 4000)
    line = start[:, None] + (end - start)[:, None] * s
    at = barycentric(tet, *line)
    for k in range(3):
        mine = (at.argmin(axis=0) == k) & (at.min(axis=0) >= 0)
        right.plot(line[0, mine], line[1, mine], color=colors[k], lw=5, solid_capstyle="butt")
    for cut in np.flatnonzero(np.diff(at.argmin(axis=0)) | np.diff((at.min(axis=0) >= 0).astype(int))):
        if at.min(axis=0)[cut] > -0.01:
            right.plot(line[0, cut], line[1, cut], "o", color=INK, ms=5)
    right.text(1.82, 0.52, "triangle of A", size=9, color=INK)
    right.set_title("linear in each region: cut there, integrate exactly", size=10)
    save(figure, "contact_regions.png")


def potentials():
    """The potential of elements beside that of depth."""
    figure, (left, right) = axes(2, 8.4, 3.6)
    nodes = {(i, j): (i + 0.17 * ((i * 7 + j * 3) % 3 - 1) * (0 < i < 3) * (0 < j < 2), j + 0.15 * ((i + 2 * j) % 3 - 1) * (0 < i < 3) * (0 < j < 2)) for i in range(4) for j in range(3)}
    triangles = []
    for i in range(3):
        for j in range(2):
            a, b, c, d = nodes[i, j], nodes[i + 1, j], nodes[i + 1, j + 1], nodes[i, j + 1]
            triangles += [(a, b, c), (a, c, d)]
    x, y = np.meshgrid(np.linspace(0, 3, 600), np.linspace(0, 2, 400))
    phi = np.zeros_like(x)
    for triangle in triangles:
        smallest = barycentric(triangle, x, y).min(axis=0)
        phi = np.where(smallest >= 0, 3 * smallest, phi)
    left.contourf(x, y, phi, levels=12, cmap="Blues")
    right.contourf(x, y, np.minimum.reduce([x, 3 - x, y, 2 - y]), levels=12, cmap="Blues")
    for axis in (left, right):
        for triangle in triangles:
            outline(axis, triangle, INK, alpha=0.35)
        axis.set_xlim(-0.05, 3.05)
        axis.set_ylim(-0.05, 2.05)
    left.set_title("Element: falls to 0 again inside, ripples along the surface", size=10)
    right.set_title("Smooth: depth below the nearest face, whatever the mesh", size=10)
    save(figure, "contact_potentials.png")


def tangent():
    """What a shift changes, and what it does not."""
    figure, (left, right) = axes(2, 8.4, 3.0)
    depth = lambda y: np.maximum(0, 0.5 - y)
    for axis, shift, title in ((left, 0.0, "pressure k φ on A's surface in B"), (right, 0.16, "A shifted by δ: k ∇φ·δ more, nothing at the rim")):
        axis.add_patch(Polygon([(-0.2, -0.7), (3.2, -0.7), (3.2, 0.5), (-0.2, 0.5)], facecolor=B_COLOR, alpha=0.25, edgecolor=B_COLOR, lw=1.6))
        surface = np.array([(0.2, 1.1), (0.9, 0.0), (2.0, -0.2), (2.9, 1.1)]) - (0, shift)
        axis.add_patch(Polygon(surface, facecolor=A_COLOR, alpha=0.35, edgecolor=A_COLOR, lw=1.6))
        for p, q in zip(surface[:-1], surface[1:]):
            along = (q - p) / np.linalg.norm(q - p)
            normal = np.array([-along[1], along[0]])
            for t in np.linspace(0.05, 0.95, 8):
                place = p + t * (q - p)
                before, now = 0.6 * depth(place[1] + shift), 0.6 * depth(place[1])
                if now > 0.01:
                    axis.plot(*np.stack([place, place + now * normal]).T, color="#b03a2e", lw=2)
                    axis.plot(*np.stack([place, place + before * normal]).T, color=INK, lw=2)
        axis.set_xlim(-0.3, 3.3)
        axis.set_ylim(-0.8, 1.2)
        axis.set_title(title, size=10)
    save(figure, "contact_tangent.png")


if __name__ == "__main__":
    cancellation()
    regions()
    potentials()
    tangent()
