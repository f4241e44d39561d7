//! `$Nodes` and `$Elements` of format 2.2. Counts are text even in binary files.

use super::cursor::{Cursor, Fault};
use super::error::MshProblem;
use super::mesh::{Kind, Mesh, NO_GROUP, element_kind, point};
use crate::mesh::error::FileProblem;

/// `tag x y z` per node.
pub(super) fn nodes(cursor: &mut Cursor, mesh: &mut Mesh) -> Result<(), Fault> {
    let count: u64 = count(cursor, "the number of nodes")?;
    let count = cursor.fitting("nodes", count, 8, 28)?;
    mesh.nodes.reserve(count);
    mesh.node_of_tag.reserve(count);
    for _ in 0..count {
        let tag = tag(cursor, "the tag of a node")?;
        let at = point(cursor)?;
        mesh.add_node(cursor, tag, at)?;
    }
    Ok(())
}

/// Text: `tag type tag-count tags… nodes…` per element. Binary: `type count tag-count` before runs of
/// `tag tags… nodes…`. The first tag is the physical group, 0 for none.
pub(super) fn elements(cursor: &mut Cursor, mesh: &mut Mesh) -> Result<(), Fault> {
    let promised: u64 = count(cursor, "the number of elements")?;
    cursor.fitting("elements", promised, 6, 8)?;
    let mut held = 0;
    while held < promised {
        if cursor.is_binary() {
            let kind = element_kind(cursor)?;
            let run = natural(cursor, "the number of elements in a run")?;
            let tags = natural(cursor, "the number of tags")?;
            let run = cursor.fitting("elements", run, 0, 4)?;
            for _ in 0..run {
                let tag = tag(cursor, "the tag of an element")?;
                element(cursor, mesh, kind, tag, tags)?;
            }
            held += run as u64;
        } else {
            let tag = tag(cursor, "the tag of an element")?;
            let kind = element_kind(cursor)?;
            let tags = natural(cursor, "the number of tags")?;
            element(cursor, mesh, kind, tag, tags)?;
            held += 1;
        }
    }
    if held != promised {
        return Err(cursor.fault(MshProblem::Sum { what: "elements", promised, held }));
    }
    Ok(())
}

fn element(cursor: &mut Cursor, mesh: &mut Mesh, kind: &Kind, tag: u64, tags: u64) -> Result<(), Fault> {
    let at = cursor.start();
    let mut group = NO_GROUP;
    for i in 0..tags {
        let value = cursor.int("a tag of an element")?;
        if i == 0 {
            group = value.unsigned_abs();
        }
    }
    let mut nodes = [0; Kind::MOST_NODES];
    for node in &mut nodes[..kind.nodes] {
        *node = natural(cursor, "the tag of a node")?;
    }
    mesh.add_element(kind, tag, at, &[group], &nodes[..kind.nodes]);
    Ok(())
}

fn count(cursor: &mut Cursor, expected: &str) -> Result<u64, Fault> {
    let count = cursor.text(expected)?;
    if cursor.is_binary() {
        cursor.rest_of_line();
    }
    Ok(count)
}

/// An `int` that is a tag; 2.2 has no larger type.
fn tag(cursor: &mut Cursor, expected: &str) -> Result<u64, Fault> {
    natural(cursor, expected)
}

fn natural(cursor: &mut Cursor, expected: &str) -> Result<u64, Fault> {
    let value = cursor.int(expected)?;
    u64::try_from(value).map_err(|_| {
        let expected = format!("{expected}, not negative");
        cursor.fault(FileProblem::Unexpected { expected, found: value.to_string() })
    })
}
