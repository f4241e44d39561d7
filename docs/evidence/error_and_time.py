#!/usr/bin/env python3
"""Writes the tables of docs/guide/error-and-time.md from the results kept in docs/evidence/error_time.

Usage: error_and_time.py [--check]      (after docs/evidence/error_time/run.sh, which calls it; --check fails where the page says otherwise)
"""

import csv
import re
import sys
from pathlib import Path

DOCS = Path(__file__).resolve().parent.parent
KEPT = DOCS / "evidence" / "error_time"
PAGE = DOCS / "guide" / "error-and-time.md"
BEGIN, END = "<!-- tables of {}: begin -->", "<!-- tables of {}: end -->"


def read(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|---" * len(header) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def times(folder):
    """A row per curve: the time to each largest error, and how often that of the fastest it is."""
    cells = [row for row in read(folder / "time_to_error.csv") if row["of"] == "max"]
    # An error of more than all there is says nothing of accuracy.
    errors = [error for error in dict.fromkeys(row["error"] for row in cells) if float(error) <= 1]
    found = {(row["curve"], row["error"]): row for row in cells}

    def cell(curve, error):
        row = found[curve, error]
        if row["time_s"] == "not reached":
            return "not reached"
        text = f"{float(row['time_s']):.2g} ({float(row['relative']):.1f})"
        return f"**{text}**" if float(row["relative"]) == 1 else text

    curves = dict.fromkeys(row["curve"] for row in cells)
    return table(["time [s] to error", *errors], [[curve, *(cell(curve, error) for error in errors)] for curve in curves])


def front(folder):
    """The settings that no other beats in both largest error and time."""
    cases = read(folder / "study.csv")
    columns = list(cases[0])
    axes = columns[1 : columns.index("status")]
    rows = [row for row in cases if row["front_max"] == "true" and float(row["error_max"]) <= 1]
    rows.sort(key=time_s)
    rows = [[*(row[axis] for axis in axes), f"{float(row['error_max']):.1e}", f"{time_s(row):.2g}"] for row in rows]
    return table([*axes, "largest error", "time [s]"], rows)


def time_s(row):
    return min(float(time) for time in row["processors_s"].split())


def failed(folder):
    """Cases without a result, counted by reason."""
    reasons = {}
    cases = read(folder / "study.csv")
    for row in cases:
        if row["status"] != "done":
            reason = re.search(r"\[([\w-]+)\]|$", row["reason"])[1] or row["reason"]
            reasons[reason] = reasons.get(reason, 0) + 1
    if not reasons:
        return f"{len(cases)} cases, none failed."
    listed = "; ".join(f"{count} × {reason}" for reason, count in reasons.items())
    return f"{len(cases)} cases; failed: {listed}."


def between(text, name, made):
    """The text with what is between the markers of a name made anew."""
    begin, end = (marker.format(name) for marker in (BEGIN, END))
    before, rest = text.split(begin)
    return f"{before}{begin}\n\n{made}\n\n{end}{rest.split(end)[1]}"


def main(check):
    text = now = PAGE.read_text(encoding="utf-8")
    for folder in sorted(path for path in KEPT.iterdir() if path.is_dir()):
        text = between(text, folder.name, "\n\n".join((times(folder), front(folder), failed(folder))))
    if check and text != now:
        sys.exit("docs/guide/error-and-time.md is out of date: docs/evidence/error_and_time.py writes it anew")
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:] == ["--check"])
