#!/usr/bin/env python3
"""Whether scenes that are labelled accurate stay so with half the step and from a slightly different start: docs/verification/stability.md.

  docs/evidence/label/scenes.py [NDDA [SCENE ...]] [--limit SECONDS]    (default: target/release/ndda, all scenes, 300 s)

Runs every scene as it is with `--sensitivity always`, which repeats an accurate run from a start that differs by 1e-4 of the largest speed, a hundred thousand times
1e-9, and with half the step. What is no longer accurate then is run as users run it; where its label is still accurate, it does not survive. Scenes without contact and
those in stages, which that option does not repeat, are run again with half the step here: velocities of blocks and monitors must agree to 1 % of the largest speed, and
displacements to 1 % of the largest. Keeps a row of each scene in scenes.csv beside this script; those that take longer than the limit are not judged.
"""

import argparse
import csv
import json
import math
import subprocess
import tempfile
import time
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
KEPT = Path(__file__).resolve().parent / "scenes.csv"
COLUMNS = ["scene", "found", "label", "reason", "spent_s"]
REPEATED = ("a start that differs", "a run with half the step", "a second run")


def summary_of(ndda, scene, sensitivity, limit_s, *changes):
    """What a run says, with the largest kinetic energy of its history; none if it takes too long, and empty if it is no run."""
    with tempfile.TemporaryDirectory() as folder:
        command = [ndda, "run", str(scene), "--out", f"{folder}/out", "--quiet", "--threads", "1", "--sensitivity", sensitivity, "--set", "output.frames=0"]
        for change in changes:
            command += ["--set", change]
        try:
            subprocess.run(command, check=False, capture_output=True, timeout=limit_s)
        except subprocess.TimeoutExpired:
            return None
        file = Path(folder, "out", "summary.json")
        if not file.exists():
            return {}
        summary = json.loads(file.read_text(encoding="utf-8"))
        with Path(folder, "out", "history.csv").open(encoding="utf-8") as rows:
            summary["kinetic_j"] = max((float(row["kinetic_j"]) for row in csv.DictReader(rows)), default=0.0)
        return summary


def motions(summary):
    """Displacement [m] and velocity [m/s] of each block and monitor at the end."""
    blocks = {name: (block["displacement_m"], block["velocity"]) for name, block in summary["blocks"].items()}
    monitors = {f"monitor {name}": (at["displacement"], at["velocity"]) for name, at in summary["monitors"].items()}
    return {**blocks, **monitors}


def apart(summary, other):
    """Largest difference of two runs: over the largest displacement, and over the largest speed, of the end, of the row of most energy or on average."""
    mine, theirs = motions(summary), motions(other)
    mass = sum(block["mass"] for block in summary["blocks"].values())
    scales = [max((math.hypot(*motion[k]) for motion in mine.values()), default=0.0) for k in range(2)]
    scales[1] = max(scales[1], math.sqrt(2 * summary["kinetic_j"] / mass), scales[0] / summary["end_s"])
    parts = [math.dist(motion[k], theirs[name][k]) / scales[k] for name, motion in mine.items() for k in range(2) if scales[k] > 0]
    return max(parts, default=0.0)


def half_the_step(ndda, scene, summary, limit_s):
    """Whether a run stays what it is with half the step, and by how much it differs."""
    other = summary_of(ndda, scene, "never", limit_s, f"time.step_s={summary['step_s'] / 2!r}")
    if not other:
        return "accurate, not repeated", ""
    part = apart(summary, other)
    return ("stays accurate" if part <= 0.01 else "does not survive"), f"with half the step by {part:.1e}"


def row(ndda, scene, limit_s):
    began = time.monotonic()
    summary = summary_of(ndda, scene, "always", limit_s)
    found, label, reason = "not judged: too long", "", ""
    if summary == {}:
        found = "no run"
    elif summary is not None:
        label, reason = summary["label"]["word"], "; ".join(summary["label"]["reasons"])
        repeated = any(stage == "sensitivity" for stage in summary["stages_s"])
        if label == "accurate":
            found = "stays accurate"
            if not repeated:
                found, reason = half_the_step(ndda, scene, summary, limit_s)
        elif not reason.startswith(REPEATED):
            found = "not accurate by itself"
        else:
            usual = summary_of(ndda, scene, "auto", limit_s)
            is_found = usual is not None and usual["label"]["word"] != "accurate"
            found = "found by ndda run" if is_found else "does not survive"
    name = str(scene.relative_to(ROOT / "scenes"))
    return dict(zip(COLUMNS, [name, found, label, reason, f"{time.monotonic() - began:.0f}"]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("ndda", nargs="?", default=str(ROOT / "target" / "release" / "ndda"))
    parser.add_argument("--limit", type=float, default=300, metavar="SECONDS")
    parser.add_argument("scenes", nargs="*", type=Path)
    args = parser.parse_args()
    scenes = args.scenes or sorted((ROOT / "scenes").rglob("*.ron"))
    kept = {}
    if KEPT.exists():
        with KEPT.open(encoding="utf-8") as file:
            kept = {row["scene"]: row for row in csv.DictReader(file)}
    for scene in scenes:
        found = row(str(Path(args.ndda).resolve()), scene.resolve(), args.limit)
        kept[found["scene"]] = found
        print(f"{found['scene']}: {found['found']} ({found['label']}, {found['spent_s']} s) {found['reason'][:100]}", flush=True)
        with KEPT.open("w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(kept[name] for name in sorted(kept))
    counts = Counter(known["found"] for known in kept.values())
    print("; ".join(f"{found}: {count}" for found, count in sorted(counts.items())))


if __name__ == "__main__":
    main()
