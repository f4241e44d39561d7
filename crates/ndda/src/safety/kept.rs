//! The state of rest on disk, so that a call that goes on with the trials of another need not look for it again.

use std::path::{Path, PathBuf};

use ndda_io::scene::Scene;
use ndda_io::{WriteError, checkpoint};
use ndda_solver::Snapshot;
use serde::{Deserialize, Serialize};

use super::free_blocks::Moved;
use super::trial::Start;
use crate::{machine, places};

/// A state of rest, and which scene's it is.
#[derive(Serialize, Deserialize)]
pub struct Kept {
    kind: String,
    version: String,
    scene_crc32: u32,
    /// CRC-32 of its blocks, whose files may have changed.
    pub blocks_crc32: u32,
    /// How many times its strength the scene came to rest with.
    pub strength: f64,
    /// Blocks that came to rest elsewhere.
    pub moved: Vec<Moved>,
    /// The state.
    pub snapshot: Snapshot,
}

const KIND: &str = "ndda.rest/1";

fn file(out: &Path) -> PathBuf {
    out.join(places::REST)
}

fn version() -> String {
    format!("{} {}", env!("CARGO_PKG_VERSION"), machine::COMMIT)
}

impl Kept {
    /// What a folder holds of a scene; none where that is another one, of another version, or damaged.
    pub fn read(out: &Path, scene: &Scene) -> Option<Self> {
        let kept: Self = checkpoint::read_file(&file(out)).ok()??;
        let asked = (KIND, version(), checkpoint::fingerprint(scene));
        (asked == (kept.kind.as_str(), kept.version.clone(), kept.scene_crc32)).then_some(kept)
    }

    /// Writes the state of rest of a scene to a folder.
    pub fn write(out: &Path, scene: &Scene, start: &Start, strength: f64) -> Result<(), WriteError> {
        let kept = Self {
            kind: KIND.into(),
            version: version(),
            scene_crc32: checkpoint::fingerprint(scene),
            blocks_crc32: start.blocks_crc32,
            strength,
            moved: start.moved.clone(),
            snapshot: start.snapshot.clone(),
        };
        checkpoint::write_file(&file(out), &kept)
    }

    /// Forgets what a folder holds.
    ///
    /// # Errors
    /// The file cannot be removed.
    pub fn forget(out: &Path) -> std::io::Result<()> {
        match std::fs::remove_file(file(out)) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(error),
            _ => Ok(()),
        }
    }
}
