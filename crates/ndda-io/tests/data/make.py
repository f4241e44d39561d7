"""Writes the meshes of this folder that Gmsh made: `pip install gmsh && python make.py` (Gmsh 4.15)."""

import gmsh


def volumes():
    return [tag for _, tag in gmsh.model.getEntities(3)]


def surfaces_at_height(z):
    at = lambda tag: gmsh.model.occ.getCenterOfMass(2, tag)
    return [tag for _, tag in gmsh.model.getEntities(2) if abs(at(tag)[2] - z) < 1e-9]


def two_boxes():
    """Two boxes apart, with names that have a space, a curve without a name, and a point."""
    gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.addBox(2, 0, 0, 1, 1, 2)
    gmsh.model.occ.synchronize()
    gmsh.model.addPhysicalGroup(3, [1], 7, "lower block")
    gmsh.model.addPhysicalGroup(3, [2], 3, "upper")
    gmsh.model.addPhysicalGroup(2, surfaces_at_height(0), 8, "bottom")
    gmsh.model.addPhysicalGroup(1, [1], 10)
    gmsh.model.addPhysicalGroup(0, [1], 11, "corner")


def touching():
    """Two boxes that share the nodes of a face."""
    below, above = gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1), gmsh.model.occ.addBox(0, 0, 1, 1, 1, 1)
    gmsh.model.occ.fragment([(3, below)], [(3, above)])
    gmsh.model.occ.synchronize()
    for tag in volumes():
        gmsh.model.addPhysicalGroup(3, [tag], tag)
    gmsh.model.addPhysicalGroup(2, surfaces_at_height(1), 9, "joint")
    gmsh.model.addPhysicalGroup(2, surfaces_at_height(2), 10, "top")


def overlapping():
    """The same, with both boxes in one more group."""
    touching()
    gmsh.model.addPhysicalGroup(3, volumes(), 20, "all")


def bricks():
    """Hexahedra."""
    square = gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
    gmsh.model.occ.synchronize()
    gmsh.model.mesh.setTransfiniteSurface(square)
    gmsh.model.mesh.setRecombine(2, square)
    gmsh.model.occ.extrude([(2, square)], 0, 0, 1, [1], recombine=True)
    gmsh.model.occ.synchronize()


def one_box():
    """No groups at all."""
    gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.synchronize()


def save(name, build, dim=3, order=1, parametric=0):
    gmsh.clear()
    gmsh.model.add(name)
    build()
    gmsh.option.setNumber("Mesh.MeshSizeMin", 1)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 1)
    gmsh.option.setNumber("Mesh.SaveParametric", parametric)
    gmsh.model.mesh.generate(dim)
    gmsh.model.mesh.setOrder(order)
    for version, number in [("v2", 2.2), ("v4", 4.1)]:
        for binary, encoding in [(0, "ascii"), (1, "binary")]:
            gmsh.option.setNumber("Mesh.MshFileVersion", number)
            gmsh.option.setNumber("Mesh.Binary", binary)
            gmsh.write(f"{name}_{version}_{encoding}.msh")


gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
save("two_boxes", two_boxes)
save("touching", touching)
save("overlapping", overlapping)
save("bricks", bricks)
save("one_box", one_box)
save("one_box_surface", one_box, dim=2)
save("one_box_order_2", one_box, order=2)
save("one_box_parametric", one_box, parametric=1)
