//! Blocks on a base that is shaken move relative to it as they do on a base at rest whose blocks feel −m a (d'Alembert): the prescribed motion of
//! the base on one side, loads over time on the other.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;

use ndda_mesh::{BlockId, Vec3};
use ndda_solver::Simulation;

use crate::evidence::Answer::AtMost;
use crate::evidence::row;

const CASE: &str = "accelerated frame";
/// Of rigid slabs, (ω Δt)² of the fastest sine; of others, whose faces vibrate, the promise for closed forms.
const RIGID: f64 = 2e-5;
const DEFORMING: f64 = 5e-3;
/// How long it shakes [s], and the spacing of its record [s].
const END_S: f64 = 0.5;
const SPACING_S: f64 = 1e-3;
/// Mass of a slab [kg].
const SLAB_KG: f64 = 0.5 * 0.5 * 0.1 * 2650.0;

fn acceleration_m_s2(t: f64) -> Vec3 {
    9.81 * Vec3::new(0.45 * (TAU * 4.0 * t).sin(), 0.35 * (TAU * 7.0 * t).sin(), 0.2 * (TAU * 3.0 * t).sin())
}

/// Two slabs on a base, under gravity that is not upright. The base is shaken, or else the slabs feel what that does.
fn slabs(folder: &Path, (body, law): (&str, &str), step_s: f64, is_shaken: bool) -> Simulation {
    let mut records = ["time_s,acceleration_m_s2\n"; 3].map(String::from);
    let mut rows = [""; 3].map(String::from);
    for i in 0..=(END_S / SPACING_S).round() as u32 {
        let t = SPACING_S * f64::from(i);
        let a = acceleration_m_s2(t);
        for axis in 0..3 {
            writeln!(records[axis], "{t:e},{:e}", a[axis]).unwrap();
            write!(rows[axis], "(time_s: {t:e}, factor: {:e}),", -SLAB_KG * a[axis]).unwrap();
        }
    }
    let axes = ["(1, 0, 0)", "(0, 1, 0)", "(0, 0, 1)"];
    let (mut shaking, mut forces) = (String::new(), String::new());
    for (axis, direction) in axes.iter().enumerate() {
        std::fs::write(folder.join(format!("{axis}.csv")), &records[axis]).unwrap();
        write!(shaking, "(direction: {direction}, record: (file: \"{axis}.csv\")),").unwrap();
        for slab in ["lower", "upper"] {
            write!(forces, "(block: \"{slab}\", force_n: {direction}, factor: [{}]),", rows[axis]).unwrap();
        }
    }
    let moved = if is_shaken {
        format!("supports: [(block: \"base\", on: All, hold: Shaking([{shaking}]))],")
    } else {
        format!("forces: [{forces}],")
    };
    let text = format!(
        "(title: \"slabs\", time: (step_s: {step_s:e}, end_s: {END_S}), gravity_m_s2: (2, 1, -9.6),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
          blocks: [
            (name: \"base\", material: \"rock\", body: Fixed, shape: Box(size_m: (3, 3, 0.5), cells: (3, 3, 1)), at_m: (-1.5, -1.5, -0.5)),
            (name: \"lower\", material: \"rock\", body: {body}, shape: Box(size_m: (0.5, 0.5, 0.1), cells: (2, 2, 1)), at_m: (-0.25, -0.25, 0)),
            (name: \"upper\", material: \"rock\", body: {body}, shape: Box(size_m: (0.5, 0.5, 0.1), cells: (2, 2, 1)), at_m: (-0.25, -0.25, 0.1)),
          ],
          {moved}
          contact: Potential(penalty_pa: 5e8, potential: Smooth(), restitution: 0.3, friction: (friction_deg: 25{law})))"
    );
    let loaded = ndda_io::read::load_text("case.ron", &text, &[], None).unwrap_or_else(|e| panic!("{e}"));
    let blocks = ndda::build::blocks(&loaded.scene, folder).unwrap_or_else(|f| panic!("{f:?}"));
    ndda::build::simulation(&loaded.scene, blocks, folder).unwrap_or_else(|faults| panic!("{faults:?}"))
}

/// Slips of both slabs against the base after each step [m].
fn slips(mut simulation: Simulation, steps: usize) -> Vec<[Vec3; 2]> {
    let start = simulation.start_position().to_vec();
    let moved = |simulation: &Simulation, block: u32| {
        let nodes = simulation.blocks().nodes_of(BlockId(block));
        let sum: Vec3 = nodes.clone().map(|n| simulation.state().position[n] - start[n]).sum();
        sum / nodes.len() as f64
    };
    let mut slips = Vec::new();
    for _ in 0..steps {
        simulation.step().unwrap();
        slips.push([1, 2].map(|block| moved(&simulation, block) - moved(&simulation, 0)));
    }
    slips
}

#[test]
fn slabs_on_a_shaken_base_slip_as_under_the_forces_of_its_frame() {
    let folder = tempfile::tempdir().unwrap();
    for body in ["Rigid", "Affine", "Elastic"] {
        for (law, words) in [("", "friction on velocities"), (", shear_penalty_pa_m: 1e9", "shear springs")] {
            let step_s = 1e-4;
            let steps = (END_S / step_s).round() as usize;
            let [shaken, pushed] = [true, false]
                .map(|is_shaken| slips(slabs(folder.path(), (body, law), step_s, is_shaken), steps));
            let largest_m = pushed.iter().flatten().map(|u| u.norm()).fold(0.0, f64::max);
            let pairs = shaken.iter().flatten().zip(pushed.iter().flatten());
            let apart_m = pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
            row(
                CASE,
                &format!("largest difference of slips over the largest slip, {body} slabs, {words}"),
                apart_m / largest_m,
                AtMost(if body == "Rigid" { RIGID } else { DEFORMING }),
            );
        }
    }
}
