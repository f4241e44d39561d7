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
        (lambda: fall.step(True), "n is True: give a whole number"),
        (lambda: fall.run(every=True), "every is True: give a whole number"),
        (lambda: ndda.Simulation(ndda.parse(ndda.EXAMPLE), threads=True), "threads is True: give 1 to 1024"),
        (lambda: ndda.run(ndda.parse(ndda.EXAMPLE), threads=1.5), "threads is 1.5: give 1 to 1024"),
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


def test_selections_of_blocks_are_copies_that_nobody_takes_for_the_state(fall: ndda.Simulation) -> None:
    block = fall.blocks["block"]
    for name in ("position", "displacement", "velocity", "stress", "center", "mass", "nodes", "elements", "tetrahedra"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(block, name)[...] = 1


def two_cubes(first: str, second: str, body: str = "Elastic") -> ndda.Simulation:
    cube = '(name: "{}", material: "rock", body: {}, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: ({}, 0, 0))'
    text = ndda.EXAMPLE.replace("(0, 0, -9.81)", "(0, 0, 0)")
    head = text[: text.index("blocks: [")]
    return ndda.Simulation(ndda.parse(f"{head}blocks: [{cube.format(first, body, 0)}, {cube.format(second, body, 3)}])"))


def test_a_name_that_is_exactly_so_wins_and_only_a_star_is_special() -> None:
    simulation = two_cubes("c[1]", "c1")
    simulation.set_force("c[1]", (2600.0, 0.0, 0.0))
    simulation.run(until=0.1)
    speeds = [simulation.blocks[i].velocity[:, 0].mean() for i in (0, 1)]
    assert speeds == pytest.approx([0.1, 0.0], abs=1e-9)
    star = two_cubes("c*", "c1")
    assert star.blocks["c*"].names == ["c*"] and star.blocks["*"].names == ["c*", "c1"]
    with pytest.raises(ValueError, match="is a pattern, too, and stands for 'c1'"):
        star.hold("c*")
    for call in (simulation.blocks.__getitem__, simulation.hold, simulation.release):
        with pytest.raises(KeyError, match="no block is called 'c[?]'; there are .*only [*] stands for anything"):
            call("c?")


def test_blocks_are_held_and_released_by_name_pattern_number_and_list() -> None:
    simulation = two_cubes("a", "b")
    for which in ("a", "*", 1, ["a", 1], -1):
        simulation.hold(which)
        simulation.release(which)
        assert not simulation.scene.to_builder().supports
    simulation.hold("*")
    with pytest.raises(ValueError, match="the support of '[*]' holds b, too: release '[*]'"):
        simulation.release("a")
    simulation.release(["a", "b"])
    with pytest.raises(KeyError, match="no support has the block 'a'; the scene has none"):
        simulation.release("a")


def test_all_functions_take_a_scene_its_objects_and_its_file_and_name_what_else_they_get(tmp_path: pathlib.Path) -> None:
    checked = ndda.parse(ndda.EXAMPLE)
    file = tmp_path / "fall.ron"
    file.write_text(ndda.EXAMPLE)
    vary = {"time.step_s": [0.01, 0.02]}
    functions = [
        lambda scene: ndda.run(scene)["steps"],
        lambda scene: ndda.Simulation(scene).steps,
        lambda scene: len(ndda.study(scene, vary, of="block block.displacement_m")["cases"]),
        lambda scene: len(ndda.certify(scene)["runs"]),
        lambda scene: ndda.picture(scene, size=(300, 200)).kind,
    ]
    others = [(ndda.EXAMPLE, "text in RON: give ndda.parse"), ({"title": "x"}, "a dictionary: give ndda.parse"), (3, "3 is not a scene")]
    for function in [*functions, ndda.safety, ndda.stereonet]:
        for other, words in others:
            with pytest.raises(TypeError, match=words):
                function(other)
    for function in functions:
        first, *rest = [function(scene) for scene in (checked, checked.to_builder(), file, str(file))]
        assert all(other == first for other in rest)
    for scene in (checked, checked.to_builder(), file):
        with pytest.raises(ValueError, match="no friction"):
            ndda.safety(scene)


def test_options_that_the_command_refuses_are_refused(tmp_path: pathlib.Path) -> None:
    scene = ndda.parse(ndda.EXAMPLE)
    for name in ("mesh", "penalty"):
        with pytest.raises(ValueError, match=f"{name} is 3: give at most 2"):
            ndda.certify(scene, **{name: 3})
    with pytest.raises(ValueError, match="towards works only with by=.gravity.: add that, or leave towards out"):
        ndda.safety(scene, towards=(1, 0, 0))
    with pytest.raises(TypeError, match="of is 3: give a text or a list of texts"):
        ndda.certify(scene, of=3)
    found = ndda.study(scene, {"time.step_s": [0.01, 0.02]}, of="label")
    assert [case["label"] for case in found["cases"]] == ["accurate", "accurate"]


def test_numbers_of_a_scene_that_are_known_only_later_are_none() -> None:
    text = ndda.EXAMPLE
    scene = ndda.parse(text.replace("step_s: 0.01, ", ""))
    assert (scene.step_s, scene.steps, scene.end_s) == (None, None, 1.0)
    assert repr(scene) == '<ndda.Scene "A block falls for a second", 1 s>'
    simulation = ndda.Simulation(scene)
    assert simulation.scene.step_s == simulation.step_s and simulation.scene.steps == simulation.steps
    staged = text.replace("contact: Off", 'contact: Off, stages: [(name: "later", then: Run(0.5))]')
    scene = ndda.parse(staged)
    assert (scene.step_s, scene.steps, scene.end_s) == (0.01, 150, 1.5)
    assert ndda.run(scene)["steps"] == 150
    with pytest.raises(ValueError, match="the scene has stages, which `ndda.run` follows"):
        ndda.Simulation(scene)
    held = text.replace("body: Rigid, ", "").rstrip()[:-1] + 'supports: [(block: "block", on: All, hold: Fixed)],)'
    scene = ndda.parse(held.replace("contact: Off", 'contact: Off, stages: [(name: "later", then: Settle())]'))
    assert (scene.step_s, scene.steps, scene.end_s) == (0.01, None, None)


def test_a_snapshot_brings_frames_and_history_of_its_own_run(fall: ndda.Simulation) -> None:
    start = fall.snapshot()
    fall.blocks["block"].set_velocity((1, 0, 0))
    fall.run(until=0.4, frames=4)
    struck = fall.snapshot()
    fall.restore(start)
    fall.run(until=0.6, frames=3)
    fall.restore(struck)
    assert [round(time, 2) for time, _ in fall._frames] == [0.0, 0.1, 0.2, 0.3, 0.4]
    meshio = pytest.importorskip("meshio")
    sideways = [meshio.read(file).point_data["Displacement"][:, 0].max() for _, file in fall._frames]
    np.testing.assert_allclose(sideways, [0, 0.1, 0.2, 0.3, 0.4], rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(fall.history["momentum_x_kg_m_s"][1:], 2600.0, rtol=1e-9)
    other = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
    other.run(until=0.6, frames=3)
    other.restore(struck)
    assert [round(time, 2) for time, _ in other._frames] == [0.4]
    np.testing.assert_array_equal(other.history["time_s"], fall.history["time_s"])


def test_after_a_restore_frames_are_those_of_the_present_run(fall: ndda.Simulation) -> None:
    kept = fall.snapshot()
    fall.run(frames=4)
    fall.restore(kept)
    fall.set_force("block", (0, 0, 2 * 2600 * 9.81))
    fall.run(frames=4)
    times = [time for time, _ in fall._frames]
    assert times == pytest.approx([0, 0.25, 0.5, 0.75, 1.0]) and fall.show().frames == 5
    meshio = pytest.importorskip("meshio")
    heights = [meshio.read(file).points[:, 2].min() for _, file in fall._frames]
    assert heights == pytest.approx([0.5 * 9.81 * time**2 for time in times], abs=1e-4)


def test_a_frame_is_a_whole_number_and_a_time_a_float(tmp_path: pathlib.Path) -> None:
    ndda.run(ndda.parse(ndda.EXAMPLE, **{"output.frames": 4}), tmp_path / "out")
    results = ndda.read(tmp_path / "out")
    names = [results._file(number).name for number in range(5)]
    assert len(set(names)) == 5
    for frame, number in [(np.int64(2), 2), (-1, 4), (np.int8(-5), 0), (0.3, 1), (np.float32(1.0), 4), (0.0, 0)]:
        assert results._file(frame).name == names[number]
    choices = "the run has frames 0 to 4, or -5 to -1 from the end, at 0 to 1 s"
    for frame in (5, -6, np.int64(5)):
        with pytest.raises(IndexError, match=choices):
            results._file(frame)
    for frame in (np.nan, -3.0, 1.1, np.inf):
        with pytest.raises(ValueError, match=choices):
            results._file(frame)
    for frame in (True, "last", None, 1j):
        with pytest.raises(TypeError, match=choices):
            results._file(frame)
