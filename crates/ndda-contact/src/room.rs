//! Room in lists whose length changes from step to step.

/// Entries from which on a list gets little more room than it needs.
const MANY: usize = 1 << 12;

/// Makes room for so many entries: for an eighth more in a long list, where the rest of a doubled one would be memory that nothing uses.
pub(crate) fn make_room<T>(list: &mut Vec<T>, count: usize) {
    if count > MANY && count > list.capacity() {
        list.reserve_exact(count + count / 8 - list.len());
    }
}

/// Puts entries in the place of others, with room for an eighth more where there is too little.
pub(crate) fn copy_into<T: Copy>(list: &mut Vec<T>, entries: &[T]) {
    list.clear();
    if list.capacity() < entries.len() {
        list.reserve_exact(entries.len() + entries.len() / 8);
    }
    list.extend_from_slice(entries);
}
