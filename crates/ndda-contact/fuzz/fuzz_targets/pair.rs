//! Any bits as a pair of tetrahedra: a finite answer or an error.
#![no_main]

use libfuzzer_sys::fuzz_target;
use ndda_contact::tet_pair::pair_forces;
use ndda_mesh::Vec3;

fuzz_target!(|bits: [[[f64; 3]; 4]; 2]| {
    let [contactor, target] = bits.map(|tet| tet.map(Vec3::from));
    if let Ok(forces) = pair_forces(&contactor, &target, 1.0) {
        assert!(forces.energy_j.is_finite() && forces.nodal_n.iter().all(|f| f.iter().all(|c| c.is_finite())));
    }
});
