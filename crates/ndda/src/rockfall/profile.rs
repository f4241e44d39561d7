//! Results along a profile: what boulders have where they pass its stations.

use super::Model;
use super::fall::Fall;
use super::passage::{Moment, chainage_m, length_m, point_at};
use super::spread::AtLine;

/// Most stations.
pub(super) const MOST_STATIONS: f64 = 1e4;

/// Boulders at a station of the profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// Distance from the start of the profile [m].
    pub chainage_m: f64,
    /// Height of the ground there; none where there is no terrain [m].
    pub ground_m: Option<f64>,
    /// Boulders that passed it.
    pub passed: usize,
    /// What those had when they first did; none if none did.
    pub first: Option<AtLine>,
}

/// Corners of the profile: those of the scene, or the middle of all releases and of all ends [m].
pub(super) fn corners_m(model: &Model, falls: &[Fall]) -> Vec<[f64; 2]> {
    if !model.rockfall.profile_m.is_empty() {
        return model.rockfall.profile_m.clone();
    }
    let middle = |of: &dyn Fn(&Fall) -> Option<Moment>| {
        let moments: Vec<Moment> = falls.iter().filter_map(of).collect();
        let mean =
            |axis: usize| moments.iter().map(|m| m.at_m[axis]).sum::<f64>() / moments.len().max(1) as f64;
        [mean(0), mean(1)]
    };
    let (from, to) = (middle(&|fall| fall.path.first().copied()), middle(&|fall| fall.path.last().copied()));
    let along = [to[0] - from[0], to[1] - from[1]];
    let length = along[0].hypot(along[1]);
    if length == 0.0 {
        return vec![from, [from[0], from[1] + model.terrain.step_m[1]]];
    }
    let unit = along.map(|part| part / length);
    // As far as the farthest boulder, and as far back.
    let ahead = |m: &Moment| (m.at_m[0] - from[0]) * unit[0] + (m.at_m[1] - from[1]) * unit[1];
    let ways = falls.iter().flat_map(|fall| &fall.path).map(ahead);
    let (back, front) = ways.fold((0.0, length), |(a, b): (f64, f64), way| (a.min(way), b.max(way)));
    [back, front].map(|way| [from[0] + way * unit[0], from[1] + way * unit[1]]).to_vec()
}

/// All stations of a profile through corners [m], from its start on, at distances of `part_m`.
pub fn stations(model: &Model, (line_m, part_m): (&[[f64; 2]], f64), falls: &[Fall]) -> Vec<Station> {
    let count = (length_m(line_m) / part_m + 1e-9).floor() as usize + 1;
    let mut moments: Vec<Vec<Moment>> = vec![Vec::new(); count];
    for fall in falls {
        for (all, first) in moments.iter_mut().zip(first_passages(line_m, part_m, count, &fall.path)) {
            all.extend(first);
        }
    }
    let station = |(k, moments): (usize, &Vec<Moment>)| {
        let chainage_m = k as f64 * part_m;
        Station {
            chainage_m,
            ground_m: model.terrain.at(point_at(line_m, chainage_m)).map(|(z, _)| z),
            passed: moments.len(),
            first: AtLine::of(moments),
        }
    };
    moments.iter().enumerate().map(station).collect()
}

/// When a path first passes each of so many stations.
fn first_passages(line_m: &[[f64; 2]], part_m: f64, count: usize, path: &[Moment]) -> Vec<Option<Moment>> {
    let mut first = vec![None; count];
    let (length, last) = (length_m(line_m) / part_m, (count - 1) as f64);
    // Where the last station is at the end, rounding does not put it beyond.
    let end = if (length - last).abs() < 1e-9 { last } else { length };
    let chainage = |moment: &Moment| {
        let at = chainage_m(line_m, moment.map_m()) / part_m;
        if at >= length { end } else { at }
    };
    for pair in path.windows(2) {
        let [a, b] = [0, 1].map(|k| chainage(&pair[k]));
        let (low, high) = (a.min(b), a.max(b));
        // A boulder that moves along no profile, or before it begins, passes no station.
        if high > low {
            let passed = first.iter_mut().zip(0u32..).map(|(first, k)| (f64::from(k), first));
            let passed = passed.skip(low.ceil() as usize).take_while(|(station, _)| *station <= high);
            for (station, first) in passed {
                first.get_or_insert_with(|| {
                    let at = |part: f64| pair[0].towards(&pair[1], part);
                    at(part_of_way((a, b), (station, end), |part| chainage(&at(part))))
                });
            }
        }
    }
    first
}

/// Part of a straight way from chainage `a` to `b` at which it passes a station. Places before and beyond the profile have the chainage 0 or `end`: there the
/// way does not grow evenly, and its place is found by bisection.
fn part_of_way((a, b): (f64, f64), (station, end): (f64, f64), chainage: impl Fn(f64) -> f64) -> f64 {
    if [a, b].iter().all(|at| 0.0 < *at && *at < end) {
        return (station - a) / (b - a);
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        let at = chainage(middle);
        let is_before = if a == station { at == a } else { (at - station) * (b - a) < 0.0 };
        *(if is_before { &mut low } else { &mut high }) = middle;
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_boulder_that_starts_before_the_profile_passes_its_first_station() {
        let path: Vec<Moment> = [-3.0, -2.0, -1.0, 0.5, 2.5]
            .iter()
            .zip(0..)
            .map(|(x, k)| Moment { time_s: f64::from(k), at_m: [*x, 0.0, 0.0], ..Moment::default() })
            .collect();
        // The way from −1 to 0.5 m takes a second, and that to 2.5 m, of which the profile has half a metre, another.
        let first = first_passages(&[[0.0, 0.0], [2.0, 0.0]], 1.0, 3, &path);
        for (moment, time_s) in first.iter().zip([2.0 + 2.0 / 3.0, 3.25, 3.75]) {
            assert!((moment.expect("it passes").time_s - time_s).abs() < 1e-12, "{moment:?}");
        }
        // A hundredth of 35 m is no number of the machine, and a hundred of them are less than 35.
        let far = [
            Moment { at_m: [30.0, 0.0, 0.0], ..Moment::default() },
            Moment { at_m: [50.0, 0.0, 0.0], time_s: 1.0, ..Moment::default() },
        ];
        let at_end = first_passages(&[[0.0, 0.0], [35.0, 0.0]], 0.01 * 35.0, 101, &far)[100];
        assert!((at_end.expect("it passes").time_s - 0.25).abs() < 1e-9, "{at_end:?}");
        let back: Vec<Moment> = path.iter().rev().copied().collect();
        let last = first_passages(&[[0.0, 0.0], [2.0, 0.0]], 1.0, 3, &back)[0];
        assert!((last.expect("it passes").at_m[0]).abs() < 1e-12, "{last:?}");
    }
}
