//! How a block may move.

use serde::Serialize;

/// How a block may move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum BodyKind {
    /// Each node by itself: linear tetrahedra.
    #[default]
    Elastic,
    /// All nodes by one affine map, 12 unknowns: the first-order block of classic DDA (Shi 1988).
    Affine,
    /// Without deformation, 6 unknowns.
    Rigid,
    /// Not at all, or as prescribed: no unknowns.
    Fixed,
}

impl BodyKind {
    /// Whether all its nodes move by one affine map, so that plane faces stay plane.
    pub fn is_affine(self) -> bool {
        self != Self::Elastic
    }
}
