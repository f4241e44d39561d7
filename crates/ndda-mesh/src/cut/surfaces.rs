//! The surfaces that cut rock, and who meets whom across them.

use super::plane::Plane;

/// Kind of surface that made a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SurfaceKind {
    /// A face of the domain. Where blocks meet across it (a concave domain in convex parts), they are glued.
    Domain,
    /// Plane `number` of discontinuity `joint`, both counted from 0.
    Joint {
        /// Index in the list of discontinuities.
        joint: u32,
        /// Number of the plane in its set, rising along the normal; 0 for a single plane or disc.
        number: u32,
    },
    /// The border of two Voronoi cells.
    Cell,
}

/// The plane behind faces of blocks, and what it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Its plane.
    pub plane: Plane,
    /// Kind of the surface.
    pub kind: SurfaceKind,
    /// Index of its name in [`Blocks::names`](super::Blocks::names).
    pub name: u32,
}

/// Two faces that meet over an area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbour {
    /// The block below the surface, and the one above.
    pub blocks: [u32; 2],
    /// Their faces.
    pub faces: [u32; 2],
    /// The surface between them.
    pub surface: u32,
    /// Area over which they meet [m²].
    pub area_m2: f64,
    /// Whether the two are parts of one rock: they meet across a face of the domain, not of a joint.
    pub glued: bool,
}

/// Index of a name, added if it is new.
pub(super) fn index_of(names: &mut Vec<String>, name: &str) -> u32 {
    let known = names.iter().position(|n| n == name).unwrap_or_else(|| {
        names.push(name.into());
        names.len() - 1
    });
    known as u32
}
