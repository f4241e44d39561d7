//! Runs of scenes, and how far two of them are apart.

use std::ops::ControlFlow;

use ndda::Model;
use ndda::build;
use ndda::run::schedule::is_due;
use ndda_mesh::Vec3;
use ndda_solver::{Simulation, Sink, SinkError, View};

use crate::generator::build;
use crate::random::Random;

/// Rows that `history.csv` has unless a scene says otherwise.
pub const ROWS: u64 = 1000;

/// Samples a run as `ndda run` does.
struct Rows {
    until: u64,
    steps: u64,
    rows: u64,
}

impl Sink for Rows {
    fn wants_sample(&self, step: u64) -> bool {
        is_due(step, self.steps, self.rows)
    }

    fn step_done(&mut self, view: &mut View) -> Result<ControlFlow<()>, SinkError> {
        let ends = view.simulation.state().step >= self.until;
        Ok(if ends { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    }
}

/// Runs up to a step, as one of `steps` in all; gives the cause where the run stops.
pub fn run_to(simulation: &mut Simulation, step: u64, steps: u64, rows: u64) -> Option<String> {
    let mut sink = Rows { until: step, steps, rows };
    let begun = simulation.state().step > 0;
    let sinks: &mut [&mut dyn Sink] = &mut [&mut sink];
    let ended = match begun {
        true => ndda_solver::resume(simulation, steps, sinks),
        false => ndda_solver::run(simulation, steps, sinks),
    };
    ended.err().map(|error| error.to_string())
}

/// A scene that has been run to its end, and why it stopped.
pub fn run(text: &str) -> (Model, Option<String>) {
    let mut ready = build(text).unwrap_or_else(|errors| panic!("{errors}\n{text}"));
    let steps = build::steps(&ready.loaded.scene.time);
    let stopped = run_to(&mut ready.simulation, steps, steps, ROWS);
    (ready, stopped)
}

/// Places [m] and velocities [m/s] of all nodes.
#[derive(Clone)]
pub struct Motion {
    pub position: Vec<Vec3>,
    pub velocity: Vec<Vec3>,
}

impl Motion {
    pub fn of(simulation: &Simulation) -> Self {
        let (state, origin_m) = (simulation.state(), simulation.blocks().origin_m);
        Self {
            position: state.position.iter().map(|x| x + origin_m).collect(),
            velocity: state.velocity.clone(),
        }
    }

    /// Largest difference of places over a length, and of velocities over a speed.
    pub fn apart(&self, other: &Self, length_m: f64, speed_m_s: f64) -> f64 {
        let largest =
            |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        let places = largest(&self.position, &other.position) / length_m;
        places.max(largest(&self.velocity, &other.velocity) / speed_m_s)
    }

    /// Largest speed [m/s].
    pub fn speed_m_s(&self) -> f64 {
        self.velocity.iter().map(|v| v.norm()).fold(0.0, f64::max)
    }
}

/// Displaces every block by a random vector and pushes it by another; blocks that are fixed stay.
pub fn disturb(simulation: &mut Simulation, length_m: f64, speed_m_s: f64) {
    let mut snapshot = simulation.snapshot();
    let mut random = Random::new(7);
    for block in simulation.blocks().ids() {
        let (place, push) = (random.vector(length_m), random.vector(speed_m_s));
        if !simulation.shape(block).is_free() {
            continue;
        }
        for node in simulation.blocks().nodes_of(block) {
            snapshot.state.position[node] += Vec3::from(place);
            snapshot.state.velocity[node] += Vec3::from(push);
        }
    }
    simulation.restore(snapshot).expect("a snapshot of this simulation");
}

/// Longest side of all blocks together [m].
pub fn extent_m(simulation: &Simulation) -> f64 {
    let nodes = &simulation.blocks().rest_position;
    let (low, high) = nodes.iter().fold((nodes[0], nodes[0]), |(low, high), x| (low.inf(x), high.sup(x)));
    (high - low).amax()
}
