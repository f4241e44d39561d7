"""A problem of problems.py in ndda: peer_ndda.py PROBLEM.json SETTING.json prints its state at the end."""

import base64
import csv
import json
import os
import struct
import sys
import tempfile
from pathlib import Path
from xml.etree import ElementTree

import timed
from problems import mean

HERE = Path(__file__).resolve().parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", HERE.parent.parent / "target"))


def main():
    problem, setting = (json.loads(Path(path).read_text()) for path in sys.argv[1:3])
    with tempfile.TemporaryDirectory() as folder:
        ended = timed.run(command(problem, setting, folder))
        if ended.code:
            sys.exit(f"ndda stopped: {ended.err}")
        summary = json.loads(Path(folder, "summary.json").read_text())
        energies, corners = energies_j(folder), corners_m(problem, folder)
    # The loop's time is wall time, on one thread: no more than the processor time of all.
    loop_s = sum(time_s for stage, time_s in summary["stages_s"].items() if stage not in ("setup", "output"))
    print(
        json.dumps(
            {
                "version": f"{summary['version']} at {summary['machine']['commit']}",
                "steps": summary["steps"],
                "step_cpu_s": min(loop_s, ended.cpu_s),
                "step_wall_s": loop_s,
                "cpu_s": ended.cpu_s,
                "wall_s": ended.wall_s,
                "label": summary["label"]["word"],
                "energies_j": energies,
                "corners_m": corners,
                "velocities_m_s": [summary["blocks"][body["name"]]["velocity"] for body in problem["bodies"]],
                "centres_m": centres_m(problem, summary, corners),
            }
        )
    )


def command(problem, setting, folder):
    scene, changes = HERE / "scenes" / f"{problem['name']}.ron", {"time.step_s": setting["step_s"], **setting["set"]}
    sets = [part for path, value in changes.items() for part in ("--set", f"{path}={value}")]
    ndda = TARGET / "release" / "ndda"
    return [ndda, "run", scene, "--out", folder, "--force", "--quiet", "--threads", "1", *sets]


def centres_m(problem, summary, corners):
    """Of the corners where there are any, else by monitors: one per body, in their order."""
    if corners:
        return [mean(points) for points in corners]
    ways = [monitor["displacement"] for monitor in summary["monitors"].values()]
    return [[c + w for c, w in zip(body["centre_m"], way)] for body, way in zip(problem["bodies"], ways)]


def energies_j(folder):
    """All energy but what friction took, of every row [J]."""
    with open(Path(folder, "history.csv")) as file:
        return [
            sum(float(row[part]) for part in ("kinetic_j", "strain_j", "contact_j", "load_j"))
            for row in csv.DictReader(file)
        ]


def corners_m(problem, folder):
    """Corners of every body at the end, from the last frame if there is one: nodes that began where corners were."""
    frames = sorted(Path(folder, "fields").glob("frame_*.vtu"))
    if not frames:
        return []
    piece = ElementTree.parse(frames[-1]).find(".//Piece")
    points, moved = vectors(piece, "Points/DataArray"), vectors(piece, "PointData/DataArray[@Name='displacement_m']")
    blocks = {}
    for point, way, block in zip(points, moved, node_blocks(piece, len(points))):
        began = tuple(p - w for p, w in zip(point, way))
        blocks.setdefault(block, {})[key(began)] = (began, point)
    by_centre = {key(mean([began for began, _ in nodes.values()])): nodes for nodes in blocks.values()}
    return [
        [
            by_centre[key(body["centre_m"])][key(c + p for c, p in zip(body["centre_m"], corner))][1]
            for corner in body["corners_m"]
        ]
        for body in problem["bodies"]
    ]


def node_blocks(piece, count):
    cells, block_id = (
        array(piece, "Cells/DataArray[@Name='connectivity']"),
        array(piece, "CellData/DataArray[@Name='block_id']"),
    )
    blocks = [0] * count
    for tet, block in enumerate(block_id):
        for node in cells[4 * tet : 4 * tet + 4]:
            blocks[node] = block
    return blocks


def key(place):
    return tuple(round(1e6 * c) for c in place)


def vectors(piece, path):
    values = array(piece, path)
    return [values[i : i + 3] for i in range(0, len(values), 3)]


def array(piece, path):
    """An array of VTK's inline base 64, whose length comes first, in eight bytes."""
    element = piece.find(path)
    data = base64.b64decode(element.text.strip())
    kind = {"Float64": "d", "Float32": "f", "Int64": "q", "Int32": "i", "UInt32": "I", "UInt8": "B"}[
        element.get("type")
    ]
    return [value for (value,) in struct.iter_unpack("<" + kind, data[8:])]


if __name__ == "__main__":
    main()
