//! Friction by the name of the joint: blocks slide and stick by the law of the joint that made their faces.

use ndda::Model;
use ndda::build;
use ndda_mesh::Vec3;
use ndda_solver::Simulation;

use crate::evidence::Answer::{Near, Within};
use crate::evidence::row;
use crate::{displacements, simulation};

const STEP_S: f64 = 1e-4;
const END_S: f64 = 0.25;
const SLOPE_DEG: f64 = 30.0;
const GRAVITY_M_S2: f64 = 9.8;

/// Rock that dips 30° to the east, with the laws of its joints; all else has no friction.
fn dipping(rock: &str, laws: &str) -> Simulation {
    simulation(&format!(
        "(title: \"t\", time: (step_s: {STEP_S:e}, end_s: {END_S}), gravity_m_s2: (0, 0, -{GRAVITY_M_S2}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)], rock: [{rock}],
          contact: Potential(penalty_pa: 2e9, potential: Smooth(), rock_joints: [{laws}]))"
    ))
}

/// A box cut by planes that dip to the east through heights of its axis.
fn cut_box(name: &str, planes: &[(&str, f64)], more: &str) -> String {
    let plane = |(name, height): &(&str, f64)| {
        format!(
            "Plane(name: \"{name}\", dip_deg: {SLOPE_DEG}, dip_direction_deg: 90, point_m: (2, 1, {height})),"
        )
    };
    let planes: String = planes.iter().map(plane).collect();
    format!(
        "(name: \"{name}\", material: \"rock\", domain: Box(min_m: (0, 0, 0), max_m: (4, 2, 5)), joints: [{planes}],
          fill: Centre, {more}),"
    )
}

/// Side of the plane through a height of the axis that is above it.
fn above(height: f64) -> String {
    format!("Beyond(point_m: (2, 1, {height}), normal: (1, 0, 1.7320508))")
}

fn below(height: f64) -> String {
    format!("Beyond(point_m: (2, 1, {height}), normal: (-1, 0, -1.7320508))")
}

fn friction(joint: &str, friction_deg: f64) -> String {
    format!("(joint: \"{joint}\", friction: (friction_deg: {friction_deg})),")
}

/// How far each block has slid down the slope at the end [m].
fn slides_m(simulation: &mut Simulation) -> Vec<f64> {
    for _ in 0..(END_S / STEP_S).round() as u32 {
        simulation.step().unwrap();
    }
    let slope = SLOPE_DEG.to_radians();
    let downhill = Vec3::new(slope.cos(), 0.0, -slope.sin());
    let moved = displacements(simulation);
    let blocks = simulation.blocks();
    let mean = |nodes: &[Vec3]| nodes.iter().sum::<Vec3>().dot(&downhill) / nodes.len() as f64;
    blocks.ids().map(|block| mean(&moved[blocks.nodes_of(block)])).collect()
}

/// S = ½ g (sin α − μ cos α) t².
fn closed_form_m(friction: f64) -> f64 {
    let slope = SLOPE_DEG.to_radians();
    0.5 * GRAVITY_M_S2 * (slope.sin() - friction * slope.cos()) * END_S * END_S
}

fn tan(angle_deg: f64) -> f64 {
    angle_deg.to_radians().tan()
}

#[test]
fn a_slab_slides_on_one_joint_by_its_friction_and_sticks_on_the_other() {
    // Rigid, as the closed form: slabs that deform vibrate along the joints, too, for 0.1 ms is long for them.
    let fixed = format!("body: Rigid, fixed: [{}]", below(2.0));
    let rock = cut_box("slope", &[("lower", 2.0), ("upper", 3.0)], &fixed);
    let slide_m = closed_form_m(tan(20.0));
    // Gravity comes at once, so blocks bounce: what is to stick needs friction to spare.
    for (laws, exact) in [
        (friction("lower", 20.0) + &friction("upper", 80.0), [0.0, slide_m, slide_m]),
        (friction("lower", 80.0) + &friction("upper", 20.0), [0.0, 0.0, slide_m]),
        // The later entry counts more.
        (friction("*", 20.0) + &friction("lower", 80.0), [0.0, 0.0, slide_m]),
    ] {
        let slides = slides_m(&mut dipping(&rock, &laws));
        for (k, (slide, exact)) in slides.iter().zip(exact).enumerate() {
            // The lowest is fixed and does not move at all. Others bounce under sudden gravity: 2 %, as docs/verification/verification.md promises.
            let off = if k == 0 { 0.0 } else { 0.02 * slide_m };
            row("joints", &format!("slide of slab {k} of three, {laws} [m]"), *slide, Near(exact, off));
        }
    }
}

#[test]
fn where_faces_of_two_joints_meet_each_law_acts_on_half_of_the_pressure() {
    let rock = cut_box("bed", &[("rough", 2.0)], &format!("body: Fixed, removed: [{}]", above(2.0)))
        + &cut_box("slab", &[("smooth", 2.0)], &format!("removed: [{}]", below(2.0)));
    let both = friction("rough", 30.0) + &friction("smooth", 10.0);
    for (laws, mean) in [(both, 0.5 * (tan(30.0) + tan(10.0))), (friction("rough", 30.0), 0.5 * tan(30.0))] {
        let slide_m = slides_m(&mut dipping(&rock, &laws))[1];
        let exact = closed_form_m(mean);
        row("joints", &format!("slide on faces of two joints, {laws} [m]"), slide_m, Within(exact, 0.01));
    }
}

#[test]
fn a_wedge_on_two_joints_of_unlike_friction_slides_by_their_mean() {
    let scene = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/wedge_two_planes.ron");
    let (left, right) = (10.0, 25.0);
    let laws = format!("contact.rock_joints=[{}{}]", friction("left", left), friction("right", right));
    let mut ready = Model::open(&scene, &["contact.friction.friction_deg=0".into(), laws]).unwrap();
    let steps = build::steps(&ready.loaded.scene.time);
    for _ in 0..steps {
        ready.simulation.step().unwrap();
    }
    // Both planes carry the same; ξ is the angle of the wedge, i the plunge of its line (the scene says how).
    let (plunge, half_angle_sine) = (42.394086044865_f64.to_radians(), tan(20.0) / tan(22.693719299736));
    let line = Vec3::new(plunge.cos(), 0.0, -plunge.sin());
    let friction = 0.5 * (tan(left) + tan(right)) / half_angle_sine;
    let time_s = steps as f64 * ready.simulation.step_s();
    let exact = 0.5 * GRAVITY_M_S2 * (plunge.sin() - friction * plunge.cos()) * time_s * time_s;
    let slide_m = ready.monitors[0].displacement(&ready.simulation).dot(&line);
    row("joints", "slide of a wedge on joints of 10° and 25° [m]", slide_m, Within(exact, 0.02));
}
