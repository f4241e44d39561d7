//! A plate that sticks on a slope must not creep (φ = 35° on 30°, ten seconds).

use ndda::Model;
use ndda_mesh::Vec3;

use crate::evidence::Answer::{AtLeast, AtMost};
use crate::evidence::row;

/// How far the plate of a scene has moved from the second second to the tenth, both as means: a vibration is not creep.
/// Also how far it has moved from the start.
fn crept(scene: &str) -> (f64, f64) {
    let scene = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(scene);
    let mut ready = Model::open(&scene, &[]).unwrap();
    let steps = |time_s: f64| (time_s / ready.simulation.step_s()).round() as usize;
    let (second, between) = (steps(1.0), steps(7.0));
    let mut advance = |steps: usize| -> Vec3 {
        let mut sum = Vec3::zeros();
        for _ in 0..steps {
            ready.simulation.step().unwrap();
            sum += ready.monitors[0].displacement(&ready.simulation);
        }
        sum / steps as f64
    };
    advance(second);
    let early = advance(second);
    advance(between);
    let late = advance(second);
    ((late - early).norm(), early.norm())
}

#[test]
fn a_sticking_plate_moves_less_than_a_nanometre_in_eight_seconds_with_either_law() {
    for scene in ["sticking_30_phi35.ron", "sticking_30_phi35_spring.ron"] {
        let (crept_m, settled_m) = crept(scene);
        row("sticking", &format!("how far the plate of {scene} settles [m]"), settled_m, AtLeast(1e-8));
        row("sticking", &format!("creep of the plate of {scene} in 8 s [m]"), crept_m, AtMost(1e-9));
    }
}
