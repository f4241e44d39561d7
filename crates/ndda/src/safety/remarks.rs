//! What is said beside the answer, read off its trials and its mechanism.

use super::mechanism::Kind;
use super::opened::Opened;
use super::rest::STRONGEST;
use super::slender::Slender;
use super::{Bracket, By, Safety, State};
use crate::numbers::{length, trend_and_plunge};

/// Remarks to read before using the answer; `is_brittle` where some cohesion is lost at once.
pub fn of(answer: &Safety, slender: Option<&Slender>, is_brittle: bool) -> Vec<String> {
    let mut remarks: Vec<String> = not_standing(answer).into_iter().collect();
    if !answer.stands_as_drawn() {
        return remarks;
    }
    remarks.extend(topples(answer, slender));
    remarks.extend(is_brittle.then(|| brittle(answer)));
    remarks.extend(answer.mechanism.as_ref().and_then(|how| how.opened.as_ref()).map(opened));
    let Bracket { lower, upper } = answer.factor_of_safety;
    let cut_off = answer.mechanism.as_ref().map(|how| &how.cut_off_by).filter(|sides| !sides.is_empty());
    if let Some(sides) = cut_off {
        let sides: Vec<String> = sides.iter().map(|side| format!("`{side}`")).collect();
        remarks.push(format!(
            "what moves is cut off by the model's {} {}: with cohesion, tension, water or several blocks a larger domain may give another factor",
            if sides.len() == 1 { "side" } else { "sides" },
            sides.join(", ")
        ));
    }
    if let (Some(lower), Some(upper)) = (lower, upper) {
        let width = upper / lower - 1.0;
        if width > answer.error * (1.0 + 1e-9) {
            remarks.push(format!(
                "the bracket is {:.1} % wide, {:.1} % was asked for: between its ends blocks neither rest nor accelerate",
                100.0 * width,
                100.0 * answer.error
            ));
        }
        if answer.trials.iter().any(|trial| trial.state == State::Stands && trial.factor > upper) {
            remarks.push(
                "blocks stand at some larger factors, too: the smallest factor at which they fail counts"
                    .into(),
            );
        }
    }
    if let (None, Some(upper)) = (lower, upper) {
        remarks.push(format!("blocks fail at every factor from {upper:.3} on that was tried"));
    }
    if let (Some(lower), None) = (lower, upper) {
        remarks.push(match answer.by {
            By::Gravity { .. } => format!(
                "blocks stand at every factor up to {lower:.3}, where gravity acts almost along the plane that it is tilted on: try another --towards"
            ),
            _ => format!("blocks stand at every factor up to {lower:.3}: what is changed does not make them fail"),
        });
    }
    remarks
}

/// Blocks that do not stand as drawn, and what that means for the answer.
fn not_standing(answer: &Safety) -> Option<String> {
    let first = answer.not_standing.first()?;
    let others = match answer.not_standing.len() - 1 {
        0 => String::new(),
        1 => " and another block".into(),
        count => format!(" and {count} other blocks"),
    };
    let way = match first.direction {
        [0.0, 0.0, 0.0] => String::new(),
        // Straight up and down have no trend.
        direction => match trend_and_plunge(direction) {
            way if way.ends_with('°') => format!(" towards {way}"),
            way => format!(" {way}"),
        },
    };
    let goes = format!("`{}`{others} moved {}{way}", first.block, length(first.moved_m));
    let moves = format!("{goes} before the scene came to rest");
    Some(match (answer.stands_as_drawn(), answer.trials.is_empty()) {
        (true, _) => {
            format!(
                "{moves}, even with joints {STRONGEST} times as strong: the factor is that of the others, from there on"
            )
        }
        (false, true) => {
            format!(
                "{goes}: hold what moves by supports, or correct its loads, its water or its shape. If it topples with its weight still just inside the edge of its base, contact is too soft: raise penalty_pa"
            )
        }
        (false, false) => {
            format!(
                "{moves}, where it fails first: trials are of that place. Hold it by a support, or correct its loads, its water or its shape"
            )
        }
    })
}

/// That a block may topple at a slope that is less steep than the answer says.
fn topples(answer: &Safety, slender: Option<&Slender>) -> Option<String> {
    let Slender { block, factor } = slender?;
    let slides = answer.factor_of_safety.lower? > *factor;
    let has_toppled = answer.mechanism.as_ref().is_some_and(|how| how.kind == Kind::Toppling);
    (slides && answer.by == By::Strength && !has_toppled).then(|| {
        format!(
            "blocks may topple first: the weight of `{block}` acts beyond the edge of its base where the ratio of shear to normal force is {factor:.2} times as large: try --by gravity"
        )
    })
}

/// What becomes of cohesion that is exceeded.
fn brittle(answer: &Safety) -> String {
    let lower = answer.factor_of_safety.lower;
    let standing = answer.trials.iter().find(|trial| Some(trial.factor) == lower);
    let broken = standing.and_then(|trial| trial.broken_facets).filter(|[broken, _]| *broken > 0);
    let found = match (broken, standing) {
        (Some([broken, all]), Some(trial)) => {
            format!(
                "some of it was gone on {broken} of {all} facets in contact where blocks still stood, at {:.4}. ",
                trial.factor
            )
        }
        _ => String::new(),
    };
    format!(
        "cohesion is lost for good, facet by facet, where it is exceeded (no `residual`): {found}Formulas with c A everywhere may give more; \
         set `residual` to the peak values for joints that keep their cohesion while they slip"
    )
}

/// Cohesion that is lost where joints open.
fn opened(opened: &Opened) -> String {
    let joints: Vec<String> = opened.joints.iter().map(|joint| format!("`{joint}`")).collect();
    let (one, several) = (("joint", "has"), ("joints", "have"));
    let (noun, verb) = if joints.len() == 1 { one } else { several };
    format!(
        "{noun} {} {verb} opened on {:.0} % of the area and lost cohesion there: formulas with c A everywhere give some {:.1} % more. {}",
        joints.join(", "),
        100.0 * opened.area_part,
        100.0 * opened.lowers_by,
        match opened.has_tension {
            true =>
                "Weight or water pulls there by more than the tensile strength, about which formulas say nothing",
            false =>
                "With `tension_pa` of c/tan φ, also in `residual`, joints bear tension as limit equilibrium assumes",
        }
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::safety::{Mechanism, Moved, SCHEMA, Trial};

    fn answer(lower: Option<f64>, upper: Option<f64>, not_standing: Vec<Moved>) -> Safety {
        let trial = |factor| Trial {
            factor,
            state: State::Stands,
            reason: String::new(),
            block: String::new(),
            history: Vec::new(),
            steps: 0,
            wall_s: 0.0,
            broken_facets: Some([12, 40]),
            velocities: Vec::new(),
            pushed: false,
            followed: false,
        };
        Safety {
            schema: SCHEMA.into(),
            version: String::new(),
            scene: String::new(),
            title: String::new(),
            scene_crc32: String::new(),
            by: By::Strength,
            error: 0.01,
            factor_of_safety: Bracket { lower, upper },
            not_standing,
            mechanism: Some(Mechanism {
                kind: Kind::Sliding,
                words: String::new(),
                cut_off_by: Vec::new(),
                opened: None,
            }),
            moving_blocks: Vec::new(),
            trials: lower.map(trial).into_iter().collect(),
            remarks: Vec::new(),
            wall_s: 0.0,
            known_trials: 0,
            earlier_s: 0.0,
        }
    }

    #[test]
    fn a_slender_block_that_slides_later_than_it_topples_is_told() {
        let slender = Slender { block: "column".into(), factor: 1.4928 };
        let remarks = of(&answer(Some(3.118), Some(3.138), Vec::new()), Some(&slender), false);
        assert!(
            remarks.len() == 1 && remarks[0].contains("`column`") && remarks[0].contains("1.49"),
            "{remarks:?}"
        );
        assert!(of(&answer(Some(1.2), Some(1.21), Vec::new()), Some(&slender), false).is_empty());
    }

    #[test]
    fn what_does_not_stand_is_told_with_its_way() {
        let moved = Moved { block: "a".into(), moved_m: 3.158, direction: [1.0, 0.0, 0.0] };
        let alone = of(&answer(None, Some(1.0 / STRONGEST), vec![moved.clone()]), None, true);
        assert!(alone.len() == 1 && alone[0].starts_with("`a` moved 3.16 m towards 90.0°/0.0°"), "{alone:?}");
        let up = Moved { block: "a".into(), moved_m: 12.6, direction: [0.0, 0.0, 1.0] };
        let flown = of(&answer(None, Some(1.0 / STRONGEST), vec![up]), None, true);
        assert!(flown[0].starts_with("`a` moved 12.6 m upward"), "{flown:?}");
        let beside = of(&answer(Some(1.2), Some(1.21), vec![moved]), None, false);
        assert!(
            beside.len() == 1 && beside[0].contains("32 times as strong: the factor is that of the others"),
            "{beside:?}"
        );
    }

    #[test]
    fn cohesion_of_joints_that_open_is_told_with_what_it_lowers() {
        let mut answer = answer(Some(1.179), Some(1.187), Vec::new());
        let opened =
            Opened { joints: vec!["b".into()], area_part: 0.12, lowers_by: 0.028, has_tension: false };
        answer.mechanism.as_mut().expect("blocks fail").opened = Some(opened);
        let remarks = of(&answer, None, false);
        assert!(
            remarks.len() == 1
                && remarks[0].starts_with("joint `b` has opened on 12 %")
                && remarks[0].contains("2.8 % more"),
            "{remarks:?}"
        );
    }

    #[test]
    fn cohesion_that_is_gone_is_counted() {
        let remarks = of(&answer(Some(1.2), Some(1.21), Vec::new()), None, true);
        assert!(remarks.len() == 1 && remarks[0].contains("12 of 40 facets"), "{remarks:?}");
    }
}
