"""The tables of docs/verification/performance.md that come from the results of run.py."""

import math
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "docs" / "evidence"))
from error_and_time import between, table

TITLES = {
    "ramp": "Ramp of 45°, φ = 0",
    "ramp_phi35": "Ramp of 45°, φ = 35°",
    "collision": "Collision of two cubes",
    "pile_125": "Pile of 125 cubes",
    "pile_512": "Pile of 512 cubes",
}
TARGETS = {"ramp": (2e-3, 2e-4, 1e-6), "ramp_phi35": (1e-2, 2e-3, 5e-4), "collision": (1e-2, 1e-3, 1e-5)}


def write(page, rows, models, problems):
    """Puts the tables between their marks."""
    parts = [section(problem, [row for row in rows if row["problem"] == problem], models) for problem in problems]
    loads = [float(row["load"]) for row in rows]
    if loads:
        parts.append(f"{'; '.join(sorted({row['processor'] for row in rows}))}; load {min(loads):.1f} to {max(loads):.1f} meanwhile.")
    page.write_text(between(page.read_text(), "the peers", "\n\n".join(part for part in parts if part)))


def section(problem, rows, models):
    if not rows:
        return ""
    tables = [time_to_error(problem, rows, models), settings(problem, rows)]
    return "\n\n".join([f"### {TITLES[problem]}", *(made for made in tables if made)])


def time_to_error(problem, rows, models):
    """Least processor time of the steps to an error that all shorter steps of the setting keep, too."""
    if problem not in TARGETS:
        return ""
    header = ["time [ms] to error, steps / whole program (over ndda's)"]
    header += [f"{target:.0e}".replace("e-0", "e-") for target in TARGETS[problem]]
    lines = []
    ours = [row for row in rows if row["program"] == "ndda"]
    for program in models:
        own = [row for row in rows if row["program"] == program]
        if own:
            reached = [(fastest(own, target), fastest(ours, target)) for target in TARGETS[problem]]
            lines.append([f"{program} {version(own)}", *(times(*pair) for pair in reached)])
    return table(header, lines)


def fastest(rows, target):
    within = [row for row in rows if all(accurate(other, target) for other in as_fine(rows, row))]
    return min(within, key=lambda row: float(row["step_cpu_s"]), default=None)


def as_fine(rows, row):
    return [
        other for other in rows if other["setting"] == row["setting"] and float(other["step_s"]) <= float(row["step_s"])
    ]


def accurate(row, target):
    """ndda's own label counts, too: a run that it calls inaccurate has no error to speak of."""
    return not row["failed"] and float(row["error"]) <= target and row["label"] in ("", "accurate")


def version(rows):
    return next((row["version"].split(" ")[0] for row in rows if row["version"]), "")


def times(row, ours):
    if not row:
        return "not reached"
    over = [f"{float(row[key]) / float(ours[key]):.2g}" for key in ("step_cpu_s", "cpu_s")] if ours else []
    return f"{milliseconds(row['step_cpu_s'])} / {milliseconds(row['cpu_s'])}" + (
        f" ({' / '.join(over)})" if over else ""
    )


def settings(problem, rows):
    """Every case, program by program."""
    pile = problem.startswith("pile")
    columns = [
        "program",
        "setting",
        "Δt [s]",
        "energy gained" if pile else "error",
        "steps, processor [ms]",
        "steps, wall [ms]",
        "program, processor [ms]",
        "wall [ms]",
    ]
    columns += ["centre of mass at the end [m]", "deepest corner at the end [mm]", "label"] if pile else []
    lines = []
    for row in rows:
        cells = [row["program"], row["setting"], f"{float(row['step_s']):g}"]
        if row["failed"]:
            cells += [f"failed: {re.sub(r'[|]', '/', row['failed'])[-80:]}"] + [""] * (len(columns) - 4)
        else:
            cells += [f"{float(row['error']):.1e}"] + [
                milliseconds(row[key]) for key in ("step_cpu_s", "step_wall_s", "cpu_s", "wall_s")
            ]
            cells += (
                [f"{float(row['height_m']):.3f}", f"{1e3 * float(row['depth_m']):.1f}", row["label"]] if pile else []
            )
        lines.append(cells)
    return table(columns, lines)


def milliseconds(seconds):
    value = 1e3 * float(seconds)
    digits = max(0, 1 - math.floor(math.log10(value))) if value > 0 else 0
    return f"{value:.{digits}f}"
