//! Effect of sudden gravity on blocks that shear springs hold: they creep while their contact vibrates.

use ndda_io::code::Code;
use ndda_io::diagnostic::{Diagnostic, Severity};
use ndda_io::read::LoadedScene;
use ndda_io::scene::{Contact, Friction, Scene};

/// A warning for scenes that begin with sudden gravity on blocks held by shear springs.
pub fn warning(loaded: &LoadedScene) -> Option<Diagnostic> {
    let scene = &loaded.scene;
    let has_gravity = scene.gravity_m_s2 != [0.0; 3];
    let is_sudden = has_gravity && scene.gravity_ramp_s == 0.0 && scene.settle.is_none();
    let springs = springs(scene).filter(|_| is_sudden && !is_damped(scene))?;
    let message = "gravity acts suddenly, so contact will vibrate; meanwhile blocks that shear springs hold may slip slightly, even where friction could hold them";
    let cures =
        "give contacts a restitution below 1, begin with settle: (), or apply gravity over gravity_ramp_s";
    let help = match springs.holds_together {
        true => cures.into(),
        false => format!("{cures}; or leave out shear_penalty_pa_m, so that friction acts on velocities"),
    };
    let mut found = loaded.diagnose(&springs.path, message.into()).with_help(help);
    (found.code, found.severity) = (Code::Inexact, Severity::Warning);
    Some(found)
}

fn is_damped(scene: &Scene) -> bool {
    matches!(&scene.contact, Some(Contact::Potential { restitution, .. }) if *restitution < 1.0)
}

/// A law whose friction acts on springs.
struct Springs {
    /// Where its stiffness is in the scene.
    path: String,
    /// Whether it also holds blocks together, which needs the springs.
    holds_together: bool,
}

/// The first law of a scene whose friction acts on springs.
fn springs(scene: &Scene) -> Option<Springs> {
    let Some(Contact::Potential { friction, rock_joints, material_pairs, .. }) = &scene.contact else {
        return None;
    };
    let of = |(path, friction): (String, &Friction)| {
        let is_spring = friction.shear_penalty_pa_m.is_some() && friction.friction_deg > 0.0;
        let holds_together = friction.cohesion_pa > 0.0 || friction.tension_pa > 0.0;
        is_spring.then(|| Springs { path: format!("{path}.shear_penalty_pa_m"), holds_together })
    };
    let all = friction.iter().map(|friction| ("contact.friction".to_string(), friction));
    let joints = rock_joints
        .iter()
        .enumerate()
        .filter_map(|(i, law)| Some((format!("contact.rock_joints[{i}].friction"), law.friction.as_ref()?)));
    let pairs = material_pairs.iter().enumerate().filter_map(|(i, law)| {
        Some((format!("contact.material_pairs[{i}].friction"), law.friction.as_ref()?))
    });
    all.chain(joints).chain(pairs).find_map(of)
}
