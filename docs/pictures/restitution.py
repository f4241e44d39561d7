#!/usr/bin/env python3
"""Draws docs/pictures/restitution.png: speed after over speed before a bounce, by scheme and step, beside theory.

Needs numpy and matplotlib. Usage: python3 docs/pictures/restitution.py
"""
import subprocess
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = Path(__file__).resolve().parent
TEST = ["cargo", "test", "--quiet", "--test", "verification", "--", "--nocapture", "restitution_over_the_step"]
NAMES = {
    ("Newmark(alpha: 0.5, delta: 1)", "Predicted"): ("the paper's: Newmark, contact where blocks were", "#b5523b", "o"),
    ("Midpoint(theta: 0.5)", "Predicted"): ("Midpoint (default)", "#333333", "s"),
    ("GeneralizedAlpha(radius: 0.8)", "Predicted"): ("GeneralizedAlpha, ρ = 0.8", "#7f9dbb", "^"),
    ("Midpoint(theta: 0.5)", "End()"): ("Midpoint, contact at the end", "#5f8a4f", "D"),
}

curves = {}
for line in subprocess.run(TEST, capture_output=True, text=True, check=True).stdout.splitlines():
    if line.startswith("restitution;"):
        _, integrator, contact_at, h, value = line.split(";")
        curves.setdefault((integrator, contact_at), []).append((float(h), float(value)))

plt.rcParams.update({"font.size": 10, "figure.dpi": 150})
figure, axis = plt.subplots(figsize=(6, 4), constrained_layout=True)
h = np.linspace(0, 1.05, 100)
axis.plot(h, np.exp(np.pi * h / 4), color="#b5523b", linewidth=1, linestyle=":", label="exp(πh/4)")
axis.plot(h, np.exp(-np.pi * h / 4), color="#5f8a4f", linewidth=1, linestyle=":", label="exp(−πh/4)")
for key, points in curves.items():
    name, color, marker = NAMES[key]
    axis.plot(*zip(*points), color=color, marker=marker, markersize=5, linestyle="none", label=name)
axis.set_xlabel("h = ω_c Δt")
axis.set_ylabel("restitution")
axis.set_xlim(0, 1.05)
axis.grid(alpha=0.3)
axis.legend(frameon=False, fontsize=8)
figure.savefig(HERE / "restitution.png")
