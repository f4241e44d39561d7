//! Why there is no stereonet.

use std::path::PathBuf;

use ndda_io::WriteError;
use ndda_io::diagnostic::SceneErrors;

/// Why there is no stereonet.
#[derive(Debug, thiserror::Error)]
pub enum StereonetError {
    /// The scene cannot be used.
    #[error("{0}")]
    Scene(Box<SceneErrors>),
    /// The scene has no joints.
    #[error("{}: the scene has no joints (rock.joints); name a scene that has, or a CSV file with the columns dip_deg, dip_direction_deg and set", .0.display())]
    NoJoints(PathBuf),
    /// The table cannot be read.
    #[error("cannot read {}: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The problem.
        reason: String,
    },
    /// A column is missing.
    #[error("{}: there is no column {column}; the first line names the columns, dip_deg,dip_direction_deg,set (set may be left out)", path.display())]
    NoColumn {
        /// The file.
        path: PathBuf,
        /// The column.
        column: &'static str,
    },
    /// A value is not an angle in its range.
    #[error("{}, line {line}: {column} is `{value}`: write {advice}", path.display())]
    Value {
        /// The file.
        path: PathBuf,
        /// Line of the file, the first being 1.
        line: u64,
        /// The column.
        column: &'static str,
        /// The cell's text.
        value: String,
        /// The range that is allowed.
        advice: &'static str,
    },
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
