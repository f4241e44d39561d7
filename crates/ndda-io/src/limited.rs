//! Reading files that somebody else has made: never more than a limit, and no devices, which may have no end.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// Most bytes of a scene or table: 256 MiB.
pub(crate) const MOST_BYTES: u64 = 1 << 28;

/// The bytes of a regular file of at most 256 MiB.
///
/// # Errors
/// It cannot be read, is a folder, a pipe or a device, or is larger.
pub(crate) fn file(path: &Path) -> io::Result<Vec<u8>> {
    if !std::fs::metadata(path).map_err(no_file)?.is_file() {
        return Err(io::Error::other("it is a folder, a pipe or a device: name a file"));
    }
    stream(path)
}

/// As [`file`], but what is no folder may also be a pipe.
///
/// # Errors
/// It cannot be read, or is larger.
pub(crate) fn stream(path: &Path) -> io::Result<Vec<u8>> {
    at_most(File::open(path).map_err(no_file)?, MOST_BYTES)
}

/// A file that is not there, in words that say what to do.
fn no_file(error: io::Error) -> io::Error {
    match error.kind() {
        io::ErrorKind::NotFound => io::Error::new(error.kind(), "there is no such file; check its path"),
        _ => error,
    }
}

/// All of standard input. It can be read once only, and is kept for those who ask again.
///
/// # Errors
/// It cannot be read, or is larger than 256 MiB.
pub(crate) fn standard_input() -> io::Result<Vec<u8>> {
    static KEPT: Mutex<Option<Vec<u8>>> = Mutex::new(None);
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    if kept.is_none() {
        *kept = Some(at_most(io::stdin().lock(), MOST_BYTES)?);
    }
    Ok(kept.clone().unwrap_or_default())
}

fn at_most(source: impl Read, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    source.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        return Err(io::Error::other(format!(
            "it has more than {most} bytes, the most that can be read: make the file smaller"
        )));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_up_to_the_limit_and_not_beyond() {
        assert_eq!(at_most(&b"abcd"[..], 4).unwrap(), b"abcd");
        assert!(at_most(&b"abcde"[..], 4).unwrap_err().to_string().contains("more than 4 bytes"));
        assert!(at_most(io::repeat(0), 1000).is_err());
    }

    #[test]
    fn folders_and_devices_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        assert!(file(folder.path()).unwrap_err().to_string().contains("name a file"));
        if Path::new("/dev/zero").exists() {
            assert!(file(Path::new("/dev/zero")).unwrap_err().to_string().contains("device"));
        }
        std::fs::write(folder.path().join("a"), "x").unwrap();
        assert_eq!(file(&folder.path().join("a")).unwrap(), b"x");
    }
}
