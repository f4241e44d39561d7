//! Arguments of `ndda record`.

use std::path::PathBuf;

use clap::Args;
use ndda::shaking::{Request, Slide, parse_baseline, parse_corners, parse_unit};
use ndda_io::scene::{AccelerationUnit, Baseline, Record};

/// Arguments of `ndda record`.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  ndda record quake.at2 --filter 0.1,25 --baseline quadratic\n  ndda record quake.csv --slope 20 --friction 30\n  \
                  ndda record out/slope --column crest.velocity_x_m_s -o crest.png"
)]
pub struct RecordArgs {
    /// Record (.at2 of PEER, or CSV with a column time_s), or folder of a run.
    pub input: PathBuf,
    /// Column of accelerations of a CSV file, or of velocities of a history, as crest.velocity_x_m_s.
    #[arg(long, value_name = "NAME")]
    pub column: Option<String>,
    /// Unit of the accelerations: g, m/s2 or cm/s2 [default: that which the file or the name of the column gives, or m/s2].
    #[arg(long, value_name = "UNIT", value_parser = parse_unit)]
    pub unit: Option<AccelerationUnit>,
    /// Factor on the accelerations.
    #[arg(long, default_value_t = 1.0)]
    pub factor: f64,
    /// Corner frequencies of a band-pass filter [Hz], as 0.1,25.
    #[arg(long, value_name = "LOW,HIGH", value_parser = parse_corners)]
    pub filter: Option<(f64, f64)>,
    /// Baseline to take out of the velocity: none, linear or quadratic.
    #[arg(long, value_name = "LINE", default_value = "none", value_parser = parse_baseline)]
    pub baseline: Baseline,
    /// Resample the record to this time step [s].
    #[arg(long, value_name = "SECONDS")]
    pub resample: Option<f64>,
    /// Damping ratio of the response spectrum, as 0.05 for 5 % of critical damping.
    #[arg(long, default_value_t = 0.05)]
    pub damping: f64,
    /// Newmark sliding block on level ground: its yield acceleration [m/s²], the same in both directions.
    #[arg(long = "yield", value_name = "M_S2", conflicts_with = "slope")]
    pub yield_m_s2: Option<f64>,
    /// Newmark sliding block on a slope that is shaken horizontally: dip of the slope [°].
    #[arg(long, value_name = "DEGREES", requires = "friction")]
    pub slope: Option<f64>,
    /// Friction angle of the block on the slope [°].
    #[arg(long, value_name = "DEGREES", requires = "slope")]
    pub friction: Option<f64>,
    /// The record shakes along the slope, not horizontally.
    #[arg(long, requires = "slope")]
    pub along_slope: bool,
    /// The picture, .svg or .png; tables go beside it as .motion.csv and .spectrum.csv.
    #[arg(long, short, default_value = "record.svg", value_name = "FILE")]
    pub out: PathBuf,
    /// Print JSON for programs, an object per line; see docs/reference/json.md.
    #[arg(long)]
    pub json: bool,
}

impl RecordArgs {
    /// The request to the library that these options stand for.
    pub fn request(&self) -> Request {
        let slope = self.slope.zip(self.friction);
        let slope = slope.map(|(slope, friction)| Slide::slope(slope, friction, self.along_slope));
        Request {
            record: Record {
                file: self.input.to_string_lossy().into_owned(),
                column: self.column.clone(),
                unit: self.unit,
                factor: self.factor,
                filter_hz: self.filter,
                baseline: self.baseline,
                resample_s: self.resample,
            },
            damping: self.damping,
            slide: self.yield_m_s2.map(Slide::Yield).or(slope),
            out: self.out.clone(),
        }
    }
}
