//! A pyramid in the roof of an excavation, held by the stress across its joints (Brady & Brown): the block below it is taken out, then it is made heavier.

use std::fmt::Write;

use ndda::summary::LabelWord;
use ndda::{Model, Run};
use ndda_mesh::Vec3;

use crate::evidence::Answer::{AtLeast, Within};
use crate::evidence::row;

/// Half of the angle at the top: faces that dip at 60°.
const ALPHA_DEG: f64 = 30.0;
const FRICTION_DEG: f64 = 40.0;
/// Normal and shear stiffness of the joints [Pa/m]; of `Smooth`, the first is twice the penalty over 1 m.
const STIFFNESS_PA_M: f64 = 4e8;
const STRESS_PA: f64 = 0.05e6;
const DENSITY: f64 = 2600.0;

/// Volume of the pyramid, 1 m high [m³], and area of a face [m²].
const VOLUME_M3: f64 = 0.577_350_269_189_625_8;
const FACE_M2: f64 = 1.154_700_538_379_251_5;

/// Stiffness of the three joints against a pull over the area of a face, for k_s/k_n of `shear`: k_s cos²α + k_n sin²α [Pa/m].
fn stiffness_pa_m(shear: f64) -> f64 {
    let alpha = ALPHA_DEG.to_radians();
    STIFFNESS_PA_M * (shear * alpha.cos().powi(2) + alpha.sin().powi(2))
}

/// Pull that the three joints bear, after what it relaxes their stress by:
/// Σ H (k_s cos²α + k_n sin²α) sin(φ − α) / (k_s cos α cos φ + k_n sin α sin φ), H = σ A cos α [N].
fn capacity_n(shear: f64) -> f64 {
    let (alpha, phi) = (ALPHA_DEG.to_radians(), FRICTION_DEG.to_radians());
    let horizontal_n = STRESS_PA * FACE_M2 * alpha.cos();
    let below = STIFFNESS_PA_M * (shear * alpha.cos() * phi.cos() + alpha.sin() * phi.sin());
    3.0 * horizontal_n * stiffness_pa_m(shear) * (phi - alpha).sin() / below
}

fn list(points: &[Vec3]) -> String {
    points.iter().map(|x| format!("({:.15}, {:.15}, {:.15}),", x.x, x.y, x.z)).collect()
}

/// The pyramid between three walls that move in by what gives the stress, above a plug; its weight is a part of the capacity, then another.
fn scene(shear: f64, parts: [f64; 2]) -> String {
    let corner = |i: u32| {
        let angle = (90.0 + 120.0 * f64::from(i)).to_radians();
        FACE_M2 * Vec3::new(angle.cos(), angle.sin(), 0.0)
    };
    let (base, apex) = ([corner(0), corner(1), corner(2)], Vec3::z());
    let prism = "faces: [[0, 2, 1], [3, 4, 5], [0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5]]))";
    let (mut blocks, mut supports) = (String::new(), String::new());
    let all = list(&[base[0], base[1], base[2], apex]);
    let _ = write!(
        blocks,
        "(name: \"wedge\", material: \"rock\", body: Rigid, shape: Polyhedron(corners_m: [{all}], faces: [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])),"
    );
    // Moved in, a wall presses each unit of its face by H cos α across it and H sin α along it, H = σ cos α: by nothing vertically.
    let alpha = ALPHA_DEG.to_radians();
    let pressed_m = STRESS_PA * alpha.cos() / STIFFNESS_PA_M;
    let (across_m, along_m) = (pressed_m * alpha.cos(), pressed_m * alpha.sin() / shear);
    for i in 0..3 {
        let face = [base[i], base[(i + 1) % 3], apex];
        let normal = (face[1] - face[0]).cross(&(face[2] - face[0])).normalize();
        let corners = list(&face) + &list(&face.map(|x| x + 0.6 * normal));
        let _ = write!(
            blocks,
            "(name: \"wall_{i}\", material: \"rock\", body: Fixed, shape: Polyhedron(corners_m: [{corners}], {prism},"
        );
        let inward = -Vec3::new(normal.x, normal.y, 0.0).normalize();
        let along = alpha.sin() * inward + alpha.cos() * Vec3::z();
        let way = along_m * along - across_m * normal;
        let _ = write!(
            supports,
            "(block: \"wall_{i}\", on: All, hold: Motion([(time_s: 0, displacement_m: (0, 0, 0)), (time_s: 0.1, displacement_m: ({}, {}, {}))])),",
            way.x, way.y, way.z
        );
    }
    let corners = list(&base.map(|x| x - 0.5 * Vec3::z())) + &list(&base);
    let _ = write!(
        blocks,
        "(name: \"plug\", material: \"rock\", body: Fixed, shape: Polyhedron(corners_m: [{corners}], {prism}"
    );
    let [light, heavy] = parts.map(|part| part * capacity_n(shear) / (DENSITY * VOLUME_M3));
    format!(
        "(title: \"roof wedge\", time: (step_s: 5e-5, end_s: 0.12),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: {DENSITY})],
          blocks: [{blocks}], supports: [{supports}],
          contact: Potential(penalty_pa: {:e}, potential: Smooth(reference_m: 1), restitution: 0.3,
                             friction: (friction_deg: {FRICTION_DEG}, shear_penalty_pa_m: {:e})),
          stages: [
              (name: \"weight\", gravity_m_s2: (0, 0, -{light}), over_s: 0.1, then: Settle()),
              (name: \"dig\", remove: [\"plug\"], over_s: 0.2, then: Run(0.2)),
              (name: \"heavier\", gravity_m_s2: (0, 0, -{heavy}), over_s: 0.2, then: Run(0.4)),
          ], output: (frames: 0))",
        0.5 * STIFFNESS_PA_M,
        shear * STIFFNESS_PA_M,
    )
}

#[test]
fn a_roof_wedge_falls_when_it_is_heavier_than_the_stress_across_its_joints_holds() {
    for (shear, printed_n) in [(1.0, 26_449.1), (0.1, 21_832.8)] {
        let capacity_n = capacity_n(shear);
        assert!((capacity_n / printed_n - 1.0f64).abs() < 1e-5, "{capacity_n}");
        let run = |parts| {
            Run::new(Model::from_text(&scene(shear, parts)).unwrap()).finish(&mut []).unwrap().summary
        };
        let [stands, falls] = [run([0.9, 0.99]), run([0.99, 1.01])];
        assert_eq!(stands.stages.len(), 3, "{:?}", stands.label.reasons);
        let moved_m = |k: usize| stands.stages[k].motion.farthest_m;
        // Pulled by P it gives way by P over the stiffness of its joints.
        let gives_m = |part: f64| part * capacity_n / (3.0 * FACE_M2 * stiffness_pa_m(shear));
        let name = |what: &str| format!("{what}, k_s/k_n = {shear} [m]");
        let sinks = |part: f64| name(&format!("sinking under {part} of the pull that its joints bear"));
        row("roof wedge", &sinks(0.9), moved_m(1), Within(gives_m(0.9), 1e-2));
        row("roof wedge", &sinks(0.99), moved_m(2), Within(gives_m(0.99), 1e-2));
        let fallen_m = falls.stages[2].motion.farthest_m;
        row("roof wedge", &name("fall under 1.01 of it, in 0.4 s"), fallen_m, AtLeast(0.05));
        for summary in [stands, falls] {
            assert_eq!(summary.label.word, LabelWord::Accurate, "{:?}", summary.label.reasons);
        }
    }
}
