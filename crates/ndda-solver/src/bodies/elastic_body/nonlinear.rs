//! Materials whose stress is not D ε: Newton's method on each block, with the tangent of the undeformed material.
//!
//! With E(w) = ∫Bᵀ (σ(ε) − D ε) dV the equations of the linear block get the load −θ E(w + s), which is iterated on:
//!
//! ```text
//! K̃ sₖ₊₁ = b + θ (E(w) − E(w + sₖ))
//! ```
//!
//! b being the right-hand side with E(w) in it (initial stress method; Zienkiewicz & Taylor 2000, vol. 2, ch. 2). It converges while no
//! tangent modulus is above twice that of the undeformed material, and faster the shorter the step.

use nalgebra::Matrix6;
use ndda_fem::Voigt;
use ndda_fem::stress::{add_stress_force, energy_of_strain};
use ndda_mesh::Vec3;

use crate::bodies::prototype::Prototype;
use crate::error::BlockError;

use super::ElasticBody;

/// Change of the excess force, over the largest it and the elastic force have been, at which the iteration ends.
const TOLERANCE: f64 = 1e-12;
/// Iterations after which it has failed.
const MOST_ITERATIONS: u32 = 100;

/// Memory of a block of such a material.
pub(super) struct Nonlinear {
    moduli: Matrix6<f64>,
    /// E(w) at the w that was last looked at [N].
    pub(super) excess: Vec<Vec3>,
    /// E(w) of the prediction [N].
    predicted: Vec<Vec3>,
    /// The right-hand side b [N].
    base: Vec<Vec3>,
    /// E of the iteration before [N].
    last: Vec<Vec3>,
    /// w + s [m].
    place: Vec<Vec3>,
}

impl Nonlinear {
    /// None for a linear material.
    pub(super) fn new(shape: &Prototype) -> Option<Box<Self>> {
        let zeros = || vec![Vec3::zeros(); shape.operator.nodes()];
        let memory = || Self {
            moduli: shape.material.moduli(),
            excess: zeros(),
            predicted: zeros(),
            base: zeros(),
            last: zeros(),
            place: zeros(),
        };
        (!shape.material.is_linear()).then(|| Box::new(memory()))
    }

    /// E(w).
    pub(super) fn find_excess(&mut self, shape: &Prototype, displacement: &[Vec3]) {
        self.excess.fill(Vec3::zeros());
        let stress = |strain: &Voigt| shape.material.stress(strain) - self.moduli * strain;
        add_stress_force(&shape.operator, stress, displacement, &mut self.excess);
    }

    /// E at the place that is looked at.
    fn find_excess_in_place(&mut self, shape: &Prototype) {
        let place = std::mem::take(&mut self.place);
        self.find_excess(shape, &place);
        self.place = place;
    }

    /// Energy that the material stores beyond ½ ε·D ε [J].
    pub(super) fn excess_energy_j(&self, shape: &Prototype, displacement: &[Vec3]) -> f64 {
        let density = |strain: &Voigt| {
            shape.material.energy_density(strain) - 0.5 * strain.dot(&(self.moduli * strain))
        };
        energy_of_strain(&shape.operator, density, displacement)
    }

    /// Keeps the right-hand side with the excess of the prediction in it.
    pub(super) fn begin(&mut self, right_hand_side: &[Vec3]) {
        self.base.copy_from_slice(right_hand_side);
        self.predicted.copy_from_slice(&self.excess);
    }
}

impl ElasticBody {
    /// Takes the solution of the linear block to that of its material; nothing to do for a linear one.
    ///
    /// # Errors
    /// [`BlockError::Material`] when the iteration does not end, [`BlockError::Solve`] as a solve.
    pub(super) fn converge(&mut self, shape: &Prototype, theta: f64) -> Result<(), BlockError> {
        let Some(mut nonlinear) = self.kept.nonlinear.take() else { return Ok(()) };
        let outcome = self.iterate(shape, theta, &mut nonlinear);
        self.kept.nonlinear = Some(nonlinear);
        outcome
    }

    fn iterate(&mut self, shape: &Prototype, theta: f64, memory: &mut Nonlinear) -> Result<(), BlockError> {
        let size = |forces: &[Vec3]| forces.iter().map(Vec3::norm).fold(0.0, f64::max);
        let elastic_n = size(&self.elastic);
        memory.last.copy_from_slice(&memory.predicted);
        for _ in 0..MOST_ITERATIONS {
            memory.place.fill(Vec3::zeros());
            shape.unknowns.scatter(&self.unknowns, &mut memory.place);
            memory.place.iter_mut().zip(&self.displacement).for_each(|(place, w)| *place += w);
            memory.find_excess_in_place(shape);
            let changed =
                memory.excess.iter().zip(&memory.last).map(|(e, l)| (e - l).norm()).fold(0.0, f64::max);
            let scale = elastic_n.max(size(&memory.excess));
            if changed <= TOLERANCE * scale {
                return Ok(());
            }
            if !changed.is_finite() {
                break;
            }
            memory.last.copy_from_slice(&memory.excess);
            for (i, r) in self.correction.iter_mut().enumerate() {
                *r = memory.base[i] + theta * (memory.predicted[i] - memory.excess[i]);
            }
            shape.unknowns.gather(&self.correction, &mut self.unknowns);
            self.solve(shape)?;
        }
        Err(BlockError::Material { iterations: MOST_ITERATIONS })
    }
}
