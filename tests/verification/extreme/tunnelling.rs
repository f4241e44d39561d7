//! Steps that take a cube 0.1 to 100 times the height of a plate's tetrahedra. What passes through is flagged, and with
//! steps that are controlled nothing does.

use ndda::study::case::cases;
use ndda_io::study::LoadedStudy;

use super::labelled::{agrees, is_true, scene, summary_of, word};
use crate::evidence::{Answer, row};

#[test]
fn whatever_jumps_through_a_plate_is_flagged_or_prevented() {
    let study = LoadedStudy::load(&scene("extreme/thin_plate_steps.ron")).unwrap();
    let (mut through, mut differ, mut prevented) = (0, 0, 0);
    for case in cases(&study).unwrap() {
        let summary = summary_of("extreme/thin_plate.ron", &case.overrides);
        let summary = summary.expect("a scene that is sound");
        println!("{}: {}, {}", case.name, word(&summary), summary["reference"]["error_end"]);
        let controlled = case.labels[0].1 == "auto";
        let wrong = word(&summary) != "stopped" && !is_true(&summary);
        assert!(!(controlled && wrong), "{}: {}", case.name, summary["reference"]);
        differ += u32::from(!agrees(&summary));
        through += u32::from(!controlled && wrong);
        prevented += u32::from(controlled && is_true(&summary));
    }
    assert!(through > 2, "only {through} of the fixed steps are too long: the scene is too easy");
    let what = "of 7 collisions with a thin plate, those right with controlled steps";
    row("extreme: long steps", what, f64::from(prevented), Answer::AtLeast(5.0));
    row(
        "extreme: long steps",
        "collisions with a thin plate whose label and closed form differ",
        f64::from(differ),
        // The statement: none. A stop is no disagreement here; the row above says how many of the controlled ones go on to the end.
        Answer::AtMost(0.0),
    );
}
