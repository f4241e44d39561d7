//! Triangles and edges as pixels: a z-buffer in bands of rows, four samples to a pixel.
//!
//! Bands are independent and each is filled in the order of the triangles, so that a picture is the same on any number of threads.

use rayon::prelude::*;

use super::paint::{Rgb, Theme, lit, mix, viridis};

/// Samples on a side of a pixel.
const SAMPLES: usize = 2;
/// Rows of pixels in a band.
const ROWS: usize = 16;
/// No block.
const NONE: u32 = u32::MAX;
/// Edges are in front of faces by this many of their widths, because faces end there.
const IN_FRONT: f64 = 2.0;

/// Colour of a face before light falls on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coat {
    /// One colour.
    Plain(Rgb),
    /// Part of the scale of colours at each corner, 0 to 1.
    Scale([f64; 3]),
}

/// A triangle to draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face {
    /// Column, row and nearness of its corners [px].
    pub corners: [[f64; 3]; 3],
    /// Its colour.
    pub coat: Coat,
    /// Light on it, 0 to 1.
    pub brightness: f64,
    /// Its block.
    pub block: u32,
}

/// An edge to draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// Column, row and nearness of its ends [px].
    pub ends: [[f64; 3]; 2],
    /// Its block.
    pub block: u32,
    /// How dark it is, 0 to 1.
    pub weight: f64,
}

/// Everything that is seen together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solid {
    /// Triangles that face the viewer.
    pub faces: Vec<Face>,
    /// Edges between faces.
    pub edges: Vec<Edge>,
}

/// How a picture is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// Colours.
    pub theme: Theme,
    /// Width of edges [px].
    pub edge_px: f64,
    /// How dark outlines of blocks are, 0 to 1.
    pub edge_weight: f64,
    /// How much of the faces of the veil is seen, and of its edges, 0 to 1.
    pub veil: [f64; 2],
}

/// Pixels, three bytes each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pixels {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Red, green and blue of each pixel, row by row from the top.
    pub rgb: Vec<u8>,
}

impl Pixels {
    /// Colour of a pixel.
    #[cfg(test)]
    pub fn at(&self, x: usize, y: usize) -> Rgb {
        let at = 3 * (y * self.width + x);
        [self.rgb[at], self.rgb[at + 1], self.rgb[at + 2]]
    }
}

/// Samples of some rows.
struct Layer {
    width: usize,
    /// First row, which may be above the picture.
    top: isize,
    rows: usize,
    nearness: Vec<f64>,
    colour: Vec<Rgb>,
    owner: Vec<u32>,
    /// How dark edges are there.
    ink: Vec<f64>,
}

/// Draws a solid, and over it a veil: blocks that are seen through.
pub fn draw(size: [usize; 2], solid: &Solid, veil: &Solid, style: &Style) -> Pixels {
    let [width, height] = size;
    let mut rgb = vec![0; 3 * width * height];
    rgb.par_chunks_mut(3 * width * ROWS).enumerate().for_each(|(band, bytes)| {
        let rows = SAMPLES * bytes.len() / (3 * width);
        let top = (SAMPLES * ROWS * band) as isize;
        let layer = |solid: &Solid| Layer::new(SAMPLES * width, top, rows, solid, style);
        let below = layer(solid);
        let above = (!veil.faces.is_empty()).then(|| layer(veil));
        for (i, pixel) in bytes.chunks_exact_mut(3).enumerate() {
            let (x, y) = (SAMPLES * (i % width), SAMPLES * (i / width));
            pixel.copy_from_slice(&pixel_colour(&below, above.as_ref(), [x, y], style));
        }
    });
    Pixels { width, height, rgb }
}

/// Mean of the samples of a pixel.
fn pixel_colour(below: &Layer, above: Option<&Layer>, [x, y]: [usize; 2], style: &Style) -> Rgb {
    let mut sums = [0u32; 3];
    for (dx, dy) in (0..SAMPLES * SAMPLES).map(|i| (i % SAMPLES, i / SAMPLES)) {
        // The first row of a layer is a border.
        let at = (y + dy + 1) * below.width + x + dx;
        let seen = if below.owner[at] == NONE { style.theme.background } else { below.colour[at] };
        let veiled = above.filter(|a| a.owner[at] != NONE && a.nearness[at] > below.nearness[at]);
        let veil = |a: &Layer| style.veil[usize::from(a.ink[at] > 0.0)];
        let colour = veiled.map_or(seen, |a| mix(seen, a.colour[at], veil(a)));
        (0..3).for_each(|c| sums[c] += u32::from(colour[c]));
    }
    let count = (SAMPLES * SAMPLES) as u32;
    sums.map(|sum| ((sum + count / 2) / count) as u8)
}

/// Part of the pixels of `moving` that are behind `others`, as a picture of so many pixels sees them; 0 where there are none.
pub fn hidden_part(size: [usize; 2], moving: &Solid, others: &Solid, style: &Style) -> f64 {
    let layer =
        |solid: &Solid| Layer::new(size[0], 0, size[1], &Solid { edges: Vec::new(), ..solid.clone() }, style);
    let (moving, others) = (layer(moving), layer(others));
    let seen = || (0..moving.owner.len()).filter(|&i| moving.owner[i] != NONE);
    let behind = seen().filter(|&i| others.owner[i] != NONE && others.nearness[i] > moving.nearness[i]);
    behind.count() as f64 / seen().count().max(1) as f64
}

impl Layer {
    /// Rows of samples of a solid whose places are pixels, with one more row above and below.
    fn new(width: usize, top: isize, rows: usize, solid: &Solid, style: &Style) -> Self {
        let count = width * (rows + 2);
        let mut layer = Self {
            width,
            top: top - 1,
            rows: rows + 2,
            nearness: vec![f64::NEG_INFINITY; count],
            colour: vec![[0; 3]; count],
            owner: vec![NONE; count],
            ink: vec![0.0; count],
        };
        solid.faces.iter().for_each(|face| layer.fill(face));
        if !solid.edges.is_empty() {
            layer.outline(style.edge_weight);
            let half = 0.5 * style.edge_px * SAMPLES as f64;
            solid.edges.iter().for_each(|edge| layer.stroke(edge, half, style.theme.background));
            layer.apply(style);
        }
        layer
    }

    /// Rows between two places, as far as the layer has them.
    fn rows_between(&self, low: f64, high: f64) -> std::ops::Range<usize> {
        let top = self.top as f64;
        let limited = |y: f64| (y - top).clamp(0.0, self.rows as f64) as usize;
        limited((low - 0.5).ceil())..limited((high - 0.5).floor() + 1.0)
    }

    fn columns_between(&self, low: f64, high: f64) -> std::ops::Range<usize> {
        let limited = |x: f64| x.clamp(0.0, self.width as f64) as usize;
        limited((low - 0.5).ceil())..limited((high - 0.5).floor() + 1.0)
    }

    /// Fills a triangle where it is nearer than what is there.
    fn fill(&mut self, face: &Face) {
        let [a, b, c] = face.corners;
        let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let area = u[0] * v[1] - u[1] * v[0];
        if area.abs() < 1e-12 {
            return;
        }
        let ends = |i: usize| (a[i].min(b[i]).min(c[i]), a[i].max(b[i]).max(c[i]));
        let ((left, right), (low, high)) = (ends(0), ends(1));
        let columns = self.columns_between(left, right);
        for row in self.rows_between(low, high) {
            let y = (self.top + row as isize) as f64 + 0.5 - a[1];
            for column in columns.clone() {
                let x = column as f64 + 0.5 - a[0];
                // Shares of the second and third corner; a hair outside counts, so that no gap is left between triangles.
                let (s, t) = ((x * v[1] - y * v[0]) / area, (u[0] * y - u[1] * x) / area);
                if s < -1e-9 || t < -1e-9 || s + t > 1.0 + 1e-9 {
                    continue;
                }
                let nearness = a[2] + s * (b[2] - a[2]) + t * (c[2] - a[2]);
                let at = row * self.width + column;
                if nearness > self.nearness[at] {
                    self.nearness[at] = nearness;
                    self.owner[at] = face.block;
                    self.colour[at] = lit(face.coat.at(s, t), face.brightness);
                }
            }
        }
    }

    /// Marks samples beside another block that is farther away, or beside nothing.
    fn outline(&mut self, weight: f64) {
        for at in (0..self.owner.len()).filter(|&at| self.owner[at] != NONE) {
            let (row, column) = (at / self.width, at % self.width);
            let beside = [
                (column > 0).then(|| at - 1),
                (column + 1 < self.width).then(|| at + 1),
                (row > 0).then(|| at - self.width),
                (row + 1 < self.rows).then(|| at + self.width),
            ];
            let differs = |other: usize| {
                self.owner[other] != self.owner[at] && self.nearness[other] <= self.nearness[at]
            };
            if beside.into_iter().flatten().any(differs) {
                self.ink[at] = weight;
            }
        }
    }

    /// Marks the samples of an edge that is not behind a face.
    fn stroke(&mut self, edge: &Edge, half: f64, background: Rgb) {
        let [a, b] = edge.ends;
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let square = dx * dx + dy * dy;
        let place = |x: f64, y: f64| {
            if square > 0.0 { (((x - a[0]) * dx + (y - a[1]) * dy) / square).clamp(0.0, 1.0) } else { 0.0 }
        };
        for row in self.rows_between(a[1].min(b[1]) - half, a[1].max(b[1]) + half) {
            let y = (self.top + row as isize) as f64 + 0.5;
            // The part of the edge that is near this row.
            let (from, to) = if dy.abs() > 1e-9 {
                let at = [y - half, y + half].map(|y| ((y - a[1]) / dy).clamp(0.0, 1.0));
                (a[0] + dx * at[0], a[0] + dx * at[1])
            } else {
                (a[0], b[0])
            };
            for column in self.columns_between(from.min(to) - half, from.max(to) + half) {
                let x = column as f64 + 0.5;
                let t = place(x, y);
                let nearness = a[2] + t * (b[2] - a[2]);
                let at = row * self.width + column;
                let is_near = (a[0] + t * dx - x).hypot(a[1] + t * dy - y) <= half;
                if is_near && nearness + IN_FRONT * half >= self.nearness[at] {
                    self.ink[at] = self.ink[at].max(edge.weight);
                    if self.owner[at] == NONE {
                        (self.owner[at], self.nearness[at]) = (edge.block, nearness);
                        self.colour[at] = background;
                    }
                }
            }
        }
    }

    fn apply(&mut self, style: &Style) {
        for (colour, weight) in self.colour.iter_mut().zip(&self.ink).filter(|(_, weight)| **weight > 0.0) {
            *colour = mix(*colour, style.theme.edge, *weight);
        }
    }
}

impl Coat {
    /// Colour at a place of a triangle, by the shares of its second and third corner.
    fn at(&self, s: f64, t: f64) -> Rgb {
        match *self {
            Self::Plain(colour) => colour,
            Self::Scale([a, b, c]) => viridis(a + s * (b - a) + t * (c - a)),
        }
    }
}

/// Places of pixels as places of samples.
pub const SAMPLES_PER_PIXEL: f64 = SAMPLES as f64;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view3d::paint::LIGHT_THEME;

    const STYLE: Style = Style { theme: LIGHT_THEME, edge_px: 1.0, edge_weight: 1.0, veil: [0.25, 0.5] };

    fn square(from: f64, to: f64, nearness: f64, coat: Coat, block: u32) -> [Face; 2] {
        let at = |x: f64, y: f64| [2.0 * x, 2.0 * y, nearness];
        let face = |corners| Face { corners, coat, brightness: 1.0, block };
        [face([at(from, from), at(to, from), at(to, to)]), face([at(from, from), at(to, to), at(from, to)])]
    }

    fn solid(faces: impl IntoIterator<Item = [Face; 2]>) -> Solid {
        Solid { faces: faces.into_iter().flatten().collect(), edges: Vec::new() }
    }

    #[test]
    fn a_square_covers_its_pixels_and_no_others() {
        let red = Coat::Plain([200, 0, 0]);
        let pixels = draw([20, 40], &solid([square(3.0, 11.0, 0.0, red, 0)]), &Solid::default(), &STYLE);
        for (x, y) in (0..20).flat_map(|x| (0..40).map(move |y| (x, y))) {
            let inside = (3..11).contains(&x) && (3..11).contains(&y);
            assert_eq!(pixels.at(x, y), if inside { [200, 0, 0] } else { [255; 3] }, "{x} {y}");
        }
    }

    #[test]
    fn the_nearer_of_two_faces_is_seen_whatever_their_order() {
        let (red, blue) = (Coat::Plain([200, 0, 0]), Coat::Plain([0, 0, 200]));
        let (near, far) = (square(2.0, 8.0, 5.0, red, 0), square(4.0, 12.0, 1.0, blue, 1));
        for faces in [[near, far], [far, near]] {
            let pixels = draw([16, 16], &solid(faces), &Solid::default(), &STYLE);
            assert_eq!((pixels.at(5, 5), pixels.at(10, 10)), ([200, 0, 0], [0, 0, 200]));
        }
    }

    #[test]
    fn half_a_pixel_is_half_the_colour() {
        let black = Coat::Plain([0; 3]);
        let pixels = draw([8, 8], &solid([square(1.5, 4.0, 0.0, black, 0)]), &Solid::default(), &STYLE);
        assert_eq!(pixels.at(1, 2), [128; 3]);
        // A quarter at the corner.
        assert_eq!(pixels.at(1, 1), [191; 3]);
    }

    #[test]
    fn values_between_corners_are_on_the_scale_between_them() {
        let mut faces = square(0.0, 8.0, 0.0, Coat::Scale([0.0, 1.0, 1.0]), 0);
        faces[1].coat = Coat::Scale([0.0, 1.0, 0.0]);
        let pixels = draw([8, 8], &solid([faces]), &Solid::default(), &STYLE);
        for x in 0..8 {
            let mean = |parts: [f64; 2]| mix(viridis(parts[0]), viridis(parts[1]), 0.5);
            let expected = mean([0.25, 0.75].map(|part| (x as f64 + part) / 8.0));
            let found = pixels.at(x, 5);
            assert!((0..3).all(|c| found[c].abs_diff(expected[c]) <= 1), "{found:?} {expected:?}");
        }
    }

    #[test]
    fn a_veil_lets_the_blocks_behind_it_be_seen() {
        let (red, grey) = (Coat::Plain([200, 0, 0]), Coat::Plain([100; 3]));
        let moving = solid([square(4.0, 8.0, 0.0, red, 0)]);
        let veil = solid([square(0.0, 12.0, 3.0, grey, 1)]);
        let pixels = draw([16, 16], &moving, &veil, &STYLE);
        assert_eq!(pixels.at(6, 6), mix([200, 0, 0], [100; 3], 0.25));
        assert_eq!(pixels.at(1, 1), mix([255; 3], [100; 3], 0.25));
        assert_eq!(hidden_part([32, 32], &moving, &veil, &STYLE), 1.0);
        assert_eq!(hidden_part([32, 32], &veil, &moving, &STYLE), 0.0);
        // Of 8 by 8 samples, 4 by 4 are behind.
        let beside = solid([square(6.0, 16.0, 3.0, grey, 1)]);
        assert_eq!(hidden_part([32, 32], &moving, &beside, &STYLE), 0.25);
    }

    #[test]
    fn an_edge_is_drawn_where_no_face_is_before_it() {
        let white = Coat::Plain([240; 3]);
        let mut solid = solid([square(0.0, 16.0, 0.0, white, 0), square(8.0, 16.0, 50.0, white, 0)]);
        solid.edges.push(Edge { ends: [[8.0, 20.0, 0.0], [28.0, 20.0, 0.0]], block: 0, weight: 1.0 });
        let pixels = draw([16, 16], &solid, &Solid::default(), &STYLE);
        assert!(pixels.at(6, 10)[0] < 160 && pixels.at(12, 10) == [240; 3]);
        assert_eq!(pixels.at(6, 4), [240; 3]);
    }

    #[test]
    fn a_picture_has_the_same_bits_on_one_and_on_two_threads() {
        let faces: Vec<[Face; 2]> = (0..200u32)
            .map(|i| {
                let from = f64::from(i * 37 % 101) * 0.61;
                let coat = Coat::Scale([0.1, 0.5, 0.9]);
                square(from, from + 17.3, f64::from(i * 53 % 97), coat, i)
            })
            .collect();
        let mut solid = solid(faces);
        solid.edges = solid
            .faces
            .iter()
            .map(|f| Edge { ends: [f.corners[0], f.corners[1]], block: f.block, weight: 0.5 })
            .collect();
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| draw([90, 83], &solid, &Solid::default(), &STYLE))
        };
        assert_eq!(on(1), on(2));
    }
}
