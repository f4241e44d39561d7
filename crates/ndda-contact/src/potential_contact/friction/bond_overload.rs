//! A bond that carries more than its strength breaks, slips, opens or is damaged.

use crate::friction::fracture::Fracture;
use crate::friction::law::{FacetSlip, FrictionLaw};
use crate::friction::stretch::{Break, Stretch, frame_of};
use crate::model::{Bond, ContactInput};

/// How a bond breaks; none where it holds. A bond whose law lets it slip does so first.
pub(super) fn overload(
    bond: &mut Bond,
    law: Option<&dyn FrictionLaw>,
    (pressed_n, input): (f64, &ContactInput),
    scratch: &mut Vec<f64>,
) -> Option<Break> {
    let Some(law) = law else { return Some(Break::default()) };
    let mut stretch = Stretch::of(input, bond);
    let Some(strength_pa) = law.tension_after_slip_pa(bond.slip_m) else {
        return stretch.overload(law, (pressed_n, law.tension_pa(), bond.slip_m), scratch);
    };
    open(bond, &mut stretch, (law, strength_pa), input);
    let (slipped_m, offset_m) = (bond.slip_m, stretch.offset_m);
    let Some(left_pa) = slip(bond, &mut stretch, law, (pressed_n, input), scratch) else {
        let opens = stretch.is_pulled(law, pressed_n);
        // A bond that slipped in earlier steps has softened gradually. One that held until this step breaks at once, and its overload shows how late.
        stretch.offset_m = offset_m;
        let at_once = stretch.overload(law, (pressed_n, strength_pa, slipped_m), scratch);
        let overload = at_once.filter(|_| slipped_m == 0.0).map_or(0.0, |found| found.overload);
        return Some(Break { overload, opens });
    };
    open(bond, &mut stretch, (law, left_pa), input);
    stretch.overload(law, (pressed_n, left_pa, bond.slip_m), scratch)
}

/// Damages a bond by how far it is stretched. Gives its overload where it breaks at once.
pub(crate) fn damage(bond: &mut Bond, fracture: &Fracture, input: &ContactInput) -> f64 {
    let (opening_m, slip_m) = Stretch::of(input, bond).beyond_rounding_m();
    let reached = fracture.damage(opening_m, slip_m);
    let at_once = bond.damage == 0.0 && reached >= 1.0;
    bond.damage = bond.damage.max(reached);
    if at_once { fracture.load(opening_m, slip_m) - 1.0 } else { 0.0 }
}

/// Lets a bond open as far as its tensile strength [Pa] is exceeded, where its law lets it.
fn open(
    bond: &mut Bond,
    stretch: &mut Stretch,
    (law, strength_pa): (&dyn FrictionLaw, f64),
    input: &ContactInput,
) {
    let elastic_m = strength_pa / law.bond_stiffness_pa_m();
    let beyond_m = stretch.opening_m - elastic_m;
    if beyond_m > 0.0 && bond.opened_m + beyond_m <= law.opens_m() {
        bond.opened_m += beyond_m;
        stretch.opening_m = elastic_m;
        bond.lambda = frame_of(bond.tet, input).lambda_at(&stretch.anchor());
    }
}

/// Lets a bond slip as far as its shear strength is exceeded. Gives its tensile strength [Pa]; none where slip has left none, or has gone as far as what the bond holds is wide.
fn slip(
    bond: &mut Bond,
    stretch: &mut Stretch,
    law: &dyn FrictionLaw,
    (pressed_n, input): (f64, &ContactInput),
    state: &mut Vec<f64>,
) -> Option<f64> {
    let trial_n = stretch.shear_n(law).norm();
    let area_m2 = 2.0 * stretch.half_area;
    let normal_n = pressed_n - stretch.tension_n(law);
    let load = FacetSlip { normal_n, area_m2, mean_area_m2: area_m2, ..FacetSlip::default() };
    let mut memory = stretch.memory((law, bond.slip_m), state);
    memory.shear_n = [trial_n, 0.0];
    law.advance(&load, &mut memory);
    let (shear_n, slip_m) = (memory.shear_n[0], memory.state[0]);
    if shear_n < trial_n {
        stretch.offset_m *= shear_n / trial_n;
        bond.lambda = frame_of(bond.tet, input).lambda_at(&stretch.anchor());
        bond.slip_m = slip_m;
    }
    let left = law.tension_after_slip_pa(bond.slip_m).filter(|left_pa| *left_pa > 0.0);
    left.filter(|_| bond.slip_m.powi(2) < area_m2)
}
