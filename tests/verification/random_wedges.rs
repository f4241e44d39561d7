//! Factors of safety of random wedges, dry, with water, with cohesion and sliding on one plane, against limit equilibrium.

use ndda::safety::{Kind, Question, Safety};
use ndda_mesh::Vec3;

use crate::evidence::Answer::AtMost;
use crate::evidence::row;
use crate::safety_factor::{bracket, found, kind, limit_equilibrium, normal, wedge};
use crate::wedge_statics::{measures, slides_without_turning};

/// Error that is asked for.
const ERROR: f64 = 0.01;

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

/// Normal forces on both planes of a dry wedge over its weight, and the pull along their line.
fn pushes([a, b]: [(f64, f64); 2]) -> ([f64; 2], f64) {
    let (n_a, n_b) = (normal(a.0, a.1), normal(b.0, b.1));
    let line = n_a.cross(&n_b).normalize();
    let weight = -Vec3::z();
    let across = weight - weight.dot(&line) * line;
    let (cos, p_a, p_b) = (n_a.dot(&n_b), -across.dot(&n_a), -across.dot(&n_b));
    let of = |p: f64, q: f64| (p - cos * q) / (1.0 - cos * cos);
    ([of(p_a, p_b), of(p_b, p_a)], weight.dot(&line).abs())
}

/// F = Σ (N − p A) tan φ/(W sin ψ), with water that presses both sides of each joint by a part of what the weight does.
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
        let (weight_n, _, faces) = measures(&dry);
        let areas = faces.map(|face| face.area_m2);
        // Up to a quarter of each normal force.
        let water_pa = [0, 1].map(|k| 0.25 * wet[k] * parts[k] * weight_n / areas[k]);
        let pressed_n: f64 = (0..2).map(|k| parts[k] * weight_n - water_pa[k] * areas[k]).sum();
        let exact = pressed_n * friction_deg.to_radians().tan() / (weight_n * pull);
        if !(0.6..6.0).contains(&exact) {
            continue;
        }
        done += 1;
        let safety = found(&dry.replace("contact:", &water(water_pa)), Question::Strength);
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

/// The water of both joints, before the contact of a scene.
fn water(pressure_pa: [f64; 2]) -> String {
    let [a, b] = pressure_pa;
    let of = |name: &str, pa: f64| format!("(on: Joint(\"{name}\"), pressure: Linear(pressure_pa: {pa})), ");
    format!("water: [{}{}], contact:", of("a", a), of("b", b))
}

/// The contact of a scene whose joints have these friction angles [°], cohesions and tensile strengths [Pa], all of which they keep: limit equilibrium of perfectly plastic
/// joints, which open at the apex of Mohr and Coulomb's line where their faces are pressed unevenly, and lose nothing by that.
fn contact(joints: [(f64, f64, f64); 2]) -> String {
    let law = |name: &str, (friction_deg, cohesion_pa, tension_pa): (f64, f64, f64)| {
        let strength =
            format!("friction_deg: {friction_deg}, cohesion_pa: {cohesion_pa}, tension_pa: {tension_pa}");
        let opens = if tension_pa > 0.0 { ", opening_m: 0.1" } else { "" };
        format!(
            "(joint: \"{name}\", friction: (shear_penalty_pa_m: 1e9, {strength}, residual: ({strength}{opens}))), "
        )
    };
    let [a, b] = joints;
    format!(
        "contact: Potential(penalty_pa: 2e9, potential: Smooth(), rock_joints: [{}{}]))",
        law("a", a),
        law("b", b)
    )
}

/// F = Σ (c A + (N − p A) tan φ)/(W sin ψ), to 1 % for every wedge. Limit equilibrium knows no moments: Mohr and Coulomb's line has to hold up to its apex, also where joints open, since their
/// weight presses them unevenly.
#[test]
fn random_wedges_with_cohesion_and_water_have_the_factors_of_limit_equilibrium() {
    let wanted = wanted(3);
    let (mut state, mut done, mut turned, mut worst) = (13, 0, 0, 0.0f64);
    while done < wanted {
        let mut random = || random(&mut state);
        let mut plane = || (30.0 + 40.0 * random(), 360.0 * random());
        let planes = [plane(), plane()];
        let friction_deg = [0; 2].map(|_| 20.0 + 25.0 * random());
        let (held, wet) = ([0; 2].map(|_| random()), [0; 2].map(|_| random()));
        let line = normal(planes[0].0, planes[0].1).cross(&normal(planes[1].0, planes[1].1));
        let plunge_deg = (line.z.abs() / line.norm()).asin().to_degrees();
        let (parts, pull) = pushes(planes);
        if line.norm() < 0.3 || plunge_deg < 15.0 || parts.iter().any(|part| *part < 0.1) {
            continue;
        }
        let dry = wedge(planes, friction_deg[0]);
        let (weight_n, center, faces) = measures(&dry);
        let mean_pa = [0, 1].map(|k| parts[k] * weight_n / faces[k].area_m2);
        // Cohesion up to half of the mean pressure of the weight, water up to a quarter of it.
        let cohesion_pa = [0, 1].map(|k| 0.5 * held[k] * mean_pa[k]);
        let water_pa = [0, 1].map(|k| 0.25 * wet[k] * mean_pa[k]);
        let tan = friction_deg.map(|deg| deg.to_radians().tan());
        let held_n: f64 =
            (0..2).map(|k| (cohesion_pa[k] + (mean_pa[k] - water_pa[k]) * tan[k]) * faces[k].area_m2).sum();
        let exact = held_n / (weight_n * pull);
        if !(0.6..6.0).contains(&exact) {
            continue;
        }
        let forces = [0, 1].map(|k| {
            let (tan, area_m2) = (tan[k] / exact, faces[k].area_m2);
            let pressed_n = (mean_pa[k] - water_pa[k]) * area_m2;
            let kept_n = [cohesion_pa[k] / exact * area_m2, water_pa[k] * area_m2];
            (normal(planes[k].0, planes[k].1), pressed_n, tan, kept_n)
        });
        if !slides_without_turning(&faces, center, line, &forces) {
            turned += 1;
            continue;
        }
        done += 1;
        let laws = [0, 1].map(|k| (friction_deg[k], cohesion_pa[k], cohesion_pa[k] / tan[k]));
        let (before, _) = dry.split_once("contact:").expect("contact");
        let text = format!("{before}{}", contact(laws)).replace("contact:", &water(water_pa));
        let safety = found(&text, Question::Strength);
        let (lower, upper) = bracket(&safety);
        println!(
            "{planes:.2?} φ = {friction_deg:.2?}°, c = {cohesion_pa:.0?} Pa, p = {water_pa:.0?} Pa: {lower:.4} to {upper:.4}, exact {exact:.4}, {:?}",
            kind(&safety)
        );
        assert_eq!(kind(&safety), Kind::Wedge, "{planes:?}");
        worst = worst.max(off(&safety, exact));
    }
    println!("{turned} more would turn");
    assert!(10 * turned <= wanted + 10, "{turned} of {wanted} would turn");
    row(
        "safety",
        &format!(
            "{wanted} random wedges with cohesion and water: limit equilibrium outside of the bracket by [-]"
        ),
        worst,
        AtMost(ERROR),
    );
}

/// F = (c A + (W cos α − p A) tan φ)/(W sin α) of a block that the weight lifts off one of its planes. Limit equilibrium knows no moments. The weight must not topple it, or pull
/// the joint open where that has cohesion. What cohesion and water do at the centre of the face must not turn it in its plane, against the other joint, which has no tensile strength,
/// or it would hold.
#[test]
fn random_wedges_that_slide_on_one_plane_have_the_factors_of_limit_equilibrium() {
    let wanted = wanted(3);
    let (mut state, mut done, mut worst) = (17, 0, 0.0f64);
    while done < wanted {
        let mut random = || random(&mut state);
        let mut plane = || (30.0 + 40.0 * random(), 360.0 * random());
        let planes = [plane(), plane()];
        let friction_deg = [0; 2].map(|_| 20.0 + 25.0 * random());
        let line = normal(planes[0].0, planes[0].1).cross(&normal(planes[1].0, planes[1].1));
        let (parts, _) = pushes(planes);
        if line.norm() < 0.3 || parts.iter().all(|part| *part > -0.05) {
            continue;
        }
        let on = usize::from(parts[1] > parts[0]);
        let dry = wedge(planes, friction_deg[on]);
        let (weight_n, center, faces) = measures(&dry);
        let (face, n) = (&faces[on], normal(planes[on].0, planes[on].1));
        let ((sine, cosine), tan) =
            (planes[on].0.to_radians().sin_cos(), friction_deg[on].to_radians().tan());
        let (size_m, mean_pa) = (face.area_m2.sqrt(), weight_n * cosine / face.area_m2);
        let beside_m = (face.center() - center).dot(&strike(planes[on].1));
        // Each second block has friction alone, which acts on velocities. The others have cohesion up to half of the mean pressure of the weight, water up to a quarter of it.
        let holds = done % 2 == 1;
        let draws = (0..if holds { 200 } else { 1 }).map(|_| match holds {
            true => (0.5 * random() * mean_pa, 0.25 * random() * mean_pa),
            false => (0.0, 0.0),
        });
        let mut draws = draws.filter(|(cohesion_pa, water_pa)| {
            let held_pa = cohesion_pa + (mean_pa - water_pa) * tan;
            let turns_m = (cohesion_pa - water_pa * tan) / held_pa * beside_m;
            // Half of the tensile strength, which is reduced with the rest.
            let least_pa = if holds { -0.5 * cohesion_pa / tan } else { -0.5 * mean_pa };
            let pressed = face.pressures(n, (mean_pa * face.area_m2, center), *water_pa);
            turns_m.abs() < STRAIGHT * size_m && pressed.iter().all(|pressure| *pressure > least_pa)
        });
        let Some((cohesion_pa, water_pa)) = draws.next() else { continue };
        let exact = (cohesion_pa + (mean_pa - water_pa) * tan) * face.area_m2 / (weight_n * sine);
        if !(0.6..6.0).contains(&exact) {
            continue;
        }
        done += 1;
        let mut laws = friction_deg.map(|deg| (deg, 0.0, 0.0));
        laws[on] = (friction_deg[on], cohesion_pa, cohesion_pa / tan);
        let mut on_both = [0.0; 2];
        on_both[on] = water_pa;
        let (before, _) = dry.split_once("contact:").expect("contact");
        let wet = || format!("{before}{}", contact(laws)).replace("contact:", &water(on_both));
        let safety = found(&if holds { wet() } else { dry.clone() }, Question::Strength);
        let (lower, upper) = bracket(&safety);
        let joints: Vec<&str> =
            safety.moving_blocks[0].planes.iter().filter_map(|plane| plane.joint.as_deref()).collect();
        println!(
            "{planes:.2?} on {on}: φ = {:.2}°, c = {cohesion_pa:.0} Pa, p = {water_pa:.0} Pa: {lower:.4} to {upper:.4}, exact {exact:.4}, {:?} on {joints:?}",
            friction_deg[on],
            kind(&safety)
        );
        assert_eq!((kind(&safety), joints), (Kind::Sliding, vec![["a", "b"][on]]), "{planes:?}");
        worst = worst.max(off(&safety, exact));
    }
    row(
        "safety",
        &format!(
            "{wanted} random wedges that slide on one plane: limit equilibrium outside of the bracket by [-]"
        ),
        worst,
        AtMost(ERROR),
    );
}

/// How far beside the line of the weight friction and cohesion act at most, over the size of the face.
const STRAIGHT: f64 = 3e-3;

/// The level direction in a plane.
fn strike(direction_deg: f64) -> Vec3 {
    let (sine, cosine) = direction_deg.to_radians().sin_cos();
    Vec3::new(cosine, -sine, 0.0)
}
