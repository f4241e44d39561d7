//! Arguments of `ndda picture`.

use std::path::PathBuf;

use clap::Args;
use ndda::view3d::{self, BoltColour, Colour, FrameChoice, Resting, View};

/// Arguments of `ndda picture`.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  ndda picture out/dominoes                              the last frame, coloured by displacement\n  ndda picture out/dominoes --frame 0.35s --color velocity_m_s\n  \
                  ndda picture scenes/arch.ron --color material          a scene before its run\n  ndda picture out/dominoes --view front --dark --size 1920x1080 -o front.png\n  \
                  ndda picture out/wedge_safety -o mechanism.svg         what fails, by ndda safety\n  ndda picture out/dominoes --animate --frames 40        an animated PNG\n\n\
                  x points east, y north, z up. Options with pictures: docs/guide/pictures.md"
)]
pub struct PictureArgs {
    /// Output folder of a run, or a scene file.
    pub input: PathBuf,
    /// Which frame: last, first, a number from 0, or the nearest to a time, as 0.35s; auto takes the last, but for a
    /// mechanism of `ndda safety` the first frame in which motion can be seen.
    #[arg(long, value_name = "FRAME", default_value = "auto")]
    pub frame: FrameChoice,
    /// Where the viewer stands: iso, top, front (south), side (east), or AZIMUTH,ELEVATION in degrees, clockwise from north and above the
    /// horizontal.
    #[arg(long, value_name = "VIEW", default_value = "iso", allow_hyphen_values = true)]
    pub view: View,
    /// Quantity shown by colours: displacement, velocity, stress (von Mises), block, material, joint (of a scene), or the name of an array of the frames
    /// [default: displacement of a run, blocks of a scene].
    #[arg(long, visible_alias = "colour", value_name = "QUANTITY")]
    pub color: Option<Colour>,
    /// How blocks at rest are drawn: auto (transparent where they hide most of what moves), solid, clear (transparent) or hidden.
    #[arg(long, value_name = "HOW", default_value = "auto")]
    pub resting: Resting,
    /// Show all blocks, in place of those that move and what is around them.
    #[arg(long)]
    pub whole: bool,
    /// Factor by which displacements are magnified.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = view3d::parse_factor, allow_hyphen_values = true)]
    pub magnify: f64,
    /// Do not draw the outlines of the blocks at their start; they are drawn only where few blocks move.
    #[arg(long)]
    pub no_outlines: bool,
    /// Colours of bolts: force (axial, tension above zero), yield (axial force over that at which the steel yields), state (elastic, debonded, yielding or
    /// broken), plain or hidden; bolts of a scene are plain.
    #[arg(long, value_name = "WHAT", default_value = "force")]
    pub bolts: BoltColour,
    /// Light on dark, for screens.
    #[arg(long)]
    pub dark: bool,
    /// Columns and rows of the picture [default: 1200x800, of animations 800x560].
    #[arg(long, value_name = "WxH", value_parser = view3d::parse_size)]
    pub size: Option<(u32, u32)>,
    /// Draw the run from its first frame to its last.
    #[arg(long, conflicts_with = "frame")]
    pub animate: bool,
    /// Largest number of frames of an animation, evenly spaced.
    #[arg(long, value_name = "N", default_value_t = 100, requires = "animate", value_parser = clap::value_parser!(u16).range(2..))]
    pub frames: u16,
    /// Frames of an animation that are shown in a second.
    #[arg(long, value_name = "N", default_value_t = 12, requires = "animate", value_parser = clap::value_parser!(u16).range(1..=100))]
    pub fps: u16,
    /// The file: .png or .svg; for an animation .png, .webm or .mp4 (the last two through ffmpeg) [default: picture.png or
    /// animation.png in the folder of the run; for a scene, a file of its name in the current folder].
    #[arg(long, short, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Override a value of the scene by its path; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub overrides: Vec<String>,
    /// Print JSON for programs, an object per line; see docs/reference/json.md.
    #[arg(long)]
    pub json: bool,
}
