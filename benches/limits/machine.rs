//! Rates of the machine: arithmetic operations in registers, and bytes read from memory.

use std::hint::black_box;
use std::time::Instant;

use pulp::{Arch, Simd, WithSimd};

use crate::{header, row};

/// Chains of operations that do not wait for each other, more than any processor needs to be busy.
const CHAINS: usize = 12;
/// Rounds of a measurement.
const ROUNDS: usize = 4096;
/// Seconds that a measurement is repeated for.
const REPEATED_S: f64 = 0.3;
/// Bytes of each array of the triad, far more than any cache.
const LARGE: usize = 1 << 27;

/// How times are taken.
pub struct Clock {
    /// Whether times matter; else everything is done once.
    pub measured: bool,
}

impl Clock {
    /// Least time that `run` takes [ns].
    pub fn least_ns(&self, mut run: impl FnMut()) -> f64 {
        let (begin, mut least) = (Instant::now(), f64::INFINITY);
        loop {
            let start = Instant::now();
            run();
            least = least.min(start.elapsed().as_secs_f64());
            if !self.measured || begin.elapsed().as_secs_f64() > REPEATED_S {
                return 1e9 * least;
            }
        }
    }
}

/// Most operations per nanosecond, which is 1e9 a second.
pub struct Rates {
    /// Products and sums fused to one instruction.
    pub fused: f64,
    /// Products and sums, each rounded: what code with the same bits on every processor can do.
    pub separate: f64,
}

/// The rates of this machine, printed as a table.
pub fn rates(clock: &Clock) -> Rates {
    let rate = |fused| {
        let mut operations = 0;
        let ns = clock.least_ns(|| operations = Arch::new().dispatch(Chains { fused }).1);
        operations as f64 / ns
    };
    let rates = Rates { fused: rate(true), separate: rate(false) };
    header("machine", &["what the machine does", "rate"]);
    let say = |what: &str, rate: String| row("machine", &[what.into(), rate]);
    say("products and sums, fused", format!("{:.1} GFLOP/s", rates.fused));
    say("products and sums, each rounded", format!("{:.1} GFLOP/s", rates.separate));
    let bytes = if clock.measured { LARGE } else { 1 << 16 };
    say("STREAM's triad, a ← b + s c, from memory", format!("{:.1} GB/s", triad_gb_s(clock, bytes)));
    say("reading, from memory", format!("{:.1} GB/s", read_gb_s(clock, bytes)));
    rates
}

/// Products and sums on numbers that stay in registers; gives their sum, so that they are done, and how many there were.
struct Chains {
    fused: bool,
}

impl WithSimd for Chains {
    type Output = (f64, usize);

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> (f64, usize) {
        let (a, b) = (simd.splat_f64s(black_box(0.999)), simd.splat_f64s(black_box(1e-3)));
        let mut x = [simd.splat_f64s(1.0); CHAINS];
        for _ in 0..ROUNDS {
            for x in &mut x {
                *x = if self.fused {
                    simd.mul_add_f64s(*x, a, b)
                } else {
                    simd.add_f64s(simd.mul_f64s(*x, a), b)
                };
            }
        }
        let sum = x.into_iter().map(|x| simd.reduce_sum_f64s(x)).sum();
        (black_box(sum), 2 * CHAINS * ROUNDS * S::F64_LANES)
    }
}

/// A bare read of numbers.
struct Read<'a>(&'a [f64]);

impl WithSimd for Read<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let (body, _) = S::as_simd_f64s(self.0);
        let mut sums = [simd.splat_f64s(0.0); CHAINS];
        for numbers in body.chunks_exact(CHAINS) {
            for (sum, &x) in sums.iter_mut().zip(numbers) {
                *sum = simd.add_f64s(*sum, x);
            }
        }
        sums.into_iter().map(|sum| simd.reduce_sum_f64s(sum)).sum()
    }
}

/// Rate at which so many bytes are read again and again [GB/s].
pub fn read_gb_s(clock: &Clock, bytes: usize) -> f64 {
    let numbers = vec![1.0; bytes / 8];
    let arch = Arch::new();
    // Several reads of a few bytes, so that the clock does not count.
    let times = (1usize << 20).div_ceil(bytes).max(1);
    let ns =
        clock.least_ns(|| (0..times).for_each(|_| _ = black_box(arch.dispatch(Read(black_box(&numbers))))));
    (times * bytes) as f64 / ns
}

/// Rate of a ← b + s c, read and written bytes together [GB/s].
fn triad_gb_s(clock: &Clock, bytes: usize) -> f64 {
    let (mut a, b, c) = (vec![0.0; bytes / 8], vec![1.0; bytes / 8], vec![2.0; bytes / 8]);
    let s = black_box(3.0);
    let ns = clock.least_ns(|| {
        a.iter_mut().zip(&b).zip(&c).for_each(|((a, b), c): ((&mut f64, &f64), &f64)| *a = b + s * c);
        black_box(&mut a);
    });
    (3 * bytes) as f64 / ns
}
