//! The end of a run: a few lines for a person, and tables of everything.

use ndda_solver::shown_time_s;

use super::words::{SECOND_RUN, in_words};
use super::{bolts, reasons};
use crate::columns::columns;
use crate::numbers::{SHORTEST_M, counted, length};
use crate::summary::{Course, Judgement, LabelWord, Motion, StageEnd, Summary, Verdict};

/// Most blocks in a table.
const MOST_BLOCKS: usize = 1000;

/// The first answers: whether the result is to be trusted, what moved, the error against a closed form, and the
/// checks that failed.
pub fn ending(summary: &Summary) -> String {
    let mut text = match (summary.label.word, summary.label.reasons.as_slice()) {
        (LabelWord::Accurate, _) => {
            let speeds = match summary.slow_error_m_s {
                // A block that has only begun to slide is slow, too.
                Some(error_m_s) if accelerates(summary) => format!("speeds to {}/s", length(error_m_s)),
                Some(error_m_s) => format!("blocks hardly move; speeds accurate to {}/s", length(error_m_s)),
                None => "speeds to 1 % of the largest".into(),
            };
            format!("accurate: {speeds}, positions to a fifth of an element\n")
        }
        (LabelWord::Sensitive, reasons) => format!("sensitive: {}\n", reasons.join("; ")),
        (LabelWord::Inaccurate, reasons) => format!("inaccurate:{}\n", reasons::in_lines(reasons)),
        (LabelWord::Stopped, _) => format!("stopped at t = {} s\n", shown_time_s(summary.end_s)),
    };
    text.extend(summary.chosen.iter().map(|chosen| format!("{chosen}\n")));
    text.extend(summary.stages.iter().map(|end| format!("{}\n", stage(end))));
    if summary.steps == 0 && summary.label.word == LabelWord::Stopped {
        // No step was done, so that there are no results to report.
        return text;
    }
    text.extend(summary.motion.as_ref().map(moved));
    text.extend(summary.settled.iter().map(|settled| format!("{settled}\n")));
    text.push_str(&bolts::bolts(&summary.bolts.0));
    text.push_str(&error(summary));
    let failed =
        |(_, verdict): &&(String, Verdict)| matches!(verdict.verdict, Judgement::Warn | Judgement::Fail);
    let bad: Vec<_> = summary.verdicts.0.iter().filter(failed).collect();
    let passed = summary.verdicts.0.iter().filter(|(_, v)| v.is_passed()).count();
    // Numbers that the table of all checks shows, too, without a limit to pass or before they can be judged.
    let shown = match summary.verdicts.0.len() - passed - bad.len() {
        0 => String::new(),
        1 => "; 1 more has no limit".into(),
        others => format!("; {others} more have no limit"),
    };
    if bad.is_empty() && passed > 0 {
        text.push_str(&format!("{passed} checks passed{shown}\n"));
    } else if !bad.is_empty() {
        text.push_str(&format!(
            "{} failed, {passed} passed{shown}:\n{}\n",
            counted(bad.len(), "check", "checks"),
            verdict_table(bad.into_iter())
        ));
    }
    if let Some(steps) = summary.unsettled_steps {
        text.push_str(&format!(
            "settling ended after {steps} steps in {:.2} s, before the time of the run began\n",
            summary.wall_s
        ));
        return text;
    }
    text.push_str(&format!(
        "{} steps of {:e} s to t = {} s in {:.2} s",
        summary.steps,
        summary.step_s,
        shown_time_s(summary.end_s),
        own_s(summary)
    ));
    if let Some(second_s) = second_run_s(summary) {
        text.push_str(&format!(
            ", and {second_s:.2} s for running the scene again (`--sensitivity never` leaves that out)"
        ));
    }
    text.push('\n');
    text
}

/// Seconds of the second run that shows whether the motion is sensitive, if there was one.
fn second_run_s(summary: &Summary) -> Option<f64> {
    summary.stages_s.0.iter().find(|(part, _)| part == SECOND_RUN).map(|(_, s)| *s)
}

/// Seconds of the run itself.
fn own_s(summary: &Summary) -> f64 {
    summary.wall_s - second_run_s(summary).unwrap_or(0.0)
}

/// How a stage ended, in a line.
pub fn stage(end: &StageEnd) -> String {
    let how = match end.settling_steps {
        0 => String::new(),
        steps => format!(", at rest after {} more", counted(steps as usize, "step", "steps")),
    };
    let motion =
        if end.motion.can_move > 0 { format!("; {}", moved(&end.motion).trim_end()) } else { String::new() };
    let (name, end_s, word) = (&end.name, shown_time_s(end.end_s), end.label.word.as_str());
    format!("stage `{name}` to t = {end_s} s{how}: {word} so far{motion}")
}

fn accelerates(summary: &Summary) -> bool {
    summary.motion.as_ref().is_some_and(|motion| motion.course == Course::Accelerating)
}

/// Which blocks moved, and how far.
pub fn moved(motion: &Motion) -> String {
    let Motion { can_move, moved, farthest, farthest_m, speed_m_s, course, fallen_out } = motion;
    let fallen_out = fallen_out_in_words(fallen_out);
    let course = match course {
        Course::AtRest => "at rest".to_string(),
        Course::Moving => match speed(*speed_m_s) {
            // The centre of mass moves by rounding alone.
            _ if *speed_m_s < SHORTEST_M => "turning in place".to_string(),
            speed => format!("moving at {speed}"),
        },
        Course::Accelerating => format!("still accelerating, {}", speed(*speed_m_s)),
    };
    // A large block may go far by less than what counts, and may have only begun to slide.
    if *moved == 0 && motion.course == Course::Accelerating {
        let (gone, speed) = (length(*farthest_m), speed(*speed_m_s));
        return format!(
            "`{farthest}` is accelerating: {gone} at the end, less than 1 % of its radius, {speed}\n{fallen_out}"
        );
    }
    let many = match (moved, can_move) {
        (0, 0..2) => "no block moved by more than 1 % of its radius".into(),
        (0, _) => format!("none of {can_move} movable blocks moved by more than 1 % of its radius"),
        _ => format!("{moved} of {} moved", counted(*can_move, "movable block", "movable blocks")),
    };
    format!("{many}; farthest `{farthest}`: {} at the end, {course}\n{fallen_out}", length(*farthest_m))
}

/// Blocks that nothing can hold any more, if there are any, in a line.
fn fallen_out_in_words(blocks: &[String]) -> String {
    let [first, others @ ..] = blocks else { return String::new() };
    let (who, them) = match others.len() {
        0 => (format!("`{first}` has"), "it"),
        more => (format!("`{first}` and {} have", counted(more, "other block", "other blocks")), "them"),
    };
    format!(
        "{who} fallen out of the model, past everything that could hold {them}: extend the ground, or end the run sooner\n"
    )
}

/// A speed in m/s, or in a smaller unit if it is below a centimetre in a second.
fn speed(speed_m_s: f64) -> String {
    if speed_m_s >= 0.01 { format!("{speed_m_s:.3} m/s") } else { format!("{}/s", length(speed_m_s)) }
}

/// The error against the closed form that the scene names, if it names one.
fn error(summary: &Summary) -> String {
    let Some(reference) = &summary.reference else { return String::new() };
    let mut text = format!(
        "against the closed form {}: relative error {:.2e} at the end, at most {:.2e} for t ≥ {} s\n",
        reference.kind, reference.error_end, reference.error_max, reference.after_s
    );
    if let (Some(end), Some(max)) = (reference.stick_stage_end, reference.stick_stage_max) {
        text.push_str(&format!(
            "against the closed form with the elastic shear before slip: {end:.2e} at the end, at most {max:.2e}\n"
        ));
    }
    text
}

/// Everything, as tables.
pub fn text(summary: &Summary) -> String {
    let mut text = format!("{}: {}\n", summary.scene, summary.title);
    let speed = summary.steps as f64 / own_s(summary);
    let solved = match summary.counts.dofs {
        0 => "rigid or fixed (no equations to solve)".into(),
        dofs => {
            let factors = counted(summary.counts.factors, "factored matrix", "factored matrices");
            format!("{}, {factors}", counted(dofs, "unknown", "unknowns"))
        }
    };
    text.push_str(&format!(
        "{} steps of {:e} s to t = {} s in {:.2} s ({speed:.0} steps/s, {}); {}, {}, {solved}\n",
        summary.steps,
        summary.step_s,
        shown_time_s(summary.end_s),
        own_s(summary),
        counted(summary.threads, "thread", "threads"),
        counted(summary.counts.blocks, "block", "blocks"),
        counted(summary.counts.tets, "tetrahedron", "tetrahedra"),
    ));
    let verdicts = verdict_table(summary.verdicts.0.iter());
    let parts = [stage_table(summary), verdicts, monitor_table(summary), block_table(summary)];
    for part in parts.iter().filter(|part| !part.is_empty()) {
        text.push_str(&format!("{part}\n"));
    }
    for warning in &summary.warnings {
        text.push_str(&format!("warning: {warning}\n"));
    }
    text
}

fn framed(header: &[&str], rows: Vec<Vec<String>>) -> String {
    columns(header.iter().map(ToString::to_string).collect(), rows)
}

fn stage_table(summary: &Summary) -> String {
    let share = |s: f64| format!("{:.1} %", 100.0 * s / summary.wall_s);
    let row = |(part, s): &(String, f64)| vec![in_words(part).to_string(), format!("{s:.3} s"), share(*s)];
    framed(&["time spent on", "time", "share"], summary.stages_s.0.iter().map(row).collect())
}

fn verdict_table<'a>(verdicts: impl Iterator<Item = &'a (String, Verdict)>) -> String {
    let number = |v: Option<f64>| v.map_or(String::new(), |v| format!("{v:.2e}"));
    let word = |verdict: &Verdict| match (verdict.verdict, verdict.limit) {
        (Judgement::Pass, None) if verdict.value.is_some() => "no limit",
        (Judgement::Pass, _) => "pass",
        (Judgement::Warn, _) => "WARN",
        (Judgement::Fail, _) => "FAIL",
        (Judgement::NotYet, _) => "not yet",
    };
    let row = |(name, v): &(String, Verdict)| {
        vec![in_words(name).into(), number(v.value), number(v.limit), word(v).into()]
    };
    framed(&["check", "worst", "limit", "verdict"], verdicts.map(row).collect())
}

fn monitor_table(summary: &Summary) -> String {
    let triple = |v: &[f64; 3]| format!("({:.6}, {:.6}, {:.6})", v[0], v[1], v[2]);
    if summary.monitors.0.is_empty() {
        return String::new();
    }
    let monitors = summary.monitors.0.iter();
    let rows =
        monitors.map(|(name, end)| vec![name.clone(), triple(&end.displacement), triple(&end.velocity)]);
    framed(&["monitor", "displacement [m]", "velocity [m/s]"], rows.collect())
}

/// The blocks that have moved; where they are very many, those that have gone farthest.
fn block_table(summary: &Summary) -> String {
    let triple = |v: &[f64; 3]| format!("({:.6}, {:.6}, {:.6})", v[0], v[1], v[2]);
    let all = &summary.blocks.0;
    let largest_m = |place: &usize| all[*place].1.motion.largest_m;
    let (mut shown, still): (Vec<usize>, Vec<usize>) =
        (0..all.len()).partition(|place| largest_m(place) > 0.0);
    let moved = shown.len();
    if moved > MOST_BLOCKS {
        let farthest_m = |place: &usize| all[*place].1.motion.farthest_m;
        shown.select_nth_unstable_by(MOST_BLOCKS, |a, b| {
            farthest_m(b).total_cmp(&farthest_m(a)).then(a.cmp(b))
        });
        shown.truncate(MOST_BLOCKS);
        shown.sort_unstable();
    }
    let mut others = match moved - shown.len() {
        0 => String::new(),
        others => format!("{others} more blocks went less far: `summary.json` has all\n"),
    };
    if !still.is_empty() {
        others += &format!("{} did not move\n", counted(still.len(), "block", "blocks"));
    }
    if shown.is_empty() {
        return others;
    }
    let rows = shown.into_iter().map(|place| {
        let (name, end) = &all[place];
        let motion = &end.motion;
        vec![
            name.clone(),
            triple(&motion.displacement_m),
            length(motion.farthest_m),
            length(motion.largest_m),
            format!("{:.3}°", motion.rotation_deg),
            triple(&end.velocity),
        ]
    });
    let header = ["block", "displacement [m]", "farthest point", "largest", "rotation", "velocity [m/s]"];
    match others.is_empty() {
        true => framed(&header, rows.collect()),
        false => format!("{}\n{others}", framed(&header, rows.collect())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::Sensitivity;
    use crate::{Model, Run};

    /// A block that hits a floor with a step that is far too long.
    #[test]
    fn a_run_of_a_step_that_is_too_long_says_the_cure_once() {
        let text = "(title: \"hit\", time: (step_s: 4e-3, end_s: 0.4), gravity_m_s2: (0, 0, -9.81),
            materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)],
            blocks: [
                (name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (2, 2, 1), cells: (1, 1, 1)), at_m: (-0.5, -0.5, -1)),
                (name: \"cube\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, 0.2)),
            ],
            contact: Potential(penalty_pa: 1e9, potential: Smooth(), friction: (friction_deg: 30)))";
        let run = Run::new(Model::from_text(text).unwrap()).finish(&mut []);
        let summary = run.unwrap().summary;
        assert!(summary.label.reasons.len() > 1, "{:?}", summary.label.reasons);
        let text = ending(&summary);
        let said = text.matches("reduce step_s").count() + text.matches("divide step_s").count();
        assert_eq!(said, 1, "{text}");
    }

    #[test]
    fn the_time_of_repeating_a_run_is_said_apart() {
        let text = "(title: \"fall\", contact: Off, time: (step_s: 1e-3, end_s: 0.01), gravity_m_s2: (0, 0, -9.81),
            materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)],
            blocks: [(name: \"cube\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))])";
        let run = Run::new(Model::from_text(text).unwrap()).sensitivity(Sensitivity::Never);
        let mut summary = run.finish(&mut []).unwrap().summary;
        summary.wall_s = 5.0;
        assert!(
            ending(&summary).contains("10 steps of 1e-3 s to t = 0.01 s in 5.00 s\n"),
            "{}",
            ending(&summary)
        );
        summary.stages_s.0.push((SECOND_RUN.into(), 2.0));
        assert!(
            ending(&summary).contains("in 3.00 s, and 2.00 s for running the scene again"),
            "{}",
            ending(&summary)
        );
    }
}
