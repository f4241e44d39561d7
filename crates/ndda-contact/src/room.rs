//! Room in lists whose length changes from step to step.

/// Entries from which on a list gets little more room than it needs.
const MANY: usize = 1 << 12;

/// Makes room for so many entries: for an eighth more in a long list, where the rest of a doubled one would be memory that nothing uses.
pub(crate) fn make_room<T>(list: &mut Vec<T>, count: usize) {
    if count > MANY {
        grow(list, count);
    }
}

/// Puts entries in the place of others, with room for an eighth more where there is too little.
pub(crate) fn copy_into<T: Copy>(list: &mut Vec<T>, entries: &[T]) {
    list.clear();
    grow(list, entries.len());
    list.extend_from_slice(entries);
}

/// Lets a list hold so many entries and an eighth more, where it holds fewer.
fn grow<T>(list: &mut Vec<T>, count: usize) {
    if count > list.capacity() {
        list.reserve_exact(count + count / 8 - list.len());
    }
}
