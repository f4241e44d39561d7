//! Many regions at a time: the integrals over [`region`](crate::integration::region)s for as many as the processor has lanes.
//!
//! A lane never branches. A convex polygon in the contactor is a set of directed edges, in no order: a cut shortens
//! each edge on its own and adds one, from where the rim leaves the half-plane to where it comes back. Integrals are
//! fans of the edges about one of their ends. Every field is a linear form in ψ given by its values at the corners.
//!
//! Rounding can make a rim that runs along a cut leave twice; such a lane is flagged, and its region is done again by
//! the ordered clipper of [`clip`](crate::integration::clip). Only sums, products and quotients are used, each rounded once, so
//! the bits do not depend on the processor.

use pulp::{Arch, Simd, WithSimd};

use crate::integration::capacity::{MOST_CORNERS, MOST_CUTS};

/// Regions in a group; a multiple of every lane count.
pub const GROUP: usize = 16;

/// One number for each region of a group.
pub(crate) type Row = [f64; GROUP];

/// A group of regions; a field is given by its values at the corners of the contactor's triangle.
#[derive(Clone, Copy, Debug)]
pub struct RegionGroup {
    /// Outlines of the contactors, (ψ₁, ψ₂) of their corners; not requested where they are triangles.
    pub outline: [[Row; 2]; MOST_CORNERS],
    /// Corners in use.
    pub corners: usize,
    /// φ.
    pub phi: [Row; 3],
    /// |∂φ/∂n| [1/m].
    pub slope: Row,
    /// Fields that are not below their bound in the region.
    pub fields: [[Row; 3]; MOST_CUTS],
    /// The bounds, see the cuts of a region.
    pub bounds: [Row; MOST_CUTS],
    /// Cuts in use.
    pub cuts: usize,
    /// Regions in use.
    pub len: usize,
}

impl Default for RegionGroup {
    /// Triangles.
    fn default() -> Self {
        let zero = [0.0; GROUP];
        Self {
            outline: [[zero; 2]; MOST_CORNERS],
            corners: 3,
            phi: [zero; 3],
            slope: zero,
            fields: [[zero; 3]; MOST_CUTS],
            bounds: [zero; MOST_CUTS],
            cuts: 0,
            len: 0,
        }
    }
}

/// The integrals of a group, over the triangle's area. ψ are the shape functions of the triangle.
#[derive(Clone, Copy, Debug, Default)]
pub struct GroupMoments {
    /// ∫ φ ψ_a dA.
    pub pressure: [Row; 3],
    /// ∫ |∂φ/∂n| ψ_a dA [1/m].
    pub slope: [Row; 3],
    /// Area of the region.
    pub area: Row,
    /// Largest φ.
    pub depth: Row,
    /// Not zero where the region has to be done one by one.
    pub doubtful: Row,
}

/// The integrals of a group of regions.
pub fn region_moments(arch: Arch, group: &RegionGroup, moments: &mut GroupMoments) {
    // Room for the edges is a constant, so that a few cuts are unrolled.
    match (group.corners, group.cuts) {
        (3, 0) => arch.dispatch(RegionKernel::<3, 0, 3> { group, moments }),
        (3, 1) => arch.dispatch(RegionKernel::<3, 1, 4> { group, moments }),
        (3, 2) => arch.dispatch(RegionKernel::<3, 2, 5> { group, moments }),
        (3, 3) => arch.dispatch(RegionKernel::<3, 3, 6> { group, moments }),
        (3, 4) => arch.dispatch(RegionKernel::<3, 4, 7> { group, moments }),
        (3, _) => arch.dispatch(RegionKernel::<3, MOST_CUTS, { 3 + MOST_CUTS }> { group, moments }),
        (4, 0) => arch.dispatch(RegionKernel::<4, 0, 4> { group, moments }),
        (4, 1) => arch.dispatch(RegionKernel::<4, 1, 5> { group, moments }),
        (4, 2) => arch.dispatch(RegionKernel::<4, 2, 6> { group, moments }),
        (4, 3) => arch.dispatch(RegionKernel::<4, 3, 7> { group, moments }),
        (4, 4) => arch.dispatch(RegionKernel::<4, 4, 8> { group, moments }),
        _ => {
            arch.dispatch(RegionKernel::<MOST_CORNERS, MOST_CUTS, { MOST_CORNERS + MOST_CUTS }> {
                group,
                moments,
            });
        }
    }
}

struct RegionKernel<'a, const CORNERS: usize, const CUTS: usize, const EDGES: usize> {
    group: &'a RegionGroup,
    moments: &'a mut GroupMoments,
}

impl<const CORNERS: usize, const CUTS: usize, const EDGES: usize> WithSimd
    for RegionKernel<'_, CORNERS, CUTS, EDGES>
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { group, moments } = self;
        let cuts = if CUTS < MOST_CUTS { CUTS } else { group.cuts };
        let corners = if CORNERS < MOST_CORNERS { CORNERS } else { group.corners };
        for k in 0..group.len.div_ceil(S::F64_LANES) {
            let load = |row: &Row| S::as_simd_f64s(row).0[k];
            let field = |at: &[Row; 3]| Form::through(simd, [load(&at[0]), load(&at[1]), load(&at[2])]);
            let mut sums = Sums::zero(simd);
            let mut cuts = group.fields.iter().zip(&group.bounds).take(cuts);
            let mut edges = match (CORNERS, CUTS) {
                (3, 0) => Edges::<S, EDGES>::triangle(simd),
                (3, _) => {
                    let (cut, bound) = cuts.next().expect("a group with cuts");
                    Edges::of_triangle(simd, &field(cut), load(bound))
                }
                _ => Edges::outline(simd, &group.outline[..corners], load),
            };
            for (cut, bound) in cuts {
                edges.cut(simd, &field(cut), load(bound), &mut sums.doubtful);
            }
            add_fan(simd, &edges, &field(&group.phi), load(&group.slope), &mut sums);
            sums.store(moments, &mut |row, v| S::as_mut_simd_f64s(row).0[k] = v);
        }
    }
}

/// Running sums of a lane.
struct Sums<S: Simd> {
    pressure: [S::f64s; 3],
    slope: [S::f64s; 3],
    area: S::f64s,
    depth: S::f64s,
    doubtful: S::f64s,
}

impl<S: Simd> Sums<S> {
    #[inline(always)]
    fn zero(simd: S) -> Self {
        let zero = simd.splat_f64s(0.0);
        Self { pressure: [zero; 3], slope: [zero; 3], area: zero, depth: zero, doubtful: zero }
    }

    #[inline(always)]
    fn store(&self, to: &mut GroupMoments, store: &mut impl FnMut(&mut Row, S::f64s)) {
        for a in 0..3 {
            store(&mut to.pressure[a], self.pressure[a]);
            store(&mut to.slope[a], self.slope[a]);
        }
        store(&mut to.area, self.area);
        store(&mut to.depth, self.depth);
        store(&mut to.doubtful, self.doubtful);
    }
}

/// A linear form c₀ + c₁ ψ₁ + c₂ ψ₂.
#[derive(Clone, Copy)]
pub(super) struct Form<S: Simd>([S::f64s; 3]);

impl<S: Simd> Form<S> {
    /// The form with these values at the corners.
    #[inline(always)]
    pub(super) fn through(simd: S, at: [S::f64s; 3]) -> Self {
        Self([at[0], simd.sub_f64s(at[1], at[0]), simd.sub_f64s(at[2], at[0])])
    }

    #[inline(always)]
    pub(super) fn at(&self, simd: S, x: S::f64s, y: S::f64s) -> S::f64s {
        let Self([c0, c1, c2]) = *self;
        simd.add_f64s(c0, simd.add_f64s(simd.mul_f64s(c1, x), simd.mul_f64s(c2, y)))
    }
}

/// Directed edges in the plane (ψ₁, ψ₂); an edge without length is outside.
pub(super) struct Edges<S: Simd, const MOST: usize> {
    pub(super) x: [[S::f64s; 2]; MOST],
    pub(super) y: [[S::f64s; 2]; MOST],
    pub(super) len: usize,
}

impl<S: Simd, const MOST: usize> Edges<S, MOST> {
    /// The whole triangle, counter-clockwise.
    #[inline(always)]
    pub(super) fn triangle(simd: S) -> Self {
        let (o, l) = (simd.splat_f64s(0.0), simd.splat_f64s(1.0));
        let (mut x, mut y) = ([[o; 2]; MOST], [[o; 2]; MOST]);
        (x[0], y[0]) = ([o, l], [o, o]);
        (x[1], y[1]) = ([l, o], [o, l]);
        (x[2], y[2]) = ([o, o], [l, o]);
        Self { x, y, len: 3 }
    }

    /// Remainder of the whole triangle after one cut: its corners need no products, and its rim leaves once at most.
    #[inline(always)]
    pub(super) fn of_triangle(simd: S, field: &Form<S>, bound: S::f64s) -> Self {
        let Form([c0, c1, c2]) = *field;
        let (d0, d1, d2) = (c0, simd.add_f64s(c0, c1), simd.add_f64s(c0, c2));
        let out0 = simd.less_than_f64s(d0, bound);
        let out1 = simd.less_than_f64s(d1, bound);
        let out2 = simd.less_than_f64s(d2, bound);
        let [in0, in1, in2] = [simd.not_m64s(out0), simd.not_m64s(out1), simd.not_m64s(out2)];
        // Along the edges 01, 12 and 20.
        let leaves = [simd.and_m64s(in0, out1), simd.and_m64s(in1, out2), simd.and_m64s(in2, out0)];
        let returns = [simd.and_m64s(out0, in1), simd.and_m64s(out1, in2), simd.and_m64s(out2, in0)];
        let gone = [simd.and_m64s(out0, out1), simd.and_m64s(out1, out2), simd.and_m64s(out2, out0)];
        let leave = crossing(simd, &leaves, [d0, d1, d2]);
        let back = crossing(simd, &returns, [d0, d1, d2]);
        let Self { mut x, mut y, .. } = Self::triangle(simd);
        // The first edge keeps its ψ₂, the last one its ψ₁.
        for k in 0..2 {
            let end = simd.select_f64s(gone[k], x[k][0], x[k][1]);
            x[k] =
                [simd.select_f64s(returns[k], back[0], x[k][0]), simd.select_f64s(leaves[k], leave[0], end)];
        }
        for k in 1..3 {
            let end = simd.select_f64s(gone[k], y[k][0], y[k][1]);
            y[k] =
                [simd.select_f64s(returns[k], back[1], y[k][0]), simd.select_f64s(leaves[k], leave[1], end)];
        }
        (x[3], y[3]) = ([leave[0], back[0]], [leave[1], back[1]]);
        Self { x, y, len: 4 }
    }

    /// All of an outline, counter-clockwise.
    #[inline(always)]
    fn outline(simd: S, corners: &[[Row; 2]], load: impl Fn(&Row) -> S::f64s) -> Self {
        let nowhere = [[simd.splat_f64s(0.0); 2]; MOST];
        let mut edges = Self { x: nowhere, y: nowhere, len: corners.len() };
        for (k, from) in corners.iter().enumerate() {
            let to = corners.get(k + 1).unwrap_or(&corners[0]);
            edges.x[k] = [load(&from[0]), load(&to[0])];
            edges.y[k] = [load(&from[1]), load(&to[1])];
        }
        edges
    }

    /// Keeps what is inside: the field is not below the bound.
    #[inline(always)]
    pub(super) fn cut(&mut self, simd: S, field: &Form<S>, bound: S::f64s, doubtful: &mut S::f64s) {
        let zero = simd.splat_f64s(0.0);
        let outside = |d| simd.less_than_f64s(d, bound);
        let (mut leave, mut back) = ([zero; 2], [zero; 2]);
        let mut left = simd.less_than_f64s(zero, zero);
        for k in 0..self.len {
            let ([x0, x1], [y0, y1]) = (self.x[k], self.y[k]);
            let (d0, d1) = (field.at(simd, x0, y0), field.at(simd, x1, y1));
            let (out0, out1) = (outside(d0), outside(d1));
            let leaves = simd.and_m64s(simd.not_m64s(out0), out1);
            let returns = simd.and_m64s(out0, simd.not_m64s(out1));
            let gone = simd.and_m64s(out0, out1);
            let t = simd.div_f64s(d0, simd.sub_f64s(d0, d1));
            let x = simd.add_f64s(x0, simd.mul_f64s(t, simd.sub_f64s(x1, x0)));
            let y = simd.add_f64s(y0, simd.mul_f64s(t, simd.sub_f64s(y1, y0)));
            let end =
                |cross, first, last| simd.select_f64s(leaves, cross, simd.select_f64s(gone, first, last));
            self.x[k] = [simd.select_f64s(returns, x, x0), end(x, x0, x1)];
            self.y[k] = [simd.select_f64s(returns, y, y0), end(y, y0, y1)];
            leave = [simd.select_f64s(leaves, x, leave[0]), simd.select_f64s(leaves, y, leave[1])];
            back = [simd.select_f64s(returns, x, back[0]), simd.select_f64s(returns, y, back[1])];
            let again = simd.and_m64s(left, leaves);
            *doubtful = simd.select_f64s(again, simd.splat_f64s(1.0), *doubtful);
            left = simd.or_m64s(left, leaves);
        }
        self.x[self.len] = [leave[0], back[0]];
        self.y[self.len] = [leave[1], back[1]];
        self.len += 1;
    }

    /// An end of an edge that has a length.
    #[inline(always)]
    pub(super) fn apex(&self, simd: S) -> [S::f64s; 2] {
        let mut apex = [self.x[0][0], self.y[0][0]];
        for k in 1..self.len {
            let has_length = self.has_length(simd, k);
            apex[0] = simd.select_f64s(has_length, self.x[k][0], apex[0]);
            apex[1] = simd.select_f64s(has_length, self.y[k][0], apex[1]);
        }
        apex
    }

    #[inline(always)]
    fn has_length(&self, simd: S, k: usize) -> S::m64s {
        let differ = |[from, to]: [S::f64s; 2]| simd.not_m64s(simd.equal_f64s(from, to));
        simd.or_m64s(differ(self.x[k]), differ(self.y[k]))
    }
}

/// The point where a field with these values at a triangle's corners is zero on one of the edges 01, 12 and 20; the first corner if
/// it is on none.
#[inline(always)]
fn crossing<S: Simd>(simd: S, on: &[S::m64s; 3], [d0, d1, d2]: [S::f64s; 3]) -> [S::f64s; 2] {
    let (o, l) = (simd.splat_f64s(0.0), simd.splat_f64s(1.0));
    let from = simd.select_f64s(on[2], d2, simd.select_f64s(on[1], d1, d0));
    let to = simd.select_f64s(on[2], d0, simd.select_f64s(on[1], d2, d1));
    let t = simd.div_f64s(from, simd.sub_f64s(from, to));
    let rest = simd.sub_f64s(l, t);
    let x = simd.select_f64s(on[0], t, simd.select_f64s(on[1], rest, o));
    [x, simd.select_f64s(on[1], t, simd.select_f64s(on[2], rest, o))]
}

/// Adds the integrals over a polygon on which φ is linear:
/// ∫ f g dA = A/12 [(Σf)(Σg) + Σ fᵢ gᵢ],  ∫ f dA = A/3 Σf  over each triangle of the fan.
#[inline(always)]
fn add_fan<S: Simd, const MOST: usize>(
    simd: S,
    edges: &Edges<S, MOST>,
    phi: &Form<S>,
    slope: S::f64s,
    sums: &mut Sums<S>,
) {
    let zero = simd.splat_f64s(0.0);
    let phi = |x, y| phi.at(simd, x, y);
    let add = |a, b| simd.add_f64s(a, b);
    let [px, py] = edges.apex(simd);
    let phi_apex = phi(px, py);
    let (mut area, mut first, mut total, mut pressure) = (zero, [zero; 2], zero, [zero; 2]);
    for k in 0..edges.len {
        let ([x0, x1], [y0, y1]) = (edges.x[k], edges.y[k]);
        let (ux, uy) = (simd.sub_f64s(x0, px), simd.sub_f64s(y0, py));
        let (vx, vy) = (simd.sub_f64s(x1, x0), simd.sub_f64s(y1, y0));
        let part = simd.sub_f64s(simd.mul_f64s(ux, vy), simd.mul_f64s(uy, vx));
        let (phi0, phi1) = (phi(x0, y0), phi(x1, y1));
        let (phi_sum, x_sum, y_sum) =
            (add(phi_apex, add(phi0, phi1)), add(px, add(x0, x1)), add(py, add(y0, y1)));
        let products = |p, q0, q1| {
            let ends = add(simd.mul_f64s(phi0, q0), simd.mul_f64s(phi1, q1));
            add(simd.mul_f64s(phi_apex, p), ends)
        };
        let weighted =
            |sum, p, q0, q1| simd.mul_f64s(part, add(simd.mul_f64s(phi_sum, sum), products(p, q0, q1)));
        area = add(area, part);
        first = [add(first[0], simd.mul_f64s(part, x_sum)), add(first[1], simd.mul_f64s(part, y_sum))];
        total = add(total, simd.mul_f64s(part, phi_sum));
        pressure =
            [add(pressure[0], weighted(x_sum, px, x0, x1)), add(pressure[1], weighted(y_sum, py, y0, y1))];
        let higher = simd.max_f64s(sums.depth, phi0);
        sums.depth = simd.select_f64s(edges.has_length(simd, k), higher, sums.depth);
    }
    let third = simd.splat_f64s(1.0 / 3.0);
    let twelfth = simd.splat_f64s(1.0 / 12.0);
    let total = simd.mul_f64s(third, total);
    let pressure = [simd.mul_f64s(twelfth, pressure[0]), simd.mul_f64s(twelfth, pressure[1])];
    let first = [simd.mul_f64s(third, first[0]), simd.mul_f64s(third, first[1])];
    let rest = |all, two: [S::f64s; 2]| simd.sub_f64s(all, add(two[0], two[1]));
    for (sum, w) in sums.pressure.iter_mut().zip([rest(total, pressure), pressure[0], pressure[1]]) {
        *sum = add(*sum, w);
    }
    for (sum, w) in sums.slope.iter_mut().zip([rest(area, first), first[0], first[1]]) {
        *sum = add(*sum, simd.mul_f64s(slope, w));
    }
    sums.area = add(sums.area, area);
}
