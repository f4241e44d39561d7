"""A friction law in Python."""

import pathlib

import ndda
import numpy as np
import pytest
from ndda._law import Facets

SCENES = pathlib.Path(__file__).resolve().parents[3] / "scenes"
RAMP = SCENES / "sliding_45_phi35_spring.ron"


class Spring:
    """Coulomb friction behind a shear spring, per area."""

    def __init__(self, friction_deg: float, stiffness_pa_m: float) -> None:
        self.tangent, self.stiffness_pa_m = np.tan(np.radians(friction_deg)), stiffness_pa_m

    def __call__(self, facets: Facets) -> np.ndarray:
        trial = facets.shear - self.stiffness_pa_m * facets.area[:, None] * facets.slip
        size = np.linalg.norm(trial, axis=1)
        most = self.tangent * np.maximum(facets.normal_force, 0.0)
        return trial * np.minimum(1.0, most / np.maximum(size, 1e-300))[:, None]


def test_coulomb_in_python_slides_as_the_closed_form() -> None:
    scene = ndda.load(RAMP, **{"time.end_s": 0.5})
    friction = scene.to_builder().contact.friction
    simulation = ndda.Simulation(scene, law=Spring(friction.friction_deg, friction.shear_penalty_pa_m))
    assert not simulation.is_reproducible
    block = simulation.block_names[-1]
    simulation.run(until=0.3)
    first = np.linalg.norm(simulation.blocks[block].velocity.mean(axis=0))
    simulation.run(until=0.5)
    second = np.linalg.norm(simulation.blocks[block].velocity.mean(axis=0))
    gravity = np.linalg.norm(scene.to_builder().gravity_m_s2)
    # Eq. (20): a = g (sin θ − cos θ tan φ).
    expected = gravity * np.sqrt(0.5) * (1.0 - np.tan(np.radians(friction.friction_deg)))
    assert (second - first) / 0.2 == pytest.approx(expected, rel=5e-3)
    energies = simulation.energies
    assert energies["friction_work_j"] < 0.0
    assert abs(energies["balance_j"]) < 1e-2 * energies["kinetic_j"]


def test_areas_and_normal_forces_of_facets_are_those_of_the_contact_so_that_cohesion_holds_as_much() -> None:
    cube = """(title: "cohesion", time: (step_s: 1e-4, end_s: 0.3), gravity_m_s2: (0, 0, -10), gravity_ramp_s: 0.05,
        materials: [(name: "rock", young_pa: 1e9, poisson: 0, density_kg_m3: 1000)],
        blocks: [
            (name: "floor", material: "rock", body: Fixed, shape: Box(size_m: (9, 3, 1), cells: (1, 1, 1)), at_m: (-1, -1, -1)),
            (name: "slab", material: "rock", body: Rigid, shape: Box(size_m: (1, 1, 0.1), cells: (1, 1, 1)), velocity_m_s: (2, 0, 0)),
        ],
        contact: Potential(penalty_pa: 1e8, potential: Smooth()))"""
    seen = {}

    def cohesion(facets: Facets) -> np.ndarray:
        seen.update(area=facets.area.sum(), force=facets.normal_force.sum())
        speed = np.maximum(np.linalg.norm(facets.slip, axis=1), 1e-300)
        return -100.0 * facets.area[:, None] * facets.slip / speed[:, None]

    simulation = ndda.Simulation(ndda.parse(cube), law=cohesion)
    simulation.run(until=0.3)
    assert seen["area"] == pytest.approx(1.0, rel=1e-4)
    # Contact still vibrates a little after the ramp.
    assert seen["force"] == pytest.approx(1000.0, rel=3e-2)
    # 100 Pa on 1 m² slow 100 kg by 1 m/s².
    assert simulation.blocks["slab"].velocity.mean(axis=0)[0] == pytest.approx(2.0 - 0.3, rel=1e-3)


def test_a_law_keeps_numbers_of_each_facet_in_snapshots() -> None:
    class Counting(Spring):
        state_len = 1
        seen = 0.0

        def __call__(self, facets: Facets) -> np.ndarray:
            facets.state[:] += 1.0
            self.seen = facets.state.max()
            return super().__call__(facets)

    law = Counting(35.0, 2e8)
    simulation = ndda.Simulation(ndda.load(RAMP), law=law)
    simulation.step(20)
    kept, count = simulation.snapshot(), law.seen
    simulation.step(5)
    assert law.seen == count + 5
    simulation.restore(kept)
    simulation.step(1)
    assert law.seen == count + 1


def test_what_a_law_raises_comes_out_of_step() -> None:
    def broken(facets: Facets) -> np.ndarray:
        raise LookupError("no such rock")

    simulation = ndda.Simulation(ndda.load(RAMP), law=broken)
    with pytest.raises(LookupError, match="no such rock"):
        simulation.run(until=0.1)
    with pytest.raises(ndda.StopError, match="no such rock"):
        simulation.step()


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (lambda facets: np.zeros(3), "make it"),
        (lambda facets: np.full((len(facets), 3), np.nan), "not finite"),
        (lambda facets: 1j * facets.slip, "complex forces: give real ones"),
    ],
)
def test_forces_that_cannot_be_used_are_refused(answer: object, words: str) -> None:
    simulation = ndda.Simulation(ndda.load(RAMP), law=answer)
    with pytest.raises((TypeError, ValueError), match=words):
        simulation.run(until=0.1)


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("state_len", 10**12, "at most 1000 numbers of each facet, 8 kB of memory"),
        ("state_len", -1, "state_len of the law is -1: give at least 0"),
        ("state_len", 1.5, "state_len of the law is 1.5: give a whole number"),
        ("stiffness_pa_m", -1.0, "stiffness_pa_m of the law is -1.0: give 0 or more"),
        ("stiffness_pa_m", np.nan, "stiffness_pa_m of the law is nan: give 0 or more"),
    ],
)
def test_numbers_of_a_law_that_cannot_be_are_refused(name: str, value: object, words: str) -> None:
    law = Spring(35.0, 2e8)
    setattr(law, name, value)
    with pytest.raises((TypeError, ValueError), match=words):
        ndda.Simulation(ndda.load(RAMP), law=law)


def glide(facets: Facets) -> np.ndarray:
    """No friction."""
    return np.zeros((len(facets), 3))


def test_a_simulation_with_a_law_goes_on_only_with_that_law(tmp_path: pathlib.Path) -> None:
    scene = ndda.load(RAMP, **{"time.end_s": 0.01, "reference": None})
    simulation = ndda.Simulation(scene, law=Spring(35.0, 2e8))
    simulation.step(10)
    simulation.save(tmp_path / "state")
    words = "the friction law `Spring`, which is not in the file, and is resumed with no law of its own: resume with it, in Python `ndda.resume"
    with pytest.raises(ValueError, match=words):
        ndda.resume(tmp_path / "state")
    with pytest.raises(ValueError, match="`Spring`, which is not in the file, and is resumed with the friction law `glide`: resume"):
        ndda.resume(tmp_path / "state", law=glide)
    later = ndda.resume(tmp_path / "state", law=Spring(35.0, 2e8))
    assert not later.is_reproducible and later.state_crc32 == simulation.state_crc32
    plain = ndda.Simulation(scene)
    with pytest.raises(ValueError, match="a simulation with the friction law `Spring`, and this one has no law of its own"):
        plain.restore(simulation.snapshot())
    gliding = ndda.Simulation(scene, law=glide)
    with pytest.raises(ValueError, match="with the friction law `Spring`, and this one has the friction law `glide`"):
        gliding.restore(simulation.snapshot())
    assert plain.step_count == 0 and plain.is_reproducible
