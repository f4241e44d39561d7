//! What all boulders together come to.

use ndda_io::scene::{CountingLine, Release, Rockfall, Scatter};
use serde::{Deserialize, Serialize};

use super::accuracy::Accuracy;
use super::draw::{self, DIPS_DEG, FRICTIONS_DEG, FROM_ZERO, LITTLE, RESTITUTIONS};
use super::fall::{End, Fall};
use super::passage::{Moment, length_m};
use super::profile;
use super::spread::{AtLine, Runout};
use super::{Boulder, Model, map};
use crate::numbers::counted;

/// Schema of [`Outcome`].
pub const SCHEMA: &str = "ndda.rockfall/1";
/// Standard normal number that is exceeded in either direction with a probability of 5 %.
const TWO_SIDED_95: f64 = 1.959_963_984_540_054;

/// The answer, as `rockfall.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// `ndda.rockfall/1`.
    pub schema: String,
    /// Version of ndda.
    pub version: String,
    /// Name of the scene: its file without the ending.
    pub scene: String,
    /// The scene's own title.
    pub title: String,
    /// Boulders that fell.
    pub count: u32,
    /// Boulders that were asked for: more, where somebody ended the computation.
    pub asked: u32,
    /// Seed of all that was drawn.
    pub seed: u64,
    /// Triangles of the terrain.
    pub triangles: usize,
    /// How falls ended.
    pub ends: Ends,
    /// Distance on the map from the release to the end [m].
    pub runout_m: Runout,
    /// Part of the distribution of sizes that `within` cuts off; sizes are drawn from the rest.
    pub sizes_cut_off: f64,
    /// Lines, in the order of the scene.
    pub lines: Vec<LineResult>,
    /// Corners of the profile [m].
    pub profile_m: Vec<[f64; 2]>,
    /// Distance of the stations of the profile [m].
    pub part_m: f64,
    /// How accurate falls are.
    pub accuracy: Inaccurate,
    /// What makes results less than they seem, with the remedy.
    pub warnings: Vec<String>,
    /// Steps of all falls.
    pub steps: u64,
    /// Wall-clock time of the falls [s].
    pub wall_s: f64,
}

/// How falls ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Ends {
    /// At rest.
    pub rest: usize,
    /// At the end of the terrain.
    pub left_terrain: usize,
    /// Still moving when the time was up.
    pub still_moving: usize,
    /// The computation could not go on.
    pub stopped: usize,
}

/// Boulders at a line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LineResult {
    /// Its name.
    pub name: String,
    /// Boulders that reached it.
    pub reached: usize,
    /// Boulders that had not, and that were last seen on their way, or left the terrain: they might.
    pub might: usize,
    /// Part of all boulders that reached it; a lower bound where others might.
    pub probability: f64,
    /// Where the probability lies with a confidence of 95 % (Wilson 1927), from none to all of those that might.
    pub confidence_95: [f64; 2],
    /// What those had when they first reached it; none if none did.
    pub first: Option<AtLine>,
}

/// Falls that are not accurate, or were not computed to their end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Inaccurate {
    /// How many.
    pub inaccurate: usize,
    /// The largest error of each kind over all falls.
    pub worst: Accuracy,
    /// What is beyond its limit at worst, and what to change.
    pub reasons: Vec<String>,
}

impl Outcome {
    /// The outcome of falls that took some time [s].
    pub fn new(model: &Model, name: &str, falls: &[Fall], wall_s: f64) -> Self {
        let profile_m = profile::corners_m(model, falls);
        let part_m = model.rockfall.detail.part_m.unwrap_or(0.01 * length_m(&profile_m));
        let worst = falls.iter().fold(Accuracy::default(), |worst, fall| worst.worst(fall.accuracy));
        let rested = falls.iter().filter(|fall| fall.end == End::Rest).map(map::runout_m);
        let runout_m = Runout::of(rested.clone().collect(), falls.len() - rested.count());
        let boulders = &model.rockfall.boulders;
        Self {
            schema: SCHEMA.into(),
            version: env!("CARGO_PKG_VERSION").into(),
            scene: name.into(),
            title: model.loaded.scene.title.clone(),
            count: falls.len() as u32,
            asked: model.rockfall.count,
            seed: model.rockfall.seed,
            triangles: model.terrain.triangles(),
            ends: ends(falls),
            runout_m,
            sizes_cut_off: Boulder::sizes_cut_off(boulders),
            lines: lines(model, falls),
            part_m: part_m.max(length_m(&profile_m) / profile::MOST_STATIONS),
            profile_m,
            accuracy: Inaccurate {
                inaccurate: falls.iter().filter(|fall| !is_accurate(fall)).count(),
                reasons: reasons(model, falls, &worst),
                worst,
            },
            warnings: warnings(model, falls),
            steps: falls.iter().map(|fall| fall.steps).sum(),
            wall_s,
        }
    }
}

/// Whether a fall was computed to its end, with errors within their limits.
fn is_accurate(fall: &Fall) -> bool {
    !matches!(fall.end, End::Stopped(_)) && fall.accuracy.is_accurate()
}

/// Reasons why falls are inaccurate, each with its cure.
fn reasons(model: &Model, falls: &[Fall], worst: &Accuracy) -> Vec<String> {
    let stopped = ends(falls).stopped;
    let count = counted(stopped, "fall was", "falls were");
    let unfinished = (stopped > 0).then(|| format!("{count} not computed to the end, as the warning says"));
    let beyond = worst.reasons(model.step_s(), model.rockfall.detail.impact_m_s);
    unfinished.into_iter().chain(beyond).collect()
}

fn ends(falls: &[Fall]) -> Ends {
    let mut ends = Ends::default();
    for fall in falls {
        match fall.end {
            End::Rest => ends.rest += 1,
            End::LeftTerrain => ends.left_terrain += 1,
            End::StillMoving => ends.still_moving += 1,
            End::Stopped(_) => ends.stopped += 1,
        }
    }
    ends
}

/// Falls that are not there or not over, and what to change.
fn warnings(model: &Model, falls: &[Fall]) -> Vec<String> {
    let (count, asked) = (falls.len(), model.rockfall.count as usize);
    let mut warnings = Vec::new();
    if count < asked {
        warnings.push(format!(
            "interrupted: results are those of the {} of {asked} that had ended; run again with --force for all, or with --count {count}",
            counted(count, "boulder", "boulders")
        ));
    }
    let ends = ends(falls);
    if ends.still_moving > 0 {
        let lines = model.rockfall.lines.len();
        let may_reach_more =
            |fall: &Fall| fall.end == End::StillMoving && (0..lines).any(|k| first_at(fall, k).is_none());
        let meanwhile = if falls.iter().any(may_reach_more) { "probabilities of reach" } else { "runouts" };
        warnings.push(format!(
            "{} of {count} boulders still moved after {} s: raise time.end_s; until then {meanwhile} are lower bounds",
            ends.still_moving, model.loaded.scene.time.end_s
        ));
    }
    let has_left = |fall: &&Fall| fall.end == End::LeftTerrain;
    let left_before =
        |k: usize| falls.iter().filter(has_left).filter(|fall| first_at(fall, k).is_none()).count();
    let lines = model.rockfall.lines.iter().enumerate().map(|(k, line)| (left_before(k), line));
    if let Some((left, line)) = lines.filter(|(left, _)| *left > 0).max_by_key(|(left, _)| *left) {
        warnings.push(format!(
            "{left} of {count} boulders left the terrain without reaching line `{}`: draw more terrain; until then probabilities of reach are lower bounds",
            line.name
        ));
    }
    let reason = falls.iter().find_map(|fall| match &fall.end {
        End::Stopped(reason) => Some(reason),
        _ => None,
    });
    if let Some(reason) = reason {
        warnings.push(format!(
            "{} of {count} falls could not be computed to the end, so that probabilities of reach are lower bounds: {reason}",
            ends.stopped
        ));
    }
    warnings.extend(model.bare.clone());
    warnings.extend(model.holes.clone());
    warnings.extend(laws_cut_off(model));
    warnings.extend(releases_cut_off(model));
    warnings
}

/// Restitutions and friction angles of which a part of the distribution is cut off.
fn laws_cut_off(model: &Model) -> Vec<String> {
    let Rockfall { ground, zones, .. } = &model.rockfall;
    let of_ground = ("the ground".to_string(), &ground.restitution, &ground.friction_deg);
    let of_zones =
        zones.iter().map(|zone| (format!("zone `{}`", zone.name), &zone.restitution, &zone.friction_deg));
    let mut found = Vec::new();
    for (name, restitution, friction_deg) in std::iter::once(of_ground).chain(of_zones) {
        for (what, scatter, limits) in
            [("restitution", restitution, RESTITUTIONS), ("friction_deg", friction_deg, FRICTIONS_DEG)]
        {
            found.extend(cut_off(what, &name, scatter, limits));
        }
    }
    found
}

/// Heights, speeds and dips of releases of which a part of the distribution is cut off.
fn releases_cut_off(model: &Model) -> Vec<String> {
    let of_release = |release: &Release| {
        let Release { name, height_m, speed_m_s, dip_deg, .. } = release;
        let name = format!("release `{name}`");
        let all = [
            ("height_m", height_m, FROM_ZERO),
            ("speed_m_s", speed_m_s, FROM_ZERO),
            ("dip_deg", dip_deg, DIPS_DEG),
        ];
        all.map(|(what, scatter, limits)| cut_off(what, &name, scatter.as_ref()?, limits))
    };
    model.rockfall.releases.iter().flat_map(of_release).flatten().collect()
}

/// That a part of a distribution is cut off, where it is not little.
fn cut_off(what: &str, of: &str, scatter: &Scatter, limits: (f64, f64)) -> Option<String> {
    let part = draw::cut_off(scatter, limits);
    let beyond = match limits {
        FROM_ZERO => "below 0".to_string(),
        (least, most) => format!("beyond {least} to {most}"),
    };
    (part > LITTLE).then(|| {
        format!(
            "{what} of {of}: {:.1} % of its distribution lies {beyond} and is cut off; give it a smaller spread, or a `Triangular` one",
            100.0 * part
        )
    })
}

/// A boulder when it first reaches the line with a number; none if it does not.
fn first_at(fall: &Fall, line: usize) -> Option<Moment> {
    fall.passages.iter().find(|(passed, _)| *passed == line).map(|(_, moment)| *moment)
}

fn lines(model: &Model, falls: &[Fall]) -> Vec<LineResult> {
    let result = |(k, line): (usize, &CountingLine)| {
        let moments: Vec<Moment> = falls.iter().filter_map(|fall| first_at(fall, k)).collect();
        let might = falls.iter().filter(|fall| fall.end != End::Rest && first_at(fall, k).is_none()).count();
        let [low, _] = wilson(moments.len(), falls.len());
        let [_, high] = wilson(moments.len() + might, falls.len());
        LineResult {
            name: line.name.clone(),
            reached: moments.len(),
            might,
            probability: moments.len() as f64 / falls.len() as f64,
            confidence_95: [low, high],
            first: AtLine::of(&moments),
        }
    };
    model.rockfall.lines.iter().enumerate().map(result).collect()
}

/// Where a probability lies with a confidence of 95 % after so many of some trials (Wilson 1927).
pub fn wilson(successes: usize, trials: usize) -> [f64; 2] {
    let (n, z2) = (trials as f64, TWO_SIDED_95 * TWO_SIDED_95);
    let part = successes as f64 / n;
    let middle = (part + 0.5 * z2 / n) / (1.0 + z2 / n);
    let half = TWO_SIDED_95 / (1.0 + z2 / n) * (part * (1.0 - part) / n + 0.25 * z2 / (n * n)).sqrt();
    [(middle - half).max(0.0), (middle + half).min(1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn confidence_is_that_of_wilson() {
        // Newcombe (1998), table I: 81 of 263.
        let [low, high] = wilson(81, 263);
        assert!((low - 0.2553).abs() < 5e-5 && (high - 0.3662).abs() < 5e-5, "{low} {high}");
        assert_eq!(wilson(0, 10)[0], 0.0);
    }
}
