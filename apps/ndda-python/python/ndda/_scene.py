"""Reading scenes, and running them whole."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ndda import _core
from ndda._core import Scene

if TYPE_CHECKING:
    from ndda.builders import Scene as SceneBuilder

EXAMPLE = """Scene(
    title: "A block falls for a second",
    time: (step_s: 0.01, end_s: 1.0), gravity_m_s2: (0, 0, -9.81), contact: Off,
    materials: [(name: "rock", density_kg_m3: 2600, young_pa: 1e9, poisson: 0.25)],
    blocks: [(name: "block", material: "rock", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
)
"""
"""Text of a scene for examples: a rigid block falls for a second."""


def value_in_ron(value: object) -> str:
    """Write a value in RON; a string is RON already, and builders write themselves."""
    if hasattr(value, "tolist"):
        # A row of an array is a vector.
        value = value.tolist()
        value = tuple(value) if isinstance(value, list) else value
    if isinstance(value, bool):
        return "true" if value else "false"
    if value is None:
        return "None"
    if isinstance(value, (tuple, list)):
        inner = ", ".join(value_in_ron(item) for item in value)
        return f"({inner})" if isinstance(value, tuple) else f"[{inner}]"
    if isinstance(value, str):
        return value
    if isinstance(value, int):
        return str(value)
    if hasattr(value, "to_ron"):
        return str(value.to_ron())
    return repr(float(value))  # type: ignore[arg-type]


def overrides_of(values: Mapping[str, object]) -> list[str]:
    """Values by their path as `ndda run --set` takes them."""
    return [f"{path}={value_in_ron(value)}" for path, value in values.items()]


def load(file: str | os.PathLike[str], **overrides: object) -> Scene:
    """Read and check the scene in a file.

    Parameters
    ----------
    file : path
        The scene.
    **overrides : number, bool, tuple, list, str, builder or None
        Values by their path in the scene; a string is RON, so that a text is quoted twice.

    Returns
    -------
    Scene

    Raises
    ------
    SceneError
        All that is wrong with it, each with its line, column and advice.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> file = pathlib.Path(tempfile.mkdtemp()) / "fall.ron"
    >>> _ = file.write_text(EXAMPLE)
    >>> load(file, **{"time.step_s": 0.02}).steps
    50
    """
    return Scene._load(os.fspath(file), overrides_of(overrides))


def parse(
    scene: str | Mapping[str, Any] | SceneBuilder, folder: str | os.PathLike[str] = ".", **overrides: object
) -> Scene:
    """Read and check a scene that is not a file.

    Parameters
    ----------
    scene : str, mapping or builders.Scene
        The scene as text in RON, as a dictionary with the same fields, or built from objects.
    folder : path
        Where the files are that it names.
    **overrides
        As those of `load`.

    Returns
    -------
    Scene

    Raises
    ------
    SceneError
        As `load`.

    Examples
    --------
    >>> parse(EXAMPLE).title
    'A block falls for a second'
    >>> time = {"step_s": 0.1, "end_s": 1.0}
    >>> rock = {"name": "rock", "density_kg_m3": 2600, "young_pa": 1e9, "poisson": 0.25}
    >>> shape = {"Box": {"size_m": (1, 1, 1), "cells": (1, 1, 1)}}
    >>> block = {"name": "block", "material": "rock", "shape": shape}
    >>> parse({"title": "A block", "time": time, "materials": [rock], "blocks": [block]}).steps
    10
    """
    if isinstance(scene, str):
        text = scene
    else:
        from ndda.builders import Scene as SceneBuilder

        built = SceneBuilder.from_dict(scene) if isinstance(scene, Mapping) else scene
        if not isinstance(built, SceneBuilder):
            raise TypeError(f"{built!r} is not a scene: give a text, a dictionary, or a builders.Scene; `load` reads files")
        text = built.to_ron()
    return Scene._parse(text, overrides_of(overrides), os.fspath(folder))


def run(
    scene: Scene,
    out: str | os.PathLike[str] | None = None,
    *,
    force: bool = False,
    threads: int | None = None,
) -> dict[str, Any]:
    """Run a scene to its end and judge it.

    Parameters
    ----------
    scene : Scene
    out : path, optional
        Folder for history, fields and summary, as `ndda run` writes them; no files without it. `read` reads it.
    force : bool
        Whether an earlier run in the folder is replaced.
    threads : int, optional
        Threads; all processors otherwise.

    Returns
    -------
    dict
        The content of `summary.json`.

    Raises
    ------
    SceneError
        The scene cannot be built.
    StopError
        The scene does not settle. A later stop is no exception: `status` is then ``"stopped"``.
    OSError
        Files cannot be written.

    Examples
    --------
    >>> summary = run(parse(EXAMPLE))
    >>> summary["status"], summary["steps"], summary["label"]["word"]
    ('done', 100, 'accurate')
    """
    import json

    if out is None:
        text = scene._run(threads)
    else:
        text = _core._record(scene, os.fspath(out), name_of(scene), force, threads)
    summary: dict[str, Any] = json.loads(text)
    return summary


def scene_of(scene: Scene | str | os.PathLike[str]) -> Scene:
    """The scene itself, or the one in a file."""
    return scene if isinstance(scene, Scene) else load(scene)


def name_of(scene: Scene) -> str:
    """Name of a scene for files: that of its own file, or `scene`."""
    return os.path.splitext(os.path.basename(scene.file))[0]
