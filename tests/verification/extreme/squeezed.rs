//! X3: a light block between heavy ones that nothing holds sideways (`squeezed_out.ron`).

use ndda_cli::verdict;
use ndda_io::summary::LabelWord;
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

/// A rigid slab of 100 t, `wide` metres wide, lies on one of `mass_kg` and 1 m that is `aside` from the middle; both are as deep as
/// the weight of the heavy one makes them.
fn slabs(mass_kg: f64, (wide, aside): (f64, f64), friction: &str, step_s: f64) -> Simulation {
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

fn run(mass_kg: f64, place: (f64, f64), friction: &str) -> Outcome {
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
        speed = sideways(&simulation, &simulation.state().velocity).norm();
        fastest = fastest.max(speed);
    }
    simulation.sample().unwrap();
    let gone = (sideways(&simulation, &simulation.state().position) - began).norm() / 0.5;
    let says = verdict::label(&simulation, None).word == LabelWord::Accurate;
    let worst = simulation.invariants();
    println!("  {:.1e} {:.1e} {:.1e}", worst.squeezed_speed.value, worst.squeezed_place.value, worst.max_h);
    Outcome { speed: speed / fastest, gone, says }
}

#[test]
fn whatever_the_masses_a_slab_that_is_squeezed_out_is_not_called_accurate() {
    let (mut claimed_wrongly, mut too_modest, mut accurate, mut wrong) = (0, 0, 0, 0);
    for friction in ["", "friction: (friction_deg: 30)", "friction: (friction_deg: 1e-5)"] {
        for mass_ratio in [1.0, 10.0, 1e2, 1e3, 1e4, 1e6, 1e9] {
            for (wide, aside) in [(1.0, 0.0), (1.0, 1e-6), (1.0, 0.1), (0.6, 0.1), (1.4, 0.1)] {
                let Outcome { speed, gone, says } = run(1e5 / mass_ratio, (wide, aside), friction);
                println!(
                    "{friction} 1:{mass_ratio:e}, {wide} m wide, {aside} m aside: {speed:.1e}, {gone:.1e} of its height, \
                     accurate {says}"
                );
                let is_true = speed <= SPEED && gone <= PLACE;
                claimed_wrongly += u32::from(says && !is_true);
                too_modest += u32::from(!says && speed < 0.25 * SPEED && gone < 0.25 * PLACE);
                accurate += u32::from(says);
                wrong += u32::from(!is_true);
            }
        }
    }
    println!("{claimed_wrongly} {too_modest} {accurate} {wrong}");
}
