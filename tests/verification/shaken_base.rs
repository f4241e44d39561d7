//! A block on a shaken base slides as Newmark's sliding block does (Newmark 1965): with the base while friction can
//! hold it, else decelerated by μ g relative to the ground.

use std::f64::consts::PI;
use std::fmt::Write;

use ndda_mesh::BlockId;

use crate::evidence::Answer::AtMost;
use crate::evidence::row;

const FRICTION_DEG: f64 = 20.0;
const GRAVITY: f64 = 9.8;
const AMPLITUDE: f64 = 6.0;
const FREQUENCY: f64 = 2.0;

/// Steps of the ordinary differential equation in one of the run.
const FINER: usize = 200;

/// Slip of a rigid block after each step Δt, by small steps of the ordinary differential equation.
fn newmark_slips(steps: usize, step_s: f64) -> Vec<f64> {
    let yields = FRICTION_DEG.to_radians().tan() * GRAVITY;
    let dt = step_s / FINER as f64;
    let (mut slip, mut rate, mut slips) = (0.0f64, 0.0f64, Vec::new());
    for i in 0..(steps * FINER) as u32 {
        let base = AMPLITUDE * (2.0 * PI * FREQUENCY * (f64::from(i) + 0.5) * dt).sin();
        // Acceleration of the block relative to the base: friction opposes the slip.
        let friction = if rate == 0.0 { base.clamp(-yields, yields) } else { -yields * rate.signum() };
        let next = rate + dt * (friction - base);
        // A slip that would change its sign within a step ends there.
        rate = if rate * next < 0.0 { 0.0 } else { next };
        slip += dt * rate;
        if (i + 1).is_multiple_of(FINER as u32) {
            slips.push(slip);
        }
    }
    slips
}

#[test]
fn a_block_on_a_shaken_base_slips_as_newmarks_sliding_block() {
    let (step_s, steps) = (2e-4, 7500);
    let exact = newmark_slips(steps, step_s);
    let largest = exact.iter().fold(0.0f64, |most, slip| most.max(slip.abs()));
    let mut record = String::from("time_s,acceleration_m_s2\n");
    for i in 0..=3000 {
        let t = f64::from(i) * 5e-4;
        writeln!(record, "{t},{}", AMPLITUDE * (2.0 * PI * FREQUENCY * t).sin()).unwrap();
    }
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("quake.csv"), record).unwrap();
    for body in ["Rigid", "Elastic"] {
        let text = format!(
            "(title: \"shaken\", time: (step_s: {step_s}, end_s: 1.5), gravity_m_s2: (0, 0, -{GRAVITY}),
              settle: (most_steps: 20000, tolerance: 1e-3),
              materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.2, density_kg_m3: 2500)],
              blocks: [
                (name: \"base\", material: \"rock\", shape: Box(size_m: (4, 1, 0.5), cells: (8, 2, 1)), body: Fixed),
                (name: \"block\", material: \"rock\", shape: Box(size_m: (0.4, 0.4, 0.1), cells: (2, 2, 1)), body: {body},
                 at_m: (1.8, 0.3, 0.5)),
              ],
              supports: [(block: \"base\", on: All, hold: Acceleration(file: \"quake.csv\", direction: (1, 0, 0)))],
              contact: Potential(penalty_pa: 1e9, potential: Smooth(reference_m: 1), friction: (friction_deg: {FRICTION_DEG})))"
        );
        let loaded = ndda_io::read::load_text("case.ron", &text, &[], None).unwrap_or_else(|e| panic!("{e}"));
        let blocks = ndda::build::blocks(&loaded.scene, folder.path()).unwrap();
        let mut simulation = ndda::build::simulation(&loaded.scene, blocks, folder.path()).unwrap();
        simulation.settle(&ndda_solver::Settle::new(1e-3, 20_000)).unwrap();
        let start = simulation.start_position().to_vec();
        let mut error = 0.0f64;
        for exact in &exact {
            simulation.step().unwrap();
            let mean = |block: BlockId| {
                let nodes = simulation.blocks().nodes_of(block);
                let moved = nodes.clone().map(|n| simulation.state().position[n].x - start[n].x);
                moved.sum::<f64>() / nodes.len() as f64
            };
            error = error.max((mean(BlockId(1)) - mean(BlockId(0)) - exact).abs());
        }
        row(
            "shaken base",
            &format!("largest error of the slip over the largest slip, {body} block"),
            error / largest,
            AtMost(5e-3),
        );
    }
}
