//! Damping of all points at which two blocks press each other, found together.

use nalgebra::{Matrix6, Vector6};
use ndda_mesh::{BlockId, Mat3, Vec3};

use crate::model::Body;
use crate::restitution::law::weight_of_end;

/// Cosine of about 8°: a facet is pressed along the force between the blocks if its normal is that near to it.
pub(super) const ALONG: f64 = 0.99;
/// Force on other facets, over that on those that are pressed along the force, that hardly counts.
const BESIDE: f64 = 0.02;
/// Part of the elastic push of a point that damping leaves at least, so that a push has a direction.
const LEFT: f64 = 1e-9;
/// Where blocks turn from approach to parting within a step, a point is damped by at most so many times its mean velocity, whose sign is that of the
/// work.
const MEAN: f64 = 4.0;
/// Solutions of one pair until no point changes from one branch of the law to another.
const MOST_ROUNDS: usize = 8;

/// A point that stands for a quarter of the pressure on a facet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    /// In the list of facets that touch.
    pub facet: u32,
    /// From the centre of pressure of the facet [m].
    pub arm: Vec3,
    /// Place [m].
    pub x: Vec3,
    /// Direction of the push on the first block: that of the facet or, of convex blocks, that of all of the pair.
    pub push: Vec3,
    /// Elastic force along it [N].
    pub force_n: f64,
    /// α.
    pub factor: f64,
    /// Velocity of the first block relative to the second here at the start of the step, and along the push [m/s].
    pub velocity_m_s: Vec3,
    pub parting_m_s: f64,
    /// Force per velocity [N s/m], and where in the step the velocity counts.
    pub rate: f64,
    pub end: f64,
    /// Change of the parting speed in the step without the damping of the same pair [m/s].
    pub free_m_s: f64,
    /// Reduction of the normal force by damping [N].
    pub taken_n: f64,
}

/// Blocks that touch in one region part along the force between them, and each point counts by what it pushes along that: an edge that slides in a face is not damped, though
/// the faces beside it part along their own normals. Two convex blocks do so, and others where one of them, the owner of facets, presses with faces along the force alone.
pub(super) fn take_one_normal(points: &mut [Point], are_convex: bool, is_of_first: impl Fn(&Point) -> bool) {
    let force_n: Vec3 = points.iter().map(|point| point.force_n * point.push).sum();
    let Some(normal) = force_n.try_normalize(0.0) else { return };
    let is_flat = |first: bool| {
        let (mut along_n, mut beside_n) = (0.0, 0.0);
        for point in points.iter().filter(|point| is_of_first(point) == first) {
            *(if point.push.dot(&normal) > ALONG { &mut along_n } else { &mut beside_n }) += point.force_n;
        }
        along_n > 0.0 && beside_n <= BESIDE * along_n
    };
    if !(are_convex || is_flat(true) || is_flat(false)) {
        return;
    }
    for point in points {
        point.force_n *= normal.dot(&point.push).max(0.0);
        point.push = normal;
        point.parting_m_s = normal.dot(&point.velocity_m_s);
    }
}

/// Change of the motion of a block in a step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Change {
    /// Of its mass centre [m/s].
    pub velocity_m_s: Vec3,
    /// Of its rotation [rad/s].
    pub spin_rad_s: Vec3,
}

impl Change {
    /// Adds that by a force at x all through a step.
    pub(super) fn push(&mut self, body: &Body, x: &Vec3, force_n: &Vec3, dt_s: f64) {
        self.velocity_m_s += dt_s / body.mass_kg * force_n;
        self.spin_rad_s += dt_s * (body.inverse_inertia * (x - body.center).cross(force_n));
    }

    /// Change of the velocity at a point [m/s].
    pub(super) fn at(&self, body: &Body, x: &Vec3) -> Vec3 {
        self.velocity_m_s + self.spin_rad_s.cross(&(x - body.center))
    }
}

/// Two blocks that press each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub blocks: [BlockId; 2],
    /// Its points.
    points: [u32; 2],
    /// Where its forces act [m], their sum on the first block without damping [N], and its direction.
    pub center: Vec3,
    pub total_n: f64,
    pub push: Vec3,
    /// 1/m for it [1/kg].
    inverse_mass: f64,
    /// By how much the surfaces of its blocks give way beyond the motion of these as rigid ones in a step [m/s per N].
    pub softness: f64,
    /// Part of the damping that the step leaves out.
    pub lag: f64,
    /// √(2W/m) [m/s].
    stored_m_s: f64,
    /// Change of the relative motion by a force and a torque about the centre on the first block and the opposite on the second, all through a step
    /// [m/s, rad/s per N, N m].
    response: Matrix6<f64>,
}

/// Change of the relative motion of two blocks by a force and a torque about a centre on the first and the opposite on the second, all through a step
/// [m/s, rad/s per N, N m].
pub(super) fn response(both: [&Body; 2], center: &Vec3, dt_s: f64) -> Matrix6<f64> {
    let mut response = Matrix6::zeros();
    for body in both {
        let arm = center - body.center;
        for k in 0..6 {
            let axis = Vec3::ith(k % 3, 1.0);
            let (force, torque) = if k < 3 { (axis, arm.cross(&axis)) } else { (Vec3::zeros(), axis) };
            let spin = body.inverse_inertia * torque;
            let velocity = force / body.mass_kg + spin.cross(&arm);
            let mut column = response.column_mut(k);
            for i in 0..3 {
                column[i] += dt_s * velocity[i];
                column[i + 3] += dt_s * spin[i];
            }
        }
    }
    response
}

/// Velocity [m/s] that a unit force along `push` at x takes from or gives to the point itself, per second: 1/m + |r × n|²/J.
fn inverse_mass(body: &Body, x: &Vec3, push: &Vec3) -> f64 {
    let moment = (x - body.center).cross(push);
    1.0 / body.mass_kg + moment.dot(&(body.inverse_inertia * moment))
}

impl Pair {
    /// The pair of these points, whose forces grow by `stiffness_n_m` with the depth. Nothing if neither block can move.
    pub(super) fn new(
        (blocks, range): ([BlockId; 2], [u32; 2]),
        points: &[Point],
        stiffness_n_m: f64,
        bodies: &[Body],
        dt_s: f64,
    ) -> Option<Self> {
        let total_n: f64 = points.iter().map(|point| point.force_n).sum();
        let center = points.iter().map(|point| point.force_n * point.x).sum::<Vec3>() / total_n;
        let push = points.iter().map(|point| point.force_n * point.push).sum::<Vec3>();
        let push = if push == Vec3::zeros() { points.first()?.push } else { push.normalize() };
        let [a, b] = blocks.map(|block| &bodies[block.index()]);
        let inverse_mass = inverse_mass(a, &center, &push) + inverse_mass(b, &center, &push);
        // s = √(2W/m) of a force that grows in proportion to the depth.
        let stored_m_s = total_n * (inverse_mass / stiffness_n_m).sqrt();
        if !(stored_m_s > 0.0 && stored_m_s.is_finite()) {
            return None;
        }
        let response = response([a, b], &center, dt_s);
        Some(Self {
            blocks,
            points: range,
            center,
            total_n,
            push,
            inverse_mass,
            softness: 0.0,
            lag: 0.0,
            stored_m_s,
            response,
        })
    }

    /// Its points in the list of all.
    pub(super) fn range(&self) -> std::ops::Range<usize> {
        self.points[0] as usize..self.points[1] as usize
    }

    /// Change of velocity along the push by a unit of it on one of both blocks in a step, if that is rigid [m/s per N].
    pub(super) fn rigid_response(&self, body: &Body, dt_s: f64) -> f64 {
        dt_s * inverse_mass(body, &self.center, &self.push)
    }

    /// Sets the rates of its points: F α/E, and no more than surfaces that give way can follow within the step, each point by its share of the push. E is
    /// that at the middle of a step that changes the parting velocity of a point by so much [m/s].
    pub(super) fn set_rates(&mut self, points: &mut [Point], dt_s: f64, change_m_s: impl Fn(&Point) -> f64) {
        self.lag = 0.0;
        for point in points {
            let parting_m_s = point.parting_m_s + 0.5 * change_m_s(point);
            let rate = point.factor / self.stored_m_s.hypot(parting_m_s) * self.total_n;
            let over = (rate * self.softness).max(1.0);
            point.end = weight_of_end(rate * self.inverse_mass * dt_s);
            point.rate = point.force_n / self.total_n * rate / over;
            self.lag = self.lag.max(1.0 - 1.0 / over);
        }
    }

    /// Sets the rates for the middle of the step that has been found.
    pub(super) fn center_rates(
        &mut self,
        points: &mut [Point],
        (bodies, changes): (&[Body], &[Change]),
        dt_s: f64,
    ) {
        let [a, b] = self.blocks.map(|block| block.index());
        let change_m_s = |point: &Point| {
            let both = changes[a].at(&bodies[a], &point.x) - changes[b].at(&bodies[b], &point.x);
            point.push.dot(&both)
        };
        self.set_rates(points, dt_s, change_m_s);
    }

    /// Finds the damping of this pair while that of all others stays; returns the largest change [N].
    pub(super) fn advance(
        &self,
        points: &mut [Point],
        (bodies, changes): (&[Body], &mut [Change]),
        dt_s: f64,
    ) -> f64 {
        let [a, b] = self.blocks.map(|block| block.index());
        let own: Vector6<f64> = points.iter().map(|point| self.wrench(point) * point.taken_n).sum();
        let own = self.response * own;
        for point in &mut *points {
            let both = changes[a].at(&bodies[a], &point.x) - changes[b].at(&bodies[b], &point.x);
            point.free_m_s = point.push.dot(&both) + self.wrench(point).dot(&own);
        }
        let motion = self.solve(points);
        let (mut largest, mut taken) = (0.0f64, Vector6::zeros());
        for point in points {
            let wrench = self.wrench(point);
            let taken_n = point.taken(point.free_m_s + wrench.dot(&motion));
            let change_n = taken_n - point.taken_n;
            largest = largest.max(change_n.abs());
            point.taken_n = taken_n;
            taken += wrench * change_n;
        }
        self.apply(&taken, (bodies, changes), dt_s);
        largest
    }

    /// Relative motion that the damping of all points adds in the step: each point is on a branch of its law, on which all of them are linear.
    fn solve(&self, points: &[Point]) -> Vector6<f64> {
        let (mut motion, mut branches) = (Vector6::zeros(), None);
        for _ in 0..MOST_ROUNDS {
            let law = |point: &Point, wrench: &Vector6<f64>| point.law(point.free_m_s + wrench.dot(&motion));
            let found = points.iter().fold(0u64, |found, point| {
                found.wrapping_mul(31).wrapping_add(law(point, &self.wrench(point)).number)
            });
            if branches == Some(found) {
                break;
            }
            let (mut matrix, mut side) = (Matrix6::identity(), Vector6::zeros());
            for point in points {
                let wrench = self.wrench(point);
                let law = law(point, &wrench);
                let push = self.response * wrench;
                side -= push * (law.constant_n + law.rate * (point.parting_m_s + law.end * point.free_m_s));
                matrix += push * wrench.transpose() * (law.rate * law.end);
            }
            let Some(inverse) = matrix.try_inverse() else { break };
            (motion, branches) = (inverse * side, Some(found));
        }
        motion
    }

    /// Force and torque about the centre of a unit push on the first block.
    fn wrench(&self, point: &Point) -> Vector6<f64> {
        let torque = (point.x - self.center).cross(&point.push);
        Vector6::new(point.push.x, point.push.y, point.push.z, torque.x, torque.y, torque.z)
    }

    /// Takes a push from both blocks.
    fn apply(&self, taken: &Vector6<f64>, (bodies, changes): (&[Body], &mut [Change]), dt_s: f64) {
        let (force, torque) = (taken.fixed_rows::<3>(0).into_owned(), taken.fixed_rows::<3>(3).into_owned());
        for (block, sign) in self.blocks.iter().zip([-1.0, 1.0]) {
            let (body, change) = (&bodies[block.index()], &mut changes[block.index()]);
            change.push(body, &self.center, &(sign * force), dt_s);
            change.spin_rad_s += sign * dt_s * (body.inverse_inertia * torque);
        }
    }
}

/// One branch of the law of a point: constant + rate · (w₀ + end · Δw) [N].
struct Branch {
    /// Which: 0 takes nothing, as the velocity changes its sign in the step; 1 takes all of the push; 2 goes by the velocity at the point of the step that
    /// counts; 3 by [`MEAN`] times the mean velocity, where that is less.
    number: u64,
    constant_n: f64,
    rate: f64,
    end: f64,
}

impl Point {
    /// The branch for a change Δw of the parting velocity in the step [m/s]. The velocity is taken at the point of the step at which the decay is that of the
    /// continuous law, or as [`MEAN`] times the mean velocity where that is less; where the two have different signs nothing is taken, and never more than the push.
    fn law(&self, change_m_s: f64) -> Branch {
        let in_step = self.parting_m_s + self.end * change_m_s;
        let mean = MEAN * (self.parting_m_s + 0.5 * change_m_s);
        let most_n = (1.0 - LEFT) * self.force_n;
        let least = if in_step.abs() <= mean.abs() { in_step } else { mean };
        if in_step * mean <= 0.0 {
            Branch { number: 0, constant_n: 0.0, rate: 0.0, end: 0.0 }
        } else if self.rate * least >= most_n {
            Branch { number: 1, constant_n: most_n, rate: 0.0, end: 0.0 }
        } else if least == in_step {
            Branch { number: 2, constant_n: 0.0, rate: self.rate, end: self.end }
        } else {
            Branch {
                number: 3,
                constant_n: (MEAN - 1.0) * self.rate * self.parting_m_s,
                rate: self.rate,
                end: 0.5 * MEAN,
            }
        }
    }

    /// Reduction of the normal force by the law [N].
    fn taken(&self, change_m_s: f64) -> f64 {
        let Branch { constant_n, rate, end, .. } = self.law(change_m_s);
        constant_n + rate * (self.parting_m_s + end * change_m_s)
    }
}

/// Arms of four points, two on each of two axes, whose second moments along these are those of a pressure [m].
pub(super) fn four_points(second_moment_m2: &Mat3, axes: &[Vec3; 2]) -> [Vec3; 4] {
    let [one, two] = axes.map(|axis| (2.0 * axis.dot(&(second_moment_m2 * axis)).max(0.0)).sqrt() * axis);
    [one, -one, two, -two]
}
