#!/usr/bin/env python3
"""ndda beside other programs on the same problems, in one run on one machine.

  benches/peers/run.py [PROBLEM ...] [--only PROGRAM ...]    all problems and all programs, or these
  benches/peers/run.py --table                               the tables from the results that there are

Problems: ramp, ramp_phi35, collision, pile_125, pile_512; programs: ndda, mujoco, rapier, yade, calculix. Each case is
run up to five times, one thread, and the fastest counts. A case prints one line of JSON; all go into
docs/evidence/peers/results.csv, where they replace those of the same problem and program, and from there into the
tables of docs/performance.md. ndda and Rapier are built by cargo, MuJoCo is installed under target/; YADE and CalculiX
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
    "problem", "program", "version", "models", "setting", "step_s", "steps", "error", "error_what", "step_cpu_s", "step_wall_s", "cpu_s", "wall_s",
    "height_m", "depth_m", "off_slope_m", "label", "runs", "load", "processor", "failed",
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
    table.write(ROOT / "docs" / "performance.md", load(), MODELS, NAMES)


def cases(name, program):
    return [(label, step_s, setting) for label, setting, steps in CASES[name][program] for step_s in steps]


def prepare(program):
    """The command that takes a problem and a setting, or none where the program is not there."""
    if program == "ndda":
        subprocess.run(["cargo", "build", "--locked", "--release", "--quiet", "-p", "ndda-cli"], cwd=ROOT, check=True)
        return [sys.executable, HERE / "peer_ndda.py"]
    if program == "rapier":
        manifest, target = HERE / "rapier" / "Cargo.toml", TARGET / "peers" / "rapier"
        subprocess.run(["cargo", "build", "--locked", "--release", "--quiet", "--manifest-path", manifest, "--target-dir", target], check=True)
        return [target / "release" / "peer-rapier"]
    if program == "mujoco":
        return [mujoco_python(), HERE / "peer_mujoco.py"]
    needs = {"yade": "yade", "calculix": "ccx"}[program]
    if not shutil.which(needs):
        print(f"left out: {program}, for there is no `{needs}`; Debian: apt install yade calculix-ccx", file=sys.stderr)
        return None
    return ["yade", "-j1", "-n", "-x", HERE / "peer_yade.py"] if program == "yade" else [sys.executable, HERE / "peer_ccx.py"]


def mujoco_python():
    venv = TARGET / "peers" / "venv"
    if not (venv / "bin" / "python").exists():
        subprocess.run([sys.executable, "-m", "venv", venv], check=True)
    subprocess.run([venv / "bin" / "pip", "install", "--quiet", "--disable-pip-version-check", MUJOCO], check=True)
    return venv / "bin" / "python"


def run_case(name, program, command, label, step_s, setting):
    """The fastest run of a case, as a row of results; it is printed, too."""
    given = problem(name)
    row = {
        "program": program, "problem": name, "setting": label, "step_s": step_s, "models": MODELS[program],
        "load": round(os.getloadavg()[0], 2), "processor": processor(),
    }
    started, best, runs = time.monotonic(), None, 0
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder, "problem.json"), Path(folder, "setting.json")]
        for path, value in zip(paths, (given, {"step_s": step_s, **setting})):
            path.write_text(json.dumps(value))
        while runs < REPEATS and time.monotonic() - started < ENOUGH_S:
            state, failed = run_once([*command, *paths])
            runs += 1
            if failed:
                row["failed"] = failed
                break
            if best is None or state["step_cpu_s"] < best["step_cpu_s"]:
                best = state
    if best:
        row["error"], row["error_what"], figures = judge(given, best)
        row |= figures | {"version": best.get("version") or rapier_version(), "runs": runs}
        row |= {"cpu_s": best["process_cpu_s"], "wall_s": best["process_wall_s"]}
        row |= {key: best.get(key) for key in ("steps", "step_cpu_s", "step_wall_s", "label")}
    print(json.dumps(row), flush=True)
    return row


def run_once(command):
    """What a program says of its end, and why it did not, if so."""
    one_thread = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    wall = time.perf_counter()
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
        run = subprocess.Popen(["timeout", str(TOO_LONG_S), *command], stdout=out, stderr=err, env={**os.environ, **one_thread})
        _, status, usage = os.wait4(run.pid, 0)
        run.returncode = os.waitstatus_to_exitcode(status)
        wall_s = time.perf_counter() - wall
        out.seek(0), err.seek(0)
        said = [line for line in out.read().splitlines() if line.startswith("{")]
        if run.returncode or not said:
            reason = " ".join(err.read().split())[-200:]
            return None, f"longer than {TOO_LONG_S} s" if run.returncode == 124 else reason or f"exit code {run.returncode}"
    state = json.loads(said[-1])
    state.setdefault("process_cpu_s", usage.ru_utime + usage.ru_stime)
    state.setdefault("process_wall_s", wall_s)
    return state, None


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
    return re.search(r'name = "rapier3d-f64"\nversion = "([^"]+)"', (HERE / "rapier" / "Cargo.lock").read_text()).group(1)


def processor():
    found = re.search(r"model name\s*: (.+)", Path("/proc/cpuinfo").read_text())
    return f"{found.group(1) if found else 'unknown'}, {os.cpu_count()} cores"


if __name__ == "__main__":
    main()
