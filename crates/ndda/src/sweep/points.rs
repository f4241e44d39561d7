//! Points of the unit cube: Latin hypercube and Sobol' points, the same ones for the same seed.

use ndda_io::study::Sampling;

/// Numbers of a point that Sobol' sequences are known for here.
pub const MOST_DIMENSIONS: usize = 21;

/// Bits of a coordinate.
const BITS: usize = 32;

/// Primitive polynomials and initial direction numbers of the dimensions from 2 on: degree, coefficients, numbers. From the file
/// new-joe-kuo-6.21201 of Joe & Kuo, "Constructing Sobol sequences with better two-dimensional projections", SIAM J. Sci.
/// Comput. 30 (2008) 2635–2654.
const DIRECTIONS: [(usize, u32, &[u32]); MOST_DIMENSIONS - 1] = [
    (1, 0, &[1]),
    (2, 1, &[1, 3]),
    (3, 1, &[1, 3, 1]),
    (3, 2, &[1, 1, 1]),
    (4, 1, &[1, 1, 3, 3]),
    (4, 4, &[1, 3, 5, 13]),
    (5, 2, &[1, 1, 5, 5, 17]),
    (5, 4, &[1, 1, 5, 5, 5]),
    (5, 7, &[1, 1, 7, 11, 19]),
    (5, 11, &[1, 1, 5, 1, 1]),
    (5, 13, &[1, 1, 1, 3, 11]),
    (5, 14, &[1, 3, 5, 5, 31]),
    (6, 1, &[1, 3, 3, 9, 7, 49]),
    (6, 13, &[1, 1, 1, 15, 21, 21]),
    (6, 16, &[1, 3, 1, 13, 27, 49]),
    (6, 19, &[1, 1, 1, 15, 7, 5]),
    (6, 22, &[1, 3, 1, 15, 13, 25]),
    (6, 25, &[1, 1, 5, 5, 19, 61]),
    (7, 1, &[1, 3, 7, 11, 23, 15, 103]),
    (7, 4, &[1, 3, 7, 13, 13, 15, 69]),
];

/// `count` points with `dimensions` coordinates in (0, 1); at most [`MOST_DIMENSIONS`] of Sobol' points.
pub fn points(sampling: Sampling, count: usize, dimensions: usize, seed: u64) -> Vec<Vec<f64>> {
    match sampling {
        Sampling::LatinHypercube => latin_hypercube(count, dimensions, seed),
        Sampling::Sobol => shifted_sobol(count, dimensions, seed),
    }
}

/// SplitMix64 (Steele, Lea & Flood 2014).
struct Stream(u64);

impl Stream {
    fn new(seed: u64, dimension: usize) -> Self {
        let mut first = Self(seed);
        Self(first.bits() ^ (dimension as u64).wrapping_mul(0xd1b5_4a32_d192_ed03))
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In (0, 1).
    fn uniform(&mut self) -> f64 {
        ((self.bits() >> 11) as f64 + 0.5) * 2f64.powi(-53)
    }

    /// Below `n`.
    fn below(&mut self, n: usize) -> usize {
        ((u128::from(self.bits()) * n as u128) >> 64) as usize
    }
}

/// Latin hypercube: each of `count` equal strata of each coordinate has one point (McKay, Beckman & Conover 1979).
fn latin_hypercube(count: usize, dimensions: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut points = vec![vec![0.0; dimensions]; count];
    for dimension in 0..dimensions {
        let mut stream = Stream::new(seed, dimension);
        let mut strata: Vec<usize> = (0..count).collect();
        for i in (1..count).rev() {
            strata.swap(i, stream.below(i + 1));
        }
        for (point, stratum) in points.iter_mut().zip(strata) {
            point[dimension] = (stratum as f64 + stream.uniform()) / count as f64;
        }
    }
    points
}

/// Sobol' points whose bits are flipped where those of a random number per coordinate are set, so that they depend on the seed and
/// each is as probable as any other (a digital shift); every coordinate is in the middle of its cell of 2⁻³².
fn shifted_sobol(count: usize, dimensions: usize, seed: u64) -> Vec<Vec<f64>> {
    let columns: Vec<Vec<u32>> = (0..dimensions).map(|dimension| sobol(count, dimension)).collect();
    let shifts: Vec<u32> =
        (0..dimensions).map(|dimension| (Stream::new(seed, dimension).bits() >> 32) as u32).collect();
    let coordinate = |bits: u32| (f64::from(bits) + 0.5) * 2f64.powi(-(BITS as i32));
    let point =
        |i: usize| columns.iter().zip(&shifts).map(|(column, shift)| coordinate(column[i] ^ shift)).collect();
    (0..count).map(point).collect()
}

/// One coordinate of the first Sobol' points, times 2³², in the order of Antonov & Saleev (1979).
fn sobol(count: usize, dimension: usize) -> Vec<u32> {
    let directions = directions(dimension);
    let mut value = 0;
    let mut values = Vec::with_capacity(count);
    for i in 0..count as u64 {
        values.push(value);
        value ^= directions[(i.trailing_ones() as usize).min(BITS - 1)];
    }
    values
}

fn directions(dimension: usize) -> [u32; BITS] {
    let mut v = [0; BITS];
    if dimension == 0 {
        v.iter_mut().enumerate().for_each(|(i, v)| *v = 1 << (BITS - 1 - i));
        return v;
    }
    let (degree, coefficients, initial) = DIRECTIONS[dimension - 1];
    for (i, m) in initial.iter().enumerate() {
        v[i] = m << (BITS - 1 - i);
    }
    for i in degree..BITS {
        v[i] = v[i - degree] ^ (v[i - degree] >> degree);
        for k in 1..degree {
            if (coefficients >> (degree - 1 - k)) & 1 == 1 {
                v[i] ^= v[i - k];
            }
        }
    }
    v
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_latin_hypercube_has_one_sample_in_each_stratum_of_each_coordinate() {
        for (count, seed) in [(1, 0), (7, 1), (100, 2)] {
            let points = points(Sampling::LatinHypercube, count, 5, seed);
            for dimension in 0..5 {
                let mut strata: Vec<usize> =
                    points.iter().map(|p| (p[dimension] * count as f64) as usize).collect();
                strata.sort_unstable();
                assert_eq!(strata, (0..count).collect::<Vec<_>>());
            }
        }
    }

    #[test]
    fn the_first_sobol_points_are_the_published_ones() {
        // Joe & Kuo's example program, `sobol 10 3 new-joe-kuo-6.21201`.
        let expected = [
            [0.0, 0.0, 0.0],
            [0.5, 0.5, 0.5],
            [0.75, 0.25, 0.25],
            [0.25, 0.75, 0.75],
            [0.375, 0.375, 0.625],
            [0.875, 0.875, 0.125],
            [0.625, 0.125, 0.875],
            [0.125, 0.625, 0.375],
            [0.1875, 0.3125, 0.9375],
            [0.6875, 0.8125, 0.4375],
        ];
        for dimension in 0..3 {
            let found: Vec<f64> =
                sobol(10, dimension).iter().map(|&bits| f64::from(bits) / 2f64.powi(32)).collect();
            assert_eq!(found, expected.map(|point| point[dimension]));
        }
    }

    #[test]
    fn sobol_points_fill_every_coordinate_evenly_whatever_the_shift() {
        for (dimension, seed) in (0..MOST_DIMENSIONS).zip(0..) {
            let points = points(Sampling::Sobol, 256, dimension + 1, seed);
            let mut cells: Vec<usize> = points.iter().map(|p| (p[dimension] * 256.0) as usize).collect();
            cells.sort_unstable();
            assert_eq!(cells, (0..256).collect::<Vec<_>>(), "dimension {}", dimension + 1);
        }
    }

    #[test]
    fn the_seed_decides_the_points() {
        for sampling in [Sampling::LatinHypercube, Sampling::Sobol] {
            assert_eq!(points(sampling, 20, 3, 7), points(sampling, 20, 3, 7));
            assert_ne!(points(sampling, 20, 3, 7), points(sampling, 20, 3, 8));
        }
    }
}
