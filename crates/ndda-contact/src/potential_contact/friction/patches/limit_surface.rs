//! Coulomb friction of a whole patch: the law holds point by point, the patch answers with a force and a torque.
//!
//! The pressure of a patch is spread evenly over the rectangle that has the same force, centre and second moments. Its cells q slide at
//! v_q = V + Ω n × r_q, and friction dissipates
//!
//! ```text
//! D(V, Ω) = μN/n Σ_q √(|v_q|² + Ω² ρ²),      ρ² = (h₁² + h₂²)/24
//! ```
//!
//! ρ is the mean that |v| gains over a cell of h₁ × h₂ when it slides across its arm (half of the second moment about the cell's centre).
//! D is convex and homogeneous, so it is the support function of a convex limit surface (Goyal, Ruina & Papadopoulos 1991), and
//! friction is its slope: force F = −∂D/∂V, torque T = −∂D/∂Ω.

use ndda_mesh::{Mat3, Vec3};
use pulp::{Arch, Simd, WithSimd};

/// Cells along and across a patch whose spin matters, by its aspect ratio: on an evenly pressed rectangle force and torque are then right to 4 % of μN, the torque
/// of a pure twist to 0.5 %.
const CELLS: [(f64, [u32; 2]); 3] = [(1.5, [4, 4]), (4.5, [8, 2]), (f64::INFINITY, [16, 2])];
/// Cells along a patch that are summed side by side, so that processors take several at once.
const LANES: usize = 4;
/// Ω r / |V| below which four points will do: they have the same friction to third order.
const TRANSLATES: f64 = 0.1;
/// Slip that counts as none, as parts of the slip without friction: first coarse, then fine.
const SMOOTHING: [f64; 2] = [1e-3, 1e-8];
/// A first guess that is longer than this part of the slip without friction is not near the kink of D, and needs no coarse search.
const NEAR: f64 = 0.1;
/// Newton steps for each, and halvings of one.
const MOST_STEPS: usize = 30;
const MOST_HALVINGS: usize = 30;
/// Relative change of the minimum that rounding hides.
const ROUNDING: f64 = 1e-12;
/// Part of that torque that is within the limit whatever the cells.
const HELD: f64 = 0.99;

/// The limit surface of a patch's friction. Slips are (V₁, V₂, Ω r) along the axes of the rectangle, forces (F₁, F₂, T/r), r the radius of gyration.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LimitSurface {
    /// μN [N].
    pub most_n: f64,
    /// r, the root of the mean square distance of the pressure from its centre [m].
    pub radius_m: f64,
    /// Half the sides of the rectangle over r, the longer first.
    half: [f64; 2],
    cells: [u32; 2],
    /// ρ²/r².
    cell_radius2: f64,
    /// Most T/r.
    most_twist_n: f64,
    /// Whether four points with the same second moments stand for all cells, as the patch is taken to hardly turn.
    is_coarse: bool,
}

impl LimitSurface {
    /// From μN and the mean squares of the distance along the principal axes [m²], the larger first.
    pub(super) fn new(most_n: f64, second_moment_m2: [f64; 2]) -> Self {
        let [along, across] = second_moment_m2;
        let radius_m = (along + across).sqrt();
        let half = [(3.0 * along).sqrt() / radius_m, (3.0 * across).sqrt() / radius_m];
        let aspect = (along / across).sqrt();
        let cells = CELLS.iter().find(|(most, _)| aspect.is_nan() || aspect <= *most).unwrap_or(&CELLS[2]).1;
        let side = |k: usize| 2.0 * half[k] / f64::from(cells[k]);
        let cell_radius2 = (side(0).powi(2) + side(1).powi(2)) / 24.0;
        let mut surface =
            Self { most_n, radius_m, half, cells, cell_radius2, most_twist_n: 0.0, is_coarse: false };
        surface.most_twist_n = surface.dissipation(&Vec3::z(), 0.0).1.z;
        surface
    }

    /// Begins a search: four points will do if the patch would hardly turn at this slip without friction.
    pub(super) fn begin(&mut self, free_slip: &Vec3) {
        self.is_coarse = hardly_turns(free_slip);
    }

    /// Lets all cells count from now on where four points do not do, as the patch turns after all; whether that is so.
    pub(super) fn refine(&mut self, free_slip: &Vec3) -> bool {
        let turns = self.is_coarse && !hardly_turns(free_slip);
        self.is_coarse &= !turns;
        turns
    }

    /// D of a displacement (u₁, u₂, θ r) [J].
    pub(super) fn work_j(&self, slip: &Vec3) -> f64 {
        let surface = Self { is_coarse: hardly_turns(slip), ..*self };
        surface.dissipation(slip, 0.0).0
    }

    /// D, its gradient and its second derivatives, |v| being √(|v|² + ε²).
    #[inline(always)]
    fn dissipation(&self, slip: &Vec3, smoothing2: f64) -> (f64, Vec3, Mat3) {
        let ([n, m], [a, b]) = (self.cells, self.half);
        if self.is_coarse {
            let points = Cell { slip: *slip, radius2: 0.0, smoothing2 };
            let (x, y) = (a / 3f64.sqrt(), b / 3f64.sqrt());
            let mut sums = CellSums::<2>::default();
            sums.add(&points, &[-x, x], -y);
            sums.add(&points, &[-x, x], y);
            return sums.total(0.25 * self.most_n);
        }
        let place = |i: u32, n: u32, half: f64| (f64::from(2 * i + 1) / f64::from(n) - 1.0) * half;
        let cell = Cell { slip: *slip, radius2: self.cell_radius2, smoothing2 };
        let mut sums = CellSums::<LANES>::default();
        for j in 0..m {
            let y = place(j, m, b);
            for i in (0..n).step_by(LANES) {
                let x: [f64; LANES] = std::array::from_fn(|lane| place(i + lane as u32, n, a));
                sums.add(&cell, &x, y);
            }
        }
        sums.total(self.most_n / f64::from(n * m))
    }

    /// Whether a force is within the limit for sure: T/Tmax ≤ 1 − (F/μN)², which is the limit of a patch without width across it, and less than
    /// that of any other.
    pub(super) fn holds(&self, force: &Vec3) -> bool {
        let along2 = (force.x * force.x + force.y * force.y) / (self.most_n * self.most_n);
        force.z.abs() <= HELD * self.most_twist_n * (1.0 - along2)
    }

    /// Friction on a patch that would slip at s without, and slips at σ = s + A⁻¹ F with it: the σ of least ½ (σ − s)·A (σ − s) + D(σ).
    /// Sought from `start`, which is near σ unless it `is_first`; gives F, to `tolerance_n`: as A + D″ is at least A, the error of F is at most the
    /// residual A (σ − s) + D′. Also gives A + D″ there; none where it sticks.
    pub(super) fn friction(
        &self,
        stiffness: &Mat3,
        slips: (&Vec3, &Vec3),
        tolerance_n: f64,
        is_first: bool,
    ) -> (Vec3, Option<Mat3>) {
        let stopping = -(stiffness * slips.0);
        if self.holds(&stopping) {
            return (stopping, None);
        }
        Arch::new().dispatch(SlidingFriction { surface: self, stiffness, slips, tolerance_n, is_first })
    }

    /// [`friction`](Self::friction) of a patch that may slide: the minimum is searched for.
    #[inline(always)]
    fn sliding_friction(
        &self,
        stiffness: &Mat3,
        (free_slip, start): (&Vec3, &Vec3),
        tolerance_n: f64,
        is_first: bool,
    ) -> (Vec3, Option<Mat3>) {
        let (mut slip, mut curvature) = (*start, *stiffness);
        let is_far = is_first && start.norm() <= NEAR * free_slip.norm();
        for &smoothing in &SMOOTHING[usize::from(!is_far)..] {
            let smoothing = smoothing * free_slip.norm();
            (slip, curvature) = self.least(stiffness, (free_slip, slip), smoothing, tolerance_n);
        }
        let force = stiffness * (slip - free_slip);
        (self.shortened(force), Some(curvature))
    }

    /// Newton's method with a line search: the slip, and A + D″ there.
    #[inline(always)]
    fn least(
        &self,
        stiffness: &Mat3,
        (free_slip, start): (&Vec3, Vec3),
        smoothing: f64,
        tolerance_n: f64,
    ) -> (Vec3, Mat3) {
        let smoothing2 = smoothing * smoothing;
        let mut slip = start;
        let (mut least, mut slope, mut curvature) = self.raised(stiffness, (free_slip, &slip), smoothing2);
        for _ in 0..MOST_STEPS {
            let Some(step) = solved(&curvature, &slope) else { break };
            let gain = slope.dot(&step);
            let is_found = slope.amax() <= tolerance_n;
            if gain.is_nan() || is_found {
                break;
            }
            let mut part = 1.0;
            let mut next = self.raised(stiffness, (free_slip, &(slip - step)), smoothing2);
            let is_less = if gain <= ROUNDING * least.abs() {
                // Rounding hides what is gained; the residual tells.
                next.1.norm_squared() < slope.norm_squared()
            } else {
                for _ in 0..MOST_HALVINGS {
                    if next.0 <= least - 1e-4 * part * gain {
                        break;
                    }
                    part *= 0.5;
                    next = self.raised(stiffness, (free_slip, &(slip - part * step)), smoothing2);
                }
                next.0 < least
            };
            if !is_less {
                break;
            }
            slip -= part * step;
            (least, slope, curvature) = next;
        }
        (slip, curvature)
    }

    /// ½ (σ − s)·A (σ − s) + D(σ), its gradient and its second derivatives.
    #[inline(always)]
    fn raised(
        &self,
        stiffness: &Mat3,
        (free_slip, slip): (&Vec3, &Vec3),
        smoothing2: f64,
    ) -> (f64, Vec3, Mat3) {
        let gap = slip - free_slip;
        let force = stiffness * gap;
        let (dissipation, slope, curvature) = self.dissipation(slip, smoothing2);
        (0.5 * gap.dot(&force) + dissipation, force + slope, stiffness + curvature)
    }

    /// A force no longer than μN: Newton's method ends a rounding beyond.
    fn shortened(&self, force: Vec3) -> Vec3 {
        let along = (force.x * force.x + force.y * force.y).sqrt();
        let part = if along > self.most_n { self.most_n / along } else { 1.0 };
        Vec3::new(part * force.x, part * force.y, force.z.clamp(-self.most_twist_n, self.most_twist_n))
    }
}

/// A question for the friction of a patch that does not stick for sure: the same sums in the same order, on the processor's widest lanes.
struct SlidingFriction<'a> {
    surface: &'a LimitSurface,
    stiffness: &'a Mat3,
    slips: (&'a Vec3, &'a Vec3),
    tolerance_n: f64,
    is_first: bool,
}

impl WithSimd for SlidingFriction<'_> {
    type Output = (Vec3, Option<Mat3>);

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let Self { surface, stiffness, slips, tolerance_n, is_first } = self;
        surface.sliding_friction(stiffness, slips, tolerance_n, is_first)
    }
}

/// Slip of the patch, ρ²/r² and ε²: the same for all of its cells.
#[derive(Clone, Copy)]
struct Cell {
    slip: Vec3,
    radius2: f64,
    smoothing2: f64,
}

/// Sums over cells of the dissipation for one newton of friction on each, and of its derivatives: xx, yy, zz, xy, xz, yz; several cells side by side.
#[derive(Clone, Copy)]
struct CellSums<const N: usize> {
    value: [f64; N],
    slope: [[f64; N]; 3],
    curvature: [[f64; N]; 6],
}

impl<const N: usize> Default for CellSums<N> {
    fn default() -> Self {
        Self { value: [0.0; N], slope: [[0.0; N]; 3], curvature: [[0.0; N]; 6] }
    }
}

impl<const N: usize> CellSums<N> {
    /// Adds the cells at x in the row at y.
    #[inline(always)]
    fn add(&mut self, &Cell { slip, radius2, smoothing2 }: &Cell, x: &[f64; N], y: f64) {
        let (u, twist) = (slip.x - slip.z * y, radius2 * slip.z);
        let fixed = twist * slip.z;
        for (lane, x) in x.iter().enumerate() {
            let v = slip.y + slip.z * x;
            let speed = (u * u + v * v + fixed + smoothing2).sqrt();
            let per_speed = if speed > 0.0 { 1.0 / speed } else { 0.0 };
            let (e, f) = (u * per_speed, v * per_speed);
            let t = x * f - y * e + twist * per_speed;
            let turn = x * x + y * y + radius2;
            self.value[lane] += speed;
            let slope = [e, f, t];
            let curvature = [1.0 - e * e, 1.0 - f * f, turn - t * t, -e * f, -(y + e * t), x - f * t];
            self.slope.iter_mut().zip(slope).for_each(|(sum, part)| sum[lane] += part);
            self.curvature.iter_mut().zip(curvature).for_each(|(sum, part)| sum[lane] += part * per_speed);
        }
    }

    /// D, its gradient and its second derivatives, each cell bearing this much friction [N].
    #[inline(always)]
    fn total(&self, share: f64) -> (f64, Vec3, Mat3) {
        let sum = |lanes: &[f64; N]| share * lanes.iter().sum::<f64>();
        let [xx, yy, zz, xy, xz, yz] = self.curvature.each_ref().map(sum);
        let slope = Vec3::from(self.slope.each_ref().map(sum));
        (sum(&self.value), slope, Mat3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz))
    }
}

/// Whether Ω r is small beside |V|.
fn hardly_turns(slip: &Vec3) -> bool {
    slip.z * slip.z < TRANSLATES * TRANSLATES * (slip.x * slip.x + slip.y * slip.y)
}

/// A⁻¹ b for a positive definite A.
#[inline(always)]
pub(super) fn solved(a: &Mat3, b: &Vec3) -> Option<Vec3> {
    let d0 = a[(0, 0)];
    let (l1, l2) = (a[(1, 0)] / d0, a[(2, 0)] / d0);
    let d1 = a[(1, 1)] - l1 * a[(1, 0)];
    let w = a[(2, 1)] - l2 * a[(1, 0)];
    let l3 = w / d1;
    let d2 = a[(2, 2)] - l2 * a[(2, 0)] - l3 * w;
    if !(d0 > 0.0 && d1 > 0.0 && d2 > 0.0) {
        return None;
    }
    let y1 = b.y - l1 * b.x;
    let z = (b.z - l2 * b.x - l3 * y1) / d2;
    let y = y1 / d1 - l3 * z;
    Some(Vec3::new(b.x / d0 - l1 * y - l2 * z, y, z))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// D of a rectangle and of its four points differ by E[½ p² q² − ⅛ q⁴] θ⁴ of μN|V| at most, θ = Ω r/|V|, with the parts p along the slip and q across it
    /// of n × r over the radius of gyration. Fourth moments differ by 0.8 of the squared second ones, so by 0.1 θ⁴; the torque, its slope, by 0.4 θ³.
    #[test]
    fn four_points_have_the_friction_of_all_cells_to_third_order_where_a_patch_hardly_turns() {
        for aspect in [1.0f64, 2.0, 10.0] {
            let surface = LimitSurface::new(1.0, [aspect.powi(2), 1.0]);
            let many = LimitSurface { cells: [200, 200], cell_radius2: 0.0, ..surface };
            let points = LimitSurface { is_coarse: true, ..surface };
            for angle in (0..=6).map(|k| f64::from(k) * std::f64::consts::FRAC_PI_2 / 6.0) {
                for turn in [TRANSLATES, 0.5 * TRANSLATES] {
                    let slip = Vec3::new(angle.cos(), angle.sin(), turn);
                    let off = (points.dissipation(&slip, 0.0).1 - many.dissipation(&slip, 0.0).1).norm();
                    // The midpoint rule leaves out 200⁻² of a second moment.
                    assert!(off <= 0.5 * turn.powi(3) + turn / 200f64.powi(2), "{off:e}: {aspect}, {slip}");
                }
            }
        }
    }

    /// The limit surface is that of a convex set; where none of its points is within the region that surely holds, that region is within the set.
    #[test]
    fn what_surely_holds_is_within_the_limit_surface() {
        for aspect in [1.0, 1.2, 1.49, 1.51, 2.0, 3.0, 4.49, 4.51, 8.0, 30.0, 1e3] {
            let surface = LimitSurface::new(5.0, [aspect * aspect, 1.0]);
            let directions = (0..=24).map(|k| f64::from(k) * std::f64::consts::PI / 24.0);
            let twists = (-30..=30).map(|k| 10f64.powf(0.05 * f64::from(k)));
            for (angle, twist) in directions.flat_map(|a| twists.clone().map(move |t| (a, t))) {
                let slip = Vec3::new(angle.cos(), angle.sin(), twist);
                let limit = surface.dissipation(&slip, 0.0).1;
                assert!(!surface.holds(&(limit * 0.999_999)), "aspect {aspect}, slip {slip}, force {limit}");
                assert!(surface.holds(&(limit * 0.8)), "aspect {aspect}, slip {slip}, force {limit}");
            }
        }
    }
}
