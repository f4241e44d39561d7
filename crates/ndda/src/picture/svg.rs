//! Pictures as SVG without axes: lines, discs and words.

use std::fmt::Write as _;

/// Red, green and blue.
pub type Rgb = [u8; 3];

/// A colour as SVG writes it.
pub fn hex([r, g, b]: Rgb) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Where text stands relative to its place.
#[derive(Clone, Copy)]
pub enum Anchor {
    /// To the right of it.
    Start,
    /// In the middle of it.
    Middle,
    /// To the left of it.
    End,
}

/// An SVG picture that grows.
pub struct Svg {
    text: String,
}

impl Svg {
    /// An empty picture of so many pixels.
    pub fn new([width, height]: [usize; 2]) -> Self {
        let text = format!(
            "<svg width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\">\n"
        );
        Self { text }
    }

    /// The picture as a file.
    pub fn finish(self) -> String {
        self.text + "</svg>\n"
    }

    /// Adds an element as it is written.
    pub fn raw(&mut self, element: &str) {
        self.text.push_str(element);
        self.text.push('\n');
    }

    /// A straight line.
    pub fn line(&mut self, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2], width: f64, colour: Rgb) {
        let _ = writeln!(
            self.text,
            "<line x1=\"{x1:.2}\" y1=\"{y1:.2}\" x2=\"{x2:.2}\" y2=\"{y2:.2}\" stroke=\"{}\" stroke-width=\"{width:.2}\"/>",
            hex(colour)
        );
    }

    /// A rectangle by its upper left corner and its size.
    pub fn rect(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], colour: Rgb) {
        let _ = writeln!(
            self.text,
            "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{width:.2}\" height=\"{height:.2}\" fill=\"{}\"/>",
            hex(colour)
        );
    }

    /// A filled polygon.
    pub fn polygon(&mut self, points: &[[f64; 2]], colour: Rgb) {
        let points: Vec<String> = points.iter().map(|[x, y]| format!("{x:.2},{y:.2}")).collect();
        let _ = writeln!(self.text, "<polygon points=\"{}\" fill=\"{}\"/>", points.join(" "), hex(colour));
    }

    /// A disc.
    pub fn circle(&mut self, [x, y]: [f64; 2], radius: f64, colour: Rgb) {
        let colour = hex(colour);
        self.raw(&format!("<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius:.2}\" fill=\"{colour}\"/>"));
    }

    /// The rim of a disc; `dashes` is empty, or the lengths of strokes and gaps.
    pub fn ring(&mut self, [x, y]: [f64; 2], radius: f64, width: f64, colour: Rgb, dashes: &str) {
        let colour = hex(colour);
        self.raw(&format!(
            "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius:.2}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width:.2}\" stroke-dasharray=\"{dashes}\"/>"
        ));
    }

    /// A line through several points.
    pub fn polyline(&mut self, points: &[[f64; 2]], width: f64, colour: Rgb) {
        let points: Vec<String> = points.iter().map(|[x, y]| format!("{x:.2},{y:.2}")).collect();
        self.raw(&format!(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width:.2}\"/>",
            points.join(" "),
            hex(colour)
        ));
    }

    /// Text whose middle line is at a height; cut where it is wider than `room`.
    pub fn words(
        &mut self,
        [x, y]: [f64; 2],
        size: f64,
        anchor: Anchor,
        colour: Rgb,
        room: f64,
        words: &str,
    ) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let _ = writeln!(
            self.text,
            "<text x=\"{x:.2}\" y=\"{y:.2}\" dy=\"0.36em\" text-anchor=\"{anchor}\" font-family=\"DejaVu Sans, sans-serif\" font-size=\"{size:.2}\" fill=\"{}\">\n{}\n</text>",
            hex(colour),
            escaped(&shortened(words, (room / (0.56 * size)) as usize))
        );
    }
}

/// At most so many letters.
fn shortened(words: &str, most: usize) -> String {
    if words.chars().count() <= most {
        return words.to_string();
    }
    words.chars().take(most.saturating_sub(1)).chain(['…']).collect()
}

/// Text that is no markup; letters that XML does not have are left out.
fn escaped(words: &str) -> String {
    let kept: String = words.chars().filter(|c| !c.is_control()).collect();
    kept.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_a_scene_are_no_markup() {
        let mut svg = Svg::new([100, 100]);
        svg.words([0.0, 0.0], 10.0, Anchor::Start, [0; 3], 1e3, "</text><script>&\"\u{1}");
        let text = svg.finish();
        assert!(text.contains("&lt;/text&gt;&lt;script&gt;&amp;&quot;\n") && !text.contains("<script"));
        assert_eq!(shortened("abcdef", 4), "abc…");
    }
}
