//! Rock under terrain whose file lacks heights within.

use ndda_io::code::Code;
use ndda_io::diagnostic::{Diagnostic, Severity};
use ndda_io::mesh::terrain_grid::Holes;
use ndda_io::read::LoadedScene;

use crate::build::RockReport;
use crate::numbers::counted;

/// That cells of terrain lack heights, of which the first has its middle at (x, y) [m]; `so` is what follows.
pub(crate) fn told(holes: &Holes, [x, y]: [f64; 2], so: &str) -> String {
    let cells = counted(holes.count, "cell within the terrain has", "cells within the terrain have");
    format!("{cells} no height at some corner, the first at ({x:.1}, {y:.1}) m: {so}")
}

const CURE: &str = "fill in the heights, unless a shaft is meant";

/// Warnings of shafts that missing heights leave in rock, each in a sentence.
pub fn sentences(rocks: &[RockReport]) -> Vec<String> {
    rocks.iter().filter_map(|rock| Some(format!("{}; {CURE}", rock.gaps.as_ref()?))).collect()
}

/// The same warnings, with the rock in the scene that each is about.
pub fn warnings(loaded: &LoadedScene, rocks: &[RockReport]) -> Vec<Diagnostic> {
    let warning = |(index, rock): (usize, &RockReport)| {
        let place = format!("rock[{index}].domain");
        let found = loaded.diagnose_as(Code::Inexact, &place, rock.gaps.clone()?);
        Some(Diagnostic { severity: Severity::Warning, ..found.with_help(CURE) })
    };
    rocks.iter().enumerate().filter_map(warning).collect()
}

#[cfg(test)]
mod tests {
    use crate::Model;

    #[test]
    fn a_shaft_that_a_missing_height_leaves_in_rock_is_warned_of() {
        let folder = tempfile::tempdir().unwrap();
        let head = "ncols 5\nnrows 5\nxllcenter 100\nyllcenter 200\ncellsize 2\nNODATA_value -9999\n";
        let warnings = |middle: &str| {
            let row = "5 5 5 5 5\n".repeat(2);
            std::fs::write(folder.path().join("t.asc"), format!("{head}{row}5 5 {middle} 5 5\n{row}"))
                .unwrap();
            let file = folder.path().join("scene.ron");
            let text = "(title: \"shaft\", time: (step_s: 1e-4, end_s: 1e-3),
                materials: [(name: \"rock\", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
                rock: [(name: \"rock\", material: \"rock\", body: Fixed,
                    domain: TerrainFile(file: \"t.asc\", origin_m: (100, 200), base_m: 0))], contact: Off)";
            std::fs::write(&file, text).unwrap();
            let warnings = Model::open(&file, &[]).unwrap().loaded.warnings;
            warnings.into_iter().map(|warning| warning.message).collect::<Vec<_>>().join("; ")
        };
        assert!(!warnings("5").contains("no height"));
        let said = warnings("-9999");
        assert!(
            said.contains(
                "4 cells within the terrain have no height at some corner, the first at (3.0, 3.0) m"
            ),
            "{said}"
        );
    }
}
