//! Files that a folder holds already: which of them ndda wrote, and may delete.

use std::fs::{self, File, FileType, TryLockError};
use std::io::ErrorKind;
use std::path::Path;

use super::{ENDING, OF_STAGE, OutputFolder, PREVIOUS, PROBE, TOP_FILES, WAITING};
use crate::atomic::TEMPORARY_ENDING;
use crate::write_error::WriteError;

/// A run holds a lock on its log; where files cannot be locked, none does.
pub(super) fn refuse_while_in_use(path: &Path) -> Result<(), WriteError> {
    let log = File::open(path.join(OutputFolder::LOG)).ok();
    match log.map(|log| log.try_lock_shared()) {
        Some(Err(TryLockError::WouldBlock)) => Err(WriteError::InUse { path: path.to_path_buf() }),
        _ => Ok(()),
    }
}

/// No run belongs there, whatever else is there.
pub(super) fn refuse_root_and_home(path: &Path) -> Result<(), WriteError> {
    let real = fs::canonicalize(path).map_err(WriteError::io("look at", path))?;
    let home = std::env::home_dir().and_then(|home| fs::canonicalize(home).ok());
    if real.parent().is_none() || home.as_ref() == Some(&real) {
        return Err(WriteError::NoResultFolder { path: path.to_path_buf() });
    }
    Ok(())
}

/// Names in a folder; a probe that a killed run left behind is no result.
fn names_but_probe(path: &Path) -> Result<Vec<String>, WriteError> {
    Ok(entries(path)?.into_iter().map(|(name, _)| name).filter(|name| name != PROBE).collect())
}

fn is_ours(name: &str) -> bool {
    is_top_file(name) || name == OutputFolder::FIELDS_FOLDER
}

/// A folder with files, none of which is of an earlier run, was not meant.
pub(super) fn refuse_unless_results(path: &Path) -> Result<(), WriteError> {
    let names = names_but_probe(path)?;
    let is_result = |name: &String| is_ours(name) || name == OutputFolder::MESH_REPORT;
    match names.first() {
        Some(found) if !names.iter().any(is_result) => {
            Err(WriteError::NotOurs { path: path.to_path_buf(), found: found.clone() })
        }
        _ => Ok(()),
    }
}

pub(super) fn refuse_unless_empty(path: &Path) -> Result<(), WriteError> {
    let names = names_but_probe(path)?;
    let is_result = |name: &&String| is_ours(name) || *name == OutputFolder::MESH_REPORT;
    if let Some(found) = names.iter().find(is_result) {
        return Err(WriteError::EarlierRun { path: path.to_path_buf(), found: found.clone() });
    }
    match names.first() {
        Some(found) => Err(WriteError::NotOurs { path: path.to_path_buf(), found: found.clone() }),
        None => Ok(()),
    }
}

/// Deletes what ndda writes. Looks at everything first, so that nothing is deleted when something is in the way.
pub(super) fn delete_earlier_run(path: &Path) -> Result<(), WriteError> {
    let (mut has_frames, mut of_stages) = (false, Vec::new());
    for (name, kind) in entries(path)? {
        let in_the_way = |needed| Err(WriteError::InTheWay { path: path.join(&name), needed });
        if is_top_file(&name) && kind.is_dir() {
            return in_the_way("file");
        }
        if is_of_stage(&name) {
            of_stages.push(path.join(&name));
        }
        if name == OutputFolder::FIELDS_FOLDER {
            // A link is not followed: what it points to may be somebody else's.
            if !kind.is_dir() {
                return in_the_way("folder");
            }
            has_frames = true;
        }
    }
    let frames = path.join(OutputFolder::FIELDS_FOLDER);
    let mut frame_files = Vec::new();
    if has_frames {
        for (name, kind) in entries(&frames)? {
            if is_frame(&name) {
                if kind.is_dir() {
                    return Err(WriteError::InTheWay { path: frames.join(&name), needed: "file" });
                }
                frame_files.push(frames.join(name));
            }
        }
    }
    // Checkpoints go first: what has lost its rows and frames must not be resumed.
    for name in [OutputFolder::CHECKPOINT, PREVIOUS, WAITING, OutputFolder::FIELDS_INDEX] {
        delete(&path.join(name))?;
    }
    for file in of_stages.iter().chain(&frame_files) {
        delete(file)?;
    }
    for name in TOP_FILES {
        delete(&path.join(name))?;
        delete(&path.join(format!("{name}{TEMPORARY_ENDING}")))?;
    }
    Ok(())
}

pub(super) fn delete(path: &Path) -> Result<(), WriteError> {
    match fs::remove_file(path) {
        Err(e) if e.kind() != ErrorKind::NotFound => Err(WriteError::io("delete", path)(e)),
        _ => Ok(()),
    }
}

/// Names in a folder, sorted, each with its own kind (a link is a link).
pub(super) fn entries(path: &Path) -> Result<Vec<(String, FileType)>, WriteError> {
    let mut found = Vec::new();
    for entry in fs::read_dir(path).map_err(WriteError::io("list", path))? {
        let entry = entry.map_err(WriteError::io("list", path))?;
        let kind = entry.file_type().map_err(WriteError::io("look at", &entry.path()))?;
        found.push((entry.file_name().to_string_lossy().into_owned(), kind));
    }
    found.sort_by(|a, b| a.0.cmp(&b.0));
    Ok(found)
}

fn is_top_file(name: &str) -> bool {
    let name = name.strip_suffix(TEMPORARY_ENDING).unwrap_or(name);
    TOP_FILES.contains(&name) || is_of_stage(name)
}

/// Whether it is the name of a checkpoint at the end of a stage.
fn is_of_stage(name: &str) -> bool {
    name.strip_suffix(TEMPORARY_ENDING).unwrap_or(name).starts_with(OF_STAGE) && name.contains(ENDING)
}

/// Whether `name` is `frame_` or `bolts_`, six digits or more, `.vtu`, and perhaps the temporary ending.
fn is_frame(name: &str) -> bool {
    let name = name.strip_suffix(TEMPORARY_ENDING).unwrap_or(name);
    let number = ["frame_", "bolts_"]
        .into_iter()
        .find_map(|kind| name.strip_prefix(kind))
        .and_then(|rest| rest.strip_suffix(".vtu"));
    number.is_some_and(|n| n.len() >= 6 && n.bytes().all(|b| b.is_ascii_digit()))
}
