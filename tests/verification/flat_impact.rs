//! An elastic cube that falls flat on a plane rebounds straight up; one of few tetrahedra does not, since they are not symmetric.

use ndda_mesh::{BlockId, Vec3};

use crate::evidence::Answer::Near;
use crate::evidence::row;
use crate::{advance, simulation};

const SPEED_M_S: f64 = 2.0;
/// Sideways speed over that of the impact, times the cells along an edge: an error of first order in the size of cells.
const PER_CELL: f64 = 0.15;

/// Speed along the plane after the rebound, over that of the impact.
fn sideways(cells: u32) -> f64 {
    let mut cube = simulation(&format!(
        "(title: \"flat impact\", time: (step_s: 5e-6, end_s: 8e-3), gravity_m_s2: (0, 0, -9.81),
          materials: [(name: \"rock\", young_pa: 5e9, poisson: 0.2, density_kg_m3: 2600)],
          blocks: [
            (name: \"floor\", material: \"rock\", shape: Box(size_m: (4, 2, 0.5), cells: (1, 1, 1)), body: Fixed, at_m: (-1, -0.5, -0.5)),
            (name: \"cube\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: ({cells}, {cells}, {cells})), at_m: (0, 0, 1e-4),
             velocity_m_s: (0, 0, -{SPEED_M_S})),
          ],
          contact: Potential(penalty_pa: 5e9, friction: (friction_deg: 30)))"
    ));
    advance(&mut cube, 1600);
    let nodes = cube.blocks().nodes_of(BlockId(1));
    let mean = cube.state().velocity[nodes.clone()].iter().sum::<Vec3>() / nodes.len() as f64;
    assert!(mean.z > 0.7 * SPEED_M_S, "{cells} cells: {mean:?}");
    mean.xy().norm() / SPEED_M_S
}

#[test]
fn an_elastic_cube_that_falls_flat_leaves_straight_up_but_for_an_error_of_its_mesh() {
    for cells in [1, 2, 4] {
        row(
            "flat impact",
            &format!("sideways speed over that of the impact, {cells}³ cells [-]"),
            sideways(cells),
            Near(0.0, PER_CELL / f64::from(cells)),
        );
    }
}
