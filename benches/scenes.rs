//! The step of whole scenes, in contact: what a run costs per step.
//!
//! `NDDA_LARGE=1` adds piles of 1000 and 8000 blocks, and one block of 93 750 and of 998 250 tetrahedra, which take minutes to begin.
#![allow(missing_docs)] // criterion's macro makes public functions

#[path = "piles/mod.rs"]
mod piles;

use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use ndda_solver::Simulation;
use piles::{fallen, prepared};

/// A scene with some values changed, and the steps until its blocks are in contact for good.
struct Case {
    name: &'static str,
    scene: &'static str,
    settings: &'static [&'static str],
    warm_up: u32,
}

const fn case(name: &'static str, warm_up: u32) -> Case {
    Case { name, scene: name, settings: &[], warm_up }
}

const CASES: [Case; 6] = [
    case("sliding_45", 1000),
    case("sliding_45_phi35", 1000),
    case("collision_equal", 2500),
    case("spinning_block", 10),
    case("column_phi5", 200),
    case("pile_125", piles::STEPS),
];

const LARGE: [Case; 4] = [
    case("pile_1000", piles::STEPS),
    Case {
        name: "pile_8000",
        scene: "pile_1000",
        settings: &[
            "rock.cube.joints.level.spacing_m=0.5",
            "rock.cube.joints.east.spacing_m=0.5",
            "rock.cube.joints.north.spacing_m=0.5",
        ],
        warm_up: piles::STEPS,
    },
    Case {
        name: "one block of 93 750 tets",
        scene: "extreme/one_block",
        settings: &["blocks.block.shape.cells=(25,25,25)"],
        warm_up: 1,
    },
    Case {
        name: "one block of 998 250 tets",
        scene: "extreme/one_block",
        settings: &["blocks.block.shape.cells=(55,55,55)"],
        warm_up: 1,
    },
];

/// The scene after its first steps; these are left out where nothing is measured.
fn begun(case: &Case) -> Simulation {
    let begin = if case.name.starts_with("pile") { fallen } else { prepared };
    let mut simulation = begin(case.scene, case.settings);
    let measured = std::env::args().any(|argument| argument == "--bench");
    for _ in 0..if measured { case.warm_up } else { 0 } {
        simulation.step().expect("a step");
    }
    simulation
}

fn step(c: &mut Criterion) {
    let large = if std::env::var_os("NDDA_LARGE").is_some() { &LARGE[..] } else { &[] };
    for case in CASES.iter().chain(large) {
        // Built once, and only if it is requested.
        let mut simulation = None;
        // A bounded number of steps, so that the block is still on its ramp.
        let mut group = c.benchmark_group("step of a scene");
        group.sample_size(10);
        group.warm_up_time(Duration::from_millis(100));
        group.measurement_time(Duration::from_millis(300));
        group.bench_function(case.name, |b| {
            let simulation = simulation.get_or_insert_with(|| begun(case));
            b.iter(|| simulation.step().expect("a step"))
        });
        group.finish();
    }
}

criterion_group!(benches, step);
criterion_main!(benches);
