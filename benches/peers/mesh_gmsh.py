#!/usr/bin/env python3
"""Meshes the blocks of an OBJ file with Gmsh, one after the other, as the example `fill` does with other programs.

Usage: mesh_gmsh.py BLOCKS.obj SIZE        Prints: name, seconds, tetrahedra, those below 10°, smallest angle.
"""

import sys
import time

import gmsh
import numpy


def blocks_of(path):
    """Vertices and faces (indices of vertices) of each object."""
    vertices, blocks = [], []
    for line in open(path):
        kind, *words = line.split()
        if kind == "o":
            blocks.append([])
        elif kind == "v":
            vertices.append([float(word) for word in words])
        elif kind == "f":
            blocks[-1].append([int(word) - 1 for word in words])
    return vertices, blocks


def mesh(vertices, faces, size):
    """Corners of the tetrahedra of one block."""
    gmsh.clear()
    geo = gmsh.model.geo
    point = {v: geo.addPoint(*vertices[v], size) for v in {v for face in faces for v in face}}
    lines = {}

    def line(a, b):
        if (b, a) in lines:
            return -lines[b, a]
        if (a, b) not in lines:
            lines[a, b] = geo.addLine(point[a], point[b])
        return lines[a, b]

    loops = [geo.addCurveLoop([line(a, b) for a, b in zip(face, face[1:] + face[:1])]) for face in faces]
    geo.addVolume([geo.addSurfaceLoop([geo.addPlaneSurface([loop]) for loop in loops])])
    geo.synchronize()
    gmsh.model.mesh.generate(3)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    place = numpy.zeros((int(tags.max()) + 1, 3))
    place[tags.astype(int)] = coordinates.reshape(-1, 3)
    _, nodes = gmsh.model.mesh.getElementsByType(4)
    return place[nodes.astype(int).reshape(-1, 4)]


def smallest_dihedral_deg(corners):
    """The smallest of the six dihedral angles of each tetrahedron."""
    least = numpy.full(len(corners), 180.0)
    for i, j, k, l in [(0, 1, 2, 3), (0, 2, 1, 3), (0, 3, 1, 2), (1, 2, 0, 3), (1, 3, 0, 2), (2, 3, 0, 1)]:
        edge = corners[:, j] - corners[:, i]
        a = numpy.cross(edge, corners[:, k] - corners[:, i])
        b = numpy.cross(edge, corners[:, l] - corners[:, i])
        sine = numpy.linalg.norm(numpy.cross(a, b), axis=1)
        least = numpy.minimum(least, numpy.degrees(numpy.arctan2(sine, (a * b).sum(axis=1))))
    return least


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip())
    vertices, blocks = blocks_of(sys.argv[1])
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    start = time.perf_counter()
    corners = [mesh(vertices, faces, float(sys.argv[2])) for faces in blocks]
    seconds = time.perf_counter() - start
    angles = smallest_dihedral_deg(numpy.concatenate(corners))
    print(f"Gmsh {seconds:.3f} {len(angles)} {(angles < 10).sum()} {angles.min():.2f}")
    gmsh.finalize()


if __name__ == "__main__":
    main()
