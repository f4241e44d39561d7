#!/usr/bin/env python3
"""How good the error bars of `ndda certify` are on every scene of scenes/ and on three that no test knows.

  docs/evidence/certify/run.py NDDA FOLDER [SCENE ...]

NDDA is the program. Each scene is certified in FOLDER, and once more from a quarter of its step: the run of a sixteenth of the step counts as the truth. A
row of FOLDER/results.csv is written as soon as a scene is done; a scene that has its row is not done again, so the same command goes on
where it was interrupted. At the end the table of docs/guide/certify.md is printed. Scenes that take long are shortened by the values of
SHORTENED, which the table repeats. Within: quantities whose true error at the end, and the largest over time, lies in the bar, of
those that are compared; a difference that is rounding counts as within. Ratio: the median of bar over true error where that is more than rounding.
"""

import csv
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
HERE = Path(__file__).resolve().parent
TRUTH = 16
MOST_S = 300
COLUMNS = ["scene", "changed", "code", "within", "compared", "ratio", "not_converging", "chaotic", "spent_s", "said"]
# Values of scenes that would take longer than minutes.
SHORTENED = {
    "scenes/arch.ron": ["time.end_s=0.05"],
    "scenes/column_phi0.ron": ["time.end_s=0.05"],
    "scenes/column_phi10.ron": ["time.end_s=0.05"],
    "scenes/column_phi5.ron": ["time.end_s=0.05"],
    "scenes/dominoes.ron": ["time.end_s=0.1"],
    "scenes/pile_125.ron": ["time.end_s=0.1"],
    "scenes/pile_1000.ron": ["time.end_s=0.005"],
    "scenes/slope_toppling.ron": ["time.end_s=0.05"],
    "scenes/spinning_block.ron": ["time.end_s=1"],
    "scenes/sticking_30_phi35.ron": ["time.end_s=0.5"],
    "scenes/sticking_30_phi35_spring.ron": ["time.end_s=0.1"],
    "scenes/voronoi_column.ron": ["time.end_s=0.02"],
    "scenes/wedge_two_planes.ron": ["time.end_s=0.15"],
    "scenes/extreme/one_block.ron": ["blocks[0].shape.cells=(8, 8, 8)"],
    "scenes/extreme/coasting.ron": ["time.end_s=1"],
    "scenes/extreme/spin.ron": ["time.end_s=10"],
    "scenes/extreme/stack.ron": ["time.end_s=0.1"],
    "scenes/extreme/ramp_at_its_limit.ron": ["time.end_s=0.5"],
    "scenes/extreme/sudden_load_at_the_limit.ron": ["time.end_s=0.5"],
    "scenes/safety/slope_three_sets.ron": ["time.end_s=0.02"],
    "scenes/safety/slope_three_sets_wet.ron": ["time.end_s=0.02"],
    "scenes/works/boulder_terrain.ron": ["time.end_s=0.05"],
    "scenes/works/drums_shaken.ron": ["time.end_s=0.05"],
    "scenes/works/fisher_blocks.ron": ["time.end_s=2e-4"],
    "scenes/works/slope_1100_blocks.ron": ["time.end_s=4e-3"],
    "scenes/works/slope_earthquake.ron": ["time.end_s=0.5"],
    "scenes/works/voronoi_collapse.ron": ["time.end_s=2e-3"],
}


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__.strip())
    program, folder = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    results = folder / "results.csv"
    for row in each(sys.argv[3:], results, COLUMNS, lambda scene: judged(program, folder, scene)):
        print(f"{row['scene']}: {row['within']} of {row['compared']}, code {row['code']}, {row['spent_s']} s", file=sys.stderr)
    show(rows(results))


def each(names, results, columns, row_of):
    """Rows of the scenes of these names, of all without names, each kept as soon as it is done; those that are kept are not done again."""
    for scene in names or scenes():
        if scene in {row["scene"] for row in rows(results)}:
            continue
        row = row_of(scene)
        is_new = not results.exists()
        with results.open("a", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, columns)
            if is_new:
                writer.writeheader()
            writer.writerow(row)
        yield row


def scenes():
    """All scenes but studies, and those that are refused, which have stages or are rockfalls."""
    files = [*sorted((ROOT / "scenes").rglob("*.ron")), *sorted(HERE.glob("*.ron"))]
    is_scene = lambda file: not re.search(r"^ *(cases|scene|stages|rockfall):", file.read_text(encoding="utf-8"), re.MULTILINE)
    return [str(file.relative_to(ROOT)) for file in files if is_scene(file)]


def rows(results):
    return list(csv.DictReader(results.open(encoding="utf-8"))) if results.exists() else []


def ran(program, words):
    """The exit code, none where it takes longer than MOST_S, and what was said last."""
    # A group of its own, so that the runs which the program starts end with it.
    with subprocess.Popen([program, *words], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True) as began:
        try:
            said = began.communicate(timeout=MOST_S)[1]
        except subprocess.TimeoutExpired:
            os.killpg(began.pid, signal.SIGKILL)
            return None, f"takes longer than {MOST_S} s"
    lines = said.strip().splitlines()
    return began.returncode, next((line for line in lines if "error" in line), lines[-1] if lines else "")


def judged(program, folder, scene):
    began = time.time()
    sets = [word for value in SHORTENED.get(scene, []) for word in ("--set", value)]
    out = folder / scene.replace("/", "_").removesuffix(".ron")
    row = dict.fromkeys(COLUMNS, "") | {"scene": scene, "changed": " ".join(SHORTENED.get(scene, [])), "within": 0, "compared": 0}
    row["code"], row["said"] = ran(program, ["certify", str(ROOT / scene), "--quiet", "--out", str(out), *sets])
    certificate = out / "certificate.json"
    if row["code"] == 0 and certificate.exists():
        row |= compared(program, scene, sets, out, json.loads(certificate.read_text(encoding="utf-8")))
    row["spent_s"] = f"{time.time() - began:.0f}"
    return row


def compared(program, scene, sets, out, certificate):
    """Scores the bars against the shortest step of a certificate whose longest is a quarter: its runs have the same monitors."""
    first = certificate["runs"][0]
    truth = out.with_name(out.name + "_truth")
    step = ["--set", f"time.step_s={4 * first['step_s'] / TRUTH:e}"]
    code, said = ran(program, ["certify", str(ROOT / scene), "--quiet", "--out", str(truth), *sets, *step])
    words = {"not_converging": 0, "chaotic": "yes" if certificate.get("chaos") else ""}
    if code != 0:
        return words | {"said": f"truth: {said}"}
    answer, truth = (history(shortest(folder)) for folder in (out, truth))
    within, errors = 0, []
    for quantity in certificate["quantities"]:
        words["not_converging"] += quantity["behaviour"] == "spreads"
        name = quantity["name"]
        if name not in truth:
            continue
        end = abs(truth[name][-1] - quantity["value"])
        most = max(abs(a - b) for a, b in paired(answer, truth, name))
        floor = 8 * sys.float_info.epsilon * first["steps"] * TRUTH * scale(truth, name, certificate)
        for error, bar in ((end, quantity["error"]), (most, quantity["largest_error"])):
            within += error <= bar or error <= floor
            errors.append((error, bar, floor))
    ratios = sorted(bar / error for error, bar, floor in errors if error > floor)
    median = f"{ratios[len(ratios) // 2]:.1f}" if ratios else ""
    return words | {"within": within, "compared": len(errors), "ratio": median}


def scale(truth, name, certificate):
    """The largest value of a quantity's group: the components of a vector, or all energies."""
    vector = re.split("_[xyz]_", name)[0]
    energies = [other["name"] for other in certificate["quantities"] if other["unit"] == "J"]
    group = energies if name in energies else [other for other in truth if other.startswith(vector)]
    return max((abs(value) for other in group for value in truth.get(other, [])), default=0.0)


def shortest(folder):
    """The history of the run of the shortest step."""
    runs = json.loads((folder / "certificate.json").read_text(encoding="utf-8"))["runs"]
    name = min((run for run in runs if run["name"].startswith("step_")), key=lambda run: run["step_s"])["name"]
    return folder / "cases" / name / "run/history.csv"


def history(file):
    table = list(csv.reader(file.open(encoding="utf-8")))
    return {name: [float(row[i]) for row in table[1:]] for i, name in enumerate(table[0])}


def paired(answer, truth, name):
    """Values at the instants that both histories have."""
    at = {f"{t:.9e}": value for t, value in zip(truth["time_s"], truth[name])}
    return [(value, at[key]) for key, value in ((f"{t:.9e}", v) for t, v in zip(answer["time_s"], answer[name])) if key in at]


def show(found):
    print("| scene | changed | quantities within | median bar/true | not converging | chaotic | s | remark |")
    print("|---|---|---|---|---|---|---|---|")
    for row in found:
        cells = [row["scene"], row["changed"], f"{row['within']} of {row['compared']}", row["ratio"], row["not_converging"]]
        remark = row["said"] if row["code"] != "0" or row["compared"] == "0" else ""
        print("| " + " | ".join([*cells, row["chaotic"], row["spent_s"], remark]) + " |")
    within, all_ = (sum(int(row[key]) for row in found) for key in ("within", "compared"))
    if all_:
        print(f"\n{within} of {all_} true errors lie within the bar ({100 * within / all_:.1f} %).")


if __name__ == "__main__":
    main()
