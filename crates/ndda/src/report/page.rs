//! The page: its skeleton, and the scripts and numbers in it. `maud` escapes every text that comes from a scene.

use maud::{DOCTYPE, Markup, PreEscaped, html};
use serde::Serialize;

use super::bolts;
use super::certificate;
use super::charts::Charts;
use super::input::Input;
use super::motion::Motion;
use super::sections;
use crate::summary::{StageEnd, Summary};

const STYLES: [&str; 2] =
    [include_str!("../../assets/vendor/uplot.min.css"), include_str!("../../assets/report/report.css")];
const DRAWING: [&str; 2] =
    [include_str!("../../assets/vendor/uplot.min.js"), include_str!("../../assets/report/charts.js")];
const BLOCKS: [&str; 6] = [
    include_str!("../../assets/vendor/three.min.js"),
    include_str!("../../assets/report/motion.js"),
    include_str!("../../assets/report/colours.js"),
    include_str!("../../assets/report/bolts.js"),
    include_str!("../../assets/report/viewer.js"),
    include_str!("../../assets/report/overlay.js"),
];
const MAIN: &str = include_str!("../../assets/report/main.js");
/// A page that requires nothing from anywhere.
const POLICY: &str =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:";

/// Data of the scripts beside the numbers of the motion.
#[derive(Serialize)]
struct Data<'a> {
    title: &'a str,
    charts: &'a Charts,
    motion: Option<super::motion::Description>,
    block_names: Vec<&'a str>,
}

/// The whole page.
pub fn page(input: &Input, motion: Option<&Motion>) -> String {
    let summary = &input.summary;
    let charts =
        Charts::new(&input.history).with_motion(motion, &names_of(summary)).with_bolts(&input.bolt_forces);
    let (description, numbers) = motion.map(Motion::describe).unzip();
    let (title, block_names) = (summary.title.as_str(), names_of(summary));
    let data = json(&Data { title, charts: &charts, motion: description, block_names });
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            (head(&summary.title))
            body {
                (sections::header(summary))
                main {
                    (sections::outcome(summary))
                    (sections::warnings(summary))
                    div.columns {
                        div.wide { (stage(input, motion)) }
                        div.narrow { (sections::farthest(summary)) (sections::facts(summary)) }
                    }
                    (certificate::certificate(input.certificate.as_ref(), summary))
                    (curves(&charts))
                    div.columns.even { (sections::stages(summary)) (sections::monitors(summary)) }
                    (sections::construction(summary))
                    (sections::verdicts(summary))
                    (bolts::table(summary))
                    (sections::blocks(summary))
                }
                (sections::footer(summary))
                (scripts(&data, numbers.as_deref()))
            }
        }
    };
    page.into_string()
}

/// A page with the blocks alone.
pub fn viewer(title: &str, block_names: &[String], motion: &Motion) -> String {
    let (description, numbers) = motion.describe();
    let block_names = block_names.iter().map(String::as_str).collect();
    let data = json(&Data { title, charts: &Charts::default(), motion: Some(description), block_names });
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            (head(title))
            body {
                main { (player(motion, motion.times_s.len(), &[])) }
                (scripts(&data, Some(&numbers)))
            }
        }
    };
    page.into_string()
}

fn names_of(summary: &Summary) -> Vec<&str> {
    summary.blocks.0.iter().map(|(name, _)| name.as_str()).collect()
}

fn head(title: &str) -> Markup {
    html! {
        head {
            meta charset="utf-8";
            meta http-equiv="Content-Security-Policy" content=(POLICY);
            meta name="viewport" content="width=device-width, initial-scale=1";
            meta name="color-scheme" content="light dark";
            title { (title) " – ndda" }
            @for style in STYLES { style { (PreEscaped(style)) } }
        }
    }
}

fn scripts(data: &str, numbers: Option<&str>) -> Markup {
    html! {
        script id="data" type="application/json" { (PreEscaped(data)) }
        @if let Some(numbers) = numbers {
            script id="numbers" type="text/plain" { (PreEscaped(numbers)) }
            @for script in BLOCKS { script { (PreEscaped(script)) } }
        }
        @for script in DRAWING { script { (PreEscaped(script)) } }
        script { (PreEscaped(MAIN)) }
    }
}

/// JSON that may stand in a script: nothing in it can end the script or begin a comment.
fn json(value: &impl Serialize) -> String {
    serde_json::to_string(value).unwrap_or_else(|_| "null".into()).replace('<', "\\u003c")
}

/// Where blocks move, with what moves them.
fn stage(input: &Input, motion: Option<&Motion>) -> Markup {
    let Some(motion) = motion else {
        return html! {
            section.card {
                h2 { "Blocks" }
                p.note { "This report shows no blocks: " (missing(input)) }
            }
        };
    };
    player(motion, input.frames.len(), &input.summary.stages)
}

/// The 3D view with its controls, of a run with so many frames; buttons lead to the ends of stages.
fn player(motion: &Motion, all: usize, stages: &[StageEnd]) -> Markup {
    let shown = motion.times_s.len();
    html! {
        section.card.stage {
            div.tools {
                label { "Colour " select #colour {} }
                label { "Motion × " select #factor { @for factor in ["1", "10", "100", "1000"] { option { (factor) } } } }
                label {
                    "Blocks at rest "
                    select #rest {
                        @for (way, name) in [("light", "light"), ("glass", "see-through"), ("plain", "as others")] {
                            option value=(way) { (name) }
                        }
                    }
                }
                @if !motion.bolts.is_empty() {
                    label {
                        "Bolts "
                        select #bolts {
                            @for (way, name) in [("force", "tension"), ("yield", "share of yield"), ("state", "state"), ("hidden", "hidden")] {
                                option value=(way) { (name) }
                            }
                        }
                    }
                }
                label { input #paths type="checkbox"; " Paths of block centres" }
                label { input #whole type="checkbox"; " Whole model" }
                span.views {
                    @for (view, name) in [("iso", "3D"), ("front", "Front"), ("side", "Side"), ("top", "Top")] {
                        button type="button" data-view=(view) { (name) }
                    }
                    button #save type="button" { "Save picture" }
                }
            }
            div #view tabindex="0" aria-label="Blocks in 3D: drag to turn, wheel to zoom, right button to shift" {
                div .bars {
                    @if !motion.bolts.is_empty() {
                        div #bolt-bar .bar { span #bolt-bar-title {} div #bolt-bar-colours {} div #bolt-bar-numbers {} }
                    }
                    div #bar .bar { span #bar-title {} div #bar-colours {} div #bar-numbers {} }
                }
                output #picked {}
            }
            @if !stages.is_empty() {
                div.tools {
                    span.views {
                        "Ends of stages "
                        @for stage in stages { button type="button" data-time=(stage.end_s) { (stage.name) } }
                    }
                }
            }
            div.player {
                button #play type="button" aria-label="Play" { "▶" }
                input #slider type="range" min="0" max=(shown.saturating_sub(1)) value="0" step="1" aria-label="Frame";
                output #time {}
            }
            @if shown < all {
                p.note { "Shows " (shown) " of the " (all) " frames of the run; fields.pvd has them all." }
            }
        }
    }
}

fn missing(input: &Input) -> &'static str {
    match input.frames.is_empty() {
        true => "the run wrote no fields. Give its scene output: (frames: 20), and run it again.",
        false => "it was written with --frames 0.",
    }
}

fn curves(charts: &Charts) -> Markup {
    html! {
        @if !charts.charts.is_empty() {
            h2.heading { "Over time" }
            @for note in &charts.notes { p.note { (note) } }
            div #charts {
                @for chart in &charts.charts { section.card.chart { h3 { (chart.title) } div.plot {} } }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_in_scripts_cannot_end_them() {
        let text = json(&["</script><script>alert(1)</script>", "<!--"]);
        assert!(!text.contains('<'), "{text}");
        assert_eq!(serde_json::from_str::<Vec<String>>(&text).unwrap()[1], "<!--");
    }

    #[test]
    fn embedded_scripts_do_not_end_early_and_name_no_server() {
        for script in BLOCKS.iter().chain(&DRAWING).chain([&MAIN]) {
            assert!(!script.contains("</script") && !script.contains("<!--"));
        }
        for own in [MAIN, BLOCKS[1], BLOCKS[2], BLOCKS[3], BLOCKS[4], BLOCKS[5], DRAWING[1], STYLES[1]] {
            assert!(!own.contains("http") && !own.contains("url("), "{own}");
        }
    }
}
