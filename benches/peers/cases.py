"""Which settings of which program each problem is run with, and with which steps.

Each program has its fastest sensible settings, found by trying integrators, cones, solvers,
stiffnesses and iterations."""

STIFF = {"solref": "{two_steps} 1"}
ELASTIC = {"solimp": "0.99 0.99 0.001"}


def mujoco(geom, **option):
    return {"geom": geom, "option": {"cone": "elliptic", **option}}


def bodies(body, penalty_pa, potential, count=2, **more):
    changes = {"contact.penalty_pa": penalty_pa, "contact.potential": potential}
    if count:
        changes |= {f"blocks[{i}].body": body for i in range(2 - count, 2)}
    return {"set": changes | more}


def pile(body, penalty_pa, **more):
    """The fewest tetrahedra; what the error and the depth at the end need, and nothing else, is written."""
    output = "(frames: 1, fields: [Displacement, BlockId], format: Base64, history_rows: 14)"
    changes = {"rock[0].body": body, "rock[0].fill": "Fewest", "output": output}
    return bodies(body, penalty_pa, "Smooth()", 0, **changes, **more)


COARSE = {"contact.friction_tolerance": 1e-3}
COARSER = {"contact.friction_tolerance": 1e-2}
LARGE_PILE_OF_NDDA = [
    ("rigid, k_n = 7 MPa, friction to 1e-2", pile("Rigid", 7e6, **COARSER), (7e-3,)),
    ("rigid, k_n = 9 MPa, friction to 1e-2", pile("Rigid", 9e6, **COARSER), (6e-3,)),
    ("rigid, k_n = 12 MPa, friction to 1e-3", pile("Rigid", 1.2e7, **COARSE), (5e-3,)),
    ("rigid, k_n = 12 MPa", pile("Rigid", 1.2e7), (5e-3,)),
    ("rigid, k_n = 20 MPa", pile("Rigid", 2e7), (4e-3,)),
    ("rigid, k_n = 50 MPa", pile("Rigid", 5e7), (2e-3, 1e-3)),
    ("rigid, k_n = 300 MPa", pile("Rigid", 3e8), (5e-4,)),
    ("affine, k_n = 50 MPa", pile("Affine", 5e7), (2e-3,)),
]
# Elastic cubes for 125 only.
PILE_OF_NDDA = [*LARGE_PILE_OF_NDDA, ("elastic, k_n = 50 MPa", pile("Elastic", 5e7), (2e-3,))]
PILE = {
    "mujoco": [
        (
            "implicitfast, CG to 1e-4, stiff",
            mujoco(STIFF, integrator="implicitfast", solver="CG", tolerance=1e-4),
            (4e-3, 2e-3, 1e-3),
        ),
        ("implicitfast, Newton, stiff", mujoco(STIFF, integrator="implicitfast"), (2e-3,)),
    ],
    "rapier": [("4 iterations", {"iterations": 4}, (4e-3, 2e-3, 1e-3))],
}

CASES = {
    "ramp": {
        "ndda": [
            ("rigid, element, k_n = 20 kPa", bodies("Rigid", 2e4, "Element", 1), (5e-3, 2e-3, 1e-3)),
            ("rigid, smooth, k_n = 200 kPa", bodies("Rigid", 2e5, "Smooth()", 1), (5e-3, 2e-3, 1e-3)),
            ("elastic, element, k_n = 20 kPa", bodies("Elastic", 2e4, "Element", 1), (5e-3, 2e-3, 1e-3)),
        ],
        "mujoco": [
            ("implicitfast, stiff", mujoco(STIFF, integrator="implicitfast"), (1e-2, 1e-3, 1e-4)),
            ("Runge-Kutta, stiff", mujoco(STIFF, integrator="RK4"), (1e-2, 5e-3, 1e-3)),
        ],
        "rapier": [
            ("1 iteration", {"iterations": 1}, (1e-2, 1e-3, 1e-4)),
            ("4 iterations", {"iterations": 4}, (1e-2, 1e-3, 1e-4)),
        ],
        "yade": [("k_n = 10 MPa/m", {"young": 1e7, "shear": 0.5}, (5e-3, 1e-3, 1e-4))],
    },
    "ramp_phi35": {
        "ndda": [
            ("rigid, element, k_n = 20 kPa", bodies("Rigid", 2e4, "Element", 1), (5e-3, 2e-3, 1e-3)),
            ("rigid, element, k_n = 200 kPa", bodies("Rigid", 2e5, "Element", 1), (2e-3, 1e-3, 5e-4)),
            ("elastic, element, k_n = 20 kPa", bodies("Elastic", 2e4, "Element", 1), (5e-3, 2e-3, 1e-3)),
        ],
        "mujoco": [
            ("implicitfast", mujoco({}, integrator="implicitfast"), (1e-2, 2e-3, 1e-3, 2e-4)),
            (
                "discrete, time constant 5 ms",
                mujoco({"solref": "0.005 1"}, integrator="discrete"),
                (1e-2, 2e-3, 1e-3, 2e-4),
            ),
            ("Runge-Kutta", mujoco({}, integrator="RK4"), (1e-2, 2e-3, 1e-3, 2e-4)),
        ],
        "rapier": [
            ("4 iterations, stiff", {"iterations": 4, "contact_hz": 300}, (1e-2, 1e-3, 1e-4)),
            ("4 iterations, stiff, its Coulomb model", {"iterations": 4, "contact_hz": 300, "coulomb": True}, (1e-3,)),
        ],
        "yade": [("k_n = 100 MPa/m", {"young": 1e8, "shear": 0.5}, (2e-3, 1e-3, 1e-4))],
    },
    "collision": {
        "ndda": [
            ("rigid, smooth, k_n = 2 MPa", bodies("Rigid", 2e6, "Smooth()"), (5e-3, 2e-3, 1e-3)),
            ("elastic, smooth, k_n = 2 MPa", bodies("Elastic", 2e6, "Smooth()"), (5e-3, 2e-3, 1e-3)),
            ("elastic, element, k_n = 500 kPa", bodies("Elastic", 5e5, "Element"), (5e-3, 4e-3, 2e-3)),
        ],
        "mujoco": [
            (
                "implicitfast, 1000/s², no damping",
                mujoco({"solref": "-1000 0", **ELASTIC}, integrator="implicitfast"),
                (1e-2, 1e-3, 1e-4),
            ),
            (
                "Runge-Kutta, 1000/s², no damping",
                mujoco({"solref": "-1000 0", **ELASTIC}, integrator="RK4"),
                (1e-2, 1e-3, 1e-4),
            ),
        ],
        "rapier": [("4 iterations, restitution 1", {"iterations": 4}, (1e-2, 1e-3, 1e-4))],
        "yade": [
            ("k_n = 10 MPa/m", {"young": 1e7, "shear": 0.5}, (1e-3, 1e-4, 2e-5)),
            ("k_n = 100 MPa/m", {"young": 1e8, "shear": 0.5}, (1e-3, 1e-4, 2e-5)),
        ],
        "calculix": [
            (
                "implicit, one brick per cube, node to surface, 2 MPa/m",
                {"cells": 1, "pair": "NODE TO SURFACE", "slope_pa_m": 2e6},
                (4e-3, 2e-3, 1e-3),
            ),
            (
                "implicit, one brick per cube, surface to surface, 2 MPa/m",
                {"cells": 1, "pair": "SURFACE TO SURFACE", "slope_pa_m": 2e6},
                (2e-3, 1e-3),
            ),
            (
                "implicit, 2³ bricks per cube, node to surface, 2 MPa/m",
                {"cells": 2, "pair": "NODE TO SURFACE", "slope_pa_m": 2e6},
                (2e-3,),
            ),
        ],
    },
    "pile_125": {"ndda": PILE_OF_NDDA, **PILE},
    "pile_512": {"ndda": LARGE_PILE_OF_NDDA, **PILE},
}
