//! The parts of the page that are text: what was run, what became of it, what it cost.

use maud::{Markup, html};

use crate::frames::STILL;
use crate::judge::table;
use crate::judge::words::in_words;
use crate::numbers::{counted, length};
use crate::summary::{BlockEnd, Judgement, LabelWord, StageEnd, Status, Summary, Verdict};

/// Blocks that are listed beside the picture.
const MOST_FARTHEST: usize = 8;
/// Blocks that are listed; a table of more is no help.
const MOST_BLOCKS: usize = 200;

/// Title and badges.
pub fn header(summary: &Summary) -> Markup {
    let count = |wanted: Judgement| summary.verdicts.0.iter().filter(|(_, v)| v.verdict == wanted).count();
    let (warned, failed) = (count(Judgement::Warn), count(Judgement::Fail));
    let passed = summary.verdicts.0.iter().filter(|(_, v)| v.is_passed()).count();
    html! {
        header {
            div {
                p.scene { (summary.scene) }
                h1 { (summary.title) }
            }
            p.badges {
                (status(summary))
                (label(summary))
                @if failed + warned > 0 {
                    span class={ "badge " (if failed > 0 { "fail" } else { "warn" }) } {
                        (counted(failed + warned, "check", "checks")) " beyond " (if failed + warned == 1 { "its limit" } else { "their limits" })
                    }
                } @else if passed > 0 {
                    span.badge.pass { (counted(passed, "check", "checks")) " passed" }
                }
                @if let Some(reference) = &summary.reference {
                    span.badge.info { "error against the closed form " (format!("{:.1e}", reference.error_end)) }
                }
            }
        }
    }
}

/// The run's label; the status has said that it stopped.
fn label(summary: &Summary) -> Markup {
    let word = summary.label.word;
    html! {
        @match word {
            LabelWord::Accurate => span.badge.pass { (word.as_str()) },
            LabelWord::Sensitive | LabelWord::Inaccurate => span.badge.warn { (word.as_str()) },
            LabelWord::Stopped => {},
        }
    }
}

fn status(summary: &Summary) -> Markup {
    let (class, word) = match summary.status {
        Status::Done => ("pass", "done"),
        Status::Failed => ("fail", "failed"),
        Status::Stopped => ("fail", "stopped"),
        Status::Interrupted => ("warn", "interrupted"),
    };
    html! { span class={ "badge " (class) } { (word) } }
}

/// Why it stopped, and what a person should know.
pub fn warnings(summary: &Summary) -> Markup {
    html! {
        @if let Some(cause) = &summary.stopped_by { p.alert.fail { strong { "Stopped " } (cause) } }
        @if matches!(summary.label.word, LabelWord::Sensitive | LabelWord::Inaccurate) {
            @let word = if summary.label.word == LabelWord::Sensitive { "Sensitive " } else { "Inaccurate " };
            @for reason in &summary.label.reasons { p.alert.warn { strong { (word) } (reason) } }
        }
        @for warning in &summary.warnings { p.alert.warn { (warning) } }
    }
}

/// Which blocks moved.
pub fn outcome(summary: &Summary) -> Markup {
    let moved = summary.motion.as_ref().map(table::moved);
    html! { @if let Some(moved) = moved { p.outcome { (moved.trim_end().replace('`', "")) } } }
}

/// The blocks that went farthest, if any did.
pub fn farthest(summary: &Summary) -> Markup {
    let blocks = by_distance(summary);
    let farthest_m = blocks.first().map_or(0.0, |(_, end)| end.motion.farthest_m);
    let moves = |end: &BlockEnd| end.motion.farthest_m > 0.0 && end.motion.farthest_m >= STILL * farthest_m;
    let first: Vec<_> = blocks.into_iter().take(MOST_FARTHEST).filter(|(_, end)| moves(end)).collect();
    html! {
        @if !first.is_empty() {
            section.card {
                h2 { "Blocks that went farthest" }
                table {
                    thead { tr { th { "" } th.number { "farthest point" } th.number { "rotation" } } }
                    tbody {
                        @for (name, end) in first {
                            tr {
                                td { (name) }
                                td.number { (length(end.motion.farthest_m)) }
                                td.number { (format!("{:.2}°", end.motion.rotation_deg)) }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Blocks, the farthest first.
fn by_distance(summary: &Summary) -> Vec<&(String, BlockEnd)> {
    let mut blocks: Vec<_> = summary.blocks.0.iter().collect();
    blocks.sort_by(|a, b| b.1.motion.farthest_m.total_cmp(&a.1.motion.farthest_m));
    blocks
}

/// Facts of the run.
pub fn facts(summary: &Summary) -> Markup {
    let counts = &summary.counts;
    let speed = summary.steps as f64 / summary.wall_s.max(f64::MIN_POSITIVE);
    let mut rows = vec![
        ("Simulated", format!("{} s", number(summary.end_s))),
        ("Steps", format!("{} of {} s", grouped(summary.steps as usize), number(summary.step_s))),
        ("Run", format!("{} on {}", seconds(summary.wall_s), counted(summary.threads, "thread", "threads"))),
        ("Speed", format!("{} steps/s", grouped(speed.round() as usize))),
        ("Blocks", format!("{}, {} tetrahedra", grouped(counts.blocks), grouped(counts.tets))),
        (
            "Unknowns",
            format!(
                "{} in {}",
                grouped(counts.dofs),
                counted(counts.factors, "factored matrix", "factored matrices")
            ),
        ),
        ("Contact", format!("{} pairs at most", grouped(counts.contact_pairs_max))),
    ];
    if let Some(reference) = &summary.reference {
        let (end, max) = (reference.error_end, reference.error_max);
        rows.push(("Closed form", reference.kind.clone()));
        rows.push((
            "Error",
            format!("{end:.2e} at the end, at most {max:.2e} for t ≥ {} s", reference.after_s),
        ));
        if let (Some(end), Some(max)) = (reference.stick_stage_end, reference.stick_stage_max) {
            rows.push(("With elastic shear before slip", format!("{end:.2e} at the end, at most {max:.2e}")));
        }
    }
    html! {
        section.card {
            h2 { "The run" }
            dl { @for (name, value) in &rows { dt { (name) } dd { (value) } } }
        }
    }
}

/// The invariants against their limits.
pub fn verdicts(summary: &Summary) -> Markup {
    let shown = |value: Option<f64>| value.map_or(String::new(), brief);
    html! {
        @if !summary.verdicts.0.is_empty() {
            section.card.checks {
                h2 { "Checks of the run" }
                div.scroll {
                    table {
                        thead { tr { th { "" } th.number { "largest value" } th.number { "limit" } th { "" } } }
                        tbody {
                            @for (name, verdict) in &summary.verdicts.0 {
                                tr {
                                    td { (in_words(name)) }
                                    td.number { (shown(verdict.value)) }
                                    td.number { (shown(verdict.limit)) }
                                    td { (judgement(verdict)) }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// How the stages of construction ended.
pub fn construction(summary: &Summary) -> Markup {
    let moved = |StageEnd { motion, .. }: &StageEnd| {
        format!(
            "{} of {}, farthest {} by {} m",
            motion.moved,
            motion.can_move,
            motion.farthest,
            brief(motion.farthest_m)
        )
    };
    let settling = |steps: u64| if steps > 0 { grouped(steps as usize) } else { String::new() };
    html! {
        @if !summary.stages.is_empty() {
            section.card {
                h2 { "Stages of construction" }
                table {
                    thead { tr { th { "" } th.number { "ends at" } th.number { "steps to rest" } th { "moved" } th { "so far" } } }
                    tbody {
                        @for stage in &summary.stages {
                            tr {
                                td { (stage.name) }
                                td.number { (number(stage.end_s)) " s" }
                                td.number { (settling(stage.settling_steps)) }
                                td { (moved(stage)) }
                                td { (stage.label.word.as_str()) }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn judgement(verdict: &Verdict) -> Markup {
    let (class, word) = match (verdict.verdict, verdict.limit, verdict.value) {
        (Judgement::Pass, None, Some(_)) => ("info", "no limit"),
        (Judgement::Pass, ..) => ("pass", "pass"),
        (Judgement::Warn, ..) => ("warn", "warn"),
        (Judgement::Fail, ..) => ("fail", "fail"),
        (Judgement::NotYet, ..) => ("info", "not yet"),
    };
    html! { span class={ "badge " (class) } { (word) } }
}

/// Time per stage.
pub fn stages(summary: &Summary) -> Markup {
    let share = |s: f64| if summary.wall_s > 0.0 { 100.0 * s / summary.wall_s } else { 0.0 };
    html! {
        section.card {
            h2 { "Computing time" }
            table.shares {
                tbody {
                    @for (name, s) in &summary.stages_s.0 {
                        tr {
                            td { (in_words(name)) }
                            td.bar { div style={ "width:" (format!("{:.2}", share(*s).clamp(0.0, 100.0))) "%" } {} }
                            td.number { (format!("{:.1} %", share(*s))) }
                            td.number { (seconds(*s)) }
                        }
                    }
                }
            }
        }
    }
}

/// Where monitors ended.
pub fn monitors(summary: &Summary) -> Markup {
    html! {
        @if !summary.monitors.0.is_empty() {
            section.card {
                h2 { "Monitors at the end" }
                div.scroll {
                    table {
                        thead { tr { th { "" } th.number { "displacement [m]" } th.number { "velocity [m/s]" } } }
                        tbody {
                            @for (name, end) in &summary.monitors.0 {
                                tr {
                                    td { (name) }
                                    td.number { (triple(&end.displacement)) }
                                    td.number { (triple(&end.velocity)) }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Where blocks ended.
pub fn blocks(summary: &Summary) -> Markup {
    let all = summary.blocks.0.len();
    html! {
        details.card {
            summary { "Blocks at the end (" (all) ")" }
            div.scroll {
                table {
                    thead {
                        tr {
                            th { "" }
                            th.number { "displacement [m]" }
                            th.number { "farthest point" }
                            th.number { "largest" }
                            th.number { "rotation" }
                            th.number { "velocity [m/s]" }
                            th.number { "mass [kg]" }
                        }
                    }
                    tbody {
                        @for (name, end) in by_distance(summary).into_iter().take(MOST_BLOCKS) {
                            tr {
                                td { (name) }
                                td.number { (triple(&end.motion.displacement_m)) }
                                td.number { (length(end.motion.farthest_m)) }
                                td.number { (length(end.motion.largest_m)) }
                                td.number { (format!("{:.2}°", end.motion.rotation_deg)) }
                                td.number { (triple(&end.velocity)) }
                                td.number { (number(end.mass)) }
                            }
                        }
                    }
                }
            }
            @if all > MOST_BLOCKS { p.note { "The " (MOST_BLOCKS) " of " (all) " blocks that went farthest; summary.json has them all." } }
        }
    }
}

/// Which program, which state.
pub fn footer(summary: &Summary) -> Markup {
    html! {
        footer {
            "ndda " (summary.version) " · final state " code { (summary.state_crc32) }
            " · drawn by three.js and uPlot (MIT)"
        }
    }
}

/// A number with six digits at most, no more than it has.
fn number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
        let text = format!("{value:.6}");
        text.trim_end_matches('0').trim_end_matches('.').to_string()
    } else {
        let text = format!("{value:.3e}");
        let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
        format!("{}e{power}", digits.trim_end_matches('0').trim_end_matches('.'))
    }
}

/// A number with two or three digits.
pub(super) fn brief(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        0.01..1000.0 => format!("{value:.3}").trim_end_matches('0').trim_end_matches('.').to_string(),
        _ => format!("{value:.1e}"),
    }
}

fn triple(v: &[f64; 3]) -> String {
    // Rounded first, and zero added, so that no −0 is shown.
    let [x, y, z] = v.map(|component| (component * 1e4).round() / 1e4 + 0.0);
    format!("({x:.4}, {y:.4}, {z:.4})")
}

fn seconds(s: f64) -> String {
    match s {
        _ if s < 1.0 => format!("{:.0} ms", 1e3 * s),
        _ if s < 120.0 => format!("{s:.1} s"),
        _ => format!("{:.0} min {:02.0} s", (s / 60.0).floor(), (s % 60.0).floor()),
    }
}

/// A whole number with its digits in threes.
fn grouped(value: usize) -> String {
    let digits = value.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push('\u{202F}');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_as_long_as_they_need_to_be() {
        assert_eq!(["0.5", "2.5e-4", "2650", "1.235e7"], [0.5, 2.5e-4, 2650.0, 1.2346e7].map(number));
        assert_eq!(["0", "1", "0.304", "-2.0e-9"], [0.0, 1.0, 0.3043, -2e-9].map(brief));
        assert_eq!(triple(&[-1e-9, 1.0, -0.5]), "(0.0000, 1.0000, -0.5000)");
        assert_eq!(grouped(1_234_567).replace('\u{202F}', " "), "1 234 567");
        assert_eq!(
            (grouped(12), seconds(0.25), seconds(150.4)),
            ("12".into(), "250 ms".into(), "2 min 30 s".into())
        );
    }
}
