//! Integrals of a potential that is any function, over the part of a triangle that lies in a tetrahedron.

use ndda_mesh::{TetId, Vec3};

use crate::integration::clip::Outline;
use crate::integration::pair_moments::PairMoments;
use crate::integration::region::{Pieces, Region};
use crate::integration::tet_frame::TetFrame;
use crate::potential::function::FunctionField;

/// A triangle in a tetrahedron.
#[derive(Clone, Copy)]
pub(crate) struct Placed<'a> {
    pub(crate) tet: TetId,
    pub(crate) frame: &'a TetFrame,
    /// λ_b at corner a of the triangle, as `[b][a]`.
    pub(crate) lambda: &'a [[f64; 3]; 4],
    /// Outward unit normal of the triangle, and its area [m²].
    pub(crate) normal: &'a Vec3,
    pub(crate) area: f64,
}

/// Adds ∫ φ ψ_a dA and ∫ |∂φ/∂n| ψ_a dA by quadrature over each region in which φ is smooth.
pub(crate) fn add_function(
    moments: &mut PairMoments,
    field: &FunctionField,
    regions: &Pieces,
    region: &mut Region,
    placed: &Placed,
) {
    let Placed { tet, frame, lambda, normal, area } = *placed;
    let rise = [0, 1, 2, 3].map(|b| frame.gradient(b).dot(normal));
    for k in 0..regions.len() {
        if !region.set_piece(regions, k) {
            continue;
        }
        let polygon = region.polygon(&Outline::TRIANGLE);
        let lambda_at = |psi: &[f64; 3]| lambda.map(|l| l[0] * psi[0] + l[1] * psi[1] + l[2] * psi[2]);
        for (psi, weight) in polygon.points(&field.rule) {
            let at = lambda_at(&psi);
            let (phi, gradient) = (field.function.phi(tet, &at), field.function.gradient(tet, &at));
            let slope: f64 = (0..4).map(|b| gradient[b] * rise[b]).sum();
            let part = area * weight;
            for ((pressure, slope_sum), psi) in moments.pressure.iter_mut().zip(&mut moments.slope).zip(psi) {
                *pressure += part * phi * psi;
                *slope_sum += part * slope.abs() * psi;
            }
            moments.area += part;
        }
        for [x, y] in polygon.corners() {
            let depth = field.function.phi(tet, &lambda_at(&[1.0 - x - y, *x, *y]));
            moments.depth = moments.depth.max(depth);
        }
    }
}
