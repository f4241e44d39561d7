"""What changes in a simulation between two steps."""

from __future__ import annotations

import operator
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ndda._arrays import Arrays
from ndda._core import SceneError
from ndda._scene import overrides_of

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from ndda.builders import HoldChoice, RegionChoice

    Vector = Sequence[float] | npt.NDArray[Any]

Which = str | int | Sequence[str | int]
"""Blocks: a name, a pattern such as ``"cube_*"``, a number, or a list of them.

As in scenes, ``*`` stands for anything in a pattern, and no other character is special. A block that has the pattern for its name is
meant alone.
"""


_INSTEAD = "make it Affine or Elastic from the start to hold it, or stop it by set_velocity and balance its loads by set_force"


class Driven(Arrays):
    """A simulation whose blocks are driven."""

    __slots__ = ()

    def nodes(self, pattern: Which) -> npt.NDArray[np.int64]:
        """Find the nodes of blocks by name.

        Parameters
        ----------
        pattern : str, int, or a list of them
            Name of a block, a pattern such as ``"cube_*"``, or its number.

        Returns
        -------
        array of int
            Rows of the arrays of nodes.

        Raises
        ------
        KeyError, IndexError
            No block has such a name or number.

        Examples
        --------
        >>> import ndda
        >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.nodes("bl*").tolist()
        [0, 1, 2, 3, 4, 5, 6, 7]
        """
        import numpy as np

        starts = self._node_starts()
        found = self._blocks(pattern)
        return np.concatenate([np.arange(starts[i], starts[i + 1], dtype=np.int64) for i in found])

    def set_force(self, pattern: Which, force: Vector) -> None:
        """Let a force act at the centre of mass of blocks from now on.

        Its impulse and its work are in the balances of momentum and energy. Where it is set in steps that follow each other, its
        errors halve with the step and are not judged: `label` is then ``"inaccurate"``.

        Parameters
        ----------
        pattern : str, int, or a list of them
            Name of a block, a pattern such as ``"cube_*"``, or its number.
        force : sequence of 3 floats
            Force on each block [N], beside the loads of the scene, until another one is set; zeros take it away.

        Raises
        ------
        KeyError, IndexError
            No block has such a name or number.
        ValueError
            A block is fixed, or the force is not finite.

        Examples
        --------
        >>> import ndda
        >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.set_force("block", (0, 0, 2600 * 9.81))
        >>> simulation.run()
        >>> round(float(simulation.displacement[0, 2]), 9) + 0.0
        0.0
        """
        for block in self._blocks(pattern):
            self._set_force(block, force)

    def set_velocity(
        self, pattern: Which, velocity: Vector, spin: Vector = (0.0, 0.0, 0.0)
    ) -> None:
        """Give blocks a velocity now, as a blow would.

        The impulse and the change of kinetic energy are in the balances of momentum and energy. Where it is set in steps that
        follow each other, its errors halve with the step and are not judged: `label` is then ``"inaccurate"``.

        Parameters
        ----------
        pattern : str, int, or a list of them
            Name of a block, a pattern such as ``"cube_*"``, or its number.
        velocity : sequence of 3 floats
            Velocity of the centre of mass of each block [m/s].
        spin : sequence of 3 floats
            Angular velocity about it [rad/s].

        Raises
        ------
        KeyError, IndexError
            No block has such a name or number.
        ValueError
            A block is fixed, its supports prescribe velocities, or a component is not finite.

        Examples
        --------
        >>> import ndda
        >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.set_velocity("block", (1, 0, 0))
        >>> simulation.step()
        >>> round(float(simulation.velocity[0, 0]), 9)
        1.0
        """
        for block in self._blocks(pattern):
            self._set_velocity(block, velocity, spin)

    def change(self, **overrides: object) -> None:
        """Change values of the scene from now on: gravity, loads, water, friction, `time.end_s`, monitors, output.

        The potential energy that jumps with a load is in the energy balance as work of loads. A snapshot from before goes
        back to the scene as it was.

        Parameters
        ----------
        **overrides
            Values by their path in the scene, as those of `load`.

        Raises
        ------
        SceneError
            The changed scene cannot be used.
        ValueError
            Such a value cannot change between steps.

        Examples
        --------
        >>> import ndda
        >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.run(until=0.5)
        >>> simulation.change(gravity_m_s2=(0, 0, 9.81))
        >>> simulation.run()
        >>> round(float(simulation.velocity[0, 2]), 9) + 0.0, simulation.label
        (0.0, 'accurate')
        """
        self._change(overrides_of(overrides))

    def hold(self, pattern: Which, on: RegionChoice = "All", hold: HoldChoice = "Fixed") -> None:
        """Hold blocks where they are from now on.

        Nodes that move stop at once: their momentum and kinetic energy are in the balances, as impulse and work of loads.

        Parameters
        ----------
        pattern : str, int, or a list of them
            Name of a block, a pattern such as ``"prop_*"``, or its number. Blocks of a pattern that have no such part stay as they are.
        on : str or Region.Plane or Region.Set
            Which part of them, such as ``ndda.builders.Region.Set("z_min")``.
        hold : str or Hold.Direction
            ``"Fixed"``, all three components, or ``"Normal"``, the component along the normal of the region's plane.

        Raises
        ------
        KeyError, IndexError
            No block has such a name or number.
        SceneError
            It has no such part.
        ValueError
            A block is rigid, which nothing can hold, the support would count from where the block was at the start, the block
            has turned too far, or the integrator remembers accelerations.

        Examples
        --------
        >>> import ndda
        >>> simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE.replace("Rigid", "Elastic")))
        >>> simulation.run(until=0.5)
        >>> simulation.hold("block")
        >>> simulation.run()
        >>> round(float(simulation.displacement[0, 2]), 6)
        -1.22625
        """
        from ndda.builders import Support

        supports = self.scene.to_builder().supports or []
        try:
            held = [Support(block=block, on=on, hold=hold) for block in self._as_in_scenes(pattern)]
            self.change(supports=[*supports, *held])
        except SceneError as error:
            if "rigid block cannot be held" in str(error):
                raise ValueError(f"{pattern!r} names a rigid block, which cannot be held: {_INSTEAD}") from error
            raise

    def release(self, pattern: Which) -> None:
        """Take away the supports of blocks.

        Parameters
        ----------
        pattern : str, int, or a list of them
            Name of a block, a pattern such as ``"prop_*"``, or its number.

        Raises
        ------
        KeyError, IndexError
            No block has such a name or number, or no support holds one.
        ValueError
            A support holds other blocks, too, so that they are to be released together; or the integrator remembers
            accelerations, so that supports cannot change.

        Examples
        --------
        >>> import ndda
        >>> held = 'supports: [(block: "block", on: All, hold: Fixed)],)'
        >>> body = ndda.EXAMPLE.replace("body: Rigid, ", "").rstrip()[:-1] + held
        >>> simulation = ndda.Simulation(ndda.parse(body))
        >>> simulation.run(until=0.5)
        >>> simulation.release("block")
        >>> simulation.run()
        >>> round(float(simulation.displacement[0, 2]), 6)
        -1.22625
        """
        supports = self.scene.to_builder().supports or []
        freed, kept = set(self._blocks(pattern)), []
        for one in supports:
            held = set(self._blocks(one.block))
            if held - freed and held & freed:
                other = self.block_names[min(held - freed)]
                raise ValueError(f"the support of {one.block!r} holds {other}, too: release {one.block!r}")
            if held - freed:
                kept.append(one)
        if len(kept) == len(supports):
            there = f"there are supports of {_some([one.block for one in supports])}" if supports else "the scene has none"
            raise KeyError(f"no support has the block {pattern!r}; {there}")
        self.change(supports=kept)

    def _blocks(self, which: Which) -> list[int]:
        names = self.block_names
        if isinstance(which, str):
            if which in names:
                return [names.index(which)]
            found = [i for i, name in enumerate(names) if _matches(which, name)]
            if not found:
                special = "; only * stands for anything" if re.search(r"[?\[]", which) else ""
                raise KeyError(f"no block is called {which!r}; there are {_some(names)}{special}")
            return found
        if isinstance(which, (int, bytes)) or not hasattr(which, "__iter__"):
            return [_numbered(which, len(names))]
        # A block that is named twice counts once.
        several = list(dict.fromkeys(i for one in which for i in self._blocks(one)))
        if not several:
            raise KeyError(f"the list of blocks is empty; there are {_some(names)}")
        return several

    def _as_in_scenes(self, which: Which) -> list[str]:
        """Blocks as a scene names them: a name or a pattern as it is, the names of others."""
        names, found = self.block_names, self._blocks(which)
        named = [which] if isinstance(which, str) else [names[i] for i in found]
        for one in set(named).intersection(names):
            other = next((name for name in names if "*" in one and name != one and _matches(one, name)), None)
            if other is not None:
                raise ValueError(f"in a support, {one!r} is a pattern, too, and stands for {other!r}: rename the block")
        return named


def _matches(pattern: str, name: str) -> bool:
    """Whether a name is that of a pattern, as a scene reads it."""
    return re.fullmatch(".*".join(map(re.escape, pattern.split("*"))), name, re.DOTALL) is not None


def _numbered(which: object, count: int) -> int:
    try:
        if isinstance(which, bool):
            raise TypeError
        number = operator.index(which)  # type: ignore[arg-type]
    except TypeError:
        raise TypeError(f"blocks are {which!r}: give a name, a pattern, a number, or a list of them") from None
    if not -count <= number < count:
        raise IndexError(f"there is no block {number}: the simulation has {count}, counted from 0")
    return number % count


def _some(names: Sequence[str]) -> str:
    """A few names."""
    return ", ".join(names[:8]) + (", …" if len(names) > 8 else "")
