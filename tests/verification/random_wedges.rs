//! Factors of safety of random wedges, dry and with water, against limit equilibrium.

use ndda::safety::{Kind, Question, Safety};
use ndda_mesh::geometry::{tet_volume, triangle_area_vector};
use ndda_solver::BodyKind;

use crate::evidence::Answer::AtMost;
use crate::evidence::row;
use crate::safety_factor::{bracket, found, kind, limit_equilibrium, normal, wedge};
use crate::simulation;

/// Error that is asked for.
const ERROR: f64 = 0.01;
const DENSITY_KG_M3: f64 = 2600.0;
const GRAVITY_M_S2: f64 = 9.81;

/// Numbers from 0 to 1 (Knuth's constants, 64 bits).
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1u64 << 53) as f64
}

/// How many cases to look at.
fn wanted(fewest: usize) -> usize {
    std::env::var("NDDA_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(fewest)
}

/// By how much an exact factor lies outside of the bracket, as a part of it.
fn off(safety: &Safety, exact: f64) -> f64 {
    let (lower, upper) = bracket(safety);
    (lower / exact - 1.0).max(1.0 - upper / exact).max(0.0)
}

#[test]
fn random_wedges_have_the_factors_of_limit_equilibrium() {
    let wanted = wanted(3);
    let (mut state, mut done, mut worst) = (7, 0, 0.0f64);
    while done < wanted {
        let mut plane = || (30.0 + 40.0 * random(&mut state), 360.0 * random(&mut state));
        let planes = [plane(), plane()];
        let friction_deg = 25.0 + 20.0 * random(&mut state);
        let line = normal(planes[0].0, planes[0].1).cross(&normal(planes[1].0, planes[1].1));
        let plunge_deg = (line.z.abs() / line.norm()).asin().to_degrees();
        let (exact, expected) = limit_equilibrium(planes, friction_deg);
        // Limit equilibrium of a block on one plane knows nothing of toppling.
        if line.norm() < 0.3 || plunge_deg < 15.0 || expected != Kind::Wedge || !(0.6..6.0).contains(&exact) {
            continue;
        }
        done += 1;
        let safety = found(&wedge(planes, friction_deg), Question::Strength);
        let (lower, upper) = bracket(&safety);
        println!(
            "{planes:.2?} φ = {friction_deg:.2}°: {lower:.4} to {upper:.4}, exact {exact:.4} {expected:?}, {:?}",
            kind(&safety)
        );
        assert_eq!(kind(&safety), expected, "{planes:?} φ = {friction_deg}°");
        worst = worst.max(off(&safety, exact));
    }
    row(
        "safety",
        &format!("{wanted} random wedges: limit equilibrium outside of the bracket by [-]"),
        worst,
        // The statement: the factor is known to the error that was asked for.
        AtMost(ERROR),
    );
}

/// The block above both joints: its weight [N], and the areas of its faces on joint `a` and on joint `b` [m²].
fn measures(text: &str) -> (f64, [f64; 2]) {
    let simulation = simulation(text);
    let blocks = simulation.blocks();
    let free =
        blocks.ids().find(|&block| simulation.shape(block).kind != BodyKind::Fixed).expect("a free block");
    let x = &blocks.rest_position;
    let volume_m3: f64 =
        blocks.tets_of(free).map(|tet| tet_volume(&blocks.tets[tet].map(|n| x[n.index()]))).sum();
    let area_m2 = |name: &str| {
        let on_joint = |(triangle, surface): &(&[ndda_mesh::NodeId; 3], &Option<u32>)| {
            let is_named = surface.is_some_and(|surface| blocks.surface_names[surface as usize] == name);
            is_named && blocks.block_of(triangle[0]) == free
        };
        let triangles = blocks.triangles.iter().zip(&blocks.triangle_surface).filter(on_joint);
        triangles.map(|(t, _)| triangle_area_vector(&t.map(|n| x[n.index()])).norm()).sum::<f64>()
    };
    (DENSITY_KG_M3 * GRAVITY_M_S2 * volume_m3, [area_m2("a"), area_m2("b")])
}

/// Normal forces on both planes of a dry wedge over its weight, and the pull along their line.
fn pushes([a, b]: [(f64, f64); 2]) -> ([f64; 2], f64) {
    let (n_a, n_b) = (normal(a.0, a.1), normal(b.0, b.1));
    let line = n_a.cross(&n_b).normalize();
    let weight = -ndda_mesh::Vec3::z();
    let across = weight - weight.dot(&line) * line;
    let (cos, p_a, p_b) = (n_a.dot(&n_b), -across.dot(&n_a), -across.dot(&n_b));
    let of = |p: f64, q: f64| (p - cos * q) / (1.0 - cos * cos);
    ([of(p_a, p_b), of(p_b, p_a)], weight.dot(&line).abs())
}

/// F = Σ (N − p A) tan φ/(W sin ψ), with water that presses both sides of each joint by a part of what the weight does. Not with cohesion: the weight of these blocks presses
/// their joints so unevenly that some open in part, and c A everywhere would be too much.
#[test]
fn random_wedges_with_water_have_the_factors_of_limit_equilibrium() {
    let wanted = wanted(2);
    let (mut state, mut done, mut worst) = (11, 0, 0.0f64);
    while done < wanted {
        let mut plane = || (30.0 + 40.0 * random(&mut state), 360.0 * random(&mut state));
        let planes = [plane(), plane()];
        let friction_deg = 20.0 + 15.0 * random(&mut state);
        let wet = [0; 2].map(|_| random(&mut state));
        let line = normal(planes[0].0, planes[0].1).cross(&normal(planes[1].0, planes[1].1));
        let plunge_deg = (line.z.abs() / line.norm()).asin().to_degrees();
        let (parts, pull) = pushes(planes);
        if line.norm() < 0.3 || plunge_deg < 15.0 || parts.iter().any(|part| *part < 0.1) {
            continue;
        }
        let dry = wedge(planes, friction_deg);
        let (weight_n, areas) = measures(&dry);
        // Up to a quarter of each normal force.
        let water_pa = [0, 1].map(|k| 0.25 * wet[k] * parts[k] * weight_n / areas[k]);
        let pressed_n: f64 = (0..2).map(|k| parts[k] * weight_n - water_pa[k] * areas[k]).sum();
        let exact = pressed_n * friction_deg.to_radians().tan() / (weight_n * pull);
        if !(0.6..6.0).contains(&exact) {
            continue;
        }
        done += 1;
        let water = |name: &str, pressure_pa: f64| {
            format!("(on: Joint(\"{name}\"), pressure: Linear(pressure_pa: {pressure_pa})), ")
        };
        let water = format!("water: [{}{}], contact:", water("a", water_pa[0]), water("b", water_pa[1]));
        let safety = found(&dry.replace("contact:", &water), Question::Strength);
        let (lower, upper) = bracket(&safety);
        println!(
            "{planes:.2?} φ = {friction_deg:.2}°, p = {water_pa:.0?} Pa: {lower:.4} to {upper:.4}, exact {exact:.4}, {:?}",
            kind(&safety)
        );
        assert_eq!(kind(&safety), Kind::Wedge, "{planes:?} φ = {friction_deg}°");
        worst = worst.max(off(&safety, exact));
    }
    row(
        "safety",
        &format!("{wanted} random wedges with water: limit equilibrium outside of the bracket by [-]"),
        worst,
        AtMost(ERROR),
    );
}
