//! Maps: paths by their speed, and the probability that a place is reached.

use std::fmt::Write as _;

use super::axes::{Axes, marks};
use super::{GREY, INK, ground, subtitle};
use crate::picture::svg::{Anchor, Rgb, Svg, hex};
use crate::picture::{colour, short};
use crate::rockfall::fall::{End, Fall};
use crate::rockfall::result::Outcome;
use crate::rockfall::{Model, map};
use crate::view3d::viridis;

/// Longest side of the map, and room around it: left, top, right, below [px].
const SIDE: f64 = 860.0;
const ROOM: [f64; 4] = [76.0, 66.0, 190.0, 58.0];
/// Most paths that are drawn; of more every second, third, … is.
const MOST_PATHS: usize = 600;
/// Classes of speed.
const CLASSES: usize = 24;
/// Least distance of the points of a path [px].
const NEAR_PX: f64 = 1.2;
/// Least probability with a colour of its own.
const LEAST: f64 = 1e-3;

/// Meaning of a mark, and how it is drawn at a place.
type Mark<'a> = (&'a str, &'a dyn Fn(&mut Svg, [f64; 2]));

/// A map with the ground, and room for a scale.
struct Map<'a> {
    svg: Svg,
    axes: Axes,
    model: &'a Model,
}

impl<'a> Map<'a> {
    fn new(model: &'a Model, outcome: &Outcome, what: &str) -> Self {
        let [least, most] = model.terrain.bounds_m();
        let extent = [most[0] - least[0], most[1] - least[1]];
        let scale = SIDE / extent[0].max(extent[1]);
        let size = extent.map(|side| (side * scale).max(260.0));
        let wide = [size[0] / scale, size[1] / scale];
        let middle = [0, 1].map(|i| 0.5 * (least[i] + most[i]));
        let [left, top, right, below] = ROOM;
        let axes = Axes {
            at: [left, top],
            size,
            x: [middle[0] - 0.5 * wide[0], middle[0] + 0.5 * wide[0]],
            y: [middle[1] - 0.5 * wide[1], middle[1] + 0.5 * wide[1]],
        };
        let whole = [left + size[0] + right, top + size[1] + below];
        let mut svg = Svg::new(whole.map(|side| side.ceil() as usize));
        svg.rect([0.0, 0.0], whole, [255; 3]);
        svg.words([left, 22.0], 17.0, Anchor::Start, INK, whole[0] - left, &outcome.title);
        let words = format!("{what} · {}", subtitle(outcome));
        svg.words([left, 45.0], 13.0, Anchor::Start, GREY, whole[0] - left, &words);
        ground::draw(&mut svg, &axes, &model.terrain);
        Self { svg, axes, model }
    }

    /// Zones, lines and the profile, with their names, and the axes.
    fn finish(mut self, outcome: &Outcome) -> String {
        let axes = self.axes;
        for (k, zone) in self.model.rockfall.zones.iter().enumerate() {
            let edge = zone_colour(k);
            if zone.outline_m.is_empty() {
                self.cells_of(k);
                continue;
            }
            let corners: Vec<String> = zone
                .outline_m
                .iter()
                .map(|corner| axes.place(self.within(*corner)))
                .map(|[x, y]| format!("{x:.1},{y:.1}"))
                .collect();
            self.svg.raw(&format!(
                "<polygon points=\"{}\" fill=\"{1}\" fill-opacity=\"0.10\" stroke=\"{1}\" stroke-width=\"1.4\" stroke-dasharray=\"7 4\"/>",
                corners.join(" "),
                hex(edge)
            ));
        }
        let profile: Vec<[f64; 2]> =
            outcome.profile_m.iter().map(|corner| axes.place(self.within(*corner))).collect();
        let points: Vec<String> = profile.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        self.svg.raw(&format!(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.3\" stroke-dasharray=\"2 4\"/>",
            points.join(" "),
            hex(INK)
        ));
        for (k, line) in (0..).zip(&self.model.rockfall.lines) {
            let points: Vec<[f64; 2]> =
                line.points_m.iter().map(|corner| axes.place(self.within(*corner))).collect();
            self.svg.polyline(&points, 5.0, [255; 3]);
            self.svg.polyline(&points, 2.6, [190, 20, 40]);
            // Names of lines side by side stand one above the other.
            if let [[x, y], [to_x, to_y], ..] = points[..] {
                let length = (to_x - x).hypot(to_y - y).max(1.0);
                let part = ((14.0 + 22.0 * f64::from(k)) / length).min(0.5);
                let at = [x + part * (to_x - x) + 7.0, y + part * (to_y - y)];
                halo(&mut self.svg, at, &line.name);
                self.svg.words(at, 13.0, Anchor::Start, [150, 10, 30], 200.0, &line.name);
            }
        }
        self.marks();
        axes.frame(&mut self.svg);
        self.svg.finish()
    }

    /// A place, or the nearest in the picture.
    fn within(&self, at: [f64; 2]) -> [f64; 2] {
        [at[0].clamp(self.axes.x[0], self.axes.x[1]), at[1].clamp(self.axes.y[0], self.axes.y[1])]
    }

    /// Coordinates at the frame.
    fn marks(&mut self) {
        let Axes { at: [left, top], size: [width, height], x, y } = self.axes;
        for mark in marks(x, width / 110.0) {
            let [place, _] = self.axes.place([mark, y[0]]);
            self.svg.line([place, top + height], [place, top + height + 5.0], 1.0, INK);
            self.svg.words([place, top + height + 16.0], 12.0, Anchor::Middle, INK, 100.0, &short(mark));
        }
        for mark in marks(y, height / 80.0) {
            let [_, place] = self.axes.place([x[0], mark]);
            self.svg.line([left - 5.0, place], [left, place], 1.0, INK);
            self.svg.words([left - 9.0, place], 12.0, Anchor::End, INK, 64.0, &short(mark));
        }
        self.axes.name_below(&mut self.svg, "x to the east, y to the north [m]");
    }

    /// A scale of colours at the right: parts of it from below with their labels.
    fn scale(&mut self, name: &str, of: impl Fn(f64) -> Rgb, labels: &[(f64, String)]) -> f64 {
        let [x, top] = [self.axes.at[0] + self.axes.size[0] + 24.0, self.axes.at[1] + 22.0];
        let height = 200.0f64.min(self.axes.size[1] - 40.0);
        self.svg.words([x, top - 15.0], 13.0, Anchor::Start, INK, 160.0, name);
        let parts = 50;
        for k in 0..parts {
            let part = (f64::from(k) + 0.5) / f64::from(parts);
            let step = height / f64::from(parts);
            let y = top + height - f64::from(k + 1) * step;
            self.svg.rect([x, y], [16.0, step + 0.4], of(part));
        }
        for (part, label) in labels {
            let y = top + height * (1.0 - part);
            self.svg.line([x + 16.0, y], [x + 21.0, y], 1.0, INK);
            self.svg.words([x + 26.0, y], 12.0, Anchor::Start, INK, 120.0, label);
        }
        top + height + 26.0
    }

    /// Cells of a zone that has no outline, those beside each other along x as one.
    fn cells_of(&mut self, zone: usize) {
        let (axes, terrain, colour) = (self.axes, &self.model.terrain, hex(zone_colour(zone)));
        let [nx, ny] = terrain.cells();
        let is_in = |i: usize, j: usize| usize::from(terrain.zones_at(i, j)[0]) == zone + 1;
        for j in 0..ny {
            let mut from = 0;
            while let Some(first) = (from..nx).find(|&i| is_in(i, j)) {
                from = (first..nx).find(|&i| !is_in(i, j)).unwrap_or(nx);
                let [x0, y0] = axes.place(terrain.map_m([first as f64, j as f64]));
                let [x1, y1] = axes.place(terrain.map_m([from as f64, j as f64 + 1.0]));
                self.svg.raw(&format!(
                    "<rect x=\"{x0:.1}\" y=\"{y1:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"{colour}\" fill-opacity=\"0.16\"/>",
                    x1 - x0,
                    y0 - y1
                ));
            }
        }
    }

    /// Names of zones and marks, from a height on.
    fn key(&mut self, from_y: f64, marks: &[Mark]) {
        let x = self.axes.at[0] + self.axes.size[0] + 32.0;
        let mut y = from_y;
        for (words, mark) in marks {
            mark(&mut self.svg, [x, y]);
            self.svg.words([x + 16.0, y], 12.0, Anchor::Start, INK, 140.0, words);
            y += 21.0;
        }
        for (k, zone) in self.model.rockfall.zones.iter().enumerate() {
            let edge = zone_colour(k);
            self.svg.line([x - 9.0, y], [x + 9.0, y], 2.0, edge);
            self.svg.words([x + 16.0, y], 12.0, Anchor::Start, INK, 140.0, &zone.name);
            y += 21.0;
        }
    }
}

/// The key to contours.
fn contour(svg: &mut Svg, [x, y]: [f64; 2]) {
    svg.line([x - 9.0, y], [x + 9.0, y], 1.0, ground::CONTOUR);
}

/// The key to the brightness of the ground.
fn shade(svg: &mut Svg, [x, y]: [f64; 2]) {
    for k in 0..6 {
        let left = x - 9.0 + 3.0 * f64::from(k);
        svg.rect([left, y - 5.0], [3.2, 10.0], ground::grey(f64::from(k) / 5.0));
    }
}

/// White behind words.
fn halo(svg: &mut Svg, [x, y]: [f64; 2], words: &str) {
    let width = 7.4 * words.chars().count() as f64 + 6.0;
    svg.raw(&format!(
        "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{width:.1}\" height=\"17\" rx=\"3\" fill=\"#ffffff\" fill-opacity=\"0.82\"/>",
        x - 3.0,
        y - 9.0
    ));
}

fn zone_colour(k: usize) -> Rgb {
    let plotters::style::RGBColor(r, g, b) = colour(k);
    [r, g, b]
}

/// Paths, coloured by speed, and where boulders came to rest.
pub(super) fn paths(model: &Model, outcome: &Outcome, falls: &[Fall]) -> String {
    let mut map = Map::new(model, outcome, "paths by speed");
    let every = falls.len().div_ceil(MOST_PATHS).max(1);
    let drawn: Vec<&Fall> = falls.iter().step_by(every).collect();
    let speeds = drawn.iter().flat_map(|fall| &fall.path).map(|moment| moment.speed_m_s());
    let most = speeds.fold(0.0, f64::max).max(f64::MIN_POSITIVE);
    for (class, path) in by_speed(&drawn, &map.axes, most).iter().enumerate().filter(|(_, p)| !p.is_empty()) {
        let colour = hex(viridis((class as f64 + 0.5) / CLASSES as f64));
        map.svg.raw(&format!(
            "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.1\" stroke-opacity=\"0.8\" stroke-linecap=\"round\"/>"
        ));
    }
    let rest = |svg: &mut Svg, at: [f64; 2]| {
        svg.circle(at, 3.1, [255; 3]);
        svg.circle(at, 2.2, [20, 20, 24]);
    };
    let start = |svg: &mut Svg, at: [f64; 2]| svg.circle(at, 2.0, [200, 30, 60]);
    for fall in &drawn {
        if let Some(moment) = fall.path.first() {
            start(&mut map.svg, map.axes.place(moment.map_m()));
        }
        if let Some(moment) = fall.path.last().filter(|_| fall.end == End::Rest) {
            rest(&mut map.svg, map.axes.place(moment.map_m()));
        }
    }
    let labels: Vec<(f64, String)> =
        marks([0.0, most], 5.0).into_iter().map(|v| (v / most, short(v))).collect();
    let y = map.scale("speed [m/s]", viridis, &labels);
    let profile = |svg: &mut Svg, [x, y]: [f64; 2]| {
        for k in 0..4 {
            svg.circle([x - 8.0 + 5.4 * f64::from(k), y], 1.0, INK);
        }
    };
    let marks: [Mark; 5] = [
        ("release", &start),
        ("came to rest", &rest),
        ("profile", &profile),
        ("contour, height [m]", &contour),
        ("lit from north-west", &shade),
    ];
    map.key(y, &marks);
    map.finish(outcome)
}

/// Pieces of paths in each class of speed.
fn by_speed(falls: &[&Fall], axes: &Axes, most: f64) -> Vec<String> {
    let mut classes = vec![String::new(); CLASSES];
    for fall in falls {
        let mut last: Option<[f64; 2]> = None;
        for (k, moment) in fall.path.iter().enumerate() {
            let at = axes.place(moment.map_m());
            let Some(from) = last else {
                last = Some(at);
                continue;
            };
            let is_near = (at[0] - from[0]).hypot(at[1] - from[1]) < NEAR_PX;
            if is_near && k + 1 < fall.path.len() {
                continue;
            }
            let class = ((moment.speed_m_s() / most * CLASSES as f64) as usize).min(CLASSES - 1);
            let _ = write!(classes[class], "M{:.1} {:.1}L{:.1} {:.1}", from[0], from[1], at[0], at[1]);
            last = Some(at);
        }
    }
    classes
}

/// The probability that a cell is reached.
pub(super) fn reach(model: &Model, outcome: &Outcome, falls: &[Fall]) -> String {
    let mut map_of = Map::new(model, outcome, "reach probability");
    let reach = map::reach(model, falls);
    let [nx, _] = model.reach_cells();
    let (origin, cell) = (model.terrain.origin_m, model.cell_m());
    let part = |p: f64| (1.0 - p.max(LEAST).log10() / LEAST.log10()).clamp(0.0, 1.0);
    let mut classes = vec![String::new(); CLASSES];
    for (k, p) in reach.iter().enumerate().filter(|(_, p)| **p > 0.0) {
        let [i, j] = [(k % nx) as f64, (k / nx) as f64];
        let [x, y] = map_of.axes.place(map_of.within([origin[0] + i * cell, origin[1] + (j + 1.0) * cell]));
        let [to_x, to_y] =
            map_of.axes.place(map_of.within([origin[0] + (i + 1.0) * cell, origin[1] + j * cell]));
        let class = ((part(*p) * CLASSES as f64) as usize).min(CLASSES - 1);
        let _ = write!(classes[class], "M{x:.1} {y:.1}H{to_x:.1}V{to_y:.1}H{x:.1}Z");
    }
    for (class, path) in classes.iter().enumerate().filter(|(_, path)| !path.is_empty()) {
        let colour = hex(viridis((class as f64 + 0.5) / CLASSES as f64));
        map_of.svg.raw(&format!(
            "<path d=\"{path}\" fill=\"{colour}\" fill-opacity=\"0.85\" shape-rendering=\"crispEdges\"/>"
        ));
    }
    let labels = [1e-3, 1e-2, 1e-1, 1.0].map(|p| (part(p), format!("{} %", short(100.0 * p))));
    let y = map_of.scale("fraction of boulders", viridis, &labels);
    map_of.key(y, &[("contour, height [m]", &contour), ("lit from north-west", &shade)]);
    map_of.finish(outcome)
}
