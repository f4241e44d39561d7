//! Shear penalties from 1e-3 to 1 E (the paper's Figs 8 and 9): the error against a slide without a spring falls as the
//! spring stiffens, and is what the spring's own closed form says.

use super::labelled::{summary_of, word};
use crate::evidence::{Answer, row};

#[test]
fn stiffer_shear_springs_slide_more_as_if_there_were_none() {
    let mut last = f64::INFINITY;
    for (ratio, penalty, step_s) in
        [("1e-3", "2e8", "1e-4"), ("1e-2", "2e9", "1e-4"), ("0.1", "2e10", "1e-4"), ("1", "2e11", "2.5e-5")]
    {
        let summary = summary_of(
            "sliding_45_phi35_spring.ron",
            &[
                format!("contact.friction.shear_penalty_pa_m={penalty}"),
                format!("time.step_s={step_s}"),
                "time.end_s=0.1".into(),
                "reference.after_s=0.05".into(),
            ],
        );
        let summary = summary.expect("a scene that is sound");
        let error = |key: &str| summary["reference"][key].as_f64().unwrap();
        assert_eq!(word(&summary), "accurate", "k_s = {ratio} E: {}", summary["label"]);
        assert!(error("error_end") < last, "k_s = {ratio} E: {} after {last}", error("error_end"));
        last = error("error_end");
        let what = format!("error against the spring's closed form, k_s = {ratio} E");
        row("extreme: shear penalty", &what, error("stick_stage_end"), Answer::AtMost(1e-3));
    }
}
