//! Arguments of `ndda rockfall`.

use std::path::PathBuf;

use clap::Args;

use super::SceneArgs;

/// Arguments of `ndda rockfall`.
#[derive(Debug, Args)]
#[command(
    after_help = "Example:\n  ndda rockfall scenes/works/rockfall.ron --count 50 --seed 7 --out out/few"
)]
pub struct RockfallArgs {
    /// The scene.
    #[command(flatten)]
    pub input: SceneArgs,
    /// Boulders to release [default: those of the scene].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub count: Option<u32>,
    /// Seed of the random numbers [default: that of the scene].
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Boulders that fall side by side; results do not depend on it [default: all cores].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// Output folder [default: out/ and the name of the scene].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace the results of an earlier rockfall in the output folder.
    #[arg(long)]
    pub force: bool,
    /// Print nothing but errors and the answer.
    #[arg(long, short)]
    pub quiet: bool,
    /// Print the answer as JSON.
    #[arg(long)]
    pub json: bool,
}
