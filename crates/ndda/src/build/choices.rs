//! Parts that a program puts in the place of those that a scene names.

use std::sync::Arc;

use ndda_contact::broad_phase::BroadPhase;
use ndda_contact::{BatchLaw, ContactModel, ContactPotential, FrictionLaw};
use ndda_fem::Material;
use ndda_solver::{LinearSolver, TimeIntegrator};

/// Parts of a program's own; whatever is left out is as the scene says.
///
/// ```
/// use ndda::build::Choices;
/// use ndda_contact::Coulomb;
///
/// let slippery = Choices { friction: Some(Box::new(Coulomb::new(5.0, 1e10))), ..Choices::default() };
/// # let _ = slippery;
/// ```
#[derive(Default)]
pub struct Choices {
    /// A contact model instead of all that the scene says of contact.
    pub contact: Option<Box<dyn ContactModel>>,
    /// A potential instead of `contact.potential`.
    pub potential: Option<Box<dyn ContactPotential>>,
    /// A friction law instead of `contact.friction`; those of single joints and pairs of materials stay.
    pub friction: Option<Box<dyn FrictionLaw>>,
    /// Friction of all facets at once instead of all friction that the scene names.
    pub batch_law: Option<Box<dyn BatchLaw>>,
    /// Tolerance of friction on velocities instead of `contact.friction_tolerance`, as a part of μN.
    pub friction_tolerance: Option<f64>,
    /// The search for pairs that may touch.
    pub broad_phase: Option<Box<dyn BroadPhase>>,
    /// A time integrator instead of `time.integrator`.
    pub integrator: Option<Box<dyn TimeIntegrator>>,
    /// A linear solver instead of `time.solver`.
    pub solver: Option<Box<dyn LinearSolver>>,
    /// Materials by their name in the scene.
    pub materials: Vec<(String, Arc<dyn Material>)>,
}

impl Choices {
    /// What stands in the place of the scene's parts, in words; none where everything is as the scene says.
    pub(crate) fn own(&self) -> Option<String> {
        let words = |law: &dyn BatchLaw| format!("the friction law `{}`", law.name());
        let other = || (!self.are_the_scenes()).then(|| "a part of a program's own".to_string());
        self.batch_law.as_deref().map(words).or_else(other)
    }

    /// Whether everything is as the scene says.
    pub(crate) fn are_the_scenes(&self) -> bool {
        let models = self.contact.is_none() && self.potential.is_none() && self.friction.is_none();
        let laws =
            self.batch_law.is_none() && self.friction_tolerance.is_none() && self.broad_phase.is_none();
        models && laws && self.integrator.is_none() && self.solver.is_none() && self.materials.is_empty()
    }
}
