//! Checks of supports.

use std::path::Path;

use super::Check;
use crate::scene::MotionRow;
use crate::scene::code::Code;
use crate::scene::record::Prepared;
use crate::scene::turning::Rows;
use crate::scene::{By, Hold, Region};

impl Check<'_> {
    pub(super) fn supports(&mut self, folder: Option<&Path>) {
        let scene = self.scene;
        for (i, support) in scene.supports.iter().enumerate() {
            let path = |field: &str| format!("supports[{i}].{field}");
            self.known_blocks(path("block"), &support.block);
            self.region(&path("on"), &support.on);
            match &support.hold {
                Hold::Normal if !matches!(support.on, Region::Plane { .. }) => {
                    let help = "use `Plane(…)` as region, or `Direction((x, y, z))`";
                    self.misfit(path("hold"), "`Normal` needs a region that is a plane", help);
                }
                Hold::Direction(n) => self.direction(path("hold"), n),
                Hold::Motion(rows) => self.motion(&path("hold"), rows),
                Hold::Acceleration { file, direction, factor } => {
                    self.direction(path("hold.direction"), direction);
                    self.numbers(&path("hold.factor"), &[*factor]);
                    self.file(path("hold.file"), file, folder);
                    self.table_of_record(path("hold.file"), file, folder, |folder| {
                        Prepared::as_written(&folder.join(file))
                    });
                }
                Hold::Shaking(components) => {
                    if components.is_empty() {
                        let help = "give one component at least: (direction: (1, 0, 0), record: (file: \"quake.at2\"))";
                        self.error(path("hold"), "shakes along no direction", help);
                    }
                    for (k, component) in components.iter().enumerate() {
                        let path = path(&format!("hold[0][{k}]"));
                        self.direction(format!("{path}.direction"), &component.direction);
                        self.record(&format!("{path}.record"), &component.record, folder);
                    }
                }
                _ => {}
            }
            if let By::Springs { stiffness_n_m: Some(stiffness) } = support.by {
                self.positive(path("by.stiffness_n_m"), stiffness, "N/m");
            }
        }
    }

    fn motion(&mut self, path: &str, rows: &[MotionRow]) {
        if rows.is_empty() {
            self.error(path, "the table has no rows", "give at least one row with time_s and displacement_m");
        }
        if rows.first().is_some_and(|row| row.time_s < 0.0) {
            self.error(
                format!("{path}[0][0].time_s"),
                "is before the start of the run",
                "begin at 0 s or later",
            );
        }
        if let Some(i) = (1..rows.len()).find(|&i| rows[i].time_s <= rows[i - 1].time_s) {
            let message = "times must increase from row to row";
            self.error(format!("{path}[0][{i}].time_s"), message, "sort the rows by time_s");
        }
        // The first row holds before its time, too: anything but zero moves the block in the very first step.
        if rows.first().is_some_and(|row| row.displacement_m != [0.0; 3]) {
            self.misfit(
                path,
                "the motion does not begin where the block is",
                "let the first row have displacement_m: (0, 0, 0), at the time at which the motion starts",
            );
        }
        rows.iter().for_each(|row| self.numbers(path, &row.displacement_m));
        self.turns(&format!("{path}[0]"), &Rows::of_motion(rows));
    }

    /// Warns of the first row at which a table turns back within less than a step.
    pub(super) fn turns(&mut self, path: &str, rows: &Rows) {
        let step_s = self.scene.time.step_s;
        if let Some((i, gap_s)) = rows.turns_within(step_s) {
            let message =
                format!("the motion turns back within {gap_s:.3e} s, less than a step of {step_s:.3e} s");
            let help = "a step follows its mean only: reduce time.step_s to follow it in full";
            self.warn(Code::Inexact, format!("{path}[{i}].time_s"), message, help);
        }
    }
}
