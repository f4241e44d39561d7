//! A boundary triangle cut by a tetrahedron and by the regions where one barycentric coordinate is smallest.
//!
//! Everything happens in the triangle's own barycentric coordinates ψ. A vertex carries ψ and the tetrahedron's
//! λ there; both are linear over the triangle, so a cut needs no other geometry.

/// A triangle has 3 corners, and each of at most 4 + 3 cuts adds one.
const MOST: usize = 12;

/// A point of the triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vertex {
    /// Barycentric coordinates in the triangle.
    pub psi: [f64; 3],
    /// Barycentric coordinates in the tetrahedron.
    pub lambda: [f64; 4],
}

impl Vertex {
    /// The point at `t` of the way from `self` to `other`.
    fn towards(&self, other: &Self, t: f64) -> Self {
        let mix = |a: f64, b: f64| a + t * (b - a);
        Self {
            psi: std::array::from_fn(|i| mix(self.psi[i], other.psi[i])),
            lambda: std::array::from_fn(|i| mix(self.lambda[i], other.lambda[i])),
        }
    }
}

/// A convex polygon in the triangle; lives on the stack.
#[derive(Clone, Copy, Debug)]
pub struct Polygon {
    vertices: [Vertex; MOST],
    len: usize,
}

impl Polygon {
    fn empty() -> Self {
        Self { vertices: [Vertex::default(); MOST], len: 0 }
    }

    /// The whole triangle; `lambda[b][a]` is λ_b at corner a.
    pub fn triangle(lambda: &[[f64; 3]; 4]) -> Self {
        let mut polygon = Self::empty();
        for a in 0..3 {
            let mut psi = [0.0; 3];
            psi[a] = 1.0;
            polygon.push(Vertex { psi, lambda: std::array::from_fn(|b| lambda[b][a]) });
        }
        polygon
    }

    fn push(&mut self, vertex: Vertex) {
        self.vertices[self.len] = vertex;
        self.len += 1;
    }

    /// Its corners in order.
    pub fn vertices(&self) -> &[Vertex] {
        &self.vertices[..self.len]
    }

    /// The part where λ_b ≥ 0; new corners have λ_b = 0 exactly.
    fn clipped(&self, b: usize) -> Self {
        let mut kept = Self::empty();
        for (i, here) in self.vertices().iter().enumerate() {
            let next = &self.vertices[(i + 1) % self.len];
            let (from, to) = (here.lambda[b], next.lambda[b]);
            if from >= 0.0 {
                kept.push(*here);
            }
            if (from < 0.0) != (to < 0.0) {
                let mut crossing = here.towards(next, from / (from - to));
                crossing.lambda[b] = 0.0;
                kept.push(crossing);
            }
        }
        kept
    }

    /// The parts where λ_a ≤ λ_b and where λ_a > λ_b. A corner is classified once, by its sign, so no point of the
    /// polygon is in both or in neither; a polygon that lies in λ_a = λ_b is in the first part only.
    fn split(&self, a: usize, b: usize) -> (Self, Self) {
        let (mut first, mut second) = (Self::empty(), Self::empty());
        let difference = |v: &Vertex| v.lambda[b] - v.lambda[a];
        for (i, here) in self.vertices().iter().enumerate() {
            let next = &self.vertices[(i + 1) % self.len];
            let (from, to) = (difference(here), difference(next));
            if from >= 0.0 {
                first.push(*here)
            } else {
                second.push(*here)
            }
            if (from < 0.0) != (to < 0.0) {
                let mut crossing = here.towards(next, from / (from - to));
                let equal = 0.5 * (crossing.lambda[a] + crossing.lambda[b]);
                (crossing.lambda[a], crossing.lambda[b]) = (equal, equal);
                first.push(crossing);
                second.push(crossing);
            }
        }
        (first, second)
    }

    fn has_area(&self) -> bool {
        self.len >= 3
    }
}

/// Calls `piece(polygon, i)` for the parts of the triangle inside the tetrahedron on which λ_i is the smallest.
///
/// The regions are found by elimination, the winner of λ₀ and λ₁ against λ₂, the winner of those against λ₃, so
/// that a triangle in a plane λ_i = λ_j is counted once.
pub fn for_each_piece(lambda: &[[f64; 3]; 4], mut piece: impl FnMut(&Polygon, usize)) {
    let mut inside = Polygon::triangle(lambda);
    for b in 0..4 {
        inside = inside.clipped(b);
        if !inside.has_area() {
            return;
        }
    }
    eliminate(&inside, 0, 1, &mut piece);
}

fn eliminate(polygon: &Polygon, smallest: usize, rival: usize, piece: &mut impl FnMut(&Polygon, usize)) {
    if !polygon.has_area() {
        return;
    }
    if rival == 4 {
        piece(polygon, smallest);
        return;
    }
    let keeps = polygon.vertices().iter().all(|v| v.lambda[smallest] <= v.lambda[rival]);
    if keeps {
        return eliminate(polygon, smallest, rival + 1, piece);
    }
    if polygon.vertices().iter().all(|v| v.lambda[smallest] > v.lambda[rival]) {
        return eliminate(polygon, rival, rival + 1, piece);
    }
    let (first, second) = polygon.split(smallest, rival);
    eliminate(&first, smallest, rival + 1, piece);
    eliminate(&second, rival, rival + 1, piece);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// λ of a triangle given by three points in the coordinates (λ₁, λ₂, λ₃).
    fn lambda_of(points: [[f64; 3]; 3]) -> [[f64; 3]; 4] {
        let mut lambda = [[0.0; 3]; 4];
        for (a, p) in points.iter().enumerate() {
            lambda[0][a] = 1.0 - p[0] - p[1] - p[2];
            for b in 0..3 {
                lambda[b + 1][a] = p[b];
            }
        }
        lambda
    }

    fn area(polygon: &Polygon) -> f64 {
        let v = polygon.vertices();
        let edge = |i: usize| [v[i].psi[1] - v[0].psi[1], v[i].psi[2] - v[0].psi[2]];
        (1..v.len() - 1).map(|i| edge(i)[0] * edge(i + 1)[1] - edge(i)[1] * edge(i + 1)[0]).sum()
    }

    fn total(lambda: &[[f64; 3]; 4]) -> (f64, usize) {
        let (mut sum, mut pieces) = (0.0, 0);
        for_each_piece(lambda, |polygon, i| {
            sum += area(polygon);
            pieces += 1;
            for v in polygon.vertices() {
                let smallest = v.lambda.iter().copied().fold(f64::INFINITY, f64::min);
                assert!(v.lambda[i] <= smallest + 1e-15, "λ_{i} is not the smallest: {v:?}");
            }
        });
        (sum, pieces)
    }

    #[test]
    fn a_triangle_inside_is_split_into_regions_that_fill_it() {
        let (area, pieces) = total(&lambda_of([[0.1, 0.1, 0.1], [0.6, 0.1, 0.2], [0.1, 0.7, 0.05]]));
        assert!((area - 1.0).abs() < 1e-15 && pieces > 1);
    }

    #[test]
    fn a_triangle_in_a_kink_plane_is_counted_once() {
        // λ₁ = λ₂ everywhere: the plane between two regions.
        let (area, _) = total(&lambda_of([[0.1, 0.1, 0.1], [0.2, 0.2, 0.1], [0.1, 0.1, 0.6]]));
        assert!((area - 1.0).abs() < 1e-15, "{area}");
    }

    #[test]
    fn a_triangle_outside_leaves_nothing() {
        assert_eq!(total(&lambda_of([[-0.1, 0.1, 0.1], [-0.2, 0.2, 0.1], [-0.1, 0.1, 0.6]])).1, 0);
    }

    #[test]
    fn a_large_triangle_is_clipped_to_the_section() {
        // The section λ₃ = 1/4 of the tetrahedron is a triangle of (3/4)² of the face.
        let (area, _) = total(&lambda_of([[-4.0, -4.0, 0.25], [8.0, -4.0, 0.25], [-4.0, 8.0, 0.25]]));
        assert!((area * 144.0 - 0.5625).abs() < 1e-13, "{area}");
    }
}
