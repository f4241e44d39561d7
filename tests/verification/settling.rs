//! A scene that settles first starts in equilibrium: penetration, stress and rest.

use std::ops::ControlFlow;

use ndda_mesh::{BlockId, Vec3};
use ndda_solver::{Damping, Settle, Settled, StepError};

use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::row;
use crate::extreme::farthest;
use crate::simulation;

const SCENE: &str = "(title: \"stack\", time: (step_s: 1e-3, end_s: 1), gravity_m_s2: (0, 0, -9.8),
    materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)],
    blocks: [
        (name: \"floor\", material: \"rock\", shape: Box(size_m: (3, 3, 1), cells: (3, 3, 1)), at_m: (-1, -1, -1)),
        (name: \"lower\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2))),
        (name: \"upper\", material: \"rock\", shape: Box(size_m: (1, 1, 0.5), cells: (2, 2, 1)), at_m: (0, 0, 1)),
    ],
    supports: [(block: \"floor\", on: All, hold: Fixed)],
    contact: Potential(penalty_pa: 2e8, potential: Smooth(reference_m: 1), friction: (friction_deg: 30)))";

#[test]
fn a_stack_that_has_settled_lies_as_deep_as_its_weight_asks_for_and_stays() {
    for (way, damping) in [("kinetic", Damping::Kinetic), ("local", Damping::Local { factor: 0.8 })] {
        settles_as_deep_as_its_weight_asks_for(way, damping);
    }
}

fn settles_as_deep_as_its_weight_asks_for(way: &str, damping: Damping) {
    let mut simulation = simulation(SCENE);
    let settled =
        simulation.settle(&Settle { damping: Some(damping), ..Settle::new(1e-6, 100_000) }).unwrap();
    assert!(settled.steps > 10 && settled.speed_ratio <= 1e-6, "{settled:?}");
    // p = 2 k_n h/L₀ under the weight of what is above.
    let sunk = |block: u32| {
        let nodes = simulation.blocks().nodes_of(BlockId(block));
        let rest = &simulation.blocks().rest_position[nodes.clone()];
        let lowest = |x: &[Vec3]| x.iter().map(|x| x.z).fold(f64::INFINITY, f64::min);
        lowest(rest) - lowest(&simulation.state().position[nodes])
    };
    let pressure = 2500.0 * 9.8 * 1.5;
    let expected = pressure / (2.0 * 2e8);
    row(
        "settling",
        &format!("depth of a stack that has settled, {way} damping [m]"),
        sunk(1),
        Within(expected, 1e-2),
    );

    assert_eq!(simulation.time_s(), 0.0);
    simulation.sample().unwrap();
    for _ in 0..1000 {
        simulation.step().unwrap();
    }
    // What is left is the tolerance, 1e-6 of the largest speed on the way, √(2 k_n/L₀ m) times the depth; for a second, if nothing stops it.
    let second = 1e-6 * (2.0 * 2e8 / (2500.0f64 * 1.5)).sqrt();
    row(
        "settling",
        &format!("motion afterwards over that depth, {way} damping"),
        farthest(&simulation) / expected,
        AtMost(second),
    );
    let sample = simulation.sample().unwrap();
    assert!(sample.load_j.abs() < 1e-3 * 2500.0 * 9.8 * 1.5 * expected, "{sample:?}");
}

/// A block on a steep plane: the answer is which block goes, and where to.
#[test]
fn a_scene_that_cannot_come_to_rest_names_the_block_that_moves() {
    let scene =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/safety/plane_dry.ron")).unwrap();
    for damping in [Damping::Kinetic, Damping::Adaptive, Damping::Local { factor: 0.8 }] {
        let mut simulation = crate::simulation(&scene.replace("friction_deg: 40", "friction_deg: 10"));
        let error =
            simulation.settle(&Settle { damping: Some(damping), ..Settle::new(1e-4, 3000) }).unwrap_err();
        let StepError::NotSettled { towards, others, gone_m, .. } = error else { panic!("{error}") };
        assert!(others == 0 && gone_m > 0.0);
        // The plane is level and gravity tilted by 30°.
        let gravity = Vec3::new(4.905, 0.0, -8.495709211125344);
        let slope_deg = Vec3::from(towards).angle(&gravity).to_degrees();
        let what = format!("a block that slides: its direction against gravity, {damping:?} [°]");
        row("settling", &what, slope_deg, Within(60.0, 0.02));
    }
}

/// Contact between rigid blocks of 2 GPa asks for steps below 1e-3 s: with ten times that it throws the cube off its plane, and nothing but the step helps.
#[test]
fn a_scene_whose_steps_are_too_long_for_contact_is_told_so() {
    let scene =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/safety/plane_dry.ron")).unwrap();
    let told = |step_s: &str| {
        let mut simulation = crate::simulation(&scene.replace("step_s: 1e-4", &format!("step_s: {step_s}")));
        simulation.settle(&Settle::new(1e-9, 300)).unwrap_err().to_string()
    };
    let long = told("1e-2");
    assert!(long.contains("steps are too long for contact") && long.contains("divide step_s by"), "{long}");
    assert!(!told("1e-5").contains("too long"), "{}", told("1e-5"));
}

/// A block that nothing holds is given up when it has fallen by the extent of the scene: n steps of free fall with s = ½ g (n Δt)² just above it.
#[test]
fn settling_ends_when_a_block_leaves_the_scene() {
    let scene = "(title: \"fall\", time: (step_s: 1e-3, end_s: 1), gravity_m_s2: (0, 0, -9.81), contact: Off,
        materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)],
        blocks: [(name: \"block\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))])";
    // Nothing can touch, so that nothing asks for other masses.
    for mass_scaling in [false, true] {
        let settle = Settle { mass_scaling, ..Settle::new(1e-4, 1_000_000) };
        let error = simulation(scene).settle(&settle).unwrap_err();
        let StepError::NotSettled { steps, gone_m, .. } = error else { panic!("{error}") };
        let extent_m = 3f64.sqrt();
        let steps_to_fall = (2.0 * extent_m / 9.81).sqrt() / 1e-3;
        assert!(gone_m > extent_m && (steps as f64) < steps_to_fall + 100.0, "{gone_m} m in {steps} steps");
    }
}

/// A tower of rigid blocks under a thin plate, which limits the step.
const TOWER: &str = "(title: \"tower\", time: (step_s: 2e-4, end_s: 1), gravity_m_s2: (0, 0, -9.8),
    materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)],
    blocks: [
        (name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (6, 6, 1), cells: (1, 1, 1)), at_m: (-1, -1, -1)),
        (name: \"first\", material: \"rock\", body: Rigid, shape: Box(size_m: (4, 4, 4), cells: (1, 1, 1))),
        (name: \"second\", material: \"rock\", body: Rigid, shape: Box(size_m: (4, 4, 4), cells: (1, 1, 1)), at_m: (0, 0, 4)),
        (name: \"third\", material: \"rock\", body: Rigid, shape: Box(size_m: (4, 4, 4), cells: (1, 1, 1)), at_m: (0, 0, 8)),
        (name: \"plate\", material: \"rock\", body: Rigid, shape: Box(size_m: (4, 4, 0.25), cells: (1, 1, 1)), at_m: (0, 0, 12)),
    ],
    contact: Potential(penalty_pa: 2e8, potential: Smooth(reference_m: 1), friction: (friction_deg: 30)))";

#[test]
fn a_tower_settles_as_deep_with_scaled_masses_in_two_thirds_of_the_steps() {
    let steps = [false, true].map(|mass_scaling| {
        let mut simulation = simulation(TOWER);
        let settle = Settle { mass_scaling, ..Settle::new(1e-6, 100_000) };
        let settled = simulation.settle(&settle).unwrap();
        assert_eq!(settled.inertia_factors.is_some(), mass_scaling);
        let top = simulation.blocks().nodes_of(BlockId(4)).start;
        let sunk = simulation.blocks().rest_position[top].z - simulation.state().position[top].z;
        // Σ p/2 k_n of the four joints, p being the weight above each.
        let heights_m = [12.25, 8.25, 4.25, 0.25].iter().sum::<f64>();
        let expected = 2500.0 * 9.8 * heights_m / (2.0 * 2e8);
        let way = if mass_scaling { "scaled" } else { "true" };
        row(
            "settling",
            &format!("depth of a tower of rigid blocks, {way} masses [m]"),
            sunk,
            Within(expected, 1e-2),
        );
        for _ in 0..1000 {
            simulation.step().unwrap();
        }
        row(
            "settling",
            &format!("motion of that tower afterwards over its depth, {way} masses"),
            farthest(&simulation) / expected,
            // The tolerance: an oscillation about rest with 1e-6 of the largest speed on the way swings by as much of the depth to either side.
            AtMost(2e-6),
        );
        settled.steps
    });
    assert!(3 * steps[1] <= 2 * steps[0], "{steps:?}");
}

/// Only the inertia of blocks over Δt² counts on the way to rest, and contact decides on that.
#[test]
fn with_scaled_masses_steps_to_rest_do_not_depend_on_the_step() {
    let settle = Settle { mass_scaling: true, ..Settle::new(1e-6, 100_000) };
    let settled = |step: &str| {
        let mut simulation = simulation(&TOWER.replace("step_s: 2e-4", &format!("step_s: {step}")));
        simulation.settle(&settle).unwrap()
    };
    let [long, short] = ["2e-4", "2e-6"].map(settled);
    let what = "steps to rest with scaled masses: a hundredth of the step over the step";
    // A step more or less, where rounding decides when the energy begins to fall.
    row("settling", what, short.steps as f64 / long.steps as f64, Within(1.0, 1.0 / long.steps as f64));
    let factors = |settled: Settled| settled.inertia_factors.unwrap()[0];
    let what = "least factor on inertia: a hundredth of the step over the step";
    // Where they rest differs by the tolerance of settling, and the stiffness of contact by as much of itself.
    row("settling", what, factors(short) / factors(long), Within(1e-4, 2e-6));
}

/// Rock in blocks of three scattered joint sets, as in `scenes/works/fisher_blocks.ron`: at rest, the forces of contact on each block carry its weight, which is
/// computed from its tetrahedra, and those on the fixed blocks the weight of all others.
#[test]
fn rock_that_has_settled_with_scaled_masses_is_in_equilibrium_with_its_true_weight() {
    let scene = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/works/fisher_blocks.ron"));
    let model = ndda::Model::open(scene, &["parameters.size_m=13".into(), "time.step_s=2e-5".into()]);
    let mut simulation = model.unwrap_or_else(|errors| panic!("{}", errors.render(false))).simulation;
    let settled = simulation.settle(&Settle { mass_scaling: true, ..Settle::new(1e-4, 20_000) }).unwrap();
    // With masses of their own again.
    let rest = simulation.state().position.clone();
    simulation.step().unwrap();
    let forces_n = simulation.contact_forces_n();
    let blocks = simulation.blocks();
    let (mut largest, mut count, mut weights, mut held) = (0.0f64, 0, Vec3::zeros(), Vec3::zeros());
    for block in blocks.ids() {
        let force_n: Vec3 = forces_n[blocks.nodes_of(block)].iter().sum();
        if simulation.shape(block).kind == ndda_solver::BodyKind::Fixed {
            held += force_n;
            continue;
        }
        let corners = |tet: usize| blocks.tets[tet].map(|node| blocks.rest_position[node.index()]);
        let volume_m3: f64 =
            blocks.tets_of(block).map(|tet| ndda_mesh::geometry::tet_volume(&corners(tet))).sum();
        let weight_n = Vec3::new(0.0, 0.0, -9.81 * 2600.0 * volume_m3);
        largest = largest.max((force_n + weight_n).norm() / weight_n.norm());
        weights += weight_n;
        count += 1;
    }
    assert!(count > 80, "{count}");
    let what = "rock in scattered blocks at rest: force on a block that is not balanced over its weight, the largest";
    row("settling", what, largest, AtMost(1e-3));
    let what =
        "rock in scattered blocks at rest: forces on fixed blocks less the weight of all others, over that";
    row("settling", what, (held - weights).norm() / weights.norm(), AtMost(1e-4));
    for _ in 0..500 {
        simulation.step().unwrap();
    }
    // Under the weight of 11 m, contact is 11 m · ρ g L₀/2 k_n deep.
    let depth_m = 11.0 * 2600.0 * 9.81 / (2.0 * 2e9);
    let positions = simulation.state().position.iter().zip(&rest);
    let moved_m = positions.map(|(x, rest)| (x - rest).norm()).fold(0.0, f64::max);
    let what = "rock in scattered blocks at rest: motion in 500 steps with true masses over the depth of contact under 11 m";
    // The tolerance, 1e-4 of the largest speed on the way: as much of the depth to either side.
    row("settling", what, moved_m / depth_m, AtMost(2e-4));
    assert!(settled.steps < 2000, "{settled:?}");
}

#[test]
fn settling_with_scaled_masses_goes_on_from_a_snapshot_with_the_same_bits() {
    let settle = Settle { mass_scaling: true, ..Settle::new(1e-4, 100_000) };
    let mut whole = simulation(TOWER);
    whole.settle(&settle).unwrap();
    let mut first = simulation(TOWER);
    let mut settling = first.begin_to_settle(&settle);
    let mut until = |settled: &Settled| match settled.steps {
        100 => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    };
    assert!(!first.go_on_settling(&settle, &mut settling, &mut until).unwrap());
    let mut second = simulation(TOWER);
    second.restore(first.snapshot()).unwrap();
    assert!(second.go_on_settling(&settle, &mut settling, &mut |_| ControlFlow::Continue(())).unwrap());
    assert_eq!(second.state().position, whole.state().position);
}

/// A plate that lies flat on shear springs, after three oscillations, moves by rounding alone.
#[test]
fn what_only_rounding_moves_is_at_rest_whatever_the_step() {
    for step_s in [5e-6, 3.5e-6, 1e-5] {
        let mut simulation = simulation(&format!(
            "(title: \"plate\", time: (step_s: {step_s}, end_s: 1), gravity_m_s2: (0, 0, -10),
              materials: [(name: \"rock\", young_pa: 60e9, poisson: 0, density_kg_m3: 2500)],
              blocks: [(name: \"base\", material: \"rock\", body: Fixed, shape: Box(size_m: (6, 6, 1), cells: (1, 1, 1)), at_m: (-1, -1, -1)),
                       (name: \"plate\", material: \"rock\", body: Rigid, shape: Box(size_m: (4, 4, 0.2), cells: (2, 2, 1)))],
              contact: Potential(penalty_pa: 1e9, potential: Smooth(), friction: (friction_deg: 60, shear_penalty_pa_m: 1e9)))"
        ));
        let settled = simulation.settle(&Settle::new(1e-6, 100_000)).unwrap();
        // A quarter of its period is ½ π/ω, ω = √(2 k_n A/L₀ m), and its largest speed g/ω. It is stopped when its energy has fallen for a step, within two steps of its
        // peak: 2 ω Δt of the oscillation are left. It is over where its speed is that of rounding, 2 ε X/Δt, and each quarter is whole steps, and that one more.
        let omega = (2e9f64 / (2500.0 * 0.2)).sqrt();
        let quarter = 0.5 * std::f64::consts::PI / (omega * step_s);
        let farthest_m = simulation.state().position.iter().map(|x| x.amax()).fold(0.0, f64::max);
        let rounding = 2.0 * f64::EPSILON * farthest_m / step_s * omega / 10.0;
        let stops = 1.0 + (rounding.ln() / (2.0 * omega * step_s).ln()).ceil();
        row(
            "settling",
            &format!("quarters of a period in which a plate comes to rest, Δt = {step_s:e} s"),
            settled.steps as f64 / quarter,
            AtMost(stops * (1.0 + 2.0 / quarter)),
        );
    }
}

/// A scene that is broken off on its way to rest, after any step, written and read again, comes to rest with the same bits.
#[test]
fn settling_goes_on_from_any_step_with_the_same_bits() {
    let scene = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/extreme/overlap.ron"));
    let open = || {
        let model = ndda::Model::open(scene, &["time.end_s=0.01".into()]);
        model.unwrap_or_else(|errors| panic!("{}", errors.render(false))).simulation
    };
    for damping in [Damping::Kinetic, Damping::Adaptive, Damping::Local { factor: 0.8 }] {
        let settle = Settle { damping: Some(damping), mass_scaling: true, ..Settle::new(1e-9, 100_000) };
        let mut whole = open();
        let all = whole.settle(&settle).unwrap().steps;
        let bits = |simulation: &ndda_solver::Simulation| {
            let state = simulation.state();
            postcard::to_stdvec(&(&state.position, &state.velocity, &state.contact)).unwrap()
        };
        let rest = bits(&whole);
        for broken_off in 1..all {
            let mut first = open();
            let mut settling = first.begin_to_settle(&settle);
            let mut until = |settled: &Settled| match settled.steps == broken_off {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            };
            assert!(!first.go_on_settling(&settle, &mut settling, &mut until).unwrap());
            let kept = postcard::to_stdvec(&(first.snapshot(), &settling)).unwrap();
            let (snapshot, mut settling) = postcard::from_bytes(&kept).unwrap();
            let mut second = open();
            second.restore(snapshot).unwrap();
            assert!(
                second.go_on_settling(&settle, &mut settling, &mut |_| ControlFlow::Continue(())).unwrap()
            );
            assert!(bits(&second) == rest, "{damping:?}, broken off after {broken_off} of {all} steps");
        }
    }
}
