//! Forces that act on in the place of blocks, supports and bolts that a stage takes away, and ramp down; those of bolts with pretension that it installs
//! ramp up likewise.

use ndda_contact::FacetContact;
use ndda_fem::Table;
use ndda_fem::supports::BlockSupports;
use ndda_mesh::geometry::barycentric;
use ndda_mesh::{BlockId, Vec3};
use serde::{Deserialize, Serialize};

use crate::bodies::kind::BodyKind;
use crate::error::StepError;
use crate::step::Simulation;
use crate::step::follower::Places;
use crate::step::loads::VaryingLoad;
use crate::step::state::State;

/// Rows of the table of a ramp.
const RAMP_ROWS: u32 = 512;

/// Forces that shrink to nothing by 1 − 3 u² + 2 u³, u being the part of the time that has gone. Its slope is zero at both ends: an oscillator of
/// frequency ω is left with at most about 12/(ω T)² of what the force displaced it by after a ramp of length T; a straight one leaves 2/(ω T).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Release {
    /// Node, and force at the beginning [N].
    forces: Vec<(u32, Vec3)>,
    from_s: f64,
    until_s: f64,
    /// How fast the block that feels them most is made by all of them [m/s²].
    pace_m_s2: f64,
}

impl Release {
    fn factor(&self) -> Table {
        let row = |i: u32| {
            let part = f64::from(i) / f64::from(RAMP_ROWS);
            let time_s = self.from_s + part * (self.until_s - self.from_s);
            (time_s, 1.0 - part * part * (3.0 - 2.0 * part))
        };
        Table { rows: (0..=RAMP_ROWS).map(row).collect() }
    }
}

/// Contact at the present positions.
pub(super) struct ContactNow {
    force: Vec<Vec3>,
    friction: Vec<Vec3>,
    pub(super) facets: Vec<FacetContact>,
}

impl Simulation {
    /// Contact at the present positions; nothing of it is remembered.
    pub(super) fn contact_now(&mut self) -> Result<ContactNow, StepError> {
        self.without_memory(|simulation| {
            simulation.scratch.force.fill(Vec3::zeros());
            simulation.scratch.contact_position.copy_from_slice(&simulation.state.position);
            if simulation.contact.is_some() || simulation.has_bolts() {
                simulation.add_contact_forces(None)?;
            }
            let mut facets = Vec::new();
            simulation.add_facets(&mut facets);
            let force = simulation.scratch.force.clone();
            let mut friction = vec![Vec3::zeros(); force.len()];
            if simulation.scratch.friction_force.len() == force.len() {
                friction.copy_from_slice(&simulation.scratch.friction_force);
            }
            Ok(ContactNow { force, friction, facets })
        })
    }

    /// Friction and bonds between removed blocks and the others, per node [N]. Weights are linear in place, so that force and moment are exact.
    pub(super) fn contact_between(&self, contact: &ContactNow, removed: &[BlockId]) -> Vec<Vec3> {
        let blocks = &self.problem.blocks;
        let mut nodal = vec![Vec3::zeros(); blocks.rest_position.len()];
        let is_removed = |block: BlockId| removed.binary_search(&block).is_ok();
        for facet in &contact.facets {
            let owner = blocks.triangle_block[facet.facet.index()];
            if !is_removed(owner) && !is_removed(facet.target) {
                continue;
            }
            // What holds a bond is counted as friction, its tension too.
            let bond_n = if facet.area_m2 == 0.0 { facet.push_n } else { Vec3::zeros() };
            let force = facet.friction_n + bond_n;
            let corners = blocks.triangles[facet.facet.index()].map(|n| n.index());
            let place = |n: usize| self.state.position[n] + self.state.contact_offset_of(owner);
            for (node, weight) in on_triangle(corners, corners.map(place), &facet.center) {
                nodal[node] += weight * force;
            }
            let place = |n: usize| self.state.position[n] + self.state.contact_offset_of(facet.target);
            let tets = blocks.tets_of(facet.target).filter_map(|tet| {
                let nodes = blocks.tets[tet].map(|n| n.index());
                Some((nodes, barycentric(&nodes.map(place), &facet.center)?))
            });
            let least = |weights: &[f64; 4]| weights.iter().copied().fold(f64::INFINITY, f64::min);
            let nearest = tets.max_by(|a, b| least(&a.1).total_cmp(&least(&b.1)));
            let Some((nodes, weights)) = nearest else { continue };
            nodes.into_iter().zip(weights).for_each(|(node, weight)| nodal[node] -= weight * force);
        }
        nodal
    }

    /// Lets what is missing from the forces on the blocks act on, and ramp down.
    pub(super) fn release(
        &mut self,
        before: &Self,
        contact: (&ContactNow, &ContactNow, &[Vec3]),
        over_s: f64,
    ) {
        let (old, rest, pairs) = contact;
        let from_s = self.time_s();
        self.place_loads_now();
        let mut reactions = vec![Vec3::zeros(); self.state.position.len()];
        self.released_reactions(before, old).into_iter().for_each(|(n, force)| reactions[n] = force);
        // Friction that acts on velocities depends on all that acts on a block: what others do to it then is no part of what goes.
        let by_facets = self.contact.as_ref().is_some_and(|model| model.needs_bodies());
        let (mut forces, mut pace_m_s2) = (Vec::new(), 0.0f64);
        for block in self.problem.blocks.ids() {
            if self.is_absent(block) {
                continue;
            }
            let nodes = self.problem.blocks.nodes_of(block);
            let first = forces.len();
            for n in nodes {
                let mut missing = old.force[n] - rest.force[n];
                if by_facets {
                    missing += rest.friction[n] - old.friction[n] + pairs[n];
                }
                if let Some(guess) = self.state.contact_force.get_mut(n) {
                    *guess -= missing;
                }
                missing += before.loads.total()[n] - self.loads.total()[n] + reactions[n];
                if missing != Vec3::zeros() {
                    forces.push((n as u32, missing));
                }
            }
            if self.shape(block).kind != BodyKind::Fixed {
                let sum_n: f64 = forces[first..].iter().map(|(_, force)| force.norm()).sum();
                pace_m_s2 = pace_m_s2.max(sum_n / self.shape(block).operator.mass_kg);
            }
        }
        if let Some(stage) = &mut self.stage {
            stage.release = Some(Release { forces, from_s, until_s: from_s + over_s, pace_m_s2 });
        }
        self.place_release();
    }

    /// Forces of supports that are there no more, per node [N], where the integrator keeps internal forces: what balanced elasticity, loads and
    /// contact. Those of supports that stay would only pass to the support again.
    fn released_reactions(&self, before: &Self, contact: &ContactNow) -> Vec<(usize, Vec3)> {
        let mut forces = Vec::new();
        for block in self.problem.blocks.ids() {
            if self.is_absent(block) || before.is_absent(block) || self.state.internal_force.is_empty() {
                continue;
            }
            let (old, new) = (&before.shape(block).supports, &self.shape(block).supports);
            let first = self.problem.blocks.nodes_of(block);
            // The forces that keep a block affine have no resultant: all nodes together tell those of its supports.
            let nodes: Vec<usize> = match self.shape(block).kind {
                BodyKind::Affine if !removed_nodes(old, new).is_empty() => first.collect(),
                BodyKind::Elastic => removed_nodes(old, new).iter().map(|n| first.start + n).collect(),
                _ => Vec::new(),
            };
            forces.extend(
                nodes
                    .into_iter()
                    .map(|n| (n, self.state.internal_force[n] - before.loads.total()[n] - contact.force[n])),
            );
        }
        forces
    }

    /// Puts the ramp of the state among the loads.
    pub(super) fn place_release(&mut self) {
        let Some(stage) = &self.stage else { return };
        let load = stage.release.as_ref().map(|release| VaryingLoad {
            forces: release.forces.clone(),
            factor: release.factor(),
            pace_m_s2: release.pace_m_s2,
        });
        let now_s = self.clock_s(0.0);
        let State { position, velocity, .. } = &self.state;
        self.loads.release(load, now_s, Places { position, velocity, lead_s: 0.0 });
    }
}

/// Nodes, counted from the block's first, at which supports were that are there no more, ascending.
fn removed_nodes(old: &BlockSupports, new: &BlockSupports) -> Vec<usize> {
    let held = old.held.iter().filter(|held| !new.held.contains(held)).map(|held| held.node);
    let springs = old.springs.iter().filter(|spring| !new.springs.contains(spring)).map(|spring| spring.node);
    let mut nodes: Vec<usize> = held.chain(springs).map(|node| node as usize).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// Weights of the corners of a triangle at a point in its plane.
fn on_triangle(nodes: [usize; 3], corners: [Vec3; 3], at: &Vec3) -> [(usize, f64); 3] {
    let [a, b, c] = corners;
    let normal = (b - a).cross(&(c - a));
    let over = normal.norm_squared();
    let part = |from: Vec3, to: Vec3| normal.dot(&(to - from).cross(&(at - from))) / over;
    [(nodes[0], part(b, c)), (nodes[1], part(c, a)), (nodes[2], part(a, b))]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bolts::setup::{BoltSetup, Grout, Steel};
    use crate::step::test_boxes::boxes;

    #[test]
    fn a_look_at_contact_changes_nothing_that_bolts_remember() {
        let foot = (BodyKind::Fixed, [1.0; 3], [0.0; 3]);
        let top = (BodyKind::Rigid, [1.0; 3], [0.0, 0.0, 1.0]);
        let mut setup = boxes(&[foot, top]);
        let at = |height_m: f64| Vec3::new(0.5, 0.5, height_m) - setup.blocks.origin_m;
        setup.bolts.push(BoltSetup {
            name: "anchor".into(),
            from_m: at(1.9),
            to_m: at(0.1),
            steel: Steel {
                young_pa: 2e11,
                area_m2: 5e-4,
                yield_n: f64::INFINITY,
                break_strain: f64::INFINITY,
            },
            grout: Grout { stiffness_n_m2: 1e9, strength_n_m: 1e4, from_m: 0.0, to_m: 1.8 },
            dowel: None,
            pretension_n: 0.0,
            plate: None,
            segment_m: None,
            is_installed: true,
            absent: Vec::new(),
        });
        let mut simulation = Simulation::new(setup).unwrap();
        let force = simulation.scratch.force.clone();
        // Pulled out by a centimetre, its grout slips.
        let nodes = simulation.problem.blocks.nodes_of(BlockId(1));
        simulation.state.position[nodes.clone()].iter_mut().for_each(|x| x.z += 1e-2);
        let before = simulation.state.clone();
        let contact = simulation.contact_now().unwrap();
        assert!(contact.force[nodes].iter().sum::<Vec3>().z < -1e3, "the bolt pulls");
        assert_eq!(simulation.state, before);
        assert_eq!(simulation.scratch.force, force);
    }
}
