//! The mesh that both versions of the format are read into.

use std::collections::{BTreeMap, HashMap};

use ndda_mesh::Vec3;

use super::cursor::{Cursor, Fault};
use super::error::MshProblem;
use crate::mesh::error::FileProblem;

/// A physical group: its dimension and its tag.
pub(super) type Group = (u8, u32);

/// Tag of the elements that are in no physical group.
pub(super) const NO_GROUP: u32 = 0;

/// A point, line, triangle or tetrahedron of first order.
pub(super) struct Element {
    pub tag: u64,
    /// Dimension, and tag of its physical group or [`NO_GROUP`].
    pub group: Group,
    /// Byte in the file.
    pub at: usize,
    /// Tags of its nodes, one more than its dimension.
    pub nodes: [u64; 4],
}

/// Nodes, elements and names as they are in the file.
#[derive(Default)]
pub(super) struct Mesh {
    pub nodes: Vec<Vec3>,
    /// Index in `nodes` of each node tag.
    pub node_of_tag: HashMap<u64, u32>,
    /// One entry per physical group that an element is in.
    pub elements: Vec<Element>,
    /// How many elements of other types there are.
    pub others: BTreeMap<&'static str, usize>,
    pub names: BTreeMap<Group, String>,
}

impl Mesh {
    /// Adds a node that `cursor` has just read; its coordinates must be finite.
    pub(crate) fn add_node(&mut self, cursor: &Cursor, tag: u64, at: Vec3) -> Result<(), Fault> {
        let Ok(index) = u32::try_from(self.nodes.len()) else {
            return Err(cursor.fault(MshProblem::TooManyNodes(self.nodes.len() + 1)));
        };
        if self.node_of_tag.insert(tag, index).is_some() {
            return Err(cursor.fault(FileProblem::Twice { what: "node", id: tag }));
        }
        self.nodes.push(at);
        Ok(())
    }

    /// Adds an element that `cursor` has just read, once per group; types that are not computed with are counted.
    pub(crate) fn add_element(&mut self, kind: &Kind, tag: u64, at: usize, groups: &[u32], nodes: &[u64]) {
        if !kind.is_linear_simplex() {
            *self.others.entry(kind.name).or_default() += 1;
            return;
        }
        let mut corners = [0; 4];
        corners[..nodes.len()].copy_from_slice(nodes);
        for &group in if groups.is_empty() { &[NO_GROUP] } else { groups } {
            self.elements.push(Element { tag, group: (kind.dim, group), at, nodes: corners });
        }
    }
}

/// One of Gmsh's element types.
pub(super) struct Kind {
    id: i32,
    /// Dimension.
    pub dim: u8,
    /// Number of nodes.
    pub nodes: usize,
    /// Name for messages.
    pub name: &'static str,
}

impl Kind {
    /// The most nodes of any type.
    pub(crate) const MOST_NODES: usize = 125;

    /// The type with that number.
    pub(crate) fn find(id: i32) -> Option<&'static Self> {
        KINDS.iter().find(|kind| kind.id == id)
    }

    fn is_linear_simplex(&self) -> bool {
        matches!(self.id, 1 | 2 | 4 | 15)
    }
}

const fn kind(id: i32, dim: u8, nodes: usize, name: &'static str) -> Kind {
    Kind { id, dim, nodes, name }
}

/// Element types by number, from Gmsh's reference manual.
const KINDS: [Kind; 33] = [
    kind(4, 3, 4, "tetrahedron"),
    kind(2, 2, 3, "triangle"),
    kind(1, 1, 2, "line"),
    kind(15, 0, 1, "point"),
    kind(3, 2, 4, "quadrangle"),
    kind(5, 3, 8, "hexahedron"),
    kind(6, 3, 6, "prism"),
    kind(7, 3, 5, "pyramid"),
    kind(8, 1, 3, "3-node line"),
    kind(9, 2, 6, "6-node triangle"),
    kind(10, 2, 9, "9-node quadrangle"),
    kind(11, 3, 10, "10-node tetrahedron"),
    kind(12, 3, 27, "27-node hexahedron"),
    kind(13, 3, 18, "18-node prism"),
    kind(14, 3, 14, "14-node pyramid"),
    kind(16, 2, 8, "8-node quadrangle"),
    kind(17, 3, 20, "20-node hexahedron"),
    kind(18, 3, 15, "15-node prism"),
    kind(19, 3, 13, "13-node pyramid"),
    kind(20, 2, 9, "9-node triangle"),
    kind(21, 2, 10, "10-node triangle"),
    kind(22, 2, 12, "12-node triangle"),
    kind(23, 2, 15, "15-node triangle"),
    kind(24, 2, 15, "15-node triangle"),
    kind(25, 2, 21, "21-node triangle"),
    kind(26, 1, 4, "4-node line"),
    kind(27, 1, 5, "5-node line"),
    kind(28, 1, 6, "6-node line"),
    kind(29, 3, 20, "20-node tetrahedron"),
    kind(30, 3, 35, "35-node tetrahedron"),
    kind(31, 3, 56, "56-node tetrahedron"),
    kind(92, 3, 64, "64-node hexahedron"),
    kind(93, 3, 125, "125-node hexahedron"),
];

/// Three finite coordinates.
pub(super) fn point(cursor: &mut Cursor) -> Result<Vec3, Fault> {
    let mut point = Vec3::zeros();
    for axis in 0..3 {
        point[axis] = cursor.real("a coordinate")?;
        if !point[axis].is_finite() {
            let found = point[axis].to_string();
            return Err(
                cursor.fault(FileProblem::Unexpected { expected: "a finite coordinate".into(), found })
            );
        }
    }
    Ok(point)
}

/// The number of an element type.
pub(super) fn element_kind(cursor: &mut Cursor) -> Result<&'static Kind, Fault> {
    let id = cursor.int("an element type")?;
    Kind::find(id).ok_or_else(|| cursor.fault(MshProblem::ElementType(id)))
}
