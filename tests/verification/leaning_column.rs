//! A column whose weight acts near the edge of its base leans, since contact gives way there, and may fall although a rigid edge would hold it.
//!
//! Its weight N acts d inside the edge, and a strip of 3 d carries it, with pressures from zero to 2 N/(3 d w) at the edge. Contact gives way by
//! N L₀/(3 d w k_n) there, so that the column tilts by θ = N L₀/(9 k_n w d²), and its weight, H/2 above the base, moves towards the edge by
//! θ (1 + tan²α) H/2. With x for what is left of d, x² (1 − x) = M = N H L₀ (1 + tan²α)/(18 k_n w d³), which has an answer up to M = 4/27.

use std::path::Path;

use ndda::Model;
use ndda::forecast::doubts::doubts;
use ndda_mesh::{BlockId, Vec3};
use ndda_solver::{Settle, Simulation};

use crate::evidence::Answer::{AtLeast, Within};
use crate::evidence::row;
use crate::simulation;

const HEIGHT_M: f64 = 4.0;
const WIDTH_M: f64 = 1.0;
/// Distance of the weight from the edge without a tilt [m].
const INSIDE_M: f64 = 0.1;
const G: f64 = 9.81;
const DENSITY: f64 = 2500.0;
const MOST: f64 = 4.0 / 27.0;

/// Tangent of the angle by which gravity is tilted.
fn slope() -> f64 {
    (0.5 * WIDTH_M - INSIDE_M) / (0.5 * HEIGHT_M)
}

/// The column in one piece or in equal ones, on level ground under gravity and other loads, with a penalty.
fn column_under(pieces: usize, gravity_m_s2: [f64; 2], loads: &str, penalty_pa: f64) -> Simulation {
    simulation(&scene_of(pieces, gravity_m_s2, loads, penalty_pa))
}

fn scene_of(pieces: usize, gravity_m_s2: [f64; 2], loads: &str, penalty_pa: f64) -> String {
    let [along, up] = gravity_m_s2;
    let height_m = HEIGHT_M / pieces as f64;
    let piece = |k: usize| {
        let at_m = k as f64 * height_m;
        format!(
            "(name: \"column_{k}\", material: \"rock\", body: Rigid, shape: Box(size_m: ({WIDTH_M}, 1, {height_m}), cells: (1, 1, 1)), at_m: (0, 0, {at_m})),"
        )
    };
    let pieces: String = (0..pieces).map(piece).collect();
    format!(
        "(title: \"column\", time: (step_s: 1e-3, end_s: 1), gravity_m_s2: ({along}, 0, {up}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: {DENSITY})],
          blocks: [
              (name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (4, 3, 1), cells: (1, 1, 1)), at_m: (-1, -1, -1)),
              {pieces}
          ],
          {loads}
          contact: Potential(penalty_pa: {penalty_pa:e}, potential: Smooth(reference_m: 1), friction: (friction_deg: 60)))"
    )
}

/// The column under tilted gravity, with the penalty of this M.
fn column(m: f64) -> Simulation {
    column_of(1, penalty_pa(m))
}

/// The penalty of this M of the column under tilted gravity.
fn penalty_pa(m: f64) -> f64 {
    let secant2 = 1.0 + slope() * slope();
    let normal_n = DENSITY * G * HEIGHT_M * WIDTH_M / secant2.sqrt();
    normal_n * HEIGHT_M * secant2 / (18.0 * INSIDE_M.powi(3) * m)
}

/// The column in so many pieces under tilted gravity.
fn column_of(pieces: usize, penalty_pa: f64) -> Simulation {
    let secant = slope().hypot(1.0);
    column_under(pieces, [G * slope() / secant, -G / secant], "", penalty_pa)
}

/// Tilt of the column, or of a piece of it [rad].
fn tilt(simulation: &Simulation, block: u32) -> f64 {
    let nodes = simulation.blocks().nodes_of(BlockId(block));
    let (rest, now) =
        (&simulation.blocks().rest_position[nodes.clone()], &simulation.state().position[nodes]);
    let [low_m, high_m] =
        rest.iter().fold([f64::MAX, f64::MIN], |[low, high], x| [low.min(x.z), high.max(x.z)]);
    let corner = |z: f64| {
        let at = Vec3::new(0.0, 0.0, z);
        now[rest.iter().position(|x| (x - at).norm() < 1e-9).expect("a corner")]
    };
    let side = corner(high_m) - corner(low_m);
    side.x.atan2(side.z)
}

/// The larger x with x² (1 − x) = M.
fn left(m: f64) -> f64 {
    let (mut low, mut high) = (2.0 / 3.0, 1.0);
    for _ in 0..60 {
        let x = 0.5 * (low + high);
        (low, high) = if x * x * (1.0 - x) > m { (x, high) } else { (low, x) };
    }
    low
}

#[test]
fn a_column_leans_by_what_contact_gives_way_at_its_edge() {
    for m in [0.03, 0.1] {
        let mut simulation = column(m);
        simulation.settle(&Settle::new(1e-6, 100_000)).unwrap();
        let secant2 = 1.0 + slope() * slope();
        let exact = (1.0 - left(m)) * INSIDE_M / (0.5 * HEIGHT_M * secant2);
        row(
            "leaning column",
            &format!("tilt at M = {m} [rad]"),
            tilt(&simulation, 1),
            // The strip is as wide as the contact is deep at the edge, θ of its 3 d, times the slope: of first order in θ.
            Within(exact, 0.02),
        );
    }
}

/// The column under gravity that is tilted so that its weight acts 0.1 m from the middle of its base, with the penalty for R; also that penalty, N and the arm.
fn column_in_the_middle(r: f64) -> (Simulation, [f64; 3]) {
    let level = 0.1 / (0.5 * HEIGHT_M);
    let secant = level.hypot(1.0);
    let (normal_n, arm_m) = (DENSITY * G * HEIGHT_M * WIDTH_M / secant, 0.5 * HEIGHT_M * secant * secant);
    let penalty_pa = 6.0 * normal_n * arm_m / (r * WIDTH_M.powi(3));
    let simulation = column_under(1, [G * level / secant, -G / secant], "", penalty_pa);
    (simulation, [penalty_pa, normal_n, arm_m])
}

/// The side that goes deepest, by d, presses by k_n d²/2 on the floor, and its friction of 60° resists the tilt by the moment of half of the width at most.
#[test]
fn a_column_whose_weight_acts_in_the_middle_third_leans_by_the_tilt_of_its_whole_base() {
    for r in [0.1, 0.3] {
        let (mut simulation, [penalty_pa, normal_n, arm_m]) = column_in_the_middle(r);
        simulation.settle(&Settle::new(1e-6, 100_000)).unwrap();
        let exact = r / (1.0 - r) * 0.1 / arm_m;
        let deepest_m = 0.5 * normal_n / penalty_pa + 0.5 * WIDTH_M * exact;
        let held_n_m = 3_f64.sqrt() * 0.5 * penalty_pa * deepest_m.powi(2) * 0.5 * WIDTH_M;
        let bound = held_n_m / (normal_n * 0.1);
        let name = format!("tilt with the weight in the middle third, R = {r} [rad]");
        row("leaning column", &name, tilt(&simulation, 1), Within(exact, bound));
    }
    let (mut simulation, _) = column_in_the_middle(0.6);
    let settled = simulation.settle(&Settle::new(1e-6, 20_000));
    assert!(settled.is_err(), "{settled:?}");
    // Its weight has passed the edge.
    let over = 0.4 / (0.5 * HEIGHT_M);
    row("leaning column", "the same at R = 0.6 [rad]", tilt(&simulation, 1).abs(), AtLeast(over));
}

#[test]
fn beyond_four_parts_of_27_it_falls_although_its_weight_acts_inside_the_edge() {
    let mut simulation = column(1.25 * MOST);
    let settled = simulation.settle(&Settle::new(1e-6, 20_000));
    assert!(settled.is_err(), "{settled:?}");
    // A rigid edge lets it go where its weight has passed the edge.
    let over = INSIDE_M / (0.5 * HEIGHT_M);
    row("leaning column", "tilt at M = 0.185 [rad]", tilt(&simulation, 1).abs(), AtLeast(over));
}

/// A force F at a height h_F on the far side of the column, which is pushed towards the edge until the line of weight and force is d inside: of
/// the tilt, the weight moves by H/2, and the force, whose point sinks, by (B − d) F/N.
#[test]
fn a_column_that_is_pushed_leans_as_one_under_tilted_gravity() {
    let weight_n = DENSITY * G * HEIGHT_M * WIDTH_M;
    let (at_m, m) = (3.0, 0.1);
    let force_n = weight_n * (0.5 * WIDTH_M - INSIDE_M) / at_m;
    let arm_m = 0.5 * HEIGHT_M + (WIDTH_M - INSIDE_M) * force_n / weight_n;
    let force =
        format!("forces: [(block: \"column_0\", at_m: (0, 0.5, {at_m}), force_n: ({force_n}, 0, 0))],");
    let penalty_pa = weight_n * arm_m / (9.0 * INSIDE_M.powi(3) * m);
    let mut simulation = column_under(1, [0.0, -G], &force, penalty_pa);
    simulation.settle(&Settle::new(1e-6, 100_000)).unwrap();
    let exact = (1.0 - left(m)) * INSIDE_M / arm_m;
    row(
        "leaning column",
        "tilt of a column that is pushed, at M = 0.1 [rad]",
        tilt(&simulation, 1),
        Within(exact, 0.02),
    );
}

/// A traction on the far side acts as a force in its middle: `ndda check` foresees how far the weight moves, and that it falls.
#[test]
fn a_column_under_a_traction_leans_and_falls_as_the_check_foresees() {
    let weight_n = DENSITY * G * HEIGHT_M * WIDTH_M;
    let force_n = weight_n * (0.5 * WIDTH_M - INSIDE_M) / (0.5 * HEIGHT_M);
    let arm_m = 0.5 * HEIGHT_M + (WIDTH_M - INSIDE_M) * force_n / weight_n;
    let traction_pa = force_n / HEIGHT_M;
    let loads = format!(
        "tractions: [(block: \"column_0\", on: Set(\"x_min\"), traction_pa: ({traction_pa}, 0, 0))],"
    );
    for (m, stands) in [(0.1, true), (1.25 * MOST, false)] {
        let penalty_pa = weight_n * arm_m / (9.0 * INSIDE_M.powi(3) * m);
        let loaded =
            ndda_io::read::load_text("column.ron", &scene_of(1, [0.0, -G], &loads, penalty_pa), &[], None)
                .unwrap();
        let scene = loaded.scene.clone();
        let mut simulation = Model::new(loaded, Path::new(".")).unwrap().simulation;
        let doubts = doubts(&scene, &simulation, None, None, Path::new("."));
        let foreseen = match stands {
            true => format!("moves {:.1} % of the way to the edge", 100.0 * (1.0 - left(m))),
            false => "the block falls, although a rigid edge would hold it".to_string(),
        };
        assert!(doubts.iter().any(|doubt| doubt.contains(&foreseen)), "{foreseen}: {doubts:?}");
        let settled = simulation.settle(&Settle::new(1e-6, 20_000));
        assert_eq!(settled.is_ok(), stands, "{settled:?}");
        let tilt = tilt(&simulation, 1);
        match stands {
            true => {
                let exact = (1.0 - left(m)) * INSIDE_M / arm_m;
                let name = "tilt of a column under a traction, at M = 0.1 [rad]";
                row("leaning column", name, tilt, Within(exact, 0.02));
            }
            false => {
                let over = INSIDE_M / (0.5 * HEIGHT_M);
                row(
                    "leaning column",
                    "tilt of a column that a traction pushes over, at M = 0.185 [rad]",
                    tilt.abs(),
                    AtLeast(over),
                );
            }
        }
    }
}

/// Tilts of equal pieces of the column under tilted gravity [rad], the lowest first, joint by joint until they change no more. The force on a joint meets it where the tilts
/// of all pieces above take it; where it does so in the middle third, all of the joint bears, with a slope of pressures of 12 N e/(w B³) for an eccentricity e.
fn tilts_of_pieces(pieces: usize, penalty_pa: f64) -> Vec<f64> {
    let (height_m, secant2) = (HEIGHT_M / pieces as f64, 1.0 + slope() * slope());
    let piece_n = DENSITY * G * height_m * WIDTH_M / secant2.sqrt();
    let mut tilts = vec![0.0; pieces];
    for _ in 0..500 {
        let mut below = 0.0;
        for joint in 0..pieces {
            let above = (pieces - joint) as f64;
            let moved = |piece: usize| {
                let full: f64 = tilts[joint..piece].iter().sum();
                height_m * (full + 0.5 * tilts[piece])
            };
            let moved_m = secant2 * (joint..pieces).map(moved).sum::<f64>() / above;
            let inside_m = 0.5 * WIDTH_M - 0.5 * above * height_m * slope() - moved_m;
            let per_width = above * piece_n / penalty_pa;
            let parted = match 3.0 * inside_m < WIDTH_M {
                true => per_width / (9.0 * inside_m * inside_m),
                false => 6.0 * per_width * (0.5 * WIDTH_M - inside_m) / WIDTH_M.powi(3),
            };
            below += parted;
            tilts[joint] = below;
        }
    }
    tilts
}

/// Joints across the column change its fall little: the lowest one bears all of the weight, with the longest arm.
#[test]
fn a_column_in_four_pieces_leans_by_what_each_of_its_joints_gives_way() {
    let penalty_pa = penalty_pa(0.05);
    let mut simulation = column_of(4, penalty_pa);
    simulation.settle(&Settle::new(1e-6, 100_000)).unwrap();
    for (exact, block) in tilts_of_pieces(4, penalty_pa).into_iter().zip(1..) {
        let name = format!("tilt of piece {block} of a column in four, M = 0.05 [rad]");
        row("leaning column", &name, tilt(&simulation, block), Within(exact, 0.02));
    }
}

/// Places of pressure across a base, along each axis.
const CELLS: usize = 600;

/// Tilt of a body that weighs N, h high, on a base that is the convex polygon of these points, under a level part a/g of gravity, by sums over a grid of cells: pressures
/// 2 k_n θ (x − x₀)/L₀ beyond x₀ carry N, and N (a/g + θ) h is their moment.
fn tilt_on(points: &[[f64; 2]], weight_n: f64, height_m: f64, level: f64, penalty_pa: f64) -> f64 {
    let radius_m = points.iter().fold(0.0_f64, |most, p| most.max(p[0].hypot(p[1])));
    let cell_m = 2.0 * radius_m / CELLS as f64;
    let at = |k: usize| -radius_m + (k as f64 + 0.5) * cell_m;
    let is_inside = |x: f64, y: f64| {
        (0..points.len()).all(|k| {
            let (p, q) = (points[k], points[(k + 1) % points.len()]);
            (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]) >= 0.0
        })
    };
    let widths: Vec<(f64, f64)> = (0..CELLS)
        .map(|i| (at(i), cell_m * (0..CELLS).filter(|j| is_inside(at(i), at(*j))).count() as f64))
        .collect();
    let sums = |from_m: f64| {
        widths.iter().filter(|(x, _)| *x > from_m).fold([0.0; 2], |[one, two], (x, width_m)| {
            let part = (x - from_m) * width_m * cell_m;
            [one + part, two + part * x]
        })
    };
    // From all of the base inwards, the first x₀ whose moment is that of the weight.
    let mut from_m = -50.0 * radius_m;
    loop {
        let [one, two] = sums(from_m);
        let tilt = weight_n / (2.0 * penalty_pa * one);
        if two / one >= (level + tilt) * height_m {
            return tilt;
        }
        from_m += 1e-3 * if from_m < -radius_m { from_m.abs() } else { radius_m };
    }
}

#[test]
fn a_drum_leans_by_the_pressures_on_its_polygon() {
    let (height_m, level, penalty_pa) = (4.0, 0.19, 2e9);
    let mut simulation = simulation(&format!(
        "(title: \"drum\", time: (step_s: 1e-3, end_s: 1), gravity_m_s2: ({}, 0, -{G}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: {DENSITY})],
          blocks: [
              (name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (4, 4, 1), cells: (1, 1, 1)), at_m: (-2, -2, -1)),
              (name: \"drum\", material: \"rock\", body: Rigid, shape: Cylinder(radius_m: 0.5, height_m: {height_m}, cells: (2, 1))),
          ],
          contact: Potential(penalty_pa: {penalty_pa:e}, potential: Smooth(reference_m: 1), friction: (friction_deg: 60)))",
        G * level
    ));
    let nodes = simulation.blocks().nodes_of(BlockId(1));
    let rest = simulation.blocks().rest_position[nodes.clone()].to_vec();
    let mut points: Vec<[f64; 2]> =
        rest.iter().filter(|x| x.z.abs() < 1e-9 && x.x.hypot(x.y) > 0.4).map(|x| [x.x, x.y]).collect();
    points.sort_by(|p, q| p[1].atan2(p[0]).total_cmp(&q[1].atan2(q[0])));
    let mass_kg = simulation.shape(BlockId(1)).operator.mass_kg;
    simulation.settle(&Settle::new(1e-6, 100_000)).unwrap();
    let now = &simulation.state().position[nodes];
    let node = |z: f64| {
        let at = |x: &Vec3| x.x.hypot(x.y) < 1e-9 && (x.z - z).abs() < 1e-9;
        now[rest.iter().position(at).expect("a node on the axis")]
    };
    let axis = node(height_m) - node(0.0);
    let exact = tilt_on(&points, mass_kg * G, 0.5 * height_m, level, penalty_pa);
    // Of first order in the tilt, as that of the column.
    row("leaning column", "tilt of a drum on its polygon [rad]", axis.x.atan2(axis.z), Within(exact, 0.02));
}

/// A square turned by 45°, so that it leans over a corner.
#[test]
fn a_column_leans_over_its_corner_by_the_pressures_on_a_triangle() {
    let (half_m, inside_m, m) = (0.5_f64.sqrt(), 0.02_f64.sqrt(), 0.05);
    let level = (half_m - inside_m) / (0.5 * HEIGHT_M);
    let weight_n = DENSITY * G * HEIGHT_M;
    let penalty_pa = 3.0 * weight_n * 0.5 * HEIGHT_M * (1.0 + level * level) / (16.0 * inside_m.powi(4) * m);
    let mut simulation = simulation(&format!(
        "(title: \"corner\", time: (step_s: 1e-3, end_s: 1), gravity_m_s2: ({}, 0, -{G}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: {DENSITY})],
          blocks: [
              (name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (4, 4, 1), cells: (1, 1, 1)), at_m: (-2, -1, -1)),
              (name: \"column\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, {HEIGHT_M}), cells: (1, 1, 1)), turns: [(axis: (0, 0, 1), angle_deg: 45)]),
          ],
          contact: Potential(penalty_pa: {penalty_pa:e}, potential: Smooth(reference_m: 1), friction: (friction_deg: 60)))",
        G * level
    ));
    simulation.settle(&Settle::new(1e-6, 100_000)).unwrap();
    let corners = [[half_m, 0.0], [0.0, half_m], [-half_m, 0.0], [0.0, -half_m]];
    let exact = tilt_on(&corners, weight_n, 0.5 * HEIGHT_M, level, penalty_pa);
    // Of first order in the tilt, as that of the column.
    row(
        "leaning column",
        "tilt of a column over its corner [rad]",
        tilt(&simulation, 1),
        Within(exact, 0.02),
    );
}
