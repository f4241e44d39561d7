//! A plan in words.

use std::fmt;

use ndda_solver::BodyKind;

use super::Explanation;
use crate::numbers::counted;

impl fmt::Display for Explanation {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        writeln!(f, "{}: {}\n{} steps of {} s", self.scene, self.title, self.steps, self.step_s)?;
        if !self.parameters.is_empty() {
            let named = self.parameters.iter().map(|(name, value)| format!("{name} = {value}"));
            writeln!(f, "parameters: {}", named.collect::<Vec<_>>().join(", "))?;
        }
        if let Some(advice) = &self.step_advice {
            writeln!(f, "{advice}")?;
        }
        writeln!(f, "\nblocks")?;
        for plan in &self.blocks {
            let kind = format!("{:?}", plan.kind);
            let moves = match plan.kind {
                BodyKind::Fixed => "not moved by forces".into(),
                BodyKind::Rigid => "six degrees of freedom each, no equations to solve".into(),
                BodyKind::Affine | BodyKind::Elastic => counted(plan.unknowns, "unknown", "unknowns"),
            };
            writeln!(
                f,
                "  {kind:8} {}, {}, {moves}",
                counted(plan.blocks, "block", "blocks"),
                counted(plan.tets, "tetrahedron", "tetrahedra")
            )?;
        }
        self.write_factors(f)?;
        self.write_parts(f, true)?;
        self.write_parts(f, false)?;
        writeln!(f, "\nfiles\n  {}", self.files.join("\n  "))?;
        let features: Vec<String> =
            self.features.iter().map(|(name, on)| format!("{}{name}", if *on { "+" } else { "-" })).collect();
        let threads = counted(self.threads, "thread", "threads");
        writeln!(f, "\n{threads}; features {}", features.join(" "))
    }
}

/// Lines of factors that are shown.
const MOST_FACTORS: usize = 10;

impl Explanation {
    fn write_factors(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if self.factors.is_empty() {
            return writeln!(f, "\nequations: none to solve");
        }
        writeln!(f, "\nequations, factored once: {} distinct", self.factors.len())?;
        for plan in self.factors.iter().take(MOST_FACTORS) {
            let alike = match plan.blocks {
                1 => format!("`{}`", plan.block),
                n => format!("`{}` and {} like it, {} of them together", plan.block, n - 1, plan.together),
            };
            writeln!(f, "  {:6} unknowns, {}: {alike}", plan.unknowns, plan.solver)?;
        }
        match self.factors.len().saturating_sub(MOST_FACTORS) {
            0 => Ok(()),
            more => writeln!(f, "  … and {more} more, none larger"),
        }
    }

    fn write_parts(&self, f: &mut fmt::Formatter, included: bool) -> fmt::Result {
        writeln!(f, "\n{}", if included { "computed" } else { "left out, and why" })?;
        let chosen: Vec<_> = self.parts.iter().filter(|part| part.included == included).collect();
        let widest = chosen.iter().map(|part| part.name.chars().count()).max().unwrap_or(0);
        chosen.iter().try_for_each(|part| writeln!(f, "  {:widest$}  {}", part.name, part.reason))
    }
}
