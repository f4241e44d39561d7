//! Pictures: drawn once as SVG; a PNG is that SVG rendered with a font that the program brings.

pub mod svg;
#[cfg(feature = "png")]
mod text;

use std::ops::Range;
use std::path::Path;

use ndda_io::{WriteError, atomic};
use plotters::coord::Shift;
use plotters::coord::combinators::{BindKeyPoints, IntoLogRange, LogCoord, WithKeyPoints};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
#[cfg(feature = "png")]
use resvg::{tiny_skia, usvg};

/// Where things are drawn.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// Whether something could be drawn.
pub type Drawn = Result<(), Box<dyn std::error::Error>>;

/// Pixels of a PNG per pixel of the SVG.
#[cfg(feature = "png")]
const PNG_SCALE: f32 = 2.0;

/// Endings of the files that every picture of a study is written to.
pub const ENDINGS: &[&str] = if cfg!(feature = "png") { &["svg", "png"] } else { &["svg"] };

/// Height of a line of a key [px].
const KEY_LINE: i32 = 22;

/// Most marks of a logarithmic axis.
const MOST_MARKS: usize = 8;

/// Colours that differ in print and for the colour-blind (Okabe and Ito; the last two are Tol's).
const COLOURS: [RGBColor; 9] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(90, 90, 90),
    RGBColor(136, 34, 85),
    RGBColor(153, 153, 51),
];

/// Colour of the i-th series.
pub fn colour(i: usize) -> RGBColor {
    COLOURS[i % COLOURS.len()]
}

/// Draws a picture and writes it to `path`, as PNG if that is its ending.
///
/// # Errors
/// [`WriteError::Encode`] when it cannot be drawn; [`WriteError::Io`] when it cannot be written.
pub fn write(path: &Path, size: (u32, u32), draw: impl FnOnce(&Area) -> Drawn) -> Result<(), WriteError> {
    let encode = |reason: String| WriteError::Encode { path: path.to_path_buf(), reason };
    write_svg(path, svg(size, draw).map_err(|e| encode(e.to_string()))?)
}

/// Writes an SVG picture to `path`, as PNG if that is its ending.
///
/// # Errors
/// As [`write`].
pub fn write_svg(path: &Path, svg: String) -> Result<(), WriteError> {
    let encode = |reason: String| WriteError::Encode { path: path.to_path_buf(), reason };
    let bytes = match path.extension().and_then(|ending| ending.to_str()) {
        Some("svg") => svg.into_bytes(),
        Some("png") => png(&svg).map_err(encode)?,
        _ => return Err(WriteError::PictureEnding { path: path.to_path_buf() }),
    };
    atomic::write_named(path, &bytes)
}

fn svg(size: (u32, u32), draw: impl FnOnce(&Area) -> Drawn) -> Result<String, Box<dyn std::error::Error>> {
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
        root.fill(&WHITE)?;
        draw(&root)?;
        root.present()?;
    }
    Ok(text)
}

#[cfg(feature = "png")]
fn png(svg: &str) -> Result<Vec<u8>, String> {
    let tree = tree(svg)?;
    let size = tree.size().to_int_size().scale_by(PNG_SCALE).ok_or("the picture has no size")?;
    let mut pixels = tiny_skia::Pixmap::new(size.width(), size.height()).ok_or("the picture is too large")?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(PNG_SCALE, PNG_SCALE), &mut pixels.as_mut());
    pixels.encode_png().map_err(|e| e.to_string())
}

/// Draws an SVG picture over opaque pixels of four bytes, red, green, blue and 255.
///
/// # Errors
/// It is no SVG picture, or the pixels are not as many as the size says.
#[cfg(feature = "png")]
pub fn draw_over(svg: &str, rgba: &mut [u8], (width, height): (u32, u32)) -> Result<(), String> {
    let tree = tree(svg)?;
    let mut pixels =
        tiny_skia::PixmapMut::from_bytes(rgba, width, height).ok_or("the pixels do not have this size")?;
    resvg::render(&tree, tiny_skia::Transform::identity(), &mut pixels);
    Ok(())
}

/// A picture with text as outlines, ready to be rendered.
#[cfg(feature = "png")]
fn tree(svg: &str) -> Result<usvg::Tree, String> {
    let outlines = text::outlined(svg, dejavu::sans::regular())?;
    usvg::Tree::from_str(&outlines, &usvg::Options::default()).map_err(|e| e.to_string())
}

#[cfg(not(feature = "png"))]
fn png(_: &str) -> Result<Vec<u8>, String> {
    Err("this program was built without the feature `png`: choose .svg".into())
}

/// Draws the legend of the colours, one below the other; `width` is that of the line in the picture [px].
///
/// # Errors
/// It cannot be drawn.
pub fn key(area: &Area, entries: &[(String, RGBColor, u32)]) -> Drawn {
    let font = TextStyle::from(("sans-serif", 14).into_font()).pos(Pos::new(HPos::Left, VPos::Center));
    for (i, (name, colour, width)) in entries.iter().enumerate() {
        let y = 24 + KEY_LINE * i as i32;
        area.draw(&PathElement::new([(4, y), (26, y)], colour.stroke_width(*width)))?;
        area.draw(&Text::new(name.as_str(), (36, y), font.clone()))?;
    }
    Ok(())
}

/// A number on an axis, to six digits: `0.02` or `3e-5`.
pub fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    if rounded == 0.0 || (1e-2..1e5).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// Ends of a logarithmic axis around values above zero, a little wider; a decade where there are none.
pub fn log_range(values: impl Iterator<Item = f64>) -> Range<f64> {
    let used = values.filter(|v| *v > 0.0 && v.is_finite());
    let (least, most) = used.fold((f64::INFINITY, 0.0f64), |(a, b), v| (a.min(v), b.max(v)));
    if least > most {
        return 0.1..1.0;
    }
    let room = (most / least).powf(0.06).max(1.3);
    least / room..most * room
}

/// A logarithmic axis with marks at powers of ten, and at two and five times those where they are few.
pub fn log_axis(ends: Range<f64>) -> WithKeyPoints<LogCoord<f64>> {
    let marks = log_marks(&ends);
    ends.log_scale().with_key_points(marks)
}

/// A logarithmic axis of whole numbers with marks at the values themselves.
pub fn count_axis(ends: Range<f64>, mut values: Vec<f64>) -> WithKeyPoints<LogCoord<f64>> {
    values.sort_by(f64::total_cmp);
    values.dedup();
    let step = values.len().div_ceil(MOST_MARKS).max(1);
    ends.log_scale().with_key_points(values.into_iter().step_by(step).collect())
}

fn log_marks(ends: &Range<f64>) -> Vec<f64> {
    let decades = (ends.start.log10().floor() as i32..=ends.end.log10().ceil() as i32).collect::<Vec<_>>();
    let at = |factors: &[f64]| -> Vec<f64> {
        let all = decades.iter().flat_map(|k| factors.iter().map(move |f| f * 10f64.powi(*k)));
        all.filter(|mark| ends.contains(mark)).collect()
    };
    let [powers, halves, all] =
        [at(&[1.0]), at(&[1.0, 2.0, 5.0]), at(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0])];
    if powers.len() > 3 {
        powers.iter().copied().step_by(powers.len().div_ceil(MOST_MARKS)).collect()
    } else if halves.len() > 1 {
        halves
    } else {
        all
    }
}

/// Ends of an axis around values, a little wider.
pub fn range(values: impl Iterator<Item = f64>) -> Range<f64> {
    let used = values.filter(|v| v.is_finite());
    let (least, most) = used.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    if least > most {
        return 0.0..1.0;
    }
    let room = match (most > least, least == 0.0) {
        (true, _) => 0.04 * (most - least),
        (false, false) => least.abs(),
        (false, true) => 1.0,
    };
    least - room..most + room
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_hold_their_values_and_are_never_empty() {
        for values in [vec![1.0, 5.0], vec![2.0], vec![], vec![0.0, 0.0], vec![f64::NAN, 1e-9]] {
            let (log, plain) = (log_range(values.iter().copied()), range(values.iter().copied()));
            assert!(0.0 < log.start && log.start < log.end && plain.start < plain.end, "{values:?}");
            for value in values.iter().filter(|v| v.is_finite()) {
                assert!(plain.contains(value) && (*value == 0.0 || log.contains(value)), "{value}");
            }
        }
    }

    #[test]
    fn logarithmic_axes_have_a_few_round_marks() {
        assert_eq!(
            log_marks(&(0.03..3.0)).iter().copied().map(short).collect::<Vec<_>>().join(" "),
            "0.05 0.1 0.2 0.5 1 2"
        );
        assert_eq!(log_marks(&(2e-9..3e-4)).len(), 5);
        assert_eq!(log_marks(&(332.0..561.0)), [400.0, 500.0]);
        assert!(log_marks(&(1e-17..1e3)).len() <= MOST_MARKS);
    }

    #[test]
    fn numbers_on_axes_are_short() {
        assert_eq!([0.1 + 0.2, 1e-5, -20.0, 1.5e5, 0.0].map(short), ["0.3", "1e-5", "-20", "1.5e5", "0"]);
    }

    #[test]
    fn a_picture_is_what_its_ending_says() {
        let folder = tempfile::tempdir().unwrap();
        let draw = |root: &Area| -> Drawn { Ok(root.titled("title", ("sans-serif", 20)).map(drop)?) };
        let written = |name: &str| {
            let path = folder.path().join(name);
            write(&path, (200, 100), draw).map(|()| std::fs::read(path).unwrap())
        };
        assert!(written("a.svg").unwrap().starts_with(b"<svg"));
        assert!(written("a.gif").unwrap_err().to_string().contains(".svg or .png"));
        if cfg!(feature = "png") {
            let png = written("a.png").unwrap();
            let size = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
            assert!(png.starts_with(b"\x89PNG"));
            assert_eq!((size(16), size(20)), (400, 200));
        }
    }
}
