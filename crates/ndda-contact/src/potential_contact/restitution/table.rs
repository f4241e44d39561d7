//! Which restitution contacts between blocks have, and on which of their faces.

use std::collections::BTreeMap;

use ndda_mesh::{BlockId, BlockSet, TriangleId};

use crate::restitution::law::{factor_of, shear_factor_of};

/// Restitution below which damping is strong.
const STRONG: f64 = 0.6;

/// Damping factors c/√(m K), along the normal and along the face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Factors {
    /// α along the normal.
    pub normal: f64,
    /// That of the dashpots beside shear springs.
    pub shear: f64,
}

/// Coefficients of restitution of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Restitution {
    /// Speed at which two blocks part after a central impact, over that at which they met.
    pub normal: f64,
    /// Speed along the face after half an oscillation on a shear spring, over that before; if none, shear springs are damped by the α of the normal.
    pub shear: Option<f64>,
}

impl From<f64> for Restitution {
    fn from(normal: f64) -> Self {
        Self { normal, shear: None }
    }
}

impl Factors {
    pub(super) fn damp(&self) -> bool {
        self.normal > 0.0 || self.shear > 0.0
    }
}

impl Restitution {
    fn factors(self) -> Factors {
        let normal = factor_of(self.normal);
        Factors { normal, shear: self.shear.map_or(normal, shear_factor_of) }
    }
}

/// A coefficient of restitution for each pair of materials, and others for named surfaces: joints.
///
/// Each side of a contact has the restitution of its own face: of the surface that the face is part of, if that has one, else of the two
/// materials. Where two faces of different surfaces meet, each damps the pressure that its side bears, about half.
#[derive(Clone, Debug, PartialEq)]
pub struct RestitutionTable {
    /// Material of each block; blocks beyond the list have material 0.
    material: Vec<u32>,
    materials: usize,
    /// Damping of each pair of materials.
    of_pair: Vec<Factors>,
    /// Damping by index in [`BlockSet::surface_names`].
    on_surface: BTreeMap<u32, Factors>,
}

impl RestitutionTable {
    /// One coefficient between all blocks.
    pub fn everywhere(restitution: impl Into<Restitution>) -> Self {
        Self::between(Vec::new(), 1, restitution)
    }

    /// One coefficient between blocks of so many materials (one index per block), until others are set.
    pub fn between(material: Vec<u32>, materials: usize, restitution: impl Into<Restitution>) -> Self {
        let of_pair = vec![restitution.into().factors(); materials * materials];
        Self { material, materials, of_pair, on_surface: BTreeMap::new() }
    }

    /// Sets the coefficient between two materials; the latest call counts.
    pub fn set(&mut self, (a, b): (u32, u32), restitution: impl Into<Restitution>) {
        let factors = restitution.into().factors();
        for (a, b) in [(a, b), (b, a)] {
            self.of_pair[a as usize * self.materials + b as usize] = factors;
        }
    }

    /// Sets the coefficient on faces of surfaces, by their index in [`BlockSet::surface_names`]; the latest call counts.
    pub fn set_on(&mut self, surfaces: &[u32], restitution: impl Into<Restitution>) {
        let factors = restitution.into().factors();
        self.on_surface.extend(surfaces.iter().map(|&surface| (surface, factors)));
    }

    /// Whether any contact is damped.
    pub fn damps(&self) -> bool {
        self.of_pair.iter().chain(self.on_surface.values()).any(|factors| factors.damp())
    }

    /// Whether any contact has a restitution below 0.6.
    pub fn damps_strongly(&self) -> bool {
        let (normal, shear) = (factor_of(STRONG), shear_factor_of(STRONG));
        let mut all = self.of_pair.iter().chain(self.on_surface.values());
        all.any(|factors| factors.normal > normal || factors.shear > normal.max(shear))
    }

    /// Damping of a facet of one block that touches another.
    pub(super) fn factors(&self, blocks: &BlockSet, facet: TriangleId, target: BlockId) -> Factors {
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
        table.set((0, 0), 0.7);
        assert!(table.damps() && !table.damps_strongly());
        table.set((0, 0), 0.5);
        assert!(table.damps() && table.damps_strongly());
        table.set((0, 0), 1.0);
        table.set_on(&[3], 0.9);
        assert!(table.damps());
        assert!(RestitutionTable::everywhere(Restitution { normal: 1.0, shear: Some(0.5) }).damps());
    }
}
