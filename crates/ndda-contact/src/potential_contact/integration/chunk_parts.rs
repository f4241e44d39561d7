//! A chunk of the integration: its facets and results, and the contactor's triangle.

use std::ops::Range;

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockId, TriangleId, Vec3};

use crate::integration::overlap_pair::{ActiveFacet, FacetMoments, OverlapPair};
use crate::integration::pair_report::OverlapReport;
use crate::integration::scene::Scene;

/// A run of facets and the hits among their pairs.
#[derive(Default)]
pub(crate) struct Chunk {
    /// Numbers of its facets, the block of the first, and how many pairs they have.
    pub(super) facets: Range<u32>,
    pub(super) first: BlockId,
    pub(super) pairs: usize,
    /// Hits in the order of pairs.
    pub overlaps: Vec<OverlapPair>,
    /// Its number.
    pub(super) number: u32,
    /// Facets that have some, ascending, and what theirs come to.
    pub(super) touching: Vec<ActiveFacet>,
    pub(super) sums: Vec<FacetMoments>,
    /// Report on the overlapping pairs.
    pub report: OverlapReport,
}

/// A contactor's triangle.
#[derive(Clone, Copy, Default)]
pub(super) struct Triangle {
    pub(super) corners: [Vec3; 3],
    /// Outward unit normal.
    pub(super) normal: Vec3,
    pub(super) area: f64,
}

impl Triangle {
    /// The triangle at the positions of its nodes.
    pub(super) fn new(scene: &Scene, triangle: TriangleId) -> Self {
        let corners = scene.blocks.triangle_corners(triangle, scene.position);
        let area_vector = triangle_area_vector(&corners);
        let area = area_vector.norm();
        Self { corners, normal: area_vector / area, area }
    }
}

/// Lists of a chunk.
#[derive(Default)]
pub(super) struct Results {
    pub(super) overlaps: Vec<OverlapPair>,
    pub(super) touching: Vec<ActiveFacet>,
    pub(super) sums: Vec<FacetMoments>,
}

/// Puts entries in the place of others, with room for an eighth more where there is too little.
pub(super) fn copy_into<T: Copy>(list: &mut Vec<T>, entries: &[T]) {
    list.clear();
    if list.capacity() < entries.len() {
        list.reserve_exact(entries.len() + entries.len() / 8);
    }
    list.extend_from_slice(entries);
}
