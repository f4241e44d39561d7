//! Heights of terrain on regular grids: ESRI ASCII grids (`.asc`), points (`.xyz`, `.txt`, `.csv`), GeoTIFF (`.tif`, `.tiff`), and surfaces of triangles (`.stl`)
//! that are sampled.
//!
//! An ESRI ASCII grid, as geographic information systems write it, is a header of keys and numbers, then heights in rows along x, the northernmost row first. `xllcorner` and `yllcorner` are the corner of the
//! south-western cell, `xllcenter` and `yllcenter` its centre; heights belong to the centres of cells.

mod geotiff;
mod holes;
mod points;
mod sampled;

use std::path::Path;

use super::error::{Fault, FileProblem, MeshFileError, ending};
use super::lines::{Line, Lines, parse, real};
use super::surface_file;
use crate::limited;
pub use holes::{Holes, connected};

/// Most heights of a grid: more would need gigabytes once they are rock.
const MOST_HEIGHTS: u64 = 1 << 24;

/// The value that says "no height" where the header gives none.
const NO_DATA: f64 = -9999.0;

/// Words for the number that an error expects where a file has a decimal comma.
const POINT: &str = "a number whose decimals come after a point, as 2.5";

/// Heights of terrain on a regular grid.
#[derive(Clone, Debug, PartialEq)]
pub struct TerrainGrid {
    /// Place (x, y) of the south-western height [m].
    pub origin_m: [f64; 2],
    /// Distance of heights along x and y [m].
    pub step_m: [f64; 2],
    /// Rows of heights along x, the southernmost row first [m]; none where the file has no height.
    pub heights_m: Vec<Vec<Option<f64>>>,
}

impl TerrainGrid {
    /// Reads heights, by the ending of `path`; a surface of triangles is sampled at this distance [m], or at a two-hundredth of its longer side.
    ///
    /// # Errors
    /// [`MeshFileError`] with the line of a text when the file cannot be read or understood, or holds no regular grid of heights in metres.
    pub fn read(path: &Path, sample_m: Option<f64>) -> Result<Self, MeshFileError> {
        let ending = ending(path);
        let parse: fn(&[u8], Option<f64>) -> Result<Self, Fault> = match ending.as_str() {
            "asc" => |bytes, _| grid(bytes),
            "xyz" | "txt" | "csv" => |bytes, _| points::read(bytes),
            "tif" | "tiff" => |bytes, _| geotiff::read(bytes),
            "stl" => |bytes, sample_m| sampled::sample(&surface_file::open_stl(bytes)?, sample_m),
            _ => {
                let known = ".asc, .xyz, .txt, .csv, .tif, .tiff, .stl";
                return Err(Fault::from(FileProblem::Extension { found: ending, known }).of(path));
            }
        };
        let bytes = limited::file(path)
            .map_err(|error| Fault::from(FileProblem::Unreadable(error.to_string())).of(path))?;
        parse(&bytes, sample_m).map_err(|fault| fault.of(path))
    }
}

fn grid(bytes: &[u8]) -> Result<TerrainGrid, Fault> {
    let mut lines = Lines::new(bytes, b'#');
    let (header, first) = Header::read(&mut lines)?;
    let (columns, rows) = (needed(header.columns, "ncols")?, needed(header.rows, "nrows")?);
    let count = columns.saturating_mul(rows);
    if count > MOST_HEIGHTS {
        let what = format!("a grid of {columns} × {rows} values, more than {MOST_HEIGHTS},");
        return Err(FileProblem::NotRead { what, cure: "resample it, or cut out the part you need" }.into());
    }
    // A height takes at least a digit and a space; the last one may lack the space.
    if count > (first.text.len() + lines.bytes_left()) as u64 / 2 + 1 {
        return Err(FileProblem::TooShort { what: "values", count }.into());
    }
    let mut heights_m = header.heights(first, lines, count as usize, columns as usize)?;
    heights_m.reverse();
    let step_m = [needed(header.step_m[0], "cellsize")?, needed(header.step_m[1], "cellsize")?];
    let origin_m = [header.origin(0, step_m[0])?, header.origin(1, step_m[1])?];
    Ok(TerrainGrid { origin_m, step_m, heights_m })
}

/// The header of a grid.
#[derive(Default)]
struct Header {
    columns: Option<u64>,
    rows: Option<u64>,
    corner_m: [Option<f64>; 2],
    center_m: [Option<f64>; 2],
    step_m: [Option<f64>; 2],
    no_data: Option<f64>,
}

impl Header {
    /// The header, and the first line of heights.
    fn read<'a>(lines: &mut Lines<'a>) -> Result<(Self, Line<'a>), Fault> {
        let mut header = Self::default();
        loop {
            let line = lines.expect("a row of values")?;
            let mut rest = line;
            let key = rest.word().unwrap_or_default();
            if parse::<f64>(key).is_some() {
                return header.without_decimal_commas(line);
            }
            if let Some(word) = decimal_comma(rest.text) {
                return Err(Fault::unexpected(line.number, POINT, word));
            }
            match key.to_ascii_lowercase().as_slice() {
                b"ncols" => header.columns = Some(extent(&mut rest)?),
                b"nrows" => header.rows = Some(extent(&mut rest)?),
                b"xllcorner" => header.corner_m[0] = Some(rest.finite("a coordinate")?),
                b"yllcorner" => header.corner_m[1] = Some(rest.finite("a coordinate")?),
                b"xllcenter" => header.center_m[0] = Some(rest.finite("a coordinate")?),
                b"yllcenter" => header.center_m[1] = Some(rest.finite("a coordinate")?),
                b"cellsize" => header.step_m = [Some(step(&mut rest)?); 2],
                b"dx" => header.step_m[0] = Some(step(&mut rest)?),
                b"dy" => header.step_m[1] = Some(step(&mut rest)?),
                b"nodata_value" => header.no_data = Some(rest.number("a number")?),
                _ => {
                    let expected = "a number, or ncols, nrows, xllcorner, xllcenter, yllcorner, yllcenter, cellsize, dx, dy or \
                                    NODATA_value";
                    return Err(Fault::unexpected(line.number, expected, key));
                }
            }
        }
    }

    /// The header with its first line of heights, in which commas are not those of decimals: then a row would have more words than columns.
    fn without_decimal_commas<'a>(self, line: Line<'a>) -> Result<(Self, Line<'a>), Fault> {
        let words = line.text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).count();
        match decimal_comma(line.text).filter(|_| self.columns == Some(words as u64)) {
            Some(word) => Err(Fault::unexpected(line.number, POINT, word)),
            None => Ok((self, line)),
        }
    }

    /// Rows of heights in the order of the file; lines may break anywhere.
    fn heights(
        &self,
        first: Line,
        lines: Lines,
        count: usize,
        columns: usize,
    ) -> Result<Vec<Vec<Option<f64>>>, Fault> {
        let no_data = self.no_data.unwrap_or(NO_DATA);
        let mut heights = Vec::with_capacity(count);
        for mut line in std::iter::once(first).chain(lines) {
            while let Some(word) = line.word() {
                if heights.len() == count {
                    let expected = format!("the end of the file after ncols × nrows = {count} values");
                    return Err(Fault::unexpected(line.number, expected, word));
                }
                let is_missing =
                    parse::<f64>(word).is_some_and(|z| z == no_data || (z.is_nan() && no_data.is_nan()));
                let height = real(word).filter(|_| !is_missing);
                if height.is_none() && !is_missing {
                    return Err(Fault::unexpected(line.number, "a finite number", word));
                }
                heights.push(height);
            }
        }
        if heights.len() < count {
            return Err(Fault::truncated(format!("value {} of {count}", heights.len() + 1)));
        }
        Ok(heights.chunks(columns).map(<[_]>::to_vec).collect())
    }

    /// The place of the south-western height along x or y [m].
    fn origin(&self, axis: usize, step_m: f64) -> Result<f64, Fault> {
        let key = ["xllcorner", "yllcorner"][axis];
        match self.center_m[axis] {
            Some(center_m) => Ok(center_m),
            None => needed(self.corner_m[axis], key).map(|corner_m| corner_m + 0.5 * step_m),
        }
    }
}

/// The first word between blanks that is a number with a comma before its decimals.
fn decimal_comma(text: &[u8]) -> Option<&[u8]> {
    let is_one = |word: &&[u8]| {
        let Some(comma) = word.iter().position(|byte| *byte == b',') else { return false };
        let (whole, decimals) = (word[..comma].trim_ascii_start(), &word[comma + 1..]);
        let whole = whole.strip_prefix(b"-").unwrap_or(whole);
        let is_digits = |part: &[u8]| !part.is_empty() && part.iter().all(u8::is_ascii_digit);
        is_digits(whole) && is_digits(decimals)
    };
    text.split(u8::is_ascii_whitespace).find(is_one)
}

fn needed<T>(value: Option<T>, key: &'static str) -> Result<T, Fault> {
    value.ok_or_else(|| FileProblem::NoHeaderLine(key).into())
}

fn extent(line: &mut Line) -> Result<u64, Fault> {
    let (number, word) = (line.number, line.clone().word().unwrap_or_default());
    let count = line.number("a whole number of at least 2")?;
    if count < 2 { Err(Fault::unexpected(number, "a whole number of at least 2", word)) } else { Ok(count) }
}

fn step(line: &mut Line) -> Result<f64, Fault> {
    let (number, word) = (line.number, line.clone().word().unwrap_or_default());
    let step_m = line.finite("a width above 0")?;
    if step_m > 0.0 { Ok(step_m) } else { Err(Fault::unexpected(number, "a width above 0", word)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRID: &str =
        "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 2\nNODATA_value -1\n4 5 -1\n1 2 3\n";

    fn error(text: &str) -> String {
        grid(text.as_bytes()).unwrap_err().of(Path::new("a.asc")).to_string()
    }

    #[test]
    fn decimal_commas_are_told_with_their_line() {
        let of_size = error(&GRID.replacen("cellsize 2", "cellsize 2,0", 1));
        assert!(of_size.contains('5') && of_size.contains("after a point, as 2.5, found `2,0`"), "{of_size}");
        let of_heights = error(&GRID.replacen("4 5 -1", "4,5 -5,25 6", 1));
        assert!(of_heights.contains('7') && of_heights.contains("found `4,5`"), "{of_heights}");
        // Commas that separate values are none.
        let separated = grid(GRID.replacen("4 5 -1", "4,5,-1", 1).as_bytes());
        assert_eq!(separated.unwrap(), grid(GRID.as_bytes()).unwrap());
    }

    #[test]
    fn rows_run_from_south_to_north_and_heights_lie_at_centres_of_cells() {
        let found = grid(GRID.as_bytes()).unwrap();
        assert_eq!((found.origin_m, found.step_m), ([101.0, 201.0], [2.0, 2.0]));
        let rows = [vec![Some(1.0), Some(2.0), Some(3.0)], vec![Some(4.0), Some(5.0), None]];
        assert_eq!(found.heights_m, rows);
    }

    #[test]
    fn keys_of_any_case_centres_unequal_steps_and_broken_rows_are_read() {
        let text = "NCOLS 3\r\nNROWS 2\r\nXLLCENTER 101\r\nYLLCENTER 201\r\nDX 2\r\nDY 2\r\nnodata_value nan\r\n4 5\r\nNaN 1 2\r\n3";
        assert_eq!(grid(text.as_bytes()).unwrap(), grid(GRID.as_bytes()).unwrap());
    }

    #[test]
    fn a_grid_may_begin_with_a_missing_height() {
        let text = "ncols 2\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 1\nNODATA_value nan\nnan 4\n1 2\n";
        assert_eq!(grid(text.as_bytes()).unwrap().heights_m[1], [None, Some(4.0)]);
    }

    #[test]
    fn errors_name_line_and_cure() {
        for (from, to, part) in [
            ("ncols 3", "ncols 1", "a.asc:1: expected a whole number of at least 2"),
            ("cellsize 2", "cellsize 0 m", "a.asc:5: expected a width above 0, found `0`"),
            ("cellsize 2", "cells 2", "a.asc:5: expected a number, or ncols"),
            ("xllcorner 100\n", "", "the header has no line `xllcorner`: write it"),
            ("1 2 3", "1 2 x", "a.asc:8: expected a finite number, found `x`"),
            ("1 2 3", "1 2 inf", "a.asc:8: expected a finite number, found `inf`"),
            ("1 2 3", "1 2", "value 6 of 6"),
            ("1 2 3", "1 2,5 3", "a.asc:8: expected the end of the file after ncols × nrows = 6 values"),
            ("ncols 3", "ncols 99", "promises 198 values"),
            ("ncols 3", "ncols 18446744073709551615", "resample it"),
        ] {
            let message = error(&GRID.replace(from, to));
            assert!(message.contains(part), "{from} -> {to}: {message}");
        }
    }

    proptest::proptest! {
        #[test]
        fn no_text_makes_the_reader_panic(cut in 0..GRID.len(), byte: u8, rest in "[ -~\\n]{0,60}") {
            let mut bytes = GRID.as_bytes().to_vec();
            bytes[cut] = byte;
            let _ = grid(&bytes);
            bytes.truncate(cut);
            let _ = grid(&bytes);
            bytes.extend(rest.bytes());
            let _ = grid(&bytes);
        }
    }
}
