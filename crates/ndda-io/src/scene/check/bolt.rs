//! Checks of bolts.

use super::Check;
use crate::scene::code::Code;
use crate::scene::{Bolt, BoltPlace, BoltSteel};

/// More bolts in rows than this are a slip of the keyboard.
const MOST_BOLTS: f64 = 1e4;
/// Young's modulus below that of any metal or glass fibre [Pa].
const SOFTEST_PA: f64 = 1e9;
/// Section above that of any bolt or anchor [m²].
const THICKEST_M2: f64 = 0.1;
/// Stresses at which steel may yield [Pa].
const STRENGTHS_PA: std::ops::RangeInclusive<f64> = 1e7..=1e10;

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
        let of_grout = [
            (
                "stiffness_n_m2",
                grout.stiffness_n_m2,
                "N/m²",
                1e5,
                "grouted bolts have about 1 to 10 GN/m²: 2 GN/m² is 2e9",
            ),
            (
                "strength_n_m",
                grout.strength_n_m,
                "N/m",
                1e3,
                "grouted bolts have about 50 to 1000 kN/m: 400 kN/m is 400e3",
            ),
        ];
        for (field, value, unit, least, help) in of_grout {
            self.small(format!("{path}.grout.{field}"), (value, unit), least, help);
        }
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
        let has_slip = self.steel(&format!("{path}.steel"), steel);
        if let (Some(yield_n), Some(strain)) = (steel.yield_n, steel.break_strain)
            && !has_slip
            && strain * steel.young_pa * steel.area_m2 < yield_n
        {
            let help = format!("give more than {:e}", yield_n / (steel.young_pa * steel.area_m2));
            let message = format!("it breaks at a strain of {strain} before it yields at {yield_n} N");
            self.misfit(format!("{path}.steel.break_strain"), message, help);
        }
    }

    /// Warns of steel in another unit than that of the field; whether it is.
    fn steel(&mut self, path: &str, steel: &BoltSteel) -> bool {
        let (young_pa, area_m2) = (steel.young_pa, steel.area_m2);
        let is_soft = young_pa > 0.0 && young_pa < SOFTEST_PA;
        if is_soft {
            let message = format!("{young_pa} Pa is softer than any metal");
            self.warn(
                Code::UnitSlip,
                format!("{path}.young_pa"),
                message,
                "steel has 200 GPa, which is 200e9",
            );
        }
        let is_thick = area_m2 > THICKEST_M2;
        if is_thick {
            let message = format!("{area_m2} m² is more than any bolt has");
            self.warn(
                Code::UnitSlip,
                format!("{path}.area_m2"),
                message,
                "a bar of 25 mm has 491 mm², which is 491e-6",
            );
        }
        let strength_pa =
            steel.yield_n.filter(|_| area_m2 > 0.0 && !is_thick).map(|yield_n| yield_n / area_m2);
        let is_odd =
            strength_pa.filter(|strength_pa| *strength_pa > 0.0 && !STRENGTHS_PA.contains(strength_pa));
        if let Some(strength_pa) = is_odd {
            let decimals = if strength_pa < 1e7 { 3 } else { 0 };
            let message = format!("over area_m2, it yields at {:.decimals$} MPa", 1e-6 * strength_pa);
            let help = "steel yields at 200 to 2000 MPa; the unit is newton: 250 kN is 250e3";
            self.warn(Code::UnitSlip, format!("{path}.yield_n"), message, help);
        }
        is_soft || is_thick || is_odd.is_some()
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::read::load_text;

    /// Warnings of a bolt of this steel.
    fn warnings(steel: &str) -> Vec<String> {
        let text = format!(
            "(title: \"t\", time: (step_s: 1e-4, end_s: 1),
              materials: [(name: \"rock\", density_kg_m3: 2700, young_pa: 2e10, poisson: 0.2)],
              blocks: [(name: \"a\", material: \"rock\", body: Fixed, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
              bolts: [(
                  name: \"anchor\", at: Line(from_m: (0.5, 0.5, 1), to_m: (0.5, 0.5, 0)),
                  steel: ({steel}), grout: (stiffness_n_m2: 1e9, strength_n_m: 2e5),
              )])"
        );
        let loaded = load_text("s.ron", &text, &[], None).unwrap();
        let slips = loaded.warnings.iter().filter(|found| found.path.contains("steel"));
        slips.map(|found| format!("{}: {}", found.path, found.help.as_deref().unwrap_or(""))).collect()
    }

    #[test]
    fn steel_in_another_unit_is_warned_of_with_that_of_the_field() {
        let good = "young_pa: 200e9, area_m2: 491e-6, yield_n: 250e3, break_strain: 0.1";
        assert_eq!(warnings(good), Vec::<String>::new());
        for (good_part, bad_part, field, unit) in [
            ("200e9", "200", "young_pa", "200 GPa, which is 200e9"),
            ("491e-6", "491", "area_m2", "491 mm², which is 491e-6"),
            ("250e3", "250", "yield_n", "250 kN is 250e3"),
        ] {
            let found = warnings(&good.replace(good_part, bad_part));
            assert!(found.len() == 1 && found[0].contains(field) && found[0].contains(unit), "{found:?}");
        }
    }
}
