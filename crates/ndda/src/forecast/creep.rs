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
    if !is_sudden || !has_springs(scene) || is_damped(scene) {
        return None;
    }
    let message = "gravity acts suddenly, so contact will vibrate; meanwhile blocks that shear springs hold may slip slightly, even where friction could hold them";
    let help = "give contacts a restitution below 1, begin with settle: (), apply gravity over gravity_ramp_s, or leave out shear_penalty_pa_m, so that friction acts on velocities";
    let mut found = loaded.diagnose("contact.friction.shear_penalty_pa_m", message.into()).with_help(help);
    (found.code, found.severity) = (Code::Inexact, Severity::Warning);
    Some(found)
}

fn is_damped(scene: &Scene) -> bool {
    matches!(&scene.contact, Some(Contact::Potential { restitution, .. }) if *restitution < 1.0)
}

fn has_springs(scene: &Scene) -> bool {
    let Some(Contact::Potential { friction, rock_joints, .. }) = &scene.contact else { return false };
    let is_spring =
        |friction: &Friction| friction.shear_penalty_pa_m.is_some() && friction.friction_deg > 0.0;
    friction.as_ref().is_some_and(is_spring)
        || rock_joints.iter().filter_map(|law| law.friction.as_ref()).any(is_spring)
}
