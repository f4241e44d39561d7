//! Why a run is inaccurate, in words: a cure that several reasons have is said once.

use super::words::OR_DAMP;

/// Reasons of which several are cured by a shorter step, and the others.
struct Grouped<'a> {
    /// By how much the step is to be divided; 0 where no reason says so.
    part: f64,
    /// What a shorter step cures.
    by_step: Vec<&'a str>,
    others: Vec<&'a str>,
}

impl<'a> Grouped<'a> {
    /// None where fewer than two reasons have that cure.
    fn new(reasons: &'a [String]) -> Option<Self> {
        let mut grouped = Self { part: 0.0, by_step: Vec::new(), others: Vec::new() };
        for reason in reasons {
            match step_cure(reason) {
                Some((what, part)) => {
                    grouped.by_step.push(what);
                    grouped.part = grouped.part.max(part.unwrap_or(0.0));
                }
                None => grouped.others.push(reason),
            }
        }
        Some(grouped).filter(|grouped| grouped.by_step.len() > 1)
    }

    fn cure(&self) -> String {
        match self.part {
            0.0 => "reduce step_s".into(),
            part => format!("divide step_s by {part} or more"),
        }
    }
}

/// A reason whose cure is a shorter step, without that cure; and by how much the step is to be divided, if it says so.
fn step_cure(reason: &str) -> Option<(&str, Option<f64>)> {
    let reason = reason.strip_suffix(OR_DAMP).unwrap_or(reason);
    let (what, cure) = reason.rsplit_once([';', ':'])?;
    match cure.trim() {
        "reduce step_s" => Some((what, None)),
        cure => Some((what, Some(cure.strip_prefix("divide step_s by ")?.parse().ok()?))),
    }
}

/// Reasons as they follow a word and a colon: one in the same line, several in lines of their own.
pub fn in_lines(reasons: &[String]) -> String {
    let lines = |reasons: &[&str]| reasons.iter().map(|reason| format!("\n  {reason}")).collect::<String>();
    match (Grouped::new(reasons), reasons) {
        (Some(grouped), _) => {
            let others = match grouped.others.as_slice() {
                [] => String::new(),
                others => format!("\nand{}", lines(others)),
            };
            format!(" {}, because{}{others}", grouped.cure(), lines(&grouped.by_step))
        }
        (None, [reason]) => format!(" {reason}"),
        (None, reasons) => lines(&reasons.iter().map(String::as_str).collect::<Vec<_>>()),
    }
}

/// Reasons in one line.
pub fn in_a_line(reasons: &[String]) -> String {
    match Grouped::new(reasons) {
        Some(grouped) => {
            let by_step = grouped.by_step.join("; ");
            let others: String = grouped.others.iter().map(|reason| format!("; and {reason}")).collect();
            format!("{}, because {by_step}{others}", grouped.cure())
        }
        None => reasons.join("; "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cure_of_several_reasons_is_said_once_with_the_largest_number() {
        let reasons =
            ["energy was gained; reduce step_s", "h is 5; divide step_s by 3", "too deep: raise penalty_pa"]
                .map(String::from);
        assert_eq!(
            in_lines(&reasons),
            " divide step_s by 3 or more, because\n  energy was gained\n  h is 5\nand\n  too deep: raise penalty_pa"
        );
        assert_eq!(
            in_a_line(&reasons),
            "divide step_s by 3 or more, because energy was gained; h is 5; and too deep: raise penalty_pa"
        );
        assert_eq!(in_lines(&reasons[1..]), "\n  h is 5; divide step_s by 3\n  too deep: raise penalty_pa");
        assert_eq!(in_lines(&reasons[2..]), " too deep: raise penalty_pa");
    }
}
