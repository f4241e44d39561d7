//! `$Entities`, `$Nodes` and `$Elements` of format 4.1.
//!
//! Read here and not through the crate `mshio` 0.4, because that forgets the tags of nodes unless they have gaps,
//! so that nodes out of order give a wrong shape without a word, and because it panics on an empty section.

use std::collections::HashMap;

use super::cursor::{Cursor, Fault};
use super::error::MshProblem;
use super::mesh::{Kind, Mesh, element_kind, point};

/// Physical groups of each geometric entity, by its dimension and tag.
pub(super) type EntityGroups = HashMap<(i32, i32), Vec<u32>>;

/// Points, curves, surfaces, volumes: `tag`, place or bounding box, physical groups, bounding entities.
pub(super) fn entities(cursor: &mut Cursor) -> Result<EntityGroups, Fault> {
    let mut counts = [0; 4];
    for count in &mut counts {
        let promised = cursor.size("the number of entities")?;
        *count = cursor.fitting("entities", promised, 10, 36)?;
    }
    let mut groups = EntityGroups::new();
    for (dim, count) in (0..).zip(counts) {
        for _ in 0..count {
            let tag = cursor.int("the tag of an entity")?;
            for _ in 0..if dim == 0 { 3 } else { 6 } {
                cursor.real("a coordinate of an entity")?;
            }
            let physical = ints(cursor, "physical groups")?;
            groups.insert((dim, tag), physical.into_iter().map(i32::unsigned_abs).collect());
            if dim > 0 {
                ints(cursor, "bounding entities")?;
            }
        }
    }
    Ok(groups)
}

/// A counted list.
fn ints(cursor: &mut Cursor, what: &'static str) -> Result<Vec<i32>, Fault> {
    let count = cursor.size(what)?;
    (0..cursor.fitting(what, count, 2, 4)?).map(|_| cursor.int(what)).collect()
}

/// Blocks of `entity-dimension entity-tag parametric count`, all tags, then all coordinates.
pub(super) fn nodes(cursor: &mut Cursor, mesh: &mut Mesh) -> Result<(), Fault> {
    let (blocks, promised) = header(cursor, "node blocks")?;
    let total = cursor.fitting("nodes", promised, 8, 32)?;
    mesh.nodes.reserve(total);
    mesh.node_of_tag.reserve(total);
    let mut held = 0;
    for _ in 0..blocks {
        let dim = cursor.int("the dimension of an entity")?;
        cursor.int("the tag of an entity")?;
        let is_parametric = cursor.int("the parametric flag")? != 0;
        let count = cursor.size("the number of nodes in a block")?;
        let count = cursor.fitting("nodes", count, 8, 32)?;
        let tags: Vec<u64> =
            (0..count).map(|_| cursor.size("the tag of a node")).collect::<Result<_, _>>()?;
        for tag in tags {
            let at = point(cursor)?;
            mesh.add_node(cursor, tag, at)?;
            for _ in 0..if is_parametric { dim } else { 0 } {
                cursor.real("a parametric coordinate")?;
            }
        }
        held += count as u64;
    }
    check_sum(cursor, "nodes", promised, held)
}

/// Blocks of `entity-dimension entity-tag type count`, then `tag nodes…` per element.
pub(super) fn elements(cursor: &mut Cursor, groups: &EntityGroups, mesh: &mut Mesh) -> Result<(), Fault> {
    let (blocks, promised) = header(cursor, "element blocks")?;
    cursor.fitting("elements", promised, 4, 16)?;
    let mut held = 0;
    for _ in 0..blocks {
        let dim = cursor.int("the dimension of an entity")?;
        let entity = cursor.int("the tag of an entity")?;
        let kind = element_kind(cursor)?;
        let count = cursor.size("the number of elements in a block")?;
        let count = cursor.fitting("elements", count, 4, 16)?;
        let groups = groups.get(&(dim, entity)).map_or(&[][..], Vec::as_slice);
        for _ in 0..count {
            let tag = cursor.size("the tag of an element")?;
            let at = cursor.start();
            let mut nodes = [0; Kind::MOST_NODES];
            for node in &mut nodes[..kind.nodes] {
                *node = cursor.size("the tag of a node")?;
            }
            mesh.add_element(kind, tag, at, groups, &nodes[..kind.nodes]);
        }
        held += count as u64;
    }
    check_sum(cursor, "elements", promised, held)
}

/// Numbers of blocks and of items, and the range of tags, which is not needed.
fn header(cursor: &mut Cursor, what: &'static str) -> Result<(usize, u64), Fault> {
    let blocks = cursor.size(what)?;
    let blocks = cursor.fitting(what, blocks, 8, 20)?;
    let items = cursor.size("the number of items")?;
    cursor.size("the smallest tag")?;
    cursor.size("the largest tag")?;
    Ok((blocks, items))
}

fn check_sum(cursor: &Cursor, what: &'static str, promised: u64, held: u64) -> Result<(), Fault> {
    if held == promised { Ok(()) } else { Err(cursor.fault(MshProblem::Sum { what, promised, held })) }
}
