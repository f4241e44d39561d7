"""The jointed column of §4.3 with small changes of dip and step: a run per row of docs/evidence/paper/ensemble.csv."""

import json
import statistics
import subprocess
import tempfile
from pathlib import Path

import results

COLUMNS = ("friction_deg", "dip_deg", "step_s", "largest_x_m", "commit")
# Friction angle, and what the paper prints [m].
PAPER_M = {"0": 1.983, "5": 1.970, "10": 1.886}
DIPS_DEG = ("57", "57.5", "58", "58.5")


def steps_s(dip_deg):
    """Steps of a dip: the scene's, and a shorter one."""
    return ("1e-4", "5e-5" if dip_deg == "58" else "7e-5")


def cases():
    return [(friction, dip, step) for friction in PAPER_M for dip in DIPS_DEG for step in steps_s(dip)]


def measure(program, folder, data):
    """Runs what the file lacks, and keeps each run once it is done."""
    rows = results.read_rows(data) if data.exists() else []
    done = {(row["friction_deg"], row["dip_deg"], row["step_s"]) for row in rows}
    for friction, dip, step in cases():
        if (friction, dip, step) in done:
            continue
        row = run(program, folder / f"column_phi{friction}.ron", friction, dip, step)
        rows.append(row)
        rows.sort(key=lambda row: cases().index((row["friction_deg"], row["dip_deg"], row["step_s"])))
        results.write_rows(data, rows, COLUMNS)
        print(f"φ = {friction}°, dip {dip}°, Δt = {step} s: {row['largest_x_m']} m", flush=True)


def run(program, scene, friction, dip, step):
    sets = {"time.step_s": step, "rock[0].joints[0].dip_deg": dip, "rock[0].joints[1].dip_deg": dip, "output.frames": 0}
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "run", scene, "--out", Path(folder) / "run", "--quiet", "--sensitivity", "never"]
        subprocess.run(command + [part for path, value in sets.items() for part in ("--set", f"{path}={value}")], check=True)
        summary = json.loads((Path(folder) / "run" / "summary.json").read_text())
    largest_m = summary["monitors"]["largest_x"]["displacement"][0]
    found = (friction, dip, step, f"{largest_m:.4f}", summary["machine"]["commit"])
    return dict(zip(COLUMNS, found))


def lines(rows):
    """Cells of the table of docs/verification/paper.md: mean and spread at each friction angle."""
    for friction, paper_m in PAPER_M.items():
        own = [float(row["largest_x_m"]) for row in rows if row["friction_deg"] == friction]
        cells = [f"{statistics.mean(own):.2f} m", f"{statistics.stdev(own) if len(own) > 1 else 0:.2f} m", f"{min(own):.2f} to {max(own):.2f} m"]
        yield [f"{friction}°", str(len(own)), *cells, f"{paper_m:.3f} m"]
