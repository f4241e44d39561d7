//! Strains of a linear material: found as they are, and told where they are too large for it.

use ndda::judge::verdict;
use ndda::summary::LabelWord;

use crate::evidence::Answer::Within;
use crate::evidence::row;
use crate::simulation;

#[test]
fn a_strain_beyond_a_tenth_is_not_called_accurate() {
    for (strain, accurate) in [(0.05, true), (0.15, false)] {
        for body in ["Elastic", "Affine"] {
            // ω² = (π/2)² E/ρL² = 987/s²: the load grows over five periods, damped by a = ω, and the strain goes 1 % beyond.
            let mut simulation = simulation(&format!(
                "(title: \"pulled\", time: (step_s: 1e-3, end_s: 2),
                  materials: [(name: \"soft\", young_pa: 1e6, poisson: 0, density_kg_m3: 2500, damping: (mass_per_s: 30))],
                  blocks: [(name: \"bar\", material: \"soft\", body: {body}, shape: Box(size_m: (1, 0.5, 0.5), cells: (2, 1, 1)))],
                  supports: [(block: \"bar\", on: Plane(point_m: (0, 0, 0), normal: (1, 0, 0)), hold: Normal),
                             (block: \"bar\", on: Plane(point_m: (0, 0, 0), normal: (0, 1, 0)), hold: Normal),
                             (block: \"bar\", on: Plane(point_m: (0, 0, 0), normal: (0, 0, 1)), hold: Normal)],
                  tractions: [(block: \"bar\", on: Set(\"x_max\"), traction_pa: ({}, 0, 0),
                               factor: [(time_s: 0, factor: 0), (time_s: 1, factor: 1)])])",
                strain * 1e6
            ));
            simulation.sample().unwrap();
            for _ in 0..20 {
                for _ in 0..100 {
                    simulation.step().unwrap();
                }
                simulation.sample().unwrap();
            }
            let found = simulation.invariants().largest_strain.value;
            row(
                "strain",
                &format!("largest strain of a bar pulled by {strain} E, {body}"),
                found,
                Within(strain, 2e-2),
            );
            let label = verdict::label(&simulation, None);
            assert_eq!(label.word == LabelWord::Accurate, accurate, "{strain}: {:?}", label.reasons);
        }
    }
}
