//! Which friction law acts between which blocks.

use ndda_mesh::BlockId;

use crate::friction::FrictionLaw;

/// What a facet's friction history belongs to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Memory {
    /// The facet and the other block: it survives when the block slides from one element to the next.
    #[default]
    Body,
    /// The facet and one element, as the paper has it: it is lost on every element border.
    Element,
}

/// A friction law for each pair of materials.
pub struct Joints {
    laws: Vec<Box<dyn FrictionLaw>>,
    /// Material of each block; blocks beyond the list have material 0.
    material: Vec<u32>,
    materials: usize,
    /// Law of each pair of materials.
    law_of: Vec<Option<u32>>,
    /// What history belongs to.
    pub memory: Memory,
}

impl Joints {
    /// One law between all blocks.
    pub fn everywhere(law: Box<dyn FrictionLaw>) -> Self {
        Self {
            laws: vec![law],
            material: Vec::new(),
            materials: 1,
            law_of: vec![Some(0)],
            memory: Memory::Body,
        }
    }

    /// No law yet, for blocks of so many materials (one index per block).
    pub fn between(material: Vec<u32>, materials: usize) -> Self {
        let law_of = vec![None; materials * materials];
        Self { laws: Vec::new(), material, materials, law_of, memory: Memory::Body }
    }

    /// Sets the law between materials, whichever is contactor; the latest call counts.
    pub fn set(&mut self, pairs: &[(u32, u32)], law: Option<Box<dyn FrictionLaw>>) {
        let index = law.map(|law| {
            self.laws.push(law);
            self.laws.len() as u32 - 1
        });
        for &(a, b) in pairs {
            for (a, b) in [(a, b), (b, a)] {
                self.law_of[a as usize * self.materials + b as usize] = index;
            }
        }
    }

    /// The law between two blocks.
    pub fn law(&self, a: BlockId, b: BlockId) -> Option<&dyn FrictionLaw> {
        let material = |block: BlockId| self.material.get(block.index()).copied().unwrap_or(0) as usize;
        self.law_of[material(a) * self.materials + material(b)].map(|law| self.laws[law as usize].as_ref())
    }

    /// Whether there is a law at all.
    pub fn have_laws(&self) -> bool {
        self.law_of.iter().any(Option::is_some)
    }

    /// Names of the laws that act, each once.
    pub fn law_names(&self) -> Vec<&'static str> {
        let mut names: Vec<_> =
            self.law_of.iter().flatten().map(|&law| self.laws[law as usize].name()).collect();
        names.sort_unstable();
        names.dedup();
        names
    }

    /// Whether a law acts on whole faces.
    pub fn act_on_faces(&self) -> bool {
        self.laws.iter().any(|law| law.acts_on_faces())
    }

    /// Whether a law carries tension.
    pub fn carry_tension(&self) -> bool {
        self.laws.iter().any(|law| law.tension_pa() > 0.0)
    }
}
