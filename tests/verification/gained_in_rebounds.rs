//! Blocks under sudden gravity that slide too fast on soft contact, and by how much the program says so: against the speed on rigid contact, in closed form.

use ndda::Model;
use ndda_mesh::Vec3;
use ndda_solver::Simulation;

use crate::contact_damping::velocity;
use crate::evidence::Answer::{AtLeast, AtMost, Within};
use crate::evidence::row;
use crate::simulation;

const GRAVITY_M_S2: f64 = 9.8;
const SECTION: &str = "sliding and friction";

/// Speed at the end along a vector, over that on rigid contact [m/s], and what the program says of it.
fn gained(
    mut simulation: Simulation,
    monitored: &str,
    (along, acceleration_m_s2): (Vec3, f64),
    steps: u64,
) -> (f64, f64) {
    let blocks = simulation.blocks();
    let block =
        blocks.ids().find(|&block| blocks.names[block.index()] == monitored).expect("a block that slides");
    for _ in 0..steps {
        simulation.step().unwrap();
    }
    simulation.sample().unwrap();
    let velocity = velocity(&simulation, block.0);
    (
        velocity.dot(&along) - acceleration_m_s2 * simulation.time_s(),
        simulation.invariants().rebound_speed.value * velocity.norm(),
    )
}

#[test]
fn a_wedge_on_two_planes_gains_what_the_program_says() {
    let scene = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/wedge_two_planes.ron");
    // Plunge of the line of both planes, and the sine of half the angle between them.
    let (plunge, half_angle_sine) =
        (42.394086044865_f64.to_radians(), 20f64.to_radians().tan() / 22.693719299736_f64.to_radians().tan());
    let line = Vec3::new(plunge.cos(), 0.0, -plunge.sin());
    let friction_deg = 38f64;
    let friction = friction_deg.to_radians().tan() / half_angle_sine;
    let acceleration_m_s2 = GRAVITY_M_S2 * (plunge.sin() - friction * plunge.cos());
    for (body, penalty_pa) in [("Rigid", 2e7), ("Rigid", 2e8), ("Elastic", 2e7)] {
        let settings = [
            format!("contact.friction.friction_deg={friction_deg}"),
            format!("contact.penalty_pa={penalty_pa:e}"),
            format!("rock.slope.body={body}"),
            "contact.restitution=0.3".into(),
        ];
        let model = Model::open(&scene, &settings).unwrap();
        let (gained_m_s, said_m_s) = gained(model.simulation, "slope_0004", (line, acceleration_m_s2), 10000);
        let of = format!("{body}, k_n = {penalty_pa:e} Pa");
        row(
            SECTION,
            &format!("wedge, sudden gravity, {of}: faster than on rigid contact [m/s]"),
            gained_m_s,
            AtLeast(0.005),
        );
        row(
            SECTION,
            &format!("wedge, sudden gravity, {of}: speed that the program says it gained [m/s]"),
            said_m_s,
            Within(gained_m_s, 0.05),
        );
    }
}

/// What a block on a plane of 30° gains under sudden gravity, and what the program says of it.
fn gained_on_a_plane(friction_deg: f64, restitution: f64) -> (f64, f64) {
    let [across, along] =
        [30f64.to_radians().cos(), 30f64.to_radians().sin()].map(|part| GRAVITY_M_S2 * part);
    let block = simulation(&format!(
        "(title: \"t\", time: (step_s: 1e-4, end_s: 1), gravity_m_s2: ({along}, 0, -{across}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
          blocks: [
            (name: \"base\", material: \"rock\", shape: Box(size_m: (6, 2, 0.5), cells: (2, 1, 1)), body: Fixed),
            (name: \"top\", material: \"rock\", shape: Box(size_m: (1, 1, 0.5), cells: (1, 1, 1)), at_m: (0.5, 0.5, 0.5), body: Rigid)],
          contact: Potential(penalty_pa: 2e7, potential: Smooth(reference_m: 1), friction: (friction_deg: {friction_deg}), restitution: {restitution}))"
    ));
    let friction = friction_deg.to_radians().tan();
    // While it slips, v + μ w grows as on rigid contact, w being the speed at which contact lifts it.
    let slides = Vec3::new(1.0, 0.0, friction);
    gained(block, "top", (slides, along - friction * across), 12000)
}

#[test]
fn a_block_on_one_plane_gains_what_the_program_says_and_nothing_where_it_never_sticks() {
    let what = |friction_deg: f64, restitution: f64| {
        format!(
            "block on a plane, sudden gravity, φ = {friction_deg}°, e = {restitution}: speed that the program says it gained"
        )
    };
    let (gained_m_s, said_m_s) = gained_on_a_plane(28.0, 0.9);
    let over = format!("{}, over what it is faster", what(28.0, 0.9));
    row(SECTION, &over, said_m_s / gained_m_s, Within(1.0, 0.25));
    let (_, said_m_s) = gained_on_a_plane(20.0, 0.3);
    row(SECTION, &format!("{} [m/s]", what(20.0, 0.3)), said_m_s, AtMost(1e-3));
}

/// An elastic cube under sudden gravity, damped in proportion to mass until it rests.
#[test]
fn a_cube_that_damping_brings_to_rest_has_gained_nothing() {
    for friction in ["", ", friction: (friction_deg: 30)"] {
        let mut cube = simulation(&format!(
            "(title: \"t\", time: (step_s: 1e-4, end_s: 1), gravity_m_s2: (0, 0, -9.8),
              materials: [(name: \"rock\", young_pa: 20e9, poisson: 0, density_kg_m3: 2500, damping: (mass_per_s: 200))],
              blocks: [
                (name: \"base\", material: \"rock\", shape: Box(size_m: (3, 3, 1), cells: (3, 3, 1)), at_m: (-1, -1, -1), body: Fixed),
                (name: \"cube\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2)))],
              contact: Potential(penalty_pa: 1e7{friction}))"
        ));
        for _ in 0..2000 {
            cube.step().unwrap();
        }
        cube.sample().unwrap();
        let worst = cube.invariants();
        let said = worst.rebound_speed.value.max(worst.rebound_speed_on_a_plane.value);
        let of = if friction.is_empty() { "no friction" } else { "φ = 30°" };
        row(
            SECTION,
            &format!("cube at rest, {of}: speed that the program says it gained, over the largest speed"),
            said,
            AtMost(0.01),
        );
    }
}
