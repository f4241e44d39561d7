//! Blocks as a picture shows them: surfaces, which of them move, their colours, and the moments of a run.

use ndda_mesh::Vec3;
use ndda_mesh::geometry::Aabb;

use super::bolts::Piece;
use super::paint::{Theme, group_colour};
use super::raster::Coat;
use crate::frames::STILL;
use crate::run::motion::MOVED;
use crate::surface::Surface;

/// A scale that begins below this part of its end begins at zero.
const NEAR_ZERO: f64 = 0.2;
/// Values that differ by less than this part of the largest are one value.
const EQUAL: f64 = 0.1;

/// Displacements shorter than this over the largest coordinate are rounding.
const ROUNDING: f64 = 1e-13;

/// Displacements longer than so many diagonals of all blocks leave nothing of these to be seen.
const MOST_DIAGONALS: f64 = 30.0;

/// Blocks at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Moment {
    /// Time [s]; none before a run.
    pub time_s: Option<f64>,
    /// Positions of the nodes of the surface [m].
    pub positions: Vec<Vec3>,
    /// Blocks that are not there, ascending.
    pub absent: Vec<u32>,
    /// Values on the scale of colours, one to a node or a triangle; none where colours are of groups.
    pub values: Vec<f32>,
    /// Bolts that are there, piece by piece.
    pub bolts: Vec<Piece>,
}

/// Meaning of the colours.
#[derive(Clone, Debug, PartialEq)]
pub enum Colouring {
    /// A quantity.
    Scale {
        /// Its name.
        label: String,
        /// Its unit; empty where it has none.
        unit: &'static str,
        /// Whether it has a value per node, or else per triangle.
        of_nodes: bool,
        /// Whether blocks at rest are coloured as well.
        with_resting: bool,
        /// Ends of the scale.
        range: [f64; 2],
    },
    /// A group to each block.
    Groups {
        /// Names of the groups.
        names: Vec<String>,
        /// Word for several groups.
        plural: &'static str,
        /// Group of each block.
        of_block: Vec<u32>,
        /// Whether blocks at rest are coloured as well.
        with_resting: bool,
    },
}

/// Blocks at some moments.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Title of the picture.
    pub title: String,
    /// Surfaces of all blocks.
    pub surface: Surface,
    /// Positions that motion counts from [m].
    pub start: Vec<Vec3>,
    /// Whether each block moves, or may.
    pub moves: Vec<bool>,
    /// Colours.
    pub colouring: Colouring,
    /// The moments, at least one.
    pub moments: Vec<Moment>,
    /// Blocks that have moved by the last of the moments, as the run counts them; none before a run.
    pub moved: Option<usize>,
    /// Blocks that can move; none where that is not known.
    pub movable: Option<usize>,
}

impl Film {
    /// Largest factor of displacements at which blocks are still seen: the farthest is drawn as long as so many diagonals of all
    /// blocks.
    pub fn largest_factor(&self) -> f64 {
        let diagonal_m = Aabb::around(&self.start).diagonal();
        let gone = |moment: &Moment| {
            let lengths = moment.positions.iter().zip(&self.start).map(|(x, x0)| (x - x0).norm());
            lengths.fold(0.0, f64::max)
        };
        MOST_DIAGONALS * diagonal_m / self.moments.iter().map(gone).fold(0.0, f64::max)
    }

    /// Most bolts that are there at a moment.
    pub fn bolt_count(&self) -> usize {
        let count = |moment: &Moment| moment.bolts.chunk_by(|a, b| a.bolt == b.bolt).count();
        self.moments.iter().map(count).max().unwrap_or(0)
    }

    /// Block of each node of the surface.
    pub fn block_of_node(&self) -> Vec<u32> {
        let mut blocks = vec![0; self.surface.nodes.len()];
        for (corners, &block) in self.surface.triangles.iter().zip(&self.surface.blocks) {
            corners.iter().for_each(|&node| blocks[node as usize] = block);
        }
        blocks
    }

    /// Colour of a triangle at a moment.
    pub fn coat(&self, moment: &Moment, triangle: usize, theme: &Theme) -> Coat {
        let block = self.surface.blocks[triangle];
        let is_coloured = |with_resting: bool| with_resting || self.moves[block as usize];
        match &self.colouring {
            Colouring::Scale { of_nodes, with_resting, range, .. } if is_coloured(*with_resting) => {
                let part = |place: u32| part(f64::from(moment.values[place as usize]), *range);
                match of_nodes {
                    true => Coat::Scale(self.surface.triangles[triangle].map(part)),
                    false => Coat::Scale([part(triangle as u32); 3]),
                }
            }
            Colouring::Groups { of_block, with_resting, .. } if is_coloured(*with_resting) => {
                Coat::Plain(group_colour(of_block[block as usize]))
            }
            _ => Coat::Plain(theme.resting),
        }
    }
}

/// Place of a value on a scale, 0 to 1.
fn part(value: f64, [low, high]: [f64; 2]) -> f64 {
    if high > low { (value - low) / (high - low) } else { 0.0 }
}

/// Whether each block has moved, by the farthest that a node of it was from its start at these moments.
pub fn moving(surface: &Surface, start: &[Vec3], moments: &[Moment]) -> Vec<bool> {
    let mut farthest = vec![0.0; surface.block_count()];
    for moment in moments {
        for (corners, &block) in surface.triangles.iter().zip(&surface.blocks) {
            for &node in corners {
                let moved = (moment.positions[node as usize] - start[node as usize]).norm();
                farthest[block as usize] = f64::max(farthest[block as usize], moved);
            }
        }
    }
    let limit = STILL * farthest.iter().copied().fold(0.0, f64::max);
    let coordinate = start.iter().map(|x| x.amax()).fold(0.0, f64::max);
    let limit = f64::max(limit, ROUNDING * coordinate);
    farthest.iter().map(|&moved| moved > 0.0 && moved >= limit).collect()
}

/// Blocks that have moved as a run counts them: by more than a part of the distance from their mass centre to their farthest node.
pub fn moved(surface: &Surface, start: &[Vec3], moment: &Moment) -> usize {
    let count = surface.block_count();
    let (mut volume, mut moments) = (vec![0.0; count], vec![Vec3::zeros(); count]);
    // A node of each block, from which it is small: in coordinates of a map the products of places leave no digits.
    let mut from = vec![Vec3::zeros(); count];
    for (corners, &block) in surface.triangles.iter().zip(&surface.blocks) {
        from[block as usize] = start[corners[0] as usize];
    }
    for (corners, &block) in surface.triangles.iter().zip(&surface.blocks) {
        // Signed tetrahedra from there; a factor of six in both cancels.
        let [a, b, c] = corners.map(|n| start[n as usize] - from[block as usize]);
        let six = a.dot(&b.cross(&c));
        volume[block as usize] += six;
        moments[block as usize] += six * (a + b + c) / 4.0;
    }
    let (mut radius, mut gone) = (vec![0.0; count], vec![0.0; count]);
    for (corners, &block) in surface.triangles.iter().zip(&surface.blocks) {
        let block = block as usize;
        for &node in corners {
            let (now, then) = (moment.positions[node as usize], start[node as usize]);
            let arm = then - from[block] - moments[block] / volume[block];
            radius[block] = f64::max(radius[block], arm.norm());
            gone[block] = f64::max(gone[block], (now - then).norm());
        }
    }
    gone.iter().zip(&radius).filter(|(gone, radius)| **gone > MOVED * **radius).count()
}

/// Ends of the scale: the least and the largest value that is drawn; zero in place of a least value near it, or of one that is
/// nearly the largest.
pub fn range(values: impl Iterator<Item = f32>) -> [f64; 2] {
    let finite = values.map(f64::from).filter(|value| value.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    match low <= high {
        true if low > 0.0 && (low < NEAR_ZERO * high || high - low < EQUAL * high) => [0.0, high],
        true => [low, high],
        false => [0.0, 0.0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view3d::testing::boxes;

    #[test]
    fn what_moves_by_rounding_alone_is_at_rest() {
        let moves = |gone_m: f64| {
            let film =
                boxes(&[([0.0; 3], [1.0; 3], [0.0, 0.0, gone_m]), ([900.0, 0.0, 0.0], [1.0; 3], [0.0; 3])]);
            moving(&film.surface, &film.start, &film.moments)
        };
        assert_eq!(moves(1e-9), [true, false]);
        assert_eq!(moves(1e-13), [false, false]);
    }

    #[test]
    fn a_scale_ends_at_the_least_and_the_largest_value() {
        assert_eq!(range([3.0, -1.0, 2.5].into_iter()), [-1.0, 3.0]);
        assert_eq!(range([2.0, 3.0, f32::NAN].into_iter()), [2.0, 3.0]);
        assert_eq!(range([0.0, 0.0].into_iter()), [0.0, 0.0]);
        assert_eq!(range(std::iter::empty()), [0.0, 0.0]);
    }

    #[test]
    fn a_scale_that_begins_near_zero_or_has_one_value_begins_at_zero() {
        assert_eq!(range([0.5, 4.0].into_iter()), [0.0, 4.0]);
        assert_eq!(range([4.0, 4.0].into_iter()), [0.0, 4.0]);
        assert_eq!(range([3.9, 4.0].into_iter()), [0.0, 4.0]);
    }

    #[test]
    fn a_block_has_moved_when_it_has_gone_a_hundredth_of_its_own_radius() {
        // A cube of 1 m has a radius of 0.866 m, whatever far larger blocks do; one of 10 m has ten times that.
        let film = boxes(&[
            ([0.0; 3], [1.0; 3], [0.0, 0.0, 0.0088]),
            ([2.0, 0.0, 0.0], [1.0; 3], [0.0, 0.0, 0.0085]),
            ([9.0, 0.0, 0.0], [10.0; 3], [0.05, 0.0, 0.0]),
            ([99.0, 0.0, 0.0], [1.0; 3], [50.0, 0.0, 0.0]),
        ]);
        assert_eq!(moved(&film.surface, &film.start, &film.moments[0]), 2);
        // In the coordinates of a map.
        let [x, y, z] = [452_317.3, 5_213_841.7, 812.4];
        let far = boxes(&[
            ([x, y, z], [1.0; 3], [0.0, 0.0, 0.0088]),
            ([x + 2.0, y, z], [1.0; 3], [0.0, 0.0, 0.0085]),
        ]);
        assert_eq!(moved(&far.surface, &far.start, &far.moments[0]), 1);
    }

    #[test]
    fn a_block_moves_when_it_goes_a_hundredth_of_the_farthest() {
        let surface = Surface {
            nodes: (0..6).collect(),
            triangles: vec![[0, 1, 2], [3, 4, 5]],
            tets: vec![0, 1],
            blocks: vec![0, 1],
            edges: Vec::new(),
        };
        let start = vec![Vec3::zeros(); 6];
        let moment = |far: f64| {
            let x = |i: usize| Vec3::new(if i < 3 { 1.0 } else { far }, 0.0, 0.0);
            Moment { positions: (0..6).map(x).collect(), ..Moment::default() }
        };
        assert_eq!(moving(&surface, &start, &[moment(0.009)]), [true, false]);
        assert_eq!(moving(&surface, &start, &[moment(0.011)]), [true, true]);
        // It counts that it was away, although it has come back.
        assert_eq!(moving(&surface, &start, &[moment(1.0), moment(0.0)]), [true, true]);
        let still = Moment { positions: start.clone(), ..Moment::default() };
        assert_eq!(moving(&surface, &start, &[still]), [false, false]);
    }
}
