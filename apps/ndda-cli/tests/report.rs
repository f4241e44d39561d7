//! `ndda report` makes one page of a run, whatever the names in its scene, and says what is wrong with a folder that is none.
#![cfg(feature = "report")]

use std::fs;
use std::path::{Path, PathBuf};

mod common;

use common::{code, exit, ndda};

const HOSTILE: &str = "</script><script>document.title='taken'</script><img src=x onerror=alert(1)>&'";

/// Two falling boxes. The title is hostile, and so are names: not as scenes may give them, but as files may come from elsewhere.
fn run_in(folder: &Path, frames: u32) -> PathBuf {
    let scene = folder.join("falling.ron");
    let block = |name: &str, x: f64| {
        format!(
            "(name: \"{name}_NAME\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: ({x}, 0, 0))"
        )
    };
    let text = format!(
        "(title: \"{HOSTILE}\", time: (step_s: 1e-3, end_s: 0.01), gravity_m_s2: (0, 0, -9.8), contact: Off,
        materials: [(name: \"rock\", young_pa: 2e10, poisson: 0.25, density_kg_m3: 2650)],
        blocks: [{}, {}], monitors: [(name: \"m_NAME\", block: \"a_NAME\")], output: (frames: {frames}),
        reference: FreeFall(monitor: \"m_NAME\", after_s: 0.001))",
        block("a", 0.0),
        block("b", 3.0)
    );
    fs::write(&scene, text).unwrap();
    let out = folder.join("out");
    let mut command = ndda();
    command.arg("run").arg(scene).arg("--out").arg(&out).args(["--force", "--quiet", "--threads", "1"]);
    assert_eq!(code(&mut command), exit::DONE);
    for file in ["summary.json", "history.csv"] {
        let text = fs::read_to_string(out.join(file)).unwrap();
        assert!(text.contains("m_NAME"));
        fs::write(out.join(file), text.replace("_NAME", HOSTILE)).unwrap();
    }
    out
}

fn report(folder: &Path, frames: Option<u32>) -> i32 {
    let mut command = ndda();
    command.arg("report").arg(folder).arg("--json");
    if let Some(frames) = frames {
        command.args(["--frames", &frames.to_string()]);
    }
    code(&mut command)
}

fn page(folder: &Path) -> String {
    fs::read_to_string(folder.join("report.html")).unwrap()
}

/// The text between a mark and the next end of a script.
fn script<'a>(page: &'a str, mark: &str) -> &'a str {
    page.split_once(mark).unwrap().1.split_once("</script>").unwrap().0
}

#[test]
fn a_page_holds_curves_and_frames_and_nothing_of_a_scene_is_markup() {
    let folder = tempfile::tempdir().unwrap();
    let out = run_in(folder.path(), 10);
    // For the test in a browser.
    assert_eq!(report(&out, None), exit::DONE);
    let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join("report.html");
    fs::copy(out.join("report.html"), kept).unwrap();
    let text = page(&out);
    assert!(!text.contains("<img") && !text.contains("<script>document"), "a name of the scene is markup");
    assert!(text.contains("&lt;img src=x onerror"));
    let data = script(&text, "<script id=\"data\" type=\"application/json\">");
    let data: serde_json::Value = serde_json::from_str(data).unwrap();
    assert_eq!(data["motion"]["times_s"].as_array().unwrap().len(), 11);
    assert_eq!(data["motion"]["triangles"], 24);
    assert_eq!(data["block_names"][1], format!("b{HOSTILE}"));
    // ½ g t² after a hundredth of a second.
    let fallen = data["motion"]["moved"]["top"].as_f64().unwrap();
    assert!((fallen - 0.5 * 9.8 * 1e-4).abs() < 1e-8, "{fallen}");
    let labels: Vec<_> =
        data["motion"]["fields"].as_array().unwrap().iter().map(|f| f["label"].as_str().unwrap()).collect();
    assert!(labels.contains(&"speed") && labels.contains(&"von Mises stress"), "{labels:?}");
    let titles = data["charts"]["charts"].as_array().unwrap().iter().map(|c| c["title"].as_str().unwrap());
    assert!(titles.clone().any(|t| t == "Energy") && titles.clone().any(|t| t.contains("displacement")));
}

#[test]
fn frames_are_thinned_when_asked_and_a_run_without_fields_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let out = run_in(folder.path(), 10);
    assert_eq!(report(&out, Some(3)), exit::DONE);
    assert!(page(&out).contains("Shows 3 of the 11 frames"));
    assert_eq!(report(&out, Some(0)), exit::DONE);
    assert!(page(&out).contains("This report shows no blocks: it was written with --frames 0"));
    let out = run_in(folder.path(), 0);
    assert!(!out.join("report.html").exists(), "--force leaves a report of the run before");
    assert_eq!(report(&out, None), exit::DONE);
    let text = page(&out);
    assert!(text.contains("the run wrote no fields") && !text.contains("id=\"numbers\""));
}

#[test]
fn folders_that_are_no_run_or_half_of_one_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(report(&folder.path().join("none"), None), exit::BAD_INPUT);
    assert_eq!(report(folder.path(), None), exit::BAD_INPUT);
    assert_eq!(code(ndda().arg("view").arg(folder.path())), exit::BAD_INPUT);
    let out = run_in(folder.path(), 4);
    let frame = out.join("fields/frame_000002.vtu");
    let whole = fs::read(&frame).unwrap();
    fs::write(&frame, &whole[..whole.len() / 2]).unwrap();
    assert_eq!(report(&out, None), exit::BAD_INPUT);
    fs::remove_file(&frame).unwrap();
    assert_eq!(report(&out, None), exit::BAD_INPUT);
    fs::write(out.join("summary.json"), "{}").unwrap();
    assert_eq!(report(&out, None), exit::BAD_INPUT);
    fs::remove_file(out.join("summary.json")).unwrap();
    assert_eq!(report(&out, None), exit::BAD_INPUT);
    assert!(!out.join("report.html").exists());
}

#[test]
fn a_page_that_cannot_be_written_is_an_error_of_output() {
    let folder = tempfile::tempdir().unwrap();
    let folder_of_run = run_in(folder.path(), 1);
    let file = folder.path().join("no/such.html");
    assert_eq!(code(ndda().arg("report").arg(folder_of_run).arg("--out").arg(file)), exit::INPUT_OUTPUT);
}

/// Two blocks that a bolt of 20 kN holds together.
const BOLTED: &str = r#"(title: "Bolted", time: (step_s: 1e-4, end_s: 2e-3),
    materials: [(name: "rock", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
    blocks: [
        (name: "foot", material: "rock", body: Fixed, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))),
        (name: "top", material: "rock", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, 1)),
    ],
    contact: Potential(penalty_pa: 1e9, friction: (friction_deg: 30)),
    bolts: [(name: "anchor", at: Line(from_m: (0.4, 0.45, 2), to_m: (0.4, 0.45, 0.2)), steel: (young_pa: 200e9, area_m2: 5e-4, yield_n: 1e5),
        grout: (stiffness_n_m2: 1e9, strength_n_m: 2e5, from_m: 1.2), pretension_n: 20e3, plate: ())],
    output: (frames: 4))"#;

#[test]
fn bolts_are_in_the_view_in_a_table_and_in_a_curve() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, out) = (folder.path().join("bolted.ron"), folder.path().join("out"));
    fs::write(&scene, BOLTED).unwrap();
    assert_eq!(code(ndda().arg("run").arg(&scene).arg("--out").arg(&out).arg("--quiet")), exit::DONE);
    assert_eq!(report(&out, None), exit::DONE);
    let text = page(&out);
    fs::copy(out.join("report.html"), Path::new(env!("CARGO_TARGET_TMPDIR")).join("report_bolts.html"))
        .unwrap();
    assert!(text.contains("Bolts at the end (1)") && text.contains("<td>anchor</td>"));
    assert!(text.contains("id=\"bolts\"") && text.contains("id=\"bolt-bar\""));
    let data = script(&text, "<script id=\"data\" type=\"application/json\">");
    let data: serde_json::Value = serde_json::from_str(data).unwrap();
    let charts = data["charts"]["charts"].as_array().unwrap();
    let chart = charts.iter().find(|c| c["title"] == "Tension of the bolts that carry most").unwrap();
    let curve = chart["curves"][0]["values"].as_array().unwrap();
    assert!(curve.len() == 5 && chart["curves"][0]["label"] == "anchor" && chart["unit"] == "kN");
    assert!(curve.iter().all(|force| (19.0..20.1).contains(&force.as_f64().unwrap())), "{curve:?}");
    let bolts = &data["motion"]["bolts"];
    let force = bolts["force_n"][1].as_f64().unwrap();
    assert!((19e3..20.1e3).contains(&force), "{force}");
    assert_eq!(bolts["counts"].as_array().unwrap().len(), 5);
    fs::write(out.join("bolts.csv"), "time_s,bolt\n").unwrap();
    assert_eq!(report(&out, None), exit::BAD_INPUT);
}
