//! Faces that coincide, corners and edges that only just meet. Zero overlap that gives exactly nothing, and the
//! forces of concave blocks, are tested in crates/ndda-contact/src/potential_contact/contact_model.rs; any bits in tests/never_panics.rs there.

use nalgebra::Rotation3;
use ndda::Model;
use ndda_contact::reference::tet_pair;
use ndda_contact::testing::{Random, evaluate, test_box, test_set};
use ndda_contact::{ContactHistory, ContactInput, ContactModel, PotentialContact, VolumePotential};
use ndda_mesh::{BlockId, BlockMesh, Mat3, Vec3};

use super::labelled::scene;
use super::{advance, extreme, farthest};
use crate::evidence::Answer::{AtMost, Near};
use crate::evidence::{rounding, row};

#[test]
fn cubes_face_to_face_stay_where_they_are() {
    for body in ["Rigid", "Elastic"] {
        let bodies: Vec<String> = (0..8).map(|i| format!("blocks[{i}].body={body}")).collect();
        let mut simulation =
            extreme("coincident", &bodies.iter().map(String::as_str).collect::<Vec<_>>()).simulation;
        advance(&mut simulation, 1000);
        // Nothing overlaps: places of a metre are rounded, once for rigid cubes, which rest, and in each step where they deform. A hundred ε of a
        // metre, and less than five in a step.
        let rounds_m = if body == "Rigid" { rounding(100) } else { 1e-12 };
        row(
            "extreme: coincident faces",
            &format!("motion of eight {body} cubes face to face in 1000 steps [m]"),
            farthest(&simulation),
            AtMost(rounds_m),
        );
    }
}

#[test]
fn a_cube_in_the_place_of_another_is_refused_with_both_names() {
    let refused = Model::open(&scene("extreme/coincident.ron"), &["blocks[1].at_m=(0,0,0)".into()]).err();
    let text = refused.map(|errors| errors.render(false)).unwrap_or_default();
    assert!(text.contains("error[overlap]") && text.contains("c000") && text.contains("c100"), "{text}");
}

#[test]
fn blocks_with_common_walls_share_the_volume_between_their_faces() {
    let (depth_m, reference_m3, penalty_pa) = (1e-3, 0.1, 1e7);
    let mut random = Random(3);
    for exponent in [1.5, 2.0, 2.5] {
        for affine in [false, true] {
            let (mut energy, mut force) = (0.0f64, 0.0f64);
            for turned in 0..8 {
                let angles = [0; 3].map(|_| if turned == 0 { 0.0 } else { 6.0 * random.unit() });
                let turn = Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
                let lower = test_box([0.0; 3], [1.0, 1.0, 0.25], [2, 2, 1]);
                let upper = test_box([0.0, 0.0, 0.25 - depth_m], [1.0; 3], [2, 2, 2]);
                let blocks =
                    test_set([lower, upper].map(|mesh| mesh.placed(turn.matrix(), &Vec3::zeros())).to_vec());
                let velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
                let input = ContactInput::new(&blocks, &blocks.rest_position, &velocity, 1.0);
                let input = ContactInput { affine: if affine { &[true; 2] } else { &[] }, ..input };
                let potential = VolumePotential { exponent, reference_m3 };
                let mut model = PotentialContact::new(penalty_pa).with_potential(Box::new(potential));
                let answer = evaluate(&mut model, &input, &mut ContactHistory::default());
                let found_n = answer.force[blocks.nodes_of(BlockId(1))].iter().sum::<Vec3>();
                let found_j = model.energy_j(&input, &ContactHistory::default()).unwrap();
                // On a square metre: W = k_n V₀/m (V/V₀)^m, V = 1 m² d, and its slope by d.
                let ratio = depth_m / reference_m3;
                let exact_n = penalty_pa * ratio.powf(exponent - 1.0) * (turn * Vec3::z());
                let exact_j = penalty_pa * reference_m3 / exponent * ratio.powf(exponent);
                energy = energy.max((found_j / exact_j - 1.0).abs());
                force = force.max((found_n - exact_n).norm() / exact_n.norm());
            }
            let named = |what: &str| format!("{what}, Volume(exponent: {exponent}), affine: {affine}");
            // Depth is a thousandth of places of a metre, whose last digits it carries.
            row("common walls", &named("energy"), energy, AtMost(rounding(10) / depth_m));
            row("common walls", &named("force"), force, AtMost(rounding(10) / depth_m));
        }
    }
}

/// Force on the second block.
fn force(lower: BlockMesh, upper: BlockMesh) -> Vec3 {
    let blocks = test_set(vec![lower, upper]);
    let velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
    let input = ContactInput::new(&blocks, &blocks.rest_position, &velocity, 1.0);
    let answer = evaluate(&mut PotentialContact::new(1e9), &input, &mut ContactHistory::default());
    answer.force[blocks.nodes_of(BlockId(1))].iter().sum()
}

/// The turns that bring a cube onto itself.
fn turns_of_a_cube() -> Vec<Mat3> {
    let signs = [-1.0, 1.0];
    let mut turns = Vec::new();
    for [i, j] in [[0, 1], [0, 2], [1, 0], [1, 2], [2, 0], [2, 1]] {
        for (a, b) in signs.iter().flat_map(|a| signs.map(|b| (*a, b))) {
            let (x, y) = (a * Vec3::ith(i, 1.0), b * Vec3::ith(j, 1.0));
            turns.push(Mat3::from_columns(&[x, y, x.cross(&y)]));
        }
    }
    turns
}

#[test]
fn a_pair_of_cubes_feels_the_same_force_however_it_is_turned() {
    let [lower, upper] =
        [test_box([0.0; 3], [1.0; 3], [2, 2, 2]), test_box([0.31, 0.17, 0.97], [1.0; 3], [2, 2, 2])];
    let still = force(lower.clone(), upper.clone());
    let mut spread = 0.0f64;
    for turn in turns_of_a_cube() {
        let turned =
            force(lower.clone().placed(&turn, &Vec3::zeros()), upper.clone().placed(&turn, &Vec3::zeros()));
        spread = spread.max((turned - turn * still).norm() / still.norm());
    }
    row(
        "extreme: coincident faces",
        "spread of the force over the 24 turns of a cube, relative",
        spread,
        // Turns by right angles exchange axes and signs: rounding of the sum over all pairs of tetrahedra, 48 in each cube.
        AtMost(rounding(48 * 48)),
    );
}

/// A unit cube with a corner at the origin, turned so that the directions `from` of it point along z.
fn standing(from: Vec3, cells: u32) -> BlockMesh {
    let turn = Rotation3::rotation_between(&from, &Vec3::z()).expect("not opposite").into_inner();
    test_box([0.0; 3], [1.0; 3], [cells; 3]).placed(&turn, &Vec3::zeros())
}

#[test]
fn corners_and_edges_meet_without_a_jump() {
    let down = Rotation3::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI).into_inner();
    let cases = [
        // The volume of the overlap goes with the third power of the depth, and its energy with the fourth.
        ("corner on corner", Vec3::new(1.0, 1.0, 1.0), Vec3::zeros()),
        ("edge across edge", Vec3::new(0.0, 1.0, 1.0), Vec3::new(-0.5, 0.0, 0.0)),
    ];
    for (name, from, shift) in cases {
        let across = Rotation3::from_axis_angle(&Vec3::z_axis(), std::f64::consts::FRAC_PI_2).into_inner();
        let upper = standing(from, 2).placed(&Mat3::identity(), &shift);
        let lower =
            standing(from, 2).placed(&Mat3::identity(), &shift).placed(&(across * down), &Vec3::zeros());
        let at = |gap: f64| {
            force(lower.clone(), upper.clone().placed(&Mat3::identity(), &Vec3::new(0.0, 0.0, gap))).norm()
        };
        for gap in [1e-15, 1e-12, 1e-9, 1e-6, 1e-3] {
            assert_eq!(at(gap), 0.0, "{name}: apart by {gap:e}");
        }
        let depths = [1e-3, 1e-6, 1e-9, 1e-12, 1e-15];
        let forces = depths.map(|depth| at(-depth));
        assert!(
            forces.iter().all(|f| f.is_finite()) && forces.is_sorted_by(|a, b| a >= b),
            "{name}: {forces:?}"
        );
        let order = (at(-1e-3) / at(-5e-4)).log2();
        row(
            "extreme: corners and edges",
            &format!("{name}: power of the depth that the force goes with"),
            order,
            // The power is exact: places of a metre are rounded to ε, that over the depth thrice in the force, by log₂, twentyfold.
            Near(3.0, 20.0 * 3.0 * f64::EPSILON / 5e-4 / std::f64::consts::LN_2),
        );
    }
}

#[test]
fn corners_that_collide_keep_momentum_and_energy() {
    for gap in ["1e-3", "1e-15", "-1e-15", "-1e-3"] {
        let mut simulation =
            extreme("corner_on_corner", &[&format!("blocks.upper.at_m=(0,0,{gap})")]).simulation;
        simulation.sample().unwrap();
        for _ in 0..50 {
            advance(&mut simulation, 10);
            simulation.sample().unwrap();
        }
        let worst = simulation.invariants();
        assert!(worst.contact_pairs_max > 0, "they do not meet");
        row(
            "extreme: corners and edges",
            &format!("momentum lost by corners that meet, gap {gap} m"),
            worst.linear_momentum,
            AtMost(rounding(500)),
        );
        row(
            "extreme: corners and edges",
            &format!("energy gained by corners that meet, gap {gap} m"),
            worst.energy_gain,
            // The promise of the header of scenes/extreme/corner_on_corner.ron.
            AtMost(1e-2),
        );
    }
}

#[test]
fn no_glancing_pair_is_not_a_number() {
    // Corner against face, edge against edge, moved by a hair's breadth; `NDDA_CASES` sets more.
    let cases: usize = std::env::var("NDDA_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(50_000);
    let mut random = Random(20_261_121);
    let mut wrong = 0u32;
    for case in 0..cases {
        let mut point = || Vec3::from_fn(|_, _| 2.0 * random.unit() - 1.0);
        let (c, t): ([Vec3; 4], [Vec3; 4]) =
            (std::array::from_fn(|_| point()), std::array::from_fn(|_| point()));
        let gap = [0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3][case % 6] * if case % 2 == 0 { 1.0 } else { -1.0 };
        let (mine, theirs) =
            if case % 3 == 0 { ((c[0] + c[1]) / 2.0, (t[0] + t[1]) / 2.0) } else { (c[0], t[case % 4]) };
        let t = t.map(|x| x + mine - theirs + Vec3::new(0.0, 0.0, gap));
        if let Ok(forces) = tet_pair::pair_forces(&c, &t, 1e9) {
            wrong += u32::from(!forces.nodal_n.iter().flatten().all(|f| f.is_finite()));
        }
    }
    row(
        "extreme: corners and edges",
        &format!("pairs of {cases} that glance and are not a number"),
        f64::from(wrong),
        // The statement: none.
        AtMost(0.0),
    );
}
