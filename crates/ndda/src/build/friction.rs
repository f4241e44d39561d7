//! The friction laws that scenes name.

use ndda_contact::{
    BartonBandis, Coulomb, Dilating, Dilation, Fracture, FrictionLaw, MohrCoulomb, Roughness, SofteningBond,
    SofteningCoulomb, VelocityCoulomb,
};
use ndda_io::scene;

/// The law of the contacts of a run; `None` where nothing rubs. Contacts open by slip where the scene says so.
pub fn friction_law(friction: &scene::Friction) -> Option<Box<dyn FrictionLaw>> {
    let law = strength(friction)?;
    let dilates = friction.roughness.as_ref().is_some_and(|roughness| roughness.dilates);
    Some(match dilation(friction).filter(|dilation| *dilation != Dilation::Own || dilates) {
        Some(dilation) => Box::new(Dilating::new(law, dilation)),
        None => law,
    })
}

/// The law without dilation.
fn strength(friction: &scene::Friction) -> Option<Box<dyn FrictionLaw>> {
    let scene::Friction { friction_deg, shear_penalty_pa_m, cohesion_pa, tension_pa, residual, .. } =
        *friction;
    if let (Some(rough), Some(shear)) = (&friction.roughness, shear_penalty_pa_m) {
        return Some(Box::new(barton_bandis(friction_deg, rough, shear)));
    }
    if let (Some(energy), Some(stiffness_pa_m)) = (&friction.fracture, shear_penalty_pa_m) {
        let fracture = Fracture {
            stiffness_pa_m,
            strength_pa: [tension_pa, cohesion_pa],
            energy_j_m2: [energy.tension_j_m2, energy.shear_j_m2],
        };
        return Some(Box::new(SofteningBond::new(friction_deg, fracture)));
    }
    if friction_deg <= 0.0 && cohesion_pa <= 0.0 && tension_pa <= 0.0 {
        return None;
    }
    Some(match (shear_penalty_pa_m, residual) {
        (None, _) => Box::new(VelocityCoulomb::new(friction_deg)),
        (Some(shear), Some(residual)) => {
            let (peak, after) = ((friction_deg, cohesion_pa), (residual.friction_deg, residual.cohesion_pa));
            let law = SofteningCoulomb::new(shear, peak, after, residual.over_m);
            // Without a tension to open at, a joint opens freely.
            let opens_m = if residual.tension_pa > 0.0 { residual.opening_m } else { 0.0 };
            Box::new(law.with_tension(tension_pa, residual.tension_pa).that_opens(opens_m))
        }
        (Some(shear), None) if cohesion_pa > 0.0 || tension_pa > 0.0 => {
            Box::new(MohrCoulomb::new(friction_deg, shear, cohesion_pa, tension_pa))
        }
        (Some(shear), None) => Box::new(Coulomb::new(friction_deg, shear)),
    })
}

/// The friction law with the dilation of the joint, for laboratory tests: a rough joint dilates there in any case.
pub fn joint_law(friction: &scene::Friction) -> Option<Box<dyn FrictionLaw>> {
    let law = strength(friction)?;
    Some(match dilation(friction) {
        Some(dilation) => Box::new(Dilating::new(law, dilation)),
        None => law,
    })
}

/// How a joint opens by slip, if it does.
fn dilation(friction: &scene::Friction) -> Option<Dilation> {
    match friction.dilation {
        Some(scene::Dilation { psi_deg, to_slip_m }) => Some(Dilation::Angle { psi_deg, to_slip_m }),
        None => friction.roughness.is_some().then_some(Dilation::Own),
    }
}

/// Roughness of a joint at its own length.
pub fn roughness(residual_deg: f64, rough: &scene::Roughness) -> Roughness {
    let scene::Roughness { jrc, jcs_pa, sample_m, length_m, .. } = *rough;
    let sample = Roughness { jrc, jcs_pa, residual_deg, length_m: sample_m };
    sample.of_length(length_m.unwrap_or(sample_m))
}

fn barton_bandis(residual_deg: f64, rough: &scene::Roughness, shear_penalty_pa_m: f64) -> BartonBandis {
    let law = BartonBandis::new(roughness(residual_deg, rough), shear_penalty_pa_m);
    let law = law.reduced_by(1.0 / rough.strength_factor);
    if rough.mobilised { law.mobilised() } else { law }
}

#[cfg(test)]
mod tests {
    use crate::{Model, Run};

    /// Three cubes that lie on each other and slide at different speeds for 20 ms.
    fn text(tolerance: &str) -> String {
        let cube = |name: &str, more: &str| {
            format!(
                "(name: {name:?}, material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), {more})"
            )
        };
        let cubes = [
            cube("a", "velocity_m_s: (0.3, 0, 0)"),
            cube("b", "at_m: (0.2, 0, 1)"),
            cube("c", "at_m: (0.1, 0.1, 2), velocity_m_s: (0, 0.2, 0)"),
        ];
        format!(
            r#"(
            title: "Three cubes slide on each other", time: (step_s: 1e-3, end_s: 0.02), gravity_m_s2: (0, 0, -9.8),
            materials: [(name: "rock", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
            blocks: [
                (name: "base", material: "rock", body: Fixed, shape: Box(size_m: (9, 3, 1), cells: (1, 1, 1)), at_m: (-3, -1, -1)),
                {}
            ],
            contact: Potential(penalty_pa: 1e8, potential: Smooth(), friction: (friction_deg: 30), {tolerance}),
            monitors: [(name: "lowest", block: "a", at: Largest((1, 0, 0)))],
        )"#,
            cubes.join(",\n")
        )
    }

    /// Velocity of the lowest along x at the end [m/s].
    fn velocity_m_s(tolerance: &str) -> f64 {
        let outcome = Run::new(Model::from_text(&text(tolerance)).unwrap()).finish(&mut []).unwrap();
        outcome.monitor("lowest").unwrap().velocity[0]
    }

    #[test]
    fn a_scene_says_how_exactly_friction_is_found() {
        let [exact, own, coarse] =
            ["friction_tolerance: 1e-10", "", "friction_tolerance: 1e-2"].map(velocity_m_s);
        // Friction changes a velocity by no more than μ g n dt in a step, of three cubes: what is left of it does not add up.
        let of_step = |tolerance: f64| tolerance * 3.0 * 0.577 * 9.8 * 1e-3;
        assert!((own - exact).abs() <= of_step(1e-7), "{own} {exact}");
        assert!((coarse - exact).abs() <= of_step(1e-2) && coarse != exact, "{coarse} {exact}");
        for wrong in ["0", "0.1", "-1e-4"] {
            let refused = Model::from_text(&text(&format!("friction_tolerance: {wrong}"))).err();
            let message = refused.expect("it is out of range").to_string();
            assert!(message.contains("from 1e-10 to 1e-2"), "{message}");
        }
    }
}
