//! Numbers beside colours and lengths: units with prefixes, and round steps.

/// Units with larger and smaller ones of the same kind, largest first.
const PREFIXES: [(&str, &[(f64, &str)]); 6] = [
    ("m", &[(1e3, "km"), (1.0, "m"), (1e-3, "mm"), (1e-6, "µm")]),
    ("m/s", &[(1.0, "m/s"), (1e-3, "mm/s"), (1e-6, "µm/s")]),
    ("Pa", &[(1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa"), (1.0, "Pa")]),
    ("N", &[(1e6, "MN"), (1e3, "kN"), (1.0, "N")]),
    ("J", &[(1e6, "MJ"), (1e3, "kJ"), (1.0, "J")]),
    ("s", &[(1.0, "s"), (1e-3, "ms")]),
];

/// The unit in which a value has few digits, and its size.
pub fn unit_for(value: f64, unit: &'static str) -> (f64, &'static str) {
    let known = PREFIXES.iter().find(|(name, _)| *name == unit).map_or(&[][..], |found| found.1);
    // A tenth of a unit still reads well: 0.5 m is not 500 mm, but 0.05 m is 50 mm.
    let fitting = known.iter().find(|(size, _)| value.abs() >= 0.1 * size * (1.0 - 1e-9));
    match (value == 0.0, fitting) {
        (false, Some(&found)) => found,
        (false, None) if !known.is_empty() => known[known.len() - 1],
        _ => (1.0, unit),
    }
}

/// The largest of 1, 2 and 5 times a power of ten that is not above `most`.
pub fn round_below(most: f64) -> f64 {
    if !(most.is_finite() && most > 0.0) {
        return 1.0;
    }
    let power = 10f64.powi(most.log10().floor() as i32);
    let fits = |factor: &f64| factor * power <= most * (1.0 + 1e-12);
    [5.0, 2.0, 1.0].into_iter().find(fits).unwrap_or(0.5) * power
}

/// Round places between two ends, about `count` of them.
pub fn ticks(low: f64, high: f64, count: usize) -> Vec<f64> {
    if !(high - low).is_finite() || high <= low {
        return Vec::new();
    }
    let step = round_below(1.6 * (high - low) / count.max(1) as f64);
    let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
    (first..=last).map(|i| i as f64 * step).collect()
}

/// A value of a scale, with enough digits to tell its marks apart and at least three of the largest.
pub fn on_scale(value: f64, low: f64, high: f64) -> String {
    let largest = low.abs().max(high.abs());
    if !(1e-3..1e5).contains(&largest) {
        return three_digits(value);
    }
    let of_span = if high > low { (-(high - low).log10()).ceil() + 1.0 } else { 0.0 };
    let decimals = of_span.max(2.0 - largest.log10().floor()).clamp(0.0, 9.0) as usize;
    let text = format!("{value:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".into() } else { text.into() }
}

/// A number of three digits, without zeros at the end.
pub fn three_digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".into() } else { value.to_string() };
    }
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    if (1e-3..1e5).contains(&rounded.abs()) { rounded.to_string() } else { format!("{rounded:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_leaves_few_digits_before_and_behind_the_point() {
        let shown = |value: f64, unit| {
            let (size, name) = unit_for(value, unit);
            format!("{} {name}", three_digits(value / size))
        };
        assert_eq!(shown(0.5, "m"), "0.5 m");
        assert_eq!(shown(0.012345, "m"), "12.3 mm");
        assert_eq!(shown(3.2e-8, "m"), "0.032 µm");
        assert_eq!(shown(2.5e6, "Pa"), "2.5 MPa");
        assert_eq!(shown(-4.0e5, "Pa"), "-0.4 MPa");
        assert_eq!(shown(0.0, "Pa"), "0 Pa");
        assert_eq!(shown(17.0, "kg m/s"), "17 kg m/s");
        assert_eq!(shown(2500.0, "m"), "2.5 km");
    }

    #[test]
    fn round_numbers_are_one_two_or_five_times_a_power_of_ten() {
        for (most, found) in [(0.99, 0.5), (1.0, 1.0), (1.99, 1.0), (4.9, 2.0), (73.0, 50.0), (2e-7, 2e-7)] {
            assert!((round_below(most) / found - 1.0).abs() < 1e-12, "{most}");
        }
        assert_eq!(round_below(0.0), 1.0);
    }

    #[test]
    fn marks_of_a_scale_have_the_digits_that_tell_them_apart() {
        let marks = |low: f64, high: f64| {
            let marks = [low, 0.5 * (low + high), high];
            marks.map(|value| on_scale(value, low, high)).join(" ")
        };
        assert_eq!(marks(0.0, 1.108), "0 0.55 1.11");
        assert_eq!(marks(2.43, 2.45), "2.43 2.44 2.45");
        assert_eq!(marks(-768.4, 0.0), "-768 -384 0");
        assert_eq!(marks(0.0, 2e7), "0 1e7 2e7");
    }

    #[test]
    fn ticks_are_round_and_within_the_ends() {
        assert_eq!(ticks(0.0, 1.0, 5), [0.0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0]);
        assert_eq!(ticks(-3.0, 12.0, 5), [-2.0, 0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0]);
        assert!(ticks(1.0, 1.0, 5).is_empty());
    }
}
