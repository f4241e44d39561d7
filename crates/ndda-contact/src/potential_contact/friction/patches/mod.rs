//! Friction of whole faces, for laws that act on velocities.
//!
//! A face is a set of boundary triangles in one plane and of one surface. Its contact with another block is a patch, together with a
//! face of the other block that lies on it (`opposite.rs`), or with a part of either (`parts.rs`): its friction is one force F and one torque T about the
//! normal, spread over its facets (`spread.rs`), and obeys Coulomb's law point by point (`limit_surface.rs`). The friction of all patches is found
//! together (`solve.rs`); blocks that deform answer to it at their nodes, as the solver says (`nodal.rs`).

mod limit_surface;
pub(crate) mod moments;
mod nodal;
mod opposite;
mod parts;
mod patch;
mod solve;
mod spread;
mod tolerance;

use ndda_mesh::{BlockId, BlockSet, Mat3, Vec3};
use rayon::prelude::*;

use crate::affine::convex_target::ConvexBlocks;
use crate::affine::surface::BlockFaces;
use crate::assembly::adjacency::BlockContactIndex;
use crate::assembly::couples::CoupleScene;
use crate::assembly::join_if::join_if;
use crate::friction::bond::BondForce;
use crate::friction::facet::FacetForce;
use crate::friction::law::FrictionLaw;
use crate::friction::law_table::FrictionLawTable;
use crate::friction::patches::nodal::{Nodal, NodalSide, SideScene};
use crate::friction::patches::opposite::Opposite;
use crate::friction::patches::parts::FaceParts;
use crate::friction::patches::patch::{ContactPatch, Moved, PatchFacets, PatchSummary, Remembered};
use crate::friction::patches::solve::chunks::Division;
use crate::friction::patches::solve::newton::Newton;
use crate::friction::patches::solve::stage::{self, Visits};
use crate::friction::patches::solve::{CoupledPatch, Motion, Search};
use crate::friction::patches::tolerance::Tolerance;
use crate::integration::integrals::Integrals;
use crate::integration::overlap_pair::{ActiveFacet, FacetMoments};
use crate::model::{Body, ContactHistory, ContactInput, FaceMemory};

/// Faces below which a second thread costs more than it brings.
const GRAIN_PATCHES: usize = 64;

/// Blocks below which a second thread costs more than it brings.
const GRAIN_BODIES: usize = 16;

/// Input of all patches.
#[derive(Clone, Copy)]
pub(crate) struct PatchScene<'a> {
    /// Blocks and their motion.
    pub input: &'a ContactInput<'a>,
    /// Integrals of the pairs.
    pub integrals: &'a Integrals,
    /// Laws.
    pub joints: &'a FrictionLawTable,
    /// Blocks that are affine convex targets.
    pub hulls: &'a ConvexBlocks,
    /// Forces of unbroken bonds.
    pub bonds: &'a [BondForce],
}

impl PatchScene<'_> {
    fn touch(&self, t: u32) -> &ActiveFacet {
        &self.integrals.touching()[t as usize]
    }

    fn sums(&self, t: u32) -> &FacetMoments {
        self.integrals.sums_of(self.touch(t))
    }

    fn owner(&self, t: u32) -> BlockId {
        self.touch(t).owner
    }

    /// Input of the computation of couples.
    fn couples(&self) -> CoupleScene<'_> {
        let ContactInput { blocks, position, .. } = *self.input;
        CoupleScene { blocks, position, integrals: self.integrals, hulls: self.hulls }
    }

    /// The law of the facets of a run, if it acts on faces.
    fn law(&self, run: &[Place]) -> Option<&dyn FrictionLaw> {
        let (_, target, first) = run[0];
        let law = self.joints.law(self.input.blocks, self.touch(first).triangle, target);
        law.filter(|law| law.acts_on_faces())
    }
}

/// (face, target, number of the touching facet).
type Place = (u32, BlockId, u32);

/// Facets by face and target, and room for what a step finds.
#[derive(Default)]
pub(crate) struct FrictionPatches {
    face_parts: FaceParts,
    /// Touching facets by face and target.
    by_face: Vec<Place>,
    /// Touching facets by patch, those of each patch among them, and the patch of each facet.
    order: Vec<Place>,
    runs: Vec<PatchFacets>,
    run_of: Vec<u32>,
    opposite: Opposite,
    /// Patches by block.
    adjacency: BlockContactIndex,
    /// Blocks with the velocities at the end of the step.
    bodies: Vec<Body>,
    /// Whether a block has patches with friction.
    is_asked: Vec<bool>,
    /// Nodes of those that deform.
    nodal: Nodal,
    /// One per run.
    patches: Vec<ContactPatch>,
    summaries: Vec<PatchSummary>,
    coupled: Vec<CoupledPatch>,
    /// Sides of each patch on blocks that deform.
    sides: Vec<[Option<NodalSide>; 2]>,
    /// Room for their solution, by block.
    most_n: Vec<f64>,
    visits: Visits,
    newton: Newton,
    /// How patches are divided among threads, and those whose friction is searched for in that order.
    division: Division,
    searched: Vec<u32>,
    new_faces: Vec<FaceMemory>,
    gaps_j: Vec<f64>,
    /// Second moments of each facet about its own centre of pressure [m²].
    own_m2: Vec<Mat3>,
}

impl FrictionPatches {
    /// Takes the faces of all blocks; once per set of blocks.
    pub(crate) fn fit(&mut self, blocks: &BlockSet, surfaces: &[BlockFaces], affine: &[bool]) {
        self.face_parts.fit(blocks, surfaces, affine);
    }

    /// Sorts touching facets by face and target; those of a block are together already, and its faces follow each other.
    pub(crate) fn arrange(&mut self, integrals: &Integrals) {
        self.by_face.clear();
        let place =
            |(t, touch): (u32, &ActiveFacet)| (self.face_parts.face_of(touch.triangle), touch.target, t);
        let touching = integrals.touching();
        self.by_face.extend((0..).zip(touching).map(place));
        let of_one_block =
            |a: &Place, b: &Place| touching[a.2 as usize].owner == touching[b.2 as usize].owner;
        self.by_face.par_chunk_by_mut(of_one_block).for_each(<[Place]>::sort_unstable);
    }

    /// Which facets each patch has.
    fn join_faces(&mut self, scene: &PatchScene, forces: &[FacetForce], history: &ContactHistory) {
        let Self { opposite, by_face, order, runs, run_of, face_parts, .. } = self;
        opposite.join(scene, (forces, history), (by_face, order), (face_parts, runs));
        run_of.resize(forces.len(), 0);
        for (number, run) in (0..).zip(&*runs) {
            order[run.places.clone()].iter().for_each(|&(_, _, t)| run_of[t as usize] = number);
        }
    }

    /// Adds the friction of faces whose law acts on faces to the facets' forces, and takes over what they remember; the facets are
    /// [arranged](Self::arrange). Gives the largest change of a slip [m/s] when the search for friction ended before it was found.
    pub(crate) fn add(
        &mut self,
        scene: &PatchScene,
        forces: &mut [FacetForce],
        history: &mut ContactHistory,
    ) -> f64 {
        self.join_faces(scene, forces, history);
        self.find_patches(scene, forces, history);
        let blocks_of = |summary: &PatchSummary| (summary.owner, summary.target);
        self.adjacency.arrange(scene.input.blocks.len(), self.summaries.iter().map(blocks_of));
        let tolerance = Tolerance::new(scene.input, scene.joints.tolerance, self.patches.len());
        tolerance.find(&mut self.summaries, scene.input.bodies, &mut self.most_n);
        self.advance_bodies(scene);
        let left_m_s = self.solve(scene, forces).left_m_s;
        let Self { patches, runs, run_of, new_faces, own_m2, .. } = self;
        let spread = |((t, force), run): ((usize, &mut FacetForce), &u32)| {
            let (t, own_m2) = (t as u32, &own_m2[t]);
            if scene.sums(t).pressure > 0.0 {
                let patch = &patches[*run as usize];
                patch.spread_to(force, (scene, t, own_m2.trace()), patch.sign_of(scene.touch(t)));
            }
        };
        let memory_of =
            |(patch, run): (&ContactPatch, &PatchFacets)| patch.has_friction().then(|| patch.memory(run));
        // The old records have been read, so that their memory is free for the new ones.
        std::mem::swap(&mut history.faces, new_faces);
        join_if(
            patches.len() > GRAIN_PATCHES,
            || {
                forces
                    .par_iter_mut()
                    .enumerate()
                    .zip(&run_of[..])
                    .with_min_len(GRAIN_PATCHES)
                    .for_each(spread)
            },
            || {
                new_faces.clear();
                new_faces.extend(patches.iter().zip(runs.iter()).filter_map(memory_of));
            },
        );
        std::mem::swap(&mut history.faces, &mut self.new_faces);
        left_m_s
    }

    /// Where each face presses, how hard, and how it slips.
    fn find_patches(&mut self, scene: &PatchScene, forces: &[FacetForce], history: &ContactHistory) {
        self.own_m2.resize(forces.len(), Mat3::zeros());
        let own = |(t, (own, force)): (u32, (&mut Mat3, &FacetForce))| {
            let FacetMoments { pressure, area, .. } = *scene.sums(t);
            let touch = scene.touch(t);
            if pressure > 0.0 {
                *own = moments::second_moment_m2((scene.input, scene.hulls), touch, area, &force.center);
            }
        };
        let each = self.own_m2.par_iter_mut().zip(forces).enumerate();
        each.with_min_len(GRAIN_PATCHES).for_each(|(t, each)| own((t as u32, each)));
        let (order, runs, own) = (&self.order, &self.runs, &self.own_m2);
        self.patches.resize(runs.len(), ContactPatch::default());
        self.summaries.resize(runs.len(), PatchSummary::default());
        let patches = self.patches.par_chunks_mut(GRAIN_PATCHES);
        let found = patches.zip(self.summaries.par_chunks_mut(GRAIN_PATCHES));
        found.zip(runs.par_chunks(GRAIN_PATCHES)).for_each(|((patches, summaries), runs)| {
            let mut remembered = Remembered::since(history, &runs[0]);
            for ((patch, summary), run) in patches.iter_mut().zip(summaries).zip(runs) {
                patch.find((&order[run.places.clone()], run), scene, (forces, own), &mut remembered);
                *summary = patch.summary();
            }
        });
    }

    /// Takes the blocks that do not deform to the end of the step under all loads, normal forces and the friction of the last step.
    fn advance_bodies(&mut self, scene: &PatchScene) {
        self.bodies.clear();
        self.bodies.extend_from_slice(scene.input.bodies);
        self.is_asked.clear();
        self.is_asked.resize(scene.input.bodies.len(), false);
        for summary in self.summaries.iter().filter(|summary| summary.has_friction) {
            for block in [summary.owner.index(), summary.target.index()] {
                self.is_asked[block] = true;
            }
        }
        for bond in scene.bonds {
            for (block, sign) in bond.blocks.iter().zip([1.0, -1.0]) {
                self.bodies[block.index()].push(&bond.center, &(sign * bond.force_n));
            }
        }
        let Self { is_asked, adjacency, patches, summaries, bodies, .. } = self;
        let is_nodal = |body: &Body| scene.input.deformation.is_some() && body.deforms;
        let advance = |(block, body): (usize, &mut Body)| {
            body.velocity_m_s += body.prescribed_change_m_s;
            if is_asked[block] && body.mass_kg.is_finite() && !is_nodal(body) {
                body.add_gyroscopic_torque();
                for (k, sign) in adjacency.at(BlockId(block as u32)) {
                    let (patch, summary) = (&patches[k as usize], &summaries[k as usize]);
                    patch.apply_loads(body, sign);
                    if !summary.is_slight() {
                        patch.apply_previous_friction(body, sign);
                    }
                }
                body.advance_velocity(scene.input.dt_s);
            }
        };
        bodies.par_iter_mut().enumerate().with_min_len(GRAIN_BODIES).for_each(advance);
    }

    /// How blocks that deform answer to the loads, and to the friction of patches, whose sides on them are found.
    fn ask_blocks(&mut self, scene: &PatchScene, forces: &[FacetForce]) {
        let Self { nodal, is_asked, adjacency, runs, order, patches, summaries, sides, own_m2, .. } = self;
        sides.clear();
        sides.resize(patches.len(), [None; 2]);
        let Some(deformation) = scene.input.deformation else { return nodal.begin([].into_iter()) };
        let patch = |(k, _): (u32, f64)| {
            let (run, summary) = (runs[k as usize].places.clone(), &summaries[k as usize]);
            (k, &patches[k as usize], &order[run], summary.matters())
        };
        let is_nodal = |block: &BlockId| is_asked[block.index()] && scene.input.bodies[block.index()].deforms;
        nodal.begin(scene.input.blocks.ids().filter(is_nodal));
        let found = SideScene { scene: *scene, forces, own_m2 };
        nodal.take_sides(&found, |block| adjacency.at(block).map(patch));
        nodal.add_bonds(scene);
        nodal.answer(scene, deformation);
        nodal.each_side(|block, number, side| {
            let k = usize::from(patches[number as usize].owner != block);
            sides[number as usize][k] = Some(side);
        });
    }

    /// Friction of the patches.
    fn solve(&mut self, scene: &PatchScene, forces: &[FacetForce]) -> Search {
        self.ask_blocks(scene, forces);
        let Self { patches, summaries, bodies, coupled, nodal, sides, visits, newton, .. } = self;
        let Self { division, searched, .. } = self;
        let ContactInput { bodies: start, dt_s, is_iterated, .. } = *scene.input;
        searched.clear();
        searched.extend((0..).zip(&*summaries).filter(|(_, summary)| summary.matters()).map(|(k, _)| k));
        division.divide(searched, |k| summaries[k as usize].moving(start));
        coupled.clear();
        coupled.extend(searched.iter().filter_map(|&number| {
            let k = number as usize;
            let patch = (number, &patches[k], summaries[k].tolerance_n);
            CoupledPatch::new(patch, (start, nodal), sides[k], dt_s)
        }));
        division.take_groups(coupled.iter().map(|patch| summaries[patch.patch as usize].moving(start)));
        coupled.iter().for_each(|patch| patch.push_nodes(nodal));
        let (alone, eased) =
            (stage::visits_alone(coupled.len()), stage::visits_eased(coupled.len(), is_iterated));
        let mut motion = Motion { bodies, nodal, division, dt_s, is_iterated, visits, alone, eased };
        let search = solve::solve(coupled, start, (&mut motion, newton));
        for found in coupled.iter() {
            found.hand_over(&mut patches[found.patch as usize], (start, bodies), dt_s);
        }
        let slight = |(patch, summary): (&mut ContactPatch, &PatchSummary)| {
            if summary.has_friction && summary.is_slight() {
                let alone =
                    CoupledPatch::new((0, patch, summary.tolerance_n), (start, nodal), [None; 2], dt_s);
                if let Some(mut alone) = alone {
                    alone.slight_friction(bodies);
                    alone.hand_over(patch, (start, bodies), dt_s);
                }
            }
        };
        patches.par_iter_mut().zip(&*summaries).with_min_len(GRAIN_PATCHES).for_each(slight);
        search
    }

    /// How far friction of the last [`add`](Self::add) was from Coulomb's law over displacements of the nodes [m]: blocks and energy [J], one call for
    /// each patch.
    pub(crate) fn each_coulomb_gap(
        &mut self,
        (blocks, integrals, forces): (&BlockSet, &Integrals, &[FacetForce]),
        moved: &[Vec3],
        add: &mut dyn FnMut(BlockId, BlockId, f64),
    ) {
        let scene = Moved { blocks, integrals, moved };
        let Self { patches, runs, order, gaps_j, .. } = self;
        gaps_j.resize(patches.len(), 0.0);
        let gap = |((gap_j, patch), run): ((&mut f64, &ContactPatch), &PatchFacets)| {
            *gap_j = patch.coulomb_gap_j(&order[run.places.clone()], &scene, forces);
        };
        gaps_j.par_iter_mut().zip(&*patches).zip(&*runs).with_min_len(GRAIN_PATCHES).for_each(gap);
        for (patch, &gap_j) in patches.iter().zip(&*gaps_j) {
            add(patch.owner, patch.target, gap_j);
        }
    }
}
