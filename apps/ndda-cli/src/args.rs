//! What a person can type.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

/// Rock blocks that slide, topple, collide and fall: 3D discontinuous deformation analysis with contact potential.
#[derive(Debug, Parser)]
#[command(
    version,
    after_help = "Examples:\n  ndda run scenes/sliding_45.ron\n  ndda run scenes/sliding_45.ron --set time.step_s=1e-3 \
                  --out out/coarse\n  ndda check scenes/sliding_45.ron\n  ndda mesh scenes/column_phi0.ron\n\nExit codes: 0 done · 1 ran, a criterion \
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
    /// Build or read the blocks of a scene or a mesh file, check and measure them, and draw them.
    ///
    /// Prints counts, volumes, how large blocks are, how good their tetrahedra are (histograms, and the worst ten with
    /// their places), and writes blocks.vtu (open it in ParaView and colour it by block_id), mesh.json and mesh.svg.
    /// Tetrahedra with dihedral angles of a few degrees or an aspect above 50 make runs inexact or short of steps:
    /// use larger spacings, another `fill`, or `sliver_width_m`.
    Mesh(MeshArgs),
    /// Run a scene over and over with other steps, integrators, meshes, …: error against time, as tables and pictures.
    ///
    /// Writes study.csv, study.json, time_to_error.csv and pictures; the same command goes on where it was interrupted.
    /// How to write a study and read its results: docs/study.md.
    Study(StudyArgs),
    /// Draw columns of histories.
    #[cfg(feature = "plots")]
    Plot(PlotArgs),
}

/// Arguments of `ndda study`.
#[derive(Debug, Args)]
#[command(
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    after_help = "Examples:\n  ndda study scenes/studies/bounce.ron\n  ndda study s.ron --emit slurm > job.sh\n  ndda study \
                  collect s.ron"
)]
pub struct StudyArgs {
    /// Part of a study.
    #[command(subcommand)]
    pub part: Option<StudyPart>,
    /// Study file (RON; see docs/study.md).
    #[arg(required = true)]
    pub study: Option<PathBuf>,
    /// Where and how.
    #[command(flatten)]
    pub how: StudyHow,
    /// Cases that run at a time; more than one disturbs their times.
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: u16,
    /// Run nothing: print what hands the cases to a scheduler.
    #[arg(long, value_enum, value_name = "KIND")]
    pub emit: Option<Emit>,
    /// Print the results as JSON.
    #[arg(long)]
    pub json: bool,
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

/// What all parts of a study take.
#[derive(Debug, Args)]
pub struct StudyHow {
    /// Output folder [default: out/ and the name of the study with _study].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Threads of each run.
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: u16,
    /// Print nothing but errors and results.
    #[arg(long, short)]
    pub quiet: bool,
}

/// What runs the cases.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Emit {
    /// A job array of Slurm.
    Slurm,
    /// GNU parallel.
    Parallel,
    /// One command per line.
    List,
}

/// Arguments of `ndda plot`.
#[cfg(feature = "plots")]
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  ndda plot out/sliding_45\n  ndda plot out/sliding_45 --columns kinetic,strain -o \
                        energy.png\n  ndda plot out/a out/b --columns reference_error --log -o errors.svg"
)]
pub struct PlotArgs {
    /// Output folders of runs, or history files; several are drawn over each other.
    #[arg(required = true)]
    pub inputs: Vec<PathBuf>,
    /// Columns to draw, by name or its beginning; without them, print those that there are.
    #[arg(long, value_delimiter = ',', value_name = "NAME")]
    pub columns: Vec<String>,
    /// Column to draw against.
    #[arg(long, default_value = "time_s", value_name = "NAME")]
    pub against: String,
    /// Logarithms of values; what is not above zero is left out.
    #[arg(long)]
    pub log: bool,
    /// The picture, .svg or .png.
    #[arg(long, short, default_value = "plot.svg", value_name = "FILE")]
    pub out: PathBuf,
}

/// Arguments of `ndda mesh`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  ndda mesh scenes/column_phi0.ron\n  ndda mesh scenes/pile_125.ron \
                        --set rock.cube.fill='Size(size_m: 0.4)'\n  ndda mesh block.msh --fix orient,merge --json")]
pub struct MeshArgs {
    /// Scene file (RON), or mesh file (Gmsh, TetGen, VTK, Abaqus) with coordinates in metres.
    pub input: PathBuf,
    /// Repairs of a mesh file, in this order: inverted tetrahedra turned round, coincident nodes merged.
    #[arg(long, value_enum, value_delimiter = ',', value_name = "FIX")]
    pub fix: Vec<Fix>,
    /// Nodes nearer than this part of a body's size are merged by `--fix merge`.
    #[arg(long, default_value_t = 1e-9, value_name = "RATIO")]
    pub within: f64,
    /// Output folder [default: out/ and the name of the input with _mesh].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace the results of an earlier call in the output folder.
    #[arg(long)]
    pub force: bool,
    /// Print the report as JSON.
    #[arg(long)]
    pub json: bool,
    /// Override a value of the scene by its path; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub overrides: Vec<String>,
}

/// A repair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Fix {
    /// Turn inverted tetrahedra round.
    Orient,
    /// Merge coincident nodes.
    Merge,
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
