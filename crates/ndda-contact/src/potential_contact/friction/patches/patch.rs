//! A face of a block on another block, and the face that lies on it: where they press, how hard, and how they slip.

use std::ops::Range;

use ndda_mesh::{BlockId, BlockSet, Vec3};

use crate::friction::facet::{FacetForce, relative_motion};
use crate::friction::law::{FacetSlip, FrictionLaw, ShearMemory};
use crate::friction::patches::limit_surface::LimitSurface;
use crate::friction::patches::parts::order_of;
use crate::friction::patches::spread::Spread;
use crate::friction::patches::{PatchScene, Place};
use crate::integration::integrals::Integrals;
use crate::integration::overlap_pair::{ActiveFacet, FacetMoments};
use crate::model::{Body, ContactHistory, FaceMemory};

/// Summary of a patch.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PatchSummary {
    pub owner: BlockId,
    pub target: BlockId,
    /// Whether there is friction on it, and the most [N].
    pub has_friction: bool,
    pub most_n: f64,
    /// Change of its friction that does not matter to the blocks [N].
    pub tolerance_n: f64,
}

impl PatchSummary {
    /// Whether its friction changes by less than what matters to the blocks, whatever its slip: a block has many such patches along its edges.
    pub(super) fn is_slight(&self) -> bool {
        2.0 * self.most_n <= self.tolerance_n
    }

    /// The blocks that may move; the same one twice where the other may not.
    pub(super) fn moving(&self, bodies: &[Body]) -> [BlockId; 2] {
        let is_held = |block: BlockId| bodies[block.index()].mass_kg.is_infinite();
        match [self.owner, self.target] {
            [owner, target] if is_held(owner) => [target; 2],
            [owner, target] if is_held(target) => [owner; 2],
            both => both,
        }
    }

    /// Whether its friction is searched for together with that of the others.
    pub(super) fn matters(&self) -> bool {
        self.has_friction && !self.is_slight()
    }
}

/// How far a step moved the nodes, and what touched meanwhile.
#[derive(Clone, Copy)]
pub(super) struct Moved<'a> {
    pub blocks: &'a BlockSet,
    pub integrals: &'a Integrals,
    pub moved: &'a [Vec3],
}

/// The facets of a patch, in a row among all.
#[derive(Clone, Debug)]
pub(super) struct PatchFacets {
    pub places: Range<u32>,
    /// Number of the face, and the block that it touches, under which its friction is remembered; the block of the face.
    pub face: u32,
    pub target: BlockId,
    pub owner: BlockId,
    /// Factor on the normal force of its facets in Coulomb's law: above 1 where they also carry the friction of the opposite face, whose facets then have 0.
    pub weight: f64,
}

impl PatchFacets {
    /// Its facets in the list of all.
    pub(super) fn of<'a>(&self, order: &'a [Place]) -> &'a [Place] {
        &order[self.places.start as usize..self.places.end as usize]
    }
}

/// The contact of one face with one block; facets of the block's own face that lies on it count with the opposite sign.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ContactPatch {
    pub owner: BlockId,
    pub target: BlockId,
    pub has_law: bool,
    /// ∫ φ dA and its centre; nothing else counts where there is no pressure.
    pub pressure: f64,
    pub center: Vec3,
    pub normal: Vec3,
    pub normal_n: f64,
    pub area_m2: f64,
    /// Most friction [N].
    pub most_n: f64,
    /// Its place among those whose friction is searched for; none where it is slight.
    pub detail: Option<u32>,
    /// Whether one of both blocks deforms.
    pub deforms: bool,
    /// Slip that loads other than contact bring within a step from rest: less is not resolved [m].
    pub least_slip_m: f64,
    /// Turn about the normal in this step, where it is found from the motion of the blocks.
    pub turn_rad: Option<f64>,
    /// Friction of this step [N, N m], and whether it is all that there may be.
    pub force_n: Vec3,
    pub torque_n_m: f64,
    pub slides: bool,
}

/// Force [N] on a patch, and torque [N m] about its centre, but for its own friction.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PatchLoads {
    load_n: Vec3,
    torque_n_m: Vec3,
}

/// Details of a patch whose friction is searched for.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PatchDetail {
    /// Number of the patch, and the end of its facets among those of all such patches.
    pub patch: u32,
    pub end: u32,
    /// The axes of the pressure, and the normal; what friction can carry along them.
    pub axes: [Vec3; 3],
    pub surface: LimitSurface,
    /// How its friction is spread.
    pub spread: Spread,
    /// Friction of the last step, turned with the face; none at first touch.
    pub previous: Option<Friction>,
}

/// Friction of a patch.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Friction {
    /// Its force [N].
    pub force_n: Vec3,
    /// Its torque about the normal [N m].
    pub torque_n_m: f64,
}

impl ContactPatch {
    /// The patch of the facets of a run.
    pub(super) fn find(
        &mut self,
        (run, facets): (&[Place], &PatchFacets),
        scene: &PatchScene,
        forces: &[FacetForce],
    ) {
        let (&PatchFacets { owner, target, .. }, law) = (facets, scene.law(run));
        let deforms = |block: BlockId| scene.input.bodies[block.index()].deforms;
        let (has_law, deforms) = (law.is_some() && facets.weight > 0.0, deforms(owner) || deforms(target));
        *self = Self { owner, target, has_law, deforms, ..Self::default() };
        self.sum(run, scene, forces);
        if !self.has_friction() {
            return;
        }
        let load_m_s2 = |block: BlockId| {
            let body = &scene.input.bodies[block.index()];
            body.load_n.norm() / body.mass_kg
        };
        self.least_slip_m = scene.input.dt_s.powi(2) * load_m_s2(owner).max(load_m_s2(target));
        self.most_n = law.map_or(0.0, |law| self.capacity_n(law, facets.weight));
    }

    /// The record of this patch for the next step, under its face and target block; without a normal where no friction was computed, since neither block can move.
    pub(super) fn memory(&self, &PatchFacets { face, target, .. }: &PatchFacets) -> FaceMemory {
        let Self { force_n, torque_n_m, slides, .. } = *self;
        let normal = if self.turn_rad.is_some() { self.normal } else { Vec3::zeros() };
        FaceMemory { face, target, force_n, torque_n_m, slides, normal }
    }

    pub(super) fn summary(&self) -> PatchSummary {
        let (has_friction, most_n) = (self.has_friction(), self.most_n);
        PatchSummary { owner: self.owner, target: self.target, has_friction, most_n, tolerance_n: 0.0 }
    }

    /// Whether there is friction on it.
    pub(super) fn has_friction(&self) -> bool {
        self.has_law && self.pressure > 0.0 && self.area_m2 > 0.0
    }

    /// 1 for a facet of the owner, −1 for one of the target.
    pub(super) fn sign_of(&self, touch: &ActiveFacet) -> f64 {
        if touch.owner == self.owner { 1.0 } else { -1.0 }
    }

    /// Pushes its owner or, with the opposite sign, its target by the normal force, and by friction of facets.
    pub(super) fn apply_loads(&self, loads: &PatchLoads, body: &mut Body, sign: f64) {
        body.push(&self.center, &(sign * loads.load_n));
        body.torque_n_m += sign * loads.torque_n_m;
    }

    /// Energy [J] by which friction did less than Coulomb's law takes from a displacement of the surfaces, D(u, θ) + F·u + T θ ≥ 0: none where the
    /// patch sticks without slip or slides against its friction. `moved` are the displacements of the nodes [m]. Zero where a block deforms: its
    /// vibrations leave gaps in quiet contacts that are as large as those of impacts which the step does not resolve.
    pub(super) fn coulomb_gap_j(
        &self,
        detail: Option<&PatchDetail>,
        run: &[Place],
        scene: &Moved,
        forces: &[FacetForce],
    ) -> f64 {
        if !self.has_friction() || self.deforms {
            return 0.0;
        }
        let (mut shift, mut twist) = (Vec3::zeros(), 0.0);
        for &(_, _, t) in run {
            let touch = &scene.integrals.touching()[t as usize];
            let sums = scene.integrals.sums_of(touch);
            if sums.pressure > 0.0 {
                let found = (scene.integrals.overlaps_of(touch), sums);
                let moved = relative_motion(touch, found, (scene.blocks, scene.moved));
                let slip = self.sign_of(touch) * moved / self.pressure;
                shift += slip;
                let arm = forces[t as usize].center - self.center;
                twist += arm.cross(&slip).dot(&self.normal);
            }
        }
        let Some(PatchDetail { axes, surface, .. }) = detail else {
            // A slight patch acts at its centre.
            let shift = shift - self.normal * self.normal.dot(&shift);
            let work_j = self.most_n * shift.norm() + self.force_n.dot(&shift);
            return if shift.norm() <= self.least_slip_m { 0.0 } else { work_j.max(0.0) };
        };
        let radius_m = surface.radius_m;
        // Facets do not see their own spin, the motion of the blocks does.
        let spin = self.turn_rad.map_or(twist / radius_m, |turn_rad| turn_rad * radius_m);
        let slip = Vec3::new(axes[0].dot(&shift), axes[1].dot(&shift), spin);
        if slip.norm() <= self.least_slip_m {
            return 0.0;
        }
        let work_j = self.force_n.dot(&shift) + self.torque_n_m / radius_m * spin;
        (surface.work_j(&slip) + work_j).max(0.0)
    }

    /// Most friction that a law allows [N].
    fn capacity_n(&self, law: &dyn FrictionLaw, weight: f64) -> f64 {
        let slip =
            FacetSlip { normal_n: weight * self.normal_n, area_m2: self.area_m2, ..FacetSlip::default() };
        law.capacity_n(&slip, &ShearMemory::default())
    }

    fn sum(&mut self, run: &[Place], scene: &PatchScene, forces: &[FacetForce]) {
        let mut push = Vec3::zeros();
        for &(_, _, t) in run {
            let FacetMoments { pressure, area, .. } = *scene.sums(t);
            if pressure > 0.0 {
                self.pressure += pressure;
                self.center += pressure * forces[t as usize].center;
                self.area_m2 += area;
                push += self.sign_of(scene.touch(t)) * pressure * forces[t as usize].push;
            }
        }
        if push == Vec3::zeros() {
            // Where blocks only just touch, an overlap may be too small for a force: without one there is no friction.
            self.pressure = 0.0;
            return;
        }
        self.center /= self.pressure;
        // Per unit of pressure: that of blocks which only just touch is too small a number to be squared.
        let push = push / self.pressure;
        self.normal_n = push.norm() * self.pressure;
        self.normal = -push.normalize();
    }

    /// Loads about the centre.
    pub(super) fn loads(&self, run: &[Place], scene: &PatchScene, forces: &[FacetForce]) -> PatchLoads {
        let mut loads = PatchLoads::default();
        for &(_, _, t) in run {
            let FacetMoments { pressure, .. } = *scene.sums(t);
            if pressure > 0.0 {
                let FacetForce { push, shear, center, .. } = &forces[t as usize];
                let sign = self.sign_of(scene.touch(t));
                let (arm, load) = (center - self.center, sign * pressure * (push + shear));
                loads.load_n += load;
                loads.torque_n_m += arm.cross(&load);
            }
        }
        loads
    }
}

impl FaceMemory {
    /// The memory turned with the normal, by the least rotation: c = a × b, v + c × v + c × (c × v)/(1 + a·b).
    pub(super) fn turned_to(self, normal: &Vec3) -> Friction {
        let (c, d) = (self.normal.cross(normal), 1.0 + self.normal.dot(normal));
        let in_plane = |v: Vec3| {
            let turned = v + c.cross(&v) + c.cross(&c.cross(&v)) / d;
            turned - normal * normal.dot(&turned)
        };
        Friction { force_n: in_plane(self.force_n), torque_n_m: self.torque_n_m }
    }
}

/// Histories of faces, in their order, read ahead of use.
pub(super) struct Remembered<'a> {
    rest: &'a [FaceMemory],
}

impl<'a> Remembered<'a> {
    pub(super) fn since(history: &'a ContactHistory, first: &PatchFacets) -> Self {
        let start = history.faces.partition_point(|memory| Self::is_before(memory, first));
        Self { rest: &history.faces[start..] }
    }

    fn is_before(memory: &FaceMemory, facets: &PatchFacets) -> bool {
        order_of(memory.face, memory.target) < order_of(facets.face, facets.target)
    }

    /// That of a face on a block, none before the last one asked for.
    pub(super) fn of(&mut self, facets: &PatchFacets) -> Option<FaceMemory> {
        let passed = self.rest.iter().take_while(|memory| Self::is_before(memory, facets)).count();
        self.rest = &self.rest[passed..];
        let found = |memory: &&FaceMemory| (memory.face, memory.target) == (facets.face, facets.target);
        self.rest.first().filter(found).copied()
    }
}
