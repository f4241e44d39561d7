//! Checks of coefficients of restitution.

use super::Check;
use crate::scene::{Contact, ContactAt, Friction, Integrator};

/// Least restitution that `GeneralizedAlpha` resolves: it answers to an impact with a part of the acceleration of the step before.
const LEAST_WITH_MEMORY: f64 = 0.3;

impl Check<'_> {
    /// Coefficients of all contacts, of pairs of materials and of joints, and whether the integrator can do with them.
    pub(super) fn restitution(&mut self, contact: &Contact) {
        let Contact::Potential {
            restitution, shear_restitution, friction, material_pairs, rock_joints, ..
        } = contact
        else {
            return;
        };
        let mut places = vec![("contact".to_string(), (Some(*restitution), *shear_restitution), friction)];
        places.extend(material_pairs.iter().enumerate().map(|(i, pair)| {
            (
                format!("contact.material_pairs[{i}]"),
                (pair.restitution, pair.shear_restitution),
                &pair.friction,
            )
        }));
        places.extend(rock_joints.iter().enumerate().map(|(i, joint)| {
            (
                format!("contact.rock_joints[{i}]"),
                (joint.restitution, joint.shear_restitution),
                &joint.friction,
            )
        }));
        // Laws of pairs and joints have springs that the coefficient of all contacts damps.
        let has_springs = |friction: &Option<Friction>| {
            friction.as_ref().is_some_and(|law| law.shear_penalty_pa_m.is_some())
        };
        let any = places.iter().any(|place| has_springs(place.2));
        for (path, (normal, shear), friction) in places {
            for (key, coefficient) in [("restitution", normal), ("shear_restitution", shear)] {
                if let Some(coefficient) = coefficient {
                    self.part_given_back(format!("{path}.{key}"), coefficient);
                }
            }
            let Some(_) = shear else { continue };
            let path = format!("{path}.shear_restitution");
            if normal.is_none() && path.starts_with("contact.rock_joints") {
                self.misfit(
                    path,
                    "a joint has no restitution along its faces alone",
                    "give `restitution` beside it",
                );
            } else if !(has_springs(friction) || (any && path == "contact.shear_restitution")) {
                let help = "give this friction `shear_penalty_pa_m`, or leave out shear_restitution: friction on velocities has no rebound";
                self.misfit(path, "there are no shear springs that could rebound", help);
            }
        }
    }

    fn part_given_back(&mut self, path: String, restitution: f64) {
        if !(0.0..=1.0).contains(&restitution) {
            let message = format!("{restitution}: must be from 0 to 1");
            self.error(path, message, "1 for contacts that give back all energy, 0.3 for rock on rock");
        } else if restitution < 1.0 {
            self.damped(path, restitution);
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
