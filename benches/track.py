#!/usr/bin/env python3
"""Figures of the benches, crate by crate, kept in benches/figures.json.

  benches/track.py keep [--clocks] [CRATE ...]     measure, and add a record
  benches/track.py check [CRATE ...]               measure, compare with the last record, fail where it got slower
  benches/track.py compare FROM TO                 two records, by the start of their commits

A crate's counted benches (benches/counted.rs) give instructions, which repeat to the last digit on one compiler; with
--clocks its criterion benches are run, too, and give nanoseconds. Needs cargo and valgrind; the runner that counts is
installed under target/tools. CRATE is the end of a name, contact for ndda-contact; without one, all.
"""
import argparse
import json
import os
import platform
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
FIGURES = ROOT / "benches" / "figures.json"
# More instructions than this are a loss; the same source differs by less between machines with AVX2.
TOLERANCE = 0.02


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    keep = commands.add_parser("keep", help="measure, and add a record")
    keep.add_argument("--clocks", action="store_true", help="run the criterion benches, too")
    keep.add_argument("crate", nargs="*")
    check = commands.add_parser("check", help="measure, and compare with the last record")
    check.add_argument("crate", nargs="*")
    compare = commands.add_parser("compare", help="print a table of two records")
    compare.add_argument("commits", nargs=2, metavar="COMMIT")
    options = parser.parse_args()
    if options.command == "compare":
        before, after = (record_of(commit) for commit in options.commits)
        print_table(before, after)
        return 0
    crates = [crate for crate in counted_crates() if not options.crate or crate.split("-")[-1] in options.crate]
    if not crates:
        sys.exit(f"no crate with counted benches among {options.crate}")
    record = measure(crates, options.command == "keep" and options.clocks)
    kept = last_record(crates)
    slower = print_table(kept, record)
    if options.command == "keep":
        records = load() + [record]
        FIGURES.write_text(json.dumps(records, indent=1) + "\n")
        return 0
    if kept and kept["rustc"] != record["rustc"]:
        print(f"another compiler than the record's ({kept['rustc']}): shown, not judged")
        return 0
    for name in slower:
        print(f"more instructions than kept: {name}", file=sys.stderr)
    return 1 if slower else 0


def counted_crates():
    return sorted(path.parent.parent.name for path in ROOT.glob("crates/*/benches/counted.rs"))


def measure(crates, clocks):
    record = {
        "commit": git("rev-parse", "--short=12", "HEAD") + ("+" if git("status", "--porcelain") else ""),
        "rustc": output("rustc", "--version"),
        "processor": processor(),
        "instructions": {crate: instructions(crate) for crate in crates},
    }
    if clocks:
        record["nanoseconds"] = {crate: nanoseconds(crate) for crate in crates}
    return record


def instructions(crate):
    folder = TARGET / "gungraun" / crate
    shutil.rmtree(folder, ignore_errors=True)
    run("cargo", "bench", "--locked", "-p", crate, "--bench", "counted", runner=runner())
    totals = {}
    for path in sorted(folder.glob("counted/*/*/callgrind.*.out")):
        total = re.search(r"^(?:totals|summary): (\d+)", path.read_text(), re.MULTILINE)
        totals[path.parent.name] = int(total.group(1))
    if not totals:
        sys.exit(f"{crate}: callgrind left no totals in {folder}")
    return totals


def nanoseconds(crate):
    shutil.rmtree(TARGET / "criterion", ignore_errors=True)
    benches = [p.stem for p in (ROOT / "crates" / crate / "benches").glob("*.rs") if p.stem != "counted"]
    for bench in sorted(benches):
        run("cargo", "bench", "--locked", "-p", crate, "--bench", bench)
    medians = {}
    for path in sorted((TARGET / "criterion").glob("**/new/estimates.json")):
        name = json.loads((path.parent / "benchmark.json").read_text())["full_id"]
        medians[name] = round(json.loads(path.read_text())["median"]["point_estimate"], 1)
    return medians


def runner():
    """The runner has to be of the version of the library."""
    lock = (ROOT / "Cargo.lock").read_text()
    version = re.search(r'name = "gungraun"\nversion = "([^"]+)"', lock).group(1)
    place = TARGET / "tools" / f"gungraun-{version}"
    binary = place / "bin" / "gungraun-runner"
    if not binary.exists():
        run("cargo", "install", "--debug", "--locked", "--quiet", "--root", place, "--version", version, "gungraun-runner")
    if not shutil.which("valgrind"):
        sys.exit("valgrind is not installed")
    return binary


def print_table(before, after):
    """Prints what changed; returns the names of counts that grew beyond the tolerance."""
    slower = []
    for kind, unit in (("instructions", ""), ("nanoseconds", " ns")):
        for crate, figures in after.get(kind, {}).items():
            print(f"\n{crate}, {kind}, {before['commit'] if before else 'nothing'} to {after['commit']}")
            old = (before or {}).get(kind, {}).get(crate, {})
            for name, figure in figures.items():
                change = f"{100 * (figure / old[name] - 1):+8.2f} %" if name in old else "     new"
                print(f"  {name:58} {figure:>14,}{unit} {change}")
                if kind == "instructions" and name in old and figure > (1 + TOLERANCE) * old[name]:
                    slower.append(f"{crate} {name}")
    return slower


def load():
    return json.loads(FIGURES.read_text()) if FIGURES.exists() else []


def last_record(crates):
    """The last figures of each crate, as one record."""
    joined = None
    for record in load():
        for crate in set(crates) & set(record["instructions"]):
            joined = joined or {"instructions": {}}
            joined["instructions"][crate] = record["instructions"][crate]
            if crate in record.get("nanoseconds", {}):
                joined.setdefault("nanoseconds", {})[crate] = record["nanoseconds"][crate]
            joined.update(commit=record["commit"], rustc=record["rustc"])
    return joined


def record_of(commit):
    found = [record for record in load() if record["commit"].startswith(commit)]
    if not found:
        sys.exit(f"no record of {commit} in {FIGURES}")
    return found[-1]


def processor():
    if Path("/proc/cpuinfo").exists():
        name = re.search(r"model name\s*: (.*)", Path("/proc/cpuinfo").read_text())
        if name:
            return f"{name.group(1)}, {os.cpu_count()} cores"
    return f"{platform.processor() or platform.machine()}, {os.cpu_count()} cores"


def git(*arguments):
    return output("git", *arguments)


def output(*command):
    return subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout.strip()


def run(*command, runner=None):
    environment = dict(os.environ, **({"GUNGRAUN_RUNNER": str(runner)} if runner else {}))
    result = subprocess.run([str(c) for c in command], cwd=ROOT, env=environment, capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{result.stdout}\n{result.stderr}")


if __name__ == "__main__":
    sys.exit(main())
