//! A single block has nothing to touch: contact is left out, to the bit.

use crate::simulation;

fn spinning(contact: &str) -> ndda_solver::Simulation {
    simulation(&format!(
        "(title: \"alone\", time: (step_s: 1e-3, end_s: 1), gravity_m_s2: (0, 0, -9.8),
          materials: [(name: \"rock\", young_pa: 1e10, poisson: 0.25, density_kg_m3: 2500)],
          blocks: [(name: \"block\", material: \"rock\", shape: Box(size_m: (1, 0.7, 0.4), cells: (2, 2, 1)),
                    spin_rad_s: (1, 2, 3))],
          {contact})"
    ))
}

#[test]
fn one_block_gives_the_same_bits_with_and_without_contact_and_counts_no_pairs() {
    let mut with = spinning(
        "contact: Potential(penalty_pa: 1e7, friction: (friction_deg: 30, shear_penalty_pa_m: 1e9))",
    );
    let mut without = spinning("contact: Off");
    for _ in 0..500 {
        with.step().unwrap();
        without.step().unwrap();
    }
    assert_eq!(with.state().position, without.state().position);
    assert_eq!(with.state().velocity, without.state().velocity);
    assert!(!with.has_contact());
    assert_eq!((with.invariants().candidate_pairs_max, with.invariants().contact_pairs_max), (0, 0));
}
