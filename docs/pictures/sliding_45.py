#!/usr/bin/env python3
"""Draws docs/pictures/sliding_45.png from the results of `ndda run scenes/sliding_45.ron`.

Usage: sliding_45.py OUTPUT_FOLDER PICTURE     (needs the packages matplotlib, numpy and vtk)
"""

import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader


def frame(path):
    """Triangles of the surface where they are now, the block and the speed of each."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    surface = vtkGeometryFilter()
    surface.SetInputConnection(reader.GetOutputPort())
    surface.Update()
    data = surface.GetOutput()
    field = lambda name: vtk_to_numpy(data.GetPointData().GetArray(name))
    points = vtk_to_numpy(data.GetPoints().GetData())
    corners = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    block = vtk_to_numpy(data.GetCellData().GetArray("block_id"))
    return points[corners], block, np.linalg.norm(field("velocity_m_s"), axis=1)[corners].mean(axis=1)


def main(folder, picture):
    frames = sorted((folder / "fields").glob("*.vtu"))
    shown = [frames[i] for i in (0, 14, 20)]
    fastest = frame(frames[-1])[2].max()
    colours = plt.colormaps["viridis"]
    figure = plt.figure(figsize=(11, 4.6))
    ax = figure.add_axes((-0.05, -0.14, 0.66, 1.26), projection="3d", computed_zorder=False, proj_type="ortho")
    for i, path in enumerate(shown):
        triangles, block, speed = frame(path)
        for b in (0, 1):
            if b == 0 and i > 0:
                continue
            here = block == b
            face = [(0.80, 0.77, 0.72)] * here.sum() if b == 0 else colours(speed[here] / fastest)
            ax.add_collection3d(
                Poly3DCollection(triangles[here], facecolors=face, edgecolors=(0, 0, 0, 0.35), linewidths=0.5, zorder=i + b)
            )
    ax.set(xlim=(0, 1.5), ylim=(-0.45, 0.45), zlim=(0, 1.5))
    ax.set_box_aspect((1.5, 0.9, 1.5))
    ax.view_init(elev=14, azim=-78)
    ax.set_axis_off()
    bar = figure.colorbar(plt.cm.ScalarMappable(plt.Normalize(0, fastest), colours), ax=ax, shrink=0.5, pad=0.0)
    bar.set_label("speed [m/s]")
    figure.text(0.30, 0.86, "the block at 0, 0.35 and 0.5 s", fontsize=10)

    with open(folder / "history.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))[1:]
    time = [float(row["time_s"]) for row in rows]
    error = [max(float(row["reference_error"]), 1e-17) for row in rows]
    curve = figure.add_axes((0.70, 0.16, 0.28, 0.70))
    curve.semilogy(time, error, color="tab:blue")
    curve.axhline(1e-4, color="0.5", ls="--")
    curve.text(0.02, 1.3e-4, "the paper's 1e-4", color="0.35", fontsize=9)
    curve.set(xlabel="time [s]", ylim=(1e-11, 1e-3), title="relative error against ½ g sin α t²")
    curve.title.set_fontsize(10)
    curve.grid(alpha=0.3)
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
