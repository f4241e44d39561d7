//! Planes by normal or by dip and dip direction.

use super::CutError;
use crate::Vec3;
use crate::geometry::Aabb;

/// The points x with n · x = offset; `height` is positive on the side that the normal points to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    normal: Vec3,
    offset_m: f64,
}

impl Plane {
    /// The plane through a point with a normal of any length.
    ///
    /// # Errors
    /// [`CutError::Plane`] when the normal has no direction or a number is not finite.
    pub fn new(point_m: Vec3, normal: Vec3) -> Result<Self, CutError> {
        let scale = normal.amax();
        let unit = (normal / scale).normalize();
        let plane = Self { normal: unit, offset_m: unit.dot(&point_m) };
        if plane.offset_m.is_finite() && scale > 0.0 && scale.is_finite() {
            Ok(plane)
        } else {
            Err(CutError::Plane { point_m: point_m.into(), normal: normal.into() })
        }
    }

    /// The plane through a point with that dip (0 horizontal, 90 vertical) and dip direction (clockwise from north).
    ///
    /// # Errors
    /// [`CutError::Plane`] or [`CutError::Angle`] when a number is not finite or the dip is not within 0 to 90.
    pub fn dipping(dip_deg: f64, dip_direction_deg: f64, point_m: Vec3) -> Result<Self, CutError> {
        check_dip(dip_deg, dip_direction_deg)?;
        Self::new(point_m, dip_normal(dip_deg, dip_direction_deg))
    }

    /// Unit normal.
    pub fn normal(&self) -> &Vec3 {
        &self.normal
    }

    /// Signed distance of a point [m], positive on the side of the normal.
    pub fn height_m(&self, point_m: &Vec3) -> f64 {
        self.normal.dot(point_m) - self.offset_m
    }

    /// Whether the plane comes within `margin_m` of the box.
    pub fn touches(&self, bounds: &Aabb, margin_m: f64) -> bool {
        let half = (bounds.max - bounds.min) * 0.5;
        self.height_m(&bounds.center()).abs() <= self.normal.abs().dot(&half) + margin_m
    }
}

pub(super) fn check_dip(dip_deg: f64, dip_direction_deg: f64) -> Result<(), CutError> {
    if !(0.0..=90.0).contains(&dip_deg) {
        return Err(CutError::Angle { what: "dip", value_deg: dip_deg, least: 0.0, most: 90.0 });
    }
    if !(-360.0..=360.0).contains(&dip_direction_deg) {
        let (what, value_deg) = ("dip direction", dip_direction_deg);
        return Err(CutError::Angle { what, value_deg, least: -360.0, most: 360.0 });
    }
    Ok(())
}

/// Upward unit normal of a dipping plane: (sin δ sin α, sin δ cos α, cos δ) with dip δ and dip direction α.
///
/// x is east, y is north, z is up; the dip direction is clockwise from north, the dip downward from horizontal.
/// Multiples of 90° are exact.
pub fn dip_normal(dip_deg: f64, dip_direction_deg: f64) -> Vec3 {
    let (sin_dip, cos_dip) = sin_cos(dip_deg);
    let (sin_direction, cos_direction) = sin_cos(dip_direction_deg);
    Vec3::new(sin_dip * sin_direction, sin_dip * cos_direction, cos_dip)
}

/// Sine and cosine of degrees, exact at multiples of 90°.
pub fn sin_cos(angle_deg: f64) -> (f64, f64) {
    let turns = (angle_deg / 90.0).round();
    let (sin, cos) = (angle_deg - 90.0 * turns).to_radians().sin_cos();
    match turns.rem_euclid(4.0) as u32 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_that_dips_east_falls_along_x() {
        let plane = Plane::dipping(30.0, 90.0, Vec3::new(0.0, 0.0, 5.0)).unwrap();
        let below = Vec3::new(3f64.sqrt(), 7.0, 4.0);
        assert!(plane.height_m(&below).abs() < 1e-14);
        assert!(plane.normal().z > 0.0 && plane.normal().x > 0.0);
    }

    #[test]
    fn right_angles_are_exact() {
        assert_eq!(dip_normal(90.0, 90.0), Vec3::x());
        assert_eq!(dip_normal(90.0, 180.0), -Vec3::y());
        assert_eq!(dip_normal(0.0, 45.0), Vec3::z());
        assert_eq!(sin_cos(-90.0), (-1.0, 0.0));
    }

    #[test]
    fn planes_without_direction_and_dips_beyond_vertical_are_refused() {
        assert!(Plane::new(Vec3::zeros(), Vec3::zeros()).is_err());
        assert!(Plane::new(Vec3::zeros(), Vec3::repeat(f64::NAN)).is_err());
        assert!(Plane::new(Vec3::repeat(f64::INFINITY), Vec3::x()).is_err());
        assert!(Plane::dipping(91.0, 0.0, Vec3::zeros()).is_err());
        assert!(Plane::dipping(10.0, f64::NAN, Vec3::zeros()).is_err());
        assert!(Plane::new(Vec3::zeros(), Vec3::repeat(1e-300)).is_ok());
    }
}
