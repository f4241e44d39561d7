//! The contract suite of friction laws.

use crate::friction::law::{FacetSlip, FrictionLaw, ShearMemory, length};

/// Step of the suite [s].
const DT_S: f64 = 1e-3;

/// A contact of 1 m² that slips.
fn slipping(normal_n: f64, slip_m: [f64; 2]) -> FacetSlip {
    let stopping_n = slip_m.map(|s| -1e2 * s);
    FacetSlip { normal_n, area_m2: 1.0, mean_area_m2: 1.0, dt_s: DT_S, slip_m, stopping_n }
}

/// A law on one facet, and what it remembers.
struct Contact<'a> {
    law: &'a dyn FrictionLaw,
    shear_n: [f64; 2],
    broken: bool,
    state: Vec<f64>,
}

impl<'a> Contact<'a> {
    fn new(law: &'a dyn FrictionLaw) -> Self {
        let mut state = vec![f64::NAN; law.state_len()];
        law.begin(&mut state);
        assert!(state.iter().all(|v| v.is_finite()), "a contact begins with a state that is not a number");
        Self { law, shear_n: [0.0; 2], broken: true, state }
    }

    /// One step; the force.
    fn advance(&mut self, slip: &FacetSlip) -> [f64; 2] {
        let mut memory = ShearMemory { shear_n: self.shear_n, broken: self.broken, state: &mut self.state };
        self.law.advance(slip, &mut memory);
        let capacity_n = self.law.capacity_n(slip, &memory);
        (self.shear_n, self.broken) = (memory.shear_n, memory.broken);
        assert!(self.size().is_finite(), "a force that is not a number");
        assert!(self.state.iter().all(|v| v.is_finite()), "a state that is not a number");
        assert!(self.size() <= capacity_n * (1.0 + 1e-12), "more than the law carries");
        self.shear_n
    }

    fn size(&self) -> f64 {
        length(self.shear_n)
    }
}

/// Panics unless `law` keeps the contract of [`FrictionLaw`].
pub fn check_friction(law: &dyn FrictionLaw) {
    let mut stuck = Contact { shear_n: [5.0, 5.0], ..Contact::new(law) };
    assert_eq!(stuck.advance(&slipping(0.0, [1e-3, -2e-3])), [0.0, 0.0], "shear without a normal force");
    check_stiffness(law);
    check_steady_slip(law);
    check_energy(law);
    check_turning(law);
}

/// The first slip stretches a spring no stiffer than the law says.
fn check_stiffness(law: &dyn FrictionLaw) {
    let stiffness_n_m = 0.5 * law.shear_stiffness_pa_m();
    if stiffness_n_m > 0.0 {
        let slip_m = [3e-9, -4e-9];
        let mut contact = Contact::new(law);
        contact.advance(&slipping(1e3 * stiffness_n_m * length(slip_m), slip_m));
        let most_n = stiffness_n_m * length(slip_m);
        assert!(
            contact.size() <= most_n * (1.0 + 1e-12),
            "stiffer than it says: {} N of {most_n}",
            contact.size()
        );
    }
}

/// Friction opposes a steady slip; where the strength is constant it grows until it slides, in proportion to the normal force at most, and a
/// block at rest is held by what held it.
fn check_steady_slip(law: &dyn FrictionLaw) {
    let along = [1e-3, -2e-3];
    let (mut once, mut twice, mut last) = (Contact::new(law), Contact::new(law), 0.0);
    for _ in 0..1000 {
        let [x, y] = once.advance(&slipping(1.0, along));
        assert!(x * along[0] + y * along[1] <= 0.0, "friction pushes along the slip");
        let grows = once.size() >= last * (1.0 - 1e-12);
        assert!(grows || !law.has_constant_strength(), "a steady slip lets the force sink");
        last = once.size();
        twice.advance(&slipping(2.0, along));
    }
    let kept = twice.shear_n;
    twice.advance(&slipping(2.0, [0.0; 2]));
    let changed = length([0, 1].map(|i| kept[i] - twice.shear_n[i]));
    assert!(twice.size() <= length(kept) * (1.0 + 1e-12), "friction grows at rest");
    if law.has_constant_strength() {
        assert!(length(kept) <= 2.0 * last * (1.0 + 1e-12), "the cap grows faster than the normal force");
        assert!(changed <= 1e-12 * length(kept), "a block at rest loses its hold");
    }
}

/// Slips of a path that turns, reverses and rests.
fn path() -> impl Iterator<Item = [f64; 2]> {
    (0..2000).map(|k| {
        let (angle, along) = (0.01 * f64::from(k), f64::from(k % 37) - 12.0);
        let size_m = if k % 200 < 40 { 0.0 } else { 1e-5 * along };
        [size_m * angle.cos(), size_m * angle.sin()]
    })
}

/// Along any path friction takes no less than its spring gives back: −Σ f·Δu − ½ f²/k ≥ 0.
fn check_energy(law: &dyn FrictionLaw) {
    let stiffness_n_m = 0.5 * law.shear_stiffness_pa_m();
    let (mut contact, mut taken_j, mut turned_over_j) = (Contact::new(law), 0.0, 0.0);
    for slip_m in path() {
        let before = contact.shear_n;
        let after = contact.advance(&slipping(1e3, slip_m));
        // A law without a spring acts with what it ends with.
        let mean = if stiffness_n_m > 0.0 { [0, 1].map(|i| 0.5 * (before[i] + after[i])) } else { after };
        let work_j = mean[0] * slip_m[0] + mean[1] * slip_m[1];
        taken_j -= work_j;
        turned_over_j += work_j.abs();
        let stored_j = if stiffness_n_m > 0.0 { 0.5 * contact.size().powi(2) / stiffness_n_m } else { 0.0 };
        assert!(
            taken_j - stored_j >= -1e-9 * turned_over_j,
            "friction gives energy: {} J",
            stored_j - taken_j
        );
    }
}

/// Slip in turned axes gives the turned force, and repeated slip the same bits.
fn check_turning(law: &dyn FrictionLaw) {
    let (sine, cosine) = 0.7f64.sin_cos();
    let turn = |[x, y]: [f64; 2]| [cosine * x - sine * y, sine * x + cosine * y];
    let [mut contact, mut again, mut turned] = [(); 3].map(|()| Contact::new(law));
    let mut most_n = 0.0f64;
    for slip_m in path() {
        let force = contact.advance(&slipping(1e3, slip_m));
        most_n = most_n.max(length(force));
        assert_eq!(force, again.advance(&slipping(1e3, slip_m)), "the same slip gives other bits");
        let (expected, found) = (turn(force), turned.advance(&slipping(1e3, turn(slip_m))));
        let off = length([0, 1].map(|i| expected[i] - found[i]));
        assert!(off <= 1e-9 * most_n, "friction does not turn with the slip: {found:?}, not {expected:?}");
    }
}
