//! The files that a scene names, and what was in them: a run goes on only with the same ones.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::limited;
use crate::scene::{Discontinuity, Domain, Ground, Hold, Scene, Shape};

/// Bytes read at a time.
const CHUNK: usize = 1 << 16;

/// A file that a scene names, as it was when the run began.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct OutsideFile {
    /// Its path, from the folder of the scene.
    pub path: PathBuf,
    /// Its length [B] and CRC-32; none if it was not there, as TetGen's `.face` may not be.
    pub content: Option<(u64, u32)>,
}

/// A file that a scene names and that is not what it was when the run began.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum OutsideFileError {
    /// It is gone.
    #[error("{}, which the scene names, is missing or cannot be read: put it back, or run the scene again", path.display())]
    Missing {
        /// The file.
        path: PathBuf,
    },
    /// Its content is another one.
    #[error("{}, which the scene names, has changed since the run began: put the old one back, or run the scene again", path.display())]
    Changed {
        /// The file.
        path: PathBuf,
    },
}

impl OutsideFile {
    /// All files that a scene names, with those that belong to them, as they are now; `folder` is that of the scene.
    pub fn all_of(scene: &Scene, folder: &Path) -> Vec<Self> {
        let mut paths = Vec::new();
        for name in names(scene) {
            add_with_companions(&mut paths, folder, PathBuf::from(name));
        }
        paths.into_iter().map(|path| Self { content: content(&folder.join(&path)), path }).collect()
    }
}

impl OutsideFile {
    /// Holds the files against what they are now.
    ///
    /// # Errors
    /// [`OutsideFileError`] of the first that is missing or has changed.
    pub fn verify_all(files: &[Self], folder: &Path) -> Result<(), OutsideFileError> {
        for file in files {
            let path = folder.join(&file.path);
            match (file.content, content(&path)) {
                (was, is) if was == is => {}
                (Some(_), None) => return Err(OutsideFileError::Missing { path }),
                _ => return Err(OutsideFileError::Changed { path }),
            }
        }
        Ok(())
    }
}

/// Meshes, surfaces, terrain, tables of discs, records and materials.
fn names(scene: &Scene) -> Vec<&str> {
    let shapes = scene.blocks.iter().filter_map(|block| match &block.shape {
        Shape::Surface { file, .. } | Shape::Mesh { file, .. } => Some(file.as_str()),
        _ => None,
    });
    let domains = scene.rock.iter().filter_map(|rock| match &rock.domain {
        Domain::File { file, .. } | Domain::TerrainFile { file, .. } => Some(file.as_str()),
        _ => None,
    });
    let discs = scene.rock.iter().flat_map(|rock| &rock.joints).filter_map(|joint| match joint {
        Discontinuity::Discs { file, .. } => Some(file.as_str()),
        _ => None,
    });
    let records = scene.supports.iter().filter_map(|support| match &support.hold {
        Hold::Acceleration { file, .. } => Some(file.as_str()),
        _ => None,
    });
    let waves = scene.quiet.iter().flat_map(|quiet| &quiet.incident).map(|wave| wave.record.file.as_str());
    let shaking = scene.supports.iter().filter_map(|support| match &support.hold {
        Hold::Shaking(components) => Some(components),
        _ => None,
    });
    let components = shaking.flatten().map(|component| component.record.file.as_str());
    let terrain = scene.rockfall.iter().filter_map(|rockfall| match &rockfall.terrain {
        Ground::File { file, .. } => Some(file.as_str()),
        Ground::Heights { .. } => None,
    });
    let materials = scene.include.iter().map(String::as_str);
    shapes
        .chain(domains)
        .chain(discs)
        .chain(records)
        .chain(waves)
        .chain(components)
        .chain(terrain)
        .chain(materials)
        .collect()
}

/// Adds a file once, and what is read along with it: the other files of a TetGen mesh, and what a Gmsh script names in
/// quotation marks.
fn add_with_companions(paths: &mut Vec<PathBuf>, folder: &Path, path: PathBuf) {
    if paths.contains(&path) {
        return;
    }
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    paths.push(path.clone());
    match ending.as_str() {
        "node" | "ele" | "face" => {
            for ending in ["node", "ele", "face"] {
                let other = path.with_extension(ending);
                if !paths.contains(&other) {
                    paths.push(other);
                }
            }
        }
        "geo" => {
            let text = limited::file(&folder.join(&path)).unwrap_or_default();
            let beside = path.parent().unwrap_or(Path::new("")).to_path_buf();
            // Every second piece between quotation marks is a word in them.
            for word in String::from_utf8_lossy(&text).split('"').skip(1).step_by(2) {
                let named = beside.join(word);
                if !word.is_empty() && folder.join(&named).is_file() {
                    add_with_companions(paths, folder, named);
                }
            }
        }
        _ => {}
    }
}

/// Length and CRC-32 of a file; none if it cannot be read, or is a device, which may have no end.
fn content(path: &Path) -> Option<(u64, u32)> {
    let mut file = File::open(path).ok().filter(|file| file.metadata().is_ok_and(|known| known.is_file()))?;
    let (mut hasher, mut length, mut chunk) = (crc32fast::Hasher::new(), 0, vec![0; CHUNK]);
    loop {
        match file.read(&mut chunk).ok()? {
            0 => return Some((length, hasher.finalize())),
            read => {
                hasher.update(&chunk[..read]);
                length += read as u64;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = "(title: \"t\", time: (step_s: 1e-3, end_s: 1),
        materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.2, density_kg_m3: 2500)],
        blocks: [
            (name: \"a\", material: \"rock\", shape: Mesh(file: \"a.ele\")),
            (name: \"b\", material: \"rock\", shape: Surface(file: \"b.stl\")),
            (name: \"c\", material: \"rock\", shape: Mesh(file: \"c.geo\")),
        ],
        rock: [(material: \"rock\", domain: File(file: \"d.obj\"))],
        supports: [(block: \"a\", on: All, hold: Acceleration(file: \"quake.csv\", direction: (1, 0, 0)))], contact: Off)";

    fn folder() -> (tempfile::TempDir, Scene) {
        let folder = tempfile::tempdir().unwrap();
        for name in ["a.ele", "a.node", "b.stl", "part.step", "d.obj", "quake.csv"] {
            std::fs::write(folder.path().join(name), name).unwrap();
        }
        std::fs::write(folder.path().join("c.geo"), "Merge \"part.step\"; Physical Volume(\"x\") = 1;")
            .unwrap();
        (folder, crate::scene::read::load_text("scene.ron", SCENE, &[], None).unwrap().scene)
    }

    #[test]
    fn every_file_that_is_read_is_listed_once() {
        let (folder, scene) = folder();
        let found = OutsideFile::all_of(&scene, folder.path());
        let names: Vec<String> = found.iter().map(|file| file.path.display().to_string()).collect();
        assert_eq!(names, ["a.ele", "a.node", "a.face", "b.stl", "c.geo", "part.step", "d.obj", "quake.csv"]);
        assert!(found.iter().all(|file| file.content.is_none() == (file.path == Path::new("a.face"))));
        assert_eq!(OutsideFile::verify_all(&found, folder.path()), Ok(()));
    }

    #[test]
    fn each_file_that_changes_goes_or_comes_is_named() {
        let (folder, scene) = folder();
        let found = OutsideFile::all_of(&scene, folder.path());
        for file in &found {
            let path = folder.path().join(&file.path);
            let old = std::fs::read(&path).ok();
            // Of the same length, where there is any.
            let mut other = old.clone().unwrap_or_else(|| b"new".to_vec());
            other[0] ^= 1;
            std::fs::write(&path, other).unwrap();
            assert_eq!(
                OutsideFile::verify_all(&found, folder.path()),
                Err(OutsideFileError::Changed { path: path.clone() })
            );
            std::fs::remove_file(&path).unwrap();
            if let Some(old) = old {
                assert_eq!(
                    OutsideFile::verify_all(&found, folder.path()),
                    Err(OutsideFileError::Missing { path: path.clone() })
                );
                std::fs::write(&path, old).unwrap();
            }
        }
        assert_eq!(OutsideFile::verify_all(&found, folder.path()), Ok(()));
    }
}
