//! Blocks that slide under accelerations along all three axes: on a plane, where the slip turns, and between two planes,
//! compared with the vector equation of motion of a rigid block (Goodman & Seed 1966; Bakun-Mazor, Hatzor & Glaser 2012).

use std::f64::consts::TAU;
use std::fmt::Write;

use ndda::judge::verdict;
use ndda::summary::LabelWord;
use ndda_mesh::{BlockId, Vec3};
use ndda_solver::{Settle, Simulation};

use crate::evidence::Answer::{AtMost, Near};
use crate::evidence::row;

const CASE: &str = "sliding in space";
const G: f64 = 9.81;
/// The promise of docs/verification/verification.md for closed forms: 0.5 %.
const PROMISED: f64 = 5e-3;
/// How long it shakes [s].
const END_S: f64 = 1.0;
/// Until when the wedge, which slides from the start, has not left its planes [s].
const WEDGE_END_S: f64 = 0.4;
/// Steps of the differential equation in one of the run.
const FINER: usize = 50;

/// Sines of an acceleration along x, y and z: amplitude over g, and frequency [Hz].
type Sines = [(f64, f64); 3];

fn base_m_s2(sines: &Sines, t: f64) -> Vec3 {
    Vec3::from(sines.map(|(part, hertz)| part * G * (TAU * hertz * t).sin()))
}

/// `Shaking` by the three records.
const HOLD: &str = "hold: Shaking([(direction: (1, 0, 0), record: (file: \"0.csv\")),
    (direction: (0, 1, 0), record: (file: \"1.csv\")), (direction: (0, 0, 1), record: (file: \"2.csv\"))])";

/// The simulation of a scene beside the records of sines.
fn shaken(text: &str, sines: &Sines) -> Simulation {
    let folder = tempfile::tempdir().unwrap();
    for axis in 0..3 {
        let mut rows = String::from("time_s,acceleration_m_s2\n");
        for i in 0..=4000 {
            let t = END_S * f64::from(i) / 4000.0;
            writeln!(rows, "{t:e},{:e}", base_m_s2(sines, t)[axis]).unwrap();
        }
        std::fs::write(folder.path().join(format!("{axis}.csv")), rows).unwrap();
    }
    let loaded = ndda_io::read::load_text("case.ron", text, &[], None).unwrap_or_else(|e| panic!("{e}"));
    let blocks = ndda::build::blocks(&loaded.scene, folder.path()).unwrap_or_else(|f| panic!("{f:?}"));
    let built = ndda::build::simulation(&loaded.scene, blocks, folder.path());
    built.unwrap_or_else(|faults| panic!("{faults:?}"))
}

/// Slip of a block over another after each step, as vectors; samples every hundredth.
fn slips(simulation: &mut Simulation, [block, base]: [BlockId; 2], steps: usize) -> Vec<Vec3> {
    let start = simulation.start_position().to_vec();
    let moved = |simulation: &Simulation, block: BlockId| {
        let nodes = simulation.blocks().nodes_of(block);
        let sum: Vec3 = nodes.clone().map(|n| simulation.state().position[n] - start[n]).sum();
        sum / nodes.len() as f64
    };
    simulation.sample().unwrap();
    (0..steps)
        .map(|step| {
            simulation.step().unwrap();
            if step % 100 == 99 {
                simulation.sample().unwrap();
            }
            moved(simulation, block) - moved(simulation, base)
        })
        .collect()
}

/// Slip of a rigid block after each step, by Coulomb's law in small steps. `split` divides what a block of 1 kg feels, gravity less the acceleration
/// of the base, into the part that drives it and the largest friction against that.
fn by_equation(
    sines: &Sines,
    (step_s, steps): (f64, usize),
    split: impl Fn(Vec3) -> (Vec3, f64),
) -> Vec<Vec3> {
    let dt = step_s / FINER as f64;
    let (mut slip, mut rate, mut slips) = (Vec3::zeros(), Vec3::zeros(), Vec::new());
    for i in 0..steps * FINER {
        let felt = Vec3::new(0.0, 0.0, -G) - base_m_s2(sines, (i as f64 + 0.5) * dt);
        let (drive, friction) = split(felt);
        // Friction takes away what it can of the slip that the drive would lead to, against its direction.
        let free = rate + dt * drive;
        rate = free * (1.0 - dt * friction / free.norm().max(dt * friction));
        slip += dt * rate;
        if (i + 1) % FINER == 0 {
            slips.push(slip);
        }
    }
    slips
}

/// Largest difference, and largest slip [m].
fn farthest(found: &[Vec3], exact: &[Vec3]) -> (f64, f64) {
    let largest = exact.iter().map(|u| u.norm()).fold(0.0, f64::max);
    (found.iter().zip(exact).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max), largest)
}

/// A rigid block on a base of some body that dips towards x.
fn on_a_plane(base: &str, dip_deg: f64, friction_deg: f64, step_s: f64) -> String {
    // Both turn about the middle of the base's upper face, on which the block lies.
    format!(
        "(title: \"plane\", time: (step_s: {step_s:e}, end_s: {END_S}), gravity_m_s2: (0, 0, -{G}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.2, density_kg_m3: 2500)],
          blocks: [
            (name: \"base\", material: \"rock\", body: {base}, turns: [(axis: (0, 1, 0), angle_deg: {dip_deg})],
             shape: Hexahedron(corners_m: ((-3, -3, -0.5), (3, -3, -0.5), (3, 3, -0.5), (-3, 3, -0.5),
                                           (-3, -3, 0), (3, -3, 0), (3, 3, 0), (-3, 3, 0)), cells: (3, 3, 1))),
            (name: \"block\", material: \"rock\", body: Rigid, turns: [(axis: (0, 1, 0), angle_deg: {dip_deg})],
             shape: Hexahedron(corners_m: ((-0.2, -0.2, 0), (0.2, -0.2, 0), (0.2, 0.2, 0), (-0.2, 0.2, 0),
                                           (-0.2, -0.2, 0.05), (0.2, -0.2, 0.05), (0.2, 0.2, 0.05), (-0.2, 0.2, 0.05)), cells: (2, 2, 1))),
          ],
          supports: [(block: \"base\", on: All, {HOLD})],
          contact: Potential(penalty_pa: 2e8, potential: Smooth(reference_m: 1), friction: (friction_deg: {friction_deg})))"
    )
}

#[test]
fn a_block_on_a_plane_slides_where_three_accelerations_drive_it() {
    for (dip_deg, friction_deg, sines) in [
        // Level ground shaken along a Lissajous figure: the slip never keeps its direction.
        (0.0, 15.0, [(0.5, 2.0), (0.4, 3.0), (0.0, 1.0)]),
        (20.0, 30.0, [(0.35, 2.0), (0.3, 3.0), (0.15, 4.0)]),
        (20.0, 30.0, [(0.1, 2.0), (0.45, 3.0), (0.3, 1.0)]),
    ] {
        let (sin, cos) = f64::to_radians(dip_deg).sin_cos();
        let normal = Vec3::new(sin, 0.0, cos);
        let friction = f64::to_radians(friction_deg).tan();
        let [x, y, z] = sines.map(|(part, _)| part);
        let what = |what: &str| {
            format!("{what}, dip {dip_deg}°, φ {friction_deg}°, {x}, {y} and {z} g along x, y and z")
        };
        for (base, step_s) in [("Fixed", 2e-4), ("Fixed", 5e-5), ("Elastic", 2e-4)] {
            let steps = (END_S / step_s).round() as usize;
            let exact = by_equation(&sines, (step_s, steps), |felt| {
                let pressed = -felt.dot(&normal);
                assert!(pressed > 0.0, "the block lifts off");
                (felt + pressed * normal, friction * pressed)
            });
            let mut simulation = shaken(&on_a_plane(base, dip_deg, friction_deg, step_s), &sines);
            simulation.settle(&Settle::new(1e-5, 40_000)).unwrap();
            let found = slips(&mut simulation, [BlockId(1), BlockId(0)], steps);
            let (error_m, largest_m) = farthest(&found, &exact);
            row(
                CASE,
                &what(&format!(
                    "largest error of the slip over the largest slip, {base} base, Δt = {step_s:e} s"
                )),
                error_m / largest_m,
                AtMost(PROMISED),
            );
            let label = verdict::label(&simulation, None);
            assert_eq!(label.word, LabelWord::Accurate, "{:?}", label.reasons);
        }
    }
}

#[test]
fn a_block_that_sticks_follows_its_base() {
    let sines = [(0.1, 2.0), (0.0, 1.0), (0.0, 1.0)];
    // ∫ a dt at its largest, after half a period.
    let fastest_m_s = 0.2 * G / (TAU * 2.0);
    for step_s in [2e-4, 5e-5] {
        let mut simulation = shaken(&on_a_plane("Fixed", 0.0, 30.0, step_s), &sines);
        simulation.settle(&Settle::new(1e-5, 40_000)).unwrap();
        let found = slips(&mut simulation, [BlockId(1), BlockId(0)], (0.3 / step_s).round() as usize);
        let lag_m = found.iter().map(|u| u.norm()).fold(0.0, f64::max);
        // Once it followed half a step late, by 0.5. Its mean velocity in a step is that of both ends, which differs from that of a sine by
        // (2π f Δt)²/12; and the block leans on its contact, by far less than it sinks.
        row(
            CASE,
            &format!("slip of a block that sticks, over the fastest base in a step, Δt = {step_s:e} s"),
            lag_m / (fastest_m_s * step_s),
            AtMost(5e-3),
        );
    }
}

/// Dips of the two planes of a wedge towards 50° and 130°.
const WEDGE_DIP_DEG: f64 = 50.0;

/// The wedge of `scenes/wedge_two_planes.ron` on a base that is shaken.
fn on_two_planes(friction: &str, penalty_pa: f64, step_s: f64) -> String {
    let n = normals();
    let beyond =
        |n: Vec3| format!("Beyond(point_m: (10.5, 0, 5.625), normal: ({:e}, {:e}, {:e})),", -n.x, -n.y, -n.z);
    let held: String =
        ["0001", "0002", "0003"].map(|n| format!("(block: \"slope_{n}\", on: All, {HOLD}),")).concat();
    format!(
        "(title: \"wedge\", time: (step_s: {step_s:e}, end_s: {WEDGE_END_S}), gravity_m_s2: (0, 0, -{G}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
          rock: [(
            name: \"slope\", material: \"rock\", body: Rigid,
            domain: Column(outline_m: [(0, 0), (12, 0), (12, 3), (8, 10), (0, 10)], axis: Y, start_m: -4, end_m: 4),
            joints: [
              Plane(name: \"left\", dip_deg: {WEDGE_DIP_DEG}, dip_direction_deg: 50, point_m: (10.5, 0, 5.625)),
              Plane(name: \"right\", dip_deg: {WEDGE_DIP_DEG}, dip_direction_deg: 130, point_m: (10.5, 0, 5.625)),
            ],
            fixed: [{}{}],
          )],
          supports: [{held}],
          contact: Potential(penalty_pa: {penalty_pa:e}, potential: Smooth(reference_m: 1), friction: ({friction}), restitution: 0.3))",
        beyond(n[0]),
        beyond(n[1])
    )
}

/// Upward normals of the two planes: x is east, y is north.
fn normals() -> [Vec3; 2] {
    let (sin, cos) = WEDGE_DIP_DEG.to_radians().sin_cos();
    [50.0f64, 130.0].map(|towards| {
        let (east, north) = towards.to_radians().sin_cos();
        Vec3::new(sin * east, sin * north, cos)
    })
}

/// Slips of a wedge along its line, by the run and by the equation, after each step [m], and whether the run is called accurate.
fn slips_of_a_wedge(
    sines: &Sines,
    (friction_deg, spring): (f64, &str),
    (penalty_pa, step_s): (f64, f64),
) -> (Vec<f64>, Vec<f64>, LabelWord) {
    let steps = (WEDGE_END_S / step_s).round() as usize;
    let [a, b] = normals();
    let mut line = a.cross(&b).normalize();
    line *= -line.z.signum();
    let friction = f64::to_radians(friction_deg).tan();
    let exact = by_equation(sines, (step_s, steps), |felt| {
        let along = felt.dot(&line) * line;
        // felt − along = −(N_a a + N_b b): two equations for the pressures of the two planes.
        let (across, cos) = (along - felt, a.dot(&b));
        let [on_a, on_b] = [a, b].map(|n| across.dot(&n));
        let [n_a, n_b] = [on_a - cos * on_b, on_b - cos * on_a].map(|n| n / (1.0 - cos * cos));
        assert!(n_a > 0.0 && n_b > 0.0, "the wedge leaves a plane: {n_a}, {n_b}");
        (along, friction * (n_a + n_b))
    });
    let law = format!("friction_deg: {friction_deg}{spring}");
    let mut simulation = shaken(&on_two_planes(&law, penalty_pa, step_s), sines);
    let wedge = simulation.blocks().ids().find(|&id| simulation.shape(id).is_free()).expect("a wedge");
    let base = BlockId(u32::from(wedge == BlockId(0)));
    let found = slips(&mut simulation, [wedge, base], steps);
    let label = verdict::label(&simulation, None);
    let along = |slips: &[Vec3]| slips.iter().map(|u| u.dot(&line)).collect();
    (along(&found), along(&exact), label.word)
}

#[test]
fn a_wedge_slides_along_its_line_under_three_accelerations() {
    for sines in [[(0.3, 2.0), (0.1, 3.0), (0.1, 4.0)], [(0.25, 3.0), (0.15, 2.0), (-0.2, 1.0)]] {
        let (found, exact, label) = slips_of_a_wedge(&sines, (25.0, ""), (2e9, 2e-4));
        let [x, y, z] = sines.map(|(part, _)| part);
        let error_m = found.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let largest_m = exact.iter().copied().fold(0.0, f64::max);
        row(
            CASE,
            &format!(
                "largest error of the slip over the largest slip, wedge, φ 25°, {x}, {y} and {z} g along x, y and z"
            ),
            error_m / largest_m,
            AtMost(PROMISED),
        );
        assert_eq!(label, LabelWord::Accurate);
    }
}

/// While a wedge rests, friction may point across its line of sliding, too, and presses it into its planes: Coulomb's law leaves open how much of
/// that there is. The equation has none. Joints with shear springs lose it within the stretch of their springs, 0.3 % of the slip, and follow the
/// equation; friction on velocities keeps it while the wedge rests, which therefore slides later, and not as far.
#[test]
fn a_wedge_that_sticks_between_slips_follows_the_equation_if_its_joints_have_shear_springs() {
    for sines in [
        [(0.3, 2.0), (0.1, 3.0), (0.1, 4.0)],
        [(0.25, 3.0), (0.15, 2.0), (-0.2, 1.0)],
        [(0.3, 4.0), (0.0, 3.0), (0.1, 4.0)],
    ] {
        let [x, y, z] = sines.map(|(part, _)| part);
        for (law, spring, answer) in [
            ("shear springs of 1e9 Pa/m", ", shear_penalty_pa_m: 1e9", Near(0.0, 1e-2)),
            ("friction on velocities", "", Near(-0.03, 0.03)),
        ] {
            let (found, exact, label) = slips_of_a_wedge(&sines, (42.0, spring), (2e10, 5e-5));
            let (found_m, exact_m) = (found[found.len() - 1], exact[exact.len() - 1]);
            row(
                CASE,
                &format!(
                    "slip over that of the equation, less 1, wedge, φ 42°, {law}, {x}, {y} and {z} g along x, y and z"
                ),
                found_m / exact_m - 1.0,
                answer,
            );
            assert_eq!(label, LabelWord::Accurate);
        }
    }
}
