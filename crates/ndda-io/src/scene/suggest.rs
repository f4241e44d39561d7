//! The name that a mistyped one may have been.

/// Names less alike than this are no suggestion.
const ALIKE: f64 = 0.75;

/// "did you mean", or all that would be allowed.
pub fn suggest(found: &str, expected: &[&str]) -> String {
    match nearest(found, expected) {
        Some(name) => format!("did you mean `{name}`?"),
        None => {
            let mut names = expected.to_vec();
            names.dedup();
            format!("there is {}", names.join(", "))
        }
    }
}

/// The name most like `found`, if any is like it.
pub fn nearest<'a>(found: &str, expected: &[&'a str]) -> Option<&'a str> {
    let likeness = |name: &&str| strsim::jaro_winkler(found, name);
    let best = expected.iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b)))?;
    (likeness(best) >= ALIKE).then_some(*best)
}
