//! Random materials, contact laws and time integrators.

use crate::random::Random;

/// How time is stepped, step and end apart.
pub fn time(random: &mut Random) -> String {
    let integrator = match random.whole(0, 99) {
        0..60 => "Midpoint(theta: 0.5)".to_string(),
        60..68 => format!("Midpoint(theta: {})", random.between(0.5, 1.0)),
        68..86 => format!("GeneralizedAlpha(radius: {})", random.between(0.0, 1.0)),
        86..93 => "Newmark(alpha: 0.5, delta: 1.0)".to_string(),
        _ => "Newmark(alpha: 0.25, delta: 0.5)".to_string(),
    };
    let mut text = format!("integrator: {integrator}");
    if random.happens(0.12) {
        text += ", contact_at: End()";
    }
    if random.happens(0.08) {
        text += ", step: Auto()";
    }
    if random.happens(0.1) {
        text += ", mass: Lumped";
    }
    if random.happens(0.1) {
        text += ", solver: ConjugateGradients()";
    }
    text
}

/// A rock.
pub fn material(random: &mut Random, young_pa: f64) -> String {
    let poisson = random.between(0.0, 0.4);
    let damping = match random.whole(0, 9) {
        0 => format!(", damping: (mass_per_s: {})", random.decades(0.1, 1e3)),
        1 => format!(", damping: (stiffness_s: {})", random.decades(1e-7, 1e-4)),
        _ => String::new(),
    };
    format!("(name: \"rock\", young_pa: {young_pa}, poisson: {poisson}, density_kg_m3: 2650{damping})")
}

/// A contact law between blocks of a size [m]; `{C}` stands for a strength.
pub fn contact(random: &mut Random, young_pa: f64, length_m: f64) -> String {
    let penalty_pa = young_pa * random.decades(1e-4, 0.1);
    let potential = match random.whole(0, 5) {
        0..3 => "Element".to_string(),
        3..5 => format!("Smooth(reference_m: {})", length_m * random.between(0.2, 1.0)),
        _ => format!(
            "Volume(exponent: {}, reference_m3: {})",
            random.between(1.5, 2.5),
            length_m.powi(3) * random.decades(1e-3, 1e-2)
        ),
    };
    let friction = friction(random, penalty_pa / length_m);
    let memory = if random.happens(0.1) { ", memory: Element" } else { "" };
    format!("Potential(penalty_pa: {penalty_pa}, potential: {potential}{friction}{memory})")
}

/// The same contact with a coefficient of restitution below 1, often a small one.
pub fn damped(random: &mut Random, contact: &str) -> String {
    let restitution = match random.whole(0, 9) {
        0 => 0.0,
        1..3 => random.decades(0.01, 0.2),
        _ => random.between(0.2, 0.95),
    };
    let open = contact.strip_suffix(')').expect("a contact in parentheses");
    format!("{open}, restitution: {restitution})")
}

/// No friction, friction on velocities, or shear springs that may hold together.
fn friction(random: &mut Random, stiffness_pa_m: f64) -> String {
    let friction_deg = random.between(5.0, 50.0);
    let spring = format!("shear_penalty_pa_m: {}", stiffness_pa_m * random.decades(0.03, 3.0));
    match random.whole(0, 9) {
        0..3 => String::new(),
        3..6 => format!(", friction: (friction_deg: {friction_deg})"),
        6..9 => format!(", friction: (friction_deg: {friction_deg}, {spring})"),
        _ => format!(
            ", friction: (friction_deg: {friction_deg}, {spring}, cohesion_pa: {{C}}, tension_pa: {{C}})"
        ),
    }
}
