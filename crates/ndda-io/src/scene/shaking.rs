//! Records of ground motion as a scene names them.

use serde::{Deserialize, Serialize};

/// A record of accelerations and what is done with it, in this order: unit and factor, filter, baseline.
///
/// Acceleration is linear between its rows, and zero before and after; `ndda record` shows it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// An `.at2` file of the PEER data base, or a CSV file with a column `time_s`; its path counts from the scene file.
    pub file: String,
    /// Column of accelerations of a CSV file. Default: `acceleration_m_s2`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub column: Option<String>,
    /// Unit of the accelerations. Default: that which an `.at2` file names, or in which the name of the column ends (`_m_s2`, `_cm_s2`, `_gal`, `_g`), or m/s².
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<AccelerationUnit>,
    /// Factor on the accelerations; a negative one turns them round. Default: 1.
    #[serde(default = "super::one")]
    pub factor: f64,
    /// Corner frequencies (low, high) [Hz] of a Butterworth band pass of second order that runs forwards and backwards: no shift in time, half of the
    /// amplitude at the corners. A low of 0 lets all low frequencies pass. Default: no filter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub filter_hz: Option<(f64, f64)>,
    /// What is taken out of the velocity, so that it does not drift. Default: `None`.
    #[serde(default)]
    pub baseline: Baseline,
    /// Even spacing to which the record is brought, linearly between its rows [s]. Default: its own rows, or their shortest spacing with a filter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub resample_s: Option<f64>,
}

/// Unit of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum AccelerationUnit {
    /// Standard gravity, 9.80665 m/s².
    G,
    /// m/s².
    MetrePerSecondSquared,
    /// cm/s², gal.
    CentimetrePerSecondSquared,
}

impl AccelerationUnit {
    /// One of it [m/s²].
    pub(crate) fn m_s2(self) -> f64 {
        match self {
            Self::G => 9.80665,
            Self::MetrePerSecondSquared => 1.0,
            Self::CentimetrePerSecondSquared => 0.01,
        }
    }

    /// The unit that the name of a column ends in, as in `acceleration_m_s2`, `ew_cm_s2`, `ns_gal` and `a_g`.
    pub(crate) fn named_by(column: &str) -> Option<Self> {
        const ENDINGS: [(&str, AccelerationUnit); 12] = [
            ("_cm_s2", AccelerationUnit::CentimetrePerSecondSquared),
            ("(cm/s2)", AccelerationUnit::CentimetrePerSecondSquared),
            ("[cm/s2]", AccelerationUnit::CentimetrePerSecondSquared),
            ("_gal", AccelerationUnit::CentimetrePerSecondSquared),
            ("(gal)", AccelerationUnit::CentimetrePerSecondSquared),
            ("[gal]", AccelerationUnit::CentimetrePerSecondSquared),
            ("_m_s2", AccelerationUnit::MetrePerSecondSquared),
            ("(m/s2)", AccelerationUnit::MetrePerSecondSquared),
            ("[m/s2]", AccelerationUnit::MetrePerSecondSquared),
            ("_g", AccelerationUnit::G),
            ("(g)", AccelerationUnit::G),
            ("[g]", AccelerationUnit::G),
        ];
        let column = column.to_lowercase();
        ENDINGS.iter().find(|(ending, _)| column.ends_with(ending)).map(|(_, unit)| *unit)
    }

    /// Its symbol.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::G => "g",
            Self::MetrePerSecondSquared => "m/s²",
            Self::CentimetrePerSecondSquared => "cm/s²",
        }
    }
}

/// The baseline of a record's velocity: the polynomial through zero at the first row that fits the velocity best, by least squares over time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Baseline {
    /// Nothing is taken out.
    #[default]
    None,
    /// c₁ t: a constant acceleration.
    Linear,
    /// c₁ t + c₂ t²: an acceleration that grows linearly.
    Quadratic,
}

/// One component of a shaken base.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Component {
    /// Its direction; its length does not matter.
    pub direction: [f64; 3],
    /// Its record.
    pub record: Record,
}
