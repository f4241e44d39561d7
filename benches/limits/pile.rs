//! The step of a pile against the sum of what it cannot do without: its hits, its rejected candidates, its solves.

use std::hint::black_box;

use ndda::machine;
use ndda_contact::ContactInput;
use ndda_contact::affine::ConvexBlocks;
use ndda_contact::broad_phase::Candidates;
use ndda_contact::integration::RegionQueue;
use ndda_contact::integration::TetFrame;
use ndda_mesh::Vec3;
use ndda_mesh::geometry::triangle_area_vector;
use ndda_solver::Simulation;
use pulp::Arch;

use crate::machine::{Clock, read_gb_s};
use crate::piles::{self, fallen};
use crate::{header, row};

/// Hits and rejects that are timed by themselves.
const SAMPLE: usize = 1024;
/// Steps that are timed.
const STEPS: u32 = 40;
/// Blocks that one reading of an inverse serves, and the doubles in one of its rows.
const EIGHT: usize = 8;

/// Prints the table. The cubes have the potential of the elements, whose kernel the other table is about.
pub fn table(clock: &Clock) {
    header(
        "step",
        &[
            "scene",
            "candidates",
            "hits",
            "ns a hit",
            "ns a reject",
            "hits",
            "rejects",
            "solves",
            "sum",
            "step",
            "step over sum",
        ],
    );
    let scenes: &[&str] = if clock.measured { &["pile_125", "pile_1000"] } else { &["pile_125"] };
    for scene in scenes {
        let mut simulation = fallen(scene, &["contact.potential=Element"]);
        steps(&mut simulation, if clock.measured { piles::STEPS } else { 1 });
        let (step_ms, candidates) = steps(&mut simulation, if clock.measured { STEPS } else { 1 });
        let looks = Looks::of(&simulation);
        let (hit_ns, reject_ns) = (looks.hit_ns(clock), looks.reject_ns(clock));
        let (hits, rejects) = (looks.hits.len() as f64, candidates - looks.hits.len() as f64);
        let parts = [1e-6 * hits * hit_ns, 1e-6 * rejects * reject_ns, solves_ms(clock, &simulation)];
        let sum: f64 = parts.iter().sum();
        let mut cells = vec![scene.to_string(), format!("{candidates:.0}"), format!("{hits:.0}")];
        cells.extend([hit_ns, reject_ns].map(|ns| format!("{ns:.1}")));
        cells.extend(parts.iter().chain([&sum, &step_ms]).map(|ms| format!("{ms:.3} ms")));
        cells.push(format!("{:.1}", step_ms / sum));
        row("step", &cells);
    }
}

/// Mean processor time of a step [ms], and mean number of candidates.
fn steps(simulation: &mut Simulation, steps: u32) -> (f64, f64) {
    let now_s = || machine::processor_time_s().unwrap_or(f64::NAN);
    let (start_s, mut candidates) = (now_s(), 0);
    (0..steps).for_each(|_| candidates += simulation.step().expect("a step").contact.candidate_pairs);
    (1e3 * (now_s() - start_s) / f64::from(steps), candidates as f64 / f64::from(steps))
}

/// Reading the inverses of all blocks, those of congruent neighbours once for eight of them [ms].
fn solves_ms(clock: &Clock, simulation: &Simulation) -> f64 {
    let mut ns = 0.0;
    for plan in simulation.plan().factors {
        assert_eq!(plan.solver, "dense inverse", "cubes of a pile are inverted");
        let bytes = 8 * EIGHT * plan.unknowns.div_ceil(EIGHT) * plan.unknowns;
        let reads = plan.blocks - plan.together + plan.together.div_ceil(EIGHT);
        ns += (reads * bytes) as f64 / read_gb_s(clock, bytes);
    }
    1e-6 * ns
}

/// Candidate pairs and overlapping pairs of contact at the blocks' present positions.
struct Looks {
    frames: Vec<TetFrame>,
    triangles: Vec<[Vec3; 3]>,
    /// λ, slopes of φ, and the area of the triangle, for each hit.
    hits: Vec<([[f64; 3]; 4], [f64; 4], f64)>,
    /// Triangle and frame of each candidate that is none.
    rejects: Vec<(u32, u32)>,
}

impl Looks {
    fn of(simulation: &Simulation) -> Self {
        let (blocks, state) = (simulation.blocks(), simulation.state());
        let mut candidates = Candidates::default();
        candidates.update(
            &ContactInput::new(blocks, &state.position, &state.velocity, simulation.step_s()),
            &ConvexBlocks::default(),
        );
        let frame = |(tet, order): (&_, &[u8; 4])| {
            TetFrame::in_order(&blocks.tet_corners(*tet, &state.position), order)
        };
        let frames: Vec<TetFrame> = candidates.tets.iter().zip(&candidates.order).map(frame).collect();
        let mut looks = Self { frames, triangles: Vec::new(), hits: Vec::new(), rejects: Vec::new() };
        for facet in candidates.facets() {
            let corners = blocks.triangle_corners(facet.triangle, &state.position);
            let area_vector = triangle_area_vector(&corners);
            looks.triangles.push(corners);
            for slot in facet.tets().map(|tet| candidates.slot_of(tet)) {
                let frame = &looks.frames[slot as usize];
                match frame.lambda_inside(&corners) {
                    Some(lambda) => {
                        let slopes = frame.slopes(&area_vector.normalize());
                        looks.hits.push((lambda, slopes, area_vector.norm()));
                    }
                    None => looks.rejects.push((looks.triangles.len() as u32 - 1, slot)),
                }
            }
        }
        looks
    }

    /// Integrals of hits, per hit [ns].
    fn hit_ns(&self, clock: &Clock) -> f64 {
        let (arch, mut batches, hits) = (Arch::new(), RegionQueue::default(), sample(&self.hits));
        let ns = clock.least_ns(|| {
            for (pair, (lambda, slopes, area)) in (0..).zip(black_box(&hits)) {
                batches.push_element(arch, pair, *area, lambda, slopes);
            }
            batches.finish(arch, |part| _ = black_box(part.area));
        });
        ns / hits.len().max(1) as f64
    }

    /// Looking at candidates that are none, per candidate [ns].
    fn reject_ns(&self, clock: &Clock) -> f64 {
        let place =
            |(triangle, frame): (u32, u32)| (self.triangles[triangle as usize], self.frames[frame as usize]);
        let rejects: Vec<_> = sample(&self.rejects).into_iter().map(place).collect();
        let inside = |(corners, frame): &&([Vec3; 3], TetFrame)| frame.lambda_inside(corners).is_some();
        let ns = clock.least_ns(|| assert_eq!(black_box(&rejects).iter().filter(inside).count(), 0));
        ns / rejects.len().max(1) as f64
    }
}

/// Some of many, from all over, so few that they stay in the cache.
fn sample<T: Copy>(all: &[T]) -> Vec<T> {
    all.iter().step_by(all.len().div_ceil(SAMPLE).max(1)).copied().collect()
}
