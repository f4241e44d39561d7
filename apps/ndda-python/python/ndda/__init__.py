"""Rock blocks that slide, topple, collide and fall.

A scene describes blocks, materials, contact, supports and time; `load` reads it, `Simulation` steps it.
Units are SI: m, s, kg, N, Pa, J.

>>> import ndda
>>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
>>> simulation.step(50)
>>> fallen_m = -float(simulation.displacement[0, 2])
>>> abs(fallen_m - 0.5 * 9.81 * 0.5**2) < 1e-9
True
"""

from ndda._core import Scene, SceneError, Snapshot, StopError, __version__
from ndda._scene import EXAMPLE, load, parse, run
from ndda._simulation import Simulation

__all__ = [
    "EXAMPLE",
    "Scene",
    "SceneError",
    "Simulation",
    "Snapshot",
    "StopError",
    "__version__",
    "load",
    "parse",
    "run",
]
