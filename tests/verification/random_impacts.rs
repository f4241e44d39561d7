//! Friction on velocities in random impacts of all kinds of body, at the step that `ndda check` advises and at a sixteenth of it.
//!
//! `NDDA_CASES=170 cargo test --test verification random_impacts -- --nocapture` prints the table of docs/theory/contact.md.

use std::path::Path;

use ndda::Model;
use ndda::forecast::step;
use ndda_contact::testing::Random;
use ndda_mesh::{BlockId, Vec3};
use ndda_solver::Simulation;

use crate::evidence::Answer::AtMost;
use crate::evidence::row;

const KINDS: [&str; 3] = ["Rigid", "Affine", "Elastic"];
/// Steps after the blocks meet at the latest.
const STEPS: f64 = 150.0;
/// (ω Δt)²/24 of the midpoint rule, rounded down: the advised step has half of the largest h, 1, and h², a bound Σ|k|/m with as much beside the diagonal as on it,
/// is twice (ω Δt)² or more. 0.5/24 are the 2 % of docs/theory/contact.md.
const MIDPOINT: f64 = 0.02;

/// Result of an impact: work of friction, all energy at the start [J], and the velocity of the mass centre of the box that flies [m/s].
struct Outcome {
    friction_j: f64,
    energy_j: f64,
    velocity: Vec3,
}

/// A turned box that flies at a fixed floor, or at another box that floats.
fn scene(random: &mut Random, kind: &str) -> (String, f64, f64) {
    let mut between = |low: f64, high: f64| low + (high - low) * random.unit();
    let size: [f64; 3] = std::array::from_fn(|_| between(0.4, 1.2));
    let axis: [f64; 3] = std::array::from_fn(|_| between(-1.0, 1.0));
    let (angle_deg, friction_deg) = (between(0.0, 90.0), between(5.0, 50.0));
    let (down, along, across) = (between(1.0, 8.0), between(-6.0, 6.0), between(-2.0, 2.0));
    let spin: [f64; 3] = std::array::from_fn(|_| between(-3.0, 3.0));
    let penalty_pa = 10f64.powf(between(9.0, 10.3));
    let cells = [1, 2][usize::from(between(0.0, 1.0) > 0.5)];
    let target = KINDS[(3.0 * between(0.0, 1.0)) as usize];
    let floats = between(0.0, 1.0) > 0.5;
    let floor = if floats {
        format!(
            "(name: \"floor\", material: \"rock\", body: {target}, shape: Box(size_m: (2.4, 2.4, 0.8), cells: (3, 3, 1)), at_m: (-1.2, -1.2, -0.8))"
        )
    } else {
        "(name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (10, 10, 1), cells: (5, 5, 1)), at_m: (-5, -5, -1))".into()
    };
    // Above the floor by its largest radius: it falls on it wherever it is turned.
    let half = 0.5 * Vec3::from(size);
    let height = half.norm() + 0.01;
    let time_s = height / down;
    // Turned about its corner, its centre is put where it passes the middle of the floor as it lands.
    let (axis_of_turn, angle) = (Vec3::from(axis).normalize(), angle_deg.to_radians());
    let centre = half * angle.cos()
        + axis_of_turn.cross(&half) * angle.sin()
        + axis_of_turn * axis_of_turn.dot(&half) * (1.0 - angle.cos());
    let flight_s = (height - 0.8 * half.norm()) / down;
    let at = Vec3::new(-along * flight_s, -across * flight_s, height) - centre;
    let text = format!(
        "(title: \"impact\", time: (step_s: 1e-4, end_s: 1),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
          blocks: [{floor},
            (name: \"box\", material: \"rock\", body: {kind}, shape: Box(size_m: ({}, {}, {}), cells: ({cells}, {cells}, {cells})),
             turns: [(axis: ({}, {}, {}), angle_deg: {angle_deg})], at_m: ({}, {}, {}),
             velocity_m_s: ({along}, {across}, -{down}), spin_rad_s: ({}, {}, {})),
          ],
          contact: Potential(penalty_pa: {penalty_pa:e}, potential: Smooth(), friction: (friction_deg: {friction_deg})))",
        size[0], size[1], size[2], axis[0], axis[1], axis[2], at.x, at.y, at.z, spin[0], spin[1], spin[2],
    );
    (text, time_s, Vec3::new(along, across, down).norm())
}

fn begun(text: &str, step_s: f64) -> (Model, Option<f64>) {
    let change = format!("time.step_s={step_s:e}");
    let loaded = ndda_io::read::load_text("impact.ron", text, &[change], None).unwrap();
    let mut ready = Model::new(loaded, Path::new(".")).unwrap_or_else(|e| panic!("{}", e.render(false)));
    let advice = step::advise(&ready.loaded.scene, &mut ready.simulation);
    (ready, advice.map(|advice| advice.step_s))
}

fn run(text: &str, step_s: f64, steps: u64) -> Outcome {
    let mut simulation: Simulation = begun(text, step_s).0.simulation;
    let energy_j = simulation.sample().unwrap().kinetic_j;
    for _ in 0..steps {
        simulation.step().unwrap();
    }
    let sample = simulation.sample().unwrap();
    let operator = &simulation.shape(BlockId(1)).operator;
    let nodes = simulation.blocks().nodes_of(BlockId(1));
    let velocity = operator.momentum(&simulation.state().velocity[nodes]) / operator.mass_kg;
    Outcome { friction_j: sample.friction_work_j, energy_j, velocity }
}

/// Errors of friction's work over it, or over a hundredth of all energy, and of the velocity over the largest speed.
fn errors(seed: u64, kind: &str) -> [f64; 2] {
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    for _ in 0..5 {
        random.unit();
    }
    let (text, time_s, speed_m_s) = scene(&mut random, kind);
    let step_s = begun(&text, 1e-4).1.expect("there is contact").min(time_s / 20.0);
    let steps = (time_s / step_s + STEPS).ceil() as u64;
    let (coarse, fine) = (run(&text, step_s, steps), run(&text, step_s / 16.0, 16 * steps));
    assert!(fine.friction_j < 0.0, "{kind} {seed}: the blocks do not meet");
    let work = (coarse.friction_j - fine.friction_j).abs() / fine.friction_j.abs().max(0.01 * fine.energy_j);
    [work, (coarse.velocity - fine.velocity).norm() / speed_m_s]
}

#[test]
fn friction_in_random_impacts_hardly_depends_on_the_step_whatever_body_it_is() {
    let cases: u64 = std::env::var("NDDA_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(12);
    for kind in KINDS {
        let mut works = Vec::new();
        let mut speeds = Vec::new();
        for seed in 0..cases {
            let [work, speed] = errors(seed, kind);
            if work > MIDPOINT {
                println!("{kind} {seed}: work {work:.3}, velocity {speed:.3}");
            }
            works.push(work);
            speeds.push(speed);
        }
        works.sort_by(f64::total_cmp);
        speeds.sort_by(f64::total_cmp);
        let at = |all: &[f64], part: f64| all[((all.len() - 1) as f64 * part) as usize];
        let beyond = works.iter().filter(|w| **w > MIDPOINT).count();
        println!(
            "{kind}: work median {:.1e}, 95 % {:.1e}, largest {:.1e}, {beyond} of {cases} beyond 2 %; velocity 95 % {:.1e}, largest {:.1e}",
            at(&works, 0.5),
            at(&works, 0.95),
            at(&works, 1.0),
            at(&speeds, 0.95),
            at(&speeds, 1.0)
        );
        row(
            "friction in impacts",
            &format!(
                "random impacts of {kind} blocks: error of friction's work at the advised step, 90th of 100"
            ),
            at(&works, 0.9),
            AtMost(MIDPOINT),
        );
    }
}
