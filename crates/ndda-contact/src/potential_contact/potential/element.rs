//! The potential of the paper.

use ndda_mesh::BlockSet;

use crate::potential::contact_potential::{ContactPotential, PotentialError, PotentialField};

/// φ = 4 min λᵢ in every tetrahedron: 0 on its faces, 1 at its centroid (Munjiza 2004, ch. 2).
///
/// Its stiffness depends on the mesh, 4 k_n (1/H_c + 1/H_t) per area, and φ is zero again on faces inside the block:
/// beyond the first layer of centroids nothing is pushed out. Where overlaps are cut, `integration/region.rs` computes its values.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ElementPotential;

impl ContactPotential for ElementPotential {
    fn name(&self) -> &'static str {
        "Element"
    }

    fn field(&self, _blocks: &BlockSet) -> Result<PotentialField, PotentialError> {
        Ok(PotentialField::Element)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::potential::testing::check_potential;

    #[test]
    fn it_keeps_the_contract_of_a_potential() {
        check_potential(&ElementPotential);
    }
}
