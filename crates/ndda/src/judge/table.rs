//! The table that a run ends with.

use ndda_io::summary::{Judgement, LabelWord, Summary, Verdict};

use crate::columns::columns;

/// The table that a run ends with.
pub fn text(summary: &Summary) -> String {
    let mut text = format!("{}: {}\n", summary.scene, summary.title);
    let speed = summary.steps as f64 / summary.wall_s;
    text.push_str(&format!(
        "{} steps of {:e} s to t = {} s in {:.2} s ({speed:.0} steps/s, {} thread(s)); {} blocks, {} tets, {} dofs, \
         {} factor(s)\n",
        summary.steps,
        summary.step_s,
        summary.end_s,
        summary.wall_s,
        summary.threads,
        summary.counts.blocks,
        summary.counts.tets,
        summary.counts.dofs,
        summary.counts.factors,
    ));
    for part in [stage_table(summary), verdict_table(summary), monitor_table(summary)] {
        text.push_str(&format!("{part}\n"));
    }
    if let Some(reference) = &summary.reference {
        text.push_str(&format!(
            "against the closed form {}: relative error {:.2e} at the end, at most {:.2e} for t ≥ {} s\n",
            reference.kind, reference.error_end, reference.error_max, reference.after_s
        ));
        if let (Some(end), Some(max)) = (reference.stick_stage_end, reference.stick_stage_max) {
            text.push_str(&format!(
                "against its form with the shear spring's stick stage: {end:.2e} at the end, at most {max:.2e}\n"
            ));
        }
    }
    for warning in &summary.warnings {
        text.push_str(&format!("warning: {warning}\n"));
    }
    if summary.label.word != LabelWord::Stopped {
        text.push_str(&format!("label: {}\n", summary.label.word.as_str()));
        for reason in &summary.label.reasons {
            text.push_str(&format!("  {reason}\n"));
        }
    }
    if let Some(cause) = &summary.stopped_by {
        text.push_str(&format!("stopped: {cause}\n"));
    }
    text
}

fn framed(header: &[&str], rows: Vec<Vec<String>>) -> String {
    columns(header.iter().map(ToString::to_string).collect(), rows)
}

fn stage_table(summary: &Summary) -> String {
    let share = |s: f64| format!("{:.1} %", 100.0 * s / summary.wall_s);
    let rows = summary.stages_s.0.iter().map(|(name, s)| vec![name.clone(), format!("{s:.3} s"), share(*s)]);
    framed(&["stage", "time", "share"], rows.collect())
}

fn verdict_table(summary: &Summary) -> String {
    let number = |v: Option<f64>| v.map_or(String::new(), |v| format!("{v:.2e}"));
    let word = |verdict: &Verdict| match (verdict.verdict, verdict.limit) {
        (Judgement::Pass, None) if verdict.value.is_some() => "shown",
        (Judgement::Pass, _) => "pass",
        (Judgement::Warn, _) => "WARN",
        (Judgement::Fail, _) => "FAIL",
        (Judgement::NotYet, _) => "not yet",
    };
    let row =
        |(name, v): &(String, Verdict)| vec![name.clone(), number(v.value), number(v.limit), word(v).into()];
    framed(&["invariant", "worst", "limit", "verdict"], summary.verdicts.0.iter().map(row).collect())
}

fn monitor_table(summary: &Summary) -> String {
    let triple = |v: &[f64; 3]| format!("({:.6}, {:.6}, {:.6})", v[0], v[1], v[2]);
    let monitors = summary.monitors.0.iter();
    let rows =
        monitors.map(|(name, end)| vec![name.clone(), triple(&end.displacement), triple(&end.velocity)]);
    let mut rows: Vec<Vec<String>> = rows.collect();
    for (name, end) in &summary.blocks.0 {
        rows.push(vec![format!("block {name}"), String::new(), triple(&end.velocity)]);
    }
    framed(&["monitor", "displacement [m]", "velocity [m/s]"], rows)
}
