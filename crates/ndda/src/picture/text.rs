//! Text of an SVG picture as outlines of its letters: what renders them needs no fonts and breaks no lines.

use std::fmt::Write;

use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// The picture with each `<text>` that plotters wrote replaced by the outlines of its letters.
///
/// # Errors
/// The font cannot be read, or a text has not the attributes that plotters gives it.
pub fn outlined(svg: &str, font: &[u8]) -> Result<String, String> {
    let face = Face::parse(font, 0).map_err(|error| format!("the font: {error}"))?;
    let mut out = String::with_capacity(2 * svg.len());
    let mut rest = svg;
    while let Some((before, text)) = rest.split_once("<text ") {
        let (attributes, text) = text.split_once('>').ok_or("a text that does not begin")?;
        let (content, after) = text.split_once("</text>").ok_or("a text that does not end")?;
        out.push_str(before);
        draw(&mut out, &face, attributes, &unescaped(content.trim()))?;
        rest = after;
    }
    out.push_str(rest);
    Ok(out)
}

/// One text: letters side by side, from where its anchor says.
fn draw(out: &mut String, face: &Face, attributes: &str, content: &str) -> Result<(), String> {
    let value = |name: &str| attribute(attributes, name).ok_or(format!("a text without {name}"));
    let number =
        |name: &str| value(name)?.parse::<f64>().map_err(|_| format!("{name} of a text is not a number"));
    let (x, y, size) = (number("x")?, number("y")?, number("font-size")?);
    let scale = size / f64::from(face.units_per_em());
    let (letters, width) = placed(face, content);
    let start = match value("text-anchor")? {
        "middle" => x - 0.5 * width * scale,
        "end" => x - width * scale,
        _ => x,
    };
    let base = y + shift(value("dy")?, size)?;
    let look: String = ["transform", "fill", "opacity"]
        .into_iter()
        .filter_map(|name| attribute(attributes, name).map(|value| format!(" {name}=\"{value}\"")))
        .collect();
    // Fonts count upwards, pictures downwards.
    let _ = write!(out, "<g{look}><g transform=\"matrix({scale} 0 0 {} {start} {base})\">", -scale);
    for (glyph, at) in letters {
        let mut outline = Outline { path: String::new() };
        if face.outline_glyph(glyph, &mut outline).is_some() {
            let _ = write!(out, "<path transform=\"translate({at} 0)\" d=\"{}\"/>", outline.path);
        }
    }
    out.push_str("</g></g>");
    Ok(())
}

/// Letters with their places, and the width of all, in units of the font; letters it lacks are its empty box.
fn placed(face: &Face, content: &str) -> (Vec<(GlyphId, f64)>, f64) {
    let (mut letters, mut at) = (Vec::new(), 0.0);
    for letter in content.chars() {
        let glyph = face.glyph_index(letter).unwrap_or(GlyphId(0));
        if let Some(&(before, _)) = letters.last() {
            at += kerning(face, before, glyph);
        }
        letters.push((glyph, at));
        at += f64::from(face.glyph_hor_advance(glyph).unwrap_or(0));
    }
    (letters, at)
}

/// How much closer two letters stand than their widths say, below zero.
fn kerning(face: &Face, left: GlyphId, right: GlyphId) -> f64 {
    let tables = face.tables().kern.into_iter().flat_map(|kern| kern.subtables);
    let mut kernings = tables.filter(|table| table.horizontal && !table.variable);
    kernings.find_map(|table| table.glyphs_kerning(left, right)).map_or(0.0, f64::from)
}

/// A length in `em`, or in `ex`, of which an em has two.
fn shift(length: &str, size: f64) -> Result<f64, String> {
    let wrong = || format!("a text is shifted by {length}");
    let (number, unit) = match (length.strip_suffix("em"), length.strip_suffix("ex")) {
        (Some(number), _) => (number, size),
        (_, Some(number)) => (number, 0.5 * size),
        _ => return Err(wrong()),
    };
    number.parse::<f64>().map(|number| number * unit).map_err(|_| wrong())
}

fn attribute<'a>(attributes: &'a str, name: &str) -> Option<&'a str> {
    let begin = format!("{name}=\"");
    let found = attributes.match_indices(&begin).find(|(at, _)| *at == 0 || attributes[..*at].ends_with(' '));
    let rest = &attributes[found?.0 + begin.len()..];
    rest.split_once('"').map(|(value, _)| value)
}

fn unescaped(text: &str) -> String {
    let entities = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&apos;", "'"), ("&amp;", "&")];
    entities.iter().fold(text.to_string(), |text, (entity, letter)| text.replace(entity, letter))
}

struct Outline {
    path: String,
}

impl OutlineBuilder for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        let _ = write!(self.path, "M{x} {y}");
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let _ = write!(self.path, "L{x} {y}");
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let _ = write!(self.path, "Q{x1} {y1} {x} {y}");
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let _ = write!(self.path, "C{x1} {y1} {x2} {y2} {x} {y}");
    }

    fn close(&mut self) {
        self.path.push('Z');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(attributes: &str, content: &str) -> String {
        let svg = format!("<svg>\n<text {attributes}>\n{content}\n</text>\n<rect/></svg>");
        outlined(&svg, dejavu::sans::regular()).unwrap()
    }

    #[test]
    fn text_becomes_a_path_per_letter_where_its_anchor_says() {
        let at = |anchor: &str, content: &str| {
            let look = format!(
                "x=\"50\" y=\"20\" dy=\"0.5ex\" text-anchor=\"{anchor}\" font-size=\"10\" fill=\"#000\""
            );
            let svg = written(&look, content);
            let matrix = svg.split_once("matrix(").unwrap().1.split_once(')').unwrap().0.to_string();
            let places: Vec<f64> = matrix.split(' ').map(|number| number.parse().unwrap()).collect();
            (places[4], places[5], svg.matches("<path").count())
        };
        let (start, middle, end) = (at("start", "mm"), at("middle", "mm"), at("end", "mm"));
        assert_eq!((start.0, start.1, start.2), (50.0, 22.5, 2));
        // An m of DejaVu Sans is 1995 of 2048 wide.
        let width = 2.0 * 10.0 * 1995.0 / 2048.0;
        assert!((middle.0 - (50.0 - 0.5 * width)).abs() < 1e-12 && (end.0 - (50.0 - width)).abs() < 1e-12);
        assert_eq!(at("start", "a &lt; b").2, 3);
    }

    #[test]
    fn turned_text_stays_turned_and_what_is_no_text_stays() {
        let look = "x=\"1\" y=\"2\" dy=\"0.76em\" text-anchor=\"start\" font-size=\"8\" transform=\"rotate(270, 1, 2)\"";
        let svg = written(look, "E [J]");
        assert!(
            svg.contains("<g transform=\"rotate(270, 1, 2)\">") && svg.ends_with("<rect/></svg>"),
            "{svg}"
        );
        assert!(!svg.contains("<text"));
    }

    #[test]
    fn text_without_a_size_is_an_error() {
        let error = outlined("<text x=\"1\" y=\"2\">a</text>", dejavu::sans::regular()).unwrap_err();
        assert_eq!(error, "a text without font-size");
    }
}
