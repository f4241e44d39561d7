//! Friction of whole faces, for laws that act on velocities.
//!
//! A face is a set of boundary triangles in one plane and of one surface. Its friction on another block is one force F and one torque T
//! about the normal, spread in proportion to the pressure p, and it answers to the slip velocity v and the spin ω
//! about the normal in the same proportion, so that a face that sticks can only take energy from what it acts on.
//!
//! ```text
//! touching, sliding   F′ = F − m_eff v₁/Δt,   |F′| ≤ μ N               stops the slip of this step, or slides
//! sticking            F′ = F − η m_eff v/Δt,   and F′ − ζ m_eff v/Δt on the block   a stiff spring and a damper
//! torque              the same with J_eff and ω,   |T′| ≤ μ N r √(1 − (F′/μN)²)
//! ```
//!
//! v₁ is the slip velocity that the rigid motion of both blocks would have at the end of the step under the loads and
//! normal forces of this step and the friction of the last; r is the mean distance of the pressure from its centre.
//! So friction is mobilised at once on a block that slides, and one that sticks is held by the force that it takes.
//! Measured on a block that sticks on a slope: with the first line in every step it is fed energy through its
//! elasticity, with v of each facet ringing is clipped at μ N, and either way it creeps.

use std::ops::Range;

use ndda_mesh::{BlockId, BlockSet, Vec3};
use rayon::prelude::*;

use crate::block_faces::BlockFaces;
use crate::both::both;
use crate::by_block::ByBlock;
use crate::facets::{FacetForce, mass_per_area, reduced, relative_velocity};
use crate::friction::{FacetSlip, FrictionLaw, ShearMemory, length};
use crate::integrals::{FacetSums, Integrals, Touch};
use crate::joints::Joints;
use crate::model::{Body, ContactHistory, ContactInput, FaceMemory};

/// η = (ω_s Δt)² of the spring that holds a face.
const SPRING: f64 = 0.1;
/// ζ, the part of a slip velocity that a step takes away.
const DAMPER: f64 = 0.2;

/// Faces below which a second thread costs more than it brings.
const GRAIN_PATCHES: usize = 64;

/// The same for blocks.
const GRAIN_BODIES: usize = 16;

/// What all faces read.
#[derive(Clone, Copy)]
pub struct FaceScene<'a> {
    /// Blocks and their motion.
    pub input: &'a ContactInput<'a>,
    /// Integrals of the pairs.
    pub integrals: &'a Integrals,
    /// Laws.
    pub joints: &'a Joints,
}

impl FaceScene<'_> {
    fn touch(&self, t: u32) -> &Touch {
        &self.integrals.touching()[t as usize]
    }

    fn sums(&self, t: u32) -> &FacetSums {
        self.integrals.sums_of(self.touch(t))
    }

    fn owner(&self, t: u32) -> BlockId {
        self.touch(t).owner
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
pub struct Faces {
    /// Face of each boundary triangle, numbered over all blocks.
    face_of: Vec<u32>,
    /// Touching facets by face and target.
    order: Vec<Place>,
    /// Those of each face and target, in `order`, and which of them each facet is in.
    runs: Vec<Range<usize>>,
    run_of: Vec<u32>,
    /// Patches by block.
    by_block: ByBlock,
    /// Mass that a square metre of each block's contacts moves within the step [kg/m²].
    mass_per_area: Vec<f64>,
    /// Blocks with the velocities that faces would stop.
    bodies: Vec<Body>,
    /// Whose motion to come a face asks for.
    is_asked: Vec<bool>,
    /// One per run.
    patches: Vec<Patch>,
    briefs: Vec<Brief>,
    new_faces: Vec<FaceMemory>,
}

/// What of a patch is asked for in passing.
#[derive(Clone, Copy, Debug, Default)]
struct Brief {
    owner: BlockId,
    target: BlockId,
    area_m2: f64,
    /// Whether it asks for the motion to come.
    asks: bool,
}

/// What one face does to one block.
#[derive(Clone, Debug, Default)]
struct Patch {
    owner: BlockId,
    target: BlockId,
    has_law: bool,
    /// ∫ φ dA and its centre; nothing else counts where there is no pressure.
    pressure: f64,
    center: Vec3,
    normal: Vec3,
    normal_n: f64,
    area_m2: f64,
    /// Force [N] on it, and torque [N m] about the centre, but for its own friction.
    load_n: Vec3,
    load_torque_n_m: Vec3,
    /// Means of r² and r from the centre, weighted by pressure.
    radius2: f64,
    radius: f64,
    /// Slip velocity, and spin about the normal, weighted by pressure; zero where nobody asks for them.
    velocity_m_s: Vec3,
    spin_rad_s: f64,
    /// Friction of the last step, turned with the face; none at first touch.
    old: Option<FaceMemory>,
    /// Friction of this step [N, N m], and what is kept of it.
    force_n: Vec3,
    torque_n_m: f64,
    memory: FaceMemory,
}

impl Faces {
    /// Takes the faces of all blocks; once per set of blocks.
    pub fn fit(&mut self, blocks: &BlockSet, surfaces: &[BlockFaces]) {
        self.face_of.clear();
        let mut next = 0;
        for (block, BlockFaces { of_triangle, .. }) in blocks.ids().zip(surfaces) {
            let named = &blocks.triangle_surface[blocks.triangles_of(block)];
            let parts: Vec<_> = of_triangle.iter().zip(named).collect();
            let mut distinct = parts.clone();
            distinct.sort_unstable();
            distinct.dedup();
            self.face_of.extend(
                parts.iter().map(|part| next + distinct.partition_point(|other| other < part) as u32),
            );
            next += distinct.len() as u32;
        }
    }

    /// Sorts touching facets by face and target; those of a block are together already, and its faces follow each other.
    pub fn arrange(&mut self, integrals: &Integrals) {
        self.order.clear();
        let place = |(t, touch): (u32, &Touch)| (self.face_of[touch.triangle.index()], touch.target, t);
        let touching = integrals.touching();
        self.order.extend((0..).zip(touching).map(place));
        let of_one_block =
            |a: &Place, b: &Place| touching[a.2 as usize].owner == touching[b.2 as usize].owner;
        self.order.par_chunk_by_mut(of_one_block).for_each(<[Place]>::sort_unstable);
        self.runs.clear();
        self.run_of.resize(touching.len(), 0);
        let mut start = 0;
        for run in self.order.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            run.iter().for_each(|&(_, _, t)| self.run_of[t as usize] = self.runs.len() as u32);
            self.runs.push(start..start + run.len());
            start += run.len();
        }
    }

    /// Adds the friction of faces whose law asks for it to the facets' forces, and takes over what they remember; the facets are
    /// [arranged](Self::arrange).
    pub fn add(&mut self, scene: &FaceScene, forces: &mut [FacetForce], history: &mut ContactHistory) {
        self.find_patches(scene, forces, history);
        let blocks_of = |brief: &Brief| (brief.owner, brief.target);
        self.by_block.arrange(scene.input.blocks.len(), self.briefs.iter().map(blocks_of));
        self.share_masses(scene);
        self.push_bodies(scene);
        self.rub(scene);
        let Self { patches, runs, run_of, order, new_faces, .. } = self;
        let spread = |(force, run): (&mut FacetForce, &u32)| patches[*run as usize].spread_to(force);
        let memory_of = |(patch, run): (&Patch, &Range<usize>)| {
            let (face, target, _) = order[run.start];
            patch.rubs().then_some(FaceMemory { face, target, ..patch.memory })
        };
        both(
            patches.len() > GRAIN_PATCHES,
            || forces.par_iter_mut().zip(&run_of[..]).with_min_len(GRAIN_PATCHES).for_each(spread),
            || {
                new_faces.clear();
                new_faces.extend(patches.iter().zip(runs.iter()).filter_map(memory_of));
            },
        );
        std::mem::swap(&mut history.faces, &mut self.new_faces);
    }

    /// Where each face presses, how hard, and how it slips.
    fn find_patches(&mut self, scene: &FaceScene, forces: &[FacetForce], history: &ContactHistory) {
        let (order, runs) = (&self.order, &self.runs);
        self.patches.resize(runs.len(), Patch::default());
        self.briefs.resize(runs.len(), Brief::default());
        let patches = self.patches.par_chunks_mut(GRAIN_PATCHES);
        let found = patches.zip(self.briefs.par_chunks_mut(GRAIN_PATCHES));
        found.zip(runs.par_chunks(GRAIN_PATCHES)).for_each(|((patches, briefs), runs)| {
            let mut remembered = Remembered::since(history, &order[runs[0].start]);
            for ((patch, brief), run) in patches.iter_mut().zip(briefs).zip(runs) {
                patch.find(&order[run.clone()], scene, forces, &mut remembered);
                *brief = patch.brief();
            }
        });
    }

    /// Friction of each face.
    fn rub(&mut self, scene: &FaceScene) {
        let (order, bodies, mass_per_area) = (&self.order, &self.bodies, &self.mass_per_area);
        let rub = |(patch, run): (&mut Patch, &Range<usize>)| {
            if patch.rubs() {
                let law = scene.law(&order[run.clone()]).expect("patches have a law");
                let basis = tangents(&patch.normal);
                let step = FaceStep { dt_s: scene.input.dt_s, patch, basis, bodies, mass_per_area };
                (patch.force_n, patch.torque_n_m, patch.memory) = step.advance(law);
            }
        };
        self.patches.par_iter_mut().zip(&self.runs).with_min_len(GRAIN_PATCHES).for_each(rub);
    }

    /// All blocks under their loads; those whose motion to come is asked for under the normal forces of this step and the friction
    /// of the last one, too.
    fn push_bodies(&mut self, scene: &FaceScene) {
        self.bodies.clear();
        self.bodies.extend_from_slice(scene.input.bodies);
        self.is_asked.clear();
        self.is_asked.resize(self.bodies.len(), false);
        for brief in self.briefs.iter().filter(|brief| brief.asks) {
            self.is_asked[brief.owner.index()] = true;
            self.is_asked[brief.target.index()] = true;
        }
        let (is_asked, by_block, patches) = (&self.is_asked, &self.by_block, &self.patches);
        let push = |(block, body): (usize, &mut Body)| {
            for (k, sign) in by_block.at(BlockId(block as u32)) {
                let patch = &patches[k as usize];
                if is_asked[patch.owner.index()] || is_asked[patch.target.index()] {
                    patch.push_now(body, sign);
                }
                patch.push_as_before(body, sign);
            }
            body.speed_up(scene.input.dt_s);
        };
        self.bodies.par_iter_mut().enumerate().with_min_len(GRAIN_BODIES).for_each(push);
    }

    /// Spreads each block's mass over what of it touches.
    fn share_masses(&mut self, scene: &FaceScene) {
        let shares = &mut self.mass_per_area;
        shares.clear();
        shares.resize(scene.input.blocks.len(), 0.0);
        for brief in &self.briefs {
            shares[brief.owner.index()] += brief.area_m2;
            shares[brief.target.index()] += brief.area_m2;
        }
        for (share, body) in shares.iter_mut().zip(scene.input.bodies) {
            *share = mass_per_area(body, *share, scene.input.dt_s);
        }
    }
}

impl Patch {
    fn find(&mut self, run: &[Place], scene: &FaceScene, forces: &[FacetForce], remembered: &mut Remembered) {
        let (_, target, first) = run[0];
        let (owner, has_law) = (scene.owner(first), scene.law(run).is_some());
        *self = Self { owner, target, has_law, ..Self::default() };
        self.sum(run, scene, forces);
        self.measure(run, scene, forces);
        if !self.rubs() {
            return;
        }
        let old = remembered.of(&run[0]).filter(|old| old.normal.dot(&self.normal) > 0.0);
        self.old = old.map(|old| old.turned_to(&self.normal));
        if self.is_held() {
            self.measure_slip(run, scene, forces);
        }
    }

    fn brief(&self) -> Brief {
        let Self { owner, target, area_m2, .. } = *self;
        Brief { owner, target, area_m2, asks: self.rubs() && !self.is_held() }
    }

    /// Whether it stuck in the last step: then its own slip counts, otherwise that of the rigid motions to come.
    fn is_held(&self) -> bool {
        self.old.is_some_and(|old| !old.slides)
    }

    /// What it does to one of its facets.
    fn spread_to(&self, force: &mut FacetForce) {
        if self.rubs() {
            let twist = self.torque_n_m / self.pressure / self.radius2;
            let arm = force.center - self.center;
            force.shear = self.force_n / self.pressure + twist * self.normal.cross(&arm);
            force.sticks = !self.memory.slides;
        }
    }

    /// What the normal force does, and friction of facets, to its owner or, with the opposite sign, to its target.
    fn push_now(&self, body: &mut Body, sign: f64) {
        body.push(&self.center, &(sign * self.load_n));
        body.torque_n_m += sign * self.load_torque_n_m;
    }

    /// What it did in the last step, to its owner or, with the opposite sign, to its target.
    fn push_as_before(&self, body: &mut Body, sign: f64) {
        if let Some(old) = &self.old {
            body.push(&self.center, &(sign * old.force_n));
            body.torque_n_m += sign * old.torque_n_m * self.normal;
        }
    }

    /// Whether there is friction on it.
    fn rubs(&self) -> bool {
        self.has_law && self.pressure > 0.0 && self.area_m2 > 0.0
    }

    fn sum(&mut self, run: &[Place], scene: &FaceScene, forces: &[FacetForce]) {
        let mut push = Vec3::zeros();
        for &(_, _, t) in run {
            let FacetSums { pressure, area, .. } = *scene.sums(t);
            if pressure > 0.0 {
                self.pressure += pressure;
                self.center += pressure * forces[t as usize].center;
                self.area_m2 += area;
                push += pressure * forces[t as usize].push;
            }
        }
        if self.pressure > 0.0 {
            self.center /= self.pressure;
            // Per unit of pressure: that of blocks which only just touch is too small a number to be squared.
            let push = push / self.pressure;
            self.normal_n = push.norm() * self.pressure;
            self.normal = -push.normalize();
        }
    }

    /// Loads, and radii about the centre; a facet counts with its own size, so that one facet has a radius, too.
    fn measure(&mut self, run: &[Place], scene: &FaceScene, forces: &[FacetForce]) {
        for &(_, _, t) in run {
            let FacetSums { pressure, area, .. } = *scene.sums(t);
            if pressure > 0.0 {
                let FacetForce { push, shear, center, .. } = &forces[t as usize];
                let (arm, load) = (center - self.center, pressure * (push + shear));
                self.load_n += load;
                self.load_torque_n_m += arm.cross(&load);
                // A disc of the same area: mean r² = A/2π.
                let radius2 = arm.norm_squared() + area / std::f64::consts::TAU;
                self.radius2 += pressure / self.pressure * radius2;
                self.radius += pressure / self.pressure * radius2.sqrt();
            }
        }
    }

    /// Slip velocity, and spin about the centre.
    fn measure_slip(&mut self, run: &[Place], scene: &FaceScene, forces: &[FacetForce]) {
        let mut twist = 0.0;
        for &(_, _, t) in run.iter().filter(|(_, _, t)| scene.sums(*t).pressure > 0.0) {
            let found = (scene.integrals.hits_of(scene.touch(t)), scene.sums(t));
            let arm = forces[t as usize].center - self.center;
            let slip = relative_velocity(scene.touch(t), found, scene.input) / self.pressure;
            self.velocity_m_s += slip;
            twist += arm.cross(&slip).dot(&self.normal);
        }
        self.velocity_m_s -= self.normal * self.normal.dot(&self.velocity_m_s);
        self.spin_rad_s = twist / self.radius2;
    }
}

/// One face in one step.
struct FaceStep<'a> {
    dt_s: f64,
    patch: &'a Patch,
    /// Two unit vectors in the face.
    basis: [Vec3; 2],
    bodies: &'a [Body],
    mass_per_area: &'a [f64],
}

impl FaceStep<'_> {
    /// Force and torque on the face, and what it remembers.
    fn advance(&self, law: &dyn FrictionLaw) -> (Vec3, f64, FaceMemory) {
        let mass_kg = self.mass_per_area() * self.patch.area_m2;
        let rate = [mass_kg, mass_kg * self.patch.radius2].map(|m| m / self.dt_s);
        match &self.patch.old {
            Some(old) if !old.slides => self.hold(law, old, rate),
            Some(old) => self.stop(law, old.force_n, old.torque_n_m, rate),
            None => self.stop(law, Vec3::zeros(), 0.0, rate),
        }
    }

    /// Touching or sliding: what stops the rigid motion in this step, or all there is.
    fn stop(
        &self,
        law: &dyn FrictionLaw,
        old_n: Vec3,
        old_n_m: f64,
        rate: [f64; 2],
    ) -> (Vec3, f64, FaceMemory) {
        let (velocity, spin) = self.slip_to_come();
        let (force_n, slides) = self.limited(law, old_n - rate[0] * velocity);
        let most_torque = self.most_torque(law, &force_n);
        let torque_n_m = (old_n_m - rate[1] * spin).clamp(-most_torque, most_torque);
        let memory =
            FaceMemory { force_n, torque_n_m, slides, normal: self.patch.normal, ..Default::default() };
        (force_n, torque_n_m, memory)
    }

    /// Sticking: a spring and a damper.
    fn hold(&self, law: &dyn FrictionLaw, old: &FaceMemory, rate: [f64; 2]) -> (Vec3, f64, FaceMemory) {
        let (velocity, spin) = (self.patch.velocity_m_s, self.patch.spin_rad_s);
        let (spring, slides) = self.limited(law, old.force_n - SPRING * rate[0] * velocity);
        let most_torque = self.most_torque(law, &spring);
        let torque_n_m = (old.torque_n_m - SPRING * rate[1] * spin).clamp(-most_torque, most_torque);
        let memory = FaceMemory {
            force_n: spring,
            torque_n_m,
            slides,
            normal: self.patch.normal,
            ..Default::default()
        };
        let (force_n, _) = self.limited(law, spring - DAMPER * rate[0] * velocity);
        let most_torque = self.most_torque(law, &force_n);
        let damped = (torque_n_m - DAMPER * rate[1] * spin).clamp(-most_torque, most_torque);
        (force_n, damped, memory)
    }

    /// What the law leaves of a force in the plane of the face, and whether that is less than asked for.
    fn limited(&self, law: &dyn FrictionLaw, force: Vec3) -> (Vec3, bool) {
        let basis = &self.basis;
        let stopping_n = [force.dot(&basis[0]), force.dot(&basis[1])];
        let mut memory = ShearMemory::default();
        law.advance(&FacetSlip { stopping_n, ..self.slip() }, &mut memory);
        let slides = length(stopping_n) > law.capacity_n(&self.slip(), &memory);
        (basis[0] * memory.shear_n[0] + basis[1] * memory.shear_n[1], slides)
    }

    /// μ N r √(1 − (F/μN)²).
    fn most_torque(&self, law: &dyn FrictionLaw, force: &Vec3) -> f64 {
        let most_n = law.capacity_n(&self.slip(), &ShearMemory::default());
        let used = if most_n > 0.0 { force.norm() / most_n } else { 1.0 };
        most_n * self.patch.radius * (1.0 - used * used).max(0.0).sqrt()
    }

    fn slip(&self) -> FacetSlip {
        FacetSlip { normal_n: self.patch.normal_n, area_m2: self.patch.area_m2, ..FacetSlip::default() }
    }

    /// Slip velocity at the end of the step, and spin about the normal, if this face gave no friction.
    fn slip_to_come(&self) -> (Vec3, f64) {
        let (own, other) = (self.body(self.patch.owner), self.body(self.patch.target));
        let (normal, at) = (&self.patch.normal, &self.patch.center);
        let velocity = own.velocity_at(at) - other.velocity_at(at);
        let spin = own.spin_rad_s - other.spin_rad_s;
        (velocity - normal * normal.dot(&velocity), spin.dot(normal))
    }

    fn mass_per_area(&self) -> f64 {
        let of = |block: BlockId| self.mass_per_area[block.index()];
        reduced(of(self.patch.owner), of(self.patch.target))
    }

    fn body(&self, block: BlockId) -> &Body {
        &self.bodies[block.index()]
    }
}

impl FaceMemory {
    /// The memory turned with the normal, by the least rotation: c = a × b, v + c × v + c × (c × v)/(1 + a·b).
    fn turned_to(self, normal: &Vec3) -> Self {
        let (c, d) = (self.normal.cross(normal), 1.0 + self.normal.dot(normal));
        let in_plane = |v: Vec3| {
            let turned = v + c.cross(&v) + c.cross(&c.cross(&v)) / d;
            turned - normal * normal.dot(&turned)
        };
        Self { force_n: in_plane(self.force_n), ..self }
    }
}

/// What faces remember, in their order: asked for one after the other, it is at hand.
struct Remembered<'a> {
    rest: &'a [FaceMemory],
}

impl<'a> Remembered<'a> {
    fn since(history: &'a ContactHistory, first: &Place) -> Self {
        let start = history.faces.partition_point(|memory| Self::is_before(memory, first));
        Self { rest: &history.faces[start..] }
    }

    fn is_before(memory: &FaceMemory, &(face, target, _): &Place) -> bool {
        (memory.face, memory.target) < (face, target)
    }

    /// That of a face on a block, none before the last one asked for.
    fn of(&mut self, place: &Place) -> Option<FaceMemory> {
        let passed = self.rest.iter().take_while(|memory| Self::is_before(memory, place)).count();
        self.rest = &self.rest[passed..];
        self.rest.first().filter(|memory| (memory.face, memory.target) == (place.0, place.1)).copied()
    }
}

/// Two unit vectors across a normal.
fn tangents(normal: &Vec3) -> [Vec3; 2] {
    let axis = [Vec3::x(), Vec3::y(), Vec3::z()][normal.iamin()];
    let first = normal.cross(&axis).normalize();
    [first, normal.cross(&first)]
}
