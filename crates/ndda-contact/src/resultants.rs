//! Resultants of touching blocks over their facets: force, moment, area, depth.

use ndda_mesh::{BlockId, BlockSet, Vec3};

use crate::model::FacetContact;

/// Resultants of contact between two blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairResultant {
    /// The block of the smaller number.
    pub first: BlockId,
    /// The other.
    pub second: BlockId,
    /// Force on the first, friction included [N].
    pub force_n: Vec3,
    /// The part of it that friction does [N].
    pub friction_n: Vec3,
    /// Centre of contact: the mean of the facets' centres of pressure by the size of their forces [m].
    pub center: Vec3,
    /// Moment on the first about that centre [N m].
    pub moment_n_m: Vec3,
    /// Area in contact, the mean of both sides [m²].
    pub area_m2: f64,
    /// Mean depth of the overlap, its volume over that area [m].
    pub depth_m: f64,
    /// Part of the area that slides.
    pub sliding: f64,
}

/// A face lies across a direction if the cosine between that and its normal is larger than `ACROSS`, and along it if smaller than `ALONG`: within a degree.
const ACROSS: f64 = 0.9998;
const ALONG: f64 = 0.0175;

/// The resultants of all pairs that touch, in the order of their blocks; `facets` are sorted by pair.
pub fn resultants(blocks: &BlockSet, facets: &mut [FacetContact]) -> Vec<PairResultant> {
    let pair = |facet: &FacetContact| {
        let owner = blocks.triangle_block[facet.facet.index()];
        (owner.min(facet.target), owner.max(facet.target))
    };
    facets.sort_by_key(pair);
    facets.chunk_by(|a, b| pair(a) == pair(b)).map(|run| resultant(blocks, pair(&run[0]), run)).collect()
}

fn resultant(
    blocks: &BlockSet,
    (first, second): (BlockId, BlockId),
    facets: &[FacetContact],
) -> PairResultant {
    // A facet of the second block feels the opposite of the first block's force.
    let sign = |f: &FacetContact| if blocks.triangle_block[f.facet.index()] == first { 1.0 } else { -1.0 };
    let (mut force_n, mut friction_n, mut center) = (Vec3::zeros(), Vec3::zeros(), Vec3::zeros());
    let (mut area, mut slides, mut weight) = (0.0, 0.0, 0.0);
    for facet in facets {
        let total = facet.push_n + facet.friction_n;
        force_n += sign(facet) * total;
        friction_n += sign(facet) * facet.friction_n;
        center += total.norm() * (facet.center - facets[0].center);
        weight += total.norm();
        area += facet.area_m2;
        slides += if facet.sticks { 0.0 } else { facet.area_m2 };
    }
    center = facets[0].center + if weight > 0.0 { center / weight } else { Vec3::zeros() };
    let moment =
        |f: &FacetContact| sign(f) * ((f.center - center).cross(&(f.push_n + f.friction_n)) + f.couple_n_m);
    PairResultant {
        first,
        second,
        force_n,
        friction_n,
        center,
        moment_n_m: facets.iter().map(moment).sum(),
        area_m2: 0.5 * area,
        depth_m: if area > 0.0 { 2.0 * overlap_m3(facets) / area } else { 0.0 },
        sliding: if area > 0.0 { slides / area } else { 0.0 },
    }
}

/// Volume of the overlap whose surface the facets are [m³]: V = ⅓ ∮ x·n dS. Where all of them lie across one direction e or along it, V = ∮ (x·e)(e·n) dS instead:
/// walls that both blocks have in common, as cubes in a stack have, lie inside neither block. They are therefore missing from the facets, but add nothing to the second integral.
fn overlap_m3(facets: &[FacetContact]) -> f64 {
    let from = facets[0].center;
    let most = facets.iter().max_by(|a, b| a.push_n.norm().total_cmp(&b.push_n.norm()));
    let e = most.expect("a pair that touches has facets").normal;
    let is_oblique = |f: &FacetContact| (ALONG..=ACROSS).contains(&f.normal.dot(&e).abs());
    let is_flat = !facets.iter().any(is_oblique);
    let part = |f: &FacetContact| match is_flat {
        true => f.area_m2 * (f.center - from).dot(&e) * f.normal.dot(&e),
        false => f.area_m2 * (f.center - from).dot(&f.normal) / 3.0,
    };
    facets.iter().map(part).sum()
}
