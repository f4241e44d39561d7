#!/usr/bin/env python3
"""What a part costs a scene that does not need it, in instructions.

  docs/evidence/leaving_out.py [NDDA]     (default: target/release/ndda; needs valgrind)

Each case runs a scene with the part absent and with it present but idle, for two numbers of steps: the difference of the two is
what steps cost, without reading and setting up. Writes docs/evidence/leaving_out/cost.csv and the table in docs/verification/leaving-out.md, and
fails if an idle part costs more than 1 % of the steps.
"""
import csv
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "verification" / "leaving-out.md"
TABLE = ROOT / "docs" / "evidence" / "leaving_out" / "cost.csv"
MOST = 0.01
MARKS = ("<!-- table -->\n", "<!-- end of table -->\n")

# Two cubes of 384 tetrahedra that slide over a plate, and two that never meet.
SCENE = """(
    title: "idle", time: (step_s: 1e-4, end_s: 1), gravity_m_s2: (0, 0, GRAVITY),
    materials: [(name: "rock", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
    blocks: [
        (name: "plate", material: "rock", shape: Box(size_m: (4, 2, 0.5), cells: (8, 4, 1)), at_m: (-0.5, -0.5, HEIGHT)),
        (name: "a", material: "rock", shape: Box(size_m: (1, 1, 1), cells: (4, 4, 4)), velocity_m_s: (1, 0, 0)),
        (name: "b", material: "rock", shape: Box(size_m: (1, 1, 1), cells: (4, 4, 4)), at_m: (1.5, 0, 0)),
    ],
    supports: [(block: "plate", on: All, hold: Fixed)],
    contact: Potential(penalty_pa: 2e7),
    output: (frames: 0, history_rows: 1, checkpoint_wall_s: 1e6),
)
"""
# Name of the part, scene (resting, apart or falling), settings without it, settings with it idle.
CASES = [
    ("friction of 0°, on velocities", "resting", [], ["contact.friction=(friction_deg: 0)"]),
    ("friction of 0°, by springs", "resting", [], ["contact.friction=(friction_deg: 0, shear_penalty_pa_m: 1e9)"]),
    ("damping of 0", "resting", [], ["materials.rock.damping=(mass_per_s: 0, stiffness_s: 0)"]),
    ("an initial stress of 0", "resting", [], ["in_situ=(stress_pa: ())"]),
    (
        "a traction that is 0 all the time",
        "resting",
        [],
        ['tractions=[(block: "a", on: Set("z_max"), traction_pa: (0, 0, -1e3), factor: [(time_s: 0, factor: 0), (time_s: 9, factor: 0)])]'],
    ),
    ("a monitor", "resting", [], ['monitors=[(name: "a", block: "a")]']),
    ("contacts and reactions in the history", "resting", [], ["output.contacts=true", "output.reactions=true"]),
    ("checkpoints once a minute", "resting", [], ["output.checkpoint_wall_s=60"]),
]
# Parts that have to watch, whether or not anything comes of it: their cost is said, not judged.
WATCHES = [
    ("contact, watching blocks that never meet", "apart", ["contact=Off"], []),
    ("the same, while they fall", "falling", ["contact=Off"], []),
    ("control of steps that are never divided", "resting", [], ["time.step=Auto()"]),
]
STEPS = (100, 500)


def instructions(ndda, scene, settings, steps):
    """Instructions of a whole run."""
    with tempfile.TemporaryDirectory() as folder:
        command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
        command += [ndda, "run", scene, "--out", f"{folder}/out", "--quiet", "--threads", "1", "--sensitivity", "never"]
        for setting in [*settings, f"time.end_s={steps * 1e-4}"]:
            command += ["--set", setting]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    found = re.search(r"Collected : (\d+)", done.stderr)
    if done.returncode != 0 or not found:
        sys.exit(f"{' '.join(command)}\n{done.stderr}")
    return int(found.group(1))


def measure(ndda, folder):
    """Rows of part, instructions per step without it and with it."""
    scenes = {}
    for name, gravity, height in (("resting", "-9.8", "-0.5001"), ("apart", "0", "-30"), ("falling", "-9.8", "-30")):
        scenes[name] = Path(folder) / f"{name}.ron"
        scenes[name].write_text(SCENE.replace("GRAVITY", gravity).replace("HEIGHT", height), encoding="utf-8")
    known = {}

    def per_step(scene, settings):
        key = (scene, *settings)
        if key not in known:
            short, long = (instructions(ndda, scenes[scene], settings, steps) for steps in STEPS)
            known[key] = (long - short) / (STEPS[1] - STEPS[0])
        return known[key]

    for part, scene, without, idle in CASES + WATCHES:
        yield part, scene, per_step(scene, without), per_step(scene, idle)


def main():
    ndda = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "target" / "release" / "ndda")
    with tempfile.TemporaryDirectory() as folder:
        rows = list(measure(ndda, folder))
    TABLE.parent.mkdir(parents=True, exist_ok=True)
    with TABLE.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["part", "scene", "instructions_per_step_without", "instructions_per_step_idle", "cost"])
        writer.writerows([part, scene, f"{a:.0f}", f"{b:.0f}", f"{b / a - 1:.5f}"] for part, scene, a, b in rows)
    lines = ["| part that has nothing to do, or only to watch | instructions a step without it | cost |\n", "|---|---|---|\n"]
    lines += [f"| {part} | {a / 1e6:.3f} million | {100 * (b / a - 1):.2f} % |\n" for part, _, a, b in rows]
    head, rest = PAGE.read_text(encoding="utf-8").split(MARKS[0])
    PAGE.write_text(head + MARKS[0] + "".join(lines) + MARKS[1] + rest.split(MARKS[1])[1], encoding="utf-8")
    print("".join(lines), end="")
    costly = [part for part, _, a, b in rows[: len(CASES)] if b / a - 1 > MOST]
    sys.exit(f"more than {100 * MOST:.0f} %: {', '.join(costly)}" if costly else 0)


if __name__ == "__main__":
    main()
