//! One convex block cut by one plane.
//!
//! A vertex within rounding of the plane counts as lying on it, and a part that rises less than a larger tolerance
//! above the plane is not cut off. What follows is combinatorial: no coordinate
//! decides twice. The section must be one simple ring that both parts share, which makes each part a closed surface
//! with V − E + F = 2. Should rounding prevent that, the band is widened; a plane that still fails leaves the block whole.

use super::plane::Plane;
use super::polyhedron::{Face, Polyhedron};
use crate::Vec3;

/// How often the band about the plane is widened, by [`WIDER`] each time.
const ATTEMPTS: usize = 6;
/// Factor between bands.
const WIDER: f64 = 4.0;

/// Tolerances of touching, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Vertices nearer to the plane lie on it [m]: rounding of coordinates.
    pub on_plane_m: f64,
    /// Parts that rise less above the plane are not cut off [m].
    pub least_depth_m: f64,
}

/// Position of a block relative to a plane, and its halves where it is cut.
#[derive(Clone, Debug, PartialEq)]
pub enum Split {
    /// The block lies above the plane, or touches it from there.
    Above,
    /// The block lies below the plane, or touches it from there.
    Below,
    /// The plane cuts; the section is the last face of both parts.
    Both {
        /// The part on the side of the normal.
        above: Polyhedron,
        /// The other part.
        below: Polyhedron,
    },
    /// The section is no simple ring at any width of the band, or a part would be a needle thinner than rounding: the
    /// block is to stay whole.
    Refused,
}

/// Cuts `block` by `plane`; the section carries `surface`.
pub fn split(block: &Polyhedron, plane: &Plane, surface: u32, tolerance: Tolerance) -> Split {
    let heights: Vec<f64> = block.vertices.iter().map(|x| plane.height_m(x)).collect();
    let highest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
    let mut band_m = tolerance.on_plane_m;
    for _ in 0..ATTEMPTS {
        let least_m = band_m.max(tolerance.least_depth_m);
        if highest <= least_m || lowest >= -least_m {
            return if highest > -lowest { Split::Above } else { Split::Below };
        }
        let sides: Vec<i8> = heights.iter().map(|&h| (h > band_m) as i8 - (h < -band_m) as i8).collect();
        let cutter = Cutter { block, heights: &heights, sides, new: Vec::new() };
        if let Some((above, below)) = cutter.cut(surface) {
            let sound = is_thick(&above, tolerance.on_plane_m) && is_thick(&below, tolerance.on_plane_m);
            return if sound { Split::Both { above, below } } else { Split::Refused };
        }
        band_m *= WIDER;
    }
    Split::Refused
}

/// Whether the volume of a part is well above what rounding of its coordinates makes of it.
fn is_thick(part: &Polyhedron, rounding_m: f64) -> bool {
    part.volume_m3() > rounding_m * part.bounds().diagonal().powi(2)
}

/// The cut of one block with the sides of its vertices settled: 1 above, −1 below, 0 on the plane.
struct Cutter<'a> {
    block: &'a Polyhedron,
    heights: &'a [f64],
    sides: Vec<i8>,
    /// Edges that the plane crosses; their points follow the vertices of the block.
    new: Vec<(u32, u32)>,
}

impl Cutter<'_> {
    fn cut(mut self, surface: u32) -> Option<(Polyhedron, Polyhedron)> {
        let (mut above, mut below) = (Vec::new(), Vec::new());
        for face in &self.block.faces {
            let has = |side: i8| face.vertices.iter().any(|&v| self.sides[v as usize] == side);
            match (has(1), has(-1)) {
                (true, false) => above.push(face.clone()),
                (false, true) => below.push(face.clone()),
                (true, true) => {
                    let [up, down] = self.halves(face)?;
                    above.push(up);
                    below.push(down);
                }
                (false, false) => return None,
            }
        }
        let open = self.open_edges(&above);
        let mut reverse: Vec<_> = self.open_edges(&below).into_iter().map(|(a, b)| (b, a)).collect();
        reverse.sort_unstable();
        if open != reverse {
            return None;
        }
        let ring = ring(&open)?;
        above.push(Face { vertices: ring.iter().rev().copied().collect(), surface });
        below.push(Face { vertices: ring, surface });
        let points: Vec<Vec3> = self.new.iter().map(|&edge| self.crossing(edge)).collect();
        Some((self.part(above, &points)?, self.part(below, &points)?))
    }

    /// The face above and below. A run of vertices on the plane is left at its first one.
    fn halves(&mut self, face: &Face) -> Option<[Face; 2]> {
        let ring = &face.vertices;
        let n = ring.len();
        let start = (0..n).find(|&i| self.sides[ring[i] as usize] != 0)?;
        let mut side = self.sides[ring[start] as usize];
        let mut changes = 0;
        let mut loops = [Vec::with_capacity(n + 1), Vec::with_capacity(n + 1)];
        let half = |side: i8| usize::from(side < 0);
        for step in 0..n {
            let (v, w) = (ring[(start + step) % n], ring[(start + step + 1) % n]);
            loops[half(side)].push(v);
            let (here, next) = (self.sides[v as usize], self.sides[w as usize]);
            let enters_run = here == 0 && self.sides[ring[(start + step + n - 1) % n] as usize] != 0;
            if enters_run && self.side_after(ring, start + step) == -side {
                side = -side;
                changes += 1;
                loops[half(side)].push(v);
            } else if here * next < 0 {
                let point = self.point_on(v, w);
                loops[half(side)].push(point);
                side = -side;
                changes += 1;
                loops[half(side)].push(point);
            }
        }
        let is_simple =
            |ring: &[u32]| ring.len() >= 3 && (1..ring.len()).all(|i| !ring[..i].contains(&ring[i]));
        let sound = changes == 2 && loops.iter().all(|ring| is_simple(ring));
        sound.then(|| loops.map(|vertices| Face { vertices, surface: face.surface }))
    }

    /// Side of the next vertex that is not on the plane.
    fn side_after(&self, ring: &[u32], at: usize) -> i8 {
        let n = ring.len();
        (1..n).map(|i| self.sides[ring[(at + i) % n] as usize]).find(|&side| side != 0).unwrap_or(0)
    }

    /// Index of the point where the plane crosses an edge.
    fn point_on(&mut self, a: u32, b: u32) -> u32 {
        let edge = (a.min(b), a.max(b));
        let known = self.new.iter().position(|&e| e == edge).unwrap_or_else(|| {
            self.new.push(edge);
            self.new.len() - 1
        });
        (self.block.vertices.len() + known) as u32
    }

    /// x = a + t (b − a), t = h_a / (h_a − h_b), from the lexicographically smaller end: blocks on both sides of an
    /// older cut then get the same bits.
    fn crossing(&self, (a, b): (u32, u32)) -> Vec3 {
        let at = |v: u32| self.block.vertices[v as usize];
        let (a, b) = if at(a).as_slice() <= at(b).as_slice() { (a, b) } else { (b, a) };
        let (ha, hb) = (self.heights[a as usize], self.heights[b as usize]);
        at(a) + (at(b) - at(a)) * (ha / (ha - hb))
    }

    fn is_on_plane(&self, vertex: u32) -> bool {
        self.sides.get(vertex as usize).is_none_or(|&side| side == 0)
    }

    /// Directed edges in the plane whose reverse is missing, sorted.
    fn open_edges(&self, faces: &[Face]) -> Vec<(u32, u32)> {
        let mut edges = Vec::new();
        for face in faces {
            let ring = &face.vertices;
            for (i, &a) in ring.iter().enumerate() {
                let b = ring[(i + 1) % ring.len()];
                if self.is_on_plane(a) && self.is_on_plane(b) {
                    edges.push((a, b));
                }
            }
        }
        let mut open: Vec<_> = edges.iter().filter(|(a, b)| !edges.contains(&(*b, *a))).copied().collect();
        open.sort_unstable();
        open
    }

    /// The polyhedron of `faces`, with only the vertices that they name.
    fn part(&self, mut faces: Vec<Face>, points: &[Vec3]) -> Option<Polyhedron> {
        let old = self.block.vertices.len();
        let mut index = vec![u32::MAX; old + points.len()];
        let mut vertices = Vec::new();
        for vertex in faces.iter_mut().flat_map(|face| &mut face.vertices) {
            let from = *vertex as usize;
            if index[from] == u32::MAX {
                index[from] = vertices.len() as u32;
                vertices.push(if from < old { self.block.vertices[from] } else { points[from - old] });
            }
            *vertex = index[from];
        }
        let corners: usize = faces.iter().map(|face| face.vertices.len()).sum();
        let is_sphere = vertices.len() + faces.len() == corners / 2 + 2;
        is_sphere.then_some(Polyhedron { vertices, faces })
    }
}

/// The one simple ring that the edges make, in their direction.
fn ring(edges: &[(u32, u32)]) -> Option<Vec<u32>> {
    let next = |from: u32| {
        let mut leaving = edges.iter().filter(|edge| edge.0 == from);
        let edge = leaving.next()?;
        leaving.next().is_none().then_some(edge.1)
    };
    let first = edges.first()?.0;
    let mut ring = vec![first];
    let mut at = next(first)?;
    while at != first && ring.len() <= edges.len() {
        ring.push(at);
        at = next(at)?;
    }
    (at == first && ring.len() == edges.len() && ring.len() >= 3).then_some(ring)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cut::random::Stream;

    const TOLERANCE: Tolerance = Tolerance { on_plane_m: 1e-13, least_depth_m: 1e-9 };

    fn unit() -> Polyhedron {
        Polyhedron::cuboid(Vec3::zeros(), Vec3::repeat(1.0))
    }

    fn cut(point: [f64; 3], normal: [f64; 3]) -> Split {
        split(&unit(), &Plane::new(point.into(), normal.into()).unwrap(), 6, TOLERANCE)
    }

    fn parts(split: Split) -> [Polyhedron; 2] {
        let Split::Both { above, below } = split else { panic!("{split:?}") };
        [above, below]
    }

    #[test]
    fn a_plane_in_the_middle_makes_two_halves_that_share_their_section() {
        let [above, below] = parts(cut([0.25, 0.0, 0.0], [1.0, 0.0, 0.0]));
        assert!((above.volume_m3() - 0.75).abs() < 1e-15 && (below.volume_m3() - 0.25).abs() < 1e-15);
        assert_eq!(above.area_vector(above.faces.last().unwrap()), -Vec3::x());
        assert_eq!(below.faces.last().unwrap().surface, 6);
    }

    #[test]
    fn planes_through_vertices_edges_and_faces_are_consistent() {
        let [a, b] = parts(cut([0.0; 3], [1.0, -1.0, 0.0]));
        assert_eq!((a.vertices.len(), a.faces.len(), b.vertices.len()), (6, 5, 6));
        let [a, b] = parts(cut([1.0, 0.0, 0.0], [1.0, 1.0, 1.0]));
        assert_eq!(a.vertices.len() + b.vertices.len(), 4 + 7);
        assert_eq!(cut([0.0; 3], [1.0, 1.0, 1.0]), Split::Above);
        assert_eq!(cut([0.0; 3], [1.0, 0.0, 0.0]), Split::Above);
        assert_eq!(cut([1.0 + 1e-12, 0.0, 0.0], [1.0, 0.0, 0.0]), Split::Below);
        assert_eq!(cut([0.0; 3], [1.0, 1.0, 0.0]), Split::Above);
    }

    /// A point and a normal on coarse grids, so that planes often pass through vertices, edges and older sections.
    fn degenerate_plane(stream: &mut Stream) -> Plane {
        let jitter = [0.0, 0.0, 1e-16, 1e-12, 1e-9, 3e-9, 1e-8][stream.between(0.0, 7.0) as usize];
        loop {
            let point =
                Vec3::from_fn(|_, _| stream.between(0.0, 5.0).floor() / 4.0 + jitter * stream.normal());
            let normal = Vec3::from_fn(|_, _| stream.between(-2.0, 3.0).floor() + jitter * stream.normal());
            if let Ok(plane) = Plane::new(point, normal) {
                return plane;
            }
        }
    }

    #[test]
    fn a_hundred_thousand_degenerate_cuts_keep_euler_and_volume() {
        let mut cuts = 0;
        let mut refused = 0;
        for case in 0u64.. {
            let mut stream = Stream::new(case, &[]);
            let mut blocks = vec![unit()];
            for _ in 0..6 {
                let plane = degenerate_plane(&mut stream);
                let old = std::mem::take(&mut blocks);
                for block in old {
                    cuts += 1;
                    match split(&block, &plane, 6, TOLERANCE) {
                        Split::Both { above, below } => blocks.extend([above, below]),
                        Split::Refused => {
                            refused += 1;
                            blocks.push(block);
                        }
                        _ => blocks.push(block),
                    }
                }
            }
            assert!(blocks.iter().all(|block| block.euler() == Some(2)), "case {case}");
            assert!(blocks.iter().all(|block| block.volume_m3() > 0.0), "case {case}");
            let volume: f64 = blocks.iter().map(Polyhedron::volume_m3).sum();
            assert!((volume - 1.0).abs() < 1e-12, "case {case}: {volume}");
            if cuts > 300_000 {
                break;
            }
        }
        println!("{cuts} cuts, {refused} refused");
        assert!(refused * 50 < cuts, "{refused} of {cuts} cuts refused");
    }
}
