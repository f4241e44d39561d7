//! What `ndda check` finds in a scene without errors.

use std::fmt;
use std::path::Path;

use ndda_io::read::Chosen;
use serde::Serialize;

use crate::body_counts::BodyCounts;
use crate::bolt_report::BoltReports;
use crate::build::RockReport;
use crate::forecast::cost::Guess;
use crate::forecast::step::Advice;
use crate::numbers::counted;
use crate::rocking::Rocking;

/// Findings in a scene without errors.
#[derive(Serialize)]
pub struct Checked<'a> {
    /// Exit code of the command.
    pub exit_code: u8,
    /// The scene.
    pub scene: &'a Path,
    /// Warnings.
    pub warnings: usize,
    /// Blocks.
    pub blocks: usize,
    /// Their nodes.
    pub nodes: usize,
    /// Their tetrahedra.
    pub tets: usize,
    /// How they may move.
    #[serde(flatten)]
    pub bodies: BodyCounts,
    /// Steps of the run.
    pub steps: u64,
    /// Longest step that contact allows [s].
    pub advised_step_s: Option<f64>,
    /// Why.
    pub contact_stability: Option<&'a Advice>,
    /// Settings that were chosen.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    pub chosen: &'a [Chosen],
    /// What its records are, and what is done with them.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    pub records: &'a [String],
    /// From which acceleration on a block rocks on a shaken base, and what penetration takes of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rocking: Option<Rocking>,
    /// What rock was cut into.
    pub rock: &'a [RockReport],
    /// Where bolts are bonded.
    #[serde(skip_serializing_if = "BoltReports::is_empty")]
    pub bolts: BoltReports,
    /// What a run will take.
    pub guess: Guess,
}

impl fmt::Display for Checked<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { blocks, bodies, nodes, tets, steps, warnings, .. } = self;
        let warnings = counted(*warnings, "warning", "warnings");
        writeln!(f, "{}: no errors, {warnings}", self.scene.display())?;
        let blocks = counted(*blocks, "block", "blocks");
        let tets = counted(*tets, "tetrahedron", "tetrahedra");
        write!(
            f,
            "{blocks} ({bodies}), {nodes} nodes, {tets}; {}",
            counted(*steps as usize, "step", "steps")
        )?;
        self.rock.iter().try_for_each(|rock| write!(f, "\n{rock}"))?;
        write!(f, "{}", self.bolts)?;
        self.records.iter().try_for_each(|record| write!(f, "\nrecord {record}"))?;
        // Too large a part has been warned of.
        self.rocking.iter().filter(|of| !of.is_doubtful()).try_for_each(|of| write!(f, "\n{of}"))?;
        self.chosen.iter().try_for_each(|chosen| write!(f, "\n{chosen}"))?;
        write!(f, "\n{}", self.guess)
    }
}
