//! Checks of water.

use super::Check;
use crate::scene::code::Code;
use crate::scene::{FactorRow, Pressure, Water, Wet};

/// Pressure of 1 cm of water [Pa].
const LEAST_PA: f64 = 100.0;
/// Part of a factor by which sums of a few numbers round at most.
const ROUNDING: f64 = 1e-12;
/// Tilts of gravity below this are rounding [°].
const TILTED_DEG: f64 = 0.05;
/// A seismic coefficient of 0.5 tilts gravity by 27°: where it is tilted further, the model is turned [°].
const SEISMIC_DEG: f64 = 27.0;
/// What pressures are in.
const UNIT: &str = "the unit is pascal: 1 m of water is 9810, 10 kPa is 10e3";

impl Check<'_> {
    pub(super) fn water(&mut self) {
        let scene = self.scene;
        for (i, water) in scene.water.iter().enumerate() {
            let path = format!("water[{i}]");
            match &water.on {
                Wet::Joint(name) => self.wet_joint(format!("{path}.on"), name),
                Wet::Part { block, region } => {
                    self.known_blocks(format!("{path}.on.block"), block);
                    self.region(&format!("{path}.on.region"), region);
                }
            }
            self.pressure(&format!("{path}.pressure"), &water.pressure);
            self.factor(&format!("{path}.factor"), &water.factor);
            self.sooner_than_weight(&path, water);
        }
        self.tilted_levels();
    }

    /// Levels of water that gravity tilts, as that of an earthquake by seismic coefficients does: real water stays level.
    fn tilted_levels(&mut self) {
        let scene = self.scene;
        let is_level = |water: &&Water| matches!(water.pressure, Pressure::Level { .. });
        let at = |i: usize| format!("water[{i}].pressure");
        let own = scene.water.iter().position(|water| is_level(&water)).map(at);
        let tilt_deg = angle_deg(&scene.gravity_m_s2, &[0.0, 0.0, -1.0]);
        if let Some(path) = own.clone().filter(|_| (TILTED_DEG..SEISMIC_DEG).contains(&tilt_deg)) {
            self.tilted_level(path, "gravity", tilt_deg);
        }
        let mut gravity = scene.gravity_m_s2;
        let mut has_level = own.is_some();
        for (i, stage) in scene.stages.iter().enumerate() {
            if let Some(water) = &stage.water {
                has_level = water.iter().any(|water| is_level(&water));
            }
            if let Some(changed) = stage.gravity_m_s2 {
                let tilt_deg = angle_deg(&changed, &gravity);
                if has_level && tilt_deg > TILTED_DEG {
                    self.tilted_level(format!("stages[{i}].gravity_m_s2"), "the stage", tilt_deg);
                }
                gravity = changed;
            }
        }
    }

    fn tilted_level(&mut self, path: String, what: &str, tilt_deg: f64) {
        let message =
            format!("{what} tilts the level of water by {tilt_deg:.1}°, since a `Level` lies across gravity");
        let help = "for an earthquake, which leaves water level, give `Linear(pressure_pa: 0, at_m: (…), gradient_pa_m: (0, 0, -9810))`, zero at the level; leave it so where the model itself is turned";
        self.warn(Code::Inexact, path, message, help);
    }

    /// Water that grows sooner than the weights that hold blocks down.
    fn sooner_than_weight(&mut self, path: &str, water: &Water) {
        let ramp_s = self.scene.gravity_ramp_s;
        if !(ramp_s > 0.0 && ramp_s.is_finite() && is_ahead(&water.factor, ramp_s)) {
            return;
        }
        let acts = if water.factor.is_empty() { "acts in full at once" } else { "grows sooner than gravity" };
        let message = format!(
            "{acts}, while gravity grows for {ramp_s} s: it may lift blocks and push them out before they have their weight"
        );
        let help = format!(
            "write factor: [(time_s: 0, factor: 0), (time_s: {ramp_s}, factor: 1)], or `settle: ()` in place of gravity_ramp_s"
        );
        self.warn(Code::Inexact, path, message, help);
    }

    fn wet_joint(&mut self, path: String, name: &str) {
        match &self.joints {
            Some(joints) if joints.is_empty() => {
                let message =
                    format!("there is no joint `{name}`, since the scene has no rock that joints cut");
                let help = "name the faces of a block: on: Part(block: \"…\", region: Set(\"z_min\"))";
                self.report(Code::UnknownName, path, message, help);
            }
            _ => self.known_joint(path, name),
        }
    }

    fn pressure(&mut self, path: &str, pressure: &Pressure) {
        match pressure {
            Pressure::Level { at_m, density_kg_m3 } => {
                self.numbers(&format!("{path}.at_m"), at_m);
                self.positive(format!("{path}.density_kg_m3"), *density_kg_m3, "kg/m³");
                if self.scene.gravity_m_s2 == [0.0; 3] {
                    let help = "give gravity_m_s2, or the pressure as `Linear` or `Points`";
                    self.report(Code::NoDirection, path, "there is no level without gravity", help);
                }
            }
            Pressure::Linear { pressure_pa, at_m, gradient_pa_m } => {
                self.numbers(&format!("{path}.pressure_pa"), &[*pressure_pa]);
                self.numbers(&format!("{path}.at_m"), at_m);
                self.numbers(&format!("{path}.gradient_pa_m"), gradient_pa_m);
                if *gradient_pa_m == [0.0; 3] {
                    let path = format!("{path}.pressure_pa");
                    match *pressure_pa < 0.0 {
                        true => self.suction(path, *pressure_pa),
                        false => self.small(path, (*pressure_pa, "Pa"), LEAST_PA, UNIT),
                    }
                }
            }
            Pressure::Points { along, at_m, rows } => {
                self.direction(format!("{path}.along"), along);
                self.numbers(&format!("{path}.at_m"), at_m);
                self.points(&format!("{path}.rows"), rows);
                let most_pa = rows.iter().map(|row| row.1).fold(0.0, f64::max);
                self.small(format!("{path}.rows"), (most_pa, "Pa at most"), LEAST_PA, UNIT);
            }
            Pressure::Least(fields) => {
                if fields.is_empty() {
                    self.error(
                        path,
                        "is an empty list, which has no least pressure",
                        "give one linear pressure at least",
                    );
                }
                for (i, field) in fields.iter().enumerate() {
                    self.numbers(&format!("{path}[{i}].pressure_pa"), &[field.pressure_pa]);
                    self.numbers(&format!("{path}[{i}].at_m"), &field.at_m);
                    self.numbers(&format!("{path}[{i}].gradient_pa_m"), &field.gradient_pa_m);
                }
            }
        }
    }

    fn points(&mut self, path: &str, rows: &[(f64, f64)]) {
        if rows.is_empty() {
            self.error(path, "has no points", "give one row at least: (distance, pressure)");
        }
        for (i, row) in rows.iter().enumerate() {
            self.numbers(&format!("{path}[{i}]"), &[row.0, row.1]);
            if row.1 < 0.0 {
                self.suction(format!("{path}[{i}]"), row.1);
            }
        }
        if let Some(i) = (1..rows.len()).find(|&i| rows[i].0 <= rows[i - 1].0) {
            let message = format!("{} m does not come after {} m", rows[i].0, rows[i - 1].0);
            self.error(format!("{path}[{i}]"), message, "sort the rows by distance");
        }
    }

    fn suction(&mut self, path: String, pressure_pa: f64) {
        let message = format!("{pressure_pa} Pa: must not be negative");
        self.error(path, message, "water in joints carries no suction");
    }
}

/// Angle between two directions [°]; zero where one of them is none.
fn angle_deg(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    let dot = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
    let cross = [0, 1, 2].map(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
    dot(&cross, &cross).sqrt().atan2(dot(a, b)).to_degrees()
}

/// Whether a factor is above f₁ t/t₁ somewhere before t₁, where it is f₁: linear between its rows, it is so at one of them, or at the start.
fn is_ahead(rows: &[FactorRow], ramp_s: f64) -> bool {
    let final_factor = factor_at(rows, ramp_s);
    let early = rows.iter().map(|row| row.time_s).filter(|time_s| (0.0..ramp_s).contains(time_s));
    let most = |time_s: f64| final_factor * time_s / ramp_s + ROUNDING * final_factor.abs();
    std::iter::once(0.0).chain(early).any(|time_s| factor_at(rows, time_s) > most(time_s))
}

/// A factor at a time: linear between rows, that of the first and of the last row beyond them, 1 without rows.
fn factor_at(rows: &[FactorRow], time_s: f64) -> f64 {
    let next = rows.partition_point(|row| row.time_s <= time_s);
    match (next.checked_sub(1).and_then(|last| rows.get(last)), rows.get(next)) {
        (Some(a), Some(b)) => a.factor + (b.factor - a.factor) * (time_s - a.time_s) / (b.time_s - a.time_s),
        (Some(row), None) | (None, Some(row)) => row.factor,
        (None, None) => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use crate::read::load_text;

    const SCENE: &str = include_str!("../../../tests/scene.ron");

    #[test]
    fn water_that_grows_sooner_than_the_weight_of_blocks_is_warned_of() {
        let warned = |factor: &str| {
            let water = format!(
                "gravity_ramp_s: 0.2, water: [(on: Part(block: \"slider\", region: Set(\"z_min\")), pressure: Level(at_m: (0, 0, 1)){factor})],\n    contact: Potential("
            );
            let text = SCENE.replacen("contact: Potential(", &water, 1);
            // The closed form of that scene has no ramp, which is said beside the warning.
            let told = load_text("s.ron", &text, &[], None).unwrap_err().to_string();
            ["acts in full at once", "grows sooner than gravity"]
                .into_iter()
                .find(|words| told.contains(words))
        };
        assert_eq!(warned(""), Some("acts in full at once"));
        for (rows, is_ahead) in [
            ("(time_s: 0, factor: 0), (time_s: 0.2, factor: 1)", false),
            ("(time_s: 0, factor: 0), (time_s: 0.2, factor: 1.5)", false),
            ("(time_s: 0.1, factor: 0), (time_s: 0.4, factor: 1)", false),
            ("(time_s: 0.3, factor: 0), (time_s: 0.4, factor: 1)", false),
            ("(time_s: 0, factor: 0), (time_s: 0.1, factor: 1)", true),
            ("(time_s: 0, factor: 0.2), (time_s: 0.2, factor: 1)", true),
            ("(time_s: 0, factor: 0), (time_s: 0.1, factor: 1), (time_s: 0.15, factor: 0)", true),
            ("(time_s: 0, factor: 1)", true),
        ] {
            let found = warned(&format!(", factor: [{rows}]"));
            assert_eq!(found, is_ahead.then_some("grows sooner than gravity"), "{rows}");
        }
    }

    #[test]
    fn gravity_that_tilts_a_level_of_water_is_warned_of() {
        let with = |gravity: &str, pressure: &str, stages: &str| {
            let water = format!(
                "water: [(on: Part(block: \"slider\", region: Set(\"z_min\")), pressure: {pressure})], {stages}\n    contact: Potential("
            );
            let text = SCENE.replacen("contact: Potential(", &water, 1);
            let overrides = [format!("gravity_m_s2={gravity}"), "reference=None".into()];
            match load_text("s.ron", &text, &overrides, None) {
                Ok(loaded) => {
                    loaded.warnings.iter().filter(|w| w.message.contains("tilts the level")).count()
                }
                Err(errors) => panic!("{errors}"),
            }
        };
        let (level, linear) = (
            "Level(at_m: (0, 0, 1))",
            "Linear(pressure_pa: 0, at_m: (0, 0, 1), gradient_pa_m: (0, 0, -9810))",
        );
        assert_eq!(with("(-0.98, 0, -9.81)", level, ""), 1);
        assert_eq!(with("(-0.98, 0, -9.81)", linear, ""), 0);
        assert_eq!(with("(0, 0, -9.81)", level, ""), 0);
        assert_eq!(with("(5.6, 0, -8)", level, ""), 0, "a model that is turned");
        let stage = "stages: [(name: \"quake\", gravity_m_s2: (-0.98, 0, -9.81), then: Run(0.1))],";
        assert_eq!(with("(0, 0, -9.81)", level, stage), 1);
        assert_eq!(with("(0, 0, -9.81)", linear, stage), 0);
    }

    #[test]
    fn water_on_a_joint_of_a_scene_without_rock_is_told_how_to_name_faces() {
        let water =
            "water: [(on: Joint(\"crack\"), pressure: Level(at_m: (0, 0, 1)))],\n    contact: Potential(";
        let errors = load_text("s.ron", &SCENE.replacen("contact: Potential(", water, 1), &[], None);
        let errors = errors.unwrap_err().to_string();
        assert!(errors.contains("no rock that joints cut") && errors.contains("on: Part(block:"), "{errors}");
    }

    #[test]
    fn rows_without_names_are_told_what_their_values_are_called() {
        let water = "water: [(on: Part(block: \"slider\", region: Set(\"z_min\")), pressure: Level(at_m: (0, 0, 1)), factor: [(0, 1)])],\n    contact: Potential(";
        let errors = load_text("s.ron", &SCENE.replacen("contact: Potential(", water, 1), &[], None)
            .unwrap_err()
            .to_string();
        assert!(
            errors.contains("expected the name of a field")
                && errors.contains("write each row as (time_s: 0, factor: …)"),
            "{errors}"
        );
    }
}
