//! Rock in bonded tetrahedra under uniaxial stress, against a direct solution of the same pieces and bonds, and the modulus that `ndda check` states.

use std::path::Path;

use nalgebra::{DMatrix, DVector};
use ndda::build::{self, Bonds};
use ndda_io::read::load_text;
use ndda_mesh::geometry::{TET_FACES, tet_volume, triangle_area_vector};
use ndda_mesh::tetrahedralise::TETRAHEDRA;
use ndda_mesh::{BlockSet, Vec3};
use ndda_solver::{Settle, Simulation};

use crate::evidence::Answer::Within;
use crate::evidence::row;
use crate::simulation;

const YOUNG_PA: f64 = 20e9;
const POISSON: f64 = 0.25;
const SIZE_M: f64 = 0.5;
/// Pull on the upper face of the cube; negative while it is pressed.
const PULL_PA: f64 = 1e6;

/// A cube of 1 m that is pulled at two opposite faces, in tetrahedra with bonds of some stiffness.
fn scene(stiffness_pa_m: f64, pull_pa: f64, more: &str) -> String {
    let step_s = 0.2 * (2600.0 * SIZE_M / 12.0 / (YOUNG_PA / SIZE_M + stiffness_pa_m)).sqrt();
    format!(
        "(title: \"cube\", time: (step_s: {step_s:e}, end_s: 1),
          materials: [(name: \"rock\", young_pa: {YOUNG_PA:e}, poisson: {POISSON}, density_kg_m3: 2600)],
          rock: [(material: \"rock\", domain: Box(min_m: (0, 0, 0), max_m: (1, 1, 1)), into: Tetrahedra(size_m: {SIZE_M}, {more}))],
          tractions: [
              (block: \"rock_*\", on: Plane(point_m: (0, 0, 1), normal: (0, 0, 1)), traction_pa: (0, 0, {pull_pa:e})),
              (block: \"rock_*\", on: Plane(point_m: (0, 0, 0), normal: (0, 0, 1)), traction_pa: (0, 0, {:e})),
          ],
          contact: Potential(penalty_pa: {:e}, potential: Smooth(), rock_joints: [
              (joint: \"tetrahedra\", friction: (friction_deg: 35, shear_penalty_pa_m: {stiffness_pa_m:e}, cohesion_pa: 1e9, tension_pa: 1e9,
                                               fracture: (tension_j_m2: 1e9, shear_j_m2: 1e9)))]))",
        -pull_pa,
        0.5 * stiffness_pa_m,
    )
}

/// Elongation along an axis, from the mean displacement of the face at 0 to that of the face at 1 m.
fn strain(blocks: &BlockSet, moved: impl Fn(usize) -> Vec3, axis: usize) -> f64 {
    let mean = |place_m: f64| {
        let on_face = |t: &&[ndda_mesh::NodeId; 3]| {
            t.iter()
                .all(|n| ((blocks.rest_position[n.index()] + blocks.origin_m)[axis] - place_m).abs() < 1e-9)
        };
        let (mut area_m2, mut sum) = (0.0, 0.0);
        for triangle in blocks.triangles.iter().filter(on_face) {
            let area = triangle_area_vector(&triangle.map(|n| blocks.rest_position[n.index()])).norm();
            area_m2 += area;
            sum += area * triangle.iter().map(|n| moved(n.index())[axis]).sum::<f64>() / 3.0;
        }
        assert!((area_m2 - 1.0).abs() < 1e-9, "{area_m2}");
        sum
    };
    mean(1.0) - mean(0.0)
}

/// Young's modulus and Poisson's ratio of the cube at rest.
fn found(cube: &mut Simulation, pull_pa: f64) -> [f64; 2] {
    cube.settle(&Settle::new(1e-5, 200_000)).unwrap();
    let (now, blocks) = (&cube.state().position, cube.blocks());
    let strain = |axis| strain(blocks, |n| now[n] - blocks.rest_position[n], axis);
    [pull_pa / strain(2), -0.5 * (strain(0) + strain(1)) / strain(2)]
}

/// The same by one linear system of all nodes: tetrahedra of constant strain, and a spring over the whole of each face between two; on `rollers` at
/// three faces, which makes the cube an eighth of a larger one.
fn solved(
    blocks: &BlockSet,
    (young_pa, poisson): (f64, f64),
    stiffness_pa_m: f64,
    rollers: bool,
) -> [f64; 2] {
    let at: Vec<Vec3> = blocks.rest_position.iter().map(|x| x + blocks.origin_m).collect();
    let mut k = DMatrix::<f64>::zeros(3 * at.len(), 3 * at.len());
    let mut f = DVector::<f64>::zeros(3 * at.len());
    let (lambda, mu) =
        (young_pa * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), young_pa / (2.0 * (1.0 + poisson)));
    for tet in &blocks.tets {
        let corners = tet.map(|n| at[n.index()]);
        let volume = tet_volume(&corners);
        // Gradient of each corner's shape function: its face's area vector inwards over 3 V.
        let gradient =
            TET_FACES.map(|face| -triangle_area_vector(&face.map(|i| corners[i])) / (3.0 * volume));
        for (a, ga) in tet.iter().zip(&gradient) {
            for (b, gb) in tet.iter().zip(&gradient) {
                for i in 0..3 {
                    for j in 0..3 {
                        let same = if i == j { ga.dot(gb) } else { 0.0 };
                        k[(3 * a.index() + i, 3 * b.index() + j)] +=
                            volume * (lambda * ga[i] * gb[j] + mu * (ga[j] * gb[i] + same));
                    }
                }
            }
        }
    }
    for [one, other] in faces_between(blocks, &at) {
        let area = triangle_area_vector(&one.map(|n| at[n])).norm();
        let ends: Vec<(usize, usize, f64)> =
            (0..3).flat_map(|c| [(c, one[c], 1.0), (c, other[c], -1.0)]).collect();
        for &(c, a, s) in &ends {
            for &(d, b, t) in &ends {
                // ∫ N_c N_d over a triangle.
                let share = area / if c == d { 6.0 } else { 12.0 };
                (0..3).for_each(|i| k[(3 * a + i, 3 * b + i)] += s * t * share * stiffness_pa_m);
            }
        }
    }
    for triangle in &blocks.triangles {
        let nodes = triangle.map(|n| n.index());
        let area = triangle_area_vector(&nodes.map(|n| at[n])).norm();
        for (place_m, sign) in [(0.0, -1.0), (1.0, 1.0)] {
            if nodes.iter().all(|&n| (at[n].z - place_m).abs() < 1e-9) {
                nodes.iter().for_each(|n| f[3 * n + 2] += sign * area / 3.0 * PULL_PA);
            }
        }
    }
    // Nothing but rigid motions feels springs as soft as these.
    let soft = 1e-9 * k.diagonal().max();
    (0..k.nrows()).for_each(|i| k[(i, i)] += soft);
    for (n, x) in at.iter().enumerate().filter(|_| rollers) {
        (0..3).filter(|&i| x[i].abs() < 1e-9).for_each(|i| k[(3 * n + i, 3 * n + i)] *= 1e9);
    }
    let u = k.cholesky().expect("bonds hold all pieces").solve(&f);
    let strain = |axis| strain(blocks, |n| Vec3::new(u[3 * n], u[3 * n + 1], u[3 * n + 2]), axis);
    [PULL_PA / strain(2), -0.5 * (strain(0) + strain(1)) / strain(2)]
}

/// Faces between two tetrahedra: the nodes of both sides, those at the same place in the same order.
fn faces_between(blocks: &BlockSet, at: &[Vec3]) -> Vec<[[usize; 3]; 2]> {
    let between = blocks.surface_names.iter().position(|name| name == TETRAHEDRA).unwrap() as u32;
    let inner: Vec<[usize; 3]> = (blocks.triangles.iter().zip(&blocks.triangle_surface))
        .filter(|(_, surface)| **surface == Some(between))
        .map(|(triangle, _)| triangle.map(|n| n.index()))
        .collect();
    let twin = |one: &[usize; 3], other: &[usize; 3]| {
        let place = |n: usize| other.iter().copied().find(|&m| (at[n] - at[m]).norm() < 1e-9);
        Some([place(one[0])?, place(one[1])?, place(one[2])?])
    };
    let mut faces = Vec::new();
    for (k, one) in inner.iter().enumerate() {
        faces.extend(inner[k + 1..].iter().find_map(|other| twin(one, other)).map(|other| [*one, other]));
    }
    assert_eq!(2 * faces.len(), inner.len());
    faces
}

#[test]
fn bonds_make_rock_as_much_softer_as_a_direct_solution_says_pulled_or_pressed() {
    for (times, pull_pa, way) in [(1.0, PULL_PA, "pulled"), (10.0, -PULL_PA, "pressed")] {
        let stiffness_pa_m = times * YOUNG_PA / SIZE_M;
        let mut cube = simulation(&scene(stiffness_pa_m, pull_pa, ""));
        let [young_pa, poisson] = found(&mut cube, pull_pa);
        let [exact_pa, exact] = solved(cube.blocks(), (YOUNG_PA, POISSON), stiffness_pa_m, false);
        let what = |of: &str| format!("{of} with bonds of {times} E/h, {way}");
        row("bonded rock", &what("E_eff/E"), young_pa / YOUNG_PA, Within(exact_pa / YOUNG_PA, 2e-3));
        row("bonded rock", &what("ν_eff"), poisson, Within(exact, 5e-3));
    }
}

/// The blocks of a scene, and what is stated of its bonds.
fn stated(text: &str) -> (BlockSet, Bonds) {
    let loaded = load_text("cube.ron", text, &[], None).unwrap_or_else(|e| panic!("{e}"));
    let (blocks, rock) = build::blocks_and_rock(&loaded.scene, Path::new(".")).unwrap();
    let bonded = rock[0].bonded.clone().expect("the rock is in pieces");
    (blocks, bonded.bonds.expect("bonds hold them"))
}

#[test]
fn the_modulus_that_is_stated_is_that_of_a_direct_solution() {
    for (times, error) in [(1.0, 0.05), (10.0, 0.01)] {
        let stiffness_pa_m = times * YOUNG_PA / SIZE_M;
        let (blocks, bonds) = stated(&scene(stiffness_pa_m, PULL_PA, ""));
        let [exact_pa, _] = solved(&blocks, (YOUNG_PA, POISSON), stiffness_pa_m, true);
        let what = format!("E_eff/E as stated, bonds of {times} E/h");
        row("bonded rock", &what, bonds.rock_pa[0] / YOUNG_PA, Within(exact_pa / YOUNG_PA, error));
    }
}

#[test]
fn stiffer_pieces_make_up_for_their_bonds() {
    let stiffness_pa_m = 10.0 * YOUNG_PA / SIZE_M;
    let text = scene(stiffness_pa_m, PULL_PA, "compensate: true");
    let (blocks, bonds) = stated(&text);
    let pieces = (bonds.pieces_pa, POISSON * bonds.pieces_pa / YOUNG_PA);
    let [young_pa, poisson] = solved(&blocks, pieces, stiffness_pa_m, true);
    row("bonded rock", "E_eff/E, made up for", young_pa / YOUNG_PA, Within(1.0, 0.02));
    row("bonded rock", "ν_eff, made up for", poisson, Within(POISSON, 0.05));
    let mut cube = simulation(&text);
    let [found_pa, _] = found(&mut cube, PULL_PA);
    let [exact_pa, _] = solved(&blocks, pieces, stiffness_pa_m, false);
    row(
        "bonded rock",
        "E_eff/E of a free cube, made up for",
        found_pa / YOUNG_PA,
        Within(exact_pa / YOUNG_PA, 2e-3),
    );
}
