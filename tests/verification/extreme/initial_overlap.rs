//! Blocks that overlap at the start are refused with the list of pairs; with `settle` they come to rest first.

use ndda::Model;
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
