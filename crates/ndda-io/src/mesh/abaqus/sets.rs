//! Which sets are bodies and which are node sets.

use super::Model;
use crate::mesh::FileProblem;
use crate::mesh::error::Fault;
use crate::mesh::parts::Parts;

/// A tetrahedron of no body yet.
const NONE: u32 = u32::MAX;

/// The model with its sets resolved.
pub(super) fn parts(model: Model) -> Result<Parts, Fault> {
    let mut parts = Parts::default();
    for (name, labels) in &model.node_sets {
        let indices = labels.iter().map(|label| model.node_of_label.get(label).copied().ok_or(label));
        let items: Result<Vec<_>, _> = indices.map(|index| index.map(|i| [i; 4])).collect();
        let missing =
            |label: &u64| FileProblem::NoSuchNode { what: format!("set `{name}`"), node: *label as i64 };
        parts.sets.insert(name.clone(), items.map_err(missing)?);
    }
    for (name, labels) in &model.element_sets {
        let facets: Vec<_> = labels.iter().filter_map(|label| model.facets.get(label).copied()).collect();
        if !facets.is_empty() {
            parts.sets.entry(name.clone()).or_default().extend(facets);
        }
    }
    (parts.names, parts.body) = bodies(&model)?;
    parts.nodes = model.nodes;
    parts.tets = model.tets;
    Ok(parts)
}

/// Names of the bodies, and the body of each tetrahedron.
fn bodies(model: &Model) -> Result<(Vec<String>, Vec<u32>), Fault> {
    let candidates = candidates(model);
    if candidates.is_empty() {
        return Ok((Vec::new(), Vec::new()));
    }
    let mut body = vec![NONE; model.tets.len()];
    for (id, (name, tets)) in (0..).zip(&candidates) {
        for &(label, tet) in tets {
            let slot = &mut body[tet as usize];
            if *slot != NONE && *slot != id {
                let a = candidates[*slot as usize].0.clone();
                return Err(FileProblem::InTwoBodies { element: label, a, b: name.clone() }.into());
            }
            *slot = id;
        }
    }
    match body.iter().filter(|&&id| id == NONE).count() {
        0 => Ok((candidates.into_iter().map(|(name, _)| name).collect(), body)),
        count => {
            let kind = if model.sections.is_empty() { "ELSET" } else { "ELSET of a *SOLID SECTION" };
            Err(FileProblem::Unassigned { count, tets: body.len(), kind }.into())
        }
    }
}

/// Name, and labels and indices of the tetrahedra.
type Candidate = (String, Vec<(u64, u32)>);

/// Sets that are bodies, in the order of their first tetrahedra.
fn candidates(model: &Model) -> Vec<Candidate> {
    let is_section = |name: &String| model.sections.is_empty() || model.sections.contains(name);
    let tets = |labels: &[u64]| {
        let mut tets: Vec<(u64, u32)> =
            labels.iter().filter_map(|label| Some((*label, *model.tet_of_label.get(label)?))).collect();
        tets.sort_unstable_by_key(|tet| tet.1);
        tets.dedup();
        tets
    };
    let sets = model.element_sets.iter().filter(|(name, _)| is_section(name));
    let mut candidates: Vec<Candidate> = sets.map(|(name, labels)| (name.clone(), tets(labels))).collect();
    candidates.retain(|(_, tets)| !tets.is_empty());
    candidates.sort_by_key(|(_, tets)| tets[0].1);
    let holds_all = |(_, tets): &Candidate| tets.len() == model.tets.len();
    if !candidates.iter().all(holds_all) {
        candidates.retain(|candidate| !holds_all(candidate));
    }
    candidates
}
