//! How heights, speeds and energies of several boulders are spread.

use serde::{Deserialize, Serialize};

use super::passage::Moment;

/// Median, 95th percentile and largest of some values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Median.
    pub median: f64,
    /// The value that 95 % do not exceed.
    pub percentile_95: f64,
    /// The largest.
    pub largest: f64,
}

impl Spread {
    /// Of values in any order, between which percentiles are linear; none of none.
    pub fn of(mut values: Vec<f64>) -> Option<Self> {
        values.sort_by(f64::total_cmp);
        let largest = *values.last()?;
        let at = |part: f64| {
            let place = part * (values.len() - 1) as f64;
            let (low, rest) = (place.floor() as usize, place.fract());
            values[low] + rest * (values[(low + 1).min(values.len() - 1)] - values[low])
        };
        Some(Self { median: at(0.5), percentile_95: at(0.95), largest })
    }
}

/// Heights, speeds and energies at a line.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AtLine {
    /// Height of the mass centre above the ground [m].
    pub height_m: Spread,
    /// Height of the highest point of the boulder [m].
    pub top_m: Spread,
    /// Speed [m/s].
    pub speed_m_s: Spread,
    /// Kinetic energy [J].
    pub energy_j: Spread,
    /// Its part of rotation [J].
    pub rotation_j: Spread,
}

impl AtLine {
    /// Of boulders at a moment each; none of none.
    pub fn of(moments: &[Moment]) -> Option<Self> {
        let spread = |of: &dyn Fn(&Moment) -> f64| Spread::of(moments.iter().map(of).collect());
        Some(Self {
            height_m: spread(&|m| m.height_m)?,
            top_m: spread(&|m| m.top_m)?,
            speed_m_s: spread(&Moment::speed_m_s)?,
            energy_j: spread(&Moment::energy_j)?,
            rotation_j: spread(&|m| m.rotation_j)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_between_values() {
        let spread = Spread::of((0..=100).rev().map(f64::from).collect()).expect("values");
        assert_eq!((spread.median, spread.percentile_95, spread.largest), (50.0, 95.0, 100.0));
        assert_eq!(Spread::of(vec![3.0]).expect("a value").median, 3.0);
        assert_eq!(Spread::of(Vec::new()), None);
    }
}
