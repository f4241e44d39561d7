//! The step that `ndda check` advises, beside what runs find.

use std::path::Path;

use ndda_cli::{check, step_advice};

/// The range of h that is foreseen and the largest h that some steps report.
fn foreseen_and_found(scene: &str, changes: &[&str], steps: usize) -> ((f64, f64), f64) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(scene);
    let changes: Vec<String> = changes.iter().map(|change| change.to_string()).collect();
    let mut ready =
        check::prepare(&path, &changes).unwrap_or_else(|errors| panic!("{}", errors.render(false)));
    let advice = step_advice::advise(&ready.loaded.scene, &mut ready.simulation).expect("there is contact");
    let mut found = 0.0f64;
    for _ in 0..steps {
        found = found.max(ready.simulation.step().unwrap().h);
    }
    (advice.range(), found)
}

#[test]
fn the_stability_number_of_contact_is_foreseen_within_a_factor_of_two_on_the_gallery() {
    // Steps until all contacts have formed; fewer than the whole run where it is long.
    let cases = [
        ("arch.ron", 400),
        ("bounce.ron", 2000),
        ("collision_equal.ron", 400),
        ("collision_equal_free.ron", 400),
        ("collision_unequal.ron", 400),
        ("collision_unequal_free.ron", 400),
        ("column_phi0.ron", 300),
        ("column_phi5.ron", 300),
        ("column_phi10.ron", 300),
        ("dominoes.ron", 4000),
        ("pile_125.ron", 400),
        ("sliding_30_phi25.ron", 500),
        ("sliding_30_phi25_spring.ron", 500),
        ("sliding_30_phi25_velocity.ron", 500),
        ("sliding_45.ron", 2000),
        ("sliding_45_phi35.ron", 500),
        ("sliding_45_phi35_spring.ron", 3000),
        ("sliding_45_phi35_velocity.ron", 500),
        ("slope_toppling.ron", 1000),
        ("sticking_30_phi35.ron", 500),
        ("sticking_30_phi35_spring.ron", 500),
        ("voronoi_column.ron", 600),
        ("wedge_two_planes.ron", 1000),
    ];
    for (scene, steps) in cases {
        let ((from, to), found) = foreseen_and_found(scene, &[], steps);
        println!("{scene}: h = {from:.3} to {to:.3} foreseen, {found:.3} found");
        assert!(to / found < 2.0 || to > 3.0 * from, "{scene}: {to} foreseen, {found} found");
        assert!((0.5 * from..2.0 * to).contains(&found), "{scene}: {from} to {to} foreseen, {found} found");
    }
}

#[test]
fn a_scene_whose_contact_is_stable_at_any_step_gets_no_advice() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/collision_equal_free.ron");
    for change in ["time.contact_at=End()", "contact=Off"] {
        let mut ready = check::prepare(&path, &[change.to_string()])
            .unwrap_or_else(|errors| panic!("{}", errors.render(false)));
        assert_eq!(step_advice::advise(&ready.loaded.scene, &mut ready.simulation), None, "{change}");
    }
}
