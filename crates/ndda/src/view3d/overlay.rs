//! Everything beside the blocks, as SVG: title, scale of colours, axes and scale bar.

use ndda_mesh::Vec3;

use super::camera::{Axes, Camera, Pane};
use super::film::{Colouring, Film};
use super::numbers::{on_scale, round_below, three_digits, ticks, unit_for};
use super::paint::{Theme, group_colour, viridis};
use crate::picture::svg::{Anchor, Rgb, Svg};

/// Colours of the axes x, y and z.
const AXIS_COLOURS: [Rgb; 3] = [[205, 62, 54], [44, 146, 84], [56, 118, 200]];
/// Most groups that are listed.
const MOST_GROUPS: usize = 14;
/// The scale bar is at most this part of the pane's width.
const BAR_PART: f64 = 0.22;

/// Places of everything in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    /// Whole picture [px].
    pub size: [usize; 2],
    /// Unit of lengths and letters [px]: 1 in a picture of 1200 by 800.
    pub unit: f64,
    /// Where the blocks are.
    pub pane: Pane,
}

impl Layout {
    /// The places in a picture of so many pixels.
    pub fn new(size: [usize; 2]) -> Self {
        let [width, height] = size.map(|side| side as f64);
        let unit = (width * height / (1200.0 * 800.0)).sqrt();
        let [left, above, right, below] = [16.0, 66.0, 164.0, 92.0].map(|length| (length * unit).round());
        let pane = Pane {
            x: left,
            y: above,
            width: (width - left - right).max(1.0),
            height: (height - above - below).max(1.0),
        };
        Self { size, unit, pane }
    }

    /// Rows and columns of the pane.
    pub fn pane_size(&self) -> [usize; 2] {
        [self.pane.width as usize, self.pane.height as usize]
    }

    /// Left end of the legend [px].
    pub fn legend_x(&self) -> f64 {
        self.pane.x + self.pane.width + 22.0 * self.unit
    }
}

/// Title, and the time and what else there is to know below it.
pub fn title(svg: &mut Svg, layout: &Layout, theme: &Theme, film: &Film, below: &str) {
    let (u, x) = (layout.unit, layout.pane.x);
    let room = layout.size[0] as f64 - 2.0 * x;
    svg.words([x, 24.0 * u], 19.0 * u, Anchor::Start, theme.text, room, &film.title);
    svg.words([x, 48.0 * u], 14.0 * u, Anchor::Start, theme.faint, room, below);
}

/// The scale of colours, or the groups; in the upper half where the legend of bolts is below.
pub fn legend(svg: &mut Svg, layout: &Layout, theme: &Theme, film: &Film, is_half: bool) {
    let (u, x) = (layout.unit, layout.legend_x());
    let (top, part) = (layout.pane.y + 8.0 * u, if is_half { 0.34 } else { 0.62 });
    let bar = Bar { x, top, height: (part * layout.pane.height).min(340.0 * u), colour: viridis };
    match &film.colouring {
        // Nothing has a colour of the scale where nothing has moved.
        Colouring::Scale { with_resting: false, .. } if !film.moves.contains(&true) => {}
        Colouring::Scale { label, unit, range, .. } => scale(svg, layout, theme, &bar, (label, unit), *range),
        Colouring::Groups { names, plural, of_block, with_resting } => {
            let shown = |b: &usize| *with_resting || film.moves[*b];
            let mut groups: Vec<u32> = (0..of_block.len()).filter(shown).map(|b| of_block[b]).collect();
            groups.sort_unstable();
            groups.dedup();
            let most = if is_half { (0.5 * layout.pane.height / (22.0 * u)) as usize } else { MOST_GROUPS };
            list(svg, layout, theme, (x, most.min(MOST_GROUPS)), (names, plural), &groups);
        }
    }
}

/// Place of a bar of colours with its name above, and its colours.
pub struct Bar {
    /// Left end [px].
    pub x: f64,
    /// Middle of its name [px].
    pub top: f64,
    /// Its height [px].
    pub height: f64,
    /// Colour at a part of it from below, 0 to 1.
    pub colour: fn(f64) -> Rgb,
}

/// A bar of colours from the least to the largest value, with round marks.
pub fn scale(
    svg: &mut Svg,
    layout: &Layout,
    theme: &Theme,
    &Bar { x, top, height, colour }: &Bar,
    (label, unit): (&str, &'static str),
    [low, high]: [f64; 2],
) {
    let u = layout.unit;
    let (size, name) = unit_for(low.abs().max(high.abs()), unit);
    let room = layout.size[0] as f64 - x;
    svg.words([x, top], 14.0 * u, Anchor::Start, theme.text, room, label);
    if !name.is_empty() {
        svg.words([x, top + 18.0 * u], 14.0 * u, Anchor::Start, theme.faint, room, &format!("[{name}]"));
    }
    let (top, width) = (top + 42.0 * u, 20.0 * u);
    let strips = 96;
    for i in 0..strips {
        let share = height / f64::from(strips);
        let colour = colour(1.0 - (f64::from(i) + 0.5) / f64::from(strips));
        // Each strip reaches under the next one, so that none shows a gap.
        let tall = if i + 1 < strips { 1.5 * share } else { share };
        svg.rect([x, top + f64::from(i) * share], [width, tall], colour);
    }
    let at = |value: f64| if high > low { top + height * (high - value) / (high - low) } else { top };
    let mut mark = |value: f64, bold: bool| {
        let y = at(value);
        let colour = if bold { theme.text } else { theme.faint };
        svg.line([x + width, y], [x + width + 5.0 * u, y], 1.2 * u, colour);
        let words = on_scale(value / size, low / size, high / size);
        svg.words([x + width + 10.0 * u, y], 13.0 * u, Anchor::Start, colour, room - width, &words);
    };
    mark(high, true);
    if high > low {
        mark(low, true);
        let apart = 15.0 * u;
        let marks = ticks(low / size, high / size, 6).into_iter().map(|tick| tick * size);
        marks.filter(|&v| at(v) - at(high) > apart && at(low) - at(v) > apart).for_each(|v| mark(v, false));
    }
}

/// A square of colour and a name for each group, or their number where they are many.
fn list(
    svg: &mut Svg,
    layout: &Layout,
    theme: &Theme,
    (x, most): (f64, usize),
    (names, plural): (&[String], &str),
    groups: &[u32],
) {
    let u = layout.unit;
    let room = layout.size[0] as f64 - x - 24.0 * u;
    let top = layout.pane.y + 8.0 * u;
    if groups.len() > most {
        let words = [format!("{} {plural},", groups.len()), "a colour each".to_string()];
        for (line, words) in [0.0, 18.0].into_iter().zip(&words) {
            svg.words([x, top + line * u], 13.0 * u, Anchor::Start, theme.faint, room, words);
        }
        return;
    }
    for (i, &group) in groups.iter().enumerate() {
        let y = top + 22.0 * u * i as f64;
        svg.rect([x, y - 7.0 * u], [14.0 * u, 14.0 * u], group_colour(group));
        let name = names.get(group as usize).map_or("", String::as_str);
        svg.words([x + 22.0 * u, y], 13.0 * u, Anchor::Start, theme.text, room, name);
    }
}

/// The directions of x (east), y (north) and z, as the picture sees them.
pub fn triad(svg: &mut Svg, layout: &Layout, theme: &Theme, axes: &Axes) {
    let u = layout.unit;
    let (centre, length) = ([layout.pane.x + 52.0 * u, layout.size[1] as f64 - 46.0 * u], 32.0 * u);
    let named = [(Vec3::x(), "x"), (Vec3::y(), "y (N)"), (Vec3::z(), "z")];
    let mut arrows: Vec<(usize, [f64; 2], f64)> = (0..3)
        .map(|i| {
            let (place, towards) = axes.plane(&named[i].0);
            (i, place, towards)
        })
        .collect();
    arrows.sort_by(|a, b| a.2.total_cmp(&b.2));
    for (i, [right, up], _) in arrows {
        let long = right.hypot(up);
        let (dx, dy) = (length * right, -length * up);
        let tip = [centre[0] + dx, centre[1] + dy];
        svg.line(centre, tip, 2.2 * u, AXIS_COLOURS[i]);
        if long < 0.2 {
            // An axis along the line of sight is a dot.
            svg.circle(tip, 3.4 * u, AXIS_COLOURS[i]);
            let beside = [centre[0] - 10.0 * u, centre[1] + 12.0 * u];
            svg.words(beside, 13.0 * u, Anchor::End, theme.text, 60.0 * u, named[i].1);
            continue;
        }
        let (ex, ey) = (dx / (long * length), dy / (long * length));
        let head = |along: f64, aside: f64| {
            [tip[0] + (along * ex - aside * ey) * u, tip[1] + (along * ey + aside * ex) * u]
        };
        svg.polygon(&[head(7.0, 0.0), head(-2.0, 3.8), head(-2.0, -3.8)], AXIS_COLOURS[i]);
        let anchor = match ex {
            ex if ex > 0.5 => Anchor::Start,
            ex if ex < -0.5 => Anchor::End,
            _ => Anchor::Middle,
        };
        let (x, y) = (tip[0] + 11.0 * u * ex, tip[1] + 15.0 * u * ey);
        svg.words([x, y], 13.0 * u, anchor, theme.text, 60.0 * u, named[i].1);
    }
}

/// Length of the scale bar of a picture [m]: round, and at most a part of the pane.
pub fn bar_length_m(camera: &Camera, pane: &Pane) -> f64 {
    round_below(BAR_PART * pane.width / camera.px_per_m)
}

/// A bar whose length is written above it.
pub fn scale_bar(svg: &mut Svg, layout: &Layout, theme: &Theme, camera: &Camera) {
    let u = layout.unit;
    let length_m = bar_length_m(camera, &layout.pane);
    let (y, right) = (layout.size[1] as f64 - 22.0 * u, layout.pane.x + layout.pane.width);
    let left = right - length_m * camera.px_per_m;
    svg.line([left, y], [right, y], 2.4 * u, theme.text);
    for x in [left, right] {
        svg.line([x, y - 5.0 * u], [x, y + 5.0 * u], 2.0 * u, theme.text);
    }
    let (size, name) = unit_for(length_m, "m");
    let words = format!("{} {name}", three_digits(length_m / size));
    svg.words([0.5 * (left + right), y - 15.0 * u], 14.0 * u, Anchor::Middle, theme.text, 200.0 * u, &words);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view3d::camera::{Bounds, View};

    #[test]
    fn a_scale_bar_is_as_long_as_it_says() {
        let layout = Layout::new([1200, 800]);
        for width_m in [0.013, 1.0, 7.3, 480.0, 12_000.0] {
            let bounds = Bounds { least: [0.0; 2], most: [width_m, 0.1 * width_m] };
            let camera = Camera::fit(Axes::new(View::default()), &bounds, &layout.pane);
            let length_m = bar_length_m(&camera, &layout.pane);
            let part = length_m * camera.px_per_m / layout.pane.width;
            assert!(part <= BAR_PART * (1.0 + 1e-9) && part > 0.4 * BAR_PART, "{width_m}: {part}");
            let mut svg = Svg::new(layout.size);
            scale_bar(&mut svg, &layout, &crate::view3d::paint::LIGHT_THEME, &camera);
            let text = svg.finish();
            let ends: Vec<f64> = ["x1", "x2"]
                .map(|name| {
                    text.split_once(&format!("{name}=\""))
                        .unwrap()
                        .1
                        .split_once('"')
                        .unwrap()
                        .0
                        .parse()
                        .unwrap()
                })
                .to_vec();
            // The pane is as wide as the bounds, so a metre is pane over width.
            let expected = length_m * layout.pane.width / width_m;
            assert!((ends[1] - ends[0] - expected).abs() < 0.02, "{width_m}: {ends:?} {expected}");
        }
    }
}
