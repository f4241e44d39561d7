//! A plate that sticks on a slope must not creep (φ = 35° on 30°, ten seconds).

use ndda_cli::check::prepare;

#[test]
fn a_sticking_plate_moves_less_than_a_nanometre_in_nine_seconds() {
    let scene = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/sticking_30_phi35.ron");
    let mut ready = prepare(&scene, &[]).unwrap();
    let mut moved_m = |steps: usize| {
        for _ in 0..steps {
            ready.simulation.step().unwrap();
        }
        ready.monitors[0].displacement(&ready.simulation)
    };
    // Means over a tenth of a second, so that a vibration does not pass for creep.
    let mut mean = |skip: usize| {
        moved_m(skip);
        (0..100).map(|_| moved_m(1)).sum::<ndda_mesh::Vec3>() / 100.0
    };
    let (early, late) = (mean(950), mean(8850));
    assert!(early.norm() > 1e-8, "the plate does not even settle: {early:?}");
    assert!((late - early).norm() < 1e-9, "crept by {:e} m", (late - early).norm());
}
