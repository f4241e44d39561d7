//! How stiff contact may be for a step, on a plate that rests on a held one. With K̃ = 2 M/Δt² + ½ K a step of `Midpoint` takes
//! y = x + ½ Δt v to y₁ − 2 y₀ + y₋₁ = −2 K̃⁻¹ (K + D) y₀, D being the stiffness of contact. That is stable where 4 K̃ − 2 (K + D) =
//! 8 M/Δt² − 2 D is positive: K drops out, and the bound is h = Δt √λ < 2, λ the largest of M⁻¹ D, however stiff the rock. Beyond it
//! vibrations grow by √(D/K) per step or so.

use nalgebra::DMatrix;
use ndda_mesh::geometry::{tet_volume, triangle_area_vector};
use ndda_mesh::{BlockId, Vec3};
use ndda_solver::Simulation;

use crate::evidence::Answer::{AtLeast, AtMost};
use crate::evidence::row;
use crate::simulation;

const PENALTY_PA: f64 = 2e9;
const DENSITY_KG_M3: f64 = 2650.0;
/// Where contact of slope 2 k_n/L carries a plate 0.06 m thick.
const DEPTH_M: f64 = DENSITY_KG_M3 * 9.8 * 0.06 / (2.0 * PENALTY_PA);
const STEPS: u64 = 1500;

/// A plate, sunk to where contact carries it.
fn plate(young_pa: f64, step_s: f64) -> Simulation {
    let height_m = 0.25 - DEPTH_M;
    simulation(&format!(
        "(title: \"plate\", time: (step_s: {step_s:e}, end_s: 1), gravity_m_s2: (0, 0, -9.8),
          materials: [(name: \"rock\", young_pa: {young_pa:e}, poisson: 0, density_kg_m3: {DENSITY_KG_M3})],
          blocks: [
            (name: \"base\", material: \"rock\", shape: Box(size_m: (0.5, 0.5, 0.25), cells: (1, 1, 1)), body: Fixed),
            (name: \"plate\", material: \"rock\", shape: Box(size_m: (0.3, 0.3, 0.06), cells: (2, 2, 1)), at_m: (0.1, 0.1, {height_m:?})),
          ],
          contact: Potential(penalty_pa: {PENALTY_PA:e}, potential: Smooth(reference_m: 1)))"
    ))
}

/// √λ of the plate's vertical motions [1/s]: M of four-node tetrahedra, D of its lower face.
fn rate(plate: &Simulation) -> f64 {
    let (blocks, own) = (plate.blocks(), BlockId(1));
    let (first, nodes) = (blocks.nodes_of(own).start, blocks.nodes_of(own).len());
    let (mut mass, mut stiffness) = (DMatrix::zeros(nodes, nodes), DMatrix::zeros(nodes, nodes));
    let add = |matrix: &mut DMatrix<f64>, corners: &[usize], each: f64| {
        for &a in corners {
            for &b in corners {
                matrix[(a, b)] += if a == b { 2.0 * each } else { each };
            }
        }
    };
    let corners = |index: usize| blocks.tets[index].map(|n| blocks.rest_position[n.index()]);
    for tet in blocks.tets_of(own) {
        let local = blocks.tets[tet].map(|n| n.index() - first);
        add(&mut mass, &local, DENSITY_KG_M3 * tet_volume(&corners(tet)) / 20.0);
    }
    for triangle in blocks.triangles_of(own) {
        let area = triangle_area_vector(&blocks.triangles[triangle].map(|n| blocks.rest_position[n.index()]));
        if area.dot(&-Vec3::z()) > 0.99 * area.norm() {
            let local = blocks.triangles[triangle].map(|n| n.index() - first);
            add(&mut stiffness, &local, 2.0 * PENALTY_PA * area.norm() / 12.0);
        }
    }
    let lower = mass.cholesky().expect("masses are positive").l();
    let half = lower.solve_lower_triangular(&stiffness).expect("regular");
    let both = lower.solve_lower_triangular(&half.transpose()).expect("regular");
    both.symmetric_eigenvalues().max().sqrt()
}

/// How far nodes go in a step at most, over the depth at which contact carries the plate: less than one as long as they stay in contact.
fn swing(young_pa: f64, step_s: f64) -> f64 {
    let mut plate = plate(young_pa, step_s);
    let mut speed_m_s = 0.0f64;
    for _ in 0..STEPS {
        plate.step().unwrap();
        speed_m_s = plate.state().velocity.iter().map(|v| v.norm()).fold(speed_m_s, f64::max);
    }
    speed_m_s * step_s / DEPTH_M
}

#[test]
fn elasticity_does_not_let_a_step_be_longer_than_contact_alone_would() {
    let longest_s = 2.0 / rate(&plate(20e9, 1e-6));
    for young_pa in [20e9, 200e9] {
        let what = |part: &str| {
            format!(
                "travel of a plate at rest in a step of {part} 2/√λ(M⁻¹D), E = {young_pa:e} Pa, over its depth in contact: most of {STEPS}"
            )
        };
        row("bounce and contact stability", &what("0.95"), swing(young_pa, 0.95 * longest_s), AtMost(1.0));
        row("bounce and contact stability", &what("1.05"), swing(young_pa, 1.05 * longest_s), AtLeast(3.0));
    }
}
