//! How the pressure on a facet is spread: its second moments about its centre.

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{Mat3, Vec3};

use crate::affine::convex_target::ConvexBlocks;
use crate::integration::clip::{Form, Outline, Polygon};
use crate::integration::overlap_pair::ActiveFacet;
use crate::model::ContactInput;

/// Second moments that differ by less than this part are the same.
const TIE: f64 = 1e-6;
/// Facets of which less than this part touches count as a disc.
const SMALL: f64 = 1e-3;

/// Mean of d dᵀ over the part of a facet that touches, d being the arm from its centre of pressure [m²].
///
/// On a target that moves by an affine map the part is cut out by its faces, and φ is that of the face which is nearest at the centre; on
/// others the facet counts as its triangle, scaled down to the area that touches.
pub(crate) fn second_moment_m2(
    (input, hulls): (&ContactInput, &ConvexBlocks),
    touch: &ActiveFacet,
    area_m2: f64,
    center: &Vec3,
) -> Mat3 {
    let corners = input.blocks.triangle_corners(touch.triangle, input.position);
    let area_vector = triangle_area_vector(&corners);
    let (whole_m2, normal) = (area_vector.norm(), area_vector.normalize());
    if area_m2 > SMALL * whole_m2 {
        let found = match hulls.affine_target(touch.target) {
            Some(_) => of_cut_facet(hulls, touch, &corners, center),
            None => Some(of_triangle(&corners) * (area_m2 / whole_m2).min(1.0)),
        };
        if let Some(found) = found {
            return found;
        }
    }
    // A disc of the same area: mean x² = mean y² = A/4π.
    0.5 * area_m2 / std::f64::consts::TAU * (Mat3::identity() - normal * normal.transpose())
}

/// Mean of the two principal second moments in the plane of two unit vectors and half of their difference [m²], and the angle from the first vector to
/// the axis of the larger one; no angle where both are the same.
pub(crate) fn principal(second_moment_m2: &Mat3, [s, t]: &[Vec3; 2]) -> (f64, f64, Option<f64>) {
    let moment = |a: &Vec3, b: &Vec3| a.dot(&(second_moment_m2 * b));
    let (xx, xy, yy) = (moment(s, s), moment(s, t), moment(t, t));
    let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let spread = half.hypot(xy);
    (mean, spread, (spread > TIE * mean).then(|| 0.5 * xy.atan2(half)))
}

/// Angle of the axes of weights w at (x, y) whose second moments are the same, as those of a square: Σ w (x + iy)⁴ is real and negative along the axes
/// of weights that lie in the corners. None where the weights have no such axes, as those of a disc or of a triangle.
pub(crate) fn fourfold_angle(weights: impl Iterator<Item = (f64, [f64; 2])>) -> Option<f64> {
    let (mut real, mut imaginary, mut all) = (0.0, 0.0, 0.0);
    for (weight, [x, y]) in weights {
        all += weight * (x * x + y * y).powi(2);
        real += weight * (x * x * (x * x - 6.0 * y * y) + y.powi(4));
        imaginary += weight * 4.0 * x * y * (x * x - y * y);
    }
    (real.hypot(imaginary) > TIE * all).then(|| 0.25 * (-imaginary).atan2(-real))
}

/// Angle of an edge of a triangle: where no direction differs from others, it turns with the blocks.
pub(crate) fn edge_angle(corners: &[Vec3; 3], [s, t]: &[Vec3; 2]) -> f64 {
    let edge = corners[1] - corners[0];
    t.dot(&edge).atan2(s.dot(&edge))
}

/// Two unit vectors across a normal.
pub(crate) fn tangents(normal: &Vec3) -> [Vec3; 2] {
    let axis = [Vec3::x(), Vec3::y(), Vec3::z()][normal.iamin()];
    let first = normal.cross(&axis).normalize();
    [first, normal.cross(&first)]
}

/// Σ d dᵀ/12 for the corners about the centroid [m²].
pub(crate) fn of_triangle(corners: &[Vec3; 3]) -> Mat3 {
    let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    corners.iter().map(|x| (x - middle) * (x - middle).transpose()).sum::<Mat3>() / 12.0
}

fn of_cut_facet(
    hulls: &ConvexBlocks,
    touch: &ActiveFacet,
    corners: &[Vec3; 3],
    center: &Vec3,
) -> Option<Mat3> {
    let faces = hulls.faces_of(touch.target);
    let outline: &Outline = hulls.outline(touch.triangle, touch.target);
    let mut part = Polygon::all_of(outline);
    let form = |k: usize| Form::through(&corners.each_ref().map(|x| faces[k].phi(x)));
    (0..faces.len()).for_each(|k| part.cut(&form(k), 0.0));
    let nearest = (0..faces.len()).min_by(|a, b| faces[*a].phi(center).total_cmp(&faces[*b].phi(center)))?;
    let (along, across) = (corners[1] - corners[0], corners[2] - corners[0]);
    let place = |[s, t]: &[f64; 2]| corners[0] + along * *s + across * *t - center;
    let rim = part.corners();
    let first = place(rim.first()?);
    let (mut total, mut mean, mut moment) = (0.0, Vec3::zeros(), Mat3::zeros());
    for pair in rim[1..].windows(2) {
        let arms = [first, place(&pair[0]), place(&pair[1])];
        let area = triangle_area_vector(&arms).norm();
        let phi = arms.map(|d| faces[nearest].phi(&(center + d)).max(0.0));
        let (sum, all) = (phi.iter().sum::<f64>(), arms[0] + arms[1] + arms[2]);
        // ∫ φ dA, ∫ φ d dA and ∫ φ d dᵀ dA of linear φ and d.
        let weighted: Vec3 = arms.iter().zip(phi).map(|(d, phi)| d * phi).sum();
        let squares = |weights: [f64; 3]| -> Mat3 {
            arms.iter().zip(weights).map(|(d, w)| w * d * d.transpose()).sum()
        };
        total += area / 3.0 * sum;
        mean += area / 12.0 * (all * sum + weighted);
        moment += area / 60.0
            * (sum * (all * all.transpose() + squares([1.0; 3]))
                + weighted * all.transpose()
                + all * weighted.transpose()
                + 2.0 * squares(phi));
    }
    let (mean, moment) = (mean / total, moment / total);
    let about_the_mean = moment - mean * mean.transpose();
    (total > 0.0 && about_the_mean.trace() > 0.0).then_some(about_the_mean)
}
