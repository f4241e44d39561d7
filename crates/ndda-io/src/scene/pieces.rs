//! Pieces that blocks of a rock are taken apart into.

use serde::{Deserialize, Serialize};

use super::{Fill, Rock};

/// Pieces that each block of a rock is taken apart into, every one a block of its own. What holds them together is the law that `contact.rock_joints`
/// gives the joint `tetrahedra`: bonds, with a fracture energy or without. Cracks run between pieces.
///
/// ```text
/// rock: [(material: "rock", domain: Box(min_m: (0, 0, 0), max_m: (1, 1, 2)), into: Tetrahedra(size_m: 0.2, compensate: true))],
/// contact: Potential(penalty_pa: 5e11, potential: Smooth(), rock_joints: [
///     (joint: "tetrahedra", friction: (friction_deg: 35, shear_penalty_pa_m: 1e12, cohesion_pa: 10e6, tension_pa: 5e6,
///                                      fracture: (tension_j_m2: 50, shear_j_m2: 500))),
/// ]),
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum Pieces {
    /// Tetrahedra. The faces between those of one block are the joint `tetrahedra`; faces on other joints keep their names.
    Tetrahedra {
        /// Length of their edges, about [m].
        size_m: f64,
        /// Whether they are made stiffer than their material, so that the rock has its Young's modulus with the bonds, which make it softer
        /// (`ndda check` says by how much). Needs bonds as stiff while they are pressed as while they are pulled,
        /// `penalty_pa` = ½ `shear_penalty_pa_m` L₀ with the potential `Smooth`. Default: false.
        #[serde(default)]
        compensate: bool,
    },
}

impl Rock {
    /// How its blocks are filled with tetrahedra, also where these come apart.
    pub fn filling(&self) -> Fill {
        match self.into {
            Some(Pieces::Tetrahedra { size_m, .. }) => Fill::Size { size_m, finer: Vec::new() },
            None => self.fill.clone(),
        }
    }
}
