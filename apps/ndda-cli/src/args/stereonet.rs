//! Arguments of `ndda stereonet`.

use std::path::PathBuf;

use clap::Args;
use ndda::stereonet::{Net, Orientation, SLIDING_LATERAL_DEG, parse_orientation};

/// Arguments of `ndda stereonet`.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  ndda stereonet scenes/safety/wedge.ron --slope 65/156 --friction 30\n  ndda stereonet joints.csv --net angle -o \
                  joints.png\n\nA table has a first line dip_deg,dip_direction_deg,set and a line per plane, as 40,130,bedding; set may be left out.\n\
                  What the marks and checks mean: docs/guide/stereonet.md"
)]
pub struct StereonetArgs {
    /// Scene whose joints are drawn, sets by their mean orientation; or a table of planes, .csv.
    pub input: PathBuf,
    /// Projection: area (equal area, Schmidt) or angle (equal angle, Wulff).
    #[arg(long, value_name = "NET", default_value = "area")]
    pub net: Net,
    /// Face of a slope, dip and dip direction in degrees, as 65/150: drawn, and checked for sliding and toppling.
    #[arg(long, value_name = "DIP/DIRECTION", value_parser = parse_orientation)]
    pub slope: Option<Orientation>,
    /// Friction of the joints in degrees: planes and wedges slide if they are steeper [default: checks of directions alone].
    #[arg(long, value_name = "DEGREES", requires = "slope")]
    pub friction: Option<f64>,
    /// Lateral limit [°]: planes slide only if their dip direction is within this angle of the slope's.
    #[arg(long, value_name = "DEGREES", default_value_t = SLIDING_LATERAL_DEG, requires = "slope")]
    pub lateral: f64,
    /// The picture, .svg or .png.
    #[arg(long, short, default_value = "stereonet.svg", value_name = "FILE")]
    pub out: PathBuf,
    /// Override a value of the scene by its path; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub overrides: Vec<String>,
    /// Print JSON for programs, an object per line; see docs/reference/json.md.
    #[arg(long)]
    pub json: bool,
}
