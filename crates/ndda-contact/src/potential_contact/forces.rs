//! Forces of contact on facets, from pressure, damping, springs and bonds, and on the nodes of blocks, with the friction of faces.

use ndda_mesh::Vec3;
use ndda_ranks::ExactSum;
use rayon::prelude::*;

use crate::affine::convex_target::ConvexBlocks;
use crate::assembly::join_if::join_if;
use crate::assembly::nodal_forces::{self, ScatterScene};
use crate::assembly::searched_friction;
use crate::friction::bond;
use crate::friction::facet::{FacetForce, FacetOutcome, FacetScene};
use crate::friction::patches::PatchScene;
use crate::friction::twist::couples_of_springs;
use crate::integration::integrals::Integrals;
use crate::integration::overlap_pair::ActiveFacet;
use crate::integration::pair_moments::OnTarget;
use crate::model::{ContactError, ContactHistory, ContactInput, ContactOutput, ContactReport};
use crate::potential::contact_potential::OverlapLaw;
use crate::restitution::{ContactDamping, DampingScene};
use crate::room::make_room;

use super::PotentialContact;

/// Facets below which a second thread costs more than it brings.
const GRAIN_FACETS: usize = 128;

impl PotentialContact {
    /// Whether friction of faces is searched for.
    fn searches_friction(&self, input: &ContactInput) -> bool {
        self.rubs_faces() && !input.bodies.is_empty() && !input.without_friction
    }

    /// Takes the deepest penetration from overlaps of blocks, where the energy of contact is no multiple of these.
    pub(super) fn report_deepest(&self, report: &mut ContactReport) {
        if self.potential.law() != OverlapLaw::Linear
            && let Some((ratio, t)) = self.overlaps.deepest()
        {
            let touch = &self.integrals.touching()[t];
            report.max_penetration_ratio = ratio;
            report.deepest = self.integrals.overlaps_of(touch).first().map(|hit| (touch.triangle, hit.tet));
        }
    }

    /// Breaks bonds that are overloaded, and finds the forces of those that are left.
    pub(super) fn load_bonds(
        &mut self,
        input: &ContactInput,
        history: &mut ContactHistory,
        report: &mut ContactReport,
    ) {
        self.bond_forces.clear();
        if let Some(joints) = self.joints.as_ref().filter(|_| !history.bonds.is_empty()) {
            let (integrals, penalty_pa) = (&self.integrals, &self.penalty_of_facet);
            let kept = (&mut *history, &mut self.new_state);
            (report.bond_overload, report.overloaded_bonds) =
                bond::break_overloaded(joints, integrals, penalty_pa, input, kept);
            bond::find_forces(joints, input, &history.bonds, &mut self.bond_forces);
        }
    }

    /// Finds the damping of the step, where there is any.
    pub(super) fn damp(&mut self, input: &ContactInput, history: &mut ContactHistory) {
        let Some(damping) = self.damping.as_mut().filter(|_| !input.bodies.is_empty()) else { return };
        let scene = DampingScene {
            input,
            integrals: &self.integrals,
            hulls: &self.hulls,
            openings: &self.openings,
            joints: self.joints.as_ref(),
            penalty_pa: &self.penalty_of_facet,
            curvature_pa_m: &self.curvature_of_facet,
        };
        damping.find(&scene, history);
    }

    /// Finds the force of each facet; meanwhile facets are sorted by block, and by face where friction of faces is searched for.
    pub(super) fn place_facet_forces(&mut self, input: &ContactInput, history: &ContactHistory) {
        let searches_friction = self.searches_friction(input);
        let Self { integrals, hulls, adjacency, faces, .. } = self;
        let blocks_of = |touch: &ActiveFacet| (touch.owner, touch.target);
        let sort = || {
            adjacency.arrange(input.blocks.len(), integrals.touching().iter().map(blocks_of));
            if searches_friction {
                faces.arrange(integrals);
            }
        };
        let rows = FacetRows {
            forces: &mut self.forces,
            outcomes: &mut self.outcomes,
            on_host: &mut self.on_host,
            state: &mut self.state_of_facet,
        };
        let joints = self.joints.as_ref();
        let couples = couples_of_springs(joints, input, (integrals, hulls));
        let scene = FacetScene { input, joints, history, elastic_pa: self.penalty_pa, couples };
        let damping = acting(&self.damping, input);
        let left_pa = damping.map_or(&self.penalty_of_facet[..], ContactDamping::left_pa);
        let dashpot_n = damping.map_or(&[][..], ContactDamping::shear_n);
        let place = || place_forces(rows, &scene, integrals, (left_pa, dashpot_n), hulls);
        join_if(integrals.touching().len() > GRAIN_FACETS, place, sort);
    }

    /// Takes over what dashpots remember, and reports how far steps are too long for them.
    pub(super) fn remember_dashpots(
        &self,
        input: &ContactInput,
        history: &mut ContactHistory,
        report: &mut ContactReport,
    ) {
        let Some(damping) = acting(&self.damping, input) else { return };
        let found = (&self.forces[..], &self.outcomes[..]);
        report.dashpot_error_m_s = damping.error_m_s(&self.integrals, found, input.dt_s);
        damping.remember_dashpots(input, &self.integrals, found, history);
    }

    /// Adds the forces of facets to the nodes of both their blocks, with the friction of faces, which is found for all blocks together.
    pub(super) fn add_to_nodes(
        &mut self,
        input: &ContactInput,
        history: &mut ContactHistory,
        output: &mut ContactOutput,
        report: &mut ContactReport,
    ) -> Result<(), ContactError> {
        let searches_friction = self.searches_friction(input);
        let Self { integrals, hulls, faces, forces, push_n, .. } = self;
        let damping = acting(&self.damping, input);
        let couples = couples_of_springs(self.joints.as_ref(), input, (integrals, hulls));
        let damped = ContactInput { bodies: damping.map_or(input.bodies, ContactDamping::bodies), ..*input };
        let patches = self.joints.as_ref().filter(|_| searches_friction).map(|joints| PatchScene {
            input: &damped,
            integrals,
            joints,
            hulls,
            bonds: &self.bond_forces,
        });
        if let Some(scene) = &patches {
            faces.begin(scene, forces, history);
        }
        let scatter = ScatterScene {
            blocks: input.blocks,
            position: (couples.is_some() || damping.is_some()).then_some(input.position),
            tilt_n_m: damping.map_or(&[][..], ContactDamping::tilt_n_m),
            integrals,
            adjacency: &self.adjacency,
            hulls,
            forces: &[],
            on_host: &self.on_host,
            stiffness_pa: &self.penalty_of_facet,
            curvature_pa_m: &self.curvature_of_facet,
        };
        push_n.clear();
        let asks_nodes = patches.as_ref().is_some_and(|scene| faces.asks_nodes(scene));
        if asks_nodes {
            push_n.resize(input.position.len(), Vec3::zeros());
        }
        let mut into = ContactOutput {
            force: if asks_nodes { &mut *push_n } else { &mut *output.force },
            friction_force: &mut *output.friction_force,
            stiffness: &mut *output.stiffness,
        };
        let known = ScatterScene { forces: &*forces, ..scatter };
        match input.ranks {
            None => nodal_forces::add(&known, &mut into),
            Some(ranks) => self.shared_forces.add(ranks, &known, &mut into)?,
        }
        let Some(scene) = &patches else { return Ok(()) };
        report.friction_left_m_s = faces.find(scene, push_n, forces, history);
        if asks_nodes {
            searched_friction::add_all(output.force, push_n);
        }
        let found = ScatterScene { forces: &*forces, position: Some(input.position), ..scatter };
        searched_friction::add(&found, faces, output);
        Ok(())
    }

    /// Sums up the work of facets against the opening of their joints.
    pub(super) fn report_dilation(&self, report: &mut ContactReport) {
        if !self.openings.is_empty() {
            let works = self.outcomes.iter().map(|outcome| outcome.dilation_work_j);
            report.dilation_work_j = works.collect::<ExactSum>().value();
        }
    }
}

/// Damping, if there is any and the motion of blocks is known, which it depends on.
fn acting<'a>(damping: &'a Option<Box<ContactDamping>>, input: &ContactInput) -> Option<&'a ContactDamping> {
    damping.as_deref().filter(|_| !input.bodies.is_empty())
}

/// Output of [`place_forces`]: forces of facets, what laws that act on facets find, reactions on host tetrahedra, and the numbers of the laws.
struct FacetRows<'a> {
    forces: &'a mut Vec<FacetForce>,
    outcomes: &'a mut Vec<FacetOutcome>,
    on_host: &'a mut Vec<OnTarget>,
    state: &'a mut Vec<f64>,
}

/// The forces of all facets, and what hosts feel of them.
fn place_forces(
    FacetRows { forces, outcomes, on_host, state }: FacetRows,
    scene: &FacetScene,
    integrals: &Integrals,
    (penalty_of_facet, dashpot_n): (&[f64], &[Vec3]),
    hulls: &ConvexBlocks,
) {
    let touching = integrals.touching();
    let state_len = scene.history.law_state_len as usize;
    make_room(forces, touching.len());
    forces.resize(touching.len(), FacetForce::default());
    state.resize(touching.len() * state_len, 0.0);
    let has_laws = state_len > 0 || scene.joints.is_some_and(|joints| !joints.act_on_faces_only());
    outcomes.clear();
    make_room(outcomes, if has_laws { touching.len() } else { 0 });
    outcomes.resize(if has_laws { touching.len() } else { 0 }, FacetOutcome::default());
    let place = |force: &mut FacetForce, t: usize, found: (Option<&mut FacetOutcome>, &mut [f64])| {
        let (overlaps, sums) = (integrals.overlaps_of(&touching[t]), integrals.sums_of(&touching[t]));
        let pushes = (t, penalty_of_facet[t], dashpot_n.get(t));
        *force = scene.force(&touching[t], overlaps, sums, pushes, found);
    };
    if state_len > 0 {
        let entries = forces.par_iter_mut().zip(outcomes).zip(state.par_chunks_mut(state_len)).enumerate();
        entries
            .with_min_len(GRAIN_FACETS / 2)
            .for_each(|(t, ((force, outcome), state))| place(force, t, (Some(outcome), state)));
    } else if has_laws {
        let entries = forces.par_iter_mut().zip(outcomes).enumerate().with_min_len(GRAIN_FACETS / 2);
        entries.for_each(|(t, (force, outcome))| place(force, t, (Some(outcome), &mut [])));
    } else {
        for_each_facet(forces, |(t, force)| place(force, t, (None, &mut [])));
    }
    on_host.clear();
    if hulls.count_affine() > 0 {
        on_host.resize(touching.len(), OnTarget::default());
        for_each_facet(on_host, |(t, on_host)| {
            if hulls.affine_target(touching[t].target).is_some() {
                *on_host = integrals.overlaps_of(&touching[t])[0].on_target;
            }
        });
    }
}

/// Fills a list with one entry per facet, on all threads if it is long.
pub(super) fn for_each_facet<T: Send>(entries: &mut [T], fill: impl Fn((usize, &mut T)) + Send + Sync) {
    if entries.len() > GRAIN_FACETS {
        entries.par_iter_mut().enumerate().with_min_len(GRAIN_FACETS / 2).for_each(fill);
    } else {
        entries.iter_mut().enumerate().for_each(fill);
    }
}
