//! Numbers as command lines take them, and counts as people read them.

/// Endings of names, and units; the longer ones before those that they end in.
const UNITS: [(&str, &str); 13] = [
    ("_kg_m2_s", "kg m²/s"),
    ("_kg_m_s", "kg m/s"),
    ("_m_s2", "m/s²"),
    ("_m_s", "m/s"),
    ("_j_m3", "J/m³"),
    ("_rad_s", "rad/s"),
    ("_deg", "°"),
    ("_kg", "kg"),
    ("_pa", "Pa"),
    ("_j", "J"),
    ("_n", "N"),
    ("_m", "m"),
    ("_s", "s"),
];

/// A name without the unit at its end, and the unit; empty where the name says none.
pub fn split_unit(name: &str) -> (&str, &'static str) {
    let found = UNITS.iter().find_map(|(ending, unit)| Some((name.strip_suffix(ending)?, *unit)));
    found.unwrap_or((name, ""))
}

/// A count with its noun: `1 block`, `2 blocks`, `no blocks`.
pub fn counted(count: usize, one: &str, many: &str) -> String {
    match count {
        0 => format!("no {many}"),
        1 => format!("1 {one}"),
        _ => format!("{count} {many}"),
    }
}

/// A number in four figures, or all those before the point.
pub fn four_figures(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        v if (1e-3..1e7).contains(&v) => {
            format!("{value:.*}", (3 - v.log10().floor() as i32).max(0) as usize)
        }
        _ => format!("{value:.3e}"),
    }
}

/// Shorter lengths [m] have no figure left in micrometres, and are most often rounding.
pub const SHORTEST_M: f64 = 1e-9;

/// A length in a unit that suits it: `3.16 m`, `11.9 mm`, `0.150 µm`.
pub fn length(metres: f64) -> String {
    match metres.abs() {
        0.0 => "0 m".into(),
        size if size >= 1.0 => format!("{} m", three_figures(metres)),
        size if size >= 1e-3 => format!("{} mm", three_figures(1e3 * metres)),
        size if size >= SHORTEST_M => format!("{} µm", three_figures(1e6 * metres)),
        _ => format!("{metres:.1e} m"),
    }
}

/// A number in three figures, or all those before the point, with at most three after it.
fn three_figures(value: f64) -> String {
    let decimals = match value.abs() {
        v if v >= 100.0 => 0,
        v if v >= 10.0 => 1,
        v if v >= 1.0 => 2,
        _ => 3,
    };
    format!("{value:.decimals$}")
}

/// A number in the fewest figures that differ from it by rounding alone: `4e-4` for 3.9999999999999996e-4.
pub fn in_fewest_figures(value: f64) -> String {
    let is_same =
        |text: &String| text.parse().is_ok_and(|read: f64| (read - value).abs() <= 1e-14 * value.abs());
    (0..16).map(|after| format!("{value:.after$e}")).find(is_same).unwrap_or_else(|| format!("{value:e}"))
}

/// The largest number of two figures that is not above a positive one, as `5.4e-3`.
pub fn two_figures_down(value: f64) -> String {
    let exponent = value.log10().floor() as i32;
    let tenths = (10.0 * (1.0 + 1e-12) * value / 10f64.powi(exponent)).floor();
    format!("{:.1}e{exponent}", 0.1 * tenths)
}

/// Trend, clockwise from the north (y), and plunge below the horizontal, negative upward, of a direction: `110.5°/37.9°`.
pub fn trend_and_plunge([x, y, z]: [f64; 3]) -> String {
    let across = x.hypot(y);
    // Rounded here, so that there is neither a −0.0° nor a 360.0°.
    let rounded = |angle: f64| (10.0 * angle.to_degrees()).round() / 10.0 + 0.0;
    // A direction has no trend where rounding alone makes one.
    if across <= 1e-6 * z.abs() {
        return if z > 0.0 { "upward" } else { "downward" }.into();
    }
    let trend_deg = rounded(x.atan2(y)).rem_euclid(360.0);
    format!("{trend_deg:.1}°/{:.1}°", rounded((-z).atan2(across)))
}

/// A value of pascals in six figures with the prefix that suits it: `1 MPa`, `20 GPa/m`, `10 Pa`.
pub fn with_prefix(value: f64, unit: &str) -> String {
    let prefixes = [(1e9, "G"), (1e6, "M"), (1e3, "k")];
    let (size, prefix) = prefixes.into_iter().find(|(size, _)| value.abs() >= *size).unwrap_or((1.0, ""));
    // Read again from its figures, so that none is there by rounding.
    let figures: f64 = format!("{:.5e}", value / size).parse().unwrap_or(value / size);
    format!("{figures} {prefix}{unit}")
}

/// Reads a relative error, above 0 and below 1.
///
/// # Errors
/// What to write instead.
pub fn relative_error(text: &str) -> Result<f64, String> {
    let error = positive(text)?;
    if error < 1.0 { Ok(error) } else { Err("a relative error lies between 0 and 1, as 1e-2".into()) }
}

/// Reads a finite number above zero.
///
/// # Errors
/// What to write instead.
pub fn positive(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|_| "write a number, as 1e-2".to_string())?;
    if number > 0.0 && number.is_finite() { Ok(number) } else { Err("must be finite and above zero".into()) }
}

/// Reads a whole number from zero on.
///
/// # Errors
/// What to write instead.
pub fn whole(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| format!("write a whole number from 0 to {}", u64::MAX))
}

/// Reads three numbers with commas between them, not all zero.
///
/// # Errors
/// What to write instead.
pub fn direction(text: &str) -> Result<[f64; 3], String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse::<f64>()).collect();
    match numbers.ok().and_then(|numbers| <[f64; 3]>::try_from(numbers).ok()) {
        Some(numbers) if numbers.iter().all(|x| x.is_finite()) && numbers != [0.0; 3] => Ok(numbers),
        _ => Err("write three numbers that are not all zero, as 1,0,0".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_were_chosen_have_the_figures_that_they_need() {
        for (value, text) in [
            (3.9999999999999996e-4, "4e-4"),
            (1.25e-5, "1.25e-5"),
            (-3e9, "-3e9"),
            (0.0, "0e0"),
            (2.0 / 3.0, "6.6666666666667e-1"),
        ] {
            assert_eq!(in_fewest_figures(value), text);
        }
        assert_eq!(
            [5.498e-3, 5.4e-3, 1e-2, 9.99].map(two_figures_down),
            ["5.4e-3", "5.4e-3", "1.0e-2", "9.9e0"]
        );
    }

    #[test]
    fn lengths_have_three_figures_and_the_unit_that_suits_them() {
        for (metres, text) in [
            (3.158, "3.16 m"),
            (123.4, "123 m"),
            (0.01188, "11.9 mm"),
            (0.56, "560 mm"),
            (1.4e-4, "140 µm"),
            (8.3e-6, "8.30 µm"),
            (5.8e-12, "5.8e-12 m"),
            (0.0, "0 m"),
        ] {
            assert_eq!(length(metres), text);
        }
    }

    #[test]
    fn a_direction_has_the_trend_and_plunge_of_a_map() {
        assert_eq!(trend_and_plunge([1.0, 0.0, -1.0]), "90.0°/45.0°");
        assert_eq!(trend_and_plunge([0.0, -2.0, 0.0]), "180.0°/0.0°");
        assert_eq!(trend_and_plunge([-1.0, 0.0, 1.0]), "270.0°/-45.0°");
        assert_eq!(trend_and_plunge([0.0, 0.0, -3.0]), "downward");
    }

    #[test]
    fn values_are_written_with_the_prefix_that_suits_them_and_without_rounding() {
        for (value, said) in [
            (1e6, "1 MPa"),
            (10.0, "10 Pa"),
            (9.999999999999999, "10 Pa"),
            (20e9, "20 GPa"),
            (1.25e5, "125 kPa"),
            (0.0, "0 Pa"),
        ] {
            assert_eq!(with_prefix(value, "Pa"), said);
        }
    }
}
