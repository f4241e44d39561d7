//! Work on the books of many blocks, each by itself.

use rayon::prelude::*;

/// Blocks below which a second thread costs more than it brings.
const GRAIN_BLOCKS: usize = 2048;

/// Calls `work` with the number of each entry and the entry, on all threads where they are many.
pub(crate) fn each_of_many<T: Send>(entries: &mut [T], work: impl Fn(usize, &mut T) + Sync + Send) {
    if entries.len() > GRAIN_BLOCKS {
        let each = entries.par_iter_mut().enumerate().with_min_len(GRAIN_BLOCKS);
        each.for_each(|(place, entry)| work(place, entry));
    } else {
        entries.iter_mut().enumerate().for_each(|(place, entry)| work(place, entry));
    }
}
