//! The result of a cut: blocks, what made their faces, who meets whom.

use super::discs::DiscReport;
use super::neighbours::neighbours;
use super::polyhedron::{Face, Polyhedron};
use super::split::Tolerance;
use super::surfaces::{Neighbour, Surface};

/// A block thinner than requested, or smaller than a cube of that width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sliver {
    /// Index of the block.
    pub block: u32,
    /// Smallest extent over the directions of its faces [m].
    pub width_m: f64,
    /// Volume [m³].
    pub volume_m3: f64,
}

/// Counts of a cut.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CutReport {
    /// Cuts made.
    pub cuts: usize,
    /// Cuts refused because they would make a needle thinner than rounding, as pairs of surface and number.
    pub refused: Vec<(u32, usize)>,
    /// Cuts left out by persistence.
    pub bridged: usize,
    /// Counts of the cuts by discs.
    pub discs: DiscReport,
    /// Blocks thinner than `sliver_width_m`, or smaller than a cube of that width, thinnest first.
    pub slivers: Vec<Sliver>,
    /// Volume of all blocks [m³].
    pub volume_m3: f64,
    /// Volume of the domain [m³].
    pub domain_m3: f64,
}

/// Convex blocks with their surfaces and neighbours.
#[derive(Clone, Debug, PartialEq)]
pub struct Blocks {
    /// The blocks.
    pub blocks: Vec<Polyhedron>,
    /// Surfaces that made their faces; [`Face::surface`] counts in this list.
    pub surfaces: Vec<Surface>,
    /// Names of the surfaces: those of the domain's faces, then of the joints.
    pub names: Vec<String>,
    /// Pairs of faces that meet.
    pub neighbours: Vec<Neighbour>,
    /// Counts of the cut.
    pub report: CutReport,
}

impl Blocks {
    /// Name of what made a face: of a joint, a face of the domain, or `cells`.
    pub fn name_of(&self, face: &Face) -> &str {
        self.surface_name(face.surface)
    }

    /// Name of a surface, as of a [`Neighbour`].
    pub fn surface_name(&self, surface: u32) -> &str {
        &self.names[self.surfaces[surface as usize].name as usize]
    }

    /// Takes blocks out, slivers for instance; later blocks move up. The report keeps what the cut amounted to, with
    /// the slivers that are left under their new indices. Returns the volume taken out [m³].
    pub fn remove(&mut self, blocks: &[u32]) -> f64 {
        let mut index: Vec<Option<u32>> = vec![Some(0); self.blocks.len()];
        for &block in blocks {
            if let Some(index) = index.get_mut(block as usize) {
                *index = None;
            }
        }
        let mut removed_m3 = 0.0;
        let mut kept = Vec::with_capacity(self.blocks.len());
        for (index, block) in index.iter_mut().zip(std::mem::take(&mut self.blocks)) {
            if index.is_some() {
                *index = Some(kept.len() as u32);
                kept.push(block);
            } else {
                removed_m3 += block.volume_m3();
            }
        }
        self.blocks = kept;
        self.neighbours.retain_mut(|neighbour| {
            let [a, b] = neighbour.blocks.map(|block| index[block as usize]);
            a.zip(b).map(|(a, b)| neighbour.blocks = [a, b]).is_some()
        });
        self.report
            .slivers
            .retain_mut(|sliver| index[sliver.block as usize].map(|block| sliver.block = block).is_some());
        removed_m3
    }

    /// Finds neighbours and slivers of finished blocks and completes the report.
    pub(super) fn finish(&mut self, tolerance: Tolerance, sliver_width_m: f64) {
        self.neighbours = neighbours(&self.blocks, &self.surfaces, tolerance.least_depth_m);
        self.report.slivers = slivers(&self.blocks, sliver_width_m);
        let volumes: Vec<f64> = self.blocks.iter().map(Polyhedron::volume_m3).collect();
        self.report.volume_m3 = pairwise_sum(&volumes);
    }
}

/// Blocks thinner than a width, or smaller than a cube of that width, thinnest first.
pub(super) fn slivers(blocks: &[Polyhedron], sliver_width_m: f64) -> Vec<Sliver> {
    let mut slivers = Vec::new();
    for (block, polyhedron) in (0..).zip(blocks) {
        let width_m = polyhedron.width_m();
        if is_sliver(polyhedron, width_m, sliver_width_m) {
            slivers.push(Sliver { block, width_m, volume_m3: polyhedron.volume_m3() });
        }
    }
    slivers.sort_by(|a, b| a.width_m.total_cmp(&b.width_m));
    slivers
}

/// Whether a block of a width is a sliver.
pub(super) fn is_sliver(block: &Polyhedron, width_m: f64, sliver_width_m: f64) -> bool {
    width_m < sliver_width_m || block.volume_m3() < sliver_width_m.powi(3)
}

/// Sum by halves: rounding grows with the logarithm of the number of terms, not with the number.
fn pairwise_sum(terms: &[f64]) -> f64 {
    if terms.len() <= 8 {
        return terms.iter().sum();
    }
    let (low, high) = terms.split_at(terms.len() / 2);
    pairwise_sum(low) + pairwise_sum(high)
}
