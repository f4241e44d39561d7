//! Errors of `.msh` files.

/// A defect that only a `.msh` file can have.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MshProblem {
    /// The file is empty.
    #[error("is empty: save the mesh again")]
    Empty,
    /// Does not begin as a `.msh` file.
    #[error("is not a Gmsh mesh: expected `$MeshFormat`, found `{0}`")]
    NotMsh(String),
    /// A version of the format that is not read.
    #[error(
        "is in format {0}; formats 2.2 and 4.1 are read: save it with `gmsh old.msh -save -format msh41 -o new.msh`"
    )]
    Version(String),
    /// Neither ASCII (0) nor binary (1).
    #[error("file type is {0}: expected 0 (ASCII) or 1 (binary)")]
    FileType(i64),
    /// Numbers of another size than on 64-bit machines.
    #[error("data size is {0} bytes; only 8 is read: save it with a 64-bit Gmsh")]
    DataSize(i64),
    /// The number 1 that gives the byte order is not there.
    #[error("byte order mark is {0:#010x}: expected 1 in either byte order")]
    ByteOrder(u32),
    /// A header promises more than the rest of the file can hold.
    #[error(
        "promises {count} {what}, but only {bytes} bytes follow: the file is truncated or damaged, save it again"
    )]
    TooShort {
        /// Item that is announced.
        what: &'static str,
        /// How many.
        count: u64,
        /// Rest of the file [bytes].
        bytes: usize,
    },
    /// The blocks of a section do not add up to its header.
    #[error(
        "the section promises {promised} {what}, its blocks hold {held}: the file is damaged, save it again"
    )]
    Sum {
        /// Item that is counted.
        what: &'static str,
        /// By the header.
        promised: u64,
        /// By the blocks.
        held: u64,
    },
    /// More nodes than 32-bit indices can hold.
    #[error("{0} nodes are more than 32-bit indices hold: mesh more coarsely")]
    TooManyNodes(usize),
    /// An element with a node that is not in the file.
    #[error("element {element} has node {node}, which is not in $Nodes: save the whole mesh again")]
    NoSuchNode {
        /// Tag of the element.
        element: u64,
        /// Tag of the node.
        node: u64,
    },
    /// An element type that Gmsh does not document.
    #[error("element type {0} is unknown: mesh with tetrahedra of first order")]
    ElementType(i32),
    /// Elements that are not points, lines, triangles or tetrahedra of first order, by type.
    #[error("holds elements other than tetrahedra of first order ({}): {}", counted(.0), cure(.0))]
    OtherElements(Vec<(&'static str, usize)>),
    /// No tetrahedra, only a surface.
    #[error(
        "holds {triangles} triangles but no tetrahedra: mesh the volume (`gmsh -3`) and, \
         if there are physical groups, put it in a Physical Volume"
    )]
    OnlySurface {
        /// How many triangles.
        triangles: usize,
    },
    /// Not even triangles.
    #[error("holds no tetrahedra: mesh the volume (`gmsh -3`)")]
    NoTetrahedra,
    /// Tetrahedra outside of all physical volumes in a file with physical groups.
    #[error(
        "{count} of {tets} tetrahedra are in no physical volume, the first being element {first}: \
         put every volume in a Physical Volume, or save without any group"
    )]
    Unassigned {
        /// How many.
        count: usize,
        /// Of how many.
        tets: usize,
        /// Tag of the first.
        first: u64,
    },
    /// Tetrahedra in two bodies.
    #[error(
        "{count} tetrahedra are in two bodies, the first being element {element} in \"{a}\" and \"{b}\": \
         put each volume in one Physical Volume only"
    )]
    InTwoBodies {
        /// How many.
        count: usize,
        /// Tag of the first.
        element: u64,
        /// One body.
        a: String,
        /// The other.
        b: String,
    },
    /// Two physical groups with one name.
    #[error("two physical groups would both be called \"{0}\": rename one")]
    SameName(String),
}

fn counted(types: &[(&'static str, usize)]) -> String {
    types.iter().map(|(name, count)| format!("{count} × {name}")).collect::<Vec<_>>().join(", ")
}

fn cure(types: &[(&'static str, usize)]) -> &'static str {
    if types.iter().any(|(name, _)| name.contains("node")) {
        "mesh with `-order 1` and without recombining"
    } else {
        "mesh without recombining or transfinite volumes of bricks"
    }
}
