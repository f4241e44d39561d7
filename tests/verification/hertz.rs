//! A rigid sphere pressed on an elastic flat, against Hertz (Johnson, Contact Mechanics, 1985, §4.2):
//! F = 4/3 E* √R d^1.5, a² = R d, p = p₀ √(1 − r²/a²). `NDDA_LARGE=1` adds a third mesh.
//!
//! A quarter of the flat is meshed, on rollers in its planes of symmetry, in cells that are uniform around the contact
//! and grow outwards by the same map on every mesh. The sphere's cap is the paraboloid that Hertz's theory takes it for.
//! What is left of the method and the box, to first order: contact's give lowers F by 1.5 E*/π s a, s = 2 k_n/L₀ (the
//! energy ½ ∫ p²/s dA at a given d), which is 0.5 % at the largest depth; the ends of the box at L raise it by the order of 2a/πL, 0.5 %.

use std::path::Path;

use ndda::build;
use ndda_mesh::{BlockId, BlockMesh, BlockSet, Vec3};
use ndda_solver::Simulation;

use crate::evidence::Answer::Within;
use crate::evidence::row;

const YOUNG_PA: f64 = 10e9;
const POISSON: f64 = 0.25;
const RADIUS_M: f64 = 1.0;
/// Radius a of the contact at the largest depth [m].
const CONTACT_M: f64 = 0.02;
/// Depths over the largest.
const DEPTHS: [f64; 3] = [0.25, 0.5, 1.0];
/// Cells of the coarsest flat along x and y, along z, and of the cap; four on the largest contact radius.
const CELLS: [u32; 3] = [18, 15, 12];
/// Cells of that flat that are uniform along x and y, and along z; the next are longer by `GROWTH` each.
const UNIFORM: [f64; 2] = [5.0, 2.0];
const GROWTH: f64 = 1.5;

fn e_star() -> f64 {
    YOUNG_PA / (1.0 - POISSON * POISSON)
}

fn depth_m(part: f64) -> f64 {
    part * CONTACT_M * CONTACT_M / RADIUS_M
}

/// The scene, its blocks still cubes, with `thirds`/3 times the cells of the coarsest mesh.
fn scene(thirds: u32) -> String {
    let [across, deep, cap] = CELLS.map(|n| n * thirds / 3);
    let rows: String = (1..)
        .zip(DEPTHS)
        .map(|(i, part)| format!("(time_s: {i}, displacement_m: (0, 0, {:e})),", -depth_m(part)))
        .collect();
    format!(
        "(title: \"hertz\", time: (step_s: 1, end_s: 3, contact_at: End(tolerance: 1e-10), integrator: Newmark(alpha: 0.5, delta: 1)),
          materials: [(name: \"rock\", young_pa: {YOUNG_PA:e}, poisson: {POISSON}, density_kg_m3: 2500)],
          blocks: [
            (name: \"flat\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: ({across}, {across}, {deep}))),
            (name: \"cap\", material: \"rock\", body: Fixed, shape: Box(size_m: (1, 1, 1), cells: ({cap}, {cap}, 1))),
          ],
          supports: [
            (block: \"flat\", on: Set(\"z_min\"), hold: Fixed),
            (block: \"flat\", on: Plane(point_m: (0, 0, 0), normal: (1, 0, 0)), hold: Normal),
            (block: \"flat\", on: Plane(point_m: (0, 0, 0), normal: (0, 1, 0)), hold: Normal),
            (block: \"cap\", on: All, hold: Motion([(time_s: 0, displacement_m: (0, 0, 0)), {rows}])),
          ],
          contact: Potential(penalty_pa: {:e}, potential: Smooth(reference_m: 1)))",
        50.0 * e_star() / CONTACT_M
    )
}

/// Distance from the centre of contact [m] after `cells` of the coarsest mesh, of which `uniform` are alike.
fn graded(cells: f64, uniform: f64) -> f64 {
    let growth = GROWTH.ln();
    let grown = (cells - uniform).max(0.0);
    CONTACT_M / 4.0 * (cells.min(uniform) + (grown * growth).exp_m1() / growth)
}

/// Makes the unit cube the quarter of a flat under z = 0.
fn shape_flat(mesh: &mut BlockMesh) {
    let [across, deep, _] = CELLS.map(f64::from);
    for x in &mut mesh.nodes {
        let side = |part: f64| graded(part * across, UNIFORM[0]);
        *x = Vec3::new(side(x.x), side(x.y), -graded((1.0 - x.z) * deep, UNIFORM[1]));
    }
}

/// Makes the unit cube a cap over the contact, beyond the planes of symmetry so that its sides touch nothing.
fn shape_cap(mesh: &mut BlockMesh) {
    for x in &mut mesh.nodes {
        let [u, v] = [x.x, x.y].map(|part| (1.8 * part - 0.31) * CONTACT_M);
        let lower = (u * u + v * v) / (2.0 * RADIUS_M);
        *x = Vec3::new(u, v, if x.z > 0.5 { 3.0 * CONTACT_M } else { lower });
    }
}

fn pressed(thirds: u32) -> Simulation {
    let loaded =
        ndda_io::read::load_text("hertz.ron", &scene(thirds), &[], None).unwrap_or_else(|e| panic!("{e}"));
    let folder = Path::new(".");
    let (mut meshes, _) = build::meshes(&loaded.scene, folder).unwrap_or_else(|f| panic!("{f:?}"));
    shape_flat(&mut meshes[0].1);
    shape_cap(&mut meshes[1].1);
    let blocks = BlockSet::new(meshes).unwrap_or_else(|e| panic!("{e}"));
    build::simulation(&loaded.scene, blocks, folder).unwrap_or_else(|f| panic!("{f:?}"))
}

/// Force F on the whole flat [N], and ∫ p r² dA / F [m²].
fn force_and_spread(simulation: &Simulation) -> (f64, f64) {
    let blocks = simulation.blocks();
    let forces = simulation.contact_forces_n();
    let (mut force, mut moment) = (0.0, 0.0);
    for node in blocks.nodes_of(BlockId(0)) {
        let at = blocks.rest_position[node] + blocks.origin_m;
        force -= 4.0 * forces[node].z;
        moment -= 4.0 * forces[node].z * (at.x * at.x + at.y * at.y);
    }
    (force, moment / force)
}

/// Forces over Hertz's at `DEPTHS`, and the spread of the pressure over Hertz's, 2/5 a², at the last.
fn over_hertz(thirds: u32) -> ([f64; 3], f64) {
    let mut simulation = pressed(thirds);
    let mut spread = 0.0;
    let forces = DEPTHS.map(|part| {
        simulation.step().unwrap_or_else(|e| panic!("{e}"));
        let (force, square) = force_and_spread(&simulation);
        let depth = depth_m(part);
        spread = square / (0.4 * RADIUS_M * depth);
        force / (4.0 / 3.0 * e_star() * RADIUS_M.sqrt() * depth.powf(1.5))
    });
    (forces, spread)
}

#[test]
fn a_sphere_pressed_on_a_flat_follows_hertz() {
    let mut meshes = vec![3, 4];
    if std::env::var_os("NDDA_LARGE").is_some() {
        meshes.push(6);
    }
    let found: Vec<([f64; 3], f64)> = meshes.iter().map(|&thirds| over_hertz(thirds)).collect();
    let cells: Vec<String> = meshes.iter().map(|&t| format!("{:.1}", 4.0 * f64::from(t) / 3.0)).collect();
    for ((forces, _), cells) in found.iter().zip(&cells) {
        let what = format!("force over Hertz's, {cells} cells on the contact radius");
        row("Hertz contact", &what, forces[2], Within(1.0, 0.1));
    }
    let last = found.len() - 1;
    let exponent = |forces: &[f64; 3]| 1.5 + (forces[2] / forces[0]).ln() / (DEPTHS[2] / DEPTHS[0]).ln();
    let (finest, spread) = &found[last];
    let on_finest = |what: &str| format!("{what}, {} cells", cells[last]);
    row("Hertz contact", &on_finest("exponent of the depth"), exponent(finest), Within(1.5, 0.02));
    row("Hertz contact", &on_finest("∫ p r² dA / F over 2/5 a²"), *spread, Within(1.0, 0.03));
    // Linear tetrahedra and plane facets: errors of second order.
    let ratio2 = (f64::from(meshes[last]) / f64::from(meshes[last - 1])).powi(2);
    let coarser = found[last - 1].0;
    let limit: [f64; 3] = std::array::from_fn(|k| finest[k] + (finest[k] - coarser[k]) / (ratio2 - 1.0));
    let named =
        |what: &str| format!("{what}, extrapolated from {} and {} cells", cells[last - 1], cells[last]);
    for (part, force) in DEPTHS.iter().zip(limit) {
        row(
            "Hertz contact",
            &named(&format!("force over Hertz's at {part} of the depth")),
            force,
            Within(1.0, 0.03),
        );
    }
    row("Hertz contact", &named("exponent of the depth"), exponent(&limit), Within(1.5, 0.02));
}
