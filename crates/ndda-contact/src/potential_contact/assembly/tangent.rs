//! Tangent stiffness of normal contact, for solvers that iterate on it; explicit steps never come here.
//!
//! A point ψ of a triangle moves against the target by δ = Σ_p s_p(ψ) u_p over seven nodes, s = ψ_a on the three of the
//! triangle and −Σ_a λ_b(X_a) ψ_a on the four of the tetrahedron. Its traction −k φ n changes by −k n (∇φ·δ), and φ is
//! zero where the piece ends, so
//!
//! ```text
//! ∂f_p/∂x_q = −k ∫ s_p s_q dA  sym(n ⊗ ∇φ)      = −k (S H Sᵀ)_pq sym(n ⊗ ∇φ),   H_ab = ∫ ψ_a ψ_b dA
//! ```
//!
//! Summed over both surfaces n ⊗ ∇φ is symmetric under a shift of a block, so taking the symmetric part of each pair
//! loses nothing there. What is left out is the turning and stretching of the triangle under its own pressure, of the
//! order of the depth over the size of the triangle.

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{Mat3, TetId, Vec3};
use pulp::Scalar;

use crate::affine::half_spaces::{HalfSpaces, Planes, SIDES};
use crate::integration::clip::{Outline, Polygon};
use crate::integration::quadrature::Quadrature;
use crate::integration::region::{Pieces, Region, element_outside};
use crate::integration::tet_frame::TetFrame;
use crate::pair_stiffness::PairStiffness;
use crate::potential::function::FunctionField;

/// Adds the part of the pair where φ is one linear function with this gradient.
fn add_part(
    stiffness: &mut PairStiffness,
    part: &Polygon,
    shapes: &[[f64; 3]; 7],
    tensor: &Mat3,
    area_m2: f64,
) {
    let h = second_moments(part, area_m2);
    let times_h = |s: &[f64; 3]| h.map(|row| row[0] * s[0] + row[1] * s[1] + row[2] * s[2]);
    for (s_p, row) in shapes.iter().zip(&mut stiffness.block) {
        let left = times_h(s_p);
        for (s_q, block) in shapes.iter().zip(row) {
            *block += tensor * (left[0] * s_q[0] + left[1] * s_q[1] + left[2] * s_q[2]);
        }
    }
}

/// H_ab = ∫ ψ_a ψ_b dA over a polygon: A/12 [(Σψ_a)(Σψ_b) + Σ ψ_a ψ_b] for each triangle of its fan.
fn second_moments(part: &Polygon, area_m2: f64) -> [[f64; 3]; 3] {
    let mut h = [[0.0; 3]; 3];
    for (corners, twice) in part.fan() {
        let psi = corners.map(|c| [1.0 - c[0] - c[1], c[0], c[1]]);
        let sum = |a: usize| psi[0][a] + psi[1][a] + psi[2][a];
        for (a, row) in h.iter_mut().enumerate() {
            for (b, entry) in row.iter_mut().enumerate() {
                let products: f64 = psi.iter().map(|p| p[a] * p[b]).sum();
                *entry += area_m2 * twice / 12.0 * (sum(a) * sum(b) + products);
            }
        }
    }
    h
}

/// Adds the stiffness of a pair where the gradient of φ differs from point to point.
fn add_function(
    stiffness: &mut PairStiffness,
    part: &Polygon,
    shapes: &[[f64; 3]; 7],
    (rule, area_m2): (&Quadrature, f64),
    tensor_at: impl Fn(&[f64; 3]) -> Mat3,
) {
    for (psi, weight) in part.points(rule) {
        let tensor = area_m2 * weight * tensor_at(&psi);
        let at = shapes.map(|s| s[0] * psi[0] + s[1] * psi[1] + s[2] * psi[2]);
        for (s_p, row) in at.iter().zip(&mut stiffness.block) {
            for (s_q, block) in at.iter().zip(row) {
                *block += s_p * s_q * tensor;
            }
        }
    }
}

/// ∇φ at a point of a triangle in a tetrahedron [1/m].
fn gradient_at(
    field: &FunctionField,
    tet: TetId,
    frame: &TetFrame,
    lambda: &[[f64; 3]; 4],
    psi: &[f64; 3],
) -> Vec3 {
    let at = lambda.map(|l| l[0] * psi[0] + l[1] * psi[1] + l[2] * psi[2]);
    let slope = field.function.gradient(tet, &at);
    (0..4).map(|b| slope[b] * frame.gradient(b)).sum()
}

/// The function φ in the target of a pair.
#[derive(Clone, Copy)]
pub(crate) enum Target<'a> {
    /// 4 min λᵢ.
    Element,
    /// The smallest of linear functions with these nodal values.
    Pieces(&'a [[f64; 4]]),
    /// A function of the tetrahedron.
    Function(&'a FunctionField, TetId),
    /// The smallest of the functions of these sides of a block that is an affine convex target, on a contactor with this outline; λ are those of
    /// its host.
    Convex(&'a [Planes], &'a Outline),
}

/// Adds the stiffness of a contactor in a tetrahedron or a block that is an affine convex target; `corners` [m] are those of its triangle.
pub(crate) fn add_pair(
    stiffness: &mut PairStiffness,
    corners: &[Vec3; 3],
    frame: &TetFrame,
    target: Target,
    penalty_pa: f64,
) {
    let lambda = frame.lambda(corners);
    let area_vector = triangle_area_vector(corners);
    let area = area_vector.norm();
    if area == 0.0 {
        return;
    }
    let normal = area_vector / area;
    let mut shapes = [[0.0; 3]; 7];
    (0..3).for_each(|a| shapes[a][a] = 1.0);
    (0..4).for_each(|b| shapes[3 + b] = lambda[b].map(|l| -l));
    let tensor = |gradient: &Vec3| {
        let product = normal * gradient.transpose();
        -0.5 * penalty_pa * (product + product.transpose())
    };
    let (mut region, mut seen, mut sides) = (Region::default(), Pieces::default(), HalfSpaces::default());
    let one_lane = Scalar::new();
    let outside = element_outside(&lambda);
    let pieces = match target {
        Target::Element => 4,
        Target::Function(field, tet) if seen.set(&lambda, field.regions.of(tet), frame, &normal) => {
            seen.len()
        }
        Target::Pieces(values) if seen.set(&lambda, values, frame, &normal) => seen.len(),
        Target::Convex(planes, outline) if sides.look(one_lane, planes, corners, &normal, outline) => {
            sides.len()
        }
        _ => 0,
    };
    let outline = if let Target::Convex(_, outline) = target { outline } else { &Outline::TRIANGLE };
    for k in 0..pieces {
        let somewhere = match target {
            Target::Element => region.set_element(&lambda, &outside, k, 0.0),
            Target::Pieces(_) | Target::Function(..) => region.set_piece(&seen, k),
            Target::Convex(..) => sides.set_region(one_lane, k, outline, &mut region),
        };
        let part = || region.polygon(outline);
        let gradient: Vec3 = match target {
            Target::Function(field, tet) => {
                if somewhere {
                    let gradient = |psi: &[f64; 3]| gradient_at(field, tet, frame, &lambda, psi);
                    add_function(stiffness, &part(), &shapes, (&field.rule, area), |psi| {
                        tensor(&gradient(psi))
                    });
                }
                continue;
            }
            Target::Element => 4.0 * frame.gradient(k),
            Target::Pieces(values) => (0..4).map(|b| values[k][b] * frame.gradient(b)).sum(),
            Target::Convex(planes, _) => planes[sides.which(k) / SIDES].gradient(sides.which(k) % SIDES),
        };
        if somewhere {
            add_part(stiffness, &part(), &shapes, &tensor(&gradient), area);
        }
    }
}
