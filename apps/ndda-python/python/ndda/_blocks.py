"""Blocks of a simulation by their names."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from ndda._driven import Vector, Which
    from ndda._simulation import Simulation

    _Array = TypeVar("_Array", bound=npt.NDArray[Any])


def _read_only(array: _Array) -> _Array:
    """The array, so that nobody takes a copy for the state."""
    array.flags.writeable = False
    return array


class Blocks:
    """The blocks of a simulation; an index is a name, a pattern such as ``"cube_*"``, a number, or a list of them.

    Examples
    --------
    >>> import ndda
    >>> blocks = ndda.Simulation(ndda.parse(ndda.EXAMPLE)).blocks
    >>> len(blocks), list(blocks)
    (1, ['block'])
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation

    def __getitem__(self, which: Which) -> BlockSelection:
        """Blocks with matching names or these numbers; KeyError or IndexError if there is none."""
        return BlockSelection(self._simulation, which)

    def __iter__(self) -> Iterator[str]:
        """Names in the order of the scene.

        Examples
        --------
        >>> import ndda
        >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
        >>> list(simulation.blocks)
        ['block']
        """
        return iter(self._simulation.block_names)

    def __len__(self) -> int:
        """How many there are."""
        return len(self._simulation.block_names)

    def __contains__(self, name: object) -> bool:
        """Whether a block has this name."""
        return name in self._simulation.block_names


class BlockSelection:
    """Blocks that a pattern of names or a list names; arrays are read-only copies.

    Examples
    --------
    >>> import ndda
    >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
    >>> simulation.blocks["block"].set_velocity((1, 0, 0))
    >>> float(simulation.blocks["block"].velocity.max())
    1.0
    """

    def __init__(self, simulation: Simulation, which: Which) -> None:
        self._simulation, self._which = simulation, which
        self._indices = simulation._blocks(which)

    @property
    def names(self) -> list[str]:
        """Names in the order of the scene.

        Examples
        --------
        >>> import ndda
        >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.blocks["b*"].names
        ['block']
        """
        names = self._simulation.block_names
        return [names[i] for i in self._indices]

    @property
    def nodes(self) -> npt.NDArray[np.int64]:
        """Rows of their nodes in the arrays of nodes.

        Examples
        --------
        >>> import ndda
        >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.blocks["b*"].nodes.tolist()
        [0, 1, 2, 3, 4, 5, 6, 7]
        """
        return _read_only(self._simulation.nodes(self._which))

    @property
    def position(self) -> npt.NDArray[np.float64]:
        """Position of their nodes [m], shape (nodes, 3).

        Examples
        --------
        >>> import ndda
        >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.blocks["b*"].position.shape
        (8, 3)
        """
        return _read_only(self._simulation.position[self.nodes])

    @property
    def displacement(self) -> npt.NDArray[np.float64]:
        """Displacement of their nodes since the start [m], shape (nodes, 3).

        Examples
        --------
        >>> import ndda
        >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.blocks["b*"].displacement.shape
        (8, 3)
        """
        return _read_only(self._simulation.displacement[self.nodes])

    @property
    def velocity(self) -> npt.NDArray[np.float64]:
        """Velocity of their nodes [m/s], shape (nodes, 3).

        Examples
        --------
        >>> import ndda
        >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.blocks["b*"].velocity.shape
        (8, 3)
        """
        return _read_only(self._simulation.velocity[self.nodes])

    @property
    def elements(self) -> npt.NDArray[np.int64]:
        """Rows of their tetrahedra in `Simulation.stress` and `Simulation.tetrahedra`.

        Examples
        --------
        >>> import ndda
        >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.blocks["b*"].elements.tolist()
        [0, 1, 2, 3, 4, 5]
        """
        import numpy as np

        starts = self._simulation._tet_starts()
        return _read_only(np.concatenate([np.arange(starts[i], starts[i + 1], dtype=np.int64) for i in self._indices]))

    @property
    def tetrahedra(self) -> npt.NDArray[np.int64]:
        """Nodes of their tetrahedra, rows of the arrays of all nodes, shape (elements, 4).

        Examples
        --------
        >>> import ndda
        >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.position[simulation.blocks["b*"].tetrahedra].shape
        (6, 4, 3)
        """
        return _read_only(self._simulation.tetrahedra[self.elements])

    @property
    def stress(self) -> npt.NDArray[np.float64]:
        """Cauchy stress xx, yy, zz, xy, yz, zx of their tetrahedra [Pa], shape (elements, 6).

        Examples
        --------
        >>> import ndda
        >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.blocks["b*"].stress.shape
        (6, 6)
        """
        return _read_only(self._simulation.stress[self.elements])

    @property
    def center(self) -> npt.NDArray[np.float64]:
        """Mass centre of each [m], shape (blocks, 3).

        Examples
        --------
        >>> import ndda
        >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.blocks["b*"].center.tolist()
        [[0.5, 0.5, 0.5]]
        """
        return _read_only(self._simulation._centers()[self._indices])

    @property
    def mass(self) -> npt.NDArray[np.float64]:
        """Mass of each [kg], shape (blocks,).

        Examples
        --------
        >>> import ndda
        >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.blocks["b*"].mass.round(6).tolist()
        [2600.0]
        """
        return _read_only(self._simulation._masses()[self._indices])

    def set_force(self, force: Vector) -> None:
        """Let a force [N] act on each from now on, as `Simulation.set_force`.

        Examples
        --------
        >>> import ndda
        >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.blocks["b*"].set_force((0, 0, 100.0))
        """
        self._simulation.set_force(self._which, force)

    def set_velocity(self, velocity: Vector, spin: Vector = (0.0, 0.0, 0.0)) -> None:
        """Give each a velocity [m/s] and a spin [rad/s] now, as `Simulation.set_velocity`.

        Examples
        --------
        >>> import ndda
        >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.blocks["b*"].set_velocity((1.0, 0, 0))
        """
        self._simulation.set_velocity(self._which, velocity, spin)

    def __len__(self) -> int:
        """How many there are."""
        return len(self._indices)

    def __repr__(self) -> str:
        """The pattern and the names in short."""
        return f"<{len(self)} blocks {self._which!r}: {', '.join(self.names[:4])}>"
