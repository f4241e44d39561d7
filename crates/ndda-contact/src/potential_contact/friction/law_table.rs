//! Which friction law acts between which blocks, and on which of their faces.

use ndda_mesh::{BlockId, BlockSet, TriangleId};

use crate::friction::law::{FacetSlip, FrictionLaw, ShearMemory};

/// The owner of a facet's friction history.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Memory {
    /// The facet and the other block: it survives when the block slides from one element to the next.
    #[default]
    Body,
    /// The facet and one element, as the paper has it: it is lost on every element border.
    Element,
}

/// Law of the faces of one named surface.
#[derive(Clone, Copy, Debug, Default)]
enum OnSurface {
    /// The law of the two materials.
    #[default]
    Materials,
    /// A law of its own, or none.
    Own(Option<u32>),
}

/// A friction law for each pair of materials, and others for named surfaces: joints.
///
/// Each side of a contact rubs by the law of its own face: of the surface that the face is part of, if that has one,
/// else of the two materials. Where two faces of different surfaces meet, each law acts on the pressure that its side
/// bears, about half.
pub struct FrictionLawTable {
    laws: Vec<Box<dyn FrictionLaw>>,
    /// Material of each block; blocks beyond the list have material 0.
    material: Vec<u32>,
    materials: usize,
    /// Law of each pair of materials.
    law_of: Vec<Option<u32>>,
    /// By index in [`BlockSet::surface_names`]; surfaces beyond the list have no law of their own.
    on_surface: Vec<OnSurface>,
    /// Owner of the friction history.
    pub memory: Memory,
    /// Part of μN to which friction on velocities is found for all patches together; 1e-7 unless it is set.
    pub tolerance: f64,
}

/// Tolerance of friction on velocities.
pub(crate) const TOLERANCE: f64 = 1e-7;

impl FrictionLawTable {
    /// One law between all blocks.
    pub fn everywhere(law: Box<dyn FrictionLaw>) -> Self {
        let mut table = Self::between(Vec::new(), 1);
        table.set(&[(0, 0)], Some(law));
        table
    }

    /// No law yet, for blocks of so many materials (one index per block).
    pub fn between(material: Vec<u32>, materials: usize) -> Self {
        let law_of = vec![None; materials * materials];
        let (laws, on_surface) = (Vec::new(), Vec::new());
        Self { laws, material, materials, law_of, on_surface, memory: Memory::Body, tolerance: TOLERANCE }
    }

    /// Sets the law between materials, whichever is contactor; the latest call counts.
    pub fn set(&mut self, pairs: &[(u32, u32)], law: Option<Box<dyn FrictionLaw>>) {
        let index = self.add(law);
        for &(a, b) in pairs {
            for (a, b) in [(a, b), (b, a)] {
                self.law_of[a as usize * self.materials + b as usize] = index;
            }
        }
    }

    /// Sets the law, or none, on faces of surfaces, by their index in [`BlockSet::surface_names`]; the latest call counts.
    pub fn set_on(&mut self, surfaces: &[u32], law: Option<Box<dyn FrictionLaw>>) {
        if surfaces.is_empty() {
            return;
        }
        let index = self.add(law);
        for surface in surfaces.iter().map(|&surface| surface as usize) {
            let count = self.on_surface.len().max(surface + 1);
            self.on_surface.resize(count, OnSurface::Materials);
            self.on_surface[surface] = OnSurface::Own(index);
        }
    }

    fn add(&mut self, law: Option<Box<dyn FrictionLaw>>) -> Option<u32> {
        let law = law?;
        assert!(law.state_len() == 0 || !law.acts_on_faces(), "{}: a law of faces has no state", law.name());
        self.laws.push(law);
        Some(self.laws.len() as u32 - 1)
    }

    /// The law on a facet of one block that touches another.
    pub fn law(&self, blocks: &BlockSet, facet: TriangleId, target: BlockId) -> Option<&dyn FrictionLaw> {
        let index = match self.on_surface(blocks, facet) {
            OnSurface::Own(law) => law,
            OnSurface::Materials => {
                let owner = blocks.triangle_block[facet.index()];
                let material =
                    |block: BlockId| self.material.get(block.index()).copied().unwrap_or(0) as usize;
                self.law_of[material(owner) * self.materials + material(target)]
            }
        };
        index.map(|law| self.laws[law as usize].as_ref())
    }

    fn on_surface(&self, blocks: &BlockSet, facet: TriangleId) -> OnSurface {
        if self.on_surface.is_empty() {
            return OnSurface::Materials;
        }
        let surface = blocks.triangle_surface[facet.index()];
        surface.and_then(|surface| self.on_surface.get(surface as usize)).copied().unwrap_or_default()
    }

    /// Whether there is a law at all.
    pub fn have_laws(&self) -> bool {
        let on_surfaces = self.on_surface.iter().any(|rule| matches!(rule, OnSurface::Own(Some(_))));
        on_surfaces || self.law_of.iter().any(Option::is_some)
    }

    /// Names of the laws that act, each once.
    pub fn law_names(&self) -> Vec<&'static str> {
        let on_surfaces = self.on_surface.iter().filter_map(|rule| match rule {
            OnSurface::Own(law) => law.as_ref(),
            OnSurface::Materials => None,
        });
        let laws = self.law_of.iter().flatten().chain(on_surfaces);
        let mut names: Vec<_> = laws.map(|&law| self.laws[law as usize].name()).collect();
        names.sort_unstable();
        names.dedup();
        names
    }

    /// Whether a law acts on whole faces.
    pub fn act_on_faces(&self) -> bool {
        self.laws.iter().any(|law| law.acts_on_faces())
    }

    /// Whether all of them do, and none holds together what touches: then facets have nothing to remember.
    pub fn act_on_faces_only(&self) -> bool {
        self.laws.iter().all(|law| law.acts_on_faces()) && !self.hold_together()
    }

    /// Friction over normal force that bears at least, whatever touches.
    pub fn min_friction_coefficient(&self) -> f64 {
        let unit = FacetSlip { normal_n: 1.0, ..FacetSlip::default() };
        let bears = |law: &u32| {
            let law = &self.laws[*law as usize];
            let mut state = vec![0.0; law.state_len()];
            law.begin(&mut state);
            law.capacity_n(&unit, &ShearMemory { state: &mut state, ..ShearMemory::default() })
        };
        let on_surfaces = self.on_surface.iter().filter_map(|rule| match rule {
            OnSurface::Own(law) => Some(law),
            OnSurface::Materials => None,
        });
        let laws = self.law_of.iter().chain(on_surfaces);
        laws.map(|law| law.as_ref().map_or(0.0, bears)).fold(f64::INFINITY, f64::min)
    }

    /// Most numbers that a law keeps of a facet.
    pub(crate) fn state_len(&self) -> usize {
        self.laws.iter().map(|law| law.state_len()).max().unwrap_or(0)
    }

    /// Whether a law opens joints by slip.
    pub fn dilate(&self) -> bool {
        self.laws.iter().any(|law| law.dilates())
    }

    /// Whether a law makes bonds.
    pub fn hold_together(&self) -> bool {
        self.laws.iter().any(|law| law.holds_together())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::coulomb::Coulomb;

    #[test]
    fn a_law_that_acts_on_surfaces_only_has_a_name_too() {
        let mut joints = FrictionLawTable::between(Vec::new(), 1);
        joints.set_on(&[1], None);
        assert!(joints.law_names().is_empty());
        joints.set_on(&[0, 2], Some(Box::new(Coulomb::new(30.0, 1e9))));
        assert_eq!(joints.law_names(), [Coulomb::new(30.0, 1e9).name()]);
    }

    #[test]
    fn the_least_friction_is_that_of_the_slipperiest_pair() {
        let law = |friction_deg: f64| -> Box<dyn FrictionLaw> { Box::new(Coulomb::new(friction_deg, 1e9)) };
        assert!((FrictionLawTable::everywhere(law(45.0)).min_friction_coefficient() - 1.0).abs() < 1e-15);
        let mut joints = FrictionLawTable::between(vec![0, 1], 2);
        joints.set(&[(0, 0), (1, 1)], Some(law(45.0)));
        assert_eq!(joints.min_friction_coefficient(), 0.0);
        joints.set(&[(0, 1)], Some(law(30.0)));
        assert!((joints.min_friction_coefficient() - 30f64.to_radians().tan()).abs() < 1e-15);
        joints.set_on(&[0], None);
        assert_eq!(joints.min_friction_coefficient(), 0.0);
    }
}
