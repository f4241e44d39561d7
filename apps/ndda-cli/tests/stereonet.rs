//! `ndda stereonet` draws and checks the joints of scenes and tables.

use std::fs;
use std::path::Path;

mod common;

use common::{exit, ndda};
use serde_json::Value;

fn stereonet(folder: &Path, input: &str, words: &[&str]) -> (i32, String, String) {
    let done = ndda().arg("stereonet").arg(input).args(words).current_dir(folder).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (done.status.code().unwrap(), text(done.stdout), text(done.stderr))
}

fn wedge() -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    root.join("scenes/safety/wedge.ron").display().to_string()
}

#[test]
fn the_joints_of_a_scene_form_the_wedge_of_the_closed_form() {
    let folder = tempfile::tempdir().unwrap();
    let words = ["--slope", "65/156", "--friction", "30", "--json"];
    let (code, said, _) = stereonet(folder.path(), &wedge(), &words);
    assert_eq!(code, exit::DONE);
    let found: Value = serde_json::from_str(&said).unwrap();
    assert_eq!((&found["schema"], &found["event"]), (&"ndda.stereonet/1".into(), &"finished".into()));
    // Joints 40/130 and 60/220 dip at right angles: tan(t − 130°) = tan 40° / tan 60°, tan p = tan 40° cos(t − 130°).
    let [tan_a, tan_b] = [40f64, 60.0].map(|dip| dip.to_radians().tan());
    let turned = (tan_a / tan_b).atan();
    let line = &found["wedges"][0];
    assert!((line["trend_deg"].as_f64().unwrap() - 130.0 - turned.to_degrees()).abs() < 1e-9, "{line}");
    assert!((line["plunge_deg"].as_f64().unwrap() - (tan_a * turned.cos()).atan().to_degrees()).abs() < 1e-9);
    assert_eq!(line["critical"], true);
    assert_eq!(found["checks"]["wedge_sliding"]["critical"], 1);
    if cfg!(feature = "plots") {
        let svg = fs::read_to_string(folder.path().join("stereonet.svg")).unwrap();
        assert!(svg.starts_with("<svg") && svg.contains("face of the slope 65/156"));
    }
}

#[test]
fn a_table_of_planes_is_measured_set_by_set() {
    let folder = tempfile::tempdir().unwrap();
    let rows: String = (0..8).map(|i| format!("20,{},flat\n", 45 * i)).collect();
    let text = format!("dip_deg,dip_direction_deg,set\n{rows}60,180,<steep>\n");
    fs::write(folder.path().join("joints.csv"), text).unwrap();
    let (code, said, _) = stereonet(folder.path(), "joints.csv", &["--net", "angle"]);
    // Eight poles at 20° about the vertical: K = 7 / (8 (1 − cos 20°)) = 14.5.
    assert!(code == exit::DONE && said.contains("14.5") && said.contains("60/180"), "{said}");
    if cfg!(feature = "plots") {
        assert!(fs::read_to_string(folder.path().join("stereonet.svg")).unwrap().contains("&lt;steep&gt;"));
    }
}

#[test]
fn a_slope_without_friction_is_checked_for_directions_alone() {
    let folder = tempfile::tempdir().unwrap();
    // Of the three only the first dips out of the face 60/180, and less steeply.
    let text = "dip_deg,dip_direction_deg\n10,180\n70,180\n10,0\n";
    fs::write(folder.path().join("joints.csv"), text).unwrap();
    let (code, said, _) = stereonet(folder.path(), "joints.csv", &["--slope", "60/180"]);
    assert!(code == exit::DONE && said.contains("friction not considered"), "{said}");
    assert!(said.contains("plane sliding      on 1 of 3"), "{said}");
}

#[test]
fn what_cannot_be_used_is_said_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("bad.csv"), "dip_deg,dip_direction_deg\n40,130\n99,0\n").unwrap();
    let scene = wedge();
    for (input, words, reason) in [
        ("bad.csv", &[][..], "bad.csv, line 3, column 1: dip_deg is `99`"),
        ("none.csv", &[], "none.csv"),
        ("bad.csv", &["--set", "a=1"], "change the table"),
        ("none.ron", &[], "none.ron"),
        (&scene, &["--slope", "65/156", "--friction", "95"], "--friction 95: write an angle from 0 to 90"),
        (&scene, &["--slope", "65/156", "--lateral", "NaN"], "--lateral NaN"),
    ] {
        let (code, _, said) = stereonet(folder.path(), input, words);
        assert!(code == exit::BAD_INPUT && said.contains(reason), "{input} {words:?}: {code} {said}");
    }
    for words in [["--slope", "65"], ["--slope", "95/100"], ["--net", "x"]] {
        assert_eq!(stereonet(folder.path(), &scene, &words).0, 2, "{words:?}");
    }
    let no_joints = "arch.ron";
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(no_joints);
    let (code, _, said) = stereonet(folder.path(), &root.display().to_string(), &[]);
    assert!(code == exit::BAD_INPUT && said.contains("has no joints"), "{said}");
}
