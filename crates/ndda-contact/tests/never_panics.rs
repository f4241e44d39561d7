//! Whatever bits come in, a pair gives a finite answer or an error.
//!
//! `NDDA_CASES` sets the number of pairs (default 200 000); the same is done under a fuzzer in `fuzz/`.
#![cfg(feature = "potential")]

use ndda_contact::tet_pair::pair_forces;
use ndda_mesh::Vec3;

struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// Any bits at all, a small number, a grid point, one an ulp beside it, or the end of the range.
    fn number(&mut self, kind: u64) -> f64 {
        let small = (self.next() % 9) as f64 - 4.0;
        match (kind + self.next() % 3) % 7 {
            0 => f64::from_bits(self.next()),
            1 => small,
            2 => f64::from_bits((small + 0.5).to_bits() + self.next() % 3),
            3 => small * 1e-160,
            4 => small * 1e150,
            5 => small * f64::MIN_POSITIVE / 8.0,
            _ => small + (self.next() as f64 / u64::MAX as f64),
        }
    }
}

#[test]
fn a_pair_of_any_bits_is_answered_finitely_or_refused() {
    let cases: usize = std::env::var("NDDA_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(200_000);
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let mut answered = 0;
    for case in 0..cases {
        let kind = (case % 7) as u64;
        let mut corner = || Vec3::from_fn(|_, _| random.number(kind));
        let pair = [[corner(), corner(), corner(), corner()], [corner(), corner(), corner(), corner()]];
        let penalty = random.number(kind).abs();
        if let Ok(forces) = pair_forces(&pair[0], &pair[1], penalty) {
            answered += 1;
            let all = [forces.volume_m3, forces.energy_j].into_iter().chain(forces.force_n.iter().copied());
            assert!(
                all.chain(forces.torque_n_m.iter().copied()).all(f64::is_finite),
                "{forces:?} for {pair:?}"
            );
        }
    }
    assert!(answered > cases / 50, "only {answered} of {cases} pairs had an answer");
}
