//! The output folder: made ready before the run begins, and never at the cost of somebody's files.

mod earlier_run;
mod shared;

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

use crate::write_error::WriteError;

use earlier_run::{
    delete, delete_earlier_run, entries, refuse_root_and_home, refuse_unless_empty, refuse_unless_results,
    refuse_while_in_use,
};

/// Files of `ndda picture`, if no other name is given.
const PICTURES: [&str; 3] = ["picture.png", "picture.svg", "animation.png"];
/// The checkpoint before.
const PREVIOUS: &str = "checkpoint.previous.ndda";
/// A checkpoint that is whole and not yet in its place.
const WAITING: &str = "checkpoint.new.ndda";
/// Beginning and ending of the name of a checkpoint at the end of a stage.
const OF_STAGE: &str = "checkpoint.stage.";
const ENDING: &str = ".ndda";

/// Files at the top of the folder, in the order in which an earlier run is deleted: an index before what it lists.
const TOP_FILES: [&str; 18] = [
    OutputFolder::CHECKPOINT,
    PREVIOUS,
    WAITING,
    OutputFolder::REPORT,
    PICTURES[0],
    PICTURES[1],
    PICTURES[2],
    OutputFolder::FIELDS_INDEX,
    OutputFolder::HISTORY,
    OutputFolder::CONTACTS,
    OutputFolder::BLOCKS,
    OutputFolder::BOLTS_INDEX,
    OutputFolder::BOLTS,
    OutputFolder::PARQUET[0],
    OutputFolder::PARQUET[1],
    OutputFolder::PARQUET[2],
    OutputFolder::LOG,
    OutputFolder::SUMMARY,
];
const PROBE: &str = "ndda-probe.tmp";
// Enough to show a full disk; a mebibyte takes as long as the steps of a small scene.
const PROBE_BYTES: usize = 1 << 17;

/// A folder that exists, holds no earlier run, and can be written to.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputFolder {
    path: PathBuf,
}

impl OutputFolder {
    /// File of the end-of-run summary.
    pub const SUMMARY: &str = "summary.json";
    /// File of the history.
    pub const HISTORY: &str = "history.csv";
    /// File of the contacts.
    pub const CONTACTS: &str = "contacts.csv";
    /// File of the motion of blocks.
    pub const BLOCKS: &str = "blocks.csv";
    /// File of the bolts.
    pub const BOLTS: &str = "bolts.csv";
    /// File that lists the frames of bolts.
    pub const BOLTS_INDEX: &str = "bolts.pvd";
    /// The tables in columnar form.
    pub const PARQUET: [&str; 3] = ["history.parquet", "contacts.parquet", "blocks.parquet"];
    /// The log of the run.
    pub const LOG: &str = "run.log";
    /// File that lists the frames of fields.
    pub const FIELDS_INDEX: &str = "fields.pvd";
    /// File of the report as a page.
    pub const REPORT: &str = "report.html";
    /// The newest checkpoint.
    pub const CHECKPOINT: &str = "checkpoint.ndda";
    /// Folder of the frames.
    pub const FIELDS_FOLDER: &str = "fields";
    /// Report of `ndda mesh`, which keeps its other files beside it.
    pub const MESH_REPORT: &str = "mesh.json";

    /// Makes the folder at `path` ready for a run; parents are created.
    ///
    /// With `force` the files of an earlier run are deleted: those that ndda writes, by name, and nothing else; a folder
    /// that holds files, but none of an earlier run, is refused all the same, and so are the root and the home folder.
    /// 128 kibibytes are written and removed again, so that a read-only folder or a full disk shows up now.
    ///
    /// # Errors
    /// [`WriteError::IsFile`] when `path` is a file; without `force`, [`WriteError::EarlierRun`] or
    /// [`WriteError::NotOurs`] when the folder is not empty; [`WriteError::InTheWay`] when something of another
    /// kind has one of our names; [`WriteError::InUse`] while another run writes there; [`WriteError::Io`] when the folder cannot be created or written to.
    pub fn create(path: &Path, force: bool) -> Result<Self, WriteError> {
        if path.exists() && !path.is_dir() {
            return Err(WriteError::IsFile { path: path.to_path_buf() });
        }
        fs::create_dir_all(path).map_err(WriteError::io("create the folder", path))?;
        refuse_root_and_home(path)?;
        refuse_while_in_use(path)?;
        if force {
            refuse_unless_results(path)?;
            delete_earlier_run(path)?;
        } else {
            refuse_unless_empty(path)?;
        }
        probe(path)?;
        Ok(Self { path: path.to_path_buf() })
    }

    /// Checks that a folder of other results is not that of a run.
    ///
    /// # Errors
    /// [`WriteError::RunFolder`] when it is.
    pub fn refuse_run(path: &Path) -> Result<(), WriteError> {
        let found =
            [OutputFolder::SUMMARY, OutputFolder::LOG, OutputFolder::HISTORY, OutputFolder::CHECKPOINT]
                .into_iter()
                .find(|name| path.join(name).is_file());
        let refuse = |found: &str| WriteError::RunFolder { path: path.to_path_buf(), found: found.into() };
        found.map_or(Ok(()), |found| Err(refuse(found)))
    }

    /// Name of a frame's file: `frame_000012.vtu`.
    pub fn frame_name(number: usize) -> String {
        format!("frame_{number:06}.vtu")
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The folder of a run that is to go on, as it is.
    ///
    /// # Errors
    /// [`WriteError`] when it is no folder, another run is writing to it, or nothing can be written there.
    pub fn open(path: &Path) -> Result<Self, WriteError> {
        entries(path)?;
        refuse_while_in_use(path)?;
        probe(path)?;
        Ok(Self { path: path.to_path_buf() })
    }

    /// Path of the newest checkpoint.
    pub fn checkpoint(&self) -> PathBuf {
        self.path.join(OutputFolder::CHECKPOINT)
    }

    /// Path of the checkpoint before.
    pub(crate) fn previous_checkpoint(&self) -> PathBuf {
        self.path.join(PREVIOUS)
    }

    /// Where a new one waits until it is whole.
    pub(crate) fn waiting_checkpoint(&self) -> PathBuf {
        self.path.join(WAITING)
    }

    /// Name of the checkpoint at the end of a stage.
    pub fn stage_checkpoint_name(stage: &str) -> String {
        format!("{OF_STAGE}{stage}{ENDING}")
    }

    /// Path of the checkpoint at the end of a stage.
    pub fn stage_checkpoint(&self, stage: &str) -> PathBuf {
        self.path.join(Self::stage_checkpoint_name(stage))
    }

    /// Path of the summary.
    pub fn summary(&self) -> PathBuf {
        self.path.join(OutputFolder::SUMMARY)
    }

    /// Path of the history.
    pub fn history(&self) -> PathBuf {
        self.path.join(OutputFolder::HISTORY)
    }

    /// Path of the contacts.
    pub fn contacts(&self) -> PathBuf {
        self.path.join(OutputFolder::CONTACTS)
    }

    /// Path of the motion of blocks.
    pub fn blocks(&self) -> PathBuf {
        self.path.join(OutputFolder::BLOCKS)
    }

    /// Path of the log.
    pub fn log(&self) -> PathBuf {
        self.path.join(OutputFolder::LOG)
    }

    /// Path of the bolts.
    pub fn bolts(&self) -> PathBuf {
        self.path.join(OutputFolder::BOLTS)
    }

    /// Path of the list of frames of bolts.
    pub fn bolts_index(&self) -> PathBuf {
        self.path.join(OutputFolder::BOLTS_INDEX)
    }

    /// Path of the list of frames.
    pub fn fields_index(&self) -> PathBuf {
        self.path.join(OutputFolder::FIELDS_INDEX)
    }
}

fn probe(folder: &Path) -> Result<(), WriteError> {
    let path = folder.join(PROBE);
    delete(&path)?;
    let written = write_probe(&path);
    let removed = delete(&path);
    written.and(removed)
}

fn write_probe(path: &Path) -> Result<(), WriteError> {
    let mut file = File::create_new(path).map_err(WriteError::io("create", path))?;
    file.write_all(&vec![0x5a; PROBE_BYTES]).map_err(WriteError::io("write", path))?;
    file.sync_all().map_err(WriteError::io("sync", path))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names_in(folder: &Path) -> Vec<String> {
        entries(folder).unwrap().into_iter().map(|(name, _)| name).collect()
    }

    fn earlier_run(folder: &Path) {
        fs::create_dir_all(folder.join(OutputFolder::FIELDS_FOLDER)).unwrap();
        for name in ["summary.json", "history.csv", "fields.pvd", "fields.pvd.tmp", "fields/frame_000000.vtu"]
        {
            fs::write(folder.join(name), "old").unwrap();
        }
    }

    #[test]
    fn a_new_folder_is_created_with_its_parents_and_left_empty() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out/../out/sliding");
        let output = OutputFolder::create(&path, false).unwrap();
        assert_eq!(names_in(output.path()), [""; 0]);
        assert_eq!(output.summary(), path.join("summary.json"));
        fs::write(path.join(PROBE), "left by a killed run").unwrap();
        OutputFolder::create(&path, false).unwrap();
        assert_eq!(names_in(output.path()), [""; 0]);
    }

    #[test]
    fn an_earlier_run_is_refused_and_replaced_only_by_force() {
        let folder = tempfile::tempdir().unwrap();
        earlier_run(folder.path());
        let error = OutputFolder::create(folder.path(), false).unwrap_err();
        assert!(matches!(error, WriteError::EarlierRun { .. }));
        assert!(error.to_string().contains("--force") && error.to_string().contains("--out"));
        assert_eq!(fs::read(folder.path().join("history.csv")).unwrap(), b"old");
        OutputFolder::create(folder.path(), true).unwrap();
        assert_eq!(names_in(folder.path()), ["fields"]);
        assert_eq!(names_in(&folder.path().join("fields")), [""; 0]);
    }

    #[test]
    fn force_deletes_nothing_that_ndda_did_not_write() {
        let folder = tempfile::tempdir().unwrap();
        earlier_run(folder.path());
        let theirs = [
            "thesis.tex",
            "history.csv.bak",
            "fields/frame_1.vtu",
            "fields/frame_00000x.vtu",
            "fields/a.png",
        ];
        for name in theirs {
            fs::write(folder.path().join(name), "theirs").unwrap();
        }
        OutputFolder::create(folder.path(), true).unwrap();
        assert_eq!(names_in(folder.path()), ["fields", "history.csv.bak", "thesis.tex"]);
        for name in theirs {
            assert_eq!(fs::read(folder.path().join(name)).unwrap(), b"theirs");
        }
    }

    #[test]
    fn a_folder_with_other_files_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("thesis.tex"), "theirs").unwrap();
        let error = OutputFolder::create(folder.path(), false).unwrap_err();
        assert!(matches!(&error, WriteError::NotOurs { found, .. } if found == "thesis.tex"));
        // With `force`, too: nothing in it says that results were ever meant to go there.
        let error = OutputFolder::create(folder.path(), true).unwrap_err();
        assert!(matches!(&error, WriteError::NotOurs { found, .. } if found == "thesis.tex"));
        assert_eq!(names_in(folder.path()), ["thesis.tex"]);
    }

    #[test]
    fn the_root_and_the_home_folder_are_refused_whatever_they_hold() {
        let home = std::env::home_dir().filter(|home| home.is_dir());
        for path in [Some(PathBuf::from("/")), Some(PathBuf::from("/usr/..")), home].into_iter().flatten() {
            for force in [false, true] {
                let error = OutputFolder::create(&path, force).unwrap_err();
                assert!(matches!(error, WriteError::NoResultFolder { .. }), "{}: {error}", path.display());
            }
        }
    }

    #[test]
    fn a_file_in_place_of_the_folder_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out");
        fs::write(&path, "a file").unwrap();
        for force in [false, true] {
            let error = OutputFolder::create(&path, force).unwrap_err();
            assert!(matches!(error, WriteError::IsFile { .. }));
            let below = OutputFolder::create(&path.join("deeper"), force).unwrap_err().to_string();
            assert!(below.contains("a part of this path is a file"), "{below}");
        }
        assert!(OutputFolder::create(Path::new(""), false).is_err());
    }

    #[test]
    fn a_folder_with_the_name_of_a_file_of_ours_is_never_deleted() {
        let folder = tempfile::tempdir().unwrap();
        earlier_run(folder.path());
        fs::remove_file(folder.path().join("summary.json")).unwrap();
        fs::create_dir(folder.path().join("summary.json")).unwrap();
        let error = OutputFolder::create(folder.path(), true).unwrap_err();
        assert!(matches!(error, WriteError::InTheWay { needed: "file", .. }));
        assert!(
            folder.path().join("history.csv").exists(),
            "nothing is deleted when something is in the way"
        );
    }

    #[cfg(unix)]
    #[test]
    fn force_does_not_follow_links_out_of_the_folder() {
        let (folder, other) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        earlier_run(other.path());
        let link = |name: &str| {
            std::os::unix::fs::symlink(other.path().join(name), folder.path().join(name)).unwrap();
        };
        link("summary.json");
        OutputFolder::create(folder.path(), true).unwrap();
        link("fields");
        let error = OutputFolder::create(folder.path(), true).unwrap_err();
        assert!(matches!(error, WriteError::InTheWay { needed: "folder", .. }));
        assert!(other.path().join("summary.json").exists());
        assert!(other.path().join("fields/frame_000000.vtu").exists());
    }

    #[cfg(unix)]
    #[test]
    fn a_read_only_folder_is_found_before_the_run() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o555)).unwrap();
        // An administrator may write anywhere; then there is nothing to find.
        if File::create_new(folder.path().join("may-i")).is_ok() {
            return;
        }
        let error = OutputFolder::create(folder.path(), false).unwrap_err().to_string();
        assert!(error.contains("ndda-probe.tmp") && error.contains("choose a folder"), "{error}");
    }
}
