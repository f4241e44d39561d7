#!/usr/bin/env python3
"""Figures of the benches, crate by crate, kept in benches/figures.json.

  benches/track.py keep [--clocks] [CRATE ...]     measure, and add a record
  benches/track.py check [CRATE ...]               measure, compare with the last records, fail where instructions grew by more than 2 %
  benches/track.py compare FROM [TO]               a table per crate of two commits; of the last records and FROM, if TO is not given
  benches/track.py draw                            the figures over the records, as docs/evidence/performance/*.png

A crate's counted benches (benches/counted.rs) give instructions, which repeat to the last digit on one compiler; with
--clocks its criterion benches are run, too, and give nanoseconds. A commit that compare does not find in the records is
checked out under target/track and its instructions are counted. Needs cargo and valgrind; the runner that counts is
installed under target/tools, matplotlib for draw under target/ where it is missing. CRATE is the end of a name, contact for
ndda-contact, and suite for the scenes in benches/; without one, all.
"""
import argparse
import json
import os
import platform
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
FIGURES = ROOT / "benches" / "figures.json"
PICTURES = ROOT / "docs" / "evidence" / "performance"
# More instructions than this are a loss; the same source differs by less between machines with AVX2.
TOLERANCE = 0.02
# Names in a panel of a picture.
NAMED = 10
KINDS = {"instructions": "", "nanoseconds": " ns"}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    keep = commands.add_parser("keep", help="measure, and add a record")
    keep.add_argument("--clocks", action="store_true", help="run the criterion benches, too")
    check = commands.add_parser("check", help="measure, and compare with the last records")
    for command in (keep, check):
        command.add_argument("crate", nargs="*")
    compare = commands.add_parser("compare", help="print tables of two commits")
    compare.add_argument("before", metavar="FROM")
    compare.add_argument("after", metavar="TO", nargs="?")
    commands.add_parser("draw", help="draw the figures over the records")
    options = parser.parse_args()
    if options.command == "draw":
        return draw(load())
    if options.command == "compare":
        return compare_commits(options.before, options.after)
    clocks = options.command == "keep" and options.clocks
    record = measure(ROOT, crates_asked_for(options.crate, clocks), clocks)
    records = load()
    slower = print_tables(lambda kind, crate: last(records, kind, crate), record)
    if options.command == "keep":
        FIGURES.write_text(json.dumps(records + [record], indent=1) + "\n")
        return 0
    for name in slower:
        print(f"more than {100 * TOLERANCE:.0f} % more instructions than kept: {name}", file=sys.stderr)
    return 1 if slower else 0


def crates_asked_for(names, clocks):
    """Crates by their names or the ends of these; without clocks only those that are counted."""
    found = [crate for crate in crates(ROOT) if not names or {crate, crate.split("-")[-1]} & set(names)]
    found = [crate for crate in found if clocks or is_counted(ROOT, crate)]
    if not found:
        sys.exit(f"no crate with {'benches' if clocks else 'counted benches'} among {names}")
    return found


def crates(root):
    """Crates that have benches; the suite is the workspace itself."""
    return [*sorted(path.parent.name for path in root.glob("crates/*/benches")), "ndda-suite"]


def benches(root, crate):
    return (root if crate == "ndda-suite" else root / "crates" / crate) / "benches"


def is_counted(root, crate):
    return (benches(root, crate) / "counted.rs").exists()


def measure(root, names, clocks):
    """A record of the crates of a working tree."""
    record = {
        "commit": commit(root),
        "rustc": output(root, "rustc", "--version"),
        "processor": processor(),
        "instructions": instructions(root, [crate for crate in names if is_counted(root, crate)]),
    }
    if clocks:
        record["nanoseconds"] = {crate: nanoseconds(root, crate) for crate in names}
    return record


def instructions(root, names):
    """Crates side by side: what is counted does not see the clock."""
    binaries = counted_binaries(root) if names else {}
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return dict(zip(names, pool.map(lambda crate: totals(root, crate, binaries[crate]), names)))


def counted_binaries(root):
    """All counted benches by crate, built at once: crate by crate, each has other features of what they share."""
    built = cargo(
        root, "bench", "--locked", "--workspace", "--bench", "counted", "--no-run", "--message-format=json", runner=runner(root)
    )
    artifacts = [json.loads(line) for line in built.splitlines()]
    return {Path(a["manifest_path"]).parent.name: a["executable"] for a in artifacts if a.get("executable")}


def totals(root, crate, binary):
    folder = TARGET / "gungraun" / crate
    shutil.rmtree(folder, ignore_errors=True)
    environment = dict(os.environ, CARGO_TARGET_DIR=str(TARGET), CARGO_PKG_NAME=crate)
    run([binary, "--bench"], benches(root, crate).parent, environment)
    found = {}
    for path in sorted(folder.glob("counted/*/*/callgrind.*.out")):
        total = re.search(r"^(?:totals|summary): (\d+)", path.read_text(), re.MULTILINE)
        found[path.parent.name] = int(total.group(1))
    if not found:
        sys.exit(f"{crate}: callgrind left no totals in {folder}")
    return found


def nanoseconds(root, crate):
    shutil.rmtree(TARGET / "criterion", ignore_errors=True)
    for path in sorted(benches(root, crate).glob("*.rs")):
        if "criterion" in path.read_text():
            cargo(root, "bench", "--locked", "-p", crate, "--bench", path.stem)
    medians = {}
    for path in sorted((TARGET / "criterion").glob("**/new/estimates.json")):
        name = json.loads((path.parent / "benchmark.json").read_text())["full_id"]
        medians[name] = round(json.loads(path.read_text())["median"]["point_estimate"], 1)
    return medians


def runner(root):
    """The runner has to be of the version of the library."""
    lock = (root / "Cargo.lock").read_text()
    version = re.search(r'name = "gungraun"\nversion = "([^"]+)"', lock).group(1)
    place = TARGET / "tools" / f"gungraun-{version}"
    binary = place / "bin" / "gungraun-runner"
    if not binary.exists():
        build = TARGET / "tools" / "build"
        command = ["install", "--debug", "--locked", "--quiet", "--root", place, "--target-dir", build]
        cargo(root, *command, "--config", "profile.dev.debug=0", "--version", version, "gungraun-runner")
        shutil.rmtree(build)
    if not shutil.which("valgrind"):
        sys.exit("valgrind is not installed")
    return binary


def compare_commits(before, after):
    records = load()
    if after is None:
        newer = record_of(before, records)
        older = [record for record in records if record is not newer]
        print_tables(lambda kind, crate: last(older, kind, crate), newer)
        return 0
    older = record_of(before, records)
    print_tables(lambda kind, crate: older, record_of(after, records))
    return 0


def record_of(name, records):
    """The last record of a commit, or one that is made of it now."""
    full = output(ROOT, "git", "rev-parse", "--verify", "--quiet", f"{name}^{{commit}}", may_fail=True)
    start = full[:12] or name
    found = [record for record in records if record["commit"].startswith(start)]
    if found:
        return found[-1]
    if not full:
        sys.exit(f"{name} is neither in {FIGURES} nor a commit of this repository")
    return measure_commit(full)


def measure_commit(name):
    tree = TARGET / "track" / name[:12]
    print(f"{name[:12]} has no record: its instructions are counted in {tree}", flush=True)
    git(ROOT, "worktree", "prune")
    if not tree.exists():
        git(ROOT, "worktree", "add", "--detach", str(tree), name)
    try:
        return measure(tree, [crate for crate in crates(tree) if is_counted(tree, crate)], clocks=False)
    finally:
        git(ROOT, "worktree", "remove", "--force", str(tree))


def last(records, kind, crate):
    """The last record with figures of a crate."""
    return next((record for record in reversed(records) if crate in record.get(kind, {})), None)


def print_tables(before_of, after):
    """A table per crate of what changed; returns the counts that grew beyond the tolerance under the same compiler.

    What is in one of two records only, because it was renamed for instance, is shown as new or gone."""
    slower = []
    for kind, unit in KINDS.items():
        for crate, figures in after.get(kind, {}).items():
            before = before_of(kind, crate) or {}
            old = before.get(kind, {}).get(crate, {})
            print(f"\n{crate}, {kind}, {before.get('commit', 'nothing')} to {after['commit']}")
            for name in dict.fromkeys([*old, *figures]):
                print(f"  {name:58} {cell(old.get(name), unit)} {cell(figures.get(name), unit)} {change(old.get(name), figures.get(name))}")
            if kind == "instructions" and before.get("rustc") == after["rustc"]:
                grown = [name for name in figures if name in old and figures[name] > (1 + TOLERANCE) * old[name]]
                slower += [f"{crate} {name} {change(old[name], figures[name]).strip()}" for name in grown]
            elif kind == "instructions" and before:
                print(f"  another compiler than the record's ({before['rustc']}): shown, not judged")
    return slower


def cell(figure, unit):
    return f"{figure:>16,}{unit}" if figure is not None else " " * (16 + len(unit))


def change(old, new):
    if old is None or new is None:
        return "     gone" if new is None else "      new"
    return f"{100 * (new / old - 1):+8.2f} %" if old else ""


def draw(records):
    """A panel per crate: each figure over that of its first record."""
    sys.path.insert(0, str(ROOT / "docs"))
    import plots

    plots.need_matplotlib()
    for kind in KINDS:
        # Clocks of another processor say nothing about the program.
        newest = next((r for r in reversed(records) if r.get(kind)), None)
        kept = [r for r in records if r.get(kind) and (kind == "instructions" or r["processor"] == newest["processor"])]
        names = sorted({crate for record in kept for crate in record[kind]})
        if not names:
            continue
        figure, axes = plots.panels(-(-len(names) // 2), min(2, len(names)), (9, 3.2 * -(-len(names) // 2)))
        for panel, crate in zip(axes, names):
            draw_crate(panel, crate, kind, kept)
            plots.finish(panel, crate, "", f"{kind} over those of the first record")
        for panel in axes[len(names) :]:
            panel.axis("off")
        plots.save(figure, PICTURES / f"{kind}.png")
        print(f"{PICTURES / kind}.png: {len(kept)} records")
    return 0


def draw_crate(axes, crate, kind, records):
    """All figures, of which those that have changed most are named."""
    curves = {}
    for name in dict.fromkeys(name for record in records for name in record[kind].get(crate, {})):
        points = [(i, record[kind][crate][name]) for i, record in enumerate(records) if name in record[kind].get(crate, {})]
        curves[name] = [(i, value / points[0][1]) for i, value in points if points[0][1]]
    by_change = sorted((name for name in curves if curves[name]), key=lambda name: -abs(curves[name][-1][1] - 1))
    for k, name in enumerate(by_change):
        axes.plot(*zip(*curves[name]), ".-", linewidth=0.9, label=name if k < NAMED else None)
    axes.set_xticks(range(len(records)), [record["commit"][:8] for record in records], rotation=30)


def load():
    return json.loads(FIGURES.read_text()) if FIGURES.exists() else []


def processor():
    if Path("/proc/cpuinfo").exists():
        name = re.search(r"model name\s*: (.*)", Path("/proc/cpuinfo").read_text())
        if name:
            return f"{name.group(1)}, {os.cpu_count()} cores"
    return f"{platform.processor() or platform.machine()}, {os.cpu_count()} cores"


def commit(root):
    """The commit of a working tree, with a + where it has changed since."""
    return git(root, "rev-parse", "--short=12", "HEAD") + ("+" if git(root, "status", "--porcelain") else "")


def git(root, *arguments):
    return output(root, "git", *arguments)


def output(root, *command, may_fail=False):
    done = subprocess.run(command, cwd=root, check=not may_fail, capture_output=True, text=True)
    return done.stdout.strip()


def cargo(root, *arguments, runner=None):
    """Standard output of cargo in a working tree; all of them share one target folder."""
    environment = dict(os.environ, CARGO_TARGET_DIR=str(TARGET), **({"GUNGRAUN_RUNNER": str(runner)} if runner else {}))
    return run(["cargo", *map(str, arguments)], root, environment)


def run(command, folder, environment):
    result = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{result.stdout}\n{result.stderr}")
    return result.stdout


if __name__ == "__main__":
    sys.exit(main())
