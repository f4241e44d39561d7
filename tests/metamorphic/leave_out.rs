//! Scenes that a defect which is known, and not yet mended, spoils: one switch per defect, to be taken out with it.

use ndda_io::scene::{Body, Contact, ContactAt, Friction, Integrator, Potential, Scene};

/// A defect: the relations that it spoils, its name, and the scenes that have it.
type Switch = (&'static [&'static str], &'static str, fn(&Scene) -> bool);

const SWITCHES: [Switch; 5] = [
    // Collisions at a distance from the origin differ from those at the origin, by the cause of one scene in forty (seed 26).
    (&["boosted", "shifted"], "left out: other integrators than Midpoint", spins),
    // A fixed block that is moved from the start has no velocity at the first step, in which contact sees it behind.
    (&["boosted"], "left out: fixed blocks that move", fixed),
    // Regions of the smooth potential depend on how a block is turned; some are refused one way and not the other.
    (
        &["rotated", "shifted", "mirrored", "boosted", "renumbered"],
        "left out: ties of the smooth potential",
        smooth,
    ),
    // Off by 1e-9 to 1e-7 in a mirror; the cause is not known.
    (&["mirrored"], "left out: friction in a mirror", rubs),
    // Friction on velocities is found patch by patch to a thousandth of what it may be, in the order of the blocks.
    (&["renumbered"], "left out: order of patches in velocity friction", velocity_friction),
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

fn spins(scene: &Scene) -> bool {
    !matches!(scene.time.integrator, Integrator::Midpoint { .. }) || ends(scene)
}

fn ends(scene: &Scene) -> bool {
    matches!(scene.time.contact_at, ContactAt::End { .. })
}

/// A boosted scene moves all of them.
fn fixed(scene: &Scene) -> bool {
    scene.blocks.iter().any(|block| block.body == Body::Fixed)
}

fn smooth(scene: &Scene) -> bool {
    matches!(scene.contact, Some(Contact::Potential { potential: Potential::Smooth { .. }, .. }))
}

fn friction(scene: &Scene) -> Option<&Friction> {
    match &scene.contact {
        Some(Contact::Potential { friction, .. }) => friction.as_ref(),
        _ => None,
    }
}

fn rubs(scene: &Scene) -> bool {
    friction(scene).is_some()
}

fn velocity_friction(scene: &Scene) -> bool {
    friction(scene).is_some_and(|friction| friction.shear_penalty_pa_m.is_none())
}
