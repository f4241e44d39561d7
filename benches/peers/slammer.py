#!/usr/bin/env python3
"""A rigid block on a slope under recorded earthquakes, beside pySLAMMER (Arnold & Garcia-Rivas 2025), whose records it takes.

  slammer.py NDDA      runs NDDA, the program, and pySLAMMER (pip install pyslammer), and keeps docs/evidence/peers/slammer.csv
  slammer.py           writes the table of docs/verification/verification.md from what is kept
  slammer.py --check   fails where the page says otherwise

The slope dips 30° and is shaken along its dip; the block yields to 0.1 g down the slope, and to more than any record has up it.
"""

import csv
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
KEPT = ROOT / "docs" / "evidence" / "peers" / "slammer.csv"
PAGE = ROOT / "docs" / "verification" / "verification.md"
BEGIN, END = "<!-- table of earthquakes: begin -->", "<!-- table of earthquakes: end -->"
GRAVITY, YIELD_G, DIP, STEP_S = 9.80665, 0.1, math.radians(30), 2e-4
# Of the smallest slips, less than a step of the records is left.
LEAST_M = 0.01
COLUMNS = ["record", "peak_g", "equation_m", "pyslammer_m", "ndda_m", "label"]


def scene(end_s):
    """The base accelerates up the slope where the record is positive."""
    friction_deg = math.degrees(math.atan((math.sin(DIP) + YIELD_G) / math.cos(DIP)))
    block = (
        "({name}, material: \"rock\", body: {body}, turns: [(axis: (0, 1, 0), angle_deg: 30)], shape: Hexahedron(corners_m: ("
        "(-{x}, -{x}, {z0}), ({x}, -{x}, {z0}), ({x}, {x}, {z0}), (-{x}, {x}, {z0}),"
        "(-{x}, -{x}, {z1}), ({x}, -{x}, {z1}), ({x}, {x}, {z1}), (-{x}, {x}, {z1})), cells: ({n}, {n}, 1)))"
    )
    base = block.format(name='name: "base"', body="Fixed", x=6, z0=-0.5, z1=0, n=3)
    slider = block.format(name='name: "block"', body="Rigid", x=0.2, z0=0, z1=0.05, n=2)
    direction = f"({-math.cos(DIP)}, 0, {math.sin(DIP)})"
    return f"""(
    title: "earthquake", time: (step_s: {STEP_S}, end_s: {end_s}), gravity_m_s2: (0, 0, -{GRAVITY}),
    settle: (most_steps: 40000, tolerance: 1e-5),
    materials: [(name: "rock", young_pa: 20e9, poisson: 0.2, density_kg_m3: 2500)],
    blocks: [{base}, {slider}],
    supports: [(block: "base", on: All, hold: Shaking([(direction: {direction}, record: (file: "quake.csv"))]))],
    contact: Potential(penalty_pa: 1e8, potential: Smooth(reference_m: 1), friction: (friction_deg: {friction_deg})),
    monitors: [(name: "base", block: "base"), (name: "block", block: "block")],
    output: (frames: 0, history_rows: 200),
)"""


def slid_m(program, folder):
    """Slip down the slope at the end, and the label."""
    out = folder / "out"
    subprocess.run([program, "run", folder / "quake.ron", "--out", out, "--quiet"], check=True)
    with (out / "history.csv").open(encoding="utf-8", newline="") as file:
        last = list(csv.DictReader(file))[-1]
    x, z = (float(last[f"block.displacement_{a}_m"]) - float(last[f"base.displacement_{a}_m"]) for a in "xz")
    label = json.loads((out / "summary.json").read_text(encoding="utf-8"))["label"]["word"]
    return x * math.cos(DIP) - z * math.sin(DIP), label


def equation_m(accelerations_g, dt_s, parts=200):
    """Newmark's block (1965) that slides down only, in steps of a 200th of the record's, which is linear between its rows."""
    slip = rate = 0.0
    step = dt_s / parts
    for a, b in zip(accelerations_g, accelerations_g[1:]):
        if rate == 0 and a <= YIELD_G and b <= YIELD_G:
            continue
        for k in range(parts):
            drive = (a + (b - a) * (k + 0.5) / parts - YIELD_G) * GRAVITY
            new = max(0.0, rate + step * drive)
            slip += 0.5 * step * (rate + new)
            rate = new
    return slip


def measure(program):
    import pyslammer

    rows = []
    for name, motion in sorted(pyslammer.sample_ground_motions().items()):
        g = [float(a) for a in motion.accel]
        exact = equation_m(g, motion.dt)
        if exact < LEAST_M:
            continue
        theirs = pyslammer.RigidAnalysis(YIELD_G, motion).max_sliding_disp
        with tempfile.TemporaryDirectory() as place:
            folder = Path(place)
            lines = [f"{i * motion.dt:.6g},{a * GRAVITY:.9g}\n" for i, a in enumerate(g)]
            (folder / "quake.csv").write_text("time_s,acceleration_m_s2\n" + "".join(lines), encoding="utf-8")
            (folder / "quake.ron").write_text(scene(motion.dt * (len(g) - 1)), encoding="utf-8")
            ours, label = slid_m(program, folder)
        rows.append([name, f"{motion.pga:.3f}", f"{exact:.5f}", f"{theirs:.5f}", f"{ours:.5f}", label])
        print(*rows[-1], flush=True)
    with KEPT.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([COLUMNS, *rows])


def table():
    with KEPT.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    lines = ["| record | peak [g] | equation [m] | pySLAMMER [m] | ndda [m] | ndda over equation − 1 | label |", "|---" * 7 + "|"]
    for row in rows:
        off = float(row["ndda_m"]) / float(row["equation_m"]) - 1
        name = row["record"].replace("_", " ")
        lines.append(f"| {name} | {row['peak_g']} | {row['equation_m']} | {row['pyslammer_m']} | {row['ndda_m']} | {off:+.2%} | {row['label']} |")
    return "\n".join(lines)


def main(words):
    if words and words != ["--check"]:
        measure(Path(words[0]).resolve())
    now = PAGE.read_text(encoding="utf-8")
    before, rest = now.split(BEGIN)
    text = f"{before}{BEGIN}\n\n{table()}\n\n{END}{rest.split(END)[1]}"
    if words == ["--check"] and text != now:
        sys.exit("docs/verification/verification.md is out of date: benches/peers/slammer.py writes it anew")
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
