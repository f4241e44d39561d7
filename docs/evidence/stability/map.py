#!/usr/bin/env python3
"""The stability maps: runs a study of scenes/extreme, keeps its cells as CSV beside this script, and draws a map per integrator.

Needs matplotlib and a built ndda. Usage: python3 docs/evidence/stability/map.py [NDDA] [OUT]
NDDA is the program (default target/release/ndda), OUT the folder of the study (default out/stability_study); what has run there
with the same program is not run again.
"""
import csv
import math
import subprocess
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[2]
STUDY = ROOT / "scenes/extreme/stability.ron"
KEPT = ["integrator", "penalty", "step", "label", "error_end", "place_end", "h", "label_reasons"]
COLOURS = {"accurate": "#9fd3a8", "inaccurate": "#f2c14e", "stopped": "#c9c9c9"}
# What an accurate run is held to here: speeds to 1 % of the closing speed, places to a tenth of a tetrahedron's height, half of what is promised.
SPEED, PLACE = 0.01, 0.1
# The scene: cubes of L with tetrahedra of height L/2 over the faces, two masses of ρ L³, E.
L, DENSITY, YOUNG = 0.1, 2650.0, 20e9
FILES = ["midpoint", "generalized_alpha", "end", "newmark"]


def contact_rate(penalty):
    """ω_c [1/s] of the two cubes as masses on the patch: stiffness 4 k_n A (1/H + 1/H), reduced mass ρ L³ / 2."""
    stiffness = 4 * penalty * YOUNG * L * L * 2 / (L / 2)
    return math.sqrt(stiffness / (DENSITY * L**3 / 2))


def cells(rows):
    """The rows of the study's cases, a stopped one labelled so."""
    for row in rows:
        if row["status"] != "done":
            stops = row["reason"].split("[")[1].split("]")[0] if "[" in row["reason"] else row["reason"]
            row.update(label="stopped", label_reasons=stops)
        yield {key: row[key] for key in KEPT}


def is_true(cell):
    """Whether the run is within what `accurate` promises, by the closed form."""
    return float(cell["error_end"]) <= SPEED and float(cell["place_end"] or "inf") <= PLACE


def verdict(cell):
    """`agrees`, `cautious` (right, and says that it may not be) or `wrong` (calls itself accurate, and is not)."""
    if cell["label"] == "stopped" or is_true(cell) == (cell["label"] == "accurate"):
        return "agrees"
    return "wrong" if cell["label"] == "accurate" else "cautious"


def bound(name):
    """h at which the scheme itself is off by what is promised, and how it is called."""
    if "Newmark" in name:
        return 4 / math.pi * math.log(1 + 2 * SPEED), "restitution exp(πh/4) = 1.02"
    if "end" in name:
        return -4 / math.pi * math.log(1 - 2 * SPEED), "restitution exp(−πh/4) = 0.98"
    return 2.0, "h = ω_c Δt = 2"


def draw(name, rows, path):
    """Cells with their label as colour and the closed form's error as number."""
    figure, axes = plt.subplots(figsize=(8.6, 6.6))
    for cell in rows:
        x, y = round(math.log10(float(cell["step"]))), round(math.log10(float(cell["penalty"])))
        axes.add_patch(plt.Rectangle((x - 0.5, y - 0.5), 1, 1, facecolor=COLOURS[cell["label"]], edgecolor="white"))
        stopped = cell["label"] == "stopped"
        text = "stopped" if stopped else f"{float(cell['error_end']):.0e}".replace("e-0", "e-").replace("e+0", "e+")
        if not stopped and float(cell["place_end"] or "inf") > PLACE:
            text += "\nplace"
        axes.text(x, y, text, ha="center", va="center", fontsize=8)
        mark = {"agrees": None, "cautious": ("o", "#1f4e9c"), "wrong": ("X", "#c1121f")}[verdict(cell)]
        if mark:
            axes.plot(x + 0.36, y + 0.33, mark[0], color=mark[1], markersize=8)
    limit, words = bound(name)
    heights = [-6.5, 2.5]
    axes.plot([math.log10(limit / contact_rate(10**y)) for y in heights], heights, "k-", lw=1.6, label=words)
    for label, colour in COLOURS.items():
        axes.plot([], [], "s", color=colour, markersize=11, label=f"the run says: {label}")
    axes.plot([], [], "o", color="#1f4e9c", label="right, but not claimed")
    axes.plot([], [], "X", color="#c1121f", label="wrong, and claimed")
    axes.set(xlim=(-7.5, -0.5), ylim=(-6.5, 2.5), xlabel="log₁₀ Δt [s]", ylabel="log₁₀ k_n / E", title=name)
    figure.legend(loc="lower center", bbox_to_anchor=(0.5, 0.01), ncol=3, fontsize=9, frameon=False)
    figure.tight_layout(rect=(0, 0.12, 1, 1))
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "target/release/ndda")
    out = Path(sys.argv[2] if len(sys.argv) > 2 else ROOT / "out/stability_study")
    subprocess.run([program, "study", str(STUDY), "--out", str(out), "--jobs", "2", "--quiet"], check=True, stdout=subprocess.DEVNULL)
    with open(out / "study.csv", newline="", encoding="utf-8") as file:
        found = list(cells(csv.DictReader(file)))
    with open(HERE / "cells.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, KEPT + ["verdict"], lineterminator="\n")
        writer.writeheader()
        writer.writerows({**cell, "verdict": verdict(cell)} for cell in found)
    for name, short in zip(dict.fromkeys(cell["integrator"] for cell in found), FILES):
        rows = [cell for cell in found if cell["integrator"] == name]
        draw(name, rows, HERE / f"{short}.png")
        count = {word: sum(verdict(cell) == word for cell in rows) for word in ["agrees", "cautious", "wrong"]}
        labels = {word: sum(cell["label"] == word for cell in rows) for word in COLOURS}
        print(f"{name}: {len(rows)} cells, {labels}, {count}")


if __name__ == "__main__":
    main()
