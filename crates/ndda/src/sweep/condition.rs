//! `safety < 1`: a condition on a quantity.

use super::quantity::{LABEL, SAFETY, SAFETY_LOWER, SAFETY_UPPER, Values};
use crate::study::error::StudyError;

/// A condition on a quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// Name of the quantity.
    pub quantity: String,
    comparison: &'static str,
    limit: Limit,
}

#[derive(Clone, Debug, PartialEq)]
enum Limit {
    Number(f64),
    Label(String),
}

/// Comparisons; one that begins like another comes before it.
const COMPARISONS: [&str; 6] = ["<=", ">=", "==", "!=", "<", ">"];

impl Condition {
    /// Reads a condition.
    ///
    /// # Errors
    /// [`StudyError::Condition`] of a text that is none.
    pub fn parse(text: &str) -> Result<Self, StudyError> {
        let refuse = |reason| StudyError::Condition { condition: text.to_string(), reason };
        let at = text.find(['<', '>', '=', '!']).ok_or_else(|| refuse("it compares nothing"))?;
        let comparison = COMPARISONS.into_iter().find(|comparison| text[at..].starts_with(comparison));
        let comparison = comparison.ok_or_else(|| refuse("the comparisons are < <= > >= == !="))?;
        let (quantity, limit) = (text[..at].trim(), text[at + comparison.len()..].trim());
        if quantity.is_empty() {
            return Err(refuse("it names no quantity"));
        }
        let limit = if quantity == LABEL {
            if !["==", "!="].contains(&comparison) {
                return Err(refuse("a label is compared by == or !="));
            }
            Limit::Label(limit.trim_matches('"').to_string())
        } else {
            let number = limit.parse::<f64>().ok().filter(|number| number.is_finite());
            Limit::Number(number.ok_or_else(|| refuse("what it compares with is not a number"))?)
        };
        Ok(Self { quantity: quantity.to_string(), comparison, limit })
    }

    /// The factor at which a trial decides it: the limit of a condition on the factor of safety.
    pub fn factor(&self) -> Option<f64> {
        match self.limit {
            Limit::Number(limit) if self.quantity == SAFETY && limit > 0.0 => {
                ["<", "<=", ">", ">="].contains(&self.comparison).then_some(limit)
            }
            _ => None,
        }
    }

    /// Whether it holds; none where the quantity has no value.
    pub fn holds(&self, values: &Values) -> Option<bool> {
        match &self.limit {
            Limit::Label(word) => {
                let is = values.label.as_deref()? == word;
                Some(is == (self.comparison == "=="))
            }
            Limit::Number(limit) => {
                let value = self.value(values)?;
                Some(match self.comparison {
                    "<" => value < *limit,
                    "<=" => value <= *limit,
                    ">" => value > *limit,
                    ">=" => value >= *limit,
                    "==" => value == *limit,
                    _ => value != *limit,
                })
            }
        }
    }

    /// Value of the quantity; of a factor of safety, or an end of its bracket, where one end alone is known, infinitely far beyond that.
    fn value(&self, values: &Values) -> Option<f64> {
        let knows = |name: &str| values.numbers.iter().any(|(known, _)| known == name);
        let is_of_safety = [SAFETY, SAFETY_LOWER, SAFETY_UPPER].contains(&self.quantity.as_str());
        match (knows(SAFETY_LOWER), knows(SAFETY_UPPER)) {
            _ if !is_of_safety || knows(&self.quantity) => values.number(&self.quantity),
            (true, _) => Some(f64::INFINITY),
            (false, true) => Some(f64::NEG_INFINITY),
            (false, false) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions_compare_quantities_with_numbers_and_labels() {
        let values = Values {
            label: Some("inaccurate".into()),
            numbers: vec![("block a.displacement_m".into(), 0.1), ("safety".into(), 1.2)],
        };
        for (text, expected) in [
            ("safety < 1", Some(false)),
            ("safety>=1.2", Some(true)),
            ("block a.displacement_m > 1e-2", Some(true)),
            ("safety != 1.2", Some(false)),
            ("label == inaccurate", Some(true)),
            ("label != \"inaccurate\"", Some(false)),
            ("kinetic_j > 0", None),
        ] {
            assert_eq!(Condition::parse(text).unwrap().holds(&values), expected, "{text}");
        }
        let trial = |name: &str| Values { label: None, numbers: vec![(name.into(), 1.0)] };
        let condition = Condition::parse("safety < 1").unwrap();
        assert_eq!(condition.holds(&trial("safety_lower")), Some(false));
        assert_eq!(condition.holds(&trial("safety_upper")), Some(true));
        // It stands at every factor that is tried, or at none.
        assert_eq!(
            Condition::parse("safety_upper < 1.5").unwrap().holds(&trial("safety_lower")),
            Some(false)
        );
        assert_eq!(Condition::parse("safety_lower < 1.5").unwrap().holds(&trial("safety_upper")), Some(true));
        assert_eq!((condition.factor(), Condition::parse("h < 1").unwrap().factor()), (Some(1.0), None));
        for text in ["safety", "< 1", "safety < x", "safety =< 1", "label < 1", "safety < inf"] {
            let said = Condition::parse(text).unwrap_err().to_string();
            assert!(said.contains("safety < 1"), "{said}");
        }
    }
}
