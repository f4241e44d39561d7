"""What the package promises: states of the command line, arrays that are copies, errors with their place."""

import json
import os
import pathlib
import signal
import subprocess
import threading
import tracemalloc

import ndda
import numpy as np
import pytest

SCENES = pathlib.Path(__file__).resolve().parents[3] / "scenes"
SCENE_FILES = [*SCENES.glob("*.ron"), *SCENES.glob("extreme/*.ron")]
# Scenes that take longer are not compared; `versions.sh` gives them more time.
LONGEST_S = float(os.environ.get("NDDA_LONGEST_S", "1"))
BOUNCE = {"time.end_s": 0.12}


@pytest.fixture
def fall() -> ndda.Simulation:
    return ndda.Simulation(ndda.parse(ndda.EXAMPLE))


def bounce(**keywords: object) -> ndda.Simulation:
    return ndda.Simulation(ndda.load(SCENES / "bounce.ron", **BOUNCE), **keywords)


def test_a_falling_block_follows_its_closed_form(fall: ndda.Simulation) -> None:
    fall.run()
    assert fall.step_count == fall.steps == 100
    np.testing.assert_allclose(fall.displacement[:, 2], -0.5 * 9.81, rtol=1e-12)
    np.testing.assert_allclose(fall.velocity[:, 2], -9.81, rtol=1e-12)
    energies = fall.energies
    assert energies["kinetic_j"] == pytest.approx(0.5 * 2600 * 9.81**2, rel=1e-12)
    assert fall.label == "accurate" and fall.reasons == []


@pytest.mark.parametrize("chunk", [1, 7, 10_000])
def test_steps_end_in_the_bits_of_a_whole_run_however_they_are_taken(chunk: int) -> None:
    scene = ndda.load(SCENES / "bounce.ron", **BOUNCE)
    summary = ndda.run(scene)
    simulation = ndda.Simulation(scene)
    while (left := simulation.steps - simulation.step_count) > 0:
        simulation.step(min(chunk, left))
    assert simulation.state_crc32 == summary["state_crc32"]
    assert simulation.label == summary["label"]["word"]
    assert simulation.reasons == summary["label"]["reasons"]


@pytest.mark.skipif("NDDA" not in os.environ, reason="NDDA names no program to compare with")
@pytest.mark.parametrize("name", sorted(str(file.relative_to(SCENES)) for file in SCENE_FILES))
def test_states_and_labels_are_those_of_the_command_line(name: str, tmp_path: pathlib.Path) -> None:
    file, out = SCENES / name, tmp_path / "out"
    command = [os.environ["NDDA"], "run", str(file), "--out", str(out), "--quiet"]
    try:
        subprocess.run(command, timeout=LONGEST_S, capture_output=True, check=False)
    except subprocess.TimeoutExpired:
        pytest.skip(f"takes more than {LONGEST_S} s")
    if not out.exists():
        # A study, which `ndda run` refuses.
        with pytest.raises(ndda.SceneError):
            ndda.load(file)
        return
    summary = json.loads((out / "summary.json").read_text())
    simulation = ndda.Simulation(ndda.load(file))
    if summary["status"] == "stopped":
        with pytest.raises(ndda.StopError) as caught:
            simulation.run()
        assert str(caught.value) == summary["stopped_by"]
    else:
        simulation.run()
    assert simulation.state_crc32 == summary["state_crc32"]
    assert simulation.label == summary["label"]["word"]
    assert simulation.reasons == summary["label"]["reasons"]


def test_states_have_the_same_bits_on_any_number_of_threads() -> None:
    found = set()
    for threads in (1, 2, None):
        simulation = bounce(threads=threads)
        simulation.run()
        found.add(simulation.state_crc32)
    assert len(found) == 1


def test_two_simulations_step_in_two_threads() -> None:
    both = [bounce(threads=1), bounce(threads=1)]
    workers = [threading.Thread(target=simulation.run) for simulation in both]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    alone = bounce()
    alone.run()
    assert [simulation.state_crc32 for simulation in both] == [alone.state_crc32] * 2


def test_a_snapshot_goes_back_with_all_bits() -> None:
    simulation = bounce()
    simulation.run(until=0.095)
    kept, places = simulation.snapshot(), simulation.position
    simulation.run()
    end = simulation.state_crc32
    simulation.restore(kept)
    assert np.array_equal(simulation.position, places)
    simulation.run()
    assert simulation.state_crc32 == end


def test_a_snapshot_of_another_scene_is_refused(fall: ndda.Simulation) -> None:
    with pytest.raises(ValueError, match="another scene"):
        bounce().restore(fall.snapshot())


def test_arrays_are_copies_that_cannot_be_written(fall: ndda.Simulation) -> None:
    before = fall.position
    with pytest.raises(ValueError, match="read-only"):
        before[0, 0] = 1.0
    kept = before.copy()
    fall.step()
    assert np.array_equal(before, kept) and not np.array_equal(before, fall.position)


def test_arrays_of_the_caller_are_filled(fall: ndda.Simulation) -> None:
    fall.step(3)
    for name in ("position", "displacement", "velocity", "acceleration"):
        room = np.full((8, 3), np.nan)
        assert np.array_equal(fall.array(name, out=room), fall.array(name))
    with pytest.raises(ValueError, match=r"make it \(8, 3\)"):
        fall.array("velocity", out=np.empty((7, 3)))
    with pytest.raises(ValueError, match="choose one of"):
        fall.array("speed")


def test_filling_an_array_allocates_none() -> None:
    cells = "shape: Box(size_m: (1, 1, 1), cells: (9, 9, 9))"
    text = ndda.EXAMPLE.replace("shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))", cells)
    simulation = ndda.Simulation(ndda.parse(text))
    room = np.empty((1000, 3))
    simulation.array("position", out=room)
    tracemalloc.start()
    for _ in range(100):
        simulation.array("position", out=room)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    # A copy would be 24 kB.
    assert most < 2000


def test_a_cube_in_its_impact_pushes_on_its_plate() -> None:
    simulation = bounce(contacts=True)
    assert len(simulation.contacts) == 0
    simulation.run(until=0.11)
    pairs = simulation.contacts
    assert len(pairs) == 1
    pair = pairs[0]
    assert {simulation.block_names[pair["first"]], simulation.block_names[pair["second"]]} == {"plate", "cube"}
    assert pair["area"] == pytest.approx(1.0, rel=1e-3)
    np.testing.assert_allclose(pair["friction"], 0.0)
    # The impact reverses the fall: more than the weight acts.
    assert abs(pair["force"][2]) > 2650 * 9.8
    with pytest.raises(ValueError, match="contacts=True"):
        _ = bounce().contacts


def test_nodes_are_found_by_patterns_of_names() -> None:
    simulation = bounce()
    cube = simulation.nodes("cu*")
    assert len(cube) == 27 and simulation.position[cube, 2].min() == pytest.approx(0.05)
    with pytest.raises(KeyError, match="there are plate, cube"):
        simulation.nodes("ball")


def test_errors_of_a_scene_have_code_place_and_advice() -> None:
    with pytest.raises(ndda.SceneError, match="young") as caught:
        ndda.parse(ndda.EXAMPLE.replace("young_pa", "yuong_pa"))
    found = caught.value.diagnostics[0]
    assert found["code"] == "unknown-field" and found["line"] == 4 and "young_pa" in found["help"]
    with pytest.raises(ndda.SceneError) as caught:
        ndda.load("no_such_scene.ron")
    assert caught.value.diagnostics[0]["code"] == "unreadable"


def test_values_of_python_replace_those_of_the_scene() -> None:
    changes = {"time.step_s": 0.005, "gravity_m_s2": (0.0, 0.0, -1.0), "title": '"Moon"'}
    scene = ndda.parse(ndda.EXAMPLE, **changes)
    assert (scene.steps, scene.title) == (200, "Moon")
    simulation = ndda.Simulation(scene)
    simulation.run()
    np.testing.assert_allclose(simulation.velocity[:, 2], -1.0, rtol=1e-12)


def test_a_step_that_cannot_be_taken_is_an_exception_and_no_state_is_shown_after_it() -> None:
    scene = ndda.load(SCENES / "bounce.ron", **{"time.step_s": 0.05, "time.end_s": 5.0})
    simulation = ndda.Simulation(scene)
    start = simulation.snapshot()
    with pytest.raises(ndda.StopError) as caught:
        simulation.run()
    assert caught.value.code in str(caught.value)
    assert simulation.label == "stopped"
    for look in (lambda: simulation.position, lambda: simulation.stress, simulation.step):
        with pytest.raises(ndda.StopError):
            look()
    simulation.restore(start)
    assert simulation.step_count == 0 and simulation.position.shape[1] == 3


def test_what_a_callback_raises_ends_the_run(fall: ndda.Simulation) -> None:
    def stop(now: ndda.Simulation) -> None:
        if now.step_count == 20:
            raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        fall.run(every=10, callback=stop)
    assert fall.step_count == 20


def test_ctrl_c_ends_a_run_after_a_whole_step() -> None:
    # A shell that starts a job in the background has it ignore the signal.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    endless = {"time.end_s": 1e7, "output.history_rows": 1, "gravity_m_s2": (0, 0, 0)}
    simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE, **endless))
    threading.Timer(0.2, lambda: signal.raise_signal(signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        simulation.run()
    done = simulation.step_count
    assert 0 < done < simulation.steps
    simulation.step()
    assert simulation.step_count == done + 1


def test_times_in_the_past_and_bad_counts_are_refused(fall: ndda.Simulation) -> None:
    fall.run(until=0.5)
    with pytest.raises(ValueError, match="restore a snapshot"):
        fall.run(until=0.4)
    with pytest.raises(ValueError, match="every is 0: give at least 1"):
        fall.run(every=0, callback=print)
    with pytest.raises(ValueError, match="threads is 0: give 1 to 1024"):
        bounce(threads=0)


def test_a_block_has_its_own_rows_of_stress_whose_volumes_are_its_mass() -> None:
    text = ndda.EXAMPLE.replace("body: Rigid, ", "").replace("cells: (1, 1, 1)", "cells: (2, 2, 2)")
    scene = ndda.parse(text).to_builder()
    second = ndda.builders.Block.from_dict(json.loads(ndda.parse(text)._json())["blocks"][0])
    second.name, second.at_m = "other", (5.0, 0.0, 0.0)
    second.initial_stress_pa = ndda.builders.Stress(zz=-1e6)
    scene.blocks.append(second)
    simulation = ndda.Simulation(scene)
    other = simulation.blocks["other"]
    assert np.array_equal(other.stress, simulation.stress[other.elements])
    corners = simulation.position[other.tetrahedra]
    volumes = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6.0
    assert (volumes > 0.0).all() and volumes.sum() == pytest.approx(1.0, rel=1e-12)
    assert set(other.tetrahedra.ravel()) == set(other.nodes)
    np.testing.assert_allclose(other.stress[:, 2], -1e6, rtol=1e-9)
    np.testing.assert_allclose(simulation.blocks["block"].stress, 0.0, atol=1e-6)
