//! Records of the PEER data base: four lines of words, the fourth with the number of points and their spacing, then accelerations.

use std::path::Path;

use super::{RecordError, Rows};
use crate::scene::AccelerationUnit;

/// Lines before the numbers.
const HEADER: usize = 4;

/// Times [s] and accelerations of a file, and the unit that it names.
///
/// # Errors
/// [`RecordError::Table`] with the line that is wrong.
pub(super) fn parse(file: &Path, text: &str) -> Result<(Rows, Option<AccelerationUnit>), RecordError> {
    let wrong = |fault: String| RecordError::Table { file: file.to_path_buf(), fault };
    let lines: Vec<&str> = text.lines().collect();
    let Some(counts) = lines.get(HEADER - 1) else {
        return Err(wrong(format!(
            "it has {} lines: a PEER record has four before its numbers",
            lines.len()
        )));
    };
    let kind = lines[HEADER - 2].to_uppercase();
    if !kind.contains("ACCEL") && (kind.contains("VELOC") || kind.contains("DISPL")) {
        return Err(wrong(format!(
            "line {} is `{}`: a record must be of accelerations, as in files ending with .AT2",
            HEADER - 1,
            kind.trim()
        )));
    }
    let (points, spacing_s) = counted(counts).ok_or_else(|| {
        wrong(format!(
            "line {HEADER} is `{}`: it should say `NPTS= 4000, DT= .0050 SEC`, the number of points and their spacing",
            counts.trim()
        ))
    })?;
    let mut rows = Vec::new();
    for (i, line) in lines.iter().enumerate().skip(HEADER) {
        for word in line.split_whitespace() {
            let value =
                number(word).ok_or_else(|| wrong(format!("line {}: `{word}` is not a number", i + 1)))?;
            rows.push((rows.len() as f64 * spacing_s, value));
        }
    }
    if rows.len() != points {
        let fault = format!(
            "it has {} numbers, and line {HEADER} says {points}: the file is incomplete, or its header wrong",
            rows.len()
        );
        return Err(wrong(fault));
    }
    Ok((rows, unit(lines[HEADER - 2])))
}

/// The unit in a line such as `ACCELERATION TIME SERIES IN UNITS OF G`.
fn unit(line: &str) -> Option<AccelerationUnit> {
    let line = line.to_uppercase();
    let (_, named) = line.split_once("UNITS OF")?;
    match named.trim() {
        "G" => Some(AccelerationUnit::G),
        "M/S/S" | "M/S2" | "M/S^2" | "M/SEC/SEC" | "M/SEC2" => Some(AccelerationUnit::MetrePerSecondSquared),
        "CM/S/S" | "CM/S2" | "CM/S^2" | "CM/SEC/SEC" | "CM/SEC2" | "GAL" => {
            Some(AccelerationUnit::CentimetrePerSecondSquared)
        }
        _ => None,
    }
}

/// Number of points and spacing, in either order of words and numbers: `NPTS= 4000, DT= .005 SEC` and `4000 .005 NPTS, DT`.
fn counted(line: &str) -> Option<(usize, f64)> {
    let words = line.split(|c: char| c.is_whitespace() || c == '=' || c == ',');
    let mut numbers = words.filter_map(number);
    let (points, spacing_s) = (numbers.next()?, numbers.next()?);
    let sound = points >= 2.0 && points.fract() == 0.0 && points < 1e9 && spacing_s > 0.0;
    sound.then_some((points as usize, spacing_s))
}

/// A finite number, as Fortran writes it, too: `-.123E-03`, `1.0D+00`.
fn number(word: &str) -> Option<f64> {
    let begins = word.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
    word.replace(['D', 'd'], "E").parse().ok().filter(|v: &f64| begins && v.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(text: &str) -> Result<(Rows, Option<AccelerationUnit>), String> {
        parse(Path::new("quake.at2"), text).map_err(|error| error.to_string())
    }

    #[test]
    fn both_forms_of_the_fourth_line_are_read_and_the_unit_with_them() {
        for counts in ["NPTS=   3, DT=   .0050 SEC,", "    3    0.0050    NPTS, DT"] {
            let text = format!(
                "PEER\nLoma\nACCELERATION TIME SERIES IN UNITS OF G\n{counts}\n  .1E-02 -.2E-02\n 3.0D-03\n"
            );
            let (rows, unit) = told(&text).unwrap();
            assert_eq!(rows, [(0.0, 1e-3), (0.005, -2e-3), (0.01, 3e-3)]);
            assert_eq!(unit, Some(AccelerationUnit::G));
        }
    }

    #[test]
    fn a_record_that_is_cut_off_or_damaged_is_refused_with_its_line() {
        for (text, word) in [
            ("PEER\nLoma\n", "2 lines"),
            (
                "a\nb\nVELOCITY TIME SERIES IN UNITS OF CM/S\nNPTS= 1, DT= .005\n1\n",
                "must be of accelerations",
            ),
            ("a\nb\nc\nd\n1 2\n", "line 4"),
            ("a\nb\nc\nNPTS= 3, DT= .005\n1 2\n", "has 2 numbers, and line 4 says 3"),
            ("a\nb\nc\nNPTS= 3, DT= .005\n1 x\n2\n", "line 5: `x`"),
            ("a\nb\nc\nNPTS= 3, DT= .005\n1 nan\n2\n", "line 5: `nan`"),
        ] {
            let message = told(text).unwrap_err();
            assert!(message.contains(word), "{text:?}: {message}");
        }
    }
}
