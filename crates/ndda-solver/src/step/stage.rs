//! Stages of construction: blocks that come and go between two steps, and loads that change over a time.

use std::ops::Range;

use ndda_contact::FacetContact;
use ndda_fem::Table;
use ndda_mesh::{BlockId, Vec3};
use serde::{Deserialize, Serialize};

use crate::bodies::kind::BodyKind;
use crate::bodies::prototype::Prototype;
use crate::diagnostics::block_diagnostics::BlockDiagnostics;
use crate::diagnostics::energies::Sample;
use crate::error::StepError;
use crate::step::Simulation;
use crate::step::change::TakeOverError;
use crate::step::follower::Places;
use crate::step::loads::VaryingLoad;
use crate::step::state::State;

/// What stages keep of a simulation.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StageState {
    /// Which blocks are absent.
    pub(crate) absent: Vec<bool>,
    /// Forces that act on in place of what was taken away, until they have ramped down.
    pub(crate) release: Option<Release>,
    /// Where nodes were when displacements were last set to zero [m]; empty while they never were.
    pub(crate) counted_from: Vec<Vec3>,
}

/// Rows of the table of a ramp.
const RAMP_ROWS: u32 = 512;

/// Forces that shrink to nothing by 1 − 3 u² + 2 u³, u being the part of the time that has gone. Its slope is zero at both ends: an oscillator of
/// frequency ω is left with 12/(ω T)² of what the force displaced it by, at most, after a ramp of length T; a straight one leaves 2/(ω T).
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

/// Blocks cannot be left out.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LeaveOutError {
    /// A block that is left out would move.
    #[error("block {0} is left out, but is not Fixed: build it as a Fixed block without loads")]
    NotFixed(String),
    /// The contact model knows of no absent blocks.
    #[error("this contact model cannot leave blocks out, as stages need: use Potential contact")]
    Contact,
}

/// What a stage does to the state that it begins with.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StageStart {
    /// Time over which forces of removed blocks, and of loads that are taken away or added, change to what they are in the stage [s]; at once if zero.
    pub over_s: f64,
    /// Whether displacements count from here on.
    pub reset_displacements: bool,
}

/// Contact at the present positions.
struct ContactNow {
    force: Vec<Vec3>,
    friction: Vec<Vec3>,
    facets: Vec<FacetContact>,
}

impl Simulation {
    /// Leaves blocks out from now on, those that are `true`: they feel nothing, nothing feels them, and they have no energy. They are
    /// built as `Fixed` ones.
    ///
    /// # Errors
    /// [`LeaveOutError`].
    pub fn leave_out(&mut self, absent: Vec<bool>) -> Result<(), LeaveOutError> {
        let is_absent = |block: &BlockId| absent.get(block.index()) == Some(&true);
        let mut left_out = self.problem.blocks.ids().filter(is_absent);
        if let Some(block) = left_out.find(|block| self.shape(*block).kind != BodyKind::Fixed) {
            return Err(LeaveOutError::NotFixed(self.problem.blocks.names[block.index()].clone()));
        }
        if self.contact.as_mut().is_some_and(|model| !model.leave_out(&absent)) {
            return Err(LeaveOutError::Contact);
        }
        let ranges: Vec<Range<usize>> =
            self.blocks().ids().filter(is_absent).map(|block| self.blocks().nodes_of(block)).collect();
        let State { position, velocity, .. } = &self.state;
        self.loads.leave_out(&ranges, Places { position, velocity, lead_s: 0.0 });
        self.stage = Some(Box::new(StageState { absent, ..StageState::default() }));
        Ok(())
    }

    /// Whether a block is absent.
    pub fn is_absent(&self, block: BlockId) -> bool {
        self.stage.as_ref().is_some_and(|stage| stage.absent.get(block.index()) == Some(&true))
    }

    /// Whether blocks may come and go.
    pub fn has_stages(&self) -> bool {
        self.stage.is_some()
    }

    /// Where displacements count from [m]: the start, or where a stage set them to zero.
    pub fn counted_from(&self) -> &[Vec3] {
        match &self.stage {
            Some(stage) if !stage.counted_from.is_empty() => &stage.counted_from,
            _ => self.start_position(),
        }
    }

    /// Continues from the state of another simulation of the same blocks, of which others are absent, under the loads, supports and laws of this one.
    ///
    /// Forces of blocks that are taken out act on and ramp down, and so does the difference of the loads, over `start.over_s`. Blocks that are
    /// added are where they were meshed, at rest and without stress. The energy of what is taken out, added, and of their contact is in the
    /// balance as energy removed; what else changes at once is work of loads.
    ///
    /// # Errors
    /// [`TakeOverError`]; this simulation is then not to be used.
    pub fn begin_stage(&mut self, before: &mut Self, start: &StageStart) -> Result<(), TakeOverError> {
        if self.weights.needs_acceleration {
            return Err(TakeOverError::RemembersAccelerations);
        }
        self.refuse_other_supports(before)?;
        let (old, _) = before.look()?;
        let released = self.changing_blocks(before, |new, old| new && !old);
        let added = self.changing_blocks(before, |new, old| !new && old);
        let mut removed_j = self.energy_of(before, &released)?;
        let contact = before.contact_now()?;
        let snapshot = before.snapshot();
        self.restore(snapshot.clone())?;
        self.change_places(before, (&released, &added), start);
        let rest = self.contact_now()?;
        // Laws that keep other numbers of each facet have refused the history by now; what the evaluation left behind goes.
        self.restore(snapshot)?;
        self.change_places(before, (&released, &added), start);
        self.stop_held_nodes(before);
        if start.over_s > 0.0 {
            let pairs = before.contact_between(&contact, &released);
            self.release(before, (&contact, &rest, &pairs), start.over_s);
        }
        let scales = self.problem.blocks.ids().map(|block| self.shape(block).scale()).collect();
        self.audit.ledger.blocks().weigh_anew(scales);
        let (new, books) = self.look()?;
        self.audit.ledger.blocks().rebase(&books);
        for block in &added {
            removed_j -= self.block_energy_j(*block)?;
        }
        removed_j += old.contact_j - new.contact_j;
        self.audit.ledger.add_work(0.0, 0.0, new.total_j() - old.total_j() + removed_j, 0.0);
        self.audit.ledger.add_removed(removed_j);
        self.audit
            .ledger
            .add_whole_impulse(new.momentum - old.momentum, new.angular_momentum - old.angular_momentum);
        Ok(())
    }

    /// Blocks that are absent now and were absent before as asked for.
    fn changing_blocks(&self, before: &Self, asked: impl Fn(bool, bool) -> bool) -> Vec<BlockId> {
        let blocks = self.problem.blocks.ids();
        blocks.filter(|&block| asked(self.is_absent(block), before.is_absent(block))).collect()
    }

    /// Energy of some blocks as they were before [J].
    fn energy_of(&self, before: &mut Self, blocks: &[BlockId]) -> Result<f64, StepError> {
        let mut total_j = 0.0;
        for block in blocks {
            total_j += before.block_energy_j(*block)?;
        }
        Ok(total_j)
    }

    /// Takes removed blocks to rest, and added ones to where they were meshed.
    fn change_places(&mut self, before: &Self, changed: (&[BlockId], &[BlockId]), start: &StageStart) {
        let (removed, added) = changed;
        if let Some(stage) = &mut self.stage {
            stage.release = None;
            if start.reset_displacements {
                stage.counted_from = before.state.position.clone();
            }
        }
        self.place_release();
        for &block in removed.iter().chain(added) {
            let nodes = self.problem.blocks.nodes_of(block);
            self.state.velocity[nodes.clone()].fill(Vec3::zeros());
            let State { acceleration, internal_force, contact_force, .. } = &mut self.state;
            for values in [acceleration, internal_force, contact_force] {
                values.get_mut(nodes.clone()).into_iter().flatten().for_each(|value| *value = Vec3::zeros());
            }
        }
        for &block in added {
            let nodes = self.problem.blocks.nodes_of(block);
            let rest = &self.problem.blocks.rest_position[nodes.clone()];
            let counted_from = self.stage.as_mut().map(|stage| &mut stage.counted_from);
            let places = [&mut self.state.position, &mut self.state.start].into_iter().chain(counted_from);
            for place in places.filter_map(|all| all.get_mut(nodes.clone())) {
                place.copy_from_slice(rest);
            }
        }
        let (blocks, absent) = (&self.problem.blocks, self.stage.as_ref().map_or(&[][..], |s| &s.absent));
        self.state.contact.forget_bonds(blocks, |block| absent.get(block.index()) == Some(&true));
    }

    /// Contact at the present positions; nothing of it is remembered.
    fn contact_now(&mut self) -> Result<ContactNow, StepError> {
        let nodes = self.state.position.len();
        let kept = (self.state.contact.clone(), std::mem::take(&mut self.scratch.force));
        self.scratch.force = vec![Vec3::zeros(); nodes];
        self.scratch.contact_position.copy_from_slice(&self.state.position);
        let found = if self.contact.is_some() { self.add_contact_forces(None).map(|_| ()) } else { Ok(()) };
        let mut facets = Vec::new();
        self.add_facets(&mut facets);
        self.state.contact = kept.0;
        let force = std::mem::replace(&mut self.scratch.force, kept.1);
        let mut friction = vec![Vec3::zeros(); nodes];
        if self.scratch.friction_force.len() == nodes {
            friction.copy_from_slice(&self.scratch.friction_force);
        }
        found.map(|()| ContactNow { force, friction, facets })
    }

    /// Friction and bonds between removed blocks and the others, per node [N]. Weights are linear in place, so that force and moment are exact.
    fn contact_between(&self, contact: &ContactNow, removed: &[BlockId]) -> Vec<Vec3> {
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
            let tets = blocks.tets_of(facet.target).map(|tet| {
                let corners = blocks.tets[tet].map(|n| n.index());
                on_tet(corners, corners.map(place), &facet.center)
            });
            let least =
                |weights: &[(usize, f64); 4]| weights.iter().map(|w| w.1).fold(f64::INFINITY, f64::min);
            let nearest = tets.max_by(|a, b| least(a).total_cmp(&least(b)));
            nearest.into_iter().flatten().for_each(|(node, weight)| nodal[node] -= weight * force);
        }
        nodal
    }

    /// Lets what is missing from the forces on the blocks act on, and ramp down.
    fn release(&mut self, before: &mut Self, contact: (&ContactNow, &ContactNow, &[Vec3]), over_s: f64) {
        let (old, rest, pairs) = contact;
        let from_s = self.time_s();
        for simulation in [&mut *self, before] {
            let State { position, velocity, .. } = &simulation.state;
            simulation.loads.place(from_s, from_s, Places { position, velocity, lead_s: 0.0 });
        }
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
                missing += before.loads.total()[n] - self.loads.total()[n];
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

    /// Takes over what stages keep; which blocks are absent is known from the start.
    pub(super) fn restore_stage(&mut self, saved: Option<StageState>) {
        let Some(saved) = saved else { return };
        let absent = self.stage.take().map_or(saved.absent, |own| own.absent);
        self.stage = Some(Box::new(StageState { absent, ..saved }));
        self.place_release();
    }

    /// Puts the ramp of the state among the loads.
    fn place_release(&mut self) {
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

    /// Energies now, and those of pairs of blocks, without a word in the ledger.
    pub(super) fn look(&mut self) -> Result<(Sample, BlockDiagnostics), StepError> {
        let kept = self.audit.ledger.clone();
        let sample = self.sample();
        let books = self.audit.ledger.blocks().clone();
        self.audit.ledger = kept;
        Ok((sample?, books))
    }

    /// Kinetic, elastic, spring and load energy of a block [J].
    fn block_energy_j(&mut self, block: BlockId) -> Result<f64, StepError> {
        let time_s = self.time_s();
        let nodes = self.problem.blocks.nodes_of(block);
        let start =
            if self.state.start.is_empty() { &self.problem.blocks.rest_position } else { &self.state.start };
        let (position, velocity) = (&self.state.position[nodes.clone()], &self.state.velocity[nodes.clone()]);
        let loads = self.loads.constant()[nodes.clone()].iter().zip(position).zip(&start[nodes]);
        let load_j = -loads.map(|((f, x), start)| f.dot(&(x - start))).sum::<f64>();
        let body = &mut self.bodies[block.index()];
        let shape: &Prototype = &self.problem.shapes[body.shape];
        let rigid_j = shape.operator.kinetic_energy_j(velocity) + load_j;
        let Some(elastic) = body.elastic() else { return Ok(rigid_j) };
        let strain_j = elastic.strain_energy_j(shape, position).map_err(|source| StepError::Block {
            time_s,
            block: self.problem.blocks.names[block.index()].clone(),
            source: source.into(),
        })?;
        Ok(rigid_j + strain_j + elastic.spring_energy_j(shape, position, time_s))
    }
}

/// Weights of the corners of a triangle at a point in its plane.
fn on_triangle(nodes: [usize; 3], corners: [Vec3; 3], at: &Vec3) -> [(usize, f64); 3] {
    let [a, b, c] = corners;
    let normal = (b - a).cross(&(c - a));
    let over = normal.norm_squared();
    let part = |from: Vec3, to: Vec3| normal.dot(&(to - from).cross(&(at - from))) / over;
    [(nodes[0], part(b, c)), (nodes[1], part(c, a)), (nodes[2], part(a, b))]
}

/// Weights of the corners of a tetrahedron at a point.
fn on_tet(nodes: [usize; 4], corners: [Vec3; 4], at: &Vec3) -> [(usize, f64); 4] {
    let volume = |[a, b, c, d]: [Vec3; 4]| (b - a).cross(&(c - a)).dot(&(d - a));
    let whole = volume(corners);
    [0, 1, 2, 3].map(|i| {
        let mut replaced = corners;
        replaced[i] = *at;
        (nodes[i], volume(replaced) / whole)
    })
}
