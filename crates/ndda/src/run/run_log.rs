//! `run.log`: what a run was, what it did and when, for a person.

use std::fs::{File, TryLockError};
use std::io::Write;
use std::path::PathBuf;
use std::time::{Instant, SystemTime};

use ndda_io::{OutputFolder, WriteError};

use super::identity::Identity;
use crate::machine;
use crate::numbers::counted;

/// Text before the scene's fingerprint.
const CRC32: &str = "CRC-32 of its text with the chosen values ";

/// The fingerprint of the scene that the log in a folder begins with, if there is a log.
pub fn scene_crc32(folder: &OutputFolder) -> Option<u32> {
    let text = std::fs::read_to_string(folder.log()).ok()?;
    let (_, rest) = text.split_once(CRC32)?;
    u32::from_str_radix(rest.get(..8)?, 16).ok()
}

/// A log that grows line by line; what has been said survives a crash.
pub struct RunLog {
    file: File,
    path: PathBuf,
    started: Instant,
}

impl RunLog {
    /// Begins the log of a run, or goes on with the one that is there.
    ///
    /// # Errors
    /// [`WriteError`] when it cannot be written, or another run is writing it.
    pub fn open(folder: &OutputFolder, started: Instant) -> Result<Self, WriteError> {
        let path = folder.log();
        let file = File::options().create(true).append(true).open(&path);
        let file = file.map_err(WriteError::io("open", &path))?;
        // Held until the run ends, however it ends.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(WriteError::InUse { path: folder.path().to_path_buf() });
        }
        Ok(Self { file, path, started })
    }

    /// Says what is about to run, and on what.
    ///
    /// # Errors
    /// [`WriteError`] when it cannot be written.
    pub fn begin(&mut self, identity: &Identity, threads: usize) -> Result<(), WriteError> {
        let version = env!("CARGO_PKG_VERSION");
        let (commit, rustc, features) = (machine::COMMIT, machine::RUSTC, machine::FEATURES);
        let now = humantime::format_rfc3339_seconds(SystemTime::now());
        self.line(&format!("ndda {version}, commit {commit}, {rustc}, features: {features}"))?;
        self.line(&format!("{now}, {} on {}", machine::processor(), counted(threads, "thread", "threads")))?;
        let crc32 = identity.crc32();
        self.line(&format!("scene {}, {CRC32}{crc32:08x}:", identity.file.display()))?;
        self.block(&identity.text)
    }

    /// Adds a line with the seconds since the start.
    ///
    /// # Errors
    /// [`WriteError`] when it cannot be written.
    pub fn line(&mut self, text: &str) -> Result<(), WriteError> {
        let spent_s = self.started.elapsed().as_secs_f64();
        self.add(&format!("[{spent_s:10.3} s] {text}\n"))
    }

    /// Adds lines as they are, set off.
    ///
    /// # Errors
    /// [`WriteError`] when they cannot be written.
    pub fn block(&mut self, text: &str) -> Result<(), WriteError> {
        self.add(&text.lines().map(|line| format!("    {line}\n")).collect::<String>())
    }

    fn add(&mut self, text: &str) -> Result<(), WriteError> {
        self.file.write_all(text.as_bytes()).map_err(WriteError::io("write", &self.path))
    }
}
