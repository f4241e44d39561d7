//! Full and read-only disks, a closed standard output, damaged and foreign checkpoints.

#![cfg(target_os = "linux")]

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

const CHECKPOINT: &str = "checkpoint.ndda";

fn scene(name: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    root.join("scenes").join(format!("{name}.ron")).display().to_string()
}

fn ndda(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_ndda"));
    command.args(arguments);
    command
}

/// Runs the ramp for a while, with a checkpoint after every few steps.
fn run(out: &Path, overrides: &[&str]) -> Output {
    let (scene, out) = (scene("sliding_45"), out.display().to_string());
    let mut command = ndda(&["run", &scene, "--out", &out, "--quiet", "--set", "time.end_s=0.05"]);
    for text in overrides {
        command.args(["--set", text]);
    }
    command.output().expect("the program starts")
}

fn resume(out: &Path) -> Output {
    ndda(&["resume", &out.display().to_string(), "--quiet"]).output().expect("the program starts")
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A file system in memory; gone when dropped.
struct Disk(tempfile::TempDir);

/// Says that a check could not run, to who watches and in the file that NDDA_SKIPPED names.
fn note_skipped(line: &str) {
    eprintln!("skipped: {line}");
    if let Some(path) = std::env::var_os("NDDA_SKIPPED") {
        let mut file = std::fs::OpenOptions::new().create(true).append(true).open(path).expect("a file");
        std::io::Write::write_all(&mut file, format!("{line}\n").as_bytes()).expect("a line");
    }
}

impl Disk {
    /// None, with a word about it, where one may not mount.
    fn of(size: &str) -> Option<Self> {
        let disk = Self(tempfile::tempdir().expect("a folder"));
        let mounted = Command::new("mount")
            .args(["-t", "tmpfs", "-o", &format!("size={size}"), "tmpfs"])
            .arg(disk.0.path())
            .stderr(Stdio::null())
            .status();
        if mounted.is_ok_and(|status| status.success()) {
            return Some(disk);
        }
        note_skipped("tmpfs: mounting is not allowed here");
        None
    }

    fn remount(&self, options: &str) {
        let status =
            Command::new("mount").args(["-o", &format!("remount,{options}")]).arg(self.0.path()).status();
        assert!(status.expect("mount").success());
    }

    fn path(&self) -> &Path {
        self.0.path()
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(self.0.path()).stderr(Stdio::null()).status();
    }
}

/// Frames that the index lists.
fn listed(out: &Path) -> Vec<PathBuf> {
    let index = fs::read_to_string(out.join("fields.pvd")).unwrap_or_default();
    index.split("file=\"").skip(1).map(|rest| out.join(rest.split('"').next().expect("a name"))).collect()
}

fn results(out: &Path) -> (Vec<u8>, Vec<Vec<u8>>) {
    let frames = listed(out).iter().map(|path| fs::read(path).expect("a frame")).collect();
    (fs::read(out.join("history.csv")).expect("a history"), frames)
}

#[test]
fn a_disk_that_fills_up_ends_the_run_with_its_cause_and_it_goes_on_when_there_is_room() {
    let Some(disk) = Disk::of("2m") else { return };
    let (out, whole) = (disk.path().join("out"), tempfile::tempdir().expect("a folder"));
    let many = ["output.frames=200", "output.format=Base64"];
    let full = run(&out, &many);
    assert_eq!(full.status.code(), Some(5), "{}", said(&full));
    assert!(said(&full).contains("free some space"), "{}", said(&full));
    let frames = listed(&out);
    assert!(!frames.is_empty() && frames.len() < 200, "{} frames", frames.len());
    for frame in &frames {
        assert!(fs::read_to_string(frame).expect("a frame").ends_with("</VTKFile>\n"), "{}", frame.display());
    }
    disk.remount("size=50m");
    let resumed = resume(&out);
    assert_eq!(resumed.status.code(), Some(0), "{}", said(&resumed));
    assert_eq!(run(&whole.path().join("out"), &many).status.code(), Some(0));
    assert!(results(&out) == results(&whole.path().join("out")), "it ends otherwise");
}

#[test]
fn a_full_or_read_only_disk_is_found_before_the_first_step() {
    let Some(disk) = Disk::of("64k") else { return };
    let full = run(&disk.path().join("out"), &[]);
    assert!(full.status.code() == Some(5) && said(&full).contains("free some space"), "{}", said(&full));
    disk.remount("ro");
    let locked = run(&disk.path().join("other"), &[]);
    assert!(locked.status.code() == Some(5) && said(&locked).contains("--out"), "{}", said(&locked));
    assert!(!disk.path().join("other").exists());
}

#[test]
fn a_run_does_not_mind_who_listens() {
    let place = tempfile::tempdir().expect("a folder");
    for (name, json) in [("closed", false), ("full", false), ("json", true)] {
        let (scene, out) = (scene("free_fall"), place.path().join(name));
        let out_text = out.display().to_string();
        let mut command = ndda(&["run", &scene, "--out", &out_text]);
        if json {
            command.arg("--json");
        }
        let mut child = match name {
            "closed" => command.stdout(Stdio::piped()),
            _ => command.stdout(File::options().write(true).open("/dev/full").expect("/dev/full")),
        }
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
        drop((child.stdout.take(), child.stderr.take()));
        assert_eq!(child.wait().expect("an end").code(), Some(0), "{name}");
        assert!(out.join("summary.json").exists(), "{name}");
    }
}

/// A checkpoint of an older format, otherwise sound.
fn older(sound: &[u8]) -> Vec<u8> {
    let mut bytes = sound[..sound.len() - 4].to_vec();
    bytes[16..20].copy_from_slice(&1u32.to_le_bytes());
    let sum = crc32fast::hash(&bytes);
    bytes.extend(sum.to_le_bytes());
    bytes
}

#[test]
fn damaged_and_older_checkpoints_are_passed_over_for_the_one_before() {
    let place = tempfile::tempdir().expect("a folder");
    for name in ["torn", "flipped", "older"] {
        let out = place.path().join(name);
        assert_eq!(run(&out, &[]).status.code(), Some(0));
        let (expected, sound) = (results(&out), fs::read(out.join(CHECKPOINT)).expect("a checkpoint"));
        let mut flipped = sound.clone();
        flipped[sound.len() / 2] ^= 8;
        let bytes = match name {
            "torn" => sound[..sound.len() / 3].to_vec(),
            "flipped" => flipped,
            _ => older(&sound),
        };
        fs::write(out.join(CHECKPOINT), &bytes).expect("a file");
        fs::remove_file(out.join("summary.json")).expect("a summary");
        let resumed = resume(&out);
        assert_eq!(resumed.status.code(), Some(0), "{name}: {}", said(&resumed));
        assert!(said(&resumed).contains("the checkpoint before"), "{name}: {}", said(&resumed));
        assert!(results(&out) == expected, "{name}: it ends otherwise");
    }
}

#[test]
fn the_checkpoint_of_another_run_is_passed_over_for_the_one_before() {
    let place = tempfile::tempdir().expect("a folder");
    let (out, other) = (place.path().join("out"), place.path().join("other"));
    assert_eq!(run(&out, &[]).status.code(), Some(0));
    let expected = results(&out);
    // A run with equal columns and frames, but other numbers.
    assert_eq!(run(&other, &["materials[0].density_kg_m3=2651"]).status.code(), Some(0));
    fs::copy(other.join(CHECKPOINT), out.join(CHECKPOINT)).expect("a copy");
    fs::remove_file(out.join("summary.json")).expect("a summary");
    let foreign = resume(&out);
    assert_eq!(foreign.status.code(), Some(0), "{}", said(&foreign));
    assert!(said(&foreign).contains("is of another run"), "{}", said(&foreign));
    assert!(results(&out) == expected, "it ends otherwise");

    fs::copy(other.join(CHECKPOINT), out.join(CHECKPOINT)).expect("a copy");
    fs::remove_file(out.join("checkpoint.previous.ndda")).expect("the one before");
    assert_eq!(resume(&out).status.code(), Some(3));
}
