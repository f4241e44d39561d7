"""Scenes as objects: to RON and back, for every scene of the repository."""

import json
import pathlib
import subprocess
import sys

import ndda
import numpy as np
import pytest
from ndda import builders

HERE = pathlib.Path(__file__).resolve().parents[1]
SCENES = HERE.parents[1] / "scenes"
SCENE_FILES = sorted(str(file.relative_to(SCENES)) for file in SCENES.rglob("*.ron") if "studies" not in file.parts)


@pytest.mark.parametrize("name", SCENE_FILES)
def test_a_scene_survives_objects_and_back(name: str) -> None:
    file = SCENES / name
    try:
        scene = ndda.load(file)
    except ndda.SceneError:
        pytest.skip("refused on purpose, or no scene")
    again = ndda.parse(scene.to_builder(), folder=file.parent)
    here, there = (json.loads(one._json()) for one in (scene, again))
    # Parameters are computed, and materials of other files are written out.
    for one in (here, there):
        one.pop("include", None)
    assert here == there


def test_the_builders_are_those_of_the_schema(tmp_path: pathlib.Path) -> None:
    schema = tmp_path / "schema.json"
    said = subprocess.run([sys.executable, "-m", "ndda", "schema"], check=True, capture_output=True)
    schema.write_bytes(said.stdout)
    command = [sys.executable, str(HERE / "write_builders.py"), str(schema)]
    written = subprocess.run(command, check=True, capture_output=True, text=True, encoding="utf-8").stdout
    assert written == pathlib.Path(builders.__file__).read_text(encoding="utf-8"), "run write_builders.py"


def test_a_field_that_is_not_there_is_refused() -> None:
    with pytest.raises(TypeError):
        builders.Time(step_s=1e-3, end_s=1.0, stride=2.0)
    time = builders.Time(step_s=1e-3, end_s=1.0)
    time.stride = 2.0
    with pytest.raises(AttributeError, match="no field 'stride'"):
        time.to_ron()
    with pytest.raises(ValueError, match="no field 'titel'"):
        ndda.parse({"titel": "x"})
    with pytest.raises(ValueError, match="Shape has no choice 'Torus'"):
        builders.Block.from_dict({"name": "a", "material": "b", "shape": {"Torus": {"radius_m": 1.0}}})
    with pytest.raises(TypeError, match="give a list or a tuple"):
        builders.Shape.Box(size_m=1.0, cells=(1, 1, 1)).to_ron()


def test_a_changed_scene_is_written() -> None:
    scene = ndda.parse(ndda.EXAMPLE).to_builder()
    scene.time.end_s = 2.0
    scene.blocks[0].velocity_m_s = [0.0, 0.0, 9.81]
    simulation = ndda.Simulation(scene)
    simulation.run()
    # v t − ½ g t².
    assert simulation.displacement[0, 2] == pytest.approx(0.0, abs=1e-9)


def test_texts_with_quotes_and_units_are_written() -> None:
    scene = ndda.parse(ndda.EXAMPLE).to_builder()
    scene.title = 'a "quoted" \\ title\n'
    scene.materials[0].young_pa = "Gigapascal(2)"
    checked = ndda.parse(scene)
    assert checked.title == scene.title and checked.to_builder().materials[0].young_pa == 2e9


def box(cells: object) -> builders.Scene:
    scene = ndda.parse(ndda.EXAMPLE).to_builder()
    scene.blocks[0].shape = builders.Shape.Box(size_m=(1, 1, 1), cells=cells)
    return scene


@pytest.mark.parametrize("count", [2, 2.0, np.int64(2), np.float32(2.0)])
def test_whole_numbers_are_counts_whoever_made_them(count: object) -> None:
    assert ndda.parse(box((count, 1, 1))).to_builder().blocks[0].shape.cells == (2, 1, 1)


@pytest.mark.parametrize(
    ("part", "words"),
    [
        (builders.Shape.Box(size_m=(1, 1, 1), cells=(3.9, 1, 1)), "cells is 3.9: give a whole number"),
        (builders.Shape.Box(size_m=(1, 1, 1), cells=("2", 1, 1)), "cells is '2': give a number without quotes"),
        (builders.Shape.Box(size_m=(1, 1, 1), cells=(True, 1, 1)), "cells is True: give a whole number"),
        (builders.Output(contacts="no"), "Output.contacts is 'no': give True or False"),
        (builders.Output(contacts=1), "Output.contacts is 1: give True or False"),
        (builders.Output(frames=float("nan")), "Output.frames is nan: give a finite number"),
        (builders.Time(step_s=float("inf"), end_s=1.0), "Time.step_s is inf: give a finite number"),
        (builders.Time(step_s=1j, end_s=1.0), "Time.step_s is 1j: give a number"),
        (builders.Scene(title=3, time=builders.Time(end_s=1.0)), "Scene.title is 3: give a text"),
    ],
)
def test_values_of_another_kind_are_refused_and_not_changed(part: builders.Builder, words: str) -> None:
    with pytest.raises((TypeError, ValueError), match=words):
        part.to_ron()


def test_booleans_of_numpy_and_paths_are_written() -> None:
    assert builders.Output(contacts=np.bool_(True)).to_ron() == "(contacts: true)"
    assert builders.Ground.File(file=pathlib.Path("a.asc")).to_ron().count('"a.asc"') == 1


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({}, "Scene lacks 'title' and 'time'"),
        ({"titel": "x"}, "no field 'titel'"),
        ({"title": 3, "time": {"end_s": 1.0}}, "Scene.title is 3"),
        ({"title": "x", "time": {"end_s": 1.0}, "blocks": 1.0}, "Scene.blocks is 1.0: give a list"),
    ],
)
def test_a_dictionary_that_is_no_scene_is_an_error_of_a_scene(fields: dict, words: str) -> None:
    with pytest.raises(ndda.SceneError, match=words) as caught:
        ndda.parse(fields)
    assert caught.value.diagnostics[0]["message"] == str(caught.value)


def test_a_part_of_the_scene_is_overridden_by_a_dictionary_or_refused_in_words() -> None:
    assert ndda.parse(ndda.EXAMPLE, time={"step_s": 0.1, "end_s": 1.0}).steps == 10
    with pytest.raises(TypeError, match=r"contact\.friction is .*: give an object of ndda.builders"):
        ndda.parse(ndda.EXAMPLE, **{"contact.friction": {"friction_deg": 30}})
    with pytest.raises(TypeError, match=r"time\.end_s is .*: give a number"):
        ndda.parse(ndda.EXAMPLE, **{"time.end_s": object()})
