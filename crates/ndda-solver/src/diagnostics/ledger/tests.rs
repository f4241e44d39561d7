use super::*;
use crate::integrators::midpoint::Midpoint;
use crate::integrators::time_integrator::TimeIntegrator;

#[test]
fn energy_that_friction_took_is_not_a_loss() {
    let mut ledger = Ledger::new(Default::default(), BlockDiagnostics::default(), 0.0);
    ledger.balance(Sample { kinetic_j: 10.0, ..Sample::default() }, true);
    ledger.add_work(-4.0, 0.0, 0.0, 0.0);
    let sample = ledger.balance(Sample { kinetic_j: 5.0, ..Sample::default() }, true);
    assert_eq!(sample.balance_j, -1.0);
    assert_eq!(ledger.invariants().energy_loss, 0.1);
    assert_eq!(ledger.invariants().energy_gain, 0.0);
}

#[test]
fn friction_that_gives_energy_is_said_unless_its_springs_were_stretched_before() {
    let mut ledger = Ledger::new(Default::default(), BlockDiagnostics::default(), 0.0);
    ledger.balance(Sample { kinetic_j: 10.0, ..Sample::default() }, true);
    ledger.add_work(-2.0, 0.0, 0.0, 0.0);
    // Springs may give back the energy that they took.
    ledger.add_work(1.5, 0.0, 0.0, 0.0);
    assert_eq!(ledger.invariants().friction_gain, 0.0);
    ledger.add_work(1.5, 0.0, 0.0, 0.0);
    assert_eq!(ledger.invariants().friction_gain, 0.1);
    ledger.springs_are_stretched();
    ledger.add_work(3.0, 0.0, 0.0, 0.0);
    assert_eq!(ledger.invariants().friction_gain, 0.0);
}

#[test]
fn what_explicit_contact_holds_back_is_not_lost_but_what_is_gone_after_it_is() {
    let mut ledger = Ledger::new(Default::default(), BlockDiagnostics::default(), 0.0);
    ledger.balance(Sample { kinetic_j: 10.0, ..Sample::default() }, true);
    ledger.watch(&StepReport { h: 1.0, ..StepReport::default() });
    ledger.balance(Sample { contact_j: 8.0, ..Sample::default() }, true);
    assert_eq!((ledger.invariants().energy_loss, ledger.invariants().lasting_loss), (0.2, 0.0));
    ledger.balance(Sample { kinetic_j: 9.0, ..Sample::default() }, true);
    assert_eq!((ledger.invariants().lasting_loss, ledger.invariants().lasting_gain), (0.1, 0.0));
    ledger.balance(Sample { contact_j: 8.0, ..Sample::default() }, false);
    assert_eq!(ledger.invariants().lasting_loss, 0.2);
}

#[test]
fn an_impulse_from_outside_explains_momentum() {
    let mut ledger = Ledger::new(Default::default(), BlockDiagnostics::default(), 0.0);
    ledger.balance(Sample::default(), true);
    let weights = Midpoint { theta: 0.5 }.weights(0.5);
    ledger.add_impulse(0.5, &weights, Vec3::x(), Vec3::zeros());
    let momentum = Vec3::new(0.5, 0.0, 0.1);
    ledger.balance(Sample { momentum, momentum_scale: 0.5, ..Sample::default() }, true);
    assert!((ledger.invariants().linear_momentum - 0.2).abs() < 1e-15);
}
