//! Which joint of a scene is tested.

use ndda_io::scene::{Contact, Discontinuity, Friction, Potential, Scene, is_unset, matches};

use super::NormalStiffness;

/// A law of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Which {
    /// That between all blocks, `contact.friction`.
    #[default]
    Everywhere,
    /// That of a named joint, of `contact.rock_joints`.
    Joint(String),
    /// That between two materials, of `contact.material_pairs`.
    Between(String, String),
}

impl Which {
    /// In words, for the headings of results; a law that is no scene's own has no title.
    pub fn describe(&self, title: Option<&str>) -> String {
        match (self, title) {
            (Self::Joint(name), _) => format!("joint `{name}`"),
            (Self::Between(a, b), _) => format!("joint of `{a}` and `{b}`"),
            (Self::Everywhere, Some(title)) => format!("all joints of `{title}`"),
            (Self::Everywhere, None) => "a joint".into(),
        }
    }
}

/// Why there is no law to test.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SelectError {
    /// No contact in the scene.
    #[error("the scene has no contact: give contact: Potential(…)")]
    NoContact,
    /// No such joint, or no law for it.
    #[error("{wanted} has no law of its own in this scene, which has {known}{}", none_such(.joints))]
    Unknown {
        /// The joint or pair that was requested.
        wanted: String,
        /// Joints and pairs that have a law.
        known: String,
        /// The joints of the scene, where the one that was requested is none of them.
        joints: Option<String>,
    },
    /// The joint has no friction.
    #[error("{wanted} has no friction in this scene, and so nothing to test")]
    Smooth {
        /// The joint or pair that was requested.
        wanted: String,
    },
}

/// The friction that a scene gives a joint; the last entry counts, as in a run.
///
/// # Errors
/// [`SelectError`], which names the joints that have laws.
pub fn friction<'a>(scene: &'a Scene, which: &Which) -> Result<&'a Friction, SelectError> {
    let Some(Contact::Potential { friction, material_pairs, rock_joints, .. }) = &scene.contact else {
        return Err(SelectError::NoContact);
    };
    let (wanted, found) = match which {
        Which::Everywhere => ("contact.friction".to_string(), Some(friction)),
        Which::Joint(name) => {
            let law = rock_joints.iter().rev().find(|law| law.joint == *name || matches(&law.joint, name));
            (format!("joint `{name}`"), law.map(|law| &law.friction))
        }
        Which::Between(a, b) => {
            let is =
                |pair: &(String, String)| (pair.0 == *a && pair.1 == *b) || (pair.0 == *b && pair.1 == *a);
            let joint = material_pairs.iter().rev().find(|joint| is(&joint.between));
            (format!("the pair of `{a}` and `{b}`"), joint.map(|joint| &joint.friction))
        }
    };
    match found {
        None => Err(SelectError::Unknown { wanted, known: known(scene), joints: joints_but(scene, which) }),
        Some(None) => Err(SelectError::Smooth { wanted }),
        Some(Some(friction)) => Ok(friction),
    }
}

fn none_such(joints: &Option<String>) -> String {
    joints.as_ref().map_or(String::new(), |joints| format!("; there is no joint of this name: {joints}"))
}

/// The joints of a scene, if a joint is requested that is none of them; tables of discs may name more.
fn joints_but(scene: &Scene, which: &Which) -> Option<String> {
    let Which::Joint(wanted) = which else { return None };
    let joints = || scene.rock.iter().flat_map(|rock| &rock.joints);
    if joints().any(|joint| matches!(joint, Discontinuity::Discs { .. }) || matches(wanted, joint.name())) {
        return None;
    }
    let mut names: Vec<&str> = joints().map(Discontinuity::name).collect();
    names.dedup();
    Some(if names.is_empty() {
        "the scene cuts no rock".into()
    } else {
        format!("it has {}", names.join(", "))
    })
}

/// Joints and pairs that have a law, as options of the command line.
fn known(scene: &Scene) -> String {
    let Some(Contact::Potential { friction, material_pairs, rock_joints, .. }) = &scene.contact else {
        return "none".into();
    };
    let everywhere = friction.iter().map(|_| "contact.friction".to_string());
    let pairs =
        material_pairs.iter().map(|joint| format!("--between {},{}", joint.between.0, joint.between.1));
    let named = rock_joints.iter().map(|law| format!("--of {}", law.joint));
    let all: Vec<String> = everywhere.chain(pairs).chain(named).collect();
    if all.is_empty() { "no law at all".into() } else { all.join(", ") }
}

/// Normal stiffness of flat joints of a scene, both sides together; rigid where it depends on the mesh.
pub fn normal_stiffness(scene: &Scene) -> NormalStiffness {
    match &scene.contact {
        // It is chosen with blocks, which are of no concern here.
        Some(Contact::Potential { penalty_pa, .. }) if is_unset(penalty_pa) => NormalStiffness::Rigid,
        Some(Contact::Potential { penalty_pa, potential: Potential::Smooth { reference_m }, .. }) => {
            NormalStiffness::Linear { stiffness_pa_m: 2.0 * penalty_pa / reference_m }
        }
        Some(Contact::Potential {
            penalty_pa,
            potential: Potential::Closure { reference_m, max_closure_m },
            ..
        }) => NormalStiffness::Hyperbolic {
            initial_pa_m: 2.0 * penalty_pa / reference_m,
            most_m: *max_closure_m,
        },
        _ => NormalStiffness::Rigid,
    }
}
