//! Whether the label tells the truth: a run against the same scene with a 16 times finer step.
//!
//! Promised is that speeds are right to 1 % of the largest, or of 0.01 √(g h) where blocks hardly move, and places to a fifth of the height of a tetrahedron; these scenes are held to a tenth, which
//! only a blow on a held block exceeds. An error is
//! the larger of the two over what is promised, at the end of the run; a speed may be that of one step before or after. The
//! judges are runs with Δt/8 and Δt/16, or Δt/32 where these leave a doubt: twice their difference is what the finer one may
//! be off by. A motion is sensitive where a push of a hundredth of what is promised grows thirtyfold.

use ndda::Model;
use ndda::{build, judge::verdict};
use ndda_io::scene::Contact;
use ndda_mesh::geometry::tet_heights;
use ndda_mesh::{BlockId, TetId, Vec3};
use ndda_solver::{BodyKind, Simulation};

use crate::generator::{Case, Wanted, build, case};
use crate::motion::{disturb, run};
use crate::search::{each_seed, has_words, keep, seeds, text_of};
use crate::table::{Record, Table};

/// Errors that the label promises: speeds over the largest, places over a height.
const SPEED: f64 = 0.01;
const PLACE: f64 = 0.1;
/// A push over what is promised, and what it has become where a motion is sensitive.
const PUSH: f64 = 0.01;
const GROWN: f64 = 0.3;

/// Where a block is, and how it moves.
#[derive(Clone, Copy)]
struct Course {
    velocity: Vec3,
    spin: Vec3,
}

/// Compared results of a run.
struct End {
    position: Vec<Vec3>,
    /// Of each block, at the end and, if requested, around it.
    courses: Vec<Vec<Course>>,
    speed_m_s: f64,
}

/// Sizes of the blocks.
struct Sizes {
    /// Speed below which blocks hardly move.
    slow_m_s: f64,
    radius_m: Vec<f64>,
    height_m: Vec<f64>,
    first_node: Vec<usize>,
}

fn sizes(model: &Model) -> Sizes {
    let (scene, simulation) = (&model.loaded.scene, &model.simulation);
    let blocks = simulation.blocks();
    let rest = &blocks.rest_position;
    let radius = |block: BlockId| {
        let nodes = &rest[blocks.nodes_of(block)];
        let middle = nodes.iter().sum::<Vec3>() / nodes.len() as f64;
        nodes.iter().map(|x| (x - middle).norm()).fold(0.0, f64::max)
    };
    // The median: a sliver inside a block is not what touches.
    let height = |block: BlockId| {
        let heights = blocks.tets_of(block).map(|t| smallest(blocks.tet_corners(TetId(t as u32), rest)));
        let mut heights: Vec<f64> = heights.collect();
        heights.sort_by(f64::total_cmp);
        heights[heights.len() / 2]
    };
    let moves = |block: &BlockId| simulation.shape(*block).kind != BodyKind::Fixed;
    let heights = blocks.ids().filter(moves).flat_map(|block| blocks.tets_of(block));
    let heights = heights.map(|t| smallest(blocks.tet_corners(TetId(t as u32), rest)));
    let lowest_m = heights.fold(f64::INFINITY, f64::min);
    let touch = !matches!(scene.contact, None | Some(Contact::Off)) && lowest_m.is_finite();
    let gravity_m_s2 = Vec3::from(scene.gravity_m_s2).norm();
    Sizes {
        slow_m_s: if touch { 0.01 * (gravity_m_s2 * lowest_m).sqrt() } else { 0.0 },
        radius_m: blocks.ids().map(radius).collect(),
        height_m: blocks.ids().map(height).collect(),
        first_node: blocks.node_starts().iter().map(|&n| n as usize).collect(),
    }
}

fn smallest(corners: [Vec3; 4]) -> f64 {
    tet_heights(&corners).into_iter().fold(f64::INFINITY, f64::min)
}

fn courses(simulation: &Simulation) -> Vec<Course> {
    let (blocks, state) = (simulation.blocks(), simulation.state());
    let course = |block: BlockId| {
        let nodes = blocks.nodes_of(block);
        let operator = &simulation.shape(block).operator;
        let motion = operator.rigid_motion(&state.position[nodes.clone()], &state.velocity[nodes]);
        Course { velocity: motion.velocity_m_s, spin: motion.spin_rad_s }
    };
    blocks.ids().map(course).collect()
}

/// Runs with steps `finer` times shorter, and a step of the case further; none where it stops.
fn judge(case: &Case, finer: u32, push_m_s: f64) -> Option<End> {
    let mut scene = case.scene.clone();
    let whole = build::steps(&scene.time);
    scene.time.step_s /= f64::from(finer);
    // Steps that are divided anyway are judged by whole ones.
    scene.time.step = ndda_io::scene::Step::Fixed;
    let mut simulation = build(&text_of(&scene)).ok()?.simulation;
    if push_m_s > 0.0 {
        disturb(&mut simulation, 0.0, push_m_s);
    }
    let (steps, around) = (whole * u64::from(finer), u64::from(finer));
    let (mut speed_m_s, mut position) = (0.0f64, Vec::new());
    let mut seen = Vec::new();
    for step in 0..steps + around {
        simulation.step().ok()?;
        let fastest = simulation.state().velocity.iter().map(Vec3::norm).fold(0.0, f64::max);
        if !fastest.is_finite() {
            return None;
        }
        if step < steps {
            speed_m_s = speed_m_s.max(fastest);
        }
        if step + 1 == steps {
            position = simulation.state().position.clone();
        }
        if step + 1 + around >= steps {
            seen.push(courses(&simulation));
        }
    }
    Some(End { position, courses: seen, speed_m_s })
}

/// Error of a run against a judge, over what is promised.
fn error(position: &[Vec3], course: &[Course], judge: &End, sizes: &Sizes) -> (f64, f64) {
    let (mut speeds, mut places) = (0.0f64, 0.0f64);
    for (block, own) in course.iter().enumerate() {
        let off = |other: &Course| {
            let spin = (own.spin - other.spin).norm() * sizes.radius_m[block];
            (own.velocity - other.velocity).norm().max(spin)
        };
        let least = judge.courses.iter().map(|all| off(&all[block])).fold(f64::INFINITY, f64::min);
        speeds = speeds.max(least / (SPEED * judge.speed_m_s.max(sizes.slow_m_s)));
        let nodes = sizes.first_node[block]..sizes.first_node[block + 1];
        let off = nodes.map(|n| (position[n] - judge.position[n]).norm()).fold(0.0, f64::max);
        places = places.max(off / (PLACE * sizes.height_m[block]));
    }
    (speeds, places)
}

/// The end of a judge as if it were the run that is judged.
fn between(a: &End, b: &End, sizes: &Sizes) -> f64 {
    let (speeds, places) = error(&a.position, &a.courses[a.courses.len() / 2], b, sizes);
    speeds.max(places)
}

/// Decision on an error: right, wrong, or neither.
fn decide(error: f64, doubt: f64) -> Option<bool> {
    if error + 2.0 * doubt <= 1.0 {
        Some(true)
    } else if error - 2.0 * doubt > 1.0 {
        Some(false)
    } else {
        None
    }
}

/// Judges a run: errors of speeds and places, doubt, and whether it is right; in words if that is not known.
fn truth(case: &Case, ready: &Model, sizes: &Sizes) -> (f64, f64, f64, Result<bool, &'static str>) {
    let (position, course) = (&ready.simulation.state().position, courses(&ready.simulation));
    let mut coarser = judge(case, 8, 0.0);
    let mut found = (f64::NAN, f64::NAN, f64::NAN, Err("undecided: the judge stops"));
    for finer in [16, 32] {
        let (Some(a), Some(b)) = (&coarser, judge(case, finer, 0.0)) else { return found };
        let doubt = between(a, &b, sizes);
        let (speeds, places) = error(position, &course, &b, sizes);
        let decided = decide(speeds.max(places), doubt);
        found = (speeds, places, doubt, decided.ok_or("undecided: the judges differ"));
        if decided.is_some() {
            break;
        }
        coarser = Some(b);
    }
    if found.3 == Ok(true) {
        return found;
    }
    let Some(judge_16) = judge(case, 16, 0.0) else { return found };
    let push_m_s = PUSH * SPEED * judge_16.speed_m_s.max(sizes.slow_m_s);
    let sensitive = judge(case, 16, push_m_s).is_none_or(|pushed| between(&pushed, &judge_16, sizes) > GROWN);
    if sensitive {
        found.3 = Err("undecided: sensitive motion");
    }
    found
}

fn record(case: &Case) -> Record {
    let (ready, stopped) = run(&case.text);
    let label = verdict::label(&ready.simulation, stopped.as_deref());
    let word = label.word.as_str();
    let mut record = Record::new(case, word, &label.reasons);
    if stopped.is_none() {
        let (speeds, places, doubt, right) = truth(case, &ready, &sizes(&ready));
        record.judged(speeds, places, doubt, right);
    }
    record
}

#[test]
fn label_tells_the_truth() {
    let table = Table::open();
    let wanted: Vec<u64> = seeds(40).into_iter().filter(|seed| !table.knows(*seed)).collect();
    each_seed(&wanted, |seed| {
        let case = case(seed, &Wanted::default());
        if !has_words(&case) {
            return;
        }
        let record = record(&case);
        if record.is_wrong() {
            println!("{}", keep("label", &case, &record.line()));
        }
        table.add(record);
    });
    let wrong = table.print();
    assert!(wrong.is_empty(), "called accurate and wrong: seeds {wrong:?}, scenes in target/metamorphic");
}

/// The truth about one scene: `NDDA_SCENE=scenes/arch.ron cargo test --test metamorphic judged -- --nocapture`.
#[test]
fn a_scene_of_the_user_is_judged() {
    let Ok(path) = std::env::var("NDDA_SCENE") else { return };
    let set: Vec<String> =
        std::env::var("NDDA_SET").unwrap_or_default().split_whitespace().map(Into::into).collect();
    let loaded = ndda_io::read::load(std::path::Path::new(&path), &set)
        .unwrap_or_else(|e| panic!("{}", e.render(false)));
    let mut scene = loaded.scene;
    scene.reference = None;
    let text = text_of(&scene);
    let case = Case { seed: 0, family: "given", factor: 1.0, text, scene };
    let record = record(&case);
    println!("{}", record.line());
}
