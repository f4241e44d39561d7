#!/usr/bin/env python3
"""Damages scenes one place at a time and checks that `ndda check` refuses each of them by its place.

Usage: refusal.py NDDA SCENE...        (exit 0: all well, 1: not)

An undamaged scene must pass with exit 0. A damaged copy must be refused with exit 3 and `file:line:column`;
a misspelt key or a number that is none must be reported on the very line where it stands, and a misspelt parameter where it is used.
"""

import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

BAD_INPUT = 3
KEY = re.compile(r"\b([a-z][a-z0-9_]*)(?=\s*:)")
NUMBER = re.compile(r"(?<![\w.])[-+]?\d[\d_]*(?:\.\d*)?(?:[eE][-+]?\d+)?(?![\w.])")
PARAMETERS = re.compile(r"\bparameters\s*:\s*\(")
COMMENT_OR_STRING = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\])*"', re.DOTALL)


def blanked(text):
    """The text with comments and strings turned to spaces, so that places stay where they are."""
    return COMMENT_OR_STRING.sub(lambda found: re.sub(r"[^\n]", " ", found.group()), text)


def damages(text):
    """Name, damaged text and damaged line (None where any line will do) of every copy to be refused."""
    code = blanked(text)
    line_of = lambda place: text.count("\n", 0, place) + 1
    names, seen = parameters(code), set()
    for key in KEY.finditer(code):
        if key.group() not in seen:
            seen.add(key.group())
            line = None if key.start() in names else line_of(key.start())
            yield f"key {key.group()}x", text[: key.end()] + "x" + text[key.end() :], line
    for number in NUMBER.finditer(code):
        for word in ("NaN", "-inf", "1e400"):
            damaged = text[: number.start()] + word + text[number.end() :]
            line = line_of(number.start())
            yield f"{word} for {number.group()} in line {line}", damaged, line
    end = max(code.rfind(")"), 1)
    for part in (0.0, 0.25, 0.5, 0.75, 1.0):
        cut = int(part * end)
        yield f"truncated to {cut} characters", text[:cut], None


def parameters(code):
    """Places between the brackets of `parameters: (…)`."""
    found = PARAMETERS.search(code)
    if not found:
        return range(0)
    depth, place = 1, found.end()
    while depth > 0 and place < len(code):
        depth += {"(": 1, ")": -1}.get(code[place], 0)
        place += 1
    return range(found.end(), place)


def check(ndda, scene):
    """Exit code and everything that `ndda check` printed."""
    done = subprocess.run(
        [ndda, "check", str(scene)],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        timeout=60,
        check=False,
    )
    return done.returncode, done.stdout.decode(errors="replace")


def complaint(ndda, scene, line):
    """What is wrong with the refusal of a damaged scene, or nothing."""
    code, printed = check(ndda, scene)
    if code != BAD_INPUT:
        return f"exit {code}, not {BAD_INPUT}:\n{printed}"
    places = [int(found) for found in re.findall(re.escape(scene.name) + r":(\d+):\d+", printed)]
    if not places:
        return f"names no {scene.name}:line:column:\n{printed}"
    if line is not None and line not in places:
        return f"damaged in line {line}, reported for line {places}:\n{printed}"
    return None


def stand_in_folder(scenes, folder):
    """Links to all that scenes may refer to, so that a damaged copy is refused for its damage alone."""
    for entry in scenes.iterdir():
        if entry.suffix != ".ron":
            (folder / entry.name).symlink_to(entry.resolve())


def try_scene(ndda, scene):
    """Number of damaged copies tried, and what is wrong."""
    code, printed = check(ndda, scene)
    if code != 0:
        return 0, [f"{scene}: refused as it is, exit {code}:\n{printed}"]
    wrong, tried = [], 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        stand_in_folder(scene.parent, folder)
        copy = folder / scene.name
        for damage, text, line in damages(scene.read_text(encoding="utf-8")):
            copy.write_text(text, encoding="utf-8")
            found = complaint(ndda, copy, line)
            tried += 1
            if found:
                wrong.append(f"{scene}: {damage}: {found}")
    return tried, wrong


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__.strip())
    failed = False
    names = sys.argv[2:]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(lambda name: try_scene(sys.argv[1], Path(name)), names))
    for name, (tried, wrong) in zip(names, results):
        print(f"{name}: passes; {tried - len(wrong)} of {tried} damaged copies refused by their place")
        for text in wrong[:10]:
            print(text)
        failed = failed or bool(wrong)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
