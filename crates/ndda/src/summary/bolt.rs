//! Bolts at the end of a run.

use serde::{Deserialize, Serialize};

/// State of a bolt at the end.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BoltEnd {
    /// Largest tension of its pieces at the end, negative in compression \[N\].
    pub axial_n: f64,
    /// Tension over the force at which the steel yields; 0 where it never does.
    pub utilisation: f64,
    /// Largest shear force at a joint \[N\].
    pub shear_n: f64,
    /// Its worst state: elastic, debonded, plate yielding, dowel yielding, yielding (its steel) or broken.
    pub state: String,
    /// How far its plate has yielded \[m\].
    #[serde(default)]
    pub plate_yielded_m: f64,
    /// How far its dowels have yielded in all \[m\].
    #[serde(default)]
    pub dowel_yielded_m: f64,
    /// Part of the bonded length whose grout has slipped.
    pub debonded: f64,
}
