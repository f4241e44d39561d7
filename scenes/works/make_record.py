"""Writes a record of ground motion, synthetic.at2 for the scenes of this folder and record.at2 for a template: python3 scenes/works/make_record.py

A sum of 120 sines of random phase (seed 7) with frequencies from 0.4 to 12 Hz and amplitudes of Brune's spectrum f²/(1 + (f/1.2 Hz)²), under the envelope
t² exp(-t) to 8 s, scaled to a peak of 0.35 g. It is no record of an earthquake.
"""

import math
import pathlib
import random

DT, COUNT, PEAK_G = 0.005, 1600, 0.35

random.seed(7)
freqs = [0.4 * (12 / 0.4) ** (k / 119) for k in range(120)]
sines = [(f, f * f / (1 + (f / 1.2) ** 2) / f, 2 * math.pi * random.random()) for f in freqs]
times = [DT * i for i in range(COUNT)]
values = [t * t * math.exp(-t) * sum(a * math.sin(2 * math.pi * f * t + p) for f, a, p in sines) for t in times]
scale = PEAK_G / max(abs(v) for v in values)
values = [scale * v for v in values]
lines = [
    "SYNTHETIC RECORD, NO EARTHQUAKE",
    "scenes/works/make_record.py",
    "ACCELERATION TIME SERIES IN UNITS OF G",
    f"NPTS=  {COUNT}, DT=   {DT:.4f} SEC",
]
for i in range(0, COUNT, 5):
    lines.append("".join(f"{v:15.7E}" for v in values[i : i + 5]))
here = pathlib.Path(__file__).resolve().parent
for file in (here / "synthetic.at2", here.parents[1] / "crates/ndda/templates/record.at2"):
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
