//! Colours of blocks in light and dark pictures.

use ndda_mesh::Vec3;

pub use crate::picture::svg::{Rgb, hex};

/// Matplotlib's viridis at even places, without its darkest ninth, where edges would not be seen; as in the report.
const VIRIDIS: [Rgb; 9] = [
    [0x48, 0x28, 0x78],
    [0x3e, 0x4a, 0x89],
    [0x31, 0x68, 0x8e],
    [0x26, 0x82, 0x8e],
    [0x1f, 0x9e, 0x89],
    [0x35, 0xb7, 0x79],
    [0x6e, 0xce, 0x58],
    [0xb5, 0xde, 0x2b],
    [0xfd, 0xe7, 0x25],
];
/// Light from the upper left of the viewer: right, up and towards the viewer.
const LIGHT: [f64; 3] = [-0.35, 0.55, 0.76];
/// Brightness of a face that no light falls on; the rest goes by the cosine of the angle to the light (Lambert).
const SHADE: f64 = 0.58;

/// Colours of everything but blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Theme {
    /// Where nothing is.
    pub background: Rgb,
    /// Blocks at rest.
    pub resting: Rgb,
    /// Edges.
    pub edge: Rgb,
    /// Text, scale bar.
    pub text: Rgb,
    /// Text of less weight.
    pub faint: Rgb,
}

/// Dark on white, for paper.
pub const LIGHT_THEME: Theme = Theme {
    background: [255, 255, 255],
    resting: [226, 223, 217],
    edge: [38, 38, 42],
    text: [28, 28, 32],
    faint: [104, 104, 112],
};
/// Light on dark, for screens.
pub const DARK_THEME: Theme = Theme {
    background: [20, 23, 28],
    resting: [92, 97, 106],
    edge: [226, 229, 236],
    text: [236, 236, 240],
    faint: [160, 163, 172],
};

/// Colour of a part of the scale, 0 to 1.
pub fn viridis(part: f64) -> Rgb {
    between(&VIRIDIS, part)
}

/// Colour at a part, 0 to 1, of a scale of colours at even places.
pub fn between(scale: &[Rgb], part: f64) -> Rgb {
    let last = scale.len() - 1;
    let place = if part.is_finite() { part.clamp(0.0, 1.0) * last as f64 } else { 0.0 };
    let low = (place.floor() as usize).min(last - 1);
    mix(scale[low], scale[low + 1], place - low as f64)
}

/// Colour of a group, a block or a material: neighbours in number are far apart in hue.
pub fn group_colour(index: u32) -> Rgb {
    let index = f64::from(index);
    let hue = (200.0 + index * 137.508) % 360.0;
    let (saturation, lightness) = (0.46, 0.6 + 0.08 * ((index * 7.0) % 3.0 - 1.0));
    let a: f64 = saturation * f64::min(lightness, 1.0 - lightness);
    [0.0, 8.0, 4.0].map(|n| {
        let k = (n + hue / 30.0) % 12.0;
        (255.0 * (lightness - a * (k - 3.0).min(9.0 - k).clamp(-1.0, 1.0))).round() as u8
    })
}

/// Brightness of a face by its normal in the axes of the picture.
pub fn brightness(normal: &Vec3) -> f64 {
    let light = Vec3::from(LIGHT);
    SHADE + (1.0 - SHADE) * (normal.dot(&light) / light.norm()).max(0.0)
}

/// A colour at a brightness.
pub fn lit(colour: Rgb, brightness: f64) -> Rgb {
    colour.map(|c| (f64::from(c) * brightness).round() as u8)
}

/// From one colour to another, `part` of the way.
pub fn mix(from: Rgb, to: Rgb, part: f64) -> Rgb {
    let between = |i: usize| f64::from(from[i]) + part * (f64::from(to[i]) - f64::from(from[i]));
    [0, 1, 2].map(|i| between(i).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_has_its_first_colour_at_zero_and_its_last_at_one() {
        assert_eq!((viridis(0.0), viridis(1.0)), (VIRIDIS[0], VIRIDIS[8]));
        assert_eq!((viridis(-1.0), viridis(2.0), viridis(f64::NAN)), (VIRIDIS[0], VIRIDIS[8], VIRIDIS[0]));
        assert_eq!(viridis(0.5), VIRIDIS[4]);
    }

    #[test]
    fn a_face_across_the_light_is_brightest_and_one_turned_away_darkest() {
        let light = Vec3::from(LIGHT).normalize();
        assert!((brightness(&light) - 1.0).abs() < 1e-12);
        assert_eq!(brightness(&-light), SHADE);
        assert_eq!(lit([200, 100, 0], 0.5), [100, 50, 0]);
    }

    #[test]
    fn groups_next_to_each_other_in_number_differ() {
        for i in 0..50 {
            let (a, b) = (group_colour(i), group_colour(i + 1));
            let apart: i32 = (0..3).map(|c| (i32::from(a[c]) - i32::from(b[c])).abs()).sum();
            assert!(apart > 60, "{a:?} {b:?}");
        }
    }
}
