//! One rotation R per block: the frame in which its strains are small.

use ndda_mesh::{Mat3, Vec3};

use crate::block_operator::BlockOperator;

/// How a block's frame may turn.
#[derive(Clone, Debug, PartialEq)]
pub enum Frame {
    /// Any way: R is the rotation of the mass-weighted best affine map from the rest shape.
    Free {
        /// (Σ mᵢ Xᵢ Xᵢᵀ)⁻¹ [1/(kg m²)].
        inverse_moment: Mat3,
    },
    /// About a fixed axis: supports allow no other turn.
    About {
        /// Unit vector along the axis.
        axis: Vec3,
    },
    /// Not at all: supports hold the block, R = I.
    Held,
}

/// A block whose shape has no rotation any more.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the block is inverted or flat (mean det F = {determinant:e}): reduce step_s or the load")]
pub struct FrameError {
    /// Determinant of the best affine map from the rest shape.
    pub determinant: f64,
}

impl Frame {
    /// A frame that turns any way with the block.
    pub fn free(operator: &BlockOperator) -> Self {
        let weighted = operator.node_mass.iter().zip(&operator.rest);
        let moment: Mat3 = weighted.map(|(&m, x)| m * x * x.transpose()).sum();
        let inverse_moment = moment.try_inverse().expect("a validated block is not flat");
        Self::Free { inverse_moment }
    }

    /// Follows the masses of its block, all of which are multiplied by a factor.
    pub fn scale_mass(&mut self, factor: f64) {
        if let Self::Free { inverse_moment } = self {
            *inverse_moment /= factor;
        }
    }

    /// R of positions x with mass centre `center` [m].
    ///
    /// # Errors
    /// [`FrameError`] when the mean deformation has no positive determinant, or is not finite.
    pub fn rotation(
        &self,
        operator: &BlockOperator,
        position: &[Vec3],
        center: &Vec3,
    ) -> Result<Mat3, FrameError> {
        match self {
            Self::Free { inverse_moment } => {
                polar_rotation(&(mixed_moment(operator, position, center) * inverse_moment))
            }
            Self::About { axis } => Ok(rotation_about(axis, &mixed_moment(operator, position, center))),
            Self::Held => Ok(Mat3::identity()),
        }
    }
}

/// Σ mᵢ (xᵢ − c) Xᵢᵀ [kg m²].
fn mixed_moment(operator: &BlockOperator, position: &[Vec3], center: &Vec3) -> Mat3 {
    let mut moment = Mat3::zeros();
    for ((x, rest), &m) in position.iter().zip(&operator.rest).zip(&operator.node_mass) {
        moment += (m * (x - center)) * rest.transpose();
    }
    moment
}

/// The rotation R of F = R U, by Newton's iteration R ← (R + R⁻ᵀ)/2 (Higham 1986).
///
/// # Errors
/// [`FrameError`] when det F is not positive and finite.
pub fn polar_rotation(gradient: &Mat3) -> Result<Mat3, FrameError> {
    let determinant = gradient.determinant();
    if !(determinant > 0.0 && determinant.is_finite()) {
        return Err(FrameError { determinant });
    }
    let mut rotation = *gradient;
    let mut last_change = f64::INFINITY;
    // At most log₂(condition) halvings and a few quadratic steps.
    for _ in 0..100 {
        let next = 0.5 * (rotation + inverse_transpose(&rotation));
        let change = (next - rotation).amax();
        rotation = next;
        // Quadratic convergence: once the change stops shrinking it is round-off.
        if change == 0.0 || (change < 1e-8 && change >= 0.5 * last_change) || change < 1e-15 {
            return Ok(rotation);
        }
        last_change = change;
    }
    Err(FrameError { determinant })
}

/// F⁻ᵀ: cofactors over the determinant.
fn inverse_transpose(f: &Mat3) -> Mat3 {
    let (a, b, c) = (f.column(0), f.column(1), f.column(2));
    let (bc, ca, ab) = (b.cross(&c), c.cross(&a), a.cross(&b));
    Mat3::from_columns(&[bc, ca, ab]) / a.dot(&bc)
}

/// The rotation about `axis` that fits Σ m x Xᵀ best: tan θ = (n · Σ m X × x) / Σ m (x · X)⊥.
fn rotation_about(axis: &Vec3, moment: &Mat3) -> Mat3 {
    let turn = Vec3::new(
        moment[(2, 1)] - moment[(1, 2)],
        moment[(0, 2)] - moment[(2, 0)],
        moment[(1, 0)] - moment[(0, 1)],
    );
    let sine = axis.dot(&turn);
    let cosine = moment.trace() - axis.dot(&(moment * axis));
    let unit = nalgebra::Unit::new_normalize(*axis);
    nalgebra::Rotation3::from_axis_angle(&unit, sine.atan2(cosine)).into_inner()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear_elastic::LinearElastic;
    use nalgebra::Rotation3;

    fn operator() -> BlockOperator {
        let nodes = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 2.0, 0.0), (0.0, 0.0, 0.1)];
        let nodes = nodes.map(|(x, y, z)| Vec3::new(x, y, z));
        BlockOperator::new(&nodes, vec![[0, 1, 2, 3]], &LinearElastic::new(1e9, 0.2, 2e3).unwrap())
    }

    #[test]
    fn a_turned_block_gives_its_rotation_to_round_off() {
        let operator = operator();
        let frame = Frame::free(&operator);
        for angle in [1e-9, 0.1, 1.0, 3.0, std::f64::consts::PI - 1e-4] {
            let turn = Rotation3::new(Vec3::new(0.36, 0.48, -0.8) * angle).into_inner();
            let shift = Vec3::new(3.0, -2.0, 1.0);
            let position: Vec<Vec3> = operator.rest.iter().map(|x| turn * x + shift).collect();
            let rotation = frame.rotation(&operator, &position, &shift).unwrap();
            assert!((rotation - turn).amax() < 2e-14, "angle {angle}: {}", (rotation - turn).amax());
        }
    }

    #[test]
    fn a_frame_about_an_axis_sees_only_that_turn() {
        let operator = operator();
        let axis = Vec3::new(0.6, 0.0, 0.8);
        let turn = Rotation3::new(axis * 2.5).into_inner();
        let position: Vec<Vec3> = operator.rest.iter().map(|x| turn * x).collect();
        let rotation = Frame::About { axis }.rotation(&operator, &position, &Vec3::zeros()).unwrap();
        assert!((rotation - turn).amax() < 1e-14);
    }

    #[test]
    fn stretch_does_not_turn_the_frame() {
        let stretch = Mat3::new(1.5, 0.2, 0.0, 0.2, 0.8, 0.1, 0.0, 0.1, 1.1);
        let turn = Rotation3::new(Vec3::new(0.5, 1.0, -0.3)).into_inner();
        assert!((polar_rotation(&(turn * stretch)).unwrap() - turn).amax() < 1e-14);
    }

    #[test]
    fn an_inverted_or_broken_shape_is_refused() {
        assert!(polar_rotation(&Mat3::from_diagonal(&Vec3::new(1.0, 1.0, -1.0))).is_err());
        assert!(polar_rotation(&Mat3::repeat(f64::NAN)).is_err());
    }
}
