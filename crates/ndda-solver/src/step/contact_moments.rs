//! Angular momentum in schemes that take contact elsewhere than in the middle of a step, or that remember accelerations.
//!
//! The angular momentum of a block is that of its mass about the mass centre c, its *spin*, and that of the mass centre about the origin,
//! its *orbital* part. Torques about c change the spin. The orbital part changes as the integrator moves c: with forces A₀ and A₁ = M a
//! at both ends of a step, u = Δt v₀ + Δt² [(½ − β) A₀ + β A₁]/m and ΔP = Δt [(1 − γ) A₀ + γ A₁] give
//!
//! ```text
//! c₁ × P₁ − c₀ × P₀ = c₀ × ΔP + Δt² v₀ × [(½ − γ + β) A₀ + (γ − β) A₁] + Δt³ (½ γ − β)/m · A₀ × A₁
//! ```
//!
//! *Loads* act along the path of c: their orbital moment is this expression, which is ∫ c × F dt for a constant load, and none of it goes
//! to the spin. *Contact* forces of a pair act at common points x*, not where the two mass centres are when the integrator moves them, so
//! their orbital moments and torques do not cancel: angular momentum would change by about ½ Δt² (v_a − v_b) × F. That misfit is given
//! to the spins of the two blocks, in proportion to their moments of inertia J. Each pair has its own velocity w = (J_b v_a + J_a v_b)/(J_a + J_b),
//! and each of its blocks takes the misfit that an observer sees who moves at w. So the result is the same for all observers, and w × F of
//! both blocks cancels. A held block counts as infinitely heavy and takes the whole misfit.

use ndda_contact::{ContactInput, FacetContact};
use ndda_mesh::{BlockId, Vec3};

use crate::bodies::prototype::Prototype;
use crate::step::Simulation;

/// Σ w × F of the contact forces on each block: memory sized once.
pub(crate) struct ContactMoments {
    /// Half the trace of the inertia of each block about its mass centre [kg m²]; infinite for blocks that are held.
    inertia: Vec<f64>,
    /// Velocity of each mass centre [m/s].
    velocity: Vec<Vec3>,
    facets: Vec<FacetContact>,
    /// Σ w × F of each block [N m/s].
    pub carried: Vec<Vec3>,
}

impl ContactMoments {
    /// Memory for blocks of these shapes.
    pub(crate) fn new<'a>(shapes: impl Iterator<Item = &'a Prototype>) -> Self {
        let inertia: Vec<f64> = shapes.map(mean_inertia).collect();
        let zeros = vec![Vec3::zeros(); inertia.len()];
        Self { inertia, velocity: zeros.clone(), facets: Vec::new(), carried: zeros }
    }

    /// w of a pair of blocks [m/s].
    fn pair_velocity(&self, a: usize, b: usize) -> Vec3 {
        let (heavy, light) = if self.inertia[a] >= self.inertia[b] { (a, b) } else { (b, a) };
        let ratio = self.inertia[light] / self.inertia[heavy];
        // Two held blocks have no ratio, and no spin that could change.
        let share = if ratio.is_nan() { 0.5 } else { ratio / (1.0 + ratio) };
        self.velocity[light] + share * (self.velocity[heavy] - self.velocity[light])
    }

    fn carry(&mut self, owner: BlockId, target: BlockId, force: &Vec3) {
        let (a, b) = (owner.index(), target.index());
        let carried = self.pair_velocity(a, b).cross(force);
        self.carried[a] += carried;
        self.carried[b] -= carried;
    }
}

/// Σ m x², half the trace of the inertia about the mass centre [kg m²]; infinite for a block that is held.
fn mean_inertia(shape: &Prototype) -> f64 {
    let arms = shape.operator.node_mass.iter().zip(&shape.operator.rest);
    if shape.is_free() { arms.map(|(m, x)| m * x.norm_squared()).sum() } else { f64::INFINITY }
}

impl Simulation {
    /// Finds Σ w × F of the contact forces just added, where the scheme requires it.
    pub(crate) fn carry_contact_forces(&mut self) {
        let Some(mut moments) = self.contact_moments.take() else { return };
        moments.carried.fill(Vec3::zeros());
        let acts = self.scratch.contact_has_acted;
        if acts {
            for block in self.problem.blocks.ids() {
                let nodes = self.problem.blocks.nodes_of(block);
                moments.velocity[block.index()] =
                    self.shape(block).operator.center(&self.state.velocity[nodes]);
            }
        }
        if let Some(model) = self.contact.as_ref().filter(|_| acts) {
            moments.facets.clear();
            let (position, velocity) = (&self.scratch.contact_position, &self.state.velocity);
            let input = ContactInput::new(&self.problem.blocks, position, velocity, self.part_s);
            model.add_facets(&input, &self.state.contact, &mut moments.facets);
            for k in 0..moments.facets.len() {
                let facet = moments.facets[k];
                let owner = self.problem.blocks.triangle_block[facet.facet.index()];
                moments.carry(owner, facet.target, &(facet.push_n + facet.friction_n));
            }
        }
        let pairs = self.bolts.iter().flat_map(|bolts| &bolts.work.pairs);
        pairs.for_each(|(owner, target, force)| moments.carry(*owner, *target, force));
        self.contact_moments = Some(moments);
    }

    /// Σ v × F of the contact forces of the last step, v being the velocity of each block itself: what they carry as long as nobody
    /// knows between which pairs they act, and the same for all observers.
    pub(crate) fn carry_by_blocks(&mut self) {
        let Some(mut moments) = self.contact_moments.take() else { return };
        for block in self.problem.blocks.ids() {
            let nodes = self.problem.blocks.nodes_of(block);
            let velocity_m_s = self.shape(block).operator.center(&self.state.velocity[nodes.clone()]);
            let force: Vec3 = self.state.contact_force[nodes].iter().sum();
            moments.carried[block.index()] = velocity_m_s.cross(&force);
        }
        self.contact_moments = Some(moments);
    }
}
