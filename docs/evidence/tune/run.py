#!/usr/bin/env python3
"""How near `ndda tune` comes to the best of the seven studies: prints the table of docs/guide/certify.md.

  docs/evidence/tune/run.py NDDA [STUDY ...]

NDDA is the program. Studies whose scene has a closed form come first: both errors are against it. The others have two references, and a table of their own:
the search takes the scene's own setting at a short step, the study the two runs that it names. For each study and error, `ndda tune` searches; the setting that docs/evidence/error_time/STUDY/study.csv has
as the cheapest for that error is run by the same program on the same machine, five times, the fastest counting. Costs are processor times: of all runs of the search,
and of all runs in study.csv but the two that a study without closed form is compared with.
"""

import csv
import json
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
COLUMN = (
    'monitors=[(name: "low", block: "column_0001"), (name: "middle", block: "column_0015"), (name: "high", block: "column_0030")]'
)
# Study: scene, errors, what is set and asked for.
STUDIES = {
    "sliding_45": ("sliding_45.ron", ["1e-3"], ["--mesh"]),
    "collision": ("collision_equal_free.ron", ["1e-2", "1e-3"], ["--mesh"]),
    "bounce": ("bounce.ron", ["1e-1", "1e-2"], []),
    "bar_impact": ("studies/base/bar_impact.ron", ["1e-1"], ["--mesh"]),
    "cantilever": ("studies/base/cantilever.ron", ["1e-1"], ["--mesh"]),
    "stack": ("studies/base/stack.ron", ["1e-1", "1e-2"], []),
    "column": ("column_phi0.ron", ["1e-1", "1e-2"], ["--set", "time.end_s=0.1", "--set", COLUMN]),
}

# Studies that compare with runs at short steps, as their scenes have no closed form.
BY_RUNS = {"bounce", "column"}


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__.strip())
    program = str(Path(sys.argv[1]).resolve())
    wanted = sys.argv[2:] or list(STUDIES)
    for title, has_closed_form in (("against the closed form", True), ("against runs at short steps", False)):
        studies = [study for study in wanted if (study not in BY_RUNS) == has_closed_form]
        if studies:
            print(f"\n| study | error {title} | tuned: error, time [s] | best of the study [s] | ratio | cost of tuning [s] | of the study [s] |")
            print("|---|---|---|---|---|---|---|")
        for study in studies:
            scene, errors, options = STUDIES[study]
            for error in errors:
                print(row(program, study, scene, error, options), flush=True)


def row(program, study, scene, error, options):
    cases = list(csv.DictReader((ROOT / f"docs/evidence/error_time/{study}/study.csv").open(encoding="utf-8")))
    done = [case for case in cases if case["status"] == "done"]
    times = lambda case: [float(s) for s in case["processors_s"].split()]
    cost = sum(sum(times(case)) for case in done)
    reached = [case for case in done if float(case["error_max"]) <= float(error)]
    best = min(reached, key=lambda case: min(times(case)))["case"]
    with tempfile.TemporaryDirectory() as folder:
        words = ["tune", str(ROOT / "scenes" / scene), "--error", error, "--json", "--quiet", "--out", f"{folder}/tuned", *options]
        said = subprocess.run([program, *words], capture_output=True, text=True)
        if not said.stdout.startswith("{"):
            return f"| {study} | {error} | {said.stderr.strip()} |"
        tuned = json.loads(said.stdout)
        words = ["study", "case", str(ROOT / f"scenes/studies/{study}.ron"), best, "--quiet", "--out", f"{folder}/study"]
        subprocess.run([program, *words], check=True)
        record = json.loads(Path(folder, "study/cases", best, "case.json").read_text(encoding="utf-8"))
    best_s = min(record["outcome"]["Done"]["processors_s"])
    found = tuned["best"]
    label = found["label"] + f", {found['step_s']:.3g} s"
    return (
        f"| {study} | {error} | {label}: {found['error']:.1e}, {found['time_s']:.3f} | {best_s:.3f} | {found['time_s'] / best_s:.2f} "
        f"| {tuned['spent_s']:.1f} | {cost:.0f} |"
    )


if __name__ == "__main__":
    main()
