//! An elastic block on a plane with undamped contact: it stands where it has to, and slides as a rigid one does.
//!
//! Friction that stops only the mean slip of a face leaves its points free to slip against each other. If it follows the pressure, or if parts of the face
//! open and close, vibrations grow until the block walks down the plane, whatever its friction angle.

use ndda::judge::verdict;
use ndda::summary::LabelWord;
use ndda_mesh::Vec3;
use ndda_solver::Simulation;

use crate::evidence::Answer::{AtMost, Near};
use crate::evidence::row;
use crate::{advance, displacements, simulation};

const RAMP_S: f64 = 0.05;
const YOUNG_PA: f64 = 5e9;
const DENSITY_KG_M3: f64 = 2600.0;
const HEIGHT_M: f64 = 0.5;
/// Gravity along a plane of 25° and across it [m/s²].
const ALONG_M_S2: f64 = 4.145_845;
const ACROSS_M_S2: f64 = 8.890_879;

#[derive(Clone, Copy)]
struct Case {
    what: &'static str,
    potential: &'static str,
    penalty_pa: f64,
    poisson: f64,
    step_s: f64,
    floor_cells: &'static str,
}

const CASE: Case = Case {
    what: "penalty E",
    potential: "Smooth()",
    penalty_pa: YOUNG_PA,
    poisson: 0.2,
    step_s: 2e-5,
    floor_cells: "(4, 2, 2)",
};

fn block(case: &Case, friction_deg: f64) -> Simulation {
    simulation(&scene(case, friction_deg, RAMP_S, 1.0))
}

fn scene(case: &Case, friction_deg: f64, ramp_s: f64, restitution: f64) -> String {
    let Case { potential, penalty_pa, poisson, step_s, floor_cells, .. } = case;
    format!(
        "(title: \"block\", time: (step_s: {step_s:e}, end_s: 1), gravity_m_s2: ({ALONG_M_S2}, 0, -{ACROSS_M_S2}), gravity_ramp_s: {ramp_s},
          materials: [(name: \"rock\", young_pa: {YOUNG_PA:e}, poisson: {poisson}, density_kg_m3: {DENSITY_KG_M3})],
          blocks: [
              (name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (3, 2, 0.5), cells: {floor_cells}), at_m: (-0.5, -0.5, -0.5)),
              (name: \"block\", material: \"rock\", shape: Box(size_m: (1.5, 1, {HEIGHT_M}), cells: (4, 3, 2))),
          ],
          contact: Potential(penalty_pa: {penalty_pa:e}, potential: {potential}, friction: (friction_deg: {friction_deg}), restitution: {restitution}))"
    )
}

/// Mean displacement of the nodes of the block [m].
fn moved_m(block: &Simulation) -> Vec3 {
    let moved = displacements(block);
    let nodes = block.blocks().nodes_of(ndda_mesh::BlockId(1));
    moved[nodes.clone()].iter().sum::<Vec3>() / nodes.len() as f64
}

/// Shear and compression of the block under its own weight, γ h²/2 (sin/G + cos/E) [m].
fn elastic_m(poisson: f64) -> f64 {
    let shear_pa = YOUNG_PA / (2.0 * (1.0 + poisson));
    0.5 * DENSITY_KG_M3 * HEIGHT_M * HEIGHT_M * (ALONG_M_S2 / shear_pa + ACROSS_M_S2 / YOUNG_PA)
}

#[test]
fn it_stands_however_stiff_the_contact_and_whatever_the_mesh_of_the_floor() {
    let stiff = Case { what: "penalty 10 E", penalty_pa: 10.0 * YOUNG_PA, step_s: 1e-5, ..CASE };
    let cases = [
        (CASE, 80.0, 0.1),
        (stiff, 26.0, 0.15),
        (Case { what: "penalty 10 E, floor of two triangles", floor_cells: "(1, 1, 1)", ..stiff }, 80.0, 0.1),
        (Case { what: "penalty 10 E, ν = 0.45", poisson: 0.45, ..stiff }, 80.0, 0.15),
        (
            Case { what: "potential of elements", potential: "Element", penalty_pa: YOUNG_PA, ..stiff },
            26.0,
            0.1,
        ),
    ];
    for (case, friction_deg, end_s) in &cases {
        let mut block = block(case, *friction_deg);
        advance(&mut block, (end_s / case.step_s).round() as u64);
        // Sudden load and compliance of contact may double it.
        let elastic_m = elastic_m(case.poisson);
        let what = format!(
            "displacement of a block that stands, φ = {friction_deg}°, {}, over γ h²/2 (sin/G + cos/E)",
            case.what
        );
        let along_m = moved_m(&block).x;
        row("elastic block on a slope", &what, along_m / elastic_m, AtMost(2.0));
    }
}

#[test]
fn where_it_chatters_on_undamped_contact_the_label_says_so() {
    // Gravity acts suddenly on a block that stands, F = 1.046.
    for (restitution, chatters) in [(1.0, true), (0.5, false)] {
        let mut block = simulation(&scene(&CASE, 26.0, 0.0, restitution));
        block.sample().unwrap();
        advance(&mut block, 10_000);
        block.sample().unwrap();
        let label = verdict::label(&block, None);
        let says = label.reasons.iter().any(|reason| reason.contains("lost contact and regained it"));
        assert_eq!((says, label.word == LabelWord::Inaccurate), (chatters, chatters), "{:?}", label.reasons);
    }
}

#[test]
fn it_slides_like_a_rigid_block() {
    let (case, end_s) = (CASE, 0.2);
    let mut block = block(&case, 20.0);
    advance(&mut block, (end_s / case.step_s).round() as u64);
    // The load grows as t/T until T, and is constant from then on.
    let rest_s = end_s - RAMP_S;
    let time2_s2 = RAMP_S.powi(2) / 6.0 + 0.5 * RAMP_S * rest_s + 0.5 * rest_s * rest_s;
    let exact_m = (ALONG_M_S2 - ACROSS_M_S2 * 20f64.to_radians().tan()) * time2_s2;
    let what = format!("way of a block that slides, φ = 20°, {}, over that of a rigid one", case.what);
    // It deforms as it slides, as much as one that stands at most; twice that in vibrations.
    let deforms = 2.0 * elastic_m(case.poisson) / exact_m;
    row("elastic block on a slope", &what, moved_m(&block).x / exact_m, Near(1.0, deforms));
}
