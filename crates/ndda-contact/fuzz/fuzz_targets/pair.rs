//! Any bits as a pair of tetrahedra: finite answers or errors, and a kernel that does not panic.
#![no_main]

use libfuzzer_sys::fuzz_target;
use ndda_contact::integration::tet_overlap;
use ndda_contact::integration::TetFrame;
use ndda_contact::integration::pair_moments;
use ndda_contact::reference::tet_pair::pair_forces;
use ndda_mesh::Vec3;
use ndda_mesh::geometry::{TET_FACES, triangle_area_vector};

fuzz_target!(|bits: [[[f64; 3]; 4]; 2]| {
    let [contactor, target] = bits.map(|tet| tet.map(Vec3::from));
    if let Ok(forces) = pair_forces(&contactor, &target, 1.0) {
        assert!(forces.energy_j.is_finite() && forces.nodal_n.iter().all(|f| f.iter().all(|c| c.is_finite())));
    }
    if let Ok(overlap) = tet_overlap(&contactor, &target) {
        assert!(overlap.volume_m3.is_finite() && overlap.volume_m3 >= 0.0);
    }
    for face in TET_FACES {
        let triangle = face.map(|i| contactor[i]);
        let _ = pair_moments(&triangle, &triangle_area_vector(&triangle), &TetFrame::new(&target));
    }
});
