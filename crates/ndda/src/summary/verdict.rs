//! Numbers against their limits.

use serde::{Deserialize, Serialize};

/// A number judged against its limit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// The number. Left out when it is not computed yet.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// Its limit. Left out when the number is only shown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit: Option<f64>,
    /// The judgement.
    pub verdict: Judgement,
}

impl Verdict {
    /// Whether something was checked and passed; a number that is only shown was not.
    pub fn is_passed(&self) -> bool {
        self.verdict == Judgement::Pass && (self.limit.is_some() || self.value.is_none())
    }
}

/// How a number compares with its limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Judgement {
    /// Within the limit.
    #[serde(rename = "pass")]
    Pass,
    /// Beyond the limit of a warning.
    #[serde(rename = "warn")]
    Warn,
    /// Beyond the limit: the result is not to be used.
    #[serde(rename = "fail")]
    Fail,
    /// This version does not compute it.
    #[serde(rename = "not yet")]
    NotYet,
}
