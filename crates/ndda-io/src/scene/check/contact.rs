//! Checks of contact.

use super::Check;
use crate::scene::code::Code;
use crate::scene::is_unset;
use crate::scene::{Contact, JointLaw, MaterialPair, Potential};

impl Check<'_> {
    pub(super) fn contact(&mut self) {
        let several = self.scene.blocks.len() > 1 || !self.scene.rock.is_empty();
        match &self.scene.contact {
            None if several => {
                let help = "write `contact: Potential(penalty_pa: …)` or `contact: Off`";
                self.misfit(
                    "contact",
                    "the scene has several blocks and does not say whether they touch",
                    help,
                );
            }
            Some(
                contact @ Contact::Potential {
                    penalty_pa,
                    depth_ratio,
                    potential,
                    friction,
                    material_pairs,
                    rock_joints,
                    friction_tolerance,
                    ..
                },
            ) => {
                self.restitution(contact);
                self.penalty(*penalty_pa, *depth_ratio, potential);
                self.potential(potential);
                if let Some(friction) = friction {
                    self.friction("contact.friction", friction);
                }
                if let Some(tolerance) = friction_tolerance {
                    self.friction_tolerance(*tolerance);
                }
                self.material_pairs(material_pairs);
                self.rock_joints(rock_joints);
                if !several && !self.scene.blocks.is_empty() {
                    self.warn(
                        Code::NoEffect,
                        "contact",
                        "the scene has one block, so that contact has no effect",
                        "leave out `contact`, or add blocks",
                    );
                }
            }
            _ => {}
        }
    }

    fn friction_tolerance(&mut self, tolerance: f64) {
        if !(1e-10..=1e-2).contains(&tolerance) {
            let message = format!("{tolerance}: must be from 1e-10 to 1e-2");
            self.error(
                "contact.friction_tolerance",
                message,
                "it is a part of the largest friction; 1e-4 is quick",
            );
        }
    }

    fn potential(&mut self, potential: &Potential) {
        match *potential {
            Potential::Element => {}
            Potential::Smooth { reference_m } => {
                self.positive("contact.potential.reference_m".into(), reference_m, "m")
            }
            Potential::Closure { reference_m, max_closure_m } => {
                self.positive("contact.potential.reference_m".into(), reference_m, "m");
                self.positive("contact.potential.max_closure_m".into(), max_closure_m, "m");
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

    fn penalty(&mut self, penalty_pa: f64, depth_ratio: f64, potential: &Potential) {
        if !is_unset(&penalty_pa) {
            self.positive("contact.penalty_pa".into(), penalty_pa, "Pa");
        } else if let Potential::Volume { .. } = potential {
            let help = "write penalty_pa: with this potential pressure depends on the volume of overlap, which is not known before the run";
            self.report(
                Code::MissingField,
                "contact",
                "the penalty of the potential `Volume` is not chosen",
                help,
            );
        }
        if !(1e-9..=0.1).contains(&depth_ratio) {
            let message = format!("{depth_ratio:e}: must be from 1e-9 to 0.1");
            self.error("contact.depth_ratio", message, "1e-4 is a tenth of a millimetre for blocks of 1 m");
        }
    }

    fn rock_joints(&mut self, laws: &[JointLaw]) {
        for (i, law) in laws.iter().enumerate() {
            self.known_joint(format!("contact.rock_joints[{i}].joint"), &law.joint);
            if let Some(friction) = &law.friction {
                self.friction(&format!("contact.rock_joints[{i}].friction"), friction);
            }
        }
    }
}
