//! Whether blocks may pass through each other between two evaluations of contact.
//!
//! Contact sees the blocks at instants Δt apart. Two blocks that approach by less than the width of the thinner one in a step
//! overlap in at least one of these instants, so they cannot change sides unnoticed. For a pair that may meet in the step the
//! criterion is therefore
//!
//! ```text
//! r = Δt · max |v_a − v_b| / min(w_a, w_b)
//! ```
//!
//! with the width w of a block as its contact resolves it ([`ContactModel::width_m`]). Two blocks may meet if the boxes that they
//! sweep in the step touch; whether they were candidates of contact before does not matter.

use ndda_contact::{ContactInput, ContactModel};
use ndda_mesh::geometry::{Aabb, tet_heights};
use ndda_mesh::{BlockId, BlockSet, Vec3};

use crate::bodies::kind::BodyKind;
use crate::diagnostics::worst::Worst;
use crate::step::Simulation;

/// Travel over width that needs no look at single pairs: a quarter of what is allowed. Below it an upper bound is reported.
const FINE: f64 = 0.125;

/// Motion of one block in a step.
#[derive(Clone, Copy, Debug)]
struct Sweep {
    /// Width of the block as contact resolves it [m].
    width_m: f64,
    /// Whether its motion is prescribed.
    is_fixed: bool,
    /// Mass, infinite where the motion is prescribed [kg].
    mass_kg: f64,
    /// Mean velocity of its nodes, and the largest deviation from it [m/s].
    velocity_m_s: Vec3,
    spread_m_s: f64,
    /// Box that holds the block during the step [m].
    bounds: Aabb,
}

/// Widths of all blocks, and memory to compare their motions.
#[derive(Debug, Default)]
pub(crate) struct Travel {
    /// Smallest height of all tetrahedra of blocks that are there [m].
    smallest_height_m: f64,
    /// Smallest width of all blocks that are there [m].
    smallest_width_m: f64,
    /// One entry per block; empty until a step is long enough to need it.
    sweeps: Vec<Sweep>,
    /// The blocks that are there, in the order of the last look.
    order: Vec<u32>,
    /// Whether the pairs that touch are noted, and those of the last step, the block of the smaller number first.
    pub(crate) notes_touching: bool,
    pub(crate) touching: Vec<(BlockId, BlockId)>,
}

impl Travel {
    pub(crate) fn new(smallest_height_m: f64) -> Self {
        Self { smallest_height_m, ..Self::default() }
    }

    /// Notes that two blocks touch; facets of a pair mostly come one after the other.
    pub(crate) fn note_touching(&mut self, a: BlockId, b: BlockId) {
        let pair = (a.min(b), a.max(b));
        if self.touching.last() != Some(&pair) {
            self.touching.push(pair);
        }
    }

    /// Takes the blocks that are there for others than before.
    pub(crate) fn begin_anew(&mut self, smallest_height_m: f64) {
        self.smallest_height_m = smallest_height_m;
        self.sweeps.clear();
    }

    fn place_widths(&mut self, simulation: &Simulation, model: &dyn ContactModel) {
        let blocks = &simulation.problem.blocks;
        let sweep = |block| Sweep {
            width_m: model.width_m(blocks, block).unwrap_or_else(|| surface_height_m(blocks, block)),
            is_fixed: simulation.shape(block).kind == BodyKind::Fixed,
            mass_kg: match simulation.shape(block).kind {
                BodyKind::Fixed => f64::INFINITY,
                _ => simulation.shape(block).operator.mass_kg,
            },
            velocity_m_s: Vec3::zeros(),
            spread_m_s: 0.0,
            bounds: Aabb::empty(),
        };
        self.sweeps = blocks.ids().map(sweep).collect();
        let present = blocks.ids().filter(|block| !simulation.is_absent(*block));
        self.order = present.map(|block| block.0).collect();
        let widths_m = self.order.iter().map(|&block| self.sweeps[block as usize].width_m);
        self.smallest_width_m = widths_m.fold(f64::INFINITY, f64::min);
    }

    fn place_sweeps(&mut self, simulation: &Simulation) {
        for (block, sweep) in simulation.problem.blocks.ids().zip(&mut self.sweeps) {
            let nodes = simulation.problem.blocks.nodes_of(block);
            let velocity = &simulation.state.velocity[nodes.clone()];
            let mean = velocity.iter().sum::<Vec3>() / nodes.len() as f64;
            let reach_m = simulation.bodies[block.index()].report.speed_m_s * simulation.part_s;
            sweep.velocity_m_s = mean;
            sweep.spread_m_s = velocity.iter().map(|v| (v - mean).norm()).fold(0.0, f64::max);
            // From x* before the step to x* after it: each is less than one Δt v away from x.
            sweep.bounds = Aabb::around(&simulation.state.position[nodes]).inflated(reach_m);
        }
    }

    /// The largest travel over width of two blocks that may meet.
    fn worst_pair(&mut self, dt_s: f64) -> Worst {
        let mut worst = Worst { value: FINE, block: 0 };
        self.each_close_pair(|i, first, j, second| {
            let thinner = if second.width_m < first.width_m { j } else { i };
            worst.take(first.ratio(second, dt_s), thinner);
        });
        worst
    }

    /// Calls for all pairs of blocks that may meet and do not both move as prescribed, by sort and sweep along the longest side
    /// of the scene.
    fn each_close_pair(&mut self, mut meet: impl FnMut(usize, &Sweep, usize, &Sweep)) {
        let Self { sweeps, order, .. } = self;
        let mut all = Aabb::empty();
        for sweep in order.iter().map(|&i| &sweeps[i as usize]) {
            all.grow(&sweep.bounds.min);
            all.grow(&sweep.bounds.max);
        }
        let axis = (all.max - all.min).imax();
        let begin = |i: u32| sweeps[i as usize].bounds.min[axis];
        order.sort_unstable_by(|&i, &j| begin(i).total_cmp(&begin(j)).then(i.cmp(&j)));
        for (place, &i) in order.iter().enumerate() {
            let first = &sweeps[i as usize];
            let end = first.bounds.max[axis];
            for &j in order[place + 1..].iter().take_while(|&&j| begin(j) <= end) {
                let second = &sweeps[j as usize];
                if !(first.is_fixed && second.is_fixed) && first.bounds.touches(&second.bounds) {
                    meet(i as usize, first, j as usize, second);
                }
            }
        }
    }
}

impl Sweep {
    /// Δt · max |v_a − v_b| / min(w_a, w_b).
    fn ratio(&self, other: &Self, dt_s: f64) -> f64 {
        self.relative_m_s(other) * dt_s / self.width_m.min(other.width_m)
    }

    /// An upper bound of the speed of any point of one block relative to any of the other [m/s].
    fn relative_m_s(&self, other: &Self) -> f64 {
        (self.velocity_m_s - other.velocity_m_s).norm() + (self.spread_m_s + other.spread_m_s)
    }
}

/// Smallest height of the tetrahedra that have a node on the surface of their block [m].
fn surface_height_m(blocks: &BlockSet, block: BlockId) -> f64 {
    let nodes = blocks.nodes_of(block);
    let mut is_outside = vec![false; nodes.len()];
    for node in blocks.triangles[blocks.triangles_of(block)].iter().flatten() {
        is_outside[node.index() - nodes.start] = true;
    }
    let tets = blocks.tets[blocks.tets_of(block)].iter();
    let outer = tets.filter(|tet| tet.iter().any(|node| is_outside[node.index() - nodes.start]));
    let heights = outer.flat_map(|tet| tet_heights(&tet.map(|node| blocks.rest_position[node.index()])));
    heights.fold(f64::INFINITY, f64::min)
}

impl Simulation {
    /// The largest relative travel of two blocks that may meet in the step just done, over the width of the thinner one, and
    /// which that is. Up to a quarter of what is allowed an upper bound is enough, and no pair is looked at.
    pub(crate) fn travel_of_step(&mut self, speed_m_s: f64) -> Worst {
        // Two blocks at the largest speed, head on, both as thin as the smallest tetrahedron.
        let bound = 2.0 * speed_m_s * self.part_s / self.audit.travel.smallest_height_m;
        if bound <= FINE || self.contact.is_none() {
            return Worst { value: bound, block: 0 };
        }
        self.with_travel(|simulation, travel| {
            let bound = 2.0 * speed_m_s * simulation.part_s / travel.smallest_width_m;
            if bound <= FINE {
                return Worst { value: bound, block: 0 };
            }
            travel.place_sweeps(simulation);
            travel.worst_pair(simulation.part_s)
        })
    }

    /// Whether blocks that did not touch in the step just done may store more than `limit_j` in a first contact \[J\]: where two
    /// approach at v and a step may be as long as h = ω_c Δt, x is at most ½ Δt v deep before contact has acted for the first time,
    /// which stores ½ k (½ Δt v)² = ⅛ h² m v².
    pub(crate) fn may_collide_with(&mut self, h: f64, limit_j: f64) -> bool {
        if self.contact.is_none() {
            return false;
        }
        self.with_travel(|simulation, travel| {
            travel.place_sweeps(simulation);
            let mut touching = std::mem::take(&mut travel.touching);
            touching.sort_unstable();
            let mut found = false;
            travel.each_close_pair(|i, first, j, second| {
                let mass_kg = first.mass_kg.min(second.mass_kg);
                let stored_j = |speed_m_s: f64| 0.125 * h * h * mass_kg * speed_m_s * speed_m_s;
                let pair = (BlockId(i.min(j) as u32), BlockId(i.max(j) as u32));
                found = found
                    || stored_j(first.relative_m_s(second)) > limit_j
                        && touching.binary_search(&pair).is_err()
                        && simulation.closing_m_s(pair).is_none_or(|speed_m_s| stored_j(speed_m_s) > limit_j);
            });
            travel.touching = touching;
            found
        })
    }

    /// Upper bound of the speed at which two blocks that did not touch in the step just done close the gap between them [m/s];
    /// `None` if any relative velocity counts.
    fn closing_m_s(&self, pair: (BlockId, BlockId)) -> Option<f64> {
        let model = self.contact.as_ref()?;
        let (position, velocity) = (&self.scratch.contact_position, &self.state.velocity);
        model.closing_m_s(&ContactInput::new(&self.problem.blocks, position, velocity, self.part_s), pair)
    }

    /// Works on the motions of the blocks while the rest is read.
    fn with_travel<T>(&mut self, work: impl FnOnce(&Self, &mut Travel) -> T) -> T {
        let mut travel = std::mem::take(&mut self.audit.travel);
        if let Some(model) = self.contact.as_deref().filter(|_| travel.sweeps.is_empty()) {
            travel.place_widths(self, model);
        }
        let found = work(self, &mut travel);
        self.audit.travel = travel;
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::step::test_boxes::boxes;

    /// Travel of the first step of a cube that falls on a base far below, with a thin block in its way that may be left out.
    fn travel(speed_m_s: f64, leaves_out: Option<bool>) -> Worst {
        let cube = (BodyKind::Rigid, [1.0; 3], [0.0, 0.0, 0.0]);
        let base = (BodyKind::Fixed, [1.0; 3], [0.0, 0.0, -9.0]);
        let thin = (BodyKind::Fixed, [1.0, 1.0, 0.01], [0.0, 0.0, -0.09]);
        let mut setup = boxes(&if leaves_out.is_some() { vec![cube, base, thin] } else { vec![cube, base] });
        setup.contact = None;
        setup.bodies[0].velocity_m_s = -speed_m_s * Vec3::z();
        let mut simulation = Simulation::new(setup).unwrap();
        if leaves_out == Some(true) {
            simulation.leave_out(vec![false, false, true]).unwrap();
        }
        simulation.step().unwrap().travel
    }

    #[test]
    fn a_thin_block_that_is_left_out_shortens_no_step() {
        // Where a bound is enough, and where each pair is looked at.
        for speed_m_s in [1.0, 100.0] {
            let alone = travel(speed_m_s, None);
            assert!(travel(speed_m_s, Some(false)).value > alone.value, "{speed_m_s} m/s");
            assert_eq!(travel(speed_m_s, Some(true)), alone, "{speed_m_s} m/s");
        }
    }

    fn cube(x_m: f64, width_m: f64, speed_m_s: f64, dt_s: f64) -> Sweep {
        let bounds = Aabb { min: Vec3::new(x_m, 0.0, 0.0), max: Vec3::new(x_m + width_m, width_m, width_m) };
        Sweep {
            width_m,
            is_fixed: false,
            mass_kg: 1.0,
            velocity_m_s: Vec3::x() * speed_m_s,
            spread_m_s: 0.0,
            bounds: bounds.inflated(speed_m_s.abs() * dt_s),
        }
    }

    fn worst(sweeps: Vec<Sweep>, dt_s: f64) -> Worst {
        let order = (0..sweeps.len() as u32).collect();
        Travel { sweeps, order, ..Travel::default() }.worst_pair(dt_s)
    }

    #[test]
    fn it_is_the_relative_travel_over_the_width_of_the_thinner_block() {
        let dt_s = 0.01;
        let pair = |gap_m| vec![cube(0.0, 1.0, 30.0, dt_s), cube(1.0 + gap_m, 0.5, -10.0, dt_s)];
        let near = worst(pair(0.1), dt_s);
        assert!((near.value - 40.0 * dt_s / 0.5).abs() < 1e-12 && near.block == 1, "{near:?}");
        // 0.4 m nearer in a step do not close a gap of 0.5 m.
        assert_eq!(worst(pair(0.5), dt_s).value, FINE);
    }

    #[test]
    fn blocks_that_move_together_do_not_approach_and_prescribed_ones_do_not_count() {
        let dt_s = 0.01;
        let together = vec![cube(0.0, 1.0, 900.0, dt_s), cube(1.0, 1.0, 900.0, dt_s)];
        assert_eq!(worst(together, dt_s).value, FINE);
        let mut fixed = vec![cube(0.0, 1.0, 900.0, dt_s), cube(1.0, 1.0, 0.0, dt_s)];
        fixed.iter_mut().for_each(|sweep| sweep.is_fixed = true);
        assert_eq!(worst(fixed, dt_s).value, FINE);
    }

    #[test]
    fn the_sweep_finds_what_all_pairs_find() {
        let mut seed = 7u64;
        let mut random = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 11) as f64 / (1u64 << 53) as f64
        };
        for _ in 0..200 {
            let mut sweep = |_| {
                let corner = Vec3::new(6.0 * random(), 2.0 * random(), 3.0 * random());
                let size = Vec3::new(random(), random(), random());
                Sweep {
                    width_m: 0.01 + size.min(),
                    is_fixed: random() < 0.2,
                    mass_kg: 1.0,
                    velocity_m_s: Vec3::new(random(), random(), random()) * 20.0,
                    spread_m_s: random(),
                    bounds: Aabb { min: corner, max: corner + size },
                }
            };
            let sweeps: Vec<Sweep> = (0..20).map(&mut sweep).collect();
            let mut largest = FINE;
            for (i, a) in sweeps.iter().enumerate() {
                for b in &sweeps[..i] {
                    if a.bounds.touches(&b.bounds) && !(a.is_fixed && b.is_fixed) {
                        largest = f64::max(largest, a.ratio(b, 0.01));
                    }
                }
            }
            assert_eq!(worst(sweeps, 0.01).value, largest);
        }
    }
}
