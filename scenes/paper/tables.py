"""Tables of docs/verification/paper.md between their markers, from the CSV of docs/evidence/paper."""

import re

import ensemble

SCHEMES = {"paper": "the paper's scheme", "Midpoint": "`Midpoint`", "GeneralizedAlpha": "`GeneralizedAlpha`"}
END = "Midpoint, contact at the end"
MARKERS = re.compile(r"(<!-- table: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "".join("| " + " | ".join(line) + " |\n" for line in lines)


def short(value):
    """Two digits, or what else stands there."""
    return f"{float(value):.1e}".replace("e-0", "e-").replace("e+0", "e") if value else "–"


def cell(row, *columns):
    """Values of a case, or that it was stopped."""
    if row is None:
        return ""
    return " / ".join(short(row[column]) for column in columns) if row["status"] == "done" else row["status"]


def picked(cases, figure):
    """Cases of a figure by what varies, scheme and start."""
    return {(row["varied"], row["scheme"], row["start"]): row for row in cases if row["figure"] == figure}


def varied(found):
    return list(dict.fromkeys(key[0] for key in found))


def collision(cases):
    found, exact = picked(cases, "fig3"), {"1": ("0", "1"), "2": ("1/3", "4/3")}
    rows = []
    for (case, scheme, _), row in found.items():
        speeds = (row["v_a_m_s"], row["v_b_m_s"], " and ".join(exact[case]))
        rows.append([case, SCHEMES[scheme], *speeds, *(short(row[key]) for key in ("along_end", "energy_gain", "momentum_lost"))])
    return table(["case", "scheme", "v_A [m/s]", "v_B [m/s]", "exact", "error", "energy gained", "momentum error"], rows)


def penalties(figure):
    """Error of the size, and along the slope, over k_n."""

    def make(cases):
        found = picked(cases, figure)
        schemes = [scheme for scheme in (*SCHEMES, END) if any(key[1] == scheme for key in found)]
        head = ["k_n", *(SCHEMES.get(scheme, "`Midpoint`, contact at the end") for scheme in schemes), "energy gained: the paper's", "`Midpoint`"]
        rows = []
        for penalty in varied(found):
            own = [found.get((penalty, scheme, "touching")) for scheme in schemes]
            gained = [cell(row, "energy_gain") for row in own[:2]]
            rows.append([penalty.removeprefix("k_n = "), *(cell(row, "size_max", "along_max") for row in own), *gained])
        return table(head, rows)

    return make


def steps(cases):
    rows = []
    for figure in ("fig5", "fig6"):
        found = picked(cases, figure)
        own = [found[("k_n = 1e-5 E", scheme, "touching")] for scheme in SCHEMES]
        rows.append([short(own[0]["step_s"]) + " s", *(cell(row, "size_max", "along_max") for row in own)])
    return table(["Δt", *SCHEMES.values()], rows)


def laws(figure):
    """Largest error over the law of friction, by scheme and start."""

    def make(cases):
        found = picked(cases, figure)
        row = lambda law, start: [law, start, *(cell(found.get((law, scheme, start)), "along_max", "along_end") for scheme in SCHEMES)]
        starts = list(dict.fromkeys(key[2] for key in found))
        return table(["friction", "start", *SCHEMES.values()], (row(law, start) for start in starts for law in varied(found)))

    return make


def angles(figure):
    """Errors over the friction angle: largest, largest after the first tenth of a second, at the end."""

    def make(cases):
        found = picked(cases, figure)
        row = lambda angle: [angle, *(cell(found.get((angle, scheme, "touching")), "along_max", "along_late", "along_end") for scheme in SCHEMES)]
        return table(["φ", *SCHEMES.values()], map(row, varied(found)))

    return make


TIMES = {
    "problem": "problem",
    "setting": "setting",
    "step_s": "Δt [s]",
    "steps": "steps",
    "runs": "runs",
    "error": "error",
    "limit": "to reach",
    "wall_s": "run [s]",
    "cpu_s": "processor [s]",
    "wall_ratio": "times quicker",
    "cpu_ratio": "… by processor",
    "contact_s": "contact [s]",
    "blocks_s": "blocks [s]",
    "rest_s": "the rest [s]",
}


def times(rows):
    return table(list(TIMES.values()), ([row[name] for name in TIMES] for row in rows))


TABLES = {"fig3": collision, "fig5": penalties("fig5"), "fig6": penalties("fig6"), "fig7": steps, "fig8": laws("fig8"), "fig9": laws("fig9")}
TABLES |= {"fig10": angles("fig10"), "fig11": angles("fig11")}


def columns(rows):
    return table(["φ", "runs", "mean", "standard deviation", "range", "the paper"], ensemble.lines(rows))


def fill(text, cases, timed, columned):
    """The text with its tables made anew."""
    others = {"times": lambda: times(timed), "ensemble": lambda: columns(columned)}

    def made(match):
        name = match[2]
        return match[1] + (others[name]() if name in others else TABLES[name](cases)) + match[3]

    return MARKERS.sub(made, text)
