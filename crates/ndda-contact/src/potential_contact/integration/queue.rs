//! Regions that wait until there are enough of them for all lanes.

use pulp::Arch;

use crate::integration::capacity::MOST_CORNERS;
use crate::integration::clip::{Form, Outline, Polygon};
use crate::integration::kernel::{GROUP, GroupMoments, RegionGroup, region_moments};
use crate::integration::pair_moments::{PairMoments, RegionMoments};
use crate::integration::region::{
    Cut, Pieces, Region, count_cuts, element_cuts, element_outside, is_somewhere,
};

/// Contactors with so many corners or fewer wait together.
const FEW_CORNERS: usize = 4;

/// Regions with this many cuts or more wait together.
const MANY_CUTS: usize = 8;

/// Batches of regions on triangles, as many for those on contactors of up to four corners, and one for all others.
const BATCHES: usize = 2 * (MANY_CUTS + 1) + 1;

/// The regions of many pairs, by the corners of the contactor and the number of their cuts. What comes out does not depend on the company that a region
/// was computed in.
#[derive(Default)]
pub struct RegionQueue {
    waiting: [Batch; BATCHES],
    parts: Vec<RegionMoments>,
    moments: GroupMoments,
}

impl RegionQueue {
    /// Room for the regions of so many pairs.
    pub(crate) fn make_room(&mut self, pairs: usize) {
        self.parts.reserve(4 * pairs);
    }

    /// Adds a region of a pair, on a contactor whose triangle has this area [m²].
    pub(crate) fn push(&mut self, arch: Arch, pair: u32, area_m2: f64, region: &Region, outline: &Outline) {
        let cuts = region.cuts();
        let which = match outline.corners().len() {
            _ if outline.is_triangle() => cuts.len().min(MANY_CUTS),
            ..=FEW_CORNERS => MANY_CUTS + 1 + cuts.len().min(MANY_CUTS),
            _ => BATCHES - 1,
        };
        let batch = &mut self.waiting[which];
        batch.make_room(cuts.len());
        batch.set_outline(outline);
        let lane = batch.lane();
        for (k, cut) in cuts.iter().enumerate() {
            batch.set_cut(lane, k, cut);
        }
        batch.set(lane, self.parts.len(), area_m2, &region.phi, region.slope);
        self.added(arch, pair, which);
    }

    /// Adds the regions of the element potential on a triangle of this area [m²]; `slopes` are |∂φ/∂n| there [1/m].
    #[inline(always)]
    pub fn push_element(
        &mut self,
        arch: Arch,
        pair: u32,
        area_m2: f64,
        lambda: &[[f64; 3]; 4],
        slopes: &[f64; 4],
    ) {
        let outside = element_outside(lambda);
        // One by one: a loop would look up the region for each of its cuts.
        self.push_one(arch, pair, area_m2, (lambda, &outside, 0, slopes[0]));
        self.push_one(arch, pair, area_m2, (lambda, &outside, 1, slopes[1]));
        self.push_one(arch, pair, area_m2, (lambda, &outside, 2, slopes[2]));
        self.push_one(arch, pair, area_m2, (lambda, &outside, 3, slopes[3]));
    }

    /// Adds region i of them if it is somewhere.
    #[inline(always)]
    fn push_one(
        &mut self,
        arch: Arch,
        pair: u32,
        area_m2: f64,
        (lambda, outside, i, slope): (&[[f64; 3]; 4], &[[u8; 4]; 4], usize, f64),
    ) {
        if !is_somewhere(&outside[i]) {
            return;
        }
        let cuts = count_cuts(&outside[i]);
        let part = self.parts.len();
        self.waiting[cuts].set_element(part, area_m2, (lambda, outside, i, slope), cuts);
        self.added(arch, pair, cuts);
    }

    /// Adds the regions of the pieces of a tetrahedron on a triangle of this area [m²].
    // Left to the compiler it is a call of its own at times, for 2 % more instructions a step.
    #[inline(always)]
    pub(crate) fn push_pieces(&mut self, arch: Arch, pair: u32, area_m2: f64, pieces: &Pieces) {
        for k in (0..pieces.len()).filter(|k| pieces.is_somewhere(*k)) {
            let cuts = pieces.count_cuts(k);
            let which = cuts.min(MANY_CUTS);
            let batch = &mut self.waiting[which];
            batch.make_room(cuts);
            let lane = batch.lane();
            pieces.cuts(k, |n, cut| batch.set_cut(lane, n, &cut));
            batch.set_cut(lane, cuts, &Cut::NOTHING);
            batch.set(lane, self.parts.len(), area_m2, pieces.phi(k), pieces.slope(k));
            self.added(arch, pair, which);
        }
    }

    #[inline(always)]
    fn added(&mut self, arch: Arch, pair: u32, batch: usize) {
        self.parts.push(RegionMoments { pair, ..RegionMoments::default() });
        let batch = &mut self.waiting[batch];
        if batch.group.len == GROUP {
            batch.flush(arch, &mut self.moments, &mut self.parts);
        }
    }

    /// Does what still waits and hands out all integrals, region by region as they came.
    pub fn finish(&mut self, arch: Arch, visit: impl FnMut(&RegionMoments)) {
        for batch in self.waiting.iter_mut().filter(|batch| batch.group.len > 0) {
            batch.flush(arch, &mut self.moments, &mut self.parts);
        }
        self.parts.iter().for_each(visit);
        self.parts.clear();
    }
}

/// One group while it fills.
#[derive(Default)]
pub(super) struct Batch {
    pub(super) group: RegionGroup,
    pub(super) part: [usize; GROUP],
    area: [f64; GROUP],
}

impl Batch {
    /// Takes region i of the element potential on a triangle, which so many of its cuts cut.
    #[inline(always)]
    pub(super) fn set_element(
        &mut self,
        part: usize,
        area_m2: f64,
        (lambda, outside, i, slope): (&[[f64; 3]; 4], &[[u8; 4]; 4], usize, f64),
        cuts: usize,
    ) {
        self.group.cuts = cuts;
        let lane = self.lane();
        element_cuts(lambda, outside, i, |k, cut| self.set_cut(lane, k, &cut));
        let [x, y, z] = lambda[i];
        self.set(lane, part, area_m2, &[4.0 * x, 4.0 * y, 4.0 * z], slope);
    }

    /// Makes room for a region with so many cuts, of which those that it has not cut nothing.
    fn make_room(&mut self, cuts: usize) {
        let group = &mut self.group;
        for cut in group.cuts..cuts {
            group.fields[cut].iter_mut().for_each(|row| row[..group.len].fill(1.0));
            group.bounds[cut][..group.len].fill(0.0);
        }
        for cut in cuts..group.cuts {
            group.fields[cut].iter_mut().for_each(|row| row[group.len] = 1.0);
            group.bounds[cut][group.len] = 0.0;
        }
        group.cuts = group.cuts.max(cuts);
    }

    /// The next lane.
    #[inline(always)]
    fn lane(&self) -> usize {
        assert!(self.group.len < GROUP, "a full group is done at once");
        self.group.len
    }

    #[inline(always)]
    fn set_outline(&mut self, outline: &Outline) {
        let room = if outline.corners().len() <= FEW_CORNERS { FEW_CORNERS } else { MOST_CORNERS };
        let (lane, group) = (self.group.len, &mut self.group);
        if outline.is_triangle() {
            return;
        }
        group.corners = group.corners.max(outline.corners().len()).max(FEW_CORNERS);
        for ([x, y], psi) in group.outline[..room].iter_mut().zip(outline.padded()) {
            (x[lane], y[lane]) = (psi[0], psi[1]);
        }
    }

    #[inline(always)]
    fn set_cut(&mut self, lane: usize, k: usize, cut: &Cut) {
        let [x, y, z] = &mut self.group.fields[k];
        (x[lane], y[lane], z[lane]) = (cut.field[0], cut.field[1], cut.field[2]);
        self.group.bounds[k][lane] = cut.bound;
    }

    /// Completes the next lane.
    #[inline(always)]
    fn set(&mut self, lane: usize, part: usize, area_m2: f64, phi: &[f64; 3], slope: f64) {
        let group = &mut self.group;
        let [x, y, z] = &mut group.phi;
        (x[lane], y[lane], z[lane]) = (phi[0], phi[1], phi[2]);
        group.slope[lane] = slope;
        (self.part[lane], self.area[lane]) = (part, area_m2);
        group.len = lane + 1;
    }

    /// Writes all integrals to their places.
    fn flush(&mut self, arch: Arch, moments: &mut GroupMoments, parts: &mut [RegionMoments]) {
        region_moments(arch, &self.group, moments);
        for lane in 0..self.group.len {
            let (part, area) = (&mut parts[self.part[lane]], self.area[lane]);
            if moments.doubtful[lane] != 0.0 {
                self.in_order(lane, part);
                continue;
            }
            for a in 0..3 {
                part.pressure[a] = area * moments.pressure[a][lane];
                part.slope[a] = area * moments.slope[a][lane];
            }
            (part.area, part.depth) = (area * moments.area[lane], moments.depth[lane]);
        }
        (self.group.len, self.group.cuts, self.group.corners) = (0, 0, 3);
    }

    fn outline_of(&self, lane: usize) -> Outline {
        let corners = self.group.outline.each_ref().map(|[x, y]| [x[lane], y[lane]]);
        match self.group.corners {
            3 => Outline::TRIANGLE,
            count => {
                Outline::of_face(&corners[..count]).expect("a group has no more corners than an outline")
            }
        }
    }

    /// The rim of a region in order, and φ.
    pub(super) fn ordered(&self, lane: usize) -> (Polygon, Form) {
        let group = &self.group;
        let form = |rows: &[[f64; GROUP]; 3]| Form::through(&rows.each_ref().map(|row| row[lane]));
        let cuts = group.fields.iter().zip(&group.bounds).take(group.cuts);
        let mut polygon = Polygon::all_of(&self.outline_of(lane));
        cuts.for_each(|(field, bound)| polygon.cut(&form(field), bound[lane]));
        (polygon, form(&group.phi))
    }

    /// A region that the lanes doubt.
    fn in_order(&self, lane: usize, part: &mut RegionMoments) {
        let (polygon, phi) = self.ordered(lane);
        let mut moments = PairMoments::default();
        moments.add(&polygon, &phi, self.group.slope[lane], self.area[lane]);
        (part.pressure, part.slope) = (moments.pressure, moments.slope);
        (part.area, part.depth) = (moments.area, moments.depth);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integration::pair_moments::element_moments;
    use crate::integration::region::element_regions;
    use crate::integration::tet_frame::{TetFrame, is_outside};
    use ndda_mesh::Vec3;
    use ndda_mesh::geometry::triangle_area_vector;
    use proptest::prelude::*;

    /// Coordinates on a coarse grid, so that corners, edges and planes often meet, some off it by a few ulps.
    fn coordinate() -> impl Strategy<Value = f64> {
        (-3i32..4, 0i32..12).prop_map(|(i, off)| {
            let on_grid = f64::from(i) * 0.25;
            if off < 8 { on_grid } else { on_grid + f64::from(off - 9) * f64::EPSILON }
        })
    }

    fn point() -> impl Strategy<Value = Vec3> {
        [coordinate(), coordinate(), coordinate()].prop_map(Vec3::from)
    }

    proptest! {
        #![proptest_config(ProptestConfig { max_global_rejects: 1_000_000, failure_persistence: None, ..ProptestConfig::with_cases(20_000) })]

        #[test]
        fn a_lane_gives_what_the_ordered_clipper_gives(
            triangle in [point(), point(), point()], corners in [point(), point(), point(), point()]
        ) {
            let mut corners = corners;
            if TetFrame::new(&corners).volume_m3 < 0.0 {
                corners.swap(0, 1);
            }
            let frame = TetFrame::new(&corners);
            let area_vector = triangle_area_vector(&triangle);
            prop_assume!(frame.volume_m3 > 1e-4 && area_vector.norm() > 1e-3);
            let lambda = frame.lambda(&triangle);
            prop_assume!(!is_outside(&lambda));
            let area = area_vector.norm();
            let slopes = frame.slopes(&(area_vector / area));
            let expected = element_moments(&lambda, &slopes, area);
            let mut batches = RegionQueue::default();
            element_regions(&lambda, &slopes, |_, region| {
                batches.push(Arch::new(), 0, area, region, &Outline::TRIANGLE);
            });
            let mut found = crate::integration::pair_moments::PairMoments::default();
            batches.finish(Arch::new(), |part| found.add_region(part));
            let close = |x: f64, y: f64, scale: f64| (x - y).abs() <= 1e-13 * scale;
            for a in 0..3 {
                prop_assert!(close(found.pressure[a], expected.pressure[a], area), "{found:?}\n{expected:?}");
                let most = expected.slope.iter().fold(area, |most, s| most.max(*s));
                prop_assert!(close(found.slope[a], expected.slope[a], 10.0 * most), "{found:?}\n{expected:?}");
            }
            prop_assert!(close(found.area, expected.area, area));
        }
    }
}
