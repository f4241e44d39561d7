"""Reading scenes, and running them whole."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ndda import _core
from ndda._checks import thread_count
from ndda._core import Scene

if TYPE_CHECKING:
    from ndda.builders import Scene as SceneBuilder

    SceneLike = Scene | SceneBuilder | str | os.PathLike[str]

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
    return [f"{path}={_override(path, value)}" for path, value in values.items()]


def _override(path: str, value: object) -> str:
    if _has_mapping(value):
        from ndda import _builder
        from ndda.builders import Scene as SceneBuilder

        kind = SceneBuilder._kinds.get(path)
        if kind is None:
            raise TypeError(f"{path} is {value!r}: give an object of ndda.builders, or a text in RON")
        return _builder._ron(kind, value, path)
    try:
        return value_in_ron(value)
    except TypeError:
        raise TypeError(f"{path} is {value!r}: give a number, a list, an object of ndda.builders, or a text in RON") from None


def _has_mapping(value: object) -> bool:
    return isinstance(value, Mapping) or (isinstance(value, (list, tuple)) and any(map(_has_mapping, value)))


def _text_of(fields: Mapping[str, Any]) -> str:
    """The text of a dictionary; what is wrong with it is an error of a scene."""
    from ndda.builders import Scene as SceneBuilder

    try:
        return SceneBuilder.from_dict(fields).to_ron()
    except (TypeError, ValueError) as error:
        refused = _core.SceneError(str(error))
        found = dict.fromkeys(("severity", "code", "path", "message", "help", "line", "column"))
        refused.diagnostics = [{**found, "severity": "error", "code": "wrong-type", "path": "", "message": str(error)}]
        raise refused from None


def load(file: str | os.PathLike[str], **overrides: object) -> Scene:
    """Read and check the scene in a file.

    Parameters
    ----------
    file : path
        The scene.
    **overrides : number, bool, tuple, list, str, builder, dictionary or None
        Values by their path in the scene; a string is RON, so that a text is quoted twice. A dictionary has all fields of a
        part of the scene, such as ``time={"step_s": 0.01, "end_s": 1.0}``.

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
    TypeError, ValueError
        A value of a builder has the wrong type: a text where a number belongs, a fraction where a count does.

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
    elif isinstance(scene, Mapping):
        text = _text_of(scene)
    else:
        from ndda.builders import Scene as SceneBuilder

        if not isinstance(scene, SceneBuilder):
            raise TypeError(f"{scene!r} is not a scene: give a text, a dictionary, or a builders.Scene; `load` reads files")
        text = scene.to_ron()
    return Scene._parse(text, overrides_of(overrides), os.fspath(folder))


def run(
    scene: SceneLike,
    out: str | os.PathLike[str] | None = None,
    *,
    force: bool = False,
    threads: int | None = None,
) -> dict[str, Any]:
    """Run a scene to its end and judge it.

    Parameters
    ----------
    scene : Scene, builders.Scene or path
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

    scene, threads = scene_of(scene), thread_count(threads)
    if out is None:
        text = scene._run(threads)
    else:
        text = _core._record(scene, os.fspath(out), name_of(scene), force, threads)
    summary: dict[str, Any] = json.loads(text)
    return summary


def scene_of(scene: SceneLike) -> Scene:
    """The scene itself, that of objects, or the one in a file."""
    if isinstance(scene, Scene):
        return scene
    if isinstance(scene, (str, os.PathLike)):
        return load(path_of(scene))
    if isinstance(scene, Mapping):
        raise TypeError("the scene is a dictionary: give ndda.parse(dictionary)")
    from ndda.builders import Scene as SceneBuilder

    if isinstance(scene, SceneBuilder):
        return parse(scene)
    raise TypeError(
        f"{scene!r} is not a scene: give one of ndda.load or ndda.parse, a builders.Scene, or the path of a file"
    )


def path_of(given: str | os.PathLike[str]) -> str:
    """The path of a file, which a text of a scene is not."""
    path = os.fspath(given)
    if "\n" in path or path.lstrip().startswith(("Scene(", "(")):
        raise TypeError("the scene is a text in RON: give ndda.parse(text); a string names a file")
    return path


def name_of(scene: Scene) -> str:
    """Name of a scene for files: that of its own file, or `scene`."""
    return os.path.splitext(os.path.basename(scene.file))[0]
