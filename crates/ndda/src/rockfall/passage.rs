//! What is known of a boulder at a place of its path.

use serde::{Deserialize, Serialize};

/// A boulder at a moment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Moment {
    /// Time since its release [s].
    pub time_s: f64,
    /// Its mass centre, in the coordinates of the scene [m].
    pub at_m: [f64; 3],
    /// Velocity of the mass centre [m/s].
    pub velocity_m_s: [f64; 3],
    /// Height of the mass centre above the ground below it [m].
    pub height_m: f64,
    /// Height of its highest point above the ground below the mass centre [m]: what a barrier has to stop.
    pub top_m: f64,
    /// Energy of its motion as a whole [J].
    pub translation_j: f64,
    /// Energy of its rotation [J].
    pub rotation_j: f64,
}

impl Moment {
    /// Speed of the mass centre [m/s].
    pub fn speed_m_s(&self) -> f64 {
        self.velocity_m_s.iter().map(|v| v * v).sum::<f64>().sqrt()
    }

    /// Kinetic energy [J].
    pub fn energy_j(&self) -> f64 {
        self.translation_j + self.rotation_j
    }

    /// Place on the map [m].
    pub fn map_m(&self) -> [f64; 2] {
        [self.at_m[0], self.at_m[1]]
    }

    /// Between this moment and a later one: `part` of the way.
    pub fn towards(&self, later: &Self, part: f64) -> Self {
        let mix = |a: f64, b: f64| a + part * (b - a);
        let mix3 = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|i| mix(a[i], b[i]));
        Self {
            time_s: mix(self.time_s, later.time_s),
            at_m: mix3(self.at_m, later.at_m),
            velocity_m_s: mix3(self.velocity_m_s, later.velocity_m_s),
            height_m: mix(self.height_m, later.height_m),
            top_m: mix(self.top_m, later.top_m),
            translation_j: mix(self.translation_j, later.translation_j),
            rotation_j: mix(self.rotation_j, later.rotation_j),
        }
    }
}

/// Part of the way from `a` to `b` at which a line through corners is crossed first, if it is.
pub(super) fn crossing(line_m: &[[f64; 2]], a: [f64; 2], b: [f64; 2]) -> Option<f64> {
    let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    let mut first: Option<f64> = None;
    for piece in line_m.windows(2) {
        let [ex, ey] = [piece[1][0] - piece[0][0], piece[1][1] - piece[0][1]];
        let [fx, fy] = [piece[0][0] - a[0], piece[0][1] - a[1]];
        let across = dx * ey - dy * ex;
        if across == 0.0 {
            continue;
        }
        let (way, along) = ((fx * ey - fy * ex) / across, (fx * dy - fy * dx) / across);
        // Of two moments in a row on either side, only the first begins beyond the line.
        if way > 0.0 && way <= 1.0 && (0.0..=1.0).contains(&along) {
            first = Some(first.map_or(way, |known: f64| known.min(way)));
        }
    }
    first
}

/// Distance from the start of a line through corners to the place on it that is nearest to a point [m].
pub(super) fn chainage_m(line_m: &[[f64; 2]], at_m: [f64; 2]) -> f64 {
    nearest_m(line_m, at_m).1
}

/// Distance of a point from a line through corners [m].
pub(super) fn distance_m(line_m: &[[f64; 2]], at_m: [f64; 2]) -> f64 {
    nearest_m(line_m, at_m).0
}

/// Distance of a point from the nearest place on a line through corners, and of that from the start of the line [m].
fn nearest_m(line_m: &[[f64; 2]], at_m: [f64; 2]) -> (f64, f64) {
    let (mut before, mut best) = (0.0, (f64::INFINITY, 0.0));
    for piece in line_m.windows(2) {
        let along = [0, 1].map(|i| piece[1][i] - piece[0][i]);
        let arm = [0, 1].map(|i| at_m[i] - piece[0][i]);
        let length = along[0].hypot(along[1]);
        if length == 0.0 {
            continue;
        }
        let way = ((arm[0] * along[0] + arm[1] * along[1]) / length).clamp(0.0, length);
        let off = (arm[0] - way / length * along[0]).hypot(arm[1] - way / length * along[1]);
        if off < best.0 {
            best = (off, before + way);
        }
        before += length;
    }
    best
}

/// Length of a line through corners [m].
pub(super) fn length_m(line_m: &[[f64; 2]]) -> f64 {
    line_m.windows(2).map(|piece| (piece[1][0] - piece[0][0]).hypot(piece[1][1] - piece[0][1])).sum()
}

/// The point at a distance from the start of a line through corners [m].
pub(super) fn point_at(line_m: &[[f64; 2]], chainage_m: f64) -> [f64; 2] {
    let mut left = chainage_m;
    for piece in line_m.windows(2) {
        let length = (piece[1][0] - piece[0][0]).hypot(piece[1][1] - piece[0][1]);
        if left <= length && length > 0.0 {
            return [0, 1].map(|i| piece[0][i] + left / length * (piece[1][i] - piece[0][i]));
        }
        left -= length;
    }
    line_m.last().copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_crossed_where_it_is() {
        let line = [[0.0, -1.0], [0.0, 1.0], [4.0, 1.0]];
        assert_eq!(crossing(&line, [-1.0, 0.0], [3.0, 0.0]), Some(0.25));
        assert_eq!(crossing(&line, [-1.0, 2.0], [3.0, 2.0]), None);
        assert_eq!(crossing(&line, [2.0, 0.0], [2.0, 2.0]), Some(0.5));
        // A moment on the line ends one crossing and begins none.
        assert_eq!(crossing(&line, [-1.0, 0.0], [0.0, 0.0]), Some(1.0));
        assert_eq!(crossing(&line, [0.0, 0.0], [1.0, 0.0]), None);
    }

    #[test]
    fn chainage_is_that_of_the_nearest_place() {
        let line = [[0.0, 0.0], [3.0, 0.0], [3.0, 4.0]];
        assert_eq!(chainage_m(&line, [1.0, 2.0]), 1.0);
        assert_eq!(chainage_m(&line, [5.0, 3.0]), 6.0);
        assert_eq!(chainage_m(&line, [-5.0, 3.0]), 0.0);
        assert_eq!((distance_m(&line, [1.0, 2.0]), distance_m(&line, [3.0, 2.0])), (2.0, 0.0));
        assert_eq!((length_m(&line), point_at(&line, 5.0)), (7.0, [3.0, 2.0]));
    }
}
