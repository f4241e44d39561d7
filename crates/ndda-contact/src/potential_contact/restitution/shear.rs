//! Dashpots beside the shear springs of damped contacts.
//!
//! A spring of stiffness K between two blocks of reduced mass m has a dashpot α √(m K): the same α as along the normal, so that blocks that swing on their
//! springs come to rest as those that bounce. A coefficient of restitution along the face takes the place of α where one is given. Spring and dashpot together
//! carry no more than the friction law allows, and their work counts as work of friction.
//!
//! Where blocks deform, the dashpots on a node of mass m, or on a block that moves by an affine map, take at most c = m/2Δt: with the velocity at the start
//! of the step, more than 2 m/Δt would be unstable. The motion of blocks as a whole is solved for (`dashpot.rs`), and has no limit.

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockId, Mat3, Vec3};

use crate::friction::facet::{FacetForce, FacetOutcome, KeptShear, STICKS, relative_velocity};
use crate::friction::law::facet_basis;
use crate::integration::integrals::Integrals;
use crate::integration::overlap_pair::ActiveFacet;
use crate::model::{Body, Bond, ContactHistory, ContactInput};
use crate::restitution::dashpot::{Dashpot, DashpotPair};
use crate::restitution::law::weight_of_end;
use crate::restitution::scene::DampingScene;
use crate::restitution::{ContactDamping, MOST_SWEEPS, TOLERANCE};

/// c Δt/m of the dashpots on a node of a block that deforms, at most. Mass matrices of tetrahedra may answer to the force of a facet with twice the
/// acceleration that the mass of its nodes alone gives.
const MOST_BRAKED: f64 = 0.5;

impl ContactDamping {
    /// Finds the dashpots of all springs of damped contacts.
    pub(super) fn damp_springs(&mut self, scene: &DampingScene, history: &ContactHistory) {
        self.shear_n.clear();
        self.dashpots.clear();
        self.dashpot_pairs.clear();
        if scene.joints.is_none() {
            return;
        }
        self.gather_dashpots(scene, &history.bonds);
        self.limit_dashpots(scene);
        let ContactInput { bodies, dt_s, .. } = *scene.input;
        for ((change, body), memory) in self.changes.iter_mut().zip(bodies).zip(&history.bodies) {
            // What comes from other forces has those of the last step.
            change.velocity_m_s -= dt_s / body.mass_kg * memory.dashpot_n;
            change.spin_rad_s -= dt_s * (body.inverse_inertia * memory.dashpot_torque_n_m);
        }
        let Self { dashpots, dashpot_pairs, changes, .. } = self;
        let largest_n = dashpots.iter().map(|one| one.rate * one.slip_m_s.norm()).fold(0.0, f64::max);
        for _ in 0..MOST_SWEEPS {
            let mut change_n = 0.0f64;
            for pair in &*dashpot_pairs {
                change_n = change_n.max(pair.advance(&mut dashpots[pair.range()], (bodies, changes), dt_s));
            }
            if change_n <= TOLERANCE * largest_n {
                break;
            }
        }
        let touching = scene.integrals.touching();
        self.shear_n.resize(touching.len(), Vec3::zeros());
        for pair in &self.dashpot_pairs {
            for dashpot in &self.dashpots[pair.range()] {
                let is_first = touching[dashpot.facet as usize].owner == pair.blocks[0];
                self.shear_n[dashpot.facet as usize] =
                    if is_first { dashpot.force_n } else { -dashpot.force_n };
            }
        }
    }

    /// The dashpots of all pairs, whole.
    fn gather_dashpots(&mut self, scene: &DampingScene, bonds: &[Bond]) {
        let ContactInput { blocks, bodies, dt_s, .. } = *scene.input;
        let touching = scene.integrals.touching();
        let stiffness_n_m = |t: u32| scene.shear_stiffness_n_m(t, bonds);
        for run in self.order.chunk_by(|a, b| a.0 == b.0) {
            let pair = run[0].0;
            let all_n_m: f64 = run.iter().map(|&(_, t)| stiffness_n_m(t)).sum();
            let inverse_mass: f64 = pair.iter().map(|block| 1.0 / bodies[block.index()].mass_kg).sum();
            let rate_per_s = (all_n_m * inverse_mass).sqrt();
            if rate_per_s == 0.0 {
                continue;
            }
            let (first, mut center, mut braked_per_s) = (self.dashpots.len(), Vec3::zeros(), 0.0);
            for &(_, t) in run {
                let touch = &touching[t as usize];
                let (hits, sums) = (scene.integrals.overlaps_of(touch), scene.integrals.sums_of(touch));
                let stiffness_n_m = stiffness_n_m(t);
                let rate = stiffness_n_m * self.table.factors(blocks, touch.triangle, touch.target).shear
                    / rate_per_s;
                let corners = blocks.triangle_corners(touch.triangle, scene.input.position);
                let x = sums.center(&corners);
                let slip_m_s = relative_velocity(touch, (hits, sums), scene.input) / sums.pressure;
                self.dashpots.push(Dashpot {
                    facet: t,
                    x,
                    normal: triangle_area_vector(&corners).normalize(),
                    slip_m_s: if touch.owner == pair[0] { slip_m_s } else { -slip_m_s },
                    rate,
                    end: 0.0,
                    lag: 0.0,
                    force_n: Vec3::zeros(),
                });
                center += stiffness_n_m / all_n_m * x;
                braked_per_s += rate * inverse_mass;
            }
            let end = weight_of_end(braked_per_s * dt_s);
            self.dashpots[first..].iter_mut().for_each(|dashpot| dashpot.end = end);
            let dashpots = [first as u32, self.dashpots.len() as u32];
            self.dashpot_pairs.push(DashpotPair { blocks: pair, dashpots, center });
        }
    }

    /// Keeps dashpots on blocks that deform within what a step can follow.
    fn limit_dashpots(&mut self, scene: &DampingScene) {
        let ContactInput { blocks, bodies, dt_s, deformation, affine, .. } = *scene.input;
        let deforms = |block: BlockId| bodies[block.index()].deforms;
        let is_affine = |block: BlockId| affine.get(block.index()).copied().unwrap_or(false);
        let Some(deformation) = deformation else { return };
        if !self.dashpot_pairs.iter().any(|pair| pair.blocks.iter().any(|block| deforms(*block))) {
            return;
        }
        // c Δt/m of each node, or of the first one of a block that moves by an affine map, where 1/m is that of all its motions.
        let braked = &mut self.of_node;
        braked.clear();
        braked.resize(scene.input.position.len(), 0.0);
        for pair in &self.dashpot_pairs {
            for block in pair.blocks.into_iter().filter(|block| deforms(*block)) {
                let first = blocks.nodes_of(block).start;
                for dashpot in &self.dashpots[pair.range()] {
                    let rate = dt_s * dashpot.rate;
                    if is_affine(block) {
                        braked[first] += rate * affine_inverse_mass(&bodies[block.index()], &dashpot.x);
                    } else {
                        scene.each_weight(dashpot.facet, block, |node, weight| {
                            braked[node] += rate * weight.abs()
                        });
                    }
                }
            }
        }
        for block in blocks.ids().filter(|block| deforms(*block) && !is_affine(*block)) {
            let own = &mut braked[blocks.nodes_of(block)];
            deformation.masses(block, &mut |masses_kg| {
                own.iter_mut().zip(masses_kg).for_each(|(braked, mass_kg)| *braked /= mass_kg);
            });
        }
        for pair in &self.dashpot_pairs {
            for dashpot in &mut self.dashpots[pair.range()] {
                let mut most = 0.0f64;
                for block in pair.blocks.into_iter().filter(|block| deforms(*block)) {
                    if is_affine(block) {
                        most = most.max(braked[blocks.nodes_of(block).start]);
                    } else {
                        scene.each_weight(dashpot.facet, block, |node, weight| {
                            most = if weight == 0.0 { most } else { most.max(braked[node]) };
                        });
                    }
                }
                let part = if most > MOST_BRAKED { MOST_BRAKED / most } else { 1.0 };
                dashpot.rate *= part;
                dashpot.lag = 1.0 - part;
            }
        }
    }

    /// Keeps what dashpots push each block by, as far as friction bears it.
    pub(crate) fn remember_dashpots(
        &self,
        input: &ContactInput,
        integrals: &Integrals,
        (forces, outcomes): (&[FacetForce], &[FacetOutcome]),
        history: &mut ContactHistory,
    ) {
        for dashpot in &self.dashpots {
            let t = dashpot.facet as usize;
            let (touch, force) = (&integrals.touching()[t], &forces[t]);
            let Some(outcome) = outcomes.get(t).filter(|outcome| outcome.spring.is_some()) else { continue };
            let Some(KeptShear { shear_n: [x, y], .. }) = outcome.memory else { continue };
            let corners = input.blocks.triangle_corners(touch.triangle, input.position);
            let basis = facet_basis(&corners, &dashpot.normal);
            let force_n = integrals.sums_of(touch).pressure * force.shear - (x * basis[0] + y * basis[1]);
            for (block, force_n) in [(touch.owner.index(), force_n), (touch.target.index(), -force_n)] {
                let memory = &mut history.bodies[block];
                memory.dashpot_n += force_n;
                memory.dashpot_torque_n_m += (dashpot.x - input.bodies[block].center).cross(&force_n);
            }
        }
    }

    /// By how much damping that the step leaves out lets blocks go too fast, at most [m/s]: blocks that a force drives against a dashpot go as much faster as
    /// it is less than it should be. Where a joint slides, dashpots of shear springs change nothing.
    pub(crate) fn error_m_s(
        &self,
        integrals: &Integrals,
        (forces, outcomes): (&[FacetForce], &[FacetOutcome]),
        dt_s: f64,
    ) -> f64 {
        let touching = integrals.touching();
        let along = self.dashpots.iter().filter(|dashpot| dashpot.lag > 0.0).filter_map(|dashpot| {
            let t = dashpot.facet as usize;
            let (force, touch): (_, &ActiveFacet) = (&forces[t], &touching[t]);
            let spring = outcomes.get(t)?.spring.as_ref().filter(|spring| !spring.slides)?;
            let shear_n = integrals.sums_of(touch).pressure * force.shear.norm();
            (shear_n < STICKS * spring.capacity_n).then(|| dashpot.lag * spring.slip_m.norm() / dt_s)
        });
        along.fold(self.normal_error_m_s(), f64::max)
    }

    /// The same of the damping along the normal.
    fn normal_error_m_s(&self) -> f64 {
        let damped = self.pairs.iter().filter(|pair| pair.lag > 0.0).map(|pair| {
            let points = &self.points[pair.range()];
            let mean: f64 = points.iter().map(|point| point.force_n * point.parting_m_s).sum();
            pair.lag * (mean / pair.total_n).abs()
        });
        damped.fold(0.0, f64::max)
    }
}

/// Acceleration of a point [m/s²] by a unit force there, at most, of a body that moves by an affine map: 1/m + x·G⁻¹x, G = Σ m x xᵀ = ½ tr J − J.
fn affine_inverse_mass(body: &Body, x: &Vec3) -> f64 {
    let arm = x - body.center;
    let second =
        body.inverse_inertia.try_inverse().map(|inertia| 0.5 * inertia.trace() * Mat3::identity() - inertia);
    let along =
        second.and_then(|second| second.try_inverse()).map_or(0.0, |inverse| arm.dot(&(inverse * arm)));
    1.0 / body.mass_kg + along.max(0.0)
}
