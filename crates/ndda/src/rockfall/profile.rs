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
        let mut is_passed = vec![false; count];
        for pair in fall.path.windows(2) {
            let [a, b] = [0, 1].map(|k| chainage_m(line_m, pair[k].map_m()) / part_m);
            let (low, high) = (a.min(b), a.max(b));
            for station in low.ceil() as usize..=(high.floor() as usize).min(count - 1) {
                if !std::mem::replace(&mut is_passed[station], true) && high > low {
                    moments[station].push(pair[0].towards(&pair[1], (station as f64 - a) / (b - a)));
                }
            }
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
