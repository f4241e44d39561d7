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

from __future__ import annotations

from typing import TYPE_CHECKING

from ndda._core import Scene, SceneError, Snapshot, StopError, __version__
from ndda._scene import EXAMPLE, load, parse, run
from ndda._simulation import Simulation, resume
from ndda._tools import certify, picture, safety, stereonet, study

if TYPE_CHECKING:
    from ndda import builders, joint
    from ndda._results import Results, read
    from ndda._view import Page, Picture

__all__ = [
    "EXAMPLE",
    "Page",
    "Picture",
    "Results",
    "Scene",
    "SceneError",
    "Simulation",
    "Snapshot",
    "StopError",
    "__version__",
    "builders",
    "certify",
    "joint",
    "load",
    "parse",
    "picture",
    "read",
    "resume",
    "run",
    "safety",
    "stereonet",
    "study",
]

# Modules that are rarely needed are imported on first use, to keep `import ndda` fast.
_LATER = {
    "Page": "ndda._view",
    "Picture": "ndda._view",
    "Results": "ndda._results",
    "builders": "ndda.builders",
    "joint": "ndda.joint",
    "read": "ndda._results",
}


def __getattr__(name: str) -> object:
    if name not in _LATER:
        raise AttributeError(f"module 'ndda' has no attribute {name!r}")
    from importlib import import_module

    module = import_module(_LATER[name])
    return module if _LATER[name] == f"ndda.{name}" else getattr(module, name)


def __dir__() -> list[str]:
    return sorted(__all__)
