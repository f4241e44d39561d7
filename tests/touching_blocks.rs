//! Blocks that were cut from one another touch to rounding: what overlaps then is next to nothing, and must stay so.

use std::path::Path;

use ndda_cli::check;

#[test]
fn blocks_that_touch_to_rounding_neither_stop_a_run_nor_stiffen_it() {
    // At this penalty and step, integrals of rounding's own sign once put a centre of pressure far away: NaN after 18 steps.
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/pile_125.ron");
    let changes = ["contact.penalty_pa=3e9", "time.step_s=2e-4"].map(String::from);
    let mut simulation = check::prepare(&path, &changes)
        .unwrap_or_else(|errors| panic!("{}", errors.render(false)))
        .simulation;
    for _ in 0..25 {
        let report = simulation.step().unwrap();
        assert!(report.h < 2.0, "{report:?}");
    }
}
