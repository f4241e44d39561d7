//! A bar of bedded rock pulled across and along its beds: strains of the compliance (Amadei 1983).

use ndda_mesh::Vec3;

use crate::{POISSON, YOUNG_PA, assert_uniform_strain, rollers, settle, simulation};

const YOUNG_ACROSS_PA: f64 = 4e9;
const POISSON_ACROSS: f64 = 0.1;

/// The bar of the other cases, of beds with this normal, pulled along x by 0.1 MPa; the Krylov solver has to do, too.
fn pulled(normal: &str, solver: &str) -> ndda_solver::Simulation {
    let bedding = format!(
        "bedding: (normal: {normal}, young_across_pa: {YOUNG_ACROSS_PA:e}, poisson_across: {POISSON_ACROSS}, \
         shear_across_pa: 1.5e9)"
    );
    simulation(&format!(
        "(title: \"bar\", time: (step_s: 2e-4, end_s: 1, integrator: Newmark(alpha: 0.5, delta: 1), solver: {solver}),
          materials: [(name: \"shale\", young_pa: {YOUNG_PA:e}, poisson: {POISSON}, density_kg_m3: 2500, {bedding})],
          blocks: [(name: \"bar\", material: \"shale\", shape: Box(size_m: (2, 1, 0.5), cells: (4, 2, 1)))],
          supports: [{}],
          tractions: [(block: \"bar\", on: Set(\"x_max\"), traction_pa: (1e5, 0, 0))])",
        rollers("")
    ))
}

#[test]
fn across_its_beds_a_bar_gives_as_much_as_they_do_and_along_them_as_if_they_were_not() {
    for solver in ["Cholesky", "ConjugateGradients(tolerance: 1e-13)"] {
        let mut across = pulled("(3, 0, 0)", solver);
        settle(&mut across);
        let strain = 1e5 / YOUNG_ACROSS_PA;
        let sideways = -POISSON_ACROSS * strain;
        assert_uniform_strain(&across, Vec3::new(strain, sideways, sideways), 1e-9);

        let mut along = pulled("(0, 0, -1)", solver);
        settle(&mut along);
        let strain = 1e5 / YOUNG_PA;
        let upward = -POISSON_ACROSS * 1e5 / YOUNG_ACROSS_PA;
        assert_uniform_strain(&along, Vec3::new(strain, -POISSON * strain, upward), 1e-9);
    }
}
