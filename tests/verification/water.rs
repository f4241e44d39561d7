//! Water in joints: buoyancy, work of pressure on moving faces, planes and wedges against limit equilibrium.

use ndda::safety::{Kind, Question};
use ndda_mesh::Vec3;
use ndda_solver::Simulation;

use crate::evidence::Answer::{AtLeast, AtMost, Near, Within};
use crate::evidence::{rounding, row};
use crate::safety_factor::{bracket, found, holds, kind, normal, scene};
use crate::simulation;

const GAMMA_W: f64 = 9810.0;

fn block(body: &str, more: &str) -> Simulation {
    simulation(&format!(
        "(title: \"wet\", time: (step_s: 1e-3, end_s: 1),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)],
          blocks: [(name: \"block\", material: \"rock\", body: {body}, shape: Box(size_m: (1, 2, 3), cells: (2, 2, 2)), {more})"
    ))
}

fn advance(simulation: &mut Simulation, steps: u32) {
    for _ in 0..steps {
        simulation.step().unwrap();
    }
}

#[test]
fn a_submerged_block_weighs_less_by_the_water_that_it_displaces() {
    for (level, volume, bodies) in [(3.0, 6.0, ["Rigid", "Affine", "Elastic"]), (1.0, 2.0, ["Rigid"; 3])] {
        for body in bodies {
            let mut simulation = block(
                body,
                &format!(
                    ")], gravity_m_s2: (0, 0, -9.81),
                    water: [(on: Part(block: \"block\", region: All), pressure: Level(at_m: (0, 0, {level})))]"
                ),
            );
            simulation.sample().unwrap();
            advance(&mut simulation, 1);
            let momentum = simulation.sample().unwrap().momentum;
            let exact = -(2500.0 * 6.0 - 1000.0 * volume) * 9.81 * 1e-3;
            row(
                "water",
                &format!("momentum of a {body} block in water, {level} m [kg m/s]"),
                momentum.z,
                // Pressure acts where the block is before it moves: rounding of a sum over 48 faces, twofold.
                Within(exact, 2.0 * rounding(48)),
            );
        }
    }
}

#[test]
fn pressure_follows_a_turning_face_and_its_work_is_in_the_books() {
    for body in ["Rigid", "Affine", "Elastic"] {
        let mut simulation = block(
            body,
            "spin_rad_s: (0, 0, 3))], water: [(on: Part(block: \"block\", region: Set(\"x_min\")), pressure: Linear(pressure_pa: 2e4))]",
        );
        simulation.sample().unwrap();
        advance(&mut simulation, 500);
        let sample = simulation.sample().unwrap();
        // The push turns with the block, the velocity with it: |v| = (p A / m ω) · 2 sin(ω t/2); the face pushes through the centre.
        let (rate, t) = (2e4 * 6.0 / 15000.0, 0.5);
        let exact = rate / 3.0 * 2.0 * (1.5f64 * t).sin();
        let speed = sample.momentum.norm() / 15000.0;
        row(
            "water",
            &format!("speed of a spinning {body} block pushed by pressure [m/s]"),
            speed,
            Within(exact, 1e-4),
        );
        let scale = sample.kinetic_j;
        row(
            "water",
            &format!("its balance of energy over its energy, {body} [-]"),
            (sample.balance_j / scale).abs(),
            // Work of a force that turns by ω Δt in a step: (ω Δt)²/12 by the trapezoidal rule.
            AtMost((3.0f64 * 1e-3).powi(2) / 12.0),
        );
        assert!(sample.load_work_j > 0.1 * scale, "{body}: pressure works");
    }
}

#[test]
fn pressure_over_time_gives_its_mean_to_each_step() {
    let mut simulation = block(
        "Rigid",
        ")], water: [(on: Part(block: \"block\", region: Set(\"x_min\")),
            pressure: Points(along: (0, 0, 2), rows: [(0, 0), (1, 6e3), (3, 6e3)]),
            factor: [(time_s: 0, factor: 0), (time_s: 0.05, factor: 1)])]",
    );
    advance(&mut simulation, 100);
    let momentum = simulation.sample().unwrap().momentum;
    // 2 m wide: 2 (½ · 6 kPa · 1 m + 6 kPa · 2 m) over 0.025 s and 0.05 s; the block turns a little.
    row(
        "water",
        "impulse of pressure from a table of points over time [N s]",
        momentum.x,
        Within(30e3 * 0.075, 1e-3),
    );
}

/// Wyllie & Mah: a plane slide with a tension crack.
fn plane(depth_m: f64, cohesion_pa: f64) -> f64 {
    let (psi, phi, face) = (35f64.to_radians(), 37f64.to_radians(), 60f64.to_radians());
    let (height, crack) = (12.0, 4.35);
    let area = (height - crack) / psi.sin();
    let part = 1.0 - (crack / height) * (crack / height);
    let weight = 0.5 * 26e3 * height * height * (part / psi.tan() - 1.0 / face.tan());
    let (uplift, push) = (0.5 * GAMMA_W * depth_m * area, 0.5 * GAMMA_W * depth_m * depth_m);
    let normal = weight * psi.cos() - uplift - push * psi.sin();
    (cohesion_pa * area + normal * phi.tan()) / (weight * psi.sin() + push * psi.cos())
}

#[test]
fn a_plane_with_a_tension_crack_has_the_factors_of_hoek_and_bray() {
    let text = scene("plane_water");
    for (depth_m, cohesion_pa, noted) in
        [(3.0, 25e3, 1.24666), (0.0, 25e3, 1.54448), (4.35, 25e3, 1.07245), (0.0, 0.0, 1.07619)]
    {
        let exact = plane(depth_m, cohesion_pa);
        assert!((exact - noted).abs() < 1e-5, "{exact} {noted}");
        let text = text.replace("cohesion_pa: 25e3", &format!("cohesion_pa: {cohesion_pa}"));
        let text = text
            .replace("10.65)", &format!("{})", 7.65 + depth_m))
            .replace("29430", &format!("{}", GAMMA_W * depth_m));
        let safety = found(&text, Question::Strength);
        holds(
            &format!("plane of 35°, water {depth_m} m deep in its crack, c = {cohesion_pa} Pa"),
            &safety,
            exact,
        );
        assert_eq!(kind(&safety), Kind::Sliding);
    }
}

/// tan φ / tan α (1 − p/(ρ g h cos α)), h normal to the plane: 1 at p = 0.270149 ρ g h.
#[test]
fn a_block_on_a_slope_slides_at_the_pressure_of_limit_equilibrium() {
    let (alpha, phi) = (30f64.to_radians(), 40f64.to_radians());
    let limit = alpha.cos() - alpha.sin() / phi.tan();
    assert!((limit - 0.270149).abs() < 1e-6, "{limit}");
    let wet = |pressure_pa: f64| {
        scene("plane_dry").replace(
            "contact:",
            &format!(
                "water: [(on: Part(block: \"cube\", region: Set(\"z_min\")), pressure: Linear(pressure_pa: {pressure_pa}))], contact:"
            ),
        )
    };
    let limit_pa = limit * 2600.0 * 9.81;
    row("water", "pressure at which a block 1 m high on 30° slides [Pa]", limit_pa, Near(6890.4, 0.1));
    for part in [0.5, 0.99, 1.01] {
        let safety = found(&wet(part * limit_pa), Question::Strength);
        let exact = phi.tan() / alpha.tan() * (1.0 - part * limit / alpha.cos());
        holds(&format!("cube on 30° at {part} of that pressure"), &safety, exact);
    }
    let tilted = found(&wet(0.5 * limit_pa), Question::Gravity { towards: None });
    // N = W cos α − U, and α grows until tan α is F times as large.
    let fails = |factor: f64| {
        let steeper = (factor * alpha.tan()).atan();
        (steeper.cos() - 0.5 * limit) * phi.tan() / steeper.sin() < 1.0
    };
    let stands = tilted.factor_of_safety.lower.expect("it stands on its own slope");
    assert!(!fails(stands) && fails(1.01 * stands), "by tilting gravity it stands up to {stands}");
}

/// Hoek & Bray's wedge of the joints 45/105 and 70/235 with a mean pressure on both: its factor, and the effective forces on them.
fn wedge(mean_pa: f64) -> f64 {
    let (a, b, face, top) =
        (normal(45.0, 105.0), normal(70.0, 235.0), normal(65.0, 185.0), normal(12.0, 195.0));
    let line = a.cross(&b).normalize();
    let down = if line.z < 0.0 { line } else { -line };
    let far = down * (40.0 / down.z);
    let corner = |plane: &Vec3| {
        let edge = plane.cross(&face);
        edge * (top.dot(&far) / top.dot(&edge))
    };
    let (at_a, at_b) = (corner(&a), corner(&b));
    let volume_m3 = far.dot(&at_a.cross(&at_b)).abs() / 6.0;
    let weight_n = 25e3 * volume_m3;
    let areas = [far.cross(&at_a).norm() / 2.0, far.cross(&at_b).norm() / 2.0];
    let (plunge_deg, trend_deg) = ((-down.z).asin().to_degrees(), down.x.atan2(down.y).to_degrees());
    let noted = [31.1965, 157.732, 6698.16, 885.141, 892.010];
    for (found, noted) in [plunge_deg, trend_deg, volume_m3, areas[0], areas[1]].into_iter().zip(noted) {
        assert!((found / noted - 1.0).abs() < 5e-6, "{found} instead of {noted}");
    }
    let pull = -weight_n * Vec3::z();
    let across = pull - pull.dot(&line) * line;
    let cos = a.dot(&b);
    let (p_a, p_b) = (-across.dot(&a), -across.dot(&b));
    let total = [(p_a - cos * p_b) / (1.0 - cos * cos), (p_b - cos * p_a) / (1.0 - cos * cos)];
    let effective = [total[0] - mean_pa * areas[0], total[1] - mean_pa * areas[1]];
    assert!(effective[0] > 0.0 && effective[1] > 0.0, "both joints are pressed");
    let tan = |angle: f64| angle.to_radians().tan();
    let holding = 24e3 * areas[0] + 48e3 * areas[1] + effective[0] * tan(20.0) + effective[1] * tan(30.0);
    holding / pull.dot(&down)
}

#[test]
fn a_wedge_with_cohesion_has_the_factors_of_hoek_and_bray_dry_and_wet() {
    let text = scene("wedge_wet");
    let mean_pa = GAMMA_W * 40.0 / 6.0;
    assert!((wedge(0.0) - 1.845172).abs() < 1e-6 && (wedge(mean_pa) - 1.213946).abs() < 1e-6);
    for part in [0.0, 0.5] {
        let text = text.replace("factor: 0.5", &format!("factor: {part}"));
        let safety = found(&text, Question::Strength);
        holds(&format!("wedge 45/105, 70/235 with c, {part} of its water"), &safety, wedge(part * mean_pa));
        assert_eq!(kind(&safety), Kind::Wedge);
    }
    // With all of its water a joint opens in part and loses its cohesion there: less than c A everywhere gives.
    let safety = found(&text.replace("factor: 0.5", "factor: 1"), Question::Strength);
    let (lower, upper) = bracket(&safety);
    row("water", "wedge 45/105, 70/235 with all of its water: upper end [-]", upper, AtMost(wedge(mean_pa)));
    row(
        "water",
        "wedge 45/105, 70/235 with all of its water: lower end [-]",
        lower,
        AtLeast(0.96 * wedge(mean_pa)),
    );
    let opened = safety.mechanism.as_ref().and_then(|how| how.opened.clone()).expect("a joint opens");
    assert!(opened.joints.contains(&"b".to_string()), "{opened:?}");
    let told = lower * (1.0 + opened.lowers_by);
    row("water", "the same with what it has lost, as the note says [-]", told, Within(wedge(mean_pa), 0.02));
    // Joints that bear tension up to the apex of their strength do as the formula says.
    let safety = found(&up_to_the_apex(&text.replace("factor: 0.5", "factor: 1")), Question::Strength);
    holds("wedge 45/105, 70/235 with all of its water and c/tan φ", &safety, wedge(mean_pa));
    assert_eq!(kind(&safety), Kind::Wedge);
    assert!(safety.mechanism.is_some_and(|how| how.opened.is_none()));
}

/// The scene with a tensile strength of c/tan φ of both joints, which they keep.
fn up_to_the_apex(text: &str) -> String {
    [(20.0, 24.0), (30.0, 48.0)].into_iter().fold(text.to_string(), |text, (friction_deg, cohesion_kpa)| {
        let strength = format!("friction_deg: {friction_deg}, cohesion_pa: {cohesion_kpa}e3");
        let tension_pa = 1e3 * cohesion_kpa / f64::to_radians(friction_deg).tan();
        text.replace(&strength, &format!("{strength}, tension_pa: {tension_pa}"))
    })
}
