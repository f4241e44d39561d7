//! The fluxes from which the energy of the element potential follows, for many regions at a time.

use pulp::{Arch, Simd, WithSimd};

use crate::integration::kernel::{Edges, Form, GROUP, RegionGroup, Row};
use crate::integration::pair_moments::mean_flux;
use crate::integration::queue::Batch;
use crate::integration::region::{count_cuts, element_outside, is_somewhere};

/// Regions of the element potential have up to four cuts.
const BATCHES: usize = 5;

/// Regions that wait until there are enough of them for all lanes, and the means of a over those that do not
/// (see [`pair_moments`](crate::integration::pair_moments)).
#[derive(Default)]
pub(crate) struct FluxQueue {
    waiting: [Batch; BATCHES],
    /// Piece and mean of each region, as they came.
    parts: Vec<(u32, f64)>,
    fluxes: GroupFluxes,
}

/// ∫ a dA of a group, over the triangle's area.
#[derive(Default)]
struct GroupFluxes {
    mean: Row,
    /// Not zero where the region has to be done one by one.
    doubtful: Row,
}

impl FluxQueue {
    /// Adds the regions of a piece; `lambda[b][a]` is λ_b at corner a of its triangle.
    pub(crate) fn push(&mut self, arch: Arch, piece: u32, lambda: &[[f64; 3]; 4]) {
        let outside = element_outside(lambda);
        for i in (0..4).filter(|i| is_somewhere(&outside[*i])) {
            let cuts = count_cuts(&outside[i]);
            let batch = &mut self.waiting[cuts];
            batch.set_element(self.parts.len(), 1.0, (lambda, &outside, i, 0.0), cuts);
            self.parts.push((piece, 0.0));
            if batch.group.len == GROUP {
                flush(arch, batch, &mut self.fluxes, &mut self.parts);
            }
        }
    }

    /// Does what still waits and hands out the means of all regions as they came.
    pub(crate) fn finish(&mut self, arch: Arch, mut visit: impl FnMut(u32, f64)) {
        for batch in self.waiting.iter_mut().filter(|batch| batch.group.len > 0) {
            flush(arch, batch, &mut self.fluxes, &mut self.parts);
        }
        self.parts.drain(..).for_each(|(piece, mean)| visit(piece, mean));
    }
}

/// Writes all means to their places.
fn flush(arch: Arch, batch: &mut Batch, fluxes: &mut GroupFluxes, parts: &mut [(u32, f64)]) {
    let group = &batch.group;
    match group.cuts {
        0 => arch.dispatch(FluxKernel::<0, 3> { group, fluxes }),
        1 => arch.dispatch(FluxKernel::<1, 4> { group, fluxes }),
        2 => arch.dispatch(FluxKernel::<2, 5> { group, fluxes }),
        3 => arch.dispatch(FluxKernel::<3, 6> { group, fluxes }),
        _ => arch.dispatch(FluxKernel::<4, 7> { group, fluxes }),
    }
    for lane in 0..group.len {
        let mean = if fluxes.doubtful[lane] == 0.0 {
            fluxes.mean[lane]
        } else {
            let (polygon, phi) = batch.ordered(lane);
            mean_flux(&polygon, &phi)
        };
        parts[batch.part[lane]].1 = mean;
    }
    (batch.group.len, batch.group.cuts) = (0, 0);
}

struct FluxKernel<'a, const CUTS: usize, const EDGES: usize> {
    group: &'a RegionGroup,
    fluxes: &'a mut GroupFluxes,
}

impl<const CUTS: usize, const EDGES: usize> WithSimd for FluxKernel<'_, CUTS, EDGES> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { group, fluxes } = self;
        for k in 0..group.len.div_ceil(S::F64_LANES) {
            let load = |row: &Row| S::as_simd_f64s(row).0[k];
            let field = |at: &[Row; 3]| Form::through(simd, [load(&at[0]), load(&at[1]), load(&at[2])]);
            let mut doubtful = simd.splat_f64s(0.0);
            let mut cuts = group.fields.iter().zip(&group.bounds).take(CUTS);
            let mut edges = match cuts.next() {
                None => Edges::<S, EDGES>::triangle(simd),
                Some((cut, bound)) => Edges::of_triangle(simd, &field(cut), load(bound)),
            };
            for (cut, bound) in cuts {
                edges.cut(simd, &field(cut), load(bound), &mut doubtful);
            }
            let mean = mean_of_a(simd, &edges, &field(&group.phi));
            S::as_mut_simd_f64s(&mut fluxes.mean).0[k] = mean;
            S::as_mut_simd_f64s(&mut fluxes.doubtful).0[k] = doubtful;
        }
    }
}

/// ∫ a dA over the triangle's area: for each triangle of the fan about a corner, its part of the area times the mean
/// −(p² − q − p q + r + p r) / (12 (1 − φ₁)(1 − φ₂)(1 − φ₃)), p = Σφ, q = Σ φᵢφⱼ, r = φ₁φ₂φ₃.
#[inline(always)]
fn mean_of_a<S: Simd, const MOST: usize>(simd: S, edges: &Edges<S, MOST>, phi: &Form<S>) -> S::f64s {
    let (add, sub) = (|a, b| simd.add_f64s(a, b), |a, b| simd.sub_f64s(a, b));
    let mul = |a, b| simd.mul_f64s(a, b);
    let (zero, one) = (simd.splat_f64s(0.0), simd.splat_f64s(1.0));
    let [px, py] = edges.apex(simd);
    let a = phi.at(simd, px, py);
    let mut sum = zero;
    for k in 0..edges.len {
        let ([x0, x1], [y0, y1]) = (edges.x[k], edges.y[k]);
        let part = sub(mul(sub(x0, px), sub(y1, y0)), mul(sub(y0, py), sub(x1, x0)));
        let (b, c) = (phi.at(simd, x0, y0), phi.at(simd, x1, y1));
        let (p, q) = (add(a, add(b, c)), add(mul(a, b), add(mul(b, c), mul(c, a))));
        let r = mul(a, mul(b, c));
        let over = sub(add(sub(mul(p, p), q), add(r, mul(p, r))), mul(p, q));
        let apart = mul(sub(one, a), mul(sub(one, b), sub(one, c)));
        // A corner at the centroid itself: there is no limit, and the penetration is past saving.
        let is_lost = simd.less_than_or_equal_f64s(apart, zero);
        let mean = simd.div_f64s(over, mul(simd.splat_f64s(-12.0), apart));
        sum = add(sum, simd.select_f64s(is_lost, zero, mul(part, mean)));
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integration::pair_moments::pair_energy;
    use crate::integration::tet_frame::TetFrame;
    use ndda_mesh::Vec3;
    use ndda_mesh::geometry::triangle_area_vector;
    use proptest::prelude::*;

    /// Coordinates on a coarse grid, so that corners, edges and planes often meet, some off it by a few ulps.
    fn point() -> impl Strategy<Value = Vec3> {
        let coordinate = (-4i32..8, 0i32..12).prop_map(|(i, off)| {
            let on_grid = f64::from(i) * 0.125;
            if off < 8 { on_grid } else { on_grid + f64::from(off - 9) * f64::EPSILON }
        });
        prop::array::uniform3(coordinate).prop_map(Vec3::from)
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(20_000) })]

        #[test]
        fn lanes_give_the_energy_of_the_ordered_clipper(triangle in [point(), point(), point()]) {
            let frame = TetFrame::new(&[Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()]);
            let area_vector = triangle_area_vector(&triangle);
            let height = frame.centroid_distance(&triangle[0], &area_vector);
            // In a plane through the centroid, a grows without bound.
            prop_assume!(height.abs() > 1e-9);
            let (lambda, mut mean, mut queue) = (frame.lambda(&triangle), 0.0, FluxQueue::default());
            queue.push(Arch::new(), 0, &lambda);
            queue.finish(Arch::new(), |_, part| mean += part);
            let found = mean * height;
            let expected = pair_energy(&triangle, &area_vector, &frame);
            prop_assert!((found - expected).abs() <= 1e-12 * area_vector.norm().max(1.0), "{found} {expected}");
        }
    }
}
