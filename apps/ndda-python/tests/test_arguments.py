"""Arguments that cannot be meant are refused in words that name them, and the others are taken as they are."""

import pathlib

import ndda
import numpy as np
import pytest

SCENES = pathlib.Path(__file__).resolve().parents[3] / "scenes"


@pytest.fixture
def fall() -> ndda.Simulation:
    return ndda.Simulation(ndda.parse(ndda.EXAMPLE))


def test_counts_that_are_none_are_refused_by_name(fall: ndda.Simulation) -> None:
    for call, words in [
        (lambda: fall.step(-1), "n is -1: give at least 0"),
        (lambda: fall.step(1.5), "n is 1.5: give a whole number"),
        (lambda: fall.step(10**30), "n is 1000000000000000000000000000000: give fewer steps"),
        (lambda: fall.run(every="a"), "every is 'a': give a whole number"),
        (lambda: fall.run(frames=-1), "frames is -1: give at least 0"),
        (lambda: fall.run("1"), r"until is '1': give a time \[s\]"),
        (lambda: fall.run(float("nan")), r"until is nan: give a time \[s\]"),
        (lambda: fall.run(1e300), "until is 1e[+]300 s, or 1e[+]302 steps: give an earlier time"),
        (lambda: fall.run(callback=3), "callback is 3: give a function"),
    ]:
        with pytest.raises((TypeError, ValueError), match=words):
            call()
    assert fall.step_count == 0


@pytest.mark.parametrize("threads", [-1, 0, 1025, 20_000])
def test_threads_are_one_to_1024(threads: int) -> None:
    scene = ndda.parse(ndda.EXAMPLE)
    for make in (ndda.Simulation, ndda.run, ndda.safety):
        with pytest.raises(ValueError, match=f"threads is {threads}: give 1 to 1024, or None for all processors"):
            make(scene, threads=threads)


@pytest.mark.parametrize("name", ["jobs", "threads"])
def test_runs_at_a_time_and_their_threads_are_one_to_1024(name: str) -> None:
    scene = ndda.parse(ndda.EXAMPLE)
    with pytest.raises(ValueError, match=f"{name} is 20000: give at most 1024"):
        ndda.certify(scene, **{name: 20_000})
    with pytest.raises(ValueError, match=f"{name} is 0: give at least 1"):
        ndda.study(scene, {"time.step_s": [0.01, 0.02]}, of=["block block.displacement_m"], **{name: 0})


def test_a_run_after_the_end_says_when_the_scene_ended(fall: ndda.Simulation) -> None:
    fall.run(until=1.5)
    with pytest.raises(ValueError, match="the scene ends at 1.0 s, and it is 1.5 s already: give until, or change"):
        fall.run()


def test_frames_are_at_most_one_of_each_step(fall: ndda.Simulation) -> None:
    fall.run(until=0.1, frames=10**12)
    assert fall.show().frames == 11


def test_an_end_that_a_callback_changes_is_that_of_the_run_under_way() -> None:
    for end_s in (0.5, 2.0):
        simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))

        def change(now: ndda.Simulation, end_s: float = end_s) -> None:
            if now.step_count == 5:
                now.change(**{"time.end_s": end_s})

        simulation.run(callback=change)
        assert simulation.time_s == pytest.approx(end_s) and simulation.step_count == simulation.steps


def test_an_end_that_is_past_is_refused(fall: ndda.Simulation) -> None:
    fall.run()
    with pytest.raises(ValueError, match="time.end_s is 0.5 s, and it is 1 s already: give a later end"):
        fall.change(**{"time.end_s": 0.5})
    assert fall.steps == 100


def test_blocks_are_found_by_number_and_in_lists_and_by_nothing_else() -> None:
    simulation = ndda.Simulation(ndda.load(SCENES / "bounce.ron"))
    blocks = simulation.blocks
    assert blocks[1].names == blocks[-1].names == blocks[np.int64(1)].names == ["cube"]
    assert blocks[["cube", 0, "cu*"]].names == ["cube", "plate"]
    assert np.array_equal(simulation.nodes(1), simulation.nodes("cube"))
    with pytest.raises(IndexError, match="there is no block 2: the simulation has 2, counted from 0"):
        blocks[2]
    for other in (None, 1.5, b"cube", True):
        with pytest.raises(TypeError, match="give a name, a pattern, a number, or a list of them"):
            blocks[other]
    with pytest.raises(KeyError, match="the list of blocks is empty"):
        blocks[[]]


def test_arrays_of_another_type_are_not_filled(fall: ndda.Simulation) -> None:
    for out, words in [
        (np.empty((8, 3), np.float32), "`out` is an array of float32: give an array of float64"),
        ([[0.0] * 3] * 8, "`out` is a list: give an array of float64"),
        (np.empty((8, 3), ">f8"), "`out` is an array of >f8: give an array of float64"),
        (np.empty(24), r"`out` has shape \(24,\): make it \(8, 3\)"),
        (fall.position, "`out` cannot be written"),
    ]:
        with pytest.raises((TypeError, ValueError), match=words):
            fall.array("position", out=out)


def test_a_rigid_block_says_that_it_cannot_be_held(fall: ndda.Simulation) -> None:
    with pytest.raises(ValueError, match="'block' names a rigid block, which cannot be held: make it Affine or Elastic"):
        fall.hold("block")
    with pytest.raises(KeyError, match="no support has the block 'block'; the scene has none"):
        fall.release("block")


def test_attributes_that_are_not_there_cannot_be_set(fall: ndda.Simulation) -> None:
    with pytest.raises(AttributeError):
        fall.treads = 1

    class Named(ndda.Simulation):
        name = ""

    named = Named(ndda.parse(ndda.EXAMPLE))
    named.name = "mine"
    assert named.name == "mine"


def test_a_force_of_zero_where_none_acts_changes_no_bit(fall: ndda.Simulation) -> None:
    plain = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
    fall.set_force("block", (0, 0, 0))
    for simulation in (plain, fall):
        simulation.run()
    assert fall.state_crc32 == plain.state_crc32


def test_contact_acts_on_the_first_block_and_all_of_its_area_slides_without_friction() -> None:
    simulation = ndda.Simulation(ndda.load(SCENES / "bounce.ron"), contacts=True)
    simulation.run(until=0.11)
    (pair,) = simulation.contacts
    names = [simulation.block_names[pair[which]] for which in ("first", "second")]
    # The cube, above, pushes the plate down.
    assert names == ["plate", "cube"] and pair["force"][2] < 0.0
    assert pair["sliding"] == 1.0
