//! Volume, centroid and potentials of the overlap of two tetrahedra.

use crate::integration::linear::Linear;
use crate::integration::polyhedron::Polyhedron;
use crate::integration::polyhedron::faces_of;
use ndda_mesh::Vec3;
use ndda_mesh::geometry::{Aabb, tet_volume};

use crate::integration::double_double::Barycentric;
use crate::integration::tet_frame::TetFrame;

/// Part of the product of three edges below which a volume is rounding.
const FLAT: f64 = 8.0 * f64::EPSILON / 6.0;

/// Why a pair of tetrahedra has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PairError {
    /// A coordinate or the penalty is infinite or not a number, or too large to compute with.
    #[error("{0} is not finite, or too large to compute with")]
    NotFinite(&'static str),
    /// A tetrahedron without volume has no barycentric coordinates.
    #[error("the {0} is flat, its volume is zero to rounding: repair the mesh, or reduce step_s")]
    Flat(&'static str),
    /// The penalty must push.
    #[error("penalty_pa = {0}: must be positive")]
    Penalty(f64),
}

/// Overlap of two tetrahedra.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TetOverlap {
    /// Volume of c ∩ t [m³].
    pub volume_m3: f64,
    /// Its centroid [m]; none if the volume is zero.
    pub centroid: Option<Vec3>,
    /// ∫ φ_c dV over c ∩ t [m³], φ = 4 min λᵢ.
    pub phi_contactor_m3: f64,
    /// ∫ φ_t dV over c ∩ t [m³].
    pub phi_target_m3: f64,
}

/// Volume, centroid and potentials of c ∩ t, corners [m] in either order.
///
/// # Errors
/// [`PairError`] for corners that are not finite, for a flat tetrahedron, and for a result beyond the range of f64.
pub fn tet_overlap(contactor: &[Vec3; 4], target: &[Vec3; 4]) -> Result<TetOverlap, PairError> {
    ScaledPair::new(contactor, target)?.overlap()
}

/// Two tetrahedra of positive volume, divided by a power of two that makes the largest coordinate about one: nothing
/// is lost, and products of lengths stay in the range of f64.
pub(crate) struct ScaledPair {
    /// Contactor and target [`unit_m`](Self::unit_m).
    pub corners: [[Vec3; 4]; 2],
    /// Whether the first two corners are swapped.
    pub swapped: [bool; 2],
    /// Length that the caller's coordinates were divided by [m].
    pub unit_m: f64,
}

impl ScaledPair {
    pub(crate) fn new(contactor: &[Vec3; 4], target: &[Vec3; 4]) -> Result<Self, PairError> {
        let mut largest = 0.0f64;
        for (which, tet) in [("contactor", contactor), ("target", target)] {
            for v in tet.iter().flat_map(|x| x.iter()) {
                if !v.is_finite() {
                    return Err(PairError::NotFinite(which));
                }
                largest = largest.max(v.abs());
            }
        }
        let exponent = (largest.to_bits() >> 52) as i32 - 1023;
        let unit_m = 2f64.powi(exponent.clamp(-1000, 1000));
        let (c, c_swapped) = oriented(contactor.map(|x| x / unit_m), "contactor")?;
        let (t, t_swapped) = oriented(target.map(|x| x / unit_m), "target")?;
        Ok(Self { corners: [c, t], swapped: [c_swapped, t_swapped], unit_m })
    }

    /// Whether the boxes around the two share more than their rims; without that there is no overlap.
    pub(crate) fn may_overlap(&self) -> bool {
        let [c, t] = self.corners.each_ref().map(Aabb::around);
        (0..3).all(|i| c.min[i] < t.max[i] && t.min[i] < c.max[i])
    }

    /// The overlap in the caller's units.
    pub(crate) fn overlap(&self) -> Result<TetOverlap, PairError> {
        if !self.may_overlap() {
            return Ok(TetOverlap::default());
        }
        let smaller = usize::from(tet_volume(&self.corners[1]) < tet_volume(&self.corners[0]));
        // From here on coordinates are local to the smaller tetrahedron, which the larger one cuts: what is rounded is of its size.
        let (body, other) = (&self.corners[smaller], &self.corners[1 - smaller]);
        let origin = body[0];
        let own = faces_of(&TetFrame::new(body), &origin);
        let exact = Barycentric::new(other);
        let cutting =
            [0, 1, 2, 3].map(|b| Linear { value: exact.at(b, &origin), gradient: exact.gradient(b) });
        let mut overlap = Polyhedron::tet(&body.map(|x| x - origin));
        cutting.iter().for_each(|face| overlap.cut(face));
        let (volume, moment) = overlap.volume_and_moment();
        let cubed = |v: f64| v * self.unit_m * self.unit_m * self.unit_m;
        let mut part = Polyhedron::default();
        let fields = if smaller == 0 { [own, cutting] } else { [cutting, own] };
        let phi = fields.map(|lambda| {
            let of_region = lambda.map(|lambda| lambda.times(4.0));
            cubed(overlap.integral_of_smallest(&of_region, &mut part))
        });
        let volume_m3 = cubed(volume);
        // The quotient of two small numbers may be anywhere.
        let within = |x: Vec3| x.sup(&overlap.bounds().min).inf(&overlap.bounds().max);
        let centroid = (volume_m3 > 0.0).then(|| (within(moment / volume) + origin) * self.unit_m);
        let numbers = [volume_m3, phi[0], phi[1]];
        if !numbers.iter().chain(centroid.iter().flat_map(|x| x.iter())).all(|v| v.is_finite()) {
            return Err(PairError::NotFinite("a result"));
        }
        // Less than nothing is rounding.
        let [volume_m3, phi_contactor_m3, phi_target_m3] = numbers.map(|v| v.max(0.0));
        Ok(TetOverlap { volume_m3, centroid, phi_contactor_m3, phi_target_m3 })
    }
}

/// The corners with positive volume, and whether the first two had to be swapped.
fn oriented(corners: [Vec3; 4], which: &'static str) -> Result<([Vec3; 4], bool), PairError> {
    let edges = [1, 2, 3].map(|i| (corners[i] - corners[0]).norm());
    let volume = tet_volume(&corners);
    if volume.abs() <= FLAT * edges[0] * edges[1] * edges[2] || !volume.is_normal() {
        return Err(PairError::Flat(which));
    }
    let [a, b, c, d] = corners;
    Ok(if volume > 0.0 { (corners, false) } else { ([b, a, c, d], true) })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(shift: [f64; 3], scale: f64) -> [Vec3; 4] {
        let corners = [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()];
        corners.map(|x| scale * x + Vec3::from(shift))
    }

    #[test]
    fn an_overlap_has_its_centroid_and_potentials_in_either_order_of_corners() {
        let c = unit([4.5e6, 0.0, 0.0], 1.0);
        let inverted = [c[1], c[0], c[2], c[3]];
        let overlap = tet_overlap(&inverted, &c).unwrap();
        assert!((overlap.centroid.unwrap() - c.iter().sum::<Vec3>() / 4.0).norm() < 1e-9);
        // φ has the mean ¼.
        assert!((overlap.phi_contactor_m3 - 1.0 / 24.0).abs() < 1e-15);
        assert!((overlap.phi_target_m3 - 1.0 / 24.0).abs() < 1e-15);
        assert_eq!(tet_overlap(&c, &unit([0.0; 3], 1.0)), Ok(TetOverlap::default()));
    }

    #[test]
    fn a_pair_without_an_answer_is_refused() {
        let c = unit([0.0; 3], 1.0);
        let mut bad = c;
        bad[3] = (c[1] + c[2]) / 2.0;
        assert_eq!(tet_overlap(&c, &bad), Err(PairError::Flat("target")));
        bad[3].y = f64::INFINITY;
        assert_eq!(tet_overlap(&bad, &c), Err(PairError::NotFinite("contactor")));
        let huge = unit([0.0; 3], 1e200);
        assert_eq!(tet_overlap(&huge, &huge), Err(PairError::NotFinite("a result")));
    }
}
