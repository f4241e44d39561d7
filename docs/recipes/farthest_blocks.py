"""Largest displacement of every block in the last frame, with meshio. Usage: farthest_blocks.py RUN"""

import sys
from pathlib import Path

import meshio
import numpy
import pandas

frames = sorted(Path(sys.argv[1], "fields").glob("frame_*.vtu"))
mesh = meshio.read(frames[-1])
size = numpy.linalg.norm(mesh.point_data["displacement_m"], axis=1)
# A block's tetrahedra know its number; the nodes of a tetrahedron are of that block alone.
tets = mesh.cells_dict["tetra"]
block = mesh.cell_data_dict["block_id"]["tetra"]
table = pandas.DataFrame({"block": block, "displacement_m": size[tets].max(axis=1)})
print(f"{frames[-1].name}: {len(mesh.points)} nodes, {len(tets)} tetrahedra")
print(table.groupby("block").max().sort_values("displacement_m", ascending=False).head(10))
