"""Laboratory tests of one joint: direct shear and closure, without blocks.

>>> import ndda
>>> test = ndda.joint.shear("(friction_deg: 30, shear_penalty_pa_m: 1e10)", normal_stress_pa=1e6)
>>> round(float(test.rows["shear_pa"][-1]))
577350
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ndda import _core
from ndda._scene import load, parse, value_in_ron

if TYPE_CHECKING:
    import os

    from ndda.builders import Friction

__all__ = ["Test", "closure", "shear"]

_BLANK = """Scene(
    title: "a joint", time: (step_s: 1e-3, end_s: 1),
    materials: [(name: "rock", density_kg_m3: 2650, young_pa: 20e9, poisson: 0.25)],
    blocks: [
        (name: "lower", material: "rock", body: Fixed, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))),
        (name: "upper", material: "rock", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, 1)),
    ],
    contact: Potential(potential: Smooth(), friction: (friction_deg: 30)),
)"""


@dataclass(frozen=True)
class Test:
    """A test of a joint and what came of it.

    Attributes
    ----------
    title : str
        The joint, its law and how it is held.
    rows : structured array
        A row for each step. Of a shear test: `slip_m`, `shear_pa`, `normal_pa`, `opening_m`, `dilation_m`,
        `plastic_slip_m`, `dissipated_j_m2`; of a closure: `closure_m`, `normal_pa`, `tangent_pa_m`, `energy_j_m2`.
    comparisons : list of dict
        Differences from closed forms.

    Examples
    --------
    >>> import ndda
    >>> test = ndda.joint.closure(joint_stiffness_pa_m=1e10, normal_stress_pa=1e6)
    >>> float(test.rows["closure_m"][-1])
    0.0001
    """

    title: str
    rows: npt.NDArray[Any]
    comparisons: list[dict[str, Any]]


def _scene(law: object) -> _core.Scene:
    if isinstance(law, _core.Scene):
        return law
    if law is None:
        return parse(_BLANK)
    if isinstance(law, Mapping):
        from ndda.builders import Friction

        law = Friction.from_dict(law)
    text = value_in_ron(law)
    if text.lstrip().startswith(("(", "Friction")):
        return parse(_BLANK, **{"contact.friction": text})
    return load(text)


def _test(law: object, kind: str, options: Mapping[str, object]) -> Test:
    found = json.loads(_core._joint(_scene(law), kind, options))
    rows = found["rows"]
    names = list(rows[0]) if rows else []
    table = np.array([tuple(row.values()) for row in rows], dtype=[(name, "f8") for name in names])
    return Test(found["title"], table, found["comparisons"])


def shear(
    law: _core.Scene | Friction | Mapping[str, Any] | str | os.PathLike[str],
    *,
    of: str | None = None,
    between: tuple[str, str] | None = None,
    normal_stress_pa: float = 1e6,
    amplitude_m: float = 0.01,
    cycles: int = 0,
    steps: int = 1000,
    constant_volume: bool = False,
    spring_pa_m: float | None = None,
    joint_stiffness_pa_m: float | None = None,
    max_closure_m: float | None = None,
) -> Test:
    """Shear a joint.

    Parameters
    ----------
    law : Scene, builders.Friction, mapping or str
        The friction law, as `contact.friction` of a scene has it, or a scene that has it.
    of : str, optional
        The joint of the scene whose law is tested; `contact.friction` otherwise.
    between : tuple of 2 str, optional
        The materials of the scene whose law is tested.
    normal_stress_pa : float
        Normal stress at the start [Pa].
    amplitude_m : float
        Slip to shear to [m].
    cycles : int
        Cycles forth and back; 0 shears in one direction.
    steps : int
        Number of increments from the start to the amplitude.
    constant_volume : bool
        Whether nothing may open the joint, in place of a constant normal stress.
    spring_pa_m : float, optional
        Stiffness of a spring that holds the joint [Pa/m], in place of a constant normal stress.
    joint_stiffness_pa_m, max_closure_m : float, optional
        Normal stiffness of the joint [Pa/m], and its largest closure [m] if it is a hyperbola.

    Returns
    -------
    Test

    Raises
    ------
    SceneError, ValueError
        The law cannot be used, or the test not be done.

    Examples
    --------
    >>> import ndda
    >>> law = {"friction_deg": 30, "shear_penalty_pa_m": 1e10}
    >>> test = ndda.joint.shear(law, normal_stress_pa=2e6, amplitude_m=0.005)
    >>> round(float(test.rows["shear_pa"].max() / 2e6), 4)
    0.5774
    """
    options = {
        "of": of,
        "between": between,
        "normal_stress_pa": normal_stress_pa,
        "amplitude_m": amplitude_m,
        "cycles": cycles,
        "steps": steps,
        "constant_volume": constant_volume,
        "spring_pa_m": spring_pa_m,
        "joint_stiffness_pa_m": joint_stiffness_pa_m,
        "max_closure_m": max_closure_m,
    }
    return _test(law, "shear", options)


def closure(
    law: _core.Scene | None = None,
    *,
    normal_stress_pa: float = 1e6,
    steps: int = 1000,
    joint_stiffness_pa_m: float | None = None,
    max_closure_m: float | None = None,
) -> Test:
    """Close a joint.

    Parameters
    ----------
    law : Scene, optional
        A scene whose potential has the stiffness; not needed with `joint_stiffness_pa_m`.
    normal_stress_pa : float
        Normal stress at the end [Pa].
    steps : int
        Steps of closure.
    joint_stiffness_pa_m, max_closure_m : float, optional
        Normal stiffness of the joint [Pa/m], and its largest closure [m] if it is a hyperbola.

    Returns
    -------
    Test

    Raises
    ------
    ValueError
        The joint has no stiffness, or a number is out of range.

    Examples
    --------
    >>> import ndda
    >>> test = ndda.joint.closure(joint_stiffness_pa_m=20e9, max_closure_m=0.3e-3, normal_stress_pa=10e6)
    >>> float(test.rows["closure_m"][-1]) < 0.3e-3
    True
    """
    options = {
        "normal_stress_pa": normal_stress_pa,
        "steps": steps,
        "joint_stiffness_pa_m": joint_stiffness_pa_m,
        "max_closure_m": max_closure_m,
    }
    return _test(law, "closure", options)
