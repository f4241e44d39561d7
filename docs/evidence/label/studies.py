#!/usr/bin/env python3
"""Whether cases of studies that are labelled accurate stay so with half the step and from a slightly different start: docs/verification/stability.md.

  docs/evidence/label/studies.py [NDDA [STUDY ...]]    (default: target/release/ndda, all of scenes/studies and scenes/paper)

Runs each case of a study twice: as `ndda study` does, and with `--second-runs always`, which repeats each accurate run from a start that differs by 1e-4 of the largest
speed, a hundred thousand times 1e-9, and with half the step. Keeps a row of each study in studies.csv beside this script, with the cases that lose their label.
"""

import argparse
import csv
import json
import re
import subprocess
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
KEPT = Path(__file__).resolve().parent / "studies.csv"
COLUMNS = ["study", "cases", "accurate", "stay accurate", "lose the label", "spent_s"]


def labels(ndda, study, second_runs):
    """Label of each case that has one."""
    with tempfile.TemporaryDirectory() as folder:
        command = [ndda, "study", str(study), "--out", folder, "--quiet", "--json", "--second-runs", second_runs]
        done = subprocess.run(command, check=False, capture_output=True, text=True)
        if not done.stdout:
            raise SystemExit(f"{study}: {done.stderr}")
        cases = json.loads(done.stdout)["cases"]
    if "figures" not in cases[0]:
        return {}
    return {case["name"]: case["figures"]["label"]["word"] if case["figures"] else "" for case in cases}


def row(ndda, study):
    began = time.monotonic()
    # Once each: times do not matter here.
    text = study.read_text(encoding="utf-8")
    text = re.sub(r"^    repeats: \d+,\n", "", text, flags=re.M).replace("    axes:", "    repeats: 1,\n    axes:", 1)
    text = re.sub(r'scene: "(.*)"', lambda found: f'scene: "{study.parent / found[1]}"', text, count=1)
    with tempfile.TemporaryDirectory() as folder:
        once = Path(folder, study.name)
        once.write_text(text, encoding="utf-8")
        usual, always = (labels(ndda, once, second_runs) for second_runs in ("auto", "always"))
    accurate = [name for name, word in usual.items() if word == "accurate"]
    lost = [name for name in accurate if always[name] != "accurate"]
    found = [study.relative_to(ROOT / "scenes"), len(usual), len(accurate), len(accurate) - len(lost), " ".join(lost)]
    return dict(zip(COLUMNS, [*map(str, found), f"{time.monotonic() - began:.0f}"]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("ndda", nargs="?", default=str(ROOT / "target" / "release" / "ndda"))
    parser.add_argument("studies", nargs="*", type=Path)
    args = parser.parse_args()
    studies = args.studies or sorted([*(ROOT / "scenes/studies").glob("*.ron"), *(ROOT / "scenes/paper").glob("*.ron")])
    kept = {}
    if KEPT.exists():
        with KEPT.open(encoding="utf-8") as file:
            kept = {row["study"]: row for row in csv.DictReader(file)}
    for study in studies:
        if "    axes:" not in study.read_text(encoding="utf-8"):
            continue
        found = row(str(Path(args.ndda).resolve()), study.resolve())
        kept[found["study"]] = found
        print("; ".join(f"{column}: {value}" for column, value in found.items()), flush=True)
        with KEPT.open("w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(kept[name] for name in sorted(kept))


if __name__ == "__main__":
    main()
