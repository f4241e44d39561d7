//! Masses of blocks that deform, on the way to rest.
//!
//! Mass is part of K̃ = θ K + c M, which is factored anew where it changes. So all blocks of a shape have one factor on their mass, for the contacts with which
//! they begin, and a larger one only where contact becomes too stiff for the step. Factors are powers of two, so that masses are scaled back to the last bit.

use ndda_mesh::BlockId;
use ndda_mesh::geometry::triangle_area_vector;

use crate::bodies::kind::BodyKind;
use crate::bodies::prototype::Prototype;
use crate::error::StepError;
use crate::step::Simulation;

/// Least mass of a block over what contact all around it would ask for: it hits others, where it touches none at first.
const LEAST: f64 = 0.25;
/// ω² of an elastic block under a force at one node over the bound from its row-sum masses, less one: the consistent mass of a tetrahedron is at least a fifth of these.
const MORE_AT_A_NODE: f64 = 4.0;
/// Part of the largest stable h beyond which blocks get more mass.
const MOST: f64 = 0.98;

impl Prototype {
    /// Multiplies the mass of a block that deforms, and all that follows from it but its factors.
    fn scale_mass(&mut self, factor: f64) {
        self.operator.scale_mass(factor);
        self.supports.frame.scale_mass(factor);
        self.mobility.iter_mut().for_each(|mobility| *mobility /= factor);
        self.turn_per_n_m /= factor;
    }

    /// Whether its mass may be scaled: rock behind quiet faces has its own.
    fn is_scalable(&self) -> bool {
        self.deforms() && self.supports.quiet.dashpots.is_empty()
    }
}

impl Simulation {
    /// λ of each block that deforms, an upper bound of ω² with contact of unit stiffness per area all around it [m²/kg]; 0 for others.
    pub(super) fn surrounded_rates2(&self) -> Vec<f64> {
        let blocks = self.blocks();
        let rate2 = |block: BlockId| {
            let shape = self.shape(block);
            if !shape.is_scalable() {
                return 0.0;
            }
            let (rest, first) = (&shape.operator.rest, blocks.nodes_of(block).start);
            let mut area_m2 = vec![0.0; rest.len()];
            for triangle in blocks.triangles_of(block) {
                let nodes = blocks.triangles[triangle].map(|node| node.index() - first);
                let third_m2 = triangle_area_vector(&nodes.map(|n| rest[n])).norm() / 3.0;
                nodes.into_iter().for_each(|n| area_m2[n] += third_m2);
            }
            shape.contact_rate2(&area_m2)
        };
        blocks.ids().map(rate2).collect()
    }

    /// Upper bounds of ω² of elastic blocks with these ω_c² [1/s²], with what bolts add: contact is spread over the nodes of a face, and a bolt acts on a few nodes, which
    /// consistent masses let oscillate faster than row sums say.
    fn rates2_with_bolts(&self, rates2: &[f64]) -> Vec<f64> {
        let Some(bolts) = &self.bolts else { return rates2.to_vec() };
        let mut stiffness_n_m = vec![0.0; self.state.position.len()];
        bolts.rows.iter().for_each(|(node, stiffness)| stiffness_n_m[*node as usize] = *stiffness);
        let with_bolts = |(block, rate2): (BlockId, &f64)| match self.shape(block).kind {
            BodyKind::Elastic => {
                let of_block = &stiffness_n_m[self.blocks().nodes_of(block)];
                rate2 + MORE_AT_A_NODE * self.shape(block).contact_rate2(of_block)
            }
            _ => *rate2,
        };
        self.blocks().ids().zip(rates2).map(with_bolts).collect()
    }

    /// Factors on the masses of shapes with which blocks oscillate as fast as the step allows under contacts with these ω_c² [1/s²]; or so many times
    /// slower, as far as that does not ask for more than their own masses.
    pub(super) fn factors_of_shapes(&self, (scale_s2, slower): (f64, f64), rates2: &[f64]) -> Vec<f64> {
        let surrounded = self.surrounded_rates2();
        let stiffness_pa_m = rates2
            .iter()
            .zip(&surrounded)
            .filter(|(_, lambda)| **lambda > 0.0)
            .fold(0.0, |most: f64, (rate2, lambda)| most.max(rate2 / lambda));
        let mut factors = vec![0.0f64; self.problem.shapes.len()];
        for ((body, rate2), lambda) in
            self.bodies.iter().zip(&self.rates2_with_bolts(rates2)).zip(&surrounded)
        {
            if *lambda > 0.0 {
                let asked = scale_s2 * rate2.max(LEAST * stiffness_pa_m * lambda);
                factors[body.shape] = factors[body.shape].max(asked);
            }
        }
        for factor in &mut factors {
            let (quick, slow) = (power_of_two_from(*factor), power_of_two_from(slower * slower * *factor));
            *factor = if slow <= 1.0 { slow } else { quick.max(1.0) };
        }
        factors
    }

    /// Multiplies the masses of shapes by factors, and leaves K̃.
    pub(super) fn scale_shapes(&mut self, factors: &[f64]) {
        for (shape, factor) in self.problem.shapes.iter_mut().zip(factors) {
            if *factor != 1.0 {
                shape.scale_mass(*factor);
            }
        }
    }

    /// Factors K̃ of these shapes, whose masses have changed.
    ///
    /// # Errors
    /// [`StepError::Factor`].
    pub(in crate::step) fn factor_anew(&mut self, shapes: &[usize]) -> Result<(), StepError> {
        for &index in shapes {
            let failed = |source| StepError::Factor { step_s: self.part_s, source };
            let (shape, solver) = (&mut self.problem.shapes[index], self.problem.solver.as_ref());
            shape.refactor(&self.weights, solver).map_err(failed)?;
            if let Some(control) = &mut self.control {
                control.forget_factors(index);
            }
        }
        if !shapes.is_empty() {
            self.renew_scratches();
        }
        Ok(())
    }

    /// Gives more mass to blocks that deform and whose contacts have become too stiff for the step; their kinetic energy stays.
    ///
    /// # Errors
    /// [`StepError::Factor`].
    pub(in crate::step) fn follow_contacts(&mut self, h: f64) -> Result<(), StepError> {
        let Some(bound) = self.resolved_h().filter(|bound| h > MOST * bound) else { return Ok(()) };
        let Some(mut masses) = self.scratch.scaled_masses.take() else { return Ok(()) };
        let mut more = vec![1.0f64; self.problem.shapes.len()];
        for (block, body) in self.blocks().ids().zip(&self.bodies) {
            let rate2 = self.contact_rate2(block);
            if self.shape(block).is_scalable() && self.part_s * rate2.sqrt() > MOST * bound {
                more[body.shape] = more[body.shape].max(power_of_two_from(masses.scale_s2 * rate2));
            }
        }
        let grown: Vec<usize> = (0..more.len()).filter(|shape| more[*shape] > 1.0).collect();
        for &shape in &grown {
            self.problem.shapes[shape].scale_mass(more[shape]);
            masses.of_shapes[shape] *= more[shape];
        }
        for (block, body) in self.problem.blocks.ids().zip(&self.bodies) {
            if more[body.shape] > 1.0 {
                let slower = more[body.shape].sqrt();
                self.state.velocity[self.problem.blocks.nodes_of(block)]
                    .iter_mut()
                    .for_each(|v| *v /= slower);
            }
        }
        if !grown.is_empty() {
            self.note_blow();
        }
        self.scratch.scaled_masses = Some(masses);
        self.factor_anew(&grown)
    }
}

/// The smallest power of two that is not below a factor; 1 for none.
fn power_of_two_from(factor: f64) -> f64 {
    if factor > 0.0 { factor.log2().ceil().exp2() } else { 1.0 }
}
