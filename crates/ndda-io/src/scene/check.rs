//! Checks that the types of a scene cannot express: ranges, names, and combinations. All errors are found in one pass.

mod block;
mod bolt;
mod contact;
mod friction;
mod load;
mod material;
mod overturned;
mod quiet;
mod reference;
mod restitution;
mod rock;
mod rockfall;
mod shape;
mod stage;
mod support;
mod time;
mod water;

use std::path::Path;

use ndda_mesh::cut::CELLS;
use ndda_mesh::tetrahedralise::TETRAHEDRA;

use crate::results::tables;
use crate::scene::code::Code;
use crate::scene::diagnostic::{Diagnostic, Severity};
use crate::scene::suggest::suggest;
use crate::scene::{At, Region, Scene, matches};

/// More steps than this are a slip of the keyboard.
const MOST_STEPS: f64 = 1e9;
/// More nodes than this per block are a slip of the keyboard.
const MOST_NODES: f64 = 5e7;
/// Numbers beyond it, or below its inverse where they must be positive, have products that overflow.
const HUGE: f64 = 1e50;
/// Gravity beyond it is that of a centrifuge, or in another unit [m/s²].
const MUCH_GRAVITY: f64 = 50.0;
/// Level part of gravity over all of it up to which it is along z.
const LEVEL: f64 = 1e-3;
/// Digits of the numbers of blocks of rock, at least.
const DIGITS: usize = 4;
/// Speed of light [m/s].
const LIGHT_M_S: f64 = 299_792_458.0;

/// Everything that is wrong or odd about a scene; `folder` is where its meshes should be. Places are not yet known.
pub(crate) fn problems(scene: &Scene, folder: Option<&Path>) -> Vec<Diagnostic> {
    let mut check = Check { scene, found: Vec::new(), joints: rock::joint_names(scene, folder) };
    check.time();
    check.gravity();
    check.materials();
    check.blocks(folder);
    check.rock(folder);
    check.supports(folder);
    check.loads();
    check.quiet(folder);
    check.ties();
    check.blasts();
    check.bolts();
    check.contact();
    check.stages(folder);
    check.rockfall(folder);
    check.monitors();
    check.reference();
    check.output();
    check.found
}

/// Length of a vector.
fn length(vector: &[f64; 3]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Whether gravity points along z.
fn points_up([x, y, z]: &[f64; 3]) -> bool {
    *z > 0.0 && x.hypot(*y) <= LEVEL * z
}

struct Check<'a> {
    scene: &'a Scene,
    found: Vec<Diagnostic>,
    /// Names of the joints of all rock; none where they are in a table that cannot be read.
    joints: Option<Vec<String>>,
}

impl Check<'_> {
    fn report(
        &mut self,
        code: Code,
        path: impl Into<String>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) {
        self.found.push(Diagnostic::error(code, path, message, None).with_help(help));
    }

    /// A value outside of what is allowed.
    fn error(&mut self, path: impl Into<String>, message: impl Into<String>, help: impl Into<String>) {
        self.report(Code::OutOfRange, path, message, help);
    }

    /// Parts that do not go together.
    fn misfit(&mut self, path: impl Into<String>, message: impl Into<String>, help: impl Into<String>) {
        self.report(Code::DoesNotFit, path, message, help);
    }

    fn warn(
        &mut self,
        code: Code,
        path: impl Into<String>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) {
        self.report(code, path, message, help);
        self.found.last_mut().into_iter().for_each(|d| d.severity = Severity::Warning);
    }

    fn gravity(&mut self) {
        let gravity = self.scene.gravity_m_s2;
        self.numbers("gravity_m_s2", &gravity);
        let size = length(&gravity);
        if (MUCH_GRAVITY..HUGE).contains(&size) {
            let message = format!("{size} m/s² is {:.0} times the gravity of the Earth", size / 9.81);
            let help = "the unit is m/s²: (0, 0, -9.81); leave it so for a model in a centrifuge";
            self.warn(Code::UnitSlip, "gravity_m_s2", message, help);
        }
        if points_up(&gravity) {
            let message =
                format!("gravity points up along z, at {size} m/s²: blocks that nothing holds fly up");
            let help = format!("z points up: give (0, 0, {})", -gravity[2]);
            self.warn(Code::DoesNotFit, "gravity_m_s2", message, help);
        }
    }

    /// A number that must be positive and finite.
    fn positive(&mut self, path: String, value: f64, unit: &str) {
        if !(value > 0.0 && value.is_finite()) {
            self.error(
                path,
                format!("{value} {unit}: must be positive"),
                format!("give a value above 0 {unit}"),
            );
        } else if !(1.0 / HUGE..=HUGE).contains(&value) {
            self.error(
                path,
                format!("{value:e} {unit}: must lie between {:e} and {HUGE:e}", 1.0 / HUGE),
                "products of such numbers cannot be represented",
            );
        }
    }

    /// Numbers of any sign that must be finite.
    fn numbers(&mut self, path: &str, values: &[f64]) {
        if values.iter().any(|v| !v.is_finite()) {
            self.error(path, "must be finite numbers", "write plain numbers");
        } else if values.iter().any(|v| v.abs() > HUGE) {
            let message = format!("must not be beyond {HUGE:e}");
            self.error(path, message, "products of such numbers cannot be represented");
        }
    }

    fn direction(&mut self, path: String, value: &[f64; 3]) {
        let length = length(value);
        if !(length > 0.0 && length.is_finite()) {
            self.report(
                Code::NoDirection,
                path,
                "is not a direction: its length is zero or overflows",
                "give a vector such as (0, 0, 1)",
            );
        }
    }

    /// A name that must be one of `known`.
    fn known(&mut self, path: String, what: &str, name: &str, known: &[&str]) {
        if !known.contains(&name) {
            self.report(
                Code::UnknownName,
                path,
                format!("there is no {what} `{name}`"),
                suggest(name, known),
            );
        }
    }

    /// The name of one block; those of a rock are looked for once it is cut.
    fn known_block(&mut self, path: String, name: &str) {
        if self.scene.rock.iter().any(|rock| rock.makes(name)) {
            let (stem, number) = name.rsplit_once('_').unwrap_or_default();
            if number.len() < DIGITS && !self.scene.blocks.iter().any(|block| block.name == name) {
                let help =
                    format!("blocks of rock have numbers of {DIGITS} digits: `{stem}_{number:0>DIGITS$}`");
                self.report(Code::UnknownName, path, format!("there is no block `{name}`"), help);
            }
        } else {
            let blocks: Vec<&str> = self.scene.blocks.iter().map(|b| b.name.as_str()).collect();
            self.known(path, "block", name, &blocks);
        }
    }

    /// The name of a block, or a pattern that stands for some.
    fn known_blocks(&mut self, path: String, pattern: &str) {
        if !pattern.contains('*') {
            self.known_block(path, pattern);
        } else if !self.scene.rock.iter().any(|rock| rock.may_make(pattern))
            && !self.scene.blocks.iter().any(|b| matches(pattern, &b.name))
        {
            self.report(
                Code::UnknownName,
                path,
                format!("no block is named `{pattern}`"),
                "`*` stands for anything",
            );
        }
    }

    fn names(&mut self, list: &str, names: &[&str]) {
        for (i, name) in names.iter().enumerate() {
            let path = format!("{list}[{i}].name");
            if name.trim().is_empty()
                || name.starts_with('.')
                || name.chars().any(|c| c.is_control() || "/\\,\"'`".contains(c))
            {
                let help = "use letters, digits, spaces, - and _: names become columns and files";
                self.report(Code::BadName, path, format!("`{}` cannot be a name", name.escape_debug()), help);
            } else if names[..i].contains(name) {
                self.report(
                    Code::BadName,
                    path,
                    format!("the name `{name}` is used twice in {list}"),
                    "give each its own name",
                );
            }
        }
    }

    fn file(&mut self, path: String, file: &str, folder: Option<&Path>) {
        if let Some(folder) = folder
            && !folder.join(file).is_file()
        {
            let place = folder.join(file);
            let message = match place.is_dir() {
                _ if file.trim().is_empty() => "names no file".into(),
                true => format!("{} is a folder", place.display()),
                false => format!("there is no file {}", place.display()),
            };
            self.report(
                Code::MissingFile,
                path,
                message,
                "name a file; its path is relative to the folder of the scene file",
            );
        }
    }

    fn region(&mut self, path: &str, region: &Region) {
        if let Region::Plane { point_m, normal } = region {
            self.numbers(&format!("{path}.point_m"), point_m);
            self.direction(format!("{path}.normal"), normal);
        }
    }

    fn monitors(&mut self) {
        let scene = self.scene;
        self.names("monitors", &scene.monitors.iter().map(|m| m.name.as_str()).collect::<Vec<_>>());
        for (i, monitor) in scene.monitors.iter().enumerate() {
            let path = format!("monitors[{i}].block");
            match &monitor.at {
                At::Largest(direction) => {
                    self.known_blocks(path, &monitor.block);
                    self.direction(format!("monitors[{i}].at"), direction);
                }
                At::Point(place) => {
                    self.known_block(path, &monitor.block);
                    self.numbers(&format!("monitors[{i}].at"), place);
                }
                At::Centre => self.known_block(path, &monitor.block),
            }
        }
    }

    fn output(&mut self) {
        let wall_s = self.scene.output.checkpoint_wall_s;
        if !(0.0..=1e9).contains(&wall_s) {
            self.error(
                "output.checkpoint_wall_s",
                format!("{wall_s} is not a time between checkpoints"),
                "give seconds, or 0 for none between start and end",
            );
        }
        let fields = &self.scene.output.fields;
        if let Some((i, field)) = fields.iter().enumerate().find(|(i, field)| fields[..*i].contains(field)) {
            let path = format!("output.fields[{i}]");
            self.error(&path, format!("{field:?} is listed twice"), "list each field once");
        }
        if self.scene.output.history.has_parquet() && !tables::HAS_PARQUET {
            self.error(
                "output.history",
                "this ndda was built without Parquet",
                "build it with `--features parquet`, or take Csv",
            );
        }
        if self.scene.output.frames > 100_000 {
            let frames = self.scene.output.frames;
            self.warn(
                Code::UnitSlip,
                "output.frames",
                format!("{frames} frames make {frames} files"),
                "reduce output.frames unless all are needed",
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::read::load_text;

    #[test]
    fn gravity_that_points_up_is_warned_of_with_what_to_write() {
        let told = |gravity: &str| {
            let text = format!(
                "(title: \"t\", time: (step_s: 1e-3, end_s: 1), gravity_m_s2: {gravity}, materials: [(name: \"rock\", density_kg_m3: 2700, young_pa: 1e10, poisson: 0.25)],
                  blocks: [(name: \"a\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))], contact: Off)"
            );
            let warnings = load_text("s.ron", &text, &[], None).unwrap().warnings;
            let of_gravity = warnings.into_iter().filter(|warning| warning.path == "gravity_m_s2");
            of_gravity
                .map(|warning| format!("{}: {}", warning.message, warning.help.unwrap()))
                .collect::<Vec<_>>()
        };
        for down in ["(0, 0, -9.81)", "(0, 0, 0)", "(0, 9.81, 0)", "(5, 0, 8)"] {
            assert_eq!(told(down), Vec::<String>::new(), "{down}");
        }
        let up = told("(0, 0, 9.81)");
        assert!(up.len() == 1 && up[0].starts_with("gravity points up along z"), "{up:?}");
        assert!(up[0].ends_with("give (0, 0, -9.81)"), "{up:?}");
    }
}
