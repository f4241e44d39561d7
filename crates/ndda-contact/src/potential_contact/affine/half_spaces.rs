//! The functions of a block that is an affine convex target as a contactor sees them, as many at a time as the processor has lanes.
//!
//! Most contactors see five or six sides, three of which make regions, and each region compares with all others. One by one that
//! took as long as the integrals.

use ndda_mesh::Vec3;
use pulp::Simd;

use crate::affine::face::Face;
use crate::integration::capacity::MOST_CUTS;
use crate::integration::clip::Outline;
use crate::integration::region::{Cut, Region};

/// Sides in a row; a multiple of every lane count.
pub(crate) const SIDES: usize = 8;
/// Rows for the sides of a block.
const ROWS: usize = MOST_CUTS / SIDES;

/// One number for each side of a row.
type Row = [f64; SIDES];

/// The place of each side, to compare with.
const PLACES: [Row; ROWS] = {
    let mut places = [[0.0; SIDES]; ROWS];
    let mut k = 0;
    while k < MOST_CUTS {
        places[k / SIDES][k % SIDES] = k as f64;
        k += 1;
    }
    places
};

/// Sides of one block next to each other; where they are fewer than a row, the last one fills it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Planes {
    /// n of φ = n·(p − x) [1/m], by component.
    normal: [Row; 3],
    /// p [m], by component.
    point: [Row; 3],
    /// −φ from which on a point is beyond.
    reach: Row,
    len: usize,
}

/// The sides of a block, of which φ is the smallest, seen from a contactor; used again and again.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct HalfSpaces {
    /// How many the block has.
    all: usize,
    /// φ of each at the corners of the contactor's triangle.
    at: [[Row; 3]; ROWS],
    /// ∂φ/∂n [1/m].
    rise: [Row; ROWS],
    /// Bounds of the lead of each over one that comes before it, and over one that comes after; none where another is below everywhere.
    over_former: [Row; ROWS],
    over_later: [Row; ROWS],
    /// Half-spaces whose function may be the smallest somewhere.
    which: [u8; MOST_CUTS],
    len: usize,
    /// By how much each leads over the one that a region is of, and in its place that one itself, which has to be positive.
    lead: [[Row; 3]; ROWS],
    bound: [Row; ROWS],
    /// At how many corners of the contactor each is below its bound.
    outside: [Row; ROWS],
}

#[inline(always)]
fn load<S: Simd>(row: &Row, i: usize) -> S::f64s {
    S::as_simd_f64s(row).0[i]
}

#[inline(always)]
fn store<S: Simd>(row: &mut Row, i: usize, value: S::f64s) {
    S::as_mut_simd_f64s(row).0[i] = value;
}

/// The values of fields at each corner of an outline, given by those at the corners of its triangle.
#[inline(always)]
fn each_corner<S: Simd>(simd: S, outline: &Outline, at: &[S::f64s; 3], mut visit: impl FnMut(S::f64s)) {
    if outline.is_triangle() {
        return at.iter().for_each(|value| visit(*value));
    }
    let [c0, c1, c2] = [at[0], simd.sub_f64s(at[1], at[0]), simd.sub_f64s(at[2], at[0])];
    for [x, y] in outline.corners() {
        let along = simd.mul_f64s(c1, simd.splat_f64s(*x));
        visit(simd.add_f64s(c0, simd.add_f64s(along, simd.mul_f64s(c2, simd.splat_f64s(*y)))));
    }
}

impl Planes {
    /// The planes of one face at least and no more than a row has.
    pub(crate) fn of(faces: &[Face]) -> Self {
        let zero = [[0.0; SIDES]; 3];
        let mut planes = Self { normal: zero, point: zero, reach: zero[0], len: faces.len() };
        for k in 0..SIDES {
            let face = &faces[k.min(faces.len() - 1)];
            let (gradient, point) = (face.gradient(), face.point());
            for a in 0..3 {
                (planes.normal[a][k], planes.point[a][k]) = (-gradient[a], point[a]);
            }
            planes.reach[k] = face.reach();
        }
        planes
    }

    /// ∇φ of one of them [1/m].
    pub(crate) fn gradient(&self, lane: usize) -> Vec3 {
        Vec3::from(self.normal.map(|row| -row[lane]))
    }

    /// Whether one of them has all these points beyond it.
    #[inline(always)]
    pub(crate) fn keep_out<S: Simd>(&self, simd: S, points: &[Vec3]) -> bool {
        (0..self.len.div_ceil(S::F64_LANES)).any(|i| {
            let reach = load::<S>(&self.reach, i);
            let mut are_beyond = simd.equal_f64s(reach, reach);
            for x in points {
                let is_beyond = simd.less_than_or_equal_f64s(reach, self.height(simd, i, x));
                are_beyond = simd.and_m64s(are_beyond, is_beyond);
            }
            simd.first_true_m64s(are_beyond) < S::F64_LANES
        })
    }

    /// −φ of each at a point.
    #[inline(always)]
    fn height<S: Simd>(&self, simd: S, i: usize, x: &Vec3) -> S::f64s {
        let mut terms = [simd.splat_f64s(0.0); 3];
        for a in 0..3 {
            let arm = simd.sub_f64s(simd.splat_f64s(x[a]), load::<S>(&self.point[a], i));
            terms[a] = simd.mul_f64s(load::<S>(&self.normal[a], i), arm);
        }
        simd.add_f64s(simd.add_f64s(terms[0], terms[1]), terms[2])
    }

    /// φ of each at a point.
    #[inline(always)]
    fn phi<S: Simd>(&self, simd: S, i: usize, x: &Vec3) -> S::f64s {
        let mut terms = [simd.splat_f64s(0.0); 3];
        for a in 0..3 {
            let arm = simd.sub_f64s(load::<S>(&self.point[a], i), simd.splat_f64s(x[a]));
            terms[a] = simd.mul_f64s(load::<S>(&self.normal[a], i), arm);
        }
        simd.add_f64s(simd.add_f64s(terms[0], terms[1]), terms[2])
    }

    /// ∂φ/∂n of each along a unit vector [1/m].
    #[inline(always)]
    fn rise<S: Simd>(&self, simd: S, i: usize, along: &Vec3) -> S::f64s {
        let mut terms = [simd.splat_f64s(0.0); 3];
        for a in 0..3 {
            let down = simd.neg_f64s(load::<S>(&self.normal[a], i));
            terms[a] = simd.mul_f64s(down, simd.splat_f64s(along[a]));
        }
        simd.add_f64s(simd.add_f64s(terms[0], terms[1]), terms[2])
    }
}

impl HalfSpaces {
    /// Looks at a block from a contactor with this outline on a triangle with these corners [m]; false if that is beyond a side.
    #[inline(always)]
    pub(crate) fn look<S: Simd>(
        &mut self,
        simd: S,
        planes: &[Planes],
        corners: &[Vec3; 3],
        normal: &Vec3,
        outline: &Outline,
    ) -> bool {
        (self.all, self.len) = (planes.iter().map(|planes| planes.len).sum(), 0);
        let (most, least) = (simd.splat_f64s(f64::INFINITY), simd.splat_f64s(f64::NEG_INFINITY));
        let mut lowest = [[0.0; SIDES]; ROWS];
        let mut enough = most;
        for (row, planes) in planes.iter().enumerate() {
            for i in 0..planes.len.div_ceil(S::F64_LANES) {
                let [x, y, z] = corners;
                let at = [planes.phi(simd, i, x), planes.phi(simd, i, y), planes.phi(simd, i, z)];
                let (mut low, mut high) = (most, least);
                each_corner(simd, outline, &at, |value| {
                    low = simd.select_f64s(simd.less_than_f64s(value, low), value, low);
                    high = simd.select_f64s(simd.greater_than_f64s(value, high), value, high);
                });
                enough = simd.min_f64s(enough, high);
                for (row, value) in self.at[row].iter_mut().zip(at) {
                    store::<S>(row, i, value);
                }
                store::<S>(&mut lowest[row], i, low);
            }
        }
        // Of all sides, one reaches no higher than this anywhere.
        let enough = simd.reduce_min_f64s(enough);
        if enough <= 0.0 {
            return false;
        }
        for (row, planes) in planes.iter().enumerate() {
            self.keep(simd, row, planes, &lowest[row], enough, normal);
        }
        true
    }

    /// Lists the sides of a row that are not above everywhere.
    #[inline(always)]
    fn keep<S: Simd>(
        &mut self,
        simd: S,
        row: usize,
        planes: &Planes,
        lowest: &Row,
        enough: f64,
        normal: &Vec3,
    ) {
        let never = simd.splat_f64s(f64::NEG_INFINITY);
        let keeps = simd.splat_f64s(Cut::new([0.0; 3], true).bound);
        let leaves = simd.splat_f64s(Cut::new([0.0; 3], false).bound);
        for i in 0..planes.len.div_ceil(S::F64_LANES) {
            let above = simd.greater_than_f64s(load::<S>(lowest, i), simd.splat_f64s(enough));
            store::<S>(&mut self.over_former[row], i, simd.select_f64s(above, never, keeps));
            store::<S>(&mut self.over_later[row], i, simd.select_f64s(above, never, leaves));
            store::<S>(&mut self.rise[row], i, planes.rise(simd, i, normal));
        }
        for (lane, lowest) in lowest.iter().enumerate().take(planes.len) {
            self.which[self.len] = (row * SIDES + lane) as u8;
            self.len += usize::from(*lowest <= enough);
        }
    }

    /// How many may be the smallest somewhere.
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// Which side of the block the k-th of them is.
    pub(crate) fn which(&self, k: usize) -> usize {
        usize::from(self.which[k])
    }

    /// The region where the k-th of them is the smallest and positive; false if that is nowhere.
    #[inline(always)]
    pub(crate) fn set_region<S: Simd>(
        &mut self,
        simd: S,
        k: usize,
        outline: &Outline,
        region: &mut Region,
    ) -> bool {
        let k = self.which(k);
        let (own, rise) = (lane_of(&self.at[k / SIDES], k % SIDES), self.rise[k / SIDES][k % SIDES]);
        self.compare(simd, k, &own, rise, outline);
        region.begin(own, rise.abs());
        let all = outline.corners().len() as f64;
        let mut is_somewhere = self.put(k, all, region);
        for n in 0..self.len {
            let j = self.which(n);
            is_somewhere &= j == k || self.put(j, all, region);
        }
        is_somewhere
    }

    /// The leads over side k.
    #[inline(always)]
    fn compare<S: Simd>(&mut self, simd: S, k: usize, own: &[f64; 3], rise: f64, outline: &Outline) {
        let (place, zero, one) = (simd.splat_f64s(k as f64), simd.splat_f64s(0.0), simd.splat_f64s(1.0));
        let own_bound = simd.splat_f64s(Cut::new([0.0; 3], rise < 0.0).bound);
        for (row, places) in PLACES.iter().enumerate().take(self.all.div_ceil(SIDES)) {
            for i in 0..(self.all - row * SIDES).min(SIDES).div_ceil(S::F64_LANES) {
                let places = load::<S>(places, i);
                let is_own = simd.equal_f64s(places, place);
                let mut lead = [zero; 3];
                for a in 0..3 {
                    let base = simd.select_f64s(is_own, zero, simd.splat_f64s(own[a]));
                    lead[a] = simd.sub_f64s(load::<S>(&self.at[row][a], i), base);
                    store::<S>(&mut self.lead[row][a], i, lead[a]);
                }
                let over = simd.select_f64s(
                    simd.less_than_f64s(place, places),
                    load::<S>(&self.over_former[row], i),
                    load::<S>(&self.over_later[row], i),
                );
                let bound = simd.select_f64s(is_own, own_bound, over);
                let mut outside = zero;
                each_corner(simd, outline, &lead, |value| {
                    let below = simd.select_f64s(simd.less_than_f64s(value, bound), one, zero);
                    outside = simd.add_f64s(outside, below);
                });
                store::<S>(&mut self.bound[row], i, bound);
                store::<S>(&mut self.outside[row], i, outside);
            }
        }
    }

    /// Adds the cut by side j if it cuts anything; false if it leaves nothing.
    #[inline(always)]
    fn put(&self, j: usize, all: f64, region: &mut Region) -> bool {
        let (row, lane) = (j / SIDES, j % SIDES);
        let outside = self.outside[row][lane];
        let field = lane_of(&self.lead[row], lane);
        region.put(Cut { field, bound: self.bound[row][lane] }, outside > 0.0);
        outside < all
    }
}

/// One lane of three rows; written out, since what takes a closure is not always compiled in place.
#[inline(always)]
fn lane_of([x, y, z]: &[Row; 3], lane: usize) -> [f64; 3] {
    [x[lane], y[lane], z[lane]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::affine::convex_target::ConvexBlocks;
    use crate::affine::surface::BlockFaces;
    use crate::testing::{test_box, test_set};
    use ndda_mesh::BlockId;
    use pulp::{Arch, Scalar, WithSimd};

    /// The regions of a triangle in a box of 1 × 2 × 3 m, by corners of φ and cuts.
    struct Regions<'a>(&'a [Planes], &'a [Vec3; 3]);

    impl WithSimd for Regions<'_> {
        type Output = Vec<Region>;

        fn with_simd<S: Simd>(self, simd: S) -> Vec<Region> {
            let (mut sides, mut region, mut found) = (HalfSpaces::default(), Region::default(), Vec::new());
            if sides.look(simd, self.0, self.1, &Vec3::z(), &Outline::TRIANGLE) {
                for k in 0..sides.len() {
                    if sides.set_region(simd, k, &Outline::TRIANGLE, &mut region) {
                        found.push(region);
                    }
                }
            }
            found
        }
    }

    fn with_box(test: impl Fn(&[Planes])) {
        let blocks = test_set(vec![test_box([0.0; 3], [1.0, 2.0, 3.0], [1, 1, 1])]);
        let mut hulls = ConvexBlocks::default();
        hulls.fit(&blocks, &BlockFaces::of_all(&blocks), Some(1.0), &[true], false);
        hulls.place(&blocks, &blocks.rest_position);
        test(hulls.planes_of(BlockId(0)));
    }

    fn area(regions: &[Region]) -> f64 {
        let fan =
            |region: &Region| region.polygon(&Outline::TRIANGLE).fan().map(|(_, part)| part).sum::<f64>();
        regions.iter().map(fan).sum()
    }

    #[test]
    fn regions_fill_a_triangle_inside_whatever_the_number_of_lanes() {
        let corners = [[0.1, 0.1, 0.4], [0.9, 0.3, 0.4], [0.4, 1.9, 0.4]].map(Vec3::from);
        with_box(|planes| {
            let one_by_one = Scalar::new().vectorize(Regions(planes, &corners));
            let at_once = Arch::new().dispatch(Regions(planes, &corners));
            assert!((area(&one_by_one) - 1.0).abs() < 1e-14, "{}", area(&one_by_one));
            let all = |regions: &[Region]| {
                regions.iter().map(|r| (r.phi, r.slope, r.cuts().to_vec())).collect::<Vec<_>>()
            };
            assert_eq!(all(&one_by_one), all(&at_once));
            // All four walls and the floor are the nearest side somewhere.
            assert_eq!(at_once.len(), 5);
        });
    }

    #[test]
    fn a_triangle_beyond_a_side_or_in_its_plane_sees_nothing() {
        for z in [-0.1, 0.0, 3.0] {
            let corners = [[0.1, 0.1, z], [0.9, 0.3, z], [0.4, 1.9, z]].map(Vec3::from);
            with_box(|planes| assert!(Arch::new().dispatch(Regions(planes, &corners)).is_empty()));
        }
    }

    #[test]
    fn half_a_triangle_inside_is_half_the_area() {
        // In the plane z = 1.5, cut by x = 1 along a median.
        let corners = [[1.0, 0.5, 1.5], [1.5, 1.5, 1.5], [0.5, 1.5, 1.5]].map(Vec3::from);
        with_box(|planes| {
            let inside = area(&Arch::new().dispatch(Regions(planes, &corners)));
            assert!((inside - 0.5).abs() < 1e-14, "{inside}");
        });
    }
}
