//! Blocks that overlap at the start are refused with the list of pairs; with `settle` they come to rest first.

use ndda::summary::LabelWord;
use ndda::{Model, Run};
use ndda_io::code::Code;
use ndda_solver::Settle;

use super::labelled::scene;
use crate::evidence::{Answer, row};

const DEPTHS: [&str; 7] = ["0.01", "0.05", "0.1", "0.25", "0.5", "0.75", "0.9"];

/// The scene with the cube sunk by a depth.
fn sunk(depth: &str) -> String {
    format!("blocks.cube.at_m[2]=-{depth}")
}

#[test]
fn blocks_that_overlap_at_the_start_are_refused_with_their_names_and_depth() {
    let path = scene("extreme/overlap.ron");
    assert!(Model::open(&path, &[]).is_ok(), "blocks that only touch are no overlap");
    let mut refused = 0;
    for depth in DEPTHS {
        let Err(errors) = Model::open(&path, &[sunk(depth)]) else { continue };
        let text = errors.render(false);
        let named =
            ["error[overlap]", "`slab` and `cube`", "settle: ()"].iter().all(|word| text.contains(word));
        refused += u32::from(named);
    }
    row(
        "extreme: initial overlap",
        "overlaps of 1 to 90 %, of 7, refused with the pair",
        f64::from(refused),
        // The statement: all are.
        Answer::Near(7.0, 0.0),
    );
}

#[test]
fn blocks_that_overlap_come_to_rest_on_request() {
    let path = scene("extreme/overlap.ron");
    for depth in ["0.01", "0.9"] {
        let mut ready =
            Model::open(&path, &[sunk(depth), "settle=()".into(), "time.step_s=5e-4".into()]).unwrap();
        ready.simulation.settle(&Settle::new(1e-4, 1_000_000)).unwrap();
        let cube = ready.simulation.blocks().find("cube").unwrap();
        let nodes = ready.simulation.blocks().nodes_of(cube);
        let positions = &ready.simulation.state().position[nodes];
        let lowest = positions.iter().map(|x| x.z).fold(f64::INFINITY, f64::min);
        // ρ g L / 2 k_n times the reference length.
        let statics = 2650.0 * 9.8 / (2.0 * 2e8);
        let rests = -(lowest + ready.simulation.blocks().origin_m.z);
        let what = format!("depth at which a cube rests that began {depth} m deep [m]");
        row("extreme: initial overlap", &what, rests, Answer::Within(statics, 0.01));
    }
}

#[test]
fn a_block_wholly_inside_the_solid_of_another_is_refused_but_not_one_in_its_hollow() {
    let refusal = |name: &str, changes: &[&str]| {
        let changes: Vec<String> = changes.iter().map(|&change| change.into()).collect();
        Model::open(&scene(name), &changes).err().map(|errors| errors.render(false))
    };
    let small =
        |at: &str| [format!("blocks.cube.at_m={at}"), "blocks.cube.shape.size_m=(0.4, 0.4, 0.4)".into()];
    let inside = |name: &str, at: &str| refusal(name, &small(at).each_ref().map(String::as_str));
    let says = |text: Option<String>, host: &str| {
        text.is_some_and(|text| {
            text.contains("error[overlap]")
                && text.contains(&format!("`cube` lies wholly inside block `{host}`"))
        })
    };
    assert!(says(inside("extreme/overlap.ron", "(0.1, 0.2, -0.7)"), "slab"));
    // The hollow of the L is inside the box around it.
    assert_eq!(inside("extreme/concave.ron", "(1.5, 0.5, 1.2)"), None);
    assert!(says(inside("extreme/concave.ron", "(0.3, 0.5, 0.3)"), "ell"), "settling does not let it out");
}

/// A free cube of 1 m on a fixed one, in one place or sunk into it.
fn cubes(at: &str) -> Result<Model, String> {
    let text = format!(
        "(title: \"two cubes\", time: (step_s: 1e-4, end_s: 0.1), gravity_m_s2: (0, 0, -9.81),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
          blocks: [
            (name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))),
            (name: \"cube\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: {at}),
          ],
          contact: Potential(penalty_pa: 2e8, potential: Smooth(), friction: (friction_deg: 30)))"
    );
    Model::from_text(&text).map_err(|errors| errors.render(false))
}

#[test]
fn blocks_in_the_same_place_are_refused() {
    for at in ["(0, 0, 0)", "(1e-9, 0, 0)", "(0.001, 0, 0)", "(0, 0.3, 0.2)"] {
        let text = cubes(at).err().unwrap_or_default();
        assert!(text.contains("error[overlap]"), "{at}: {text}");
    }
}

#[test]
fn a_block_that_contact_throws_from_where_it_is_drawn_is_not_called_accurate() {
    let label = |at: &str| {
        let model = cubes(at).unwrap();
        let is_warned = model.loaded.warnings.iter().any(|warning| warning.code == Code::Overlap);
        let summary = Run::new(model).finish(&mut []).unwrap().summary;
        (is_warned, summary.label.word)
    };
    for at in ["(0, 0, 0.995)", "(0, 0, 0.999)"] {
        assert_eq!(label(at), (true, LabelWord::Inaccurate), "{at}");
    }
    // Touching, and as deep as contact carries it: ρ g L₀ h/2 k_n with L₀ = 1 m.
    let depth_m = 2650.0 * 9.81 / (2.0 * 2e8);
    for at in ["(0, 0, 1)".to_string(), format!("(0, 0, {})", 1.0 - depth_m)] {
        assert!(!label(&at).0, "{at}");
    }
}
