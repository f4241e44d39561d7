//! A stereonet as a picture: poles by set, mean planes, intersections, the face of a slope, and circles of friction.

use super::input::Planes;
use super::net::Net;
use super::orientation::{Line, Orientation};
use super::{Set, Stereonet};
use crate::picture;
use crate::picture::svg::{Anchor, Rgb, Svg};

/// Width and height [px].
const SIZE: [usize; 2] = [1080, 690];
/// Middle and radius of the disc [px].
const CENTRE: [f64; 2] = [320.0, 376.0];
const RADIUS: f64 = 270.0;
/// Points of a great circle.
const POINTS: usize = 91;
const INK: Rgb = [30, 30, 34];
const FAINT: Rgb = [214, 214, 218];
const GREY: Rgb = [110, 110, 118];
const FACE: Rgb = [196, 40, 40];
/// Left end of the key, and its first line [px].
const KEY: [f64; 2] = [650.0, 84.0];
const LINE: f64 = 22.0;
/// Room of words in the key [px].
const ROOM: f64 = 390.0;
/// Colour of the planes of sets that are not listed.
const OTHERS: Rgb = [160, 160, 166];

/// Draws a stereonet; the face and friction are drawn whether or not there is a check.
pub fn draw(
    planes: &Planes,
    stereonet: &Stereonet,
    face: Option<Orientation>,
    friction_deg: Option<f64>,
) -> String {
    let mut svg = Svg::new(SIZE);
    svg.rect([0.0, 0.0], SIZE.map(|side| side as f64), [255; 3]);
    let net = stereonet.net;
    let kind = match net {
        Net::Area => "equal area",
        Net::Angle => "equal angle",
    };
    svg.words([24.0, 26.0], 19.0, Anchor::Start, INK, 920.0, &stereonet.title);
    let below = format!("lower hemisphere, {kind} · poles of {} planes", planes.planes.len());
    svg.words([24.0, 50.0], 14.0, Anchor::Start, GREY, 920.0, &below);
    grid(&mut svg, net);
    if let Some(face) = face {
        circle(&mut svg, net, &face, 2.6, FACE);
    }
    if let Some(friction_deg) = friction_deg {
        // Poles of planes that dip by φ, and lines that plunge by φ.
        svg.ring(CENTRE, RADIUS * net.radius(90.0 - friction_deg), 1.8, GREY, "");
        svg.ring(CENTRE, RADIUS * net.radius(friction_deg), 1.8, GREY, "7 5");
    }
    let colours = Colours::new(stereonet);
    for (set, colour) in &colours.listed {
        circle(&mut svg, net, &stereonet.sets[*set].fisher.mean, 1.4, *colour);
    }
    poles(&mut svg, planes, stereonet, &colours);
    marks(&mut svg, stereonet, &colours);
    key(&mut svg, stereonet, &colours, face, friction_deg);
    svg.finish()
}

/// The sets that are listed with their colours; all others share one.
struct Colours {
    listed: Vec<(usize, Rgb)>,
}

impl Colours {
    fn new(stereonet: &Stereonet) -> Self {
        let colour = |(place, set)| {
            let plotters::style::RGBColor(r, g, b) = picture::colour(place);
            (set, [r, g, b])
        };
        Self { listed: stereonet.listed().into_iter().enumerate().map(colour).collect() }
    }

    /// Colour of a set, if it is listed.
    fn find(&self, set: usize) -> Option<Rgb> {
        self.listed.iter().find(|(listed, _)| *listed == set).map(|(_, colour)| *colour)
    }
}

fn place(net: Net, line: &Line) -> [f64; 2] {
    on_disc(net.place(line))
}

fn on_disc([x, y]: [f64; 2]) -> [f64; 2] {
    [CENTRE[0] + RADIUS * x, CENTRE[1] - RADIUS * y]
}

/// Circles of equal plunge and radii of equal trend, every 30°, with azimuths on the rim.
fn grid(svg: &mut Svg, net: Net) {
    for plunge in [30.0, 60.0] {
        svg.ring(CENTRE, RADIUS * net.radius(plunge), 1.0, FAINT, "");
    }
    for step in 0..12 {
        let trend_deg = 30.0 * f64::from(step);
        let rim = place(net, &Line { trend_deg, plunge_deg: 0.0 });
        svg.line(CENTRE, rim, 1.0, FAINT);
        let outside = [0, 1].map(|i| CENTRE[i] + (rim[i] - CENTRE[i]) * (RADIUS + 18.0) / RADIUS);
        let words = if step == 0 { "N".into() } else { format!("{trend_deg:.0}") };
        svg.words(outside, if step == 0 { 17.0 } else { 12.0 }, Anchor::Middle, INK, 60.0, &words);
    }
    svg.ring(CENTRE, RADIUS, 1.8, INK, "");
}

fn circle(svg: &mut Svg, net: Net, plane: &Orientation, width: f64, colour: Rgb) {
    let points: Vec<[f64; 2]> = net.great_circle(plane, POINTS).into_iter().map(on_disc).collect();
    svg.polyline(&points, width, colour);
}

/// Poles in the colours of their sets; those of planes that may slide or topple with a ring.
fn poles(svg: &mut Svg, planes: &Planes, stereonet: &Stereonet, colours: &Colours) {
    let radius = if planes.planes.len() > 300 { 2.6 } else { 4.2 };
    for (plane, &set) in planes.planes.iter().zip(&planes.set_of) {
        let at = place(stereonet.net, &plane.pole());
        svg.circle(at, radius, colours.find(set).unwrap_or(OTHERS));
        let is_critical = stereonet.slope.is_some_and(|slope| slope.slides(plane) || slope.topples(plane));
        if is_critical {
            svg.ring(at, radius + 2.6, 1.6, FACE, "");
        }
    }
}

/// Means of sets as squares, and intersections of mean planes as triangles.
fn marks(svg: &mut Svg, stereonet: &Stereonet, colours: &Colours) {
    for (set, colour) in &colours.listed {
        let fisher = &stereonet.sets[*set].fisher;
        if fisher.planes > 1 {
            square(svg, place(stereonet.net, &fisher.mean.pole()), *colour);
        }
    }
    let is_listed = |name: &String| colours.listed.iter().any(|(set, _)| stereonet.sets[*set].name == *name);
    for wedge in stereonet.wedges.iter().filter(|wedge| wedge.sets.iter().all(is_listed)) {
        triangle(
            svg,
            place(stereonet.net, &wedge.line),
            if wedge.critical == Some(true) { FACE } else { INK },
        );
    }
}

fn square(svg: &mut Svg, [x, y]: [f64; 2], colour: Rgb) {
    svg.rect([x - 7.0, y - 7.0], [14.0, 14.0], INK);
    svg.rect([x - 5.0, y - 5.0], [10.0, 10.0], colour);
}

fn triangle(svg: &mut Svg, [x, y]: [f64; 2], colour: Rgb) {
    svg.polygon(&[[x, y - 8.0], [x + 7.0, y + 5.0], [x - 7.0, y + 5.0]], colour);
}

/// Sets with their means, and the meaning of lines and marks.
fn key(
    svg: &mut Svg,
    stereonet: &Stereonet,
    colours: &Colours,
    face: Option<Orientation>,
    friction_deg: Option<f64>,
) {
    let mut y = KEY[1];
    let mut line = |svg: &mut Svg, mark: &dyn Fn(&mut Svg, [f64; 2]), words: &str| {
        mark(svg, [KEY[0] + 12.0, y]);
        svg.words([KEY[0] + 34.0, y], 13.0, Anchor::Start, INK, ROOM, words);
        y += LINE;
    };
    for (set, colour) in &colours.listed {
        line(svg, &|svg, at| svg.circle(at, 5.0, *colour), &words_of(&stereonet.sets[*set]));
    }
    let others = stereonet.sets.len() - colours.listed.len();
    if others > 0 {
        line(svg, &|svg, at| svg.circle(at, 5.0, OTHERS), &format!("{others} other sets"));
    }
    line(svg, &|_, _| (), "");
    if stereonet.sets.iter().any(|set| set.fisher.planes > 1) {
        line(svg, &|svg, at| square(svg, at, GREY), "mean pole of a set");
    }
    if !stereonet.wedges.is_empty() {
        line(svg, &|svg, at| triangle(svg, at, INK), "intersection of mean planes");
    }
    if stereonet.wedges.iter().any(|wedge| wedge.critical == Some(true)) {
        line(svg, &|svg, at| triangle(svg, at, FACE), "the same, along which a wedge may slide");
    }
    let dash = |colour: Rgb| {
        move |svg: &mut Svg, [x, y]: [f64; 2]| svg.line([x - 12.0, y], [x + 12.0, y], 2.4, colour)
    };
    if let Some(face) = face {
        line(svg, &dash(FACE), &format!("face of the slope {face}"));
    }
    if let Some(friction) = friction_deg {
        line(
            svg,
            &|svg, at| svg.ring(at, 8.0, 1.8, GREY, ""),
            &format!("poles of planes that dip by φ = {friction}°"),
        );
        line(
            svg,
            &|svg, at| svg.ring(at, 8.0, 1.8, GREY, "4 3"),
            &format!("lines that plunge by φ = {friction}°"),
        );
    }
    if let Some(checks) = stereonet.checks {
        line(svg, &|svg, at| svg.ring(at, 6.0, 1.6, FACE, ""), "plane that may slide or topple");
        line(svg, &|_, _| (), "");
        for (name, count, of) in [
            ("plane sliding on", checks.plane_sliding, "planes"),
            ("wedge sliding along", checks.wedge_sliding, "lines"),
            ("toppling on", checks.flexural_toppling, "planes"),
        ] {
            line(svg, &|_, _| (), &format!("{name} {}", count.of_all(of)));
        }
    }
}

fn words_of(set: &Set) -> String {
    let alike = if set.fisher.planes > 1 { ", all alike" } else { "" };
    let k = set.fisher.k.map_or(alike.to_string(), |k| format!(", K = {k:.0}"));
    let count =
        if set.fisher.planes > 1 { format!("{} planes, mean ", set.fisher.planes) } else { String::new() };
    format!("{}: {count}{}{k}", set.name, set.fisher.mean)
}
