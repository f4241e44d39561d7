//! What a person can type.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};

/// Rock blocks that slide, topple, collide and fall: 3D discontinuous deformation analysis with contact potential.
#[derive(Debug, Parser)]
#[command(
    version,
    after_help = "Examples:\n  ndda run scenes/sliding_45.ron\n  ndda run scenes/sliding_45.ron --set time.step_s=1e-3 \
                  --out out/coarse\n  ndda check scenes/sliding_45.ron\n\nExit codes: 0 done · 1 ran, a criterion \
                  failed · 2 usage · 3 bad input · 4 numerical stop · 5 input/output · 6 resources · 130 interrupted"
)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub verb: Verb,
}

/// The verbs of the command line.
#[derive(Debug, Subcommand)]
pub enum Verb {
    /// Run a scene and write its results.
    ///
    /// Writes summary.json (numbers and verdicts), history.csv (monitors, energies, momentum over time) and
    /// fields.pvd with its frames (open it in ParaView).
    Run(RunArgs),
    /// Go on with a run that was interrupted, from its last checkpoint: the same bits as if it never had been.
    Resume(ResumeArgs),
    /// Read and check a scene without running it: all errors at once, each with its place.
    Check(CheckArgs),
}

/// Arguments of `ndda run`.
#[derive(Debug, Args)]
pub struct RunArgs {
    /// Scene file (RON; see docs/scene.md).
    pub scene: PathBuf,
    /// Output folder [default: out/ and the name of the scene].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace the results of an earlier run in the output folder.
    #[arg(long)]
    pub force: bool,
    /// Override a value of the scene by its path; may be repeated.
    ///
    /// `time.step_s=1e-3`, `materials.rock.young_pa=20e9`, `blocks[0].at_m[2]=0.5`.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub overrides: Vec<String>,
    /// How to run it.
    #[command(flatten)]
    pub how: HowArgs,
}

/// What does not depend on the scene.
#[derive(Debug, Default, Args)]
pub struct HowArgs {
    /// Threads; results do not depend on it [default: all cores].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Exit with code 1 when an invariant is beyond its limit.
    #[arg(long)]
    pub strict: bool,
    /// Print nothing but errors.
    #[arg(long, short)]
    pub quiet: bool,
}

/// What `ndda resume` takes.
#[derive(Debug, Args)]
pub struct ResumeArgs {
    /// Output folder of the run.
    pub folder: PathBuf,
    /// How to run it.
    #[command(flatten)]
    pub how: HowArgs,
}

/// Arguments of `ndda check`.
#[derive(Debug, Args)]
pub struct CheckArgs {
    /// Scene file (RON; see docs/scene.md).
    pub scene: PathBuf,
    /// Override a value of the scene by its path; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub overrides: Vec<String>,
}
