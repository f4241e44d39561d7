//! Blocks without contact or supports: free fall and free spin. Runs with contact's default model switched off.

use std::sync::Arc;

use ndda_fem::LinearElastic;
use ndda_fem::stress::volume_m3;
use ndda_mesh::generate::{BoxPattern, box_block};
use ndda_mesh::{BlockId, BlockSet, Vec3};
use ndda_solver::{BodyKind, BodySetup, Direct, Mass, Midpoint, Newmark, Setup, Simulation, TimeIntegrator};

fn cube(integrator: Box<dyn TimeIntegrator>, step_s: f64, gravity: Vec3, spin: Vec3) -> Simulation {
    let mesh = box_block([0.3, 0.2, 0.1], [2, 2, 1], BoxPattern::Six).unwrap();
    let blocks = BlockSet::new(vec![("block".into(), mesh)]).unwrap();
    let body = BodySetup {
        kind: BodyKind::Elastic,
        material: Arc::new(LinearElastic::new(200e9, 0.25, 2650.0).unwrap()),
        supports: Vec::new(),
        initial_stress: None,
        tractions: Vec::new(),
        pressures: Vec::new(),
        ties: Vec::new(),
        quiet: Vec::new(),
        forces: Vec::new(),
        velocity_m_s: Vec3::zeros(),
        spin_rad_s: spin,
    };
    Simulation::new(Setup {
        blocks,
        bodies: vec![body],
        gravity_m_s2: gravity,
        mass: Mass::Consistent,
        gravity_factor: None,
        step_s,
        integrator,
        contact: None,
        implicit_contact: None,
        solver: Box::new(Direct),
        auto_step: None,
        bolts: Vec::new(),
    })
    .unwrap()
}

fn integrators() -> [Box<dyn TimeIntegrator>; 3] {
    [
        Box::new(Midpoint { theta: 0.5 }),
        Box::new(Newmark { alpha: 0.5, delta: 1.0 }),
        Box::new(Newmark { alpha: 0.25, delta: 0.5 }),
    ]
}

#[test]
fn a_falling_block_follows_half_g_t_squared_at_any_step() {
    let gravity = Vec3::new(0.0, 0.0, -9.8);
    for step_s in [1e-5, 1e-3, 0.1] {
        for integrator in integrators() {
            let name = integrator.name();
            let mut simulation = cube(integrator, step_s, gravity, Vec3::zeros());
            for _ in 0..200 {
                simulation.step().unwrap();
            }
            let fallen = 0.5 * gravity * simulation.time_s().powi(2);
            let scale = fallen.norm() + 0.3;
            for (x, rest) in simulation.state().position.iter().zip(&simulation.blocks().rest_position) {
                let error = (x - rest - fallen).norm() / scale;
                assert!(error < 2e-13, "{name}, Δt = {step_s}: {error}");
            }
        }
    }
}

/// Mean dilatation of a body that turns at ω about its mass centre, by the virial theorem:
/// E ⟨tr ε⟩ = (1 − 2ν) ⟨tr σ⟩ and ∫ tr σ dV = ∫ ρ |ω × r|² dV = 2 T.
fn spinning_dilatation(kinetic_j: f64, volume_m3: f64) -> f64 {
    (1.0 - 2.0 * 0.25) / 200e9 * 2.0 * kinetic_j / volume_m3
}

#[test]
fn a_spinning_block_keeps_angular_momentum_energy_and_volume() {
    for integrator in integrators() {
        let name = integrator.name();
        let mut simulation = cube(integrator, 1e-3, Vec3::zeros(), Vec3::new(1.0, 2.0, 5.0));
        let start = simulation.sample().unwrap();
        let volume = |s: &Simulation| volume_m3(&s.shape(BlockId(0)).operator, &s.state().position);
        let first = volume(&simulation);
        let dilatation = spinning_dilatation(start.kinetic_j, first);
        for _ in 0..20 {
            for _ in 0..500 {
                simulation.step().unwrap();
            }
            let now = simulation.sample().unwrap();
            let turned = (now.angular_momentum - start.angular_momentum).norm();
            assert!(turned <= 1e-11 * start.angular_momentum.norm(), "{name}: {turned:e}");
            assert!((now.total_j() / start.total_j() - 1.0).abs() < 1e-8, "{name}: energy drifts");
            // Released from rest shape the block rings between zero and twice its mean dilatation; sampled
            // far above its period, other modes show, too.
            let grown = volume(&simulation) / first - 1.0;
            assert!(
                (grown - dilatation).abs() < 2.0 * dilatation,
                "{name}: {grown:e} against {dilatation:e}"
            );
        }
    }
}

#[test]
fn a_newmark_block_that_damps_settles_at_the_dilatation_of_its_spin() {
    let integrator = Box::new(Newmark { alpha: 0.5, delta: 1.0 });
    let mut simulation = cube(integrator, 1e-3, Vec3::zeros(), Vec3::new(0.0, 0.0, 5.0));
    let start = simulation.sample().unwrap();
    let volume = |s: &Simulation| volume_m3(&s.shape(BlockId(0)).operator, &s.state().position);
    let first = volume(&simulation);
    for _ in 0..4000 {
        simulation.step().unwrap();
    }
    let dilatation = spinning_dilatation(start.kinetic_j, first);
    let grown = volume(&simulation) / first - 1.0;
    assert!((grown - dilatation).abs() < 1e-3 * dilatation, "{grown:e} against {dilatation:e}");
}
