//! Contact damping by a coefficient of restitution.
//!
//! The push of each point is multiplied by 1 + α δ̇/E (`law.rs`), δ̇ being the speed at which the two blocks approach there and E that of the energy
//! of the pair: √(δ̇² + s²), s = F √(1/(m k)) for the force F, the stiffness k and the reduced mass m of all points of the pair. It never pulls, it does
//! not change the depth at rest, and it takes energy from every motion along the normal, rocking included.
//!
//! The force of a step depends on the velocity that it leads to, which is solved for (`pair.rs`): pair by pair, blocks being rigid, until the forces of
//! all pairs stay. Forces beside the push, such as friction and those of supports, are those of the step before.

mod dashpot;
mod law;
mod memory;
mod pair;
mod scene;
mod shear;
mod softness;
mod table;

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockId, BlockSet, Vec3};

use crate::affine::convex_target::ConvexBlocks;
use crate::assembly::couples::CoupleScene;
use crate::friction::facet::relative_motion;
use crate::integration::integrals::Integrals;
use crate::model::{Body, ContactHistory, ContactInput};
use crate::restitution::dashpot::{Dashpot, DashpotPair};
use crate::restitution::pair::{ALONG, Change, Pair, Point, take_one_normal};

pub(crate) use scene::DampingScene;
pub use table::{Restitution, RestitutionTable};

/// Part of the largest force that the damping of a pair may still change by.
const TOLERANCE: f64 = 1e-9;
/// Sweeps over all pairs.
const MOST_SWEEPS: usize = 50;

/// Damping of the contacts of a step, and the memory that it is found in.
pub(crate) struct ContactDamping {
    table: RestitutionTable,
    /// Touching facets that are damped, by pair of blocks.
    order: Vec<([BlockId; 2], u32)>,
    points: Vec<Point>,
    pairs: Vec<Pair>,
    /// Motion that the step brings to each block.
    changes: Vec<Change>,
    /// For each block that deforms one vector per node in each column: its own motion, and how it answers to each of its pairs.
    columns: Vec<Vec<Vec3>>,
    /// Blocks that have columns, and these while the blocks answer.
    answering: Vec<BlockId>,
    answers: Vec<Vec<Vec3>>,
    /// Pairs of each block that have been looked at.
    asked: Vec<usize>,
    /// Elastic push of each touching facet [Pa], and what is left of it.
    push_pa: Vec<Vec3>,
    left_pa: Vec<f64>,
    /// Reduction of the pressure [Pa] by damping, and its moment about the centre of pressure [N m], on the facet.
    taken_pa: Vec<Vec3>,
    tilt_n_m: Vec<Vec3>,
    /// Dashpots beside shear springs, pair by pair, and the force of theirs on each touching facet [N]; none without springs.
    dashpots: Vec<Dashpot>,
    dashpot_pairs: Vec<DashpotPair>,
    shear_n: Vec<Vec3>,
    /// Room for a number of each node.
    of_node: Vec<f64>,
    /// Blocks with the moments of damping among their loads.
    bodies: Vec<Body>,
}

impl ContactDamping {
    /// Damping with these coefficients.
    pub(crate) fn new(table: RestitutionTable) -> Self {
        Self {
            table,
            order: Vec::new(),
            points: Vec::new(),
            pairs: Vec::new(),
            changes: Vec::new(),
            columns: Vec::new(),
            answering: Vec::new(),
            answers: Vec::new(),
            asked: Vec::new(),
            push_pa: Vec::new(),
            left_pa: Vec::new(),
            taken_pa: Vec::new(),
            tilt_n_m: Vec::new(),
            dashpots: Vec::new(),
            dashpot_pairs: Vec::new(),
            shear_n: Vec::new(),
            of_node: Vec::new(),
            bodies: Vec::new(),
        }
    }

    /// Whether a contact has a restitution below 0.6.
    pub(crate) fn is_strong(&self) -> bool {
        self.table.damps_strongly()
    }

    /// Finds the damping of all facets that touch.
    pub(crate) fn find(&mut self, scene: &DampingScene, history: &mut ContactHistory) {
        self.place_pushes(scene);
        self.predict(scene, history);
        self.list(scene);
        self.gather(scene);
        self.ask_blocks(scene);
        self.solve(scene);
        self.spread(scene);
        self.damp_springs(scene, history);
        self.remember(scene, history);
    }

    /// Penalty of each touching facet with damping [Pa].
    pub(crate) fn left_pa(&self) -> &[f64] {
        &self.left_pa
    }

    /// Moment of damping on each touching facet about its centre of pressure [N m].
    pub(crate) fn tilt_n_m(&self) -> &[Vec3] {
        &self.tilt_n_m
    }

    /// Force of the dashpot beside the shear spring of each touching facet on it [N]; empty without springs.
    pub(crate) fn shear_n(&self) -> &[Vec3] {
        &self.shear_n
    }

    /// Reduction of the pressure on each touching facet by damping [Pa].
    pub(crate) fn taken_pa(&self) -> &[Vec3] {
        &self.taken_pa
    }

    /// Blocks with the moments of damping among their loads.
    pub(crate) fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// Elastic push of each touching facet.
    fn place_pushes(&mut self, scene: &DampingScene) {
        let ContactInput { blocks, position, .. } = *scene.input;
        self.push_pa.clear();
        for (touch, penalty_pa) in scene.integrals.touching().iter().zip(scene.penalty_pa) {
            let corners = blocks.triangle_corners(touch.triangle, position);
            let presses = scene.integrals.sums_of(touch).pressure > 0.0;
            let normal = triangle_area_vector(&corners).normalize();
            self.push_pa.push(if presses { -*penalty_pa * normal } else { Vec3::zeros() });
        }
    }

    /// Facets that are damped, by pair.
    fn list(&mut self, scene: &DampingScene) {
        self.order.clear();
        for (t, touch) in (0..).zip(scene.integrals.touching()) {
            // Walls that ride on each other part without leaving each other.
            let rides = scene.openings.have(touch.triangle, touch.target);
            let presses = !rides && self.push_pa[t as usize] != Vec3::zeros();
            if presses && self.table.factors(scene.input.blocks, touch.triangle, touch.target).damp() {
                let pair = [touch.owner.min(touch.target), touch.owner.max(touch.target)];
                self.order.push((pair, t));
            }
        }
        self.order.sort_unstable();
    }

    /// The points of all pairs.
    fn gather(&mut self, scene: &DampingScene) {
        self.points.clear();
        self.pairs.clear();
        let ContactInput { bodies, dt_s, .. } = *scene.input;
        for run in self.order.chunk_by(|a, b| a.0 == b.0) {
            let pair = run[0].0;
            if pair.iter().all(|block| bodies[block.index()].mass_kg.is_infinite()) {
                continue;
            }
            let first = self.points.len();
            for &(_, t) in run {
                let touch = &scene.integrals.touching()[t as usize];
                let factor = self.table.factors(scene.input.blocks, touch.triangle, touch.target).normal;
                if factor > 0.0 {
                    self.points.extend(scene.points(t, &self.push_pa[t as usize], (pair, factor)));
                }
            }
            let are_convex = pair.iter().all(|block| scene.hulls.is_convex(*block));
            let owner = |point: &Point| scene.integrals.touching()[point.facet as usize].owner;
            take_one_normal(&mut self.points[first..], are_convex, |point| owner(point) == pair[0]);
            let stiffness_n_m = scene.stiffness_n_m(&self.points[first..], &self.push_pa);
            let range = [first as u32, self.points.len() as u32];
            match Pair::new((pair, range), &self.points[first..], stiffness_n_m, bodies, dt_s) {
                Some(pair) => self.pairs.push(pair),
                None => self.points.truncate(first),
            }
        }
    }

    /// Damping with E at the start of the step, then with that in the middle of the step which it leads to.
    fn solve(&mut self, scene: &DampingScene) {
        self.sweep(scene);
        let Self { points, pairs, changes, .. } = self;
        let ContactInput { bodies, dt_s, .. } = *scene.input;
        for pair in pairs {
            pair.center_rates(&mut points[pair.range()], (bodies, changes), dt_s);
        }
        self.sweep(scene);
    }

    /// Pair by pair, until the damping of none changes.
    fn sweep(&mut self, scene: &DampingScene) {
        let Self { points, pairs, changes, .. } = self;
        let largest_n = points.iter().map(|point| point.force_n).fold(0.0, f64::max);
        let ContactInput { bodies, dt_s, .. } = *scene.input;
        for _ in 0..MOST_SWEEPS {
            let mut change_n = 0.0f64;
            for pair in &*pairs {
                change_n = change_n.max(pair.advance(&mut points[pair.range()], (bodies, changes), dt_s));
            }
            if change_n <= TOLERANCE * largest_n {
                break;
            }
        }
    }

    /// From points to facets.
    fn spread(&mut self, scene: &DampingScene) {
        let touching = scene.integrals.touching();
        for list in [&mut self.taken_pa, &mut self.tilt_n_m] {
            list.clear();
            list.resize(touching.len(), Vec3::zeros());
        }
        self.left_pa.clear();
        self.left_pa.extend_from_slice(scene.penalty_pa);
        self.bodies.clear();
        self.bodies.extend_from_slice(scene.input.bodies);
        for pair in &self.pairs {
            let points = &self.points[pair.range()];
            let of_pair = taken_part(points);
            for four in points.chunks_exact(4) {
                let t = four[0].facet as usize;
                let touch = &touching[t];
                let push_pa = self.push_pa[t];
                let sign = if touch.owner == pair.blocks[0] { 1.0 } else { -1.0 };
                let unit = sign * four[0].push;
                // Others are damped by what presses all of the pair, so that their pushes across that direction stay in balance.
                let is_along = unit.dot(&push_pa) > ALONG * push_pa.norm();
                let part = if is_along { taken_part(four) } else { of_pair };
                self.left_pa[t] = scene.penalty_pa[t] * (1.0 - part);
                self.taken_pa[t] = part * push_pa;
                let moment: Vec3 = four.iter().map(|point| point.taken_n * point.arm).sum();
                let tilt_n_m = -moment.cross(&unit);
                self.tilt_n_m[t] = tilt_n_m;
                self.bodies[touch.owner.index()].torque_n_m += tilt_n_m;
                self.bodies[touch.target.index()].torque_n_m -= tilt_n_m;
            }
        }
    }

    /// Work of damping over displacements of the nodes [m]: blocks and work [J], one call for each facet.
    pub(crate) fn each_work(
        &self,
        (blocks, integrals, hulls): (&BlockSet, &Integrals, &ConvexBlocks),
        position: &[Vec3],
        moved: &[Vec3],
        add: &mut dyn FnMut(BlockId, BlockId, f64),
    ) {
        let couples = CoupleScene { blocks, position, integrals, hulls };
        for (t, touch) in integrals.touching().iter().enumerate() {
            let (taken_pa, tilt_n_m) = (self.taken_pa[t], self.tilt_n_m[t]);
            if taken_pa == Vec3::zeros() && tilt_n_m == Vec3::zeros() {
                continue;
            }
            let found = (integrals.overlaps_of(touch), integrals.sums_of(touch));
            let mut work_j = -taken_pa.dot(&relative_motion(touch, found, (blocks, moved)));
            for (is_owner, tilt_n_m) in [(true, tilt_n_m), (false, -tilt_n_m)] {
                couples
                    .each_force(touch, is_owner, &tilt_n_m, |node, force| work_j += force.dot(&moved[node]));
            }
            add(touch.owner, touch.target, work_j);
        }
    }
}

/// Part of their push that damping takes from points.
fn taken_part(points: &[Point]) -> f64 {
    let sum = |of: fn(&Point) -> f64| points.iter().map(of).sum::<f64>();
    sum(|point| point.taken_n) / sum(|point| point.force_n)
}
