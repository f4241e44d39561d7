//! Checks of friction.

use super::Check;
use crate::scene::code::Code;
use crate::scene::{Contact, Dilation, FractureEnergy, Friction, Memory, Potential, Residual, Roughness};

/// Typical friction angles, as advice.
const TYPICAL: &str =
    "typical are 25° to 40° for joints in rock, 10° to 20° with clay in them; μ = 0.6 is 31°";
/// Largest roughness coefficient.
const MOST_JRC: f64 = 20.0;

/// Stiffness [Pa/m] below which a joint has none in any rock; clay has more.
const SOFTEST_JOINT_PA_M: f64 = 1e4;
/// Strength [Pa] that is the weight of some millimetres of rock.
const LEAST_STRENGTH_PA: f64 = 100.0;
/// Strength [Pa] below that of any wall of a joint; soil has more.
const LEAST_WALL_PA: f64 = 1e4;

/// Angles below it [°] are probably coefficients: no joint has one so small, and coefficients lie below it.
const LEAST_LIKELY_DEG: f64 = 2.0;

impl Friction {
    /// The angle [°] whose tangent is a number that is given as an angle and is too small for one of a joint: it is probably tan φ.
    pub fn deg_of_coefficient(angle_deg: f64) -> Option<f64> {
        (0.0 < angle_deg && angle_deg < LEAST_LIKELY_DEG).then(|| angle_deg.atan().to_degrees())
    }
}

impl Check<'_> {
    /// Warns of a value with its unit that is positive and too small to mean anything.
    pub(super) fn small(&mut self, path: String, (value, unit): (f64, &str), least: f64, help: &str) {
        if value > 0.0 && value < least {
            self.warn(Code::UnitSlip, path, format!("{value} {unit} is next to nothing"), help);
        }
    }

    /// Warns of an angle [°] that is probably a coefficient of friction.
    pub(super) fn coefficient(&mut self, path: String, angle_deg: f64) {
        if let Some(degrees) = Friction::deg_of_coefficient(angle_deg) {
            let message = format!("{angle_deg}° is less than any joint has");
            let help = format!(
                "if {angle_deg} is meant as the coefficient tan φ, write {degrees:.1}; if it is in radians, Radians({angle_deg})"
            );
            self.warn(Code::UnitSlip, path, message, help);
        }
    }

    pub(super) fn friction(&mut self, path: &str, friction: &Friction) {
        let field = |name: &str| format!("{path}.{name}");
        let angle = friction.friction_deg;
        if !(0.0..90.0).contains(&angle) {
            let message = format!("{angle}°: a friction angle must be at least 0 and below 90°");
            self.error(field("friction_deg"), message, TYPICAL);
        } else {
            self.coefficient(field("friction_deg"), angle);
        }
        if let Some(penalty) = friction.shear_penalty_pa_m {
            self.positive(field("shear_penalty_pa_m"), penalty, "Pa/m");
            let help = "joints have 1 to 100 GPa/m: 10 GPa/m is 10e9";
            self.small(field("shear_penalty_pa_m"), (penalty, "Pa/m"), SOFTEST_JOINT_PA_M, help);
        }
        let help = "the unit is pascal: 50 kPa is 50e3";
        self.small(field("cohesion_pa"), (friction.cohesion_pa, "Pa"), LEAST_STRENGTH_PA, help);
        self.small(field("tension_pa"), (friction.tension_pa, "Pa"), LEAST_STRENGTH_PA, help);
        for (name, strength) in [("cohesion_pa", friction.cohesion_pa), ("tension_pa", friction.tension_pa)] {
            if !(strength >= 0.0 && strength.is_finite()) {
                let message = format!("{strength} Pa: must be zero or positive");
                self.error(field(name), message, "0 for a joint that does not hold together");
            } else if strength > 0.0 && friction.shear_penalty_pa_m.is_none() {
                let help = "give shear_penalty_pa_m, the stiffness of the joint until it breaks";
                self.misfit(
                    field(name),
                    "a joint that holds together needs a shear stiffness to hold with",
                    help,
                );
            }
        }
        if let Some(residual) = &friction.residual {
            self.residual(&field("residual"), friction, residual);
        }
        if let Some(roughness) = &friction.roughness {
            self.roughness(&field("roughness"), friction, roughness);
        }
        if let Some(fracture) = &friction.fracture {
            self.fracture(&field("fracture"), friction, fracture);
        }
        if let Some(dilation) = &friction.dilation {
            self.dilation(&field("dilation"), friction, dilation);
        }
    }

    fn residual(&mut self, path: &str, peak: &Friction, residual: &Residual) {
        let field = |name: &str| format!("{path}.{name}");
        let Residual { friction_deg, cohesion_pa, tension_pa, over_m, opening_m } = *residual;
        if !(0.0..=peak.friction_deg).contains(&friction_deg) {
            let message = format!("{friction_deg}°: must be from 0 to the peak, {}°", peak.friction_deg);
            self.error(field("friction_deg"), message, "joints weaken when they slip");
        }
        if !(0.0..=peak.cohesion_pa).contains(&cohesion_pa) {
            let message = format!("{cohesion_pa} Pa: must be from 0 to the peak, {} Pa", peak.cohesion_pa);
            self.error(field("cohesion_pa"), message, "joints weaken when they slip");
        }
        if !(0.0..=peak.tension_pa).contains(&tension_pa) {
            let message = format!("{tension_pa} Pa: must be from 0 to the peak, {} Pa", peak.tension_pa);
            self.error(field("tension_pa"), message, "joints weaken when they slip");
        }
        if !(over_m >= 0.0 && over_m.is_finite()) {
            self.error(
                field("over_m"),
                format!("{over_m} m: must be zero or positive"),
                "0 for a strength that falls at once",
            );
        }
        if !(opening_m >= 0.0 && opening_m.is_finite()) {
            let message = format!("{opening_m} m: must be zero or positive");
            self.error(field("opening_m"), message, "0 for a joint that is broken where it opens");
        } else if opening_m > 0.0 && tension_pa == 0.0 {
            let message = format!(
                "{opening_m} m has no effect: without a residual tensile strength a joint opens freely"
            );
            let help = "leave out opening_m, or give residual.tension_pa, the tension at which it opens, and as much tension_pa or more";
            self.warn(Code::NoEffect, field("opening_m"), message, help);
        }
        if peak.shear_penalty_pa_m.is_none() {
            let help = "give shear_penalty_pa_m, the stiffness of the joint before it slips";
            self.misfit(
                path.to_string(),
                "a joint that softens needs a shear stiffness, to measure its slip",
                help,
            );
        }
        if peak.tension_pa > 0.0 && peak.dilation.is_some() {
            let help = "leave out tension_pa, or dilation";
            self.misfit(path.to_string(), "a joint that opens by slip keeps no tensile strength", help);
        }
    }

    fn roughness(&mut self, path: &str, friction: &Friction, roughness: &Roughness) {
        let field = |name: &str| format!("{path}.{name}");
        if !(0.0..=MOST_JRC).contains(&roughness.jrc) {
            let message = format!("{}: must be from 0 to {MOST_JRC}", roughness.jrc);
            self.error(
                field("jrc"),
                message,
                "0 for a smooth joint, 20 for the roughest of Barton's profiles",
            );
        }
        self.positive(field("jcs_pa"), roughness.jcs_pa, "Pa");
        let help = "walls of joints have 1 to 300 MPa: 100 MPa is 100e6";
        self.small(field("jcs_pa"), (roughness.jcs_pa, "Pa"), LEAST_WALL_PA, help);
        self.positive(field("sample_m"), roughness.sample_m, "m");
        if let Some(length_m) = roughness.length_m {
            self.positive(field("length_m"), length_m, "m");
        }
        if roughness.dilates {
            if !roughness.mobilised {
                let help = "give mobilised: true, with which roughness wears off";
                self.misfit(
                    field("dilates"),
                    "a joint whose roughness is not worn off would open for ever",
                    help,
                );
            }
            self.moves_faces_out(&field("dilates"));
        }
        let factor = roughness.strength_factor;
        if !(factor > 0.0 && factor.is_finite()) {
            let message = format!("{factor}: must be positive");
            self.error(field("strength_factor"), message, "1 for the strength of the joint as it is");
        }
        if friction.shear_penalty_pa_m.is_none() {
            let help = "give shear_penalty_pa_m, the shear stiffness of the joint";
            self.misfit(
                path.to_string(),
                "a joint with roughness needs a shear stiffness, to measure its slip",
                help,
            );
        }
        let strengths = friction.cohesion_pa > 0.0 || friction.tension_pa > 0.0;
        if strengths || friction.residual.is_some() {
            let help = "leave out cohesion_pa, tension_pa and residual, or roughness";
            self.misfit(
                path.to_string(),
                "a joint with roughness has the strength of its roughness only",
                help,
            );
        }
    }

    fn fracture(&mut self, path: &str, friction: &Friction, fracture: &FractureEnergy) {
        let Some(stiffness_pa_m) = friction.shear_penalty_pa_m else {
            let help = "give shear_penalty_pa_m, the stiffness of the joint until it breaks";
            return self.misfit(
                path.to_string(),
                "a joint that holds together needs a shear stiffness to hold with",
                help,
            );
        };
        if !(friction.cohesion_pa > 0.0 && friction.tension_pa > 0.0) {
            let help = "give cohesion_pa and tension_pa, or leave out fracture";
            self.misfit(path.to_string(), "a joint without strength takes no energy to break", help);
        }
        if friction.residual.is_some() || friction.roughness.is_some() || friction.dilation.is_some() {
            let help = "leave out residual, roughness and dilation, or fracture";
            self.misfit(path.to_string(), "a joint that breaks gradually leaves plain friction", help);
        }
        for (name, energy_j_m2, strength_pa) in [
            ("tension_j_m2", fracture.tension_j_m2, friction.tension_pa),
            ("shear_j_m2", fracture.shear_j_m2, friction.cohesion_pa),
        ] {
            // Energy stored in the spring at its strength.
            let least_j_m2 = 0.5 * strength_pa * strength_pa / stiffness_pa_m;
            if !(energy_j_m2 > least_j_m2 && energy_j_m2.is_finite()) {
                let message = format!("{energy_j_m2} J/m²: must be above {least_j_m2:e} J/m²");
                let help = "the joint stores this much elastic energy before it breaks: raise the fracture energy, or shear_penalty_pa_m";
                self.error(format!("{path}.{name}"), message, help);
            }
        }
    }

    fn dilation(&mut self, path: &str, friction: &Friction, dilation: &Dilation) {
        let field = |name: &str| format!("{path}.{name}");
        let residual_deg = friction.residual.map_or(friction.friction_deg, |residual| residual.friction_deg);
        let most_deg = friction.friction_deg.min(residual_deg);
        let psi_deg = dilation.psi_deg;
        if !(0.0..=most_deg).contains(&psi_deg) {
            let message = format!("{psi_deg}°: must be from 0 to the least friction angle, {most_deg}°");
            self.error(
                field("psi_deg"),
                message,
                "a dilation angle above the friction angle would create energy",
            );
        }
        if !(dilation.to_slip_m >= 0.0 && dilation.to_slip_m.is_finite()) {
            let message = format!("{} m: must be zero or positive", dilation.to_slip_m);
            self.error(field("to_slip_m"), message, "the slip at which dilation ends");
        }
        if friction.shear_penalty_pa_m.is_none() {
            let help = "give shear_penalty_pa_m, the shear stiffness of the joint";
            self.misfit(
                path.to_string(),
                "dilation follows slip beyond the elastic shear displacement, which needs a shear stiffness",
                help,
            );
        }
        if friction.roughness.is_some() {
            let help = "leave out dilation, or roughness";
            self.misfit(
                path.to_string(),
                "a joint with roughness has its own dilation, half of its roughness angle",
                help,
            );
        }
        self.moves_faces_out(path);
    }

    /// Joints that open by slip ask for a pressure that depends on the depth below faces, and for memory that crosses the borders of elements.
    fn moves_faces_out(&mut self, path: &str) {
        let Some(Contact::Potential { potential, memory, .. }) = &self.scene.contact else { return };
        if !matches!(potential, Potential::Smooth { .. } | Potential::Closure { .. }) {
            let help = "give contact.potential: Smooth(), or Closure(…)";
            self.misfit(
                path.to_string(),
                "a joint opens by slip with the potentials Smooth and Closure",
                help,
            );
        }
        if *memory == Memory::Element {
            let help = "give contact.memory: Body";
            self.misfit(path.to_string(), "a joint that has opened would close at the next element", help);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::read::load_text;

    #[test]
    fn an_opening_of_a_joint_without_tensile_strength_is_warned_of_and_does_not_stop() {
        let told = |friction: &str| {
            let text = format!(
                "(title: \"t\", time: (step_s: 1e-3, end_s: 1),
                  materials: [(name: \"rock\", density_kg_m3: 2700, young_pa: 1e10, poisson: 0.25)],
                  blocks: [(name: \"a\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
                  contact: Potential(penalty_pa: 1e8, friction: (friction_deg: 30, shear_penalty_pa_m: 1e9, {friction})))"
            );
            let warnings = load_text("s.ron", &text, &[], None).unwrap().warnings;
            warnings
                .into_iter()
                .filter(|warning| warning.path.contains("opening_m"))
                .map(|warning| format!("{}: {}", warning.path, warning.message))
                .collect::<Vec<_>>()
        };
        let kept = |strength_pa: &str| {
            told(&format!(
                "cohesion_pa: {strength_pa}, tension_pa: {strength_pa}, residual: (friction_deg: 30, cohesion_pa: {strength_pa}, tension_pa: {strength_pa}, opening_m: 0.1)"
            ))
        };
        assert_eq!(kept("1e5"), Vec::<String>::new());
        let none = kept("0");
        assert!(
            none.len() == 1
                && none[0].starts_with("contact.friction.residual.opening_m: 0.1 m has no effect"),
            "{none:?}"
        );
    }
}
