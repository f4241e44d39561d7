//! The words for what is wrong.

use std::fmt::Write;

/// Number of faulty items that a problem lists.
const LISTED: usize = 10;

/// Number of faulty items, and the first ten of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Found<T> {
    /// How many in all.
    pub count: usize,
    /// The first ten.
    pub first: Vec<T>,
}

impl<T> Default for Found<T> {
    fn default() -> Self {
        Self { count: 0, first: Vec::new() }
    }
}

impl<T> Found<T> {
    /// Whether nothing was found.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    pub(super) fn add(&mut self, culprit: T) {
        self.count += 1;
        if self.first.len() < LISTED {
            self.first.push(culprit);
        }
    }

    /// "(3): a, b, c" or "(25): a, …, j and 15 more".
    fn list(&self, show: impl Fn(&T) -> String) -> String {
        let mut text =
            format!("({}): {}", self.count, self.first.iter().map(show).collect::<Vec<_>>().join(", "));
        if self.count > self.first.len() {
            let _ = write!(text, " and {} more", self.count - self.first.len());
        }
        text
    }
}

impl<T> FromIterator<T> for Found<T> {
    fn from_iter<I: IntoIterator<Item = T>>(culprits: I) -> Self {
        let mut found = Self::default();
        culprits.into_iter().for_each(|culprit| found.add(culprit));
        found
    }
}

/// One kind of defect in one block. Ids count from 0 within the block.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshProblem {
    /// The block has no tetrahedra.
    #[error("no tetrahedra ({nodes} nodes): mesh the volume, not only its surface")]
    Empty {
        /// Nodes of the block.
        nodes: usize,
    },
    /// More than 32-bit indices can hold.
    #[error("{nodes} nodes and {tets} tetrahedra are more than 32-bit indices hold: mesh more coarsely")]
    TooLarge {
        /// Nodes of the block.
        nodes: usize,
        /// Tetrahedra of the block.
        tets: usize,
    },
    /// Nodes with a coordinate that is infinite or not a number.
    #[error("nodes with a coordinate that is not finite {}: correct them", .0.list(u32::to_string))]
    NotFinite(Found<u32>),
    /// Tetrahedra and the first node of each that does not exist.
    #[error(
        "tetrahedra with a node that does not exist (nodes go from 0 to {}) {}: correct the list of tetrahedra",
        i64::from(*.node_count) - 1, .tets.list(|(tet, node)| format!("{tet} (node {node})"))
    )]
    NoSuchNode {
        /// Tetrahedron and node.
        tets: Found<(u32, u32)>,
        /// Nodes of the block.
        node_count: u32,
    },
    /// A node set with nodes that do not exist.
    #[error(
        "node set \"{set}\" with nodes that do not exist (nodes go from 0 to {}) {}: correct the set",
        i64::from(*.node_count) - 1, .nodes.list(u32::to_string)
    )]
    SetOutOfRange {
        /// Name of the set.
        set: String,
        /// The nodes.
        nodes: Found<u32>,
        /// Nodes of the block.
        node_count: u32,
    },
    /// Tetrahedra that name a node more than once.
    #[error("tetrahedra that name a node twice {}: remove them", .0.list(u32::to_string))]
    RepeatedNode(Found<u32>),
    /// Tetrahedra of negative volume, with it [m³].
    #[error("inverted tetrahedra {}: swap two nodes of each, as `ndda mesh FILE --fix orient` does", .0.list(with_volume))]
    Inverted(Found<(u32, f64)>),
    /// Tetrahedra whose volume [m³] is lost in rounding.
    #[error("flat tetrahedra {}: remesh there, or move a node off the plane of the others", .0.list(with_volume))]
    Flat(Found<(u32, f64)>),
    /// Nodes at the same place.
    #[error("pairs of nodes within {tolerance_m:e} m of each other {}: merge them", .pairs.list(pair))]
    Coincident {
        /// The first node there and a later one.
        pairs: Found<(u32, u32)>,
        /// Distance below which two places are the same [m].
        tolerance_m: f64,
    },
    /// Nodes that belong to no tetrahedron.
    #[error("nodes that belong to no tetrahedron {}: remove them", .0.list(u32::to_string))]
    Orphans(Found<u32>),
    /// Tetrahedra with the same four nodes as an earlier one.
    #[error("pairs of tetrahedra with the same nodes {}: remove one of each", .0.list(pair))]
    DuplicateTets(Found<(u32, u32)>),
    /// Faces of more than two tetrahedra.
    #[error("faces of more than two tetrahedra, as nodes {}: tetrahedra overlap there; remesh", .0.list(face))]
    CrowdedFaces(Found<[u32; 3]>),
    /// Faces whose two tetrahedra lie on the same side.
    #[error("faces with both tetrahedra on the same side, as nodes {}: tetrahedra overlap there; remesh", .0.list(face))]
    Folded(Found<[u32; 3]>),
    /// Surface edges that are not between exactly two boundary triangles.
    #[error(
        "surface edges that are not between two triangles, as nodes {}: \
         the block touches itself there; split it into two blocks or join the parts by a face",
        .0.list(|(edge, triangles)| format!("{}-{} ({triangles} triangles)", edge[0], edge[1]))
    )]
    OpenEdges(Found<([u32; 2], usize)>),
    /// The tetrahedra fall into parts that share no face.
    #[error(
        "{parts} parts that share no face, of {} tetrahedra: make each part a block of its own",
        .tets.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")
    )]
    Parts {
        /// How many parts.
        parts: usize,
        /// Tetrahedra of the ten largest, falling.
        tets: Vec<usize>,
    },
}

fn with_volume((tet, volume_m3): &(u32, f64)) -> String {
    format!("{tet} ({volume_m3:.3e} m³)")
}

fn pair((a, b): &(u32, u32)) -> String {
    format!("{a} and {b}")
}

fn face([a, b, c]: &[u32; 3]) -> String {
    format!("{a}-{b}-{c}")
}

/// Everything that is wrong with the blocks of a scene.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}", all(.problems))]
pub struct MeshError {
    /// Name of the block and what is wrong with it.
    pub problems: Vec<(String, MeshProblem)>,
}

fn all(problems: &[(String, MeshProblem)]) -> String {
    let lines: Vec<_> =
        problems.iter().map(|(block, problem)| format!("block \"{block}\": {problem}")).collect();
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ten_culprits_are_named_and_the_rest_counted() {
        let problem = MeshProblem::Orphans((0..12).collect());
        assert_eq!(
            problem.to_string(),
            "nodes that belong to no tetrahedron (12): 0, 1, 2, 3, 4, 5, 6, 7, 8, 9 and 2 more: remove them"
        );
    }

    #[test]
    fn the_error_prints_every_problem_with_its_block() {
        let inverted = MeshProblem::Inverted([(4, -0.125)].into_iter().collect());
        let error = MeshError {
            problems: vec![("ramp".into(), inverted), ("b".into(), MeshProblem::Empty { nodes: 0 })],
        };
        assert_eq!(
            error.to_string(),
            "block \"ramp\": inverted tetrahedra (1): 4 (-1.250e-1 m³): swap two nodes of each, as `ndda mesh FILE --fix orient` does\n\
             block \"b\": no tetrahedra (0 nodes): mesh the volume, not only its surface"
        );
    }
}
