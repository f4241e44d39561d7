//! What reasons advise.

use crate::{Model, Run};

#[test]
fn momentum_that_a_scheme_books_at_one_instant_is_no_reason_for_a_report() {
    let text = "(title: \"rod\", time: (step_s: 2.5e-5, end_s: 5e-3, integrator: Newmark(alpha: 0.25, delta: 0.5)),
        materials: [(name: \"rock\", young_pa: 1e10, poisson: 0, density_kg_m3: 2500, damping: (stiffness_s: 1e-4))],
        blocks: [(name: \"a\", material: \"rock\", shape: Box(size_m: (5, 0.25, 0.25), cells: (20, 1, 1)))],
        supports: [(block: \"a\", on: Set(\"x_min\"), hold: Fixed)],
        tractions: [(block: \"a\", on: Set(\"x_max\"), traction_pa: (1e5, 0, 0))])";
    let label = Run::new(Model::from_text(text).unwrap()).finish(&mut []).unwrap().summary.label;
    let reason = label.reasons.join("; ");
    assert!(reason.contains("momentum is not conserved") && reason.contains("use Midpoint"), "{reason}");
    assert!(!reason.contains("report this scene"), "{reason}");
}
