//! Arguments of `ndda safety`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use ndda::numbers::{direction, relative_error};

use super::SceneArgs;

/// Arguments of `ndda safety`.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  ndda safety scenes/safety/plane_slide.ron\n  ndda safety scenes/safety/wedge.ron --error 5e-3\n  ndda safety \
                  scenes/safety/toppling_column.ron --by gravity\n\nThe same command goes on where it was interrupted."
)]
pub struct SafetyArgs {
    /// The scene.
    #[command(flatten)]
    pub input: SceneArgs,
    /// Quantity that is changed until blocks fail.
    #[arg(long, value_enum, default_value_t = SafetyBy::Strength)]
    pub by: SafetyBy,
    /// With `--by gravity`: direction towards which gravity is tilted, as x,y,z [default: straight down the steepest way that blocks can slide].
    #[arg(long, value_name = "X,Y,Z", value_parser = direction, allow_hyphen_values = true)]
    pub towards: Option<[f64; 3]>,
    /// Largest relative difference between the two factors of the answer: the largest at which blocks stand, the smallest at which they fail.
    #[arg(long, value_name = "ERROR", default_value_t = 0.01, value_parser = relative_error)]
    pub error: f64,
    /// Output folder [default: out/ and the name of the scene with _safety].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Begin anew, without the trials of an earlier run of this command.
    #[arg(long)]
    pub force: bool,
    /// Number of threads, which run trials side by side; the answer does not depend on it [default: all cores].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Print nothing but errors and the answer.
    #[arg(long, short)]
    pub quiet: bool,
    /// Print the answer as JSON.
    #[arg(long)]
    pub json: bool,
}

/// The quantity that a factor of safety scales.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SafetyBy {
    /// Divide tan φ, cohesion and tensile strength of all joints.
    Strength,
    /// Tilt gravity: finds toppling, which a weaker joint may hide.
    Gravity,
    /// Multiply forces and tractions.
    Load,
}
