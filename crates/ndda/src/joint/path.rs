//! Slips of direct-shear tests.

use super::{JointError, positive};

/// Steps of a test, at most.
const MOST_STEPS: u64 = 10_000_000;
/// Amplitude of a test for which none is given [m].
const AMPLITUDE_M: f64 = 0.01;

/// Whether a test has steps, and no more than its rows can be kept of.
pub(super) fn steps(count: u64) -> Result<(), JointError> {
    if (1..=MOST_STEPS).contains(&count) {
        return Ok(());
    }
    let advice = "give --steps and --cycles with 1 to 10 million steps in all";
    Err(JointError::OutOfRange { what: "the number of steps", value: count as f64, advice })
}

/// Slips of a test: to the amplitude (1 cm where none is given) and no farther, or forth and back about the start so many times.
///
/// # Errors
/// [`JointError::OutOfRange`].
pub fn path(amplitude_m: impl Into<Option<f64>>, cycles: u32, steps: u32) -> Result<Vec<f64>, JointError> {
    let amplitude_m = amplitude_m.into().unwrap_or(AMPLITUDE_M);
    positive("--amplitude", amplitude_m)?;
    let count = u64::from(steps).saturating_mul(if cycles == 0 { 1 } else { 4 * u64::from(cycles) });
    self::steps(count)?;
    let part = |k: u64| (k as f64) / f64::from(steps);
    let at = |k: u64| match (k / u64::from(steps)) % 4 {
        _ if cycles == 0 => part(k),
        0 => part(k % (4 * u64::from(steps))),
        1 | 2 => 2.0 - part(k % (4 * u64::from(steps))),
        _ => part(k % (4 * u64::from(steps))) - 4.0,
    };
    Ok((1..=count).map(|k| amplitude_m * at(k)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_goes_forth_and_back_through_its_start_in_even_steps() {
        assert_eq!(path(2.0, 0, 4), Ok(vec![0.5, 1.0, 1.5, 2.0]));
        let cycle = [1.0, 2.0, 1.0, 0.0, -1.0, -2.0, -1.0, 0.0];
        assert_eq!(path(2.0, 2, 2), Ok([cycle, cycle].concat()));
    }

    #[test]
    fn a_path_that_leads_nowhere_or_never_ends_is_an_error() {
        assert!(path(-1.0, 0, 10).is_err() && path(f64::NAN, 0, 10).is_err());
        assert!(path(1.0, 0, 0).is_err() && path(1.0, u32::MAX, 10).is_err());
        assert!(path(1.0, u32::MAX, u32::MAX).is_err());
    }
}
