//! One pair of tetrahedra against exact arithmetic, over families made to be hard.
//!
//! The corners are read as the rational numbers they are and put on a common grid. Every plane is then a row of
//! integers, every corner of a clipped face the meeting point of three planes in homogeneous integers, and every sign
//! is exact. The integral over each triangle is one quotient of integers; only that is rounded down, to 2⁻¹²⁸ of the
//! grid's unit.
//!
//! `NDDA_CASES` (or `PROPTEST_CASES`) sets the number of pairs: `NDDA_CASES=100000 cargo test --release
//! -p ndda-contact --test exact -- --nocapture` prints the worst error of each family.

mod families;
mod rational;

use std::array::from_fn;

use families::{FAMILIES, Random, middle, pair};
use ndda_contact::reference::tet_pair::{NodalForces, PairError, pair_forces};
use ndda_mesh::Vec3;
use ndda_mesh::geometry::{tet_heights, tet_volume};
use num_bigint::BigInt;
use rational::{KEPT_BITS, Plane, Tet, float, integral, minus, on_grid, potential, pressure, zero};

/// Volume over L³, energy over k L³, force over k L²: the bound for each, L the size of the larger tetrahedron.
const BOUND: f64 = 1e-12;

/// Bound of the force of the kernel that blocks use, times the smallest height over L: it rounds λ to f64.
const KERNEL_BOUND: f64 = 1e-14;

/// Pairs without `NDDA_CASES`.
const CASES: usize = 3000;

/// The force on the contactor from the kernel, near the origin and for positive volumes.
fn force_of_kernel(c: &[Vec3; 4], t: &[Vec3; 4]) -> Vec3 {
    let oriented = |tet: &[Vec3; 4]| {
        let [p, q, r, s] = tet.map(|x| x - c[0]);
        if tet_volume(tet) > 0.0 { [p, q, r, s] } else { [q, p, r, s] }
    };
    let mut forces = [[[Vec3::zeros(); 4]; 2]];
    NodalForces::default().of(&[[oriented(c), oriented(t)]], 1.0, &mut forces);
    forces[0][0].iter().sum()
}

/// Whether they overlap; the errors of volume, energy, force and the kernel's force relative to the larger tetrahedron,
/// and the last times the smallest height over L. None for a pair rightly refused as flat.
fn errors(c: &[Vec3; 4], t: &[Vec3; 4]) -> Option<(bool, [f64; 5])> {
    let ([c_grid, t_grid], exponent) = on_grid(c, t);
    let (c_exact, t_exact) = (Tet::oriented(c_grid), Tet::oriented(t_grid));
    let found = match pair_forces(c, t, 1.0) {
        Ok(found) => found,
        Err(PairError::Flat(which)) => {
            let (flat, corners) = if which == "contactor" { (&c_exact, c) } else { (&t_exact, t) };
            let volume = float(&flat.six_volumes, 3 * exponent);
            assert!(volume <= 1e-14 * size(corners).powi(3), "{corners:?} is not flat");
            return None;
        }
        Err(error) => panic!("{error} for {c:?} and {t:?}"),
    };
    let one = Plane { normal: from_fn(|_| zero()), value: BigInt::from(1) };
    let exact_volume = integral(&c_exact, &t_exact, &one, &BigInt::from(1));
    let energy = potential(&c_exact, &t_exact) + potential(&t_exact, &c_exact);
    let force = minus(&pressure(&t_exact, &c_exact), &pressure(&c_exact, &t_exact));
    let l = size(c).max(size(t));
    let off = |found: f64, expected: &BigInt, power: i32| {
        (found - float(expected, power * exponent - KEPT_BITS)).abs() / l.powi(power)
    };
    let of_force = |found: Vec3| (0..3).map(|k| off(found[k], &force[k], 2)).fold(0.0, f64::max);
    let kernel = of_force(force_of_kernel(c, t));
    let height = tet_heights(c).into_iter().chain(tet_heights(t)).fold(l, f64::min);
    let (volume, energy) = (off(found.volume_m3, &exact_volume, 3), off(found.energy_j, &energy, 3));
    let errors = [volume, energy, of_force(found.force_n), kernel, kernel * height / l];
    Some((exact_volume > zero(), errors))
}

fn size(tet: &[Vec3; 4]) -> f64 {
    let edges = (0..4).flat_map(|i| (0..i).map(move |j| (i, j)));
    edges.map(|(i, j)| (tet[i] - tet[j]).norm()).fold(0.0, f64::max)
}

/// The worst of a family: errors, each with its case.
#[derive(Clone, Copy, Default)]
struct Worst {
    pairs: usize,
    overlapping: usize,
    errors: [(f64, usize); 5],
}

impl Worst {
    fn join(&mut self, other: &Self) {
        self.pairs += other.pairs;
        self.overlapping += other.overlapping;
        for (mine, theirs) in self.errors.iter_mut().zip(other.errors) {
            *mine = if theirs.0 > mine.0 { theirs } else { *mine };
        }
    }
}

fn worst_of(cases: impl Iterator<Item = usize>) -> [Worst; FAMILIES.len()] {
    let mut worst = [Worst::default(); FAMILIES.len()];
    for case in cases {
        let [c, t] = pair(case % FAMILIES.len(), &mut Random::of_case(case));
        if let Some((overlap, errors)) = errors(&c, &t) {
            let errors = errors.map(|e| (e, case));
            let found = Worst { pairs: 1, overlapping: usize::from(overlap), errors };
            worst[case % FAMILIES.len()].join(&found);
        }
    }
    worst
}

#[test]
fn volume_energy_and_force_are_those_of_exact_arithmetic() {
    let variable = |name: &str| std::env::var(name).ok().and_then(|n| n.parse().ok());
    let cases = variable("NDDA_CASES").or_else(|| variable("PROPTEST_CASES")).unwrap_or(CASES);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut worst = [Worst::default(); FAMILIES.len()];
    std::thread::scope(|scope| {
        let start = |k| scope.spawn(move || worst_of((0..cases).filter(move |case| case % threads == k)));
        let running: Vec<_> = (0..threads).map(start).collect();
        for found in running.into_iter().map(|thread| thread.join().expect("no pair panics")) {
            worst.iter_mut().zip(&found).for_each(|(all, part)| all.join(part));
        }
    });
    for (name, Worst { pairs, overlapping, errors }) in FAMILIES.iter().zip(worst) {
        let [volume, energy, force, kernel, by_shape] = errors.map(|(error, _)| error);
        println!(
            "{name:22} {pairs:6} pairs, {overlapping:6} overlap: volume {volume:.1e}, energy {energy:.1e}, force {force:.1e};"
        );
        println!("{:22} kernel's force {kernel:.1e}, times height over size {by_shape:.1e}", "");
    }
    let measures = [("volume", BOUND), ("energy", BOUND), ("force", BOUND), ("kernel", f64::INFINITY)];
    let measures = measures.into_iter().chain([("kernel's force times height over size", KERNEL_BOUND)]);
    for (name, Worst { pairs, overlapping, errors }) in FAMILIES.iter().zip(worst) {
        assert!(
            overlapping > pairs / 8 || cases < CASES,
            "only {overlapping} of {pairs} {name} pairs overlap"
        );
        for ((what, bound), (error, case)) in measures.clone().zip(errors) {
            let [c, t] = pair(case % FAMILIES.len(), &mut Random::of_case(case));
            assert!(error <= bound, "{name}, case {case}: {what} is off by {error:e} for {c:?} and {t:?}");
        }
    }
}

#[test]
fn a_pair_of_very_unlike_sizes_has_its_volume_right_to_the_smaller_one() {
    let mut random = Random { state: 7, coarse: false };
    let mut worst = 0.0f64;
    for case in 0..300 {
        let (large, small) = (random.tet(), random.tet());
        // About a corner, an edge, a face or the middle of the larger one.
        let at = middle(&large[..1 + case % 4]);
        let tiny = small.map(|x| at + (x - middle(&small)) * 1e-6);
        if [large, tiny].iter().any(|tet| tet_volume(tet).abs() < 1e-3 * size(tet).powi(3)) {
            continue;
        }
        for (c, t) in [(large, tiny), (tiny, large)] {
            let ([c_grid, t_grid], exponent) = on_grid(&c, &t);
            let one = Plane { normal: from_fn(|_| zero()), value: BigInt::from(1) };
            let exact = integral(&Tet::oriented(c_grid), &Tet::oriented(t_grid), &one, &BigInt::from(1));
            let found = pair_forces(&c, &t, 1.0).expect("sound tetrahedra").volume_m3;
            let error = (found - float(&exact, 3 * exponent - KEPT_BITS)).abs();
            worst = worst.max(error / tet_volume(&tiny).abs());
        }
    }
    println!("largest error of the volume over that of the smaller: {worst:.1e}");
    assert!(worst <= 1e-13, "{worst:e}");
}
