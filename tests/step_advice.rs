//! The step that `ndda check` advises, beside what runs find.

use std::path::Path;

use ndda::Model;
use ndda::forecast::step;

/// A slope of 40 blocks that joints cut out of the rock, filled with slivers.
const SLOPE: &str = r#"(
    title: "cut slope", time: (step_s: 5e-6, end_s: 1), gravity_m_s2: (0, 0, -9.8),
    materials: [(name: "rock", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
    rock: [(
        name: "b", material: "rock", BODY fill: Fewest,
        domain: Column(outline_m: [(0, 0), (24, 0), (24, 3), (14, 20), (0, 20)], axis: Y, start_m: -4, end_m: 4),
        joints: [
            Set(name: "a", dip_deg: 45, dip_direction_deg: 90, spacing_m: 4.3),
            Set(name: "b", dip_deg: 80, dip_direction_deg: 270, spacing_m: 6),
            Set(name: "c", dip_deg: 90, dip_direction_deg: 0, spacing_m: 4),
        ],
        fixed: [Inside(min_m: (-1, -5, -1), max_m: (6, 5, 30)), Inside(min_m: (-1, -5, -1), max_m: (30, 5, 3))],
    )],
    contact: Potential(penalty_pa: 2e10, POTENTIAL friction: (friction_deg: 35)),
)"#;

#[test]
fn the_stability_number_of_a_cut_slope_is_foreseen_whatever_fills_its_blocks() {
    // Rigid blocks with `Smooth` are taken whole: their slivers do not count.
    for body in ["body: Rigid,", "body: Affine,", ""] {
        for (potential, step_s) in [("potential: Smooth(),", 5e-6), ("", 1e-6)] {
            let text = SLOPE.replace("BODY", body).replace("POTENTIAL", potential);
            let change = format!("time.step_s={step_s:e}");
            let loaded = ndda_io::read::load_text("slope.ron", &text, &[change], None).unwrap();
            let mut ready =
                Model::new(loaded, Path::new(".")).unwrap_or_else(|e| panic!("{}", e.render(false)));
            let advice = step::advise(&ready.loaded.scene, &mut ready.simulation).expect("there is contact");
            let mut found = 0.0f64;
            for _ in 0..1000 {
                found = found.max(ready.simulation.step().unwrap().h);
            }
            let (from, to) = advice.range();
            println!("slope {body} {potential}: h = {from:.3} to {to:.3} foreseen, {found:.3} found");
            assert!(
                to < 3.0 * from && (0.5 * from..2.0 * to).contains(&found) && to < 3.0 * found,
                "{body} {potential}"
            );
        }
    }
}

/// The range of h that is foreseen and the largest h that some steps report.
fn foreseen_and_found(scene: &str, changes: &[&str], steps: usize) -> ((f64, f64), f64) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(scene);
    let changes: Vec<String> = changes.iter().map(|change| change.to_string()).collect();
    let mut ready = Model::open(&path, &changes).unwrap_or_else(|errors| panic!("{}", errors.render(false)));
    let advice = step::advise(&ready.loaded.scene, &mut ready.simulation).expect("there is contact");
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
        ("bounce.ron", 12000),
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
    let mut wrong = Vec::new();
    for (scene, steps) in cases {
        let ((from, to), found) = foreseen_and_found(scene, &[], steps);
        println!("{scene}: h = {from:.3} to {to:.3} foreseen, {found:.3} found");
        let is_one_number = to <= 3.0 * from;
        if !(0.5 * from..2.0 * to).contains(&found) || (is_one_number && to > 2.0 * found) {
            wrong.push(scene);
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

#[test]
fn a_scene_whose_contact_is_stable_at_any_step_gets_no_advice() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/collision_equal_free.ron");
    for change in ["time.contact_at=End()", "contact=Off"] {
        let mut ready = Model::open(&path, &[change.to_string()])
            .unwrap_or_else(|errors| panic!("{}", errors.render(false)));
        assert_eq!(step::advise(&ready.loaded.scene, &mut ready.simulation), None, "{change}");
    }
}
