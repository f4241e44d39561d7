//! Splits a mesh into bodies with nodes of their own, and physical groups into their node sets.

use std::collections::{BTreeMap, BTreeSet};

use ndda_mesh::BlockMesh;

use super::cursor::Fault;
use super::error::MshProblem;
use super::mesh::{Element, Group, Mesh, NO_GROUP};

/// Name of the body of a file without physical groups.
const ONLY_BODY: &str = "body";

/// One body: its name and tetrahedra, and the nodes that they use, by rising index.
struct Body {
    name: String,
    tets: Vec<[u32; 4]>,
    nodes: Vec<u32>,
}

/// Physical volumes as blocks, by rising tag.
pub(super) fn split(mesh: &Mesh) -> Result<Vec<(String, BlockMesh)>, Fault> {
    check_types(mesh)?;
    check_assigned(mesh)?;
    let bodies = bodies(mesh)?;
    check_apart(mesh, &bodies)?;
    let mut blocks: Vec<(String, BlockMesh)> =
        bodies.iter().map(|body| (body.name.clone(), block(mesh, body))).collect();
    for (body, name, nodes) in node_sets(mesh, &bodies)? {
        blocks[body].1.node_sets.insert(name, nodes);
    }
    Ok(blocks)
}

fn of_dim(mesh: &Mesh, dim: u8) -> impl Iterator<Item = &Element> {
    mesh.elements.iter().filter(move |element| element.group.0 == dim)
}

fn check_types(mesh: &Mesh) -> Result<(), MshProblem> {
    if !mesh.others.is_empty() {
        let types = mesh.others.iter().map(|(&name, &count)| (name, count)).collect();
        return Err(MshProblem::OtherElements(types));
    }
    if of_dim(mesh, 3).next().is_some() {
        return Ok(());
    }
    match of_dim(mesh, 2).count() {
        0 => Err(MshProblem::NoTetrahedra),
        triangles => Err(MshProblem::OnlySurface { triangles }),
    }
}

/// Either every tetrahedron is in a physical volume, or there are no physical groups.
fn check_assigned(mesh: &Mesh) -> Result<(), Fault> {
    let has_groups = !mesh.names.is_empty() || mesh.elements.iter().any(|e| e.group.1 != NO_GROUP);
    let mut unassigned = of_dim(mesh, 3).filter(|tet| tet.group.1 == NO_GROUP);
    match unassigned.next() {
        Some(first) if has_groups => {
            let count = 1 + unassigned.count();
            let tets = of_dim(mesh, 3).count();
            let problem = MshProblem::Unassigned { count, tets, first: first.tag }.into();
            Err(Fault { at: Some(first.at), problem })
        }
        _ => Ok(()),
    }
}

fn bodies(mesh: &Mesh) -> Result<Vec<Body>, Fault> {
    let mut tets_of: BTreeMap<Group, Vec<[u32; 4]>> = BTreeMap::new();
    for element in of_dim(mesh, 3) {
        tets_of.entry(element.group).or_default().push(indices(mesh, element)?);
    }
    let mut bodies = Vec::new();
    let mut names = BTreeSet::new();
    for (group, tets) in tets_of {
        let name = if group.1 == NO_GROUP { ONLY_BODY.to_string() } else { name_of(mesh, group) };
        if !names.insert(name.clone()) {
            return Err(MshProblem::SameName(name).into());
        }
        let mut nodes: Vec<u32> = tets.iter().flatten().copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        bodies.push(Body { name, tets, nodes });
    }
    Ok(bodies)
}

fn name_of(mesh: &Mesh, group: Group) -> String {
    let kind = ["point", "curve", "surface", "volume"][usize::from(group.0)];
    mesh.names.get(&group).cloned().unwrap_or_else(|| format!("{kind}_{}", group.1))
}

/// Indices of the element's nodes; entries that it does not use repeat its first.
fn indices(mesh: &Mesh, element: &Element) -> Result<[u32; 4], Fault> {
    let used = &element.nodes[..=usize::from(element.group.0)];
    let index = |node: u64| {
        let problem = MshProblem::NoSuchNode { element: element.tag, node }.into();
        mesh.node_of_tag.get(&node).copied().ok_or(Fault { at: Some(element.at), problem })
    };
    let mut indices = [index(used[0])?; 4];
    for (slot, &node) in indices.iter_mut().zip(used) {
        *slot = index(node)?;
    }
    Ok(indices)
}

/// No tetrahedron may be in two bodies: they would be in contact all through.
fn check_apart(mesh: &Mesh, bodies: &[Body]) -> Result<(), Fault> {
    let mut keys: Vec<([u32; 4], usize)> = Vec::new();
    for (id, body) in bodies.iter().enumerate() {
        keys.extend(body.tets.iter().map(|tet| (sorted(*tet), id)));
    }
    keys.sort_unstable();
    let shared: Vec<_> = keys.windows(2).filter(|w| w[0].0 == w[1].0 && w[0].1 != w[1].1).collect();
    let Some(first) = shared.first() else { return Ok(()) };
    for element in of_dim(mesh, 3) {
        if sorted(indices(mesh, element)?) == first[0].0 {
            let [a, b] = [first[0].1, first[1].1].map(|id| bodies[id].name.clone());
            let problem = MshProblem::InTwoBodies { count: shared.len(), element: element.tag, a, b }.into();
            return Err(Fault { at: Some(element.at), problem });
        }
    }
    unreachable!("the tetrahedron comes from the elements")
}

fn sorted(mut tet: [u32; 4]) -> [u32; 4] {
    tet.sort_unstable();
    tet
}

fn block(mesh: &Mesh, body: &Body) -> BlockMesh {
    let local = |node: u32| local(body, node).expect("a body has the nodes of its tetrahedra");
    BlockMesh {
        nodes: body.nodes.iter().map(|&node| mesh.nodes[node as usize]).collect(),
        tets: body.tets.iter().map(|tet| tet.map(local)).collect(),
        ..BlockMesh::default()
    }
}

/// Index of a node of the file in the body.
fn local(body: &Body, node: u32) -> Option<u32> {
    body.nodes.binary_search(&node).ok().map(|index| index as u32)
}

/// Body, name and nodes of each set. An element counts for a body if all its nodes are the body's, so that a
/// surface between two bodies is a set of both, and of no third body that it only touches along its rim.
fn node_sets(mesh: &Mesh, bodies: &[Body]) -> Result<Vec<(usize, String, Vec<u32>)>, Fault> {
    let mut owners: Vec<(u32, usize)> = Vec::new();
    for (id, body) in bodies.iter().enumerate() {
        owners.extend(body.nodes.iter().map(|&node| (node, id)));
    }
    owners.sort_unstable();
    let mut sets: BTreeMap<(Group, usize), Vec<u32>> = BTreeMap::new();
    for element in mesh.elements.iter().filter(|e| e.group.0 < 3 && e.group.1 != NO_GROUP) {
        let nodes = indices(mesh, element)?;
        let first_owner = owners.partition_point(|owner| owner.0 < nodes[0]);
        for &(_, id) in owners[first_owner..].iter().take_while(|owner| owner.0 == nodes[0]) {
            let all: Option<Vec<u32>> = nodes.iter().map(|&node| local(&bodies[id], node)).collect();
            sets.entry((element.group, id)).or_default().extend(all.into_iter().flatten());
        }
    }
    let groups: BTreeSet<Group> = sets.keys().map(|key| key.0).collect();
    let mut names = BTreeSet::new();
    if let Some(group) = groups.iter().find(|group| !names.insert(name_of(mesh, **group))) {
        return Err(MshProblem::SameName(name_of(mesh, *group)).into());
    }
    let named = sets.into_iter().filter(|(_, nodes)| !nodes.is_empty()).map(|((group, id), mut nodes)| {
        nodes.sort_unstable();
        nodes.dedup();
        (id, name_of(mesh, group), nodes)
    });
    Ok(named.collect())
}
