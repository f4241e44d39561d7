//! Blocks that may pass through each other between two evaluations of contact: relative travel in a step over the width of the
//! thinner block, for pairs that may meet.

use ndda::judge::verdict;
use ndda::summary::LabelWord;
use ndda_solver::Simulation;

use crate::evidence::Answer::{AtLeast, AtMost, Near};
use crate::evidence::row;
use crate::simulation;

/// Largest relative travel over width that a label accepts.
const LIMIT: f64 = 0.5;

/// Whether the label of a run says that blocks may have passed through each other.
fn is_doubted(simulation: &Simulation) -> bool {
    let label = verdict::label(simulation, None);
    label.reasons.iter().any(|reason| reason.contains("passed through each other"))
}

/// Two rigid boxes of 1 m and of `width_m`, that far apart along x, with these velocities and a common one along y.
fn pair(width_m: f64, gap_m: f64, speeds_m_s: [f64; 2], dt_s: f64) -> Simulation {
    let [first, second] = speeds_m_s;
    simulation(&format!(
        "(title: \"pair\", time: (step_s: {dt_s:e}, end_s: 1),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.2, density_kg_m3: 2500)],
          blocks: [
            (name: \"block\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (3, 2, 4)), velocity_m_s: ({first:e}, 50, 0)),
            (name: \"plate\", material: \"rock\", body: Rigid, shape: Box(size_m: ({width_m:e}, 1, 1), cells: (3, 1, 7)), at_m: ({:e}, 0, 0), velocity_m_s: ({second:e}, 50, 0)),
          ],
          contact: Potential(penalty_pa: 1e8, potential: Smooth()))",
        1.0 + gap_m
    ))
}

#[test]
fn it_is_the_way_by_which_two_blocks_approach_over_the_width_of_the_thinner_one() {
    let mut worst = 0.0f64;
    for (width_m, ratio) in
        [(0.5, 0.2), (0.5, 0.499), (0.5, 0.501), (0.02, 0.499), (0.02, 0.501), (1.0, 20.0)]
    {
        let dt_s = 1e-3;
        let speed_m_s = ratio * width_m / dt_s;
        for shares in [[1.0, 0.0], [0.25, -0.75]] {
            let gap_m = 0.9 * speed_m_s * dt_s;
            let mut pair = pair(width_m, gap_m, shares.map(|share: f64| share * speed_m_s), dt_s);
            let report = pair.step().unwrap();
            worst = worst.max((report.travel.value / ratio - 1.0).abs());
            let thinner = report.travel.block;
            assert!(width_m == 1.0 || thinner == 1, "{width_m} m: {thinner}");
            assert_eq!(is_doubted(&pair), ratio > LIMIT, "{width_m} m, {ratio}");
        }
    }
    // A width of 0.02 m is the difference of places of a metre that are rounded to ε: twentyfold.
    let rounds = 20.0 * f64::EPSILON / 0.02;
    row("travel", "v Δt/w of two boxes, error relative to it", worst, AtMost(rounds));
}

#[test]
fn blocks_that_cannot_meet_or_move_together_are_not_doubted() {
    // A step takes them 2 widths, but not to each other; and together.
    let mut apart = pair(0.5, 2.1, [1000.0, 0.0], 1e-3);
    let mut together = pair(0.5, 0.0, [1000.0, 1000.0], 1e-3);
    for pair in [&mut apart, &mut together] {
        pair.step().unwrap();
        assert!(!is_doubted(pair));
    }
}

#[test]
fn slivers_that_contact_of_rigid_cells_does_not_see_do_not_shorten_steps() {
    let cells = |step: &str| {
        simulation(&format!(
            "(title: \"cells\", time: (step_s: 1e-4, end_s: 1, step: {step}), gravity_m_s2: (0, 0, -9.8),
              materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
              blocks: [(name: \"floor\", material: \"rock\", body: Fixed, at_m: (-3, -3, -1),
                        shape: Box(size_m: (6, 6, 1), cells: (6, 6, 1), pattern: TwentyFour))],
              rock: [(name: \"cell\", material: \"rock\", body: Rigid, domain: Box(min_m: (-2, -2, 0), max_m: (2, 2, 5.4)),
                      voronoi: (count: 400), seed: 9, fill: Centre)],
              contact: Potential(penalty_pa: 1e9, potential: Smooth()))"
        ))
    };
    let mut fixed = cells("Fixed");
    let heights = fixed.blocks().ids().map(|block| fixed.shape(block).smallest_height_m);
    let smallest_m = heights.fold(f64::INFINITY, f64::min);
    let mut auto = cells("Auto()");
    for run in [&mut fixed, &mut auto] {
        run.sample().unwrap();
        for _ in 0..100 {
            run.step().unwrap();
        }
        run.sample().unwrap();
    }
    let speed_m_s = fixed.state().velocity.iter().map(|v| v.norm()).fold(0.0, f64::max);
    let over_height = speed_m_s * 1e-4 / smallest_m;
    row(
        "travel",
        "400 rigid Voronoi cells: travel of a step over the smallest tetrahedron",
        over_height,
        AtLeast(2.0),
    );
    let (fixed, auto) = (fixed.invariants(), auto.invariants());
    row(
        "travel",
        "… over the width of a cell that may meet another, at most",
        fixed.max_travel.value,
        AtMost(LIMIT),
    );
    row("travel", "… most halvings of a step of 1e-4 s", f64::from(auto.control.most_halvings), AtMost(2.0));
}

#[test]
fn wide_plates_that_pass_through_each_other_are_never_called_accurate() {
    // A plate 0.02 m thick meets its equal, which is held, faster than its contact can stop: all of ½ m v² is more than the
    // potential stores.
    for (body, cells) in
        [("Rigid", "(1, 8, 8)"), ("Affine", "(1, 1, 1)"), ("Elastic", "(1, 1, 1)"), ("Elastic", "(1, 8, 8)")]
    {
        let mut plates = simulation(&format!(
            "(title: \"plates\", time: (step_s: 1e-4, end_s: 1),
              materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
              blocks: [
                (name: \"flying\", material: \"rock\", body: {body}, shape: Box(size_m: (0.02, 2, 2), cells: {cells}), velocity_m_s: (5, 0, 0)),
                (name: \"held\", material: \"rock\", body: Fixed, shape: Box(size_m: (0.02, 2, 2), cells: {cells}), at_m: (0.03, 0, 0)),
              ],
              contact: Potential(penalty_pa: 2e6, potential: Smooth()))"
        ));
        plates.sample().unwrap();
        for _ in 0..400 {
            plates.step().unwrap();
        }
        plates.sample().unwrap();
        let nodes = plates.blocks().nodes_of(ndda_mesh::BlockId(0));
        let gone = plates.state().position[nodes.clone()].iter().zip(&plates.start_position()[nodes.clone()]);
        let gone_m = gone.map(|(x, start)| x.x - start.x).sum::<f64>() / nodes.len() as f64;
        row(
            "travel",
            &format!("way of a {body} plate of {cells} cells through another [m]"),
            gone_m,
            Near(0.2, 0.01),
        );
        assert_ne!(verdict::label(&plates, None).word, LabelWord::Accurate, "{body} {cells}");
    }
}
