//! A chunk of the integration: its facets and results, and the contactor's triangle.

use std::ops::Range;

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockId, BlockSet, TriangleId, Vec3};

use crate::integration::overlap_pair::{ActiveFacet, ChunkFacet, FacetMoments, OverlapPair};
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
    pub(super) touching: Vec<ChunkFacet>,
    pub(super) sums: Vec<FacetMoments>,
    /// Report on the overlapping pairs.
    pub report: OverlapReport,
}

impl Chunk {
    /// Its facets that touch, with the places of their hits.
    pub(super) fn facets_in_touch(&self, blocks: &BlockSet) -> impl Iterator<Item = ActiveFacet> {
        let (chunk, mut end) = (self.number, 0);
        (0..).zip(&self.touching).map(move |(place, &ChunkFacet { facet, triangle, target, hits })| {
            let (first, owner) = (end, blocks.triangle_block[triangle.index()]);
            end += hits;
            ActiveFacet { facet, triangle, owner, target, chunk, overlaps: [first, end], place }
        })
    }
}

/// A contactor's triangle.
#[derive(Clone, Copy, Default)]
pub(crate) struct Triangle {
    pub(crate) corners: [Vec3; 3],
    /// Outward unit normal.
    pub(crate) normal: Vec3,
    pub(crate) area: f64,
}

impl Triangle {
    /// The triangle at the positions of its nodes.
    pub(crate) fn new(scene: &Scene, triangle: TriangleId) -> Self {
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
    pub(super) touching: Vec<ChunkFacet>,
    pub(super) sums: Vec<FacetMoments>,
}
