//! The command line, which all ranks read alike.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::{Args as ClapArgs, Parser, Subcommand};
use ndda::run::Sensitivity;

/// One scene on several processes: start it by mpirun or srun.
#[derive(Debug, Parser)]
#[command(name = "ndda-mpi", version, about, after_help = "mpirun -n 4 ndda-mpi run scenes/pile_1000.ron")]
pub struct Args {
    /// The command.
    #[command(subcommand)]
    pub verb: Verb,
}

/// The commands that several processes can carry out.
#[derive(Debug, Subcommand)]
pub enum Verb {
    /// Runs a scene; the files are those of `ndda run`, to the bit.
    Run(RunArgs),
    /// Goes on with a run from its last checkpoint, on any number of ranks.
    Resume(ResumeArgs),
    /// Anything else needs one process.
    #[command(external_subcommand)]
    Other(Vec<String>),
}

/// A new run.
#[derive(Debug, ClapArgs)]
pub struct RunArgs {
    /// The scene.
    pub scene: PathBuf,
    /// Replaces a value of the scene, such as `time.end_s=0.1`; may be given several times.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub overrides: Vec<String>,
    /// Folder of the results; `out/` and the name of the scene unless it is given.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Replaces results that are there.
    #[arg(long)]
    pub force: bool,
    /// Options of both commands.
    #[command(flatten)]
    pub how: HowArgs,
}

/// A run that goes on.
#[derive(Debug, ClapArgs)]
pub struct ResumeArgs {
    /// Folder of its results.
    pub folder: PathBuf,
    /// Options of both commands.
    #[command(flatten)]
    pub how: HowArgs,
}

/// Options of both commands.
#[derive(Debug, ClapArgs)]
pub struct HowArgs {
    /// Threads of each rank.
    #[arg(long, default_value = "1")]
    pub threads: NonZeroUsize,
    /// A limit that is passed makes the run fail.
    #[arg(long)]
    pub strict: bool,
    /// Whether a second run shows that the motion is sensitive: auto, always or never [default: auto; of a run that goes on, what it began with].
    #[arg(long)]
    pub sensitivity: Option<Sensitivity>,
    /// Prints errors only.
    #[arg(long)]
    pub quiet: bool,
}
