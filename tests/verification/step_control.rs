//! Steps as short as they have to be: a discarded step leaves no trace.

use crate::evidence::Answer::AtMost;
use crate::evidence::{rounding, row};
use crate::simulation;

/// A block that falls 5 cm on a fixed slab and slides there; `time` says how steps are chosen.
fn falling(time: &str) -> ndda_solver::Simulation {
    simulation(&format!(
        "(title: \"falling\", time: (end_s: 1, {time}), gravity_m_s2: (3, 0, -9.3),
          materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.2, density_kg_m3: 2500)],
          blocks: [
            (name: \"slab\", material: \"rock\", shape: Box(size_m: (3, 3, 1), cells: (3, 3, 1)), body: Fixed),
            (name: \"cube\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2)), at_m: (0.9, 1.1, 1.05)),
          ],
          contact: Potential(penalty_pa: 1e9, friction: (friction_deg: 20, shear_penalty_pa_m: 1e9)))"
    ))
}

#[test]
fn a_fall_is_done_in_long_steps_and_the_impact_in_short_ones() {
    let mut simulation = falling("step_s: 4e-3, step: Auto()");
    simulation.sample().unwrap();
    let (mut in_the_air, mut largest_h) = (0, 0.0f64);
    for step in 0..125 {
        let report = simulation.step().unwrap();
        largest_h = largest_h.max(report.h);
        if step < 20 {
            in_the_air = simulation.state().control.halvings;
        }
        assert_eq!(simulation.state().step, step + 1);
        assert_eq!(simulation.time_s(), (step + 1) as f64 * 4e-3);
    }
    simulation.sample().unwrap();
    let worst = simulation.invariants();
    assert_eq!(in_the_air, 0);
    assert!(worst.control.rejected > 0 && worst.control.most_halvings >= 4, "{worst:?}");
    row("steps", "largest h of a fall and its impact, steps by themselves", largest_h, AtMost(1.0));
    // Steps are divided so that energy is kept: half of the 2 % of the label. Explicit contact alone could gain h²/2, far more at h up to 1.
    row("steps", "energy gained by it", worst.energy_gain, AtMost(1e-2));
    // Rounding of 125 steps of as many parts as the shortest has.
    let parts = rounding(125 << worst.control.most_halvings);
    row("steps", "momentum lost by it", worst.linear_momentum, AtMost(parts));
}

#[test]
fn a_step_that_is_taken_back_leaves_nothing_behind() {
    let mut auto = falling("step_s: 4e-3, step: Auto(energy: 1e9)");
    // Up to the first step that is discarded, and that step as it was done in the end.
    let rejected = |s: &ndda_solver::Simulation| s.invariants().control.rejected;
    while rejected(&auto) == 0 {
        auto.step().unwrap();
    }
    let parts = 1 << auto.state().control.halvings;
    let mut again = falling(&format!("step_s: {}", 4e-3 / f64::from(parts)));
    // A run of whole steps in the air, and one of steps as short as those parts, have the same bits.
    let steps = auto.state().step - 1;
    let mut whole = falling("step_s: 4e-3");
    for _ in 0..steps {
        whole.step().unwrap();
    }
    let mut snapshot = whole.snapshot();
    snapshot.state.step = steps * u64::from(parts as u32);
    again.restore(snapshot).unwrap();
    for _ in 0..parts {
        again.step().unwrap();
    }
    assert_eq!(again.state().position, auto.state().position);
    assert_eq!(again.state().velocity, auto.state().velocity);
    assert_eq!(again.state().contact, auto.state().contact);
}

#[test]
fn a_run_that_goes_on_from_a_snapshot_divides_its_steps_as_it_would_have() {
    let mut whole = falling("step_s: 4e-3, step: Auto()");
    for _ in 0..60 {
        whole.step().unwrap();
    }
    let snapshot = whole.snapshot();
    let mut resumed = falling("step_s: 4e-3, step: Auto()");
    resumed.restore(snapshot).unwrap();
    for _ in 0..30 {
        whole.step().unwrap();
        resumed.step().unwrap();
    }
    assert_eq!(whole.state(), resumed.state());
}

#[test]
fn a_run_for_which_no_step_is_short_enough_stops_and_says_so() {
    let mut simulation = falling("step_s: 4e-3, step: Auto(most_halvings: 2)");
    let stopped = (0..125).find_map(|_| simulation.step().err()).expect("it stops");
    assert!(stopped.to_string().contains("even for steps of 1e-3 s"), "{stopped}");
}
