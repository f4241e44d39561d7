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
            Box::new(law.with_tension(tension_pa, residual.tension_pa).that_opens(residual.opening_m))
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
