//! Checks of bolts.

use super::Check;
use crate::scene::{Bolt, BoltPlace};

/// More bolts in rows than this are a slip of the keyboard.
const MOST_BOLTS: f64 = 1e4;

impl Check<'_> {
    pub(super) fn bolts(&mut self) {
        let scene = self.scene;
        for (i, bolt) in scene.bolts.iter().enumerate() {
            let path = format!("bolts[{i}]");
            if let Some(first) = scene.bolts[..i].iter().position(|other| other.name == bolt.name) {
                let message = format!("`{}` is the name of bolts[{first}], too", bolt.name);
                self.misfit(format!("{path}.name"), message, "give each entry a name of its own");
            }
            self.bolt_place(&format!("{path}.at"), &bolt.at);
            self.bolt_parts(&path, bolt);
        }
    }

    fn bolt_place(&mut self, path: &str, place: &BoltPlace) {
        match place {
            BoltPlace::Line { from_m, to_m } => {
                self.numbers(&format!("{path}.from_m"), from_m);
                self.numbers(&format!("{path}.to_m"), to_m);
                if from_m == to_m {
                    self.error(
                        format!("{path}.to_m"),
                        "is the head: the bolt has no length",
                        "move one of them",
                    );
                }
            }
            BoltPlace::Rows { corner_m, along_m, up_m, spacing_m, direction, length_m, .. } => {
                self.numbers(&format!("{path}.corner_m"), corner_m);
                self.numbers(&format!("{path}.along_m"), along_m);
                self.numbers(&format!("{path}.up_m"), up_m);
                self.positive(format!("{path}.spacing_m"), spacing_m.0.min(spacing_m.1), "m");
                self.direction(format!("{path}.direction"), direction);
                self.positive(format!("{path}.length_m"), *length_m, "m");
                let length = |side: &[f64; 3]| side.iter().map(|v| v * v).sum::<f64>().sqrt();
                let count = (length(along_m) / spacing_m.0 + 1.0) * (length(up_m) / spacing_m.1 + 1.0);
                if count > MOST_BOLTS {
                    let message = format!("{count:.0} bolts are more than {MOST_BOLTS:.0}");
                    self.error(format!("{path}.spacing_m"), message, "widen the spacing");
                }
            }
        }
    }

    fn bolt_parts(&mut self, path: &str, bolt: &Bolt) {
        let Bolt { steel, grout, dowel, plate, .. } = bolt;
        self.positive(format!("{path}.steel.young_pa"), steel.young_pa, "Pa");
        self.positive(format!("{path}.steel.area_m2"), steel.area_m2, "m²");
        self.positive(format!("{path}.grout.stiffness_n_m2"), grout.stiffness_n_m2, "N/m²");
        self.positive(format!("{path}.grout.strength_n_m"), grout.strength_n_m, "N/m");
        let optional = [
            ("steel.yield_n", steel.yield_n, "N"),
            ("steel.break_strain", steel.break_strain, ""),
            ("dowel.stiffness_n_m", dowel.map(|dowel| dowel.stiffness_n_m), "N/m"),
            ("dowel.capacity_n", dowel.map(|dowel| dowel.capacity_n), "N"),
            ("plate.strength_n", plate.and_then(|plate| plate.strength_n), "N"),
            ("segment_m", bolt.segment_m, "m"),
        ];
        for (field, value, unit) in optional {
            if let Some(value) = value {
                self.positive(format!("{path}.{field}"), value, unit);
            }
        }
        if !(bolt.pretension_n >= 0.0 && bolt.pretension_n.is_finite()) {
            let message = format!("{} N: must not be negative", bolt.pretension_n);
            self.error(format!("{path}.pretension_n"), message, "tension is positive");
        }
        if bolt.pretension_n > 0.0 && plate.is_none() {
            let help = "add `plate: ()`, or leave pretension_n out";
            self.misfit(format!("{path}.pretension_n"), "there is no plate that it is jacked against", help);
        }
        let ends_m = grout.to_m.unwrap_or(f64::INFINITY);
        if !(grout.from_m >= 0.0 && grout.from_m.is_finite() && ends_m > grout.from_m) {
            let message =
                format!("the bonded length from {} to {ends_m} m is zero or negative", grout.from_m);
            self.error(
                format!("{path}.grout.from_m"),
                message,
                "both are measured from the head: 0 <= from_m < to_m",
            );
        }
        if let (Some(yield_n), Some(strain)) = (steel.yield_n, steel.break_strain)
            && strain * steel.young_pa * steel.area_m2 < yield_n
        {
            let help = format!("give more than {:e}", yield_n / (steel.young_pa * steel.area_m2));
            let message = format!("it breaks at a strain of {strain} before it yields at {yield_n} N");
            self.misfit(format!("{path}.steel.break_strain"), message, help);
        }
    }
}
