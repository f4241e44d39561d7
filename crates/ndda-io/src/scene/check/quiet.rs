//! Checks of quiet faces, records, and blasts.

use std::path::Path;

use super::Check;
use crate::scene::code::Code;
use crate::scene::record::{Prepared, RecordError};
use crate::scene::{BlastPressure, BlastWall, Body, IncidentWave, Quiet, Record, RecordedAs, WaveKind};

impl Check<'_> {
    pub(super) fn quiet(&mut self, folder: Option<&Path>) {
        let scene = self.scene;
        for (i, quiet) in scene.quiet.iter().enumerate() {
            let path = |field: &str| format!("quiet[{i}].{field}");
            self.known_blocks(path("block"), &quiet.block);
            self.region(&path("on"), &quiet.on);
            if let Some(material) = &quiet.beyond {
                let known: Vec<&str> = scene.materials.iter().map(|m| m.name.as_str()).collect();
                self.known(path("beyond"), "material", material, &known);
            }
            let other = scene.blocks.iter().find(|b| b.name == quiet.block && b.body != Body::Elastic);
            if let Some(block) = other {
                let message = format!(
                    "block `{}` is {:?}: only an Elastic block carries waves, which a quiet face lets out",
                    block.name, block.body
                );
                self.misfit(
                    path("block"),
                    message,
                    "give the block `body: Elastic`, or hold it by a support",
                );
            }
            for (k, wave) in quiet.incident.iter().enumerate() {
                self.incident(&path(&format!("incident[{k}]")), wave, folder);
            }
            if !quiet.layers.is_empty() {
                self.layers(&path(""), quiet);
            }
        }
        let stressed = scene.in_situ.is_some() || scene.blocks.iter().any(|b| b.initial_stress_pa.is_some());
        if !scene.quiet.is_empty() && scene.gravity_m_s2 != [0.0; 3] && scene.settle.is_none() && !stressed {
            let message = "a quiet face has no stiffness: without `settle` or an initial stress nothing holds the rock up, and it sinks";
            self.warn(
                Code::Inexact,
                "quiet[0]",
                message,
                "add settle: (), or give the stress in the ground as in_situ",
            );
        }
    }

    /// Layers of the ground beyond a side; `path` ends with a point.
    fn layers(&mut self, path: &str, quiet: &Quiet) {
        let materials: Vec<&str> = self.scene.materials.iter().map(|m| m.name.as_str()).collect();
        for (k, layer) in quiet.layers.iter().enumerate() {
            let at = |field: &str| format!("{path}layers[{k}].{field}");
            self.known(at("material"), "material", &layer.material, &materials);
            self.numbers(&at("top_m"), &layer.top_m);
        }
        if quiet.beyond.is_some() {
            let help = "leave it out: what lies beyond is the layers, the lowest of which goes on below";
            self.misfit(format!("{path}beyond"), "there are layers beyond", help);
        }
        for (k, wave) in quiet.incident.iter().enumerate() {
            let at = |field: &str| format!("{path}incident[{k}].{field}");
            for (field, is_given) in [("along", wave.along.is_some()), ("ground_m", wave.ground_m.is_some())]
            {
                if is_given {
                    let help = "leave it out: waves go straight up in layers, and their uppermost border is the ground";
                    self.misfit(at(field), "there are layers beyond", help);
                }
            }
            if wave.motion == RecordedAs::Within {
                let help = "use the record of an outcrop, or the wave that comes up";
                self.misfit(
                    at("motion"),
                    "in layers the echo of a record from within rock is not known",
                    help,
                );
            }
        }
    }

    fn incident(&mut self, path: &str, wave: &IncidentWave, folder: Option<&Path>) {
        if let WaveKind::S(direction) = &wave.wave {
            self.direction(format!("{path}.wave"), direction);
        }
        if let Some(along) = &wave.along {
            self.direction(format!("{path}.along"), along);
        }
        for (field, place) in [("from_m", &wave.from_m), ("ground_m", &wave.ground_m)] {
            if let Some(place) = place {
                self.numbers(&format!("{path}.{field}"), place);
            }
        }
        if wave.motion == RecordedAs::Within && wave.ground_m.is_none() {
            let message = "a record from within rock contains the upgoing wave and its reflection from the level ground surface";
            self.misfit(
                format!("{path}.motion"),
                message,
                "give ground_m, a point on the ground surface above",
            );
        }
        self.record(&format!("{path}.record"), &wave.record, folder);
    }

    pub(super) fn record(&mut self, path: &str, record: &Record, folder: Option<&Path>) {
        let before = self.found.len();
        self.file(format!("{path}.file"), &record.file, folder);
        self.numbers(&format!("{path}.factor"), &[record.factor]);
        if let Some(spacing_s) = record.resample_s {
            self.positive(format!("{path}.resample_s"), spacing_s, "s");
        }
        if let Some((low_hz, high_hz)) = record.filter_hz
            && !(0.0 <= low_hz && low_hz < high_hz && high_hz.is_finite())
        {
            let message =
                format!("({low_hz}, {high_hz}) Hz: the lower corner comes first, and is not negative");
            self.error(
                format!("{path}.filter_hz"),
                message,
                "such as (0.1, 25); a low of 0 lets low frequencies pass",
            );
        }
        if self.found.len() == before {
            self.table_of_record(format!("{path}.file"), &record.file, folder, |folder| {
                record.prepared(folder)
            });
        }
    }

    /// Refuses the file of a record that is there, but cannot be read as a record.
    pub(super) fn table_of_record(
        &mut self,
        path: String,
        file: &str,
        folder: Option<&Path>,
        read: impl Fn(&Path) -> Result<Prepared, RecordError>,
    ) {
        let Some(folder) = folder.filter(|folder| folder.join(file).is_file()) else { return };
        if let Err(error) = read(folder) {
            let help = "a record is a table with the columns time_s and acceleration_m_s2, or an AT2 file; `ndda record FILE` draws it";
            self.report(Code::CannotBuild, path, error.to_string(), help);
        }
    }

    pub(super) fn ties(&mut self) {
        let scene = self.scene;
        for (i, tie) in scene.ties.iter().enumerate() {
            self.known_blocks(format!("ties[{i}].block"), &tie.block);
            if tie.on.is_empty() {
                let help = "such as [Set(\"x_min\"), Set(\"x_max\")]";
                self.error(format!("ties[{i}].on"), "names no region", help);
            }
            for (k, region) in tie.on.iter().enumerate() {
                self.region(&format!("ties[{i}].on[{k}]"), region);
            }
            if let Some(along) = &tie.along {
                self.direction(format!("ties[{i}].along"), along);
            }
        }
    }

    pub(super) fn blasts(&mut self) {
        let scene = self.scene;
        for (i, blast) in scene.blasts.iter().enumerate() {
            let path = |field: &str| format!("blasts[{i}].{field}");
            self.known_blocks(path("block"), &blast.block);
            match &blast.on {
                BlastWall::Part(region) => self.region(&path("on"), region),
                BlastWall::Hole { from_m, to_m, within_m } => {
                    self.numbers(&path("on.from_m"), from_m);
                    let axis: [f64; 3] = std::array::from_fn(|k| to_m[k] - from_m[k]);
                    self.direction(path("on.to_m"), &axis);
                    self.positive(path("on.within_m"), *within_m, "m");
                }
            }
            if !(blast.start_s >= 0.0 && blast.start_s.is_finite()) {
                let message = format!("{} s: must not be negative", blast.start_s);
                self.error(path("start_s"), message, "0 detonates when the run begins");
            }
            self.blast_pressure(&path("pressure"), &blast.pressure);
        }
    }

    fn blast_pressure(&mut self, path: &str, pressure: &BlastPressure) {
        match pressure {
            BlastPressure::Rows(rows) => {
                if rows.len() < 2 {
                    self.error(
                        path,
                        "needs two rows at least",
                        "such as Rows([(0, 0), (1e-4, 2e8), (1e-3, 0)])",
                    );
                }
                for (k, row) in rows.iter().enumerate() {
                    self.numbers(&format!("{path}[0][{k}]"), &[row.0, row.1]);
                    if row.0 < 0.0 || row.1 < 0.0 {
                        let message =
                            format!("({}, {}): neither time nor pressure is negative", row.0, row.1);
                        self.error(format!("{path}[0][{k}]"), message, "times count from the detonation");
                    }
                }
                if let Some(k) = (1..rows.len()).find(|&k| rows[k].0 <= rows[k - 1].0) {
                    let message = format!("{} s does not come after {} s", rows[k].0, rows[k - 1].0);
                    self.error(format!("{path}[0][{k}]"), message, "sort the rows by time");
                }
            }
            BlastPressure::Duvall { peak_pa, alpha_per_s, beta_per_s } => {
                self.positive(format!("{path}.peak_pa"), *peak_pa, "Pa");
                self.positive(format!("{path}.alpha_per_s"), *alpha_per_s, "1/s");
                if !(beta_per_s > alpha_per_s && beta_per_s.is_finite()) {
                    let message = format!("{beta_per_s} 1/s: must be above alpha_per_s, {alpha_per_s} 1/s");
                    self.error(
                        format!("{path}.beta_per_s"),
                        message,
                        "a pressure rises faster than it falls",
                    );
                }
            }
        }
    }
}
