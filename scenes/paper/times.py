"""Time to the paper's error: our settings against the paper's scheme at the paper's, run by turns, the fastest of ten.

Elapsed time is what a run says of itself (`wall_s`: reading, factoring and writing included); processor time is that of the process.
"""

import json
import os
import subprocess

import results

COLUMNS = ("problem", "setting", "step_s", "steps", "runs", "error", "limit", "wall_s", "cpu_s", "wall_ratio", "cpu_ratio", "contact_s", "blocks_s", "rest_s")
REPEATS = 10

MIDPOINT = {"time.integrator": "Midpoint()"}
VELOCITIES = {"contact.friction.shear_penalty_pa_m": "None"}
NO_FRICTION = {"contact.friction": "None", "reference.friction_deg": "0"}
RIGID_RAMP = {"blocks.ramp.body": "Fixed", "supports": "[]", "blocks.prism.body": "Rigid"}
RIGID_CUBES = {"blocks.plate.body": "Fixed", "supports": "[]", "blocks.A.body": "Rigid", "blocks.B.body": "Rigid"}
# History rows cost, and how many are written is not a matter of schemes.
ROWS = {"output.history_rows": "25"}
HELD = {f"supports[{i}].by": "Elimination" for i in range(5)}
# Errors count from here on, where the bounce of the sudden load has become small.
LATE = {"reference.after_s": "0.1"}


def step(step_s):
    return {"time.step_s": step_s}


# 0.5 s / 760: nearly as long as ω_c Δt < 2 allows. All shorter ones reach the error, too.
LONGEST = step("0.0006578947368421052")
# 0.5 s / 770: the longest that reaches the error at ten times as many rows, too, as all down to two thirds of it do (steps_30.ron).
LONGEST_30 = step("0.0006493506493506494")
# Softer, with a longer step: without friction a slide asks nothing of k_n.
SOFT_45 = {"contact.penalty_pa": "2e5"} | step("2e-3")

PAPER = "the paper's scheme"
OURS = "defaults"
# Problem: scene, what all settings share, the error that the paper prints (none: that of its scheme is the limit), settings.
# The first setting is what the others are compared with.
PROBLEMS = {
    "ramp of 45°, no friction": ("ramp_45", NO_FRICTION, 1e-4, {
        PAPER + ", Δt of Fig. 6": step("1e-5"),
        PAPER + ", Δt of Fig. 5": step("1e-4"),
        OURS: MIDPOINT | LONGEST,
        "rigid": MIDPOINT | RIGID_RAMP | LONGEST,
        OURS + ", k_n = 1e-6 E": MIDPOINT | SOFT_45,
        "rigid, k_n = 1e-6 E": MIDPOINT | RIGID_RAMP | SOFT_45,
    }),
    "ramp of 45°, φ = 35°": ("ramp_45", LATE, 1e-3, {
        PAPER: step("1e-5"),
        OURS: MIDPOINT | VELOCITIES | LONGEST,
        "rigid": MIDPOINT | VELOCITIES | RIGID_RAMP | LONGEST,
    }),
    "ramp of 30°, φ = 25°": ("ramp_30", LATE, 1e-2, {
        PAPER: step("1e-5"),
        OURS: MIDPOINT | VELOCITIES | LONGEST_30,
        "rigid": MIDPOINT | VELOCITIES | RIGID_RAMP | LONGEST_30,
    }),
    "equal cubes": ("collision", {}, None, {
        PAPER: step("1e-6"),
        OURS: MIDPOINT | HELD | step("8e-5"),
        "rigid": MIDPOINT | RIGID_CUBES | step("8e-5"),
    }),
    "unequal cubes": ("collision", {"materials[1].density_kg_m3": "1325"}, None, {
        PAPER: step("1e-6"),
        OURS: MIDPOINT | HELD | step("8e-5"),
        "rigid": MIDPOINT | RIGID_CUBES | step("8e-5"),
    }),
}


def run(program, scene, values, out):
    """Summary of a run, and its processor time [s]."""
    command = [program, "run", scene, "--out", out, "--force", "--quiet", "--threads", "1"]
    command += [part for path, value in values.items() for part in ("--set", f"{path}={value}")]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, command))} ended with {process.returncode}")
    return json.loads((out / "summary.json").read_text()), used.ru_utime + used.ru_stime


def measure(program, folder, out, problem, repeats):
    """Rows of one problem: its settings by turns."""
    scene, common, limit, settings = PROBLEMS[problem]
    fastest = {}
    for _ in range(repeats):
        for setting, values in settings.items():
            summary, cpu_s = run(program, folder / f"{scene}.ron", ROWS | common | values, out)
            best = fastest.setdefault(setting, (summary, summary["wall_s"], cpu_s))
            summary = min(summary, best[0], key=lambda s: s["wall_s"])
            fastest[setting] = (summary, summary["wall_s"], min(cpu_s, best[2]))
    first = next(iter(fastest.values()))
    limit = limit or first[0]["reference"]["error_max"]
    return [{"runs": repeats} | row(problem, setting, found, first, limit) for setting, found in fastest.items()]


def row(problem, setting, found, first, limit):
    summary, wall_s, cpu_s = found
    stages = summary["stages_s"]
    own = {"problem": problem, "setting": setting, "step_s": f"{summary['step_s']:g}", "steps": summary["steps"]}
    own |= {"error": results.number(summary["reference"]["error_max"]), "limit": f"{limit:.1e}", "wall_s": f"{wall_s:.4f}", "cpu_s": f"{cpu_s:.4f}"}
    own |= {"wall_ratio": f"{first[1] / wall_s:.1f}", "cpu_ratio": f"{first[2] / cpu_s:.1f}"}
    shares = {"contact_s": stages["contact"], "blocks_s": stages["blocks"]}
    shares["rest_s"] = wall_s - sum(shares.values())
    return own | {name: f"{value:.4f}" for name, value in shares.items()}


def measure_all(program, folder, out, repeats=REPEATS):
    rows = []
    for problem in PROBLEMS:
        rows += measure(program, folder, out, problem, repeats)
        print(f"{problem}: " + "; ".join(f"{r['setting']} {r['wall_s']} s" for r in rows if r["problem"] == problem), flush=True)
    return rows
