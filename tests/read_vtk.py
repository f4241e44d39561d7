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
# Components of every array that a frame may hold.
POINT_ARRAYS = {
    "displacement_m": 3,
    "velocity_m_s": 3,
    "acceleration_m_s2": 3,
    "contact_force_n": 3,
    "contact_traction_pa": 3,
    "friction_state": 1,
}
CELL_ARRAYS = {"block_id": 1, "material": 1, "stress_pa": 6, "von_mises_pa": 1}


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
    """The arrays of a frame's points or cells, known, finite and of the right shape."""
    found = {}
    for index in range(data.GetNumberOfArrays()):
        array = data.GetArray(index)
        name = data.GetArrayName(index)
        require(name in expected, f"{where}: nobody knows the array {name}")
        components = expected[name]
        count = array.GetNumberOfComponents()
        require(count == components, f"{where}: {name} has {count} components, not {components}")
        found[name] = vtk_to_numpy(array).astype(float)
        require(numpy.isfinite(found[name]).all(), f"{where}: {name} is not finite everywhere")
    return found


def digits(data):
    """Rounding of the numbers that were written."""
    kinds = [data.GetArray(index).GetDataTypeAsString() for index in range(data.GetNumberOfArrays())]
    return 1e-6 if "float" in kinds else 1e-12


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
    frame = {"digits": digits(grid.GetCellData()), "nodes": nodes, "points": vtk_to_numpy(grid.GetPoints().GetData()).astype(float)}
    frame.update(named_arrays(grid.GetPointData(), POINT_ARRAYS, path))
    frame.update(named_arrays(grid.GetCellData(), CELL_ARRAYS, path))
    return frame


def check_frame(frame, path):
    """What holds in each frame on its own."""
    require(numpy.isfinite(frame["points"]).all(), f"{path}: a point is not finite")
    a, b, c, d = (frame["points"][frame["nodes"][:, corner]] for corner in range(4))
    volumes = numpy.einsum("ij,ij->i", b - a, numpy.cross(c - a, d - a)) / 6.0
    require((volumes > 0.0).all(), f"{path}: {(volumes <= 0.0).sum()} inverted tetrahedra")
    if "block_id" in frame:
        blocks = numpy.unique(frame["block_id"])
        require((blocks == numpy.arange(len(blocks))).all(), f"{path}: block ids {blocks} are not 0, 1, 2, …")
    if "contact_force_n" in frame:
        total = numpy.linalg.norm(frame["contact_force_n"].sum(axis=0))
        size = numpy.abs(frame["contact_force_n"]).sum()
        require(total <= 1e-5 * size, f"{path}: contact forces sum to {total:g} N of {size:g} N")
    if "von_mises_pa" in frame and "stress_pa" in frame:
        check_von_mises(frame, path)


def check_von_mises(frame, path):
    """The one is that of the other, to the digits that were written."""
    xx, yy, zz, xy, yz, xz = frame["stress_pa"].T
    normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    expected = numpy.sqrt(0.5 * normal + 3.0 * (xy**2 + yz**2 + xz**2))
    largest = numpy.abs(frame["stress_pa"]).max()
    require(
        numpy.abs(frame["von_mises_pa"] - expected).max() <= frame["digits"] * largest,
        f"{path}: von_mises_pa is not that of stress_pa",
    )


def check_against_first(frame, first, path):
    """What does not change over time."""
    require(frame["points"].shape == first["points"].shape, f"{path}: the number of points changed")
    require(frame["nodes"].shape == first["nodes"].shape, f"{path}: the number of cells changed")
    require((frame["nodes"] == first["nodes"]).all(), f"{path}: the cells changed")
    for name in ("block_id", "material"):
        if name in frame:
            require((frame[name] == first[name]).all(), f"{path}: {name} changed")
    if "displacement_m" not in frame:
        return
    # Exact but for rounding, of a coordinate in the file and of the steps that led there.
    rest = frame["points"] - frame["displacement_m"]
    magnitude = max(numpy.abs(frame["points"]).max(), numpy.abs(frame["displacement_m"]).max())
    moved = numpy.abs(rest - first["points"]).max()
    require(
        moved <= frame["digits"] * magnitude,
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
            require(not frame.get("displacement_m", numpy.zeros(1)).any(), f"{path}: the first frame is displaced")
            first = frame
        check_against_first(frame, first, path)
        largest = [
            f"{name} ≤ {numpy.abs(frame[name]).max():.4g}" for name in (*POINT_ARRAYS, *CELL_ARRAYS) if name in frame
        ]
        print(f"{path.name}: t = {time:.6g} s, {len(frame['points'])} points, {len(frame['nodes'])} tetrahedra", *largest, sep=", ")
    print(f"{len(frames)} frames read by VTK without a complaint")


if __name__ == "__main__":
    try:
        main()
    except (Failure, ElementTree.ParseError) as failure:
        sys.exit(f"read_vtk.py: {failure}")
