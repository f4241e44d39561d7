//! `ndda picture` draws runs and scenes, and says what is wrong with what it cannot draw.
#![cfg(feature = "png")]

use std::fs;
use std::path::{Path, PathBuf};

mod common;

use common::{exit, ndda};

/// A block that falls beside one that is fixed.
const SCENE: &str = r#"(title: "A fall", time: (step_s: 1e-3, end_s: 0.1), gravity_m_s2: (0, 0, -9.8), contact: Off,
    materials: [(name: "granite", young_pa: 2e10, poisson: 0.25, density_kg_m3: 2650)],
    blocks: [
        (name: "falling", material: "granite", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))),
        (name: "wall", material: "granite", body: Fixed, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (2, 0, 0)),
    ], output: (frames: FRAMES))"#;

fn scene_in(folder: &Path, frames: u32) -> PathBuf {
    let scene = folder.join("fall.ron");
    fs::write(&scene, SCENE.replace("FRAMES", &frames.to_string())).unwrap();
    scene
}

fn run_in(folder: &Path, frames: u32) -> PathBuf {
    let out = folder.join("out");
    let mut command = ndda();
    command.arg("run").arg(scene_in(folder, frames)).arg("--out").arg(&out).args(["--force", "--quiet"]);
    assert!(command.output().unwrap().status.success());
    out
}

/// Exit code, standard output and error of a call.
fn picture(input: &Path, words: &[&str]) -> (i32, String, String) {
    let folder = input.parent().unwrap();
    let done = ndda().arg("picture").arg(input).args(words).current_dir(folder).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (done.status.code().unwrap(), text(done.stdout), text(done.stderr))
}

fn number(bytes: &[u8]) -> u32 {
    u32::from_be_bytes(bytes[..4].try_into().unwrap())
}

/// Width, height, and frames of an animation.
fn measured(file: &Path) -> (u32, u32, Option<u32>) {
    let bytes = fs::read(file).unwrap();
    assert!(bytes.starts_with(b"\x89PNG"), "{}", file.display());
    let control = bytes.windows(4).position(|w| w == b"acTL");
    (number(&bytes[16..]), number(&bytes[20..]), control.map(|at| number(&bytes[at + 4..])))
}

/// Blocks of very different sizes move by very different lengths; a picture counts those that the run counts.
#[test]
fn a_picture_counts_the_blocks_that_the_run_counts() {
    let folder = tempfile::tempdir().unwrap();
    let block = |name: &str, size: f64, at: f64, speed: f64| {
        format!(
            "(name: \"{name}\", material: \"granite\", body: Rigid, shape: Box(size_m: ({size}, {size}, {size}), cells: (1, 1, 1)),
            at_m: ({at}, 0, 0), velocity_m_s: (0, 0, {speed})),"
        )
    };
    // Radii of 0.087, 0.87 and 8.7 m, gone 1, 10 and 50 mm: the first two by more than 1 %.
    let blocks =
        [block("a", 0.1, 0.0, 0.01), block("b", 1.0, 5.0, 0.1), block("c", 10.0, 20.0, 0.5)].concat();
    let scene = SCENE.replace("FRAMES", "10").replace("gravity_m_s2: (0, 0, -9.8),", "");
    let (before, after) = scene.split_once("(name: \"falling\"").unwrap();
    let (_, after) = after.split_once('\n').unwrap();
    let file = folder.path().join("sizes.ron");
    fs::write(&file, format!("{before}{blocks}\n{after}")).unwrap();
    let out = folder.path().join("out");
    let run = ndda().arg("run").arg(&file).arg("--out").arg(&out).output().unwrap();
    let said = String::from_utf8(run.stdout).unwrap();
    assert!(said.contains("2 of 3 movable blocks moved"), "{said}");
    let (_, said, _) = picture(&out, &[]);
    assert!(said.contains("2 of 3 movable blocks moved"), "{said}");
    // Without the summary, by the same rule from the frames.
    fs::remove_file(out.join("summary.json")).unwrap();
    let (_, said, _) = picture(&out, &[]);
    assert!(said.contains("2 of 4 blocks moved"), "{said}");
}

#[test]
fn a_run_is_drawn_as_a_picture_of_the_size_that_was_asked_for_and_as_an_animation() {
    let folder = tempfile::tempdir().unwrap();
    let out = run_in(folder.path(), 10);
    let (code, said, _) = picture(&out, &[]);
    assert!(code == exit::DONE && said.contains("1 of 1 movable block moved"), "{said}");
    assert_eq!(measured(&out.join("picture.png")), (1200, 800, None));
    let (code, said, _) = picture(
        &out,
        &[
            "--frame", "0.05s", "--color", "velocity", "--view", "20,-10", "--size", "300x200", "-o",
            "a.png", "--json",
        ],
    );
    assert!(
        code == exit::DONE
            && said.contains("\"size\":[300,200]")
            && said.contains("\"schema\":\"ndda.picture/1\"")
    );
    assert_eq!(measured(&folder.path().join("a.png")), (300, 200, None));
    assert_eq!(picture(&out, &["--animate", "--frames", "4", "--size", "200x160"]).0, exit::DONE);
    assert_eq!(measured(&out.join("animation.png")), (200, 160, Some(4)));
    assert_eq!(picture(&out, &["-o", "a.svg", "--dark"]).0, exit::DONE);
    let svg = fs::read_to_string(folder.path().join("a.svg")).unwrap();
    // ½ g t² of a tenth of a second is 49 mm.
    assert!(
        svg.starts_with("<svg")
            && svg.contains("\n49\n")
            && svg.contains("[mm]")
            && svg.contains("\nA fall\n")
    );
    // A run anew leaves no picture of the one before.
    run_in(folder.path(), 10);
    assert!(!out.join("picture.png").exists() && !out.join("animation.png").exists());
}

#[test]
fn the_first_frame_is_that_of_blocks_that_have_not_moved() {
    let folder = tempfile::tempdir().unwrap();
    let out = run_in(folder.path(), 10);
    let (code, said, _) = picture(&out, &["--frame", "first", "-o", "first.svg"]);
    assert!(code == exit::DONE && said.contains("0 of 1 movable block moved"), "{said}");
    // No colour has a meaning yet.
    assert!(!fs::read_to_string(folder.path().join("first.svg")).unwrap().contains("displacement"));
    for names in [["velocity", "velocity_m_s"], ["displacement", "displacement_m"]] {
        let drawn = names.map(|name| {
            let file = format!("{name}.svg");
            assert_eq!(picture(&out, &["--color", name, "-o", &file]).0, exit::DONE, "{name}");
            fs::read(folder.path().join(file)).unwrap()
        });
        assert_eq!(drawn[0], drawn[1], "{names:?}");
    }
}

#[test]
fn a_scene_is_drawn_before_it_has_run() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene_in(folder.path(), 0);
    for colour in ["block", "material"] {
        assert_eq!(picture(&scene, &["--color", colour]).0, exit::DONE);
        assert_eq!(measured(&folder.path().join("fall.png")), (1200, 800, None));
    }
    for (words, reason) in [
        (["--color", "stress"], "a scene has no results before it is run"),
        (["--animate", "--fps=5"], "does not move"),
        (["--set", "materials.granite.poisson=0.7"], "poisson"),
    ] {
        let (code, _, said) = picture(&scene, &words);
        assert!(code == exit::BAD_INPUT && said.contains(reason), "{said}");
    }
}

#[test]
fn a_run_of_one_frame_or_none_is_drawn_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = run_in(folder.path(), 1);
    for words in [&["--frame", "first"][..], &["--animate"]] {
        assert_eq!(picture(&out, words).0, exit::DONE);
    }
    let index = out.join("fields.pvd");
    fs::write(&index, "<VTKFile><Collection></Collection></VTKFile>").unwrap();
    let (code, _, said) = picture(&out, &[]);
    assert!(code == exit::BAD_INPUT && said.contains("holds no frames of blocks"), "{said}");
    fs::remove_file(&index).unwrap();
    let (code, _, said) = picture(&out, &[]);
    assert!(code == exit::BAD_INPUT && said.contains("output.frames above 0"), "{said}");
}

#[test]
fn a_damaged_frame_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let out = run_in(folder.path(), 4);
    let frame = out.join("fields/frame_000004.vtu");
    let whole = fs::read(&frame).unwrap();
    for part in [0, 1, 3, 7] {
        fs::write(&frame, &whole[..whole.len() * part / 8]).unwrap();
        let (code, _, said) = picture(&out, &[]);
        assert!(code == exit::BAD_INPUT && said.contains("frame_000004.vtu"), "{said}");
    }
    // The frames before it are whole.
    assert_eq!(picture(&out, &["--frame", "3"]).0, exit::DONE);
    fs::remove_file(&frame).unwrap();
    let (code, _, said) = picture(&out, &["--animate"]);
    assert!(code == exit::BAD_INPUT && said.contains("frame_000004.vtu"), "{said}");
}

#[test]
fn what_cannot_be_drawn_is_refused_with_figures() {
    let folder = tempfile::tempdir().unwrap();
    let out = run_in(folder.path(), 4);
    for (words, reason) in [
        (["--size", "10x10"], "160 to 16384 pixels"),
        (["--size", "16000x16000"], "256.00 million"),
        (["--size", "4000000000x2"], "16384 pixels"),
        (["--frame", "5"], "5 frames, 0 to 4"),
        (["--frame", "0.2s"], "0 s to 0.1 s"),
        (["--color", "colour"], "choose one of displacement, block, velocity_m_s"),
        (["--color", "material"], "add Material to output.fields"),
        (["-o", "a.jpg"], ".png or .svg"),
        (["--magnify", "1e30"], "here up to 2030"),
        (["--set", "time.end_s=1"], "run it again with --set"),
    ] {
        let (code, _, said) = picture(&out, &words);
        assert!(code == exit::BAD_INPUT && said.contains(reason), "{words:?}: {said}");
    }
    let (code, _, said) = picture(&folder.path().join("none"), &[]);
    assert!(code == exit::BAD_INPUT && said.contains("there is no"), "{said}");
    let (code, _, said) = picture(&out, &["-o", "no/such.png"]);
    assert!(code == exit::INPUT_OUTPUT && said.contains("such.png"), "{said}");
    for words in [
        ["--view", "up"],
        ["--size", "10"],
        ["--resting", "x"],
        ["--magnify", "inf"],
        ["--magnify", "0"],
        ["--frame", "x"],
    ] {
        assert_eq!(picture(&out, &words).0, 2, "{words:?}");
    }
}

#[test]
fn the_joints_of_a_scene_have_a_colour_each_and_those_of_a_run_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("rock.ron");
    let joints = r#"joints: [Plane(name: "bed", dip_deg: 10, dip_direction_deg: 90, point_m: (1, 1, 1)),
        Set(name: "steep", dip_deg: 80, dip_direction_deg: 0, spacing_m: 0.8)]"#;
    let text = |joints: &str| {
        format!(
            "(title: \"Joints\", time: (step_s: 1e-3, end_s: 0.002), contact: Potential(penalty_pa: 1e8),
            materials: [(name: \"granite\", young_pa: 2e10, poisson: 0.25, density_kg_m3: 2650)],
            rock: [(name: \"rock\", material: \"granite\", body: Rigid, domain: Box(min_m: (0, 0, 0), max_m: (2, 2, 2)), {joints})],
            output: (frames: 2))"
        )
    };
    fs::write(&scene, text(joints)).unwrap();
    let (code, said, _) = picture(&scene, &["--color", "joint", "-o", "joints.svg"]);
    assert!(code == exit::DONE && said.contains("joints.svg: 1200 x 800 pixels, 2 joints or sets"), "{said}");
    let svg = fs::read_to_string(folder.path().join("joints.svg")).unwrap();
    assert!(svg.contains("bed") && svg.contains("steep") && !svg.contains("x_min"));
    let out = folder.path().join("out");
    let mut run = ndda();
    run.arg("run").arg(&scene).arg("--out").arg(&out).args(["--force", "--quiet"]);
    assert!(run.output().unwrap().status.success());
    assert!(picture(&out, &["--color", "joint"]).2.contains("name the scene file to see them"));
    fs::write(&scene, text("joints: []")).unwrap();
    assert!(picture(&scene, &["--color", "joint"]).2.contains("has no block with a face on a joint"));
}

/// A block on one that is fixed, tied to it by a bolt of 20 kN and, from a stage on, by another one.
const BOLTED: &str = r#"(title: "Bolted", time: (step_s: 1e-4, end_s: 2e-3),
    materials: [(name: "rock", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
    blocks: [
        (name: "foot", material: "rock", body: Fixed, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))),
        (name: "top", material: "rock", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, 1)),
    ],
    contact: Potential(penalty_pa: 1e9, friction: (friction_deg: 30)),
    bolts: [
        (name: "anchor", at: Line(from_m: (0.4, 0.45, 2), to_m: (0.4, 0.45, 0.2)), steel: (young_pa: 200e9, area_m2: 5e-4, yield_n: 1e5),
         grout: (stiffness_n_m2: 1e9, strength_n_m: 2e5, from_m: 1.2), pretension_n: 20e3, plate: ()),
        (name: "late", at: Line(from_m: (0.7, 0.6, 2), to_m: (0.7, 0.6, 0.2)), steel: (young_pa: 200e9, area_m2: 5e-4),
         grout: (stiffness_n_m2: 1e9, strength_n_m: 2e5)),
    ],
    stages: [(name: "second", install: ["late"], over_s: 1e-3, then: Run(2e-3))],
    output: (frames: 4))"#;

#[test]
fn bolts_are_drawn_with_a_scale_of_their_forces_and_of_a_scene_plainly() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("bolted.ron");
    fs::write(&scene, BOLTED).unwrap();
    let svg = || fs::read_to_string(folder.path().join("a.svg")).unwrap();
    let (code, said, _) = picture(&scene, &["-o", "a.svg"]);
    assert!(code == exit::DONE && said.contains("2 bolts, 1 of 2 blocks may move"), "{said}");
    assert!(svg().contains("\nbolts\n"));
    let out = folder.path().join("out");
    let run = ndda().arg("run").arg(&scene).arg("--out").arg(&out).arg("--quiet").output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let (code, said, _) = picture(&out, &["-o", "a.svg"]);
    assert!(code == exit::DONE && said.contains("2 bolts, "), "{said}");
    // The anchor keeps its 20 kN but for what the blocks give way, and there is no other.
    let found = svg();
    let (_, scale) = found.split_once("\nbolts, tension\n").unwrap();
    let largest = scale.split("<text ").nth(2).unwrap().lines().nth(1).unwrap();
    assert!(scale.contains("[kN]") && (19.0..20.1).contains(&largest.parse::<f64>().unwrap()), "{largest}");
    // In the first frame the second bolt is not there yet.
    assert!(picture(&out, &["--frame", "0", "-o", "a.svg"]).1.contains("1 bolt, "));
    assert_eq!(picture(&out, &["--bolts", "hidden", "-o", "a.svg"]).0, exit::DONE);
    assert!(!svg().contains("bolts"));
    assert_eq!(picture(&out, &["--animate", "--size", "200x160", "--bolts", "state"]).0, exit::DONE);
    assert_eq!(picture(&out, &["--bolts", "axial"]).0, 2);
    // A damaged frame of bolts is refused by name.
    fs::write(out.join("fields/bolts_000001.vtu"), "<VTKFile>").unwrap();
    let (code, _, said) = picture(&out, &["--frame", "1"]);
    assert!(code == exit::BAD_INPUT && said.contains("bolts_000001.vtu"), "{said}");
}

#[test]
fn options_that_would_change_nothing_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene_in(folder.path(), 1);
    let out = run_in(folder.path(), 1);
    for (input, words, reason) in [
        (&scene, ["--frame", "3"], "--frame is for the output folder of a run"),
        (&scene, ["--magnify", "50"], "--magnify is for the output folder of a run"),
        (&scene, ["--bolts", "plain"], "--bolts: there are no bolts"),
        (&out, ["--bolts", "state"], "--bolts: there are no bolts"),
    ] {
        let (code, _, said) = picture(input, &words);
        assert!(code == exit::BAD_INPUT && said.contains(reason), "{code} {said}");
    }
}
