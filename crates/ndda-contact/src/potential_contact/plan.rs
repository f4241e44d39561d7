//! The parts of this model.

use super::PotentialContact;
use crate::friction::law_table::{FrictionLawTable, Memory};
use crate::plan::Part;
use crate::potential::contact_potential::{OverlapLaw, PotentialField};

const FRICTION: &str = "friction";
const MEMORY: &str = "friction history";

/// Parts of the model, by what it holds.
pub(super) fn parts(model: &PotentialContact) -> Vec<Part> {
    let (name, penalty_pa) = (model.potential.name(), model.penalty_pa);
    let by_quadrature = matches!(&model.field, Some((_, PotentialField::Function(_))));
    let how = if by_quadrature { "by quadrature" } else { "exactly" };
    let curved = model.potential.law() != OverlapLaw::Linear;
    let mut parts = vec![
        Part::included(
            "broad phase",
            format!(
                "{}; pairs of blocks are listed anew once one has moved beyond its margin",
                model.candidates.finder()
            ),
        ),
        Part::included(
            "contact potential",
            format!("{name}, penalty_pa = {penalty_pa:e} Pa, integrated {how}"),
        ),
        whole_blocks(model),
        Part::of(
            "volume of overlaps",
            curved,
            "the pressure of a patch depends on all of its overlap",
            "pressure is penalty times φ, each point for itself",
        ),
    ];
    match &model.joints {
        None => {
            let why = "friction, cohesion and tension are zero between all materials";
            parts.extend([FRICTION, MEMORY, "bonds"].map(|name| Part::left_out(name, why)));
        }
        Some(joints) => parts.extend(friction(joints)),
    }
    parts
}

fn whole_blocks(model: &PotentialContact) -> Part {
    let count = model.hulls.count_affine();
    let why_not = match model.potential.phi_per_m() {
        None => format!("the potential {} is defined per tetrahedron", model.potential.name()),
        Some(_) => "no convex block is Rigid, Affine or Fixed, or contact.memory is Element".into(),
    };
    let what =
        format!("{count} convex blocks are compared as a whole, by their faces, not by their tetrahedra");
    Part::of("convex blocks taken whole", count > 0, what, why_not)
}

fn friction(joints: &FrictionLawTable) -> [Part; 3] {
    let faces = joints.act_on_faces();
    let memory = match joints.memory {
        _ if faces => "one force per face and block that it touches",
        Memory::Body => "one force per facet and block that it touches",
        Memory::Element => {
            "one force per facet and element that it touches, lost where the facet slides to the next element"
        }
    };
    [
        Part::included(FRICTION, joints.law_names().join(", ")),
        Part::included(MEMORY, memory),
        Part::of(
            "bonds",
            joints.hold_together(),
            "cohesion and tension until they break",
            "no joint has cohesion or tensile strength",
        ),
    ]
}
