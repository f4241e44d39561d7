//! Gauss quadrature over triangles and tetrahedra, for potentials that have no closed integrals.

/// Points and weights of a rule over a triangle, and of one over a tetrahedron.
///
/// Both are products of Gauss–Legendre rules on collapsed coordinates (Stroud 1971, ch. 2): exact for polynomials of a stated degree, with
/// positive weights and points inside.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Quadrature {
    /// Barycentric coordinates and weights; weights add up to 1.
    triangle: Vec<([f64; 3], f64)>,
    tetrahedron: Vec<([f64; 4], f64)>,
}

impl Quadrature {
    /// Rules that are exact for polynomials of this degree.
    pub(crate) fn exact_to(degree: usize) -> Self {
        // The collapsed coordinates add one degree on a triangle and two on a tetrahedron; n points are exact to 2 n − 1.
        Self { triangle: triangle(degree.div_ceil(2) + 1), tetrahedron: tetrahedron(degree / 2 + 2) }
    }

    /// Points of a triangle as barycentric coordinates, with weights that add up to 1.
    pub(crate) fn triangle(&self) -> &[([f64; 3], f64)] {
        &self.triangle
    }

    /// Points and weights of a tetrahedron.
    pub(crate) fn tetrahedron(&self) -> &[([f64; 4], f64)] {
        &self.tetrahedron
    }
}

/// x = u, y = v (1 − u), with dA = (1 − u) du dv over an area of ½.
fn triangle(n: usize) -> Vec<([f64; 3], f64)> {
    let line = gauss_legendre(n);
    let mut points = Vec::with_capacity(n * n);
    for &(u, weight_u) in &line {
        for &(v, weight_v) in &line {
            let (x, y) = (u, v * (1.0 - u));
            points.push(([1.0 - x - y, x, y], 2.0 * (1.0 - u) * weight_u * weight_v));
        }
    }
    points
}

/// x = u, y = v (1 − u), z = w (1 − u) (1 − v), with dV = (1 − u)² (1 − v) du dv dw over a volume of ⅙.
fn tetrahedron(n: usize) -> Vec<([f64; 4], f64)> {
    let line = gauss_legendre(n);
    let mut points = Vec::with_capacity(n * n * n);
    for &(u, weight_u) in &line {
        for &(v, weight_v) in &line {
            for &(w, weight_w) in &line {
                let (x, y, z) = (u, v * (1.0 - u), w * (1.0 - u) * (1.0 - v));
                let jacobian = (1.0 - u) * (1.0 - u) * (1.0 - v);
                points.push(([1.0 - x - y - z, x, y, z], 6.0 * jacobian * weight_u * weight_v * weight_w));
            }
        }
    }
    points
}

/// Points and weights of Gauss and Legendre on [0, 1]: the roots of P_n by Newton's method from Tricomi's estimate.
pub(crate) fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    let count = n as f64;
    let root = |k: usize| {
        let mut x = (std::f64::consts::PI * (k as f64 + 0.75) / (count + 0.5)).cos();
        for _ in 0..8 {
            let (value, slope) = legendre(n, x);
            x -= value / slope;
        }
        let (_, slope) = legendre(n, x);
        (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(root).collect()
}

/// P_n(x) and its derivative by Bonnet's recursion, |x| < 1.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut last, mut value) = (1.0, x);
    for k in 2..=n {
        let k = k as f64;
        (last, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * last) / k);
    }
    (value, n as f64 * (x * value - last) / (x * x - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factorial(n: usize) -> f64 {
        (1..=n).map(|k| k as f64).product()
    }

    #[test]
    fn monomials_up_to_the_degree_are_integrated_to_rounding() {
        for degree in 0..12 {
            let rule = Quadrature::exact_to(degree);
            for (i, j) in (0..=degree).flat_map(|i| (0..=degree - i).map(move |j| (i, j))) {
                // ∫ x^i y^j dA over ½: i! j! / (i + j + 2)!, and i! j! / (i + j + 3)! over a tetrahedron of ⅙.
                let power = |l: &[f64]| l[1].powi(i as i32) * l[2].powi(j as i32);
                let area: f64 = rule.triangle().iter().map(|(l, w)| w * power(l)).sum();
                let exact = 2.0 * factorial(i) * factorial(j) / factorial(i + j + 2);
                assert!((area / exact - 1.0).abs() < 1e-12, "x^{i} y^{j}: {area} instead of {exact}");
                let volume: f64 = rule.tetrahedron().iter().map(|(l, w)| w * power(l)).sum();
                let exact = 6.0 * factorial(i) * factorial(j) / factorial(i + j + 3);
                assert!((volume / exact - 1.0).abs() < 1e-12, "x^{i} y^{j}: {volume} instead of {exact}");
            }
        }
    }
}
