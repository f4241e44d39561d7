//! Blocks that were cut from one another touch to rounding: what overlaps then is next to nothing, and must stay so.

use std::path::Path;

use ndda::Model;

#[test]
fn blocks_that_touch_to_rounding_neither_stop_a_run_nor_stiffen_it() {
    // At this penalty and step, integrals of rounding's own sign once put a centre of pressure far away: NaN after 18 steps.
    run_steps("pile_125", &["contact.penalty_pa=3e9", "time.step_s=2e-4"], 25);
    // And pressures whose squares underflow had no direction: NaN after 25 steps.
    run_steps("pile_1000", &[], 28);
}

#[test]
fn faces_that_meet_exactly_are_not_taken_for_a_block_inside_another() {
    // The step in which the faces coincide once stopped the run: slivers of the sides lay beyond a centroid.
    let newmark = "time.integrator=Newmark(alpha:0.5,delta:1.0)";
    run_steps("collision_equal_free", &["time.step_s=5e-4", newmark], 45);
}

fn run_steps(scene: &str, changes: &[&str], steps: usize) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{scene}.ron"));
    let changes: Vec<String> = changes.iter().map(|change| (*change).into()).collect();
    let mut simulation =
        Model::open(&path, &changes).unwrap_or_else(|errors| panic!("{}", errors.render(false))).simulation;
    for _ in 0..steps {
        let report = simulation.step().unwrap();
        assert!(report.h < 2.0, "{report:?}");
    }
}
