//! A record as a picture: acceleration, velocity and displacement over time, and the response spectrum.

use std::path::Path;

use ndda_io::WriteError;

use super::{Motion, Shaking};
use crate::picture::write;
use crate::plot::{self, Line};

/// Width and height [px], and heights of the curves over time.
const SIZE: (u32, u32) = (1160, 1240);
const CURVE: u32 = 280;
/// Longest period that is drawn [s].
const LONGEST_S: f64 = 4.0;

/// Draws a record to an SVG or PNG file.
pub(super) fn draw(shaking: &Shaking, motion: &Motion, out: &Path) -> Result<(), WriteError> {
    let over_time = |name: &str, values: &[f64]| Line {
        name: name.into(),
        points: motion.time_s.iter().copied().zip(values.iter().copied()).collect(),
    };
    let curves = [
        (over_time("acceleration", &motion.acceleration), "acceleration [m/s²]"),
        (over_time("velocity", &motion.velocity), "velocity [m/s]"),
        (over_time("displacement", &motion.displacement), "displacement [m]"),
    ];
    let shown = shaking.spectrum.iter().filter(|r| r.period_s <= LONGEST_S);
    let points = shown.map(|r| (r.period_s, r.pseudo_acceleration_m_s2)).collect();
    let damping = format!("{} % of critical", 100.0 * shaking.damping);
    let spectrum = Line { name: damping, points };
    write(out, SIZE, |root| {
        let title = shaking.record.split([':', ';']).next().unwrap_or_default();
        let mut rest = root.titled(title, ("sans-serif", 17))?;
        for (line, axis) in curves {
            let (upper, lower) = rest.split_vertically(CURVE);
            draw_lines(&upper, line, ["time [s]", axis])?;
            rest = lower;
        }
        draw_lines(&rest, spectrum, ["period [s]", "pseudo-acceleration [m/s²]"])
    })
}

fn draw_lines(area: &crate::picture::Area, line: Line, axes: [&str; 2]) -> crate::picture::Drawn {
    plot::draw(area, &[line], &axes.map(String::from), false)
}
