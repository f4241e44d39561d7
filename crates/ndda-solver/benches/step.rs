//! The step of free blocks by size and by number, and what it costs to begin.
#![allow(missing_docs)] // criterion's macro makes public functions

use std::sync::Arc;

use criterion::{Criterion, criterion_group, criterion_main};
use ndda_fem::LinearElastic;
use ndda_mesh::generate::{BoxPattern, box_block};
use ndda_mesh::{BlockSet, Mat3, Vec3};
use ndda_solver::{BodyKind, BodySetup, Direct, Mass, Midpoint, Setup, Simulation};

/// `count` equal cubes of n³ cells, spinning freely.
fn cubes(count: usize, n: u32) -> Simulation {
    let cube = |i: usize| {
        let mesh = box_block([1.0; 3], [n; 3], BoxPattern::Six).expect("a cube");
        (format!("cube {i}"), mesh.placed(&Mat3::identity(), &Vec3::new(2.0 * i as f64, 0.0, 0.0)))
    };
    let material = Arc::new(LinearElastic::new(20e9, 0.25, 2650.0).expect("rock"));
    let body = || BodySetup {
        kind: BodyKind::Elastic,
        material: material.clone(),
        supports: Vec::new(),
        initial_stress: None,
        tractions: Vec::new(),
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
        integrator: Box::new(Midpoint { theta: 0.5 }),
        contact: None,
        end_contact: None,
        solver: Box::new(Direct),
        auto_step: None,
    })
    .expect("a simulation")
}

fn step(c: &mut Criterion) {
    for (count, n) in [(1, 2), (1, 8), (1, 16), (64, 2)] {
        let mut simulation = cubes(count, n);
        let name = format!("step/{count} cube(s) of {n}x{n}x{n} cells");
        c.bench_function(&name, |b| b.iter(|| simulation.step().expect("a step")));
    }
}

fn begin(c: &mut Criterion) {
    let mut group = c.benchmark_group("begin");
    group.sample_size(10);
    group.bench_function("64 congruent cubes of 4x4x4 cells: one factor", |b| b.iter(|| cubes(64, 4)));
    group.bench_function("1 cube of 16x16x16 cells", |b| b.iter(|| cubes(1, 16)));
    group.finish();
}

criterion_group!(benches, step, begin);
criterion_main!(benches);
