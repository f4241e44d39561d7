//! Records, and velocities in the history of a run.

use std::path::{Path, PathBuf};

use ndda_io::OutputFolder;
use ndda_io::record::Prepared;
use ndda_io::results::Table;
use ndda_io::scene::{AccelerationUnit, Baseline, Record};

use super::ShakingError;

/// What a column of velocities is called between the name of the monitor and the axis.
const VELOCITY: &str = ".velocity_";

/// A unit of accelerations by its name.
///
/// # Errors
/// The names, for another one.
pub fn parse_unit(text: &str) -> Result<AccelerationUnit, String> {
    match text {
        "g" => Ok(AccelerationUnit::G),
        "m/s2" => Ok(AccelerationUnit::MetrePerSecondSquared),
        "cm/s2" | "gal" => Ok(AccelerationUnit::CentimetrePerSecondSquared),
        _ => Err("write g, m/s2 or cm/s2".into()),
    }
}

/// A baseline by its name.
///
/// # Errors
/// The names, for another one.
pub fn parse_baseline(text: &str) -> Result<Baseline, String> {
    match text {
        "none" => Ok(Baseline::None),
        "linear" => Ok(Baseline::Linear),
        "quadratic" => Ok(Baseline::Quadratic),
        _ => Err("write none, linear or quadratic".into()),
    }
}

/// Two frequencies, as `0.1,25`.
///
/// # Errors
/// An example, for another text.
pub fn parse_corners(text: &str) -> Result<(f64, f64), String> {
    let numbers = text
        .split_once(',')
        .and_then(|(low, high)| Some((low.trim().parse().ok()?, high.trim().parse().ok()?)));
    numbers.ok_or_else(|| "write two frequencies in hertz, as 0.1,25".into())
}

/// A record, or the acceleration of a monitor of a run.
pub(super) fn read(record: &Record) -> Result<Prepared, ShakingError> {
    let path = Path::new(&record.file);
    let asks_for_history = record.column.as_ref().is_some_and(|column| column.contains(VELOCITY));
    if !path.is_dir() && !asks_for_history {
        return Ok(record.prepared(Path::new(""))?);
    }
    if let Some(unit) = record.unit {
        let advice = "no unit for a history, whose velocities are in m/s";
        return Err(ShakingError::Option { option: "unit", value: unit.symbol().into(), advice });
    }
    let file = match path.is_dir() {
        true => OutputFolder::history_in(path).unwrap_or_else(|| path.join(OutputFolder::HISTORY)),
        false => path.to_path_buf(),
    };
    let table = Table::read(&file)?;
    let known = || -> String {
        let names: Vec<&str> =
            table.names.iter().filter(|name| name.contains(VELOCITY)).map(String::as_str).collect();
        names.join(", ")
    };
    let lost =
        |file: PathBuf, reason: &str| ShakingError::Column { file, reason: reason.into(), names: known() };
    let Some(column) = &record.column else { return Err(lost(file, "a history has several motions")) };
    if !column.contains(VELOCITY) {
        return Err(lost(file, &format!("column `{column}` is not a velocity of a monitor")));
    }
    let place = |name: &str| table.names.iter().position(|known| known == name);
    let (Some(time), Some(velocity)) = (place("time_s"), place(column)) else {
        return Err(lost(file, &format!("there is no column `{column}`")));
    };
    let (time_s, velocity) = (&table.columns[time], &table.columns[velocity]);
    if time_s.len() < 3 {
        return Err(lost(file, "it has less than three rows"));
    }
    // Mean accelerations, at the middle between two rows.
    let pairs = time_s.windows(2).zip(velocity.windows(2));
    let rows: Vec<(f64, f64)> =
        pairs.map(|(t, v)| (0.5 * (t[0] + t[1]), record.factor * (v[1] - v[0]) / (t[1] - t[0]))).collect();
    let told = format!("{}: {column}, {} rows, less the velocity at the start", file.display(), rows.len());
    Ok(record.processed(&file, rows, told)?)
}
