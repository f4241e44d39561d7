//! The frames of a run, as far as a page shows them.

use ndda_io::results::{FieldFrame, ListedFrame};
use ndda_mesh::Vec3;
use ndda_mesh::geometry::Aabb;
use serde::Serialize;

use super::bolts::{BoltDescription, BoltMotion};
use super::error::ReportError;
use super::packed::{Codes, Packed, PackedArray};
use crate::field::{Field, Place, fields};
use crate::frames::{STILL, same_blocks, thinned};
use crate::surface::Surface;

/// Codes of all frames before compression [bytes]; runs with more are thinned.
const MOST_BYTES: usize = 40_000_000;
/// Part of all values that the colours resolve where a few are far above the others.
const USUAL: f64 = 0.995;

/// The 3D view of a run.
pub struct Motion {
    /// Times of the frames that are shown [s].
    pub times_s: Vec<f64>,
    /// The surfaces.
    pub surface: Surface,
    /// Positions in the first frame [m], of nodes of the surface.
    start: Vec<Vec3>,
    /// Displacements since then [m], three per node.
    moved: Codes,
    /// Blocks that are not there, for each frame.
    absent: Vec<Vec<u32>>,
    /// The fields with a value per node or triangle.
    fields: Vec<(Field, Codes)>,
    /// The box that holds all blocks at all times.
    extent: Aabb,
    /// Bolts.
    pub bolts: BoltMotion,
}

/// Description of a motion for the page, beside the numbers themselves.
#[derive(Serialize)]
pub struct Description {
    times_s: Vec<f64>,
    /// Centre of everything; positions count from it.
    origin_m: [f64; 3],
    extent_m: [f64; 3],
    nodes: usize,
    triangles: usize,
    /// Blocks that hardly move.
    still: Vec<usize>,
    /// Blocks that are not there, for each frame; none where all are.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    absent: Vec<Vec<u32>>,
    moved: Range,
    fields: Vec<Colour>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bolts: Option<BoltDescription>,
    arrays: Vec<PackedArray>,
}

#[derive(Serialize)]
struct Range {
    least: f32,
    largest: f32,
    /// Upper end of the colour scale.
    top: f32,
}

#[derive(Serialize)]
struct Colour {
    array: String,
    label: String,
    unit: &'static str,
    of_nodes: bool,
    range: Range,
}

impl Motion {
    /// Reads frames and those of bolts, at most `most` of them or as many as a page can carry.
    ///
    /// # Errors
    /// [`ReportError`] when a frame is damaged or does not fit the first.
    pub fn read(
        listed: &[ListedFrame],
        bolt_frames: &[ListedFrame],
        most: Option<usize>,
    ) -> Result<Self, ReportError> {
        let first = FieldFrame::read(&listed[0].path)?;
        let surface = Surface::new(&first);
        let fields = fields(&first);
        let entries: usize = fields.iter().map(|f| entries(f.place, &surface)).sum();
        let fitting = MOST_BYTES / (2 * (3 * surface.nodes.len() + entries)).max(1);
        let shown = thinned(listed.len(), most.unwrap_or(fitting.max(2)));
        let start: Vec<Vec3> = surface.nodes.iter().map(|&n| first.points[n as usize]).collect();
        let (mut moved, mut values) = (Vec::new(), vec![Vec::new(); fields.len()]);
        let mut bolts = BoltMotion::default();
        let (mut extent, mut times_s, mut absent) = (Aabb::empty(), Vec::new(), Vec::new());
        for index in shown {
            let ListedFrame { time_s, path } = &listed[index];
            let frame = FieldFrame::read(path)?;
            same_blocks(path, &first, &frame, &fields)?;
            let now: Vec<Vec3> = surface.nodes.iter().map(|&n| frame.points[n as usize]).collect();
            now.iter().for_each(|x| extent.grow(x));
            bolts.push(bolt_frames, (index, *time_s), &surface, [&start, &now])?;
            let displacements = now.iter().zip(&start).map(|(x, x0)| x - x0);
            moved.push(displacements.flat_map(<[f64; 3]>::from).map(|u| u as f32).collect());
            for (field, values) in fields.iter().zip(&mut values) {
                values.extend(field.array_of(&frame).map(|array| field.values(array, &surface)));
            }
            times_s.push(*time_s);
            absent.push(surface.absent(&frame));
        }
        if absent.iter().all(Vec::is_empty) {
            absent.clear();
        }
        let fields = fields.into_iter().zip(&values).map(|(field, values)| (field, Codes::new(values)));
        let (moved, fields) = (Codes::new(&moved), fields.collect());
        Ok(Self { times_s, start, moved, absent, fields, surface, extent, bolts })
    }

    /// The page's description of the motion, and the numbers as a text.
    pub fn describe(&self) -> (Description, String) {
        let origin = self.extent.center();
        let mut packed = Packed::default();
        let coordinates = |x: &Vec3| <[f64; 3]>::from(x - origin).map(|c| c as f32);
        packed.add_f32("start", self.start.iter().flat_map(coordinates));
        packed.add_u32("triangles", self.surface.triangles.iter().flatten().copied());
        packed.add_u32("blocks", self.surface.blocks.iter().copied());
        packed.add_u32("edges", self.surface.edges.iter().flatten().copied());
        packed.add_codes("moved", &self.moved);
        let (bolts, numbers) = self.bolts.describe(&origin).unzip();
        packed.add_f32("bolts", numbers.unwrap_or_default());
        let lengths = self.largest_motions();
        let farthest = lengths.iter().copied().fold(0.0, f64::max);
        let colour = |(field, codes): &(Field, Codes)| {
            packed.add_codes(&field.array, codes);
            let (array, label, unit) = (field.array.clone(), field.label.clone(), field.unit);
            Colour { array, label, unit, of_nodes: field.place == Place::Node, range: range(codes) }
        };
        let fields = self.fields.iter().map(colour).collect();
        let description = Description {
            times_s: self.times_s.clone(),
            origin_m: origin.into(),
            extent_m: (self.extent.max - self.extent.min).into(),
            nodes: self.start.len(),
            triangles: self.surface.triangles.len(),
            still: (0..lengths.len()).filter(|&b| lengths[b] < STILL * farthest).collect(),
            absent: self.absent.clone(),
            moved: Range { least: self.moved.least, largest: self.moved.largest, top: farthest as f32 },
            fields,
            bolts,
            arrays: packed.arrays.drain(..).collect(),
        };
        (description, packed.text())
    }

    /// Farthest that a node of each block was from where it began [m].
    fn largest_motions(&self) -> Vec<f64> {
        let mut largest = vec![0.0; self.surface.block_count()];
        for frame in &self.moved.frames {
            let now = self.farthest_nodes(frame);
            largest
                .iter_mut()
                .zip(now)
                .for_each(|(largest, now): (&mut f64, f64)| *largest = largest.max(now));
        }
        largest
    }

    /// How far the farthest node of each block that moves is from where it began [m], with the block's number, frame by frame.
    pub fn displacements(&self) -> Vec<(usize, Vec<f32>)> {
        let frames: Vec<Vec<f64>> =
            self.moved.frames.iter().map(|frame| self.farthest_nodes(frame)).collect();
        let of_block = |block: usize| frames.iter().map(|frame| frame[block] as f32).collect();
        let blocks: Vec<(usize, Vec<f32>)> =
            (0..self.surface.block_count()).map(|block| (block, of_block(block))).collect();
        let most = |curve: &[f32]| curve.iter().copied().fold(0.0f32, f32::max);
        let farthest = blocks.iter().map(|(_, curve)| most(curve)).fold(0.0, f32::max);
        blocks.into_iter().filter(|(_, curve)| most(curve) >= STILL as f32 * farthest).collect()
    }

    /// How far the farthest node of each block is in a frame from where it began [m].
    fn farthest_nodes(&self, frame: &[u16]) -> Vec<f64> {
        let step = f64::from(self.moved.largest - self.moved.least) / f64::from(u16::MAX);
        let metres = |code: u16| f64::from(self.moved.least) + step * f64::from(code);
        let mut farthest = vec![0.0; self.surface.block_count()];
        for (corners, &block) in self.surface.triangles.iter().zip(&self.surface.blocks) {
            for &node in corners {
                let u = &frame[3 * node as usize..][..3];
                let length = Vec3::new(metres(u[0]), metres(u[1]), metres(u[2])).norm();
                farthest[block as usize] = f64::max(farthest[block as usize], length);
            }
        }
        farthest
    }
}

/// A range whose colours end where nearly all values do.
fn range(codes: &Codes) -> Range {
    let Codes { least, largest, .. } = *codes;
    let usual = codes.quantile(USUAL);
    let top = if largest - least > 1.5 * (usual - least) && usual > least { usual } else { largest };
    Range { least, largest, top }
}

fn entries(place: Place, surface: &Surface) -> usize {
    match place {
        Place::Node => surface.nodes.len(),
        Place::Triangle => surface.triangles.len(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_values_far_above_the_others_do_not_spoil_the_colours() {
        let mut values = vec![1.0f32; 10_000];
        values[0] = 0.0;
        assert_eq!(range(&Codes::new(&[values.clone()])).top, 1.0);
        values[1] = 100.0;
        let found = range(&Codes::new(&[values]));
        assert!((found.top - 1.0).abs() < 1e-2 && found.largest == 100.0);
    }
}
