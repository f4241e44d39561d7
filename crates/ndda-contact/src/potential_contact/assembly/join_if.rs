//! Two things at once.

/// Does both, the second on another thread if one is free and it is worth waking one.
pub(crate) fn join_if<A: Send, B: Send>(
    is_worth_it: bool,
    first: impl FnOnce() -> A + Send,
    second: impl FnOnce() -> B + Send,
) -> (A, B) {
    if is_worth_it { rayon::join(first, second) } else { (first(), second()) }
}
