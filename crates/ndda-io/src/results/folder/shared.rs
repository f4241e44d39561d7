//! Folders of results other than those of a run: files of somebody else stay, and one program at a time writes.

use std::fs::{File, TryLockError};
use std::path::Path;

use super::OutputFolder;
use crate::write_error::WriteError;

impl OutputFolder {
    /// Refuses a folder that has a file with the name of one of the results, unless it holds earlier ones: that file is somebody's own.
    ///
    /// # Errors
    /// [`WriteError::NotOurs`] with the first of them.
    pub fn refuse_others(path: &Path, holds_earlier: bool, names: &[&str]) -> Result<(), WriteError> {
        let is_there = |name: &&&str| path.join(name).symlink_metadata().is_ok();
        match names.iter().find(is_there).filter(|_| !holds_earlier) {
            Some(found) => Err(WriteError::NotOurs { path: path.to_path_buf(), found: (*found).into() }),
            None => Ok(()),
        }
    }

    /// Holds a folder for its results until the answer is dropped; nothing where folders cannot be locked.
    ///
    /// # Errors
    /// [`WriteError::InUse`] while another program holds it.
    pub fn hold(path: &Path) -> Result<Option<File>, WriteError> {
        let Ok(folder) = File::open(path) else { return Ok(None) };
        match folder.try_lock() {
            Err(TryLockError::WouldBlock) => Err(WriteError::InUse { path: path.to_path_buf() }),
            Err(TryLockError::Error(_)) => Ok(None),
            Ok(()) => Ok(Some(folder)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_of_somebody_else_is_refused_by_its_name() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("sweep.csv"), "mine").unwrap();
        let refused =
            |earlier, names: &[&str]| OutputFolder::refuse_others(folder.path(), earlier, names).err();
        let error = refused(false, &["sweep.json", "sweep.csv"]).unwrap().to_string();
        assert!(error.contains("ndda did not write (sweep.csv)") && error.contains("--out"), "{error}");
        assert!(refused(true, &["sweep.csv"]).is_none() && refused(false, &["tune.json"]).is_none());
    }

    #[cfg(unix)]
    #[test]
    fn a_folder_is_held_by_one_at_a_time() {
        let folder = tempfile::tempdir().unwrap();
        let held = OutputFolder::hold(folder.path()).unwrap();
        assert!(matches!(OutputFolder::hold(folder.path()), Err(WriteError::InUse { .. })));
        drop(held);
        assert!(OutputFolder::hold(folder.path()).unwrap().is_some());
    }
}
