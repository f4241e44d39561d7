"""A simulation that is stepped."""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

from ndda import _core
from ndda._arrays import _HISTORY
from ndda._blocks import Blocks
from ndda._checks import MOST_STEPS, finite, thread_count, whole
from ndda._driven import Driven
from ndda._progress import Progress
from ndda._scene import scene_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ndda._law import Law
    from ndda._scene import SceneLike
    from ndda._view import Page


class Simulation(Driven):
    """A scene on its way through time.

    State and label after the scene's last step are those of `ndda run`, bit for bit, however the steps are taken; for the
    label, some scenes run again (see `label`).
    Two simulations can step in two threads; one simulation belongs to one thread at a time.

    Parameters
    ----------
    scene : Scene, builders.Scene or path
        What to simulate. A scene that is to settle first is settled here; one with stages is refused.
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
    ValueError
        It has stages, which `run` follows: leave them out, and use `change` between steps.

    Examples
    --------
    >>> import ndda
    >>> simulation = Simulation(ndda.parse(ndda.EXAMPLE), threads=1)
    >>> simulation.run(until=0.5)
    >>> simulation.step_count, simulation.label
    (50, 'accurate')
    """

    __slots__ = ("__weakref__", "_files", "_folder", "_frames", "_frames_of", "_law")
    _files: int
    _folder: Any
    _frames: list[tuple[float, str]]
    _frames_of: WeakKeyDictionary[_core.Snapshot, list[tuple[float, str]]]
    _law: object

    def __new__(
        cls,
        scene: SceneLike,
        *,
        threads: int | None = None,
        contacts: bool = False,
        law: Law | None = None,
    ) -> Simulation:
        """Build the scene and take it to its start."""
        return cls._made(scene_of(scene), threads, contacts, law)

    @classmethod
    def _made(
        cls, source: _core.Scene | str, threads: int | None, contacts: bool, law: Law | None
    ) -> Simulation:
        adapted: dict[str, Any] = {}
        if law is not None:
            from ndda._law import adapted_law

            adapted = adapted_law(law)
        self = super().__new__(cls, source, threads=thread_count(threads), contacts=contacts, **adapted)
        self._begin(contacts, law)
        return self

    def _begin(self, contacts: bool, law: object) -> None:
        self._keeps_contacts = contacts
        self._law = law
        self._frames = []
        self._frames_of = WeakKeyDictionary()
        self._files, self._folder = 0, None
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
            Time [s], rounded to the nearest step; the end of the scene otherwise, also one that `callback` changes.
        every : int, optional
            Steps between calls of `callback`; 1 otherwise.
        callback : callable, optional
            Called with the simulation; what it raises ends the run.
        frames : int
            Frames to keep for `show`, evenly spaced, beside that of the start; at most one of each step.
        progress : bool
            Whether runs of more than a second show a bar, where tqdm is installed.

        Raises
        ------
        StopError
            A step would have given a wrong number.
        ValueError
            `until` or the end of the scene lies in the past, or `every` or `frames` is too small.

        Examples
        --------
        >>> import ndda
        >>> simulation, times = Simulation(ndda.parse(ndda.EXAMPLE)), []
        >>> simulation.run(until=0.3, every=10, callback=lambda now: times.append(round(now.time_s, 6)))
        >>> times
        [0.1, 0.2, 0.3]
        """
        every = 1 if every is None else whole("every", every, 1)
        if callback is not None and not callable(callback):
            raise TypeError(f"callback is {callback!r}: give a function of the simulation")
        first, last = self.step_count, self._last_step(until)
        if whole("frames", frames, 0):
            self.keep_frame()
        frames = min(frames, last - first)
        spacing = (last - first) / frames if frames else 0.0
        with Progress(last - first, wanted=progress) as bar:
            while (done := self.step_count) < last:
                to = last if callback is None else min(last, done + every)
                frame = _next_frame(first, done, spacing) if frames else last
                left = min(to, frame) - done
                while left > 0:
                    left = self._some_steps(left)
                    bar.show(self.step_count - first)
                if frames and self.step_count == frame:
                    self.keep_frame()
                if callback is not None and self._is_due(first, last, every):
                    callback(self)
                    last = self.steps if until is None else last

    def _last_step(self, until: float | None) -> int:
        """The step at which a run ends."""
        now, time_s = self.step_count, self.time_s
        if until is None:
            if self.steps < now:
                end_s = self.scene.end_s
                raise ValueError(f"the scene ends at {end_s} s, and it is {time_s} s already: give until, or change time.end_s")
            return self.steps
        last = finite("until", until, "a time [s]") / self.step_s
        if last > MOST_STEPS:
            raise ValueError(f"until is {until} s, or {last:.3g} steps: give an earlier time")
        if round(last) < now:
            raise ValueError(f"until is {until} s, and it is {time_s} s already: restore a snapshot")
        return round(last)

    def _is_due(self, first: int, last: int, every: int) -> bool:
        done = self.step_count
        return done == last or (done - first) % every == 0

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

    def snapshot(self) -> _core.Snapshot:
        """Copy all that changes, to go back to it later.

        Returns
        -------
        Snapshot

        Examples
        --------
        >>> import ndda
        >>> simulation = Simulation(ndda.parse(ndda.EXAMPLE))
        >>> simulation.restore(simulation.snapshot())
        """
        kept = super().snapshot()
        self._frames_of[kept] = list(self._frames)
        return kept

    def restore(self, snapshot: _core.Snapshot) -> None:
        """Go on from a snapshot of the same scene, bit for bit.

        The rows of `history` and the frames of `show` become those that led to the snapshot.
        A snapshot of another simulation brings no frames.

        Parameters
        ----------
        snapshot : Snapshot
            Of this simulation, or of another one of the same scene.

        Raises
        ------
        ValueError
            It is of another scene, or of a simulation with a law, which this one lacks.

        Examples
        --------
        >>> import ndda
        >>> simulation = Simulation(ndda.parse(ndda.EXAMPLE))
        >>> kept = simulation.snapshot()
        >>> simulation.step(10)
        >>> simulation.restore(kept)
        >>> simulation.step_count
        0
        """
        super().restore(snapshot)
        shows_the_present = bool(self._frames) and self._frames[-1][0] >= self.time_s
        # A frame of the same time may be of other velocities: that of the present state is kept anew.
        self._frames = [one for one in self._frames_of.get(snapshot, ()) if one[0] < self.time_s]
        if shows_the_present:
            # What has stopped has no frame.
            with suppress(_core.StopError):
                self.keep_frame()

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
        file = os.path.join(self._folder.name, f"frame_{self._files:06}.vtu")
        self._files += 1
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


def _next_frame(first: int, done: int, spacing: float) -> int:
    """The next step of which a frame is kept."""
    number = int((done - first) / spacing)
    while (frame := first + round(number * spacing)) <= done:
        number += 1
    return frame


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
        As those of `Simulation`; a law is not in the file, and is given again if the simulation had one.

    Returns
    -------
    Simulation
        Its `history` begins anew.

    Raises
    ------
    ValueError
        The file is damaged or holds something else, files that the scene names have changed, or it is of a simulation with a
        law and none is given.

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
