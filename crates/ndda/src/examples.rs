//! The scenes of `scenes/`, in the program.

use std::fmt::Write;

use ndda_io::locate::Node;
use ndda_io::read::suggest;

/// Names and texts.
pub const EXAMPLES: [(&str, &str); 27] = [
    ("arch", include_str!("../../../scenes/arch.ron")),
    ("bounce", include_str!("../../../scenes/bounce.ron")),
    ("collision_equal", include_str!("../../../scenes/collision_equal.ron")),
    ("collision_equal_free", include_str!("../../../scenes/collision_equal_free.ron")),
    ("collision_unequal", include_str!("../../../scenes/collision_unequal.ron")),
    ("collision_unequal_free", include_str!("../../../scenes/collision_unequal_free.ron")),
    ("column_phi0", include_str!("../../../scenes/column_phi0.ron")),
    ("column_phi10", include_str!("../../../scenes/column_phi10.ron")),
    ("column_phi5", include_str!("../../../scenes/column_phi5.ron")),
    ("dominoes", include_str!("../../../scenes/dominoes.ron")),
    ("free_fall", include_str!("../../../scenes/free_fall.ron")),
    ("pile_1000", include_str!("../../../scenes/pile_1000.ron")),
    ("pile_125", include_str!("../../../scenes/pile_125.ron")),
    ("sliding_30_phi25", include_str!("../../../scenes/sliding_30_phi25.ron")),
    ("sliding_30_phi25_spring", include_str!("../../../scenes/sliding_30_phi25_spring.ron")),
    ("sliding_30_phi25_velocity", include_str!("../../../scenes/sliding_30_phi25_velocity.ron")),
    ("sliding_45", include_str!("../../../scenes/sliding_45.ron")),
    ("sliding_45_phi35", include_str!("../../../scenes/sliding_45_phi35.ron")),
    ("sliding_45_phi35_spring", include_str!("../../../scenes/sliding_45_phi35_spring.ron")),
    ("sliding_45_phi35_velocity", include_str!("../../../scenes/sliding_45_phi35_velocity.ron")),
    ("slope_toppling", include_str!("../../../scenes/slope_toppling.ron")),
    ("spinning_block", include_str!("../../../scenes/spinning_block.ron")),
    ("sticking_30_phi35", include_str!("../../../scenes/sticking_30_phi35.ron")),
    ("sticking_30_phi35_spring", include_str!("../../../scenes/sticking_30_phi35_spring.ron")),
    ("tunnel_roof_wedge", include_str!("../../../scenes/tunnel_roof_wedge.ron")),
    ("voronoi_column", include_str!("../../../scenes/voronoi_column.ron")),
    ("wedge_two_planes", include_str!("../../../scenes/wedge_two_planes.ron")),
];

/// The text of an example.
pub fn find(name: &str) -> Option<&'static str> {
    EXAMPLES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// All examples with their titles.
pub fn list() -> String {
    let widest = EXAMPLES.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    EXAMPLES.iter().fold(String::new(), |mut out, (name, text)| {
        let title = Node::of(text).find(text, "title").map_or("", |node| &text[node.span.clone()]);
        writeln!(out, "{name:widest$}  {}", title.trim_matches('"')).expect("a string takes all");
        out
    })
}

/// The text of an example.
///
/// # Errors
/// There is none of that name; the message says which there are.
pub fn text(name: &str) -> Result<&'static str, String> {
    let names: Vec<&str> = EXAMPLES.iter().map(|(name, _)| *name).collect();
    find(name).ok_or_else(|| format!("there is no example `{name}`: {}", suggest(name, &names)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndda_io::read::load_text;
    use ndda_io::scene::{Hold, Scene, Shape};

    fn reads_files(scene: &Scene) -> bool {
        scene.blocks.iter().any(|block| matches!(block.shape, Shape::Mesh { .. }))
            || scene.supports.iter().any(|support| matches!(support.hold, Hold::Acceleration { .. }))
    }

    #[test]
    fn every_scene_is_an_example_and_needs_no_other_file() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes");
        let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        let mut names: Vec<String> = files
            .filter(|file| file.extension().is_some_and(|extension| extension == "ron"))
            .map(|file| file.file_stem().unwrap().to_string_lossy().into_owned())
            .collect();
        names.sort();
        assert_eq!(names, EXAMPLES.map(|(name, _)| name));
        for (name, text) in EXAMPLES {
            let loaded = load_text(name, text, &[], None).unwrap_or_else(|errors| panic!("{errors}"));
            assert!(!reads_files(&loaded.scene), "{name}");
        }
    }

    #[test]
    fn the_list_has_names_and_titles() {
        assert!(list().contains("free_fall "));
        assert!(list().contains("  Free fall of a block\n"));
        assert!(find("free_fall").is_some() && find("free_fal").is_none());
    }
}
