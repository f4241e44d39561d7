//! Scenes that a defect which is known, and not yet mended, spoils: one switch per defect, to be taken out with it.

use ndda_io::scene::{Body, Contact, ContactAt, Integrator, Mass, Scene};

/// A defect: the relations that it spoils, its name, and the scenes that have it.
type Switch = (&'static [&'static str], &'static str, fn(&Scene) -> bool);

const SWITCHES: [Switch; 5] = [
    (&["boosted", "label"], "left out: spin of Newmark", newmark),
    (&["label"], "left out: velocity friction in impacts", velocity_friction),
    (&["label"], "left out: strength of bonds", bonds),
    (&["resumed", "split"], "left out: resume with contact at the end", rigid_end),
    (&["label"], "left out: moved base", moved_base),
];

/// The first defect that spoils a scene for a relation; none where `NDDA_ALL` is set.
pub fn known(relation: &str, scene: &Scene) -> Option<&'static str> {
    if std::env::var_os("NDDA_ALL").is_some() {
        return None;
    }
    let mut switches = SWITCHES.iter();
    let found = switches.find(|(relations, _, spoils)| relations.contains(&relation) && spoils(scene));
    found.map(|(_, name, _)| *name)
}

fn newmark(scene: &Scene) -> bool {
    matches!(scene.time.integrator, Integrator::Newmark { .. })
}

fn velocity_friction(scene: &Scene) -> bool {
    let Some(Contact::Potential { friction: Some(friction), .. }) = &scene.contact else { return false };
    friction.shear_penalty_pa_m.is_none()
}

fn bonds(scene: &Scene) -> bool {
    let Some(Contact::Potential { friction: Some(friction), .. }) = &scene.contact else { return false };
    friction.cohesion_pa > 0.0 || friction.tension_pa > 0.0
}

fn rigid_end(scene: &Scene) -> bool {
    matches!(scene.time.contact_at, ContactAt::End { .. })
        && (scene.blocks.iter().any(|b| b.body == Body::Rigid)
            || scene.rock.iter().any(|r| r.body == Body::Rigid))
}

fn moved_base(scene: &Scene) -> bool {
    scene.blocks.iter().any(|b| b.body == Body::Fixed) && !scene.supports.is_empty()
}

#[allow(dead_code)]
fn lumped(scene: &Scene) -> bool {
    scene.time.mass == Mass::Lumped
}
