//! How far each block has gone: displacement, rotation and speed, and the largest of a run.

use std::ops::ControlFlow;
use std::time::Instant;

use ndda_fem::BlockOperator;
use ndda_io::{History, OutputFolder, WriteError};
use ndda_mesh::{BlockId, Mat3, Vec3};
use ndda_solver::{BodyKind, Simulation, Sink, SinkError, View};
use serde::{Deserialize, Serialize};

use super::schedule::Schedule;
use crate::numbers::length;
use crate::summary::{BlockMotion, Course, Motion};

/// A block has moved if a point of it has gone farther than this part of the distance from its mass centre to its farthest node.
pub(crate) const MOVED: f64 = 0.01;
/// A block rests if it moves at less than this part of its own largest speed.
const RESTS: f64 = 0.01;
/// Slower motion is rounding [m/s].
const SLOWEST_M_S: f64 = 1e-12;
/// It rests as well if no point of it has gone farther than this part of the distance from its mass centre to its farthest node, but for one that accelerates.
const STAYS: f64 = 1e-6;
/// It accelerates if it moves at more than this part of that.
const ACCELERATES: f64 = 0.99;

/// Columns of `blocks.csv`; blocks are numbered from 0 in the order of `block_id` and of the summary.
pub const COLUMNS: [&str; 13] = [
    "time_s",
    "block",
    "displacement_x_m",
    "displacement_y_m",
    "displacement_z_m",
    "farthest_m",
    "rotation_deg",
    "velocity_x_m_s",
    "velocity_y_m_s",
    "velocity_z_m_s",
    "spin_x_rad_s",
    "spin_y_rad_s",
    "spin_z_rad_s",
];

/// The largest displacement and speed of each block so far.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LargestMotions {
    farthest_m: Vec<f64>,
    fastest_m_s: Vec<f64>,
}

impl LargestMotions {
    /// Looks at all blocks as they are now.
    pub fn watch(&mut self, simulation: &Simulation) {
        let blocks = simulation.blocks();
        self.farthest_m.resize(blocks.len(), 0.0);
        self.fastest_m_s.resize(blocks.len(), 0.0);
        for block in blocks.ids() {
            let (farthest, fastest) =
                (&mut self.farthest_m[block.index()], &mut self.fastest_m_s[block.index()]);
            *farthest = farthest.max(farthest_m(simulation, block));
            *fastest = fastest.max(velocity_m_s(simulation, block).norm());
        }
    }

    /// Displacements count from now on.
    pub fn begin_anew(&mut self) {
        self.farthest_m.clear();
    }

    /// Motion of a block now, and its largest.
    pub fn of(&self, simulation: &Simulation, block: BlockId) -> BlockMotion {
        let farthest_m = farthest_m(simulation, block);
        let largest_m = self.farthest_m.get(block.index()).copied().unwrap_or(0.0);
        BlockMotion {
            displacement_m: displacement_m(simulation, block).into(),
            farthest_m,
            largest_m: largest_m.max(farthest_m),
            rotation_deg: rotation_deg(simulation, block),
        }
    }

    /// The motion of the blocks, in one record; none where every block is fixed or held.
    pub fn summary(&self, simulation: &Simulation) -> Option<Motion> {
        let blocks = simulation.blocks();
        let free = || blocks.ids().filter(|&block| is_movable(simulation, block));
        let has_moved = |&block: &BlockId| {
            farthest_m(simulation, block) > MOVED * radius_m(&simulation.shape(block).operator)
        };
        let farthest = free().map(|block| (farthest_m(simulation, block), block));
        let (distance_m, block) = farthest.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)))?;
        let speed_m_s = velocity_m_s(simulation, block).norm();
        let fastest_m_s = self.fastest_m_s.get(block.index()).copied().unwrap_or(0.0).max(speed_m_s);
        let is_slow = speed_m_s <= RESTS * fastest_m_s || fastest_node_m_s(simulation, block) < SLOWEST_M_S;
        // A boulder at the top of its flight is slow, too.
        let stays = distance_m < STAYS * radius_m(&simulation.shape(block).operator);
        let flies = simulation.falls_freely(block);
        // Over its way, its acceleration would change its speed by less than a hundredth.
        let coasts =
            simulation.acceleration_m_s2(block).norm() * distance_m < (1.0 - ACCELERATES) * speed_m_s.powi(2);
        let course = if is_slow && !flies {
            Course::AtRest
        } else if speed_m_s >= ACCELERATES * fastest_m_s && !coasts {
            Course::Accelerating
        } else if stays && !flies {
            Course::AtRest
        } else {
            Course::Moving
        };
        Some(Motion {
            can_move: free().count(),
            moved: free().filter(has_moved).count(),
            farthest: blocks.names[block.index()].clone(),
            farthest_m: distance_m,
            speed_m_s,
            course,
            fallen_out: simulation.fallen_out().iter().map(|out| blocks.names[out.index()].clone()).collect(),
        })
    }
}

/// Speed of a block's fastest node [m/s].
fn fastest_node_m_s(simulation: &Simulation, block: BlockId) -> f64 {
    simulation.state().velocity[simulation.blocks().nodes_of(block)]
        .iter()
        .map(|v| v.norm())
        .fold(0.0, f64::max)
}

/// Whether forces can move a block: it is not fixed, and supports do not hold or drive all of its nodes.
fn is_movable(simulation: &Simulation, block: BlockId) -> bool {
    let shape = simulation.shape(block);
    shape.kind == BodyKind::Rigid || shape.factor.is_some()
}

/// Distance from the mass centre to the farthest node at rest [m].
pub(crate) fn radius_m(operator: &BlockOperator) -> f64 {
    operator.rest.iter().map(|x| x.norm()).fold(0.0, f64::max)
}

/// How far the farthest node has gone [m].
fn farthest_m(simulation: &Simulation, block: BlockId) -> f64 {
    farthest_between_m(simulation, block, [simulation.counted_from(), &simulation.state().position])
}

/// The largest distance of a node of a block between two sets of places of all nodes [m].
fn farthest_between_m(simulation: &Simulation, block: BlockId, [from, to]: [&[Vec3]; 2]) -> f64 {
    let squares = simulation.blocks().nodes_of(block).map(|n| (to[n] - from[n]).norm_squared());
    squares.fold(0.0, f64::max).sqrt()
}

/// A warning says how far settling has moved a block if a point of it has gone farther than this part of the distance from its mass centre to its farthest node.
const SETTLED_FAR: f64 = 5e-3;

/// Warning that settling has moved a block far, of the one that went farthest over its size; none where no block went far.
pub(crate) fn moved_while_settling(simulation: &Simulation) -> Option<String> {
    let blocks = simulation.blocks();
    let (drawn, start) = (&blocks.rest_position, simulation.start_position());
    let went = |block: BlockId| {
        let gone_m = farthest_between_m(simulation, block, [drawn, start]);
        (gone_m / radius_m(&simulation.shape(block).operator), gone_m, block)
    };
    let free = blocks.ids().filter(|&block| is_movable(simulation, block));
    let (part, gone_m, block) = free.map(went).max_by(|a, b| a.0.total_cmp(&b.0).then(b.2.cmp(&a.2)))?;
    (part > SETTLED_FAR).then(|| {
        format!(
            "block `{}` moved by {}, {:.1} % of its radius, while the scene settled; displacements count from there",
            blocks.names[block.index()],
            length(gone_m),
            100.0 * part
        )
    })
}

/// Displacement of the mass centre [m].
fn displacement_m(simulation: &Simulation, block: BlockId) -> Vec3 {
    shift_m(simulation, simulation.counted_from(), block)
}

/// Displacement of the mass centre from where nodes were [m].
pub(crate) fn shift_m(simulation: &Simulation, from: &[Vec3], block: BlockId) -> Vec3 {
    let (operator, nodes) = (&simulation.shape(block).operator, simulation.blocks().nodes_of(block));
    operator.center(&simulation.state().position[nodes.clone()]) - operator.center(&from[nodes])
}

fn velocity_m_s(simulation: &Simulation, block: BlockId) -> Vec3 {
    let (operator, nodes) = (&simulation.shape(block).operator, simulation.blocks().nodes_of(block));
    operator.momentum(&simulation.state().velocity[nodes]) / operator.mass_kg
}

fn rotation_deg(simulation: &Simulation, block: BlockId) -> f64 {
    turn_deg(simulation, simulation.counted_from(), block)
}

/// Angle of the rotation in the motion of the nodes, from 0 to 180 [°].
fn turn_deg(simulation: &Simulation, from: &[Vec3], block: BlockId) -> f64 {
    let (angle, _) = angle_and_axis(&rotation(simulation, from, block));
    angle.to_degrees()
}

/// The rotation in the motion of the nodes: its axis, as long as its angle [rad].
pub(crate) fn turn_rad(simulation: &Simulation, from: &[Vec3], block: BlockId) -> Vec3 {
    let (angle, axis) = angle_and_axis(&rotation(simulation, from, block));
    axis.try_normalize(0.0).map_or_else(Vec3::zeros, |axis| angle * axis)
}

/// Angle of a rotation from 0 to π, and its axis, as long as twice the sine of that.
fn angle_and_axis(rotation: &Mat3) -> (f64, Vec3) {
    let axial = Vec3::new(
        rotation[(2, 1)] - rotation[(1, 2)],
        rotation[(0, 2)] - rotation[(2, 0)],
        rotation[(1, 0)] - rotation[(0, 1)],
    );
    (axial.norm().atan2(rotation.trace() - 1.0), axial)
}

/// The rotation in the motion of the nodes: the orthogonal part of A = Σ m (x − c)(X − C)ᵀ by its singular values, which fits best (Kabsch 1976). Of a block that deforms,
/// that of A S⁻¹, S = Σ m (X − C)(X − C)ᵀ, the affine motion that fits best: strain of a mesh without symmetry turns A, and is no rotation.
fn rotation(simulation: &Simulation, from: &[Vec3], block: BlockId) -> Mat3 {
    let (operator, nodes) = (&simulation.shape(block).operator, simulation.blocks().nodes_of(block));
    let now = &simulation.state().position[nodes.clone()];
    let start = &from[nodes];
    if now == start {
        return Mat3::identity();
    }
    let (center, first) = (operator.center(now), operator.center(start));
    let mut moment = Mat3::zeros();
    for ((&mass, x), old) in operator.node_mass.iter().zip(now).zip(start) {
        moment += mass * (x - center) * (old - first).transpose();
    }
    if matches!(simulation.shape(block).kind, BodyKind::Elastic | BodyKind::Affine) {
        let mut size = Mat3::zeros();
        for (&mass, old) in operator.node_mass.iter().zip(start) {
            size += mass * (old - first) * (old - first).transpose();
        }
        moment *= size.try_inverse().unwrap_or_else(Mat3::identity);
    }
    let parts = moment.svd(true, true);
    let (Some(left), Some(right)) = (parts.u, parts.v_t) else { return Mat3::identity() };
    let mut mirror = Mat3::identity();
    let smallest = parts.singular_values.imin();
    mirror[(smallest, smallest)] = (left * right).determinant().signum();
    left * mirror * right
}

/// Writes `blocks.csv`: a row per block at the times of the frames.
pub struct BlockTable {
    table: History,
    schedule: Schedule,
    /// Seconds spent in this part of the run.
    pub spent_s: f64,
}

impl BlockTable {
    /// Begins a table, or goes on after so many rows of it.
    ///
    /// # Errors
    /// [`WriteError`] when the file cannot be written, or is another table.
    pub fn new(folder: &OutputFolder, schedule: Schedule, saved: Option<usize>) -> Result<Self, WriteError> {
        let columns = COLUMNS.map(String::from);
        let table = match saved {
            None => History::create(&folder.blocks(), &columns)?,
            Some(saved) => History::resume(&folder.blocks(), &columns, saved)?,
        };
        Ok(Self { table, schedule, spent_s: 0.0 })
    }

    /// Rows so far, all of them on the disk.
    ///
    /// # Errors
    /// [`WriteError`] when they are not.
    pub fn save(&mut self) -> Result<usize, WriteError> {
        self.table.sync()?;
        Ok(self.table.rows())
    }
}

impl Sink for BlockTable {
    fn step_done(&mut self, view: &mut View) -> Result<ControlFlow<()>, SinkError> {
        let simulation = &*view.simulation;
        if !self.schedule.is_due(simulation.state().step) {
            return Ok(ControlFlow::Continue(()));
        }
        let started = Instant::now();
        for block in simulation.blocks().ids().filter(|&block| !simulation.is_absent(block)) {
            self.table.push(&row(simulation, block))?;
        }
        self.spent_s += started.elapsed().as_secs_f64();
        Ok(ControlFlow::Continue(()))
    }
}

fn row(simulation: &Simulation, block: BlockId) -> [f64; COLUMNS.len()] {
    let (operator, nodes) = (&simulation.shape(block).operator, simulation.blocks().nodes_of(block));
    let state = simulation.state();
    let motion = operator.rigid_motion(&state.position[nodes.clone()], &state.velocity[nodes]);
    let displacement_m = displacement_m(simulation, block);
    let mut row = [0.0; COLUMNS.len()];
    row[..2].copy_from_slice(&[simulation.time_s(), block.index() as f64]);
    row[2..5].copy_from_slice(displacement_m.as_slice());
    row[5..7].copy_from_slice(&[farthest_m(simulation, block), rotation_deg(simulation, block)]);
    row[7..10].copy_from_slice(motion.velocity_m_s.as_slice());
    row[10..].copy_from_slice(motion.spin_rad_s.as_slice());
    row
}

#[cfg(test)]
mod tests {
    use crate::summary::Course;
    use crate::{Model, Run};

    #[test]
    fn a_block_at_the_top_of_its_flight_is_not_at_rest() {
        let text = "(title: \"thrown\", contact: Off, time: (step_s: 1e-3, end_s: 0.2), gravity_m_s2: (0, 0, -10),
            materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)],
            blocks: [(name: \"cube\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), velocity_m_s: (0, 0, 2))])";
        let summary = Run::new(Model::from_text(text).unwrap()).finish(&mut []).unwrap().summary;
        let motion = summary.motion.unwrap();
        assert!(motion.speed_m_s < 1e-9, "{}", motion.speed_m_s);
        assert_eq!(motion.course, Course::Moving);
    }

    #[test]
    fn a_block_that_flies_without_gravity_moves_and_does_not_accelerate() {
        let text = "(title: \"thrown\", contact: Off, time: (step_s: 1e-3, end_s: 0.2),
            materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)],
            blocks: [(name: \"cube\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), velocity_m_s: (0, 0, 2))])";
        let summary = Run::new(Model::from_text(text).unwrap()).finish(&mut []).unwrap().summary;
        assert_eq!(summary.motion.unwrap().course, Course::Moving);
    }

    #[test]
    fn strain_of_a_mesh_without_symmetry_is_no_rotation() {
        let text = "(title: \"stretched\", contact: Off, time: (step_s: 1e-5, end_s: 5e-4),
            materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)],
            blocks: [(name: \"cube\", material: \"rock\", body: Affine, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1), pattern: Six),
                      initial_stress_pa: (xx: -2e7))])";
        let summary = Run::new(Model::from_text(text).unwrap()).finish(&mut []).unwrap().summary;
        let cube = &summary.blocks.0[0].1.motion;
        assert!(cube.farthest_m > 1e-4, "{} m", cube.farthest_m);
        assert!(cube.rotation_deg < 1e-8, "{}°", cube.rotation_deg);
    }

    #[test]
    fn displacement_and_rotation_of_a_thrown_block_are_those_of_free_flight() {
        let text = "(title: \"thrown\", contact: Off, time: (step_s: 1e-3, end_s: 0.5), gravity_m_s2: (0, 0, -10),
            materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)],
            blocks: [(name: \"cube\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), velocity_m_s: (1, 0, 2),
                      spin_rad_s: (0, 0, 4)),
                     (name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, -9))])";
        let model = Model::from_text(text).unwrap();
        let summary = Run::new(model).finish(&mut []).unwrap().summary;
        let cube = &summary.blocks.0[0].1.motion;
        for (found, expected) in cube.displacement_m.into_iter().zip([0.5, 0.0, 2.0 * 0.5 - 5.0 * 0.25]) {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
        assert!((cube.rotation_deg - 2f64.to_degrees()).abs() < 1e-9, "{}", cube.rotation_deg);
        // A corner at √½ from the axis is turned by 2 rad about it, and the nearest the flight shifts it is that of the centre.
        let chord_m = 2.0 * 0.5f64.sqrt() * 1f64.sin();
        assert!(cube.farthest_m > chord_m && cube.farthest_m < chord_m + 0.5591, "{}", cube.farthest_m);
        assert!(cube.largest_m >= cube.farthest_m);
        let motion = summary.motion.unwrap();
        assert_eq!((motion.can_move, motion.moved, motion.farthest.as_str()), (1, 1, "cube"));
        assert_eq!((motion.course, motion.fallen_out), (Course::Accelerating, Vec::new()));
    }

    #[test]
    fn a_block_that_misses_the_floor_and_falls_past_it_is_said_to_have_fallen_out() {
        let run = |end_s: f64| {
            let text = format!(
                "(title: \"over the rim\", time: (step_s: 1e-3, end_s: {end_s}), gravity_m_s2: (0, 0, -10),
                materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)],
                blocks: [(name: \"cube\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (4, 0, 0)),
                         (name: \"stays\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (1, 1, 0)),
                         (name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (3, 3, 1), cells: (1, 1, 1)), at_m: (0, 0, -1))],
                contact: Potential(friction: (friction_deg: 30)))"
            );
            let summary = Run::new(Model::from_text(&text).unwrap()).finish(&mut []).unwrap().summary;
            (summary.motion.clone().unwrap().fallen_out, crate::judge::table::moved(&summary.motion.unwrap()))
        };
        // Its upper face is 2 m above the floor's lower one, which it passes after √(2·2/10) = 0.632 s.
        assert!(run(0.62).0.is_empty());
        let (fallen_out, words) = run(0.65);
        assert_eq!(fallen_out, ["cube"]);
        assert!(words.contains("`cube` has fallen out of the model"), "{words}");
    }
}
