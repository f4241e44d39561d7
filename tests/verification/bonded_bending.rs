//! A plate of 1 m² that is glued under a fixed one and pulled at the edge of its kern, so that the stress grows linearly from nothing to twice the mean.

use crate::evidence::Answer::Near;
use crate::evidence::row;
use crate::simulation;

const STEP_S: f64 = 1e-6;
const END_S: f64 = 0.01;
const TENSION_PA: f64 = 1e5;
/// Pull over σ_t A at which the edge is at its strength.
const EXACT: f64 = 0.5;
/// Bonds lie inside their facets, so that the edge is seen from within: an error of first order in the size of cells.
const PER_CELL: f64 = 0.15;

/// Pull over σ_t A at which the first bond breaks; plates of so many cells, and as many of the fixed one.
fn breaking(cells: u32, roof_cells: u32) -> f64 {
    let mut simulation = simulation(&format!(
        "(title: \"bond in bending\", time: (step_s: {STEP_S:e}, end_s: {END_S}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650, damping: (mass_per_s: 4000))],
          blocks: [
            (name: \"roof\", material: \"rock\", body: Fixed, shape: Box(size_m: (1.2, 1.2, 0.1), cells: ({roof_cells}, {roof_cells}, 1)),
             at_m: (-0.1, -0.1, 0)),
            (name: \"plate\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 0.01), cells: ({cells}, {cells}, 1)), at_m: (0, 0, -0.01)),
          ],
          forces: [(block: \"plate\", at_m: (0.6666666666666667, 0.5, 0), force_n: (0, 0, {:e}), factor: [(time_s: 0, factor: 0), (time_s: {END_S}, factor: 1)])],
          contact: Potential(penalty_pa: 1e9, potential: Smooth(reference_m: 0.1),
                             friction: (friction_deg: 30, shear_penalty_pa_m: 1e11, cohesion_pa: 1e6, tension_pa: {TENSION_PA:e})))",
        -TENSION_PA
    ));
    while simulation.time_s() < END_S {
        simulation.step().unwrap();
        if simulation.state().contact.bonds.iter().any(|bond| bond.damage >= 1.0) {
            return simulation.time_s() / END_S;
        }
    }
    f64::INFINITY
}

#[test]
fn a_glued_plate_that_is_pulled_at_the_edge_of_its_kern_breaks_where_its_own_edge_is_at_its_strength() {
    for (cells, roof_cells) in [(1, 1), (2, 1), (4, 1), (4, 3), (8, 6)] {
        row(
            "bonds in bending",
            &format!("pull at the edge of the kern over σ_t A, {cells}² cells under {roof_cells}² [-]"),
            breaking(cells, roof_cells),
            Near(EXACT, PER_CELL / f64::from(cells.min(roof_cells))),
        );
    }
}
