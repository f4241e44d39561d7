//! Runs against closed forms and against each other: one file per case.

mod accelerated_frame;
mod bar_under_traction;
mod bars_that_collide;
mod bedded_bar;
mod blast;
mod block_on_a_slope;
mod blocks_that_supports_let_turn;
mod body_kinds;
mod bolts;
mod bolts_in_stages;
mod bonded_bar;
mod bonded_bending;
mod bonded_plate;
mod bonded_rock;
mod bonds_at_rest;
mod bonds_beside_friction;
mod bouncing_block;
mod bound_of_contact;
mod brazilian_disc;
mod cantilever;
mod cavity;
mod clamped_key;
mod contact_damping;
mod contact_fields;
mod contact_patch;
mod conveyor;
mod cradle;
mod damping;
mod damping_at_edges;
mod damping_beyond_the_step;
mod dilation;
mod double_cantilever;
mod driven_blocks;
mod elastic_block_on_a_slope;
mod elastic_waves;
mod end_contact;
mod evidence;
mod extreme;
mod flat_impact;
mod free_field;
mod free_flight;
mod friction_at_edges;
mod friction_of_patches;
mod gained_in_rebounds;
mod glancing_collision;
mod ground_stress;
mod hertz;
mod joint_friction;
mod joint_laws;
mod jointed_column;
mod jointed_slope;
mod joints_in_stages;
mod kirsch;
mod large_strain;
mod leaning_column;
mod loads_over_time;
mod lumped_mass;
mod masonry_arch;
mod moved_base;
mod nothing_far_or_stale;
mod one_block_alone;
mod paper;
mod prescribed_motion;
mod quiet;
mod quiet_joints;
mod quiet_oblique;
mod random_impacts;
mod random_wedges;
mod release_of_initial_stress;
mod repeated_impacts;
mod restitution;
mod rockfall;
mod rocking_block;
mod rocking_threshold;
mod roof_wedge;
mod safety_as_drawn;
mod safety_factor;
mod safety_held;
mod settling;
mod settling_of_deforming_blocks;
mod shaken_base;
mod shaking;
mod sliding_in_space;
mod sliding_over_element_borders;
mod spring_creep;
mod springs_and_elimination;
mod stages;
mod step_control;
mod sticking_plate;
mod sudden_load;
mod tall_stack;
mod toppling_slope;
mod torsional_friction;
mod travel;
mod water;
mod wedge_statics;

use ndda::build;
use ndda_mesh::Vec3;
use ndda_solver::Simulation;

use evidence::Answer::AtMost;
use evidence::row;

/// The simulation of a scene text.
fn simulation(text: &str) -> Simulation {
    let loaded = ndda_io::read::load_text("case.ron", text, &[], None).unwrap_or_else(|e| panic!("{e}"));
    let folder = std::path::Path::new(".");
    let blocks = build::blocks(&loaded.scene, folder).unwrap_or_else(|faults| panic!("{faults:?}"));
    build::simulation(&loaded.scene, blocks, folder).unwrap_or_else(|faults| panic!("{faults:?}"))
}

/// A bar of 2 × 1 × 0.5 m on rollers at its lower faces, damped as the paper's integrator damps at ω Δt ≈ 1; `more`
/// goes into the block, `loads` into the scene.
fn bar(more: &str, supports: &str, loads: &str) -> Simulation {
    simulation(&format!(
        "(title: \"bar\", time: (step_s: 2e-4, end_s: 1, integrator: Newmark(alpha: 0.5, delta: 1)),
          materials: [(name: \"rock\", young_pa: {YOUNG_PA:e}, poisson: {POISSON}, density_kg_m3: 2500)],
          blocks: [(name: \"bar\", material: \"rock\", shape: Box(size_m: (2, 1, 0.5), cells: (4, 2, 1)), {more})],
          supports: [{supports}], {loads})"
    ))
}

const YOUNG_PA: f64 = 10e9;
const POISSON: f64 = 0.25;

/// The three lower faces of [`bar`] on rollers; `by` may request springs.
fn rollers(by: &str) -> String {
    ["(1, 0, 0)", "(0, 1, 0)", "(0, 0, 1)"]
        .map(|n| format!("(block: \"bar\", on: Plane(point_m: (0, 0, 0), normal: {n}), hold: Normal, {by}),"))
        .concat()
}

fn advance(simulation: &mut Simulation, steps: u64) {
    for _ in 0..steps {
        simulation.step().unwrap();
    }
}

fn settle(simulation: &mut Simulation) {
    advance(simulation, 2000);
}

/// Displacement of every node [m].
fn displacements(simulation: &Simulation) -> Vec<Vec3> {
    let rest = &simulation.blocks().rest_position;
    simulation.state().position.iter().zip(rest).map(|(x, rest)| x - rest).collect()
}

/// The row that every node is displaced by `strain` ∘ (its place) to within `tolerance` of the largest.
#[track_caller]
fn assert_uniform_strain(simulation: &Simulation, strain: Vec3, tolerance: f64) {
    let origin = simulation.blocks().origin_m;
    let largest = 2.0 * strain.amax();
    let moved = displacements(simulation);
    let off = moved
        .iter()
        .zip(&simulation.blocks().rest_position)
        .map(|(u, rest)| (u - strain.component_mul(&(rest + origin))).norm());
    let worst = off.fold(0.0, f64::max) / largest;
    row(
        "uniform stress",
        "largest error of displacements under a uniform strain, relative",
        worst,
        AtMost(tolerance),
    );
}
