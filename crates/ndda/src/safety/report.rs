//! The answer in words and columns.

use std::fmt::Write as _;

use super::rest::STRONGEST;
use super::{Bracket, By, Safety, State};
use crate::columns::columns;
use crate::numbers::{counted, length, trend_and_plunge};

/// Blocks that are named.
const MOST_BLOCKS: usize = 12;

/// The answer as text.
pub fn text(safety: &Safety) -> String {
    let mut text = format!("{}: {}\n", safety.scene, safety.title);
    let by = match safety.by {
        By::Strength => "tan φ, c and σ_t of all joints divided by the factor",
        By::Load => "forces and tractions multiplied by the factor",
        By::Gravity { slope_deg, normals: [a, b], .. } if a == b => &format!(
            "ratio of shear to normal force on the plane of {slope_deg:.1}° multiplied by the factor, by tilting gravity"
        ),
        By::Gravity { slope_deg, .. } => &format!(
            "ratio of the weight that drives blocks down the line of two planes, which plunges {slope_deg:.1}°, to the weight that presses on them \
             multiplied by the factor, by tilting gravity"
        ),
    };
    let answer = match safety.factor_of_safety {
        Bracket { upper: Some(upper), .. } if !safety.stands_as_drawn() => {
            format!(
                "does not stand as drawn, even with joints {STRONGEST} times as strong: factor of safety below {:.3}",
                (1e3 * upper).ceil() / 1e3
            )
        }
        Bracket { lower: Some(lower), upper: Some(upper) } => {
            format!("factor of safety {lower:.4} to {upper:.4}")
        }
        Bracket { lower: Some(lower), upper: None } => format!("factor of safety above {lower:.4}"),
        Bracket { lower: None, upper: Some(upper) } => format!("factor of safety below {upper:.4}"),
        Bracket { lower: None, upper: None } => "factor of safety unknown: no trial was decided".into(),
    };
    let _ = writeln!(text, "{answer} ({by})");
    if let Some(mechanism) = &safety.mechanism {
        let _ = writeln!(text, "{}", mechanism.words);
        let rows = safety.moving_blocks.iter().take(MOST_BLOCKS).map(|block| {
            vec![
                block.name.clone(),
                block.kind.to_string(),
                trend_and_plunge(block.direction),
                length(block.gone_m),
            ]
        });
        let header = ["moving block", "how", "trend/plunge", "moved"].map(String::from).to_vec();
        let _ = writeln!(text, "{}", columns(header, rows.collect()));
        if safety.moving_blocks.len() > MOST_BLOCKS {
            let _ = writeln!(
                text,
                "{} more blocks move, see safety.json",
                safety.moving_blocks.len() - MOST_BLOCKS
            );
        }
    }
    let rows = safety.trials.iter().map(|trial| {
        vec![
            format!("{:.4}", trial.factor),
            state(trial.state).to_string(),
            trial.steps.to_string(),
            format!("{:.1}", trial.wall_s),
            trial.reason.clone(),
        ]
    });
    let header = ["factor", "blocks", "steps", "time [s]", "why"].map(String::from).to_vec();
    if !safety.trials.is_empty() {
        let _ = writeln!(text, "{}", columns(header, rows.collect()));
    }
    for remark in &safety.remarks {
        let _ = writeln!(text, "note: {remark}");
    }
    let _ = writeln!(text, "{}", time_spent(safety));
    text
}

/// Time and trials; those of earlier calls apart.
fn time_spent(safety: &Safety) -> String {
    let Safety { wall_s, earlier_s, known_trials, trials, .. } = safety;
    let trials = counted(trials.len(), "trial", "trials");
    match known_trials {
        0 => format!("time spent: {wall_s:.1} s in {trials}"),
        known => format!(
            "{known} of {trials} known from an earlier run; time spent: {:.1} s now, {earlier_s:.1} s then",
            wall_s - earlier_s
        ),
    }
}

/// The blocks' final state, in a word.
pub fn state(state: State) -> &'static str {
    match state {
        State::Stands => "stand",
        State::Fails => "fail",
        State::Undecided => "undecided",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::safety::{SCHEMA, Trial};

    #[test]
    fn trials_of_earlier_calls_are_counted_apart() {
        let trial = Trial {
            factor: 1.0,
            state: State::Stands,
            reason: String::new(),
            block: String::new(),
            history: Vec::new(),
            broken_facets: None,
            velocities: Vec::new(),
            pushed: false,
            followed: false,
            steps: 10,
            wall_s: 1.0,
        };
        let mut safety = Safety {
            schema: SCHEMA.into(),
            version: String::new(),
            scene: "s".into(),
            title: "t".into(),
            scene_crc32: String::new(),
            by: By::Strength,
            error: 0.01,
            factor_of_safety: Bracket { lower: Some(1.0), upper: None },
            not_standing: Vec::new(),
            mechanism: None,
            moving_blocks: Vec::new(),
            trials: vec![trial; 3],
            remarks: Vec::new(),
            wall_s: 30.0,
            known_trials: 0,
            earlier_s: 0.0,
        };
        assert_eq!(time_spent(&safety), "time spent: 30.0 s in 3 trials");
        (safety.known_trials, safety.earlier_s) = (2, 20.0);
        assert_eq!(
            time_spent(&safety),
            "2 of 3 trials known from an earlier run; time spent: 10.0 s now, 20.0 s then"
        );
    }
}
