//! Errors of files of meshes or surfaces.

use std::fmt;
use std::path::{Path, PathBuf};

use super::msh::error::MshProblem;

/// Why a file of a mesh or a surface cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}{}: {problem}", path.display(), place.map(|p| p.to_string()).unwrap_or_default())]
pub struct MeshFileError {
    /// The file.
    pub path: PathBuf,
    /// Where in the file, if it is one place.
    pub place: Option<Place>,
    /// The problem.
    pub problem: FileProblem,
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Line of a text, from 1.
    Line(usize),
    /// Byte of a binary file, from 0.
    Byte(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, ":{line}"),
            Self::Byte(byte) => write!(f, ", byte {byte}"),
        }
    }
}

/// One defect of a file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FileProblem {
    /// The operating system does not let the file be read.
    #[error("cannot be read: {0}")]
    Unreadable(String),
    /// A folder or a device.
    #[error("is not a file: name the file itself")]
    NotAFile,
    /// An ending that says no format that is read here.
    #[error("`.{found}` is not a format that is read here: give one of {known}")]
    Extension {
        /// The ending.
        found: String,
        /// The endings that are read.
        known: &'static str,
    },
    /// The file ends too early.
    #[error("the file ends where {0} was expected: it is truncated, save it again")]
    Truncated(String),
    /// A header without a line that it needs.
    #[error("the header has no line `{0}`: write it, or save the grid again as an ESRI ASCII grid")]
    NoHeaderLine(&'static str),
    /// Something else than expected.
    #[error("expected {expected}, found `{found}`")]
    Unexpected {
        /// Item that the format requires here.
        expected: String,
        /// Item that was found.
        found: String,
    },
    /// A header promises more than the file can hold.
    #[error(
        "promises {count} {what}, more than the file can hold: it is truncated or damaged, save it again"
    )]
    TooShort {
        /// Item that is announced.
        what: &'static str,
        /// How many.
        count: u64,
    },
    /// Lists that should have one length have two.
    #[error("{what}: {found} where {needed} are needed; the file is damaged, save it again")]
    Count {
        /// Which list.
        what: String,
        /// Entries found.
        found: usize,
        /// Entries needed.
        needed: usize,
    },
    /// More nodes than 32-bit indices can hold.
    #[error("more nodes than 32-bit indices hold: mesh more coarsely")]
    TooManyNodes,
    /// Something with a number that something else has.
    #[error("{what} {id} is there twice: remove one")]
    Twice {
        /// Name of the item.
        what: &'static str,
        /// Its number.
        id: u64,
    },
    /// A cell with a node that is not in the file.
    #[error("{what} has node {node}, which is not in the file: save the whole mesh again")]
    NoSuchNode {
        /// The cell.
        what: String,
        /// The node.
        node: i64,
    },
    /// A part of the format that is not read.
    #[error("{what} is not supported: {cure}")]
    NotRead {
        /// Name of the item.
        what: String,
        /// Remedy.
        cure: &'static str,
    },
    /// No tetrahedra.
    #[error("holds no tetrahedra: mesh the volume and save it with its cells")]
    NoTetrahedra,
    /// Tetrahedra of no body in a file with bodies.
    #[error(
        "{count} of {tets} tetrahedra are in no {kind}: put every tetrahedron in one, or save without any"
    )]
    Unassigned {
        /// How many.
        count: usize,
        /// Of how many.
        tets: usize,
        /// The format's word for a body.
        kind: &'static str,
    },
    /// A tetrahedron of two bodies.
    #[error(
        "tetrahedron {element} is in the sets `{a}` and `{b}`: put it in one only, or name the bodies by sections"
    )]
    InTwoBodies {
        /// Its number.
        element: u64,
        /// One body.
        a: String,
        /// The other.
        b: String,
    },
    /// A surface without faces.
    #[error("holds no faces: save a surface of triangles or polygons")]
    NoFaces,
    /// A surface with edges of one face only, or of faces that disagree.
    #[error("the surface is not closed: {count} edges have a face on one side only, or two that face opposite ways, the first {edges}; \
             close the holes, and turn all faces outward{}", if *count > 4 { ", or weld at a larger tolerance" } else { "" })]
    Open {
        /// How many edges.
        count: usize,
        /// The first of them, by their ends [unit of the file].
        edges: String,
    },
    /// Another program was needed and did not do its work.
    #[error("{0}")]
    Program(String),
    /// Something that only Gmsh's meshes can have.
    #[error(transparent)]
    Msh(#[from] MshProblem),
}

/// A problem and the line where it is.
#[derive(Debug)]
pub(crate) struct Fault {
    /// Line from 1, if it is one line.
    pub line: Option<usize>,
    /// The problem.
    pub problem: FileProblem,
}

impl Fault {
    /// `problem` in `line`.
    pub(crate) fn at(line: usize, problem: FileProblem) -> Self {
        Self { line: Some(line), problem }
    }

    /// Something else than `expected` in `line`.
    pub(crate) fn unexpected(line: usize, expected: impl Into<String>, found: &[u8]) -> Self {
        Self::at(line, FileProblem::Unexpected { expected: expected.into(), found: excerpt(found) })
    }

    /// The file ends before `what`.
    pub(crate) fn truncated(what: impl Into<String>) -> Self {
        FileProblem::Truncated(what.into()).into()
    }

    /// With the file that it is in.
    pub(crate) fn of(self, path: &Path) -> MeshFileError {
        MeshFileError { path: path.to_owned(), place: self.line.map(Place::Line), problem: self.problem }
    }
}

impl From<FileProblem> for Fault {
    fn from(problem: FileProblem) -> Self {
        Self { line: None, problem }
    }
}

/// The bytes of the file at `path`.
pub(crate) fn bytes_of(path: &Path) -> Result<Vec<u8>, MeshFileError> {
    let unreadable = |error: std::io::Error| Fault::from(FileProblem::Unreadable(error.to_string())).of(path);
    // A folder or a device may have no end.
    if !std::fs::metadata(path).map_err(unreadable)?.is_file() {
        return Err(Fault::from(FileProblem::NotAFile).of(path));
    }
    std::fs::read(path).map_err(unreadable)
}

/// The ending of a path, in small letters.
pub(crate) fn ending(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default()
}

/// The start of what was found, printable.
pub(crate) fn excerpt(found: &[u8]) -> String {
    let clean = |c: char| if c.is_control() { '\u{FFFD}' } else { c };
    let head = String::from_utf8_lossy(&found[..found.len().min(160)]);
    let text: String = head.chars().map(clean).take(40).collect();
    if text.len() < found.len() { text + "…" } else { text }
}
