//! What the types of a scene cannot say: ranges, names, and what fits together. All of it in one pass.

mod rock;
mod shape;

use std::path::Path;

use ndda_mesh::cut::CELLS;

use crate::results::tables;
use crate::scene::code::Code;
use crate::scene::diagnostic::{Diagnostic, Severity};
use crate::scene::suggest::suggest;
use crate::scene::{
    At, Body, By, Contact, ContactAt, Friction, Hold, Integrator, Joint, JointLaw, Potential, Reference,
    Region, Residual, Scene, Solver, Step, matches,
};

/// More steps than this are a slip of the keyboard.
const MOST_STEPS: f64 = 1e9;
/// More nodes than this per block are a slip of the keyboard.
const MOST_NODES: f64 = 5e7;
/// Numbers beyond it, or below its inverse where they must be positive, have products that overflow.
const HUGE: f64 = 1e50;
/// Speed of light [m/s].
const LIGHT_M_S: f64 = 299_792_458.0;

/// Everything that is wrong or odd about a scene; `folder` is where its meshes should be. Places are not yet known.
pub fn problems(scene: &Scene, folder: Option<&Path>) -> Vec<Diagnostic> {
    let mut check = Check { scene, found: Vec::new() };
    check.time();
    check.numbers("gravity_m_s2", &scene.gravity_m_s2);
    check.materials();
    check.blocks(folder);
    check.rock(folder);
    check.supports(folder);
    check.loads();
    check.contact();
    check.monitors();
    check.reference();
    check.output();
    check.found
}

struct Check<'a> {
    scene: &'a Scene,
    found: Vec<Diagnostic>,
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
        let length = value.iter().map(|v| v * v).sum::<f64>().sqrt();
        if !(length > 0.0 && length.is_finite()) {
            self.report(
                Code::NoDirection,
                path,
                "is no direction: its length is zero or overflows",
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
        if !self.scene.rock.iter().any(|rock| rock.makes(name)) {
            let blocks: Vec<&str> = self.scene.blocks.iter().map(|b| b.name.as_str()).collect();
            self.known(path, "block", name, &blocks);
        }
    }

    /// The name of a block, or a pattern that stands for some.
    fn known_blocks(&mut self, path: String, pattern: &str) {
        if !pattern.contains('*') {
            self.known_block(path, pattern);
        } else if self.scene.rock.is_empty() && !self.scene.blocks.iter().any(|b| matches(pattern, &b.name)) {
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

    fn time(&mut self) {
        let time = &self.scene.time;
        self.positive("time.step_s".into(), time.step_s, "s");
        self.positive("time.end_s".into(), time.end_s, "s");
        if time.step_s > 0.0 && time.end_s > 0.0 {
            if time.end_s < time.step_s {
                let message =
                    format!("{} s is before the end of the first step ({} s)", time.end_s, time.step_s);
                self.error("time.end_s", message, "make it at least one step");
            } else if time.end_s / time.step_s > MOST_STEPS {
                let message = format!("{:.1e} steps", time.end_s / time.step_s);
                self.error("time.step_s", message, "at most 1e9 steps are taken: make the step larger");
            } else if time.step_s > 0.1 * time.end_s {
                self.warn(
                    Code::UnitSlip,
                    "time.step_s",
                    "fewer than ten steps",
                    "is it meant in milliseconds? the unit is seconds",
                );
            }
        }
        if let Solver::ConjugateGradients { tolerance } = time.solver
            && !(1e-16..=1e-3).contains(&tolerance)
        {
            let message = format!("{tolerance:e}: must be from 1e-16 to 1e-3");
            self.error(
                "time.solver.tolerance",
                message,
                "1e-12 costs little more than 1e-6 and leaves no doubt",
            );
        }
        if let Step::Auto { safety, energy, most_halvings } = time.step {
            self.positive("time.step.safety".into(), safety, "");
            self.positive("time.step.energy".into(), energy, "");
            if safety > 1.0 {
                self.error(
                    "time.step.safety",
                    format!("{safety}: is beyond the bound"),
                    "0.5 is a good choice",
                );
            }
            if most_halvings > 30 {
                let message = format!("{most_halvings} halvings are a billionth of a step");
                self.error("time.step.most_halvings", message, "at most 30");
            }
        }
        if let ContactAt::End { tolerance, most_iterations } = time.contact_at {
            if !(1e-13..=1e-2).contains(&tolerance) {
                let message = format!("{tolerance:e}: must be from 1e-13 to 1e-2");
                self.error("time.contact_at.tolerance", message, "1e-8 is a step more than 1e-4");
            }
            if most_iterations == 0 {
                let message = "no evaluation of contact at all";
                self.error("time.contact_at.most_iterations", message, "100 is seldom reached");
            }
        }
        match time.integrator {
            Integrator::Midpoint { theta } if !(0.5..=1.0).contains(&theta) => {
                self.error(
                    "time.integrator.theta",
                    format!("θ = {theta}: must be from 0.5 to 1"),
                    "0.5 damps nothing",
                );
            }
            Integrator::GeneralizedAlpha { radius } if !(0.0..=1.0).contains(&radius) => {
                self.error(
                    "time.integrator.radius",
                    format!("ρ = {radius}: must be from 0 to 1"),
                    "1 damps nothing, 0.8 a little",
                );
            }
            Integrator::Newmark { alpha, delta } if !(delta >= 0.5 && 2.0 * alpha >= delta) => {
                let message = format!("α = {alpha}, δ = {delta}: unstable, must be 2 α ≥ δ ≥ ½");
                self.error("time.integrator", message, "the paper has α = 0.5, δ = 1");
            }
            _ => {}
        }
    }

    fn materials(&mut self) {
        let scene = self.scene;
        self.names("materials", &scene.materials.iter().map(|m| m.name.as_str()).collect::<Vec<_>>());
        for (i, material) in scene.materials.iter().enumerate() {
            let path = |field: &str| format!("materials[{i}].{field}");
            self.positive(path("young_pa"), material.young_pa, "Pa");
            self.positive(path("density_kg_m3"), material.density_kg_m3, "kg/m³");
            if !(-1.0 < material.poisson && material.poisson < 0.5) {
                let message = format!("{}: must lie between −1 and 0.5, both excluded", material.poisson);
                self.error(path("poisson"), message, "rock has 0.15 to 0.35");
            } else if material.poisson > 0.49 {
                let help = "four-node tetrahedra lock near 0.5: displacements come out too small";
                self.warn(Code::Inexact, path("poisson"), "nearly incompressible", help);
            }
            if material.young_pa > 0.0 && material.young_pa < 1e6 {
                let help = "the unit is pascal: 20 GPa is 20e9";
                self.warn(
                    Code::UnitSlip,
                    path("young_pa"),
                    format!("{} Pa is softer than any rock", material.young_pa),
                    help,
                );
            }
            let density = material.density_kg_m3;
            if density > 0.0 && !(100.0..=20000.0).contains(&density) {
                let help = "the unit is kg/m³: granite is 2650";
                self.warn(
                    Code::UnitSlip,
                    path("density_kg_m3"),
                    format!("{density} kg/m³ is not the density of a rock"),
                    help,
                );
            }
            for (name, value) in
                [("mass_per_s", material.damping.mass_per_s), ("stiffness_s", material.damping.stiffness_s)]
            {
                if !(value >= 0.0 && value.is_finite()) {
                    let message = format!("{value}: must not be negative");
                    self.error(path(&format!("damping.{name}")), message, "0 is no damping");
                }
            }
            if let Some(bedding) = &material.bedding {
                self.positive(path("bedding.young_across_pa"), bedding.young_across_pa, "Pa");
                self.positive(path("bedding.shear_across_pa"), bedding.shear_across_pa, "Pa");
                if bedding.normal == [0.0; 3] {
                    let help = "give a direction, such as (0, 0, 1) for level beds";
                    self.report(
                        Code::NoDirection,
                        path("bedding.normal"),
                        "the normal of the beds has no length",
                        help,
                    );
                }
            }
            let of_rock = scene.rock.iter().any(|rock| rock.material == material.name);
            if !of_rock && !scene.blocks.iter().any(|b| b.material == material.name) {
                self.warn(
                    Code::NoEffect,
                    path("name"),
                    format!("no block is made of `{}`", material.name),
                    "it may be left out",
                );
            }
        }
    }

    fn blocks(&mut self, folder: Option<&Path>) {
        let scene = self.scene;
        if scene.blocks.is_empty() && scene.rock.is_empty() {
            self.misfit("blocks", "there is no block", "a scene has `blocks` or `rock`");
        }
        self.names("blocks", &scene.blocks.iter().map(|b| b.name.as_str()).collect::<Vec<_>>());
        let materials: Vec<&str> = scene.materials.iter().map(|m| m.name.as_str()).collect();
        for (i, block) in scene.blocks.iter().enumerate() {
            let path = |field: &str| format!("blocks[{i}].{field}");
            self.known(path("material"), "material", &block.material, &materials);
            for (k, turn) in block.turns.iter().enumerate() {
                self.direction(path(&format!("turns[{k}].axis")), &turn.axis);
                self.numbers(&path(&format!("turns[{k}].angle_deg")), &[turn.angle_deg]);
            }
            self.numbers(&path("at_m"), &block.at_m);
            self.numbers(&path("velocity_m_s"), &block.velocity_m_s);
            if block.velocity_m_s.iter().any(|v| v.abs() > LIGHT_M_S) {
                self.error(path("velocity_m_s"), "is faster than light", "the unit is metres per second");
            }
            self.numbers(&path("spin_rad_s"), &block.spin_rad_s);
            if matches!(block.body, Body::Rigid | Body::Fixed) && block.initial_stress_pa.is_some() {
                let help = "leave it out, or make the body Elastic or Affine";
                self.misfit(path("initial_stress_pa"), "a block that does not deform has no stress", help);
            }
            if block.body == Body::Fixed && (block.velocity_m_s, block.spin_rad_s) != ([0.0; 3], [0.0; 3]) {
                let help = "leave it out, or give the block a support with a Motion";
                self.misfit(path("velocity_m_s"), "a fixed block does not start with a velocity", help);
            }
            self.shape(&path("shape"), &block.shape, folder);
        }
    }

    fn file(&mut self, path: String, file: &str, folder: Option<&Path>) {
        if let Some(folder) = folder
            && !folder.join(file).is_file()
        {
            let message = format!("there is no file {}", folder.join(file).display());
            self.report(Code::MissingFile, path, message, "the path counts from the scene file");
        }
    }

    fn cells(&mut self, path: &str, cells: &[u32]) {
        let nodes: f64 = cells.iter().map(|&n| f64::from(n) + 1.0).product();
        for (i, _) in cells.iter().enumerate().filter(|(_, n)| **n == 0) {
            self.error(format!("{path}.cells[{i}]"), "0 cells", "at least one cell is needed");
        }
        if nodes > MOST_NODES {
            self.error(format!("{path}.cells"), format!("about {nodes:.1e} nodes"), "at most 5e7 are made");
        }
    }

    fn region(&mut self, path: &str, region: &Region) {
        if let Region::Plane { point_m, normal } = region {
            self.numbers(&format!("{path}.point_m"), point_m);
            self.direction(format!("{path}.normal"), normal);
        }
    }

    fn supports(&mut self, folder: Option<&Path>) {
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
                }
                _ => {}
            }
            if let By::Springs { stiffness_n_m: Some(stiffness) } = support.by {
                self.positive(path("by.stiffness_n_m"), stiffness, "N/m");
            }
        }
    }

    fn motion(&mut self, path: &str, rows: &[crate::scene::MotionRow]) {
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
        let along = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
        let way = |i: usize| -> [f64; 3] {
            std::array::from_fn(|k| rows[i + 1].displacement_m[k] - rows[i].displacement_m[k])
        };
        let times: Vec<f64> = rows.iter().map(|row| row.time_s).collect();
        self.turns(&format!("{path}[0]"), &times, |i| along(&way(i - 1), &way(i)) < 0.0);
    }

    /// Warns of the first row at which a table turns back between two neighbours that are less than a step apart.
    fn turns(&mut self, path: &str, times: &[f64], turns_at: impl Fn(usize) -> bool) {
        let step_s = self.scene.time.step_s;
        let unseen = |i: &usize| times[i + 1] - times[i - 1] < step_s && turns_at(*i);
        if let Some(i) = (1..times.len().saturating_sub(1)).find(unseen) {
            let gap_s = times[i + 1] - times[i - 1];
            let message = format!("turns back within {gap_s:.3e} s, less than a step of {step_s:.3e} s");
            let help = "a step knows its mean only: reduce time.step_s to see what is between";
            self.warn(Code::Inexact, format!("{path}[{i}].time_s"), message, help);
        }
    }

    fn loads(&mut self) {
        let scene = self.scene;
        if let Some(in_situ) = &scene.in_situ {
            self.numbers("in_situ.at_m", &in_situ.at_m);
            for (i, gradient) in in_situ.gradients.iter().enumerate() {
                self.direction(format!("in_situ.gradients[{i}].along"), &gradient.along);
            }
        }
        if !(scene.gravity_ramp_s >= 0.0 && scene.gravity_ramp_s.is_finite()) {
            let message = format!("{} s: must not be negative", scene.gravity_ramp_s);
            self.error("gravity_ramp_s", message, "0 applies gravity suddenly");
        }
        if scene.gravity_ramp_s > 0.0
            && matches!(scene.reference, Some(Reference::SlidingBlock { .. } | Reference::FreeFall { .. }))
        {
            let help = "leave out the ramp or the reference";
            self.misfit("gravity_ramp_s", "the closed form of `reference` has gravity act at once", help);
        }
        if let Some(settle) = scene.settle {
            if !(0.0 < settle.tolerance && settle.tolerance < 1.0) {
                let message = format!("{}: must be between 0 and 1", settle.tolerance);
                self.error("settle.tolerance", message, "1e-4 leaves a ten-thousandth of the largest speed");
            }
            if scene.gravity_ramp_s > 0.0 {
                let help = "leave out one of the two";
                self.misfit("gravity_ramp_s", "a scene settles under its full weight", help);
            }
        }
        for (i, force) in scene.forces.iter().enumerate() {
            self.known_blocks(format!("forces[{i}].block"), &force.block);
            self.numbers(&format!("forces[{i}].at_m"), force.at_m.as_slice().as_flattened());
            self.numbers(&format!("forces[{i}].force_n"), &force.force_n);
            self.factor(&format!("forces[{i}].factor"), &force.factor);
        }
        for (i, traction) in scene.tractions.iter().enumerate() {
            self.known_blocks(format!("tractions[{i}].block"), &traction.block);
            self.region(&format!("tractions[{i}].on"), &traction.on);
            self.numbers(&format!("tractions[{i}].traction_pa"), &traction.traction_pa);
            self.factor(&format!("tractions[{i}].factor"), &traction.factor);
        }
    }

    fn factor(&mut self, path: &str, rows: &[crate::scene::FactorRow]) {
        if let Some(i) = (1..rows.len()).find(|&i| rows[i].time_s <= rows[i - 1].time_s) {
            let message = format!("{} s does not come after {} s", rows[i].time_s, rows[i - 1].time_s);
            self.error(format!("{path}[{i}].time_s"), message, "sort the rows by time_s");
        }
        let times: Vec<f64> = rows.iter().map(|row| row.time_s).collect();
        let rises = |i: usize| rows[i + 1].factor - rows[i].factor;
        self.turns(path, &times, |i| rises(i - 1) * rises(i) < 0.0);
    }

    fn potential(&mut self, potential: &Potential) {
        match *potential {
            Potential::Element => {}
            Potential::Smooth { reference_m } => {
                self.positive("contact.potential.reference_m".into(), reference_m, "m")
            }
            Potential::Volume { exponent, reference_m3 } => {
                self.positive("contact.potential.reference_m3".into(), reference_m3, "m³");
                if !(exponent > 1.0 && exponent.is_finite()) {
                    let message = format!("{exponent}: must be above 1");
                    self.error(
                        "contact.potential.exponent",
                        message,
                        "W ∝ V^m; m = 2 makes pressure grow with V",
                    );
                }
            }
        }
    }

    fn friction(&mut self, path: &str, friction: &Friction) {
        let field = |name: &str| format!("{path}.{name}");
        let angle = friction.friction_deg;
        if !(0.0..90.0).contains(&angle) {
            let message = format!("{angle}°: must be from 0 to below 90");
            self.error(field("friction_deg"), message, "μ = tan φ");
        }
        if let Some(penalty) = friction.shear_penalty_pa_m {
            self.positive(field("shear_penalty_pa_m"), penalty, "Pa/m");
        }
        for (name, strength) in [("cohesion_pa", friction.cohesion_pa), ("tension_pa", friction.tension_pa)] {
            if !(strength >= 0.0 && strength.is_finite()) {
                let message = format!("{strength} Pa: must be zero or positive");
                self.error(field(name), message, "0 for a joint that does not hold together");
            } else if strength > 0.0 && friction.shear_penalty_pa_m.is_none() {
                let help = "give shear_penalty_pa_m, the stiffness of the joint until it breaks";
                self.misfit(field(name), "a joint that holds together needs a spring to hold with", help);
            }
        }
        if let Some(residual) = &friction.residual {
            self.residual(&field("residual"), friction, residual);
        }
    }

    fn residual(&mut self, path: &str, peak: &Friction, residual: &Residual) {
        let field = |name: &str| format!("{path}.{name}");
        let Residual { friction_deg, cohesion_pa, over_m } = *residual;
        if !(0.0..=peak.friction_deg).contains(&friction_deg) {
            let message = format!("{friction_deg}°: must be from 0 to the peak, {}°", peak.friction_deg);
            self.error(field("friction_deg"), message, "joints weaken when they slip");
        }
        if !(0.0..=peak.cohesion_pa).contains(&cohesion_pa) {
            let message = format!("{cohesion_pa} Pa: must be from 0 to the peak, {} Pa", peak.cohesion_pa);
            self.error(field("cohesion_pa"), message, "joints weaken when they slip");
        }
        if !(over_m >= 0.0 && over_m.is_finite()) {
            self.error(
                field("over_m"),
                format!("{over_m} m: must be zero or positive"),
                "0 for a strength that falls at once",
            );
        }
        if peak.shear_penalty_pa_m.is_none() {
            let help = "give shear_penalty_pa_m, the stiffness of the joint before it slips";
            self.misfit(path.to_string(), "a joint that softens needs a spring that measures its slip", help);
        }
        if peak.tension_pa > 0.0 {
            let help = "leave out tension_pa, or residual";
            self.misfit(path.to_string(), "a joint that softens has no tensile strength", help);
        }
    }

    fn joints(&mut self, joints: &[Joint]) {
        let scene = self.scene;
        let materials: Vec<&str> = scene.materials.iter().map(|m| m.name.as_str()).collect();
        for (i, joint) in joints.iter().enumerate() {
            self.known(format!("contact.joints[{i}].between[0]"), "material", &joint.between.0, &materials);
            self.known(format!("contact.joints[{i}].between[1]"), "material", &joint.between.1, &materials);
            if let Some(friction) = &joint.friction {
                self.friction(&format!("contact.joints[{i}].friction"), friction);
            }
        }
    }

    fn laws(&mut self, laws: &[JointLaw]) {
        let scene = self.scene;
        let mut names: Vec<&str> =
            scene.rock.iter().flat_map(|rock| &rock.joints).map(|j| j.name()).collect();
        names.extend(scene.rock.iter().filter(|rock| rock.voronoi.is_some()).map(|_| CELLS));
        for (i, law) in laws.iter().enumerate() {
            if !names.iter().any(|name| matches(&law.joint, name)) {
                self.known(format!("contact.laws[{i}].joint"), "joint", &law.joint, &names);
            }
            if let Some(friction) = &law.friction {
                self.friction(&format!("contact.laws[{i}].friction"), friction);
            }
        }
    }

    fn contact(&mut self) {
        let several = self.scene.blocks.len() > 1 || !self.scene.rock.is_empty();
        match &self.scene.contact {
            None if several => {
                let help = "write `contact: Potential(penalty_pa: …)` or `contact: Off`";
                self.misfit("contact", "more than one block, and no word on contact", help);
            }
            Some(Contact::Potential { penalty_pa, potential, friction, joints, laws, .. }) => {
                self.positive("contact.penalty_pa".into(), *penalty_pa, "Pa");
                self.potential(potential);
                if let Some(friction) = friction {
                    self.friction("contact.friction", friction);
                }
                self.joints(joints);
                self.laws(laws);
                if !several && !self.scene.blocks.is_empty() {
                    self.warn(
                        Code::NoEffect,
                        "contact",
                        "one block has nothing to touch",
                        "contact is left out of this run",
                    );
                }
            }
            _ => {}
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

    fn reference(&mut self) {
        let scene = self.scene;
        let monitors: Vec<&str> = scene.monitors.iter().map(|m| m.name.as_str()).collect();
        let path = |field: &str| format!("reference.{field}");
        match &scene.reference {
            Some(Reference::SlidingBlock {
                monitor,
                downhill,
                slope_deg,
                friction_deg,
                thickness_m,
                after_s,
            }) => {
                self.known(path("monitor"), "monitor", monitor, &monitors);
                self.direction(path("downhill"), downhill);
                if !(*slope_deg > 0.0 && *slope_deg < 90.0) {
                    self.error(
                        path("slope_deg"),
                        format!("{slope_deg}°: must be between 0 and 90"),
                        "α of the ramp",
                    );
                }
                if !(0.0..90.0).contains(friction_deg) {
                    let message = format!("{friction_deg}°: must be from 0 to below 90");
                    self.error(path("friction_deg"), message, "as in `contact`");
                }
                if slope_deg.to_radians().tan() <= friction_deg.to_radians().tan() {
                    let message = "the block does not slide: the closed form is 0 and has no relative error";
                    self.misfit(path("friction_deg"), message, "compare a slope that is steeper than φ");
                }
                if let Some(thickness) = thickness_m {
                    self.positive(path("thickness_m"), *thickness, "m");
                }
                self.after(*after_s);
            }
            Some(Reference::Collision { first, second, along, after_s }) => {
                self.known_block(path("first"), first);
                self.known_block(path("second"), second);
                self.direction(path("along"), along);
                self.after(*after_s);
            }
            Some(Reference::FreeFall { monitor, after_s }) => {
                self.known(path("monitor"), "monitor", monitor, &monitors);
                self.after(*after_s);
            }
            Some(Reference::FreeSpin { block }) => self.known_block(path("block"), block),
            Some(Reference::BarImpact { block, along, length_m, gap_m, after_s }) => {
                self.bar_impact(block, *length_m, *gap_m);
                self.direction(path("along"), along);
                self.after(*after_s);
            }
            Some(Reference::Displacement { monitor, displacement_m, after_s }) => {
                self.known(path("monitor"), "monitor", monitor, &monitors);
                self.direction(path("displacement_m"), displacement_m);
                self.after(*after_s);
            }
            None => {}
        }
    }

    fn bar_impact(&mut self, block: &str, length_m: f64, gap_m: f64) {
        self.known_block("reference.block".into(), block);
        self.positive("reference.length_m".into(), length_m, "m");
        if !(gap_m >= 0.0 && gap_m.is_finite()) {
            let message = format!("{gap_m} m: must not be negative");
            self.error("reference.gap_m", message, "0 for a bar that touches the wall");
        }
        let scene = self.scene;
        let material = scene.blocks.iter().find(|b| b.name == block).map(|b| &b.material);
        let poisson = scene.materials.iter().find(|m| Some(&m.name) == material).map(|m| m.poisson);
        if poisson.is_some_and(|poisson| poisson != 0.0) {
            let help = "set the bar's `poisson` to 0";
            self.misfit("reference", "the closed form is that of a bar without lateral strain", help);
        }
    }

    fn after(&mut self, after_s: f64) {
        let end_s = self.scene.time.end_s;
        if !(0.0..end_s).contains(&after_s) {
            let message = format!("{after_s} s is outside the run, which ends at {end_s} s");
            self.error("reference.after_s", message, "the largest error is taken from here to the end");
        }
    }

    fn output(&mut self) {
        let wall_s = self.scene.output.checkpoint_wall_s;
        if !(0.0..=1e9).contains(&wall_s) {
            self.error(
                "output.checkpoint_wall_s",
                format!("{wall_s} is no time between checkpoints"),
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
                format!("{frames} frames are as many files"),
                "are that many needed?",
            );
        }
    }
}
