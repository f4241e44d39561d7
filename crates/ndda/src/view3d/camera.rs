//! Where a picture is seen from: a parallel projection, in which a metre is equally long everywhere.

use std::str::FromStr;

use ndda_mesh::Vec3;
use ndda_mesh::cut::sin_cos;

/// The names of directions, with azimuth and elevation [°].
const NAMED: [(&str, f64, f64); 4] =
    [("iso", 150.0, 30.0), ("front", 180.0, 0.0), ("side", 90.0, 0.0), ("top", 180.0, 90.0)];

/// Direction that a picture is seen from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Where the viewer stands, clockwise from north, which is y [°].
    pub azimuth_deg: f64,
    /// How high the viewer stands above the horizontal [°], −90 to 90.
    pub elevation_deg: f64,
}

impl Default for View {
    fn default() -> Self {
        Self { azimuth_deg: NAMED[0].1, elevation_deg: NAMED[0].2 }
    }
}

impl FromStr for View {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Some(&(_, azimuth_deg, elevation_deg)) = NAMED.iter().find(|(name, ..)| *name == text) {
            return Ok(Self { azimuth_deg, elevation_deg });
        }
        let numbers: Vec<f64> = text.split(',').map_while(|part| part.trim().parse().ok()).collect();
        match numbers[..] {
            [azimuth_deg, elevation_deg]
                if text.split(',').count() == 2
                    && azimuth_deg.is_finite()
                    && (-90.0..=90.0).contains(&elevation_deg) =>
            {
                Ok(Self { azimuth_deg, elevation_deg })
            }
            _ => Err(
                "write iso, top, front or side, or AZIMUTH,ELEVATION of the viewer in degrees (elevation \
                      -90 to 90), as 150,30"
                    .into(),
            ),
        }
    }
}

/// Bounds in the plane of a picture [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Left and lower end.
    pub least: [f64; 2],
    /// Right and upper end.
    pub most: [f64; 2],
}

impl Bounds {
    /// Bounds of nothing.
    pub const EMPTY: Self = Self { least: [f64::INFINITY; 2], most: [f64::NEG_INFINITY; 2] };

    /// Takes in a point.
    pub fn grow(&mut self, point: [f64; 2]) {
        for (i, x) in point.into_iter().enumerate() {
            self.least[i] = self.least[i].min(x);
            self.most[i] = self.most[i].max(x);
        }
    }

    /// Whether there is no point in them.
    pub fn is_empty(&self) -> bool {
        self.least[0] > self.most[0]
    }

    /// Width and height [m].
    pub fn size(&self) -> [f64; 2] {
        [0, 1].map(|i| self.most[i] - self.least[i])
    }

    /// Bounds with `part` of the larger side more on all sides, but not beyond `limit`.
    pub fn with_surroundings(&self, part: f64, limit: &Self) -> Self {
        let [width, height] = self.size();
        let more = part * width.max(height);
        Self {
            least: [0, 1].map(|i| (self.least[i] - more).max(limit.least[i])),
            most: [0, 1].map(|i| (self.most[i] + more).min(limit.most[i])),
        }
    }
}

/// A part of a picture [px], its origin at the upper left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pane {
    /// Left end.
    pub x: f64,
    /// Upper end.
    pub y: f64,
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
}

/// The axes of a picture in space, of unit length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    /// To the right.
    pub right: Vec3,
    /// Upwards.
    pub up: Vec3,
    /// Towards the viewer.
    pub towards: Vec3,
}

impl Axes {
    /// The axes of a view: towards = (sin A cos E, cos A cos E, sin E) of azimuth A and elevation E, right is horizontal,
    /// up = towards × right.
    pub fn new(view: View) -> Self {
        let (sin_a, cos_a) = sin_cos(view.azimuth_deg);
        let (sin_e, cos_e) = sin_cos(view.elevation_deg);
        let towards = Vec3::new(sin_a * cos_e, cos_a * cos_e, sin_e);
        let right = Vec3::new(-cos_a, sin_a, 0.0);
        Self { right, up: towards.cross(&right), towards }
    }

    /// Place in the plane of the picture, and distance towards the viewer [m].
    pub fn plane(&self, x: &Vec3) -> ([f64; 2], f64) {
        ([self.right.dot(x), self.up.dot(x)], self.towards.dot(x))
    }
}

/// A projection of space on a pane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Axes in space.
    pub axes: Axes,
    /// Pixels of a metre.
    pub px_per_m: f64,
    /// Point in the plane of the picture that is in the middle of the pane [m].
    centre: [f64; 2],
    /// Middle of the pane [px].
    middle: [f64; 2],
}

impl Camera {
    /// The camera whose pane just holds the bounds.
    pub fn fit(axes: Axes, bounds: &Bounds, pane: &Pane) -> Self {
        let [width, height] = bounds.size();
        let fits = (pane.width / width).min(pane.height / height);
        Self {
            axes,
            px_per_m: if fits.is_finite() && fits > 0.0 { fits } else { 1.0 },
            centre: [0, 1].map(|i| 0.5 * (bounds.least[i] + bounds.most[i])),
            middle: [pane.x + 0.5 * pane.width, pane.y + 0.5 * pane.height],
        }
    }

    /// Column, row (downwards) and nearness to the viewer of a point, all in pixels.
    pub fn project(&self, x: &Vec3) -> [f64; 3] {
        let ([right, up], towards) = self.axes.plane(x);
        [
            self.middle[0] + self.px_per_m * (right - self.centre[0]),
            self.middle[1] - self.px_per_m * (up - self.centre[1]),
            self.px_per_m * towards,
        ]
    }

    /// The same projection with `factor` times as many pixels on each side.
    pub fn scaled(&self, factor: f64) -> Self {
        Self { px_per_m: factor * self.px_per_m, middle: self.middle.map(|m| factor * m), ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axes(text: &str) -> Axes {
        Axes::new(text.parse().unwrap())
    }

    #[test]
    fn the_named_views_have_the_axes_of_a_drawing() {
        let (x, y, z) = (Vec3::x(), Vec3::y(), Vec3::z());
        assert_eq!(axes("front"), Axes { right: x, up: z, towards: -y });
        assert_eq!(axes("side"), Axes { right: y, up: z, towards: x });
        assert_eq!(axes("top"), Axes { right: x, up: y, towards: z });
    }

    #[test]
    fn the_axes_of_any_view_are_orthonormal_and_right_handed() {
        for (azimuth_deg, elevation_deg) in [(150.0, 30.0), (-20.0, -75.0), (271.3, 12.5)] {
            let Axes { right, up, towards } = Axes::new(View { azimuth_deg, elevation_deg });
            assert!((right.cross(&up) - towards).norm() < 1e-15 && (up.norm() - 1.0).abs() < 1e-15);
            assert!(right.z == 0.0 && up.z >= 0.0);
            // The bearing of the viewer from the centre is the azimuth, and the height above the horizontal the elevation.
            let bearing = towards.x.atan2(towards.y).to_degrees().rem_euclid(360.0);
            assert!((bearing - f64::rem_euclid(azimuth_deg, 360.0)).abs() < 1e-9, "{bearing}");
            assert!((towards.z.asin().to_degrees() - elevation_deg).abs() < 1e-9);
        }
    }

    #[test]
    fn a_cube_in_isometric_view_is_a_regular_hexagon() {
        // atan(1/√2) above the horizontal and between two axes, all edges of a cube are √(2/3) long.
        let view = View { azimuth_deg: 135.0, elevation_deg: (0.5f64.sqrt()).atan().to_degrees() };
        let axes = Axes::new(view);
        for edge in [Vec3::x(), Vec3::y(), Vec3::z()] {
            let ([a, b], _) = axes.plane(&edge);
            assert!((a.hypot(b) - (2.0f64 / 3.0).sqrt()).abs() < 1e-12);
        }
    }

    #[test]
    fn bounds_fill_the_pane_in_one_direction_and_are_in_its_middle() {
        let bounds = Bounds { least: [1.0, 10.0], most: [5.0, 11.0] };
        let pane = Pane { x: 10.0, y: 20.0, width: 400.0, height: 300.0 };
        let camera = Camera::fit(axes("front"), &bounds, &pane);
        assert_eq!(camera.px_per_m, 100.0);
        assert_eq!(camera.project(&Vec3::new(1.0, 0.0, 11.0)), [10.0, 120.0, 0.0]);
        assert_eq!(camera.project(&Vec3::new(5.0, -2.0, 10.0)), [410.0, 220.0, 200.0]);
        assert_eq!(camera.scaled(2.0).project(&Vec3::new(5.0, 0.0, 10.0)), [820.0, 440.0, 0.0]);
    }

    #[test]
    fn what_is_no_direction_is_refused_with_an_example() {
        for text in ["", "1", "1,2,3", "a,b", "10,91", "nan,3", "isometric", "10,20,x"] {
            assert!(text.parse::<View>().unwrap_err().contains("150,30"), "{text}");
        }
        assert_eq!("-30, 45".parse(), Ok(View { azimuth_deg: -30.0, elevation_deg: 45.0 }));
    }
}
