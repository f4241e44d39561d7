//! The faces of convex blocks, and blocks that are affine convex targets.
//!
//! A point beyond one face of a convex block is outside the block. Blocks that lie side by side have many boundary
//! triangles that touch each other's edges and are in nothing; one comparison with the faces of the whole block says
//! so, where its tetrahedra would be tested one by one.
//!
//! A convex block that moves by an affine map x = F X + c (a rigid one, an affine one, one that is held as a whole)
//! keeps its faces plane. If φ is the depth below the nearest of them, it stays the smallest of the same linear
//! functions all over the block, and the block needs no tetrahedra: it is one target, with one function per face.
//! Forces on it go to the corners of its largest tetrahedron, the *host*, whose λ are coordinates of the whole space. Its own faces
//! are contactors, see [`contactors`](crate::affine::face_contactor).

use std::ops::Range;

use nalgebra::{Matrix4, Vector4};
use ndda_mesh::geometry::{Aabb, tet_volume};
use ndda_mesh::{BlockId, BlockSet, TetId, TriangleId, Vec3};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::affine::face::Face;
use crate::affine::face_contactor::{FaceContactor, FaceContactors};
use crate::affine::half_spaces::{Planes, SIDES};
use crate::affine::surface::BlockFaces;
use crate::integration::capacity::MOST_CUTS;
use crate::integration::clip::Outline;
use crate::integration::polyhedron::EmbeddedPolyhedron;
use crate::integration::tet_frame::TetFrame;

/// Faces below which a second thread costs more than it brings.
const GRAIN_FACES: usize = 1024;

/// Pairs of blocks below which a second thread costs more than it brings.
const GRAIN_PAIRS: usize = 128;

/// A block of more faces is treated by its tetrahedra.
const MOST_FACES: usize = 32;

/// A convex block that is an affine convex target.
#[derive(Clone, Debug)]
pub(crate) struct AffineConvexTarget {
    /// Its largest tetrahedron, whose corners take its forces.
    pub host: TetId,
    /// φ as deep as the block is wide: at the node furthest below a face, where that is least.
    pub most_phi: f64,
    /// Its shape, carried by the host.
    pub shape: EmbeddedPolyhedron,
    /// Volume share of each node, a quarter of that of its tetrahedra.
    pub share: Vec<f64>,
    /// Λ⁻¹, Λ = Σ share λ λᵀ over the nodes, λ those of the host.
    pub inverse_spread: Matrix4<f64>,
}

/// The faces of all convex blocks, where they are now.
#[derive(Clone, Debug, Default)]
pub struct ConvexBlocks {
    faces: Vec<Face>,
    /// First face of each block; one that is concave or round has none.
    start: Vec<u32>,
    whole: Vec<Option<Box<AffineConvexTarget>>>,
    /// Which blocks move by affine maps; blocks beyond the list do not.
    is_affine: Vec<bool>,
    /// Which blocks are convex; blocks beyond the list are not.
    is_convex: Vec<bool>,
    /// How many blocks are affine convex targets.
    affine: usize,
    /// The faces of each block once more, by rows, and where those of each row are.
    planes: Vec<Planes>,
    in_row: Vec<Range<usize>>,
    /// First row of each block.
    row_start: Vec<u32>,
    contactors: FaceContactors,
    /// Whether a face keeps the two blocks of a pair apart.
    are_apart: Vec<bool>,
    /// Whether a block has a neighbour that no face keeps apart from it.
    may_touch: Vec<bool>,
}

impl ConvexBlocks {
    /// Takes the faces of all blocks; once per set of blocks. `phi_per_m` is φ per depth below the nearest face, if it is that;
    /// then the blocks of which `affine` says that they move by an affine map are affine convex targets, and their faces are contactors unless
    /// triangles are requested.
    pub fn fit(
        &mut self,
        blocks: &BlockSet,
        surfaces: &[BlockFaces],
        phi_per_m: Option<f64>,
        affine: &[bool],
        by_triangle: bool,
    ) {
        self.faces.clear();
        self.whole.clear();
        self.start.clear();
        self.start.push(0);
        self.in_row.clear();
        self.row_start.clear();
        self.row_start.push(0);
        self.contactors.clear();
        self.is_affine.clear();
        self.is_affine.extend_from_slice(affine);
        self.is_convex.clear();
        self.is_convex.extend(surfaces.iter().map(|surface| surface.convex));
        for (block, surface) in blocks.ids().zip(surfaces) {
            let count = surface.planes.len();
            let is_affine = affine.get(block.index()) == Some(&true);
            let phi_per_m = phi_per_m.filter(|_| is_affine && surface.convex && count <= MOST_CUTS);
            if surface.convex && count <= MOST_FACES {
                let face = |face| Face::new(blocks, block, surface, face, phi_per_m);
                self.faces.extend((0..count).map(face));
            }
            self.start.push(self.faces.len() as u32);
            let own = &self.faces[self.places_of(block)];
            let whole = phi_per_m.map(|_| Box::new(AffineConvexTarget::new(blocks, block, own)));
            match &whole {
                Some(whole) if !by_triangle => {
                    let host = TetFrame::new(&blocks.tet_corners(whole.host, &blocks.rest_position));
                    self.contactors.take(blocks, block, surface, &host);
                }
                _ => self.contactors.skip(),
            }
            let places = self.places_of(block);
            let row = |first| first..places.end.min(first + SIDES);
            self.in_row.extend(places.clone().step_by(SIDES).map(row));
            self.row_start.push(self.in_row.len() as u32);
            self.whole.push(whole);
        }
        self.affine = self.whole.iter().flatten().count();
    }

    /// Takes the faces to where the nodes are [m].
    pub fn place(&mut self, blocks: &BlockSet, position: &[Vec3]) {
        let place = |face: &mut Face| face.place(&position[blocks.nodes_of(face.block)], position);
        self.faces.par_iter_mut().with_min_len(GRAIN_FACES).for_each(place);
        let rows = self.in_row.par_iter().with_min_len(GRAIN_FACES / SIDES);
        rows.map(|row| Planes::of(&self.faces[row.clone()])).collect_into_vec(&mut self.planes);
    }

    /// Looks for a face between the two blocks of each pair, that far from one of them at least [m].
    pub fn separate(
        &mut self,
        blocks: &BlockSet,
        position: &[Vec3],
        pairs: &[(BlockId, BlockId)],
        distance_m: f64,
    ) {
        let mut are_apart = std::mem::take(&mut self.are_apart);
        are_apart.resize(pairs.len(), false);
        let arch = Arch::new();
        let keeps = |block, other| {
            let nodes = &position[blocks.nodes_of(other)];
            match distance_m {
                0.0 => self.keep_apart(arch, block, nodes),
                _ => self.faces_of(block).iter().any(|face| face.keeps_out(nodes, distance_m)),
            }
        };
        let look = |(apart, &(a, b)): (&mut bool, &(BlockId, BlockId))| *apart = keeps(a, b) || keeps(b, a);
        are_apart.par_iter_mut().zip(pairs).with_min_len(GRAIN_PAIRS).for_each(look);
        self.are_apart = are_apart;
        self.may_touch.clear();
        self.may_touch.resize(blocks.len(), false);
        for (&(a, b), _) in pairs.iter().zip(&self.are_apart).filter(|(_, apart)| !**apart) {
            (self.may_touch[a.index()], self.may_touch[b.index()]) = (true, true);
        }
    }

    /// Whether a block has a neighbour that no face keeps apart from it.
    #[inline]
    pub(crate) fn may_touch(&self, block: BlockId) -> bool {
        self.may_touch[block.index()]
    }

    /// Whether a face keeps the k-th pair of blocks apart; touching is not overlap.
    #[inline]
    pub(crate) fn are_apart(&self, k: u32) -> bool {
        self.are_apart[k as usize]
    }

    /// Whether a face of the block keeps it from what these points span; touching is not overlap.
    #[inline]
    pub(crate) fn keep_apart(&self, arch: Arch, block: BlockId, points: &[Vec3]) -> bool {
        arch.dispatch(FacesSeparate { planes: self.planes_of(block), points })
    }

    /// The faces of a block; none of one that is concave or round.
    #[inline]
    pub(crate) fn faces_of(&self, block: BlockId) -> &[Face] {
        &self.faces[self.places_of(block)]
    }

    /// The faces of a block, by rows.
    #[inline]
    pub(crate) fn planes_of(&self, block: BlockId) -> &[Planes] {
        let [start, end] = [0, 1].map(|next| self.row_start[block.index() + next] as usize);
        &self.planes[start..end]
    }

    /// The faces of all blocks, block by block.
    pub(crate) fn faces(&self) -> &[Face] {
        &self.faces
    }

    /// A block that is an affine convex target.
    #[inline]
    pub(crate) fn affine_target(&self, block: BlockId) -> Option<&AffineConvexTarget> {
        self.whole.get(block.index()).and_then(Option::as_deref)
    }

    /// Whether a block moves by affine maps: what is apart in it then never meets.
    #[inline]
    pub(crate) fn keeps_its_shape(&self, block: BlockId) -> bool {
        self.is_affine.get(block.index()) == Some(&true)
    }

    /// Whether a block is convex, however many faces it has.
    #[inline]
    pub(crate) fn is_convex(&self, block: BlockId) -> bool {
        self.is_convex.get(block.index()) == Some(&true)
    }

    /// The faces of a block as contactors in another; none where it is put into that triangle by triangle.
    #[inline]
    pub(crate) fn contactors(&self, block: BlockId, target: BlockId) -> &[FaceContactor] {
        if self.affine_target(target).is_some() { self.contactors.of_block(block) } else { &[] }
    }

    /// The face that a triangle stands for as a contactor in another block.
    #[inline]
    pub(crate) fn contactor(&self, triangle: TriangleId, target: BlockId) -> Option<&FaceContactor> {
        self.affine_target(target).and_then(|_| self.contactors.of_triangle(triangle))
    }

    /// The outline of a contactor in another block: that of the face that the triangle stands for, or the triangle.
    #[inline]
    pub(crate) fn outline(&self, triangle: TriangleId, target: BlockId) -> &Outline {
        self.contactor(triangle, target).map_or(&Outline::TRIANGLE, |face| &face.outline)
    }

    /// How many blocks are affine convex targets.
    pub(crate) fn count_affine(&self) -> usize {
        self.affine
    }

    /// Range of a block's faces in the list of all faces.
    pub(crate) fn places_of(&self, block: BlockId) -> Range<usize> {
        let start = |block: usize| self.start.get(block).map_or(0, |&start| start as usize);
        start(block.index())..start(block.index() + 1)
    }
}

/// A question to the faces of a block.
struct FacesSeparate<'a> {
    planes: &'a [Planes],
    points: &'a [Vec3],
}

impl WithSimd for FacesSeparate<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> bool {
        self.planes.iter().any(|row| row.keep_out(simd, self.points))
    }
}

impl AffineConvexTarget {
    fn new(blocks: &BlockSet, block: BlockId, faces: &[Face]) -> Self {
        let tets = || blocks.tets_of(block).map(|tet| TetId(tet as u32));
        let corners = |tet: TetId| blocks.tet_corners(tet, &blocks.rest_position);
        let volume = |tet: TetId| tet_volume(&corners(tet));
        let larger = |a: &TetId, b: &TetId| volume(*a).total_cmp(&volume(*b));
        let host = tets().max_by(larger).expect("a block has tetrahedra");
        let nodes = blocks.nodes_of(block);
        let quarter = 0.25 / tets().map(volume).sum::<f64>();
        let mut share = vec![0.0; nodes.len()];
        for tet in tets() {
            for node in blocks.tets[tet.index()] {
                share[node.index() - nodes.start] += quarter * volume(tet);
            }
        }
        let frame = TetFrame::new(&corners(host));
        let outer = |(x, share): (&Vec3, &f64)| {
            let lambda = Vector4::from(frame.lambda_at(x));
            *share * lambda * lambda.transpose()
        };
        let spread: Matrix4<f64> = blocks.rest_position[nodes].iter().zip(&share).map(outer).sum();
        let inverse_spread = spread.try_inverse().expect("a block fills space");
        let furthest = faces.iter().filter_map(|face| face.furthest).map(|(_, phi)| phi);
        let most_phi = furthest.fold(f64::INFINITY, f64::min);
        let sides = faces.iter().map(|face| {
            let mut face = face.clone();
            face.place(&[], &blocks.rest_position);
            face.linear(&Vec3::zeros())
        });
        let bounds = Aabb::around(&blocks.rest_position[blocks.nodes_of(block)]);
        let shape = EmbeddedPolyhedron::new(&bounds, sides, &frame);
        Self { host, most_phi, shape, share, inverse_spread }
    }

    /// A bound of ω² over K/M when points of the block, given by λ of the host, are held by springs: S = Σ k λ λᵀ. The
    /// nodes of an affine block follow four motions, and √(tr (Λ⁻¹S)²) is no less than the largest eigenvalue.
    pub(crate) fn rate(&self, springs: &Matrix4<f64>) -> f64 {
        let product = self.inverse_spread * springs;
        product.component_mul(&product.transpose()).sum().max(0.0).sqrt()
    }
}
