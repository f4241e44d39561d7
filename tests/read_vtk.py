#!/usr/bin/env python3
"""Reads the fields of a run with VTK's own reader, the one inside ParaView, and checks what it finds.

Usage: read_vtk.py OUTDIR        (needs the PyPI packages vtk and numpy; exit 0: all well, 1: not)
"""

import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

VTK_TETRA = 10
POINT_ARRAYS = {"displacement_m": 3, "velocity_m_s": 3}
CELL_ARRAYS = {"block_id": 1, "stress_pa": 6, "von_mises_pa": 1}


class Failure(Exception):
    """What is wrong with the files."""


def require(condition, message):
    if not condition:
        raise Failure(message)


class Complaints:
    """Everything that VTK reports while files are read; a clean file gives nothing."""

    def __init__(self):
        self.texts = []
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
        window = vtkOutputWindow.GetInstance()
        window.SetDisplayModeToNever()
        self.watch(window)

    def watch(self, source):
        for event in ("ErrorEvent", "WarningEvent"):
            source.AddObserver(event, self.note)

    def note(self, _source, _event, text):
        self.texts.append(" ".join(text.strip().splitlines()[:2]))

    # How VTK is told to pass the text on.
    note.CallDataType = "string0"


def listed_frames(index):
    """Times and files of fields.pvd."""
    require(index.is_file(), f"{index} is missing")
    entries = ElementTree.parse(index).getroot().findall("./Collection/DataSet")
    require(entries, f"{index} lists no frame")
    frames = []
    for entry in entries:
        path = Path(entry.get("file"))
        require(not path.is_absolute() and ".." not in path.parts, f"{path} is not below the folder")
        frames.append((float(entry.get("timestep")), index.parent / path))
    times = [time for time, _ in frames]
    require(all(a < b for a, b in zip(times, times[1:])), f"times do not increase: {times}")
    return frames


def named_arrays(data, expected, where):
    """The arrays of a frame's points or cells, finite and of the right shape."""
    found = {}
    for name, components in expected.items():
        array = data.GetArray(name)
        require(array is not None, f"{where}: no array {name}")
        count = array.GetNumberOfComponents()
        require(count == components, f"{where}: {name} has {count} components, not {components}")
        found[name] = vtk_to_numpy(array).astype(float)
        require(numpy.isfinite(found[name]).all(), f"{where}: {name} is not finite everywhere")
    return found


def read_frame(path, complaints):
    """Topology and arrays of one file."""
    require(path.is_file(), f"{path} is listed but missing")
    reader = vtkXMLUnstructuredGridReader()
    complaints.watch(reader)
    require(reader.CanReadFile(str(path)), f"{path}: VTK does not take it for an unstructured grid")
    reader.SetFileName(str(path))
    reader.Update()
    require(not complaints.texts, f"{path}: " + "; ".join(complaints.texts))
    require(reader.GetErrorCode() == 0, f"{path}: VTK error {reader.GetErrorCode()}")
    grid = reader.GetOutput()
    points, cells = grid.GetNumberOfPoints(), grid.GetNumberOfCells()
    require(points > 0 and cells > 0, f"{path}: {points} points, {cells} cells")
    kinds = {grid.GetCellType(cell) for cell in range(cells)}
    require(kinds == {VTK_TETRA}, f"{path}: cell types {sorted(kinds)}, not tetrahedra only")
    nodes = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(cells, 4)
    require(0 <= nodes.min() and nodes.max() < points, f"{path}: a cell refers to a point that is not there")
    frame = {"nodes": nodes, "points": vtk_to_numpy(grid.GetPoints().GetData()).astype(float)}
    frame.update(named_arrays(grid.GetPointData(), POINT_ARRAYS, path))
    frame.update(named_arrays(grid.GetCellData(), CELL_ARRAYS, path))
    return frame


def check_frame(frame, path):
    """What holds in each frame on its own."""
    require(numpy.isfinite(frame["points"]).all(), f"{path}: a point is not finite")
    a, b, c, d = (frame["points"][frame["nodes"][:, corner]] for corner in range(4))
    volumes = numpy.einsum("ij,ij->i", b - a, numpy.cross(c - a, d - a)) / 6.0
    require((volumes > 0.0).all(), f"{path}: {(volumes <= 0.0).sum()} inverted tetrahedra")
    blocks = numpy.unique(frame["block_id"])
    require((blocks == numpy.arange(len(blocks))).all(), f"{path}: block ids {blocks} are not 0, 1, 2, …")
    xx, yy, zz, xy, yz, xz = frame["stress_pa"].T
    normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    expected = numpy.sqrt(0.5 * normal + 3.0 * (xy**2 + yz**2 + xz**2))
    largest = numpy.abs(frame["stress_pa"]).max()
    require(
        numpy.abs(frame["von_mises_pa"] - expected).max() <= 1e-12 * largest,
        f"{path}: von_mises_pa is not that of stress_pa",
    )


def check_against_first(frame, first, path):
    """What does not change over time."""
    require(frame["points"].shape == first["points"].shape, f"{path}: the number of points changed")
    require(frame["nodes"].shape == first["nodes"].shape, f"{path}: the number of cells changed")
    require((frame["nodes"] == first["nodes"]).all(), f"{path}: the cells changed")
    require((frame["block_id"] == first["block_id"]).all(), f"{path}: the blocks changed")
    # Exact but for rounding, of a coordinate in the file and of the steps that led there.
    rest = frame["points"] - frame["displacement_m"]
    magnitude = max(numpy.abs(frame["points"]).max(), numpy.abs(frame["displacement_m"]).max())
    moved = numpy.abs(rest - first["points"]).max()
    require(
        moved <= 1e-12 * magnitude,
        f"{path}: position minus displacement is off by {moved:g} m from the first frame",
    )


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__.strip())
    frames = listed_frames(Path(sys.argv[1]) / "fields.pvd")
    complaints = Complaints()
    first = None
    for time, path in frames:
        frame = read_frame(path, complaints)
        check_frame(frame, path)
        if first is None:
            require(not frame["displacement_m"].any(), f"{path}: the first frame is displaced")
            first = frame
        check_against_first(frame, first, path)
        print(
            f"{path.name}: t = {time:.6g} s, {len(frame['points'])} points, {len(frame['nodes'])} tetrahedra, "
            f"|u| ≤ {numpy.linalg.norm(frame['displacement_m'], axis=1).max():.4g} m, "
            f"von Mises ≤ {frame['von_mises_pa'].max():.4g} Pa"
        )
    blocks = len(numpy.unique(first["block_id"]))
    print(f"{len(frames)} frames of {blocks} blocks read by VTK without a complaint")


if __name__ == "__main__":
    try:
        main()
    except (Failure, ElementTree.ParseError) as failure:
        sys.exit(f"read_vtk.py: {failure}")
