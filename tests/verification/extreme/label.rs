//! The label on a second problem: an elastic block that bounces on a held one, over all h = ω_c Δt.

use ndda::judge::verdict;
use ndda::summary::LabelWord;

use super::labelled::{SPEED, summary_of, word};
use crate::bouncing_block::{ball, contact_rate, restitution};
use crate::evidence::{Answer, row};

/// Error of the restitution of a bounce, whether the run calls itself accurate, and the h that it reports over
/// the bound that it knows.
fn bounce(integrator: &str, h: f64) -> Option<(f64, bool, f64)> {
    let mut simulation = ball(integrator, h / contact_rate());
    simulation.sample().unwrap();
    let (mut touched, mut free) = (false, 0);
    // A block that passes through never touches again, or never did.
    while free < 40 {
        let touches = simulation.step().ok()?.contact.contact_pairs > 0;
        touched |= touches;
        free = if touches { 0 } else { free + 1 };
        simulation.sample().ok()?;
        if touched && free > 2 {
            break;
        }
    }
    let restitution = restitution(&mut simulation).ok()?;
    let says = verdict::label(&simulation, None).word == LabelWord::Accurate;
    let beyond = simulation.contact_bound().map_or(0.0, |bound| simulation.invariants().max_h / bound);
    Some(((restitution - 1.0).abs(), says, beyond))
}

/// The paper's integrator damps in the bar what it gains in contact, so that no verdict on energy fails.
#[test]
fn a_bar_whose_contact_is_not_resolved_says_so() {
    for (cells, step_s) in [(40, 1e-6), (40, 2e-6)] {
        let set = [
            format!("time.step_s={step_s:e}"),
            "time.integrator=Newmark(alpha: 0.5, delta: 1.0)".into(),
            "contact.penalty_pa=2e10".into(),
            "contact.potential=Smooth(reference_m: 0.01)".into(),
            format!("blocks.bar.shape.cells=({cells}, 1, 1)"),
        ];
        let summary = summary_of("studies/base/bar_impact.ron", &set);
        let summary = summary.unwrap();
        let (error, h) = (&summary["reference"]["error_max"], &summary["invariants"]["max_h"]);
        println!("Δt = {step_s:e} s: h = {h}, error {error}, {}", summary["label"]);
        assert_eq!(word(&summary), "inaccurate", "{}", summary["label"]);
    }
}

#[test]
fn a_bounce_is_never_called_accurate_when_it_is_not() {
    let integrators = [
        "Midpoint(theta: 0.5)",
        "GeneralizedAlpha(radius: 0.8)",
        "Newmark(alpha: 0.5, delta: 1)",
        "Midpoint(theta: 0.5), contact_at: End()",
    ];
    let (mut claimed_wrongly, mut too_modest) = (0, 0);
    for integrator in integrators {
        for h in
            [0.003, 0.008, 0.011, 0.015, 0.03, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.4, 1.9, 2.5, 5.0, 20.0, 300.0]
        {
            let Some((error, says, beyond)) = bounce(integrator, h) else {
                println!("{integrator}, h = {h}: stopped");
                continue;
            };
            println!("{integrator}, h = {h}: error {error:.2e}, accurate {says}, h over bound {beyond:.2}");
            claimed_wrongly += u32::from(says && error > SPEED);
            // Between the bound on rows, which is what a run knows, and ω_c itself, it may be right by luck.
            too_modest += u32::from(!says && error <= SPEED && beyond <= 1.0);
        }
    }
    // The statement: none is, in either direction.
    row(
        "extreme: penalty, step and label",
        "bounces called accurate that are not",
        f64::from(claimed_wrongly),
        Answer::AtMost(0.0),
    );
    row(
        "extreme: penalty, step and label",
        "bounces called inaccurate within the bound that are not",
        f64::from(too_modest),
        Answer::AtMost(0.0),
    );
}
