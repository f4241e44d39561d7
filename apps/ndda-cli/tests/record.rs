//! `ndda record`: files, numbers and refusals.

use std::path::Path;
use std::process::{Command, Output};

fn record(folder: &Path, args: &[&str]) -> Output {
    let mut ndda = Command::new(env!("CARGO_BIN_EXE_ndda"));
    ndda.arg("record").args(args).current_dir(folder).output().unwrap()
}

/// A pulse of 0.3 g for half a second, in g, as PEER writes it.
fn pulse() -> String {
    let values = "  .3000000E+00".repeat(5) + "\n";
    format!(
        "PEER\npulse\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 50, DT= .0100 SEC\n{}",
        values.repeat(10)
    )
}

#[test]
fn a_record_is_measured_and_its_block_slides_as_its_closed_form_says() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("pulse.AT2"), pulse()).unwrap();
    let done = record(folder.path(), &["pulse.AT2", "--yield", "0.980665", "--json"]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let json: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    assert_eq!((&json["schema"], &json["event"]), (&"ndda.record/1".into(), &"finished".into()));
    let (g, t) = (9.80665, 0.49);
    // 0.3 g for 0.49 s against 0.1 g: ½ · 0.2 g t² · 3.
    let slip = json["slip"][0]["last_m"].as_f64().unwrap();
    assert!((slip + 0.5 * 0.2 * g * t * t * 3.0).abs() < 1e-6, "{slip}");
    let peak = json["peak_velocity_m_s"]["value"].as_f64().unwrap();
    assert!((peak - 0.3 * g * t).abs() < 1e-9, "{peak}");
    for file in ["record.motion.csv", "record.spectrum.csv"] {
        assert!(folder.path().join(file).is_file(), "{file}");
    }
}

#[test]
fn velocities_of_a_history_are_resampled_filtered_and_corrected_as_records_are() {
    let folder = tempfile::tempdir().unwrap();
    let rows: String =
        (0..100).map(|i| format!("{},{}\n", 0.01 * f64::from(i), 0.02 * f64::from(i))).collect();
    std::fs::write(folder.path().join("history.csv"), format!("time_s,crest.velocity_x_m_s\n{rows}"))
        .unwrap();
    let measured = |more: &[&str]| {
        let args = [&["history.csv", "--column", "crest.velocity_x_m_s", "--json"], more].concat();
        let done = record(folder.path(), &args);
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        let json: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
        (
            json["peak_acceleration_m_s2"]["value"].as_f64().unwrap(),
            json["record"].as_str().unwrap().to_owned(),
        )
    };
    assert!((measured(&[]).0 - 2.0).abs() < 1e-9);
    let (left_m_s2, told) = measured(&["--baseline", "linear", "--resample", "0.02"]);
    assert!(
        left_m_s2 < 1e-9 && told.contains("brought to 50 rows of 0.02 s, less a velocity of 2"),
        "{left_m_s2}: {told}"
    );
    let (_, told) = measured(&["--filter", "0.1,25"]);
    assert!(told.contains("filtered from 0.1 to 25 Hz"), "{told}");
}

#[test]
fn what_is_no_record_is_refused_with_its_cure() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("pulse.at2"), pulse().replace("NPTS= 50", "NPTS= 51")).unwrap();
    std::fs::write(folder.path().join("table.csv"), "time_s,ax,ay\n0,1,2\n1,1,2\n").unwrap();
    std::fs::write(folder.path().join("empty.csv"), "").unwrap();
    std::fs::write(folder.path().join("head.csv"), "time_s,acceleration_m_s2\n").unwrap();
    for (args, word) in [
        (vec!["empty.csv"], "it is empty: name the columns"),
        (vec!["head.csv"], "it has no row of numbers: give two at least"),
        (vec!["pulse.at2"], "line 4 says 51"),
        (vec!["no.at2"], "cannot be read"),
        (vec!["table.csv"], "there is no column `acceleration_m_s2`; the first line names time_s, ax, ay"),
        (vec!["pulse.at2", "--column", "ax"], "an .at2 file has no columns: leave `column` out"),
        (vec!["table.csv"], ": set `column` (--column) to the one that holds accelerations"),
        (vec!["table.csv", "--column", "ax", "--resample", "5"], "`resample_s` (--resample)"),
    ] {
        let done = record(folder.path(), &args);
        let said = String::from_utf8_lossy(&done.stderr).into_owned();
        assert!(done.status.code() == Some(3) && said.contains(word), "{args:?}: {said}");
    }
}

#[test]
fn options_of_records_that_are_out_of_range_are_errors_of_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("table.csv"), "time_s,ax,ay\n0,1,2\n1,1,2\n").unwrap();
    for (args, word) in [
        (vec!["--filter", "5,1"], "the lower one first"),
        (vec!["--slope", "40", "--friction", "30"], "below that of --friction"),
        (vec!["--damping", "1.5"], "from 0 to below 1"),
        (vec!["--factor", "nan"], "--factor NaN: write a finite number"),
        (
            vec!["--column", "crest.velocity_x_m_s", "--unit", "g"],
            "write no unit for a history, whose velocities are in m/s",
        ),
    ] {
        let column: &[&str] = if args.contains(&"--column") { &[] } else { &["--column", "ax"] };
        let done = record(folder.path(), &[&["table.csv"], column, &args].concat());
        let said = String::from_utf8_lossy(&done.stderr).into_owned();
        assert!(done.status.code() == Some(2) && said.contains(word), "{args:?}: {said}");
    }
}

#[test]
fn a_peak_that_resampling_loses_is_told_and_a_wrong_picture_leaves_no_tables() {
    let folder = tempfile::tempdir().unwrap();
    let rows: String = (0..40).map(|i| format!("{},{}\n", 0.01 * f64::from(i), i32::from(i == 13))).collect();
    std::fs::write(folder.path().join("blow.csv"), format!("time_s,acceleration_m_s2\n{rows}")).unwrap();
    let told = |spacing: &str| {
        let done = record(folder.path(), &["blow.csv", "--resample", spacing]);
        String::from_utf8_lossy(&done.stdout).contains("the peak of 1.0000 m/s² is lost")
    };
    assert_eq!([told("0.1"), told("0.005")], [true, false]);
    let done = record(folder.path(), &["blow.csv", "-o", "blow.bmp"]);
    assert!(!done.status.success() && !folder.path().join("blow.motion.csv").exists());
}

#[test]
fn a_scene_whose_record_is_no_table_is_refused_where_it_names_the_file() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("quake.csv"), "time_s,acceleration_m_s2\n0,0\n0.1,abc\n").unwrap();
    for (hold, path) in [
        (
            "Shaking([(direction: (1, 0, 0), record: (file: \"quake.csv\"))])",
            "supports[0].hold[0][0].record.file",
        ),
        ("Acceleration(file: \"quake.csv\", direction: (1, 0, 0))", "supports[0].hold.file"),
    ] {
        let scene = format!(
            "(title: \"shaken\", time: (step_s: 1e-3, end_s: 0.1), materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.2, density_kg_m3: 2600)],
              blocks: [(name: \"base\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
              supports: [(block: \"base\", on: All, hold: {hold})], contact: Off)"
        );
        std::fs::write(folder.path().join("shaken.ron"), scene).unwrap();
        let done = Command::new(env!("CARGO_BIN_EXE_ndda"))
            .args(["check", "shaken.ron"])
            .current_dir(folder.path())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&done.stderr).into_owned();
        assert!(said.contains(&format!("{path}: ")) && said.contains("line 3 has no number"), "{said}");
        assert!(said.contains("FILE` draws it"), "{said}");
    }
}
