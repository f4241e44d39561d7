//! Arguments of `ndda joint`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// Arguments of `ndda joint`.
#[derive(Debug, Args)]
#[command(
    after_help = "Numbers are in SI units: Pa, Pa/m, m.\n\nExamples:\n  ndda joint scenes/safety/plane_slide.ron\n  ndda joint slope.ron --of bedding --normal-stress 0.5e6 --amplitude 0.02 --out out/bedding\n  \
                  ndda joint slope.ron --between granite,schist --cycles 3\n  ndda joint --friction '(friction_deg: 30, shear_penalty_pa_m: 1e10, dilation: (psi_deg: 10, to_slip_m: 0.02))' --constant-volume \
                  --joint-stiffness 1e10\n  ndda joint --friction '(friction_deg: 30, shear_penalty_pa_m: 1e10, roughness: (jrc: 10, jcs_pa: 100e6, mobilised: true))' --out out/rough\n  \
                  ndda joint --test closure --joint-stiffness 20e9 --max-closure 0.3e-3 --normal-stress 10e6\n\nWhat the columns mean: docs/guide/joints.md"
)]
pub struct JointArgs {
    /// Scene whose law is tested (RON; see docs/reference/scene.md); not needed with --friction, nor for a closure test with --joint-stiffness.
    pub scene: Option<PathBuf>,
    /// Use a built-in example instead of a file; without a name, list the examples.
    #[arg(long, value_name = "NAME", num_args = 0..=1, default_missing_value = "", conflicts_with = "scene")]
    pub example: Option<String>,
    /// Override a value of the scene by its path; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub overrides: Vec<String>,
    /// Test the law of this joint, as contact.rock_joints of the scene has it [default: contact.friction].
    #[arg(long, value_name = "JOINT", conflicts_with_all = ["between", "friction"])]
    pub of: Option<String>,
    /// Test the law between two materials, as contact.material_pairs has it.
    #[arg(long, value_name = "A,B", value_parser = pair, conflicts_with = "friction")]
    pub between: Option<(String, String)>,
    /// Test this law, written as contact.friction of a scene is.
    #[arg(long, value_name = "LAW", value_parser = law)]
    pub friction: Option<String>,
    /// Which test.
    #[arg(long, value_enum, default_value_t = JointTestKind::Shear)]
    pub test: JointTestKind,
    /// Normal stress [Pa]: at the start of a shear test, at the end of a closure test.
    #[arg(long, value_name = "PA", default_value_t = 1e6, allow_negative_numbers = true)]
    pub normal_stress: f64,
    /// Shear at constant volume: the joint can neither open nor close, and the normal stress changes.
    #[arg(long, conflicts_with = "spring")]
    pub constant_volume: bool,
    /// Shear at constant normal stiffness: a spring of this stiffness [Pa/m] holds the joint, in place of a constant normal stress.
    #[arg(long, value_name = "PA_PER_M", allow_negative_numbers = true)]
    pub spring: Option<f64>,
    /// Normal stiffness of the joint [Pa/m] [default: 2 penalty_pa / L₀ if the scene's potential is Smooth or Closure, with its length L₀].
    #[arg(long, value_name = "PA_PER_M", allow_negative_numbers = true)]
    pub joint_stiffness: Option<f64>,
    /// Largest closure of the joint [m]: closure then follows a hyperbola (Bandis), with --joint-stiffness as its initial stiffness.
    #[arg(long, value_name = "M", requires = "joint_stiffness", allow_negative_numbers = true)]
    pub max_closure: Option<f64>,
    /// Slip at which shearing ends, or turns round in a cyclic test [m] [default: 0.01].
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub amplitude: Option<f64>,
    /// Number of shear cycles, to the same slip on both sides of the start; 0 shears in one direction only.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub cycles: u32,
    /// Number of increments from the start to the amplitude, or to the normal stress of a closure test.
    #[arg(long, value_name = "N", default_value_t = 1000)]
    pub steps: u32,
    /// Folder to write joint.csv, joint.json and the picture joint.svg to.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print the test as JSON, with all of its rows.
    #[arg(long)]
    pub json: bool,
}

/// A test of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum JointTestKind {
    /// Direct shear under a normal stress.
    Shear,
    /// Closure under a growing normal stress.
    Closure,
}

/// Two names with a comma between them.
fn law(text: &str) -> Result<String, String> {
    match text.parse::<f64>() {
        Ok(_) => Err(format!("write the law in brackets, as '(friction_deg: {text})'")),
        Err(_) => Ok(text.into()),
    }
}

fn pair(text: &str) -> Result<(String, String), String> {
    match text.split(',').map(str::trim).collect::<Vec<_>>()[..] {
        [a, b] if !a.is_empty() && !b.is_empty() => Ok((a.to_string(), b.to_string())),
        _ => Err("write the names of two materials with a comma between them, as granite,schist".into()),
    }
}
