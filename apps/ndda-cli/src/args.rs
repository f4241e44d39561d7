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
    /// their places), the steps that contact of each material asks for, and writes blocks.vtu (open it in ParaView and colour it by block_id), mesh.json and mesh.svg.
    /// Tetrahedra with dihedral angles of a few degrees or an aspect above 50 make runs inexact or short of steps:
    /// use larger spacings, another `fill`, or `sliver_width_m`.
    Mesh(MeshArgs),
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
    /// Nodes nearer than this part of a body's size are merged by `--fix merge`.
    #[arg(long, default_value_t = 1e-9, value_name = "RATIO")]
    pub within: f64,
    /// Output folder [default: out/ and the name of the input with _mesh].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace the results of an earlier call in the output folder.
    #[arg(long)]
    pub force: bool,
    /// Write the blocks in other formats, too: `polyhedra` and `obj` are the convex parts of rock before they are filled.
    #[arg(long, value_enum, value_delimiter = ',', value_name = "FORMAT")]
    pub also: Vec<Export>,
    /// Print the report as JSON.
    #[arg(long)]
    pub json: bool,
    /// Override a value of the scene by its path; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub overrides: Vec<String>,
}

/// A format of meshes or blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Export {
    /// mesh.msh, with a physical volume per block.
    Gmsh,
    /// mesh.inp.
    Abaqus,
    /// mesh.node, mesh.ele and mesh.face.
    Tetgen,
    /// mesh.vtu, with the sets of nodes.
    Vtu,
    /// ROCK_parts.vtu, with the blocks of a rock as polyhedra.
    Polyhedra,
    /// ROCK_parts.obj.
    Obj,
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
