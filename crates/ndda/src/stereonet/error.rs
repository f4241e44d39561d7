//! Why there is no stereonet.

use std::path::PathBuf;

use ndda_io::WriteError;
use ndda_io::diagnostic::SceneErrors;
use ndda_io::joint_table::JointTableError;

/// Why there is no stereonet.
#[derive(Debug, thiserror::Error)]
pub enum StereonetError {
    /// The scene cannot be used.
    #[error("{0}")]
    Scene(Box<SceneErrors>),
    /// The scene has no joints.
    #[error("{}: the scene has no joints (rock.joints); name a scene that has, or a CSV file with the columns dip_deg, dip_direction_deg and set", .0.display())]
    NoJoints(PathBuf),
    /// The table cannot be used.
    #[error(transparent)]
    Table(#[from] JointTableError),
    /// There are no planes, or too many.
    #[error("{} has {count} planes: a stereonet takes 1 to {most}", path.display())]
    Count {
        /// The file.
        path: PathBuf,
        /// Planes of the file.
        count: usize,
        /// The most that are allowed.
        most: usize,
    },
    /// Values of a scene are set in a table.
    #[error("--set changes a scene, and {} is a table: change the table", .0.display())]
    SetOfTable(PathBuf),
    /// An angle of the command line is out of range.
    #[error("--{option} {value}: write {advice}")]
    Option {
        /// The option.
        option: &'static str,
        /// The value.
        value: f64,
        /// The range that is allowed.
        advice: &'static str,
    },
    /// The picture cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}
