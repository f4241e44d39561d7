"""A problem of problems.py in YADE's polyhedra: yade -n -x peer_yade.py PROBLEM.json SETTING.json prints its end."""

import json
import math
import sys
import time
from pathlib import Path

from yade import O, Vector3, config, polyhedra_utils
from yade.wrapper import (
    Bo1_Polyhedra_Aabb,
    ForceResetter,
    Ig2_Polyhedra_Polyhedra_PolyhedraGeom,
    InsertionSortCollider,
    InteractionLoop,
    Ip2_PolyhedraMat_PolyhedraMat_PolyhedraPhys,
    Law2_PolyhedraGeom_PolyhedraPhys_Volumetric,
    NewtonIntegrator,
    PolyhedraMat,
)


def main():
    problem, setting = (json.loads(Path(path).read_text()) for path in sys.argv[1:3])
    bodies = build(problem, setting)
    steps = round(problem["end_s"] / setting["step_s"])
    O.dt = setting["step_s"]
    wall, cpu = time.perf_counter(), time.process_time()
    O.run(steps, True)
    wall_s, cpu_s = time.perf_counter() - wall, time.process_time() - cpu
    print(
        json.dumps(
            {
                "version": config.version,
                "steps": steps,
                "step_cpu_s": cpu_s,
                "step_wall_s": wall_s,
                "energies_j": [],
                "corners_m": [],
                "centres_m": [list(body.state.pos) for body in bodies],
                "velocities_m_s": [list(body.state.vel) for body in bodies],
            }
        ),
        flush=True,
    )


def build(problem, setting):
    """Force is the shared volume by `young`; no numerical damping."""
    rock = PolyhedraMat(
        density=problem["density_kg_m3"],
        young=setting["young"],
        poisson=setting["shear"],
        frictionAngle=math.atan(problem["friction"]),
    )
    for support in problem["supports"]:
        O.bodies.append(polyhedra_utils.polyhedra(rock, v=[tuple(c) for c in support["corners_m"]], fixed=True))
    bodies = []
    for given in problem["bodies"]:
        world = [Vector3(*given["centre_m"]) + Vector3(*corner) for corner in given["corners_m"]]
        body = polyhedra_utils.polyhedra(rock, v=[tuple(c) for c in world])
        body.state.vel = given["velocity_m_s"]
        O.bodies.append(body)
        bodies.append(body)
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Polyhedra_Aabb()]),
        InteractionLoop(
            [Ig2_Polyhedra_Polyhedra_PolyhedraGeom()],
            [Ip2_PolyhedraMat_PolyhedraMat_PolyhedraPhys()],
            [Law2_PolyhedraGeom_PolyhedraPhys_Volumetric()],
        ),
        NewtonIntegrator(damping=0, gravity=problem["gravity_m_s2"]),
    ]
    return bodies


main()
