"""A simulation that is stepped."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fnmatch import fnmatchcase
from typing import Any

import numpy as np
import numpy.typing as npt

from ndda import _core

_FORCES = ("force", "friction", "center", "moment")
_CONTACT = np.dtype(
    [("first", "i8"), ("second", "i8")]
    + [(name, "f8", (3,)) for name in _FORCES]
    + [("area", "f8"), ("depth", "f8"), ("sliding", "f8")]
)


class Simulation(_core.Simulation):
    """A scene on its way through time.

    State and label after the scene's last step are those of `ndda run`, bit for bit, however the steps are taken.
    Two simulations can step in two threads; one simulation belongs to one thread at a time.

    Parameters
    ----------
    scene : Scene
        What to simulate. A scene that is to settle first is settled here.
    threads : int, optional
        Threads of its own; all processors of the process otherwise. Results have the same bits on any number.
    contacts : bool
        Whether `contacts` is kept.

    Raises
    ------
    SceneError
        The scene cannot be built.
    StopError
        It does not settle.

    Examples
    --------
    >>> import ndda
    >>> simulation = Simulation(ndda.parse(ndda.EXAMPLE), threads=1)
    >>> simulation.run(until=0.5)
    >>> simulation.step_count, simulation.label
    (50, 'accurate')
    """

    def __init__(self, scene: _core.Scene, *, threads: int | None = None, contacts: bool = False) -> None:
        self._keeps_contacts = contacts

    def run(
        self,
        until: float | None = None,
        *,
        every: int | None = None,
        callback: Callable[[Simulation], object] | None = None,
    ) -> None:
        """Step to a time; Ctrl-C ends it after a step.

        Parameters
        ----------
        until : float, optional
            Time [s], rounded to the nearest step; the end of the scene otherwise.
        every : int, optional
            Steps between calls of `callback`; 1 otherwise.
        callback : callable, optional
            Called with the simulation; what it raises ends the run.

        Raises
        ------
        StopError
            A step would have given a wrong number.
        ValueError
            `until` lies in the past, or `every` is no number of steps.

        Examples
        --------
        >>> import ndda
        >>> simulation, times = Simulation(ndda.parse(ndda.EXAMPLE)), []
        >>> simulation.run(until=0.3, every=10, callback=lambda now: times.append(round(now.time_s, 6)))
        >>> times
        [0.1, 0.2, 0.3]
        """
        if every is not None and every < 1:
            raise ValueError(f"every is {every}: give at least 1 step")
        last = self.steps if until is None else round(until / self.step_s)
        if last < self.step_count:
            raise ValueError(f"until is {until} s, and it is {self.time_s} s already: restore a snapshot")
        while (left := last - self.step_count) > 0:
            self.step(left if callback is None else min(left, every or 1))
            if callback is not None:
                callback(self)

    def array(self, name: str, out: npt.NDArray[np.float64] | None = None) -> npt.NDArray[np.float64]:
        """Copy a quantity of the nodes.

        Parameters
        ----------
        name : {"position", "displacement", "velocity", "acceleration"}
            Global coordinates [m, m, m/s, m/s²].
        out : array of shape (nodes, 3), optional
            Where to write it; a new read-only array otherwise.

        Returns
        -------
        array of shape (nodes, 3)

        Examples
        --------
        >>> import ndda, numpy
        >>> simulation = Simulation(ndda.parse(ndda.EXAMPLE))
        >>> room = numpy.empty(simulation.position.shape)
        >>> simulation.array("velocity", out=room) is room
        True
        """
        if out is None:
            return self._nodes(name)
        self._fill_nodes(name, out)
        return out

    @property
    def position(self) -> npt.NDArray[np.float64]:
        """Position of each node [m], shape (nodes, 3), a read-only copy."""
        return self._nodes("position")

    @property
    def displacement(self) -> npt.NDArray[np.float64]:
        """Displacement of each node since the start [m], shape (nodes, 3), a read-only copy."""
        return self._nodes("displacement")

    @property
    def velocity(self) -> npt.NDArray[np.float64]:
        """Velocity of each node [m/s], shape (nodes, 3), a read-only copy."""
        return self._nodes("velocity")

    @property
    def acceleration(self) -> npt.NDArray[np.float64]:
        """Acceleration of each node [m/s²], shape (nodes, 3), a read-only copy."""
        return self._nodes("acceleration")

    @property
    def contacts(self) -> npt.NDArray[Any]:
        """Pairs of blocks that touched in the last step, a structured array.

        Fields are `first` and `second` (blocks, numbered from 0), `force`, `friction` [N], `center` [m], `moment` [N m]
        of shape (3,), `area` [m²], `depth` [m], and `sliding`, the part of the area that slides.
        """
        if not self._keeps_contacts:
            raise ValueError("contacts are not kept: make the simulation with contacts=True")
        rows = self._contacts()
        table = np.zeros(len(rows), dtype=_CONTACT)
        table["first"], table["second"] = rows[:, 1], rows[:, 2]
        for index, name in enumerate(_FORCES):
            table[name] = rows[:, 3 + 3 * index : 6 + 3 * index]
        table["area"], table["depth"], table["sliding"] = rows[:, 15], rows[:, 16], rows[:, 17]
        table.flags.writeable = False
        return table

    def nodes(self, pattern: str) -> npt.NDArray[np.int64]:
        """Find the nodes of blocks by name.

        Parameters
        ----------
        pattern : str
            Name of a block, or a pattern such as ``"cube_*"``.

        Returns
        -------
        array of int
            Rows of the arrays of nodes.

        Raises
        ------
        KeyError
            No block has such a name.

        Examples
        --------
        >>> import ndda
        >>> simulation = Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.nodes("bl*").tolist()
        [0, 1, 2, 3, 4, 5, 6, 7]
        """
        starts = self._node_starts()
        found = self._blocks(pattern)
        return np.concatenate([np.arange(starts[i], starts[i + 1], dtype=np.int64) for i in found])

    def set_force(self, pattern: str, force: Sequence[float]) -> None:
        """Let a force act at the centre of mass of blocks from now on.

        Its impulse and its work are in the balances of momentum and energy.

        Parameters
        ----------
        pattern : str
            Name of a block, or a pattern such as ``"cube_*"``.
        force : sequence of 3 floats
            Force on each block [N], beside the loads of the scene, until another one is set; zeros take it away.

        Raises
        ------
        KeyError
            No block has such a name.
        ValueError
            A block is fixed, or the force is not finite.

        Examples
        --------
        >>> import ndda
        >>> simulation = Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.set_force("block", (0, 0, 2600 * 9.81))
        >>> simulation.run()
        >>> round(float(simulation.displacement[0, 2]), 9) + 0.0
        0.0
        """
        for block in self._blocks(pattern):
            self._set_force(block, force)

    def set_velocity(
        self, pattern: str, velocity: Sequence[float], spin: Sequence[float] = (0.0, 0.0, 0.0)
    ) -> None:
        """Give blocks a velocity now, as a blow would.

        The impulse and the change of kinetic energy are in the balances of momentum and energy.

        Parameters
        ----------
        pattern : str
            Name of a block, or a pattern such as ``"cube_*"``.
        velocity : sequence of 3 floats
            Velocity of the centre of mass of each block [m/s].
        spin : sequence of 3 floats
            Angular velocity about it [rad/s].

        Raises
        ------
        KeyError
            No block has such a name.
        ValueError
            A block is fixed, its supports prescribe velocities, or a component is not finite.

        Examples
        --------
        >>> import ndda
        >>> simulation = Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.set_velocity("block", (1, 0, 0))
        >>> simulation.step()
        >>> round(float(simulation.velocity[0, 0]), 9)
        1.0
        """
        for block in self._blocks(pattern):
            self._set_velocity(block, velocity, spin)

    def _blocks(self, pattern: str) -> list[int]:
        names = self.block_names
        found = [i for i, name in enumerate(names) if name == pattern or fnmatchcase(name, pattern)]
        if not found:
            raise KeyError(f"no block is called {pattern!r}; there are {', '.join(names[:8])}")
        return found
