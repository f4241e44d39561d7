//! The step that `ndda check` advises, beside what runs find.

use std::path::Path;

use ndda_cli::{check, step_advice};

/// h that is foreseen and h that the run reports.
fn foreseen_and_found(scene: &str, steps: usize) -> (f64, f64) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(scene);
    let mut ready = check::prepare(&path, &[]).unwrap_or_else(|errors| panic!("{}", errors.render(false)));
    let advice = step_advice::advise(&ready.loaded.scene, &ready.simulation).expect("there is contact");
    let mut found = 0.0f64;
    for _ in 0..steps {
        found = found.max(ready.simulation.step().unwrap().h);
    }
    (advice.h, found)
}

#[test]
fn the_stiffness_of_contact_is_foreseen_within_a_factor_of_one_and_a_half() {
    let cases = [
        ("collision_equal_free.ron", 400),
        ("sliding_45.ron", 2000),
        ("sliding_45_phi35_spring.ron", 3000),
        ("sliding_45_phi35_velocity.ron", 500),
    ];
    for (scene, steps) in cases {
        let (foreseen, found) = foreseen_and_found(scene, steps);
        println!("{scene}: h = {foreseen:.3} foreseen, {found:.3} found");
        assert!((0.67..1.5).contains(&(foreseen / found)), "{scene}: {foreseen} foreseen, {found} found");
    }
}

#[test]
fn a_scene_whose_contact_is_stable_at_any_step_gets_no_advice() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/collision_equal_free.ron");
    for change in ["time.contact_at=End()", "contact=Off"] {
        let ready = check::prepare(&path, &[change.to_string()])
            .unwrap_or_else(|errors| panic!("{}", errors.render(false)));
        assert_eq!(step_advice::advise(&ready.loaded.scene, &ready.simulation), None, "{change}");
    }
}
