//! Kinematic checks of a slope: which planes and lines of intersection may slide out of it, and which may topple.
//!
//! After Markland (A useful technique for estimating the stability of rock slopes when the rigid wedge sliding type of failure is
//! expected, Imperial College Rock Mechanics Research Report 19, 1972), Goodman & Bray (Toppling of rock slopes, ASCE 1976) and
//! Wyllie & Mah (Rock slope engineering, 2004, chapters 6 and 9). They ask for directions and friction only: neither cohesion nor
//! water nor the extent of joints is in them.

use serde::Serialize;

use super::orientation::{Line, Orientation, between_deg};

/// Angles nearer to each other than this are equal [°].
const ROUNDING_DEG: f64 = 1e-9;

/// A slope that is checked.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Slope {
    /// The face.
    pub face: Orientation,
    /// Friction of the joints φ [°].
    pub friction_deg: f64,
    /// Planes slide if they dip within this angle of the face's dip direction [°].
    pub sliding_lateral_deg: f64,
    /// Planes topple if they dip within this angle of the direction opposite to the face's [°].
    pub toppling_lateral_deg: f64,
}

/// Planes or lines that meet a criterion, out of all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Count {
    /// Number that meets the criterion.
    pub critical: usize,
    /// Number of all.
    pub of: usize,
}

/// Result of the checks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Checks {
    /// Planes that may slide.
    pub plane_sliding: Count,
    /// Lines of intersection of two planes along which wedges may slide.
    pub wedge_sliding: Count,
    /// Planes that may topple by bending.
    pub flexural_toppling: Count,
}

impl Slope {
    /// Whether a line that descends comes out of the face: its plunge is less than the apparent dip of the face along its trend.
    /// A line of the face itself does not, whatever its rounding.
    pub fn daylights(&self, line: &Line) -> bool {
        line.plunge_deg < self.face.apparent_dip_deg(line.trend_deg) - ROUNDING_DEG
    }

    /// Plane sliding (Markland 1972): the plane is steeper than friction, its dip line daylights, and it dips within the lateral limit
    /// (20° by Wyllie & Mah 2004) of the face.
    pub fn slides(&self, plane: &Orientation) -> bool {
        plane.dip_deg > self.friction_deg
            && self.daylights(&plane.dip_line())
            && between_deg(plane.dip_direction_deg, self.face.dip_direction_deg) <= self.sliding_lateral_deg
    }

    /// Wedge sliding (Markland 1972): the line of intersection plunges more steeply than friction and daylights. Friction on two planes
    /// holds a wedge better than on one, so the check is on the safe side.
    pub fn wedge_slides(&self, line: &Line) -> bool {
        line.plunge_deg > self.friction_deg && self.daylights(line)
    }

    /// Flexural toppling (Goodman & Bray 1976): layers slip on each other, 90° − δ ≤ ψ − φ for a face of dip ψ, and dip into the slope
    /// within the lateral limit (30° by Goodman, Introduction to rock mechanics, 1989). An upright plane dips either way.
    pub fn topples(&self, plane: &Orientation) -> bool {
        let into = self.face.dip_direction_deg + 180.0;
        let from_into = between_deg(plane.dip_direction_deg, into);
        let is_upright = plane.dip_deg >= 90.0 - ROUNDING_DEG;
        let from_into = if is_upright { from_into.min(180.0 - from_into) } else { from_into };
        90.0 - plane.dip_deg <= self.face.dip_deg - self.friction_deg
            && from_into <= self.toppling_lateral_deg
    }

    /// Why no wedge slides along a line; none where one may.
    pub fn holds_wedge(&self, line: &Line) -> Option<&'static str> {
        match (line.plunge_deg > self.friction_deg, self.daylights(line)) {
            (true, true) => None,
            (false, true) => Some("flatter than φ"),
            (true, false) => Some("it does not come out of the face"),
            (false, false) => Some("flatter than φ, and it does not come out of the face"),
        }
    }

    /// All checks of all planes; wedges are those of two planes of different sets.
    pub fn checks(&self, planes: &[Orientation], set_of: &[usize]) -> Checks {
        let count = |meets: &dyn Fn(&Orientation) -> bool| Count {
            critical: planes.iter().filter(|plane| meets(plane)).count(),
            of: planes.len(),
        };
        let mut wedge_sliding = Count::default();
        for (i, plane) in planes.iter().enumerate() {
            let others = (i + 1..planes.len()).filter(|&j| set_of[j] != set_of[i]);
            for line in others.filter_map(|j| plane.intersection(&planes[j])) {
                wedge_sliding.of += 1;
                wedge_sliding.critical += usize::from(self.wedge_slides(&line));
            }
        }
        Checks {
            plane_sliding: count(&|plane| self.slides(plane)),
            wedge_sliding,
            flexural_toppling: count(&|plane| self.topples(plane)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(dip_deg: f64, dip_direction_deg: f64) -> Orientation {
        Orientation { dip_deg, dip_direction_deg }
    }

    fn slope(dip_deg: f64, dip_direction_deg: f64, friction_deg: f64) -> Slope {
        Slope {
            face: plane(dip_deg, dip_direction_deg),
            friction_deg,
            sliding_lateral_deg: 20.0,
            toppling_lateral_deg: 30.0,
        }
    }

    #[test]
    fn planes_slide_between_friction_and_the_face_and_within_the_lateral_limit() {
        let slope = slope(60.0, 180.0, 30.0);
        for (dip, direction, slides) in [
            (35.0, 180.0, true),
            (29.9, 180.0, false),
            (60.1, 180.0, false),
            (59.9, 180.0, true),
            (35.0, 199.9, true),
            (35.0, 200.1, false),
            (35.0, 0.0, false),
            // 20° beside the face's direction, tan δ_a = tan 60° cos 20° gives 58.43°.
            (58.4, 160.0, true),
            (58.5, 160.0, false),
        ] {
            assert_eq!(slope.slides(&plane(dip, direction)), slides, "{dip}/{direction}");
        }
    }

    #[test]
    fn the_wedge_of_40_130_and_60_220_slides_where_its_line_is_steeper_than_friction_and_daylights() {
        let line = plane(40.0, 130.0).intersection(&plane(60.0, 220.0)).unwrap();
        // Trend 155.85° and plunge 37.06°, by the closed form in the tests of orientations.
        assert!(slope(65.0, 156.0, 30.0).wedge_slides(&line));
        assert!(
            !slope(65.0, 156.0, 37.1).wedge_slides(&line) && slope(65.0, 156.0, 37.0).wedge_slides(&line)
        );
        assert!(
            !slope(37.0, 155.85, 30.0).wedge_slides(&line) && slope(37.1, 155.85, 30.0).wedge_slides(&line)
        );
        assert!(!slope(65.0, 336.0, 30.0).wedge_slides(&line));
    }

    #[test]
    fn layers_topple_when_they_slip_on_each_other_and_dip_into_the_slope() {
        // 90° − δ ≤ 60° − 30°: from a dip of 60° on.
        let slope = slope(60.0, 180.0, 30.0);
        for (dip, direction, topples) in [
            (60.0, 0.0, true),
            (59.9, 0.0, false),
            (85.0, 29.9, true),
            (85.0, 30.1, false),
            (85.0, 330.1, true),
            (85.0, 180.0, false),
        ] {
            assert_eq!(slope.topples(&plane(dip, direction)), topples, "{dip}/{direction}");
        }
    }

    #[test]
    fn an_upright_plane_topples_whichever_of_its_two_directions_is_written() {
        let slope = slope(65.0, 120.0, 30.0);
        for direction in [120.0, 300.0, 91.0, 329.0] {
            assert!(slope.topples(&plane(90.0, direction)), "{direction}");
        }
        assert!(!slope.topples(&plane(90.0, 210.0)) && !slope.topples(&plane(89.0, 120.0)));
    }

    #[test]
    fn a_line_in_the_face_does_not_come_out_of_it_and_the_reason_that_holds_a_wedge_is_said() {
        let slope = slope(65.0, 120.0, 30.0);
        for direction in [30.0, 200.0, 285.0] {
            let line = slope.face.intersection(&plane(60.0, direction)).unwrap();
            assert!(!slope.daylights(&line), "{line:?}");
        }
        for (trend_deg, plunge_deg, why) in [
            (120.0, 40.0, None),
            (120.0, 20.0, Some("flatter than φ")),
            (120.0, 70.0, Some("it does not come out of the face")),
            (300.0, 5.0, Some("flatter than φ, and it does not come out of the face")),
        ] {
            assert_eq!(slope.holds_wedge(&Line { trend_deg, plunge_deg }), why);
        }
    }

    #[test]
    fn wedges_are_counted_between_planes_of_different_sets() {
        let planes = [plane(40.0, 130.0), plane(40.0, 130.0), plane(60.0, 220.0)];
        let checks = slope(65.0, 156.0, 30.0).checks(&planes, &[0, 0, 1]);
        assert_eq!(checks.wedge_sliding, Count { critical: 2, of: 2 });
        assert_eq!(checks.plane_sliding.of, 3);
        // Parallel planes do not meet.
        let checks = slope(65.0, 156.0, 30.0).checks(&planes[..2], &[0, 1]);
        assert_eq!(checks.wedge_sliding, Count { critical: 0, of: 0 });
    }
}
