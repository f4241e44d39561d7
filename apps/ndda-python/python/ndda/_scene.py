"""Reading scenes, and running them whole."""

from __future__ import annotations

import json
import os
from typing import Any

from ndda._core import Scene

EXAMPLE = """Scene(
    title: "A block falls for a second",
    time: (step_s: 0.01, end_s: 1.0), gravity_m_s2: (0, 0, -9.81), contact: Off,
    materials: [(name: "rock", density_kg_m3: 2600, young_pa: 1e9, poisson: 0.25)],
    blocks: [(name: "block", material: "rock", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
)
"""
"""Text of a scene for examples: a rigid block falls for a second."""


def _value(value: object) -> str:
    """Write a value in RON; a string is RON already."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if value is None:
        return "None"
    if isinstance(value, (tuple, list)):
        inner = ", ".join(_value(item) for item in value)
        return f"({inner})" if isinstance(value, tuple) else f"[{inner}]"
    if isinstance(value, str):
        return value
    if isinstance(value, int):
        return str(value)
    return repr(float(value))  # type: ignore[arg-type]


def _overrides(values: dict[str, object]) -> list[str]:
    return [f"{path}={_value(value)}" for path, value in values.items()]


def load(file: str | os.PathLike[str], **overrides: object) -> Scene:
    """Read and check the scene in a file.

    Parameters
    ----------
    file : path
        The scene.
    **overrides : number, bool, tuple, list, str or None
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
    return Scene._load(os.fspath(file), _overrides(overrides))


def parse(text: str, folder: str | os.PathLike[str] = ".", **overrides: object) -> Scene:
    """Read and check the text of a scene.

    Parameters
    ----------
    text : str
        The scene in RON.
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
    """
    return Scene._parse(text, _overrides(overrides), os.fspath(folder))


def run(scene: Scene) -> dict[str, Any]:
    """Run a scene to its end and judge it, writing no files.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    dict
        What `summary.json` says after `ndda run`.

    Raises
    ------
    SceneError
        The scene cannot be built.
    StopError
        The scene does not settle. A later stop is no exception: `status` is then ``"stopped"``.

    Examples
    --------
    >>> summary = run(parse(EXAMPLE))
    >>> summary["status"], summary["steps"], summary["label"]["word"]
    ('done', 100, 'accurate')
    """
    summary: dict[str, Any] = json.loads(scene._run())
    return summary
