"""A friction law in Python: arrays in, arrays out, once a step."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from ndda._checks import finite, whole

_MOST_STATE = 1000


@dataclass(frozen=True)
class Facets:
    """All facets in contact in a step, as a friction law sees them; vectors are in global axes.

    Attributes
    ----------
    dt : float
        Time step [s].
    first, second : array of int, shape (facets,)
        Blocks of each facet and of what it is pressed into.
    area : array, shape (facets,)
        Area of contact that a facet stands for [m²]: half of what it has in contact, since where blocks touch, the faces of both
        are facets. `normal_force / area` is the pressure, and stresses times `area` add up to the force between blocks.
    normal : array, shape (facets, 3)
        Outward normal of the facet.
    normal_force : array, shape (facets,)
        Force on the facet against its normal [N].
    slip : array, shape (facets, 3)
        Slip of the facet on the other block in this step [m], along the facet.
    shear : array, shape (facets, 3)
        Shear force on the facet that the law gave in the last step [N], zero where contact begins.
    state : array, shape (facets, law.state_len)
        Numbers of the law's own, zero where contact begins; what it writes there is kept.

    Examples
    --------
    >>> import numpy as np
    >>> none, vectors = np.zeros(0), np.zeros((0, 3))
    >>> blocks = np.zeros(0, int)
    >>> len(Facets(1e-3, blocks, blocks, none, vectors, none, vectors, vectors, np.zeros((0, 0))))
    0
    """

    dt: float
    first: npt.NDArray[np.int64]
    second: npt.NDArray[np.int64]
    area: npt.NDArray[np.float64]
    normal: npt.NDArray[np.float64]
    normal_force: npt.NDArray[np.float64]
    slip: npt.NDArray[np.float64]
    shear: npt.NDArray[np.float64]
    state: npt.NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.area)


class Law(Protocol):
    """What `Simulation(law=…)` takes: gives the shear force on each facet [N], shape (facets, 3).

    It may have `stiffness_pa_m`, that of its springs [Pa/m], and `state_len`, how many numbers of its own are kept of each
    facet, at most 1000.
    """

    def __call__(self, facets: Facets, /) -> npt.NDArray[np.float64]:
        """Shear force on each facet [N]."""


def adapted_law(law: Law) -> dict[str, Any]:
    """What the native simulation takes: a function of arrays, and two numbers of the law."""
    if not callable(law):
        raise TypeError(f"law is {law!r}: give a function of facets")

    def call(given: dict[str, Any]) -> npt.NDArray[np.float64]:
        facets = Facets(**given)
        answer = np.asarray(law(facets))
        if np.iscomplexobj(answer):
            raise TypeError("the law gave complex forces: give real ones")
        force = answer.astype(np.float64, copy=False)
        if force.shape != (len(facets), 3):
            raise ValueError(f"the law gave forces of shape {force.shape}: make it ({len(facets)}, 3)")
        if not np.isfinite(force).all():
            raise ValueError("the law gave a force that is not finite")
        return np.ascontiguousarray(force)

    return {
        "law": call,
        "law_name": str(getattr(law, "__name__", type(law).__name__)),
        "law_numbers": (_state_len(law), _stiffness_pa_m(law)),
    }


def _state_len(law: Law) -> int:
    state_len = whole("state_len of the law", getattr(law, "state_len", 0), 0)
    if state_len > _MOST_STATE:
        size = f"{_MOST_STATE} numbers of each facet, 8 kB of memory"
        raise ValueError(f"state_len of the law is {state_len}: a law keeps at most {size}")
    return state_len


def _stiffness_pa_m(law: Law) -> float:
    stiffness = finite("stiffness_pa_m of the law", getattr(law, "stiffness_pa_m", 0.0), "0 or more [Pa/m]")
    if stiffness < 0.0:
        raise ValueError(f"stiffness_pa_m of the law is {stiffness}: give 0 or more [Pa/m]")
    return stiffness
