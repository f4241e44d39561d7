//! Arguments of the commands that run a scene over and over.

use std::path::PathBuf;

use clap::Args;
use ndda::numbers::{positive, relative_error};

use super::SceneArgs;

/// Arguments of `ndda certify`.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  ndda certify scenes/bounce.ron\n  ndda certify scenes/bounce.ron --of momentum,cube --jobs 2\n  \
                  ndda certify scenes/studies/base/stack.ron --mesh --penalty\n  ndda report out/bounce_certified"
)]
pub struct CertifyArgs {
    /// The scene.
    #[command(flatten)]
    pub input: SceneArgs,
    /// More quantities: columns of history.csv or blocks, by name or its beginning.
    #[arg(long, value_delimiter = ',', value_name = "NAME")]
    pub of: Vec<String>,
    /// Estimate the error of the mesh as well, by N runs, each with cells half as large as before.
    #[arg(long, value_name = "N", num_args = 0..=1, default_value_t = 0, default_missing_value = "1", value_parser = clap::value_parser!(u32).range(0..=2))]
    pub mesh: u32,
    /// Estimate the error of the penalty as well, by N runs, each with contact four times as stiff as before.
    #[arg(long, value_name = "N", num_args = 0..=1, default_value_t = 0, default_missing_value = "1", value_parser = clap::value_parser!(u32).range(0..=2))]
    pub penalty: u32,
    /// Where and how.
    #[command(flatten)]
    pub how: TrialHow,
}

/// Arguments of `ndda tune`.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  ndda tune scenes/bounce.ron --error 1e-2\n  ndda tune scenes/column_phi0.ron --error 1e-3 --of \
                  largest_x --set time.end_s=0.1\n  ndda tune scenes/studies/base/cantilever.ron --error 0.1 --mesh"
)]
pub struct TuneArgs {
    /// The scene.
    #[command(flatten)]
    pub input: SceneArgs,
    /// The largest relative error that is allowed.
    #[arg(long, value_name = "ERROR", value_parser = relative_error)]
    pub error: f64,
    /// Results that have to be right: columns of history.csv or blocks, by name or its beginning [default: what the scene's closed
    /// form judges, else the displacements of the monitors, or of all blocks where there are none].
    #[arg(long, value_delimiter = ',', value_name = "NAME")]
    pub of: Vec<String>,
    /// Try coarser and finer meshes, too.
    #[arg(long)]
    pub mesh: bool,
    /// Time limit for all runs together [s].
    #[arg(long, value_name = "SECONDS", default_value_t = 600.0, value_parser = positive)]
    pub budget_s: f64,
    /// Where and how.
    #[command(flatten)]
    pub how: TrialHow,
}

/// How a scene is run over and over.
#[derive(Debug, Args)]
pub struct TrialHow {
    /// Output folder [default: out/ and the name of the scene with _certified or _tuned].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Runs that go side by side; with more than one, measured times are less reliable.
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: u16,
    /// Threads of each run.
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: u16,
    /// Print nothing but errors and results.
    #[arg(long, short)]
    pub quiet: bool,
    /// Print the results as JSON.
    #[arg(long)]
    pub json: bool,
}
