//! How bonds break gradually.

/// How the stress that a bond carries falls while it opens and slips.
///
/// With the opening δ_n (not below zero) and the slip δ_s, the stresses (1 − D) k δ_n and (1 − D) k δ_s fall linearly with δ = √(δ_n² + δ_s²) at a constant ratio
/// of both, from where (σ/f_t)² + (τ/c)² = 1 to where (δ_n/δ_nc)² + (δ_s/δ_sc)² = 1, δ_nc = 2 G_I/f_t and δ_sc = 2 G_II/c:
///
/// ```text
/// D = δ_c (δ − δ_0) / (δ (δ_c − δ_0))
/// ```
///
/// The damage D never heals. In pure tension a bond takes the work G_I, in pure shear G_II per area, whatever its stiffness k.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fracture {
    /// Stiffness k of an unbroken bond [Pa/m].
    pub stiffness_pa_m: f64,
    /// Tensile strength f_t and shear strength c without normal stress [Pa].
    pub strength_pa: [f64; 2],
    /// Fracture energies G_I and G_II [J/m²].
    pub energy_j_m2: [f64; 2],
}

impl Fracture {
    /// δ_nc and δ_sc, where nothing is carried any more [m].
    pub fn last_m(&self) -> [f64; 2] {
        [0, 1].map(|k| 2.0 * self.energy_j_m2[k] / self.strength_pa[k])
    }

    /// √((σ/f_t)² + (τ/c)²) of a whole bond at an opening and a slip [m]: it is damaged from 1 on.
    pub fn load(&self, opening_m: f64, slip_m: f64) -> f64 {
        part(opening_m, slip_m, self.strength_pa.map(|strength| strength / self.stiffness_pa_m))
    }

    /// Damage by an opening and a slip [m], reached for the first time: 0 for a whole bond, 1 for a broken one.
    pub fn damage(&self, opening_m: f64, slip_m: f64) -> f64 {
        let (first, last) = (self.load(opening_m, slip_m), part(opening_m, slip_m, self.last_m()));
        if first <= 1.0 {
            return 0.0;
        }
        if last >= 1.0 {
            return 1.0;
        }
        // δ_0 = δ/first and δ_c = δ/last.
        ((1.0 - 1.0 / first) / (1.0 - last / first)).clamp(0.0, 1.0)
    }

    /// By how much a bond that is being damaged at an opening and a slip [m] gives more along its own direction than what is whole of it, over k:
    /// δ_0 δ_c/(δ (δ_c − δ_0)); zero for a whole bond and a broken one. Its stress then falls by k δ_0/(δ_c − δ_0) per length.
    pub(crate) fn softening(&self, opening_m: f64, slip_m: f64) -> f64 {
        let (first, last) = (self.load(opening_m, slip_m), part(opening_m, slip_m, self.last_m()));
        if first > 1.0 && last < 1.0 { 1.0 / (first - last) } else { 0.0 }
    }
}

/// Part of the way to an ellipse with these half axes, along the ratio of opening to slip.
fn part(opening_m: f64, slip_m: f64, axes_m: [f64; 2]) -> f64 {
    (opening_m.max(0.0) / axes_m[0]).hypot(slip_m / axes_m[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    const BAR: Fracture =
        Fracture { stiffness_pa_m: 1e13, strength_pa: [3e6, 5e6], energy_j_m2: [100.0, 400.0] };

    /// Work ∫ σ dδ from nothing to the end, at a ratio of opening to slip, by the midpoint rule.
    fn work_j_m2(fracture: &Fracture, ratio: [f64; 2]) -> f64 {
        let steps = 1_000_000;
        let end_m = fracture.last_m()[0].max(fracture.last_m()[1]);
        let step_m = end_m / f64::from(steps);
        let stress = |k: u32| {
            let at_m = ratio.map(|part| part * (f64::from(k) + 0.5) * step_m);
            let damage = fracture.damage(at_m[0], at_m[1]);
            (1.0 - damage) * fracture.stiffness_pa_m * (at_m[0] * ratio[0] + at_m[1] * ratio[1])
        };
        (0..steps).map(stress).sum::<f64>() * step_m
    }

    #[test]
    fn breaking_takes_the_fracture_energy_whatever_the_stiffness() {
        for stiffness_pa_m in [1e12, 1e13, 1e14] {
            let fracture = Fracture { stiffness_pa_m, ..BAR };
            assert!((work_j_m2(&fracture, [1.0, 0.0]) / 100.0 - 1.0).abs() < 1e-4);
            assert!((work_j_m2(&fracture, [0.0, 1.0]) / 400.0 - 1.0).abs() < 1e-4);
        }
    }

    #[test]
    fn a_bond_is_whole_until_its_strength_and_broken_on_the_ellipse() {
        let [normal_m, shear_m] = BAR.last_m();
        assert!((normal_m - 66.667e-6).abs() < 1e-9, "{normal_m}");
        for angle in [0.0f64, 0.3, 0.8, 1.2] {
            let (cosine, sine) = (angle.cos(), angle.sin());
            let onset = |part: f64| BAR.damage(part * cosine * 3e6 / 1e13, part * sine * 5e6 / 1e13);
            assert!(onset(0.999) == 0.0 && onset(1.001) > 0.0);
            let end = |part: f64| BAR.damage(part * cosine * normal_m, part * sine * shear_m);
            assert!(end(0.999) < 1.0 && end(1.0 + 1e-12) == 1.0);
        }
        // Pressed bonds break by slip alone.
        assert_eq!(BAR.damage(-1.0, 0.0), 0.0);
        assert_eq!(BAR.damage(-1.0, shear_m), BAR.damage(0.0, shear_m));
    }

    #[test]
    fn a_bond_that_is_being_damaged_gives_as_its_stress_changes() {
        for angle in [0.0f64, 0.3, 0.8, 1.5] {
            let stress = |way_m: f64| {
                let [opening_m, slip_m] = [way_m * angle.cos(), way_m * angle.sin()];
                (1.0 - BAR.damage(opening_m, slip_m)) * way_m
            };
            for way_m in [1e-6, 5e-6, 3e-5] {
                let [opening_m, slip_m] = [way_m * angle.cos(), way_m * angle.sin()];
                let step_m = 1e-6 * way_m;
                let slope = (stress(way_m + step_m) - stress(way_m - step_m)) / (2.0 * step_m);
                let given = 1.0 - BAR.damage(opening_m, slip_m) - BAR.softening(opening_m, slip_m);
                assert!((slope / given - 1.0).abs() < 1e-6, "{angle}, {way_m:e}: {slope:e} and {given:e}");
            }
        }
        assert_eq!([BAR.softening(1e-9, 0.0), BAR.softening(1.0, 0.0)], [0.0; 2]);
    }

    /// A bar of 0.1 m, E 30 GPa with one bond across: u = σ (L/E + 1/k) + w, σ = f_t (1 − w/δ_nc), so that σ = 1.411765 MPa at 40 µm where k is large.
    #[test]
    fn a_bar_with_one_bond_across_softens_as_its_closed_form() {
        for (stiffness_pa_m, printed_mpa) in [(1e13, None), (1e18, Some(1.411_765))] {
            let bond = Fracture { stiffness_pa_m, ..BAR };
            let stress_pa = |opening_m: f64| (1.0 - bond.damage(opening_m, 0.0)) * stiffness_pa_m * opening_m;
            let ends_m = |opening_m: f64| stress_pa(opening_m) * 0.1 / 30e9 + opening_m;
            // The opening with which the ends are 40 µm apart, by halving on the branch that falls.
            let (mut low, mut high) = (3e6 / stiffness_pa_m, 66.6e-6);
            for _ in 0..100 {
                let middle = 0.5 * (low + high);
                if ends_m(middle) < 40e-6 { low = middle } else { high = middle }
            }
            let last_m = bond.last_m()[0];
            let exact_pa = (last_m - 40e-6) / (last_m / 3e6 - 0.1 / 30e9 - 1.0 / stiffness_pa_m);
            assert!((stress_pa(low) / exact_pa - 1.0).abs() < 1e-6, "{} for {exact_pa}", stress_pa(low));
            if let Some(printed_mpa) = printed_mpa {
                assert!((1e-6 * stress_pa(low) - printed_mpa).abs() < 2e-6, "{}", stress_pa(low));
            }
        }
    }
}
