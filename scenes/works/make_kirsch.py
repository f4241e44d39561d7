#!/usr/bin/env python3
"""Writes kirsch_glued.ron: a quarter of a circular tunnel in rings of blocks that are glued to each other.

Usage: make_kirsch.py > kirsch_glued.ron
"""

from math import cos, radians, sin

# Radii of the rings [m], cells of each along its radius, blocks around a quarter, and cells of each around it.
RADII, ALONG, BLOCKS, AROUND = [1, 1.4, 2, 3, 5], 5, 3, 10
WIDTH = 0.2
SHEAR, POISSON = 2.8e9, 0.210345
# Density times the length of a cell [kg/m²].
SCALED = 1000

HEAD = """// Kirsch's tunnel: a circular tunnel of 1 m radius in elastic rock under 30 MPa along x and 15 MPa along z, excavated in a stage. The rock is glued from twelve blocks
// by stiff bonds, and fixed at a radius of 5 m; x = 0 and z = 0 are planes of symmetry. Written by make_kirsch.py.
//
// Densities make the density times the length of a cell the same in all rings, so that no ring needs shorter steps than the others: there is no weight, and at rest
// nothing depends on them.
//
// Passes when displacements and stresses around the tunnel agree with the closed form for a fixed wall (`cargo test --test verification kirsch`): displacements to 1.3 % of
// the largest, stresses to 1.5 %.
"""


def ring(number):
    """The blocks of a ring, counted from 1."""
    inner, outer = RADII[number - 1 : number + 1]
    for block in range(BLOCKS):
        start, end = (90 * (block + k) / BLOCKS for k in (0, 1))
        yield (
            f'        (name: "ring_{number}_{block + 1}", material: "ring {number}", shape: Voussoir(inner_radius_m: {inner}, outer_radius_m: {outer}, '
            f"start_deg: {start:g}, end_deg: {end:g}, width_m: {WIDTH}, cells: ({ALONG}, 1, {AROUND}))),"
        )


def core():
    """The block that is taken out: a quarter of a disc with the corners of the innermost ring."""
    angles = [radians(90 * k / (BLOCKS * AROUND)) for k in range(BLOCKS * AROUND + 1)]
    outline = [(0.0, 0.0)] + [(RADII[0] * cos(a), RADII[0] * sin(a)) for a in angles]
    count = len(outline)
    corners = ", ".join(f"({x:.15g}, {y}, {z:.15g})" for y in (0, WIDTH) for x, z in outline)
    sides = [[k, count + k, count + (k + 1) % count, (k + 1) % count] for k in range(count)]
    faces = [list(range(count)), list(range(2 * count - 1, count - 1, -1)), *sides]
    return f'        (name: "core", material: "ring 1", shape: Polyhedron(fill: Centre, corners_m: [{corners}], faces: {faces})),'


def main():
    young = 2 * SHEAR * (1 + POISSON)
    rings = range(1, len(RADII))
    density = lambda number: SCALED * ALONG / (RADII[number] - RADII[number - 1])
    materials = [
        f'        (name: "ring {number}", young_pa: {young:.9g}, poisson: {POISSON}, density_kg_m3: {density(number):.6g}),' for number in rings
    ]
    blocks = [core(), *(line for number in rings for line in ring(number))]
    plane = lambda point, normal: f'        (block: "*", on: Plane(point_m: {point}, normal: {normal}), hold: Direction({normal})),'
    supports = [
        plane("(0, 0, 0)", "(1, 0, 0)"),
        plane("(0, 0, 0)", "(0, 0, 1)"),
        plane("(0, 0, 0)", "(0, 1, 0)"),
        plane(f"(0, {WIDTH}, 0)", "(0, 1, 0)"),
        f'        (block: "ring_{len(rings)}_*", on: Set("extrados"), hold: Fixed),',
    ]
    lines = [
        HEAD + "(",
        '    title: "Kirsch\'s tunnel in glued blocks",',
        "    time: (step_s: 7e-6, end_s: 1.4e-5),",
        f"    in_situ: (stress_pa: (xx: -30e6, yy: {-POISSON * 45e6:.9g}, zz: -15e6)),",
        "    settle: (tolerance: 1e-3),",
        "    materials: [",
        *materials,
        "    ],",
        "    blocks: [",
        *blocks,
        "    ],",
        "    supports: [",
        *supports,
        "    ],",
        "    contact: Potential(penalty_pa: 1.2e10, friction: (friction_deg: 35, shear_penalty_pa_m: 5e11, cohesion_pa: 1e10, tension_pa: 1e10)),",
        "    monitors: [",
        '        (name: "wall along x", block: "ring_1_1", at: Point((1, 0, 0))),',
        '        (name: "wall along z", block: "ring_1_3", at: Point((0, 0, 1))),',
        "    ],",
        '    stages: [(name: "tunnel", remove: ["core"], over_s: 5e-3, then: Settle(tolerance: 1e-3), reset_displacements: true)],',
        "    output: (frames: 4, history_rows: 100, fields: [Displacement, Stress, BlockId]),",
        ")",
    ]
    print("\n".join(lines))


if __name__ == "__main__":
    main()
