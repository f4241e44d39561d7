//! The contract suite of friction laws.

use crate::friction::law::{FacetSlip, FrictionLaw, ShearMemory};

/// Panics unless `law` keeps the contract of [`FrictionLaw`].
pub fn check_friction(law: &dyn FrictionLaw) {
    let along = [1e-3, -2e-3];
    let slip = |normal_n: f64| FacetSlip {
        normal_n,
        area_m2: 1.0,
        mean_area_m2: 1.0,
        slip_m: along,
        stopping_n: along.map(|s| -1e2 * s),
    };
    let size = |memory: &ShearMemory| memory.shear_n[0].hypot(memory.shear_n[1]);
    let mut stuck = ShearMemory { shear_n: [5.0, 5.0], ..ShearMemory::default() };
    law.advance(&slip(0.0), &mut stuck);
    assert_eq!(stuck.shear_n, [0.0, 0.0], "shear without a normal force");

    let (mut once, mut last) = (ShearMemory::default(), 0.0);
    for _ in 0..1000 {
        law.advance(&slip(1.0), &mut once);
        let power = once.shear_n[0] * along[0] + once.shear_n[1] * along[1];
        assert!(power <= 0.0, "friction pushes along the slip");
        let reached = size(&once);
        assert!(reached.is_finite() && reached >= last * (1.0 - 1e-12), "a steady slip lets the force sink");
        assert!(reached <= law.capacity_n(&slip(1.0), &once) * (1.0 + 1e-12), "more than the law carries");
        last = reached;
    }
    let mut double = ShearMemory::default();
    for _ in 0..1000 {
        law.advance(&slip(2.0), &mut double);
    }
    assert!(size(&double) <= 2.0 * last * (1.0 + 1e-12), "the cap grows faster than the normal force");
    let kept = double;
    let rest = FacetSlip { slip_m: [0.0; 2], stopping_n: [0.0; 2], ..slip(2.0) };
    law.advance(&rest, &mut double);
    let lost = (kept.shear_n[0] - double.shear_n[0]).hypot(kept.shear_n[1] - double.shear_n[1]);
    assert!(lost <= 1e-12 * size(&kept), "a block at rest loses its hold");
}
