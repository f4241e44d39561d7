//! From which acceleration of a shaken base on blocks rock, and by how much contact that gives way lowers it.
//!
//! Under a level acceleration a, weights and inertia of a block and of what rests on it meet the base at a foot that moves towards an edge as a grows. A rigid edge
//! holds them until the foot is there. Contact of penalty k_n gives way: where the base tilts by θ about a line s₀, pressures are 2 k_n θ (s − s₀)/L₀ beyond it,
//! so that N = (2 k_n θ/L₀) ∫ (s − s₀) dA, and the foot is at ∫ s (s − s₀) dA/∫ (s − s₀) dA. The tilt moves the forces on by θ times their arm, so that
//! they stand while some s₀ has foot(s₀) ≥ foot(a) + θ(s₀) arm. On a rectangle of half depth b and width w, and masses h high, that is up to
//! a = g (b − 3 d/2)/h, d³ = 2 N h (1 + a²/g²) L₀/(9 k_n w), instead of g b/h.

mod stack;

use std::fmt;

use ndda_fem::Motion;
use ndda_io::scene::{Contact, Potential, Scene};
use ndda_mesh::{BlockId, Vec3};
use ndda_solver::{BodyKind, Simulation};
use serde::Serialize;

use crate::base_of_block::Base;
use crate::numbers::counted;
use stack::Stack;

/// Part of the acceleration that penetration may take.
pub const MOST_LOST: f64 = 0.06;
/// Part that is left to it with the penalty that is advised.
const ADVISED: f64 = 0.05;
/// Most free blocks of a scene that are looked at: each is compared with all others.
const MOST_BLOCKS: usize = 100;
/// Decades by which the penalty may be raised.
const MOST_DECADES: f64 = 8.0;

/// From which acceleration on a block rocks, with what rests on it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Rocking {
    /// Name of the block.
    pub block: String,
    /// Blocks that rest on it.
    pub blocks_on_it: usize,
    /// Acceleration of the base at the instant that brings the block nearest to rocking, all records together [m/s²].
    pub peak_m_s2: f64,
    /// Acceleration in that direction at which it begins to rock [m/s²].
    pub rocks_at_m_s2: f64,
    /// The same on an edge that does not give way [m/s²].
    pub rigid_m_s2: f64,
    /// Penalty with which penetration takes 5 %, that of the scene where it takes no more [Pa].
    pub advised_penalty_pa: f64,
}

impl Rocking {
    /// Part of the acceleration that penetration takes.
    pub fn lost(&self) -> f64 {
        lost([self.rocks_at_m_s2, self.rigid_m_s2])
    }

    /// Whether the base shakes it enough for penetration to decide, by too much.
    pub fn is_doubtful(&self) -> bool {
        are_doubtful([self.rocks_at_m_s2, self.rigid_m_s2], self.peak_m_s2)
    }
}

/// Part that penetration takes of the acceleration at which a block rocks; the second is on an edge that does not give way.
fn lost([rocks_at_m_s2, rigid_m_s2]: [f64; 2]) -> f64 {
    1.0 - rocks_at_m_s2 / rigid_m_s2
}

/// Whether a base that is shaken this much reaches the first, and penetration takes too much of it.
fn are_doubtful(at: [f64; 2], peak_m_s2: f64) -> bool {
    peak_m_s2 > at[0] && lost(at) > MOST_LOST
}

impl fmt::Display for Rocking {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { block, blocks_on_it, peak_m_s2, rocks_at_m_s2, rigid_m_s2, advised_penalty_pa } = self;
        let with = match blocks_on_it {
            0 => String::new(),
            on_it => format!(", with {} on it,", counted(*on_it, "block", "blocks")),
        };
        write!(
            f,
            "block `{block}`{with} begins to rock where its base accelerates by {rocks_at_m_s2:.3} m/s², on rigid edges by {rigid_m_s2:.3} m/s²: penetration lowers \
             this by {:.1} %, limit {:.0} %, and the base reaches {peak_m_s2:.3} m/s²",
            100.0 * self.lost(),
            100.0 * MOST_LOST
        )?;
        if self.is_doubtful() { write!(f, ": raise penalty_pa to {advised_penalty_pa:.0e}") } else { Ok(()) }
    }
}

/// Of the blocks on a shaken base that rock too early, and by too much, the one that loses most; where none does, the one that comes nearest to rocking. None where no base is
/// shaken by a record, without gravity, and of potentials other than `Smooth`.
pub fn worst(scene: &Scene, simulation: &Simulation) -> Option<Rocking> {
    let Some(Contact::Potential { penalty_pa, potential: Potential::Smooth { reference_m }, .. }) =
        scene.contact
    else {
        return None;
    };
    let (gravity, blocks) = (Vec3::from(scene.gravity_m_s2), simulation.blocks());
    gravity.try_normalize(0.0)?;
    let free: Vec<BlockId> =
        blocks.ids().filter(|block| simulation.shape(*block).kind != BodyKind::Fixed).collect();
    if free.len() > MOST_BLOCKS {
        return None;
    }
    let accelerations = accelerations(simulation);
    if accelerations.is_empty() {
        return None;
    }
    let bases: Vec<(BlockId, Base)> =
        free.into_iter().filter_map(|block| Some((block, Base::of(simulation, block, &gravity)?))).collect();
    let soft_per_m = |penalty_pa: f64| reference_m / (2.0 * penalty_pa);
    let found = bases.iter().flat_map(|(block, base)| {
        let stack = Stack::new(simulation, &bases, *block, base, &gravity);
        let peaks = stack.as_ref().map_or_else(Vec::new, |stack| stack.peaks(&accelerations));
        let thresholds = peaks.into_iter().map(move |peak| {
            let (stack, along) = (stack.as_ref()?, peak.normalize());
            let rigid_m_s2 = stack.threshold(&along, 0.0)?;
            let rocks_at_m_s2 = stack.threshold(&along, soft_per_m(penalty_pa))?;
            Some(Found { stack: stack.clone(), peak, at: [rocks_at_m_s2, rigid_m_s2], block })
        });
        thresholds.flatten()
    });
    let worst = found.max_by(|a, b| a.rank().partial_cmp(&b.rank()).unwrap_or(std::cmp::Ordering::Equal))?;
    let Found { stack, peak, at, block } = &worst;
    let is_enough = |penalty_pa: f64| {
        let soft = stack.threshold(&peak.normalize(), soft_per_m(penalty_pa));
        soft.is_some_and(|soft| lost([soft, at[1]]) <= ADVISED)
    };
    let advised_penalty_pa = if lost(*at) > ADVISED { least_from(penalty_pa, is_enough) } else { penalty_pa };
    Some(Rocking {
        block: blocks.names[block.index()].clone(),
        blocks_on_it: stack.blocks_on_it,
        peak_m_s2: peak.norm(),
        rocks_at_m_s2: at[0],
        rigid_m_s2: at[1],
        advised_penalty_pa,
    })
}

/// A block at one of the peaks of its base.
struct Found<'a> {
    stack: Stack<'a>,
    /// Acceleration of the base [m/s²].
    peak: Vec3,
    /// Accelerations in that direction at which it begins to rock, and would on rigid edges [m/s²].
    at: [f64; 2],
    block: &'a BlockId,
}

impl Found<'_> {
    /// Blocks that rock too early come first, the one that loses most before others, to a millionth; then those that come nearest to rocking, or go farthest beyond it.
    fn rank(&self) -> [f64; 3] {
        let peak_m_s2 = self.peak.norm();
        let (first, loss) = match are_doubtful(self.at, peak_m_s2) {
            true => (1.0, (1e6 * lost(self.at)).round()),
            false => (0.0, 0.0),
        };
        [first, loss, peak_m_s2 / self.at[0]]
    }
}

/// About the least penalty from one on that is enough [Pa].
pub fn least_from(penalty_pa: f64, is_enough: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, MOST_DECADES);
    for _ in 0..12 {
        let middle = 0.5 * (low + high);
        if is_enough(penalty_pa * 10_f64.powf(middle)) { high = middle } else { low = middle }
    }
    penalty_pa * 10_f64.powf(high)
}

/// Accelerations of the records that move blocks, those of one base together, at each of their rows [m/s²].
fn accelerations(simulation: &Simulation) -> Vec<Vec3> {
    let motions = simulation.blocks().ids().flat_map(|block| &simulation.shape(block).supports.motions);
    let mut seen: Vec<&Motion> = Vec::new();
    motions.for_each(|motion| {
        if !seen.contains(&motion) {
            seen.push(motion);
        }
    });
    let all = seen.into_iter().flat_map(Motion::accelerations);
    all.filter(|acceleration| *acceleration != Vec3::zeros()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Model;

    const PENALTY_PA: f64 = 2e9;

    /// Cubes of 1 m on each other on a base that follows a record of 3 m/s².
    fn shaken(cubes: usize) -> Option<Rocking> {
        shaken_by(cubes, (0.0, 10.0), &[("(1, 0, 0)", "0,0\n0.5,3\n1,-2\n1.5,0\n")])
    }

    /// Cubes on a base that follows records, each with its direction, under a gravity (x, −z).
    fn shaken_by(cubes: usize, (down_x, down_z): (f64, f64), records: &[(&str, &str)]) -> Option<Rocking> {
        // Tests run side by side.
        let (process, thread) = (std::process::id(), std::thread::current().id());
        let files: Vec<_> = (0..records.len())
            .map(|k| std::env::temp_dir().join(format!("ndda_rocking_{process}_{thread:?}_{k}.csv")))
            .collect();
        for ((_, rows), file) in records.iter().zip(&files) {
            std::fs::write(file, format!("time_s,acceleration_m_s2\n{rows}")).unwrap();
        }
        let record = |((direction, _), file): (&(&str, &str), &std::path::PathBuf)| {
            format!("(direction: {direction}, record: (file: {file:?}))")
        };
        let shaking: Vec<String> = records.iter().zip(&files).map(record).collect();
        let cube = |k: usize| {
            format!(
                "(name: \"cube_{k}\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, {k}))"
            )
        };
        let cubes: Vec<String> = (0..cubes).map(cube).collect();
        let text = format!(
            "(title: \"t\", time: (step_s: 1e-3, end_s: 1.5), gravity_m_s2: ({down_x}, 0, -{down_z}),
             materials: [(name: \"rock\", young_pa: 2e10, poisson: 0.25, density_kg_m3: 2500)],
             blocks: [(name: \"base\", material: \"rock\", body: Fixed, shape: Box(size_m: (4, 3, 1), cells: (2, 1, 1)), at_m: (-2, -1, -1)), {}],
             supports: [(block: \"base\", on: All, hold: Shaking([{}]))],
             contact: Potential(penalty_pa: {PENALTY_PA}, potential: Smooth(reference_m: 1), friction: (friction_deg: 60)))",
            cubes.join(", "),
            shaking.join(", ")
        );
        let loaded = ndda_io::read::load_text("t.ron", &text, &[], None).unwrap();
        let scene = loaded.scene.clone();
        let found = worst(&scene, &Model::new(loaded, std::path::Path::new(".")).unwrap().simulation);
        files.iter().for_each(|file| std::fs::remove_file(file).unwrap());
        found
    }

    #[test]
    fn a_stack_rocks_where_the_closed_form_of_a_rectangle_says() {
        for cubes in [1, 3] {
            let found = shaken(cubes).unwrap();
            let (height_m, weight_n) = (0.5 * cubes as f64, 2.5e4 * cubes as f64);
            let (rigid, mut soft) = (10.0 * 0.5 / height_m, 0.0);
            for _ in 0..20 {
                let arm_m = height_m * (1.0 + f64::powi(0.1 * soft, 2));
                let d_m = (2.0 * weight_n * arm_m / (9.0 * PENALTY_PA)).cbrt();
                soft = 10.0 * (0.5 - 1.5 * d_m) / height_m;
            }
            // The places of s₀ are 4 % apart, and at the largest a they count by their square.
            assert!((found.rigid_m_s2 / rigid - 1.0).abs() < 1e-9, "{found:?}, {rigid}");
            assert!((found.rocks_at_m_s2 / soft - 1.0).abs() < 1e-4, "{found:?}, {soft}");
            assert!((found.peak_m_s2 - 3.0).abs() < 1e-12 && found.blocks_on_it == cubes - 1, "{found:?}");
            // 12 halvings of eight decades, and an arm that changes by half a per cent with a.
            let advised_pa = PENALTY_PA * ((1.0 - soft / rigid) / ADVISED).powi(3).max(1.0);
            assert!((found.advised_penalty_pa / advised_pa).log10().abs() < 5e-3, "{found:?}, {advised_pa}");
        }
    }

    /// Down a slope of 31° a cube rocks from g (cos 31° − sin 31°) = 3.42 m/s² on, which the base exceeds; up it from 13.7 m/s² on, of which penetration
    /// takes more, but which no base reaches.
    #[test]
    fn a_direction_in_which_it_rocks_only_far_above_the_peak_hides_none_in_which_it_does() {
        let on_a_slope = |slope_deg: f64, rows: &str| {
            let (sin, cos) = slope_deg.to_radians().sin_cos();
            let found = shaken_by(1, (10.0 * sin, 10.0 * cos), &[("(1, 0, 0)", rows)]).unwrap();
            (found.rigid_m_s2 / (10.0 * (cos - sin)), found)
        };
        let (ratio, found) = on_a_slope(31.0, "0,0\n0.5,4\n1,-4\n1.5,0\n");
        assert!((ratio - 1.0).abs() < 1e-9 && found.is_doubtful(), "{found:?}");
        // Where it rocks in neither, the one is named that comes first.
        let (ratio, found) = on_a_slope(10.0, "0,0\n0.5,4\n1,-4\n1.5,0\n");
        assert!((ratio - 1.0).abs() < 1e-9 && !found.is_doubtful(), "{found:?}");
        // A base that accelerates by as much in the other direction only does not reach it.
        let found = on_a_slope(31.0, "0,0\n0.5,4\n1.5,0\n").1;
        assert!(!found.is_doubtful(), "{found:?}");
    }

    #[test]
    fn components_of_a_record_and_vertical_motion_count_together() {
        let alone = |rows: &str| format!("0,0\n0.5,{rows}\n1,0\n");
        let (six, four, minus_four) = (alone("6"), alone("4"), alone("-4"));
        // 30° from an axis, the foot reaches the edge across that axis at g/cos 30°.
        let found = shaken_by(1, (0.0, 10.0), &[("(0.866025403784, 0.5, 0)", &six)]).unwrap();
        assert!((found.rigid_m_s2 / (10.0 / 30_f64.to_radians().cos()) - 1.0).abs() < 1e-9, "{found:?}");
        assert!((found.peak_m_s2 - 6.0).abs() < 1e-9, "{found:?}");
        // Two of 4 m/s² at once, but not one after the other.
        let found = shaken_by(1, (0.0, 10.0), &[("(1, 0, 0)", &four), ("(0, 1, 0)", &four)]).unwrap();
        assert!((found.rigid_m_s2 / (10.0 * 2_f64.sqrt()) - 1.0).abs() < 1e-9, "{found:?}");
        assert!((found.peak_m_s2 - 32_f64.sqrt()).abs() < 1e-9, "{found:?}");
        let later = "0.5,0\n1,4\n1.5,0\n";
        let found = shaken_by(1, (0.0, 10.0), &[("(1, 0, 0)", &alone("4")), ("(0, 1, 0)", later)]).unwrap();
        assert!((found.peak_m_s2 - 4.0).abs() < 1e-9, "{found:?}");
        // A cube rocks where a_x = g + a_z: at 6 m/s² for a_z = −⅔ a_x, since a base that falls presses less, at 30 m/s² for a_z = ⅔ a_x.
        for (vertical, rigid_m_s2) in [(&minus_four, 10.0 / (1.0 + 4.0 / 6.0)), (&four, 30.0)] {
            let found = shaken_by(1, (0.0, 10.0), &[("(1, 0, 0)", &six), ("(0, 0, 1)", vertical)]).unwrap();
            let rigid_m_s2 = rigid_m_s2 * (1.0 + (4.0 / 6.0_f64).powi(2)).sqrt();
            assert!((found.rigid_m_s2 / rigid_m_s2 - 1.0).abs() < 1e-9, "{found:?}, {rigid_m_s2}");
        }
    }

    #[test]
    fn it_counts_only_where_the_base_shakes_as_much() {
        assert!(!shaken(1).unwrap().is_doubtful(), "a cube rocks at 10 m/s² only");
        let text = shaken(4).unwrap().to_string();
        assert!(
            text.starts_with(
                "block `cube_0`, with 3 blocks on it, begins to rock where its base accelerates by 2."
            ),
            "{text}"
        );
    }
}
