//! Arguments of `ndda study`.

use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, Subcommand, ValueEnum};
use ndda::study::emit::Emit;
use ndda_io::study::SecondRuns;

/// Arguments of `ndda study`.
#[derive(Debug, Args)]
#[command(
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    after_help = "Examples:\n  ndda study scenes/studies/bounce.ron\n  ndda study scenes/bounce.ron --vary time.step_s=4e-4,2e-4 --of \
                  cube\n  ndda study scenes/safety/plane_parameters.ron --vary \"parameters.friction_deg=Normal(35, 3)\" \
                  --fails-when \"safety < 1\" --samples 200\n  ndda study s.ron --emit slurm > job.sh\n  ndda study collect s.ron"
)]
pub struct StudyArgs {
    /// Part of a study.
    #[command(subcommand)]
    pub part: Option<StudyPart>,
    /// Study file (RON; see docs/guide/study.md), or with --vary a scene.
    #[arg(required = true)]
    pub study: Option<PathBuf>,
    /// Quantities over values or distributions.
    #[command(flatten)]
    pub sweep: SweepArgs,
    /// Where and how.
    #[command(flatten)]
    pub how: StudyHow,
    /// Cases that run side by side; with more than one, measured times are less reliable.
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: u16,
    /// Run nothing: print a job script, or a list of commands, that runs the cases.
    #[arg(long, value_parser = kinds_of_scripts(), value_name = "KIND", conflicts_with_all = ["vary", "of", "fails_when"])]
    pub emit: Option<Emit>,
    /// Print the results as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Quantities over values or distributions, without a reference.
#[derive(Debug, Args)]
#[command(next_help_heading = "Sweeps and probability")]
pub struct SweepArgs {
    /// Vary a value of the scene: path=a,b,c, or path=Normal(mean, deviation), LogNormal, Uniform, Triangular or Fisher; may be repeated.
    #[arg(long, value_name = "PATH=VALUES")]
    pub vary: Vec<String>,
    /// Quantities: label, safety, columns of history.csv, monitors or blocks, by name or its beginning [default: displacements].
    #[arg(long, value_delimiter = ',', value_name = "NAME")]
    pub of: Vec<String>,
    /// Find the probability of a condition, such as "safety < 1".
    #[arg(long, value_name = "CONDITION")]
    pub fails_when: Option<String>,
    /// Samples of the random parameters [default: 100].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    pub samples: Option<u32>,
    /// How samples are spread [default: lhs].
    #[arg(long, value_enum, value_name = "KIND")]
    pub sampling: Option<Spread>,
    /// Seed of the samples [default: 0].
    #[arg(long, value_name = "SEED", value_parser = ndda::numbers::whole)]
    pub seed: Option<u64>,
    /// Correlate two random parameters by their names: a,b=-0.5; may be repeated.
    #[arg(long, value_name = "A,B=R", allow_hyphen_values = true)]
    pub correlate: Vec<String>,
    /// Find how much each random parameter matters (Sobol' indices), by samples × (parameters + 2) runs.
    #[arg(long)]
    pub sensitivity: bool,
}

/// How samples are spread.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Spread {
    /// A Latin hypercube: one sample in each stratum of each parameter.
    Lhs,
    /// Points of a Sobol' sequence.
    Sobol,
}

/// Parts of a study, for schedulers.
#[derive(Debug, Subcommand)]
pub enum StudyPart {
    /// Run one case.
    Case(StudyCaseArgs),
    /// Gather the results of the cases that have run.
    Collect(StudyCollectArgs),
}

/// Arguments of `ndda study case`.
#[derive(Debug, Args)]
pub struct StudyCaseArgs {
    /// Study file.
    pub study: PathBuf,
    /// Name of the case.
    pub case: String,
    /// Where and how.
    #[command(flatten)]
    pub how: StudyHow,
}

/// Arguments of `ndda study collect`.
#[derive(Debug, Args)]
pub struct StudyCollectArgs {
    /// Study file.
    pub study: PathBuf,
    /// Where and how.
    #[command(flatten)]
    pub how: StudyHow,
    /// Print the results as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Settings that all parts of a study share.
#[derive(Debug, Args)]
pub struct StudyHow {
    /// Output folder [default: out/ and the name of the study with _study].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Threads of each run.
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: u16,
    /// Run each case by so many ranks of ndda-mpi with --threads each: by srun in a job of Slurm, else by mpirun.
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    pub ranks: u16,
    /// Repeat accurate runs, for their labels, as `ndda run --sensitivity` does: auto, always or never [default: as the study says].
    #[arg(long, value_name = "WHEN")]
    pub second_runs: Option<SecondRuns>,
    /// Print nothing but errors and results.
    #[arg(long, short)]
    pub quiet: bool,
    /// Override a value of the base scene by its path; may be repeated. What the study itself sets comes after it.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub overrides: Vec<String>,
}

fn kinds_of_scripts() -> impl TypedValueParser<Value = Emit> {
    let shown = Emit::KINDS.map(|(_, name, help)| PossibleValue::new(name).help(help));
    PossibleValuesParser::new(shown).try_map(|name| Emit::named(&name).ok_or("no such kind"))
}
