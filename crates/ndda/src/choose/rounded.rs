//! Values as a person would write them.

/// A length in metres with two digits.
pub(super) fn metres(length_m: f64) -> String {
    if (0.01..1e4).contains(&length_m) { format!("{length_m:.2} m") } else { format!("{length_m:.1e} m") }
}

/// The largest of 1, 2 and 5 times a power of ten that is not above a value.
pub(super) fn rounded_down(value: f64) -> f64 {
    let exponent = value.log10().floor() as i32;
    let digits = (1.0 + 1e-12) * value / 10f64.powi(exponent);
    let digit = [5, 2, 1].into_iter().find(|digit| f64::from(*digit) <= digits).unwrap_or(1);
    // Read from its digits, so that it is the number that a person would write.
    format!("{digit}e{exponent}").parse().unwrap_or(value)
}

/// The smallest of 1, 2 and 5 times a power of ten that is not below a value.
pub(crate) fn rounded_up(value: f64) -> f64 {
    let below = rounded_down(value);
    if below >= value * (1.0 - 1e-12) { below } else { rounded_down(2.6 * below) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_rounded_to_what_a_person_would_write() {
        for (value, down, up) in [
            (1.0, 1.0, 1.0),
            (1.9e-5, 1e-5, 2e-5),
            (2e-5, 2e-5, 2e-5),
            (4.9e9, 2e9, 5e9),
            (5.1e9, 5e9, 1e10),
            (9.99e-3, 5e-3, 1e-2),
        ] {
            assert_eq!((rounded_down(value), rounded_up(value)), (down, up), "{value}");
        }
    }
}
