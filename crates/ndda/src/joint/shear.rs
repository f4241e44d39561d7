//! Direct shear of one joint.

use ndda_contact::{FacetSlip, FrictionLaw};
use serde::Serialize;

use super::side::Side;
use super::{JointError, NormalStiffness, positive};

/// Halvings of a bracket of normal stresses, at most.
const MOST_TRIALS: usize = 300;
/// Normal stresses are found to this part of themselves.
const BALANCED: f64 = 4.0 * f64::EPSILON;

/// Boundary condition in the normal direction during shear.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Hold {
    /// It is constant.
    Stress,
    /// The joint may not open.
    Volume,
    /// A spring on top of the joint holds it.
    Stiffness {
        /// K [Pa/m].
        stiffness_pa_m: f64,
    },
}

impl Hold {
    /// 1/K [m/Pa]; nothing for a constant stress.
    fn compliance_m_pa(&self) -> Option<f64> {
        match *self {
            Self::Stress => None,
            Self::Volume => Some(0.0),
            Self::Stiffness { stiffness_pa_m } => Some(1.0 / stiffness_pa_m),
        }
    }
}

/// A direct-shear test.
#[derive(Clone, Debug, PartialEq)]
pub struct ShearTest {
    /// Normal stress σ₀ that the joint is pressed to before it is sheared [Pa].
    pub stress_pa: f64,
    /// Boundary condition in the normal direction during shear.
    pub hold: Hold,
    /// How the joint closes.
    pub normal: NormalStiffness,
    /// Total slip at the end of each step [m], from none.
    pub path_m: Vec<f64>,
}

/// The joint after a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ShearRow {
    /// Slip u, the stretch of the shear spring included [m].
    pub slip_m: f64,
    /// Shear stress τ against it [Pa].
    pub shear_pa: f64,
    /// Normal stress σ, compression positive [Pa].
    pub normal_pa: f64,
    /// By how much both walls are farther apart than at the start [m].
    pub opening_m: f64,
    /// The part of it that slip has made, v [m].
    pub dilation_m: f64,
    /// Slip along the path beyond the stretch of the shear spring [m].
    pub plastic_slip_m: f64,
    /// Energy that is lost so far, ∫ τ du_p − ∫ σ dv [J/m²].
    pub dissipated_j_m2: f64,
}

impl ShearTest {
    /// Shears a joint of this law. Both of its sides follow it, so that each bears half.
    ///
    /// # Errors
    /// [`JointError`]: numbers that a test cannot begin with, or a joint that no stiffness holds.
    pub fn run(&self, law: &dyn FrictionLaw) -> Result<Vec<ShearRow>, JointError> {
        self.check()?;
        let mut state = vec![0.0; law.state_len()];
        law.begin(&mut state);
        let mut side = Side::whole(state);
        let mut rows = vec![ShearRow { normal_pa: self.stress_pa, ..ShearRow::default() }];
        for &slip_m in &self.path_m {
            let last = rows[rows.len() - 1];
            let normal_pa = self.balance(law, &side, &last, slip_m)?;
            let strength_n = side.memory(|memory| law.capacity_n(&self.slip(0.0, last.normal_pa), memory));
            let stored_j_m2 = side.stored_j_m2(law);
            self.advance(law, &mut side, slip_m - last.slip_m, normal_pa);
            let before = (2.0 * strength_n, stored_j_m2);
            rows.push(self.row(law, &mut side, &last, (slip_m, normal_pa), before));
        }
        Ok(rows)
    }

    fn check(&self) -> Result<(), JointError> {
        positive("the normal stress", self.stress_pa)?;
        if let Hold::Stiffness { stiffness_pa_m } = self.hold {
            positive("the stiffness that holds the joint", stiffness_pa_m)?;
        }
        if self.normal == NormalStiffness::Rigid && self.hold == Hold::Volume {
            return Err(JointError::NoStiffness);
        }
        self.normal.check()
    }

    /// Slip and normal force of one side in a step.
    fn slip(&self, slip_m: f64, normal_pa: f64) -> FacetSlip {
        FacetSlip {
            normal_n: 0.5 * normal_pa,
            area_m2: 1.0,
            mean_area_m2: 1.0,
            dt_s: 1.0,
            slip_m: [slip_m, 0.0],
            stopping_n: [0.0; 2],
        }
    }

    /// One step of one side at a normal stress; the opening by slip after it.
    fn advance(&self, law: &dyn FrictionLaw, side: &mut Side, slip_m: f64, normal_pa: f64) -> f64 {
        let mut slip = self.slip(slip_m, normal_pa);
        if let Some(fracture) = law.fracture() {
            side.slip_m += slip_m;
            side.damage = side.damage.max(fracture.damage(0.0, side.slip_m));
            slip.normal_n *= side.damage;
            (slip.area_m2, slip.mean_area_m2) = (side.damage, side.damage);
        }
        side.memory(|memory| {
            if law.acts_on_faces() && slip_m != 0.0 {
                // A slip that is prescribed is stopped by no force: all that friction can do acts against it.
                let enough_n = 2.0 * (law.capacity_n(&slip, memory) + memory.shear_n[0].abs());
                slip.stopping_n = [-enough_n * slip_m.signum(), 0.0];
            }
            law.advance(&slip, memory);
            law.dilation_m(memory)
        })
    }

    /// Normal stress at which the joint's opening by slip is taken up by its closure and by what holds it.
    fn balance(
        &self,
        law: &dyn FrictionLaw,
        side: &Side,
        last: &ShearRow,
        slip_m: f64,
    ) -> Result<f64, JointError> {
        let Some(compliance_m_pa) = self.hold.compliance_m_pa() else { return Ok(self.stress_pa) };
        let start_m = self.normal.closure_m(self.stress_pa);
        let excess_m = |normal_pa: f64| {
            let dilation_m = self.advance(law, &mut side.clone(), slip_m - last.slip_m, normal_pa);
            let held_m = compliance_m_pa * (normal_pa - self.stress_pa);
            held_m + self.normal.closure_m(normal_pa) - start_m - dilation_m
        };
        // Opening falls with the stress, which stretches the shear spring more: the excess grows with it from below zero at none.
        let (mut low, mut high) = ((0.0, excess_m(0.0)), (last.normal_pa, excess_m(last.normal_pa)));
        for _ in 0..MOST_TRIALS {
            if high.1 >= 0.0 {
                return Ok(zero_between(&excess_m, low, high));
            }
            low = high;
            high.0 *= 2.0;
            high.1 = excess_m(high.0);
        }
        Err(JointError::NoBalance { slip_m })
    }

    fn row(
        &self,
        law: &dyn FrictionLaw,
        side: &mut Side,
        last: &ShearRow,
        (slip_m, normal_pa): (f64, f64),
        (strength_pa, stored_j_m2): (f64, f64),
    ) -> ShearRow {
        let shear_pa = side.shear_pa(law);
        let dilation_m = side.memory(|memory| law.dilation_m(memory));
        let stiffness_pa_m = law.shear_stiffness_pa_m();
        let stretch_m = if stiffness_pa_m > 0.0 { (shear_pa - last.shear_pa) / stiffness_pa_m } else { 0.0 };
        let slid_m = slip_m - last.slip_m - stretch_m;
        // From the strength that the joint had, which is where it yields, to the one that it has.
        let slid_j_m2 = match law.fracture() {
            None => 0.5 * (strength_pa.abs() + shear_pa.abs()) * slid_m.abs(),
            Some(_) => {
                let work_j_m2 = 0.5 * (last.shear_pa + shear_pa) * (slip_m - last.slip_m);
                work_j_m2 - (side.stored_j_m2(law) - stored_j_m2)
            }
        };
        let opened_j_m2 = 0.5 * (last.normal_pa + normal_pa) * (dilation_m - last.dilation_m);
        let closed_m = self.normal.closure_m(normal_pa) - self.normal.closure_m(self.stress_pa);
        ShearRow {
            slip_m,
            shear_pa,
            normal_pa,
            opening_m: dilation_m - closed_m,
            dilation_m,
            plastic_slip_m: last.plastic_slip_m + slid_m.abs(),
            dissipated_j_m2: last.dissipated_j_m2 + slid_j_m2 - opened_j_m2,
        }
    }
}

/// Where a function changes its sign between two places (regula falsi, Illinois), to rounding.
fn zero_between(function: &dyn Fn(f64) -> f64, mut low: (f64, f64), mut high: (f64, f64)) -> f64 {
    let mut last_was_high = None;
    for _ in 0..MOST_TRIALS {
        if high.1 == 0.0 || high.0 - low.0 <= BALANCED * high.0 {
            break;
        }
        let chord = high.0 - high.1 * (high.0 - low.0) / (high.1 - low.1);
        let at = if chord > low.0 && chord < high.0 { chord } else { 0.5 * (low.0 + high.0) };
        let found = function(at);
        let is_high = found >= 0.0;
        // An end that stays twice counts half.
        let weight = if last_was_high == Some(is_high) { 0.5 } else { 1.0 };
        if is_high {
            (high, low.1) = ((at, found), weight * low.1);
        } else {
            (low, high.1) = ((at, found), weight * high.1);
        }
        last_was_high = Some(is_high);
    }
    high.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::joint::path;
    use ndda_contact::{
        BartonBandis, Coulomb, Dilating, Dilation, Fracture, Roughness, SofteningBond, SofteningCoulomb,
    };

    const STIFFNESS_PA_M: f64 = 1e10;
    const LINEAR: NormalStiffness = NormalStiffness::Linear { stiffness_pa_m: STIFFNESS_PA_M };

    fn tan(deg: f64) -> f64 {
        deg.to_radians().tan()
    }

    /// φ 30°, ψ 10°, k_s 10 GPa/m.
    fn dilating(to_slip_m: f64) -> Dilating {
        let dilation = Dilation::Angle { psi_deg: 10.0, to_slip_m };
        Dilating::new(Box::new(Coulomb::new(30.0, STIFFNESS_PA_M)), dilation)
    }

    fn sheared(law: &dyn FrictionLaw, hold: Hold, path_m: Vec<f64>) -> Vec<ShearRow> {
        ShearTest { stress_pa: 1e6, hold, normal: LINEAR, path_m }.run(law).expect("a test")
    }

    fn near(found: f64, expected: f64, tolerance: f64) {
        assert!((found / expected - 1.0).abs() <= tolerance, "{found:e} for {expected:e}");
    }

    #[test]
    fn at_a_constant_stress_a_joint_lifts_by_its_dilation_and_dissipates_the_rest() {
        let yields_m = 1e6 * tan(30.0) / STIFFNESS_PA_M;
        for (to_slip_m, lift_mm, lost_j_m2) in [(1.0, 0.881_635, 2005.12), (3e-3, 0.528_981, 2357.77)] {
            let path_m = [0.0, 3e-3, 5e-3].map(|slip| yields_m + slip).to_vec();
            let end = sheared(&dilating(to_slip_m), Hold::Stress, path_m)[3];
            let expected_m = tan(10.0) * to_slip_m.min(5e-3);
            near(end.opening_m, expected_m, 1e-9);
            near(end.dissipated_j_m2, 1e6 * (5e-3 * tan(30.0) - expected_m), 1e-9);
            near(1e3 * end.opening_m, lift_mm, 1e-6);
            near(end.dissipated_j_m2, lost_j_m2, 3e-6);
            near(end.plastic_slip_m, 5e-3, 1e-9);
        }
    }

    #[test]
    fn at_a_constant_volume_and_against_a_spring_dilation_raises_the_normal_stress() {
        let slips_m = vec![1e-3, 2e-3, 5e-3];
        let spring = Hold::Stiffness { stiffness_pa_m: 1e9 };
        for (hold, stiffness_pa_m, printed_mpa) in [
            (Hold::Volume, STIFFNESS_PA_M, [2.507_95, 4.108_30, 8.909_36]),
            (spring, 1.0 / (1.0 / STIFFNESS_PA_M + 1e-9), [1.149_657, 1.308_485, 1.784_967]),
        ] {
            let rows = sheared(&dilating(1.0), hold, slips_m.clone());
            for (row, printed) in rows[1..].iter().zip(printed_mpa) {
                let raised = 1e6 + stiffness_pa_m * tan(10.0) * row.slip_m;
                let stress_pa = raised / (1.0 + stiffness_pa_m * tan(10.0) * tan(30.0) / STIFFNESS_PA_M);
                near(row.normal_pa, stress_pa, 1e-9);
                near(1e-6 * row.normal_pa, printed, 3e-6);
                near(row.shear_pa, row.normal_pa * tan(30.0), 1e-12);
            }
            if hold == Hold::Volume {
                assert!(rows.iter().all(|row| row.opening_m.abs() < 1e-12));
            }
        }
    }

    #[test]
    fn softening_takes_half_the_fall_of_the_strength_times_the_slip() {
        let law = SofteningCoulomb::new(STIFFNESS_PA_M, (40.0, 0.0), (25.0, 0.0), 5e-3);
        let (peak_pa, residual_pa) = (1e6 * tan(40.0), 1e6 * tan(25.0));
        let path_m = vec![peak_pa / STIFFNESS_PA_M, 5e-3 + residual_pa / STIFFNESS_PA_M, 8e-3];
        let rows = sheared(&law, Hold::Stress, path_m);
        let excess_j_m2 = rows[2].dissipated_j_m2 - residual_pa * rows[2].plastic_slip_m;
        near(excess_j_m2, 0.5 * (peak_pa - residual_pa) * 5e-3, 1e-9);
        near(excess_j_m2, 931.98, 1e-5);
        near(rows[1].shear_pa, peak_pa, 1e-12);
        near(rows[3].shear_pa, residual_pa, 1e-12);
    }

    /// A loop is 4 τ (A − τ/k_s) once the joint has yielded.
    #[test]
    fn cycles_dissipate_the_area_of_their_loops_and_do_not_ratchet() {
        let (amplitude_m, strength_pa) = (2e-3, 1e6 * tan(30.0));
        let path_m = path(amplitude_m, 3, 400).expect("a path");
        assert_eq!((path_m.len(), path_m[399], path_m[4799]), (4800, amplitude_m, 0.0));
        let rows = sheared(&Coulomb::new(30.0, STIFFNESS_PA_M), Hold::Stress, path_m.clone());
        let per_cycle = rows[4000].dissipated_j_m2 - rows[2400].dissipated_j_m2;
        near(per_cycle, 4.0 * strength_pa * (amplitude_m - strength_pa / STIFFNESS_PA_M), 1e-9);
        let rows = sheared(&dilating(1.0), Hold::Stress, path_m);
        let most_m = rows.iter().map(|row| row.opening_m).fold(0.0, f64::max);
        near(most_m, tan(10.0) * (amplitude_m - strength_pa / STIFFNESS_PA_M), 1e-9);
        for pair in rows.windows(2) {
            let lost = pair[1].dissipated_j_m2 - pair[0].dissipated_j_m2;
            assert!(lost > -1e-9, "a joint gives {lost} J/m²");
        }
    }

    #[test]
    fn dissipation_is_never_negative_whatever_holds_a_rough_joint() {
        let rough = Roughness { jrc: 15.0, jcs_pa: 50e6, residual_deg: 25.0, length_m: 0.1 };
        let closing = NormalStiffness::Hyperbolic { initial_pa_m: 2e10, most_m: 3e-4 };
        let spring = Hold::Stiffness { stiffness_pa_m: 1e9 };
        for hold in [Hold::Stress, spring, Hold::Volume] {
            let law = BartonBandis::new(rough, STIFFNESS_PA_M).mobilised();
            let law = Dilating::new(Box::new(law), Dilation::Own);
            let path_m = path(5e-3, 2, 2000).expect("a path");
            let test = ShearTest { stress_pa: 1e6, hold, normal: closing, path_m };
            let rows = test.run(&law).expect("a test");
            for pair in rows.windows(2) {
                let lost = pair[1].dissipated_j_m2 - pair[0].dissipated_j_m2;
                assert!(lost >= -1e-9, "{hold:?}: {lost} J/m² at a slip of {} m", pair[1].slip_m);
                assert!(pair[1].normal_pa > 0.0);
            }
        }
    }

    #[test]
    fn a_joint_that_breaks_gradually_loses_its_fracture_energy_and_rubs_on_what_is_broken() {
        let fracture =
            Fracture { stiffness_pa_m: 1e12, strength_pa: [1e6, 2e6], energy_j_m2: [100.0, 400.0] };
        let law = SofteningBond::new(30.0, fracture);
        let [_, last_m] = fracture.last_m();
        let path_m: Vec<f64> = (1..=20_000).map(|k| 1e-4 * last_m * f64::from(k)).collect();
        let normal = NormalStiffness::Rigid;
        let test = ShearTest { stress_pa: 1.0, hold: Hold::Stress, normal, path_m: path_m.clone() };
        let rows = test.run(&law).expect("a test");
        near(rows[20_000].dissipated_j_m2, 400.0, 1e-5);
        near(rows.iter().map(|row| row.shear_pa).fold(0.0, f64::max), 2e6, 1e-3);
        let rows = ShearTest { stress_pa: 1e6, ..test }.run(&law).expect("a test");
        near(rows[20_000].shear_pa, 1e6 * tan(30.0), 1e-12);
        for pair in rows.windows(2) {
            let lost = pair[1].dissipated_j_m2 - pair[0].dissipated_j_m2;
            assert!(lost > -1e-6, "a joint gives {lost} J/m²");
        }
    }

    #[test]
    fn friction_on_velocities_is_tested_as_a_joint_without_a_spring() {
        let law = ndda_contact::VelocityCoulomb::new(30.0);
        let rows = sheared(&law, Hold::Stress, vec![1e-3, -1e-3]);
        near(rows[1].shear_pa, 1e6 * tan(30.0), 1e-12);
        near(rows[2].shear_pa, -1e6 * tan(30.0), 1e-12);
        near(rows[2].dissipated_j_m2, 3e-3 * 1e6 * tan(30.0), 1e-12);
    }

    #[test]
    fn what_a_test_cannot_begin_with_is_an_error() {
        let law = Coulomb::new(30.0, STIFFNESS_PA_M);
        let (normal, path_m) = (NormalStiffness::Rigid, vec![1e-3]);
        let test = ShearTest { stress_pa: 1e6, hold: Hold::Volume, normal, path_m };
        assert_eq!(test.run(&law), Err(JointError::NoStiffness));
        let pulled = ShearTest { stress_pa: -1.0, ..test };
        assert!(pulled.run(&law).expect_err("tension").to_string().contains("above 0"));
    }
}
