//! Axes: places of numbers in a picture, round marks and their labels.

use super::{FAINT, GREY, INK};
use crate::picture::short;
use crate::picture::svg::{Anchor, Rgb, Svg, hex};

/// Size of numbers at axes [px].
const NUMBER: f64 = 12.0;

/// A rectangle of a picture in which numbers have places.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axes {
    /// Upper left corner [px].
    pub at: [f64; 2],
    /// Width and height [px].
    pub size: [f64; 2],
    /// Numbers at the left and right end.
    pub x: [f64; 2],
    /// Numbers at the lower and upper end.
    pub y: [f64; 2],
}

impl Axes {
    /// Place of numbers [px].
    pub(super) fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let part = [(x - self.x[0]) / (self.x[1] - self.x[0]), (y - self.y[0]) / (self.y[1] - self.y[0])];
        [self.at[0] + part[0] * self.size[0], self.at[1] + (1.0 - part[1]) * self.size[1]]
    }

    /// Lines at round numbers, with those along y at the left, and those along x below if asked for.
    pub(super) fn grid(&self, svg: &mut Svg, numbers_below: bool) {
        let [left, top] = self.at;
        let [right, bottom] = [left + self.size[0], top + self.size[1]];
        for mark in marks(self.x, self.size[0] / 90.0) {
            let [x, _] = self.place([mark, self.y[0]]);
            svg.line([x, top], [x, bottom], 1.0, FAINT);
            if numbers_below {
                svg.words([x, bottom + 13.0], NUMBER, Anchor::Middle, INK, 80.0, &short(mark));
            }
        }
        for mark in marks(self.y, self.size[1] / 38.0) {
            let [_, y] = self.place([self.x[0], mark]);
            svg.line([left, y], [right, y], 1.0, FAINT);
            svg.words([left - 7.0, y], NUMBER, Anchor::End, INK, 80.0, &short(mark));
        }
    }

    /// The frame.
    pub(super) fn frame(&self, svg: &mut Svg) {
        let ([x, y], [width, height]) = (self.at, self.size);
        svg.raw(&format!(
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1\"/>",
            hex(INK)
        ));
    }

    /// The name of what is above the frame, at its left end.
    pub(super) fn name(&self, svg: &mut Svg, name: &str) {
        svg.words([self.at[0], self.at[1] - 11.0], 13.0, Anchor::Start, INK, self.size[0], name);
    }

    /// The name of what is along x, below its numbers.
    pub(super) fn name_below(&self, svg: &mut Svg, name: &str) {
        let at = [self.at[0] + 0.5 * self.size[0], self.at[1] + self.size[1] + 32.0];
        svg.words(at, 13.0, Anchor::Middle, GREY, self.size[0], name);
    }

    /// A line through points, cut off at the frame by being drawn inside of it.
    pub(super) fn curve(&self, svg: &mut Svg, points: &[[f64; 2]], width: f64, colour: Rgb) {
        let placed: Vec<[f64; 2]> = points.iter().map(|point| self.place(*point)).collect();
        svg.polyline(&placed, width, colour);
    }
}

/// Round numbers between two ends, about as many as asked for.
pub(super) fn marks([from, to]: [f64; 2], about: f64) -> Vec<f64> {
    let rough = (to - from) / about.max(1.0);
    if !(rough > 0.0 && rough.is_finite()) {
        return Vec::new();
    }
    let ten = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|f| f * ten).into_iter().find(|step| *step >= rough);
    let step = step.unwrap_or(10.0 * ten);
    let first = (from / step - 1e-9).ceil() as i64;
    let last = (to / step + 1e-9).floor() as i64;
    // A multiple of the step has its digits, unlike a sum of steps.
    (first..=last).map(|k| k as f64 * step).map(|mark| (mark / step).round() * step).collect()
}

/// Ends of an axis from zero to values, a little wider.
pub(super) fn from_zero(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let most = values.filter(|v| v.is_finite()).fold(0.0, f64::max);
    [0.0, if most > 0.0 { 1.06 * most } else { 1.0 }]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_round_and_within_the_ends() {
        assert_eq!(marks([0.0, 10.0], 5.0), [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
        assert_eq!(marks([-0.3, 0.3], 3.0), [-0.2, 0.0, 0.2]);
        assert!(marks([1.0, 1.0], 3.0).is_empty());
    }
}
