//! Planes by dip and dip direction, lines by trend and plunge. x is east, y north, z up.

use ndda_mesh::Vec3;
use ndda_mesh::cut::{dip_normal, sin_cos};
use serde::Serialize;

/// Planes whose normals have a smaller sine between them are parallel.
const PARALLEL: f64 = 1e-9;

/// A plane.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Orientation {
    /// Angle below the horizontal of its steepest line, 0 to 90 [°].
    pub dip_deg: f64,
    /// Azimuth of that line, clockwise from north [°].
    pub dip_direction_deg: f64,
}

/// A line.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Line {
    /// Azimuth of its lower end, clockwise from north, 0 to 360 [°].
    pub trend_deg: f64,
    /// Angle of its lower end below the horizontal, 0 to 90 [°].
    pub plunge_deg: f64,
}

impl Orientation {
    /// Upward unit normal (sin δ sin α, sin δ cos α, cos δ) of dip δ and dip direction α.
    pub fn normal(&self) -> Vec3 {
        dip_normal(self.dip_deg, self.dip_direction_deg)
    }

    /// The pole: the line normal to the plane, trend α + 180° and plunge 90° − δ.
    pub fn pole(&self) -> Line {
        let trend_deg = (self.dip_direction_deg + 180.0).rem_euclid(360.0);
        Line { trend_deg, plunge_deg: 90.0 - self.dip_deg }
    }

    /// The line of steepest descent, along which a block slides on the plane.
    pub fn dip_line(&self) -> Line {
        Line { trend_deg: self.dip_direction_deg.rem_euclid(360.0), plunge_deg: self.dip_deg }
    }

    /// The plane with a normal, upward or downward.
    pub fn of_normal(normal: &Vec3) -> Self {
        let up = if normal.z < 0.0 { -normal } else { *normal };
        let dip_deg = up.x.hypot(up.y).atan2(up.z).to_degrees();
        Self { dip_deg, dip_direction_deg: up.x.atan2(up.y).to_degrees().rem_euclid(360.0) }
    }

    /// Dip in a vertical section along an azimuth [°]: tan δ_a = tan δ cos(azimuth − α); below zero where the plane rises along it.
    pub fn apparent_dip_deg(&self, azimuth_deg: f64) -> f64 {
        let (sin, cos) = sin_cos(self.dip_deg);
        (sin * sin_cos(azimuth_deg - self.dip_direction_deg).1).atan2(cos).to_degrees()
    }

    /// The line in which two planes meet; none if they are parallel.
    pub fn intersection(&self, other: &Self) -> Option<Line> {
        let along = self.normal().cross(&other.normal());
        (along.norm() > PARALLEL).then(|| Line::of_vector(&along))
    }
}

impl Line {
    /// Unit vector towards the lower end: (cos p sin t, cos p cos t, −sin p) of trend t and plunge p.
    pub fn vector(&self) -> Vec3 {
        let ((sin_t, cos_t), (sin_p, cos_p)) = (sin_cos(self.trend_deg), sin_cos(self.plunge_deg));
        Vec3::new(cos_p * sin_t, cos_p * cos_t, -sin_p)
    }

    /// The line along a vector of any length, which may point upwards.
    pub fn of_vector(along: &Vec3) -> Self {
        let down = if along.z > 0.0 { -along } else { *along };
        // Of a level line, −0 is 0.
        let plunge_deg = (0.0 - down.z).atan2(down.x.hypot(down.y)).to_degrees();
        Self { trend_deg: down.x.atan2(down.y).to_degrees().rem_euclid(360.0), plunge_deg }
    }
}

/// Smallest angle between two azimuths, 0 to 180 [°].
pub fn between_deg(a: f64, b: f64) -> f64 {
    let turned = (a - b).rem_euclid(360.0);
    turned.min(360.0 - turned)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(dip_deg: f64, dip_direction_deg: f64) -> Orientation {
        Orientation { dip_deg, dip_direction_deg }
    }

    #[test]
    fn a_pole_is_normal_to_its_plane_and_the_dip_line_in_it() {
        for plane in [plane(40.0, 130.0), plane(0.0, 77.0), plane(90.0, 250.0), plane(12.5, 359.0)] {
            assert!((plane.pole().vector() + plane.normal()).norm() < 1e-15);
            assert!(plane.dip_line().vector().dot(&plane.normal()).abs() < 1e-15);
            let back = Orientation::of_normal(&plane.normal());
            assert!((back.dip_deg - plane.dip_deg).abs() < 1e-12);
        }
    }

    #[test]
    fn planes_that_dip_at_right_angles_meet_where_their_apparent_dips_agree() {
        // tan p = tan δ₁ cos(t − α₁) = tan δ₂ cos(t − α₂); with α₂ = α₁ + 90°, tan(t − α₁) = tan δ₁ / tan δ₂.
        let (a, b) = (plane(40.0, 130.0), plane(60.0, 220.0));
        let line = a.intersection(&b).unwrap();
        let [tan_a, tan_b] = [40.0f64, 60.0].map(|dip| dip.to_radians().tan());
        let turned = (tan_a / tan_b).atan();
        assert!((line.trend_deg - 130.0 - turned.to_degrees()).abs() < 1e-10, "{line:?}");
        assert!((line.plunge_deg - (tan_a * turned.cos()).atan().to_degrees()).abs() < 1e-10, "{line:?}");
        for plane in [a, b] {
            assert!((plane.apparent_dip_deg(line.trend_deg) - line.plunge_deg).abs() < 1e-10);
        }
        assert_eq!(a.intersection(&a), None);
        let level = Line::of_vector(&Vec3::new(1.0, 1.0, 0.0));
        assert_eq!(format!("{:.1}", level.plunge_deg), "0.0");
    }

    #[test]
    fn azimuths_are_compared_across_north() {
        assert_eq!(
            (between_deg(350.0, 15.0), between_deg(10.0, 190.0), between_deg(-10.0, 350.0)),
            (25.0, 180.0, 0.0)
        );
    }
}
