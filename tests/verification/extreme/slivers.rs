//! Elements a thousand to a million times as wide as high. Random ones against exact arithmetic are the families
//! `sliver`, `two slivers` and `sliver along a face` of crates/ndda-contact/tests/exact/main.rs.

use ndda_contact::integration::tet_overlap;
use ndda_mesh::Vec3;
use ndda_solver::Settle;

use super::{block, extreme};
use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::row;

/// A large tetrahedron whose lowest face is the plane z = `height_m`.
fn upper_half(height_m: f64) -> [Vec3; 4] {
    [(-9.0, -9.0, 0.0), (19.0, -9.0, 0.0), (-9.0, 19.0, 0.0), (-1.0, -1.0, 9.0)]
        .map(|(x, y, z)| Vec3::new(x, y, z + height_m))
}

#[test]
fn a_plane_cuts_off_slivers_what_their_corners_say() {
    let mut worst = 0.0f64;
    for aspect in [1e3, 1e4, 1e5, 1e6] {
        let height = 1.0 / aspect;
        let sliver = [Vec3::zeros(), Vec3::x(), Vec3::new(0.3, 1.1, 0.0), Vec3::new(0.37, 0.31, height)];
        let volume = 1.1 * height / 6.0;
        for part in [0.0, 0.1, 0.5, 0.9, 0.999] {
            // Above the height `part` of it there is (1 − part)³ of a tetrahedron.
            let shared = tet_overlap(&upper_half(part * height), &sliver).unwrap().volume_m3;
            worst = worst.max((shared / volume - (1.0 - part).powi(3)).abs());
        }
    }
    row(
        "extreme: slivers",
        "volume cut off slivers of aspect 1e3 to 1e6, error over theirs",
        worst,
        // Heights are cut from heights, which keep their own digits however flat: the rounding of a few dozen operations.
        AtMost(100.0 * f64::EPSILON),
    );
}

#[test]
fn a_sheet_of_slivers_bears_a_block() {
    for thickness in ["1e-3", "1e-6"] {
        let size = format!("blocks.plate.shape.size_m=(1,1,{thickness})");
        let place = format!("blocks.block.at_m=(0,0,{thickness})");
        let mut simulation = extreme("slivers", &[&size, &place]).simulation;
        simulation.settle(&Settle::new(1e-3, 100_000)).unwrap();
        let base = block(&simulation, "base");
        // Two periods of what is left of its bounce.
        let (mut force, steps) = (0.0, 200);
        for _ in 0..steps {
            simulation.step().unwrap();
            force += (simulation.reaction_n(base).z - 9.0 * 2500.0 * 9.8) / f64::from(steps);
        }
        let weight = 2500.0 * 9.8 * (1.0 + thickness.parse::<f64>().unwrap());
        row(
            "extreme: slivers",
            &format!("force under a sheet of {thickness} m and a block [N]"),
            force,
            // It settled to 1e-3 of its largest speed.
            Within(weight, 1e-3),
        );
    }
}
