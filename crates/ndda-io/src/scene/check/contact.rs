//! Checks of contact and friction.

use super::{CELLS, Check};
use crate::scene::code::Code;
use crate::scene::{Contact, Friction, JointLaw, MaterialPair, Potential, Residual, matches};

impl Check<'_> {
    pub(super) fn contact(&mut self) {
        let several = self.scene.blocks.len() > 1 || !self.scene.rock.is_empty();
        match &self.scene.contact {
            None if several => {
                let help = "write `contact: Potential(penalty_pa: …)` or `contact: Off`";
                self.misfit("contact", "more than one block, and no word on contact", help);
            }
            Some(Contact::Potential {
                penalty_pa, potential, friction, material_pairs, rock_joints, ..
            }) => {
                self.positive("contact.penalty_pa".into(), *penalty_pa, "Pa");
                self.potential(potential);
                if let Some(friction) = friction {
                    self.friction("contact.friction", friction);
                }
                self.material_pairs(material_pairs);
                self.rock_joints(rock_joints);
                if !several && !self.scene.blocks.is_empty() {
                    self.warn(
                        Code::NoEffect,
                        "contact",
                        "one block has nothing to touch",
                        "contact is left out of this run",
                    );
                }
            }
            _ => {}
        }
    }

    fn potential(&mut self, potential: &Potential) {
        match *potential {
            Potential::Element => {}
            Potential::Smooth { reference_m } => {
                self.positive("contact.potential.reference_m".into(), reference_m, "m")
            }
            Potential::Volume { exponent, reference_m3 } => {
                self.positive("contact.potential.reference_m3".into(), reference_m3, "m³");
                if !(exponent > 1.0 && exponent.is_finite()) {
                    let message = format!("{exponent}: must be above 1");
                    self.error(
                        "contact.potential.exponent",
                        message,
                        "W ∝ V^m; m = 2 makes pressure grow with V",
                    );
                }
            }
        }
    }

    fn friction(&mut self, path: &str, friction: &Friction) {
        let field = |name: &str| format!("{path}.{name}");
        let angle = friction.friction_deg;
        if !(0.0..90.0).contains(&angle) {
            let message = format!("{angle}°: must be from 0 to below 90");
            self.error(field("friction_deg"), message, "μ = tan φ");
        }
        if let Some(penalty) = friction.shear_penalty_pa_m {
            self.positive(field("shear_penalty_pa_m"), penalty, "Pa/m");
        }
        for (name, strength) in [("cohesion_pa", friction.cohesion_pa), ("tension_pa", friction.tension_pa)] {
            if !(strength >= 0.0 && strength.is_finite()) {
                let message = format!("{strength} Pa: must be zero or positive");
                self.error(field(name), message, "0 for a joint that does not hold together");
            } else if strength > 0.0 && friction.shear_penalty_pa_m.is_none() {
                let help = "give shear_penalty_pa_m, the stiffness of the joint until it breaks";
                self.misfit(field(name), "a joint that holds together needs a spring to hold with", help);
            }
        }
        if let Some(residual) = &friction.residual {
            self.residual(&field("residual"), friction, residual);
        }
    }

    fn residual(&mut self, path: &str, peak: &Friction, residual: &Residual) {
        let field = |name: &str| format!("{path}.{name}");
        let Residual { friction_deg, cohesion_pa, over_m } = *residual;
        if !(0.0..=peak.friction_deg).contains(&friction_deg) {
            let message = format!("{friction_deg}°: must be from 0 to the peak, {}°", peak.friction_deg);
            self.error(field("friction_deg"), message, "joints weaken when they slip");
        }
        if !(0.0..=peak.cohesion_pa).contains(&cohesion_pa) {
            let message = format!("{cohesion_pa} Pa: must be from 0 to the peak, {} Pa", peak.cohesion_pa);
            self.error(field("cohesion_pa"), message, "joints weaken when they slip");
        }
        if !(over_m >= 0.0 && over_m.is_finite()) {
            self.error(
                field("over_m"),
                format!("{over_m} m: must be zero or positive"),
                "0 for a strength that falls at once",
            );
        }
        if peak.shear_penalty_pa_m.is_none() {
            let help = "give shear_penalty_pa_m, the stiffness of the joint before it slips";
            self.misfit(path.to_string(), "a joint that softens needs a spring that measures its slip", help);
        }
        if peak.tension_pa > 0.0 {
            let help = "leave out tension_pa, or residual";
            self.misfit(path.to_string(), "a joint that softens has no tensile strength", help);
        }
    }

    fn material_pairs(&mut self, pairs: &[MaterialPair]) {
        let scene = self.scene;
        let materials: Vec<&str> = scene.materials.iter().map(|m| m.name.as_str()).collect();
        for (i, pair) in pairs.iter().enumerate() {
            self.known(
                format!("contact.material_pairs[{i}].between[0]"),
                "material",
                &pair.between.0,
                &materials,
            );
            self.known(
                format!("contact.material_pairs[{i}].between[1]"),
                "material",
                &pair.between.1,
                &materials,
            );
            if let Some(friction) = &pair.friction {
                self.friction(&format!("contact.material_pairs[{i}].friction"), friction);
            }
        }
    }

    fn rock_joints(&mut self, laws: &[JointLaw]) {
        let scene = self.scene;
        let mut names: Vec<&str> =
            scene.rock.iter().flat_map(|rock| &rock.joints).map(|j| j.name()).collect();
        names.extend(scene.rock.iter().filter(|rock| rock.voronoi.is_some()).map(|_| CELLS));
        for (i, law) in laws.iter().enumerate() {
            if !names.iter().any(|name| matches(&law.joint, name)) {
                self.known(format!("contact.rock_joints[{i}].joint"), "joint", &law.joint, &names);
            }
            if let Some(friction) = &law.friction {
                self.friction(&format!("contact.rock_joints[{i}].friction"), friction);
            }
        }
    }
}
