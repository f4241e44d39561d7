//! The factor of safety of a jointed slope against that of its bedding, whichever way it comes to rest.

use ndda::safety::{Kind, Question};

use crate::safety_factor::{bracket, found, holds, kind, scene};

/// F = tan φ / tan α.
fn exact(friction_deg: f64) -> f64 {
    friction_deg.to_radians().tan() / 38f64.to_radians().tan()
}

#[test]
fn a_slope_that_stands_has_the_factor_of_its_bedding() {
    let text = scene("slope_two_sets");
    let safety = found(&text, Question::Strength);
    holds("slope of two sets, bedding 38°, φ = 40°", &safety, exact(40.0));
    assert_eq!(kind(&safety), Kind::Sliding);
    assert!(safety.remarks.is_empty(), "{:?}", safety.remarks);
}

/// It comes to rest with more strength than it has, and by local damping: the answer is the same.
#[test]
fn a_slope_that_fails_has_the_factor_of_its_bedding_too() {
    let text = scene("slope_two_sets").replace("friction_deg: 40", "friction_deg: 37");
    let text = text.replace("    contact:", "    settle: (damping: Local()),\n    contact:");
    let safety = found(&text, Question::Strength);
    holds("slope of two sets, bedding 38°, φ = 37°", &safety, exact(37.0));
    assert!(bracket(&safety).1 < 1.0);
}
