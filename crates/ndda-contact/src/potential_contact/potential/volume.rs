//! A potential of the overlap's volume alone.

use ndda_mesh::BlockSet;

use crate::potential::contact_potential::{ContactPotential, OverlapLaw, PotentialError, PotentialField};
use crate::potential::piece_table::PieceTable;

/// W = k_n V₀/m (V/V₀)^m, V the volume that two blocks share (Feng 2021, contact volume based model).
///
/// The pressure is the same all over a patch, k_n (V/V₀)^(m − 1), whatever the meshes; it does not know where a block
/// is deeper, so it resists tilting only through the shape of the patch. One patch per pair of blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VolumePotential {
    /// m, above 1.
    pub exponent: f64,
    /// V₀ [m³].
    pub reference_m3: f64,
}

impl ContactPotential for VolumePotential {
    fn name(&self) -> &'static str {
        "Volume"
    }

    /// φ = ½ in either block, so that U = V.
    fn field(&self, blocks: &BlockSet) -> Result<PotentialField, PotentialError> {
        let mut table = PieceTable::new();
        blocks.tets.iter().for_each(|_| table.push(&[[0.5; 4]]));
        Ok(PotentialField::Pieces(table))
    }

    fn law(&self) -> OverlapLaw {
        OverlapLaw::Power { exponent: self.exponent, reference_m3: self.reference_m3 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::potential::testing::check_potential;

    #[test]
    fn it_keeps_the_contract_of_a_potential() {
        check_potential(&VolumePotential { exponent: 2.0, reference_m3: 1.0 });
        check_potential(&VolumePotential { exponent: 1.5, reference_m3: 1e-3 });
    }
}
