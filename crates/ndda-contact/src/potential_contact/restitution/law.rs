//! The law of contact damping, and the factor that gives a coefficient of restitution.
//!
//! A normal force F_el that a body of mass m feels at the depth δ is multiplied by 1 + α δ̇/E, at least by zero, where ½ m E² = ½ m δ̇² + W(δ) is the
//! energy of the impact. With s = √(2W/m) the motion is v dv = −s (1 + α v/√(v² + s²)) ds, from which F_el has dropped out: the restitution depends on α alone,
//! whatever the elastic law, the mass and the speed. In polar coordinates v = E q, s = E √(1 − q²),
//!
//! ```text
//! ln E(−1/α) = −∫ α q²/(1 + α q (1 − q²)) dq  from max(−1, −1/α) to 1        e = E · min(1, 1/α)
//! ```
//!
//! Contact ends where the factor is zero, at v = −E/α, and the body is free from there.

/// Least restitution that is reckoned with: without any, a contact would stay where an impact has pressed it.
const LEAST_RESTITUTION: f64 = 0.005;
/// Factor of [`LEAST_RESTITUTION`], and more.
const MOST_FACTOR: f64 = 64.0;
/// Points of the integral of e(α), and halvings of its inverse.
const POINTS: u32 = 2000;
const HALVINGS: u32 = 60;

/// e of the factor α.
pub(super) fn restitution_of(factor: f64) -> f64 {
    let end = -(1.0 / factor).min(1.0);
    // The integrand has its peak at the end: q = end + (1 − end) t².
    let width = 1.0 / f64::from(POINTS);
    let at = |k: u32| {
        let t = (f64::from(k) + 0.5) * width;
        let q = end + (1.0 - end) * t * t;
        factor * q * q / (1.0 + factor * q * (1.0 - q * q)) * 2.0 * (1.0 - end) * t * width
    };
    (-(0..POINTS).map(at).sum::<f64>()).exp() * -end
}

/// α of a coefficient of restitution from 0 to 1; none for a contact that gives back all.
pub(super) fn factor_of(restitution: f64) -> f64 {
    if restitution >= 1.0 {
        return 0.0;
    }
    let wanted = restitution.max(LEAST_RESTITUTION);
    let (mut less, mut more) = (0.0, MOST_FACTOR);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (less + more);
        if restitution_of(middle) > wanted { less = middle } else { more = middle }
    }
    0.5 * (less + more)
}

/// c/√(m K) of a dashpot beside a spring with which half an oscillation leaves this part of the speed: 2ζ, e = exp(−π ζ/√(1 − ζ²)).
pub(super) fn shear_factor_of(restitution: f64) -> f64 {
    if restitution >= 1.0 {
        return 0.0;
    }
    let decrement = -restitution.max(LEAST_RESTITUTION).ln();
    2.0 * decrement / decrement.hypot(std::f64::consts::PI)
}

/// Where in a step a velocity counts by which a damper of rate λ, z = λ Δt, brakes it, so that it decays by exp(−z): ½ at the start of
/// a short step, the end in a long one.
pub(super) fn weight_of_end(z: f64) -> f64 {
    // 1/(1 − exp(−z)) − 1/z loses its digits for small z.
    if z < 1e-2 { 0.5 + z / 12.0 } else { -1.0 / (-z).exp_m1() - 1.0 / z }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rebound of a unit mass at unit speed from F = k δⁿ (1 + α δ̇/E), by the trapezoidal rule in time (Heun's).
    fn rebound(factor: f64, exponent: f64, stiffness: f64) -> f64 {
        let rate = |depth: f64, speed: f64| {
            let force = stiffness * depth.max(0.0).powf(exponent);
            let energy = 2.0 * force * depth.max(0.0) / (exponent + 1.0) + speed * speed;
            -force * (1.0 + factor * speed / energy.sqrt()).max(0.0)
        };
        let time_s = stiffness.powf(-1.0 / (exponent + 1.0)) * 1e-4;
        let (mut depth, mut speed) = (0.0, 1.0);
        while depth >= 0.0 {
            let first = rate(depth, speed);
            let second = rate(depth + time_s * speed, speed + time_s * first);
            depth += time_s * (speed + 0.5 * time_s * first);
            speed += 0.5 * time_s * (first + second);
        }
        -speed
    }

    #[test]
    fn the_rebound_is_that_of_the_coefficient_for_every_elastic_law_and_stiffness() {
        for restitution in [0.05, 0.3, 0.6, 0.9] {
            for (exponent, stiffness) in [(1.0, 1.0), (1.0, 1e6), (1.5, 1e3), (3.0, 1e3)] {
                let found = rebound(factor_of(restitution), exponent, stiffness);
                assert!(
                    (found - restitution).abs() < 1e-3,
                    "e = {restitution}, F ∝ δ^{exponent}, k = {stiffness}: {found}"
                );
            }
        }
    }

    #[test]
    fn the_factor_is_the_inverse_of_the_restitution() {
        assert_eq!(factor_of(1.0), 0.0);
        for restitution in [0.005, 0.1, 0.5, 0.99, 0.999] {
            let found = restitution_of(factor_of(restitution));
            assert!((found - restitution).abs() < 1e-12, "{restitution}: {found}");
        }
        assert_eq!(factor_of(0.0), factor_of(LEAST_RESTITUTION));
    }

    #[test]
    fn a_velocity_that_is_braked_decays_exponentially() {
        for z in [1e-6, 0.009_999, 0.010_001, 0.3, 5.0, 800.0] {
            let at = weight_of_end(z);
            // v₁ = v₀ − z ((1 − θ) v₀ + θ v₁).
            let left = (1.0 - z * (1.0 - at)) / (1.0 + z * at);
            assert!((left - (-z).exp()).abs() < 1e-6, "{z}: {left}");
        }
    }
}
