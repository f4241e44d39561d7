//! Whether all cases of a sweep end when their scenes ask for it: a run has whole steps.

use ndda_solver::shown_time_s;

use super::Sweep;
use crate::build;

/// Cases that are looked at: more of them say nothing new.
const MOST_CASES: usize = 500;
/// Ends nearer than this part of them are the same.
const SAME: f64 = 1e-9;

/// When a case ends.
struct End<'a> {
    name: &'a str,
    /// `time.end_s` of its scene, and the end of its last step [s].
    asked_s: f64,
    reached_s: f64,
}

impl End<'_> {
    fn is_off(&self) -> bool {
        (self.reached_s - self.asked_s).abs() > SAME * self.asked_s
    }
}

/// The warning that cases end at different times, because not all their steps divide `time.end_s`.
pub(super) fn differing(sweep: &Sweep) -> Option<String> {
    let sets_time = |text: &String| text.starts_with("time") || text.starts_with("parameters");
    if !sweep.cases.iter().any(|case| case.case.overrides.iter().any(sets_time)) {
        return None;
    }
    let end = |case: &'_ super::SweepCase| {
        let scene = sweep.loaded.scene_with(&case.case.overrides).ok()?.scene;
        let reached_s = build::steps(&scene.time) as f64 * scene.time.step_s;
        scene.stages.is_empty().then_some((scene.time.end_s, reached_s))
    };
    let ends = sweep.cases.iter().take(MOST_CASES).filter_map(|case| {
        let (asked_s, reached_s) = end(case)?;
        Some(End { name: &case.case.name, asked_s, reached_s })
    });
    said(&ends.collect::<Vec<_>>())
}

/// What is said of these ends; nothing where all are what is asked for, or as far from it as each other.
fn said(ends: &[End]) -> Option<String> {
    let part = |end: &End| end.reached_s / end.asked_s;
    let first = part(ends.first()?);
    if ends.iter().all(|end| (part(end) - first).abs() <= SAME) {
        return None;
    }
    let off = || ends.iter().filter(|end| end.is_off());
    let farthest = off().max_by(|a, b| (part(a) - 1.0).abs().total_cmp(&(part(b) - 1.0).abs()))?;
    Some(format!(
        "warning: cases end at different times, since a run has whole steps: {} of {} do not end at time.end_s, such as {}, which ends at \
         {} s in place of {} s; choose steps that divide it",
        off().count(),
        ends.len(),
        farthest.name,
        shown_time_s(farthest.reached_s),
        shown_time_s(farthest.asked_s)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn end(name: &str, asked_s: f64, step_s: f64) -> End<'_> {
        End { name, asked_s, reached_s: (asked_s / step_s).round() * step_s }
    }

    #[test]
    fn steps_that_do_not_divide_the_end_are_named_once() {
        let found = said(&[end("a", 1.0, 0.1), end("b", 1.0, 0.3), end("c", 1.0, 0.4)]).unwrap();
        assert!(
            found.contains("2 of 3 do not end at time.end_s, such as c, which ends at 1.2 s in place of 1 s"),
            "{found}"
        );
    }

    #[test]
    fn cases_that_all_end_alike_are_not_spoken_of() {
        assert_eq!(said(&[end("a", 1.0, 0.1), end("b", 1.0, 0.01), end("c", 2.0, 1e-3)]), None);
        assert_eq!(said(&[end("a", 1.0, 0.3), end("b", 1.0, 0.3)]), None);
        assert_eq!(said(&[]), None);
    }
}
