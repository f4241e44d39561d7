//! Cases that are measured, by the clock and by counting instructions.
#![allow(dead_code)] // each bench takes some of it

use std::sync::Arc;

use ndda_fem::{BlockOperator, BlockSupports, LinearElastic};
use ndda_mesh::generate::{BoxPattern, box_block};
use ndda_mesh::{BlockSet, Mat3, Vec3};
use ndda_solver::Unknowns;
use ndda_solver::{
    BodyKind, BodySetup, Direct, Mass, Midpoint, Setup, Simulation, SymmetricMatrix, TimeIntegrator,
};

/// K̃ of a cube of n³ cells in a step of 0.1 ms.
pub fn matrix(n: u32) -> SymmetricMatrix {
    let mesh = box_block([1.0; 3], [n; 3], BoxPattern::Six).expect("a cube");
    let rock = LinearElastic::new(20e9, 0.25, 2650.0).expect("rock");
    let operator = BlockOperator::new(&mesh.nodes, mesh.tets, &rock);
    let supports = BlockSupports::new(&operator, &[], &[]).expect("no supports");
    let weights = Midpoint { theta: 0.5 }.weights(1e-4);
    Unknowns::nodal(operator.nodes(), &supports).matrix(&operator, &supports, &weights, 0.0)
}

/// A load on so many unknowns.
pub fn load(unknowns: usize) -> Vec<f64> {
    (0..unknowns).map(|i| (i as f64).sin()).collect()
}

/// `count` equal cubes of n³ cells, spinning freely.
pub fn cubes(count: usize, n: u32, kind: BodyKind, integrator: Box<dyn TimeIntegrator>) -> Simulation {
    let cube = |i: usize| {
        let mesh = box_block([1.0; 3], [n; 3], BoxPattern::Six).expect("a cube");
        (format!("cube {i}"), mesh.placed(&Mat3::identity(), &Vec3::new(2.0 * i as f64, 0.0, 0.0)))
    };
    let material = Arc::new(LinearElastic::new(20e9, 0.25, 2650.0).expect("rock"));
    let body = || BodySetup {
        kind,
        material: material.clone(),
        supports: Vec::new(),
        initial_stress: None,
        tractions: Vec::new(),
        pressures: Vec::new(),
        ties: Vec::new(),
        quiet: Vec::new(),
        forces: Vec::new(),
        velocity_m_s: Vec3::x(),
        spin_rad_s: Vec3::new(0.1, 0.2, 0.3),
    };
    Simulation::new(Setup {
        blocks: BlockSet::new((0..count).map(cube).collect()).expect("cubes"),
        bodies: (0..count).map(|_| body()).collect(),
        gravity_m_s2: Vec3::new(0.0, 0.0, -9.8),
        gravity_factor: None,
        step_s: 1e-5,
        mass: Mass::Consistent,
        integrator,
        contact: None,
        implicit_contact: None,
        solver: Box::new(Direct),
        auto_step: None,
        bolts: Vec::new(),
    })
    .expect("a simulation")
}

/// Elastic cubes with the default integrator.
pub fn elastic_cubes(count: usize, n: u32) -> Simulation {
    cubes(count, n, BodyKind::Elastic, Box::new(Midpoint { theta: 0.5 }))
}
