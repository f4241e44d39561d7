//! Cohesion that is lost where joints open in part: formulas count it on the whole joint.

use std::collections::BTreeSet;
use std::path::Path;

use ndda_io::diagnostic::SceneErrors;
use ndda_io::scene::{Residual, Scene};
use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockId, BlockSet, TetId, TriangleId, Vec3};
use ndda_solver::Simulation;
use serde::{Deserialize, Serialize};

use crate::Model;
use crate::build::Choices;
use crate::joint::{self, Which};

/// Openings that lower the factor by less than this do not matter.
const LITTLE: f64 = 2e-3;

/// Cohesion that joints do not have because they have opened.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Opened {
    /// Names of the joints, sorted.
    pub joints: Vec<String>,
    /// Part of their area that is open.
    pub area_part: f64,
    /// Part by which a formula with cohesion everywhere gives a larger factor.
    pub lowers_by: f64,
    /// Whether all of them have a tensile strength that they keep while they slip, which was exceeded.
    pub has_tension: bool,
}

/// Cohesion that joints of blocks near failure have lost since the blocks were drawn, because they opened; none where it is little. Counted for joints that keep their
/// cohesion while they slip; others lose it anyway.
///
/// # Errors
/// [`SceneErrors`] if the simulation cannot be built anew.
pub fn of(standing: &Model, folder: &Path, moving: &[&str]) -> Result<Option<Opened>, SceneErrors> {
    let mut begun = Model::resuming_with(standing.loaded.clone(), folder, Choices::default())?.simulation;
    // Bonds form in the first step.
    let begins = begun.step().is_ok();
    Ok(begins.then(|| between(&standing.loaded.scene, &begun, &standing.simulation, moving)).flatten())
}

fn between(scene: &Scene, begun: &Simulation, standing: &Simulation, moving: &[&str]) -> Option<Opened> {
    let blocks = standing.blocks();
    let ids: Vec<BlockId> =
        blocks.ids().filter(|id| moving.contains(&blocks.names[id.index()].as_str())).collect();
    let holds = |facet: TriangleId, target: BlockId| {
        ids.contains(&blocks.triangle_block[facet.index()]) != ids.contains(&target)
    };
    let kept = |facet: TriangleId, target| kept(scene, blocks, facet).filter(|_| holds(facet, target));
    let (before, now) = (held(begun, &kept), held(standing, &kept));
    let rubs = standing.contacts().iter().filter(|contact| holds(contact.facet, contact.target));
    let friction_n: f64 = rubs.map(|contact| contact.friction_n.norm()).sum();
    let mut opened = Opened { joints: Vec::new(), area_part: 0.0, lowers_by: 0.0, has_tension: true };
    let (mut all_m2, mut open_m2) = (0.0, 0.0);
    for name in before.iter().map(|part| &part.joint).collect::<BTreeSet<_>>() {
        let sum = |parts: &[Part], of: fn(&Part) -> f64| -> f64 {
            parts.iter().filter(|part| part.joint == *name).map(of).sum()
        };
        let lost_n = sum(&before, |part| part.force_n) - sum(&now, |part| part.force_n);
        if lost_n > LITTLE * friction_n {
            opened.has_tension &= before.iter().all(|part| part.joint != *name || part.has_tension);
            opened.joints.push(name.clone());
            opened.lowers_by += lost_n / friction_n;
            all_m2 += sum(&before, |part| part.area_m2);
            open_m2 += sum(&before, |part| part.area_m2) - sum(&now, |part| part.area_m2);
        }
    }
    opened.area_part = open_m2 / all_m2;
    (!opened.joints.is_empty() && friction_n > 0.0).then_some(opened)
}

/// Cohesion on a part of a joint.
struct Part {
    joint: String,
    area_m2: f64,
    force_n: f64,
    has_tension: bool,
}

/// Where joints have cohesion: by bonds, and by facets in contact that have none.
fn held(simulation: &Simulation, kept: &dyn Fn(TriangleId, BlockId) -> Option<Residual>) -> Vec<Part> {
    let (blocks, history) = (simulation.blocks(), &simulation.state().contact);
    let target = |tet: TetId| blocks.tet_block[tet.index()];
    let bonded: BTreeSet<(TriangleId, BlockId)> =
        history.bonds.iter().map(|bond| (bond.facet, target(bond.tet))).collect();
    let corners = |facet: TriangleId| {
        blocks.triangles[facet.index()].map(|node| simulation.state().position[node.index()])
    };
    let bonds = history.bonds.iter().map(|bond| {
        let area_m2: Vec3 = triangle_area_vector(&corners(bond.facet));
        (bond.facet, target(bond.tet), (1.0 - bond.damage) * bond.share * area_m2.norm())
    });
    let facets = history.facets.iter().map(|facet| (facet.facet, facet.target, facet.area_m2));
    let facets = facets.filter(|(facet, target, _)| !bonded.contains(&(*facet, *target)));
    let part = |(facet, target, area_m2): (TriangleId, BlockId, f64)| {
        let kept = kept(facet, target)?;
        let surface = blocks.triangle_surface[facet.index()];
        let joint = surface.map_or(String::new(), |surface| blocks.surface_names[surface as usize].clone());
        // Both sides are in the list.
        Some(Part {
            joint,
            area_m2: 0.5 * area_m2,
            force_n: 0.5 * kept.cohesion_pa * area_m2,
            has_tension: kept.tension_pa > 0.0,
        })
    };
    bonds.chain(facets).filter_map(part).collect()
}

/// What the joint of a facet keeps while it slips, where that is cohesion.
fn kept(scene: &Scene, blocks: &BlockSet, facet: TriangleId) -> Option<Residual> {
    let named = blocks.triangle_surface[facet.index()].and_then(|surface| {
        let name = blocks.surface_names[surface as usize].clone();
        joint::friction(scene, &Which::Joint(name)).ok()
    });
    let law = named.or_else(|| joint::friction(scene, &Which::Everywhere).ok())?;
    law.residual.filter(|residual| residual.cohesion_pa > 0.0)
}
