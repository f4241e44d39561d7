//! The integrals of all candidate pairs, in parallel, many pairs at a time.

use std::ops::Range;

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockSet, Vec3};
use pulp::Arch;
use rayon::prelude::*;

use crate::candidates::{Candidates, Facet, Pair};
use crate::clip::{Form, Polygon};
use crate::kernel::{GROUP, GroupMoments, MOST_CUTS, PairGroup, PieceGroup, element_moments, piece_moments};
use crate::pair::{self, PairMoments, TetFrame};
use crate::potential::{Field, PieceTable};

/// Pairs of a chunk: one task for a thread.
const CHUNK_PAIRS: usize = 512;

/// A candidate pair that does overlap.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hit {
    /// Index in [`Candidates::pairs`].
    pub pair: u32,
    /// Its integrals.
    pub moments: PairMoments,
}

/// What all chunks read.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// Topology.
    pub blocks: &'a BlockSet,
    /// Positions [m].
    pub position: &'a [Vec3],
    /// Pairs and facets.
    pub candidates: &'a Candidates,
    /// A frame for each of [`Candidates::tets`].
    pub frames: &'a [TetFrame],
    /// φ.
    pub field: &'a Field,
}

/// A run of facets and the hits among their pairs.
#[derive(Default)]
pub struct Chunk {
    /// Facets of this chunk, in [`Candidates::facets`].
    pub facets: Range<usize>,
    /// Hits in the order of pairs.
    pub hits: Vec<Hit>,
    /// End of each facet's hits.
    ends: Vec<usize>,
    element: ElementBatch,
    piece: PieceBatch,
    moments: GroupMoments,
}

impl Chunk {
    /// The hits of the k-th facet of this chunk.
    pub fn hits_of(&self, k: usize) -> &[Hit] {
        let start = if k == 0 { 0 } else { self.ends[k - 1] };
        &self.hits[start..self.ends[k]]
    }

    fn integrate(&mut self, arch: Arch, scene: &Scene) {
        self.hits.clear();
        self.ends.clear();
        for facet in &scene.candidates.facets[self.facets.clone()] {
            self.add_facet(arch, scene, facet);
            self.ends.push(self.hits.len());
        }
        self.flush_elements(arch);
        self.flush_pieces(arch);
    }

    fn add_facet(&mut self, arch: Arch, scene: &Scene, facet: &Facet) {
        let corners = scene.blocks.triangle_corners(facet.triangle, scene.position);
        let area_vector = triangle_area_vector(&corners);
        let area = area_vector.norm();
        if area == 0.0 {
            return;
        }
        let normal = area_vector / area;
        let pieces = matches!(scene.field, Field::Pieces(_));
        for index in facet.pairs.clone() {
            let pair: &Pair = &scene.candidates.pairs[index];
            let frame = &scene.frames[pair.tet as usize];
            let in_plane = || Some(frame.lambda(&corners)).filter(|l| lies_in_a_plane_of(frame, l, &normal));
            let inside = frame.lambda_inside(&corners);
            let Some(lambda) = inside.or_else(|| if pieces { in_plane() } else { None }) else { continue };
            let hit = self.hits.len();
            self.hits.push(Hit { pair: index as u32, ..Hit::default() });
            match scene.field {
                Field::Element => {
                    if self.element.push(hit, area, &lambda, &frame.slopes(&normal)) {
                        self.flush_elements(arch);
                    }
                }
                Field::Pieces(table) => {
                    let tet = scene.candidates.tets[pair.tet as usize];
                    let item = PieceItem { hit, area, lambda: &lambda, frame, normal: &normal };
                    self.add_pieces(arch, table, table.of(tet), &item);
                }
            }
        }
    }

    fn add_pieces(&mut self, arch: Arch, _table: &PieceTable, pieces: &[[f64; 4]], item: &PieceItem) {
        for k in 0..pieces.len() {
            if self.piece.push(item, pieces, k) {
                self.flush_pieces(arch);
            }
        }
    }

    fn flush_elements(&mut self, arch: Arch) {
        if self.element.len == 0 {
            return;
        }
        self.element.fill_up();
        element_moments(arch, &self.element.group, &mut self.moments);
        for lane in 0..self.element.len {
            let (hit, area) = (self.element.hit[lane], self.element.area[lane]);
            self.hits[hit].moments = if self.moments.doubtful[lane] == 0.0 {
                self.moments.of(lane, area)
            } else {
                let group = &self.element.group;
                let lambda = group.lambda.each_ref().map(|at| at.each_ref().map(|row| row[lane]));
                pair::element_moments(&lambda, &group.slope.each_ref().map(|row| row[lane]), area)
            };
        }
        self.element.len = 0;
    }

    fn flush_pieces(&mut self, arch: Arch) {
        if self.piece.len == 0 {
            return;
        }
        self.piece.fill_up();
        piece_moments(arch, &self.piece.group, &mut self.moments);
        for lane in 0..self.piece.len {
            let (hit, area) = (self.piece.hit[lane], self.piece.area[lane]);
            let part = if self.moments.doubtful[lane] == 0.0 {
                self.moments.of(lane, area)
            } else {
                self.piece.in_order(lane)
            };
            self.hits[hit].moments.join(&part);
        }
        self.piece.len = 0;
        self.piece.group.len = 0;
    }
}

/// Whether the triangle lies exactly in a face's plane and the tetrahedron owns it: other potentials than the
/// paper's are not zero on the faces inside a block.
fn lies_in_a_plane_of(frame: &TetFrame, lambda: &[[f64; 3]; 4], normal: &Vec3) -> bool {
    let beyond = |at: &[f64; 3]| at.iter().all(|&l| l < 0.0);
    let off = |b: usize| lambda[b].iter().all(|&l| l <= 0.0) && !frame.owns_plane(b, normal);
    !lambda.iter().any(beyond) && !(0..4).any(off)
}

/// Pairs of the element potential that wait for a full group.
#[derive(Default)]
struct ElementBatch {
    group: PairGroup,
    hit: [usize; GROUP],
    area: [f64; GROUP],
    len: usize,
}

impl ElementBatch {
    /// Adds a pair; true when the group is full.
    fn push(&mut self, hit: usize, area: f64, lambda: &[[f64; 3]; 4], slopes: &[f64; 4]) -> bool {
        let lane = self.len;
        let rows = self.group.lambda.as_flattened_mut().iter_mut().chain(&mut self.group.slope);
        for (row, value) in rows.zip(lambda.as_flattened().iter().chain(slopes)) {
            row[lane] = *value;
        }
        (self.hit[lane], self.area[lane]) = (hit, area);
        self.len += 1;
        self.len == GROUP
    }

    /// Puts pairs that do not overlap into the lanes left over.
    fn fill_up(&mut self) {
        for lane in self.len..GROUP {
            for row in self.group.lambda.iter_mut().flatten() {
                row[lane] = -1.0;
            }
        }
    }
}

/// A piece of a pair.
struct PieceItem<'a> {
    hit: usize,
    area: f64,
    lambda: &'a [[f64; 3]; 4],
    frame: &'a TetFrame,
    normal: &'a Vec3,
}

/// Pieces of any other potential that wait for a full group.
#[derive(Default)]
struct PieceBatch {
    group: PieceGroup,
    hit: [usize; GROUP],
    area: [f64; GROUP],
    len: usize,
}

impl PieceBatch {
    /// Adds the k-th of the pieces whose smallest is φ; true when the group is full.
    fn push(&mut self, item: &PieceItem, pieces: &[[f64; 4]], k: usize) -> bool {
        let lane = self.len;
        let at_corners =
            |values: &[f64; 4]| [0, 1, 2].map(|a| (0..4).map(|b| values[b] * item.lambda[b][a]).sum::<f64>());
        let phi = at_corners(&pieces[k]);
        for cut in self.group.len..3 + pieces.len() {
            self.open(cut);
        }
        for (b, lambda) in item.lambda.iter().enumerate() {
            self.set_cut(b, lane, lambda, f64::from(item.frame.owns_plane(b, item.normal)));
        }
        let rivals = (0..pieces.len()).filter(|&j| j != k);
        for (slot, j) in rivals.enumerate() {
            let rival = at_corners(&pieces[j]);
            let ahead = [0, 1, 2].map(|a| rival[a] - phi[a]);
            self.set_cut(4 + slot, lane, &ahead, f64::from(k < j));
        }
        let gradient: Vec3 = (0..4).map(|b| pieces[k][b] * item.frame.gradients()[b]).sum();
        self.group.slope[lane] = gradient.dot(item.normal).abs();
        for (row, value) in self.group.phi.iter_mut().zip(phi) {
            row[lane] = value;
        }
        (self.hit[lane], self.area[lane]) = (item.hit, item.area);
        self.len += 1;
        self.len == GROUP
    }

    /// Makes room for one more cut, one that cuts nothing.
    fn open(&mut self, cut: usize) {
        self.group.cuts[cut] = [[1.0; GROUP]; 3];
        self.group.ties[cut] = [1.0; GROUP];
        self.group.len = cut + 1;
    }

    fn set_cut(&mut self, cut: usize, lane: usize, field: &[f64; 3], tie: f64) {
        for (row, value) in self.group.cuts[cut].iter_mut().zip(field) {
            row[lane] = *value;
        }
        self.group.ties[cut][lane] = tie;
    }

    fn fill_up(&mut self) {
        for lane in self.len..GROUP {
            self.set_cut(0, lane, &[-1.0; 3], 1.0);
        }
    }

    fn in_order(&self, lane: usize) -> PairMoments {
        let group = &self.group;
        let field = |rows: &[[f64; GROUP]; 3]| Form::through(&rows.each_ref().map(|row| row[lane]));
        let cuts = group.cuts.iter().zip(&group.ties).take(group.len);
        let polygon = cuts.fold(Polygon::triangle(), |p, (cut, tie)| p.cut(&field(cut), tie[lane] != 0.0));
        let mut moments = PairMoments::default();
        moments.add(&polygon, &field(&group.phi), group.slope[lane], self.area[lane]);
        let at = |b: usize| [0, 1, 2].map(|a| group.cuts[b][a][lane]);
        moments.share_with_target(&[at(0), at(1), at(2), at(3)]);
        moments
    }
}

/// All chunks of a scene; their memory is kept from step to step.
pub struct Integrals {
    arch: Arch,
    chunks: Vec<Chunk>,
    /// Chunk of each facet.
    chunk_of: Vec<u32>,
}

impl Default for Integrals {
    fn default() -> Self {
        Self { arch: Arch::new(), chunks: Vec::new(), chunk_of: Vec::new() }
    }
}

impl Integrals {
    /// Integrates all pairs. The division into chunks depends on the list of pairs alone.
    pub fn update(&mut self, scene: &Scene) {
        self.divide(&scene.candidates.facets);
        let (arch, used) = (self.arch, self.chunk_count());
        let chunks = &mut self.chunks[..used];
        match chunks {
            [only] => only.integrate(arch, scene),
            many => many.par_iter_mut().for_each(|chunk| chunk.integrate(arch, scene)),
        }
    }

    fn divide(&mut self, facets: &[Facet]) {
        self.chunk_of.clear();
        let (mut used, mut start) = (0, 0);
        while start < facets.len() {
            let first_pair = facets[start].pairs.start;
            let more = facets[start..].iter().take_while(|f| f.pairs.end - first_pair <= CHUNK_PAIRS).count();
            let end = start + more.max(1);
            if used == self.chunks.len() {
                self.chunks.push(Chunk::default());
            }
            self.chunks[used].facets = start..end;
            self.chunk_of.resize(end, used as u32);
            used += 1;
            start = end;
        }
    }

    fn chunk_count(&self) -> usize {
        self.chunk_of.last().map_or(0, |&last| last as usize + 1)
    }

    /// The chunks in use, in the order of facets.
    pub fn chunks(&self) -> &[Chunk] {
        &self.chunks[..self.chunk_count()]
    }

    /// The hits of a facet.
    pub fn hits_of(&self, facet: usize) -> &[Hit] {
        let chunk = &self.chunks[self.chunk_of[facet] as usize];
        chunk.hits_of(facet - chunk.facets.start)
    }
}

const _: () = assert!(MOST_CUTS >= 4, "a tetrahedron has four faces");
