#!/usr/bin/env python3
"""The figures of docs/verification/figures.md, from the lines that tests leave with `evidence::row`.

  docs/evidence/figures.py [LOG]            writes the tables anew
  docs/evidence/figures.py --check [LOG]    fails, naming the rows, where tables and figures disagree

LOG holds such lines, among others, as NDDA_EVIDENCE=LOG cargo test leaves them. Without it the tests of TESTS run.
"""

import os
import re
import subprocess
import sys
import tempfile
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
MANUAL = ROOT / "docs" / "verification" / "figures.md"
BEGIN, END = "<!-- figures: begin -->", "<!-- figures: end -->"
# Test binaries whose rows are in the manual.
TESTS = ["verification", "scenes", "certify"]
# Part of its tolerance by which a figure may be off before the manual is out of date; of itself, if all that it has is a limit.
STALE = 0.05
# Differences below this part of the answer, or of one, are rounding: another compiler has others.
ROUND_OFF = 1e-9
HEADER = "| what | measured | answer | tolerance | error |\n|---|---|---|---|---|"


@dataclass(frozen=True)
class Row:
    """One figure: texts as the manual shows them."""

    id: str
    file: str
    what: str
    measured: str
    answer: str
    tolerance: str
    error: str

    @property
    def key(self):
        return self.id, self.file, self.what

    def name(self):
        return f"{self.id}, {self.file}: {self.what}"

    def cells(self):
        return f"| {self.what} | {self.measured} | {self.answer} | {self.tolerance} | {self.error} |"


def main(arguments):
    check = arguments[:1] == ["--check"]
    logs = arguments[check:]
    if len(logs) > 1 or any(log.startswith("-") for log in logs):
        sys.exit(__doc__.strip())
    rows = from_log(Path(logs[0]).read_text(encoding="utf-8") if logs else run_tests())
    if not rows:
        sys.exit("there is no line of evidence")
    text = MANUAL.read_text(encoding="utf-8")
    if check:
        faults = disagreements(from_manual(between_markers(text)[1]), rows)
        if faults:
            sys.exit("\n".join(faults) + "\ndocs/verification/figures.md is out of date: docs/evidence/figures.py writes it anew")
        print(f"docs/verification/figures.md says what {len(rows)} figures say")
    else:
        before, _, after = between_markers(text)
        MANUAL.write_text(f"{before}\n\n{tables(rows)}\n{after}", encoding="utf-8")
        print(f"{len(rows)} figures are written to docs/verification/figures.md")


def run_tests():
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "evidence.log"
        command = ["cargo", "test", "--locked", "--workspace"] + [word for test in TESTS for word in ("--test", test)]
        subprocess.run(command, cwd=ROOT, check=True, env=os.environ | {"NDDA_EVIDENCE": str(log)})
        return log.read_text(encoding="utf-8")


def from_log(text):
    """The rows of a log by id, file and place in it."""
    found = set()
    for line in text.splitlines():
        # The name of a test may stand before what it prints.
        fields = line[line.find("evidence\t") :].split("\t")
        if len(fields) != 7 or fields[0] != "evidence":
            continue
        _, id_, place, what, measured, answer, error = fields
        file, _, number = place.partition(":")
        answer, tolerance = split_answer(answer)
        row = Row(heading(id_), file, what.replace("|", "∣"), plain(measured), answer, tolerance, plain(error))
        found.add((natural(id_), file, int(number or 0), natural(what), row))
    return [entry[-1] for entry in sorted(found, key=lambda entry: entry[:-1] + (entry[-1].measured,))]


def split_answer(text):
    """Answer and tolerance: `1e0 ± 2e-2 of it`, `0e0 ± 1e-6`, `at most 1e-3`."""
    answer, _, tolerance = text.partition(" ± ")
    number = answer.split()[-1]
    answer = answer.removesuffix(number) + plain(number)
    if not tolerance:
        return answer, "–"
    return answer, plain(tolerance.removesuffix(" of it")) + (" of it" if tolerance.endswith(" of it") else "")


def plain(number):
    """A number as people write it; six digits, of which the lines have no more."""
    return "–" if number == "-" else f"{float(number):.6g}"


def natural(text):
    """Sorts 9 before 10, and numbers before words."""
    parts = re.findall(r"\d+(?:\.\d+)?(?:e[+-]?\d+)?|\D+", text)
    return tuple((0, float(part), "") if part[0].isdecimal() else (1, 0.0, part) for part in parts)


def title(file):
    """The first paragraph of a test file's header."""
    header = []
    for line in (ROOT / file).read_text(encoding="utf-8").splitlines():
        if not line.startswith("//! "):
            break
        header.append(line.removeprefix("//! ").strip())
    text = " ".join(header)
    return text[:1].upper() + text[1:]


def heading(id_):
    return id_[:1].upper() + id_[1:]


def tables(rows):
    """A heading per id, with a table per test file."""
    groups = defaultdict(list)
    for row in rows:
        groups[row.id, row.file].append(row)
    text, last = [], None
    for (id_, file), members in groups.items():
        if id_ != last:
            text.append(f"## {id_}\n")
            last = id_
        text.append(f"`{file}`: {title(file)}\n\n{HEADER}")
        text.extend(row.cells() for row in members)
        text.append("")
    return "\n".join(text)


def between_markers(text):
    """What stands before, between and after the markers; the markers stay outside."""
    before, begin, rest = text.partition(BEGIN)
    between, end, after = rest.partition(END)
    if not (begin and end):
        sys.exit(f"docs/verification/figures.md has no {BEGIN} … {END}")
    return before + begin, between, end + after


def from_manual(text):
    rows, id_, file = [], "", ""
    for line in text.splitlines():
        if line.startswith("## "):
            id_ = line.removeprefix("## ")
        elif line.startswith("`"):
            file = line.split("`")[1]
        elif line.startswith("| ") and not HEADER.startswith(line):
            rows.append(Row(id_, file, *(cell.strip() for cell in line.strip("|").split("|"))))
    return rows


def disagreements(written, measured):
    """What is missing, new or different, in words."""
    faults = []
    by_key = [defaultdict(list), defaultdict(list)]
    for rows, found in zip((written, measured), by_key):
        for row in rows:
            found[row.key].append(row)
    for key in by_key[0] | by_key[1]:
        # One name may stand for several figures, which are then told apart by size.
        old, new = (sorted(found[key], key=lambda row: float(row.measured)) for found in by_key)
        if len(old) == len(new):
            faults += [difference(a, b) for a, b in zip(old, new) if not agree(a, b)]
        else:
            faults.append(f"{(old + new)[0].name()}: written {len(old)} times, measured {len(new)} times")
    return faults


def difference(old, new):
    said = [f"{row.measured} for {row.answer}, tolerance {row.tolerance}" for row in (old, new)]
    return f"{new.name()}: {said[0]} is written, {said[1]} measured"


def agree(old, new):
    if (old.answer, old.tolerance) != (new.answer, new.tolerance):
        return False
    a, b, answer = float(old.measured), float(new.measured), float(new.answer.split()[-1])
    limit = new.tolerance == "–"
    tolerance, _, part = new.tolerance.partition(" ")
    # A limit may be far from what is measured, so that a part of it says nothing.
    size = abs(a) if limit else float(tolerance) * (abs(answer) if part else 1.0)
    target = 0.0 if limit else answer
    if max(abs(a - target), abs(b - target)) <= ROUND_OFF * max(abs(target), 1.0):
        return True
    # The last of six digits may be rounded either way.
    return abs(a - b) <= STALE * size + 1e-5 * abs(a)


if __name__ == "__main__":
    main(sys.argv[1:])
