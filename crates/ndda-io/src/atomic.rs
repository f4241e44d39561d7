//! Whole files or none: a reader never sees half of one, a crash leaves the old one or the new one.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

use crate::write_error::WriteError;

/// Ending of the temporary file beside the one that is being written.
pub(crate) const TEMPORARY_ENDING: &str = ".tmp";
/// Links that are followed, one after the other.
const MOST_LINKS: usize = 40;
/// Files that are synced at a time.
const AT_A_TIME: usize = 8;

/// Replaces the file at `path` by `content`: temporary file in the same folder, sync, rename, sync of the folder.
///
/// # Errors
/// [`WriteError::Io`] with the step that failed; the temporary file is then removed and an older file at `path`
/// is as it was.
pub fn write(path: &Path, content: &[u8]) -> Result<(), WriteError> {
    write_by(path, |file| file.write_all(content))
}

/// Writes a file that somebody named. A link stays, and the file that it leads to is replaced as by [`write()`]; what is no regular file, as a pipe, stays what it
/// is, and takes the content.
///
/// # Errors
/// As [`write()`].
pub fn write_named(path: &Path, content: &[u8]) -> Result<(), WriteError> {
    // Of what a link leads to.
    match fs::metadata(path).map(|found| found.file_type()) {
        Ok(kind) if kind.is_file() && path.is_symlink() => {
            let file = fs::canonicalize(path).map_err(WriteError::io("look at", path))?;
            write(&file, content)
        }
        Ok(kind) if kind.is_file() => write(path, content),
        Ok(kind) if !kind.is_dir() => {
            let mut file = File::options().write(true).open(path).map_err(WriteError::io("open", path))?;
            file.write_all(content).map_err(WriteError::io("write", path))
        }
        _ => write(&end_of_links(path), content),
    }
}

/// Where a link leads to that leads to nothing yet.
fn end_of_links(path: &Path) -> PathBuf {
    let mut end = path.to_path_buf();
    for _ in 0..MOST_LINKS {
        let Ok(next) = fs::read_link(&end) else { break };
        end = end.parent().map_or_else(|| next.clone(), |folder| folder.join(&next));
    }
    end
}

/// The same with content that is made while it is written: a large one need not be in memory.
///
/// # Errors
/// As [`write`].
pub fn write_by(
    path: &Path,
    content: impl FnOnce(&mut File) -> std::io::Result<()>,
) -> Result<(), WriteError> {
    replace(path, content, true)?;
    sync_folder_of(path);
    Ok(())
}

/// Writes without waiting for the disk: a killed program leaves the old file or the new one, a power failure may leave
/// less until [`sync`] has returned.
///
/// # Errors
/// As [`write`].
pub(crate) fn write_unsynced(path: &Path, content: &[u8]) -> Result<(), WriteError> {
    replace(path, |file| file.write_all(content), false)
}

/// Waits until these files of one folder are on the disk, many at a time: a disk takes hardly longer for eight than for one.
///
/// # Errors
/// [`WriteError::Io`] with the first that is not.
pub(crate) fn sync(paths: &[PathBuf]) -> Result<(), WriteError> {
    let sync = |path: &PathBuf| {
        let file = File::open(path).map_err(WriteError::io("open", path))?;
        file.sync_all().map_err(WriteError::io("sync", path))
    };
    let share = paths.len().div_ceil(AT_A_TIME).max(1);
    std::thread::scope(|scope| {
        let threads: Vec<_> =
            paths.chunks(share).map(|chunk| scope.spawn(move || chunk.iter().try_for_each(sync))).collect();
        threads.into_iter().try_for_each(|thread| thread.join().expect("a sync that does not panic"))
    })?;
    paths.iter().take(1).for_each(|path| sync_folder_of(path));
    Ok(())
}

fn replace(
    path: &Path,
    content: impl FnOnce(&mut File) -> std::io::Result<()>,
    waits: bool,
) -> Result<(), WriteError> {
    let temporary = temporary_path(path);
    let done = write_all(&temporary, content, waits).and_then(|()| {
        fs::rename(&temporary, path).map_err(WriteError::io("rename the temporary file to", path))
    });
    if done.is_err() {
        // The first error is the one to report; a temporary file that was never created cannot be removed.
        drop(fs::remove_file(&temporary));
    }
    done
}

fn write_all(
    path: &Path,
    content: impl FnOnce(&mut File) -> std::io::Result<()>,
    waits: bool,
) -> Result<(), WriteError> {
    let mut file = File::create(path).map_err(WriteError::io("create", path))?;
    content(&mut file).map_err(WriteError::io("write", path))?;
    if waits { file.sync_all().map_err(WriteError::io("sync", path)) } else { Ok(()) }
}

fn temporary_path(path: &Path) -> PathBuf {
    let mut name = path.file_name().map_or_else(OsString::new, OsString::from);
    name.push(TEMPORARY_ENDING);
    path.with_file_name(name)
}

/// Makes the rename durable. Not every file system can sync a folder; the file itself is whole in any case, so a
/// refusal is no error.
fn sync_folder_of(path: &Path) {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if let Ok(folder) = File::open(folder) {
        drop(folder.sync_all());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names_in(folder: &Path) -> Vec<OsString> {
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name()).collect()
    }

    #[test]
    fn a_file_is_replaced_whole_and_no_temporary_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("summary.json");
        write(&path, b"a long first version").unwrap();
        write(&path, b"second").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"second");
        assert_eq!(names_in(folder.path()), ["summary.json"]);
    }

    #[cfg(unix)]
    #[test]
    fn links_and_pipes_that_somebody_names_stay_what_they_are() {
        use std::os::unix::fs::{FileTypeExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("elsewhere")).unwrap();
        fs::write(at("elsewhere/old.svg"), "old").unwrap();
        symlink("elsewhere/old.svg", at("old.svg")).unwrap();
        symlink("elsewhere/new.svg", at("new.svg")).unwrap();
        for name in ["old.svg", "new.svg", "own.svg"] {
            write_named(&at(name), name.as_bytes()).unwrap();
            assert_eq!(fs::read_to_string(at(name)).unwrap(), name);
            assert_eq!(at(name).is_symlink(), name != "own.svg");
        }
        assert_eq!(fs::read_to_string(at("elsewhere/old.svg")).unwrap(), "old.svg");
        let pipe = at("pipe.svg");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let reader = std::thread::spawn({
            let pipe = pipe.clone();
            move || fs::read(pipe).unwrap()
        });
        write_named(&pipe, b"picture").unwrap();
        assert_eq!(reader.join().unwrap(), b"picture");
        assert!(fs::symlink_metadata(&pipe).unwrap().file_type().is_fifo());
    }

    #[test]
    fn a_temporary_left_by_a_killed_run_is_no_obstacle() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("a.csv.tmp"), "half a fi").unwrap();
        write(&folder.path().join("a.csv"), b"whole").unwrap();
        assert_eq!(names_in(folder.path()), ["a.csv"]);
    }

    #[test]
    fn a_failed_rename_leaves_no_temporary_and_names_the_step() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("taken");
        fs::create_dir_all(path.join("by a folder")).unwrap();
        let error = write(&path, b"x").unwrap_err().to_string();
        assert!(error.starts_with("cannot rename the temporary file to "), "{error}");
        assert_eq!(names_in(folder.path()), ["taken"]);
    }

    #[test]
    fn a_missing_folder_is_an_error_with_the_path() {
        let folder = tempfile::tempdir().unwrap();
        let error = write(&folder.path().join("no/such.csv"), b"x").unwrap_err();
        assert!(matches!(error, WriteError::Io { operation: "create", .. }));
        assert!(error.to_string().contains("such.csv"));
    }
}
