//! The error that is left in the last of three results of ever shorter steps.
//!
//! Richardson (1911): f(Δt) = f₀ + c Δtᵖ gives, for steps that halve, the observed order p = log₂(|f₁ − f₂|/|f₂ − f₃|) and
//! the error of the last result, δ = |f₂ − f₃|/(2ᵖ − 1). The bar is a safety factor times δ, as in Roache's grid
//! convergence index (Roache, Verification and Validation in Computational Science and Engineering, 1998, §5): smaller
//! where the observed order is that of the scheme, larger where it is not. Where differences do not fall there is no
//! order, and their spread takes its place.

use serde::{Deserialize, Serialize};

/// Orders this near to that of the scheme count as observed.
const NEAR: f64 = 0.5;
/// The least order with which errors are extrapolated.
const LEAST_ORDER: f64 = 0.5;
/// Differences that fall by less than 2 to this power do not fall.
const FALLS: f64 = 0.3;
/// Safety factor where the order is that of the scheme.
const SAFETY: f64 = 2.0;
/// Safety factor where it is not (Roache's for two grids).
const SAFETY_ELSE: f64 = 3.0;

/// How a sequence of results behaves as the step falls.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Behaviour {
    /// All results are the same to rounding.
    Rounding,
    /// All results are the same to rounding, but a table turns back within the shortest step, which sees its mean only: they may be wrong alike.
    Unseen,
    /// Differences fall with the order of the scheme.
    Converges,
    /// Differences fall more slowly than the order of the scheme.
    Slowly,
    /// Differences fall faster than the order of the scheme: a coincidence, or a better scheme than is known.
    Faster,
    /// Differences fall and change their sign.
    Oscillates,
    /// Differences do not fall: the error is the spread of the results.
    Spreads,
    /// The motion is chaotic: value and error are mean and scatter of the runs.
    Chaotic,
}

impl Behaviour {
    /// The word that tables show.
    pub fn word(self) -> &'static str {
        match self {
            Self::Rounding => "exact to rounding",
            Self::Unseen => "table not resolved",
            Self::Converges => "converges",
            Self::Slowly => "converges slowly",
            Self::Faster => "converges fast",
            Self::Oscillates => "oscillates",
            Self::Spreads => "does not converge",
            Self::Chaotic => "chaotic",
        }
    }
}

/// The error of the last of three results.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Its bar, never negative.
    pub error: f64,
    /// How the results behave.
    pub behaviour: Behaviour,
    /// The observed order; none where differences do not fall or are rounding.
    pub order: Option<f64>,
    /// Limit of the results; none where there is no order.
    pub limit: Option<f64>,
}

/// Error of `values[2]`, of results at Δt, Δt/2 and Δt/4 by a scheme of order `theory`; differences below `rounding`
/// say nothing.
pub fn estimate(values: [f64; 3], theory: f64, rounding: f64) -> Estimate {
    let (first, last) = (values[1] - values[0], values[2] - values[1]);
    let (a, b) = (first.abs(), last.abs());
    let of =
        |error: f64, behaviour, order, limit| Estimate { error: error + rounding, behaviour, order, limit };
    if a.max(b) <= 2.0 * rounding {
        return of(a.max(b), Behaviour::Rounding, None, None);
    }
    // A difference of zero is one below rounding.
    let least = rounding.max(f64::MIN_POSITIVE);
    let order = (a.max(least) / b.max(least)).log2();
    if order < FALLS {
        return of(SAFETY_ELSE * a.max(b), Behaviour::Spreads, None, None);
    }
    if first * last < 0.0 {
        return of((2.0 * b).max(a / 4.0), Behaviour::Oscillates, Some(order), None);
    }
    let richardson = |order: f64| b / (order.exp2() - 1.0);
    if order > theory + NEAR {
        // The last difference may be small by chance: the first, reduced by the order of the scheme, bounds the error.
        let error = (SAFETY_ELSE * richardson(theory)).max(a / theory.exp2());
        return of(error, Behaviour::Faster, Some(order), Some(values[2] + last / (theory.exp2() - 1.0)));
    }
    let counted = order.clamp(LEAST_ORDER.min(theory), theory);
    let (safety, behaviour) = match order < theory - NEAR {
        true => (SAFETY_ELSE, Behaviour::Slowly),
        false => (SAFETY, Behaviour::Converges),
    };
    let limit = values[2] + last / (counted.exp2() - 1.0);
    of(safety * richardson(counted), behaviour, Some(order), Some(limit))
}

/// Error of `coarse` by one result that is finer by `ratio` (> 1), if errors fall with the power `order` of it:
/// |f_coarse − f_fine| ratioᵖ/(ratioᵖ − 1), times the safety factor where the order is not observed.
pub fn estimate_of_coarse(coarse: f64, fine: f64, ratio: f64, order: f64) -> f64 {
    let power = ratio.powf(order);
    SAFETY * (coarse - fine).abs() * power / (power - 1.0)
}

/// Error of the first of three results, each finer than the last by `ratio`, the order being observed between ½ and
/// `theory`; the spread where differences do not fall.
pub fn estimate_of_coarsest(values: [f64; 3], ratio: f64, theory: f64, rounding: f64) -> f64 {
    let (a, b) = ((values[1] - values[0]).abs(), (values[2] - values[1]).abs());
    if a.max(b) <= 2.0 * rounding {
        return a.max(b) + rounding;
    }
    let least = rounding.max(f64::MIN_POSITIVE);
    let order = (a.max(least) / b.max(least)).ln() / ratio.ln();
    if order < FALLS {
        return SAFETY_ELSE * a.max(b) + rounding;
    }
    estimate_of_coarse(values[0], values[1], ratio, order.clamp(LEAST_ORDER, theory)) + rounding
}

/// √(Σ e²/n) of the errors of some estimates.
pub fn root_mean_square(some: &[Estimate]) -> f64 {
    let largest = some.iter().map(|e| e.error).fold(0.0, f64::max);
    if largest == 0.0 {
        return 0.0;
    }
    // Relative to the largest, so that no square overflows.
    let sum: f64 = some.iter().map(|e| (e.error / largest) * (e.error / largest)).sum();
    largest * (sum / some.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// f₀ + c Δtᵖ at Δt, Δt/2, Δt/4.
    fn sequence(order: f64, step: f64) -> [f64; 3] {
        [1.0, 0.5, 0.25].map(|part: f64| 7.0 + 3.0 * (part * step).powf(order))
    }

    #[test]
    fn errors_of_known_order_are_within_the_bar_and_the_bar_is_tight() {
        for (order, theory, behaviour) in [
            (1.0, 1.0, Behaviour::Converges),
            (2.0, 2.0, Behaviour::Converges),
            (4.0, 4.0, Behaviour::Converges),
            (1.0, 2.0, Behaviour::Slowly),
            (0.6, 1.0, Behaviour::Converges),
            (4.0, 2.0, Behaviour::Faster),
            (2.0, 1.0, Behaviour::Faster),
        ] {
            let values = sequence(order, 0.1);
            let found = estimate(values, theory, 1e-15);
            let truth = (values[2] - 7.0).abs();
            assert_eq!(found.behaviour, behaviour, "order {order}, theory {theory}");
            assert!((found.order.unwrap() - order).abs() < 1e-6, "{found:?}");
            // An observed order above the scheme's is not used; the scheme's is.
            let most = if behaviour == Behaviour::Faster { 70.0 } else { 3.1 };
            assert!(truth <= found.error && found.error <= most * truth, "{found:?}, true {truth:e}");
        }
    }

    #[test]
    fn the_limit_is_that_of_the_sequence_where_the_order_is_observed() {
        for order in [1.0, 2.0] {
            let limit = estimate(sequence(order, 0.1), order, 1e-15).limit.unwrap();
            assert!((limit - 7.0).abs() < 1e-12, "{limit}");
        }
    }

    #[test]
    fn the_same_to_rounding_is_exact() {
        let found = estimate([2.0, 2.0 + 4e-16, 2.0], 2.0, 1e-15);
        assert_eq!((found.behaviour, found.order, found.limit), (Behaviour::Rounding, None, None));
        assert!(found.error <= 2e-15, "{found:?}");
        assert_eq!(estimate([0.0; 3], 2.0, 0.0).error, 0.0);
    }

    #[test]
    fn differences_that_do_not_fall_give_their_spread() {
        for values in [[1.0, 2.0, 1.1], [1.0, 1.1, 1.25], [0.3, -0.9, 0.4]] {
            let found = estimate(values, 2.0, 1e-15);
            assert_eq!((found.behaviour, found.limit), (Behaviour::Spreads, None));
            let spread = values.iter().fold(f64::MIN, |a, b| a.max(*b))
                - values.iter().fold(f64::MAX, |a, b| a.min(*b));
            assert!(found.error >= spread, "{found:?}");
        }
    }

    #[test]
    fn differences_of_changing_sign_that_fall_give_a_bar_that_holds() {
        // Second order with a sign that depends on where in an impact the steps fall.
        for signs in [[1.0, -1.0, 1.0], [-1.0, 1.0, -1.0]] {
            let values = [0, 1, 2].map(|k| 7.0 + signs[k] * 0.25f64.powi(k as i32));
            let found = estimate(values, 2.0, 1e-15);
            assert_eq!(found.behaviour, Behaviour::Oscillates);
            assert!(found.error >= 1.0 / 16.0 && found.error <= 12.0 / 16.0, "{found:?}");
        }
    }

    #[test]
    fn a_last_difference_that_is_small_by_chance_does_not_make_the_bar_small() {
        // The errors 1, ¼ and 0.24 of a sequence that has not begun to converge.
        let found = estimate([8.0, 7.25, 7.24], 2.0, 1e-15);
        assert!(found.error >= 0.18, "{found:?}");
    }

    #[test]
    fn nothing_that_is_finite_gives_a_number_that_is_not() {
        for values in [[0.0; 3], [1.0, 1.0, 2.0], [1.0, 2.0, 2.0], [1e300, -1e300, 1e300], [1e-320, 0.0, 0.0]]
        {
            for rounding in [0.0, 1e-300] {
                let found = estimate(values, 2.0, rounding);
                let order = found.order.unwrap_or(0.0);
                assert!(found.error.is_finite() && order.is_finite(), "{values:?}: {found:?}");
            }
        }
    }

    #[test]
    fn the_error_of_the_coarse_result_is_found_from_one_or_two_finer_ones() {
        for order in [1.0, 2.0] {
            let values = sequence(order, 0.1);
            let truth = (values[0] - 7.0).abs();
            for found in [
                estimate_of_coarse(values[0], values[1], 2.0, order),
                estimate_of_coarsest(values, 2.0, order, 1e-15),
            ] {
                assert!(truth <= found && found <= 2.01 * truth, "{found:e}, true {truth:e}");
            }
        }
        assert!(estimate_of_coarsest([1.0, 1.1, 1.3], 2.0, 2.0, 0.0) >= 0.3);
    }
}
