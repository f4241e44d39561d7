//! Blocks that press on their base near its edge, where contact gives way and lets them lean, or fall.
//!
//! A force N whose line meets the base d inside an edge presses on a strip of 3 d. With the width w of the base along the edge, the tilt takes the
//! part 1 − x of d, x² (1 − x) = M, M = N h L₀/(9 k_n w d³). h is how far the line moves towards the edge by the tilt: h_c/cos²α for a weight whose
//! mass centre is h_c above a base that dips by α. Beyond M = 4/27 there is no such x, and the block falls, although a rigid edge would hold it.
//!
//! Where N acts within the middle third of a base of depth B, the whole base is in contact. Its eccentricity e grows to e/(1 − R),
//! R = 6 N h L₀/(k_n w B³) = 54 M d³/B³, as long as that stays within the middle third.

use std::fmt;

use ndda_io::scene::{Contact, Force, Potential, Scene, matches};
use ndda_mesh::{BlockId, Vec3};
use ndda_solver::{BodyKind, Simulation};

use crate::base_of_block::{Base, Pressed, Pull, with_all_on_it};
use crate::build;
use crate::numbers::{counted, length};
use crate::rocking::least_from;

/// Part of d that the force may move by.
pub const MOST_MOVED: f64 = 0.06;
/// M from which on it falls.
const FALLS: f64 = 4.0 / 27.0;
/// M with the penalty that is advised, and the part of d that the force moves by then.
const ADVISED: f64 = 0.02;
/// Most free blocks of a scene that are looked at: each is compared with all others.
const MOST_BLOCKS: usize = 100;
/// Factor on the penalty beyond which none is advised.
const MOST_RAISED: f64 = 1e6;

/// A block whose weight, with that of all that rests on it, acts near the edge of its base.
#[derive(Clone, Debug, PartialEq)]
pub struct Lean {
    /// Its name.
    pub block: String,
    /// Blocks that rest on it.
    pub blocks_on_it: usize,
    /// d [m].
    pub inside_m: f64,
    /// M.
    pub m: f64,
    /// Part of d that the force moves by: all of it where the block falls.
    pub moved: f64,
    /// Penalty with which it hardly leans [Pa].
    pub penalty_pa: f64,
}

impl fmt::Display for Lean {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { block, blocks_on_it, inside_m, m, moved, penalty_pa } = self;
        let inside = length(*inside_m);
        let (on_it, them) = match blocks_on_it {
            0 => (String::new(), "it"),
            on_it => (format!(" and of {} on it", counted(*on_it, "block", "blocks")), "them"),
        };
        write!(
            f,
            "the weight of block `{block}`{on_it}, with the forces on {them}, acts {inside} inside the edge of its base, and contact is too soft there: "
        )?;
        match *moved < 1.0 {
            true => write!(
                f,
                "the block leans, and its weight moves {:.1} % of the way to the edge, limit {:.0} %",
                100.0 * moved,
                100.0 * MOST_MOVED
            )?,
            false => write!(f, "the block falls, although a rigid edge would hold it")?,
        }
        match *m < MOST_RAISED * ADVISED {
            true => write!(f, ": raise penalty_pa to {penalty_pa:.0e}"),
            false => write!(f, ", but so close to the edge that no penalty decides whether it stands"),
        }
    }
}

/// Part of d that a force moves by, and M; all of d where the block falls.
fn moved(Pressed { normal_n, inside_m, width_m, across_m, arm_m }: Pressed, soft_m_pa: f64) -> (f64, f64) {
    let m = normal_n * arm_m * soft_m_pa / (9.0 * width_m * inside_m.powi(3));
    let (r, eccentric_m) = (54.0 * m * (inside_m / across_m).powi(3), 0.5 * across_m - inside_m);
    if 6.0 * eccentric_m < (1.0 - r) * across_m {
        return (r * eccentric_m / ((1.0 - r) * inside_m), m);
    }
    (if m < FALLS { 1.0 - left(m) } else { 1.0 }, m)
}

/// x: the part of d that is left.
fn left(m: f64) -> f64 {
    let (mut low, mut high) = (2.0 / 3.0, 1.0);
    for _ in 0..50 {
        let x = 0.5 * (low + high);
        if x * x * (1.0 - x) > m { low = x } else { high = x }
    }
    low
}

/// The free block whose force moves by the largest part at the start; none without gravity, of potentials other than `Smooth`, or where none moves by more than
/// [`MOST_MOVED`].
pub fn worst(scene: &Scene, simulation: &Simulation) -> Option<Lean> {
    let Some(Contact::Potential { penalty_pa, potential: Potential::Smooth { reference_m }, .. }) =
        scene.contact
    else {
        return None;
    };
    let gravity = Vec3::from(scene.gravity_m_s2);
    let is_free = |block: &BlockId| {
        let name = &simulation.blocks().names[block.index()];
        let is_held = scene.supports.iter().any(|support| matches(&support.block, name));
        simulation.shape(*block).kind != BodyKind::Fixed && !is_held
    };
    let free: Vec<BlockId> = simulation.blocks().ids().filter(is_free).collect();
    if gravity == Vec3::zeros() || free.len() > MOST_BLOCKS {
        return None;
    }
    let bases: Vec<(BlockId, Base)> =
        free.into_iter().filter_map(|block| Some((block, Base::of(simulation, block, &gravity)?))).collect();
    let lean = |(block, base): &(BlockId, Base)| {
        // A block that rests on several others is left out, since how it divides its weight among them is not known.
        let stack = with_all_on_it(&bases, *block).unwrap_or_else(|| vec![*block]);
        let soft_m_pa = reference_m / penalty_pa;
        let leans = pulls(scene, simulation, &stack).into_iter().filter_map(|pulls| {
            let edges = base.pressed(&pulls).into_iter();
            let over_edges = edges.map(|pressed| (pressed.inside_m, moved(pressed, soft_m_pa)));
            let (inside_m, (moved, m)) =
                over_edges.max_by(|(_, a), (_, b)| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)))?;
            match base.moved_outwards(&pulls, soft_m_pa) {
                Some((farther, way_m)) if farther > 1.05 * moved => Some((farther, m, way_m, Some(pulls))),
                _ => Some((moved, m, inside_m, None)),
            }
        });
        let (moved, m, inside_m, over_corner) = leans
            .max_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)))
            .filter(|at| at.0 > MOST_MOVED)?;
        let advised_pa = over_corner.map_or(penalty_pa * m / ADVISED, |pulls| {
            let moved = |penalty_pa: f64| base.moved_outwards(&pulls, reference_m / penalty_pa);
            least_from(penalty_pa, |penalty_pa| moved(penalty_pa).is_some_and(|at| at.0 <= ADVISED))
        });
        let (block, blocks_on_it) = (simulation.blocks().names[block.index()].clone(), stack.len() - 1);
        let m = ADVISED * advised_pa / penalty_pa;
        Some(Lean { block, blocks_on_it, inside_m, m, moved, penalty_pa: advised_pa })
    };
    bases.iter().filter_map(lean).max_by(|a, b| a.moved.total_cmp(&b.moved).then(a.m.total_cmp(&b.m)))
}

/// The weights and the forces of the scene on blocks, at the start and at each row of the tables of these.
fn pulls(scene: &Scene, simulation: &Simulation, stack: &[BlockId]) -> Vec<Vec<Pull>> {
    let blocks = simulation.blocks();
    let gravity = Vec3::from(scene.gravity_m_s2);
    let (mut weights, mut forces) = (Vec::new(), Vec::new());
    for &block in stack {
        let (shape, name) = (simulation.shape(block), &blocks.names[block.index()]);
        let centre = shape.operator.center(&blocks.rest_position[blocks.nodes_of(block)]);
        weights.push((centre, shape.operator.mass_kg * gravity));
        let on_it = scene.forces.iter().filter(|force| matches(&force.block, name));
        forces.extend(on_it.map(|force| (centre, force)));
    }
    let rows = forces.iter().flat_map(|(_, force)| force.factor.iter().map(|row| row.time_s));
    let at = |time_s: f64| {
        let pull = |(centre, force): &(Vec3, &Force)| {
            let place = force.at_m.map_or(*centre, |at_m| Vec3::from(at_m) - blocks.origin_m);
            let factor = build::table(&force.factor).map_or(1.0, |table| table.at(time_s));
            (place, factor * Vec3::from(force.force_n))
        };
        weights.iter().copied().chain(forces.iter().map(pull)).collect()
    };
    std::iter::once(0.0).chain(rows).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Model;

    /// Blocks on a floor, under gravity with a level part, and with forces.
    fn text(penalty_pa: f64, level_m_s2: f64, blocks: &str, forces: &str) -> String {
        format!(
            "(title: \"t\", time: (step_s: 1e-3, end_s: 1), gravity_m_s2: ({level_m_s2}, 0, -9.81),
             materials: [(name: \"rock\", young_pa: 2e10, poisson: 0.25, density_kg_m3: 2500)],
             blocks: [(name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (4, 3, 1), cells: (2, 1, 1)), at_m: (-2, -1, -1)), {blocks}],
             forces: [{forces}],
             contact: Potential(penalty_pa: {penalty_pa}, potential: Smooth(reference_m: 1), friction: (friction_deg: 60)))"
        )
    }

    fn leaning(text: &str) -> Option<Lean> {
        let loaded = ndda_io::read::load_text("t.ron", text, &[], None).unwrap();
        let scene = loaded.scene.clone();
        worst(&scene, &Model::new(loaded, std::path::Path::new(".")).unwrap().simulation)
    }

    /// A column of 1 × 1 × 4 m, its lower corner so far from that of a floor.
    fn pushed(penalty_pa: f64, level_m_s2: f64, at_x_m: f64, forces: &str) -> Option<Lean> {
        let column = format!(
            "(name: \"column\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 4), cells: (1, 1, 1)), at_m: ({at_x_m}, 0, 0))"
        );
        leaning(&text(penalty_pa, level_m_s2, &column, forces))
    }

    fn found(penalty_pa: f64, level_m_s2: f64, at_x_m: f64) -> Option<Lean> {
        pushed(penalty_pa, level_m_s2, at_x_m, "")
    }

    #[test]
    fn a_weight_near_an_edge_is_measured_by_its_distance_from_it() {
        // tan α = 0.2: the foot is 0.1 m from the edge.
        let lean = found(2e8, 0.2 * 9.81, 0.0).unwrap();
        let exact = 2500.0 * 4.0 * 9.81 * 2.0 * 1.04 / (9.0 * 2e8 * 1e-3);
        assert!(
            (lean.inside_m - 0.1).abs() < 1e-9 && (lean.m / exact - 1.0).abs() < 1e-6,
            "{lean:?}, {exact}"
        );
        assert!(lean.to_string().contains("100.0 mm inside the edge"), "{lean}");
        assert_eq!(found(1e10, 0.2 * 9.81, 0.0), None, "contact is stiff");
        assert_eq!(
            found(2e8, 0.0, 0.0),
            None,
            "its weight acts in the middle of a base that is stiff enough"
        );
        assert_eq!(found(2e8, 0.3 * 9.81, 0.0), None, "its weight acts beyond the edge, so that it topples");
    }

    #[test]
    fn a_force_moves_the_foot_of_a_weight_as_a_level_part_of_gravity_does() {
        let level = found(2e8, 0.2 * 9.81, 0.0).unwrap();
        let force_n = 2500.0 * 4.0 * 0.2 * 9.81;
        // Through the mass centre; on a point at its height; with a factor over time; and where it pushes with half the force at twice the height.
        for force in [
            format!("(block: \"column\", force_n: ({force_n}, 0, 0))"),
            format!("(block: \"column\", at_m: (0.5, 0.5, 2), force_n: ({force_n}, 0, 0))"),
            format!(
                "(block: \"col*\", force_n: ({force_n}, 0, 0), factor: [(time_s: 0, factor: 0), (time_s: 1, factor: 1), (time_s: 2, factor: 0.5)])"
            ),
        ] {
            let pushed = pushed(2e8, 0.0, 0.0, &force).unwrap();
            assert!(
                (pushed.inside_m - 0.1).abs() < 1e-9 && (pushed.m / level.m - 1.0).abs() < 1e-9,
                "{pushed:?}, {level:?}"
            );
        }
        let high = format!("(block: \"column\", at_m: (0, 0.5, 4), force_n: ({}, 0, 0))", 0.5 * force_n);
        let high = pushed(2e8, 0.0, 0.0, &high).unwrap();
        // Arm: h for the weight, and 0.1 × 0.9 m for the force, which acts 0.9 m behind the foot.
        let exact = 2500.0 * 4.0 * 9.81 * (2.0 + 0.1 * 0.9) / (9.0 * 2e8 * 1e-3);
        assert!(
            (high.inside_m - 0.1).abs() < 1e-9 && (high.m / exact - 1.0).abs() < 1e-9,
            "{high:?}, {exact}"
        );
    }

    /// Gravity that is tilted by 0.05 moves the foot by 0.1 m of the middle: R = 0.3 takes it 0.0429 m on, of 0.4 m to the edge; beyond R = 0.511 it falls. Upright, R = 1 decides.
    #[test]
    fn a_weight_in_the_middle_third_counts_by_the_tilt_of_the_whole_base() {
        let at = |r: f64, level: f64| {
            let weight_n = 2500.0 * 4.0 * 9.81;
            found(6.0 * weight_n * 2.0 * (1.0 + level * level) / r, level * 9.81, 0.0)
        };
        let lean = at(0.3, 0.05).unwrap();
        assert!(
            (lean.inside_m - 0.4).abs() < 1e-9 && (lean.moved - 0.3 / 0.7 * 0.1 / 0.4).abs() < 1e-9,
            "{lean:?}"
        );
        assert!(at(0.51, 0.05).unwrap().moved < 1.0 && at(0.512, 0.05).unwrap().moved == 1.0);
        assert!(at(0.99, 0.0).is_none() && at(1.01, 0.0).unwrap().moved == 1.0);
        let advised = found(lean.penalty_pa, 0.05 * 9.81, 0.0);
        assert!(advised.is_none(), "{advised:?}");
    }

    /// A joint across a column changes nothing: its lower part bears all of the weight.
    #[test]
    fn blocks_that_rest_on_a_block_count_with_it() {
        let column = "(name: \"column\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 4), cells: (1, 1, 1)), at_m: (0, 0, 0))";
        let drum = |k: usize| {
            format!(
                "(name: \"drum_{k}\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, {k}))"
            )
        };
        let drums = [0, 1, 2, 3].map(drum).join(", ");
        // Gravity alone, and with a force on the uppermost one.
        for (level_m_s2, force) in [
            (0.2 * 9.81, String::new()),
            (
                0.0,
                format!(
                    "(block: \"NAME\", at_m: (0.5, 0.5, 3.5), force_n: ({}, 0, 0))",
                    2500.0 * 4.0 * 0.2 * 9.81 * 2.0 / 3.5
                ),
            ),
        ] {
            let [whole, parted] = [(column, "column"), (drums.as_str(), "drum_3")].map(|(blocks, name)| {
                let text = text(2e8, level_m_s2, blocks, &force.replace("NAME", name));
                leaning(&text).unwrap()
            });
            assert_eq!((parted.block.as_str(), parted.blocks_on_it), ("drum_0", 3));
            assert!((parted.m / whole.m - 1.0).abs() < 1e-9, "{parted:?}, {whole:?}");
            let words = "the weight of block `drum_0` and of 3 blocks on it, with the forces on them, acts 100.0 mm inside";
            assert!(parted.to_string().starts_with(words), "{parted}");
        }
    }

    /// Over a corner of 90° a triangle bears: y³ (1 − y) = 3 N h L₀/(16 k_n d⁴) for the part y of d that is left, up to 27/256.
    #[test]
    fn over_a_corner_a_triangle_bears_and_gives_way_more() {
        let column = "(name: \"column\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 4), cells: (1, 1, 1)), turns: [(axis: (0, 0, 1), angle_deg: 45)])";
        let (inside_m, weight_n) = (0.02_f64.sqrt(), 2500.0 * 4.0 * 9.81);
        let tangent = 0.5 * (0.5_f64.sqrt() - inside_m);
        let at = |m: f64| {
            let penalty_pa = 3.0 * weight_n * 2.0 * (1.0 + tangent * tangent) / (16.0 * inside_m.powi(4) * m);
            leaning(&text(penalty_pa, 9.81 * tangent, column, ""))
        };
        let lean = at(0.08).unwrap();
        let y = 1.0 - lean.moved;
        assert!(
            (lean.inside_m - inside_m).abs() < 1e-9 && (y.powi(3) * (1.0 - y) / 0.08 - 1.0).abs() < 1e-6,
            "{lean:?}"
        );
        assert!(at(0.105).unwrap().moved < 0.3 && at(0.106).unwrap().moved == 1.0);
        let advised = leaning(&text(at(0.106).unwrap().penalty_pa, 9.81 * tangent, column, ""));
        assert!(advised.is_none(), "{advised:?}");
    }

    /// A slab of 2 × 1 × 1 m whose weight acts 0.18 m inside a long edge and 0.2 m inside a short one, over which it moves more.
    #[test]
    fn the_edge_over_which_a_weight_moves_most_need_not_be_the_nearest() {
        let slab = "(name: \"slab\", material: \"rock\", body: Rigid, shape: Box(size_m: (2, 1, 1), cells: (1, 1, 1)))";
        let weight_n = 2500.0 * 2.0 * 9.81;
        let force = format!("(block: \"slab\", force_n: ({}, {}, 0))", 1.6 * weight_n, 0.64 * weight_n);
        let [short, long] = [(0.5 + 1.6 * 0.8, 1.0, 0.2_f64), (0.5 + 0.64 * 0.32, 2.0, 0.18)]
            .map(|(arm_m, width_m, inside_m)| weight_n * arm_m / (9.0 * width_m * inside_m.powi(3)));
        let lean = leaning(&text(short / 0.1, 0.0, slab, &force)).unwrap();
        assert!(long / short < 0.3 && lean.moved >= 1.0 - left(0.1) - 1e-6, "{lean:?}");
    }

    #[test]
    fn a_scene_that_has_settled_is_judged_by_how_it_was_drawn() {
        let column = "(name: \"column\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 4), cells: (1, 1, 1)), at_m: (0, 0, 0))";
        let loaded =
            ndda_io::read::load_text("t.ron", &text(2e8, 0.2 * 9.81, column, ""), &[], None).unwrap();
        let scene = loaded.scene.clone();
        let mut simulation = Model::new(loaded, std::path::Path::new(".")).unwrap().simulation;
        let drawn = worst(&scene, &simulation);
        simulation.settle(&ndda_solver::Settle::new(1e-6, 100_000)).unwrap();
        assert!(drawn.is_some() && worst(&scene, &simulation) == drawn, "{drawn:?}");
    }

    #[test]
    fn the_edge_is_that_of_what_a_block_rests_on() {
        // The floor ends at x = 2: 0.55 m of the base lie on it.
        let lean = found(2e8, 0.0, 1.45).unwrap();
        assert!((lean.inside_m - 0.05).abs() < 1e-9, "{lean:?}");
        assert!(lean.to_string().contains("the block falls"), "{lean}");
    }
}
