//! A light block between heavy ones that nothing holds sideways (`squeezed_out.ron`).

use ndda::judge::verdict;
use ndda::summary::LabelWord;
use ndda_mesh::Vec3;
use ndda_solver::Simulation;

use super::labelled::{PLACE, SPEED, summary_of, word};
use crate::evidence::Answer::{AtLeast, AtMost, Within};
use crate::evidence::row;
use crate::simulation;

/// Weight of the heavy slab [N], 2k_n/L₀ [Pa/m], and how deep it sinks [m].
const WEIGHT_N: f64 = 1e5 * 9.8;
const SPRING_PA_M: f64 = 2e9;
const DEPTH_M: f64 = WEIGHT_N / SPRING_PA_M;

/// Sizes and places of the slabs: how wide the heavy one is [m], and how far the light one is from the middle [m].
type Place = (f64, f64);

const PLACES: [Place; 5] = [(1.0, 0.0), (1.0, 1e-6), (1.0, 0.1), (0.6, 0.1), (1.4, 0.1)];
const MASS_RATIOS: [f64; 7] = [1.0, 10.0, 1e2, 1e3, 1e4, 1e6, 1e9];

/// A rigid slab of 100 t sinks at 20 mm/s on one of `mass_kg` and 1 m; both are as deep as the weight of the heavy one makes them.
fn slabs(mass_kg: f64, (wide, aside): Place, friction: &str, step_s: f64) -> Simulation {
    let (corner, light) = (0.5 * (1.0 - wide), mass_kg / 0.5);
    simulation(&format!(
        "(title: \"squeezed\", time: (step_s: {step_s:e}, end_s: 1), gravity_m_s2: (0, 0, -9.8),
          materials: [
            (name: \"heavy\", young_pa: 20e9, poisson: 0, density_kg_m3: {:e}),
            (name: \"light\", young_pa: 20e9, poisson: 0, density_kg_m3: {light:e}),
          ],
          blocks: [
            (name: \"base\", material: \"light\", body: Fixed, at_m: (-1, -1, -0.5),
             shape: Box(size_m: (3, 3, 0.5), cells: (3, 3, 1))),
            (name: \"light\", material: \"light\", body: Rigid, at_m: ({aside}, 0, {:e}),
             shape: Box(size_m: (1, 1, 0.5), cells: (1, 1, 1))),
            (name: \"heavy\", material: \"heavy\", body: Rigid, velocity_m_s: (0, 0, -0.02), at_m: ({corner}, {corner}, {:e}),
             shape: Box(size_m: ({wide}, {wide}, 0.25), cells: (1, 1, 1))),
          ],
          contact: Potential(penalty_pa: 1e9, potential: Smooth(reference_m: 1), {friction}))",
        1e5 / (0.25 * wide * wide),
        -DEPTH_M,
        0.5 - 2.0 * DEPTH_M,
    ))
}

/// A run of the slabs.
struct Outcome {
    /// How fast the light one goes sideways, over the largest speed of the run.
    speed: f64,
    /// How far it is, over its height.
    gone: f64,
    /// Whether the run calls itself accurate.
    says: bool,
}

fn run(mass_ratio: f64, place: Place, friction: &str) -> Outcome {
    let mass_kg = 1e5 / mass_ratio;
    let step_s = 0.3 * (mass_kg / (2.0 * SPRING_PA_M)).sqrt();
    let mut simulation = slabs(mass_kg, place, friction, step_s);
    let block = simulation.blocks().find("light").unwrap();
    let sideways = |simulation: &Simulation, field: &[Vec3]| {
        let nodes = simulation.blocks().nodes_of(block);
        simulation.shape(block).operator.center(&field[nodes]).xy()
    };
    let began = sideways(&simulation, simulation.start_position());
    let (mut fastest, mut speed) = (0.02f64, 0.0f64);
    simulation.sample().unwrap();
    for _ in 0..(0.02 / step_s).min(3000.0) as u64 {
        simulation.step().unwrap();
        let velocity = &simulation.state().velocity;
        speed = sideways(&simulation, velocity).norm();
        fastest = velocity.iter().map(|v| v.norm()).fold(fastest, f64::max);
    }
    simulation.sample().unwrap();
    let gone = (sideways(&simulation, &simulation.state().position) - began).norm() / 0.5;
    // The slabs vibrate up and down, too, which other criteria judge.
    let reasons = verdict::label(&simulation, None).reasons;
    let says = reasons.iter().all(|reason| reason.contains("vibrate or jump"));
    let speed = speed / fastest;
    println!(
        "1:{mass_ratio:e} at {place:?} {friction}: {speed:.1e}, {gone:.1e} of its height, accurate {says}"
    );
    Outcome { speed, gone, says }
}

#[test]
fn whatever_the_masses_a_slab_that_is_squeezed_out_is_not_called_accurate() {
    let (mut claimed_wrongly, mut too_modest, mut accurate) = (0, 0, 0);
    // Friction of 1e-5 carries less than what is unknown.
    for friction in ["", "friction: (friction_deg: 6e-4)"] {
        for mass_ratio in MASS_RATIOS {
            for place in PLACES {
                let Outcome { speed, gone, says } = run(mass_ratio, place, friction);
                claimed_wrongly += u32::from(says && (speed > SPEED || gone > PLACE));
                too_modest += u32::from(!says && speed < 0.5 * SPEED && gone < 0.5 * PLACE);
                accurate += u32::from(says);
            }
        }
    }
    // The statement: none is, in either direction.
    row(
        "extreme: unlike masses",
        "squeezed slabs called accurate that are not",
        f64::from(claimed_wrongly),
        AtMost(0.0),
    );
    row(
        "extreme: unlike masses",
        "squeezed slabs called inaccurate that are not",
        f64::from(too_modest),
        AtMost(0.0),
    );
    row(
        "extreme: unlike masses",
        "squeezed slabs called accurate, of 70",
        f64::from(accurate),
        AtLeast(20.0),
    );
}

#[test]
fn a_slab_that_friction_holds_stays_and_is_called_accurate() {
    let (mut farthest, mut called) = (0.0f64, 0);
    for mass_ratio in MASS_RATIOS {
        for place in [(1.0, 1e-6), (1.0, 0.1), (1.4, 0.1)] {
            let Outcome { gone, says, .. } = run(mass_ratio, place, "friction: (friction_deg: 30)");
            farthest = farthest.max(gone);
            called += u32::from(says);
        }
    }
    row(
        "extreme: unlike masses",
        "way of a slab that friction holds, over its height",
        farthest,
        AtMost(1e-3),
    );
    row(
        "extreme: unlike masses",
        "slabs that friction holds called accurate, of 21",
        f64::from(called),
        AtLeast(21.0),
    );
}

/// A rigid wedge of 20 kg, `angle` steep, under a rigid block of 20 t, both free on a floor: how far it is pressed out, over what it should be,
/// −½ t² g sin α cos α / (m/M + sin² α), and whether the run calls itself accurate.
fn wedge(angle_deg: f64) -> (f64, bool) {
    let (sin, cos) = angle_deg.to_radians().sin_cos();
    let low = 0.5 - sin / cos;
    // Heights of the lower and of the upper face, at x = 0 and at x = 1.
    let block = |[a, b]: [f64; 2], [c, d]: [f64; 2]| {
        format!(
            "Hexahedron(cells: (1, 1, 1), corners_m: ((0, 0, {a:e}), (1, 0, {b:e}), (1, 1, {b:e}), (0, 1, {a:e}), (0, 0, {c:e}), \
             (1, 0, {d:e}), (1, 1, {d:e}), (0, 1, {c:e})))"
        )
    };
    let mut simulation = simulation(&format!(
        "(title: \"wedge\", time: (step_s: 2e-5, end_s: 1), gravity_m_s2: (0, 0, -9.8),
          materials: [
            (name: \"heavy\", young_pa: 20e9, poisson: 0, density_kg_m3: {:e}),
            (name: \"light\", young_pa: 20e9, poisson: 0, density_kg_m3: {:e}),
          ],
          blocks: [
            (name: \"floor\", material: \"light\", body: Fixed, at_m: (-2, -1, -0.5),
             shape: Box(size_m: (5, 3, 0.5), cells: (5, 3, 1))),
            (name: \"light\", material: \"light\", body: Rigid, shape: {}),
            (name: \"heavy\", material: \"heavy\", body: Rigid, shape: {}),
          ],
          contact: Potential(penalty_pa: 1e9, potential: Smooth(reference_m: 1)))",
        2e4 / (0.5 + 0.5 * sin / cos),
        20.0 / (0.5 - 0.5 * sin / cos),
        block([0.0; 2], [0.5, low]),
        block([0.5, low], [1.0; 2]),
    ));
    simulation.sample().unwrap();
    crate::advance(&mut simulation, 1000);
    simulation.sample().unwrap();
    let block = simulation.blocks().find("light").unwrap();
    let (nodes, operator) = (simulation.blocks().nodes_of(block), &simulation.shape(block).operator);
    let way = operator.center(&simulation.state().position[nodes.clone()])
        - operator.center(&simulation.start_position()[nodes]);
    let expected = -9.8 * sin * cos / (1e-3 + sin * sin);
    (way.x / (0.5 * 0.02 * 0.02 * expected), verdict::label(&simulation, None).word == LabelWord::Accurate)
}

#[test]
fn a_wedge_is_pressed_out_as_it_should_be_and_called_accurate() {
    for angle_deg in [2.0, 10.0] {
        let (way, says) = wedge(angle_deg);
        row(
            "extreme: unlike masses",
            &format!("way of a light wedge of {angle_deg}° under a block, over its closed form"),
            way,
            Within(1.0, 1e-2),
        );
        assert!(says);
    }
}

#[test]
fn a_scene_in_which_a_slab_leaves_says_so() {
    let summary = summary_of("extreme/squeezed_out.ron", &[]);
    let summary = summary.unwrap();
    let (value, left) = (
        &summary["verdicts"]["unresolved lateral speed / largest speed"]["value"],
        &summary["monitors"]["light"],
    );
    let left_m = left["displacement"][0].as_f64().unwrap().hypot(left["displacement"][1].as_f64().unwrap());
    row(
        "extreme: unlike masses",
        "way of a slab of a millionth of the mass above it [m]",
        left_m,
        AtLeast(1.0),
    );
    // It grows as the instability does; the limit is 1e-2.
    row(
        "extreme: unlike masses",
        "its speed that is not known, over the largest",
        value.as_f64().unwrap(),
        AtLeast(0.1),
    );
    assert_eq!(word(&summary), "inaccurate");
}
