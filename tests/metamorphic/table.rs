//! The label's record over many scenes: a line per scene in a file that grows, and a table of them all.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::PathBuf;
use std::sync::Mutex;

use ndda_io::scene::{Contact, Integrator, Potential};

use crate::generator::Case;
use crate::search::{folder, number};

const HEAD: &str = "seed,family,integrator,contact_at,potential,friction,body,factor,label,error_speed,error_place,doubt,truth,reasons";

/// A scene and what was found.
pub struct Record {
    seed: u64,
    scene: String,
    label: &'static str,
    errors: [f64; 3],
    truth: &'static str,
    reasons: String,
}

impl Record {
    pub fn new(case: &Case, label: &'static str, reasons: &[String]) -> Self {
        let scene = &case.scene;
        let integrator = match scene.time.integrator {
            Integrator::Midpoint { theta: 0.5 } => "Midpoint",
            Integrator::Midpoint { .. } => "Midpoint damped",
            Integrator::GeneralizedAlpha { .. } => "GeneralizedAlpha",
            Integrator::Newmark { .. } => "Newmark",
        };
        let (potential, friction) = match &scene.contact {
            Some(Contact::Potential { potential, friction, .. }) => {
                let potential = match potential {
                    Potential::Element => "Element",
                    Potential::Smooth { .. } => "Smooth",
                    Potential::Closure { .. } => "Closure",
                    Potential::Volume { .. } => "Volume",
                };
                let friction = match friction {
                    None => "none",
                    Some(f) if f.cohesion_pa > 0.0 => "bond",
                    Some(f) if f.shear_penalty_pa_m.is_some() => "spring",
                    Some(_) => "velocity",
                };
                (potential, friction)
            }
            _ => ("none", "none"),
        };
        let at = if scene.time.contact_at == Default::default() { "predicted" } else { "end" };
        let mut bodies: Vec<String> = scene.blocks.iter().map(|b| format!("{:?}", b.body)).collect();
        bodies.extend(scene.rock.iter().map(|r| format!("{:?}", r.body)));
        bodies.sort();
        bodies.dedup();
        let bodies = bodies.join("+");
        let text =
            format!("{},{integrator},{at},{potential},{friction},{bodies},{}", case.family, case.factor);
        let reasons = reasons.iter().map(|reason| short(reason)).collect::<Vec<_>>().join("; ");
        let errors = [f64::NAN; 3];
        Self { seed: case.seed, scene: text, label, errors, truth: "", reasons }
    }

    /// Errors over what is promised, doubt of the judge, and whether the run is right.
    pub fn judged(&mut self, speeds: f64, places: f64, doubt: f64, right: Result<bool, &'static str>) {
        self.errors = [speeds, places, doubt];
        self.truth = right.map_or_else(|why| why, |right| if right { "right" } else { "wrong" });
    }

    pub fn is_wrong(&self) -> bool {
        self.label == "accurate" && self.truth == "wrong"
    }

    pub fn line(&self) -> String {
        let number = |x: f64| if x.is_finite() { format!("{x:.3}") } else { String::new() };
        let [speed, place, doubt] = self.errors.map(number);
        let Self { seed, scene, label, truth, reasons, .. } = self;
        format!("{seed},{scene},{label},{speed},{place},{doubt},{truth},{reasons}")
    }
}

/// Subject of a reason, without its numbers.
fn short(reason: &str) -> &'static str {
    const KINDS: [(&str, &str); 27] = [
        ("deviates from Coulomb", "friction"),
        ("strains reach", "strains"),
        ("lumped masses", "lumped masses"),
        ("does not resolve damping of contact", "contact damping"),
        ("does not resolve damping", "damping"),
        ("vibrate or jump", "ringing"),
        ("of the total energy was gained", "energy of all"),
        ("of the total energy was lost", "energy of all"),
        ("energy was added", "energy for a time"),
        ("contact added", "energy of a pair"),
        ("contact removed", "energy of a pair"),
        ("penetrate each other", "penetration"),
        ("drifts sideways", "squeezed out"),
        ("crept by", "creep"),
        ("creeps at", "creep"),
        ("each time longer than before", "hops"),
        ("a bond broke", "bonds"),
        ("unstable or not resolved", "h of contact"),
        ("approached each other", "travel"),
        ("rotates too far", "turn"),
        ("vibrations", "vibrations"),
        ("change within a step", "pulses"),
        ("is not balanced", "momentum"),
        ("action and reaction", "action and reaction"),
        ("inverted", "inverted"),
        ("centroid", "past the centroid"),
        ("evaluations", "contact not solved"),
    ];
    KINDS.iter().find(|(part, _)| reason.contains(part)).map_or("other", |(_, kind)| kind)
}

/// The file of all records.
pub struct Table {
    file: Mutex<File>,
    path: PathBuf,
    known: Vec<u64>,
}

impl Table {
    /// The file that `NDDA_LABEL` names, which grows; else a new one under `target/metamorphic`.
    pub fn open() -> Self {
        let kept = std::env::var_os("NDDA_LABEL").map(PathBuf::from);
        let path = kept.clone().unwrap_or_else(|| folder().join("label.csv"));
        if kept.is_none() || !path.exists() {
            std::fs::write(&path, format!("{HEAD}\n")).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        }
        let text = std::fs::read_to_string(&path).expect("a table");
        let seed = |line: &str| line.split(',').next().and_then(|seed| seed.parse().ok());
        let known = text.lines().filter_map(seed).collect();
        let file = OpenOptions::new().append(true).open(&path).expect("a table to add to");
        Self { file: Mutex::new(file), path, known }
    }

    pub fn knows(&self, seed: u64) -> bool {
        number("NDDA_SEED").is_none() && self.known.contains(&seed)
    }

    pub fn add(&self, record: Record) {
        let mut file = self.file.lock().unwrap();
        writeln!(file, "{}", record.line()).expect("room on the disk");
    }

    /// Prints the table of all records; gives the seeds that were called accurate and are wrong.
    pub fn print(&self) -> Vec<u64> {
        let text = std::fs::read_to_string(&self.path).expect("a table");
        let rows: Vec<Vec<&str>> = text.lines().skip(1).map(|line| line.split(',').collect()).collect();
        let (label, truth, reasons) = (8, 12, 13);
        let (mut counts, mut alarms) = (BTreeMap::<String, u64>::new(), BTreeMap::<&str, u64>::new());
        let mut wrong = Vec::new();
        for row in &rows {
            let what = if row[label] == "stopped" {
                "stopped".into()
            } else {
                format!("{}, {}", row[label], row[truth])
            };
            *counts.entry(what).or_default() += 1;
            if (row[label], row[truth]) == ("inaccurate", "right") {
                let subjects: BTreeSet<&str> = row[reasons].split("; ").collect();
                subjects.into_iter().for_each(|reason| *alarms.entry(reason).or_default() += 1);
            }
            if (row[label], row[truth]) == ("accurate", "wrong") {
                wrong.push(row[0].parse().expect("a seed"));
            }
        }
        println!("{} scenes\n\n| label and truth | scenes |\n|---|---|", rows.len());
        counts.iter().for_each(|(what, count)| println!("| {what} | {count} |"));
        println!("\n| why right runs are called inaccurate | scenes |\n|---|---|");
        alarms.iter().for_each(|(reason, count)| println!("| {reason} | {count} |"));
        wrong
    }
}
