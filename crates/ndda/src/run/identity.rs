//! Which scene a run is of.

use std::path::{Path, PathBuf};

use ndda_io::checkpoint;
use ndda_io::outside_files::OutsideFile;
use ndda_io::scene::Scene;
use serde::{Deserialize, Serialize};

use super::twin::Sensitivity;

/// Which scene a run is of.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Identity {
    /// Name of the run.
    pub name: String,
    /// The scene's text, overrides included.
    pub text: String,
    /// The scene's file, from the root of the file system: its meshes are beside it.
    pub file: PathBuf,
    /// CRC-32 of that file when the run began; none of a scene that is in no file.
    pub file_crc32: Option<u32>,
    /// The files that the scene names, as they were when the run began.
    pub outside: Vec<OutsideFile>,
    /// When it is repeated after its end.
    pub sensitivity: Sensitivity,
}

impl Identity {
    /// Of a scene that is read from `file`, by its text and the files that it names.
    pub fn new(name: String, text: String, file: PathBuf, scene: &Scene) -> Self {
        let outside = OutsideFile::all_of(scene, folder_of(&file));
        let file_crc32 = crc32_of(&file);
        Self { name, text, file, file_crc32, outside, sensitivity: Sensitivity::default() }
    }

    /// Folder of the scene.
    pub fn folder(&self) -> &Path {
        folder_of(&self.file)
    }

    /// That the scene's file is another by now than when the run began, in words; none where it is not, or is gone.
    pub fn edited(&self) -> Option<String> {
        let is_edited = self.file_crc32? != crc32_of(&self.file)?;
        let file = self.file.display();
        is_edited.then(|| {
            format!("{file} has changed since the run began: the run goes on with the scene as it was; `ndda run` runs the new one from its start")
        })
    }

    /// CRC-32 of the scene's text.
    pub fn crc32(&self) -> u32 {
        checkpoint::fingerprint(&self.text)
    }
}

/// CRC-32 of a text file, if it can be read.
fn crc32_of(file: &Path) -> Option<u32> {
    Some(checkpoint::fingerprint(&std::fs::read_to_string(file).ok()?))
}

fn folder_of(file: &Path) -> &Path {
    file.parent().unwrap_or(Path::new("."))
}
