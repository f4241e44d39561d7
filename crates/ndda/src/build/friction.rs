//! The friction laws that scenes name.

use ndda_contact::{
    BartonBandis, Coulomb, Dilating, Dilation, Fracture, FrictionLaw, MohrCoulomb, Roughness, SofteningBond,
    SofteningCoulomb, VelocityCoulomb,
};
use ndda_io::scene;

/// The law of the contacts of a run; `None` where nothing rubs. Contacts do not open by slip.
pub fn friction_law(friction: &scene::Friction) -> Option<Box<dyn FrictionLaw>> {
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
            Box::new(SofteningCoulomb::new(shear, peak, after, residual.over_m))
        }
        (Some(shear), None) if cohesion_pa > 0.0 || tension_pa > 0.0 => {
            Box::new(MohrCoulomb::new(friction_deg, shear, cohesion_pa, tension_pa))
        }
        (Some(shear), None) => Box::new(Coulomb::new(friction_deg, shear)),
    })
}

/// The friction law with the dilation of the joint, for laboratory tests.
pub fn joint_law(friction: &scene::Friction) -> Option<Box<dyn FrictionLaw>> {
    let law = friction_law(friction)?;
    Some(match friction.dilation {
        Some(scene::Dilation { psi_deg, to_slip_m }) => {
            Box::new(Dilating::new(law, Dilation::Angle { psi_deg, to_slip_m }))
        }
        None if friction.roughness.is_some() => Box::new(Dilating::new(law, Dilation::Own)),
        None => law,
    })
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
