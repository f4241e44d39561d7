//! Tetrahedra of whole numbers: planes, clipped faces and the integrals over them, all exact.

use std::array::from_fn;

use ndda_mesh::Vec3;
use ndda_mesh::geometry::TET_FACES;
use num_bigint::{BigInt, Sign};

/// Bits below the grid's unit that sums keep.
pub const KEPT_BITS: i32 = 128;

/// Whole numbers of the grid's unit.
pub type Point = [BigInt; 3];

pub fn minus(a: &Point, b: &Point) -> Point {
    from_fn(|i| &a[i] - &b[i])
}

pub fn cross(a: &Point, b: &Point) -> Point {
    [&a[1] * &b[2] - &a[2] * &b[1], &a[2] * &b[0] - &a[0] * &b[2], &a[0] * &b[1] - &a[1] * &b[0]]
}

pub fn dot(a: &Point, b: &Point) -> BigInt {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub fn zero() -> BigInt {
    BigInt::from(0)
}

/// A point x/w, w > 0.
#[derive(Clone)]
pub struct Corner {
    pub x: Point,
    pub w: BigInt,
}

/// normal · x + value.
#[derive(Clone)]
pub struct Plane {
    pub normal: Point,
    pub value: BigInt,
}

impl Plane {
    /// w times the value at a corner: it has the sign of the value.
    pub fn at(&self, corner: &Corner) -> BigInt {
        dot(&self.normal, &corner.x) + &self.value * &corner.w
    }

    pub fn holds(&self, points: &[&Point]) -> bool {
        points.iter().all(|x| dot(&self.normal, x) + &self.value == zero())
    }
}

/// Where three planes meet, by Cramer's rule.
pub fn meeting([f, g, h]: [&Plane; 3]) -> Corner {
    let [gh, hf, fg] = [(g, h), (h, f), (f, g)].map(|(a, b)| cross(&a.normal, &b.normal));
    let w = dot(&f.normal, &gh);
    let x: Point = from_fn(|k| -(&f.value * &gh[k] + &g.value * &hf[k] + &h.value * &fg[k]));
    if w.sign() == Sign::Minus { Corner { x: x.map(|x| -x), w: -w } } else { Corner { x, w } }
}

/// A tetrahedron of positive volume; `planes[i]` / `six_volumes` is λᵢ.
pub struct Tet {
    pub corners: [Point; 4],
    pub planes: [Plane; 4],
    pub six_volumes: BigInt,
}

impl Tet {
    pub fn new(corners: [Point; 4]) -> Self {
        let planes = TET_FACES.map(|face| {
            let [a, b, c] = face.map(|i| &corners[i]);
            let outward = cross(&minus(b, a), &minus(c, a));
            Plane { value: dot(&outward, a), normal: outward.map(|n| -n) }
        });
        let [p, q, r, s] = &corners;
        let six_volumes = dot(&minus(q, p), &cross(&minus(r, p), &minus(s, p)));
        Self { planes, six_volumes, corners }
    }

    /// The tetrahedron with its first two corners swapped if its volume is negative.
    pub fn oriented(corners: [Point; 4]) -> Self {
        let tet = Self::new(corners);
        if tet.six_volumes.sign() != Sign::Minus {
            return tet;
        }
        let [p, q, r, s] = tet.corners;
        Self::new([q, p, r, s])
    }

    /// The part where λᵢ is the smallest: its corner i is the centroid, and its λᵢ is φ.
    pub fn region(&self, i: usize) -> Self {
        let mut corners = self.corners.clone();
        // The grid has been refined fourfold, so the quotient is whole.
        corners[i] = from_fn(|k| self.corners.iter().map(|x| &x[k]).sum::<BigInt>() / 4);
        Self::new(corners)
    }

    pub fn face_points(&self, i: usize) -> [&Point; 3] {
        TET_FACES[i].map(|k| &self.corners[k])
    }

    /// Face i, with the plane of the face beyond each edge.
    pub fn face(&self, i: usize) -> Polygon<'_> {
        let rim = from_fn::<_, 3, _>(|k| {
            let corner = Corner { x: self.corners[TET_FACES[i][k]].clone(), w: BigInt::from(1) };
            (corner, &self.planes[TET_FACES[i][(k + 2) % 3]])
        });
        Polygon { plane: &self.planes[i], rim: rim.to_vec() }
    }

    /// The index of the face in whose plane a face of another tetrahedron lies, and whether both look the same way.
    pub fn coplanar(&self, other: &Self, face: usize) -> Option<(usize, bool)> {
        let j = (0..4).find(|&j| self.planes[j].holds(&other.face_points(face)))?;
        Some((j, dot(&self.planes[j].normal, &other.planes[face].normal) > zero()))
    }

    pub fn clip<'a>(&'a self, polygon: Polygon<'a>) -> Polygon<'a> {
        self.planes.iter().fold(polygon, Polygon::cut)
    }
}

/// A convex polygon of a plane: corners in order, each with a plane through the edge to the next.
pub struct Polygon<'a> {
    plane: &'a Plane,
    rim: Vec<(Corner, &'a Plane)>,
}

impl<'a> Polygon<'a> {
    /// The part where `side` ≥ 0.
    pub fn cut(self, side: &'a Plane) -> Self {
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

    pub fn fan(&self) -> impl Iterator<Item = [&Corner; 3]> {
        let corner = |i: usize| &self.rim[i].0;
        (1..self.rim.len().max(2) - 1).map(move |i| [corner(0), corner(i), corner(i + 1)])
    }
}

pub fn fixed(numerator: BigInt, denominator: &BigInt) -> BigInt {
    (numerator << KEPT_BITS) / denominator
}

/// Σ f/w over three corners times w₀ w₁ w₂, and w₀ w₁ w₂.
pub fn sum_of(f: &Plane, [a, b, c]: [&Corner; 3]) -> (BigInt, BigInt) {
    let (bc, ca, ab) = (&b.w * &c.w, &c.w * &a.w, &a.w * &b.w);
    (f.at(a) * &bc + f.at(b) * ca + f.at(c) * ab, &a.w * bc)
}

/// ∫ f/scale dV over a ∩ b by the flux of x (value/3 + gradient·x/4), whose divergence is f.
pub fn integral(a: &Tet, b: &Tet, f: &Plane, scale: &BigInt) -> BigInt {
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
pub fn potential(c: &Tet, t: &Tet) -> BigInt {
    let part = |i: usize| {
        let region = t.region(i);
        integral(c, &region, &region.planes[i], &region.six_volumes)
    };
    (0..4).map(part).sum()
}

/// ∮ φ_t n dS over the owner's faces in t; n dS is the area vector of a piece.
pub fn pressure(owner: &Tet, t: &Tet) -> Point {
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
pub fn odd_and_exponent(v: f64) -> (i64, i32) {
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
pub fn on_grid(c: &[Vec3; 4], t: &[Vec3; 4]) -> ([[Point; 4]; 2], i32) {
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
pub fn float(n: &BigInt, exponent: i32) -> f64 {
    let excess = n.bits().saturating_sub(64);
    let head = (n.magnitude() >> excess).iter_u64_digits().next().unwrap_or(0) as f64;
    let size = head * 2f64.powi(exponent + excess as i32);
    if n.sign() == Sign::Minus { -size } else { size }
}
