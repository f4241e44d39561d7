//! Whether a motion is chaotic: differences do not fall with the step, and a twin that begins hardly different ends
//! somewhere else.

use ndda_io::table::Table;
use serde::{Deserialize, Serialize};

use super::quantities::{Kind, Quantity, common_rows, values, values_of};

/// The twin's gravity differs by this part.
pub const DISTURBANCE: f64 = 1e-9;
/// Differences of displacements below this part of the largest displacement are no reason to suspect chaos.
const NEGLIGIBLE: f64 = 1e-6;
/// Differences that fall less than to this part when the step is halved do not fall.
const STAYS: f64 = 0.7;
/// A disturbance that grows by less than this is that of a regular motion.
const GROWS: f64 = 1e3;
/// Runs that are nearer than this part of the largest displacement have the same trajectory.
const TOGETHER: f64 = 1e-2;

/// A motion whose single trajectories mean nothing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Chaos {
    /// How many times a small disturbance has grown at the end.
    pub growth: f64,
    /// Until when runs of different steps stay within 1 % of the largest displacement [s].
    pub predictable_until_s: f64,
}

/// Difference of the displacements of two runs over time, relative to the largest displacement in the second.
struct Apart {
    times_s: Vec<f64>,
    /// The largest displacement in the second [m].
    largest_m: f64,
    relative: Vec<f64>,
}

fn apart(quantities: &[Quantity], first: &Table, second: &Table) -> Apart {
    let rows = common_rows(&[first, second]);
    let mut scale = 0.0f64;
    let mut relative = vec![0.0f64; rows[0].len()];
    for quantity in quantities.iter().filter(|quantity| quantity.kind == Kind::Displacement) {
        let [a, b] = [(first, &rows[0]), (second, &rows[1])].map(|(t, rows)| values_of(t, quantity, rows));
        scale = b.iter().map(|v| v.abs()).fold(scale, f64::max);
        relative.iter_mut().zip(a.iter().zip(&b)).for_each(|(r, (a, b))| *r = r.max((a - b).abs()));
    }
    let divisor = if scale > 0.0 { scale } else { 1.0 };
    relative.iter_mut().for_each(|r| *r /= divisor);
    Apart { times_s: values(second, super::quantities::TIME, &rows[1]), largest_m: scale, relative }
}

impl Apart {
    fn largest(&self) -> f64 {
        self.relative.iter().copied().fold(0.0, f64::max)
    }
}

/// Whether displacements of three runs of ever shorter steps do not come nearer to each other, by more than the rounding of places [m].
pub fn is_suspect(quantities: &[Quantity], tables: [&Table; 3], rounding_m: f64) -> bool {
    let first = apart(quantities, tables[0], tables[1]).largest();
    let finer = apart(quantities, tables[1], tables[2]);
    let last = finer.largest();
    last > NEGLIGIBLE && last > STAYS * first && last * finer.largest_m > rounding_m
}

/// Judgement by the twin of the run of the longest step; none where the motion is regular.
pub fn judge(quantities: &[Quantity], tables: [&Table; 3], twin: &Table) -> Option<Chaos> {
    let growth = apart(quantities, twin, tables[0]).largest() / DISTURBANCE;
    let last = apart(quantities, tables[1], tables[2]);
    // Runs that stay together have one trajectory, whatever becomes of a disturbance.
    let lost = last.relative.iter().position(|r| *r > TOGETHER)?;
    let predictable_until_s = last.times_s.get(lost.saturating_sub(1)).copied().unwrap_or(0.0);
    (growth > GROWS).then_some(Chaos { growth, predictable_until_s })
}

#[cfg(test)]
mod tests {
    use super::super::quantities::{TIME, quantities};
    use super::*;

    /// x(t) of the logistic map of 4, or of a swing, that begins at `x`.
    fn motion(x: f64, chaotic: bool) -> Table {
        let mut column = vec![x];
        for k in 1..60 {
            let last = column[k - 1];
            column.push(if chaotic { 4.0 * last * (1.0 - last) } else { (0.1 * k as f64).sin() + x });
        }
        let times = (0..60).map(f64::from).collect();
        Table { names: vec![TIME.into(), "m.displacement_x_m".into()], columns: vec![times, column] }
    }

    fn judged(chaotic: bool, errors: [f64; 3]) -> (bool, Option<Chaos>) {
        judged_beyond(0.0, chaotic, errors)
    }

    fn judged_beyond(rounding_m: f64, chaotic: bool, errors: [f64; 3]) -> (bool, Option<Chaos>) {
        let runs = errors.map(|error| motion(0.3 + error, chaotic));
        let found = quantities(&runs[0], &[]);
        let tables = [&runs[0], &runs[1], &runs[2]];
        let twin = motion(0.3 + errors[0] + DISTURBANCE, chaotic);
        (is_suspect(&found, tables, rounding_m), judge(&found, tables, &twin))
    }

    #[test]
    fn a_chaotic_map_is_told_with_the_instant_until_which_its_runs_agree() {
        let (suspect, chaos) = judged(true, [4e-6, 2e-6, 1e-6]);
        let chaos = chaos.unwrap();
        // 1e-6 doubles with every step on average and is 1e-2 after some 13 of them.
        assert!(suspect && chaos.growth > 1e7, "{chaos:?}");
        assert!((8.0..20.0).contains(&chaos.predictable_until_s), "{chaos:?}");
    }

    #[test]
    fn a_regular_motion_is_not_chaotic_whether_or_not_its_differences_fall() {
        assert_eq!(judged(false, [4e-2, 2e-2, 1e-2]), (false, None));
        assert_eq!(judged(false, [1e-2, -1e-2, 2e-2]), (true, None));
    }

    #[test]
    fn differences_within_the_rounding_of_places_are_no_chaos() {
        assert!(judged_beyond(0.5, true, [4e-6, 2e-6, 1e-6]).0);
        assert!(!judged_beyond(2.0, true, [4e-6, 2e-6, 1e-6]).0);
    }
}
