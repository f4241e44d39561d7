//! The profile: the ground with paths above it, and envelopes of height, speed and energy below.

use std::fmt::Write as _;

use super::axes::{Axes, from_zero};
use super::{GREY, INK, LARGEST, MEDIAN, PERCENTILE, subtitle};
use crate::picture::svg::{Anchor, Rgb, Svg, hex};
use crate::rockfall::Model;
use crate::rockfall::fall::Fall;
use crate::rockfall::passage::{chainage_m, crossing, length_m, point_at};
use crate::rockfall::profile::{Station, stations};
use crate::rockfall::result::Outcome;
use crate::rockfall::spread::{AtLine, Spread};
use crate::view3d::viridis;

/// Width of the picture, room at both sides, and heights of the section and of each envelope [px].
const WIDTH: f64 = 1100.0;
const LEFT: f64 = 84.0;
const RIGHT: f64 = 30.0;
const TOP: f64 = 92.0;
const MOST_SECTION: f64 = 430.0;
const LEAST_SECTION: f64 = 180.0;
const ENVELOPE: f64 = 128.0;
const GAP: f64 = 34.0;
/// Most paths that are drawn.
const MOST_PATHS: usize = 300;
/// Classes of speed, and points of the ground.
const CLASSES: usize = 24;
const POINTS: usize = 600;

/// Name of a quantity, its unit, and how it is spread.
type Panel = (&'static str, f64, fn(&AtLine) -> Spread);
/// A percentile with the colour and width of its line.
type Curve = (fn(&Spread) -> f64, Rgb, f64);

/// Draws the profile.
pub(super) fn draw(model: &Model, outcome: &Outcome, falls: &[Fall]) -> String {
    let stations = stations(model, (&outcome.profile_m, outcome.part_m), falls);
    let line = &outcome.profile_m;
    let length = length_m(line);
    let at = |k: usize| length * k as f64 / POINTS as f64;
    let ground: Vec<[f64; 2]> = (0..=POINTS)
        .filter_map(|k| model.terrain.at(point_at(line, at(k))).map(|(z, _)| [at(k), z]))
        .collect();
    let highest = stations.iter().filter_map(|s| s.first.map(|f| f.height_m.largest)).fold(0.0, f64::max);
    let ends = ground.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p[1]), b.max(p[1])));
    let (low, high) = if ends.0 <= ends.1 { ends } else { (0.0, 1.0) };
    let room = 0.06 * (high - low).max(highest).max(1.0);
    let y = [low - room, high + highest.min(high - low + 1.0) + room];
    let width = WIDTH - LEFT - RIGHT;
    // Heights and lengths at one scale where there is room for it.
    let height = (width * (y[1] - y[0]) / length).clamp(LEAST_SECTION, MOST_SECTION);
    let section = Axes { at: [LEFT, TOP], size: [width, height], x: [0.0, length], y };
    let whole = TOP + height + 3.0 * (ENVELOPE + GAP) + 64.0;
    let mut svg = Svg::new([WIDTH as usize, whole as usize]);
    svg.rect([0.0, 0.0], [WIDTH, whole], [255; 3]);
    svg.words([LEFT, 22.0], 17.0, Anchor::Start, INK, width, &outcome.title);
    svg.words([LEFT, 45.0], 13.0, Anchor::Start, GREY, width, &format!("profile · {}", subtitle(outcome)));
    let exaggeration = height / (y[1] - y[0]) * length / width;
    let name = match (exaggeration - 1.0).abs() < 0.02 {
        true => "height of terrain and paths [m], coloured by speed".to_string(),
        false => format!(
            "height of terrain and paths [m], coloured by speed; drawn {exaggeration:.2} times as large as lengths"
        ),
    };
    section_of(&mut svg, &section, (model, outcome, falls), &ground);
    section.name(&mut svg, &name);
    let panels: [Panel; 3] = [
        ("height of the centre of mass above the ground [m]", 1.0, |f| f.height_m),
        ("speed [m/s]", 1.0, |f| f.speed_m_s),
        ("kinetic energy [kJ]", 1e3, |f| f.energy_j),
    ];
    let mut top = TOP + height + GAP + 6.0;
    for (k, (name, unit, of)) in panels.into_iter().enumerate() {
        let values = stations.iter().filter_map(|s| s.first.as_ref().map(|f| of(f).largest / unit));
        let axes = Axes { at: [LEFT, top], size: [width, ENVELOPE], x: [0.0, length], y: from_zero(values) };
        axes.grid(&mut svg, k == 2);
        envelope(&mut svg, &axes, &stations, of, unit);
        lines(&mut svg, &axes, model, outcome, false);
        axes.frame(&mut svg);
        axes.name(&mut svg, name);
        if k == 0 {
            key(&mut svg, [WIDTH - RIGHT - 364.0, top - 11.0]);
        }
        if k == 2 {
            axes.name_below(&mut svg, "distance along the profile [m]");
        }
        top += ENVELOPE + GAP;
    }
    svg.finish()
}

/// The ground, filled, with paths above it.
fn section_of(
    svg: &mut Svg,
    axes: &Axes,
    (model, outcome, falls): (&Model, &Outcome, &[Fall]),
    ground: &[[f64; 2]],
) {
    axes.grid(svg, false);
    let line = &outcome.profile_m;
    let every = falls.len().div_ceil(MOST_PATHS).max(1);
    let drawn = || falls.iter().step_by(every);
    let most = drawn().flat_map(|fall| &fall.path).map(|m| m.speed_m_s()).fold(f64::MIN_POSITIVE, f64::max);
    let mut classes = vec![String::new(); CLASSES];
    for fall in drawn() {
        let mut last: Option<[f64; 2]> = None;
        for moment in &fall.path {
            let chainage = chainage_m(line, moment.map_m());
            let Some((below, _)) = model.terrain.at(point_at(line, chainage)) else { continue };
            let at = axes.place([chainage, (below + moment.height_m).min(axes.y[1])]);
            if let Some(from) = last {
                let class = ((moment.speed_m_s() / most * CLASSES as f64) as usize).min(CLASSES - 1);
                let _ = write!(classes[class], "M{:.1} {:.1}L{:.1} {:.1}", from[0], from[1], at[0], at[1]);
            }
            last = Some(at);
        }
    }
    for (class, path) in classes.iter().enumerate().filter(|(_, path)| !path.is_empty()) {
        let colour = hex(viridis((class as f64 + 0.5) / CLASSES as f64));
        svg.raw(&format!(
            "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1\" stroke-opacity=\"0.6\"/>"
        ));
    }
    let mut outline: Vec<[f64; 2]> = ground.iter().map(|point| axes.place(*point)).collect();
    if let (Some(first), Some(last)) = (outline.first().copied(), outline.last().copied()) {
        let bottom = axes.at[1] + axes.size[1];
        let edge = outline.clone();
        outline.extend([[last[0], bottom], [first[0], bottom]]);
        svg.polygon(&outline, [216, 210, 200]);
        svg.polyline(&edge, 1.6, [70, 62, 54]);
    }
    lines(svg, axes, model, outcome, true);
    axes.frame(svg);
    scale(svg, most);
}

/// Where lines cross the profile, with their names if asked for.
fn lines(svg: &mut Svg, axes: &Axes, model: &Model, outcome: &Outcome, with_names: bool) {
    for (k, line) in (0..).zip(&model.rockfall.lines) {
        for piece in outcome.profile_m.windows(2) {
            let Some(part) = crossing(&line.points_m, piece[0], piece[1]) else { continue };
            let at = [0, 1].map(|i| piece[0][i] + part * (piece[1][i] - piece[0][i]));
            let [x, _] = axes.place([chainage_m(&outcome.profile_m, at), axes.y[0]]);
            svg.raw(&format!(
                "<line x1=\"{x:.1}\" y1=\"{:.1}\" x2=\"{x:.1}\" y2=\"{:.1}\" stroke=\"#be1428\" stroke-width=\"1.4\" stroke-dasharray=\"5 3\"/>",
                axes.at[1],
                axes.at[1] + axes.size[1]
            ));
            if with_names {
                svg.words(
                    [x + 5.0, axes.at[1] + 12.0 + 16.0 * f64::from(k)],
                    12.0,
                    Anchor::Start,
                    [150, 10, 30],
                    160.0,
                    &line.name,
                );
            }
            break;
        }
    }
}

/// Largest values, 95th percentiles and medians at the stations that boulders passed.
fn envelope(svg: &mut Svg, axes: &Axes, stations: &[Station], of: impl Fn(&AtLine) -> Spread, unit: f64) {
    let lines: [Curve; 3] =
        [(|s| s.largest, LARGEST, 1.4), (|s| s.percentile_95, PERCENTILE, 2.2), (|s| s.median, MEDIAN, 2.2)];
    for (value, colour, width) in lines {
        for run in stations.chunk_by(|a, b| a.first.is_some() == b.first.is_some()) {
            let at = |s: &Station| s.first.as_ref().map(|f| [s.chainage_m, value(&of(f)) / unit]);
            let points: Vec<[f64; 2]> = run.iter().filter_map(at).collect();
            if points.len() > 1 {
                axes.curve(svg, &points, width, colour);
            }
        }
    }
}

/// The meaning of the lines of envelopes.
fn key(svg: &mut Svg, [x, y]: [f64; 2]) {
    let mut at = x;
    for (name, colour, room) in
        [("largest", LARGEST, 92.0), ("95th percentile", PERCENTILE, 142.0), ("median", MEDIAN, 90.0)]
    {
        svg.line([at, y], [at + 20.0, y], 2.4, colour);
        svg.words([at + 26.0, y], 12.0, Anchor::Start, INK, room, name);
        at += room + 16.0;
    }
}

/// The scale of speeds, above the section at the right.
fn scale(svg: &mut Svg, most: f64) {
    let [x, y, width] = [WIDTH - RIGHT - 200.0, 62.0, 120.0];
    svg.words([x - 8.0, y + 5.0], 12.0, Anchor::End, INK, 140.0, "speed [m/s]  0");
    for k in 0..40 {
        let part = (f64::from(k) + 0.5) / 40.0;
        svg.rect([x + f64::from(k) * width / 40.0, y], [width / 40.0 + 0.4, 10.0], viridis(part));
    }
    svg.words([x + width + 8.0, y + 5.0], 12.0, Anchor::Start, INK, 60.0, &format!("{most:.1}"));
}
