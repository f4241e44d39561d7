//! Why blocks cannot be drawn.

use std::path::PathBuf;

use ndda_io::WriteError;
use ndda_io::diagnostic::SceneErrors;
use ndda_io::mesh_file::MeshFileError;

use super::image::{LARGEST_PX, MOST_PX, SMALLEST_PX};
use super::numbers::three_digits;
use crate::frames::OtherBlocks;

/// Why blocks cannot be drawn.
#[derive(Debug, thiserror::Error)]
pub enum ViewError {
    /// The scene cannot be used.
    #[error("{0}")]
    Scene(Box<SceneErrors>),
    /// Neither a scene nor a folder.
    #[error("there is no {}: name the output folder of a run, as out/sliding_45, or a scene file", .0.display())]
    NoInput(PathBuf),
    /// A table of joints.
    #[error("{} is a table: `ndda stereonet {}` draws its planes", .0.display(), .0.display())]
    Table(PathBuf),
    /// A scene without joints.
    #[error("--color joint: {} has no block with a face on a joint: give its rock `joints`, or choose block or material", .0.display())]
    NoJoints(PathBuf),
    /// Colours of joints were requested of a run.
    #[error("--color joint: the frames of a run do not hold the joints: name the scene file to see them")]
    JointsOfRun,
    /// The folder has no frames.
    #[error(
        "{} holds no frames of blocks ({} is missing or empty): name the output folder of a run whose scene has output.frames above 0",
        folder.display(),
        ndda_io::OutputFolder::FIELDS_INDEX
    )]
    NoFrames {
        /// The output folder.
        folder: PathBuf,
    },
    /// A frame, or the list of them, cannot be used.
    #[error("{0}; run the scene again")]
    Frame(#[from] MeshFileError),
    /// A frame that does not fit the first.
    #[error(transparent)]
    OtherBlocks(#[from] OtherBlocks),
    /// A frame with a position that is not finite.
    #[error("{}: node {node} is at no finite place; the frame is damaged, run the scene again", path.display())]
    NotFinite {
        /// The frame.
        path: PathBuf,
        /// The node.
        node: usize,
    },
    /// There is no such frame.
    #[error("--frame {asked}: the run has {count} frames, 0 to {}, of 0 s to {last_s} s", count - 1)]
    NoFrame {
        /// The frame that was requested.
        asked: String,
        /// Frames of the run.
        count: usize,
        /// Time of the last [s].
        last_s: f64,
    },
    /// The frames have no such array.
    #[error("--color {asked}: the frames do not hold it{advice}; choose one of displacement, block{}", names.iter().map(|n| format!(", {n}")).collect::<String>())]
    NoField {
        /// The quantity that was requested.
        asked: String,
        /// How a run writes it.
        advice: &'static str,
        /// Arrays of the frames.
        names: Vec<String>,
    },
    /// A scene before its run has no fields.
    #[error(
        "--color {0}: a scene has no results before it is run: choose block, material or joint, or name the output folder of a run"
    )]
    NoResults(String),
    /// Values of a scene are set in one that has run.
    #[error("--set changes a scene before its run, and {} holds a run: name the scene, or run it again with --set", .0.display())]
    HasRun(PathBuf),
    /// Displacements so large that nothing is seen of the blocks.
    #[error(
        "--magnify {}: blocks would be too small to see beside displacements so long; write a number above 0, here up to {}",
        three_digits(*asked),
        three_digits(*most)
    )]
    Magnify {
        /// The factor that was requested.
        asked: f64,
        /// The largest that can be drawn.
        most: f64,
    },
    /// Frames or motion of a scene before its run.
    #[error(
        "{0} is for the output folder of a run: a scene that has not run has no frames and no displacements"
    )]
    NotRun(&'static str),
    /// Colours of bolts where there are none, or where they carry nothing yet.
    #[error("--bolts: {0}")]
    Bolts(&'static str),
    /// A scene before its run does not move.
    #[error("--animate is for the output folder of a run: a scene that has not run does not move")]
    Still,
    /// The picture would be too small or too large.
    #[error(
        "--size {width}x{height}: each side has {SMALLEST_PX} to {LARGEST_PX} pixels, and a picture at most {1} million; this one would have {0:.2} million",
        f64::from(*width) * f64::from(*height) / 1e6,
        MOST_PX / 1_000_000
    )]
    Size {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// The ending of the file says no format.
    #[error("{}: the name of {what} ends in {endings}", path.display())]
    Ending {
        /// The file.
        path: PathBuf,
        /// A picture or an animation.
        what: &'static str,
        /// Endings that there are.
        endings: &'static str,
    },
    /// A format that the program was built without.
    #[error("{}: this program was built without the feature `png`: choose .svg", .0.display())]
    NoPng(PathBuf),
    /// ffmpeg cannot be started or fails.
    #[error("{}: ffmpeg {reason}; install ffmpeg, or choose .png for an animated PNG", path.display())]
    Ffmpeg {
        /// The file.
        path: PathBuf,
        /// The problem.
        reason: String,
    },
    /// The picture cannot be encoded.
    #[error("{}: {reason}", path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// Error of the encoder.
        reason: String,
    },
    /// The picture cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

impl From<SceneErrors> for ViewError {
    fn from(errors: SceneErrors) -> Self {
        Self::Scene(Box::new(errors))
    }
}
