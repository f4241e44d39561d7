//! Shear strength of rough joints after Barton and Bandis.

use crate::friction::law::{FacetSlip, FrictionLaw, ShearMemory, capped, length};

/// Largest total friction angle: beyond it the logarithm is an extrapolation [°].
const MOST_DEG: f64 = 70.0;

/// Roughness that is mobilised: slip over that at the peak, and JRC over that at the peak (Barton 1982, table of the dimensionless model). Before the first
/// of these points the angle rises from nothing to φ_r.
const MOBILISED: [[f64; 2]; 8] =
    [[0.3, 0.0], [0.6, 0.75], [1.0, 1.0], [2.0, 0.85], [4.0, 0.7], [10.0, 0.5], [25.0, 0.4], [100.0, 0.0]];

/// Bisections that find a slip to the last bit.
const HALVINGS: usize = 60;

/// Properties of a rough joint, measured on a sample or at full size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roughness {
    /// Joint roughness coefficient JRC [-].
    pub jrc: f64,
    /// Compressive strength of the walls JCS [Pa].
    pub jcs_pa: f64,
    /// Residual friction angle φ_r [°].
    pub residual_deg: f64,
    /// Length that JRC and JCS are of [m].
    pub length_m: f64,
}

impl Roughness {
    /// Properties at another length L: JRC (L/L₀)^(−0.02 JRC) and JCS (L/L₀)^(−0.03 JRC) (Bandis, Lumsden & Barton 1981).
    pub fn of_length(self, length_m: f64) -> Self {
        let ratio = length_m / self.length_m;
        Self {
            jrc: self.jrc * ratio.powf(-0.02 * self.jrc),
            jcs_pa: self.jcs_pa * ratio.powf(-0.03 * self.jrc),
            length_m,
            ..self
        }
    }

    /// Slip at the peak, (L/500) (JRC/L)^0.33, L in metres [m] (Barton & Bandis 1982).
    pub fn peak_slip_m(&self) -> f64 {
        self.length_m / 500.0 * (self.jrc / self.length_m).powf(0.33)
    }

    /// Roughness angle i = JRC log₁₀(JCS/σ) [°]; none where σ is above the strength of the walls.
    pub fn roughness_deg(&self, stress_pa: f64) -> f64 {
        (self.jrc * (self.jcs_pa / stress_pa).log10()).max(0.0)
    }

    /// Peak friction angle φ_r + i, at most 70° [°].
    pub fn peak_deg(&self, stress_pa: f64) -> f64 {
        (self.residual_deg + self.roughness_deg(stress_pa)).min(MOST_DEG)
    }

    /// Peak shear strength σ tan(φ_r + JRC log₁₀(JCS/σ)) [Pa].
    pub fn strength_pa(&self, stress_pa: f64) -> f64 {
        if stress_pa > 0.0 { stress_pa * self.peak_deg(stress_pa).to_radians().tan() } else { 0.0 }
    }

    /// Dilation angle at the peak, ½ i [°].
    pub fn dilation_deg(&self, stress_pa: f64) -> f64 {
        0.5 * (self.peak_deg(stress_pa) - self.residual_deg).max(0.0)
    }

    /// Slope and intercept of the tangent to the strength: φ_i [°] and c_i [Pa].
    pub fn tangent(&self, stress_pa: f64) -> (f64, f64) {
        let angle = self.peak_deg(stress_pa).to_radians();
        let rough = self.roughness_deg(stress_pa) > 0.0 && angle.to_degrees() < MOST_DEG;
        let turns = if rough { self.jrc.to_radians() / std::f64::consts::LN_10 } else { 0.0 };
        let slope = angle.tan() - turns * (1.0 + angle.tan().powi(2));
        (slope.atan().to_degrees(), self.strength_pa(stress_pa) - stress_pa * slope)
    }
}

/// Barton's law with a shear spring k_s:
///
/// ```text
/// τ = σ tan(φ_r + JRC log₁₀(JCS/σ))        φ_r + … at most 70°, log₁₀ at least 0
/// ```
///
/// Each side of a contact bears half of σ, which matters to the logarithm: σ = 2 f_n/S, and the side carries ½ τ S. Where roughness is mobilised by
/// slip, JRC is multiplied by a function of the plastic slip over that at the peak: it rises until the peak and is worn off beyond it; the angle
/// begins at nothing. Plastic slip is counted along the path, forth and back. A contact that begins during a run begins unworn.
///
/// Barton & Choubey 1977; Barton 1982; Barton & Bandis 1982.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BartonBandis {
    roughness: Roughness,
    shear_penalty_pa_m: f64,
    /// Slip at the peak, where roughness is mobilised by slip [m].
    peak_slip_m: Option<f64>,
    /// Factor that divides tan φ [-].
    reduction: f64,
}

impl BartonBandis {
    /// The peak strength at any slip; k_s [Pa/m].
    pub fn new(roughness: Roughness, shear_penalty_pa_m: f64) -> Self {
        Self { roughness, shear_penalty_pa_m, peak_slip_m: None, reduction: 1.0 }
    }

    /// With roughness that is mobilised and worn off by slip.
    pub fn mobilised(self) -> Self {
        Self { peak_slip_m: Some(self.roughness.peak_slip_m()), ..self }
    }

    /// With a strength τ/F.
    pub fn reduced_by(self, factor: f64) -> Self {
        Self { reduction: factor, ..self }
    }

    /// JRC over that at the peak after some plastic slip; below zero while less than φ_r is mobilised, which is −1 at no slip.
    fn mobilised_part(&self, plastic_m: f64) -> f64 {
        let Some(peak_m) = self.peak_slip_m else { return 1.0 };
        let slip = plastic_m / peak_m;
        let (mut from, last) = ([0.0, -1.0], MOBILISED[MOBILISED.len() - 1]);
        for to in MOBILISED {
            if slip < to[0] {
                return from[1] + (to[1] - from[1]) * (slip - from[0]) / (to[0] - from[0]);
            }
            from = to;
        }
        last[1]
    }

    /// Normal stress of both sides together [Pa].
    fn stress_pa(slip: &FacetSlip) -> f64 {
        2.0 * slip.normal_n / slip.area_m2
    }

    /// Strength of one side after some plastic slip [N].
    fn strength_n(&self, slip: &FacetSlip, plastic_m: f64) -> f64 {
        if slip.normal_n <= 0.0 {
            return 0.0;
        }
        let (part, roughness) = (self.mobilised_part(plastic_m), &self.roughness);
        let angle_deg = if part < 0.0 {
            // From nothing to φ_r.
            (1.0 + part) * roughness.residual_deg
        } else {
            let rough_deg = part * roughness.roughness_deg(Self::stress_pa(slip));
            (roughness.residual_deg + rough_deg).min(MOST_DEG)
        };
        slip.normal_n * angle_deg.to_radians().tan() / self.reduction
    }

    /// Further plastic slip in a step whose spring would bear `trial_n`: the first Δp at which |f| − k Δp = τ(p + Δp). Between two points of the
    /// curve the angle is linear in the slip, so its tangent is convex, and the difference of both sides has one root where it changes its sign.
    fn plastic_slip_m(&self, trial_n: f64, slip: &FacetSlip, from_m: f64, spring_n_m: f64) -> f64 {
        let left_n = |more_m: f64| trial_n - spring_n_m * more_m - self.strength_n(slip, from_m + more_m);
        let mut low_m = 0.0;
        for point in MOBILISED {
            let high_m = point[0] * self.peak_slip_m.unwrap_or(0.0) - from_m;
            if high_m <= low_m {
                continue;
            }
            if left_n(high_m) <= 0.0 {
                return first_zero(&left_n, low_m, high_m);
            }
            low_m = high_m;
        }
        (trial_n - self.strength_n(slip, from_m + low_m)) / spring_n_m
    }
}

/// Where a function that is above zero at `low` and not at `high` changes its sign once.
fn first_zero(function: &dyn Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if function(middle) > 0.0 { low = middle } else { high = middle }
    }
    high
}

impl FrictionLaw for BartonBandis {
    fn name(&self) -> &'static str {
        "Barton–Bandis with a shear spring"
    }

    /// Plastic slip where it matters [m].
    fn state_len(&self) -> usize {
        usize::from(self.peak_slip_m.is_some())
    }

    fn advance(&self, slip: &FacetSlip, memory: &mut ShearMemory) {
        let spring_n_m = 0.5 * self.shear_penalty_pa_m * slip.mean_area_m2;
        let trial = [0, 1].map(|i| memory.shear_n[i] - spring_n_m * slip.slip_m[i]);
        let slides = length(trial) > self.capacity_n(slip, memory) && spring_n_m > 0.0;
        if let (true, Some(plastic_m)) = (slides, memory.state.first_mut()) {
            *plastic_m += self.plastic_slip_m(length(trial), slip, *plastic_m, spring_n_m);
        }
        memory.shear_n = capped(trial, self.capacity_n(slip, memory)).0;
    }

    fn capacity_n(&self, slip: &FacetSlip, memory: &ShearMemory) -> f64 {
        self.strength_n(slip, memory.state.first().copied().unwrap_or(0.0))
    }

    fn shear_stiffness_pa_m(&self) -> f64 {
        self.shear_penalty_pa_m
    }

    /// ½ JRC log₁₀(JCS/σ), of the roughness that is mobilised; nothing before φ_r is, and no more than the friction angle where strength is divided by a factor.
    fn dilation_deg(&self, slip: &FacetSlip, memory: &ShearMemory) -> f64 {
        if slip.normal_n <= 0.0 {
            return 0.0;
        }
        let part = self.mobilised_part(memory.state.first().copied().unwrap_or(0.0)).max(0.0);
        let rubs_deg = (self.capacity_n(slip, memory) / slip.normal_n).atan().to_degrees();
        (part * self.roughness.dilation_deg(Self::stress_pa(slip))).min(rubs_deg)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::testing::check_friction;

    const ROUGH: Roughness = Roughness { jrc: 10.0, jcs_pa: 100e6, residual_deg: 30.0, length_m: 0.1 };

    fn pressed(stress_pa: f64, slip_m: f64) -> FacetSlip {
        let (normal_n, slip_m) = (0.5 * stress_pa, [slip_m, 0.0]);
        FacetSlip { normal_n, area_m2: 1.0, mean_area_m2: 1.0, slip_m, ..FacetSlip::default() }
    }

    #[test]
    fn it_keeps_the_contract_of_a_friction_law() {
        check_friction(&BartonBandis::new(ROUGH, 2e10));
        check_friction(&BartonBandis::new(ROUGH, 2e10).mobilised());
        check_friction(&BartonBandis::new(Roughness { jcs_pa: 1e3, ..ROUGH }, 2e10).mobilised());
    }

    #[test]
    fn both_sides_together_have_the_strength_of_barton() {
        let law = BartonBandis::new(ROUGH, 1e12);
        let expected = [0.663_771, 1.191_754, 2.143_965, 4.664_256, 8.390_996];
        for (stress_mpa, expected) in [0.5f64, 1.0, 2.0, 5.0, 10.0].into_iter().zip(expected) {
            let mut memory = ShearMemory::default();
            law.advance(&pressed(1e6 * stress_mpa, 1.0), &mut memory);
            let strength_mpa = -2e-6 * memory.shear_n[0];
            let angle = (30.0 + 10.0 * (100.0 / stress_mpa).log10()).to_radians();
            assert!((strength_mpa / (stress_mpa * angle.tan()) - 1.0).abs() < 1e-12);
            assert!((strength_mpa - expected).abs() < 5e-7, "{strength_mpa} for {expected}");
        }
    }

    #[test]
    fn dilation_is_half_of_the_roughness_angle() {
        let law = BartonBandis::new(ROUGH, 1e12);
        for (stress_pa, expected) in
            [(0.5e6, 11.505_15), (1e6, 10.0), (2e6, 8.494_85), (5e6, 6.505_15), (10e6, 5.0)]
        {
            let found = law.dilation_deg(&pressed(stress_pa, 0.0), &ShearMemory::default());
            assert!((found - expected).abs() < 1e-5, "{found} for {expected}");
        }
    }

    #[test]
    fn the_tangent_is_a_mohr_coulomb_law_with_the_same_strength_and_slope() {
        let (friction_deg, cohesion_pa) = ROUGH.tangent(1e6);
        assert!((friction_deg - 45.2368).abs() < 5e-5, "{friction_deg}");
        assert!((cohesion_pa - 183_454.0).abs() < 0.5, "{cohesion_pa}");
        let slope = (ROUGH.strength_pa(1e6 + 10.0) - ROUGH.strength_pa(1e6 - 10.0)) / 20.0;
        assert!((slope - friction_deg.to_radians().tan()).abs() < 1e-8);
    }

    #[test]
    fn longer_joints_are_smoother_and_slip_farther() {
        let long = ROUGH.of_length(2.0);
        assert!((long.jrc - 5.4928).abs() < 5e-5 && (long.jcs_pa - 40.709e6).abs() < 500.0, "{long:?}");
        assert!((1e3 * ROUGH.peak_slip_m() - 0.9142).abs() < 5e-5);
        assert!((1e3 * long.peak_slip_m() - 5.5828).abs() < 5e-5);
    }

    #[test]
    fn the_total_angle_is_at_most_70_degrees_and_walls_that_crush_have_the_residual_one() {
        let rough = Roughness { jrc: 20.0, ..ROUGH };
        assert!((rough.strength_pa(10.0) / 10.0 - 70f64.to_radians().tan()).abs() < 1e-12);
        assert!((rough.strength_pa(1e9) / 1e9 - 30f64.to_radians().tan()).abs() < 1e-12);
        assert_eq!(rough.strength_pa(0.0), 0.0);
        assert_eq!(rough.tangent(10.0).0.round(), 70.0);
    }

    /// Along the table of Barton: 0, φ_r, φ_r + ¾ i, φ_r + i, and down again, whatever the step.
    #[test]
    fn mobilised_roughness_follows_its_curve_over_plastic_slip_whatever_the_step() {
        let law = BartonBandis::new(ROUGH, 1e12).mobilised();
        let peak_m = ROUGH.peak_slip_m();
        for [slip, part] in MOBILISED {
            let angle = (30.0 + part * 20.0f64).to_radians();
            let strength_pa = 1e6 * angle.tan();
            let end_m = slip * peak_m + strength_pa / 1e12;
            let ends = [1, 7, 1000].map(|steps| {
                let mut state = [0.0];
                let mut memory = ShearMemory { state: &mut state, ..ShearMemory::default() };
                (0..steps).for_each(|_| law.advance(&pressed(1e6, end_m / f64::from(steps)), &mut memory));
                (-2.0 * memory.shear_n[0], memory.state[0])
            });
            for (strength, plastic_m) in ends {
                assert!((strength / strength_pa - 1.0).abs() < 1e-9, "{slip}: {strength} for {strength_pa}");
                assert!((plastic_m / (slip * peak_m) - 1.0).abs() < 1e-9, "{slip}: {plastic_m}");
            }
        }
    }

    #[test]
    fn a_reduced_strength_is_the_strength_over_the_factor() {
        let whole = BartonBandis::new(ROUGH, 1e12);
        let (all, half) = (whole.strength_n(&pressed(1e6, 0.0), 0.0), whole.reduced_by(2.0));
        assert!((2.0 * half.strength_n(&pressed(1e6, 0.0), 0.0) / all - 1.0).abs() < 1e-14);
    }
}
