//! Penalties from 1e-6 to 100 E and steps from 1e-7 to 0.1 s, for every integrator: the label agrees with the closed form.
//!
//! Here three of the corners and both sides of the borders between accurate, inaccurate and stopped; `NDDA_LARGE=1` runs all 252
//! cells, which `docs/evidence/stability/map.py` draws.

use ndda::study::case::{Case, cases};
use ndda_io::study::LoadedStudy;

use super::labelled::{agrees, scene, summary_of, word};
use crate::evidence::{Answer, row};

/// Penalty over E and step [s] of the cells that always run.
const CELLS: [(&str, &str); 12] = [
    ("1e-6", "1e-4"),
    ("1e-6", "1e-1"),
    ("1e-5", "1e-4"),
    ("1e-5", "1e-3"),
    ("1e-4", "1e-4"),
    ("1e-3", "1e-5"),
    ("1e-3", "1e-4"),
    ("1e-1", "1e-5"),
    ("1e0", "1e-3"),
    ("1e2", "1e-7"),
    ("1e2", "1e-5"),
    ("1e2", "1e-1"),
];

/// Choice of a case along an axis.
fn choice<'a>(case: &'a Case, axis: &str) -> &'a str {
    &case.labels.iter().find(|(name, _)| name == axis).unwrap().1
}

/// Whether a step is at most a tenth of the collision, which takes 29 ms at 1e-6 E and as the root of the stiffness less.
fn is_resolved(case: &Case) -> bool {
    let [penalty, step_s]: [f64; 2] = ["penalty", "step"].map(|axis| choice(case, axis).parse().unwrap());
    step_s <= 0.1 * 0.029 * (1e-6 / penalty).sqrt()
}

#[test]
fn a_run_knows_whether_it_is_accurate_whatever_the_penalty_and_the_step() {
    let study = LoadedStudy::load(&scene("extreme/stability.ron")).unwrap();
    let all = std::env::var_os("NDDA_LARGE").is_some();
    let wanted = |case: &&Case| all || CELLS.contains(&(choice(case, "penalty"), choice(case, "step")));
    let cells = cases(&study).unwrap();
    let (mut count, mut differ, mut words) = (0, 0, [0; 3]);
    for case in cells.iter().filter(wanted) {
        let summary = summary_of("extreme/collision.ron", &case.overrides);
        let summary = summary.unwrap_or_else(|error| panic!("{}: {error}", case.name));
        count += 1;
        words[["accurate", "inaccurate", "stopped"].iter().position(|w| *w == word(&summary)).unwrap()] += 1;
        // A run of short steps has no cause to stop.
        if !agrees(&summary) || (word(&summary) == "stopped" && is_resolved(case)) {
            differ += 1;
            println!("{}: {} but {}", case.name, summary["label"], summary["reference"]);
        }
    }
    assert!(words.iter().all(|n| *n > 0), "every label should be met: {words:?}");
    let what = format!("cells of the stability map, of {count}, whose label and closed form differ");
    // The statement: none.
    row("extreme: penalty, step and label", &what, f64::from(differ), Answer::AtMost(0.0));
}
