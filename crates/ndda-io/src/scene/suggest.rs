//! The name that a mistyped one may have been.

/// Names less alike than this are no suggestion.
const ALIKE: f64 = 0.75;

/// "did you mean", or all that would be allowed.
pub fn suggest(found: &str, expected: &[&str]) -> String {
    match nearest(found, expected) {
        Some(name) => match with_unit(name, expected) {
            Some(longer) => format!("did you mean `{name}` or `{longer}`?"),
            None => format!("did you mean `{name}`?"),
        },
        None => {
            let mut names = expected.to_vec();
            names.dedup();
            match names[..] {
                [] => "there is none".into(),
                [only] => format!("there is {only}"),
                _ => format!("choose one of {}", names.join(", ")),
            }
        }
    }
}

/// An expected name that continues another one by a unit, as `step_s` continues `step`.
fn with_unit<'a>(name: &str, expected: &[&'a str]) -> Option<&'a str> {
    expected.iter().find(|other| is_with_unit(other, name)).copied()
}

/// Whether a name is another one with a unit, or another word, after it.
pub fn is_with_unit(name: &str, without: &str) -> bool {
    name.strip_prefix(without).is_some_and(|rest| rest.starts_with('_'))
}

/// The name most like `found`, if any is like it, or the only one that begins with it.
pub fn nearest<'a>(found: &str, expected: &[&'a str]) -> Option<&'a str> {
    let likeness = |name: &&str| strsim::jaro_winkler(found, name);
    let best = expected.iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b)))?;
    if likeness(best) >= ALIKE {
        return Some(*best);
    }
    let mut longer = expected.iter().filter(|name| !found.is_empty() && name.starts_with(found));
    longer.next().filter(|_| longer.next().is_none()).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_suggested_with_the_one_that_adds_its_unit() {
        assert_eq!(suggest("stp", &["end_s", "step", "step_s"]), "did you mean `step` or `step_s`?");
        assert_eq!(suggest("ste_s", &["end_s", "step", "step_s"]), "did you mean `step_s`?");
        assert_eq!(suggest("c", &["cohesion_pa", "tension_pa"]), "did you mean `cohesion_pa`?");
        assert_eq!(suggest("c", &["cohesion_pa", "conductivity"]), "choose one of cohesion_pa, conductivity");
        assert_eq!(suggest("x", &["end_s", "step"]), "choose one of end_s, step");
        assert_eq!(suggest("x", &["end_s"]), "there is end_s");
    }
}
