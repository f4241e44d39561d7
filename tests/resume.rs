//! A run that is killed at any step and goes on in a new process has the bits of one that never was, whatever it is made of.
//!
//! Here a new simulation takes the place of the process, after each of `NDDA_KILLS` (default 10) random steps, and the
//! snapshot goes through the encoding of a checkpoint. Real kills are in `apps/ndda-cli/tests/kill_and_resume.rs`.
//! The gate takes every 13th of the 1200 cells, in which each choice of each axis occurs; `NDDA_LARGE=1` takes all.

use ndda::build;
use ndda_contact::testing::Random;
use ndda_io::read::load_text;
use ndda_solver::{Simulation, Snapshot};
use rayon::prelude::*;

const INTEGRATORS: [&str; 5] = [
    "Midpoint()",
    "Midpoint(theta: 0.7)",
    "GeneralizedAlpha(radius: 0.8)",
    "Newmark(alpha: 0.25, delta: 0.5)",
    "Newmark(alpha: 0.5, delta: 1)",
];
/// Kinds of the three blocks that move; the fourth is fixed and shaken.
const BODIES: [[&str; 3]; 4] = [["Elastic"; 3], ["Affine"; 3], ["Rigid"; 3], ["Rigid", "Elastic", "Affine"]];
const CONTACT_AT: [&str; 2] = ["Predicted", "End()"];
const POTENTIALS: [&str; 3] =
    ["Element", "Smooth(reference_m: 1)", "Volume(exponent: 2, reference_m3: 1e-3)"];
/// Without friction, on velocities, by springs, and glued; the last also with the memory of the paper.
const FRICTION: [&str; 5] = [
    "",
    "friction: (friction_deg: 30)",
    "friction: (friction_deg: 30, shear_penalty_pa_m: 1e8)",
    "friction: (friction_deg: 30, shear_penalty_pa_m: 1e8, cohesion_pa: 1e3, tension_pa: 1e3)",
    "friction: (friction_deg: 30, shear_penalty_pa_m: 1e8), memory: Element",
];
const STEPS: [&str; 2] = ["Fixed", "Auto(safety: 0.2)"];

/// Steps of each run: the blocks meet within the first ten, and part or slide later.
const RUN_STEPS: u64 = 40;
/// A row of the history, and so a sample, falls on every seventh step.
const ROW_STEPS: u64 = 7;

#[derive(Clone, Copy)]
struct Cell {
    integrator: &'static str,
    bodies: [&'static str; 3],
    contact_at: &'static str,
    potential: &'static str,
    friction: &'static str,
    step: &'static str,
}

impl Cell {
    fn all() -> Vec<Self> {
        let mut cells = Vec::new();
        for integrator in INTEGRATORS {
            for bodies in BODIES {
                for contact_at in CONTACT_AT {
                    for potential in POTENTIALS {
                        for friction in FRICTION {
                            cells.extend(STEPS.map(|step| Self {
                                integrator,
                                bodies,
                                contact_at,
                                potential,
                                friction,
                                step,
                            }));
                        }
                    }
                }
            }
        }
        cells
    }

    /// Three blocks that run into each other on a base that is shaken, pushed by a load that changes.
    fn text(&self) -> String {
        let Self { integrator, bodies: [a, b, c], contact_at, potential, friction, step } = self;
        let cube = |name: &str, body: &str, at: &str, more: &str| {
            format!(
                "(name: \"{name}\", material: \"rock\", shape: Box(size_m: (0.5, 0.4, 0.3), cells: (2, 1, 1)), body: {body},
                  at_m: {at}, {more}),"
            )
        };
        let cubes =
            cube("a", a, "(0.3, 0.3, 0.4003)", "velocity_m_s: (1, 0, -0.5), spin_rad_s: (0.5, 2, -1)")
                + &cube("b", b, "(0.81, 0.35, 0.4001)", "velocity_m_s: (-0.5, 0.1, -0.2)")
                + &cube("c", c, "(0.5, 0.3, 0.702)", "velocity_m_s: (0, 0, -0.5), spin_rad_s: (0, 0, 3)");
        format!(
            "(title: \"kill\", time: (step_s: 5e-4, end_s: 1, integrator: {integrator}, contact_at: {contact_at}, step: {step}),
              gravity_m_s2: (0, 0, -9.8),
              materials: [(name: \"rock\", young_pa: 1e8, poisson: 0.2, density_kg_m3: 2500, damping: (mass_per_s: 1))],
              blocks: [
                (name: \"base\", material: \"rock\", shape: Box(size_m: (1.7, 1.1, 0.4), cells: (2, 1, 1)), body: Fixed),
                {cubes}
              ],
              supports: [(block: \"base\", on: All, hold: Motion([(time_s: 0, displacement_m: (0, 0, 0)), (time_s: 0.02, displacement_m: (5e-3, 0, 1e-3)),
                (time_s: 0.04, displacement_m: (0, 0, 0))]))],
              forces: [(block: \"b\", force_n: (-500, 100, 0), factor: [(time_s: 0, factor: 0), (time_s: 0.01, factor: 1)])],
              contact: Potential(penalty_pa: 1e7, potential: {potential}, {friction}))"
        )
    }

    fn simulation(&self) -> Simulation {
        let text = self.text();
        let loaded =
            load_text("case.ron", &text, &[], None).unwrap_or_else(|e| panic!("{}", e.render(false)));
        let folder = std::path::Path::new(".");
        let blocks = build::blocks(&loaded.scene, folder).unwrap_or_else(|faults| panic!("{faults:?}"));
        build::simulation(&loaded.scene, blocks, folder).unwrap_or_else(|faults| panic!("{faults:?}"))
    }

    fn name(&self) -> String {
        let Self { integrator, bodies, contact_at, potential, friction, step } = self;
        format!("{integrator}, {bodies:?}, {contact_at}, {potential}, {{{friction}}}, {step}")
    }
}

/// State and ledger, digit for digit. Seconds spent are no result, and neither is the number of candidate pairs: it
/// depends on when the list of pairs was last renewed, which a new process does at once.
fn results(simulation: &Simulation) -> (Vec<u8>, serde_json::Value) {
    let Snapshot { state, ledger, .. } = simulation.snapshot();
    let mut ledger = serde_json::to_value(&ledger).expect("a ledger");
    for count in ["candidate_pairs_max", "candidate_pairs_total"] {
        ledger["worst"].as_object_mut().expect("the worst values").remove(count).expect("a count");
    }
    (postcard::to_stdvec(&state).expect("a state"), ledger)
}

/// One step, and a sample where a row is due; false when the run has stopped.
fn advance(simulation: &mut Simulation) -> bool {
    let stepped = simulation.step();
    if let Err(error) = &stepped {
        println!("{error}");
    }
    let has_stepped = stepped.is_ok();
    if has_stepped && simulation.state().step.is_multiple_of(ROW_STEPS) {
        simulation.sample().expect("a sample");
    }
    has_stepped
}

/// The simulation of the same scene in a new process.
fn resumed(cell: &Cell, simulation: &Simulation) -> Simulation {
    let bytes = postcard::to_stdvec(&simulation.snapshot()).expect("a snapshot");
    let mut next = cell.simulation();
    next.restore(postcard::from_bytes(&bytes).expect("a snapshot")).expect("the same scene");
    next
}

/// The first difference, if there is any; and how many steps had contact.
fn first_difference(cell: &Cell, kills: usize, seed: u64) -> (Option<String>, u64) {
    let (mut whole, mut broken) = (cell.simulation(), cell.simulation());
    for simulation in [&mut whole, &mut broken] {
        simulation.sample().expect("a sample");
    }
    let mut random = Random(seed);
    let mut at: Vec<u64> = (0..kills).map(|_| (RUN_STEPS as f64 * random.unit()) as u64).collect();
    at.sort_unstable();
    for step in 0..RUN_STEPS {
        if at.contains(&step) {
            broken = resumed(cell, &broken);
        }
        let (went_on, also) = (advance(&mut whole), advance(&mut broken));
        if went_on != also {
            return (Some(format!("{}: one stops at step {step}, killed at {at:?}", cell.name())), 0);
        }
        if !went_on {
            return (Some(format!("{}: both stop at step {step}", cell.name())), 0);
        }
        let ((state, ledger), (other_state, other_ledger)) = (results(&whole), results(&broken));
        if state != other_state || ledger != other_ledger {
            let what = if state != other_state { "state" } else { "ledger" };
            return (
                Some(format!("{}: the {what} differs at step {step}, killed at {at:?}", cell.name())),
                0,
            );
        }
    }
    (None, whole.invariants().contact_pairs_total)
}

#[test]
fn a_run_that_goes_on_from_its_checkpoint_has_the_bits_of_one_that_was_never_killed() {
    let kills = std::env::var("NDDA_KILLS").ok().and_then(|text| text.parse().ok()).unwrap_or(10);
    let every = if std::env::var_os("NDDA_LARGE").is_some() { 1 } else { 13 };
    let cells: Vec<Cell> = Cell::all().into_iter().step_by(every).collect();
    let run = |(seed, cell): (usize, &Cell)| first_difference(cell, kills, 1 + seed as u64);
    let found: Vec<(Option<String>, u64)> = cells.par_iter().enumerate().map(run).collect();
    let without_contact = found.iter().filter(|(differs, pairs)| differs.is_none() && *pairs == 0).count();
    let different: Vec<&String> = found.iter().filter_map(|(differs, _)| differs.as_ref()).collect();
    println!("{} of {} cells differ after {kills} kills each", different.len(), cells.len());
    different.iter().take(40).for_each(|text| println!("{text}"));
    assert!(different.is_empty() && without_contact == 0, "{without_contact} cells without contact");
}

#[test]
fn a_run_of_damped_contacts_has_the_bits_of_one_that_was_never_killed() {
    for bodies in BODIES {
        for (integrator, friction) in
            [("Midpoint()", FRICTION[1]), ("GeneralizedAlpha(radius: 0.8)", FRICTION[2])]
        {
            for step in STEPS {
                let friction = format!("restitution: 0.4, {friction}").leak();
                let potential = POTENTIALS[1];
                let cell = Cell { integrator, bodies, contact_at: CONTACT_AT[0], potential, friction, step };
                let (differs, pairs) = first_difference(&cell, 10, 3);
                assert!(differs.is_none() && pairs > 0, "{differs:?}, {pairs} pairs");
            }
        }
    }
}

#[test]
fn a_run_on_worn_opened_and_closing_joints_has_the_bits_of_one_that_was_never_killed() {
    let worn = "friction: (friction_deg: 30, shear_penalty_pa_m: 1e8, roughness: (jrc: 10, jcs_pa: 1e6, mobilised: true))";
    let opened =
        "friction: (friction_deg: 10, shear_penalty_pa_m: 1e8, dilation: (psi_deg: 8, to_slip_m: 0.1))";
    for bodies in BODIES {
        for (contact_at, potential, friction) in [
            ("Predicted", "Closure(max_closure_m: 0.02)", worn),
            ("End()", "Smooth()", worn),
            ("Predicted", "Smooth()", opened),
            ("End()", "Closure(max_closure_m: 0.02)", opened),
        ] {
            let (integrator, step) = ("Midpoint()", "Fixed");
            let cell = Cell { integrator, bodies, contact_at, potential, friction, step };
            let (differs, pairs) = first_difference(&cell, 5, 1);
            assert!(differs.is_none() && pairs > 0, "{differs:?}, {pairs} pairs in contact");
        }
    }
}
