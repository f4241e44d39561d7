//! Which restitution contacts between blocks have, and on which of their faces.

use std::collections::BTreeMap;

use ndda_mesh::{BlockId, BlockSet, TriangleId};

use crate::restitution::law::factor_of;

/// A coefficient of restitution for each pair of materials, and others for named surfaces: joints.
///
/// Each side of a contact has the restitution of its own face: of the surface that the face is part of, if that has one, else of the two
/// materials. Where two faces of different surfaces meet, each damps the pressure that its side bears, about half.
#[derive(Clone, Debug, PartialEq)]
pub struct RestitutionTable {
    /// Material of each block; blocks beyond the list have material 0.
    material: Vec<u32>,
    materials: usize,
    /// Damping factor α of each pair of materials.
    of_pair: Vec<f64>,
    /// α by index in [`BlockSet::surface_names`].
    on_surface: BTreeMap<u32, f64>,
}

impl RestitutionTable {
    /// One coefficient between all blocks.
    pub fn everywhere(restitution: f64) -> Self {
        Self::between(Vec::new(), 1, restitution)
    }

    /// One coefficient between blocks of so many materials (one index per block), until others are set.
    pub fn between(material: Vec<u32>, materials: usize, restitution: f64) -> Self {
        let of_pair = vec![factor_of(restitution); materials * materials];
        Self { material, materials, of_pair, on_surface: BTreeMap::new() }
    }

    /// Sets the coefficient between two materials; the latest call counts.
    pub fn set(&mut self, (a, b): (u32, u32), restitution: f64) {
        for (a, b) in [(a, b), (b, a)] {
            self.of_pair[a as usize * self.materials + b as usize] = factor_of(restitution);
        }
    }

    /// Sets the coefficient on faces of surfaces, by their index in [`BlockSet::surface_names`]; the latest call counts.
    pub fn set_on(&mut self, surfaces: &[u32], restitution: f64) {
        let factor = factor_of(restitution);
        self.on_surface.extend(surfaces.iter().map(|&surface| (surface, factor)));
    }

    /// Whether any contact is damped.
    pub fn damps(&self) -> bool {
        self.of_pair.iter().chain(self.on_surface.values()).any(|&factor| factor > 0.0)
    }

    /// α of a facet of one block that touches another; zero without damping.
    pub(super) fn factor(&self, blocks: &BlockSet, facet: TriangleId, target: BlockId) -> f64 {
        let surface = blocks.triangle_surface[facet.index()];
        let own = surface.and_then(|surface| self.on_surface.get(&surface));
        own.copied().unwrap_or_else(|| {
            let owner = blocks.triangle_block[facet.index()];
            let material = |block: BlockId| self.material.get(block.index()).copied().unwrap_or(0) as usize;
            self.of_pair[material(owner) * self.materials + material(target)]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_damps_unless_all_contacts_give_back_all() {
        let mut table = RestitutionTable::everywhere(1.0);
        assert!(!table.damps());
        table.set((0, 0), 0.5);
        assert!(table.damps());
        table.set((0, 0), 1.0);
        table.set_on(&[3], 0.9);
        assert!(table.damps());
    }
}
