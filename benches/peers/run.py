#!/usr/bin/env python3
"""ndda beside other programs on the same problems, in one run on one machine.

  benches/peers/run.py [PROBLEM ...] [--only PROGRAM ...]    all problems and all programs, or these
  benches/peers/run.py --table                               the tables from the results that there are

Problems: ramp, ramp_phi35, collision, pile_125, pile_512; programs: ndda, mujoco, rapier, yade, calculix. Each case is
run up to five times, one thread, and the fastest counts. A case prints one line of JSON; all go into
docs/evidence/peers/results.csv, where they replace those of the same problem and program, and from there into the
tables of docs/verification/performance.md. ndda and Rapier are built by cargo, MuJoCo is installed under target/; YADE and CalculiX
must be there (Debian: apt install yade calculix-ccx) or are left out.
"""

import argparse
import csv
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import table
import timed
from cases import CASES
from problems import NAMES, judge, problem

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
RESULTS = ROOT / "docs" / "evidence" / "peers" / "results.csv"
MUJOCO = "mujoco==4.0.0"
MODELS = {
    "ndda": "rigid or elastic blocks, penalty on what they share",
    "mujoco": "rigid bodies, soft constraints solved for in each step",
    "rapier": "rigid bodies, impulses by iteration",
    "yade": "rigid polyhedra, penalty on the shared volume",
    "calculix": "elastic finite elements, penalty between faces",
}
COLUMNS = (
    "problem",
    "program",
    "version",
    "models",
    "setting",
    "step_s",
    "steps",
    "error",
    "error_what",
    "step_cpu_s",
    "step_wall_s",
    "cpu_s",
    "wall_s",
    "height_m",
    "depth_m",
    "off_slope_m",
    "label",
    "runs",
    "load",
    "processor",
    "failed",
)
REPEATS = 5
# No further run of a case that has taken this long together, and none that takes longer alone [s].
ENOUGH_S, TOO_LONG_S = 5, 300


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("problem", nargs="*", metavar="PROBLEM")
    parser.add_argument("--only", action="append", choices=MODELS, metavar="PROGRAM")
    parser.add_argument("--table", action="store_true")
    options = parser.parse_args()
    if unknown := [name for name in options.problem if name not in NAMES]:
        parser.error(f"no problem {', '.join(unknown)}; there are {', '.join(NAMES)}")
    if not options.table:
        commands = {name: command for name in options.only or MODELS if (command := prepare(name))}
        for name in options.problem or NAMES:
            for program, command in commands.items():
                if program in CASES[name]:
                    keep(name, program, [run_case(name, program, command, *case) for case in cases(name, program)])
    table.write(ROOT / "docs" / "verification" / "performance.md", load(), MODELS, NAMES)


def cases(name, program):
    return [(label, step_s, setting) for label, setting, steps in CASES[name][program] for step_s in steps]


def prepare(program):
    """The command that takes a problem and a setting, or none where the program is not there."""
    if program == "ndda":
        subprocess.run(["cargo", "build", "--locked", "--release", "--quiet", "-p", "ndda-cli"], cwd=ROOT, check=True)
        return [sys.executable, HERE / "peer_ndda.py"]
    if program == "rapier":
        manifest, target = HERE / "rapier" / "Cargo.toml", TARGET / "peers" / "rapier"
        subprocess.run(
            ["cargo", "build", "--locked", "--release", "--quiet", "--manifest-path", manifest, "--target-dir", target],
            check=True,
        )
        return [target / "release" / "peer-rapier"]
    if program == "mujoco":
        return [mujoco_python(), HERE / "peer_mujoco.py"]
    needs = {"yade": "yade", "calculix": "ccx"}[program]
    if not shutil.which(needs):
        print(f"left out: {program}, for there is no `{needs}`; Debian: apt install yade calculix-ccx", file=sys.stderr)
        return None
    return (
        ["yade", "-j1", "-n", "-x", HERE / "peer_yade.py"]
        if program == "yade"
        else [sys.executable, HERE / "peer_ccx.py"]
    )


def mujoco_python():
    venv = TARGET / "peers" / "venv"
    if not (venv / "bin" / "python").exists():
        subprocess.run([sys.executable, "-m", "venv", venv], check=True)
    subprocess.run([venv / "bin" / "pip", "install", "--quiet", "--disable-pip-version-check", MUJOCO], check=True)
    return venv / "bin" / "python"


def run_case(name, program, command, label, step_s, setting):
    """The least times of a case, as a row of results; it is printed, too."""
    given, load = problem(name), os.getloadavg()[0]
    states, failed = run_often(command, given, {"step_s": step_s, **setting})
    row = {"program": program, "problem": name, "setting": label, "step_s": step_s, "models": MODELS[program]}
    row |= {"load": round(load, 2), "processor": processor(), "runs": len(states), "failed": failed}
    if states:
        row["error"], row["error_what"], figures = judge(given, states[0])
        row |= figures | {"version": states[0].get("version") or rapier_version()}
        row |= {key: states[0].get(key) for key in ("steps", "label")}
        row |= {key: min(state[key] for state in states) for key in ("step_cpu_s", "step_wall_s", "cpu_s", "wall_s")}
    print(json.dumps(row), flush=True)
    return row


def run_often(command, given, setting):
    """What a program said of the end of each run, and why one failed, if so."""
    started, states = time.monotonic(), []
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder, "problem.json"), Path(folder, "setting.json")]
        for path, value in zip(paths, (given, setting)):
            path.write_text(json.dumps(value))
        while len(states) < REPEATS and time.monotonic() - started < ENOUGH_S:
            state, failed = run_once([*command, *paths])
            if failed:
                return [], failed
            states.append(state)
    return states, None


def run_once(command):
    """What a program says of its end, and why it did not, if so."""
    one_thread = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    ended = timed.run(["timeout", str(TOO_LONG_S), *command], env={**os.environ, **one_thread})
    said = [line for line in ended.out.splitlines() if line.startswith("{")]
    if ended.code == 124:
        return None, f"longer than {TOO_LONG_S} s"
    if ended.code or not said:
        return None, " ".join(ended.err.split())[-200:] or f"exit code {ended.code}"
    return {"cpu_s": ended.cpu_s, "wall_s": ended.wall_s} | json.loads(said[-1]), None


def keep(name, program, rows):
    others = [row for row in load() if (row["problem"], row["program"]) != (name, program)]
    RESULTS.parent.mkdir(parents=True, exist_ok=True)
    order = {key: place for place, key in enumerate((p, q) for p in NAMES for q in MODELS)}
    rows = sorted(others + rows, key=lambda row: order[row["problem"], row["program"]])
    with open(RESULTS, "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows({key: short(value) for key, value in row.items()} for row in rows)


def load():
    if not RESULTS.exists():
        return []
    with open(RESULTS, newline="") as file:
        return list(csv.DictReader(file))


def short(value):
    return f"{value:.4g}" if isinstance(value, float) else value


def rapier_version():
    return re.search(r'name = "rapier3d-f64"\nversion = "([^"]+)"', (HERE / "rapier" / "Cargo.lock").read_text()).group(
        1
    )


def processor():
    found = re.search(r"model name\s*: (.+)", Path("/proc/cpuinfo").read_text())
    return f"{found.group(1) if found else 'unknown'}, {os.cpu_count()} cores"


if __name__ == "__main__":
    main()
