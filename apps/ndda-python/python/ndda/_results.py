"""Results of runs in folders: histories as tables, fields as meshes."""

from __future__ import annotations

import operator
import os
from numbers import Integral, Real
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ndda import _core
from ndda._view import Page

if TYPE_CHECKING:
    import meshio
    import pandas as pd
    import pyvista


class Results:
    """The output folder of a run; `read` makes it.

    Parameters
    ----------
    folder : path

    Examples
    --------
    >>> import ndda, pathlib, tempfile
    >>> folder = pathlib.Path(tempfile.mkdtemp()) / "fall"
    >>> _ = ndda.run(ndda.parse(ndda.EXAMPLE, **{"output.frames": 4}), folder)
    >>> results = ndda.read(folder)
    >>> results.summary["steps"], len(results.times)
    (100, 5)
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)

    @property
    def summary(self) -> dict[str, Any]:
        """The content of `summary.json`: label, verdicts, energies, where blocks ended.

        Examples
        --------
        >>> import ndda
        >>> ndda.read("out/fall").summary["label"]["word"]  # doctest: +SKIP
        'accurate'
        """
        import json

        found: dict[str, Any] = json.loads((self.folder / "summary.json").read_text(encoding="utf-8"))
        return found

    @property
    def history(self) -> pd.DataFrame:
        """Energies, momenta and monitors over `time_s`; units are in the names of the columns.

        Examples
        --------
        >>> import ndda
        >>> ndda.read("out/fall").history.plot("time_s", "kinetic_j")  # doctest: +SKIP
        """
        return self._table("history")

    @property
    def contacts(self) -> pd.DataFrame:
        """Contacts of each row of the history, for runs with `output.contacts`.

        Examples
        --------
        >>> import ndda
        >>> ndda.read("out/fall").contacts.groupby("time_s")["area_m2"].sum()  # doctest: +SKIP
        """
        return self._table("contacts")

    @property
    def blocks(self) -> pd.DataFrame:
        """Motion of each block in each frame, for runs with `output.blocks`.

        Examples
        --------
        >>> import ndda
        >>> ndda.read("out/fall").blocks.columns  # doctest: +SKIP
        """
        return self._table("blocks")

    def _table(self, name: str) -> pd.DataFrame:
        import pandas

        csv, parquet = self.folder / f"{name}.csv", self.folder / f"{name}.parquet"
        if csv.exists():
            return pandas.read_csv(csv)
        if parquet.exists():
            return pandas.read_parquet(parquet)
        advice = "" if name == "history" else f"; runs with `output.{name}: true` write it"
        raise FileNotFoundError(f"{self.folder} has no {name}.csv{advice}")

    @property
    def times(self) -> list[float]:
        """Times of the frames [s].

        Examples
        --------
        >>> import ndda
        >>> ndda.read("out/fall").times  # doctest: +SKIP
        [0.0, 0.5, 1.0]
        """
        return [time for time, _ in self._frames()]

    def _frames(self) -> list[tuple[float, Path]]:
        from xml.etree import ElementTree

        index = self.folder / "fields.pvd"
        if not index.exists():
            raise FileNotFoundError(f"{self.folder} has no frames: run its scene with `output: (frames: 20)`")
        sets = ElementTree.parse(index).getroot().iter("DataSet")
        return [(float(one.attrib["timestep"]), self.folder / one.attrib["file"]) for one in sets]

    def _file(self, frame: int | float) -> Path:
        frames = self._frames()
        if not frames:
            raise FileNotFoundError(f"{self.folder} has no frame yet")
        count, first_s, last_s = len(frames), frames[0][0], frames[-1][0]
        choices = f"the run has frames 0 to {count - 1}, or -{count} to -1 from the end, at {first_s:g} to {last_s:g} s"
        if isinstance(frame, bool) or not isinstance(frame, Real):
            raise TypeError(f"frame is {frame!r}: give a number, whole for a frame, or a time [s] as a float; {choices}")
        if isinstance(frame, Integral):
            number = operator.index(frame)
            if not -count <= number < count:
                raise IndexError(f"frame is {number}: {choices}; a time is a float, such as {number}.0")
            return frames[number][1]
        # Times of frames are rounded where they are written.
        margin_s = 1e-6 * (last_s - first_s)
        if not first_s - margin_s <= frame <= last_s + margin_s:
            raise ValueError(f"frame is {frame} s: {choices}")
        return min(frames, key=lambda one: abs(one[0] - frame))[1]

    def mesh(self, frame: int | float = -1) -> meshio.Mesh:
        """Read the fields of a frame with meshio.

        Parameters
        ----------
        frame : int or float
            A whole number is that of the frame, from the end if negative; a float is a time [s], and the nearest frame is read.

        Returns
        -------
        meshio.Mesh

        Raises
        ------
        FileNotFoundError
            The run wrote no frames.
        IndexError, ValueError
            It has no such frame, or has none at such a time.

        Examples
        --------
        >>> import ndda
        >>> ndda.read("out/fall").mesh(0.5).point_data["displacement_m"]  # doctest: +SKIP
        """
        import meshio

        return meshio.read(self._file(frame))

    def grid(self, frame: int | float = -1) -> pyvista.UnstructuredGrid:
        """Read the fields of a frame with pyvista.

        Parameters
        ----------
        frame : int or float
            A whole number is that of the frame, from the end if negative; a float is a time [s], and the nearest frame is read.

        Returns
        -------
        pyvista.UnstructuredGrid

        Raises
        ------
        FileNotFoundError
            The run wrote no frames.
        IndexError, ValueError
            It has no such frame, or has none at such a time.

        Examples
        --------
        >>> import ndda
        >>> ndda.read("out/fall").grid().plot(scalars="displacement_m")  # doctest: +SKIP
        """
        import pyvista

        return pyvista.read(self._file(frame))

    def show(self, frames: int | None = None) -> Page:
        """Show the report of the run, inline in a notebook.

        Parameters
        ----------
        frames : int, optional
            Frames to show; all of them otherwise.

        Returns
        -------
        Page

        Examples
        --------
        >>> import ndda
        >>> ndda.read("out/fall").show()  # doctest: +SKIP
        """
        import json
        import tempfile

        with tempfile.TemporaryDirectory(prefix="ndda") as folder:
            file = os.path.join(folder, "report.html")
            written = json.loads(_core._report(os.fspath(self.folder), file, frames))
            text = Path(file).read_text(encoding="utf-8")
        return Page(self.summary["title"], text, written["frames"])

    def __repr__(self) -> str:
        return f"<ndda.Results of {self.folder}>"


def read(folder: str | os.PathLike[str]) -> Results:
    """Read the output folder of a run.

    Parameters
    ----------
    folder : path
        As `ndda run --out` or `run(scene, out=…)` writes it.

    Returns
    -------
    Results

    Raises
    ------
    FileNotFoundError
        The folder holds no run.

    Examples
    --------
    >>> read("no_such_folder")
    Traceback (most recent call last):
    ...
    FileNotFoundError: no_such_folder holds no run: name the output folder of `ndda run`
    """
    path = Path(folder)
    if not any((path / name).exists() for name in ("summary.json", "history.csv", "history.parquet")):
        raise FileNotFoundError(f"{path} holds no run: name the output folder of `ndda run`")
    return Results(path)
