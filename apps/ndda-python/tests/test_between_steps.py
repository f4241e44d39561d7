"""What changes between steps, and states that are saved."""

import pathlib

import ndda
import numpy as np
import pytest

SCENES = pathlib.Path(__file__).resolve().parents[3] / "scenes"
RAMP = SCENES / "sliding_45_phi35.ron"


def bounce(**keywords: object) -> ndda.Simulation:
    return ndda.Simulation(ndda.load(SCENES / "bounce.ron", **{"time.end_s": 0.2}), **keywords)


def test_gravity_that_turns_round_brings_a_block_to_rest() -> None:
    simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE))
    simulation.run(until=0.5)
    simulation.change(gravity_m_s2=(0.0, 0.0, 9.81))
    simulation.run()
    np.testing.assert_allclose(simulation.velocity, 0.0, atol=1e-12)
    # ½ g t² twice.
    np.testing.assert_allclose(simulation.displacement[:, 2], -9.81 * 0.25, rtol=1e-12)
    assert simulation.label == "accurate"
    energies = simulation.energies
    assert abs(energies["balance_j"]) < 1e-9 * energies["load_work_j"] and energies["load_work_j"] > 0.0


def test_friction_that_is_lost_lets_a_block_slide_without_it() -> None:
    simulation = ndda.Simulation(ndda.load(RAMP, **{"time.end_s": 0.2}))
    block = simulation.block_names[-1]
    simulation.run(until=0.1)
    before = np.linalg.norm(simulation.blocks[block].velocity.mean(axis=0))
    simulation.change(**{"contact.friction.friction_deg": 0.0})
    simulation.run()
    after = np.linalg.norm(simulation.blocks[block].velocity.mean(axis=0))
    gravity = np.linalg.norm(ndda.load(RAMP).to_builder().gravity_m_s2)
    # Down a slope of 45°: g sin 45°, without friction.
    assert after - before == pytest.approx(gravity * np.sqrt(0.5) * 0.1, rel=5e-3)
    assert simulation.label == "accurate", simulation.reasons


def test_a_snapshot_from_before_a_change_goes_back_to_the_scene_as_it_was() -> None:
    simulation = bounce()
    simulation.run(until=0.05)
    kept = simulation.snapshot()
    simulation.run()
    end = simulation.state_crc32
    simulation.restore(kept)
    simulation.change(gravity_m_s2=(0.0, 0.0, -1.0))
    simulation.run()
    assert simulation.state_crc32 != end
    simulation.restore(kept)
    assert simulation.scene.text == ndda.load(SCENES / "bounce.ron", **{"time.end_s": 0.2}).text
    simulation.run()
    assert simulation.state_crc32 == end


def test_a_change_to_what_is_there_already_changes_no_bit() -> None:
    plain, changed = bounce(), bounce()
    plain.run()
    changed.run(until=0.11)
    changed.change(gravity_m_s2=tuple(changed.scene.to_builder().gravity_m_s2))
    changed.run()
    assert changed.state_crc32 == plain.state_crc32 and changed.label == plain.label


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"time.step_s": 1e-3}, "time cannot change"),
        ({"materials.0.density_kg_m3": 1000.0}, "materials cannot change"),
        ({"contact.penalty_pa": 1e9}, "contact, but for its friction, cannot change"),
    ],
)
def test_what_cannot_change_is_refused_in_words_and_nothing_has_changed(change: dict, words: str) -> None:
    simulation = bounce()
    simulation.step(10)
    before, text = simulation.state_crc32, simulation.scene.text
    with pytest.raises(ValueError, match=words):
        simulation.change(**change)
    with pytest.raises(ndda.SceneError):
        simulation.change(gravity_m_s2="down")
    assert (simulation.state_crc32, simulation.scene.text) == (before, text)
    simulation.step()


def test_laws_that_keep_other_numbers_are_refused_and_nothing_has_changed() -> None:
    simulation = ndda.Simulation(ndda.load(RAMP, **{"time.end_s": 0.02, "reference": None}))
    simulation.run(until=0.01)
    before = simulation.state_crc32
    residual = "(friction_deg: 35, shear_penalty_pa_m: 2e10, residual: (friction_deg: 20, over_m: 0.001))"
    with pytest.raises(ValueError, match="numbers per facet, and the changed ones 1: .* Begin a new one with them"):
        simulation.change(**{"contact.friction": residual})
    assert simulation.state_crc32 == before
    simulation.change(**{"contact.friction": "(friction_deg: 20)"})
    simulation.run()
    assert simulation.label == "accurate"


def test_a_saved_simulation_goes_on_with_all_bits(tmp_path: pathlib.Path) -> None:
    simulation = bounce()
    simulation.run(until=0.11)
    simulation.change(gravity_m_s2=(0.0, 0.0, -5.0))
    simulation.save(tmp_path / "state")
    simulation.run()
    later = ndda.resume(tmp_path / "state")
    later.run()
    assert later.state_crc32 == simulation.state_crc32 and later.label == simulation.label


def test_the_checkpoint_of_a_run_in_a_folder_goes_on(tmp_path: pathlib.Path) -> None:
    scene = ndda.load(SCENES / "bounce.ron", **{"time.end_s": 0.02})
    summary = ndda.run(scene, tmp_path / "out")
    assert ndda.resume(tmp_path / "out").state_crc32 == summary["state_crc32"]


def test_a_run_with_stages_is_resumed_as_a_whole(tmp_path: pathlib.Path) -> None:
    staged = ndda.EXAMPLE.replace("contact: Off", 'contact: Off, stages: [(name: "later", then: Run(0.5))]')
    ndda.run(ndda.parse(staged), tmp_path / "out")
    with pytest.raises(ValueError, match="has stages, through which a run goes on as a whole: `ndda resume"):
        ndda.resume(tmp_path / "out")


def test_files_that_hold_something_else_are_refused(tmp_path: pathlib.Path) -> None:
    with pytest.raises(ValueError, match="holds no saved simulation"):
        ndda.resume(tmp_path / "nothing")
    file = tmp_path / "state"
    simulation = bounce()
    simulation.save(file)
    content = bytearray(file.read_bytes())
    content[len(content) // 2] ^= 1
    file.write_bytes(content)
    with pytest.raises(ValueError, match="damaged"):
        ndda.resume(file)


def test_blocks_by_pattern_have_centres_and_masses() -> None:
    simulation = bounce()
    cube = simulation.blocks["cu*"]
    assert cube.names == ["cube"] and len(cube.nodes) == 27
    np.testing.assert_allclose(cube.center, [cube.position.mean(axis=0)], rtol=1e-12)
    assert cube.mass[0] == pytest.approx(2650.0, rel=1e-12)
    assert "cube" in simulation.blocks and list(simulation.blocks) == ["plate", "cube"]
    with pytest.raises(KeyError, match="there are plate, cube"):
        simulation.blocks["ball"]


def test_supports_that_do_not_exist_are_not_released() -> None:
    with pytest.raises(KeyError, match="no support"):
        bounce().release("cube")


def test_a_block_that_is_held_stops_where_it_is_and_falls_again_when_released() -> None:
    simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE.replace("Rigid", "Elastic")))
    simulation.run(until=0.25)
    simulation.hold("block")
    simulation.run(until=0.5)
    # ½ g t² of the time in which it was free.
    np.testing.assert_allclose(simulation.displacement[:, 2], -0.5 * 9.81 * 0.25**2, rtol=1e-9)
    simulation.release("block")
    simulation.run(until=0.75)
    np.testing.assert_allclose(simulation.displacement[:, 2], -9.81 * 0.25**2, rtol=1e-9)


def test_a_block_that_has_turned_is_not_held_without_turning() -> None:
    simulation = ndda.Simulation(ndda.parse(ndda.EXAMPLE.replace("Rigid", "Elastic")))
    simulation.set_velocity("block", (0.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    simulation.run(until=0.25)
    with pytest.raises(ValueError, match="has rotated by"):
        simulation.hold("block", ndda.builders.Region.Set("z_min"))


GRAIN = SCENES / "extreme" / "small_between_large.ron"


def test_changes_that_act_on_no_block_leave_the_label_that_a_run_has() -> None:
    summary = ndda.run(ndda.load(GRAIN))
    simulation = ndda.Simulation(ndda.load(GRAIN))
    simulation.step(100)
    simulation.change(title='"another"', monitors=[], **{"output.frames": 3})
    simulation.run()
    assert summary["label"]["word"] == "inaccurate" and summary["label"]["reasons"] == simulation.reasons
    assert simulation.state_crc32 == summary["state_crc32"]


def test_a_grain_that_is_struck_is_not_called_accurate_without_half_the_step() -> None:
    simulation = ndda.Simulation(ndda.load(GRAIN))
    simulation.step(100)
    grain = simulation.block_names[1]
    simulation.set_velocity(grain, simulation.blocks[grain].velocity.mean(axis=0))
    simulation.run()
    assert simulation.label == "inaccurate"
    assert "was not repeated with half the step, since a velocity was set at t = " in simulation.reasons[0]


def test_a_block_that_is_driven_in_each_step_is_not_called_accurate() -> None:
    cube = '(name: "{}", material: "rock", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: ({}, 0, 0))'
    text = f"""Scene(title: "driven", time: (step_s: 1e-3, end_s: 0.06),
        materials: [(name: "rock", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
        blocks: [{cube.format("a", 0)}, {cube.format("b", 1.005)}],
        contact: Potential(penalty_pa: 1e8, potential: Smooth()))"""
    simulation = ndda.Simulation(ndda.parse(text))
    simulation.run(callback=lambda now: now.set_velocity("a", (1.0, 0.0, 0.0)))
    # A wall that moves at 1 m/s throws a cube at rest off at 2 m/s; with this step, the error is a tenth.
    assert abs(simulation.blocks["b"].velocity[:, 0].mean() - 2.0) > 0.05
    assert simulation.label == "inaccurate"
    assert "driven in steps that follow each other (a velocity was set at t = " in simulation.reasons[-1]
    assert "half of time.step_s" in simulation.reasons[-1]
