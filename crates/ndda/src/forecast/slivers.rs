//! Whether so much of a rock is slivers that its joints are no longer those of the scene.

use ndda_io::code::Code;
use ndda_io::diagnostic::{Diagnostic, Severity};
use ndda_io::read::LoadedScene;

use crate::build::RockReport;
use crate::numbers::{counted, four_figures};

/// Part of the volume of a rock in slivers that were united, above which its blocks are others than those between its joints.
const MUCH: f64 = 0.1;
/// The cure.
const CURE: &str = "reduce sliver_width_m to a tenth of the smallest spacing, or less";

/// Number of each rock of which much is slivers, and what is said of it.
fn found(rocks: &[RockReport]) -> impl Iterator<Item = (usize, String)> + '_ {
    rocks.iter().enumerate().filter_map(|(index, rock)| {
        let (count, merged_m3) = rock.merged;
        let part = merged_m3 / rock.domain_m3;
        (part > MUCH).then(|| {
            let slivers = counted(count, "sliver", "slivers");
            let volume = four_figures(merged_m3);
            let said = format!(
                "{slivers} of {volume} m³, {:.0} % of the rock, were united with neighbours: its blocks are no longer those between its joints",
                100.0 * part
            );
            (index, said)
        })
    })
}

/// Warnings, each in a sentence.
pub fn sentences(rocks: &[RockReport]) -> Vec<String> {
    found(rocks).map(|(_, message)| format!("{message}; {CURE}")).collect()
}

/// The same at their places in the scene.
pub fn warnings(loaded: &LoadedScene, rocks: &[RockReport]) -> Vec<Diagnostic> {
    let warning = |(index, message): (usize, String)| {
        let found = loaded.diagnose_as(Code::Inexact, &format!("rock[{index}].sliver_width_m"), message);
        Diagnostic { severity: Severity::Warning, ..found.with_help(CURE) }
    };
    found(rocks).map(warning).collect()
}

#[cfg(test)]
mod tests {
    use ndda_io::code::Code;

    use crate::Model;

    /// Codes of the warnings about values of a rock that is cut by one set, with slivers up to a width.
    fn codes(spacing_m: f64, sliver_width_m: f64) -> Vec<String> {
        let text = format!(
            "(title: \"rock\", time: (step_s: 1e-4, end_s: 1e-3),
            materials: [(name: \"rock\", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
            rock: [(name: \"rock\", material: \"rock\", body: Rigid, sliver_width_m: {sliver_width_m},
                domain: Box(min_m: (0, 0, 0), max_m: (4, 4, 4)),
                joints: [Set(name: \"a\", dip_deg: 0, dip_direction_deg: 0, spacing_m: {spacing_m}, origin_m: (0, 0, 0.1))])],
            contact: Potential(potential: Smooth(), penalty_pa: 1e8, friction: (friction_deg: 30)))"
        );
        let warnings = Model::from_text(&text).unwrap().loaded.warnings;
        // Nothing loads it, which is told, too.
        let of_values = warnings.iter().filter(|warning| warning.code == Code::Inexact);
        of_values.map(|warning| warning.code.to_string()).collect()
    }

    #[test]
    fn slivers_that_are_much_of_the_rock_or_wider_than_a_spacing_are_warned_of() {
        assert_eq!(codes(1.0, 0.2), Vec::<String>::new());
        assert_eq!(codes(0.5, 0.6), ["inexact", "inexact"]);
    }
}
