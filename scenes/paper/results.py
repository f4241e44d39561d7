"""What the studies of the paper's figures have found, as CSV: a row per case, and curves over time per figure."""

import csv
import json
import math

FIGURES = ("fig3", "fig5", "fig6", "fig8", "fig9", "fig10", "fig11")
DENSITIES_KG_M3 = {"1": (2650, 2650), "2": (2650, 1325)}
GRAVITY_M_S2 = 9.8
# Largest errors count from here on: near here the paper's curves begin, and later the bounce of the sudden load has faded.
AFTER_S = (0.02, 0.1)
# Errors swing: that at the end is the largest of so much of it.
END_S = 0.02
COLUMNS = ("figure", "varied", "scheme", "start", "status", "step_s", "along_end", "along_max", "size_max", "along_late", "size_late",
           "energy_gain", "momentum_lost", "h", "v_a_m_s", "v_b_m_s", "wall_s")


def gather(study_folder, name):
    """Rows of cases.csv, and curves: a list of (label, times, values)."""
    study = json.loads((study_folder / "study.json").read_text())
    rows, curves = [], []
    for case in study["cases"]:
        labels = dict(case["labels"])
        scheme, start = labels.pop("scheme"), labels.pop("start", "touching" if name != "fig3" else "")
        varied = next(iter(labels.values()))
        results = study_folder / "cases" / case["name"] / "run"
        summary = json.loads((results / "summary.json").read_text())
        with open(results / "history.csv", newline="") as file:
            history = list(csv.DictReader(file))
        row = {"figure": name, "varied": varied, "scheme": scheme, "start": start, "status": summary["status"]}
        row |= {"step_s": number(summary["step_s"]), "wall_s": f"{summary['wall_s']:.3f}", "h": number(summary["invariants"]["max_h"])}
        row["energy_gain"] = number(summary["invariants"]["energy_gain"])
        row["momentum_lost"] = number(summary["invariants"]["linear_momentum"])
        own = momentum(history, varied) if name == "fig3" else slide(history, name, varied)
        if summary["status"] == "done":
            row |= velocities(history, summary) if name == "fig3" else errors(own)
        rows.append(row)
        if name == "fig3":
            names = ("A", "B", "total")
            curves += [(f"{varied} | {scheme} | {n}", own[0], values) for n, values in zip(names, own[1:])]
        else:
            curves.append((" | ".join(filter(None, (varied, scheme, start))), own[0], own[2]))
    return rows, curves


def number(value):
    return f"{value:.3e}"


def column(history, name):
    return [float(row[name]) for row in history]


def slope(name):
    """Slope of a figure's ramp [°]."""
    return 30 if name in ("fig9", "fig11") else 45


def friction(name, varied):
    """Friction angle of a case [°]."""
    if name in ("fig10", "fig11"):
        return float(varied.rstrip("°"))
    return {"fig8": 35, "fig9": 25}.get(name, 0)


def slide(history, name, varied):
    """Time, error along the slope and error of the size of the displacement of the prism's centre, both over eq (20)'s S."""
    alpha = math.radians(slope(name))
    down = (math.cos(alpha), 0, -math.sin(alpha))
    rate = 0.5 * GRAVITY_M_S2 * (math.sin(alpha) - math.tan(math.radians(friction(name, varied))) * math.cos(alpha))
    axes = [column(history, f"centre.displacement_{axis}_m") for axis in "xyz"]
    times, along, size = [], [], []
    for time_s, *moved in zip(column(history, "time_s"), *axes):
        if time_s >= 0.999 * AFTER_S[0]:
            slid = rate * time_s**2
            times.append(time_s)
            along.append(sum(a * b for a, b in zip(moved, down)) / slid - 1)
            size.append(math.hypot(*moved) / slid - 1)
    return times, along, size


def errors(own):
    """Errors at the end and the largest from AFTER_S on."""
    times, along, size = own
    largest = lambda values, after: max((abs(v) for t, v in zip(times, values) if t >= 0.999 * after), default=math.nan)
    found = {"along_end": largest(along, times[-1] - END_S), "along_max": largest(along, AFTER_S[0]), "size_max": largest(size, AFTER_S[0])}
    found |= {"along_late": largest(along, AFTER_S[1]), "size_late": largest(size, AFTER_S[1])}
    return {key: number(value) for key, value in found.items()}


def momentum(history, case):
    """Time, and momentum of A, of B and of both along the line of motion [kg m/s]; the cubes are 1 m³."""
    of_a, of_b = ([rho * v for v in column(history, f"centre_{name}.velocity_x_m_s")] for name, rho in zip("AB", DENSITIES_KG_M3[case]))
    return column(history, "time_s"), of_a, of_b, [a + b for a, b in zip(of_a, of_b)]


def velocities(history, summary):
    """Velocities of A and B at the end [m/s], and their error over the relative speed."""
    of_a, of_b = (block["velocity"][0] for block in list(summary["blocks"].values())[:2])
    return {"v_a_m_s": f"{of_a:.6f}", "v_b_m_s": f"{of_b:.6f}", "along_end": number(summary["reference"]["error_end"])}


def write_rows(path, rows, columns=COLUMNS):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def read_rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def write_curves(path, curves):
    """One column per curve; a run that stopped early has none in the end."""
    times = max((curve[1] for curve in curves), key=len)
    with open(path, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["time_s", *(label for label, *_ in curves)])
        for i, time_s in enumerate(times):
            writer.writerow([f"{time_s:.4g}", *(number(values[i]) if i < len(values) else "" for _, _, values in curves)])


def read_curves(path):
    """Times, and values by label."""
    with open(path, newline="") as file:
        head, *rows = csv.reader(file)
    of = lambda i: [float(row[i]) if row[i] else math.nan for row in rows]
    return of(0), {label: of(i) for i, label in enumerate(head) if i > 0}
