//! Energy of facets that are moved out before they are clipped: their blocks need not overlap.
//!
//! Let d be the depth below the nearest face of the target and E(d) = ∫₀ᵈ φ the energy of a column of this depth. The field −m E(d), m being that face's outward normal, has the
//! divergence φ and no flux through the face, so that ∫ φ dV over the part of a moved block in its target is the sum over facets of −n·m ∫ E dA. On a facet E = φ (E/φ) is
//! integrated with E/φ at the centre of pressure, which is exact where φ is linear: there E/φ = ½ d. Left out is what flows through the edges between faces,
//! within one depth of the rim of the target.

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{TetId, Vec3};

use crate::assembly::overlap_parts::OverlapParts;
use crate::friction::openings::Openings;
use crate::integration::overlap_pair::{ActiveFacet, OverlapPair};
use crate::integration::quadrature::gauss_legendre;
use crate::integration::tet_frame::TetFrame;
use crate::model::ContactInput;
use crate::potential::contact_potential::PotentialField;
use crate::potential::function::FunctionField;

/// Points of the rule along a column where φ is any function.
const POINTS: usize = 16;

/// A facet's share of ∫ φ dV [m³].
pub(super) fn energy_m3(
    touch: &ActiveFacet,
    input: &ContactInput,
    parts: &OverlapParts,
    openings: &Openings,
) -> f64 {
    let corners = input.blocks.triangle_corners(touch.triangle, input.position);
    let normal = triangle_area_vector(&corners).normalize();
    let opening_m = openings.of(touch.triangle, touch.target);
    let share = |hit: &OverlapPair| {
        // The force acts where the facet is, not where it is clipped.
        let found = hit.center(&input.blocks.tet_corners(hit.tet, input.position));
        found.map_or(0.0, |(pressure_m2, center)| {
            pressure_m2 * column_m(touch, hit, parts, (&(center + opening_m * normal), &normal))
        })
    };
    parts.integrals.overlaps_of(touch).iter().map(share).sum()
}

/// −n·m E/φ at a point of a facet with normal n [m].
fn column_m(
    touch: &ActiveFacet,
    hit: &OverlapPair,
    parts: &OverlapParts,
    (point, normal): (&Vec3, &Vec3),
) -> f64 {
    let frame = parts.frames.at(hit.slot);
    let (depth, gradient) = match parts.hulls.affine_target(touch.target) {
        Some(_) => {
            let faces = parts.hulls.faces_of(touch.target).iter();
            let nearest = faces.min_by(|a, b| a.phi(point).total_cmp(&b.phi(point)));
            nearest.map_or((0.0, Vec3::zeros()), |face| (face.phi(point), face.gradient()))
        }
        None => {
            let lambda = frame.lambda_at(point);
            match parts.field {
                PotentialField::Element => smallest(&ELEMENT, &lambda, frame),
                PotentialField::Pieces(table) => smallest(table.of(hit.tet), &lambda, frame),
                PotentialField::Function(field) => smallest(field.regions.of(hit.tet), &lambda, frame),
            }
        }
    };
    let steepness = gradient.norm();
    if depth <= 0.0 || steepness == 0.0 {
        return 0.0;
    }
    let (inward, depth_m) = (gradient / steepness, depth / steepness);
    let column_m = match parts.field {
        PotentialField::Function(field) => {
            mean_over_last(field, (hit.tet, frame), point, &(depth_m * inward)) * depth_m
        }
        _ => 0.5 * depth_m,
    };
    normal.dot(&inward) * column_m
}

/// The functions of the element potential.
const ELEMENT: [[f64; 4]; 4] =
    [[4.0, 0.0, 0.0, 0.0], [0.0, 4.0, 0.0, 0.0], [0.0, 0.0, 4.0, 0.0], [0.0, 0.0, 0.0, 4.0]];

/// The smallest of linear functions at a point, and its gradient.
fn smallest(pieces: &[[f64; 4]], lambda: &[f64; 4], frame: &TetFrame) -> (f64, Vec3) {
    let at = |values: &[f64; 4]| values.iter().zip(lambda).map(|(v, l)| v * l).sum::<f64>();
    let least = pieces.iter().min_by(|a, b| at(a).total_cmp(&at(b))).copied().unwrap_or_default();
    (at(&least), (0..4).map(|b| least[b] * frame.gradient(b)).sum())
}

/// Mean of φ on the way to the face, over its value at the point.
fn mean_over_last(field: &FunctionField, (tet, frame): (TetId, &TetFrame), point: &Vec3, way: &Vec3) -> f64 {
    let phi = |t: f64| field.function.phi(tet, &frame.lambda_at(&(point - t * way)));
    let mean: f64 = gauss_legendre(POINTS).iter().map(|&(t, weight)| weight * phi(t)).sum();
    let last = phi(0.0);
    if last > 0.0 { mean / last } else { 0.0 }
}
