#!/usr/bin/env python3
"""Compares numbers of README.md, docs/ and the headers of scenes with their sources, as docs/evidence/claims/ties.csv ties them.

  docs/evidence/ties.py [--night] [--write] [--only TEXT] [NDDA]        (default: target/release/ndda)

A row of ties.csv holds one number: a page, some words of it with the number in braces, its source, a factor from the source to the
number (two: what is added, and the factor), how the two compare, and when. Sources are

  figure: ID: WHAT                     a row of docs/verification/figures.md, which the gate compares with the tests
  csv: FILE: COLUMN=VALUE, …: COLUMN   a cell of a file of measurements
  bench: CRATE: NAME or NAME/NAME      instructions of a counted bench as last kept in benches/figures.json, or the ratio of two
  ndda ARGUMENTS: QUANTITY             a run of the program, with its results in a folder

A quantity is `json FILE /PATH` (a slash in a key is ~1), `history COLUMN OPERATION` or `said PATTERN`, the first group of a regular expression in what the program
prints. A column is one of history.csv, or two of them, A-B, the first less the second. Operations are last, first, min, max, absmax and mean, with two times between which
they count, at TIME, and change A B C D, the mean between C and D less that between A and B.

Numbers compare as `=`, rounded to the digits that are written (off by at most 0.6 of the last); `<`, `>`; `± 3 %`; or `is`, for a word. Rows with `night` in their last
column are those whose runs take long: --night runs all, and keeps what it measured in docs/evidence/claims/results.csv. --write puts the
measured number into the page where one is off; read it before it is committed. --only takes rows whose page or source has a text.
"""

import argparse
import csv
import datetime
import json
import math
import os
import re
import shlex
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import claims

ROOT = claims.ROOT
RESULTS = claims.TIES.with_name("results.csv")
COLUMNS = ["page", "words", "measured", "holds", "seconds", "date", "commit"]
LIMIT_S = 3600
# Exit code of the program after Ctrl-C.
INTERRUPTED = 130


class Fault(Exception):
    """Why a number cannot be compared."""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--night", action="store_true")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--only", default="")
    parser.add_argument("ndda", nargs="?", default=ROOT / "target" / "release" / "ndda", type=Path)
    given = parser.parse_args()
    every = claims.ties()
    rows = [row for row in every if given.night or row["when"] != "night"]
    rows = [row for row in rows if given.only in row["page"] or given.only in row["source"]]
    sources, found = Sources(given.ndda.absolute()), []
    # Rows that are not compared now must still be found in their pages.
    faults = [there for row in every if row not in rows and isinstance(there := claims.place(row), str)]
    for fault in faults:
        print(fault, flush=True)
    for row in rows:
        result, fault = compare(row, sources, given.write)
        found.append(result)
        if fault:
            faults.append(fault)
            print(fault, flush=True)
    if given.night and not given.only:
        keep(found)
    if faults:
        sys.exit(f"{len(faults)} numbers are not those of their sources")
    print(f"{len(rows)} numbers are those of their sources")


def compare(row, sources, write):
    """What is kept of a number, and what is wrong with it or nothing."""
    result = {"page": row["page"], "words": row["words"], "date": datetime.date.today().isoformat(), "commit": commit()}
    there = claims.place(row)
    if isinstance(there, str):
        return result | {"holds": "no"}, there
    line, written = there
    began = time.monotonic()
    try:
        measured = sources.value(row["source"])
    except (Fault, LookupError, ValueError, OSError) as fault:
        return result | {"holds": "no"}, f"{row['page']}:{line}: {row['words']}: {row['source']}: {fault!r}"
    result["seconds"] = f"{time.monotonic() - began:.1f}"
    if not isinstance(measured, str):
        *offset, factor = (float(part) for part in (row["factor"] or "1").split())
        measured = sum(offset) + factor * measured
    result["measured"] = measured if isinstance(measured, str) else f"{measured:.6g}"
    if holds(row["relation"] or "=", written, measured):
        return result | {"holds": "yes"}, None
    if write and row["relation"] in ("", "="):
        put(row, shown(measured, written))
    return result | {"holds": "no"}, f"{row['page']}:{line}: {row['words']}: {row['source']} is {result['measured']}"


def holds(relation, written, measured):
    if relation == "is":
        return written == measured
    if isinstance(measured, str):
        raise Fault(f"{measured} is no number")
    number = claims.value(written)
    if relation == "<":
        return measured < number
    if relation == ">":
        return measured > number
    if relation.startswith("±"):
        return abs(measured - number) <= float(relation.strip("± %")) / 100 * abs(number)
    return abs(measured - number) <= 0.6 * claims.last_digit(written)


def shown(measured, like):
    """A number with as many digits as another."""
    mantissa, _, exponent = like.replace("−", "-").partition("e")
    decimals = len(mantissa.partition(".")[2])
    if not exponent:
        space = re.search(r"\d([\s])\d{3}", mantissa)
        return f"{measured:,.{decimals}f}".replace(",", space[1] if space else "")
    text = f"{measured:.{decimals}e}"
    return re.sub(r"e([+-])0*(\d+)", lambda m: f"e{m[1].strip('+')}{m[2]}", text)


def put(row, number):
    """Writes a number into the page in the place of the one that is there."""
    path = ROOT / row["page"]
    text = path.read_text(encoding="utf-8")
    begin, end = claims.span(row, text)
    path.write_text(text[:begin] + number + text[end:], encoding="utf-8")
    rows = claims.ties()
    for other in (other for other in rows if other["page"] == row["page"]):
        # Other rows may have the number among their words.
        there = claims.match(other, text)
        if there and there.start() <= begin and end <= there.end():
            old = text[begin:end]
            before = text[there.start() : begin].count(old)
            parts = other["words"].split(old)
            other["words"] = old.join(parts[: before + 1]) + number + old.join(parts[before + 1 :])
    with claims.TIES.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def keep(found):
    with RESULTS.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(found)


def commit():
    return subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True).stdout.strip()


class Sources:
    """Values of sources; each command runs once."""

    def __init__(self, ndda):
        self.ndda, self.figures, self.runs = ndda, claims.figure_rows(), {}
        self.folder = tempfile.TemporaryDirectory()

    def value(self, source):
        if not source.startswith("ndda "):
            return claims.source_value(source, self.figures)
        command, _, quantity = source.partition(": ")
        if command not in self.runs:
            self.runs[command] = self.run(command)
        folder, said = self.runs[command]
        kind, _, what = quantity.partition(" ")
        if kind == "json":
            file, _, pointer = what.partition(" ")
            return from_json(folder / file, pointer)
        if kind == "history":
            return from_history(folder / "history.csv", *what.split(" "))
        if kind == "said":
            match = re.search(what, said)
            if not match:
                raise Fault("the program does not say so")
            return number(match[1])
        raise Fault(f"{kind!r} is no kind of quantity")

    def run(self, command):
        verb, *arguments = shlex.split(command)[1:]
        folder = Path(self.folder.name) / str(len(self.runs))
        out = ["--out", str(folder)] if verb in ("run", "mesh", "safety", "study", "certify", "rockfall") else []
        # Twins take as long as the run, and only a label wants them.
        quiet = ["--sensitivity", "never"] if verb == "run" and "--sensitivity" not in arguments else []
        done = subprocess.run(
            [self.ndda, verb, *arguments, *out, *quiet], cwd=ROOT, text=True, capture_output=True, timeout=LIMIT_S, env=os.environ | {"NO_COLOR": "1"}
        )
        if done.returncode < 0 or done.returncode == INTERRUPTED:
            raise Fault("the run was interrupted")
        return folder, done.stdout + done.stderr


def number(text):
    try:
        return float(text)
    except ValueError:
        return text


def from_json(path, pointer):
    found = json.loads(path.read_text(encoding="utf-8"))
    for key in pointer.strip("/").split("/"):
        found = found[int(key)] if isinstance(found, list) else found[key.replace("~1", "/")]
    return found if isinstance(found, str) else float(found)


def from_history(path, column, operation, *times):
    of, _, less = column.partition("-")
    with path.open(encoding="utf-8", newline="") as file:
        rows = [(float(row["time_s"]), float(row[of]) - (float(row[less]) if less else 0.0)) for row in csv.DictReader(file)]
    times = [float(t) for t in times]
    if operation == "at":
        return min(rows, key=lambda row: abs(row[0] - times[0]))[1]
    if operation == "change":
        return mean(rows, *times[2:]) - mean(rows, *times[:2])
    low, high = times or (-math.inf, math.inf)
    values = [value for t, value in rows if low <= t <= high]
    operations = {"last": lambda v: v[-1], "first": lambda v: v[0], "min": min, "max": max, "absmax": lambda v: max(map(abs, v))}
    return mean(rows, low, high) if operation == "mean" else operations[operation](values)


def mean(rows, low, high):
    values = [value for t, value in rows if low <= t <= high]
    return sum(values) / len(values)


if __name__ == "__main__":
    main()
