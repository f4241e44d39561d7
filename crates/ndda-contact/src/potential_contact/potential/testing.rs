//! The contract suite of contact potentials.

use crate::PotentialContact;
use crate::potential::contact_potential::ContactPotential;
use crate::testing::check_model;

/// Panics unless `potential` keeps the contract of [`ContactPotential`] in the
/// default contact model.
pub fn check_potential<P: ContactPotential + Clone + 'static>(potential: &P) {
    check_model(&mut PotentialContact::new(1e9).with_potential(Box::new(potential.clone())));
}
