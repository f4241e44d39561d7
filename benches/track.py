#!/usr/bin/env python3
"""Figures of the benches, crate by crate, kept in benches/figures.json.

  benches/track.py keep [--clocks] [CRATE ...]     measure, and add a record
  benches/track.py check [CRATE ...]               measure, compare with the last records, fail where instructions grew by more than 2 %
  benches/track.py caches [CRATE ...]              the same with simulated caches, whose misses instructions do not see; once a day
  benches/track.py compare FROM [TO]               a table per crate of two commits; of the last records and FROM, if TO is not given
  benches/track.py draw                            the figures over the records, as docs/evidence/performance/*.png

A crate's counted benches (benches/counted.rs) give instructions, which repeat to the last digit on one compiler; with
--clocks its criterion benches are run, too, and give nanoseconds. A commit that compare does not find in the records is
checked out under target/track and its instructions are counted. caches counts cycles as callgrind estimates them (an
instruction 1, a miss of the first cache 5, of the last one 30 more), compares them with the last record that has them, and adds
one. A crate whose benches do not build or run is named, with the compiler's message, and does not stop the others.

Needs cargo and valgrind; the runner that counts is installed under target/tools, matplotlib for draw under target/ where it is
missing. CRATE is a crate's name, with or without ndda- before it, and suite for the scenes in benches/; without one, all.
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
# Estimated cycles move with addresses: by this much between two counts of one program.
CYCLES_TOLERANCE = 0.05
KINDS = {"instructions": "", "cycles": "", "nanoseconds": " ns"}
TOLERANCES = {"instructions": TOLERANCE, "cycles": CYCLES_TOLERANCE}
# Lines of a failed command that are shown: what is wrong stands at their end.
SHOWN_LINES = 60


class Broken(Exception):
    """A command failed; says which, and how."""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    keep = commands.add_parser("keep", help="measure, and add a record")
    keep.add_argument("--clocks", action="store_true", help="run the criterion benches, too")
    check = commands.add_parser("check", help="measure, and compare with the last records")
    caches = commands.add_parser("caches", help="measure with simulated caches, compare, and add a record")
    for command in (keep, check, caches):
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
    names = crates_asked_for(options.crate, clocks)
    record, broken = measure(ROOT, names, clocks, with_caches=options.command == "caches")
    records = load()
    slower = print_tables(lambda kind, crate: last(records, kind, crate), record)
    for name in slower:
        print(f"grown: {name}", file=sys.stderr)
    for crate, why in broken.items():
        print(f"\n{crate} was not measured:\n{why}", file=sys.stderr)
    keeps = options.command in ("keep", "caches")
    if keeps and any(record.get(kind) for kind in KINDS):
        FIGURES.write_text(json.dumps(records + [record], indent=1) + "\n")
        print(f"\nkept as {record['commit']}; {len(slower)} figure(s) grew beyond the tolerance")
    return 1 if broken or (slower and options.command != "keep") else 0


def crates_asked_for(names, clocks):
    """The crates of that name, ndda-NAME if none has it; without clocks only those that are counted."""
    all_crates = crates(ROOT)
    wanted = [named(name, all_crates) for name in names] or all_crates
    found = [crate for crate in all_crates if crate in wanted and (clocks or is_counted(ROOT, crate))]
    if not found:
        sys.exit(f"no crate with {'benches' if clocks else 'counted benches'} among {names}")
    return found


def named(name, all_crates):
    for candidate in (name, f"ndda-{name}"):
        if candidate in all_crates:
            return candidate
    sys.exit(f"no crate {name} with benches; there are {', '.join(all_crates)}")


def crates(root):
    """Crates that have benches; the suite is the workspace itself."""
    return [*sorted(path.parent.name for path in root.glob("crates/*/benches")), "ndda-suite"]


def benches(root, crate):
    return (root if crate == "ndda-suite" else root / "crates" / crate) / "benches"


def is_counted(root, crate):
    return (benches(root, crate) / "counted.rs").exists()


def measure(root, names, clocks, with_caches=False):
    """A record of the crates of a working tree, and why crates are missing from it."""
    record = {"commit": commit(root), "rustc": output(root, "rustc", "--version"), "processor": processor()}
    kind = "cycles" if with_caches else "instructions"
    counted = [crate for crate in names if is_counted(root, crate)]
    record[kind], broken = counts(root, counted, with_caches)
    if clocks:
        record["nanoseconds"], slow = each(names, lambda crate: nanoseconds(root, crate))
        broken |= slow
    return record, broken


def each(names, figures, workers=1):
    """Figures of the crates that have them, and what broke of the others."""

    def attempt(crate):
        try:
            return figures(crate), None
        except Broken as error:
            return None, str(error)

    with ThreadPoolExecutor(workers) as pool:
        results = dict(zip(names, pool.map(attempt, names)))
    found = {crate: result for crate, (result, _) in results.items() if result is not None}
    return found, {crate: why for crate, (_, why) in results.items() if why}


def counts(root, names, with_caches):
    """Crates side by side: what is counted does not see the clock."""
    if not names:
        return {}, {}
    binaries, messages = counted_binaries(root)

    def figures(crate):
        if crate not in binaries:
            raise Broken(messages)
        return totals(root, crate, binaries[crate], with_caches)

    return each(names, figures, os.cpu_count())


def counted_binaries(root):
    """All counted benches by crate, built at once (crate by crate, each has other features of what they share), and the
    compiler's messages where one does not build."""
    options = ["--locked", "--workspace", "--bench", "counted", "--profile", "bench", "--keep-going"]
    options.append("--message-format=json-render-diagnostics")
    built = command(["cargo", "build", *options], root, cargo_environment(runner(root)))
    artifacts = [json.loads(line) for line in built.stdout.splitlines() if line.startswith("{")]
    found = {Path(a["manifest_path"]).parent.name: a["executable"] for a in artifacts if a.get("executable")}
    return found, shown(built.stderr)


def totals(root, crate, binary, with_caches):
    folder = TARGET / "gungraun" / crate
    shutil.rmtree(folder, ignore_errors=True)
    environment = dict(os.environ, CARGO_TARGET_DIR=str(TARGET), CARGO_PKG_NAME=crate, GUNGRAUN_RUNNER=str(runner(root)))
    caches = ["--callgrind-args=--cache-sim=yes"] if with_caches else []
    run([binary, "--bench", *caches], benches(root, crate).parent, environment)
    found = {}
    for path in sorted(folder.glob("counted/*/*/callgrind.*.out")):
        found[path.parent.name] = cost(path.read_text(), with_caches)
    if not found:
        raise Broken(f"callgrind left no totals in {folder}")
    return found


def cost(profile, with_caches):
    """Instructions of a profile, or its estimated cycles."""
    events = re.search(r"^events: (.+)", profile, re.MULTILINE).group(1).split()
    figures = re.search(r"^(?:totals|summary): (.+)", profile, re.MULTILINE).group(1).split()
    by_name = dict(zip(events, map(int, figures)))
    if not with_caches:
        return by_name["Ir"]
    first = sum(by_name.get(name, 0) for name in ("I1mr", "D1mr", "D1mw"))
    last_level = sum(by_name.get(name, 0) for name in ("ILmr", "DLmr", "DLmw"))
    return by_name["Ir"] + 5 * first + 30 * last_level


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
        record, broken = measure(tree, [crate for crate in crates(tree) if is_counted(tree, crate)], clocks=False)
        for crate, why in broken.items():
            print(f"{crate} was not measured:\n{why}", file=sys.stderr)
        return record
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
            # Simulated caches are those of the processor.
            same = [field for field in ("rustc", "processor") if field == "rustc" or kind == "cycles"]
            if kind in TOLERANCES and all(before.get(field) == after[field] for field in same):
                limit = 1 + TOLERANCES[kind]
                grown = [name for name in figures if name in old and figures[name] > limit * old[name]]
                slower += [f"{crate} {name} {change(old[name], figures[name]).strip()} {kind}" for name in grown]
            elif kind in TOLERANCES and before:
                print(f"  another compiler or processor than the record's ({before['rustc']}): shown, not judged")
    return slower


def cell(figure, unit):
    return f"{figure:>16,}{unit}" if figure is not None else " " * (16 + len(unit))


def change(old, new):
    if old is None or new is None:
        return "     gone" if new is None else "      new"
    return f"{100 * (new / old - 1):+8.2f} %" if old else ""


def draw(records):
    """A panel per crate: each figure over that of its first record."""
    sys.path.insert(0, str(ROOT / "docs" / "evidence"))
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


def cargo(root, *arguments):
    """Standard output of cargo in a working tree; all of them share one target folder."""
    return run(["cargo", *map(str, arguments)], root, cargo_environment())


def cargo_environment(runner=None):
    return dict(os.environ, CARGO_TARGET_DIR=str(TARGET), **({"GUNGRAUN_RUNNER": str(runner)} if runner else {}))


def run(arguments, folder, environment):
    result = command(arguments, folder, environment)
    if result.returncode != 0:
        raise Broken(f"{' '.join(map(str, arguments))}\n{shown(result.stdout)}\n{shown(result.stderr)}")
    return result.stdout


def command(arguments, folder, environment):
    return subprocess.run(arguments, cwd=folder, env=environment, capture_output=True, text=True)


def shown(text):
    """What a person reads of a failed command: no lines of progress."""
    progress = re.compile(r"\s*(Compiling|Downloading|Downloaded|Updating|Locking|Finished|Fresh|Blocking) ")
    lines = [line for line in text.splitlines() if not progress.match(line)]
    return "\n".join(lines[-SHOWN_LINES:])


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Broken as error:
        sys.exit(str(error))
