#!/usr/bin/env python3
"""Every number that README.md, docs/ and the headers of scenes state, with its place, its sentence and what keeps it true.

  docs/evidence/claims.py                        how many numbers each page states, by what holds them
  docs/evidence/claims.py --csv                  all of them: file, line, number, holder, sentence
  docs/evidence/claims.py --sample N --seed S    a random sample of those that nothing reruns, to rerun by hand

Left out are the generated references of scenes and of the Python package, code, addresses, numbers of sections, figures, equations and
years, and numbers in words. A number that a scene's header shares with the scene itself is a *setting*; whether another number is a
measurement or a choice only a reader can tell.

docs/evidence/ties.py compares the numbers that docs/evidence/claims/ties.csv ties to a source.
"""

import argparse
import csv
import json
import random
import re
import sys
from collections import Counter, defaultdict
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
TIES = ROOT / "docs" / "evidence" / "claims" / "ties.csv"
FIGURES = ROOT / "docs" / "verification" / "figures.md"
BENCHES = ROOT / "benches" / "figures.json"
GENERATED = {"docs/reference/scene.md", "docs/python/reference.md"}

# What holds a number, the strongest first; what stands before `DATA` is rerun by a machine.
QUOTED = "quoted output, rerun by the gate"
FIGURE = "figure of a test, compared by the gate"
TIED = "tied to its source, compared by the gate"
TEST = "text compared by a test"
NIGHT = "rerun at night"
DATA = "table compared with its data by the gate"
TABLE = "table that a script wrote from data"
SETTING = "setting of the scene"
NOTHING = "nothing"
HOLDERS = (QUOTED, FIGURE, TIED, TEST, NIGHT, DATA, TABLE, SETTING, NOTHING)

# Pages of which a test or a script compares all numbers of a kind of line: page, part of the line, holder.
LINES = (
    ("docs/reference/features.md", r"^\| (none|`)", TEST),  # tests/leaving_out.rs
    ("docs/guide/certify.md", r"^\| (scenes|docs)/", TABLE),  # docs/evidence/certify/run.py
    ("docs/verification/nightly.md", r"^\|", TABLE),  # .ci/nightly
)
# Markers of what stands between them: page, holder.
MARKED = {
    "docs/verification/figures.md": FIGURE,  # docs/evidence/figures.py --check
    "docs/verification/paper.md": DATA,  # scenes/paper/run.py --check
    "docs/verification/performance.md": DATA,  # docs/evidence/performance.py --check, all but the tables of the peers
    "docs/guide/error-and-time.md": DATA,  # docs/evidence/error_and_time.py --check
}
BEGIN = re.compile(r"<!-- (table|figures|tables of)\b.*-->")
END = re.compile(r"<!-- (end|figures: end|tables? of .*: end|end of table).*-->")

NUMBER = re.compile(
    r"(?<![\w.,§/–^-])[-−+±]?(\d{1,3}(?:[   ]\d{3})+(?!\d)|\d+)(\.\d+)?(?:e[-+−]?\d+|\s?[·×] ?10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?(?:[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?(?![\w]*[_(])"
)
NO_CLAIM = re.compile(
    r"`[^`]*`|\]\([^)]*\)|https?://\S+|<!--.*?-->|\d{4}-\d\d-\d\d|^\d+\. "
    r"|§\s?\d[\d.]*|\b(?:[Ff]igs?\.?|[Tt]ables?|[Ee]qs?\.?|section|Chapter|p\.|pp\.|Rust|Python|version|V|X|commit)\s?\d[\d.–,a-c]*(?: (?:and|to) \d+)*"
    r"|(?<![.\d])\b(?:19|20)\d\d\b(?!\.\d|\s?(?:m|s|kg|J|N|Pa|steps|random|scenes|blocks)\b)|\bat [0-9a-f]{7,12}\b"
)
SENTENCE = re.compile(r"(?<=[.!?])\s+(?=[A-Z`*\[(])")


class Claim(NamedTuple):
    file: str
    line: int
    number: str
    holder: str
    sentence: str


class Piece(NamedTuple):
    """Text that belongs together: a paragraph, a row of a table, a line of output. Lines are numbers of lines by place in the text."""

    text: str
    starts: list
    holder: str


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--csv", action="store_true")
    parser.add_argument("--sample", type=int, metavar="N")
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    found = claims()
    if given.csv:
        writer = csv.writer(sys.stdout, lineterminator="\n")
        writer.writerow(Claim._fields)
        writer.writerows(found)
    elif given.sample:
        free = [claim for claim in found if claim.holder == NOTHING]
        for claim in random.Random(given.seed).sample(free, min(given.sample, len(free))):
            print(f"{claim.file}:{claim.line}: {claim.number}\n    {claim.sentence}")
    else:
        print(summary(found))


def claims():
    """All of them, page by page."""
    tied = tied_places()
    found = []
    for path in pages():
        name = path.relative_to(ROOT).as_posix()
        text = path.read_text(encoding="utf-8")
        pieces, settings = (header(text), body_numbers(text)) if path.suffix == ".ron" else (markdown(name, text), set())
        for piece in pieces:
            for claim, place in numbers(name, piece):
                held = tied.get((name, claim.line, claim.number))
                if held and claim.holder in (NOTHING, DATA, TABLE):
                    claim = claim._replace(holder=held)
                elif claim.holder == NOTHING and value(claim.number) in settings:
                    claim = claim._replace(holder=SETTING)
                found.append(claim)
    return found


def pages():
    docs = sorted((ROOT / "docs").rglob("*.md"))
    scenes = sorted((ROOT / "scenes").rglob("*.ron"))
    readmes = [ROOT / "README.md", ROOT / "scenes" / "failures" / "README.md"]
    return [path for path in readmes + docs + scenes if path.relative_to(ROOT).as_posix() not in GENERATED]


def header(text):
    """Comments of a scene; those that quote a command are held by the test `quoted`."""
    pieces, lines, quoted = [], [], False
    for number, line in enumerate(text.splitlines() + [""], 1):
        comment = line.strip().removeprefix("//").strip() if line.strip().startswith("//") else None
        if comment and comment.startswith("$ ndda"):
            pieces.append(joined(lines, NOTHING))
            lines, quoted = [], True
        if comment is None or not comment:
            pieces.append(joined(lines, QUOTED if quoted else NOTHING))
            lines, quoted = [], quoted and comment is not None
        else:
            lines.append((number, comment))
    return [piece for piece in pieces if piece.text]


def body_numbers(text):
    """Values of a scene's own numbers."""
    body = "\n".join(line.split("//")[0] for line in text.splitlines())
    return {float(word) for word in re.findall(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e-?\d+)?", body)}


def markdown(name, text):
    """Pieces of a page, with what holds each by where it stands."""
    pieces, lines, fence, between, marker = [], [], None, None, ""

    def close(holder=NOTHING):
        pieces.append(joined(lines, holder))
        lines.clear()

    for number, line in enumerate(text.splitlines() + [""], 1):
        stripped = line.strip()
        if fence is not None:
            if stripped.startswith("```"):
                fence = None
            elif fence in (QUOTED, NIGHT):
                pieces.append(joined([(number, line)], fence if not stripped.startswith("$") else SETTING))
            continue
        if stripped.startswith("```"):
            close()
            fence = (NIGHT if "nightly" in marker else QUOTED) if marker.startswith("run") else "code"
        elif END.search(stripped):
            close()
            between = None
        elif BEGIN.search(stripped):
            close()
            between = TABLE if "peers" in stripped else MARKED.get(name, TABLE)
        elif stripped.startswith("|"):
            close()
            special = next((holder for page, part, holder in LINES if page == name and re.search(part, stripped)), NOTHING)
            if not re.fullmatch(r"[|\-: ]+", stripped):
                pieces.append(joined([(number, stripped)], between or special))
        elif not stripped or re.match(r"(#|[*-] |\d+\. |!\[)", stripped):
            close()
            if stripped and not stripped.startswith("!["):
                lines.append((number, re.sub(r"^(#+|[*-]|\d+\.) ", "", stripped)))
        else:
            lines.append((number, stripped))
        marker = stripped.removeprefix("<!-- ").removesuffix(" -->") if stripped.startswith("<!--") else ""
    close()
    return [piece for piece in pieces if piece.text]


def joined(lines, holder):
    text, starts = "", []
    for number, line in lines:
        starts.append((len(text), number))
        text += line + " "
    return Piece(text.rstrip(), starts, holder)


def numbers(name, piece):
    """Numbers of a piece with their sentences, and where in the piece they are."""
    masked = piece.text
    if piece.holder not in (QUOTED, NIGHT):
        masked = NO_CLAIM.sub(lambda mark: " " * len(mark[0]), masked)
    breaks = [0, *(match.end() for match in SENTENCE.finditer(piece.text)), len(piece.text)]
    if piece.text.startswith("|"):
        breaks = [0, len(piece.text)]
    for match in NUMBER.finditer(masked):
        at = match.start()
        line = max(number for start, number in piece.starts if start <= at)
        begin, end = max(b for b in breaks if b <= at), min(b for b in breaks if b > at)
        yield Claim(name, line, match[0].strip(), piece.holder, piece.text[begin:end].strip()), at


def value(number):
    """A number as it is written, as a float; none if it is no plain one."""
    try:
        return float(re.sub(r"[\s   ]", "", number).replace("−", "-").lstrip("+±"))
    except ValueError:
        return None


def summary(found):
    by_page = defaultdict(Counter)
    for claim in found:
        folder = claim.file if claim.file.endswith(".md") else f"{Path(claim.file).parent.as_posix()}/*.ron"
        by_page[folder][claim.holder] += 1
    lines = ["| page | " + " | ".join(HOLDERS) + " |", "|---" * (len(HOLDERS) + 1) + "|"]
    for page, counts in sorted(by_page.items()):
        lines.append(f"| {page} | " + " | ".join(str(counts[holder] or "") for holder in HOLDERS) + " |")
    total = Counter(claim.holder for claim in found)
    lines.append("| **all** | " + " | ".join(str(total[holder]) for holder in HOLDERS) + " |")
    return "\n".join(lines)


def ties():
    if not TIES.exists():
        return []
    with TIES.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def span(tie, text):
    """Where the number of a tie is in the text of its page; none unless its words are there once."""
    found = match(tie, text)
    return found and found.span(1)


def match(tie, text):
    """The words of a tie in the text of its page, its number as a group; none unless they are there once."""
    if tie["page"].endswith(".ron"):
        text = re.sub(r"^[ \t]*//", lambda match: " " * len(match[0]), text, flags=re.MULTILINE)
    before, _, rest = tie["words"].partition("{")
    number, _, after = rest.partition("}")
    parts = (r"\s+".join(re.escape(word) for word in part.split(" ")) for part in (before, number, after))
    hits = list(re.finditer("{}({}){}".format(*parts), text))
    return hits[0] if len(hits) == 1 else None


def place(tie):
    """Line of a tie's number in its page, and the number; a fault in words where the words are not there once."""
    text = (ROOT / tie["page"]).read_text(encoding="utf-8")
    found = span(tie, text)
    if found is None:
        return f"{tie['page']}: not there once: {tie['words']}"
    return text.count("\n", 0, found[0]) + 1, text[slice(*found)]


def tied_places():
    """What holds the numbers that are tied."""
    found = {}
    for tie in ties():
        there = place(tie)
        if not isinstance(there, str):
            found[tie["page"], *there] = NIGHT if tie["when"] == "night" else TIED
    return found


def last_digit(number):
    """Size of one in the last digit of a number as it is written."""
    mantissa, _, exponent = number.replace("−", "-").partition("e")
    decimals = len(mantissa.partition(".")[2])
    return 10.0 ** (int(exponent or 0) - decimals)


def figure_rows():
    """Measured values of docs/verification/figures.md by heading and name."""
    found, id_ = defaultdict(list), ""
    for line in FIGURES.read_text(encoding="utf-8").splitlines():
        if line.startswith("## "):
            id_ = line.removeprefix("## ")
        elif line.startswith("| "):
            cells = [cell.strip() for cell in line.strip("|").split("|")]
            found[id_, cells[0]].append(cells[1])
    return found


def source_value(source, rows):
    kind, _, rest = source.partition(": ")
    if kind == "figure":
        cells = {cell for (id_, what), found in rows.items() if f"{id_}: {what}" == rest for cell in found}
        if len(cells) != 1:
            raise LookupError(f"{len(cells)} such rows")
        return float(cells.pop())
    if kind == "csv":
        file, conditions, column = rest.split(": ")
        wanted = dict(part.split("=", 1) for part in re.split(r", (?=[^,=]*[^,= ]=)", conditions))
        with (ROOT / file).open(encoding="utf-8", newline="") as opened:
            hits = [row for row in csv.DictReader(opened) if all(row[key] == text for key, text in wanted.items())]
        if len(hits) != 1:
            raise LookupError(f"{len(hits)} such rows")
        return float(hits[0][column])
    if kind == "bench":
        crate, bench = rest.split(": ")
        # The last record that has the crate.
        kept = next(record["instructions"][crate] for record in reversed(json.loads(BENCHES.read_text())) if record["instructions"].get(crate))
        counts = [kept[name] for name in bench.split("/")]
        return counts[0] / (counts[1] if len(counts) > 1 else 1)
    raise ValueError("a source begins with `figure: `, `csv: `, `bench: ` or `ndda `")


if __name__ == "__main__":
    main()
