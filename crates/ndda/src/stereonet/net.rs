//! Nets: the lower hemisphere on a disc of radius 1.

use ndda_mesh::Vec3;
use serde::Serialize;

use super::orientation::{Line, Orientation};

/// A projection of the lower hemisphere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Net {
    /// Equal area (Schmidt): densities of poles may be compared.
    #[default]
    Area,
    /// Equal angle (Wulff): circles remain circles.
    Angle,
}

impl std::str::FromStr for Net {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "area" => Ok(Self::Area),
            "angle" => Ok(Self::Angle),
            _ => Err("write area (equal area, Schmidt) or angle (equal angle, Wulff)".into()),
        }
    }
}

impl Net {
    /// Distance from the centre of a line of some plunge: √2 sin(θ/2) or tan(θ/2) with θ = 90° − plunge
    /// (Priest, Discontinuity analysis for rock engineering, 1993, section 3.2).
    pub fn radius(self, plunge_deg: f64) -> f64 {
        let half = (0.5 * (90.0 - plunge_deg)).to_radians();
        match self {
            Self::Area => std::f64::consts::SQRT_2 * half.sin(),
            Self::Angle => half.tan(),
        }
    }

    /// Place of a line: to the right is east, upwards is north.
    pub fn place(self, line: &Line) -> [f64; 2] {
        let (sin, cos) = line.trend_deg.to_radians().sin_cos();
        let radius = self.radius(line.plunge_deg);
        [radius * sin, radius * cos]
    }

    /// The great circle of a plane as points from one end of its strike to the other.
    pub fn great_circle(self, plane: &Orientation, points: usize) -> Vec<[f64; 2]> {
        let strike = Vec3::new(
            -plane.dip_direction_deg.to_radians().cos(),
            plane.dip_direction_deg.to_radians().sin(),
            0.0,
        );
        let down = plane.dip_line().vector();
        let last = points.max(2) - 1;
        (0..=last)
            .map(|i| {
                let (sin, cos) = (std::f64::consts::PI * i as f64 / last as f64).sin_cos();
                // The ends are on the rim, on either side of it by rounding; the first is that of the strike.
                let vector = cos * strike + sin * down;
                let plunge_deg = (-vector.z).clamp(0.0, 1.0).asin().to_degrees();
                let trend_deg = vector.x.atan2(vector.y).to_degrees();
                self.place(&Line { trend_deg, plunge_deg })
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pole_is_where_the_formula_of_the_net_puts_it() {
        // The pole of 40/130 has trend 310° and plunge 50°; θ/2 = 20°.
        let pole = Orientation { dip_deg: 40.0, dip_direction_deg: 130.0 }.pole();
        let direction = [310f64.to_radians().sin(), 310f64.to_radians().cos()];
        let twenty = 20f64.to_radians();
        for (net, radius) in [(Net::Area, 2f64.sqrt() * twenty.sin()), (Net::Angle, twenty.tan())] {
            let place = net.place(&pole);
            assert!((0..2).all(|i| (place[i] - radius * direction[i]).abs() < 1e-14), "{place:?}");
            assert!((net.radius(0.0) - 1.0).abs() < 1e-15 && net.radius(90.0) == 0.0);
        }
    }

    #[test]
    fn great_circles_of_the_equal_angle_net_are_arcs_of_circles() {
        // Radius 1 / cos δ about a point at tan δ from the centre, opposite to the dip (Priest 1993).
        for (dip_deg, dip_direction_deg) in [(30.0, 0.0), (65.0, 130.0), (5.0, 280.0)] {
            let plane = Orientation { dip_deg, dip_direction_deg };
            let (dip, direction) = (f64::to_radians(dip_deg), f64::to_radians(dip_direction_deg));
            let centre = [-dip.tan() * direction.sin(), -dip.tan() * direction.cos()];
            for [x, y] in Net::Angle.great_circle(&plane, 31) {
                let radius = (x - centre[0]).hypot(y - centre[1]);
                assert!((radius - 1.0 / dip.cos()).abs() < 1e-9, "{x} {y}: {radius}");
            }
        }
    }

    #[test]
    fn great_circles_are_normal_to_their_poles_on_both_nets() {
        let plane = Orientation { dip_deg: 50.0, dip_direction_deg: 75.0 };
        for net in [Net::Area, Net::Angle] {
            let circle = net.great_circle(&plane, 41);
            assert!((circle[0][0].hypot(circle[0][1]) - 1.0).abs() < 1e-9);
            // The middle is the dip line.
            let middle = net.place(&plane.dip_line());
            assert!((circle[20][0] - middle[0]).hypot(circle[20][1] - middle[1]) < 1e-12);
        }
    }
}
