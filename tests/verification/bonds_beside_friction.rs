//! Blocks that bonds pull while friction holds them: a patch that sticks does not creep, and bonds and friction together never give energy.

use ndda::Model;
use ndda::run::Run;
use ndda_mesh::BlockId;
use ndda_solver::Simulation;

use crate::evidence::Answer::AtMost;
use crate::evidence::row;
use crate::{advance, displacements, simulation};

const STEP_S: f64 = 5e-4;
const RAMP_S: f64 = 0.2;
/// Gravity along the floor and across it [m/s²]: a slope of 15°.
const ALONG_M_S2: f64 = 2.539;
const ACROSS_M_S2: f64 = 9.476;

/// Two cubes of a metre on a floor, bonded to each other. Friction holds the upper one, and nothing but the bond the lower one.
fn pair(body: &str) -> Simulation {
    let cube = |name: &str, material: &str, x: f64| {
        format!(
            "(name: \"{name}\", material: \"{material}\", body: {body}, shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2)), at_m: ({x}, 0, 0)),"
        )
    };
    let material = |name: &str| {
        format!(
            "(name: \"{name}\", young_pa: 10e9, poisson: 0.25, density_kg_m3: 2600, damping: (mass_per_s: 20)),"
        )
    };
    simulation(&format!(
        "(title: \"pair\", time: (step_s: {STEP_S:e}, end_s: 2), gravity_m_s2: ({ALONG_M_S2}, 0, -{ACROSS_M_S2}), gravity_ramp_s: {RAMP_S},
          materials: [{}{}{}],
          blocks: [
              (name: \"floor\", material: \"floor\", body: Fixed, shape: Box(size_m: (10, 10, 1), cells: (1, 1, 1)), at_m: (-4, -4, -1)),
              {}{}
          ],
          contact: Potential(penalty_pa: 1e8, potential: Smooth(reference_m: 1), material_pairs: [
              (between: (\"floor\", \"rough\"), friction: (friction_deg: 45)),
              (between: (\"rough\", \"smooth\"), friction: (friction_deg: 45, shear_penalty_pa_m: 2e8, cohesion_pa: 1e8, tension_pa: 1e8)),
          ]))",
        material("floor"),
        material("rough"),
        material("smooth"),
        cube("upper", "rough", 0.0),
        cube("lower", "smooth", 1.0),
    ))
}

/// Mean displacement along the floor of the lowest nodes of the upper cube [m].
fn slip_m(pair: &Simulation) -> f64 {
    let moved = displacements(pair);
    let blocks = pair.blocks();
    let low = |n: &usize| (blocks.rest_position[*n].z + blocks.origin_m.z).abs() < 1e-9;
    let base: Vec<usize> = blocks.nodes_of(BlockId(1)).filter(low).collect();
    base.iter().map(|&n| moved[n].x).sum::<f64>() / base.len() as f64
}

#[test]
fn a_block_that_friction_holds_does_not_creep_under_the_pull_of_a_bond() {
    for body in ["Rigid", "Affine", "Elastic"] {
        let mut pair = pair(body);
        advance(&mut pair, (1.0 / STEP_S) as u64);
        let early_m = slip_m(&pair);
        advance(&mut pair, (1.0 / STEP_S) as u64);
        let creep_m_s = slip_m(&pair) - early_m;
        // Slip velocity where the search for friction leaves out the force of the bond: Δt g sin α.
        let overlooked_m_s = STEP_S * ALONG_M_S2;
        let what = format!("{body}: creep of the cube that sticks, over Δt g sin α");
        row("bonds beside friction", &what, creep_m_s.abs() / overlooked_m_s, AtMost(1e-4));
    }
}

/// A cut through affine rock on a floor with friction, whose benches are not dug yet: their borders are glued.
const CUT: &str = "(title: \"cut\", time: (end_s: 0.5), gravity_m_s2: (0, 0, -9.81), gravity_ramp_s: 0.05,
    materials: [(name: \"rock\", young_pa: 10e9, poisson: 0.25, density_kg_m3: 2600)],
    rock: [(name: \"rock\", material: \"rock\", body: Affine, domain: Box(min_m: (-8, 0, -4), max_m: (26, 4, 12)),
        joints: [Plane(name: \"floor\", dip_deg: 0, dip_direction_deg: 0, point_m: (0, 0, 0))],
        fixed: [Beyond(point_m: (0, 0, 0), normal: (0, 0, -1))],
        excavations: [
            (name: \"bench_1\", axis: Y, outline_m: [(-8, 6), (2.798, 6), (5.596, 12), (-8, 12)], start_m: 0, end_m: 4),
            (name: \"bench_2\", axis: Y, outline_m: [(-8, 0), (0, 0), (2.798, 6), (-8, 6)], start_m: 0, end_m: 4),
        ])],
    supports: [(block: \"bench_*\", on: Set(\"x_min\"), hold: Direction((1, 0, 0)))],
    contact: Potential(potential: Smooth(), friction: (friction_deg: 30)), output: (frames: 0))";

#[test]
fn glue_and_friction_together_never_give_energy() {
    let model = Model::from_text(CUT).unwrap_or_else(|errors| panic!("{}", errors.render(false)));
    let history = Run::new(model).finish(&mut []).unwrap().history.unwrap();
    let column = |name: &str| &history.columns[history.names.iter().position(|known| known == name).unwrap()];
    let most_j = |name: &str| column(name).iter().copied().fold(0.0, f64::max);
    // Energy stored in bonds is booked as negative work of friction, so that the sum never exceeds zero.
    let given = most_j("friction_work_j") / most_j("strain_j");
    row(
        "bonds beside friction",
        "largest work of glue and friction over the strain energy",
        given,
        AtMost(1e-9),
    );
}
