//! Bolts in pictures: lines over the blocks in which they lie, coloured by what they carry.

use ndda_mesh::Vec3;

use super::bolts::{BoltColour, Piece};
use super::camera::{Camera, Pane};
use super::film::{Film, Moment, range};
use super::overlay::{self, Bar, Layout};
use super::paint::{Rgb, Theme, between};
use crate::picture::svg::{Anchor, Svg};

/// Width of a bolt in a picture of 1200 by 800, and of the dark rim on either side of it [px].
const WIDTH_PX: [f64; 2] = [3.0, 0.9];
/// Pieces that meet reach under each other by this much, so that no rim shows between them [px].
const OVERLAP_PX: f64 = 0.6;
/// Colours from the least to the largest force, apart from those of blocks.
const FORCES: [Rgb; 5] = [[255, 246, 190], [254, 203, 92], [252, 141, 60], [222, 45, 38], [122, 0, 38]];
/// Colour of bolts without forces.
const PLAIN: Rgb = [213, 94, 0];
/// States of a piece, by their numbers, and their colours.
const STATES: [(&str, Rgb); 4] = [
    ("elastic", [86, 180, 233]),
    ("debonded", [240, 210, 60]),
    ("yielding", [222, 80, 20]),
    ("broken", [120, 0, 110]),
];

/// Bolts of the moments of a film with a meaning of their colours.
pub struct Bolts<'a> {
    film: &'a Film,
    colour: BoltColour,
    range: [f64; 2],
}

impl<'a> Bolts<'a> {
    /// Chooses the range of colours; bolts of a scene before its run are plain.
    pub fn new(film: &'a Film, colour: BoltColour) -> Self {
        let has_run = film.moments.iter().any(|moment| moment.time_s.is_some());
        let colour = if has_run || colour == BoltColour::Hidden { colour } else { BoltColour::Plain };
        let all = film.moments.iter().flat_map(|moment| &moment.bolts);
        Self { film, colour, range: range(all.map(|piece| value(colour, piece) as f32)) }
    }

    /// Whether there are bolts to draw at any moment.
    pub fn are_shown(&self) -> bool {
        self.colour != BoltColour::Hidden && self.film.moments.iter().any(|moment| !moment.bolts.is_empty())
    }

    /// Draws the bolts of a moment with displacements `magnify` times as large, the farthest away first.
    pub fn draw(&self, svg: &mut Svg, layout: &Layout, theme: &Theme, camera: &Camera, at: (&Moment, f64)) {
        if !self.are_shown() {
            return;
        }
        let (moment, magnify) = at;
        let places = Places::new(self.film, moment, magnify);
        let mut bolts: Vec<(f64, Vec<Line>)> = moment
            .bolts
            .chunk_by(|a, b| a.bolt == b.bolt)
            .map(|pieces| {
                let lines = pieces.iter().map(|piece| self.line(piece, places.of(piece), camera, layout));
                let nearness = lines.clone().map(|(nearness, _)| nearness).sum::<f64>() / pieces.len() as f64;
                (nearness, lines.filter_map(|(_, line)| line).collect())
            })
            .collect();
        bolts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let [width, rim] = WIDTH_PX.map(|width| width * layout.unit);
        for (_, lines) in bolts {
            lines.iter().for_each(|&([a, b], _)| svg.line(a, b, width + 2.0 * rim, theme.edge));
            let [first, last] = [0, lines.len().saturating_sub(1)];
            for (k, &(ends, colour)) in lines.iter().enumerate() {
                let [a, b] =
                    lengthened(ends, [k > first, k < last].map(|meets| if meets { OVERLAP_PX } else { 0.0 }));
                svg.line(a, b, width, colour);
            }
        }
    }

    /// How near a piece is, and the part of it on the pane with its colour.
    fn line(&self, piece: &Piece, ends: [Vec3; 2], camera: &Camera, layout: &Layout) -> (f64, Option<Line>) {
        let projected = ends.map(|end| camera.project(&end));
        let Pane { x, y, .. } = layout.pane;
        let ends = projected.map(|[column, row, _]| [x + column, y + row]);
        let nearness = 0.5 * (projected[0][2] + projected[1][2]);
        (nearness, clipped(ends, &layout.pane).map(|ends| (ends, self.colour_of(piece))))
    }

    fn colour_of(&self, piece: &Piece) -> Rgb {
        match self.colour {
            BoltColour::Plain | BoltColour::Hidden => PLAIN,
            BoltColour::State => STATES[usize::from(piece.state).min(STATES.len() - 1)].1,
            BoltColour::Force | BoltColour::Yield => {
                let [low, high] = self.range;
                let part = if high > low { (value(self.colour, piece) - low) / (high - low) } else { 0.0 };
                between(&FORCES, part)
            }
        }
    }

    /// What the colours mean, below the legend of the blocks.
    pub fn legend(&self, svg: &mut Svg, layout: &Layout, theme: &Theme) {
        if !self.are_shown() {
            return;
        }
        let (u, x) = (layout.unit, layout.legend_x());
        let bar = Bar {
            x,
            top: layout.pane.y + 0.54 * layout.pane.height,
            height: (0.3 * layout.pane.height).min(340.0 * u),
            colour: |part| between(&FORCES, part),
        };
        match self.colour {
            BoltColour::Force => {
                overlay::scale(svg, layout, theme, &bar, ("bolts, tension", "N"), self.range)
            }
            BoltColour::Yield => overlay::scale(svg, layout, theme, &bar, ("bolts / yield", ""), self.range),
            BoltColour::Plain => entry(svg, layout, theme, [x, bar.top], ("bolts", PLAIN)),
            BoltColour::State => {
                let room = layout.size[0] as f64 - x;
                svg.words([x, bar.top], 14.0 * u, Anchor::Start, theme.text, room, "bolts");
                for (i, state) in STATES.into_iter().enumerate() {
                    entry(svg, layout, theme, [x, bar.top + 22.0 * u * (i + 1) as f64], state);
                }
            }
            BoltColour::Hidden => {}
        }
    }
}

type Line = ([[f64; 2]; 2], Rgb);

/// A line that is longer at its ends by so many pixels.
fn lengthened([a, b]: [[f64; 2]; 2], [before, after]: [f64; 2]) -> [[f64; 2]; 2] {
    let step = [b[0] - a[0], b[1] - a[1]];
    let along = step.map(|d| d / step[0].hypot(step[1]).max(f64::MIN_POSITIVE));
    [[0, 1].map(|i| a[i] - before * along[i]), [0, 1].map(|i| b[i] + after * along[i])]
}

/// A short line of a colour and its name.
fn entry(svg: &mut Svg, layout: &Layout, theme: &Theme, [x, y]: [f64; 2], (name, colour): (&str, Rgb)) {
    let u = layout.unit;
    let [width, rim] = WIDTH_PX.map(|width| width * u);
    svg.line([x, y], [x + 18.0 * u, y], width + 2.0 * rim, theme.edge);
    svg.line([x, y], [x + 18.0 * u, y], width, colour);
    let room = layout.size[0] as f64 - x - 26.0 * u;
    svg.words([x + 26.0 * u, y], 13.0 * u, Anchor::Start, theme.text, room, name);
}

fn value(colour: BoltColour, piece: &Piece) -> f64 {
    match colour {
        BoltColour::Force => piece.axial_n,
        BoltColour::Yield => piece.utilisation,
        _ => 0.0,
    }
}

/// Where pieces are drawn: magnified with their blocks.
struct Places<'a> {
    film: &'a Film,
    moment: &'a Moment,
    magnify: f64,
    block_of_node: Vec<u32>,
}

impl<'a> Places<'a> {
    fn new(film: &'a Film, moment: &'a Moment, magnify: f64) -> Self {
        let block_of_node = if magnify == 1.0 { Vec::new() } else { film.block_of_node() };
        Self { film, moment, magnify, block_of_node }
    }

    /// The ends with the further displacement of the nearest node of their block.
    fn of(&self, piece: &Piece) -> [Vec3; 2] {
        if self.magnify == 1.0 {
            return piece.ends;
        }
        let (now, start) = (&self.moment.positions, &self.film.start);
        let is_of_block = |node: &usize| piece.block.is_none_or(|block| self.block_of_node[*node] == block);
        piece.ends.map(|end| {
            let distance = |node: usize| (now[node] - end).norm_squared();
            let nodes = (0..now.len()).filter(is_of_block);
            let nearest = nodes.min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
            nearest.map_or(end, |node| end + (self.magnify - 1.0) * (now[node] - start[node]))
        })
    }
}

/// The part of a line that is on a pane (Liang and Barsky, 1984).
fn clipped([a, b]: [[f64; 2]; 2], pane: &Pane) -> Option<[[f64; 2]; 2]> {
    let (mut from, mut to) = (0.0f64, 1.0f64);
    let ends = [[pane.x, pane.x + pane.width], [pane.y, pane.y + pane.height]];
    for axis in 0..2 {
        let step = b[axis] - a[axis];
        for (along, room) in [(-step, a[axis] - ends[axis][0]), (step, ends[axis][1] - a[axis])] {
            if along > 0.0 {
                to = to.min(room / along);
            } else if along < 0.0 {
                from = from.max(room / along);
            } else if room < 0.0 {
                return None;
            }
        }
    }
    let place = |t: f64| [0, 1].map(|axis| a[axis] + t * (b[axis] - a[axis]));
    (from < to).then(|| [place(from), place(to)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view3d::image::{Look, Picture};
    use crate::view3d::testing::boxes;

    const PANE: Pane = Pane { x: 10.0, y: 20.0, width: 100.0, height: 50.0 };

    #[test]
    fn lines_end_where_the_pane_does() {
        assert_eq!(clipped([[20.0, 30.0], [40.0, 60.0]], &PANE), Some([[20.0, 30.0], [40.0, 60.0]]));
        let near = |line: [[f64; 2]; 2], to: [[f64; 2]; 2]| {
            let found = clipped(line, &PANE).unwrap();
            assert!(
                found.iter().flatten().zip(to.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-9),
                "{found:?}"
            );
        };
        near([[0.0, 30.0], [200.0, 30.0]], [[10.0, 30.0], [110.0, 30.0]]);
        near([[60.0, 0.0], [60.0, 45.0]], [[60.0, 20.0], [60.0, 45.0]]);
        assert_eq!(clipped([[0.0, 0.0], [9.0, 100.0]], &PANE), None);
        assert_eq!(clipped([[0.0, 10.0], [200.0, 10.0]], &PANE), None);
    }

    /// A box that has moved by 0.1 m along x, with a bolt of two pieces.
    fn film() -> Film {
        let mut film = boxes(&[([0.0; 3], [1.0; 3], [0.1, 0.0, 0.0])]);
        let piece = |from: f64, axial_n: f64, state: u8| Piece {
            ends: [from, from + 0.4].map(|z| Vec3::new(0.6, 0.5, z)),
            bolt: 0,
            block: Some(0),
            axial_n,
            utilisation: axial_n / 5e4,
            state,
        };
        film.moments[0].bolts = vec![piece(0.1, 2e3, 0), piece(0.5, 2e4, 2)];
        film
    }

    fn lines(bolts: BoltColour, magnify: f64) -> (Vec<[f64; 4]>, String) {
        let film = film();
        let look = Look { bolts, magnify, view: "front".parse().unwrap(), ..Look::default() };
        let svg = Picture::new(&film, look).svg(&film.moments[0]).unwrap();
        let number = |line: &str, name: &str| -> f64 {
            let text = line.split_once(&format!(" {name}=\"")).unwrap().1;
            text.split_once('"').unwrap().0.parse().unwrap()
        };
        let wide = format!("stroke-width=\"{:.2}\"", WIDTH_PX[0]);
        let found = svg.lines().filter(|line| line.starts_with("<line") && line.contains(&wide));
        (found.map(|line| ["x1", "y1", "x2", "y2"].map(|name| number(line, name))).collect(), svg)
    }

    #[test]
    fn a_bolt_is_drawn_where_it_is_and_moves_with_its_block_where_that_is_magnified() {
        let (once, svg) = lines(BoltColour::Force, 1.0);
        assert_eq!(once.len(), 2);
        // From the south, x is to the right and a bolt along z upright; its pieces meet.
        assert!(once.iter().all(|[x1, y1, x2, y2]| x1 == x2 && y1 > y2));
        let overlap = once[1][1] - once[0][3];
        assert!((overlap - 2.0 * OVERLAP_PX).abs() < 0.02, "{overlap}");
        assert!(
            svg.contains("\nbolts, tension\n") && svg.contains("[kN]") && svg.contains("\n20\n"),
            "{svg}"
        );
        // In view is from 0 to 1 + m/10 metres; the bolt was at half a metre and has moved by m/10.
        for magnify in [1.0, 10.0] {
            let (found, _) = lines(BoltColour::Force, magnify);
            let px_per_m = (found[0][1] - found[0][3] - OVERLAP_PX) / 0.4;
            let from_middle_m = (found[0][0] - (16.0 + 0.5 * 1020.0)) / px_per_m;
            assert!((from_middle_m - 0.05 * magnify).abs() < 1e-3, "{magnify}: {from_middle_m}");
        }
    }

    #[test]
    fn colours_say_force_share_of_yield_or_state_or_nothing() {
        let has = |bolts: BoltColour, words: &[&str]| {
            let (found, svg) = lines(bolts, 1.0);
            words.iter().all(|word| svg.contains(&format!("\n{word}\n"))).then_some(found.len())
        };
        assert_eq!(has(BoltColour::Yield, &["bolts / yield", "0.4"]), Some(2));
        assert_eq!(has(BoltColour::State, &["bolts", "elastic", "broken"]), Some(2 + STATES.len()));
        assert_eq!(has(BoltColour::Plain, &["bolts"]), Some(3));
        let (found, svg) = lines(BoltColour::Hidden, 1.0);
        assert!(found.is_empty() && !svg.contains("bolts"));
    }
}
