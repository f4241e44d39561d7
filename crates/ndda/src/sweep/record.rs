//! Records of the cases that have been computed, a line of JSON for each in `cases.jsonl`.

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use ndda_io::WriteError;
use serde::{Deserialize, Serialize};

use super::quantity::Values;
use crate::study::record::Cause;

/// File of the records.
const FILE: &str = "cases.jsonl";

/// A case that has been computed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepRecord {
    /// Name of the case.
    pub name: String,
    /// Its scene with the files that it names, the program, and what was computed: only the same ones count as computed.
    pub identity: String,
    /// How it went.
    pub outcome: SweepOutcome,
}

/// How a case went.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum SweepOutcome {
    /// It has values.
    Done(Values),
    /// It has none.
    Failed {
        /// Kind of failure.
        cause: Cause,
        /// Why, in its own words.
        reason: String,
    },
}

impl SweepRecord {
    /// Whether the case need not be computed again: a scene that is wrong and a numerical stop stay what they are, a full disk or a
    /// killed process does not.
    fn is_final(&self) -> bool {
        !matches!(self.outcome, SweepOutcome::Failed { cause: Cause::Other, .. })
    }
}

/// The records in a folder, to which more are added.
pub struct Records {
    path: PathBuf,
    known: HashMap<String, SweepRecord>,
    file: Mutex<File>,
}

impl Records {
    /// Reads the records of a folder; a line that was cut off, as by a killed process, is removed.
    ///
    /// # Errors
    /// [`WriteError`] when the file cannot be opened.
    pub fn open(folder: &Path) -> Result<Self, WriteError> {
        let path = folder.join(FILE);
        let io = |operation| {
            let path = path.clone();
            move |source| WriteError::Io { operation, path, source }
        };
        let text = std::fs::read_to_string(&path).unwrap_or_default();
        let whole = text.rfind('\n').map_or(0, |end| end + 1);
        let lines = text[..whole].lines().filter_map(|line| serde_json::from_str::<SweepRecord>(line).ok());
        let known = lines.map(|record| (record.name.clone(), record)).collect();
        let file = OpenOptions::new().create(true).append(true).open(&path).map_err(io("open"))?;
        if whole < text.len() {
            file.set_len(whole as u64).map_err(io("shorten"))?;
        }
        Ok(Self { path, known, file: Mutex::new(file) })
    }

    /// The record of a case, if it need not be computed again.
    pub fn get(&self, name: &str, identity: &str) -> Option<&SweepRecord> {
        self.known.get(name).filter(|record| record.identity == identity && record.is_final())
    }

    /// Adds a record.
    ///
    /// # Errors
    /// [`WriteError`] when it cannot be written.
    pub fn add(&self, record: &SweepRecord) -> Result<(), WriteError> {
        let encode =
            |e: serde_json::Error| WriteError::Encode { path: self.path.clone(), reason: e.to_string() };
        let mut line = serde_json::to_string(record).map_err(encode)?;
        line.push('\n');
        let mut file = self.file.lock().expect("no thread panics");
        let io = |source| WriteError::Io { operation: "write", path: self.path.clone(), source };
        file.write_all(line.as_bytes()).map_err(io)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_are_found_again_and_a_line_that_was_cut_off_is_removed() {
        let folder = tempfile::tempdir().unwrap();
        let record = |name: &str, outcome| SweepRecord { name: name.into(), identity: "1".into(), outcome };
        let done =
            record("a", SweepOutcome::Done(Values { label: None, numbers: vec![("x".into(), 0.1 + 0.2)] }));
        let failed = |cause| SweepOutcome::Failed { cause, reason: "r".into() };
        let records = Records::open(folder.path()).unwrap();
        let others = [record("b", failed(Cause::Stopped)), record("c", failed(Cause::Other))];
        [done.clone()].iter().chain(&others).for_each(|record| records.add(record).unwrap());
        let file = folder.path().join(FILE);
        let whole = std::fs::read_to_string(&file).unwrap();
        std::fs::write(&file, format!("{whole}{{\"name\": \"d")).unwrap();
        let again = Records::open(folder.path()).unwrap();
        assert_eq!(again.get("a", "1"), Some(&done));
        assert!(again.get("b", "1").is_some() && again.get("c", "1").is_none());
        assert_eq!(again.get("a", "2"), None);
        again.add(&record("d", failed(Cause::Scene))).unwrap();
        assert!(Records::open(folder.path()).unwrap().get("d", "1").is_some());
    }
}
