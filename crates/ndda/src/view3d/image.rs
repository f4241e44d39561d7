//! A picture of one moment: blocks as pixels, and beside them title, scale of colours, axes and scale bar.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;

use super::bolt_lines::Bolts;
use super::bolts::BoltColour;
use super::camera::View;
use super::film::{Film, Moment};
use super::overlay::{self, Layout};
use super::paint::{DARK_THEME, LIGHT_THEME, Theme, hex};
use super::raster::Pixels;
use super::stage::{Resting, Setting, Stage};
use crate::picture::svg::Svg;

/// Fewest pixels on a side.
pub const SMALLEST_PX: u32 = 160;
/// Most pixels on a side.
pub const LARGEST_PX: u32 = 16_384;
/// Most pixels of a picture.
pub const MOST_PX: u32 = 64_000_000;
/// Width of edges in a picture of 1200 by 800 [px].
const EDGE_PX: f64 = 1.1;
/// Pixels of blocks on a side of a pixel of an SVG picture, which is often printed; one in very large pictures.
const SVG_FINENESS: usize = 2;
/// Pixels of a picture that count as very large.
const VERY_LARGE: usize = 8_000_000;

/// How a picture looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Where the viewer stands.
    pub view: View,
    /// How blocks at rest are drawn.
    pub resting: Resting,
    /// Whether all blocks are in view, or else those that move and what is around them.
    pub whole: bool,
    /// Displacements are drawn so many times as large.
    pub magnify: f64,
    /// Whether outlines show where blocks began, if few move.
    pub outlines: bool,
    /// What the colours of bolts say.
    pub bolts: BoltColour,
    /// Light on dark.
    pub dark: bool,
    /// Columns and rows [px].
    pub size: (u32, u32),
}

impl Default for Look {
    fn default() -> Self {
        Self {
            view: View::default(),
            resting: Resting::default(),
            whole: false,
            magnify: 1.0,
            outlines: true,
            bolts: BoltColour::default(),
            dark: false,
            size: (1200, 800),
        }
    }
}

/// A film as it is to be drawn.
pub struct Picture<'a> {
    film: &'a Film,
    look: Look,
    layout: Layout,
    theme: Theme,
}

impl<'a> Picture<'a> {
    /// A film with a look.
    pub fn new(film: &'a Film, look: Look) -> Self {
        let layout = Layout::new([look.size.0 as usize, look.size.1 as usize]);
        Self { film, look, layout, theme: if look.dark { DARK_THEME } else { LIGHT_THEME } }
    }

    /// The blocks on their pane, with `fineness` pixels on the side of one of the picture.
    pub fn stage(&self, fineness: usize) -> Stage<'a> {
        let Look { view, resting, whole, magnify, outlines, .. } = self.look;
        let edge_px = EDGE_PX * fineness as f64 * self.layout.unit.max(0.6);
        let setting = Setting { view, resting, whole, magnify, outlines, edge_px };
        Stage::new(self.film, setting, self.theme, self.layout.pane_size().map(|side| fineness * side))
    }

    /// A moment as an SVG picture with the blocks as an image in it.
    ///
    /// # Errors
    /// The image cannot be encoded.
    pub fn svg(&self, moment: &Moment) -> Result<String, String> {
        let [width, height] = self.layout.size;
        let fineness = if width * height > VERY_LARGE { 1 } else { SVG_FINENESS };
        let stage = self.stage(fineness);
        let image = BASE64_STANDARD.encode(png(&stage.pixels(moment))?);
        let mut svg = Svg::new(self.layout.size);
        svg.raw(&format!(
            "<rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>",
            hex(self.theme.background)
        ));
        let pane = self.layout.pane;
        let [columns, rows] = self.layout.pane_size();
        svg.raw(&format!(
            "<image x=\"{}\" y=\"{}\" width=\"{columns}\" height=\"{rows}\" xlink:href=\"data:image/png;base64,{image}\"/>",
            pane.x, pane.y
        ));
        self.surround(&mut svg, &stage, fineness, moment);
        Ok(svg.finish())
    }

    /// A moment as pixels of four bytes: red, green, blue and opaque.
    ///
    /// # Errors
    /// The legend, axes or title cannot be drawn.
    #[cfg(feature = "png")]
    pub fn rgba(&self, stage: &Stage, moment: &Moment) -> Result<Vec<u8>, String> {
        let [width, height] = self.layout.size;
        let [r, g, b] = self.theme.background;
        let mut rgba = [r, g, b, 255].repeat(width * height);
        let pixels = stage.pixels(moment);
        let (left, top) = (self.layout.pane.x as usize, self.layout.pane.y as usize);
        for (y, row) in pixels.rgb.chunks_exact(3 * pixels.width).enumerate().take(height.saturating_sub(top))
        {
            let place = &mut rgba[4 * ((top + y) * width + left)..4 * (top + y + 1) * width];
            for (to, from) in place.chunks_exact_mut(4).zip(row.chunks_exact(3)) {
                to[..3].copy_from_slice(from);
            }
        }
        let mut svg = Svg::new(self.layout.size);
        self.surround(&mut svg, stage, 1, moment);
        crate::picture::draw_over(&svg.finish(), &mut rgba, self.look.size)?;
        Ok(rgba)
    }

    /// Title, scale of colours, axes and scale bar.
    fn surround(&self, svg: &mut Svg, stage: &Stage, fineness: usize, moment: &Moment) {
        let (layout, theme) = (&self.layout, &self.theme);
        let camera = stage.camera.scaled(1.0 / fineness as f64);
        let bolts = Bolts::new(self.film, self.look.bolts);
        bolts.draw(svg, layout, theme, &camera, (moment, self.look.magnify));
        overlay::title(svg, layout, theme, self.film, &self.words(moment));
        overlay::legend(svg, layout, theme, self.film, bolts.are_shown());
        bolts.legend(svg, layout, theme);
        overlay::triad(svg, layout, theme, &camera.axes);
        overlay::scale_bar(svg, layout, theme, &camera);
    }

    /// Time and direction of the viewer.
    fn words(&self, moment: &Moment) -> String {
        let last_s = self.film.moments.last().and_then(|moment| moment.time_s).unwrap_or(0.0);
        let decimals = if last_s > 0.0 { (2.0 - last_s.log10().floor()).clamp(0.0, 9.0) as usize } else { 0 };
        let time = moment.time_s.map_or("before the run".to_string(), |t| format!("t = {t:.decimals$} s"));
        let View { azimuth_deg, elevation_deg } = self.look.view;
        let seen = format!("seen from azimuth {azimuth_deg}°, elevation {elevation_deg}°");
        let magnified = match self.look.magnify {
            1.0 => String::new(),
            factor => format!(" · displacements × {factor}"),
        };
        format!("{time} · {seen}{magnified}")
    }
}

/// Pixels as a PNG file.
fn png(pixels: &Pixels) -> Result<Vec<u8>, String> {
    encode_png([pixels.width, pixels.height], png::ColorType::Rgb, &pixels.rgb)
}

/// Bytes of an opaque picture as a PNG file.
///
/// # Errors
/// The encoder's.
#[cfg(feature = "png")]
pub fn opaque_png(size: (u32, u32), rgba: &[u8]) -> Result<Vec<u8>, String> {
    let rgb: Vec<u8> = rgba.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    encode_png([size.0 as usize, size.1 as usize], png::ColorType::Rgb, &rgb)
}

fn encode_png([width, height]: [usize; 2], colour: png::ColorType, bytes: &[u8]) -> Result<Vec<u8>, String> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width as u32, height as u32);
    encoder.set_color(colour);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().map_err(|e| e.to_string())?;
    writer.write_image_data(bytes).map_err(|e| e.to_string())?;
    writer.finish().map_err(|e| e.to_string())?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view3d::testing::boxes;

    const LOOK: Look = Look {
        view: View { azimuth_deg: 150.0, elevation_deg: 30.0 },
        resting: Resting::Auto,
        whole: false,
        magnify: 1.0,
        outlines: true,
        bolts: BoltColour::Force,
        dark: false,
        size: (320, 240),
    };

    #[test]
    fn the_scale_of_colours_says_the_least_and_the_largest_value_with_their_unit() {
        let film =
            boxes(&[([0.0; 3], [1.0; 3], [0.0, 0.0, 0.012]), ([2.0, 0.0, 0.0], [1.0; 3], [0.034, 0.0, 0.0])]);
        let svg = Picture::new(&film, LOOK).svg(&film.moments[0]).unwrap();
        let words: Vec<&str> = svg.split("<text ").skip(1).map(|t| t.lines().nth(1).unwrap()).collect();
        assert!(["displacement", "[mm]", "12", "34"].iter().all(|word| words.contains(word)), "{words:?}");
        assert!(words[1].starts_with("t = 1.00 s · seen from azimuth 150°, elevation 30°"), "{words:?}");
    }

    #[cfg(feature = "png")]
    #[test]
    fn a_picture_is_the_same_on_one_and_two_threads_and_dark_where_asked() {
        let film =
            boxes(&[([0.0; 3], [1.0; 3], [0.3, 0.0, 0.0]), ([0.0, 0.0, -1.0], [4.0, 1.0, 1.0], [0.0; 3])]);
        let on = |threads: usize, dark: bool| {
            let picture = Picture::new(&film, Look { dark, ..LOOK });
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| picture.rgba(&picture.stage(1), &film.moments[0]).unwrap())
        };
        assert_eq!(on(1, false), on(2, false));
        assert_eq!(on(1, false)[..4], [255; 4]);
        assert_eq!(on(1, true)[..3], DARK_THEME.background);
    }

    #[cfg(feature = "png")]
    #[test]
    fn the_smallest_picture_has_room_for_everything() {
        let film = boxes(&[([0.0; 3], [1.0; 3], [0.3, 0.0, 0.0])]);
        let size = (SMALLEST_PX, SMALLEST_PX);
        let picture = Picture::new(&film, Look { size, ..LOOK });
        assert_eq!(picture.rgba(&picture.stage(1), &film.moments[0]).unwrap().len(), 4 * 160 * 160);
    }
}
