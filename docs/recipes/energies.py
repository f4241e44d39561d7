"""Draws the energies of a run over time. Usage: energies.py RUN [PICTURE]"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import pandas

run = Path(sys.argv[1])
picture = sys.argv[2] if len(sys.argv) > 2 else run / "energies.png"
history = pandas.read_csv(run / "history.csv").set_index("time_s")
# Energies and works are the columns in joules; those that never act are left out.
joules = history.filter(regex="_j$")
joules = joules.loc[:, (joules != 0).any()]
axes = joules.plot(figsize=(8, 4.5))
axes.set(xlabel="time [s]", ylabel="energy, work [J]")
axes.grid(alpha=0.3)
axes.figure.savefig(picture, dpi=110, bbox_inches="tight")
print(f"largest kinetic energy {history.kinetic_j.max():.6g} J at t = {history.kinetic_j.idxmax():.6g} s")
