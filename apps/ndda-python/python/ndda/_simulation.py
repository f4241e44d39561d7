"""A simulation that is stepped."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Any

from ndda import _core
from ndda._blocks import Blocks
from ndda._progress import Progress
from ndda._scene import overrides_of, parse

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    from matplotlib.axes import Axes

    from ndda._law import Law
    from ndda._view import Page
    from ndda.builders import HoldChoice, RegionChoice
    from ndda.builders import Scene as SceneBuilder

_FORCES = ("force", "friction", "center", "moment")
_HISTORY = _core._HISTORY


class Simulation(_core.Simulation):
    """A scene on its way through time.

    State and label after the scene's last step are those of `ndda run`, bit for bit, however the steps are taken; for the
    label, some scenes run again (see `label`).
    Two simulations can step in two threads; one simulation belongs to one thread at a time.

    Parameters
    ----------
    scene : Scene or builders.Scene
        What to simulate. A scene that is to settle first is settled here.
    threads : int, optional
        Threads of its own; all processors of the process otherwise. Results have the same bits on any number.
    contacts : bool
        Whether `contacts` is kept.
    law : callable, optional
        Friction in place of all that the scene names: called once a step with all facets in contact as arrays. Such a
        simulation is outside the promise of equal bits. See `docs/python/howto.md`.

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

    def __new__(
        cls,
        scene: _core.Scene | SceneBuilder,
        *,
        threads: int | None = None,
        contacts: bool = False,
        law: Law | None = None,
    ) -> Simulation:
        """Build the scene and take it to its start."""
        checked = scene if isinstance(scene, _core.Scene) else parse(scene)
        return cls._made(checked, threads, contacts, law)

    @classmethod
    def _made(
        cls, source: _core.Scene | str, threads: int | None, contacts: bool, law: Law | None
    ) -> Simulation:
        adapted: dict[str, Any] = {}
        if law is not None:
            from ndda._law import adapted_law

            adapted = adapted_law(law)
        self = super().__new__(cls, source, threads=threads, contacts=contacts, **adapted)
        self._begin(contacts, law)
        return self

    def _begin(self, contacts: bool, law: object) -> None:
        self._keeps_contacts = contacts
        self._law = law
        self._frames: list[tuple[float, str]] = []
        self._folder: Any = None
        warnings = self._warnings()
        if warnings:
            import logging

            for found in warnings:
                logging.getLogger("ndda").warning("%s: %s", found["path"], found["message"])

    def run(
        self,
        until: float | None = None,
        *,
        every: int | None = None,
        callback: Callable[[Simulation], object] | None = None,
        frames: int = 0,
        progress: bool = True,
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
        frames : int
            Frames to keep for `show`, evenly spaced, beside that of the start.
        progress : bool
            Whether runs of more than a second show a bar, where tqdm is installed.

        Raises
        ------
        StopError
            A step would have given a wrong number.
        ValueError
            `until` lies in the past or is no time, or `every` or `frames` is no number.

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
        if frames < 0:
            raise ValueError(f"frames is {frames}: give at least 0")
        if until is not None and not abs(until) < float("inf"):
            raise ValueError(f"until is {until}: give a time [s]")
        last = self.steps if until is None else round(until / self.step_s)
        first = self.step_count
        if last < first:
            raise ValueError(f"until is {until} s, and it is {self.time_s} s already: restore a snapshot")
        shown = sorted({first + round(k * (last - first) / frames) for k in range(frames + 1)} if frames else ())
        if shown:
            self.keep_frame()
        with Progress(last - first, wanted=progress) as bar:
            while (done := self.step_count) < last:
                to = last if callback is None else min(last, done + (every or 1))
                frame = next((step for step in shown if step > done), last)
                left = min(to, frame) - done
                while left > 0:
                    left = self._some_steps(left)
                    bar.show(self.step_count - first)
                if shown and self.step_count == frame:
                    self.keep_frame()
                if callback is not None and self._is_due(first, last, every or 1):
                    callback(self)

    def _is_due(self, first: int, last: int, every: int) -> bool:
        done = self.step_count
        return done == last or (done - first) % every == 0

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
        """Position of each node [m], shape (nodes, 3), a read-only copy.

        Examples
        --------
        >>> import ndda
        >>> float(Simulation(ndda.parse(ndda.EXAMPLE)).position.max())
        1.0
        """
        return self._nodes("position")

    @property
    def displacement(self) -> npt.NDArray[np.float64]:
        """Displacement of each node since the start [m], shape (nodes, 3), a read-only copy.

        Examples
        --------
        >>> import ndda
        >>> float(Simulation(ndda.parse(ndda.EXAMPLE)).displacement.max())
        0.0
        """
        return self._nodes("displacement")

    @property
    def velocity(self) -> npt.NDArray[np.float64]:
        """Velocity of each node [m/s], shape (nodes, 3), a read-only copy.

        Examples
        --------
        >>> import ndda
        >>> Simulation(ndda.parse(ndda.EXAMPLE)).velocity.shape
        (8, 3)
        """
        return self._nodes("velocity")

    @property
    def acceleration(self) -> npt.NDArray[np.float64]:
        """Acceleration of each node [m/s²], shape (nodes, 3), a read-only copy.

        Examples
        --------
        >>> import ndda
        >>> Simulation(ndda.parse(ndda.EXAMPLE)).acceleration.shape
        (8, 3)
        """
        return self._nodes("acceleration")

    @property
    def contacts(self) -> npt.NDArray[Any]:
        """Pairs of blocks that touched in the last step, a structured array.

        Fields are `first` and `second` (blocks, numbered from 0), `force`, `friction` [N], `center` [m], `moment` [N m]
        of shape (3,), `area` [m²], `depth` [m], and `sliding`, the part of the area that slides.

        Examples
        --------
        >>> import ndda
        >>> len(Simulation(ndda.parse(ndda.EXAMPLE), contacts=True).contacts)
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
        >>> simulation = Simulation(ndda.parse(ndda.EXAMPLE))
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

    @property
    def blocks(self) -> Blocks:
        """Blocks by name or pattern.

        Examples
        --------
        >>> import ndda
        >>> simulation = Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.blocks["bl*"].center.tolist()
        [[0.5, 0.5, 0.5]]
        """
        return Blocks(self)

    @property
    def is_reproducible(self) -> bool:
        """Whether results have the same bits everywhere, which a friction law in Python does not promise.

        Examples
        --------
        >>> import ndda
        >>> Simulation(ndda.parse(ndda.EXAMPLE)).is_reproducible
        True
        """
        return self._law is None

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
        import numpy as np

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
        >>> simulation = Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.run(until=0.5)
        >>> simulation.change(gravity_m_s2=(0, 0, 9.81))
        >>> simulation.run()
        >>> round(float(simulation.velocity[0, 2]), 9) + 0.0, simulation.label
        (0.0, 'accurate')
        """
        self._change(overrides_of(overrides))

    def hold(self, pattern: str, on: RegionChoice = "All", hold: HoldChoice = "Fixed") -> None:
        """Hold blocks where they are from now on.

        Nodes that move stop at once: their momentum and kinetic energy are in the balances, as impulse and work of loads.

        Parameters
        ----------
        pattern : str
            Name of a block, or a pattern such as ``"prop_*"``.
        on : str or Region.Plane or Region.Set
            Which part of them, such as ``ndda.builders.Region.Set("z_min")``.
        hold : str or Hold.Direction
            ``"Fixed"``, all three components, or ``"Normal"``, the component along the normal of the region's plane.

        Raises
        ------
        SceneError
            No block has such a name, or it has no such part.
        ValueError
            The support would count from where the block was at the start, the block has turned too far, or the integrator
            remembers accelerations.

        Examples
        --------
        >>> import ndda
        >>> simulation = Simulation(ndda.parse(ndda.EXAMPLE.replace("Rigid", "Elastic")))
        >>> simulation.run(until=0.5)
        >>> simulation.hold("block")
        >>> simulation.run()
        >>> round(float(simulation.displacement[0, 2]), 6)
        -1.22625
        """
        from ndda.builders import Support

        supports = self.scene.to_builder().supports or []
        self.change(supports=[*supports, Support(block=pattern, on=on, hold=hold)])

    def release(self, pattern: str) -> None:
        """Take away the supports of blocks.

        Parameters
        ----------
        pattern : str
            `block` of the supports in the scene, or a pattern such as ``"prop_*"``.

        Raises
        ------
        KeyError
            No support has such a block.
        ValueError
            The integrator remembers accelerations, so that supports cannot change.

        Examples
        --------
        >>> import ndda
        >>> held = 'supports: [(block: "block", on: All, hold: Fixed)],)'
        >>> body = ndda.EXAMPLE.replace("body: Rigid, ", "").rstrip()[:-1] + held
        >>> simulation = Simulation(ndda.parse(body))
        >>> simulation.run(until=0.5)
        >>> simulation.release("block")
        >>> simulation.run()
        >>> round(float(simulation.displacement[0, 2]), 6)
        -1.22625
        """
        supports = self.scene.to_builder().supports or []
        kept = [one for one in supports if not (one.block == pattern or fnmatchcase(one.block, pattern))]
        if len(kept) == len(supports):
            raise KeyError(f"no support has the block {pattern!r}; there are {[one.block for one in supports]}")
        self.change(supports=kept)

    def keep_frame(self) -> None:
        """Keep the present state for `show`, with the fields that the scene's `output` names.

        Examples
        --------
        >>> import ndda
        >>> simulation = Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.keep_frame()
        """
        import tempfile

        if self._frames and self._frames[-1][0] >= self.time_s:
            return
        self._folder = self._folder or tempfile.TemporaryDirectory(prefix="ndda")
        file = os.path.join(self._folder.name, f"frame_{len(self._frames):06}.vtu")
        with open(file, "wb") as out:
            out.write(self._frame())
        self._frames.append((self.time_s, file))

    def show(self) -> Page:
        """Show blocks in 3D, with a slider over the frames that were kept and the present one; inline in a notebook.

        Returns
        -------
        Page
            Shows itself in a notebook; ``.save(file)`` writes it, ``.open()`` shows it in a browser.

        Examples
        --------
        >>> import ndda
        >>> simulation = Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.run(frames=5)
        >>> simulation.show()
        <ndda.Page 'A block falls for a second', 6 frames>
        """
        from ndda._view import Page

        self.keep_frame()
        title, frames = self.scene.title, self._frames
        return Page(title, _core._viewer(title, self.block_names, frames), len(frames))

    def plot(self, *columns: str, ax: Axes | None = None) -> Axes:
        """Draw columns of `history` over time with matplotlib.

        Parameters
        ----------
        *columns : str
            Names of columns; energies that are not zero throughout otherwise.
        ax : matplotlib Axes, optional
            Where to draw; new ones otherwise.

        Returns
        -------
        matplotlib Axes

        Raises
        ------
        ValueError
            `history` has no such column.

        Examples
        --------
        >>> import ndda
        >>> simulation = Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.run()
        >>> axes = simulation.plot("kinetic_j")  # doctest: +SKIP
        """
        history = self.history
        unknown = [name for name in columns if name not in _HISTORY]
        if unknown:
            raise ValueError(f"history has no column {unknown[0]!r}; it has {', '.join(_HISTORY)}")
        if ax is None:
            from matplotlib import pyplot

            ax = pyplot.subplots()[1]
        for name in columns or [name for name in _HISTORY[1:] if history[name].any()]:
            ax.plot(history["time_s"], history[name], label=name.removesuffix("_j").replace("_", " "))
        ax.set(xlabel="time [s]", ylabel="energy [J]")
        ax.legend()
        return ax

    def __repr__(self) -> str:
        """Title, time and steps in short."""
        return f"<ndda.Simulation {self.scene.title!r}, t = {self.time_s:g} s, step {self.step_count} of {self.steps}>"

    def _blocks(self, pattern: str) -> list[int]:
        names = self.block_names
        found = [i for i, name in enumerate(names) if name == pattern or fnmatchcase(name, pattern)]
        if not found:
            raise KeyError(f"no block is called {pattern!r}; there are {', '.join(names[:8])}")
        return found


def resume(
    path: str | os.PathLike[str],
    *,
    threads: int | None = None,
    contacts: bool = False,
    law: Law | None = None,
) -> Simulation:
    """Go on from what `Simulation.save` wrote, or from the last checkpoint of a run, bit for bit.

    Parameters
    ----------
    path : path
        The file, or the output folder of a run.
    threads, contacts, law
        As those of `Simulation`; a law is not in the file.

    Returns
    -------
    Simulation
        Its `history` begins anew.

    Raises
    ------
    ValueError
        The file is damaged or holds something else, or files that the scene names have changed.

    Examples
    --------
    >>> import ndda, pathlib, tempfile
    >>> file = pathlib.Path(tempfile.mkdtemp()) / "fall.ndda"
    >>> simulation = Simulation(ndda.parse(ndda.EXAMPLE))
    >>> simulation.step(30)
    >>> simulation.save(file)
    >>> resume(file).step_count
    30
    """
    return Simulation._made(os.fspath(path), threads, contacts, law)
