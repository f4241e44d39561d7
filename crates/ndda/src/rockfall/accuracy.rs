//! How accurate a fall is, by what its windows have found.

use ndda_solver::{Sample, Simulation};
use serde::{Deserialize, Serialize};

/// Energy that may come from nowhere or vanish, over the largest kinetic energy: speeds are as its root, and may be off by 1 %.
const MOST_ENERGY: f64 = 0.02;
/// Depth of a contact over the width of the boulder: it leaves the boulder up to π d/2 from where it should be, which is less than ground is known to.
const MOST_DEPTH: f64 = 0.1;
/// Factor on the `impact_m_s` that is recommended, since depth follows its law only roughly.
const MARGIN: f64 = 1.2;
/// Energy by which friction may be off Coulomb's law, over the largest kinetic energy.
const MOST_FRICTION: f64 = 0.01;

/// Errors of a fall, and their limits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Accuracy {
    /// Energy that had come from nowhere or vanished since the release, at worst, over the largest kinetic energy.
    pub energy: f64,
    /// Energy by which friction was off Coulomb's law, over the same.
    pub friction: f64,
    /// Largest depth of a contact over the width of the boulder.
    pub depth: f64,
    /// Balance of energy since the release, and energy stored in contact now [J].
    #[serde(skip)]
    balance_j: f64,
    #[serde(skip)]
    stored_j: f64,
}

impl Accuracy {
    /// Adds the errors of a window [J], which is over. Within a contact the balance is off by what comes back when it ends, a part of the energy that the
    /// contact stores, so that it counts only where the boulder does not touch the ground, and at the end.
    pub(super) fn add(&mut self, simulation: &Simulation, sample: &Sample, touches: bool) {
        let worst = simulation.invariants();
        let mass_kg = simulation.shape(super::contact::BOULDER).operator.mass_kg;
        let scale_j = 0.5 * mass_kg * simulation.speed_scale_m_s().powi(2);
        self.balance_j += sample.balance_j;
        self.stored_j = if touches { sample.contact_j } else { 0.0 };
        if !touches {
            self.energy = self.energy.max(self.balance_j.abs());
        }
        self.friction += worst.unresolved_friction.value * scale_j;
        self.depth = self.depth.max(worst.max_penetration_ratio);
    }

    /// Turns energies into parts of the largest kinetic energy.
    pub(super) fn close(&mut self, largest_j: f64) {
        self.energy = self.energy.max(self.balance_j.abs() - self.stored_j);
        if largest_j > 0.0 {
            self.energy /= largest_j;
            self.friction /= largest_j;
        }
        (self.balance_j, self.stored_j) = (0.0, 0.0);
    }

    /// Whether all errors are within their limits.
    pub fn is_accurate(&self) -> bool {
        self.energy <= MOST_ENERGY && self.friction <= MOST_FRICTION && self.depth <= MOST_DEPTH
    }

    /// What is beyond its limit, and what to change.
    pub fn reasons(&self, step_s: f64, impact_m_s: f64) -> Vec<String> {
        let percent = |part: f64| 100.0 * part;
        let mut reasons = Vec::new();
        for (what, value, limit) in [
            ("energy error of the computation", self.energy, MOST_ENERGY),
            ("deviation of friction from Coulomb's law", self.friction, MOST_FRICTION),
        ] {
            if value > limit {
                let shorter = step_s * (limit / value).sqrt();
                reasons.push(format!(
                    "{what}: {:.1} % of the largest kinetic energy, limit {:.0} %: take time.step_s: {shorter:.1e}",
                    percent(value),
                    percent(limit)
                ));
            }
        }
        if self.depth > MOST_DEPTH {
            // The depth of a corner goes about with the root of the speed that stiffness is chosen for.
            let needed = (MARGIN * impact_m_s * (self.depth / MOST_DEPTH).powi(2)).ceil();
            reasons.push(format!(
                "depth of contact: {:.1} % of the boulder's width, limit {:.0} %: take rockfall.detail.impact_m_s: {needed:.0}",
                percent(self.depth),
                percent(MOST_DEPTH)
            ));
        }
        reasons
    }

    /// The larger of each error of two falls.
    pub fn worst(self, other: Self) -> Self {
        Self {
            energy: self.energy.max(other.energy),
            friction: self.friction.max(other.friction),
            depth: self.depth.max(other.depth),
            ..Self::default()
        }
    }
}
