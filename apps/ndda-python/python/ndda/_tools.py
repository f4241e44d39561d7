"""Studies, certificates, factors of safety, nets and pictures."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

from ndda import _core
from ndda._checks import names, thread_count, whole
from ndda._files import file_of, findable, folder_of
from ndda._scene import name_of, overrides_of, scene_of

if TYPE_CHECKING:
    from ndda._scene import SceneLike
    from ndda._view import Picture

    PathLike = str | os.PathLike[str]


def _read(text: str) -> dict[str, Any]:
    import json

    found: dict[str, Any] = json.loads(text)
    return found


def study(
    scene: SceneLike,
    vary: Mapping[str, str | Sequence[object]] | None = None,
    *,
    of: str | Sequence[str] = (),
    fails_when: str | None = None,
    samples: int | None = None,
    sampling: Literal["lhs", "sobol"] | None = None,
    seed: int | None = None,
    correlate: str | Sequence[str] = (),
    sensitivity: bool = False,
    second_runs: Literal["auto", "always", "never"] | None = None,
    out: PathLike | None = None,
    jobs: int = 1,
    threads: int = 1,
    **overrides: object,
) -> dict[str, Any]:
    """Find quantities over values and distributions of parameters, or run a study file; lines go to `logging`.

    Parameters
    ----------
    scene : path, Scene or builders.Scene
        A scene with `vary`, or the file of a study.
    vary : mapping, optional
        Values by their path: a list, or a distribution in RON such as ``"Normal(30, 2)"``.
    of : str or sequence of str
        Quantities: `label`, `safety`, columns of a history, monitors, blocks; displacements otherwise.
    fails_when : str, optional
        Condition whose probability is wanted, such as ``"safety < 1"``.
    samples, sampling, seed
        How many samples of what is random (100), how they are spread ("lhs"), and their seed (0).
    correlate : str or sequence of str
        Correlations of random parameters, such as ``"parameters.a,parameters.b=-0.5"``.
    sensitivity : bool
        Whether to find how much each random axis matters.
    second_runs : {"auto", "always", "never"}, optional
        Whether accurate runs are repeated for their labels, as `run` does; as the study says, or else "auto".
    out : path, optional
        Folder of tables, pictures and runs; the same call goes on there where it was interrupted. None is kept otherwise.
    jobs, threads : int
        Runs at a time, and threads of each.
    **overrides
        Values of the scene, as those of `load`.

    Returns
    -------
    dict
        The content of `study.json`.

    Raises
    ------
    SceneError
        The scene or the study cannot be used.
    ValueError
        What is asked for is not there, or every case has failed: the message has the first reason.

    Examples
    --------
    >>> import ndda
    >>> fall = ndda.parse(ndda.EXAMPLE)
    >>> found = ndda.study(fall, {"time.step_s": [0.01, 0.02]}, of=["block block.displacement_m"])
    >>> [round(case["values"][0], 6) for case in found["cases"]]
    [4.905, 4.905]
    """
    if not isinstance(scene, (str, os.PathLike)) and not vary:
        scene_of(scene)
        raise ValueError("nothing varies: give `vary`, or name the file of a study")
    options = {
        "vary": [f"{path}={_choices(values)}" for path, values in (vary or {}).items()],
        "of": names("of", of),
        "fails_when": fails_when,
        "samples": samples,
        "sampling": sampling,
        "seed": seed,
        "correlate": names("correlate", correlate),
        "sensitivity": sensitivity,
        "second_runs": second_runs,
        "overrides": overrides_of(overrides),
        **_at_a_time(jobs, threads),
    }
    with folder_of(out) as folder, file_of(scene) as file:
        return _some_done(_read(_core._study(file, folder, options)))


def _some_done(found: dict[str, Any]) -> dict[str, Any]:
    """The content of a study, unless all of its cases have failed."""
    cases = found.get("cases") or found.get("points") or []
    if cases and all(case.get("reason") for case in cases):
        name, reason = cases[0]["name"] or "the scene", cases[0]["reason"]
        raise ValueError(f"all cases of the study have failed, {len(cases)} of {len(cases)}; the first, {name}: {reason}")
    return found


def _at_a_time(jobs: int, threads: int) -> dict[str, int]:
    """Runs at a time and threads of each, as many as the command takes."""
    return {"jobs": whole("jobs", jobs, 1, 1024), "threads": whole("threads", threads, 1, 1024)}


def _choices(values: str | Sequence[object]) -> str:
    from ndda._scene import value_in_ron

    return values if isinstance(values, str) else ",".join(value_in_ron(value) for value in values)


def certify(
    scene: SceneLike,
    *,
    of: str | Sequence[str] = (),
    mesh: int = 0,
    penalty: int = 0,
    out: PathLike | None = None,
    jobs: int = 1,
    threads: int = 1,
) -> dict[str, Any]:
    """Give every result of a scene an error bar, from runs with steps that halve; lines go to `logging`.

    Parameters
    ----------
    scene : path, Scene or builders.Scene
    of : str or sequence of str
        More quantities: columns of the history or blocks, by name or its beginning.
    mesh, penalty : int
        Finer meshes and stiffer contacts to run for their errors, 0 to 2 each.
    out : path, optional
        Folder of the certificate and its runs; none are kept otherwise.
    jobs, threads : int
        Runs at a time, and threads of each.

    Returns
    -------
    dict
        The content of `certificate.json`.

    Raises
    ------
    SceneError
        The scene cannot be used.
    ValueError
        Runs fail, or what is asked for is not there.

    Examples
    --------
    >>> import ndda
    >>> certificate = ndda.certify(ndda.parse(ndda.EXAMPLE))
    >>> certificate["schema"].startswith("ndda.certificate")
    True
    """
    scene = scene_of(scene)
    finer = {"mesh": whole("mesh", mesh, 0, 2), "penalty": whole("penalty", penalty, 0, 2)}
    options = {"of": names("of", of), **finer, **_at_a_time(jobs, threads)}
    with folder_of(out) as folder:
        return _read(_core._certify(findable(scene), name_of(scene), folder, options))


def safety(
    scene: SceneLike,
    *,
    by: Literal["strength", "load", "gravity"] = "strength",
    towards: Sequence[float] | None = None,
    error: float = 0.01,
    out: PathLike | None = None,
    threads: int | None = None,
) -> dict[str, Any]:
    """Find by how much the strength of joints may fall, loads grow or gravity tilt before blocks move.

    Parameters
    ----------
    scene : path, Scene or builders.Scene
    by : {"strength", "load", "gravity"}
        Quantity that is changed until blocks fail.
    towards : sequence of 3 floats, optional
        With ``by="gravity"``, where gravity is tilted to; straight down the steepest way that blocks can slide otherwise.
    error : float
        Relative width of the bracket.
    out : path, optional
        Folder of `safety.json` and of a run that shows the failure; none are kept otherwise.
    threads : int, optional
        Number of threads, which run trials side by side; all cores otherwise. The answer does not depend on it.

    Returns
    -------
    dict
        The content of `safety.json`; ``["factor_of_safety"]`` has the largest factor at which blocks stand as `lower`,
        and the smallest at which they fail as `upper`.

    Raises
    ------
    SceneError
        The scene cannot be used.
    StopError
        It does not come to rest.
    ValueError
        It has no strength, loads or slope that could be changed.

    Examples
    --------
    >>> import ndda
    >>> ndda.safety(ndda.parse(ndda.EXAMPLE))  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    ValueError: joints have no friction, cohesion or tensile strength that could be reduced, ...
    """
    if towards is not None and by != "gravity":
        raise ValueError('towards works only with by="gravity": add that, or leave towards out')
    options = {
        "by": by,
        "towards": None if towards is None else [float(x) for x in towards],
        "error": error,
        "threads": thread_count(threads),
    }
    scene = scene_of(scene)
    folder = None if out is None else os.fspath(out)
    if folder is not None:
        os.makedirs(folder, exist_ok=True)
    return _read(_core._safety(scene, name_of(scene), folder, options))


def stereonet(
    joints: SceneLike,
    *,
    net: Literal["area", "angle"] = "area",
    slope: str | None = None,
    friction_deg: float | None = None,
    lateral_deg: float | None = None,
    out: PathLike | None = None,
) -> tuple[dict[str, Any], Picture]:
    r"""Draw orientations of joints on the lower hemisphere, and check a slope kinematically.

    Parameters
    ----------
    joints : path, Scene or builders.Scene
        A scene with joints, or a table of planes as CSV with the columns `dip_deg`, `dip_direction_deg` and `set`.
    net : {"area", "angle"}
        Projection: equal area (Schmidt) or equal angle (Wulff).
    slope : str, optional
        Face of a slope, dip and dip direction [°], such as ``"65/150"``.
    friction_deg : float, optional
        Friction of the joints [°], for the checks.
    lateral_deg : float, optional
        Lateral limit: planes slide only if their dip direction is within this angle of the slope's [°]; 20 otherwise.
    out : path, optional
        File of the picture, .svg or .png.

    Returns
    -------
    dict
        Statistics of the sets and the checks.
    Picture
        Shows itself in a notebook.

    Raises
    ------
    ValueError
        The table cannot be read, or an angle is out of range.

    Examples
    --------
    >>> import ndda, pathlib, tempfile
    >>> table = pathlib.Path(tempfile.mkdtemp()) / "joints.csv"
    >>> _ = table.write_text("dip_deg,dip_direction_deg,set\n40,130,bedding\n44,134,bedding\n")
    >>> found, picture = ndda.stereonet(table)
    >>> found["sets"][0]["name"], picture
    ('bedding', <ndda.Picture, svg>)
    """
    import tempfile

    from ndda._view import Picture

    options = {"net": net, "slope": slope, "friction_deg": friction_deg, "lateral_deg": lateral_deg}
    with file_of(joints) as file, tempfile.TemporaryDirectory(prefix="ndda") as folder:
        target = os.path.join(folder, "stereonet.svg") if out is None else os.fspath(out)
        found = _read(_core._stereonet(file, target, options))
        return found, Picture.of_file(target)


def picture(
    run: SceneLike,
    *,
    frame: str = "auto",
    color: str | None = None,
    view: str = "iso",
    resting: Literal["auto", "solid", "clear", "hidden"] = "auto",
    whole: bool = False,
    magnify: float = 1.0,
    bolts: Literal["force", "yield", "state", "plain", "hidden"] = "force",
    dark: bool = False,
    size: tuple[int, int] | None = None,
    animate: int | None = None,
    out: PathLike | None = None,
) -> Picture:
    """Draw the blocks of a run or a scene in 3D, without a browser.

    Parameters
    ----------
    run : path, Scene or builders.Scene
        Output folder of a run, or a scene.
    frame : str
        ``"first"``, ``"last"``, a number from 0, or a time such as ``"0.35s"``.
    color : str, optional
        ``"displacement"``, ``"velocity"``, ``"stress"``, ``"block"``, ``"material"`` or the name of a field.
    view : str
        ``"iso"``, ``"top"``, ``"front"``, ``"side"``, or azimuth and elevation [°] such as ``"150,30"``.
    resting : {"auto", "solid", "clear", "hidden"}
        How blocks at rest are drawn.
    whole : bool
        Whether all blocks are in view, in place of those that move.
    magnify : float
        Factor on displacements.
    bolts : {"force", "yield", "state", "plain", "hidden"}
        Colours of bolts: axial force, its share of the yield force, or state; bolts of a scene are plain.
    dark : bool
        Light on dark.
    size : tuple of 2 ints, optional
        Columns and rows [px].
    animate : int, optional
        Most frames of an animation.
    out : path, optional
        File, .png or .svg.

    Returns
    -------
    Picture
        Shows itself in a notebook.

    Raises
    ------
    SceneError, ValueError
        The scene or the run cannot be used, or there is no such frame or field.

    Examples
    --------
    >>> import ndda
    >>> ndda.picture(ndda.parse(ndda.EXAMPLE), size=(300, 200))
    <ndda.Picture, png>
    """
    import tempfile

    from ndda._view import Picture

    options = {
        "frame": frame,
        "color": color,
        "view": view,
        "resting": resting,
        "whole": whole,
        "magnify": magnify,
        "bolts": bolts,
        "dark": dark,
        "size": size,
        "animate": animate,
    }
    with file_of(run) as file, tempfile.TemporaryDirectory(prefix="ndda") as folder:
        target = os.path.join(folder, "picture.png") if out is None else os.fspath(out)
        _core._picture(file, target, options)
        return Picture.of_file(target)
