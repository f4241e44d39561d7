//! One pair of tetrahedra against exact rational arithmetic, over families made to be hard.
//!
//! `NDDA_CASES` sets the number of pairs (default 240): `NDDA_CASES=100000 cargo test --release -p ndda-contact
//! --test exact -- --nocapture` prints the worst error of each family.
#![cfg(feature = "potential")]

use ndda_contact::tet_pair::pair_forces;
use ndda_mesh::Vec3;
use ndda_mesh::geometry::TET_FACES;
use num_rational::BigRational as Exact;

/// Volume over L³, energy over k L³, force over k L²: the bound for each, L the size of the larger tetrahedron.
const BOUND: f64 = 1e-12;

type Point = [Exact; 3];

fn exact(x: &Vec3) -> Point {
    [x.x, x.y, x.z].map(|v| Exact::from_float(v).expect("finite"))
}

fn number(n: i64) -> Exact {
    Exact::from_integer(n.into())
}

fn minus(a: &Point, b: &Point) -> Point {
    std::array::from_fn(|i| &a[i] - &b[i])
}

fn cross(a: &Point, b: &Point) -> Point {
    [&a[1] * &b[2] - &a[2] * &b[1], &a[2] * &b[0] - &a[0] * &b[2], &a[0] * &b[1] - &a[1] * &b[0]]
}

fn dot(a: &Point, b: &Point) -> Exact {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn float(x: &Exact) -> f64 {
    use num_bigint::BigInt;
    // Quotients of huge numbers: shift both into the range of f64 first.
    let bits = x.numer().bits().max(x.denom().bits());
    if bits < 900 {
        let part = |n: &BigInt| n.to_string().parse::<f64>().expect("a number");
        return part(x.numer()) / part(x.denom());
    }
    let shift = bits - 900;
    let part = |n: &BigInt| (n >> shift).to_string().parse::<f64>().expect("a number");
    part(x.numer()) / part(x.denom())
}

/// value + gradient · x.
#[derive(Clone)]
struct Linear {
    value: Exact,
    gradient: Point,
}

impl Linear {
    fn at(&self, x: &Point) -> Exact {
        &self.value + dot(&self.gradient, x)
    }

    fn minus(&self, other: &Self) -> Self {
        Self { value: &self.value - &other.value, gradient: minus(&self.gradient, &other.gradient) }
    }

    fn times(&self, factor: i64) -> Self {
        let f = number(factor);
        Self { value: &self.value * &f, gradient: self.gradient.clone().map(|g| g * &f) }
    }
}

/// λ₀ … λ₃ of a tetrahedron of positive volume.
fn lambdas(tet: &[Point; 4]) -> [Linear; 4] {
    std::array::from_fn(|i| {
        let [a, b, c] = TET_FACES[i].map(|k| &tet[k]);
        let normal = cross(&minus(b, a), &minus(c, a));
        let height = dot(&normal, &minus(&tet[i], a));
        let gradient = normal.map(|n| n / &height);
        Linear { value: -dot(&gradient, a), gradient }
    })
}

fn cut(polygon: Vec<Point>, side: &Linear) -> Vec<Point> {
    let sides: Vec<Exact> = polygon.iter().map(|x| side.at(x)).collect();
    let zero = number(0);
    let mut kept = Vec::new();
    for i in 0..polygon.len() {
        let j = (i + 1) % polygon.len();
        if sides[i] >= zero {
            kept.push(polygon[i].clone());
        }
        if (sides[i] < zero && sides[j] > zero) || (sides[i] > zero && sides[j] < zero) {
            let t = &sides[i] / (&sides[i] - &sides[j]);
            kept.push(std::array::from_fn(|k| &polygon[i][k] + &t * (&polygon[j][k] - &polygon[i][k])));
        }
    }
    if kept.len() < 3 { Vec::new() } else { kept }
}

/// Triangles of a fan, each with its area vector times two.
fn fan(polygon: &[Point]) -> Vec<([Point; 3], Point)> {
    let triangle = |i: usize| {
        let corners = [polygon[0].clone(), polygon[i].clone(), polygon[i + 1].clone()];
        let twice = cross(&minus(&corners[1], &corners[0]), &minus(&corners[2], &corners[0]));
        (corners, twice)
    };
    (1..polygon.len().max(2) - 1).map(triangle).collect()
}

fn face(tet: &[Point; 4], i: usize) -> Vec<Point> {
    TET_FACES[i].map(|k| tet[k].clone()).to_vec()
}

/// The face of the other tetrahedron in whose plane a polygon lies, with the same side outward or not.
fn coplanar(polygon: &[Point], other: &[Linear; 4]) -> Option<bool> {
    let zero = number(0);
    let plane = other.iter().find(|l| polygon.iter().all(|x| l.at(x) == zero))?;
    let twice = cross(&minus(&polygon[1], &polygon[0]), &minus(&polygon[2], &polygon[0]));
    Some(dot(&plane.gradient, &twice) < zero)
}

/// ∫ f dV over a ∩ b by the flux of x (value/3 + gradient·x/4), whose divergence is f.
fn integral(a: &[Point; 4], b: &[Point; 4], f: &Linear) -> Exact {
    let mut sum = number(0);
    for (owner, other, shares) in [(a, b, true), (b, a, false)] {
        let planes = lambdas(other);
        for i in 0..4 {
            // A face that both have counts once, one that they turn to each other not at all.
            match coplanar(&face(owner, i), &planes) {
                Some(same) if !(same && shares) => continue,
                _ => {}
            }
            let inside = planes.iter().fold(face(owner, i), cut);
            for (corners, twice) in fan(&inside) {
                let mean = corners.iter().map(|x| dot(&f.gradient, x)).fold(number(0), |s, v| s + v);
                let flux = &f.value / number(3) + mean / number(12);
                sum += dot(&corners[0], &twice) / number(2) * flux;
            }
        }
    }
    sum
}

/// ∫ 4 min λ dV of t's potential over c ∩ t: over c and the four tetrahedra between t's centroid and its faces.
fn potential(c: &[Point; 4], t: &[Point; 4]) -> Exact {
    let lambda = lambdas(t);
    let centroid: Point = std::array::from_fn(|k| t.iter().fold(number(0), |s, x| s + &x[k]) / number(4));
    let part = |i: usize| {
        let [p, q, r] = TET_FACES[i].map(|k| t[k].clone());
        integral(c, &[centroid.clone(), p, q, r], &lambda[i].times(4))
    };
    (0..4).map(part).fold(number(0), |s, v| s + v)
}

/// ∮ φ_t n dS over the owner's faces in t.
fn pressure(owner: &[Point; 4], t: &[Point; 4]) -> Point {
    let lambda = lambdas(t);
    let mut sum: Point = std::array::from_fn(|_| number(0));
    for i in 0..4 {
        let inside = lambda.iter().fold(face(owner, i), cut);
        for k in 0..4 {
            let rivals: Vec<(usize, Linear)> =
                (0..4).filter(|&j| j != k).map(|j| (j, lambda[j].minus(&lambda[k]))).collect();
            // A face in a kink plane belongs to one region only.
            let elsewhere =
                |(j, rival): &(usize, Linear)| *j < k && inside.iter().all(|x| rival.at(x) == number(0));
            if rivals.iter().any(elsewhere) {
                continue;
            }
            let part = rivals.iter().fold(inside.clone(), |p, (_, rival)| cut(p, rival));
            for (corners, twice) in fan(&part) {
                let mean = corners.iter().map(|x| lambda[k].at(x)).fold(number(0), |s, v| s + v) / number(3);
                for (s, n) in sum.iter_mut().zip(&twice) {
                    *s += number(2) * &mean * n;
                }
            }
        }
    }
    sum
}

/// Knuth's MMIX generator: tests need numbers that are the same everywhere, no more.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        self.0 >> 33
    }

    fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }

    /// A multiple of 1/64 in [−1, 1].
    fn coordinate(&mut self) -> f64 {
        (self.below(129) as f64 - 64.0) / 64.0
    }

    fn point(&mut self) -> Vec3 {
        Vec3::from_fn(|_, _| self.coordinate())
    }

    /// A tetrahedron that is not flat.
    fn tet(&mut self) -> [Vec3; 4] {
        loop {
            let corners = [self.point(), self.point(), self.point(), self.point()];
            if ndda_mesh::geometry::tet_volume(&corners).abs() > 0.02 {
                return corners;
            }
        }
    }
}

fn nudged(x: f64, ulps: i64) -> f64 {
    if x == 0.0 { ulps as f64 * 1e-17 } else { f64::from_bits((x.to_bits() as i64 + ulps) as u64) }
}

const FAMILIES: [&str; 12] = [
    "random",
    "glancing",
    "identical",
    "an ulp apart",
    "shared corner",
    "shared edge",
    "shared face",
    "coplanar faces",
    "one in the other",
    "face in a kink plane",
    "sliver",
    "map coordinates",
];

fn pair(family: usize, random: &mut Random) -> ([Vec3; 4], [Vec3; 4]) {
    let c = random.tet();
    let mut t = random.tet();
    let centroid = |tet: &[Vec3; 4]| tet.iter().sum::<Vec3>() / 4.0;
    match family {
        1 => {
            // Moved until a corner of one is a hair's breadth within a face of the other.
            let gap = [1e-15, 1e-12, 1e-9, 1e-6, 1e-3][random.below(5) as usize];
            let normal = (c[1] - c[0]).cross(&(c[2] - c[0])).normalize();
            let side = normal.dot(&(c[3] - c[0])).signum();
            let middle = (c[0] + c[1] + c[2]) / 3.0;
            let nearest =
                (0..4).max_by(|&i, &j| (side * normal.dot(&t[i])).total_cmp(&(side * normal.dot(&t[j]))));
            let shift = middle + normal * side * gap - t[nearest.unwrap_or(0)];
            t = t.map(|x| x + shift);
        }
        2 => t = c,
        3 => {
            t = c;
            for x in t.iter_mut().flat_map(|x| x.iter_mut()) {
                *x = nudged(*x, random.below(3) as i64 - 1);
            }
        }
        4 => t[0] = c[0],
        5 => (t[0], t[1]) = (c[0], c[1]),
        6 => (t[0], t[1], t[2]) = (c[0], c[1], c[2]),
        7 => {
            for x in t.iter_mut().take(3) {
                let [u, v] = [random.coordinate(), random.coordinate()];
                *x = c[0] + (c[1] - c[0]) * u + (c[2] - c[0]) * v;
            }
        }
        8 => t = c.map(|x| centroid(&c) + (x - centroid(&c)) * 0.25),
        9 => {
            // The plane of c₀, c₁ and the middle of the opposite edge is where λ₂ = λ₃.
            let middle = (c[2] + c[3]) / 2.0;
            (t[0], t[1], t[2]) = (c[0], c[1], middle);
        }
        10 => {
            let thin = [1e-3, 1e-4, 1e-6][random.below(3) as usize];
            t[3] = (t[0] + t[1] + t[2]) / 3.0 + thin * (t[3] - t[0]);
        }
        11 => {
            let far = Vec3::new(4.5e6, 4.2e6, 1e3);
            return (c.map(|x| x + far), t.map(|x| x + far));
        }
        _ => {}
    }
    (c, t)
}

fn size(tet: &[Vec3; 4]) -> f64 {
    (0..4)
        .flat_map(|i| (0..i).map(move |j| (i, j)))
        .map(|(i, j)| (tet[i] - tet[j]).norm())
        .fold(0.0, f64::max)
}

/// Errors of volume, energy and force relative to the larger tetrahedron; none for a flat one.
fn errors(c: &[Vec3; 4], t: &[Vec3; 4]) -> Option<[f64; 3]> {
    let found = pair_forces(c, t, 1.0).ok()?;
    let oriented = |tet: &[Vec3; 4]| {
        let tet = tet.map(|x| exact(&x));
        let [p, q, r, s] = [0, 1, 2, 3].map(|i| &tet[i]);
        let volume = dot(&minus(q, p), &cross(&minus(r, p), &minus(s, p)));
        if volume > number(0) { tet.clone() } else { [q, p, r, s].map(Clone::clone) }
    };
    let (c_exact, t_exact) = (oriented(c), oriented(t));
    let one = Linear { value: number(1), gradient: std::array::from_fn(|_| number(0)) };
    let volume = integral(&c_exact, &t_exact, &one);
    let energy = potential(&c_exact, &t_exact) + potential(&t_exact, &c_exact);
    let force = minus(&pressure(&t_exact, &c_exact), &pressure(&c_exact, &t_exact));
    let l = size(c).max(size(t));
    let off = |found: f64, expected: &Exact, scale: f64| (found - float(expected)).abs() / scale;
    let of_force = (0..3).map(|k| off(found.force_n[k], &force[k], l * l)).fold(0.0, f64::max);
    let l3 = l * l * l;
    Some([off(found.volume_m3, &volume, l3), off(found.energy_j, &energy, l3), of_force])
}

#[test]
fn volume_energy_and_force_are_those_of_exact_arithmetic() {
    let cases: usize = std::env::var("NDDA_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(240);
    let mut random = Random(20_261_121);
    let mut worst = [[0.0f64; 3]; FAMILIES.len()];
    let mut pairs = [0; FAMILIES.len()];
    for case in 0..cases {
        let family = case % FAMILIES.len();
        let (c, t) = pair(family, &mut random);
        let Some(errors) = errors(&c, &t) else { continue };
        pairs[family] += 1;
        for (w, e) in worst[family].iter_mut().zip(errors) {
            assert!(e <= BOUND, "{}: {errors:?} for {c:?} and {t:?}", FAMILIES[family]);
            *w = w.max(e);
        }
    }
    for (name, (worst, pairs)) in FAMILIES.iter().zip(worst.iter().zip(pairs)) {
        println!(
            "{name:22} {pairs:7} pairs: volume {:.1e}, energy {:.1e}, force {:.1e}",
            worst[0], worst[1], worst[2]
        );
        assert!(pairs > 0, "no {name} pair had an answer");
    }
}
