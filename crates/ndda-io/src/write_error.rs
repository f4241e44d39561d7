//! Why a result could not be written.

use std::io;
use std::path::{Path, PathBuf};

/// Why a result could not be written, and what to do about it.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The operating system refused.
    #[error("cannot {operation} {}: {source}{}", path.display(), advice(source.kind()))]
    Io {
        /// The operation, as a verb: "create", "write", "rename".
        operation: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// A number is infinite or not a number; nothing was written.
    #[error(
        "{array}{} is not a finite number, so {} was not written: the run became unstable before this; \
         reduce time.step_s",
        bracketed(*index),
        path.display()
    )]
    NotFinite {
        /// The file that should have held it.
        path: PathBuf,
        /// Name of the array, the column or the key.
        array: String,
        /// Index of the node, tetrahedron, row or frame, where there is one.
        index: Option<usize>,
    },
    /// The data cannot be put into the file's format.
    #[error("cannot encode {}: {reason}", path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// Error of the encoder.
        reason: String,
    },
    /// Two columns of a table have one name.
    #[error("{} would have two columns called '{column}': rename a monitor or a block", path.display())]
    DuplicateColumn {
        /// The table.
        path: PathBuf,
        /// The name.
        column: String,
    },
    /// A table cannot be gone on with.
    #[error("{} is not the table that belongs to the checkpoint ({what}): put the original file back, or run the scene again", path.display())]
    NotThatTable {
        /// The table.
        path: PathBuf,
        /// The item.
        what: String,
    },
    /// Frames that a checkpoint knows of are gone.
    #[error("{} has lost {}: put them back, or run the scene again", folder.display(), listed(frames))]
    LostFrames {
        /// Folder of the frames.
        folder: PathBuf,
        /// Names of those that are missing or empty.
        frames: Vec<String>,
    },
    /// The name of a picture does not say which of the formats that there are.
    #[error("{}: the name of a picture ends in .svg or .png", path.display())]
    PictureEnding {
        /// The file.
        path: PathBuf,
    },
    /// A folder that holds more than results: the root of the file system, or somebody's home.
    #[error("{} is not a folder for results: choose another one with --out", path.display())]
    NoResultFolder {
        /// The folder.
        path: PathBuf,
    },
    /// Another run is writing there.
    #[error("another run is writing to {}: wait for its end, or choose another folder", path.display())]
    InUse {
        /// The folder.
        path: PathBuf,
    },
    /// The output folder is a file.
    #[error("the output folder {} is a file: choose another folder with --out", path.display())]
    IsFile {
        /// The path.
        path: PathBuf,
    },
    /// The output folder holds the results of an earlier run.
    #[error(
        "{} holds an earlier run ({found}): choose another folder with --out, or replace it with --force",
        path.display()
    )]
    EarlierRun {
        /// The folder.
        path: PathBuf,
        /// One of its files.
        found: String,
    },
    /// The folder of several runs is that of one.
    #[error("{} holds the results of a run ({found}): choose another folder with --out", path.display())]
    RunFolder {
        /// The folder.
        path: PathBuf,
        /// One of its files.
        found: String,
    },
    /// The output folder holds something that ndda did not write, and no results of an earlier run.
    #[error(
        "{} is not empty and holds something that ndda did not write ({found}): choose another folder with --out",
        path.display()
    )]
    NotOurs {
        /// The folder.
        path: PathBuf,
        /// One of the things in it.
        found: String,
    },
    /// Something has the name of a file or folder of ours but is of another kind; it is never deleted.
    #[error(
        "{} is in the way, ndda needs this name for a {needed}: move it or choose another folder with --out",
        path.display()
    )]
    InTheWay {
        /// The file in the way.
        path: PathBuf,
        /// "file" or "folder".
        needed: &'static str,
    },
}

impl WriteError {
    /// For `map_err`: wraps what the operating system said.
    pub fn io(operation: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_path_buf();
        move |source| Self::Io { operation, path, source }
    }

    /// A number of `array` in the file at `path` is not finite.
    pub fn not_finite(path: &Path, array: impl Into<String>, index: Option<usize>) -> Self {
        Self::NotFinite { path: path.to_path_buf(), array: array.into(), index }
    }
}

/// Names, the first five of them.
fn listed(names: &[String]) -> String {
    const SHOWN: usize = 5;
    let first = names[..names.len().min(SHOWN)].join(", ");
    if names.len() > SHOWN { format!("{first} and {} more", names.len() - SHOWN) } else { first }
}

fn bracketed(index: Option<usize>) -> String {
    index.map(|i| format!("[{i}]")).unwrap_or_default()
}

/// Remedy for an error of the operating system.
fn advice(kind: io::ErrorKind) -> &'static str {
    match kind {
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "; choose a folder that you may write to with --out"
        }
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "; free some space, or choose another disk with --out; a run writes less with fewer output.frames"
        }
        io::ErrorKind::NotADirectory => "; a part of this path is a file, choose another folder with --out",
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_disk_is_named_with_the_file_and_the_cure() {
        let full = io::Error::from(io::ErrorKind::StorageFull);
        let text = WriteError::io("write", Path::new("out/history.csv"))(full).to_string();
        assert!(text.starts_with("cannot write out/history.csv: "), "{text}");
        assert!(text.ends_with(
            "free some space, or choose another disk with --out; a run writes less with fewer output.frames"
        ));
    }

    #[test]
    fn a_number_that_is_not_finite_is_named_by_array_and_index() {
        let text = WriteError::not_finite(Path::new("a.vtu"), "velocity_m_s", Some(12)).to_string();
        assert!(
            text.starts_with("velocity_m_s[12] is not a finite number, so a.vtu was not written"),
            "{text}"
        );
        let text = WriteError::not_finite(Path::new("a.json"), "wall_s", None).to_string();
        assert!(text.starts_with("wall_s is not"), "{text}");
    }
}
