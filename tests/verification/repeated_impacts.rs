//! Blocks that bounce down slopes: what a run with several impacts says of itself, against an eighth of its step.
//!
//! `NDDA_CASES=100 cargo test --test verification repeated_impacts -- --nocapture` says how many are right, with and without a repetition.

use ndda::Model;
use ndda::run::{Outcome, Run, Sensitivity};
use ndda::summary::LabelWord;
use ndda_contact::testing::Random;
use ndda_fem::block_operator::RigidMotion;
use ndda_mesh::BlockId;
use ndda_solver::Simulation;

use crate::evidence::Answer::AtMost;
use crate::evidence::row;

/// Largest error of a velocity that the label `accurate` allows, over the largest speed.
const PROMISE: f64 = 0.01;

/// A turned block that is thrown on a slope.
fn scene(random: &mut Random) -> (String, f64) {
    let mut between = |low: f64, high: f64| low + (high - low) * random.unit();
    let dip = between(20.0, 50.0f64).to_radians();
    let size: [f64; 3] = std::array::from_fn(|_| between(0.5, 1.0));
    let axis: [f64; 3] = std::array::from_fn(|_| between(-1.0, 1.0));
    let (angle_deg, friction_deg, restitution) =
        (between(0.0, 180.0), between(15.0, 60.0), between(0.3, 1.0));
    let spin: [f64; 3] = std::array::from_fn(|_| between(-2.0, 3.0));
    let (along, across) = (between(0.0, 2.0), between(-0.5, 0.5));
    let (penalty_pa, end_s) = (10f64.powf(between(9.3, 10.0)), between(1.0, 2.0));
    let step_s = [5e-5, 1e-4, 2e-4][(3.0 * between(0.0, 1.0)) as usize];
    let body = ["Rigid", "Rigid", "Affine"][(3.0 * between(0.0, 1.0)) as usize];
    let text = format!(
        "(title: \"bounces\", time: (step_s: @STEP@, end_s: {end_s}), gravity_m_s2: ({}, 0, {}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)],
          blocks: [
            (name: \"slope\", material: \"rock\", body: Fixed, shape: Box(size_m: (60, 20, 1), cells: (1, 1, 1)), at_m: (-5, -10, -1)),
            (name: \"b\", material: \"rock\", body: {body}, shape: Box(size_m: ({}, {}, {}), cells: (1, 1, 1)), at_m: (0, 0, 2),
             turns: [(axis: ({}, {}, {}), angle_deg: {angle_deg})], velocity_m_s: ({along}, {across}, 0), spin_rad_s: ({}, {}, {})),
          ],
          contact: Potential(penalty_pa: {penalty_pa:e}, potential: Smooth(), friction: (friction_deg: {friction_deg}), restitution: {restitution}),
          output: (frames: 0, history_rows: 2))",
        9.81 * dip.sin(), -9.81 * dip.cos(),
        size[0], size[1], size[2], axis[0], axis[1], axis[2], spin[0], spin[1], spin[2],
    );
    (text, step_s)
}

fn run(text: &str, step_s: f64, sensitivity: Sensitivity) -> Outcome {
    let text = text.replace("@STEP@", &format!("{step_s:e}"));
    let model = Model::from_text(&text).unwrap_or_else(|errors| panic!("{}", errors.render(false)));
    Run::new(model).sensitivity(sensitivity).finish(&mut []).unwrap()
}

fn motion(simulation: &Simulation) -> RigidMotion {
    let (nodes, state) = (simulation.blocks().nodes_of(BlockId(1)), simulation.state());
    let operator = &simulation.shape(BlockId(1)).operator;
    operator.rigid_motion(&state.position[nodes.clone()], &state.velocity[nodes])
}

/// Error of velocity, or of spin times half a metre, over the largest speed; none where the block is being hit as the run ends.
fn error(coarse: &mut Simulation, fine: &mut Simulation) -> Option<f64> {
    let (a, b) = (motion(coarse), motion(fine));
    let off_m_s = (a.velocity_m_s - b.velocity_m_s).norm().max(0.5 * (a.spin_rad_s - b.spin_rad_s).norm());
    let error = off_m_s / fine.speed_scale_m_s();
    let is_hit = [coarse, fine].into_iter().any(|one| one.step().unwrap().contact.contact_pairs > 0);
    (!is_hit).then_some(error)
}

#[test]
fn blocks_that_bounce_down_slopes_are_right_where_their_runs_are_called_accurate() {
    let cases: u64 = std::env::var("NDDA_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(24);
    let (mut without, mut wrong_without, mut with, mut wrong, mut worst) = (0, 0, 0, 0, 0.0f64);
    for seed in 0..cases {
        let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) + 1);
        for _ in 0..5 {
            random.unit();
        }
        let (text, step_s) = scene(&mut random);
        let alone = run(&text, step_s, Sensitivity::Never);
        if alone.summary.label.word != LabelWord::Accurate {
            continue;
        }
        let mut repeated = run(&text, step_s, Sensitivity::Auto);
        let mut fine = run(&text, step_s / 8.0, Sensitivity::Never);
        let Some(error) = error(&mut repeated.simulation, &mut fine.simulation) else { continue };
        without += 1;
        wrong_without += usize::from(error > PROMISE);
        if repeated.summary.label.word == LabelWord::Accurate {
            with += 1;
            wrong += usize::from(error > PROMISE);
            worst = worst.max(error);
        }
    }
    println!(
        "of {cases} runs {without} are accurate if they are not repeated, {wrong_without} of these off by more than 1 %; \
         if they are, {with} are, {wrong} of them off by more, at most by {:.1} %",
        100.0 * worst
    );
    assert!(with > 0, "nothing is accurate");
    // The difference to half the step is taken for at least half of the error.
    row(
        "repeated impacts",
        "random blocks that bounce down slopes and are accurate: largest error over the largest speed",
        worst,
        AtMost(2.0 * PROMISE),
    );
}
