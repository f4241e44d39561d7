//! Friction of whole faces, for laws that act on velocities.
//!
//! A face is a set of boundary triangles in one plane and of one surface. Its contact with another block is a patch, together with a
//! face of the other block that lies on it (`opposite.rs`), or with a part of either (`parts.rs`): its friction is one force F and one torque T about the
//! normal, spread over its facets (`spread.rs`), and obeys Coulomb's law point by point (`limit_surface.rs`). The friction of all patches is found
//! together (`solve.rs`), but for patches that hardly count (`slight.rs`); blocks that deform answer to it at their nodes, as the solver says (`nodal.rs`).

mod detail;
mod gaps;
mod limit_surface;
pub(crate) mod moments;
mod nodal;
mod opposite;
mod parts;
mod patch;
mod slight;
mod solve;
mod spread;
mod tolerance;

use ndda_mesh::{BlockId, BlockSet, Vec3};
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
use crate::friction::patches::detail::{DetailScene, facets_of};
use crate::friction::patches::nodal::{Nodal, NodalSide, SearchedPatch, SideScene};
use crate::friction::patches::opposite::Opposite;
use crate::friction::patches::parts::FaceParts;
use crate::friction::patches::patch::{ContactPatch, PatchDetail, PatchFacets, PatchLoads, PatchSummary};
use crate::friction::patches::solve::chunks::Division;
use crate::friction::patches::solve::newton::Newton;
use crate::friction::patches::solve::stage::{self, Visits};
use crate::friction::patches::solve::{CoupledPatch, Motion, Search};
use crate::friction::patches::tolerance::Tolerance;
use crate::integration::integrals::Integrals;
use crate::integration::overlap_pair::{ActiveFacet, FacetMoments};
use crate::model::{Body, ContactHistory, ContactInput, Deformation, FaceMemory};
use crate::room::make_room;

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
    /// Touching facets by patch, those of each patch among them, and for each facet its place there and its patch.
    order: Vec<Place>,
    runs: Vec<PatchFacets>,
    places: Vec<FacetPlace>,
    opposite: Opposite,
    /// Patches by block.
    adjacency: BlockContactIndex,
    /// Blocks with the velocities at the end of the step.
    bodies: Vec<Body>,
    /// Whether a block has patches with friction.
    is_asked: Vec<bool>,
    /// Nodes of those that deform.
    nodal: Nodal,
    /// One per run, and what loads it, where blocks need that which do not deform.
    patches: Vec<ContactPatch>,
    loads: Vec<PatchLoads>,
    summaries: Vec<PatchSummary>,
    /// One for each patch whose friction is searched for, and for their facets the mean square distance of points from the facet's own centre of pressure [m²].
    details: Vec<PatchDetail>,
    own_m2: Vec<f64>,
    /// Whether others have friction.
    has_slight: bool,
    coupled: Vec<CoupledPatch>,
    /// Their sides on blocks that deform.
    sides: Vec<[Option<NodalSide>; 2]>,
    /// Room for their solution, by block.
    most_n: Vec<f64>,
    visits: Visits,
    newton: Newton,
    /// How patches are divided among threads, and the order in which their friction is searched for.
    division: Division,
    search_order: Vec<u32>,
    new_faces: Vec<FaceMemory>,
    gaps_j: Vec<f64>,
}

/// Whether a block answers by its nodes.
fn is_nodal(body: &Body, deformation: Option<&dyn Deformation>) -> bool {
    deformation.is_some() && body.deforms
}

/// Where a facet is among the facets of all patches, and the number of its patch.
#[derive(Clone, Copy, Default)]
struct FacetPlace {
    place: u32,
    patch: u32,
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
        make_room(&mut self.by_face, touching.len());
        self.by_face.extend((0..).zip(touching).map(place));
        let of_one_block =
            |a: &Place, b: &Place| touching[a.2 as usize].owner == touching[b.2 as usize].owner;
        self.by_face.par_chunk_by_mut(of_one_block).for_each(<[Place]>::sort_unstable);
    }

    /// Which facets each patch has.
    fn join_faces(&mut self, scene: &PatchScene, forces: &[FacetForce], history: &ContactHistory) {
        let Self { opposite, by_face, order, runs, places, face_parts, .. } = self;
        opposite.join(scene, (forces, history), (by_face, order), (face_parts, runs));
        make_room(places, forces.len());
        places.resize(forces.len(), FacetPlace::default());
        for (patch, run) in (0..).zip(&*runs) {
            for (place, &(_, _, t)) in run.places.clone().zip(run.of(order)) {
                places[t as usize] = FacetPlace { place, patch };
            }
        }
    }

    /// Finds the patches of faces whose law acts on faces; the facets are [arranged](Self::arrange). Adds the friction of those that are slight to their facets'
    /// forces.
    pub(crate) fn begin(&mut self, scene: &PatchScene, forces: &mut [FacetForce], history: &ContactHistory) {
        self.join_faces(scene, forces, history);
        self.find_patches(scene, forces);
        let blocks_of = |summary: &PatchSummary| (summary.owner, summary.target);
        self.adjacency.arrange(scene.input.blocks.len(), self.summaries.iter().map(blocks_of));
        let tolerance = Tolerance::new(scene.input, scene.joints.tolerance, self.patches.len());
        tolerance.find(&mut self.summaries, scene.input.bodies, &mut self.most_n);
        self.find_details(scene, forces, history);
        self.advance_bodies(scene);
        if self.has_slight {
            self.add_slight_friction(scene, forces);
        }
    }

    /// Finds the friction of patches that are not slight, adds it to the facets' forces, and takes over what faces remember; `push` are the other forces of
    /// contact on nodes where blocks [answer](Self::asks_nodes). Gives the largest change of a slip [m/s] when the search for friction ended before it was found.
    pub(crate) fn find(
        &mut self,
        scene: &PatchScene,
        push: &[Vec3],
        forces: &mut [FacetForce],
        history: &mut ContactHistory,
    ) -> f64 {
        let left_m_s = self.solve(scene, push, forces).left_m_s;
        let Self { patches, runs, details, own_m2, places, new_faces, .. } = self;
        let spread = |((t, force), &FacetPlace { place, patch }): ((usize, &mut FacetForce), &FacetPlace)| {
            let (patch, run) = (&patches[patch as usize], &runs[patch as usize]);
            if let Some(detail) = patch.detail.filter(|_| scene.sums(t as u32).pressure > 0.0) {
                let own_m2 = own_m2[facets_of(details, detail).start + (place - run.places.start) as usize];
                details[detail as usize].spread_to(patch, force, (scene, t as u32, own_m2));
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
                    .zip(&places[..])
                    .with_min_len(GRAIN_PATCHES)
                    .for_each(spread)
            },
            || {
                new_faces.clear();
                make_room(new_faces, patches.len());
                new_faces.extend(patches.iter().zip(runs.iter()).filter_map(memory_of));
            },
        );
        std::mem::swap(&mut history.faces, &mut self.new_faces);
        left_m_s
    }

    /// Where each face presses, and how hard.
    fn find_patches(&mut self, scene: &PatchScene, forces: &[FacetForce]) {
        let (order, runs) = (&self.order, &self.runs);
        make_room(&mut self.patches, runs.len());
        make_room(&mut self.summaries, runs.len());
        self.patches.resize(runs.len(), ContactPatch::default());
        self.summaries.resize(runs.len(), PatchSummary::default());
        let found = self.patches.par_iter_mut().zip(&mut self.summaries).zip(runs);
        found.with_min_len(GRAIN_PATCHES).for_each(|((patch, summary), run)| {
            patch.find((run.of(order), run), scene, forces);
            *summary = patch.summary();
        });
        let ContactInput { bodies, deformation, .. } = *scene.input;
        let advances = |body: &Body| body.mass_kg.is_finite() && !is_nodal(body, deformation);
        self.loads.clear();
        if bodies.iter().any(advances) {
            make_room(&mut self.loads, runs.len());
            self.loads.resize(runs.len(), PatchLoads::default());
        }
        let found = self.loads.par_iter_mut().zip(&self.patches).zip(runs);
        found.with_min_len(GRAIN_PATCHES).for_each(|((loads, patch), run)| {
            *loads = patch.loads(run.of(order), scene, forces);
        });
    }

    /// Finds the details of patches whose friction is searched for.
    fn find_details(&mut self, scene: &PatchScene, forces: &[FacetForce], history: &ContactHistory) {
        let Self { patches, summaries, runs, order, details, own_m2, has_slight, .. } = self;
        *has_slight = false;
        details.clear();
        let mut end = 0;
        for (number, patch) in (0..).zip(&mut *patches) {
            if summaries[number as usize].matters() {
                end += runs[number as usize].places.len() as u32;
                patch.detail = Some(details.len() as u32);
                details.push(PatchDetail { patch: number, end, ..PatchDetail::default() });
            } else {
                *has_slight |= summaries[number as usize].has_friction;
            }
        }
        own_m2.resize(end as usize, 0.0);
        let found = DetailScene { scene, forces, history, patches, runs, order };
        found.find(details, (0, own_m2));
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
        let Self { is_asked, adjacency, patches, loads, details, bodies, .. } = self;
        let advance = |(block, body): (usize, &mut Body)| {
            body.velocity_m_s += body.prescribed_change_m_s;
            if is_asked[block] && body.mass_kg.is_finite() && !is_nodal(body, scene.input.deformation) {
                body.add_gyroscopic_torque();
                for (k, sign) in adjacency.at(BlockId(block as u32)) {
                    let patch = &patches[k as usize];
                    patch.apply_loads(&loads[k as usize], body, sign);
                    if let Some(detail) = patch.detail {
                        details[detail as usize].apply_previous_friction(patch, body, sign);
                    }
                }
                body.advance_velocity(scene.input.dt_s);
            }
        };
        bodies.par_iter_mut().enumerate().with_min_len(GRAIN_BODIES).for_each(advance);
    }

    /// Whether blocks that deform have friction.
    pub(crate) fn asks_nodes(&self, scene: &PatchScene) -> bool {
        let asks = |(body, is_asked): (&Body, &bool)| body.deforms && *is_asked;
        scene.input.deformation.is_some() && scene.input.bodies.iter().zip(&self.is_asked).any(asks)
    }

    /// The facets of patches whose friction is searched for on a block, and of the block, with the normal of the patch.
    pub(crate) fn searched_facets(&self, block: BlockId) -> impl Iterator<Item = (u32, &Vec3)> {
        let searched = self.adjacency.at(block).filter(|(k, _)| self.patches[*k as usize].detail.is_some());
        searched.flat_map(|(k, _)| {
            let (run, normal) = (&self.runs[k as usize], &self.patches[k as usize].normal);
            run.of(&self.order).iter().map(move |place| (place.2, normal))
        })
    }

    /// How blocks that deform answer to the loads, and to the friction of patches, whose sides on them are found.
    fn ask_blocks(&mut self, scene: &PatchScene, push: &[Vec3], forces: &[FacetForce]) {
        let Self { nodal, is_asked, adjacency, runs, order, patches, details, sides, own_m2, .. } = self;
        sides.clear();
        sides.resize(details.len(), [None; 2]);
        let Some(deformation) = scene.input.deformation else { return nodal.begin([].into_iter()) };
        let patch = |(k, _): (u32, f64)| -> Option<SearchedPatch> {
            let (run, patch) = (runs[k as usize].of(order), &patches[k as usize]);
            let detail = patch.detail?;
            let own_m2 = &own_m2[facets_of(details, detail)];
            Some(SearchedPatch { number: k, patch, detail: &details[detail as usize], run, own_m2 })
        };
        let is_nodal = |block: &BlockId| is_asked[block.index()] && scene.input.bodies[block.index()].deforms;
        nodal.begin(scene.input.blocks.ids().filter(is_nodal));
        let found = SideScene { scene: *scene, push, forces };
        nodal.ask(&found, deformation, |block| adjacency.at(block).filter_map(patch));
        nodal.each_side(|block, number, side| {
            let patch = &patches[number as usize];
            if let Some(detail) = patch.detail {
                sides[detail as usize][usize::from(patch.owner != block)] = Some(side);
            }
        });
    }

    /// Friction of the patches.
    fn solve(&mut self, scene: &PatchScene, push: &[Vec3], forces: &[FacetForce]) -> Search {
        self.ask_blocks(scene, push, forces);
        let Self { patches, summaries, details, bodies, coupled, nodal, sides, visits, newton, .. } = self;
        let Self { division, search_order, .. } = self;
        let ContactInput { bodies: start, dt_s, is_iterated, .. } = *scene.input;
        let summary_of = |k: u32| &summaries[details[k as usize].patch as usize];
        search_order.clear();
        search_order.extend(0..details.len() as u32);
        division.divide(search_order, |k| summary_of(k).moving(start));
        coupled.clear();
        coupled.extend(search_order.iter().filter_map(|&k| {
            let (detail, tolerance_n) = (&details[k as usize], summary_of(k).tolerance_n);
            let patch = (&patches[detail.patch as usize], detail, tolerance_n);
            CoupledPatch::new(patch, (start, nodal), sides[k as usize], dt_s)
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
        search
    }
}
