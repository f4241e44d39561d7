//! Records of ground motion: their measures, response spectra, and slip of a rigid block.
//!
//! | module | contents |
//! |---|---|
//! | `measures` | peaks, Arias intensity, duration |
//! | `spectrum` | response spectra, exact between rows |
//! | `newmark` | slip of a rigid block, exact between rows |
//! | `input`, `report`, `picture` | files; words and tables; a picture |

mod input;
mod measures;
mod newmark;
#[cfg(feature = "plots")]
mod picture;
mod report;
mod spectrum;

use std::path::PathBuf;

use ndda_io::WriteError;
use ndda_io::record::RecordError;
use ndda_io::scene::Record;
use ndda_io::table::TableError;
use serde::Serialize;

pub use input::{parse_baseline, parse_corners, parse_unit};
pub use measures::{Measures, Motion, measures};
pub use newmark::{Slide, Slip, slip};
pub use report::tell;
pub use spectrum::{Response, response, spectrum};

/// Gravity of the measures [m/s²].
pub(crate) const GRAVITY: f64 = 9.80665;

/// A record to look at.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// The record, and what is done with it; or a run's folder or history, of which `column` is a velocity.
    pub record: Record,
    /// Part of critical damping of the response spectrum.
    pub damping: f64,
    /// Block that slides.
    pub slide: Option<Slide>,
    /// The picture, SVG or PNG, and the tables as CSV beside it.
    pub out: PathBuf,
}

/// Why there is nothing to show.
#[derive(Debug, thiserror::Error)]
pub enum ShakingError {
    /// The record cannot be used.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// The history cannot be read.
    #[error(transparent)]
    History(#[from] TableError),
    /// The history has no such velocity.
    #[error("{}: {reason}; {}", file.display(), which_column(names))]
    Column {
        /// The history.
        file: PathBuf,
        /// The problem.
        reason: String,
        /// Velocities that it has.
        names: String,
    },
    /// An option is out of range.
    #[error("--{option} {value}: write {advice}")]
    Option {
        /// The option.
        option: &'static str,
        /// Its value.
        value: String,
        /// The range that is allowed.
        advice: &'static str,
    },
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

fn which_column(names: &str) -> String {
    match names.is_empty() {
        true => "it has no velocities: give the scene `monitors`, and run it again".into(),
        false => format!("write --column with one of {names}"),
    }
}

/// What there is to know of a record.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Shaking {
    /// What it is and what was done with it.
    pub record: String,
    /// Peaks, intensity, duration.
    #[serde(flatten)]
    pub measures: Measures,
    /// Part of critical damping of the spectrum.
    pub damping: f64,
    /// Response by period.
    pub spectrum: Vec<Response>,
    /// Slip of a block under the record as it is, and turned round.
    pub slip: Option<[Slip; 2]>,
    /// The picture; none in a program without pictures.
    pub picture: Option<PathBuf>,
    /// Tables: motion over time, and spectrum.
    pub tables: [PathBuf; 2],
}

/// Reads a record, measures it, and writes its tables and picture.
///
/// # Errors
/// [`ShakingError`].
pub fn make(request: &Request) -> Result<Shaking, ShakingError> {
    check(request)?;
    let prepared = input::read(&request.record)?;
    let rows = &prepared.rows;
    let motion = Motion::new(rows);
    let periods_s = spectrum::periods_s();
    let turned: Vec<(f64, f64)> = rows.iter().map(|(t, a)| (*t, -a)).collect();
    let slips = request.slide.as_ref().map(|slide| [slip(rows, slide), slip(&turned, slide)]);
    let shaking = Shaking {
        record: prepared.told.clone(),
        measures: measures(&motion),
        damping: request.damping,
        spectrum: spectrum(rows, &periods_s, request.damping),
        slip: slips,
        picture: None,
        tables: [request.out.with_extension("motion.csv"), request.out.with_extension("spectrum.csv")],
    };
    #[cfg(feature = "plots")]
    let shaking = {
        picture::draw(&shaking, &motion, &request.out)?;
        Shaking { picture: Some(request.out.clone()), ..shaking }
    };
    report::write_tables(&shaking, &motion)?;
    Ok(shaking)
}

fn check(request: &Request) -> Result<(), ShakingError> {
    let wrong = |option, value: String, advice| Err(ShakingError::Option { option, value, advice });
    if !(0.0..1.0).contains(&request.damping) {
        return wrong("damping", request.damping.to_string(), "a damping ratio from 0 to below 1, as 0.05");
    }
    if !request.record.factor.is_finite() {
        return wrong("factor", request.record.factor.to_string(), "a finite number");
    }
    if let Some((low, high)) = request.record.filter_hz
        && !(0.0 <= low && low < high && high.is_finite())
    {
        return wrong(
            "filter",
            format!("{low},{high}"),
            "corner frequencies in hertz, the lower one first, as 0.1,25",
        );
    }
    if request.record.resample_s.is_some_and(|s| !(s > 0.0 && s.is_finite())) {
        let value = request.record.resample_s.unwrap_or_default().to_string();
        return wrong("resample", value, "seconds above 0");
    }
    match &request.slide {
        Some(Slide::Yield(a)) if !(*a > 0.0 && a.is_finite()) => {
            wrong("yield", a.to_string(), "m/s² above 0")
        }
        Some(Slide::Slope { slope_deg, friction_deg, .. })
            if !(0.0 <= *slope_deg && slope_deg < friction_deg && slope_deg + friction_deg < 90.0) =>
        {
            let advice = "an angle from 0 to below that of --friction, and both together below 90";
            wrong("slope", slope_deg.to_string(), advice)
        }
        _ => Ok(()),
    }
}
