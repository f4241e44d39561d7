//! Lumped mass: the same weight and momentum, frequencies from below where consistent mass has them from above.

use nalgebra::{DMatrix, DVector};
use ndda::judge::verdict;
use ndda::summary::LabelWord;
use ndda_mesh::{BlockId, Mat3, TetId, Vec3};
use ndda_solver::Simulation;

use crate::evidence::Answer::{AtLeast, AtMost, Within};
use crate::evidence::{rounding, row};
use crate::simulation;

/// Length [m], Young's modulus [Pa], density [kg/m³] and traction at the end [Pa] of a bar that is fixed at one end.
const BAR: (f64, f64, f64, f64) = (4.0, 1e9, 2500.0, 1e4);

fn bar(mass: &str) -> Simulation {
    let (length_m, young_pa, density_kg_m3, traction_pa) = BAR;
    simulation(&format!(
        "(title: \"bar\", time: (step_s: 1e-5, end_s: 1, mass: {mass}),
          materials: [(name: \"rock\", young_pa: {young_pa}, poisson: 0, density_kg_m3: {density_kg_m3})],
          blocks: [(name: \"bar\", material: \"rock\", shape: Box(size_m: ({length_m}, 0.5, 0.5), cells: (4, 1, 1)))],
          supports: [(block: \"bar\", on: Set(\"x_min\"), hold: Fixed)],
          tractions: [(block: \"bar\", on: Set(\"x_max\"), traction_pa: ({traction_pa}, 0, 0))])"
    ))
}

/// Stiffness [N/m] and mass [kg] of all nodes, assembled from their textbook formulas: with ν = 0,
/// K_ab = V E/2 (g_b g_aᵀ + g_a·g_b I), M_ab = ρ V (1 + δ_ab)/20 I, or ρ V/4 δ_ab I where it is lumped.
fn assembled(bar: &Simulation, is_lumped: bool) -> (DMatrix<f64>, DMatrix<f64>) {
    let (_, young_pa, density_kg_m3, _) = BAR;
    let (blocks, n) = (bar.blocks(), 3 * bar.blocks().rest_position.len());
    let (mut stiffness, mut mass) = (DMatrix::zeros(n, n), DMatrix::zeros(n, n));
    for nodes in &blocks.tets {
        let x = nodes.map(|node| blocks.rest_position[node.index()]);
        let edges = Mat3::from_columns(&[x[1] - x[0], x[2] - x[0], x[3] - x[0]]);
        let volume_m3 = edges.determinant() / 6.0;
        let rows = edges.try_inverse().unwrap();
        let mut gradient = [Vec3::zeros(); 4];
        for k in 0..3 {
            gradient[k + 1] = rows.row(k).transpose();
            gradient[0] -= gradient[k + 1];
        }
        for a in 0..4 {
            for b in 0..4 {
                let (g, h) = (gradient[a], gradient[b]);
                let k = 0.5 * young_pa * volume_m3 * (h * g.transpose() + Mat3::identity() * g.dot(&h));
                let share = match is_lumped {
                    true => 0.25 * f64::from(u8::from(a == b)),
                    false => f64::from(1 + u8::from(a == b)) / 20.0,
                };
                let m = Mat3::identity() * (share * density_kg_m3 * volume_m3);
                let place = (3 * nodes[a].index(), 3 * nodes[b].index());
                let mut block = stiffness.fixed_view_mut::<3, 3>(place.0, place.1);
                block += k;
                let mut block = mass.fixed_view_mut::<3, 3>(place.0, place.1);
                block += m;
            }
        }
    }
    (stiffness, mass)
}

/// Angular frequencies of the free nodes [rad/s], and the share of each mode in the stretch of the last node under the traction [m].
fn modes(bar: &Simulation, is_lumped: bool) -> Vec<(f64, f64)> {
    let (length_m, _, _, traction_pa) = BAR;
    let (stiffness, mass) = assembled(bar, is_lumped);
    let blocks = bar.blocks();
    let free: Vec<usize> = (0..stiffness.nrows()).filter(|i| blocks.rest_position[i / 3].x > 0.0).collect();
    let (stiffness, mass) =
        (stiffness.select_rows(&free).select_columns(&free), mass.select_rows(&free).select_columns(&free));
    let mut load = DVector::zeros(free.len());
    for corners in &blocks.triangles {
        let x = corners.map(|node| blocks.rest_position[node.index()]);
        if x.iter().all(|x| x.x == length_m) {
            let area_m2 = 0.5 * (x[1] - x[0]).cross(&(x[2] - x[0])).norm();
            for node in corners {
                let row = free.iter().position(|&i| i == 3 * node.index()).unwrap();
                load[row] += traction_pa * area_m2 / 3.0;
            }
        }
    }
    // M = L Lᵀ, A = L⁻¹ K L⁻ᵀ, u = L⁻ᵀ q.
    let lower = mass.cholesky().unwrap().l();
    let inverse = lower.try_inverse().unwrap();
    let eigen = (&inverse * stiffness * inverse.transpose()).symmetric_eigen();
    let (shapes, pushes) =
        (inverse.transpose() * &eigen.eigenvectors, eigen.eigenvectors.transpose() * &inverse * load);
    let end = shapes.nrows() - 3;
    let share = |k: usize| shapes[(end, k)] * pushes[k] / eigen.eigenvalues[k];
    let mut modes: Vec<_> = (0..shapes.ncols()).map(|k| (eigen.eigenvalues[k].sqrt(), share(k))).collect();
    modes.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    modes
}

/// A bar that a sudden traction stretches: u(t) = Σ_k s_k (1 − cos ω_k t) over the modes of matrices that the test assembles.
#[test]
fn a_bar_that_is_pulled_moves_as_the_modes_of_its_matrices_do() {
    let (length_m, young_pa, density_kg_m3, traction_pa) = BAR;
    let exact = 4.0 * length_m / (young_pa / density_kg_m3).sqrt();
    for (mass, is_lumped) in [("Consistent", false), ("Lumped", true)] {
        let mut bar = bar(mass);
        let modes = modes(&bar, is_lumped);
        let period = std::f64::consts::TAU / modes[0].0 / exact;
        // T = 4 L/c of the continuum lies between both.
        let bound = if is_lumped { AtLeast(1.0) } else { AtMost(1.0) };
        row("mass", &format!("first period of the matrices of a bar over 4L/c, {mass}"), period, bound);
        let end = bar.blocks().rest_position.len() - 1;
        let mut worst = 0.0f64;
        for _ in 0..5000 {
            bar.step().unwrap();
            let time_s = bar.time_s();
            let expected: f64 =
                modes.iter().map(|(omega, share)| share * (1.0 - (omega * time_s).cos())).sum();
            worst = worst.max((crate::displacements(&bar)[end].x - expected).abs());
        }
        let stretch_m = traction_pa * length_m / young_pa;
        row(
            "mass",
            &format!("stretch of a pulled bar over two periods, {mass}: error [of the static one]"),
            worst / stretch_m,
            AtMost(2e-3),
        );
    }
}

#[test]
fn a_lumped_block_falls_and_spins_with_its_books_in_order() {
    let mut simulation = simulation(
        "(title: \"fall\", time: (step_s: 1e-3, end_s: 1, mass: Lumped), gravity_m_s2: (0, 0, -10),
          materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.2, density_kg_m3: 2500)],
          blocks: [(name: \"b\", material: \"rock\", shape: Box(size_m: (1, 0.6, 0.5), cells: (2, 1, 1)), spin_rad_s: (1, 3, 0))])",
    );
    // A quarter of each tetrahedron turns with each of its corners.
    let blocks = simulation.blocks();
    let center = Vec3::new(0.5, 0.3, 0.25) - blocks.origin_m;
    let corners = |tet| blocks.tet_corners(tet, &blocks.rest_position);
    let of_tet = |tet: usize| {
        let x = corners(TetId(tet as u32));
        let volume = (x[1] - x[0]).cross(&(x[2] - x[0])).dot(&(x[3] - x[0])) / 6.0;
        let speed2 = |x: &Vec3| Vec3::new(1.0, 3.0, 0.0).cross(&(x - center)).norm_squared();
        0.5 * 2500.0 * volume / 4.0 * x.iter().map(speed2).sum::<f64>()
    };
    let energy_j: f64 = (0..blocks.tets.len()).map(of_tet).sum();
    simulation.sample().unwrap();
    for _ in 0..1000 {
        simulation.step().unwrap();
    }
    let end = simulation.sample().unwrap();
    row(
        "mass",
        "momentum of a lumped block after a second of fall [kg m/s]",
        end.momentum.z,
        Within(-7500.0, rounding(1000)),
    );
    // Its spin stretches it by ρ ω² r²/E, which vibrates: as much of its energy may be lost by the scheme.
    let stretch = 2500.0 * 10.0 * (0.5f64.powi(2) + 0.3f64.powi(2) + 0.25f64.powi(2)) / 1e9;
    row("mass", "energy of a lumped block after it [J]", end.total_j(), Within(energy_j, stretch.min(1e-6)));
    row("mass", "angular momentum of it", simulation.invariants().angular_momentum, AtMost(rounding(1000)));
}

/// A cube of 1 m and 2500 kg of six tetrahedra under a couple of 1000 N m about z for 10 ms.
fn coupled(body: &str, mass: &str) -> Simulation {
    let mut simulation = simulation(&format!(
        "(title: \"couple\", time: (step_s: 1e-4, end_s: 1, mass: {mass}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.2, density_kg_m3: 2500)],
          blocks: [(name: \"b\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), body: {body})],
          tractions: [
            (block: \"b\", on: Set(\"x_max\"), traction_pa: (0, 1000, 0)),
            (block: \"b\", on: Set(\"x_min\"), traction_pa: (0, -1000, 0)),
          ])"
    ));
    simulation.sample().unwrap();
    for _ in 0..100 {
        simulation.step().unwrap();
    }
    simulation.sample().unwrap();
    simulation
}

/// Rate of rotation, by the velocities of nodes [rad/s].
fn spin(simulation: &Simulation) -> Vec3 {
    let state = simulation.state();
    simulation.shape(BlockId(0)).operator.rigid_motion(&state.position, &state.velocity).spin_rad_s
}

#[test]
fn rigid_and_affine_blocks_have_their_own_inertia_whatever_the_mass() {
    // ω = T t/J with J = m a²/6. The couple stays where it is while the cube turns by θ = ½ ω t, and loses up to θ²/2: twice that. The
    // rock of an affine block shears by τ/G and swings: tenfold.
    let expected: f64 = 1000.0 * 0.01 * 6.0 / 2500.0;
    let aslant = (0.5 * expected * 0.01).powi(2);
    let sheared = 1000.0 * 2.4 / 20e9;
    for body in ["Rigid", "Affine"] {
        for mass in ["Consistent", "Lumped"] {
            let simulation = coupled(body, mass);
            let what = format!("spin of a cube under a couple, {body}, {mass} [rad/s]");
            let off = if body == "Affine" { aslant + 10.0 * sheared } else { aslant };
            row("mass", &what, spin(&simulation).z, Within(expected, off));
            assert!(simulation.lumped_inertia_errors().is_empty());
            assert_eq!(verdict::label(&simulation, None).word, LabelWord::Accurate, "{body}, {mass}");
        }
    }
}

#[test]
fn a_lumped_elastic_block_that_turns_is_not_called_accurate_and_says_by_how_much() {
    // Two opposite corners carry a quarter of the mass, the others a twelfth: J has m a²/2 on its diagonal and m a²/12 beside it, which is
    // 7/12 m a² across the diagonal of the cube, 3.5 times the true m a²/6.
    let lumped = coupled("Elastic", "Lumped");
    let [(_, error)] = lumped.lumped_inertia_errors()[..] else { panic!("one kind of block") };
    // Rounding of sums over eight nodes, and of the eigenvalues of 3 × 3: a hundred ε.
    let rounds = rounding(100);
    row("mass", "stated error of the inertia of a lumped cube of six tetrahedra", error, Within(2.5, rounds));
    let label = verdict::label(&lumped, None);
    assert_eq!(label.word, LabelWord::Inaccurate, "{:?}", label.reasons);
    assert!(label.reasons.iter().any(|reason| reason.contains("lumped masses")), "{:?}", label.reasons);
    let consistent = coupled("Elastic", "Consistent");
    let expected = 1000.0 * 0.01 * 6.0 / 2500.0;
    // It rings: a shear wave moves nodes by τ/√(G ρ), beside ω a/2 at its faces; twice that passes.
    let rings_m_s = 1000.0 / (20e9 / 2.4 * 2500f64).sqrt();
    let what = "spin of a cube under a couple, Elastic, Consistent [rad/s]";
    row("mass", what, spin(&consistent).z, Within(expected, 2.0 * rings_m_s / (0.5 * expected)));
    assert!(consistent.lumped_inertia_errors().is_empty());
}

#[test]
fn a_lumped_elastic_block_that_does_not_turn_is_called_accurate() {
    let mut simulation = simulation(
        "(title: \"fall\", time: (step_s: 1e-3, end_s: 1, mass: Lumped), gravity_m_s2: (0, 0, -10),
          materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.2, density_kg_m3: 2500)],
          blocks: [(name: \"b\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), velocity_m_s: (3, 0, 0))])",
    );
    simulation.sample().unwrap();
    for _ in 0..1000 {
        simulation.step().unwrap();
    }
    simulation.sample().unwrap();
    let label = verdict::label(&simulation, None);
    assert_eq!(label.word, LabelWord::Accurate, "{:?}", label.reasons);
}
