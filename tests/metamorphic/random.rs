//! Random numbers of a seed: SplitMix64 (Steele, Lea & Flood 2014), the same on every machine.

/// A stream of random numbers.
pub struct Random(u64);

impl Random {
    /// The stream of a seed; neighbouring seeds have unrelated streams.
    pub fn new(seed: u64) -> Self {
        let mut random = Self(seed ^ 0x6a09_e667_f3bc_c908);
        random.next();
        random
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform between two numbers, with few digits, so that scenes can be read.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        few_digits(low + (high - low) * self.unit())
    }

    /// Uniform in the logarithm between two positive numbers.
    pub fn decades(&mut self, low: f64, high: f64) -> f64 {
        few_digits((low.ln() + (high / low).ln() * self.unit()).exp())
    }

    /// A whole number from `low` to `high`, both included.
    pub fn whole(&mut self, low: u32, high: u32) -> u32 {
        low + (self.next() % u64::from(high - low + 1)) as u32
    }

    /// True in this part of all cases.
    pub fn happens(&mut self, part: f64) -> bool {
        self.unit() < part
    }

    /// One of several.
    pub fn one_of<'a, T>(&mut self, all: &'a [T]) -> &'a T {
        &all[self.whole(0, all.len() as u32 - 1) as usize]
    }

    /// A vector whose components are uniform in [−size, size].
    pub fn vector(&mut self, size: f64) -> [f64; 3] {
        [0; 3].map(|_| self.between(-size, size))
    }
}

/// A number rounded to four digits.
pub fn few_digits(x: f64) -> f64 {
    format!("{x:.3e}").parse().expect("a number")
}
