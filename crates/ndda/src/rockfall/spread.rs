//! How heights, speeds and energies of several boulders are spread.

use serde::{Deserialize, Serialize};

use super::passage::Moment;
use crate::sweep::statistics::quantile;

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
        let [median, percentile_95] = [0.5, 0.95].map(|part| quantile(&values, part));
        Some(Self { median, percentile_95, largest })
    }
}

/// How far boulders get, where some were last seen on their way: those that left the terrain, still moved, or could not be computed to the end. They
/// count as farther than all that came to rest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Runout {
    /// Median [m]; none where half of the boulders were last seen on their way.
    pub median: Option<f64>,
    /// The distance that 95 % do not exceed [m]; none where more than 5 % were last seen on their way.
    pub percentile_95: Option<f64>,
    /// The largest of those that came to rest [m]; none if none did.
    pub largest: Option<f64>,
}

impl Runout {
    /// Of the distances of boulders that came to rest, in any order, and so many that were last seen on their way.
    pub fn of(mut rested_m: Vec<f64>, on_their_way: usize) -> Self {
        rested_m.sort_by(f64::total_cmp);
        let last = (rested_m.len() + on_their_way).saturating_sub(1);
        let at = |part: f64| {
            let place = part * last as f64;
            let low = rested_m.get(place.floor() as usize)?;
            let high = rested_m.get(place.ceil() as usize)?;
            Some(low + place.fract() * (high - low))
        };
        Self { median: at(0.5), percentile_95: at(0.95), largest: rested_m.last().copied() }
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
    fn boulders_that_were_last_seen_on_their_way_count_as_farther_than_all_others() {
        let rested = |count: u32| (1..=count).rev().map(f64::from).collect::<Vec<_>>();
        let whole = Runout { median: Some(51.0), percentile_95: Some(96.0), largest: Some(101.0) };
        assert_eq!(Runout::of(rested(101), 0), whole);
        // 97 of 101 at rest: the 96th of them is still one of these.
        assert_eq!(Runout::of(rested(97), 4), Runout { largest: Some(97.0), ..whole });
        assert_eq!(Runout::of(rested(95), 6), Runout { percentile_95: None, largest: Some(95.0), ..whole });
        assert_eq!(
            Runout::of(rested(18), 22),
            Runout { median: None, percentile_95: None, largest: Some(18.0) }
        );
        assert_eq!(Runout::of(Vec::new(), 8), Runout { median: None, percentile_95: None, largest: None });
    }

    #[test]
    fn percentiles_are_between_values() {
        let spread = Spread::of((0..=100).rev().map(f64::from).collect()).expect("values");
        assert_eq!((spread.median, spread.percentile_95, spread.largest), (50.0, 95.0, 100.0));
        assert_eq!(Spread::of(vec![3.0]).expect("a value").median, 3.0);
        assert_eq!(Spread::of(Vec::new()), None);
    }
}
