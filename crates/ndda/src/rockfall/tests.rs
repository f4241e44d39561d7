//! A boulder in contact with the ground against closed forms.

use std::path::Path;

use ndda_io::scene::Ground;
use ndda_mesh::{Mat3, Vec3};

use super::boulder::Boulder;
use super::contact::BOULDER;
use super::terrain::Terrain;
use super::window::{Cells, Laws, Motion, motion, restitution_of, simulation};

const G: f64 = 9.81;
const DENSITY_KG_M3: f64 = 2700.0;
/// Penalty of a boulder of a metre for impacts at 15 m/s.
const PENALTY_PA: f64 = 4.4e10;

/// A slope that falls to the east at an angle [°], 40 m wide, with a height in every metre.
fn slope(angle_deg: f64, columns: usize) -> Terrain {
    let fall = angle_deg.to_radians().tan();
    let row: Vec<f64> = (0..=columns).map(|i| -fall * i as f64).collect();
    let ground = Ground::Heights { origin_m: [0.0, 0.0], step_m: [1.0; 2], heights_m: vec![row; 41] };
    Terrain::new(&ground, Path::new("."), (&[], None)).expect("a grid")
}

fn laws(restitution: f64, friction_deg: f64) -> Laws {
    Laws {
        penalty_pa: PENALTY_PA,
        restitution: restitution_of(&[restitution]),
        friction_deg: vec![friction_deg],
        density_kg_m3: DENSITY_KG_M3,
        gravity_m_s2: -G,
        step_s: 1e-3,
        energy: 1e-4,
    }
}

/// A cube of a metre that lies on a slope, a bit above it, and moves down it and into it.
fn cube(angle_deg: f64, at_x: f64, lift_m: f64, [along, into]: [f64; 2]) -> (Boulder, Motion) {
    let boulder = Boulder::cube(1.0);
    let (sin, cos) = angle_deg.to_radians().sin_cos();
    let (down, normal) = (Vec3::new(cos, 0.0, -sin), Vec3::new(sin, 0.0, cos));
    let turn = Mat3::from_columns(&[down, Vec3::y(), normal]);
    let foot = Vec3::new(at_x, 20.3, -angle_deg.to_radians().tan() * at_x);
    let center = foot + (0.5 + lift_m) * normal;
    let arms = boulder.mesh.nodes.iter().map(|x| turn * x).collect();
    let velocity_m_s = along * down - into * normal;
    (boulder, Motion { arms, center, velocity_m_s, spin_rad_s: Vec3::zeros() })
}

/// Steps for a time, with new windows where they are needed; the motion then, and the energy that came from nowhere [J].
fn moved(terrain: &Terrain, boulder: &Boulder, start: Motion, laws: &Laws, time_s: f64) -> (Motion, f64) {
    let (mut now, mut left, mut spurious_j) = (start, (time_s / laws.step_s).round() as u32, 0.0);
    while left > 0 {
        let cells = Cells::around(terrain, &now, boulder.radius_m).expect("on the terrain");
        let mut running = simulation((terrain, cells), (&boulder.mesh.tets, &now), laws).expect("a window");
        while left > 0 {
            running.step().expect("a step");
            left -= 1;
            let nodes = running.blocks().nodes_of(BOULDER);
            let center = running.shape(BOULDER).operator.center(&running.state().position[nodes]);
            if !cells.hold(terrain, &(center + running.blocks().origin_m), boulder.radius_m, 0.0) {
                break;
            }
        }
        spurious_j += running.sample().expect("energies").balance_j.abs();
        now = motion(&running);
    }
    (now, spurious_j)
}

#[test]
fn a_cube_rebounds_with_the_restitution_of_the_ground_on_any_slope() {
    for (angle_deg, restitution) in [(0.0, 0.2), (0.0, 0.7), (30.0, 0.4)] {
        let terrain = slope(angle_deg, 60);
        let (boulder, start) = cube(angle_deg, 20.4, 0.01, [0.0, 6.0]);
        let laws = laws(restitution, 0.0);
        let (end, _) = moved(&terrain, &boulder, start, &laws, 0.06);
        let (sin, cos) = f64::to_radians(angle_deg).sin_cos();
        let speed = end.velocity_m_s.dot(&Vec3::new(sin, 0.0, cos));
        // Gravity changes it by less than 0.6 m/s along the normal, most of it known.
        let rebound = speed + G * cos * 0.05;
        assert!((rebound / (6.0 * restitution) - 1.0).abs() < 0.12, "{angle_deg}° e {restitution}: {speed}");
    }
}

#[test]
fn a_cube_slides_down_a_slope_as_coulomb_says() {
    let (angle_deg, friction_deg) = (25.0, 32.0);
    let terrain = slope(angle_deg, 120);
    let (boulder, start) = cube(angle_deg, 20.0, 0.0, [8.0, 0.0]);
    let from = start.center;
    let laws = laws(0.1, friction_deg);
    let (sin, cos) = f64::to_radians(angle_deg).sin_cos();
    let braking = G * (f64::to_radians(friction_deg).tan() * cos - sin);
    let (stop_s, way_m) = (8.0 / braking, 0.5 * 64.0 / braking);
    let (end, spurious_j) = moved(&terrain, &boulder, start, &laws, stop_s + 0.5);
    let gone = (end.center - from).norm();
    assert!((gone / way_m - 1.0).abs() < 0.01, "{gone} m of {way_m} m");
    assert!(end.velocity_m_s.norm() < 0.02, "{}", end.velocity_m_s);
    let kinetic_j = 0.5 * DENSITY_KG_M3 * 64.0;
    assert!(spurious_j < 0.02 * kinetic_j, "{spurious_j} J of {kinetic_j} J");
}

#[test]
fn the_borders_of_triangles_of_a_plane_do_not_matter() {
    // The same cube on the same plane, under which the grid is shifted by a part of a step.
    let (angle_deg, friction_deg) = (20.0, 30.0);
    let (boulder, start) = cube(angle_deg, 20.0, 0.0, [6.0, 0.0]);
    let fall = f64::to_radians(angle_deg).tan();
    let ends = [0.0, 0.37].map(|shift| {
        let row: Vec<f64> = (0..=60).map(|i| -fall * (f64::from(i) - shift)).collect();
        let ground =
            Ground::Heights { origin_m: [-shift, -0.21], step_m: [1.0; 2], heights_m: vec![row; 41] };
        let terrain = Terrain::new(&ground, Path::new("."), (&[], None)).expect("a grid");
        moved(&terrain, &boulder, start.clone(), &laws(0.1, friction_deg), 1.0).0.center
    });
    let gone = (ends[0] - start.center).norm();
    assert!((ends[1] - ends[0]).norm() < 1e-3 * gone, "{} m of {gone} m", (ends[1] - ends[0]).norm());
}

#[test]
fn a_boulder_beside_a_gap_in_the_heights_moves_as_without_the_ground_beyond_it() {
    // A plane of 0°, on which a cube stays; the column from x = 22 to 23 m has no heights, and the ground goes on beyond it.
    let folder = tempfile::tempdir().unwrap();
    let row = |gap: bool, beyond: &str| -> String {
        let height = |i: usize| match i {
            22 if gap => "-9999 ",
            23.. => beyond,
            _ => "0 ",
        };
        (0..=40).map(height).collect()
    };
    let ends = [(false, "0 "), (true, "0 "), (true, "-9999 ")].map(|(gap, beyond)| {
        let head = "ncols 41\nnrows 41\nxllcenter 0\nyllcenter 0\ncellsize 1\nNODATA_value -9999\n";
        std::fs::write(
            folder.path().join("t.asc"),
            format!("{head}{}", (row(gap, beyond) + "\n").repeat(41)),
        )
        .unwrap();
        let ground = Ground::File { file: "t.asc".into(), origin_m: [0.0; 2], sample_m: None };
        let terrain = Terrain::new(&ground, folder.path(), (&[], None)).expect("a grid");
        let (boulder, start) = cube(0.0, 19.0, 0.01, [3.0, 0.0]);
        moved(&terrain, &boulder, start, &laws(0.1, 30.0), 0.3).0.center
    });
    assert_eq!(ends[1], ends[2]);
    assert!((ends[0] - ends[1]).norm() < 1e-9, "{ends:?}");
}
