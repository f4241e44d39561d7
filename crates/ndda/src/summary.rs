//! The summary: what a run did, what it cost and whether it can be trusted, as `summary.json`.

mod bolt;
mod label;
mod motion;
mod named;
mod read;
mod reference_error;
mod stage;
mod verdict;

use std::io::{self, BufWriter, Write};
use std::path::Path;

use ndda_io::read::Chosen;
use ndda_io::{WriteError, atomic};
use serde::{Deserialize, Serialize};
use serde_json::Value;

pub use bolt::BoltEnd;
pub use label::{Label, LabelWord};
pub use motion::{BlockEnd, BlockMotion, Course, MonitorEnd, Motion};
pub use named::Named;
pub use read::SummaryError;
pub use reference_error::ReferenceError;
pub use stage::StageEnd;
pub use verdict::{Judgement, Verdict};

/// Everything that `summary.json` says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Version of ndda.
    pub version: String,
    /// Name of the scene: its file without the ending.
    pub scene: String,
    /// The scene's own title.
    pub title: String,
    /// How the run ended.
    pub status: Status,
    /// Why it stopped before its end. Left out when it did not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stopped_by: Option<String>,
    /// The run's judgement of its own result.
    pub label: Label,
    /// Error of speeds that an accurate label allows where blocks hardly move \[m/s\]: 1 % of the speed of a fall through 1/20 000 of the lowest
    /// tetrahedron. Left out where 1 % of the largest speed is more.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slow_error_m_s: Option<f64>,
    /// Steps done.
    pub steps: u64,
    /// Steps of settling after which the run ended, before the scene had come to rest; time had then not begun. Left out of other runs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unsettled_steps: Option<u64>,
    /// Step Δt \[s\].
    pub step_s: f64,
    /// Values that the scene leaves out and that were chosen for it. Left out where there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub chosen: Vec<Chosen>,
    /// Simulated time reached \[s\].
    pub end_s: f64,
    /// CRC-32 of the final state, hexadecimal: runs that end in the same bits have the same.
    pub state_crc32: String,
    /// Wall-clock time of the whole run \[s\].
    pub wall_s: f64,
    /// Threads used.
    pub threads: usize,
    /// Machine and program.
    pub machine: Machine,
    /// Sizes of the problem.
    pub counts: Counts,
    /// Wall-clock time per stage of the step \[s\].
    pub stages_s: Named<f64>,
    /// The largest violation of each invariant.
    pub invariants: Invariants,
    /// The invariants and the scene's own criteria with their limits.
    pub verdicts: Named<Verdict>,
    /// How the stages of construction ended. Left out where there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stages: Vec<StageEnd>,
    /// Blocks that moved, and how far. Left out where every block is fixed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<Motion>,
    /// State of the monitors at the end.
    pub monitors: Named<MonitorEnd>,
    /// State of the blocks at the end.
    pub blocks: Named<BlockEnd>,
    /// State of the bolts at the end; left out where there are none.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub bolts: Named<BoltEnd>,
    /// Comparison with the closed form that the scene names; null when it names none.
    pub reference: Option<ReferenceError>,
    /// Warnings to read before using the result.
    pub warnings: Vec<String>,
    /// The one of these that says how far settling has moved a block, if any.
    #[serde(skip)]
    pub settled: Option<String>,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// It ran to its end and every criterion was met.
    Done,
    /// It ran to its end and a criterion was not met.
    Failed,
    /// It was stopped because going on would have given a wrong number.
    Stopped,
    /// A person or the system ended it.
    Interrupted,
}

/// Sizes of the problem.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Counts {
    /// Blocks.
    pub blocks: usize,
    /// Nodes.
    pub nodes: usize,
    /// Tetrahedra.
    pub tets: usize,
    /// Unknown displacement components.
    pub dofs: usize,
    /// Matrices factored; congruent blocks share one.
    pub factors: usize,
    /// Most pairs that the broad phase reported in a step.
    pub candidate_pairs_max: usize,
    /// Most pairs that touched in a step.
    pub contact_pairs_max: usize,
    /// Pairs that the broad phase reported, over all steps.
    pub candidate_pairs_total: u64,
    /// Pairs that touched and were clipped, over all steps.
    pub clips_total: u64,
}

/// Machine and program of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// The processor.
    pub processor: String,
    /// Commit that the program was built from.
    pub commit: String,
    /// Cargo features that it was built with.
    pub features: Vec<String>,
    /// Most memory that it held at a time \[B\]. Left out where the system does not report it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub peak_memory_b: Option<u64>,
    /// Processor time of all its threads \[s\]. Left out where the system does not report it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub processor_time_s: Option<f64>,
}

/// The largest violation of each invariant over the run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Invariants {
    /// Energy gained, relative to the peak.
    pub energy_gain: f64,
    /// Energy lost by the algorithm, relative to the peak.
    pub energy_loss: f64,
    /// Linear momentum minus impulses, relative to Σ m |v|.
    pub linear_momentum: f64,
    /// Angular momentum minus angular impulses, relative.
    pub angular_momentum: f64,
    /// Deepest penetration over the height of its tetrahedron.
    pub max_penetration_ratio: f64,
    /// Largest h = ω_c Δt of contact.
    pub max_h: f64,
}

impl Summary {
    /// Writes the summary to `path`, replacing an older file whole.
    ///
    /// # Errors
    /// [`WriteError::NotFinite`] with the key of the first number that is not finite, before anything is written;
    /// [`WriteError::Io`] when the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), WriteError> {
        let encode =
            |e: serde_json::Error| WriteError::Encode { path: path.to_path_buf(), reason: e.to_string() };
        let mut nulls = Nulls::default();
        self.write_to(&mut nulls).map_err(encode)?;
        if nulls.count > usize::from(self.reference.is_none()) {
            let tree = serde_json::to_value(self).map_err(encode)?;
            let key = first_null(&tree, "").unwrap_or_default();
            return Err(WriteError::not_finite(path, key, None));
        }
        atomic::write_by(path, |file| {
            let mut out = BufWriter::new(file);
            self.write_to(&mut out)?;
            out.write_all(b"\n")?;
            out.flush()
        })
    }

    fn write_to(&self, to: &mut dyn Write) -> serde_json::Result<()> {
        serde_json::to_writer_pretty(to, self)
    }
}

/// Counts the nulls of a text in JSON that is written to it: a summary of a million blocks need not be in memory once more to be looked through.
#[derive(Default)]
struct Nulls {
    count: usize,
    is_in_text: bool,
    is_escaped: bool,
}

impl Write for Nulls {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        for byte in bytes {
            match byte {
                _ if self.is_escaped => self.is_escaped = false,
                b'\\' => self.is_escaped = true,
                b'"' => self.is_in_text = !self.is_in_text,
                // No other word of JSON has this letter.
                b'n' if !self.is_in_text => self.count += 1,
                _ => {}
            }
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The key of the first null other than `reference`. JSON has no word for NaN and infinity: serde_json writes null.
/// Every other field that may be absent is left out rather than null, so any other null is such a number.
fn first_null(value: &Value, key: &str) -> Option<String> {
    let below = |name: String| if key.is_empty() { name } else { format!("{key}.{name}") };
    match value {
        Value::Null => (key != "reference").then(|| key.to_owned()),
        Value::Array(items) => {
            items.iter().enumerate().find_map(|(i, item)| first_null(item, &format!("{key}[{i}]")))
        }
        Value::Object(map) => map.iter().find_map(|(name, item)| first_null(item, &below(name.clone()))),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn example() -> Summary {
        let verdict = |value, limit, verdict| Verdict { value, limit, verdict };
        Summary {
            version: "0.1.0".into(),
            scene: "sliding_45".into(),
            title: "Block on a ramp".into(),
            status: Status::Done,
            stopped_by: None,
            label: Label { word: LabelWord::Inaccurate, reasons: vec!["too deep".into()] },
            slow_error_m_s: None,
            steps: 10_000,
            unsettled_steps: None,
            step_s: 1e-4,
            chosen: Vec::new(),
            end_s: 1.0,
            state_crc32: "0123abcd".into(),
            wall_s: 2.5,
            threads: 2,
            machine: Machine { processor: "one".into(), ..Machine::default() },
            counts: Counts { blocks: 2, nodes: 100, ..Counts::default() },
            stages_s: Named(vec![("contact".into(), 1.5), ("assemble".into(), 0.5)]),
            invariants: Invariants { energy_gain: 1e-9, ..Invariants::default() },
            verdicts: Named(vec![
                ("energy gained".into(), verdict(Some(1e-9), Some(0.01), Judgement::Pass)),
                ("action minus reaction".into(), verdict(None, None, Judgement::NotYet)),
            ]),
            stages: Vec::new(),
            motion: None,
            bolts: Named(Vec::new()),
            monitors: Named(vec![("top".into(), MonitorEnd::default())]),
            blocks: Named(vec![("ramp".into(), BlockEnd::default()), ("block".into(), BlockEnd::default())]),
            reference: Some(ReferenceError {
                kind: "SlidingBlock".into(),
                error_end: 1e-7,
                error_max: 2e-7,
                place_end: None,
                after_s: 0.02,
                stick_stage_end: None,
                stick_stage_max: Some(3e-7),
            }),
            warnings: Vec::new(),
            settled: None,
        }
    }

    fn written(summary: &Summary) -> (String, Value) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("summary.json");
        summary.write(&path).unwrap();
        let text = fs::read_to_string(&path).unwrap();
        let value = serde_json::from_str(&text).unwrap();
        (text, value)
    }

    fn keys(value: &Value) -> Vec<&str> {
        value.as_object().unwrap().keys().map(String::as_str).collect()
    }

    #[test]
    fn the_promised_keys_are_there() {
        let (_, value) = written(&example());
        let top = "scene status label steps step_s end_s wall_s threads machine counts stages_s invariants monitors blocks reference";
        let promised = [
            ("", top),
            ("/label", "word reasons"),
            ("/machine", "processor commit features"),
            (
                "/counts",
                "blocks nodes tets dofs factors candidate_pairs_max contact_pairs_max candidate_pairs_total clips_total",
            ),
            (
                "/invariants",
                "energy_gain energy_loss linear_momentum angular_momentum max_penetration_ratio max_h",
            ),
            ("/monitors/top", "displacement velocity"),
            ("/blocks/block", "mass velocity momentum displacement_m farthest_m largest_m rotation_deg"),
            ("/reference", "kind error_end error_max"),
        ];
        for (pointer, names) in promised {
            let found = keys(value.pointer(pointer).unwrap());
            for name in names.split(' ') {
                assert!(found.contains(&name), "{pointer}/{name} is missing: {found:?}");
            }
        }
        assert_eq!(value["status"], "done");
        assert_eq!(value["verdicts"]["action minus reaction"], serde_json::json!({ "verdict": "not yet" }));
        assert!(value["reference"].get("stick_stage_end").is_none());
    }

    #[test]
    fn blocks_and_stages_keep_their_order() {
        let (text, _) = written(&example());
        assert!(text.find("\"ramp\"").unwrap() < text.find("\"block\"").unwrap());
        assert!(text.find("\"contact\"").unwrap() < text.find("\"assemble\"").unwrap());
    }

    #[test]
    fn a_scene_without_a_closed_form_has_a_null_reference() {
        let (_, value) = written(&Summary { reference: None, ..example() });
        assert_eq!(value["reference"], Value::Null);
    }

    #[test]
    fn numbers_read_back_to_the_same_bits() {
        let (_, value) = written(&Summary { wall_s: 0.1 + 0.2, end_s: 5e-324, ..example() });
        assert_eq!(value["wall_s"].as_f64(), Some(0.1 + 0.2));
        assert_eq!(value["end_s"].as_f64(), Some(5e-324));
    }

    #[test]
    fn a_number_that_is_not_finite_is_refused_by_its_key() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("summary.json");
        let refused = |summary: &Summary| match summary.write(&path).unwrap_err() {
            WriteError::NotFinite { array, .. } => array,
            other => panic!("{other}"),
        };
        let mut summary = example();
        summary.blocks.0[1].1.momentum[2] = f64::NAN;
        assert_eq!(refused(&summary), "blocks.block.momentum[2]");
        let mut summary = example();
        summary.reference.as_mut().unwrap().stick_stage_max = Some(f64::INFINITY);
        assert_eq!(refused(&summary), "reference.stick_stage_max");
        let mut summary = example();
        summary.verdicts.0[0].1.value = Some(f64::NEG_INFINITY);
        assert_eq!(refused(&summary), "verdicts.energy gained.value");
        assert!(!path.exists());
    }
}
