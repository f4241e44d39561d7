//! Notes on blocks that topple about edges at which contact gives way.
//!
//! A force whose line meets the base d inside an edge tips a block over where M = N h L₀/(9 k_n w d³) reaches 4/27 (`lean.rs`): on a rigid edge it would do so at d = 0.
//! So the factor is too small by what moves the line by that d, which falls with the cube root of the penalty.

use crate::choose::rounded_up;

/// Part by which a factor is made larger to see how far the line of a weight moves.
pub const LITTLE: f64 = 1e-4;

/// The factor at which the line of a weight is at the edge, from how far inside of it is at a factor, and at one that is larger by [`LITTLE`]; none where that
/// does not bring it nearer.
pub fn rigid(factor: f64, inside_m: f64, inside_next_m: f64) -> Option<f64> {
    let nearer_m = inside_m - inside_next_m;
    // A move within rounding does not count.
    (nearer_m > 1e-3 * LITTLE * inside_m).then(|| factor * (1.0 + LITTLE * inside_m / nearer_m))
}

/// That a block topples too soon, and what its factor would be, if that is more than the bracket was asked to tell; `rigid` is the factor on a rigid edge.
pub fn one(
    block: &str,
    (lower, upper, rigid): (f64, f64, f64),
    error: f64,
    penalty_pa: f64,
) -> Option<String> {
    let missing = rigid / upper - 1.0;
    let raised_pa = rounded_up(penalty_pa * ((rigid / lower - 1.0) / error).powi(3));
    (missing > error).then(|| {
        format!(
            "the factor is {:.1} % too small, because `{block}` topples about an edge at which contact gives way: on a rigid edge it would be about {rigid:.4}. \
             What is missing falls with the cube root of penalty_pa, which is {penalty_pa:.0e}, and is below the {:.2} % of --error from penalty_pa: {raised_pa:.0e} on",
            100.0 * missing,
            100.0 * error
        )
    })
}

/// That several blocks topple at once: how their edges share the forces is not known, so that no factor on rigid edges is given.
pub fn several(count: usize, penalty_pa: f64) -> String {
    format!(
        "{count} blocks topple, about edges at which contact gives way: the factor may be too small. Repeat with contact.penalty_pa: {:.0e} (ten times larger) and \
         time.contact_at: End(), until the factor no longer changes",
        10.0 * penalty_pa
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A column of 1 × 2.5 m on 20°: tan α = 0.4 tips it over on a rigid edge, at 0.4/tan 20° = 1.0990. Its foot is 0.5 − 1.25 tan α inside the edge.
    #[test]
    fn the_factor_on_a_rigid_edge_follows_from_two_places_of_the_foot() {
        let inside_m = |factor: f64| 0.5 - 1.25 * factor * 20f64.to_radians().tan();
        let found = rigid(1.0574, inside_m(1.0574), inside_m(1.0574 * (1.0 + LITTLE))).unwrap();
        assert!((found - 1.0990).abs() < 1e-4, "{found}");
        assert_eq!(rigid(1.0574, 0.02, 0.02), None, "joints that are stronger do not move it");
    }

    #[test]
    fn the_penalty_that_is_named_is_enough_once_it_is_taken() {
        let exact = 1.0990;
        // What a bracket of 1 % finds where the factor is too small by a part that falls with the cube root of the penalty: 3.7 % at 1e10.
        let told = |penalty_pa: f64| {
            let found = exact / (1.0 + 0.037 * (1e10 / penalty_pa).cbrt());
            one("b", (found * 0.996, found * 1.004, exact), 0.01, penalty_pa)
        };
        let words = told(1e10).unwrap();
        assert!(words.contains("about 1.0990") && words.contains("from penalty_pa: 1e12 on"), "{words}");
        assert_eq!(told(1e12), None);
        assert!(told(1e11).is_some());
    }
}
