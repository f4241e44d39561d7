//! Quantities of a run, by the names that histories and `ndda certify --of` have for them.

use std::path::Path;

use ndda_io::results::Table;
use ndda_io::{OutputFolder, read};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::Model;
use crate::certify::quantities::{BLOCK, TIME};
use crate::run::recorder::{self, Extras};
use crate::safety::Bracket;
use crate::study::error::StudyError;
use crate::summary::Summary;

/// Name of the label.
pub const LABEL: &str = "label";
/// Name of the factor of safety: the middle of its bracket, whose ends are `safety_lower` and `safety_upper`.
pub const SAFETY: &str = "safety";
/// Largest factor at which blocks stand.
pub const SAFETY_LOWER: &str = "safety_lower";
/// Smallest factor at which they fail.
pub const SAFETY_UPPER: &str = "safety_upper";

/// Quantities of a monitor at the end of a run.
const OF_MONITOR: [&str; 2] = ["displacement_m", "velocity_m_s"];
/// Quantities of a block at the end of a run.
const OF_BLOCK: [&str; 8] = [
    "displacement_m",
    "displacement_x_m",
    "displacement_y_m",
    "displacement_z_m",
    "farthest_m",
    "largest_m",
    "rotation_deg",
    "velocity_m_s",
];
/// Names that are there whatever the scene.
pub const FIXED: [&str; 4] = [LABEL, SAFETY, SAFETY_LOWER, SAFETY_UPPER];
/// Most names that a question lists.
const MOST_NEAR: usize = 3;

/// Whether a name is one of the factor of safety or of the ends of its bracket, also where it is cut short; those of monitors and blocks have a point.
pub fn is_of_safety(name: &str) -> bool {
    name.starts_with(SAFETY) && !name.contains('.')
}

/// Quantities of one case.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Values {
    /// Label of the run; none where there was no run.
    pub label: Option<String>,
    /// Numbers by name.
    #[serde(serialize_with = "as_text", deserialize_with = "from_text")]
    pub numbers: Vec<(String, f64)>,
}

/// Numbers as text, since `serde_json` reads numbers with an error of the last digit.
fn as_text<S: Serializer>(numbers: &[(String, f64)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(numbers.iter().map(|(name, value)| (name, format!("{value:e}"))))
}

fn from_text<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<(String, f64)>, D::Error> {
    let texts = Vec::<(String, String)>::deserialize(deserializer)?;
    let number = |(name, text): (String, String)| Ok((name, text.parse().map_err(D::Error::custom)?));
    texts.into_iter().map(number).collect()
}

impl Values {
    /// A number by its full name, or the only one whose name begins so.
    pub fn number(&self, name: &str) -> Option<f64> {
        match self.named(name)[..] {
            [only] => Some(self.numbers[only].1),
            _ => None,
        }
    }

    /// Numbers that a name stands for: that of this very name, or all whose names, or those of whose blocks, begin so.
    pub fn named(&self, name: &str) -> Vec<usize> {
        let names = || self.numbers.iter().map(|(known, _)| known.as_str()).enumerate();
        if let Some((i, _)) = names().find(|(_, known)| *known == name) {
            return vec![i];
        }
        let begins = |known: &str| {
            known.starts_with(name) || known.strip_prefix(BLOCK).is_some_and(|block| block.starts_with(name))
        };
        names().filter(|(_, known)| begins(known)).map(|(i, _)| i).collect()
    }

    /// Adds a factor of safety.
    pub fn add_safety(&mut self, bracket: Bracket) {
        let middle = match (bracket.lower, bracket.upper) {
            (Some(lower), Some(upper)) => Some(0.5 * (lower + upper)),
            (one, other) => one.or(other),
        };
        self.numbers.extend(middle.map(|value| (SAFETY.to_string(), value)));
        self.add_ends(bracket);
    }

    /// Adds the ends of its bracket alone, of which a trial at one factor gives one.
    pub fn add_ends(&mut self, bracket: Bracket) {
        let ends = [(SAFETY_LOWER, bracket.lower), (SAFETY_UPPER, bracket.upper)];
        self.numbers.extend(ends.into_iter().filter_map(|(name, value)| Some((name.to_string(), value?))));
    }
}

/// Names of the numbers that a run of a scene has, before it is run: all are zero here.
pub fn of_model(model: &Model) -> Values {
    let blocks = model.simulation.blocks();
    let names = || model.monitors.iter().map(|monitor| monitor.name.as_str());
    let mut known: Vec<String> = Vec::new();
    for name in names().filter(|name| !name.starts_with(BLOCK)) {
        known.extend(OF_MONITOR.map(|quantity| format!("{name}.{quantity}")));
    }
    for name in &blocks.names {
        known.extend(OF_BLOCK.map(|quantity| format!("{BLOCK}{name}.{quantity}")));
    }
    if model.loaded.scene.reference.is_some() {
        known.extend(["error_end", "error_max"].map(String::from));
    }
    let held = recorder::held_blocks(&model.simulation);
    let extras = Extras::of(&model.loaded.scene);
    known.extend(recorder::columns(names(), &held, extras).into_iter().filter(|name| name != TIME));
    Values { label: None, numbers: known.into_iter().map(|name| (name, 0.0)).collect() }
}

/// Names for a message, quantities of blocks and reactions of supports for the first block that has them.
pub fn listed(numbers: &[(String, f64)]) -> String {
    let mut names: Vec<String> = FIXED.map(String::from).to_vec();
    let (mut shown, mut others) = (Vec::new(), false);
    for (name, _) in numbers {
        let (of, quantity) = name.rsplit_once('.').unwrap_or(("", name));
        let is_of_block = of.starts_with(BLOCK) || quantity.starts_with("reaction_");
        if names.contains(name) {
            continue;
        } else if is_of_block && shown.contains(&quantity) {
            others = true;
        } else {
            shown.push(quantity);
            names.push(name.clone());
        }
    }
    format!("{}{}", names.join(", "), if others { ", and those of the other blocks likewise" } else { "" })
}

/// Names that one of no quantity may have been meant for, as a question; empty where none is like it.
pub fn near(name: &str, numbers: &[(String, f64)]) -> String {
    let known: Vec<&str> = FIXED.into_iter().chain(numbers.iter().map(|(name, _)| name.as_str())).collect();
    let within: Vec<&str> =
        known.iter().copied().filter(|known| known.contains(name)).take(MOST_NEAR).collect();
    // Whole names, or the part behind a block or monitor.
    let quantity = |known: &&'_ str| known.rsplit('.').next().unwrap_or_default().to_string();
    let quantities: Vec<String> = known.iter().map(quantity).collect();
    let quantities: Vec<&str> = quantities.iter().map(String::as_str).collect();
    let like = read::nearest(name, &known).or_else(|| {
        let like = read::nearest(name, &quantities)?;
        known.iter().copied().find(|known| known.rsplit('.').next() == Some(like))
    });
    let found = if within.is_empty() { like.into_iter().collect() } else { within };
    match found.is_empty() {
        true => String::new(),
        false => format!(": did you mean `{}`?", found.join("`, `")),
    }
}

/// The quantities in the folder of a run: label, monitors, blocks, and the last row of the history.
///
/// # Errors
/// [`StudyError`] when its summary or history cannot be read.
pub fn of_run(run: &Path) -> Result<Values, StudyError> {
    let file = run.join(OutputFolder::SUMMARY);
    let broken = |reason: String| StudyError::Record { file: file.clone(), reason };
    let text = std::fs::read_to_string(&file).map_err(|error| broken(error.to_string()))?;
    let summary: Summary = serde_json::from_str(&text).map_err(|error| broken(error.to_string()))?;
    let mut values = of_summary(&summary);
    if let Some(history) = OutputFolder::history_in(run) {
        let history = Table::read(&history)?;
        let last = history.names.iter().zip(&history.columns).filter(|(name, _)| *name != TIME);
        values.numbers.extend(last.filter_map(|(name, column)| Some((name.clone(), *column.last()?))));
    }
    values.numbers.retain(|(_, value)| value.is_finite());
    Ok(values)
}

fn of_summary(summary: &Summary) -> Values {
    let size = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let mut numbers = Vec::new();
    for (name, end) in &summary.monitors.0 {
        let values = [size(end.displacement), size(end.velocity)];
        numbers.extend(OF_MONITOR.iter().zip(values).map(|(quantity, v)| (format!("{name}.{quantity}"), v)));
    }
    for (name, end) in &summary.blocks.0 {
        let [x, y, z] = end.motion.displacement_m;
        let gone_m = size(end.motion.displacement_m);
        let motion = &end.motion;
        let values =
            [gone_m, x, y, z, motion.farthest_m, motion.largest_m, motion.rotation_deg, size(end.velocity)];
        let named = OF_BLOCK.iter().zip(values);
        numbers.extend(named.map(|(quantity, v)| (format!("{BLOCK}{name}.{quantity}"), v)));
    }
    if let Some(reference) = &summary.reference {
        numbers.push(("error_end".into(), reference.error_end));
        numbers.push(("error_max".into(), reference.error_max));
    }
    Values { label: Some(summary.label.word.as_str().into()), numbers }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stand_for_one_number_or_for_all_that_begin_so() {
        let names =
            ["m.displacement_m", "block a.displacement_m", "block a.farthest_m", "block ab.farthest_m", "h"];
        let numbers = names.iter().zip(0..).map(|(name, i)| (name.to_string(), f64::from(i))).collect();
        let values = Values { label: None, numbers };
        assert_eq!(values.named("a"), [1, 2, 3]);
        assert_eq!(values.named("block a."), [1, 2]);
        assert_eq!(values.named("h"), [4]);
        assert_eq!(values.number("a.f"), Some(2.0));
        assert_eq!(values.number("a"), None);
    }

    #[test]
    fn names_are_listed_once_for_all_blocks_and_found_by_their_quantity() {
        let names = [
            "m.displacement_x_m",
            "block a.rotation_deg",
            "block b.rotation_deg",
            "h",
            "a.reaction_x_n",
            "b.reaction_x_n",
        ];
        let numbers: Vec<(String, f64)> = names.iter().map(|name| (name.to_string(), 0.0)).collect();
        let text = listed(&numbers);
        assert!(
            text.contains("m.displacement_x_m, block a.rotation_deg, h, a.reaction_x_n, and those"),
            "{text}"
        );
        assert_eq!(near("rotatoin", &numbers), ": did you mean `block a.rotation_deg`?");
        assert_eq!(near("zzz", &numbers), "");
    }

    #[test]
    fn numbers_keep_their_bits_in_records() {
        for value in [0.11151838014472873, 0.1 + 0.2, 5e-324, -1.7976931348623157e308] {
            let values = Values { label: None, numbers: vec![("x".into(), value)] };
            let text = serde_json::to_string(&values).unwrap();
            assert_eq!(serde_json::from_str::<Values>(&text).unwrap(), values);
        }
    }

    #[test]
    fn the_factor_of_safety_is_the_middle_of_its_bracket() {
        let mut values = Values::default();
        values.add_safety(Bracket { lower: Some(1.0), upper: Some(1.5) });
        assert_eq!((values.number("safety"), values.number("safety_upper")), (Some(1.25), Some(1.5)));
        let mut open = Values::default();
        open.add_safety(Bracket { lower: Some(100.0), upper: None });
        assert_eq!((open.number("safety"), open.number("safety_upper")), (Some(100.0), None));
    }
}
