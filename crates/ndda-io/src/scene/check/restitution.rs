//! Checks of coefficients of restitution.

use super::Check;
use crate::scene::{ContactAt, Integrator, JointLaw, MaterialPair};

/// Least restitution that `GeneralizedAlpha` resolves: it answers to an impact with a part of the acceleration of the step before.
const LEAST_WITH_MEMORY: f64 = 0.3;

impl Check<'_> {
    /// Coefficients of all contacts, of pairs of materials and of joints, and whether the integrator can do with them.
    pub(super) fn restitution(&mut self, all: f64, pairs: &[MaterialPair], joints: &[JointLaw]) {
        let mut given = vec![("contact.restitution".to_string(), all)];
        let of_pairs = pairs.iter().map(|pair| pair.restitution).enumerate();
        let of_pairs = of_pairs.map(|(i, e)| (format!("contact.material_pairs[{i}].restitution"), e));
        let of_joints = joints.iter().map(|joint| joint.restitution).enumerate();
        let of_joints = of_joints.map(|(i, e)| (format!("contact.rock_joints[{i}].restitution"), e));
        given.extend(of_pairs.chain(of_joints).filter_map(|(path, e)| Some((path, e?))));
        for (path, restitution) in given {
            if !(0.0..=1.0).contains(&restitution) {
                let message = format!("{restitution}: must be from 0 to 1");
                self.error(path, message, "1 for contacts that give back all energy, 0.3 for rock on rock");
            } else if restitution < 1.0 {
                self.damped(path, restitution);
            }
        }
    }

    fn damped(&mut self, path: String, restitution: f64) {
        let time = &self.scene.time;
        if let ContactAt::End { .. } = time.contact_at {
            let help = "write `contact_at: Predicted`, or leave out restitution: contact at the end of the step damps by itself";
            self.misfit(path, "contact at the end of the step cannot be damped", help);
            return;
        }
        match time.integrator {
            Integrator::Midpoint { .. } => {}
            Integrator::Newmark { .. } => {
                let help = "write `integrator: Midpoint()`";
                self.misfit(
                    path,
                    "contact gains energy with `Newmark`, so that there is no restitution",
                    help,
                );
            }
            Integrator::GeneralizedAlpha { .. } if restitution < LEAST_WITH_MEMORY => {
                let help = "write `integrator: Midpoint()`, or a restitution of 0.3 or more";
                let message = format!("{restitution}: `GeneralizedAlpha` does not resolve less than 0.3");
                self.misfit(path, message, help);
            }
            Integrator::GeneralizedAlpha { .. } => {}
        }
    }
}
