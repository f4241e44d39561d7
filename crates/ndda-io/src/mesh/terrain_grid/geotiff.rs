//! Heights in GeoTIFF files: one band of numbers in strips or tiles, plain or compressed by Deflate or LZW, north up in metres.

mod bytes;
mod pixels;
mod units;

use super::{MOST_HEIGHTS, NO_DATA, TerrainGrid};
use crate::mesh::error::{Fault, FileProblem};
use bytes::{Entry, Ifd};

/// Numbers of the tags that are read (TIFF 6.0, GeoTIFF 1.1, GDAL).
const WIDTH: u16 = 256;
const HEIGHT: u16 = 257;
const BITS: u16 = 258;
const COMPRESSION: u16 = 259;
const STRIP_OFFSETS: u16 = 273;
const SAMPLES: u16 = 277;
const ROWS_PER_STRIP: u16 = 278;
const STRIP_BYTES: u16 = 279;
const PREDICTOR: u16 = 317;
const TILE_WIDTH: u16 = 322;
const TILE_HEIGHT: u16 = 323;
const TILE_OFFSETS: u16 = 324;
const TILE_BYTES: u16 = 325;
const FORMAT: u16 = 339;
const PIXEL_SCALE: u16 = 33550;
const TIE_POINT: u16 = 33922;
const TRANSFORMATION: u16 = 34264;
const GEO_KEYS: u16 = 34735;
const GDAL_METADATA: u16 = 42112;
const GDAL_NO_DATA: u16 = 42113;

/// Key of GeoTIFF: what a pixel is.
const RASTER_TYPE: u64 = 1025;
const PIXEL_IS_POINT: u64 = 2;

/// Reads the first image of a file.
pub(super) fn read(bytes: &[u8]) -> Result<TerrainGrid, Fault> {
    let ifd = Ifd::read(bytes)?;
    let keys = ifd.get(GEO_KEYS).map(Entry::whole_numbers).transpose()?.unwrap_or_default();
    let key =
        |id: u64| keys.get(4..)?.chunks_exact(4).find(|key| key[0] == id && key[1] == 0).map(|key| key[3]);
    let metadata = ifd.get(GDAL_METADATA).map(Entry::text).transpose()?;
    units::are_metres(&key, metadata.as_deref())?;
    let size = [ifd.number(WIDTH)?, ifd.number(HEIGHT)?];
    if size.iter().any(|n| *n < 2) || size[0].saturating_mul(size[1]) > MOST_HEIGHTS {
        let what = format!("a grid of {} × {} heights", size[0], size[1]);
        return Err(not_read(
            what,
            "give at least 2 × 2 and at most 16 777 216: resample it, or cut out the part you need",
        ));
    }
    let (origin_m, step_m) = place(&ifd, size, key(RASTER_TYPE) == Some(PIXEL_IS_POINT))?;
    let no_data = ifd.get(GDAL_NO_DATA).map(Entry::text).transpose()?;
    let no_data = no_data.and_then(|text| text.trim().parse::<f64>().ok()).unwrap_or(NO_DATA);
    let numbers = pixels::read(&ifd, size.map(|n| n as usize))?;
    // GDAL writes what is missing as a number of the file's own precision.
    let is_missing = |z: f64| !z.is_finite() || z == no_data || z == f64::from(no_data as f32);
    let height = |z: &f64| (!is_missing(*z)).then_some(*z);
    let rows = numbers.chunks(size[0] as usize).rev().map(|row| row.iter().map(height).collect());
    Ok(TerrainGrid { origin_m, step_m, heights_m: rows.collect() })
}

/// Place of the south-western height, and the distance of heights [m].
fn place(ifd: &Ifd, size: [u64; 2], is_point: bool) -> Result<([f64; 2], [f64; 2]), Fault> {
    if ifd.get(PIXEL_SCALE).is_none() && ifd.get(TRANSFORMATION).is_some() {
        return Err(not_read("a rotated grid", "turn it north up, as with gdalwarp"));
    }
    let needed = |tag, name: &str, least: usize| {
        let entry = ifd.get(tag).ok_or_else(|| Fault::truncated(format!("the tag {name} of a GeoTIFF")))?;
        let numbers = entry.numbers()?;
        let is_sound = numbers.len() >= least && numbers[..least].iter().all(|x| x.is_finite());
        if is_sound { Ok(numbers) } else { Err(Fault::truncated(format!("numbers of the tag {name}"))) }
    };
    let scale = needed(PIXEL_SCALE, "ModelPixelScale", 2)?;
    let tie = needed(TIE_POINT, "ModelTiepoint", 6)?;
    let step_m = [scale[0], scale[1]];
    if step_m.iter().any(|step| *step <= 0.0) {
        return Err(not_read(
            format!("a grid of steps {} × {}", step_m[0], step_m[1]),
            "turn it north up, as with gdalwarp",
        ));
    }
    // The tie point is of a corner of a pixel, or of its middle; heights belong to the middles.
    let middle = if is_point { 0.0 } else { 0.5 };
    let x = tie[3] + (middle - tie[0]) * step_m[0];
    let north = tie[4] - (middle - tie[1]) * step_m[1];
    Ok(([x, north - (size[1] - 1) as f64 * step_m[1]], step_m))
}

/// A part of the format that is not read.
fn not_read(what: impl Into<String>, cure: &'static str) -> Fault {
    FileProblem::NotRead { what: what.into(), cure }.into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    /// Tag, type, count, and value or place of each entry.
    type Entries = Vec<(u16, u16, u32, u32)>;

    /// A file of 3 × 2 numbers of a kind; `change` takes entries as (tag, type, count, value or place).
    fn file(format: (u16, u16), data: &[u8], compression: u16, change: impl Fn(&mut Entries)) -> Vec<u8> {
        let mut bytes = b"II\x2a\x00\x08\x00\x00\x00".to_vec();
        let tail = 8 + 2 + 12 * 13 + 4;
        let scale = [2.0f64, 5.0, 0.0];
        let tie = [0.0f64, 0.0, 0.0, 100.0, 200.0, 0.0];
        let (at_scale, at_tie) = (tail as u32, tail as u32 + 24);
        let at_data = at_tie + 48;
        let mut entries = vec![
            (WIDTH, 3, 1, 3),
            (HEIGHT, 3, 1, 2),
            (BITS, 3, 1, u32::from(format.1)),
            (COMPRESSION, 3, 1, u32::from(compression)),
            (STRIP_OFFSETS, 4, 1, at_data),
            (SAMPLES, 3, 1, 1),
            (ROWS_PER_STRIP, 3, 1, 2),
            (STRIP_BYTES, 4, 1, data.len() as u32),
            (FORMAT, 3, 1, u32::from(format.0)),
            (PIXEL_SCALE, 12, 3, at_scale),
            (TIE_POINT, 12, 6, at_tie),
            (GDAL_NO_DATA, 2, 3, u32::from_le_bytes(*b"-1\0\0")),
        ];
        change(&mut entries);
        bytes.extend((entries.len() as u16).to_le_bytes());
        for (tag, kind, count, value) in entries {
            bytes.extend(tag.to_le_bytes());
            bytes.extend(kind.to_le_bytes());
            bytes.extend(count.to_le_bytes());
            bytes.extend(value.to_le_bytes());
        }
        bytes.resize(tail, 0);
        scale.iter().chain(&tie).for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes.extend(data);
        bytes
    }

    fn floats() -> Vec<u8> {
        [4.0f32, 5.0, -1.0, 1.0, 2.0, 3.0].iter().flat_map(|x| x.to_le_bytes()).collect()
    }

    fn expected() -> TerrainGrid {
        let heights_m = vec![vec![Some(1.0), Some(2.0), Some(3.0)], vec![Some(4.0), Some(5.0), None]];
        // The north-western corner of the grid is (100, 200), its pixels are 2 × 5 m.
        TerrainGrid { origin_m: [101.0, 192.5], step_m: [2.0, 5.0], heights_m }
    }

    #[test]
    fn numbers_of_all_kinds_are_heights_of_the_middles_of_pixels() {
        assert_eq!(read(&file((3, 32), &floats(), 1, |_| ())).unwrap(), expected());
        let doubles: Vec<u8> =
            [4.0f64, 5.0, -1.0, 1.0, 2.0, 3.0].iter().flat_map(|x| x.to_le_bytes()).collect();
        assert_eq!(read(&file((3, 64), &doubles, 1, |_| ())).unwrap(), expected());
        let whole: Vec<u8> = [4i16, 5, -1, 1, 2, 3].iter().flat_map(|x| x.to_le_bytes()).collect();
        assert_eq!(read(&file((2, 16), &whole, 1, |_| ())).unwrap(), expected());
    }

    #[test]
    fn deflate_lzw_and_predictors_give_the_same() {
        let deflated = miniz_oxide::deflate::compress_to_vec_zlib(&floats(), 6);
        assert_eq!(read(&file((3, 32), &deflated, 8, |_| ())).unwrap(), expected());
        // Differences of neighbours in a row.
        let whole: Vec<u8> = [4i16, 1, -6, 1, 1, 1].iter().flat_map(|x| x.to_le_bytes()).collect();
        let deflated = miniz_oxide::deflate::compress_to_vec_zlib(&whole, 6);
        let differences = |entries: &mut Vec<_>| entries.insert(8, (PREDICTOR, 3, 1, 2));
        assert_eq!(read(&file((2, 16), &deflated, 8, differences)).unwrap(), expected());
        // LZW without any repeats: a clear code, each byte as a code of nine bits, an end.
        let plain = floats();
        let codes = std::iter::once(256).chain(plain.iter().map(|b| u32::from(*b))).chain([257]);
        let (mut packed, mut held, mut bits) = (Vec::new(), 0u32, 0);
        for code in codes {
            held = held << 9 | code;
            bits += 9;
            while bits >= 8 {
                bits -= 8;
                packed.push((held >> bits) as u8);
            }
        }
        packed.push((held << (8 - bits)) as u8);
        assert_eq!(read(&file((3, 32), &packed, 5, |_| ())).unwrap(), expected());
    }

    #[test]
    fn what_is_not_read_is_refused_with_a_cure() {
        let said = |bytes: &[u8]| read(bytes).unwrap_err().of(Path::new("a.tif")).to_string();
        let with = |change: &dyn Fn(&mut Entries)| said(&file((3, 32), &floats(), 1, change));
        assert!(said(b"II\x2b\x00").contains("gdal_translate"));
        assert!(said(b"PK").contains("TIFF"));
        assert!(with(&|e| e[3].3 = 7).contains("gdal_translate"));
        assert!(with(&|e| e[5].3 = 3).contains("one band"));
        assert!(with(&|e| e[0].3 = 60_000).contains("truncated"));
        assert!(
            with(&|e| (e[0].1, e[0].3, e[1].1, e[1].3) = (4, u32::MAX, 4, u32::MAX)).contains("resample")
        );
        assert!(with(&|e| e.retain(|entry| entry.0 != PIXEL_SCALE)).contains("ModelPixelScale"));
        assert!(with(&|e| e[4].3 = u32::MAX).contains("truncated"));
        // Heights in feet: a list of keys behind the numbers of the grid.
        let keys = [1u16, 1, 0, 1, 4099, 0, 1, 9002].into_iter().flat_map(u16::to_le_bytes);
        let data: Vec<u8> = floats().into_iter().chain(keys).collect();
        let in_feet = said(&file((3, 32), &data, 1, |e| {
            let at_keys = e[4].3 + 24;
            e.insert(11, (GEO_KEYS, 3, 8, at_keys));
        }));
        assert!(in_feet.contains("EPSG 9002 (feet)"), "{in_feet}");
    }

    proptest::proptest! {
        #[test]
        fn no_bytes_make_the_reader_panic(at in 0usize..300, byte: u8, cut in 0usize..300) {
            let mut bytes = file((3, 32), &floats(), 1, |_| ());
            if let Some(place) = bytes.get_mut(at) {
                *place = byte;
            }
            let _ = read(&bytes);
            bytes.truncate(cut);
            let _ = read(&bytes);
        }
    }
}
