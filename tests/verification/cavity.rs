//! A spherical cavity under a blast, against the closed form of its wave (Sharpe 1942; Blake 1952).

use ndda_mesh::Vec3;

use crate::evidence::Answer::AtMost;
use crate::evidence::row;
use crate::simulation;

const YOUNG_PA: f64 = 20e9;
const POISSON: f64 = 0.25;
const DENSITY: f64 = 2600.0;
/// Radii of the cavity and of the mesh [m].
const CAVITY_M: f64 = 1.0;
const MESH_M: f64 = 4.5;
/// The mesh is a cone of four planes through the centre, of this slope against its axis; each plane keeps its nodes.
const SLOPE: f64 = 0.08;
/// Peak of Duvall's pressure [Pa], and its rates [1/s].
const PEAK_PA: f64 = 10e6;
const RATES: (f64, f64) = (500.0, 5000.0);

/// Shear modulus [Pa] and speed of P waves [m/s].
fn rock() -> (f64, f64) {
    let shear_pa = 0.5 * YOUNG_PA / (1.0 + POISSON);
    let lame_pa = YOUNG_PA * POISSON / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON));
    (shear_pa, ((lame_pa + 2.0 * shear_pa) / DENSITY).sqrt())
}

/// f and f' of the potential f(t − (r − a)/c)/r under a pressure exp(−k t): f'' + 2b f' + ω² f = −(a/ρ) exp(−k t) with ω² = 4G/ρa² and
/// b = 2G/ρca, from f = f' = 0.
fn potential(k: f64, t: f64) -> (f64, f64) {
    let (shear_pa, c) = rock();
    let b = 2.0 * shear_pa / (DENSITY * c * CAVITY_M);
    let omega_2 = 4.0 * shear_pa / (DENSITY * CAVITY_M * CAVITY_M);
    let rate = (omega_2 - b * b).sqrt();
    let (part, q) = (-CAVITY_M / DENSITY / (k * k - 2.0 * b * k + omega_2), (b - k) / rate);
    let (forced, decayed, (sin, cos)) = ((-k * t).exp(), (-b * t).exp(), (rate * t).sin_cos());
    let value = forced - decayed * (cos + q * sin);
    let slope = -k * forced + decayed * (k * cos + (b * q + rate) * sin);
    (part * value, part * slope)
}

/// Radial displacement −f'/cr − f/r² at a radius and a time [m].
fn displacement_m(radius_m: f64, time_s: f64) -> f64 {
    let (alpha, beta) = RATES;
    let c = rock().1;
    let since_s = time_s - (radius_m - CAVITY_M) / c;
    if since_s <= 0.0 {
        return 0.0;
    }
    let peak_s = (beta / alpha).ln() / (beta - alpha);
    let scale_pa = PEAK_PA / ((-alpha * peak_s).exp() - (-beta * peak_s).exp());
    let (slow, fast) = (potential(alpha, since_s), potential(beta, since_s));
    let (value, slope) = (scale_pa * (slow.0 - fast.0), scale_pa * (slow.1 - fast.1));
    -slope / (c * radius_m) - value / (radius_m * radius_m)
}

fn scene(step_s: f64) -> String {
    let corner = |x: f64, y: f64, z: f64| format!("({x}, {}, {})", y * SLOPE * x, z * SLOPE * x);
    let (a, r) = (CAVITY_M, MESH_M);
    let corners: Vec<String> = [-1.0, 1.0]
        .into_iter()
        .flat_map(|z| [corner(a, -1.0, z), corner(r, -1.0, z), corner(r, 1.0, z), corner(a, 1.0, z)])
        .collect();
    let held: Vec<String> = ["1, 0", "-1, 0", "0, 1", "0, -1"]
        .iter()
        .map(|side| {
            format!(
                "(block: \"cone\", on: Plane(point_m: (0, 0, 0), normal: ({SLOPE}, {side})), hold: Normal)"
            )
        })
        .collect();
    format!(
        "(title: \"cavity\", time: (step_s: {step_s:e}, end_s: 1),
          materials: [(name: \"rock\", young_pa: {YOUNG_PA:e}, poisson: {POISSON}, density_kg_m3: {DENSITY})],
          blocks: [(name: \"cone\", material: \"rock\", shape: Hexahedron(corners_m: ({}), cells: (70, 1, 1)))],
          supports: [{}],
          blasts: [(block: \"cone\", on: Part(Set(\"x_min\")),
                    pressure: Duvall(peak_pa: {PEAK_PA:e}, alpha_per_s: {}, beta_per_s: {}))])",
        corners.join(", "),
        held.join(", "),
        RATES.0,
        RATES.1
    )
}

/// Until the wave comes back from the end of the mesh to twice the radius of the cavity.
#[test]
fn a_blast_in_a_spherical_cavity_sends_off_the_wave_of_its_closed_form() {
    let step_s = 4e-6;
    let mut simulation = simulation(&scene(step_s));
    let end_s = (2.0 * MESH_M - 3.0 * CAVITY_M) / rock().1;
    let start = simulation.state().position.clone();
    let radii = [CAVITY_M, 2.0 * CAVITY_M];
    let origin = simulation.blocks().origin_m;
    let nodes = radii.map(|radius| {
        let corner = Vec3::new(radius, SLOPE * radius, SLOPE * radius);
        start.iter().position(|x| (x + origin - corner).norm() < 1e-6).expect("a node on an edge of the cone")
    });
    let (mut error, mut peak) = ([0.0f64; 2], [0.0f64; 2]);
    for step in 1..(end_s / step_s) as u32 {
        simulation.step().unwrap();
        for (k, (&node, &radius)) in nodes.iter().zip(&radii).enumerate() {
            let exact = displacement_m(radius, f64::from(step) * step_s);
            let moved = (simulation.state().position[node] - start[node]).norm();
            error[k] = error[k].max((moved - exact.abs()).abs());
            peak[k] = peak[k].max(exact);
        }
    }
    for (k, place) in ["wall", "place at twice its radius"].iter().enumerate() {
        let name = format!("largest error of the displacement of the {place} over its peak");
        row("spherical cavity under a blast", &name, error[k] / peak[k], AtMost(0.025));
    }
}
