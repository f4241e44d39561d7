//! Bolts of a run: their lines in the 3D view, and what they carry at the end.

use maud::{Markup, html};
use ndda_io::BoltLine;
use ndda_io::mesh_file::MeshFileError;
use ndda_io::results::ListedFrame;
use ndda_mesh::Vec3;
use serde::Serialize;

use super::sections::brief;
use crate::summary::{BoltEnd, Summary};
use crate::surface::Surface;
use crate::view3d::bolts;

/// Bytes that all frames may have before compression; pieces are joined where they would have more.
const MOST_BYTES: usize = 12_000_000;
/// Most pieces that are shown of a bolt.
const MOST_PIECES: usize = 16;
/// Bytes of a piece.
const PIECE_BYTES: usize = 4 * NUMBERS;
/// Numbers of a piece: its ends, their displacements, tension, utilisation, state, bolt.
const NUMBERS: usize = 16;
/// Bolts that are listed; a table of more is no help.
const MOST_BOLTS: usize = 200;

/// Bolts in the frames that a page shows.
#[derive(Default)]
pub struct BoltMotion {
    frames: Vec<Vec<Placed>>,
}

/// A piece, and the displacements of the rock at its ends [m].
struct Placed {
    line: BoltLine,
    moved_m: [Vec3; 2],
}

/// What the page needs to know of bolts, beside their numbers.
#[derive(Serialize)]
pub struct BoltDescription {
    /// Pieces in each frame.
    counts: Vec<usize>,
    /// Least and largest tension [N].
    force_n: [f64; 2],
    /// Largest tension over the force at which the steel yields.
    utilisation: f64,
}

impl BoltMotion {
    /// Takes in the bolts of the frame of some number and time [s], whose surface is at some places [m] and was at others.
    ///
    /// # Errors
    /// A frame of bolts cannot be read.
    pub fn push(
        &mut self,
        listed: &[ListedFrame],
        (number, time_s): (usize, f64),
        surface: &Surface,
        [start, now]: [&[Vec3]; 2],
    ) -> Result<(), MeshFileError> {
        let lines = bolts::at(listed, number, time_s)?;
        let mut nodes = vec![Vec::new(); if lines.is_empty() { 0 } else { surface.block_count() }];
        if !lines.is_empty() {
            for (corners, &block) in surface.triangles.iter().zip(&surface.blocks) {
                nodes[block as usize].extend(corners);
            }
        }
        let moved = |end: [f64; 3], block: u32| {
            let distance = |node: u32| (now[node as usize] - Vec3::from(end)).norm_squared();
            let all = nodes.get(block as usize).into_iter().flatten().copied();
            let nearest = all.min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
            nearest.map_or(Vec3::zeros(), |node| now[node as usize] - start[node as usize])
        };
        let placed = |line: BoltLine| Placed { moved_m: line.ends_m.map(|end| moved(end, line.block)), line };
        self.frames.push(lines.into_iter().map(placed).collect());
        Ok(())
    }

    /// Whether there are none in any frame.
    pub fn is_empty(&self) -> bool {
        self.frames.iter().all(Vec::is_empty)
    }

    /// What the page needs to know, and the numbers of all pieces, places from `origin` [m]; none where there are no bolts.
    pub fn describe(&self, origin: &Vec3) -> Option<(BoltDescription, Vec<f32>)> {
        if self.is_empty() {
            return None;
        }
        let bolts: usize =
            self.frames.iter().map(|pieces| pieces.chunk_by(same_bolt).count()).sum::<usize>().max(1);
        let most = (MOST_BYTES / (PIECE_BYTES * bolts)).clamp(1, MOST_PIECES);
        let (mut counts, mut numbers) = (Vec::new(), Vec::new());
        for pieces in &self.frames {
            let before = numbers.len();
            for bolt in pieces.chunk_by(same_bolt) {
                bolt.chunks(bolt.len().div_ceil(most)).for_each(|part| add(&mut numbers, part, origin));
            }
            counts.push((numbers.len() - before) / NUMBERS);
        }
        let all = || self.frames.iter().flatten().map(|placed| &placed.line);
        let force_n =
            all().fold([0.0f64; 2], |[low, high], line| [low.min(line.axial_n), high.max(line.axial_n)]);
        let utilisation = all().map(|line| line.utilisation).fold(0.0, f64::max);
        Some((BoltDescription { counts, force_n, utilisation }, numbers))
    }
}

fn same_bolt(a: &Placed, b: &Placed) -> bool {
    a.line.bolt == b.line.bolt
}

/// Adds pieces that follow each other as one: from the first end to the last, with the largest force and the worst state.
fn add(numbers: &mut Vec<f32>, part: &[Placed], origin: &Vec3) {
    let (first, last) = (&part[0], &part[part.len() - 1]);
    let ends = [Vec3::from(first.line.ends_m[0]), Vec3::from(last.line.ends_m[1])];
    let moved = [first.moved_m[0], last.moved_m[1]];
    let places = ends.map(|end| end - origin).into_iter().chain(moved);
    numbers.extend(places.flat_map(<[f64; 3]>::from).map(|x| x as f32));
    let strongest = part
        .iter()
        .map(|placed| placed.line.axial_n)
        .fold(0.0, |a, b| if f64::abs(b) > f64::abs(a) { b } else { a });
    let utilisation = part.iter().map(|placed| placed.line.utilisation).fold(0.0, f64::max);
    let state = part.iter().map(|placed| placed.line.state).max().unwrap_or(0);
    numbers.extend([strongest as f32, utilisation as f32, f32::from(state), first.line.bolt as f32]);
}

/// What bolts carry at the end, those nearest to their limits first.
pub fn table(summary: &Summary) -> Markup {
    let mut all: Vec<&(String, BoltEnd)> = summary.bolts.0.iter().collect();
    let gave_way = |end: &BoltEnd| end.plate_yielded_m > 0.0 || end.dowel_yielded_m > 0.0;
    let rank = |end: &BoltEnd| (end.utilisation.max(f64::from(u8::from(gave_way(end)))), end.axial_n.abs());
    all.sort_by(|(_, a), (_, b)| {
        let ([a, a_n], [b, b_n]) = ([rank(a).0, rank(a).1], [rank(b).0, rank(b).1]);
        b.total_cmp(&a).then(b_n.total_cmp(&a_n))
    });
    let share = |part: f64| brief(100.0 * part);
    html! {
        @if !all.is_empty() {
            details.card open {
                summary { "Bolts at the end (" (all.len()) ")" }
                div.scroll {
                    table {
                        thead {
                            tr {
                                th { "" }
                                th.number { "largest tension [kN]" }
                                th.number { "share of yield [%]" }
                                th.number { "largest shear [kN]" }
                                th.number { "grout slipped [%]" }
                                th { "state" }
                            }
                        }
                        tbody {
                            @for (name, end) in all.iter().take(MOST_BOLTS) {
                                tr {
                                    td { (name) }
                                    td.number { (brief(1e-3 * end.axial_n)) }
                                    td.number { (share(end.utilisation)) }
                                    td.number { (brief(1e-3 * end.shear_n)) }
                                    td.number { (share(end.debonded)) }
                                    td { (end.state) }
                                }
                            }
                        }
                    }
                }
                @if all.len() > MOST_BOLTS {
                    p.note { "The " (MOST_BOLTS) " of " (all.len()) " bolts nearest to their limits; summary.json has them all." }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn placed(bolt: usize, z: f64, axial_n: f64, state: u8) -> Placed {
        let ends_m = [[0.0, 0.0, z], [0.0, 0.0, z + 0.01]];
        let line = BoltLine { ends_m, bolt, block: 0, axial_n, utilisation: 0.1, slip_m: 0.0, state };
        Placed { line, moved_m: [Vec3::zeros(); 2] }
    }

    #[test]
    fn pieces_of_a_long_bolt_are_joined_with_the_largest_force_and_the_worst_state() {
        let long: Vec<Placed> = (0..160)
            .map(|k| placed(0, 0.01 * k as f64, if k == 37 { -9e3 } else { 1e3 }, u8::from(k == 3)))
            .collect();
        let short = [placed(4, 0.0, 2e3, 0)];
        let motion = BoltMotion { frames: vec![Vec::new(), long.into_iter().chain(short).collect()] };
        let (description, numbers) = motion.describe(&Vec3::new(0.0, 0.0, 1.0)).unwrap();
        assert_eq!(description.counts, [0, MOST_PIECES + 1]);
        assert_eq!(description.force_n, [-9e3, 2e3]);
        let pieces: Vec<&[f32]> = numbers.chunks(NUMBERS).collect();
        assert_eq!(pieces[3][12], -9e3);
        assert_eq!((pieces[0][14], pieces[1][14], pieces[16][15]), (1.0, 0.0, 4.0));
        // Pieces of ten hundredths of a metre that follow each other, from a metre below the origin.
        assert_eq!((pieces[0][2], pieces[1][2]), (-1.0, pieces[0][5]));
        assert!((pieces[15][5] - 0.6).abs() < 1e-6);
        assert!(BoltMotion { frames: vec![Vec::new()] }.describe(&Vec3::zeros()).is_none());
    }
}
