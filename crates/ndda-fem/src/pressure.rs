//! Pressure of a fluid on faces, as consistent nodal forces that follow the faces.
//!
//! A field is a list of pieces, each a linear pressure within half-spaces. A triangle is cut by them, and what is left integrated exactly:
//! a triangle that the water table crosses carries the pressure of its wet part.

use ndda_mesh::Vec3;
use ndda_mesh::geometry::triangle_area_vector;

/// A function that is linear in space, value + gradient · x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearField {
    /// Its value at the origin.
    pub value: f64,
    /// Its change per metre.
    pub gradient: Vec3,
}

impl LinearField {
    /// The field that has a value at a place.
    pub fn through(at: &Vec3, value: f64, gradient: Vec3) -> Self {
        Self { value: value - gradient.dot(at), gradient }
    }

    /// The value at a place.
    pub fn at(&self, x: &Vec3) -> f64 {
        self.value + self.gradient.dot(x)
    }

    /// This less another.
    pub fn minus(&self, other: &Self) -> Self {
        Self { value: self.value - other.value, gradient: self.gradient - other.gradient }
    }
}

/// A linear pressure in a part of space.
#[derive(Clone, Debug, PartialEq)]
pub struct PressurePiece {
    /// It acts where none of these is negative.
    pub within: Vec<LinearField>,
    /// The pressure [Pa].
    pub pressure_pa: LinearField,
}

/// A pressure in space; parts that overlap add up.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PressureField {
    /// Its pieces.
    pub pieces: Vec<PressurePiece>,
}

/// Barycentric coordinates of a point of a triangle.
type Weights = [f64; 3];

/// Room to cut triangles in.
#[derive(Clone, Debug, Default)]
pub struct CutRoom {
    polygon: Vec<Weights>,
    cut: Vec<Weights>,
}

impl CutRoom {
    /// Room for a field: each half-space adds a corner at most.
    pub fn enough_for(field: &PressureField) -> Self {
        let most = field.pieces.iter().map(|piece| piece.within.len()).max().unwrap_or(0);
        Self { polygon: Vec::with_capacity(3 + most), cut: Vec::with_capacity(3 + most) }
    }
}

impl PressureField {
    /// The pressure at a place [Pa].
    pub fn at(&self, x: &Vec3) -> f64 {
        let inside = |piece: &&PressurePiece| piece.within.iter().all(|side| side.at(x) >= 0.0);
        self.pieces.iter().filter(inside).map(|piece| piece.pressure_pa.at(x)).sum()
    }

    /// −∫ Nₐ p n dA per corner of a triangle [N], counter-clockwise seen from outside.
    pub fn forces(&self, corners: &[Vec3; 3], room: &mut CutRoom) -> [Vec3; 3] {
        let mut shares = [0.0; 3];
        for piece in &self.pieces {
            room.polygon.clear();
            room.polygon.extend([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
            for side in &piece.within {
                cut(&corners.map(|x| side.at(&x)), room);
            }
            integrate(&corners.map(|x| piece.pressure_pa.at(&x)), &room.polygon, &mut shares);
        }
        let area = triangle_area_vector(corners);
        shares.map(|share| -share * area)
    }
}

/// The value at a point of a linear function with these values at the corners.
fn value(at_corners: &[f64; 3], point: &Weights) -> f64 {
    at_corners[0] * point[0] + at_corners[1] * point[1] + at_corners[2] * point[2]
}

/// Leaves the part of the polygon where a linear function is not negative.
fn cut(at_corners: &[f64; 3], room: &mut CutRoom) {
    let CutRoom { polygon, cut } = room;
    cut.clear();
    for (i, here) in polygon.iter().enumerate() {
        let next = &polygon[(i + 1) % polygon.len()];
        let (a, b) = (value(at_corners, here), value(at_corners, next));
        if a >= 0.0 {
            cut.push(*here);
        }
        // Strictly on both sides: a − b is not zero.
        if (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0) {
            let part = a / (a - b);
            cut.push(std::array::from_fn(|k| here[k] + part * (next[k] - here[k])));
        }
    }
    std::mem::swap(polygon, cut);
}

/// Adds ∫ Nₐ p dA over a polygon, for a triangle of area one.
fn integrate(at_corners: &[f64; 3], polygon: &[Weights], shares: &mut [f64; 3]) {
    let Some((first, rest)) = polygon.split_first() else { return };
    for pair in rest.windows(2) {
        let points = [first, &pair[0], &pair[1]];
        let part = triangle_part(&points);
        let pressure = points.map(|point| value(at_corners, point));
        let sum: f64 = pressure.iter().sum();
        for (a, share) in shares.iter_mut().enumerate() {
            let weights: f64 = points.iter().map(|point| point[a]).sum();
            let products: f64 = points.iter().zip(pressure).map(|(point, p)| point[a] * p).sum();
            *share += part / 12.0 * (weights * sum + products);
        }
    }
}

/// Area of a triangle of three points over that of the whole.
fn triangle_part(points: &[&Weights; 3]) -> f64 {
    let [a, b, c] = points.map(|point| (point[1], point[2]));
    ((b.0 - a.0) * (c.1 - a.1) - (c.0 - a.0) * (b.1 - a.1)).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 3.0]];

    fn corners() -> [Vec3; 3] {
        CORNERS.map(Vec3::from)
    }

    fn forces(field: &PressureField) -> [Vec3; 3] {
        field.forces(&corners(), &mut CutRoom::enough_for(field))
    }

    fn water(level: f64) -> PressureField {
        let depth = LinearField::through(&Vec3::new(0.0, 0.0, level), 0.0, -9810.0 * Vec3::z());
        PressureField { pieces: vec![PressurePiece { within: vec![depth], pressure_pa: depth }] }
    }

    /// Nodal forces by many small triangles, each with the pressure at its centroid.
    fn by_many(field: &PressureField) -> [Vec3; 3] {
        let n = 600;
        let [a, b, c] = corners();
        let place = |i: usize, j: usize| (i as f64 / n as f64, j as f64 / n as f64);
        let mut sum = [Vec3::zeros(); 3];
        let mut add = |points: [(f64, f64); 3]| {
            let (u, v) = points.iter().fold((0.0, 0.0), |s, p| (s.0 + p.0 / 3.0, s.1 + p.1 / 3.0));
            let x = a + u * (b - a) + v * (c - a);
            let force = -field.at(&x) * triangle_area_vector(&corners()) / (n * n) as f64;
            [1.0 - u - v, u, v].iter().zip(&mut sum).for_each(|(w, s)| *s += *w * force);
        };
        for i in 0..n {
            for j in 0..n - i {
                add([place(i, j), place(i + 1, j), place(i, j + 1)]);
                if i + j + 2 <= n {
                    add([place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)]);
                }
            }
        }
        sum
    }

    #[test]
    fn a_uniform_pressure_pushes_against_the_outward_normal_by_thirds() {
        let pressure_pa = LinearField { value: 5.0, gradient: Vec3::zeros() };
        let field = PressureField { pieces: vec![PressurePiece { within: Vec::new(), pressure_pa }] };
        let area = triangle_area_vector(&corners());
        for force in forces(&field) {
            assert!((force + 5.0 / 3.0 * area).norm() < 1e-14);
        }
    }

    /// Water of depth h against a triangle of base b that narrows upwards to z = 3: F = ρg b (h²/2 − h³/18).
    #[test]
    fn a_triangle_that_the_water_table_crosses_bears_the_pressure_of_its_wet_part() {
        for level in [0.5, 1.0, 2.0, 3.0] {
            let total: Vec3 = forces(&water(level)).iter().sum();
            let exact = 9810.0 * 2.0 * (level * level / 2.0 - level.powi(3) / 18.0);
            assert!((total.norm() / exact - 1.0).abs() < 1e-13, "{level}: {} {exact}", total.norm());
        }
        assert_eq!(forces(&water(-1.0)), [Vec3::zeros(); 3]);
        assert_eq!(forces(&water(0.0)).iter().map(|f| f.norm()).sum::<f64>(), 0.0);
    }

    #[test]
    fn forces_of_cut_fields_are_those_of_many_small_triangles() {
        let plane = |value: f64, x: f64, z: f64| LinearField { value, gradient: Vec3::new(x, 0.0, z) };
        let (a, b) = (plane(10.0, 4.0, 0.0), plane(30.0, -9.0, -6.0));
        let tent =
            |p: LinearField, q: LinearField| PressurePiece { within: vec![q.minus(&p), p], pressure_pa: p };
        let tent = PressureField { pieces: vec![tent(a, b), tent(b, a)] };
        for field in [tent, water(1.3)] {
            let (exact, slow) = (forces(&field), by_many(&field));
            for (exact, slow) in exact.iter().zip(&slow) {
                assert!((exact - slow).norm() < 2e-5 * exact.norm(), "{exact:?} {slow:?}");
            }
        }
    }
}
