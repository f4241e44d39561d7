//! A disc that is pressed along its diameter until it splits: two halves that are bonded along it (Brazilian test).

use std::f64::consts::PI;
use std::fmt::Write;

use ndda_mesh::{TetId, Vec3};
use ndda_solver::Simulation;

use crate::evidence::Answer::Within;
use crate::evidence::row;
use crate::simulation;

const RADIUS_M: f64 = 0.025;
const THICKNESS_M: f64 = 0.025;
const TENSION_PA: f64 = 5e6;
/// Load that is reached at the end, over that at which it splits.
const MOST: f64 = 1.2;
const END_S: f64 = 4e-4;
const STEP_S: f64 = 1e-7;
/// Edges of the polygon that stands for the circle; one of them takes the load from above, one from below.
const EDGES: u32 = 32;

/// P = ½ π D t f_t, under which the centre bears f_t across and −3 f_t along the load (Hertz 1883).
fn splits_n() -> f64 {
    PI * RADIUS_M * THICKNESS_M * TENSION_PA
}

fn disc(size_m: f64) -> Simulation {
    // Its area is that of the circle.
    let turn = 2.0 * PI / f64::from(EDGES);
    let corner_m = RADIUS_M * (turn / turn.sin()).sqrt();
    let mut outline = String::new();
    for k in 0..EDGES {
        let angle = turn * (f64::from(k) + 0.5);
        write!(outline, "({:e}, {:e}),", corner_m * angle.sin(), corner_m * angle.cos()).unwrap();
    }
    let edge_m = 2.0 * corner_m * (0.5 * turn).sin();
    let pressure_pa = MOST * splits_n() / (edge_m * THICKNESS_M);
    let ramp = format!("factor: [(time_s: 0, factor: 0), (time_s: {END_S}, factor: 1)]");
    simulation(&format!(
        "(title: \"disc\", time: (step_s: {STEP_S:e}, end_s: {END_S}, integrator: Newmark(alpha: 0.5, delta: 1)),
          materials: [(name: \"rock\", young_pa: 30e9, poisson: 0.25, density_kg_m3: 2600)],
          rock: [(name: \"disc\", material: \"rock\", domain: Column(outline_m: [{outline}], axis: Y, start_m: 0, end_m: {THICKNESS_M}),
              joints: [Plane(name: \"split\", dip_deg: 90, dip_direction_deg: 90, point_m: (0, 0, 0))], fill: Size(size_m: {size_m}))],
          tractions: [
              (block: \"disc_*\", on: Set(\"side_{}\"), traction_pa: (0, 0, {:e}), {ramp}),
              (block: \"disc_*\", on: Set(\"side_{}\"), traction_pa: (0, 0, {pressure_pa:e}), {ramp}),
          ],
          contact: Potential(penalty_pa: 5e12, potential: Smooth(), friction: (friction_deg: 30, shear_penalty_pa_m: 1e13, cohesion_pa: 50e6, tension_pa: {TENSION_PA:e},
              fracture: (tension_j_m2: 10, shear_j_m2: 400))))",
        EDGES - 1,
        -pressure_pa,
        EDGES / 2 - 1,
    ))
}

/// Load now [N].
fn load_n(disc: &Simulation) -> f64 {
    MOST * splits_n() * disc.time_s() / END_S
}

/// Stress across and along the load at a place of an elastic disc, over P/(π R t) (Timoshenko & Goodier, Theory of Elasticity, § 41).
fn exact(x_m: f64, z_m: f64) -> [f64; 2] {
    let (above_m, below_m) = (RADIUS_M - z_m, RADIUS_M + z_m);
    let [above4, below4] = [above_m, below_m].map(|h| (x_m * x_m + h * h).powi(2));
    let of = |above: f64, below: f64| 1.0 - 2.0 * RADIUS_M * (above / above4 + below / below4);
    [of(above_m * x_m * x_m, below_m * x_m * x_m), of(above_m.powi(3), below_m.powi(3))]
}

/// Stress across and along the load at the centre [Pa]: the mean near it, corrected by how much that of an elastic disc differs there.
fn centre_pa(disc: &mut Simulation) -> [f64; 2] {
    let mut stress_pa = vec![[0.0; 6]; disc.blocks().tets.len()];
    disc.recover_stress(&mut stress_pa).unwrap();
    let (mut sum, mut expected) = ([0.0; 2], [0.0; 2]);
    for (tet, stress) in (0..).map(TetId).zip(&stress_pa) {
        let corners = disc.blocks().tet_corners(tet, &disc.blocks().rest_position);
        let at = corners.iter().sum::<Vec3>() / 4.0 + disc.blocks().origin_m;
        if at.x.hypot(at.z) < 0.2 * RADIUS_M {
            let exact = exact(at.x, at.z);
            sum = [sum[0] + stress[0], sum[1] + stress[2]];
            expected = [expected[0] + exact[0], expected[1] + exact[1]];
        }
    }
    [sum[0] / expected[0], -3.0 * sum[1] / expected[1]]
}

/// Part of its bonds that is broken.
fn broken(disc: &Simulation, bonds: usize) -> f64 {
    let whole: f64 = disc.state().contact.bonds.iter().map(|bond| 1.0 - bond.damage).sum();
    1.0 - whole / bonds as f64
}

#[test]
fn a_disc_that_is_pressed_along_its_diameter_splits_at_its_tensile_strength() {
    let fine = std::env::var_os("NDDA_LARGE").is_some();
    let mut disc = disc(if fine { 0.003 } else { 0.005 });
    assert!((splits_n() - 9817.48).abs() < 0.01);
    disc.step().unwrap();
    let bonds = disc.state().contact.bonds.len();
    let (mut sums_pa, mut samples, mut step, mut split_n) = ([0.0; 2], 0.0, 0, None);
    while disc.time_s() < END_S && split_n.is_none() {
        disc.step().unwrap();
        step += 1;
        let load_n = load_n(&disc);
        // Nothing is broken yet; the disc rings by a tenth of its stress.
        if step % 20 == 0 && (0.25..0.55).contains(&(load_n / splits_n())) {
            let centre_pa = centre_pa(&mut disc).map(|stress| stress * splits_n() / load_n);
            sums_pa = [0, 1].map(|i| sums_pa[i] + centre_pa[i]);
            samples += 1.0;
        }
        if broken(&disc, bonds) > 0.5 {
            split_n = Some(load_n);
        }
    }
    let [across_pa, along_pa] = sums_pa.map(|sum| sum / samples);
    row("Brazilian disc", "stress across the load at the centre [Pa]", across_pa, Within(TENSION_PA, 0.05));
    row(
        "Brazilian disc",
        "stress along the load at the centre [Pa]",
        along_pa,
        Within(-3.0 * TENSION_PA, 0.05),
    );
    let found_n = split_n.expect("it splits");
    row("Brazilian disc", "load at which it splits [N]", found_n, Within(splits_n(), 0.05));
}
