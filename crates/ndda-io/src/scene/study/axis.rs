//! Axes of a study: the values of a scene that vary.

use std::collections::BTreeMap;

use ron::value::RawValue;
use serde::Deserialize;

use super::distribution::Distribution;
use crate::scene::locate;

/// Values as text, by their paths in the scene.
pub(crate) type Values = BTreeMap<String, Box<RawValue>>;

/// Something that varies.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Axis {
    /// One value of the scene.
    Vary {
        /// Its path, as in `--set`; the last part of it names the axis.
        path: String,
        /// Its values.
        values: Vec<Box<RawValue>>,
        /// Name of the axis. Default: the last part of the path.
        #[serde(default)]
        name: Option<String>,
    },
    /// One value of the scene, drawn from a distribution.
    Random {
        /// Its path, as in `--set`; the last part of it names the axis.
        path: String,
        /// Its distribution.
        distribution: Distribution,
        /// Name of the axis. Default: the last part of the path.
        #[serde(default)]
        name: Option<String>,
    },
    /// Several values that change together, or one whose choices need labels.
    Choose {
        /// Name of the axis.
        name: String,
        /// The choices.
        choices: Vec<Choice>,
    },
}

/// One choice of an axis.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Choice {
    /// Name in tables and pictures.
    pub label: String,
    /// Values by path.
    pub set: Values,
}

impl Axis {
    /// Name in tables.
    pub fn name(&self) -> &str {
        match self {
            Self::Vary { name: Some(name), .. } | Self::Random { name: Some(name), .. } => name,
            Self::Vary { path, .. } | Self::Random { path, .. } => {
                locate::segments(path).last().copied().unwrap_or(path)
            }
            Self::Choose { name, .. } => name,
        }
    }

    /// Label and overrides of each choice; none of a distribution.
    pub fn choices(&self) -> Vec<(String, Vec<String>)> {
        match self {
            Self::Random { .. } => Vec::new(),
            Self::Vary { path, values, .. } => {
                let texts = values.iter().map(|value| value.get_ron().trim());
                texts.map(|text| (text.to_string(), vec![format!("{path}={text}")])).collect()
            }
            Self::Choose { choices, .. } => {
                choices.iter().map(|choice| (choice.label.clone(), as_overrides(&choice.set))).collect()
            }
        }
    }

    /// Whether it varies the value at a path.
    pub(crate) fn varies(&self, path: &str) -> bool {
        match self {
            Self::Vary { path: own, .. } | Self::Random { path: own, .. } => own == path,
            Self::Choose { choices, .. } => choices.iter().any(|choice| choice.set.contains_key(path)),
        }
    }
}

/// Values as `--set` takes them; a path comes before those below it.
pub fn as_overrides(values: &Values) -> Vec<String> {
    values.iter().map(|(path, value)| format!("{path}={}", value.get_ron().trim())).collect()
}
