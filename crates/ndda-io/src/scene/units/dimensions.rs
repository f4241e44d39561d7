//! Kinds of quantities, and the units in which each may be written.

/// A unit that a value may be written in: one of it is `factor` · 10^`decimals` of the field's own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Unit {
    /// Its name.
    pub name: &'static str,
    decimals: i32,
    factor: f64,
}

/// A kind of quantity, known by the end of a field's name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Dimension {
    /// End of the field's name.
    pub suffix: &'static str,
    /// Name of the unit.
    pub name: &'static str,
    /// Units of it.
    pub units: &'static [Unit],
}

const fn decimal(name: &'static str, decimals: i32) -> Unit {
    Unit { name, decimals, factor: 1.0 }
}

const fn times(name: &'static str, factor: f64) -> Unit {
    Unit { name, decimals: 0, factor }
}

const fn dimension(suffix: &'static str, name: &'static str, units: &'static [Unit]) -> Dimension {
    Dimension { suffix, name, units }
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Dimensions; an end that is part of another comes after it.
pub(crate) const DIMENSIONS: [Dimension; 16] = [
    dimension(
        "_kg_m3",
        "a density",
        &[
            decimal("KilogramPerCubicMetre", 0),
            decimal("TonnePerCubicMetre", 3),
            decimal("GramPerCubicCentimetre", 3),
        ],
    ),
    dimension(
        "_j_m2",
        "an energy per area",
        &[decimal("JoulePerSquareMetre", 0), decimal("KilojoulePerSquareMetre", 3)],
    ),
    dimension(
        "_n_m2",
        "a stiffness per length",
        &[
            decimal("NewtonPerSquareMetre", 0),
            decimal("MeganewtonPerSquareMetre", 6),
            decimal("GiganewtonPerSquareMetre", 9),
        ],
    ),
    dimension(
        "_m2",
        "an area",
        &[decimal("SquareMetre", 0), decimal("SquareCentimetre", -4), decimal("SquareMillimetre", -6)],
    ),
    dimension(
        "_m_s2",
        "an acceleration",
        &[decimal("MetrePerSecondSquared", 0), times("StandardGravity", 9.80665)],
    ),
    dimension(
        "_rad_s",
        "a rate of rotation",
        &[
            decimal("RadiansPerSecond", 0),
            times("DegreesPerSecond", DEGREE),
            times("RevolutionsPerMinute", 6.0 * DEGREE),
        ],
    ),
    dimension("_per_s", "a rate", &[decimal("PerSecond", 0), times("PerMinute", 1.0 / 60.0)]),
    dimension(
        "_m_s",
        "a velocity",
        &[
            decimal("MetrePerSecond", 0),
            decimal("MillimetrePerSecond", -3),
            times("KilometrePerHour", 1.0 / 3.6),
        ],
    ),
    dimension(
        "_pa_m",
        "a pressure per length",
        &[
            decimal("PascalPerMetre", 0),
            decimal("KilopascalPerMetre", 3),
            decimal("MegapascalPerMetre", 6),
            decimal("GigapascalPerMetre", 9),
        ],
    ),
    dimension(
        "_n_m",
        "a stiffness",
        &[
            decimal("NewtonPerMetre", 0),
            decimal("KilonewtonPerMetre", 3),
            decimal("MeganewtonPerMetre", 6),
            decimal("GiganewtonPerMetre", 9),
        ],
    ),
    dimension(
        "_m3",
        "a volume",
        &[decimal("CubicMetre", 0), decimal("CubicDecimetre", -3), decimal("CubicCentimetre", -6)],
    ),
    dimension("_deg", "an angle", &[decimal("Degrees", 0), times("Radians", 1.0 / DEGREE)]),
    dimension(
        "_pa",
        "a pressure",
        &[decimal("Pascal", 0), decimal("Kilopascal", 3), decimal("Megapascal", 6), decimal("Gigapascal", 9)],
    ),
    dimension(
        "_m",
        "a length",
        &[
            decimal("Metre", 0),
            decimal("Kilometre", 3),
            decimal("Decimetre", -1),
            decimal("Centimetre", -2),
            decimal("Millimetre", -3),
            decimal("Micrometre", -6),
        ],
    ),
    dimension("_n", "a force", &[decimal("Newton", 0), decimal("Kilonewton", 3), decimal("Meganewton", 6)]),
    dimension(
        "_s",
        "a time",
        &[
            decimal("Second", 0),
            decimal("Millisecond", -3),
            decimal("Microsecond", -6),
            times("Minute", 60.0),
            times("Hour", 3600.0),
        ],
    ),
];

/// The dimension of a field, by its name.
pub(crate) fn dimension_of(field: &str) -> Option<&'static Dimension> {
    DIMENSIONS.iter().find(|d| field.ends_with(d.suffix))
}

impl Dimension {
    /// Names of its units.
    pub(crate) fn unit_names(&self) -> Vec<&'static str> {
        self.units.iter().map(|unit| unit.name).collect()
    }

    /// The unit of this name.
    pub(crate) fn unit(&self, name: &str) -> Option<&'static Unit> {
        self.units.iter().find(|unit| unit.name == name)
    }
}

impl Unit {
    /// Whether a number in it is a number in the field's own unit.
    pub(super) fn is_own(&self) -> bool {
        self.decimals == 0 && self.factor == 1.0
    }

    /// A number in this unit, as text in the field's own. Powers of ten move the decimal point, so that
    /// `Gigapascal(20.7)` has the bits of 20.7e9.
    pub(super) fn in_field(&self, number: &str) -> Option<String> {
        let digits = number.replace('_', "");
        let (mantissa, exponent) = digits.split_once(['e', 'E']).unwrap_or((&digits, "0"));
        let exponent = exponent.parse::<i32>().ok()?.checked_add(self.decimals)?;
        let value = format!("{mantissa}e{exponent}").parse::<f64>().ok()? * self.factor;
        value.is_finite().then(|| format!("{value:e}"))
    }
}
