//! The command line's arguments.

mod joint;
#[cfg(feature = "plots")]
mod picture;
mod record;
mod rockfall;
mod safety;
mod stereonet;
mod study;
mod trial;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
pub use joint::{JointArgs, JointTestKind};
use ndda::run::Sensitivity;
#[cfg(feature = "plots")]
pub use picture::PictureArgs;
pub use record::RecordArgs;
pub use rockfall::RockfallArgs;
pub use safety::{SafetyArgs, SafetyBy};
pub use stereonet::StereonetArgs;
pub use study::{Spread, StudyArgs, StudyCaseArgs, StudyHow, StudyPart};
pub use trial::{CertifyArgs, TrialHow, TuneArgs};

/// Rock blocks that slide, topple, collide and fall: 3D discontinuous deformation analysis with contact potential.
#[derive(Debug, Parser)]
#[command(
    name = "ndda",
    version,
    after_help = "First steps:\n  ndda run --example sliding_45      run a built-in example\n  ndda view out/sliding_45           look at it in the browser\n  \
                  ndda new slide                     write a scene of your own\n  ndda check slide.ron               errors, warnings, time and files of a run\n  \
                  ndda run slide.ron --set parameters.dip_deg=40 --out out/steeper\n  ndda picture out/steeper           draw the blocks that moved\n\nExit codes: 0 done · 1 ended, but not accurate (--strict), or cases of a \
                  study failed · 2 wrong command line · 3 wrong scene or mesh · 4 the computation could not go on correctly · 5 files cannot be written · 6 too little memory, \
                  or threads cannot be started · 130 interrupted"
)]
pub struct Cli {
    /// Memory limit, such as 8GB: scenes that would need more are refused before they are built [default: the free memory of the machine].
    #[arg(long, global = true, value_name = "SIZE", value_parser = ndda::forecast::memory::parse)]
    pub memory: Option<u64>,
    /// The command.
    #[command(subcommand)]
    pub verb: Verb,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Verb {
    /// Run a scene and write its results.
    ///
    /// Writes summary.json (numbers and checks), history.csv (monitors, energies, momentum over time), blocks.csv (motion of each block), run.log and
    /// fields.pvd with its frames (open it in ParaView). Ctrl-C ends it after a step, with all files; `ndda resume` goes on.
    Run(RunArgs),
    /// Continue an interrupted run from its last checkpoint; the results are the same, to the last bit, as without the interruption.
    Resume(ResumeArgs),
    /// Check a scene without running it: all errors with their places, warnings, and, from a few timed steps, the time, memory and files
    /// of a run.
    Check(CheckArgs),
    /// List what a run of a scene will compute and what it will leave out, with the reasons.
    Explain(ExplainArgs),
    /// Write a commented scene to begin with.
    New(NewArgs),
    /// Print the fields of a scene and their types, as JSON Schema.
    #[cfg(feature = "schema")]
    Schema(SchemaArgs),
    /// Not in this program, which was built without the feature `schema`.
    #[cfg(not(feature = "schema"))]
    Schema(AbsentArgs),
    /// Print completions for a shell.
    #[cfg(feature = "shell")]
    Completions(CompletionsArgs),
    /// Not in this program, which was built without the feature `shell`.
    #[cfg(not(feature = "shell"))]
    Completions(AbsentArgs),
    /// Print the manual page (ndda man | man -l -).
    #[cfg(feature = "shell")]
    Man(ManArgs),
    /// Not in this program, which was built without the feature `shell`.
    #[cfg(not(feature = "shell"))]
    Man(AbsentArgs),
    /// Show the blocks of a scene or a mesh file before any run: how many, how large, how good their tetrahedra, and a picture.
    ///
    /// Prints counts, volumes, histograms of sizes and of the quality of tetrahedra, the ten worst tetrahedra with their positions, and the largest
    /// time step that contact of each material allows. Writes blocks.png (a picture), mesh.svg (the histograms), mesh.json, and blocks.vtu for
    /// ParaView. Tetrahedra with angles of a few degrees, or a longest edge above 50 times the smallest height, make results inexact or time steps
    /// short: use larger spacings, another `fill`, or `sliver_width_m`.
    Mesh(MeshArgs),
    /// Write a run as one HTML page: the blocks moving in 3D, curves, and the checks; it needs no network.
    #[cfg(feature = "report")]
    Report(ReportArgs),
    /// Not in this program, which was built without the feature `report`.
    #[cfg(not(feature = "report"))]
    Report(AbsentArgs),
    /// Open the report of a run in a browser; it is written first if it is missing or older than the run.
    #[cfg(feature = "report")]
    View(ViewArgs),
    /// Not in this program, which was built without the feature `report`.
    #[cfg(not(feature = "report"))]
    View(AbsentArgs),
    /// Run a scene many times with other values, steps, integrators or meshes: tables and pictures of results, errors, times and probabilities.
    ///
    /// Writes study.csv, study.json, time_to_error.csv and pictures; the same command goes on where it was interrupted.
    /// How to write a study and read its results: docs/guide/study.md.
    Study(StudyArgs),
    /// Find the error bar of every result of a scene, from runs with the time step halved and halved again.
    ///
    /// Runs the scene with Δt, Δt/2 and Δt/4 (and with finer meshes and stiffer contact, if asked), and gives each monitor,
    /// the place and velocity of each block and the energies as value ± error: extrapolated where results converge, the
    /// spread where they do not; says when a motion is chaotic. Writes certificate.json, which `ndda report` shows, too.
    /// Given again, the command goes on where it was interrupted. How the error bars are made: docs/guide/certify.md.
    Certify(CertifyArgs),
    /// Find the factor of safety: by how much joints may weaken, loads grow or gravity tilt before blocks move.
    ///
    /// Brings the scene to rest, then runs trials side by side until the largest factor at which blocks stand and the
    /// smallest at which they fail are as near as requested. Writes safety.json and the failing run, folder mechanism.
    Safety(SafetyArgs),
    /// Test the law of a joint as in a laboratory: direct shear at constant normal stress, constant volume or constant normal
    /// stiffness, in one direction or in cycles, and normal closure.
    ///
    /// Prints shear and normal stress, opening, slip and the energy that is lost, and the closed form where there is one. The law is that
    /// of a scene (between all blocks, of a named joint, of two materials), or written on the command line.
    Joint(JointArgs),
    /// Find the fastest settings whose error stays below a given one: integrator, time step, potential, kind of body and penalty.
    ///
    /// Tries settings by short runs that double their effort, judges them by the closed form of the scene or by certified
    /// runs of it, and prints the best settings, as --set lines, too, and what was tried. Writes
    /// tune.json. The same command goes on where it was interrupted. How it searches: docs/guide/certify.md.
    Tune(TuneArgs),
    /// Draw joints on a stereonet: poles, mean and concentration of each set, and which may slide or topple out of a slope.
    Stereonet(StereonetArgs),
    /// Show a record of ground motion: motion over time, response spectrum, intensity, and slip of a rigid block.
    Record(RecordArgs),
    /// Rockfall: let boulders fall over terrain. Gives runout, what they reach, and height, speed and energy where they cross lines such as barriers.
    ///
    /// Writes rockfall.json, tables of boulders, paths, lines and the profile, a map of reach, and pictures. Scenes: docs/guide/rockfall.md.
    Rockfall(RockfallArgs),
    /// Draw curves from the tables of one or more runs.
    #[cfg(feature = "plots")]
    Plot(PlotArgs),
    /// Not in this program, which was built without the feature `plots`.
    #[cfg(not(feature = "plots"))]
    Plot(AbsentArgs),
    /// Draw the blocks of a run, or of a scene before it runs, in 3D as a picture or an animation.
    ///
    /// Shows the blocks that have moved and what is around them, with a scale of colours, axes and a scale bar; blocks at rest
    /// that hide them are drawn transparent. Needs neither browser nor graphics card.
    #[cfg(feature = "plots")]
    Picture(PictureArgs),
    /// Not in this program, which was built without the feature `plots`.
    #[cfg(not(feature = "plots"))]
    Picture(AbsentArgs),
}

/// Arguments of a command that this program was built without: whatever is typed.
#[cfg(not(all(feature = "plots", feature = "report", feature = "schema", feature = "shell")))]
#[derive(Debug, Args)]
#[command(disable_help_flag = true)]
pub struct AbsentArgs {
    /// Ignored.
    #[arg(hide = true, trailing_var_arg = true, allow_hyphen_values = true)]
    pub rest: Vec<String>,
}

/// Arguments of `ndda report`.
#[cfg(feature = "report")]
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  ndda report out/sliding_45\n  ndda report out/pile_125 -o pile.html --frames 25"
)]
pub struct ReportArgs {
    /// Output folder of a run.
    pub folder: PathBuf,
    /// The page [default: report.html in the folder].
    #[arg(long, short, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Largest number of frames to show, evenly spaced; 0 leaves the blocks out [default: all, or as many as a page can carry].
    #[arg(long, value_name = "N")]
    pub frames: Option<u32>,
    /// Print JSON for programs, an object per line; see docs/reference/json.md.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `ndda view`.
#[cfg(feature = "report")]
#[derive(Debug, Args)]
pub struct ViewArgs {
    /// Output folder of a run.
    pub folder: PathBuf,
    /// Print JSON for programs, an object per line; see docs/reference/json.md.
    #[arg(long)]
    pub json: bool,
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
    /// Columns to draw, by name or the beginning of a name [default: draw nothing, list the columns].
    #[arg(long, value_delimiter = ',', value_name = "NAME")]
    pub columns: Vec<String>,
    /// Column to draw against.
    #[arg(long, default_value = "time_s", value_name = "NAME", requires = "columns")]
    pub against: String,
    /// Logarithmic vertical axis; values not above zero are left out.
    #[arg(long, requires = "columns")]
    pub log: bool,
    /// The picture, .svg or .png.
    #[arg(long, short, default_value = "plot.svg", value_name = "FILE")]
    pub out: PathBuf,
    /// Print JSON for programs, an object per line; see docs/reference/json.md.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `ndda mesh`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  ndda mesh scenes/column_phi0.ron\n  ndda mesh scenes/pile_125.ron \
                        --set rock.cube.fill='Size(size_m: 0.4)'\n  ndda mesh scenes/column_phi0.ron --also polyhedra,gmsh\n  ndda mesh block.msh --fix orient,merge --json")]
pub struct MeshArgs {
    /// Scene file (RON), or mesh file (Gmsh, TetGen, VTK, Abaqus) with coordinates in metres.
    pub input: PathBuf,
    /// Repairs of a mesh file, in this order: inverted tetrahedra turned round, coincident nodes merged.
    #[arg(long, value_enum, value_delimiter = ',', value_name = "FIX")]
    pub fix: Vec<Fix>,
    /// Nodes nearer to each other than this fraction of a body's size are merged by `--fix merge`.
    #[arg(long, default_value_t = 1e-9, value_name = "RATIO", requires = "fix")]
    pub within: f64,
    /// Output folder [default: out/ and the name of the input with _mesh].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace the results of an earlier run of this command in the output folder.
    #[arg(long)]
    pub force: bool,
    /// Write the blocks in other formats, too: gmsh, abaqus, tetgen, vtu (with node sets), and polyhedra or obj (the convex parts of
    /// rock before they are filled).
    #[arg(long, value_delimiter = ',', value_name = "FORMAT")]
    pub also: Vec<ndda::mesh_export::Export>,
    /// Print the report as JSON, one object on a line (see docs/reference/json.md).
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

/// Which scene, and what is changed in it.
#[derive(Debug, Default, Args)]
pub struct SceneArgs {
    /// Scene file (RON; see docs/reference/scene.md), or - for standard input.
    #[arg(required_unless_present = "example")]
    pub scene: Option<PathBuf>,
    /// Use a built-in example instead of a file; without a name, list the examples.
    #[arg(long, value_name = "NAME", num_args = 0..=1, default_missing_value = "", conflicts_with = "scene")]
    pub example: Option<String>,
    /// Override a value of the scene by its path; may be repeated.
    ///
    /// `time.step_s=1e-3`, `materials.rock.young_pa=20e9`, `blocks[0].at_m[2]=0.5`; `@FILE` for the values in the lines of a file.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub overrides: Vec<String>,
}

/// Arguments of `ndda run`.
#[derive(Debug, Args)]
pub struct RunArgs {
    /// The scene.
    #[command(flatten)]
    pub input: SceneArgs,
    /// Output folder [default: out/ and the name of the scene].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace the results of an earlier run in the output folder.
    #[arg(long)]
    pub force: bool,
    /// How to run it.
    #[command(flatten)]
    pub how: HowArgs,
}

/// Settings of a run that do not depend on the scene.
#[derive(Debug, Args)]
pub struct HowArgs {
    /// Number of threads; results do not depend on it [default: all cores].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Exit with code 1 when a run is labelled inaccurate or sensitive, or a check is beyond its limit.
    #[arg(long)]
    pub strict: bool,
    /// After an accurate run, run the scene again, from a slightly different start or with half the step, to see whether the result changes: auto (where
    /// several blocks move, one hops or hits several times or on strongly damped contact, loads change along the way of one, nothing can touch, or the run was short), always or never. It takes as long, or twice as long [default: auto; resume: as it began].
    #[arg(long, value_name = "WHEN")]
    pub sensitivity: Option<Sensitivity>,
    /// Print nothing but errors.
    #[arg(long, short)]
    pub quiet: bool,
    /// Print all tables at the end: computing time, every check, monitors and blocks. They are in run.log in any case.
    #[arg(long, short, conflicts_with_all = ["quiet", "json"])]
    pub verbose: bool,
    /// Print events and results as JSON, one object per line (see docs/reference/json.md).
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `ndda resume`.
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
    /// The scene.
    #[command(flatten)]
    pub input: SceneArgs,
    /// Write the penalty and the time step that ndda chose into the scene file, where the file leaves them out.
    #[arg(long, conflicts_with_all = ["example", "overrides"])]
    pub write: bool,
    /// Print what is found as JSON, one object per line (see docs/reference/json.md).
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `ndda explain`.
#[derive(Debug, Args)]
pub struct ExplainArgs {
    /// The scene.
    #[command(flatten)]
    pub input: SceneArgs,
    /// Print the plan as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `ndda new`.
#[derive(Debug, Args)]
pub struct NewArgs {
    /// Which template [default: slide].
    pub template: Option<String>,
    /// File to write, or - for standard output [default: the template's name with .ron].
    #[arg(long, short, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// List the templates.
    #[arg(long)]
    pub list: bool,
    /// Replace the file if it is there.
    #[arg(long)]
    pub force: bool,
    /// Print JSON for programs, an object per line; see docs/reference/json.md.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `ndda schema`.
#[cfg(feature = "schema")]
#[derive(Debug, Args)]
pub struct SchemaArgs {
    /// Print docs/reference/scene.md instead.
    #[arg(long)]
    pub markdown: bool,
}

/// Arguments of `ndda completions`.
#[cfg(feature = "shell")]
#[derive(Debug, Args)]
pub struct CompletionsArgs {
    /// Which shell.
    pub shell: clap_complete::Shell,
}

/// Arguments of `ndda man`.
#[cfg(feature = "shell")]
#[derive(Debug, Args)]
pub struct ManArgs {
    /// Command whose page is printed [default: all, in short].
    pub command: Option<String>,
}
