//! Words for a person in the place of the keys of `summary.json`.

/// A cure beside shorter steps of blocks that vibrate on contacts that are not damped.
pub(super) const OR_DAMP: &str = ", or damp contact (`restitution: 0.5`)";
/// The part of a run's computing time that is spent on the second run, which shows whether the motion is sensitive.
pub const SECOND_RUN: &str = "sensitivity";

/// Key, and what a table says instead.
const WORDS: [(&str, &str); 9] = [
    ("ledger", "energy balance"),
    (SECOND_RUN, "running again (sensitivity)"),
    ("setup", "reading and building"),
    ("finite state", "all numbers finite"),
    ("lasting energy error", "energy gained or lost for good"),
    ("friction search error / largest speed", "friction convergence error / largest speed"),
    ("spurious contact energy", "energy made or lost by contact"),
    ("hops that grow by friction", "rebounds in a row, each longer"),
    ("action minus reaction", "difference of action and reaction / force"),
];

/// A check of a run, or a part of its computing time, as tables name it.
pub fn in_words(key: &str) -> &str {
    WORDS.iter().find(|(known, _)| *known == key).map_or(key, |(_, words)| words)
}
