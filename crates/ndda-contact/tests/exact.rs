//! One pair of tetrahedra against exact arithmetic, over families made to be hard.
//!
//! The corners are read as the rational numbers they are and put on a common grid. Every plane is then a row of
//! integers, every corner of a clipped face the meeting point of three planes in homogeneous integers, and every sign
//! is exact. The integral over each triangle is one quotient of integers; only that is rounded down, to 2⁻¹²⁸ of the
//! grid's unit.
//!
//! `NDDA_CASES` (or `PROPTEST_CASES`) sets the number of pairs: `NDDA_CASES=100000 cargo test --release
//! -p ndda-contact --test exact -- --nocapture` prints the worst error of each family.
#![cfg(feature = "potential")]

use std::array::from_fn;

use ndda_contact::reference::tet_pair::{NodalForces, PairError, pair_forces};
use ndda_mesh::Vec3;
use ndda_mesh::geometry::{TET_FACES, tet_heights, tet_volume};
use num_bigint::{BigInt, Sign};

/// Volume over L³, energy over k L³, force over k L²: the bound for each, L the size of the larger tetrahedron.
const BOUND: f64 = 1e-12;

/// The same for the force of the kernel that blocks use, times the smallest height over L: it rounds λ to f64.
const KERNEL_BOUND: f64 = 1e-14;

/// Pairs without `NDDA_CASES`.
const CASES: usize = 3000;

/// Bits below the grid's unit that sums keep.
const KEPT_BITS: i32 = 128;

/// Whole numbers of the grid's unit.
type Point = [BigInt; 3];

fn minus(a: &Point, b: &Point) -> Point {
    from_fn(|i| &a[i] - &b[i])
}

fn cross(a: &Point, b: &Point) -> Point {
    [&a[1] * &b[2] - &a[2] * &b[1], &a[2] * &b[0] - &a[0] * &b[2], &a[0] * &b[1] - &a[1] * &b[0]]
}

fn dot(a: &Point, b: &Point) -> BigInt {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn zero() -> BigInt {
    BigInt::from(0)
}

/// A point x/w, w > 0.
#[derive(Clone)]
struct Corner {
    x: Point,
    w: BigInt,
}

/// normal · x + value.
#[derive(Clone)]
struct Plane {
    normal: Point,
    value: BigInt,
}

impl Plane {
    /// w times the value at a corner: it has the sign of the value.
    fn at(&self, corner: &Corner) -> BigInt {
        dot(&self.normal, &corner.x) + &self.value * &corner.w
    }

    fn holds(&self, points: &[&Point]) -> bool {
        points.iter().all(|x| dot(&self.normal, x) + &self.value == zero())
    }
}

/// Where three planes meet, by Cramer's rule.
fn meeting([f, g, h]: [&Plane; 3]) -> Corner {
    let [gh, hf, fg] = [(g, h), (h, f), (f, g)].map(|(a, b)| cross(&a.normal, &b.normal));
    let w = dot(&f.normal, &gh);
    let x: Point = from_fn(|k| -(&f.value * &gh[k] + &g.value * &hf[k] + &h.value * &fg[k]));
    if w.sign() == Sign::Minus { Corner { x: x.map(|x| -x), w: -w } } else { Corner { x, w } }
}

/// A tetrahedron of positive volume; `planes[i]` / `six_volumes` is λᵢ.
struct Tet {
    corners: [Point; 4],
    planes: [Plane; 4],
    six_volumes: BigInt,
}

impl Tet {
    fn new(corners: [Point; 4]) -> Self {
        let planes = TET_FACES.map(|face| {
            let [a, b, c] = face.map(|i| &corners[i]);
            let outward = cross(&minus(b, a), &minus(c, a));
            Plane { value: dot(&outward, a), normal: outward.map(|n| -n) }
        });
        let [p, q, r, s] = &corners;
        let six_volumes = dot(&minus(q, p), &cross(&minus(r, p), &minus(s, p)));
        Self { planes, six_volumes, corners }
    }

    /// The same with its first two corners swapped if its volume is negative.
    fn oriented(corners: [Point; 4]) -> Self {
        let tet = Self::new(corners);
        if tet.six_volumes.sign() != Sign::Minus {
            return tet;
        }
        let [p, q, r, s] = tet.corners;
        Self::new([q, p, r, s])
    }

    /// The part where λᵢ is the smallest: its corner i is the centroid, and its λᵢ is φ.
    fn region(&self, i: usize) -> Self {
        let mut corners = self.corners.clone();
        // The grid has been refined fourfold, so the quotient is whole.
        corners[i] = from_fn(|k| self.corners.iter().map(|x| &x[k]).sum::<BigInt>() / 4);
        Self::new(corners)
    }

    fn face_points(&self, i: usize) -> [&Point; 3] {
        TET_FACES[i].map(|k| &self.corners[k])
    }

    /// Face i, with the plane of the face beyond each edge.
    fn face(&self, i: usize) -> Polygon<'_> {
        let rim = from_fn::<_, 3, _>(|k| {
            let corner = Corner { x: self.corners[TET_FACES[i][k]].clone(), w: BigInt::from(1) };
            (corner, &self.planes[TET_FACES[i][(k + 2) % 3]])
        });
        Polygon { plane: &self.planes[i], rim: rim.to_vec() }
    }

    /// The index of the face in whose plane a face of another tetrahedron lies, and whether both look the same way.
    fn coplanar(&self, other: &Self, face: usize) -> Option<(usize, bool)> {
        let j = (0..4).find(|&j| self.planes[j].holds(&other.face_points(face)))?;
        Some((j, dot(&self.planes[j].normal, &other.planes[face].normal) > zero()))
    }

    fn clip<'a>(&'a self, polygon: Polygon<'a>) -> Polygon<'a> {
        self.planes.iter().fold(polygon, Polygon::cut)
    }
}

/// A convex polygon of a plane: corners in order, each with a plane through the edge to the next.
struct Polygon<'a> {
    plane: &'a Plane,
    rim: Vec<(Corner, &'a Plane)>,
}

impl<'a> Polygon<'a> {
    /// The part where `side` ≥ 0.
    fn cut(self, side: &'a Plane) -> Self {
        let signs: Vec<Sign> = self.rim.iter().map(|(corner, _)| side.at(corner).sign()).collect();
        let mut rim = Vec::new();
        for (i, (corner, edge)) in self.rim.iter().enumerate() {
            match (signs[i], signs[(i + 1) % signs.len()]) {
                (Sign::Minus, Sign::Plus) => rim.push((meeting([self.plane, edge, side]), *edge)),
                (Sign::Minus, _) => {}
                (Sign::NoSign, Sign::Minus) => rim.push((corner.clone(), side)),
                (Sign::Plus, Sign::Minus) => {
                    rim.push((corner.clone(), *edge));
                    rim.push((meeting([self.plane, edge, side]), side));
                }
                _ => rim.push((corner.clone(), *edge)),
            }
        }
        if rim.len() < 3 {
            rim.clear();
        }
        Self { rim, ..self }
    }

    fn fan(&self) -> impl Iterator<Item = [&Corner; 3]> {
        let corner = |i: usize| &self.rim[i].0;
        (1..self.rim.len().max(2) - 1).map(move |i| [corner(0), corner(i), corner(i + 1)])
    }
}

fn fixed(numerator: BigInt, denominator: &BigInt) -> BigInt {
    (numerator << KEPT_BITS) / denominator
}

/// Σ f/w over three corners times w₀ w₁ w₂, and w₀ w₁ w₂.
fn sum_of(f: &Plane, [a, b, c]: [&Corner; 3]) -> (BigInt, BigInt) {
    let (bc, ca, ab) = (&b.w * &c.w, &c.w * &a.w, &a.w * &b.w);
    (f.at(a) * &bc + f.at(b) * ca + f.at(c) * ab, &a.w * bc)
}

/// ∫ f/scale dV over a ∩ b by the flux of x (value/3 + gradient·x/4), whose divergence is f.
fn integral(a: &Tet, b: &Tet, f: &Plane, scale: &BigInt) -> BigInt {
    let mut sum = zero();
    for (owner, other, shares) in [(a, b, true), (b, a, false)] {
        for i in 0..4 {
            // A face that both have counts once, one that they turn to each other not at all.
            if other.coplanar(owner, i).is_some_and(|(_, same)| !(same && shares)) {
                continue;
            }
            for corners in other.clip(owner.face(i)).fan() {
                let [x, y, z] = corners.map(|c| &c.x);
                let (at_corners, w) = sum_of(f, corners);
                let flux = dot(x, &cross(y, z)) * (&f.value * &w + at_corners);
                sum += fixed(flux, &(&w * &w * scale * 24));
            }
        }
    }
    sum
}

/// ∫ φ_t dV over c ∩ t.
fn potential(c: &Tet, t: &Tet) -> BigInt {
    let part = |i: usize| {
        let region = t.region(i);
        integral(c, &region, &region.planes[i], &region.six_volumes)
    };
    (0..4).map(part).sum()
}

/// ∮ φ_t n dS over the owner's faces in t; n dS is the area vector of a piece.
fn pressure(owner: &Tet, t: &Tet) -> Point {
    let mut sum: Point = from_fn(|_| zero());
    for i in 0..4 {
        let region = t.region(i);
        for face in 0..4 {
            // A face in the plane between two regions belongs to one of them only.
            if region.coplanar(owner, face).is_some_and(|(j, _)| j < i) {
                continue;
            }
            for corners in region.clip(owner.face(face)).fan() {
                let (phi, w) = sum_of(&region.planes[i], corners);
                let scale = &w * &w * &region.six_volumes * 6;
                let [a, b, c] = corners;
                let turns = [(a, b, c), (b, c, a), (c, a, b)].map(|(p, q, r)| (cross(&p.x, &q.x), &r.w));
                for (k, sum) in sum.iter_mut().enumerate() {
                    let twice: BigInt = turns.iter().map(|(turn, w)| &turn[k] * *w).sum();
                    *sum += fixed(twice * &phi, &scale);
                }
            }
        }
    }
    sum
}

/// v = n 2^exponent with n odd, or nothing times one.
fn odd_and_exponent(v: f64) -> (i64, i32) {
    assert!(v.is_finite());
    if v == 0.0 {
        return (0, 0);
    }
    let digits = v.to_bits() & ((1 << 52) - 1);
    let (n, exponent) = match ((v.to_bits() >> 52) & 0x7ff) as i32 {
        0 => (digits as i64, -1074),
        biased => ((digits | (1 << 52)) as i64, biased - 1075),
    };
    let zeros = n.trailing_zeros();
    (if v < 0.0 { -(n >> zeros) } else { n >> zeros }, exponent + zeros as i32)
}

/// Corners on a common grid with the origin at the first, refined fourfold, and the binary exponent of its unit.
fn on_grid(c: &[Vec3; 4], t: &[Vec3; 4]) -> ([[Point; 4]; 2], i32) {
    let all = || c.iter().chain(t).flat_map(|x| x.iter());
    let unit = all().map(|&v| odd_and_exponent(v).1).min().expect("corners").min(0) - 2;
    let whole = |x: &Vec3| {
        [x.x, x.y, x.z].map(|v| {
            let (n, exponent) = odd_and_exponent(v);
            BigInt::from(n) << (exponent - unit)
        })
    };
    let origin = whole(&c[0]);
    let local = |tet: &[Vec3; 4]| from_fn(|i| minus(&whole(&tet[i]), &origin));
    ([local(c), local(t)], unit)
}

/// n 2^exponent as a float, to an ulp or two.
fn float(n: &BigInt, exponent: i32) -> f64 {
    let excess = n.bits().saturating_sub(64);
    let head = (n.magnitude() >> excess).iter_u64_digits().next().unwrap_or(0) as f64;
    let size = head * 2f64.powi(exponent + excess as i32);
    if n.sign() == Sign::Minus { -size } else { size }
}

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

/// Knuth's MMIX generator: tests need numbers that are the same everywhere, no more.
struct Random {
    state: u64,
    /// Corners are multiples of 1/64, so that degenerate pairs are exactly so; else of 2⁻⁵².
    coarse: bool,
}

impl Random {
    fn of_case(case: usize) -> Self {
        let mut random = Self { state: 20_261_121 + case as u64, coarse: false };
        (0..4).for_each(|_| {
            random.next();
        });
        random.coarse = random.below(3) == 0;
        random
    }

    fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        let mixed = (self.state ^ (self.state >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed ^ (mixed >> 32)
    }

    fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }

    fn one_of(&mut self, choices: &[f64]) -> f64 {
        choices[self.below(choices.len() as u64) as usize]
    }

    /// In [−1, 1].
    fn coordinate(&mut self) -> f64 {
        if self.coarse {
            return (self.below(129) as f64 - 64.0) / 64.0;
        }
        (self.next() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn point(&mut self) -> Vec3 {
        Vec3::from_fn(|_, _| self.coordinate())
    }

    /// A tetrahedron that is not flat.
    fn tet(&mut self) -> [Vec3; 4] {
        loop {
            let corners = from_fn(|_| self.point());
            if tet_volume(&corners).abs() > 0.02 {
                return corners;
            }
        }
    }
}

fn nudged(x: f64, ulps: i64) -> f64 {
    if x == 0.0 { ulps as f64 * 1e-17 } else { f64::from_bits((x.to_bits() as i64 + ulps) as u64) }
}

fn middle(points: &[Vec3]) -> Vec3 {
    points.iter().sum::<Vec3>() / points.len() as f64
}

/// Moves t until its first corner is at `to`.
fn moved(t: [Vec3; 4], to: Vec3) -> [Vec3; 4] {
    let shift = to - t[0];
    t.map(|x| x + shift)
}

const FAMILIES: [&str; 18] = [
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
const SHAPES: u64 = 15;

fn pair(family: usize, random: &mut Random) -> [[Vec3; 4]; 2] {
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

fn touching(shape: usize, c: [Vec3; 4], mut t: [Vec3; 4], random: &mut Random) -> [[Vec3; 4]; 2] {
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

fn contrived(shape: usize, c: [Vec3; 4], mut t: [Vec3; 4], random: &mut Random) -> [[Vec3; 4]; 2] {
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
