//! Why a stack that shear springs hold creeps after a sudden load: the normal force of undamped contact swings between zero and twice the
//! weight, the limit of friction μ N falls with it in each swing, and the spring loses what is above the limit each time. An independent
//! integration of two masses on springs and sliders creeps as fast, so that this is the law and not its implementation.

use ndda::judge::verdict;
use ndda::summary::LabelWord;
use ndda_mesh::BlockId;
use ndda_solver::{Settle, Simulation};

use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::row;
use crate::{advance, displacements, simulation};

const SLOPE_DEG: f64 = 20.0;
const GRAVITY_M_S2: f64 = 9.8;
const PENALTY_PA: f64 = 2e9;
const MASS_KG: f64 = 260.0;
const END_S: f64 = 0.1;

/// Two masses of one square metre each on a slope: normal springs 2 k_n/L₀ that only press, shear springs k_s limited by μ N; steps
/// of a hundredth of the quickest swing. Slip of both at the end [m].
fn oscillators(friction_deg: f64, shear_pa_m: f64) -> [f64; 2] {
    let (friction, slope) = (friction_deg.to_radians().tan(), SLOPE_DEG.to_radians());
    let (down, along) = (-GRAVITY_M_S2 * slope.cos(), GRAVITY_M_S2 * slope.sin());
    let steps = 50_000;
    let dt = END_S / f64::from(steps);
    let (mut y, mut vy, mut x, mut vx, mut shear) = ([0.0; 2], [0.0; 2], [0.0; 2], [0.0; 2], [0.0; 2]);
    for _ in 0..steps {
        let middle = [0, 1].map(|k| y[k] + 0.5 * dt * vy[k]);
        let normal: [f64; 2] =
            [-middle[0], middle[0] - middle[1]].map(|depth: f64| (2.0 * PENALTY_PA * depth).max(0.0));
        for (k, slip) in [vx[0], vx[1] - vx[0]].into_iter().enumerate() {
            let limit = friction * normal[k];
            shear[k] = (shear[k] - shear_pa_m * dt * slip).clamp(-limit, limit);
        }
        let lift = [(normal[0] - normal[1]) / MASS_KG + down, normal[1] / MASS_KG + down];
        let drive = [(shear[0] - shear[1]) / MASS_KG + along, shear[1] / MASS_KG + along];
        for k in 0..2 {
            y[k] += dt * (vy[k] + 0.5 * dt * lift[k]);
            x[k] += dt * (vx[k] + 0.5 * dt * drive[k]);
            vy[k] += dt * lift[k];
            vx[k] += dt * drive[k];
        }
    }
    x
}

/// Two rigid plates of a square metre on the slope.
fn stack(thickness_m: f64, step_s: f64, friction_deg: f64, shear_pa_m: f64) -> Simulation {
    let slope = SLOPE_DEG.to_radians();
    let plate = |name: &str, body: &str, size: f64, height: f64, at: f64, z: f64| {
        format!(
            "(name: \"{name}\", material: \"rock\", body: {body}, shape: Box(size_m: ({size}, {size}, {height}), cells: (2, 2, 1)),
              at_m: ({at}, {at}, {z})),"
        )
    };
    simulation(&format!(
        "(title: \"stack\", time: (step_s: {step_s:e}, end_s: {END_S}), gravity_m_s2: ({:e}, 0, {:e}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: {:e})],
          blocks: [{}{}{}],
          contact: Potential(penalty_pa: {PENALTY_PA:e}, potential: Smooth(reference_m: 1),
            friction: (friction_deg: {friction_deg}, shear_penalty_pa_m: {shear_pa_m:e})))",
        GRAVITY_M_S2 * slope.sin(),
        -GRAVITY_M_S2 * slope.cos(),
        MASS_KG / thickness_m,
        plate("bed", "Fixed", 3.0, 1.0, -1.0, -1.0),
        plate("lower", "Rigid", 1.0, thickness_m, 0.0, 0.0),
        plate("upper", "Rigid", 1.0, thickness_m, 0.0, thickness_m),
    ))
}

/// How far both plates have slipped [m].
fn slips(simulation: &Simulation) -> [f64; 2] {
    let moved = displacements(simulation);
    [1, 2].map(|block| {
        let nodes = simulation.blocks().nodes_of(BlockId(block));
        let count = nodes.len() as f64;
        moved[nodes].iter().map(|u| u.x).sum::<f64>() / count
    })
}

/// Slip of plates so thin that shear does not make them rock.
fn plates(friction_deg: f64, shear_pa_m: f64) -> [f64; 2] {
    let step_s = 2e-5;
    let mut simulation = stack(1e-3, step_s, friction_deg, shear_pa_m);
    advance(&mut simulation, (END_S / step_s).round() as u64);
    slips(&simulation)
}

#[test]
fn a_ringing_stack_on_shear_springs_creeps_as_two_masses_with_sliders_do() {
    for (friction_deg, shear_pa_m) in [(30.0, 1e9), (30.0, 1e8), (60.0, 1e9)] {
        let (expected, found) = (oscillators(friction_deg, shear_pa_m), plates(friction_deg, shear_pa_m));
        for (k, which) in ["lower", "upper"].into_iter().enumerate() {
            let what = format!(
                "slip of the {which} plate, φ = {friction_deg}°, k_s = {shear_pa_m:e} Pa/m, after {END_S} s [m]"
            );
            // Swings that differ in phase after a hundred of them: a few per cent of the slip.
            row("creep", &what, found[k], Within(expected[k], 0.05));
        }
    }
}

#[test]
fn a_stack_that_starts_at_rest_does_not_creep() {
    let step_s = 1e-4;
    let mut simulation = stack(0.1, step_s, 30.0, 1e9);
    simulation.settle(&Settle::new(1e-6, 1_000_000)).expect("a stack that comes to rest");
    let second = (1.0 / step_s) as u64;
    advance(&mut simulation, second);
    let early = slips(&simulation);
    let end_s = if std::env::var_os("NDDA_LARGE").is_some() { 30 } else { 3 };
    advance(&mut simulation, (end_s - 1) * second);
    let late = slips(&simulation);
    let crept_m = (0..2).map(|k| (late[k] - early[k]).abs()).fold(0.0, f64::max);
    // It settled to 1e-6 of its largest speed, that of stretching the springs under both plates: a hundred times that part of the stretch.
    let stretch_m = 2.0 * MASS_KG * GRAVITY_M_S2 * SLOPE_DEG.to_radians().sin() / 1e9;
    row("creep", "slip of a stack at rest after its first second [m]", crept_m, AtMost(1e-4 * stretch_m));
}

/// The label of a stack after so many seconds.
fn labelled(simulation: &mut Simulation, step_s: f64, end_s: f64) -> (LabelWord, String) {
    simulation.sample().expect("a sound state");
    for _ in 0..10 {
        advance(simulation, (0.1 * end_s / step_s).round() as u64);
        simulation.sample().expect("a sound state");
    }
    let label = verdict::label(simulation, None);
    (label.word, label.reasons.join("; "))
}

#[test]
fn a_stack_that_creeps_is_not_called_accurate() {
    let step_s = 1e-4;
    for shear_pa_m in [1e8, 1e9] {
        let mut simulation = stack(0.1, step_s, 30.0, shear_pa_m);
        let (word, reasons) = labelled(&mut simulation, step_s, 5.0);
        println!("k_s = {shear_pa_m:e} Pa/m: {:?} m, {word:?}: {reasons}", slips(&simulation));
        assert_eq!(word, LabelWord::Inaccurate, "k_s = {shear_pa_m:e} Pa/m");
        assert!(reasons.contains("creeps"), "{reasons}");
    }
}

#[test]
fn what_is_judged_as_creep_is_what_two_masses_with_sliders_slip() {
    let step_s = 2e-5;
    for shear_pa_m in [1e8, 1e9] {
        let mut simulation = stack(1e-3, step_s, 30.0, shear_pa_m);
        let (word, reasons) = labelled(&mut simulation, step_s, END_S);
        assert_eq!(word, LabelWord::Inaccurate, "{reasons}");
        let [lower, upper] = oscillators(30.0, shear_pa_m);
        let worst = simulation.invariants();
        let speed_m_s = worst.creep_speed.value * simulation.speed_scale_m_s();
        let what = format!("mean speed of creep that the label sees, k_s = {shear_pa_m:e} Pa/m [m/s]");
        // The first swing and an unfinished one do not count.
        row("creep", &what, speed_m_s, Within(lower.max(upper - lower) / END_S, 0.1));
    }
}

#[test]
fn a_stack_that_is_held_or_slides_is_accurate() {
    // Plates that slide rock on their springs, and longer steps leave the phase of that unknown: 1.0 % of the speed at 1e-4 s.
    for (friction_deg, settles, step_s) in [(30.0, true, 1e-4), (10.0, false, 2e-5), (5.0, false, 2e-5)] {
        let mut simulation = stack(0.1, step_s, friction_deg, 1e9);
        if settles {
            let settle = Settle::new(1e-6, 1_000_000);
            simulation.settle(&settle).expect("a stack that comes to rest");
        }
        let (word, reasons) = labelled(&mut simulation, step_s, 0.5);
        assert_eq!(word, LabelWord::Accurate, "φ = {friction_deg}°: {reasons}");
    }
}
