//! The seam for contact potentials: what φ is in a block, and what its integral costs.
//!
//! Blocks A and B that overlap have U = ∫_{A∩B} (φ_A + φ_B) dV and the energy W = k_n w(U). A potential is continuous,
//! and zero on the surface of its block unless it says so by a law w of its own. Inside a tetrahedron it is the
//! smallest of a few linear functions, and every integral over a flat triangle is exact; or any other function, integrated by quadrature.

use ndda_mesh::{BlockSet, TetId};

use crate::potential::function::FunctionField;
use crate::potential::piece_table::{MOST_PIECES, PieceTable};

/// A contact potential.
///
/// Contract (checked by [`check_potential`](crate::potential::testing::check_potential)): forces are −∂W/∂x in every rigid
/// motion, they balance, and they vanish where blocks do not overlap.
pub trait ContactPotential: Send + Sync {
    /// Its name, as scenes spell it.
    fn name(&self) -> &'static str;

    /// φ of all blocks, from their rest shape.
    ///
    /// # Errors
    /// [`PotentialError`] naming the block that it cannot serve.
    fn field(&self, blocks: &BlockSet) -> Result<PotentialField, PotentialError>;

    /// φ per depth below the nearest face of a convex block [1/m], if it is that: such a block is an affine convex target where it moves by an
    /// affine map, see [`ConvexBlocks`](crate::affine::ConvexBlocks).
    fn phi_per_m(&self) -> Option<f64> {
        None
    }

    /// The law W(U).
    fn law(&self) -> OverlapLaw {
        OverlapLaw::Linear
    }
}

/// W/k_n as a function of U = ∫ (φ_A + φ_B) dV for one pair of blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OverlapLaw {
    /// w = U: pressure is k_n φ, each point for itself.
    Linear,
    /// w = U₀/m (U/U₀)^m: the pressure k_n φ (U/U₀)^(m − 1) knows of the whole overlap.
    Power {
        /// m, above 1.
        exponent: f64,
        /// U₀ [m³].
        reference_m3: f64,
    },
}

impl OverlapLaw {
    /// w(U) [m³].
    pub fn energy_m3(&self, overlap_m3: f64) -> f64 {
        match *self {
            Self::Linear => overlap_m3,
            Self::Power { exponent, reference_m3 } => {
                reference_m3 / exponent * (overlap_m3.max(0.0) / reference_m3).powf(exponent)
            }
        }
    }

    /// dw/dU.
    pub fn slope(&self, overlap_m3: f64) -> f64 {
        match *self {
            Self::Linear => 1.0,
            Self::Power { exponent, reference_m3 } => {
                (overlap_m3.max(0.0) / reference_m3).powf(exponent - 1.0)
            }
        }
    }
}

impl OverlapLaw {
    /// d²w/dU² [1/m³].
    pub fn curvature(&self, overlap_m3: f64) -> f64 {
        match *self {
            Self::Power { exponent, reference_m3 } if overlap_m3 > 0.0 => {
                (exponent - 1.0) / reference_m3 * (overlap_m3 / reference_m3).powf(exponent - 2.0)
            }
            _ => 0.0,
        }
    }
}

/// φ of all blocks of a scene.
#[derive(Clone, Debug)]
pub enum PotentialField {
    /// 4 min λᵢ in every tetrahedron.
    Element,
    /// The smallest of linear functions.
    Pieces(PieceTable),
    /// Any function, by quadrature.
    Function(FunctionField),
}

impl PotentialField {
    /// Whether it is the paper's.
    pub(crate) fn is_element(&self) -> bool {
        matches!(self, Self::Element)
    }

    /// φ where it is the same everywhere.
    pub(crate) fn uniform(&self) -> Option<f64> {
        match self {
            Self::Pieces(table) => table.uniform(),
            _ => None,
        }
    }
}

/// Why a potential cannot serve a block.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PotentialError {
    /// All nodes of a tetrahedron of a concave block are on its surface, where interpolated depth is zero.
    #[error(
        "tetrahedron {} of the concave block `{block}` has all its nodes on the surface, where depth is zero: give it an \
         interior node (pattern TwentyFour, or a finer mesh), or take the potential `Element`", tet.0
    )]
    NoInteriorNode {
        /// Name of the block.
        block: String,
        /// The tetrahedron.
        tet: TetId,
    },
    /// Too many faces of a block are nearest to points of one tetrahedron.
    #[error(
        "tetrahedron {} of block `{block}` is near {faces} faces of the block at once, more than {MOST_PIECES}: take \
         the potential `Element` or `Volume`, or give the block a coarser surface with fewer faces, a `Sphere` at most 1 of `levels`",
        tet.0
    )]
    TooManyFaces {
        /// Name of the block.
        block: String,
        /// The tetrahedron.
        tet: TetId,
        /// Number of faces.
        faces: usize,
    },
}
