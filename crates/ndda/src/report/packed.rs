//! Numbers as bytes that a page can hold: 16 bits each, differences from frame to frame, deflated, base 64.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use serde::Serialize;

/// Highest code of 16 bits.
const TOP: f32 = 65535.0;
/// Effort of compression, 0 to 10; more takes long and saves little.
const LEVEL: u8 = 7;

/// Arrays one after the other.
#[derive(Default)]
pub struct Packed {
    bytes: Vec<u8>,
    /// Name and place of each.
    pub arrays: Vec<PackedArray>,
}

/// Where an array is.
#[derive(Debug, Serialize)]
pub struct PackedArray {
    name: String,
    offset: usize,
    length: usize,
}

/// Values of equal number in every frame, as codes of 16 bits from the least to the largest.
#[derive(Clone, Debug, PartialEq)]
pub struct Codes {
    /// The value of code 0.
    pub least: f32,
    /// The value of the highest code.
    pub largest: f32,
    /// Codes per frame.
    pub frames: Vec<Vec<u16>>,
}

impl Codes {
    /// The codes of values; what is not a number has code 0.
    pub fn new(frames: &[Vec<f32>]) -> Self {
        let finite = || frames.iter().flatten().copied().filter(|value| value.is_finite());
        let (least, largest) =
            (finite().fold(f32::INFINITY, f32::min), finite().fold(f32::NEG_INFINITY, f32::max));
        if least >= largest || !(largest - least).is_finite() {
            let least = if least.is_finite() { least } else { 0.0 };
            let frames = frames.iter().map(|values| vec![0; values.len()]).collect();
            return Self { least, largest: least, frames };
        }
        let scale = TOP / (largest - least);
        let code = |value: &f32| ((value - least) * scale).round() as u16;
        Self {
            least,
            largest,
            frames: frames.iter().map(|values| values.iter().map(code).collect()).collect(),
        }
    }

    /// The value that this part of all values are not above.
    pub fn quantile(&self, part: f64) -> f32 {
        let mut counts = vec![0usize; usize::from(u16::MAX) + 1];
        self.frames.iter().flatten().for_each(|&code| counts[usize::from(code)] += 1);
        let enough = (part * counts.iter().sum::<usize>() as f64).ceil() as usize;
        let mut sum = 0;
        let reached = |count: &usize| {
            sum += count;
            sum >= enough
        };
        let code = counts.iter().position(reached).unwrap_or(0);
        self.least + (self.largest - self.least) * code as f32 / TOP
    }
}

impl Packed {
    /// Adds whole numbers.
    pub fn add_u32(&mut self, name: &str, values: impl IntoIterator<Item = u32>) {
        self.add(name, values.into_iter().flat_map(u32::to_le_bytes));
    }

    /// Adds numbers.
    pub fn add_f32(&mut self, name: &str, values: impl IntoIterator<Item = f32>) {
        self.add(name, values.into_iter().flat_map(f32::to_le_bytes));
    }

    /// Adds codes as differences from the frame before: first all low bytes, then all high ones, which deflate better.
    pub fn add_codes(&mut self, name: &str, codes: &Codes) {
        let mut before = vec![0; codes.frames.first().map_or(0, Vec::len)];
        let mut differences = Vec::with_capacity(before.len() * codes.frames.len());
        for frame in &codes.frames {
            differences.extend(
                frame.iter().zip(&before).map(|(now, before): (&u16, &u16)| now.wrapping_sub(*before)),
            );
            before.clone_from(frame);
        }
        let low = differences.iter().map(|d| d.to_le_bytes()[0]);
        self.add(name, low.chain(differences.iter().map(|d| d.to_le_bytes()[1])));
    }

    fn add(&mut self, name: &str, bytes: impl Iterator<Item = u8>) {
        // Typed arrays of a page begin at multiples of their size.
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let offset = self.bytes.len();
        self.bytes.extend(bytes);
        self.arrays.push(PackedArray { name: name.into(), offset, length: self.bytes.len() - offset });
    }

    /// All of it as a text.
    pub fn text(&self) -> String {
        BASE64_STANDARD.encode(miniz_oxide::deflate::compress_to_vec_zlib(&self.bytes, LEVEL))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Unpacks as the page does.
    fn unpacked(packed: &Packed) -> Vec<u8> {
        let deflated = BASE64_STANDARD.decode(packed.text()).unwrap();
        miniz_oxide::inflate::decompress_to_vec_zlib(&deflated).unwrap()
    }

    #[test]
    fn codes_come_back_to_within_half_a_step() {
        let frames: Vec<Vec<f32>> =
            (0..5u8).map(|f| (0..7u8).map(|i| f32::from(f) * 0.3 - f32::from(i * i)).collect()).collect();
        let codes = Codes::new(&frames);
        let mut packed = Packed::default();
        packed.add_u32("first", [7]);
        packed.add_codes("codes", &codes);
        let bytes = unpacked(&packed);
        let place = &packed.arrays[1];
        let (low, high) = bytes[place.offset..place.offset + place.length].split_at(place.length / 2);
        let step = (codes.largest - codes.least) / TOP;
        let mut sum = [0u16; 7];
        for (f, frame) in frames.iter().enumerate() {
            for (i, value) in frame.iter().enumerate() {
                let difference = u16::from_le_bytes([low[7 * f + i], high[7 * f + i]]);
                sum[i] = sum[i].wrapping_add(difference);
                let back = codes.least + step * f32::from(sum[i]);
                assert!((back - value).abs() <= 0.51 * step, "{back} for {value}");
            }
        }
    }

    #[test]
    fn equal_values_and_what_is_no_number_have_code_zero() {
        assert_eq!(
            Codes::new(&[vec![2.0, 2.0]]),
            Codes { least: 2.0, largest: 2.0, frames: vec![vec![0, 0]] }
        );
        let codes = Codes::new(&[vec![f32::NAN, 1.0, 3.0]]);
        assert_eq!((codes.least, codes.largest, &codes.frames[0]), (1.0, 3.0, &vec![0, 0, u16::MAX]));
        assert_eq!(Codes::new(&[vec![]]).least, 0.0);
    }

    #[test]
    fn a_quantile_leaves_the_rest_above() {
        let values: Vec<f32> = (0..1000u16).map(f32::from).collect();
        let found = Codes::new(&[values]).quantile(0.9);
        assert!((found - 899.0).abs() < 0.1, "{found}");
    }
}
