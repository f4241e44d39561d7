//! Closed forms of direct-shear tests.

use ndda_io::scene::Friction;

use super::{Comparison, Hold, NormalStiffness, ShearRow, ShearTest};
use crate::build::friction::roughness;

/// Shear strength τ = c + σ tan φ of a joint, and the spring and the dilation with it.
struct Plastic {
    cohesion_pa: f64,
    friction: f64,
    /// 1/k_s [m/Pa].
    compliance_m_pa: f64,
    /// tan ψ, and the slip where dilation ends [m].
    dilation: (f64, f64),
}

impl Plastic {
    fn strength_pa(&self, normal_pa: f64) -> f64 {
        self.cohesion_pa + self.friction * normal_pa
    }

    /// v at a plastic slip from the start [m].
    fn opening_m(&self, plastic_m: f64) -> f64 {
        self.dilation.0 * plastic_m.abs().min(self.dilation.1)
    }
}

/// The joint at the end of a test, by its closed form.
struct End {
    shear_pa: f64,
    normal_pa: f64,
    plastic_slip_m: f64,
    dilation_m: f64,
    /// Where it is one.
    dissipated_j_m2: Option<f64>,
}

/// A test beside its closed form, where there is one: perfectly plastic joints forth and back, joints that soften or break in one direction under a
/// constant stress, and the peak of rough ones.
pub fn shear(friction: &Friction, test: &ShearTest, rows: &[ShearRow]) -> Vec<Comparison> {
    let Some(last) = rows.last() else { return Vec::new() };
    let is_forth = test.path_m.windows(2).all(|pair| pair[0] <= pair[1]);
    let mobilised = friction.roughness.is_some_and(|rough| rough.mobilised);
    if mobilised {
        return peak(friction, test, rows).into_iter().collect();
    }
    if friction.fracture.is_some() {
        return broken(friction, test, last).into_iter().collect();
    }
    let end = match (softens(friction), is_forth, test.hold) {
        (false, true, _) => forth(friction, test, last.slip_m),
        (false, false, Hold::Stress) => cycled(friction, test, last),
        (true, true, Hold::Stress) => softened(friction, test, last.slip_m),
        _ => None,
    };
    let Some(end) = end else { return Vec::new() };
    let row = Comparison::new;
    let mut found = vec![
        row("shear stress at the end", "Pa", last.shear_pa, end.shear_pa),
        row("normal stress at the end", "Pa", last.normal_pa, end.normal_pa),
        row("plastic slip", "m", last.plastic_slip_m, end.plastic_slip_m),
        row("opening by slip", "m", last.dilation_m, end.dilation_m),
    ];
    found.extend(end.dissipated_j_m2.map(|lost| row("energy lost", "J/m²", last.dissipated_j_m2, lost)));
    found
}

/// Whether strength falls with slip.
fn softens(friction: &Friction) -> bool {
    let Friction { friction_deg, cohesion_pa, residual, roughness, .. } = *friction;
    match residual {
        Some(after) => after.friction_deg < friction_deg || after.cohesion_pa < cohesion_pa,
        None => roughness.is_none() && cohesion_pa > 0.0,
    }
}

/// The joint as a perfectly plastic one under a normal stress; nothing where its strength is no straight line over the stresses of the test.
fn plastic(friction: &Friction, test: &ShearTest) -> Option<Plastic> {
    let compliance_m_pa = friction.shear_penalty_pa_m.map_or(0.0, f64::recip);
    if let Some(rough) = &friction.roughness {
        let (joint, stress_pa) = (roughness(friction.friction_deg, rough), test.stress_pa);
        let slope = rough.strength_factor * joint.strength_pa(stress_pa) / stress_pa;
        let psi = joint.dilation_deg(stress_pa).to_radians().tan();
        let dilation = (psi, f64::INFINITY);
        let law = Plastic { cohesion_pa: 0.0, friction: slope, compliance_m_pa, dilation };
        return (test.hold == Hold::Stress).then_some(law);
    }
    let dilation = friction.dilation.map_or((0.0, 0.0), |d| (d.psi_deg.to_radians().tan(), d.to_slip_m));
    let (cohesion_pa, friction) = (friction.cohesion_pa, friction.friction_deg.to_radians().tan());
    Some(Plastic { cohesion_pa, friction, compliance_m_pa, dilation })
}

/// 1/(1/K + 1/k_n) [Pa/m]: by how much the normal stress grows with the opening by slip, where that is constant.
fn held_pa_m(test: &ShearTest) -> Option<f64> {
    let closes_m_pa = match test.normal {
        NormalStiffness::Rigid => 0.0,
        NormalStiffness::Linear { stiffness_pa_m } => 1.0 / stiffness_pa_m,
        NormalStiffness::Hyperbolic { .. } if test.hold == Hold::Stress => 0.0,
        NormalStiffness::Hyperbolic { .. } => return None,
    };
    Some(match test.hold {
        Hold::Stress => 0.0,
        Hold::Volume => 1.0 / closes_m_pa,
        Hold::Stiffness { stiffness_pa_m } => 1.0 / (1.0 / stiffness_pa_m + closes_m_pa),
    })
}

/// σ = σ₀ + K′ v, τ = c + σ tan φ, u = u_p + τ/k_s, v = tan ψ min(u_p, u_zd): linear in σ on either side of the end of dilation.
fn forth(friction: &Friction, test: &ShearTest, slip_m: f64) -> Option<End> {
    let (law, held_pa_m) = (plastic(friction, test)?, held_pa_m(test)?);
    let (tan, to_slip_m) = law.dilation;
    let slips = |normal_pa: f64| slip_m - law.compliance_m_pa * law.strength_pa(normal_pa);
    if slips(test.stress_pa) <= 0.0 {
        // It has not yielded.
        let shear_pa = slip_m / law.compliance_m_pa;
        let (plastic_slip_m, dilation_m, dissipated_j_m2) = (0.0, 0.0, Some(0.0));
        return Some(End {
            shear_pa,
            normal_pa: test.stress_pa,
            plastic_slip_m,
            dilation_m,
            dissipated_j_m2,
        });
    }
    let growth_pa = held_pa_m * tan;
    let elastic_m = law.compliance_m_pa * law.cohesion_pa;
    let dilating_pa = (test.stress_pa + growth_pa * (slip_m - elastic_m))
        / (1.0 + growth_pa * law.friction * law.compliance_m_pa);
    let normal_pa =
        if slips(dilating_pa) <= to_slip_m { dilating_pa } else { test.stress_pa + growth_pa * to_slip_m };
    let (plastic_slip_m, shear_pa) = (slips(normal_pa), law.strength_pa(normal_pa));
    let dilation_m = law.opening_m(plastic_slip_m);
    // While the joint dilates, both stresses grow in proportion to the plastic slip.
    let (dilated_m, mean_pa) = (plastic_slip_m.min(to_slip_m), 0.5 * (test.stress_pa + normal_pa));
    let (dilated_j, rest_m) = (law.strength_pa(mean_pa) * dilated_m, plastic_slip_m - dilated_m);
    let dissipated_j_m2 = Some(dilated_j + shear_pa * rest_m - mean_pa * dilation_m);
    Some(End { shear_pa, normal_pa, plastic_slip_m, dilation_m, dissipated_j_m2 })
}

/// Cycles of a perfectly plastic joint under a constant stress: each turn costs 2 τ/k_s of plastic slip, the first loading τ/k_s.
fn cycled(friction: &Friction, test: &ShearTest, last: &ShearRow) -> Option<End> {
    let law = plastic(friction, test)?;
    let amplitude_m = test.path_m.iter().copied().fold(0.0, f64::max);
    let way_m: f64 = test.path_m.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum();
    let way_m = way_m + test.path_m[0].abs();
    let strength_pa = law.strength_pa(test.stress_pa);
    let stretch_m = law.compliance_m_pa * strength_pa;
    if amplitude_m < 2.0 * stretch_m {
        return None;
    }
    let turns = (way_m / (4.0 * amplitude_m)).round() * 2.0;
    let plastic_slip_m = way_m - stretch_m * (1.0 + 2.0 * turns);
    // It comes back to its start from below.
    let dilation_m = law.opening_m(last.slip_m - stretch_m);
    // A rough joint may dilate by another angle from slip to slip; what it loses is a sum over all of them all the same.
    let dissipated_j_m2 = Some(strength_pa * plastic_slip_m - test.stress_pa * dilation_m);
    Some(End {
        shear_pa: strength_pa,
        normal_pa: test.stress_pa,
        plastic_slip_m,
        dilation_m,
        dissipated_j_m2,
    })
}

/// A strength that falls linearly over u_c under a constant stress, at once where the spring is softer or u_c is nothing.
fn softened(friction: &Friction, test: &ShearTest, slip_m: f64) -> Option<End> {
    let law = plastic(friction, test)?;
    let peak_pa = law.strength_pa(test.stress_pa);
    let (residual_pa, over_m) = match &friction.residual {
        Some(after) => {
            (after.cohesion_pa + after.friction_deg.to_radians().tan() * test.stress_pa, after.over_m)
        }
        None => (law.friction * test.stress_pa, 0.0),
    };
    let beyond_m = slip_m - law.compliance_m_pa * peak_pa;
    if beyond_m <= 0.0 {
        return forth(friction, test, slip_m);
    }
    let snaps = over_m <= law.compliance_m_pa * (peak_pa - residual_pa);
    let softening_m = if snaps {
        f64::INFINITY
    } else {
        beyond_m / (1.0 - law.compliance_m_pa * (peak_pa - residual_pa) / over_m)
    };
    let is_residual = softening_m >= over_m;
    let plastic_slip_m = if is_residual { slip_m - law.compliance_m_pa * residual_pa } else { softening_m };
    let fallen = if is_residual { 1.0 } else { plastic_slip_m / over_m };
    let shear_pa = peak_pa - fallen * (peak_pa - residual_pa);
    let dilation_m = law.opening_m(plastic_slip_m);
    let falling_m = plastic_slip_m.min(over_m);
    let lost_j_m2 = 0.5 * (peak_pa + shear_pa) * falling_m + residual_pa * (plastic_slip_m - falling_m);
    // A joint that snaps loses part of its spring's energy to motion, which depends on inertia.
    let dissipated_j_m2 = (!snaps).then_some(lost_j_m2 - test.stress_pa * dilation_m);
    Some(End { shear_pa, normal_pa: test.stress_pa, plastic_slip_m, dilation_m, dissipated_j_m2 })
}

/// The largest shear stress of a joint whose roughness is mobilised by slip, where the test comes to the peak under a constant stress.
fn peak(friction: &Friction, test: &ShearTest, rows: &[ShearRow]) -> Option<Comparison> {
    let rough = friction.roughness.as_ref()?;
    let joint = roughness(friction.friction_deg, rough);
    let most_m = rows.iter().map(|row| row.plastic_slip_m).fold(0.0, f64::max);
    if test.hold != Hold::Stress || most_m < joint.peak_slip_m() {
        return None;
    }
    let found_pa = rows.iter().map(|row| row.shear_pa).fold(0.0, f64::max);
    let exact_pa = rough.strength_factor * joint.strength_pa(test.stress_pa);
    Some(Comparison::new("largest shear stress, of all steps", "Pa", found_pa, exact_pa))
}

/// Friction of a joint that has broken gradually in one direction, under a constant stress.
fn broken(friction: &Friction, test: &ShearTest, last: &ShearRow) -> Option<Comparison> {
    let last_m = 2.0 * friction.fracture?.shear_j_m2 / friction.cohesion_pa;
    let exact_pa = friction.friction_deg.to_radians().tan() * test.stress_pa;
    let slips = last.slip_m - last_m > 2.0 * exact_pa / friction.shear_penalty_pa_m?;
    let holds = slips && test.hold == Hold::Stress;
    holds.then(|| Comparison::new("shear stress at the end", "Pa", last.shear_pa, exact_pa))
}
