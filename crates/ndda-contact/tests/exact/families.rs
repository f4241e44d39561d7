//! Pairs of tetrahedra that are made to be hard, from a generator that gives the same on every machine.

use std::array::from_fn;

use ndda_mesh::Vec3;
use ndda_mesh::geometry::tet_volume;

/// Knuth's MMIX generator: tests need numbers that are the same everywhere, no more.
pub struct Random {
    pub state: u64,
    /// Corners are multiples of 1/64, so that degenerate pairs are exactly so; else of 2⁻⁵².
    pub coarse: bool,
}

impl Random {
    pub fn of_case(case: usize) -> Self {
        let mut random = Self { state: 20_261_121 + case as u64, coarse: false };
        (0..4).for_each(|_| {
            random.next();
        });
        random.coarse = random.below(3) == 0;
        random
    }

    pub fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        let mixed = (self.state ^ (self.state >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed ^ (mixed >> 32)
    }

    pub fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }

    pub fn one_of(&mut self, choices: &[f64]) -> f64 {
        choices[self.below(choices.len() as u64) as usize]
    }

    /// In [−1, 1].
    pub fn coordinate(&mut self) -> f64 {
        if self.coarse {
            return (self.below(129) as f64 - 64.0) / 64.0;
        }
        (self.next() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn point(&mut self) -> Vec3 {
        Vec3::from_fn(|_, _| self.coordinate())
    }

    /// A tetrahedron that is not flat.
    pub fn tet(&mut self) -> [Vec3; 4] {
        loop {
            let corners = from_fn(|_| self.point());
            if tet_volume(&corners).abs() > 0.02 {
                return corners;
            }
        }
    }
}

pub fn nudged(x: f64, ulps: i64) -> f64 {
    if x == 0.0 { ulps as f64 * 1e-17 } else { f64::from_bits((x.to_bits() as i64 + ulps) as u64) }
}

pub fn middle(points: &[Vec3]) -> Vec3 {
    points.iter().sum::<Vec3>() / points.len() as f64
}

/// Moves t until its first corner is at `to`.
pub fn moved(t: [Vec3; 4], to: Vec3) -> [Vec3; 4] {
    let shift = to - t[0];
    t.map(|x| x + shift)
}

pub const FAMILIES: [&str; 18] = [
    "random",
    "glancing",
    "identical",
    "an ulp apart",
    "shared corner",
    "shared edge",
    "shared face",
    "coplanar faces",
    "one in the other",
    "corner on a face",
    "edges that cross",
    "face in a kink plane",
    "sliver",
    "two slivers",
    "sliver along a face",
    "map coordinates",
    "a thousandth in size",
    "a thousandfold in size",
];

/// The last three are any of the others, moved or scaled with rounding.
pub const SHAPES: u64 = 15;

pub fn pair(family: usize, random: &mut Random) -> [[Vec3; 4]; 2] {
    let far = Vec3::new(4.5e6, 4.2e6, 4.5e6);
    let shape = if family < SHAPES as usize { family } else { random.below(SHAPES) as usize };
    let (c, t) = (random.tet(), random.tet());
    let pair = if shape < 9 { touching(shape, c, t, random) } else { contrived(shape, c, t, random) };
    match family {
        15 => pair.map(|tet| tet.map(|x| x + far)),
        16 => pair.map(|tet| tet.map(|x| x * 1e-3)),
        17 => pair.map(|tet| tet.map(|x| x * 1e3)),
        _ => pair,
    }
}

pub fn touching(shape: usize, c: [Vec3; 4], mut t: [Vec3; 4], random: &mut Random) -> [[Vec3; 4]; 2] {
    match shape {
        1 => {
            // Moved until its furthest corner is a hair's breadth within a face of the other.
            let gap = random.one_of(&[1e-15, 1e-12, 1e-9, 1e-6, 1e-3]);
            let normal = (c[1] - c[0]).cross(&(c[2] - c[0])).normalize();
            let inward = normal * normal.dot(&(c[3] - c[0])).signum();
            t.sort_by(|x, y| inward.dot(y).total_cmp(&inward.dot(x)));
            t = moved(t, middle(&c[..3]) + inward * gap);
        }
        2 => t = c,
        3 => t = c.map(|x| x.map(|v| nudged(v, random.below(3) as i64 - 1))),
        4..=6 => t[..shape - 3].copy_from_slice(&c[..shape - 3]),
        7 => {
            for x in &mut t[..3] {
                let [u, v] = [random.coordinate(), random.coordinate()];
                *x = c[0] + (c[1] - c[0]) * u + (c[2] - c[0]) * v;
            }
        }
        8 => t = c.map(|x| middle(&c) + (x - middle(&c)) * 0.25),
        _ => {}
    }
    [c, t]
}

pub fn contrived(shape: usize, c: [Vec3; 4], mut t: [Vec3; 4], random: &mut Random) -> [[Vec3; 4]; 2] {
    let mut thin = |tet: [Vec3; 4], base: [Vec3; 3]| {
        let aspect = random.one_of(&[1e-3, 1e-4, 1e-5, 1e-6]);
        [base[0], base[1], base[2], middle(&base) + aspect * (tet[3] - tet[0])]
    };
    let base = |tet: [Vec3; 4]| [tet[0], tet[1], tet[2]];
    match shape {
        9 => t = moved(t, c[0] / 2.0 + c[1] / 4.0 + c[2] / 4.0),
        10 => {
            let shift = (c[0] + c[1]) / 2.0 - (t[0] + t[1]) / 2.0;
            t = t.map(|x| x + shift);
        }
        // The plane of c₀, c₁ and the middle of the opposite edge is where λ₂ = λ₃.
        11 => (t[0], t[1], t[2]) = (c[0], c[1], middle(&c[2..])),
        12 => t = thin(t, base(t)),
        13 => return [thin(c, base(c)), thin(t, base(t))],
        _ => t = thin(t, base(c).map(|x| x * 0.75 + middle(&c[..3]) * 0.25)),
    }
    [c, t]
}
