//! Units as people write them after a number, `20 GPa`, and how a scene writes them.

use super::dimensions::{DIMENSIONS, Dimension, Unit, dimension_of};

/// Symbol, and the name of the unit. Symbols with several names are told apart by the field.
const SYMBOLS: [(&str, &str); 62] = [
    ("Pa", "Pascal"),
    ("kPa", "Kilopascal"),
    ("MPa", "Megapascal"),
    ("GPa", "Gigapascal"),
    ("N/m2", "Pascal"),
    ("kN/m2", "Kilopascal"),
    ("MN/m2", "Megapascal"),
    ("GN/m2", "Gigapascal"),
    ("N/mm2", "Megapascal"),
    ("Pa/m", "PascalPerMetre"),
    ("kPa/m", "KilopascalPerMetre"),
    ("MPa/m", "MegapascalPerMetre"),
    ("GPa/m", "GigapascalPerMetre"),
    ("N/m3", "PascalPerMetre"),
    ("kN/m3", "KilopascalPerMetre"),
    ("MN/m3", "MegapascalPerMetre"),
    ("GN/m3", "GigapascalPerMetre"),
    ("N/m", "NewtonPerMetre"),
    ("kN/m", "KilonewtonPerMetre"),
    ("MN/m", "MeganewtonPerMetre"),
    ("GN/m", "GiganewtonPerMetre"),
    ("N/m2", "NewtonPerSquareMetre"),
    ("MN/m2", "MeganewtonPerSquareMetre"),
    ("GN/m2", "GiganewtonPerSquareMetre"),
    ("N", "Newton"),
    ("kN", "Kilonewton"),
    ("MN", "Meganewton"),
    ("kg/m3", "KilogramPerCubicMetre"),
    ("t/m3", "TonnePerCubicMetre"),
    ("g/cm3", "GramPerCubicCentimetre"),
    ("J/m2", "JoulePerSquareMetre"),
    ("kJ/m2", "KilojoulePerSquareMetre"),
    ("m", "Metre"),
    ("km", "Kilometre"),
    ("dm", "Decimetre"),
    ("cm", "Centimetre"),
    ("mm", "Millimetre"),
    ("um", "Micrometre"),
    ("m2", "SquareMetre"),
    ("cm2", "SquareCentimetre"),
    ("mm2", "SquareMillimetre"),
    ("m3", "CubicMetre"),
    ("dm3", "CubicDecimetre"),
    ("cm3", "CubicCentimetre"),
    ("m/s", "MetrePerSecond"),
    ("mm/s", "MillimetrePerSecond"),
    ("km/h", "KilometrePerHour"),
    ("m/s2", "MetrePerSecondSquared"),
    ("g", "StandardGravity"),
    ("rad/s", "RadiansPerSecond"),
    ("deg/s", "DegreesPerSecond"),
    ("rpm", "RevolutionsPerMinute"),
    ("/s", "PerSecond"),
    ("1/s", "PerSecond"),
    ("1/min", "PerMinute"),
    ("deg", "Degrees"),
    ("rad", "Radians"),
    ("s", "Second"),
    ("ms", "Millisecond"),
    ("us", "Microsecond"),
    ("min", "Minute"),
    ("h", "Hour"),
];

/// What is wrong with a unit behind a number.
pub(crate) const NOT_BEHIND: &str = "the unit cannot stand after the number";

/// How a scene writes a number of a field that has a unit behind it.
pub(crate) fn advice(number: &str, symbol: &str, field: &str) -> String {
    let Some(dimension) = dimension_of(field) else {
        return "write a plain number: this one has no unit".into();
    };
    let own = dimension.units.iter().find(|unit| unit.is_own());
    match unit(symbol, dimension) {
        Some(unit) if unit.is_own() => {
            format!("`{field}` is in this unit: write {number}, or {}({number})", unit.name)
        }
        Some(unit) => {
            let plain = unit.in_field(number).map_or(String::new(), |plain| format!(", or {plain}"));
            format!("write {}({number}){plain}", unit.name)
        }
        None => {
            let example = own.map_or(String::new(), |own| format!(", such as {}({number})", own.name));
            format!("{}{example}", super::units_of(dimension))
        }
    }
}

/// The unit of a dimension with this symbol: as it is written, or else whatever its capitals.
fn unit(symbol: &str, dimension: &Dimension) -> Option<&'static Unit> {
    let symbol = plain(symbol);
    let of = |is: &dyn Fn(&str) -> bool| {
        let names = SYMBOLS.iter().filter(|(known, _)| is(known)).map(|(_, name)| *name);
        names.filter_map(|name| dimension.unit(name)).next()
    };
    of(&|known| known == symbol)
        .or_else(|| of(&|known| known.eq_ignore_ascii_case(&symbol)))
        .or_else(|| dimension.units.iter().find(|unit| unit.name.eq_ignore_ascii_case(&symbol)))
}

/// A symbol in letters, figures and strokes.
fn plain(symbol: &str) -> String {
    let blank = |c: &char| !c.is_whitespace() && !"^*()".contains(*c);
    let letter = |c: char| match c {
        '²' => '2',
        '³' => '3',
        'µ' | 'μ' => 'u',
        other => other,
    };
    match symbol.trim() {
        "°" => "deg".into(),
        other => other.chars().filter(blank).map(letter).collect(),
    }
}

/// Whether a word may be a unit after a number.
pub(crate) fn may_be_unit(word: &str) -> bool {
    let starts = word.starts_with(|c: char| c.is_alphabetic() || "°/".contains(c));
    starts && DIMENSIONS.iter().any(|dimension| unit(word, dimension).is_some())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_is_known_by_a_symbol() {
        for dimension in &DIMENSIONS {
            for unit in dimension.units {
                let symbol = SYMBOLS.iter().find(|(_, name)| *name == unit.name);
                let (symbol, _) = symbol.unwrap_or_else(|| panic!("{} has no symbol", unit.name));
                let said = advice("20", symbol, &format!("some{}", dimension.suffix));
                assert!(said.contains(&format!("{}(20)", unit.name)), "{symbol}: {said}");
            }
        }
        for (symbol, name) in SYMBOLS {
            assert!(DIMENSIONS.iter().any(|d| d.unit(name).is_some()), "{symbol}: there is no unit {name}");
        }
    }

    #[test]
    fn a_unit_is_written_around_the_number_or_turned_into_that_of_the_field() {
        for (number, symbol, field, said) in [
            ("20", "GPa", "young_pa", "write Gigapascal(20), or 2e10"),
            ("20", "gpa", "young_pa", "write Gigapascal(20), or 2e10"),
            ("5", "MN/m²", "penalty_pa", "write Megapascal(5), or 5e6"),
            ("5", "MN/m²", "shear_n_m2", "write MeganewtonPerSquareMetre(5), or 5e6"),
            ("2.65", "g/cm^3", "density_kg_m3", "write GramPerCubicCentimetre(2.65), or 2.65e3"),
            ("12", "m", "height_m", "`height_m` is in this unit: write 12, or Metre(12)"),
            ("30", "°", "friction_deg", "`friction_deg` is in this unit: write 30, or Degrees(30)"),
            ("3", "µm", "gap_m", "write Micrometre(3), or 3e-6"),
            ("3", "GPa", "poisson", "write a plain number: this one has no unit"),
        ] {
            assert_eq!(advice(number, symbol, field), said);
        }
        assert!(advice("3", "psi", "young_pa").contains("Megapascal"));
    }
}
