#!/usr/bin/env python3
"""Reads meshes that ndda wrote with meshio and Gmsh, compares them, and writes them again for ndda to read.

Usage: mesh_exchange.py FOLDER        (needs the PyPI packages meshio, gmsh and numpy)
Run by the test crates/ndda-io/tests/mesh_exchange.rs. Exit 0: all well, 1: not, 3: a package is missing. Without Gmsh it
says so and goes on with meshio.
"""

import sys
from pathlib import Path

try:
    import meshio
    import numpy
except (ImportError, OSError) as missing:
    print(f"mesh_exchange.py: {missing}")
    sys.exit(3)
try:
    import gmsh
except (ImportError, OSError) as missing:
    # Its wheels need libraries of the system that draw (libGLU and others).
    gmsh = None
    print(f"SKIPPED: Gmsh, which cannot be imported: {missing}")

# What meshio writes again: name, format, options.
AGAIN = [
    ("meshio_zlib.vtu", "vtu", {"compression": "zlib"}),
    ("meshio_plain.vtu", "vtu", {"compression": None}),
    ("meshio_text.vtu", "vtu", {"binary": False}),
    ("meshio_42.vtk", "vtk42", {"binary": True}),
    ("meshio_42_text.vtk", "vtk42", {"binary": False}),
    ("meshio_51.vtk", "vtk51", {"binary": True}),
    ("meshio.inp", "abaqus", {}),
    ("meshio_41.msh", "gmsh", {"binary": True}),
    ("meshio_22.msh", "gmsh22", {"binary": False}),
    ("meshio.node", "tetgen", {}),
]


def require(condition, message):
    if not condition:
        sys.exit(f"mesh_exchange.py: {message}")


def meshio_agrees(folder, points, tets):
    """meshio reads the same nodes and tetrahedra from every format."""
    for name in ("a.msh", "a.vtu", "a.inp", "a.node"):
        mesh = meshio.read(folder / name)
        found = numpy.vstack([cells.data for cells in mesh.cells if cells.type == "tetra"])
        require(numpy.array_equal(mesh.points, points), f"meshio reads other nodes from {name}")
        require(numpy.array_equal(found, tets), f"meshio reads other tetrahedra from {name}")
        print(f"meshio {meshio.__version__} reads {name}: {len(points)} nodes, {len(tets)} tetrahedra")


def meshio_finds_polyhedra(folder):
    """The three blocks of a cut are cells with the volumes of their own."""
    mesh = meshio.read(folder / "blocks.vtu")
    kinds = [cells.type for cells in mesh.cells for _ in cells.data]
    require(len(kinds) == 3 and all(kind.startswith("polyhedron") for kind in kinds), f"blocks.vtu holds {kinds}")
    volume = sum(values.sum() for values in mesh.cell_data["volume_m3"])
    require(abs(volume - 6.0) < 1e-12, f"the blocks have {volume} m³, not 6")
    print(f"meshio reads blocks.vtu: {', '.join(kinds)}")


def gmsh_agrees(folder, bodies, sets):
    """Gmsh finds the bodies and sets, and writes the mesh again."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.open(str(folder / "a.msh"))
    found = {}
    for dim, tag in gmsh.model.getPhysicalGroups():
        entities = gmsh.model.getEntitiesForPhysicalGroup(dim, tag)
        tags = [gmsh.model.mesh.getElements(dim, entity)[1] for entity in entities]
        found[dim, gmsh.model.getPhysicalName(dim, tag)] = sum(len(t) for entity in tags for t in entity)
    expected = {(3, name): count for name, count in bodies} | {(0, name): count for name, count in sets}
    require(found == expected, f"Gmsh finds {found}, not {expected}")
    gmsh.write(str(folder / "gmsh_41.msh"))
    gmsh.write(str(folder / "gmsh.vtk"))
    gmsh.option.setNumber("Mesh.MshFileVersion", 2.2)
    gmsh.option.setNumber("Mesh.Binary", 1)
    gmsh.write(str(folder / "gmsh_22.msh"))
    gmsh.write(str(folder / "gmsh_binary.vtk"))
    gmsh.finalize()
    print(f"Gmsh {gmsh.__version__} reads a.msh: {len(bodies)} bodies, {len(sets)} sets")


def counted(path):
    """Pairs of name and number from lines `number name`."""
    lines = path.read_text().splitlines()
    return [(name, int(number)) for number, name in (line.split(" ", 1) for line in lines)]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__.strip())
    folder = Path(sys.argv[1])
    points = numpy.loadtxt(folder / "points.txt")
    tets = numpy.loadtxt(folder / "tets.txt", dtype=int)
    meshio_agrees(folder, points, tets)
    meshio_finds_polyhedra(folder)
    if gmsh:
        gmsh_agrees(folder, counted(folder / "bodies.txt"), counted(folder / "sets.txt"))
    body = numpy.loadtxt(folder / "body_of_tets.txt", dtype=int)
    for name, form, options in AGAIN:
        data = {} if form == "abaqus" or form.startswith("gmsh") else {"body": [body]}
        meshio.write(folder / name, meshio.Mesh(points, [("tetra", tets)], cell_data=data), form, **options)


if __name__ == "__main__":
    main()
