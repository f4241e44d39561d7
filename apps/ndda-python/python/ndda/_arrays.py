"""Arrays of a simulation: copies of its nodes, contacts and history."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ndda import _core

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

_FORCES = ("force", "friction", "center", "moment")
_HISTORY = _core._HISTORY


class Arrays(_core.Simulation):
    """A simulation with its arrays."""

    __slots__ = ("_keeps_contacts",)
    _keeps_contacts: bool

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

        Raises
        ------
        TypeError, ValueError
            There is no such quantity, or `out` has another type or shape, or cannot be written.

        Examples
        --------
        >>> import ndda, numpy
        >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
        >>> room = numpy.empty(simulation.position.shape)
        >>> simulation.array("velocity", out=room) is room
        True
        """
        if out is None:
            return self._nodes(name)
        if getattr(out, "dtype", None) != "float64" or not hasattr(out, "flags"):
            raise TypeError(f"`out` is {_kind_of(out)}: give an array of float64")
        if out.ndim != 2:
            raise ValueError(f"`out` has shape {out.shape}: make it ({self._node_starts()[-1]}, 3)")
        if not out.flags.writeable:
            raise ValueError("`out` cannot be written: give an array of your own, such as a copy")
        self._fill_nodes(name, out)
        return out

    @property
    def position(self) -> npt.NDArray[np.float64]:
        """Position of each node [m], shape (nodes, 3), a read-only copy.

        Examples
        --------
        >>> import ndda
        >>> float(ndda.Simulation(ndda.parse(ndda.EXAMPLE)).position.max())
        1.0
        """
        return self._nodes("position")

    @property
    def displacement(self) -> npt.NDArray[np.float64]:
        """Displacement of each node since the start [m], shape (nodes, 3), a read-only copy.

        Examples
        --------
        >>> import ndda
        >>> float(ndda.Simulation(ndda.parse(ndda.EXAMPLE)).displacement.max())
        0.0
        """
        return self._nodes("displacement")

    @property
    def velocity(self) -> npt.NDArray[np.float64]:
        """Velocity of each node [m/s], shape (nodes, 3), a read-only copy.

        Examples
        --------
        >>> import ndda
        >>> ndda.Simulation(ndda.parse(ndda.EXAMPLE)).velocity.shape
        (8, 3)
        """
        return self._nodes("velocity")

    @property
    def acceleration(self) -> npt.NDArray[np.float64]:
        """Acceleration of each node [m/s²], shape (nodes, 3), a read-only copy.

        Examples
        --------
        >>> import ndda
        >>> ndda.Simulation(ndda.parse(ndda.EXAMPLE)).acceleration.shape
        (8, 3)
        """
        return self._nodes("acceleration")

    @property
    def contacts(self) -> npt.NDArray[Any]:
        """Pairs of blocks that touched in the last step, a structured array.

        Fields are `first` and `second` (blocks, numbered from 0, the smaller number first), `force` and `friction` [N], `center`
        [m] and `moment` [N m] of shape (3,), `area` [m²], `depth` [m] and `sliding`. Force, friction and moment act on the first
        block, and their opposites on the second. `force` is all that contact does, and `friction` the part of it along the
        faces. `center` is the mean of the facets' centres of pressure by the size of their forces, and `moment` is taken about
        it. `depth` is the volume of the overlap over the area. `sliding` is the part of the area on which friction has
        reached its most; without friction, and with a law of one's own, it is 1.

        Examples
        --------
        >>> import ndda
        >>> len(ndda.Simulation(ndda.parse(ndda.EXAMPLE), contacts=True).contacts)
        0
        """
        import numpy as np

        if not self._keeps_contacts:
            raise ValueError("contacts are not kept: make the simulation with contacts=True")
        rows = self._contacts()
        fields: list[Any] = [("first", "i8"), ("second", "i8"), *((name, "f8", (3,)) for name in _FORCES)]
        table = np.zeros(len(rows), dtype=[*fields, ("area", "f8"), ("depth", "f8"), ("sliding", "f8")])
        table["first"], table["second"] = rows[:, 1], rows[:, 2]
        for index, name in enumerate(_FORCES):
            table[name] = rows[:, 3 + 3 * index : 6 + 3 * index]
        table["area"], table["depth"], table["sliding"] = rows[:, 15], rows[:, 16], rows[:, 17]
        table.flags.writeable = False
        return table

    @property
    def history(self) -> npt.NDArray[Any]:
        """Energies and works [J] over `time_s` [s], a structured array with a row for each row of a run's history.

        ``pandas.DataFrame(simulation.history)`` makes a table of it.

        Examples
        --------
        >>> import ndda
        >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.run()
        >>> float(simulation.history["time_s"][-1])
        1.0
        """
        import numpy as np

        rows = self._history()
        table = np.zeros(len(rows), dtype=[(name, "f8") for name in _HISTORY])
        for index, name in enumerate(_HISTORY):
            table[name] = rows[:, index]
        table.flags.writeable = False
        return table


def _kind_of(value: object) -> str:
    kind = getattr(value, "dtype", None)
    return f"a {type(value).__name__}" if kind is None else f"an array of {kind}"
