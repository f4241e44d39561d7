//! The kernel of `ndda_contact::integration::kernel` for one region, operation by operation, on numbers that count what is done with
//! them: sums, differences, products and quotients, not comparisons and choices.

use std::cell::Cell;
use std::ops::{Add, Div, Mul, Sub};

use ndda_contact::integration::Region;

thread_local!(static OPERATIONS: Cell<u64> = const { Cell::new(0) });

/// A number that counts.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
struct N(f64);

fn counted(value: f64) -> N {
    OPERATIONS.with(|count| count.set(count.get() + 1));
    N(value)
}

impl Add for N {
    type Output = N;

    fn add(self, other: N) -> N {
        counted(self.0 + other.0)
    }
}

impl Sub for N {
    type Output = N;

    fn sub(self, other: N) -> N {
        counted(self.0 - other.0)
    }
}

impl Mul for N {
    type Output = N;

    fn mul(self, other: N) -> N {
        counted(self.0 * other.0)
    }
}

impl Div for N {
    type Output = N;

    fn div(self, other: N) -> N {
        counted(self.0 / other.0)
    }
}

const ZERO: N = N(0.0);
const ONE: N = N(1.0);

/// A point (ψ₁, ψ₂).
type Point = [N; 2];

/// c₀ + c₁ ψ₁ + c₂ ψ₂.
#[derive(Clone, Copy)]
struct Form([N; 3]);

impl Form {
    fn through(at: &[f64; 3]) -> Self {
        let [a, b, c] = at.map(N);
        Self([a, b - a, c - a])
    }

    fn at(&self, [x, y]: Point) -> N {
        let Self([c0, c1, c2]) = *self;
        c0 + (c1 * x + c2 * y)
    }
}

/// Results of the kernel for one region: ∫ φ ψ_a, ∫ |∂φ/∂n| ψ_a, and the area, over that of the triangle.
pub type Moments = [f64; 7];

/// The integrals of a region, and the operations that they took.
pub fn moments(region: &Region) -> (Moments, u64) {
    OPERATIONS.with(|count| count.set(0));
    let mut cuts = region.cuts().iter().map(|cut| (Form::through(&cut.field), N(cut.bound)));
    let mut edges = match cuts.next() {
        Some((field, bound)) => cut_triangle(&field, bound),
        None => TRIANGLE.to_vec(),
    };
    cuts.for_each(|(field, bound)| shorten(&mut edges, &field, bound));
    let found = fan(&edges, &Form::through(&region.phi), N(region.slope));
    (found.map(|x| x.0), OPERATIONS.with(Cell::get))
}

const TRIANGLE: [[Point; 2]; 3] =
    [[[ZERO, ZERO], [ONE, ZERO]], [[ONE, ZERO], [ZERO, ONE]], [[ZERO, ONE], [ZERO, ZERO]]];

/// Remainder of the triangle after one cut; its corners need no products.
fn cut_triangle(&Form([c0, c1, c2]): &Form, bound: N) -> Vec<[Point; 2]> {
    let d = [c0, c0 + c1, c0 + c2];
    let is_out = d.map(|d| d < bound);
    let on = |from, to| (0..3).find(|&k| is_out[k] == from && is_out[(k + 1) % 3] == to);
    let crossing = |on: Option<usize>| {
        let k = on.unwrap_or(0);
        let t = d[k] / (d[k] - d[(k + 1) % 3]);
        let rest = ONE - t;
        on.map_or([ZERO; 2], |k| [[t, ZERO], [rest, t], [ZERO, rest]][k])
    };
    let (leaves, returns) = (on(false, true), on(true, false));
    let (leave, back) = (crossing(leaves), crossing(returns));
    let mut edges = TRIANGLE.to_vec();
    for (k, edge) in edges.iter_mut().enumerate() {
        let first = edge[0];
        match (is_out[k], is_out[(k + 1) % 3]) {
            (false, true) => edge[1] = leave,
            (true, false) => edge[0] = back,
            (true, true) => edge[1] = first,
            (false, false) => {}
        }
    }
    edges.push([leave, back]);
    edges
}

/// Keeps what is not below the bound, and closes the rim.
fn shorten(edges: &mut Vec<[Point; 2]>, field: &Form, bound: N) {
    let (mut leave, mut back) = ([ZERO; 2], [ZERO; 2]);
    for edge in edges.iter_mut() {
        let [from, to] = *edge;
        let (d0, d1) = (field.at(from), field.at(to));
        let t = d0 / (d0 - d1);
        let cross = [from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])];
        match (d0 < bound, d1 < bound) {
            (false, true) => (edge[1], leave) = (cross, cross),
            (true, false) => (edge[0], back) = (cross, cross),
            (true, true) => edge[1] = from,
            (false, false) => {}
        }
    }
    edges.push([leave, back]);
}

fn fan(edges: &[[Point; 2]], phi: &Form, slope: N) -> [N; 7] {
    let apex = edges.iter().skip(1).filter(|[from, to]| from != to).fold(edges[0][0], |_, edge| edge[0]);
    let phi_apex = phi.at(apex);
    let (mut area, mut first, mut total, mut pressure) = (ZERO, [ZERO; 2], ZERO, [ZERO; 2]);
    for [from, to] in edges {
        let (u, v) = ([from[0] - apex[0], from[1] - apex[1]], [to[0] - from[0], to[1] - from[1]]);
        let part = u[0] * v[1] - u[1] * v[0];
        let (phi0, phi1) = (phi.at(*from), phi.at(*to));
        let phi_sum = phi_apex + (phi0 + phi1);
        for k in 0..2 {
            let sum = apex[k] + (from[k] + to[k]);
            let products = phi_apex * apex[k] + (phi0 * from[k] + phi1 * to[k]);
            pressure[k] = pressure[k] + part * (phi_sum * sum + products);
            first[k] = first[k] + part * sum;
        }
        area = area + part;
        total = total + part * phi_sum;
    }
    let (third, twelfth) = (N(1.0 / 3.0), N(1.0 / 12.0));
    let total = third * total;
    let pressure = [twelfth * pressure[0], twelfth * pressure[1]];
    let first = [third * first[0], third * first[1]];
    let rest = |all: N, two: [N; 2]| all - (two[0] + two[1]);
    let (p, s) = ([rest(total, pressure), pressure[0], pressure[1]], [rest(area, first), first[0], first[1]]);
    // The kernel adds to sums that begin with zero.
    let [p, s] = [p.map(|p| ZERO + p), s.map(|s| ZERO + slope * s)];
    [p[0], p[1], p[2], s[0], s[1], s[2], ZERO + area]
}
