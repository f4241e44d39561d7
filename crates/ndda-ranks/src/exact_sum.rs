//! Sums that do not depend on the order of their addends: exact, and rounded once.
//!
//! A finite number of 64 bits is an integer m 2ᵖ of at most 53 bits, in units of 2⁻¹⁰⁷⁴. Its bits are added to the limbs of a number of fixed point that spans all
//! exponents (Kulisch 1987; Neal 2015: a small superaccumulator): limb k counts 2³²ᵏ and has 64 bits, so that 2³⁰ addends fit before carries are taken. The sum of integers
//! is exact in any order; its value is the number nearest to it, ties to even, which is what the order of IEEE 754 sums would give if each were exact. One addend and the sum of two are
//! exact and rounded once anyway, and take no limbs.

/// Limbs for all exponents, and for carries beyond the largest.
const LIMBS: usize = 70;
/// Bits of a limb that its place counts.
const LIMB_BITS: u32 = 32;
/// Addends that surely fit in limbs without carries.
const MOST_ADDENDS: u32 = 1 << 30;
/// Bits of the fraction of a number of 64 bits, and its exponent where it is not finite.
const FRACTION_BITS: u32 = 52;
const NOT_FINITE: u64 = 0x7ff;

/// The sum of some numbers, the same to the last bit in whatever order they are added.
///
/// A sum beyond the largest number of 64 bits is infinite, whatever partial sums were. Infinities of one sign give that infinity, those of both signs and anything
/// that is not a number give NaN. A sum of nothing, and one that vanishes, is +0.
///
/// ```
/// use ndda_ranks::ExactSum;
///
/// let sum: ExactSum = [1e300, 1.0, -1e300].into_iter().collect();
/// assert_eq!(sum.value(), 1.0);
/// ```
#[derive(Clone, Debug)]
pub struct ExactSum {
    /// The first two addends that are not zero; `count` says how many there are, three for more, which are in the limbs.
    few: [f64; 2],
    count: u8,
    limbs: [i64; LIMBS],
    /// Limbs in use.
    first: usize,
    last: usize,
    /// Addends since carries were taken.
    addends: u32,
    /// Sum of those that are not finite.
    beyond: f64,
}

impl Default for ExactSum {
    fn default() -> Self {
        Self::new()
    }
}

impl ExactSum {
    /// Of nothing.
    pub const fn new() -> Self {
        Self { few: [0.0; 2], count: 0, limbs: [0; LIMBS], first: LIMBS, last: 0, addends: 0, beyond: 0.0 }
    }

    /// Forgets all addends.
    #[inline]
    pub fn clear(&mut self) {
        if self.count > 2 {
            if self.first <= self.last {
                self.limbs[self.first..=self.last].fill(0);
            }
            (self.first, self.last, self.addends, self.beyond) = (LIMBS, 0, 0, 0.0);
        }
        self.count = 0;
    }

    /// Adds a number.
    #[inline]
    pub fn add(&mut self, addend: f64) {
        if addend == 0.0 {
            return;
        }
        match self.count {
            0 | 1 => {
                self.few[usize::from(self.count)] = addend;
                self.count += 1;
            }
            2 => {
                self.count = 3;
                self.few.into_iter().for_each(|x| self.add_to_limbs(x));
                self.add_to_limbs(addend);
            }
            _ => self.add_to_limbs(addend),
        }
    }

    fn add_to_limbs(&mut self, addend: f64) {
        let bits = addend.to_bits();
        let exponent = bits >> FRACTION_BITS & NOT_FINITE;
        if exponent == NOT_FINITE {
            self.beyond += addend;
            return;
        }
        let fraction = bits & ((1 << FRACTION_BITS) - 1);
        // Subnormal numbers have the exponent of the smallest normal one, without its implicit leading bit.
        let (whole, place) = match exponent {
            0 => (fraction, 0),
            _ => (fraction | 1 << FRACTION_BITS, exponent as u32 - 1),
        };
        let limb = (place / LIMB_BITS) as usize;
        let shifted = u128::from(whole) << (place % LIMB_BITS);
        let sign = 1 - 2 * (bits >> 63) as i64;
        for (k, limb) in self.limbs[limb..limb + 3].iter_mut().enumerate() {
            *limb += sign * i64::from((shifted >> (LIMB_BITS * k as u32)) as u32);
        }
        (self.first, self.last) = (self.first.min(limb), self.last.max(limb + 2));
        self.addends += 1;
        if self.addends == MOST_ADDENDS {
            self.carry();
        }
    }

    /// Takes carries from limb to limb, so that each has room again; the last one keeps the sign.
    fn carry(&mut self) {
        self.addends = 0;
        let mut k = self.first;
        while k < self.last || self.limbs[k].unsigned_abs() >> LIMB_BITS != 0 {
            let limb = self.limbs[k];
            self.limbs[k] = limb & i64::from(u32::MAX);
            self.limbs[k + 1] += limb >> LIMB_BITS;
            k += 1;
            self.last = self.last.max(k);
        }
    }

    /// The number nearest to the sum, ties to even.
    pub fn value(&self) -> f64 {
        match self.count {
            0 => 0.0,
            1 => self.few[0],
            // No sum of two numbers is −0 but of two that are.
            2 => self.few[0] + self.few[1],
            _ if self.beyond != 0.0 => self.beyond,
            _ if self.first > self.last => 0.0,
            _ => self.rounded(),
        }
    }

    fn rounded(&self) -> f64 {
        let mut digits = [0; LIMBS + 2];
        let is_negative = self.write_digits(1, &mut digits);
        if is_negative {
            self.write_digits(-1, &mut digits);
        }
        let size = nearest(&digits[..self.last + 3]);
        if is_negative { -size } else { size }
    }

    /// The digits of the sum times a sign, each of 32 bits; returns whether it is negative, where they are of no use.
    fn write_digits(&self, sign: i64, digits: &mut [u32; LIMBS + 2]) -> bool {
        let mut carry = 0;
        for (digit, limb) in digits[self.first..].iter_mut().zip(&self.limbs[self.first..=self.last]) {
            let sum = sign * limb + carry;
            *digit = sum as u32;
            carry = sum >> LIMB_BITS;
        }
        digits[self.last + 1] = carry as u32;
        digits[self.last + 2] = (carry >> LIMB_BITS) as u32;
        carry < 0
    }
}

/// The number nearest to an integer with these digits of 32 bits, the least first, in units of 2⁻¹⁰⁷⁴.
fn nearest(digits: &[u32]) -> f64 {
    let Some(top) = digits.iter().rposition(|digit| *digit != 0) else { return 0.0 };
    let length = LIMB_BITS * (top as u32 + 1) - digits[top].leading_zeros();
    let Some(dropped) = length.checked_sub(FRACTION_BITS + 1).filter(|bits| *bits > 0) else {
        // As many units as the bits of the number say: a step of its exponent is one of the leading bit.
        let low = u64::from(digits[0]) | u64::from(digits.get(1).copied().unwrap_or(0)) << LIMB_BITS;
        return f64::from_bits(low);
    };
    let digit = |k: usize| u128::from(digits.get(k).copied().unwrap_or(0));
    let first = (dropped / LIMB_BITS) as usize;
    let around = digit(first) | digit(first + 1) << LIMB_BITS | digit(first + 2) << (2 * LIMB_BITS);
    let whole = (around >> (dropped % LIMB_BITS)) as u64;
    let (half, half_at) = (dropped - 1, ((dropped - 1) / LIMB_BITS) as usize);
    let is_half = digits[half_at] >> (half % LIMB_BITS) & 1 == 1;
    let below = digits[half_at] & ((1u32 << (half % LIMB_BITS)) - 1);
    let is_more = below != 0 || digits[..half_at].iter().any(|digit| *digit != 0);
    let rounded = whole + u64::from(is_half && (is_more || whole & 1 == 1));
    // The leading bit of `rounded` adds one to the exponent, and so does one that rounding has carried.
    let exponent = u64::from(dropped);
    if exponent >= NOT_FINITE {
        return f64::INFINITY;
    }
    let bits = (exponent << FRACTION_BITS) + rounded;
    f64::from_bits(bits.min(NOT_FINITE << FRACTION_BITS))
}

impl Extend<f64> for ExactSum {
    fn extend<I: IntoIterator<Item = f64>>(&mut self, addends: I) {
        addends.into_iter().for_each(|addend| self.add(addend));
    }
}

impl FromIterator<f64> for ExactSum {
    fn from_iter<I: IntoIterator<Item = f64>>(addends: I) -> Self {
        let mut sum = Self::new();
        sum.extend(addends);
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_bigint::BigInt;

    /// The sum as a decimal fraction, which the standard library reads to the nearest number: N 2⁻¹⁰⁷⁴ = N 5¹⁰⁷⁴ 10⁻¹⁰⁷⁴.
    fn slow(addends: &[f64]) -> f64 {
        let integer = |x: &f64| {
            let (bits, fraction) = (x.to_bits(), x.to_bits() << 12 >> 12);
            let exponent = bits << 1 >> 53;
            let size = match exponent {
                0 => BigInt::from(fraction),
                _ => BigInt::from(fraction + (1u64 << 52)) << (exponent - 1),
            };
            if *x < 0.0 { -size } else { size }
        };
        let sum: BigInt = addends.iter().map(integer).sum();
        let fifths = BigInt::from(5).pow(1074);
        format!("{}e-1074", sum * fifths).parse().expect("a number")
    }

    /// Random numbers by a linear congruential generator (Knuth's MMIX), upper bits first.
    struct Random(u64);

    impl Random {
        fn bits(&mut self) -> u64 {
            let mut next = || {
                self.0 =
                    self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                self.0 >> 32
            };
            next() << 32 | next()
        }

        fn below(&mut self, end: u64) -> u64 {
            self.bits() % end
        }

        /// A number with an exponent out of a range, any fraction or few bits of it, so that ties occur, and any sign.
        fn number(&mut self, exponents: std::ops::Range<u64>) -> f64 {
            let exponent = exponents.start + self.below(exponents.end - exponents.start);
            let kept = [0, 1, 2, 20, 52][self.below(5) as usize];
            let fraction = self.bits() << 12 >> 12 >> (52 - kept) << (52 - kept);
            f64::from_bits(self.bits() >> 63 << 63 | exponent << 52 | fraction)
        }

        fn shuffle(&mut self, list: &mut [f64]) {
            (1..list.len()).for_each(|i| list.swap(i, self.below(i as u64 + 1) as usize));
        }
    }

    fn check(addends: &[f64], random: &mut Random) {
        let expected = slow(addends);
        let mut list = addends.to_vec();
        let mut sum = ExactSum::new();
        for _ in 0..3 {
            random.shuffle(&mut list);
            sum.clear();
            for addend in &list {
                sum.add(*addend);
                // Carries may be taken at any time.
                if sum.count == 3 && random.below(3) == 0 {
                    sum.carry();
                }
            }
            // A twin that reads −0 is as good: a sum has the sign of zero of the order of addends otherwise.
            assert!(sum.value() == expected, "{:e} instead of {expected:e}: {list:?}", sum.value());
        }
    }

    #[test]
    fn it_is_the_number_nearest_to_the_exact_sum_in_any_order() {
        let mut random = Random(1);
        let all = [0..2047, 1000..1046, 1022..1025, 0..3, 2040..2047, 1..120];
        for round in 0..6000 {
            let exponents = all[round % all.len()].clone();
            let count = random.below(25);
            let mut addends: Vec<f64> = (0..count).map(|_| random.number(exponents.clone())).collect();
            // Most of it cancels.
            if round % 4 == 3 {
                let gone = addends.len() / 2;
                let negative: Vec<f64> = addends[..gone].iter().map(|x| -x).collect();
                addends.extend(negative);
            }
            check(&addends, &mut random);
        }
    }

    #[test]
    fn ties_go_to_even_and_less_than_half_a_unit_decides_them() {
        let (unit, mut random) = (f64::EPSILON, Random(2));
        for (addends, expected) in [
            (vec![1.0, 0.25 * unit, 0.25 * unit], 1.0),
            (vec![1.0, 0.25 * unit, 0.25 * unit, 5e-324], 1.0 + unit),
            (vec![1.0, 0.25 * unit, 0.25 * unit, -5e-324], 1.0),
            (vec![1.0 + unit, 0.25 * unit, 0.25 * unit], 1.0 + 2.0 * unit),
            (vec![f64::MAX, f64::MAX, -f64::MAX], f64::MAX),
            (vec![f64::MAX, f64::MAX, 1.0], f64::INFINITY),
            (vec![-f64::MAX, 2f64.powi(970), -2f64.powi(970), -2f64.powi(970)], f64::NEG_INFINITY),
            (vec![f64::MAX, 2f64.powi(969), 1.0], f64::MAX),
            (vec![5e-324; 3], 1.5e-323),
            (vec![f64::MIN_POSITIVE, -5e-324, -5e-324], f64::MIN_POSITIVE - 1e-323),
            (vec![1e300, -1e300, 0.0, -0.0], 0.0),
            (vec![3.0, -1.0, -2.0], 0.0),
            (vec![], 0.0),
        ] {
            check(&addends, &mut random);
            let sum = addends.iter().copied().collect::<ExactSum>().value();
            assert_eq!(sum.to_bits(), expected.to_bits(), "{addends:?}: {sum:e}");
        }
    }

    #[test]
    fn what_is_not_finite_does_not_depend_on_the_order_either() {
        let (inf, nan) = (f64::INFINITY, f64::NAN);
        for (addends, expected) in [
            (vec![inf], inf),
            (vec![1.0, inf, f64::MAX], inf),
            (vec![f64::MAX, f64::MAX, f64::MAX, -inf], -inf),
            (vec![inf, 1.0, inf], inf),
            (vec![inf, 2.0, -inf, 1.0], nan),
            (vec![inf, -inf], nan),
            (vec![1.0, nan, 2.0], nan),
            (vec![nan], nan),
        ] {
            for turn in 0..addends.len() {
                let order = addends.iter().cycle().skip(turn).take(addends.len());
                let sum = order.copied().collect::<ExactSum>().value();
                assert!(sum == expected || sum.is_nan() && expected.is_nan(), "{addends:?}: {sum}");
            }
        }
    }

    #[test]
    fn many_addends_fit_and_a_cleared_sum_is_empty() {
        let mut sum = ExactSum::new();
        for (addend, count) in [(-f64::MAX, 100_000), (f64::MAX, 100_000), (0.1, 1000), (-0.1, 999)] {
            sum.extend(std::iter::repeat_n(addend, count));
        }
        assert_eq!(sum.value(), 0.1);
        sum.clear();
        assert_eq!(sum.value().to_bits(), 0);
        sum.extend([1.0, 2.0, 3.0]);
        assert_eq!(sum.value(), 6.0);
    }
}
