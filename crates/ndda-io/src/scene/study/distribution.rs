//! Distributions of what varies: `Normal(30, 2)`.

use serde::{Deserialize, Serialize};

use crate::scene::suggest::nearest;
use crate::scene::units::DIMENSIONS;

/// A distribution of one number of a scene, in the unit of its field.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Distribution {
    /// Mean and standard deviation.
    Normal(f64, f64),
    /// Mean and standard deviation of the number itself, not of its logarithm.
    LogNormal(f64, f64),
    /// Least and largest value.
    Uniform(f64, f64),
    /// Least, most likely and largest value.
    Triangular(f64, f64, f64),
    /// Concentration κ of directions about their mean (Fisher 1953). The number is the angle between the two, in degrees.
    Fisher(f64),
}

/// How each distribution is written.
const FORMS: [&str; 5] = [
    "Normal(mean, deviation)",
    "LogNormal(mean, deviation)",
    "Uniform(least, largest)",
    "Triangular(least, likeliest, largest)",
    "Fisher(concentration)",
];

/// The part before the brackets.
fn name_of(text: &str) -> &str {
    text.split('(').next().unwrap_or_default().trim()
}

impl Distribution {
    /// A distribution as it is written; none if the text is something else.
    ///
    /// # Errors
    /// A text that begins with the name of a distribution, and has wrong parameters.
    pub fn parse(text: &str) -> Option<Result<Self, String>> {
        let form = FORMS.iter().find(|form| name_of(form) == name_of(text))?;
        let read = ron::from_str::<Self>(text)
            .map_err(|_| format!("`{text}`: write {form}, with numbers in place of the words"));
        Some(read.and_then(|read| read.check().map(|()| read)))
    }

    /// How the distribution that a text names is written.
    pub(super) fn form_of(text: &str) -> Option<&'static str> {
        FORMS.into_iter().find(|form| name_of(form) == name_of(text))
    }

    /// Why a text that looks like a distribution is none: numbers in the brackets of a name that is no unit.
    pub(super) fn misspelt(text: &str) -> Option<String> {
        let (name, inside) = text.strip_suffix(')')?.split_once('(')?;
        let name = name.trim();
        let numbers = inside.split(',').map(|part| part.trim().parse::<f64>());
        let count = numbers.collect::<Result<Vec<f64>, _>>().ok()?.len();
        if name.is_empty() || DIMENSIONS.iter().any(|dimension| dimension.unit(name).is_some()) {
            return None;
        }
        // One number may have a unit that is misspelt.
        let names = FORMS.map(name_of);
        match nearest(name, &names) {
            Some(near) => Some(format!("`{name}` is not a distribution: did you mean `{near}`?")),
            None if count > 1 => {
                Some(format!("`{name}` is not a distribution; choose one of {}", names.join(", ")))
            }
            None => None,
        }
    }

    /// Whether its parameters make sense.
    ///
    /// # Errors
    /// The one that does not, and what to write.
    pub fn check(&self) -> Result<(), String> {
        let numbers = match *self {
            Self::Normal(a, b) | Self::LogNormal(a, b) | Self::Uniform(a, b) => [a, b, b],
            Self::Triangular(a, b, c) => [a, b, c],
            Self::Fisher(a) => [a, a, a],
        };
        let refuse = |reason: &str| Err(format!("{self:?}: {reason}"));
        if numbers.iter().any(|number| !number.is_finite()) {
            return refuse("its numbers must be finite");
        }
        match *self {
            Self::Normal(_, deviation) | Self::LogNormal(_, deviation) if deviation <= 0.0 => {
                refuse("the standard deviation must be above 0")
            }
            Self::LogNormal(mean, _) if mean <= 0.0 => refuse("the mean must be above 0"),
            Self::Uniform(least, largest) if least >= largest => {
                refuse("the least value comes first, and is less than the largest")
            }
            Self::Triangular(least, likeliest, largest)
                if !(least <= likeliest && likeliest <= largest && least < largest) =>
            {
                refuse("write the least, the likeliest and the largest value in this order")
            }
            Self::Fisher(concentration) if concentration <= 0.0 => {
                refuse("the concentration must be above 0")
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distributions_are_read_and_wrong_ones_refused() {
        assert_eq!(Distribution::parse("Normal(30, 2)"), Some(Ok(Distribution::Normal(30.0, 2.0))));
        assert_eq!(
            Distribution::parse("Triangular(1,1,4)"),
            Some(Ok(Distribution::Triangular(1.0, 1.0, 4.0)))
        );
        assert_eq!(Distribution::parse("Fisher(300)"), Some(Ok(Distribution::Fisher(300.0))));
        assert_eq!(Distribution::parse("Newmark()"), None);
        for (text, word) in [
            ("Normal(30)", "Normal(mean"),
            ("Normal(30, -2)", "above 0"),
            ("LogNormal(-1, 2)", "mean must be above 0"),
            ("Uniform(2, 1)", "least value comes first"),
            ("Triangular(1, 5, 4)", "order"),
            ("Normal(inf, 1)", "finite"),
            ("Fisher(0)", "concentration must be above 0"),
            ("Fisher(1, 2)", "Fisher(concentration)"),
        ] {
            let said = Distribution::parse(text).expect("a distribution").unwrap_err();
            assert!(said.contains(word), "{said}");
        }
    }
}
