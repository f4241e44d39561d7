//! Frames of a run as the report and pictures take them: some of many, all with the blocks of the first.

use std::path::{Path, PathBuf};

use ndda_io::results::FieldFrame;

use crate::field::Field;

/// Blocks that move less than this part of the farthest motion are at rest.
pub(crate) const STILL: f64 = 0.01;

/// A frame that does not fit the first.
#[derive(Debug, thiserror::Error)]
#[error("{} holds {found} {what} and the first frame {needed}: they are of two runs, run the scene again", path.display())]
pub struct OtherBlocks {
    /// The frame.
    pub path: PathBuf,
    /// Points, tetrahedra or entries of an array.
    pub what: String,
    /// Number of them in the frame.
    pub found: usize,
    /// Number of them in the first frame.
    pub needed: usize,
}

/// Checks that a frame has as many points, tetrahedra and entries of these fields as the first.
///
/// # Errors
/// [`OtherBlocks`].
pub(crate) fn same_blocks(
    path: &Path,
    first: &FieldFrame,
    frame: &FieldFrame,
    fields: &[Field],
) -> Result<(), OtherBlocks> {
    let length =
        |frame: &FieldFrame, field: &Field| field.array_of(frame).map_or(0, |array| array.values.len());
    let mut counts = vec![
        ("points".to_string(), frame.points.len(), first.points.len()),
        ("tetrahedra".to_string(), frame.tets.len(), first.tets.len()),
    ];
    counts.extend(
        fields.iter().map(|f| (format!("numbers in {}", f.array), length(frame, f), length(first, f))),
    );
    match counts.into_iter().find(|(_, found, needed)| found != needed) {
        None => Ok(()),
        Some((what, found, needed)) => Err(OtherBlocks { path: path.to_path_buf(), what, found, needed }),
    }
}

/// At most `most` of `count` frames, evenly, the first and the last among them; at least one.
pub(crate) fn thinned(count: usize, most: usize) -> Vec<usize> {
    match most.min(count) {
        0 | 1 => vec![count - 1],
        shown => (0..shown).map(|i| (i * (count - 1) + (shown - 1) / 2) / (shown - 1)).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinned_frames_are_even_and_keep_both_ends() {
        assert_eq!(thinned(5, 9), [0, 1, 2, 3, 4]);
        assert_eq!(thinned(4, 100), [0, 1, 2, 3]);
        assert_eq!(thinned(11, 3), [0, 5, 10]);
        assert_eq!(thinned(11, 2), [0, 10]);
        assert_eq!((thinned(11, 1), thinned(1, 1)), (vec![10], vec![0]));
        assert_eq!((thinned(1, 5), thinned(7, 1)), (vec![0], vec![6]));
        let many = thinned(1000, 37);
        assert_eq!((many.len(), many[0], many[36]), (37, 0, 999));
        assert!(many.windows(2).all(|w| (27..=28).contains(&(w[1] - w[0]))), "{many:?}");
    }

    #[test]
    fn as_many_frames_are_left_as_were_asked_for_with_both_ends() {
        for most in 2..60 {
            let frames = thinned(60, most);
            assert!(frames.len() == most && frames[0] == 0 && frames[most - 1] == 59);
            assert!(frames.windows(2).all(|pair| pair[0] < pair[1]));
        }
    }
}
