//! The runs of a certificate: the scene with steps that halve, finer meshes, stiffer contact, and a disturbed twin.

use ndda_io::scene::{
    At, Body, Contact, ContactAt, Fill, Grading, Integrator, Monitor, Scene, Shape, Turning,
};
use ndda_mesh::BlockId;
use ndda_solver::BodyKind;
use ndda_solver::Simulation;

use super::chaos::DISTURBANCE;
use super::error::CertifyError;
use super::quantities::{BLOCK, named, rounding};
use crate::build;
use crate::run::Sensitivity;
use crate::run::recorder::{Extras, columns, held_blocks};
use crate::study::case::Case;

/// Rows of a history that errors are found from.
const ROWS: u64 = 200;
/// Fewer rows than this say little about time.
const FEW_ROWS: u64 = 20;
/// Numbers in a history, if every step has a row, up to which it may have one.
const MOST_NUMBERS: u64 = 4_000_000;
/// Each stiffer contact is this times as stiff: with half the step h = ω_c Δt stays what it is.
pub const STIFFER: f64 = 4.0;
/// Each finer mesh has cells of this part.
pub const FINER: f64 = 2.0;

/// A scene and what all its runs have in common.
pub struct Plan {
    /// The scene as it is to be certified.
    pub scene: Scene,
    /// Arguments of every run's `--set`, the person's own values first.
    common: Vec<String>,
    /// Steps of the longest step.
    steps: u64,
    /// The longest step [s].
    step_s: f64,
    /// The end of all runs [s].
    end_s: f64,
    /// Columns of the histories of its runs.
    columns: Vec<String>,
    /// Largest coordinate of a node [m].
    farthest_m: f64,
    /// Whether a block deforms, so that it can vibrate.
    pub deforms: bool,
}

impl Plan {
    /// A plan for a scene that is read with the values of `overrides`, whose longest step has `steps` to the end.
    pub fn new(scene: &Scene, simulation: &Simulation, overrides: &[String], steps: u64) -> Self {
        let end_s = build::steps(&scene.time) as f64 * scene.time.step_s;
        let monitors = monitors(scene, simulation);
        let rows = rows(steps, scene.output.history_rows, 20 + 6 * monitors.len() as u64);
        let mut common = overrides.to_vec();
        // All runs end at the same instant, that of the run of the longest step.
        common.push(format!("time.end_s={end_s:e}"));
        common.push(format!("output.history_rows={rows}"));
        common.extend(["output.frames=0", "output.contacts=false", "output.history=Csv"].map(String::from));
        if !monitors.is_empty() {
            common.push(format!("monitors=[{}]", monitors.iter().map(written).collect::<String>()));
        }
        let step_s =
            if steps == build::steps(&scene.time) { scene.time.step_s } else { end_s / steps as f64 };
        let names = monitors.iter().map(|monitor| monitor.name.as_str());
        let columns = columns(names, &held_blocks(simulation), Extras::of(scene));
        let farthest_m = simulation.blocks().rest_position.iter().map(|x| x.amax()).fold(0.0, f64::max);
        let deforms = |block| matches!(simulation.shape(block).kind, BodyKind::Elastic | BodyKind::Affine);
        let deforms = simulation.blocks().ids().any(deforms);
        Self { scene: scene.clone(), common, steps, step_s, end_s, columns, farthest_m, deforms }
    }

    /// A table that turns back within the shortest of three steps, of which `level` is the longest.
    pub fn turning(&self, level: u32) -> Option<Turning> {
        self.scene.turns_within(self.step_s(level + 2))
    }

    /// Rounding error of a position [m] in the run of the shortest of three steps, of which `level` is the longest.
    pub fn rounding_m(&self, level: u32) -> f64 {
        rounding(self.farthest_m, self.steps(level + 2))
    }

    /// Whether all names that are asked for begin a column of the histories.
    ///
    /// # Errors
    /// [`CertifyError::NoQuantity`] with the columns that there are.
    pub fn check_names(&self, of: &[String]) -> Result<(), CertifyError> {
        let is_there = |wanted: &&String| self.columns.iter().any(|name| named(name, wanted));
        match of.iter().find(|wanted| !is_there(wanted)) {
            None => Ok(()),
            Some(name) => {
                Err(CertifyError::NoQuantity { name: name.clone(), known: self.columns[1..].join(", ") })
            }
        }
    }

    /// Step of the level `k`, Δt/2ᵏ [s].
    pub fn step_s(&self, level: u32) -> f64 {
        self.step_s / f64::from(2u32.pow(level))
    }

    /// Steps of the level `k`.
    pub fn steps(&self, level: u32) -> u64 {
        self.steps << level
    }

    /// The run of the level `k`, with more values set.
    pub fn case(&self, name: String, level: u32, more: Vec<String>) -> Case {
        let mut overrides = self.common.clone();
        overrides.push(format!("time.step_s={:e}", self.step_s(level)));
        overrides.extend(more);
        Case { name, labels: Vec::new(), overrides, repeats: 1, sensitivity: Sensitivity::Never }
    }

    /// The run of the level `k`.
    pub fn level(&self, level: u32) -> Case {
        self.case(format!("step_{}", 2u32.pow(level)), level, Vec::new())
    }

    /// The run whose cells are halved `times`, of the shortest step of the three from `first` on, or shorter.
    pub fn finer_mesh(&self, first: u32, times: u32) -> Case {
        let more = finer(&self.scene, times as i32);
        self.case(format!("mesh_{}", 2u32.pow(times)), first + 1 + times, more)
    }

    /// The run whose contact is [`STIFFER`] `times` over, of the shortest step of the three from `first` on, or shorter.
    pub fn stiffer(&self, first: u32, times: u32) -> Option<Case> {
        let Some(Contact::Potential { penalty_pa, .. }) = &self.scene.contact else { return None };
        let factor = STIFFER.powi(times as i32);
        let more = vec![format!("contact.penalty_pa={:e}", factor * penalty_pa)];
        Some(self.case(format!("penalty_{factor}"), first + 1 + times, more))
    }

    /// The run of the level `k` whose gravity differs by 1e-9 in a direction along which nothing is symmetric; in a scene
    /// without gravity that differs which would have brought blocks to `speed_m_s`.
    pub fn twin(&self, level: u32, speed_m_s: f64) -> Case {
        let gravity = self.scene.gravity_m_s2;
        let norm = gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
        let size = DISTURBANCE * norm.max(speed_m_s / self.end_s);
        let [x, y, z] = [0.623, -0.481, 0.617];
        let [x, y, z] = [gravity[0] + size * x, gravity[1] + size * y, gravity[2] + size * z];
        self.case("twin".into(), level, vec![format!("gravity_m_s2=({x:e}, {y:e}, {z:e})")])
    }
}

/// The order of the error in Δt that a scene's scheme has.
pub fn order(scene: &Scene) -> f64 {
    let has_contact = !matches!(scene.contact, None | Some(Contact::Off));
    let at_end = has_contact && matches!(scene.time.contact_at, ContactAt::End { .. });
    let second = match scene.time.integrator {
        Integrator::Midpoint { theta } => theta == 0.5,
        Integrator::GeneralizedAlpha { .. } => true,
        // Contact at the positions before costs the scheme its order.
        Integrator::Newmark { delta, .. } => delta == 0.5 && !has_contact,
    };
    if second && !at_end { 2.0 } else { 1.0 }
}

/// The monitors of the scene, and the centres of the blocks that move and have none of theirs.
fn monitors(scene: &Scene, simulation: &Simulation) -> Vec<Monitor> {
    let blocks = simulation.blocks();
    let has_own = |name: &String| scene.monitors.iter().any(|m| m.block == *name && m.at == At::Centre);
    let is_wanted = |block: &BlockId| {
        simulation.shape(*block).kind != BodyKind::Fixed && !has_own(&blocks.names[block.index()])
    };
    let moving = blocks.ids().filter(is_wanted);
    let centre =
        |name: &String| Monitor { name: format!("{BLOCK}{name}"), block: name.clone(), at: At::Centre };
    let centres = moving.map(|block| centre(&blocks.names[block.index()]));
    scene.monitors.iter().cloned().chain(centres).collect()
}

/// A monitor as the scene file has it.
fn written(monitor: &Monitor) -> String {
    let at = match monitor.at {
        At::Centre => "Centre".into(),
        At::Point([x, y, z]) => format!("Point(({x:e}, {y:e}, {z:e}))"),
        At::Largest([x, y, z]) => format!("Largest(({x:e}, {y:e}, {z:e}))"),
    };
    format!("(name: {:?}, block: {:?}, at: {at}), ", monitor.name, monitor.block)
}

/// Rows of a history, a divisor of its steps so that runs of shorter steps have the same instants: some two hundred; a row
/// per step where the steps have no such divisor and are not too many.
fn rows(steps: u64, asked: u32, columns: u64) -> u64 {
    let most = u64::from(asked).clamp(1, ROWS);
    let divisor = (1..=most).rev().find(|rows| steps.is_multiple_of(*rows)).unwrap_or(1);
    if divisor < FEW_ROWS && steps * columns <= MOST_NUMBERS { steps } else { divisor }
}

/// Values that make the cells of a scene's meshes smaller by a half `times`, or larger where that is negative, by path; empty
/// where none can be changed.
pub fn finer(scene: &Scene, times: i32) -> Vec<String> {
    let mut set = Vec::new();
    for (i, block) in scene.blocks.iter().enumerate() {
        let path = format!("blocks[{i}].shape");
        let more = |cells: &[u32]| {
            let cells: Vec<String> = cells.iter().map(|cells| refined(*cells, times).to_string()).collect();
            format!("{path}.cells=({})", cells.join(", "))
        };
        match &block.shape {
            Shape::Box { cells, .. } | Shape::Hexahedron { cells, .. } | Shape::Voussoir { cells, .. } => {
                set.push(more(cells));
            }
            Shape::Prism { cells, .. } | Shape::Cylinder { cells, .. } => set.push(more(cells)),
            Shape::Sphere { levels, .. } => {
                set.push(format!("{path}.levels={}", levels.saturating_add_signed(times)));
            }
            Shape::Polyhedron { fill, .. } | Shape::Surface { fill, .. } => {
                set.extend(filled(&path, fill, times))
            }
            Shape::Mesh { size_m: Some(size_m), finer, .. } => {
                set.push(format!("{path}.size_m={:e}", size_m * 0.5f64.powi(times)));
                set.extend(graded(&path, finer, times));
            }
            Shape::Mesh { .. } => {}
        }
    }
    for (i, rock) in scene.rock.iter().enumerate() {
        set.extend(filled(&format!("rock[{i}]"), &rock.fill, times));
    }
    set
}

/// Cells where there are `cells`, halved `times` or joined; at least one.
fn refined(cells: u32, times: i32) -> u32 {
    let factor = 2u32.saturating_pow(times.unsigned_abs());
    if times < 0 { cells.div_ceil(factor) } else { cells.saturating_mul(factor) }
}

/// A filling of other size, also where it is finer; nothing for one without a size.
fn filled(path: &str, fill: &Fill, times: i32) -> Vec<String> {
    match fill {
        Fill::Size { size_m, finer } => {
            let whole = format!("{path}.fill.size_m={:e}", size_m * 0.5f64.powi(times));
            std::iter::once(whole).chain(graded(&format!("{path}.fill"), finer, times)).collect()
        }
        _ => Vec::new(),
    }
}

/// Edges of length s + g d at a distance d of a place become shorter in all of it where s and g do.
fn graded(path: &str, finer: &[Grading], times: i32) -> Vec<String> {
    let part = 0.5f64.powi(times);
    let set = |(k, grading): (usize, &Grading)| {
        let (size_m, growth) = (part * grading.size_m, part * grading.growth);
        [format!("{path}.finer[{k}].size_m={size_m:e}"), format!("{path}.finer[{k}].growth={growth:e}")]
    };
    finer.iter().enumerate().flat_map(set).collect()
}

/// Names of blocks and rocks that deform and whose mesh cannot be made finer by a value of the scene.
pub fn not_refined(scene: &Scene) -> Vec<String> {
    let deforms = |body: &Body| matches!(body, Body::Elastic);
    let alone = |block: &ndda_io::scene::Block| {
        let scene =
            Scene { blocks: vec![block.clone()], rock: Vec::new(), bolts: Vec::new(), ..scene.clone() };
        finer(&scene, 1).is_empty()
    };
    let blocks = scene.blocks.iter().filter(|b| deforms(&b.body) && alone(b)).map(|b| b.name.clone());
    let rocks = scene.rock.iter().filter(|r| deforms(&r.body) && filled("", &r.fill, 1).is_empty());
    blocks.chain(rocks.map(|rock| rock.name.clone())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_graded_mesh_is_finer_in_all_of_it() {
        let text = "(title: \"t\", time: (step_s: 1e-4, end_s: 1e-3), contact: Off,
            materials: [(name: \"rock\", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
            blocks: [(name: \"a\", material: \"rock\", shape: Polyhedron(corners_m: [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
                faces: [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
                fill: Size(size_m: 1, finer: [(towards: Point((0, 0, 0)), size_m: 0.3, growth: 0.1)])))])";
        let scene = ndda_io::read::load_text("t.ron", text, &[], None).unwrap().scene;
        let fill = "blocks[0].shape.fill";
        let expected = [
            format!("{fill}.size_m=5e-1"),
            format!("{fill}.finer[0].size_m=1.5e-1"),
            format!("{fill}.finer[0].growth=5e-2"),
        ];
        let set = finer(&scene, 1);
        assert_eq!(set, expected);
        assert!(ndda_io::read::load_text("t.ron", text, &set, None).is_ok());
    }

    #[test]
    fn rows_divide_the_steps() {
        assert_eq!(rows(10_000, 1000, 50), 200);
        assert_eq!(rows(7, 1000, 50), 7);
        // 1 009 is a prime.
        assert_eq!(rows(1009, 1000, 50), 1009);
        assert_eq!(rows(1_000_003, 1000, 50), 1);
        assert_eq!(rows(1000, 0, 10_000), 1);
    }
}
