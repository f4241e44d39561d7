//! Checkpoints: all that a run needs to go on, in one file that is whole or not there; the one before is kept.
//!
//! ```text
//! "NDDA-CHECKPOINT\n"  format [u32]  length of the content [u64]  content  CRC-32 of all before [u32]
//! ```
//!
//! Numbers are little-endian. The content is a value in the postcard encoding, whose floats keep their bits.

use std::fs;
use std::io::{BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::atomic;
use crate::results::folder::OutputFolder;
use crate::write_error::WriteError;

/// Changes whenever what is kept changes.
pub(crate) const FORMAT: u32 = 36;

const MAGIC: &[u8; 16] = b"NDDA-CHECKPOINT\n";
const HEADER: usize = 16 + 4 + 8;
const TRAILER: usize = 4;
/// Bytes that are written at a time.
const PIECE: usize = 1 << 16;

/// Why a checkpoint cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum CheckpointError {
    /// There is none.
    #[error("{} holds no checkpoint: run the scene again with `ndda run`", folder.display())]
    None {
        /// The output folder.
        folder: PathBuf,
    },
    /// The file cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// The file is not a checkpoint, or not a whole one.
    #[error("{} is damaged ({what}): delete it to go on from the one before, if there is one", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// The damage.
        what: String,
    },
    /// The file belongs to another run.
    #[error("{} is of another run ({what}): put it back where it came from", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// The evidence.
        what: String,
    },
    /// The file is of another version.
    #[error("{} is of format {found}, this ndda reads format {FORMAT}: resume it with the ndda that wrote it", path.display())]
    Version {
        /// The file.
        path: PathBuf,
        /// Its format.
        found: u32,
    },
}

/// CRC-32 of a value's encoding: equal values, bit for bit, have equal ones.
pub fn fingerprint(value: &impl Serialize) -> u32 {
    let mut nowhere = std::io::sink();
    let mut encoding = Encoding::of(&mut nowhere);
    encoding.add(value).map_or(0, |()| encoding.crc.finalize())
}

/// Bytes of a value's encoding.
pub fn size(value: &impl Serialize) -> u64 {
    let mut nowhere = std::io::sink();
    let mut encoding = Encoding::of(&mut nowhere);
    encoding.add(value).map_or(0, |()| encoding.bytes)
}

/// A value as bytes, to hand it to another process of the same program.
pub fn to_bytes(value: &impl Serialize) -> Vec<u8> {
    let mut bytes = Vec::new();
    let encoded = Encoding::of(&mut bytes).add(value);
    encoded.map_or(Vec::new(), |()| bytes)
}

/// The value that [`to_bytes`] was given; none where it could not be encoded.
pub fn from_bytes<T: DeserializeOwned>(bytes: &[u8]) -> Option<T> {
    postcard::from_bytes(bytes).ok()
}

/// Encoded values on their way to a file, never in memory as a whole. Wherever they go, each type is encoded by the same code.
struct Encoding<'a> {
    to: &'a mut dyn Write,
    crc: crc32fast::Hasher,
    bytes: u64,
    /// Why the file cannot be written: the encoder would not say.
    failed: Option<std::io::Error>,
}

impl<'a> Encoding<'a> {
    fn of(to: &'a mut dyn Write) -> Self {
        Self { to, crc: crc32fast::Hasher::new(), bytes: 0, failed: None }
    }

    fn add(&mut self, value: &impl Serialize) -> postcard::Result<()> {
        let mut whole = BufWriter::with_capacity(PIECE, &mut *self);
        postcard::to_io(value, &mut whole)?;
        whole.flush().map_err(|_| postcard::Error::SerializeBufferFull)
    }
}

impl Write for Encoding<'_> {
    fn write(&mut self, piece: &[u8]) -> std::io::Result<usize> {
        if let Err(error) = self.to.write_all(piece) {
            let kind = error.kind();
            self.failed = Some(error);
            return Err(kind.into());
        }
        self.crc.update(piece);
        self.bytes += piece.len() as u64;
        Ok(piece.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.to.flush()
    }
}

impl OutputFolder {
    /// Writes a checkpoint; the file that was there becomes the previous one.
    ///
    /// # Errors
    /// [`WriteError`] when the value cannot be encoded or the file not be written; the files before are then as they were.
    pub fn write_checkpoint(&self, value: &impl Serialize) -> Result<(), WriteError> {
        let (path, previous) = (self.checkpoint(), self.previous_checkpoint());
        let waiting = self.waiting_checkpoint();
        write_file(&waiting, value)?;
        match fs::rename(&path, &previous) {
            Err(e) if e.kind() != ErrorKind::NotFound => return Err(WriteError::io("rename", &path)(e)),
            _ => {}
        }
        fs::rename(&waiting, &path).map_err(WriteError::io("rename the new checkpoint to", &path))
    }
}

/// Writes a checkpoint to a file of its own, whole or not at all.
///
/// # Errors
/// [`WriteError`] when the value cannot be encoded or the file not be written.
pub fn write_file(path: &Path, value: &impl Serialize) -> Result<(), WriteError> {
    let refused = |e: postcard::Error| WriteError::Encode { path: path.to_path_buf(), reason: e.to_string() };
    let mut nowhere = std::io::sink();
    let mut counted = Encoding::of(&mut nowhere);
    counted.add(value).map_err(refused)?;
    atomic::write_by(path, |file| {
        let mut encoding = Encoding::of(file);
        encoding.write_all(MAGIC)?;
        encoding.write_all(&FORMAT.to_le_bytes())?;
        encoding.write_all(&counted.bytes.to_le_bytes())?;
        if let Err(error) = encoding.add(value) {
            return Err(encoding.failed.take().unwrap_or_else(|| std::io::Error::other(error)));
        }
        let crc = encoding.crc.clone().finalize();
        encoding.to.write_all(&crc.to_le_bytes())
    })
}

impl OutputFolder {
    /// Reads the newest checkpoint of a folder that is whole and of its run, and says why a newer one was passed over;
    /// `fits` says what a foreign one gives itself away by.
    ///
    /// # Errors
    /// [`CheckpointError`] of the newest file when none can be used.
    pub fn read_checkpoint<T: DeserializeOwned>(
        &self,
        fits: impl Fn(&T) -> Result<(), String>,
    ) -> Result<(T, Option<CheckpointError>), CheckpointError> {
        let mut passed_over = None;
        for path in [self.checkpoint(), self.previous_checkpoint()] {
            let found = read_file(&path).and_then(|found| match found.as_ref().map_or(Ok(()), &fits) {
                Ok(()) => Ok(found),
                Err(what) => Err(CheckpointError::Foreign { path: path.clone(), what }),
            });
            match found {
                Ok(Some(value)) => return Ok((value, passed_over)),
                Ok(None) => {}
                Err(error) => passed_over = passed_over.or(Some(error)),
            }
        }
        Err(passed_over.unwrap_or(CheckpointError::None { folder: self.path().to_path_buf() }))
    }
}

impl OutputFolder {
    /// Puts the checkpoint before in the place of a newer one that cannot be used, so that the next one written does not
    /// take its place.
    ///
    /// # Errors
    /// [`WriteError::Io`] when the file cannot be renamed.
    pub fn go_back(&self) -> Result<(), WriteError> {
        let previous = self.previous_checkpoint();
        fs::rename(&previous, self.checkpoint()).map_err(WriteError::io("rename", &previous))
    }
}

/// Reads a checkpoint from a file; none where there is no file.
///
/// # Errors
/// [`CheckpointError`] when the file cannot be used.
pub fn read_file<T: DeserializeOwned>(path: &Path) -> Result<Option<T>, CheckpointError> {
    let bytes = match fs::read(path) {
        Ok(bytes) => bytes,
        Err(e) if e.kind() == ErrorKind::NotFound => return Ok(None),
        Err(source) => return Err(CheckpointError::Unreadable { path: path.to_path_buf(), source }),
    };
    let damaged = |what: &str| CheckpointError::Damaged { path: path.to_path_buf(), what: what.to_owned() };
    if bytes.len() < HEADER + TRAILER {
        return Err(damaged("too short"));
    }
    if &bytes[..16] != MAGIC {
        return Err(damaged("it does not begin as a checkpoint does"));
    }
    let (body, sum) = bytes.split_at(bytes.len() - TRAILER);
    if crc32fast::hash(body).to_le_bytes() != sum {
        return Err(damaged("its checksum is wrong"));
    }
    let found = u32::from_le_bytes([body[16], body[17], body[18], body[19]]);
    if found != FORMAT {
        return Err(CheckpointError::Version { path: path.to_path_buf(), found });
    }
    let length = u64::from_le_bytes(body[20..28].try_into().expect("eight bytes"));
    if length != (body.len() - HEADER) as u64 {
        return Err(damaged("its length is wrong"));
    }
    postcard::from_bytes(&body[HEADER..]).map(Some).map_err(|e| damaged(&e.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn folder() -> (tempfile::TempDir, OutputFolder) {
        let place = tempfile::tempdir().unwrap();
        let folder = OutputFolder::create(&place.path().join("out"), false).unwrap();
        (place, folder)
    }

    #[test]
    fn a_checkpoint_comes_back_bit_for_bit_and_the_one_before_is_kept() {
        let (_place, folder) = folder();
        let value = vec![0.1 + 0.2, -0.0, f64::MIN_POSITIVE / 8.0, f64::INFINITY];
        folder.write_checkpoint(&vec![1.0f64]).unwrap();
        folder.write_checkpoint(&value).unwrap();
        let (found, passed_over): (Vec<f64>, _) = folder.read_checkpoint(any).unwrap();
        assert!(found.iter().zip(&value).all(|(a, b)| a.to_bits() == b.to_bits()) && passed_over.is_none());
        fs::remove_file(folder.checkpoint()).unwrap();
        assert_eq!(folder.read_checkpoint(any::<Vec<f64>>).unwrap().0, [1.0]);
    }

    fn any<T>(_: &T) -> Result<(), String> {
        Ok(())
    }

    #[test]
    fn one_of_another_run_is_passed_over_and_does_not_come_back() {
        let (_place, folder) = folder();
        folder.write_checkpoint(&1.0f64).unwrap();
        folder.write_checkpoint(&2.0f64).unwrap();
        let fits = |value: &f64| if *value == 1.0 { Ok(()) } else { Err("it is two".to_owned()) };
        let (found, passed_over) = folder.read_checkpoint(fits).unwrap();
        assert!(found == 1.0 && matches!(passed_over, Some(CheckpointError::Foreign { .. })));
        folder.go_back().unwrap();
        assert!(folder.read_checkpoint(fits).unwrap().1.is_none() && !folder.previous_checkpoint().exists());
    }

    #[test]
    fn a_folder_without_one_and_another_format_are_named() {
        let (_place, folder) = folder();
        assert!(matches!(folder.read_checkpoint(any::<f64>), Err(CheckpointError::None { .. })));
        let mut bytes = MAGIC.to_vec();
        bytes.extend_from_slice(&99u32.to_le_bytes());
        bytes.extend_from_slice(&0u64.to_le_bytes());
        bytes.extend_from_slice(&crc32fast::hash(&bytes).to_le_bytes());
        fs::write(folder.checkpoint(), bytes).unwrap();
        assert!(matches!(
            folder.read_checkpoint(any::<f64>),
            Err(CheckpointError::Version { found: 99, .. })
        ));
    }

    proptest! {
        #[test]
        fn a_damaged_file_is_passed_over_for_the_one_before(at in 0usize..1000, cut in prop::bool::ANY, bit in 0u8..8) {
            let (_place, folder) = folder();
            let values = [vec![1.5f64; 7], vec![2.5f64; 9]];
            folder.write_checkpoint(&values[0]).unwrap();
            folder.write_checkpoint(&values[1]).unwrap();
            let mut bytes = fs::read(folder.checkpoint()).unwrap();
            let at = at % bytes.len();
            if cut { bytes.truncate(at) } else { bytes[at] ^= 1 << bit }
            fs::write(folder.checkpoint(), bytes).unwrap();
            let (found, passed_over): (Vec<f64>, _) = folder.read_checkpoint(any).unwrap();
            prop_assert_eq!(&found, &values[0]);
            prop_assert!(passed_over.is_some());
        }
    }
}
