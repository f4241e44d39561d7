//! Two arms that are bonded along a part of their length and pulled apart at their ends (double cantilever beam), with contact at the end of long steps.

use ndda_mesh::{BlockId, Vec3};
use ndda_solver::Simulation;

use crate::evidence::Answer::Within;
use crate::evidence::row;
use crate::simulation;

const YOUNG_PA: f64 = 30e9;
const ENERGY_J_M2: f64 = 100.0;
/// Height of an arm, and width of both.
const SIDE_M: f64 = 0.01;
const CRACK_M: f64 = 0.1;
/// Bonded length.
const BONDED_M: f64 = 0.03;
/// Strength of the joint, so high that bonds break within some millimetres, and stiffness of the joint until then.
const TENSION_PA: f64 = 50e6;
const JOINT_PA_M: f64 = 1e14;
/// Loads over that of slender arms: the first is reached in a few periods of the arms, the other so slowly that they hardly swing.
const LOADS: [f64; 2] = [0.8, 1.1];
const TIMES_S: [f64; 2] = [0.02, 0.08];
const STEP_S: f64 = 1e-3;

/// √(G b E I) = P a of slender arms [N m].
fn moment() -> f64 {
    let inertia_m4 = SIDE_M.powi(4) / 12.0;
    (ENERGY_J_M2 * SIDE_M * YOUNG_PA * inertia_m4).sqrt()
}

/// The arms with this many cells over their height. Nothing pulls in the first step, in which bonds form.
fn scene(cells: u32) -> String {
    let size_m = SIDE_M / f64::from(cells);
    let along = |length_m: f64| (length_m / size_m).round();
    let length_m = CRACK_M + BONDED_M;
    let arm = |name: &str, z: f64| {
        format!(
            "(name: \"{name}\", material: \"rock\", shape: Box(size_m: ({length_m}, {SIDE_M}, {SIDE_M}), cells: ({}, 1, {cells}), pattern: TwentyFour), at_m: (0, 0, {z})),",
            along(length_m)
        )
    };
    let held = |name: &str| {
        format!(
            "(block: \"{name}\", on: Plane(point_m: ({length_m}, 0, 0), normal: (1, 0, 0)), hold: Fixed),"
        )
    };
    let pull = |name: &str, z: f64, sign: f64| {
        let one = |y: f64| {
            format!(
                "(block: \"{name}\", at_m: (0, {y}, {z}), force_n: (0, 0, {}), factor: [(time_s: {STEP_S:e}, factor: 0), (time_s: {}, factor: {}), (time_s: {}, factor: {})]),",
                sign * 0.5 * moment() / CRACK_M,
                TIMES_S[0],
                LOADS[0],
                TIMES_S[1],
                LOADS[1],
            )
        };
        one(0.0) + &one(SIDE_M)
    };
    // Pressed as stiff as pulled.
    format!(
        "(title: \"double cantilever\", time: (step_s: {STEP_S:e}, end_s: {}, integrator: Newmark(alpha: 0.5, delta: 1), contact_at: End()),
          materials: [(name: \"rock\", young_pa: {YOUNG_PA:e}, poisson: 0, density_kg_m3: 2500, damping: (mass_per_s: 300))],
          blocks: [{}{}],
          supports: [{}{}],
          forces: [{}{}],
          contact: Potential(penalty_pa: {:e}, potential: Smooth(reference_m: 1), friction: (friction_deg: 30, shear_penalty_pa_m: {JOINT_PA_M:e},
              cohesion_pa: 100e6, tension_pa: {TENSION_PA:e}, fracture: (tension_j_m2: {ENERGY_J_M2}, shear_j_m2: 400))))",
        TIMES_S[1],
        arm("lower", 0.0),
        arm("upper", SIDE_M),
        held("lower"),
        held("upper"),
        pull("lower", 0.5 * SIDE_M, -1.0),
        pull("upper", 1.5 * SIDE_M, 1.0),
        0.5 * JOINT_PA_M,
    )
}

/// Takes out the bonds along the crack.
fn crack(arms: &mut Simulation) {
    arms.step().unwrap();
    let mut snapshot = arms.snapshot();
    let blocks = arms.blocks();
    let start = |bond: &ndda_contact::Bond| {
        let corners = blocks.triangle_corners(bond.facet, &blocks.rest_position);
        corners.iter().map(|x| x.x).fold(f64::INFINITY, f64::min) + blocks.origin_m.x
    };
    snapshot.state.contact.bonds.retain(|bond| start(bond) > CRACK_M - 1e-6);
    arms.restore(snapshot).unwrap();
}

/// Slope of the end of the upper arm, by its nodes.
fn slope(arms: &Simulation) -> f64 {
    let blocks = arms.blocks();
    let nodes = blocks.nodes_of(BlockId(1));
    let ends: Vec<(Vec3, Vec3)> = nodes
        .map(|n| (blocks.rest_position[n], arms.state().position[n]))
        .filter(|(rest, _)| (rest + blocks.origin_m).x < 1e-9)
        .collect();
    let mean = |of: &dyn Fn(&(Vec3, Vec3)) -> f64| ends.iter().map(of).sum::<f64>() / ends.len() as f64;
    let (z, u) = (mean(&|(rest, _)| rest.z), mean(&|(rest, now)| now.x - rest.x));
    let above = |(rest, now): &(Vec3, Vec3)| (rest.z - z) * (now.x - rest.x - u);
    mean(&above) / mean(&|(rest, _)| (rest.z - z).powi(2))
}

/// Load at which the first bonds have broken [N], and the slope of the arms there.
fn breaks(cells: u32) -> [f64; 2] {
    let mut arms = simulation(&scene(cells));
    crack(&mut arms);
    let bonds = arms.state().contact.bonds.len();
    while arms.time_s() < TIMES_S[1] {
        arms.step().unwrap();
        if arms.state().contact.bonds.len() < bonds {
            let part = (arms.time_s() - TIMES_S[0]) / (TIMES_S[1] - TIMES_S[0]);
            let load = LOADS[0] + (LOADS[1] - LOADS[0]) * part;
            return [load * moment() / CRACK_M, slope(&arms)];
        }
    }
    panic!("the arms hold {} times the load of slender ones", LOADS[1]);
}

#[test]
fn bonded_arms_part_at_the_load_of_their_fracture_energy() {
    assert!((moment() / CRACK_M - 50.0).abs() < 1e-9);
    let is_large = std::env::var_os("NDDA_LARGE").is_some();
    for cells in [4, 6].into_iter().filter(|_| is_large) {
        let [load_n, slope] = breaks(cells);
        println!(
            "{cells} cells over the height of an arm: {load_n} N, {} J/m²",
            2.0 * load_n * slope / SIDE_M
        );
    }
    let [load_n, slope] = breaks(if is_large { 8 } else { 6 });
    // A crack that is longer by 0.64 of an arm's height stands for the rotation of its root (Kanninen, International Journal of Fracture 9, 1973).
    let exact_n = moment() / (CRACK_M + 0.64 * SIDE_M);
    row("double cantilever", "load at which the crack begins to run [N]", load_n, Within(exact_n, 0.03));
    // J = 2 P θ/b, whatever the bonds and the mesh (Paris and Paris, Engineering Fracture Mechanics 31, 1988).
    let released_j_m2 = 2.0 * load_n * slope / SIDE_M;
    let what = "energy release rate 2 P θ/b there [J/m²]";
    row("double cantilever", what, released_j_m2, Within(ENERGY_J_M2, 0.03));
}
