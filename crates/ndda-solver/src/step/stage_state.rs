//! What stages of construction keep from step to step.

use ndda_mesh::Vec3;
use serde::{Deserialize, Serialize};

use crate::step::release::Release;

/// What stages keep of a simulation.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StageState {
    /// Which blocks are absent.
    pub(crate) absent: Vec<bool>,
    /// Forces that act on in place of what was taken away, until they have ramped down.
    pub(crate) release: Option<Release>,
    /// Where nodes were when displacements were last set to zero [m]; empty while they never were.
    pub(crate) counted_from: Vec<Vec3>,
}
