//! Strength of bonded joints by prescribed motion: two plates of a square metre, bonded over unlike meshes, are pulled apart
//! or pressed to a normal stress σ (compression positive) and then sheared; the largest shear force is the strength.

use std::ops::Range;

use ndda_contact::testing::{evaluate, test_box, test_set};
use ndda_contact::{
    ContactHistory, ContactInput, ContactModel, FrictionLaw, MohrCoulomb, PotentialContact, SmoothPotential,
    SofteningCoulomb,
};
use ndda_mesh::{BlockId, BlockSet, Mat3, Vec3};

const PENALTY_PA: f64 = 1e12;
const SHEAR_PA_M: f64 = 1e12;
const TENSION_PA: f64 = 1e6;
/// Part of the strength by which the shear grows from one evaluation to the next, and so what a strength is off by.
const INCREMENT: f64 = 2e-3;

struct Plates {
    blocks: BlockSet,
    model: PotentialContact,
    history: ContactHistory,
    last: Vec<Vec3>,
    friction: Vec<Vec3>,
    /// Work of bonds and friction so far [J], by the trapezoidal rule.
    work_j: f64,
    /// Overload of the bonds that broke in the last evaluation.
    overload: f64,
}

impl Plates {
    fn new(friction_deg: f64, cohesion_pa: f64) -> Self {
        Self::of(Box::new(MohrCoulomb::new(friction_deg, SHEAR_PA_M, cohesion_pa, TENSION_PA)))
    }

    fn of(law: Box<dyn FrictionLaw>) -> Self {
        let lower = test_box([0.0; 3], [1.0, 1.0, 0.1], [3, 2, 1]);
        let upper = test_box([0.0, 0.0, 0.1], [1.0, 1.0, 0.1], [2, 2, 1]);
        let blocks = test_set(vec![lower, upper]);
        let model = PotentialContact::new(PENALTY_PA)
            .with_potential(Box::new(SmoothPotential { reference_m: 1.0 }))
            .with_friction(law);
        let (last, friction) =
            (blocks.rest_position.clone(), vec![Vec3::zeros(); blocks.rest_position.len()]);
        let history = ContactHistory::default();
        let mut plates = Self { blocks, model, history, last, friction, work_j: 0.0, overload: 0.0 };
        plates.shifted(Vec3::zeros());
        plates
    }

    fn upper(&self) -> Range<usize> {
        self.blocks.nodes_of(BlockId(1))
    }

    /// Force on the upper plate, and the part of it by bonds and friction, at these places of the nodes.
    fn at(&mut self, position: Vec<Vec3>) -> (Vec3, Vec3) {
        let velocity: Vec<Vec3> = position.iter().zip(&self.last).map(|(x, old)| x - old).collect();
        let input = ContactInput::new(&self.blocks, &position, &velocity, 1.0);
        let answer = evaluate(&mut self.model, &input, &mut self.history);
        let pairs = answer.friction_force.iter().zip(&self.friction).zip(&velocity);
        self.work_j += pairs.map(|((new, old), moved)| 0.5 * (new + old).dot(moved)).sum::<f64>();
        let (sum, scale): (Vec3, f64) =
            (answer.force.iter().sum(), answer.force.iter().map(|f| f.norm()).sum());
        let torque: Vec3 = position.iter().zip(&answer.force).map(|(x, f)| x.cross(f)).sum();
        assert!(
            sum.norm() <= 1e-12 * scale && torque.norm() <= 1e-11 * scale,
            "{sum:?} {torque:?} of {scale}"
        );
        let on_upper = |forces: &[Vec3]| forces[self.upper()].iter().sum();
        let found = (on_upper(&answer.force), on_upper(&answer.friction_force));
        (self.last, self.friction) = (position, answer.friction_force);
        self.overload = answer.report.bond_overload;
        found
    }

    fn shifted(&mut self, shift: Vec3) -> (Vec3, Vec3) {
        let mut position = self.blocks.rest_position.clone();
        position[self.upper()].iter_mut().for_each(|x| *x += shift);
        self.at(position)
    }

    /// Opening of the joint at a normal stress: a bond's spring k_s in tension, 2 k_n/L₀ of both sides in compression.
    fn opening_m(sigma_pa: f64) -> f64 {
        if sigma_pa < 0.0 { -sigma_pa / SHEAR_PA_M } else { -sigma_pa / (2.0 * PENALTY_PA) }
    }
}

fn across() -> Vec3 {
    Vec3::new(0.6, 0.8, 0.0)
}

/// Largest shear stress on the way, up to one and a half times what would be enough.
fn strength_pa(friction_deg: f64, cohesion_pa: f64, sigma_pa: f64) -> f64 {
    let mut plates = Plates::new(friction_deg, cohesion_pa);
    let lifted = Plates::opening_m(sigma_pa) * Vec3::z();
    let normal_n = -plates.shifted(lifted).0.z;
    assert!(
        (normal_n + sigma_pa).abs() <= 2e-3 * sigma_pa.abs().max(cohesion_pa),
        "{normal_n} at {sigma_pa}"
    );
    let enough_pa = cohesion_pa + sigma_pa.abs();
    let slip = |k: u32| f64::from(k) * INCREMENT * cohesion_pa / SHEAR_PA_M * across();
    let last = (1.5 * enough_pa / (INCREMENT * cohesion_pa)) as u32;
    (1..=last).map(|k| plates.shifted(lifted + slip(k)).1.xy().norm()).fold(0.0, f64::max)
}

#[test]
fn shear_strength_is_that_of_mohr_and_coulomb_with_a_tension_cut_off() {
    for ratio in [0.1, 0.3, 1.0, 3.0, 10.0] {
        for friction_deg in [0.0f64, 20.0, 40.0] {
            let cohesion_pa = ratio * TENSION_PA;
            for sigma_pa in [-0.9, -0.5, -0.1]
                .map(|part| part * TENSION_PA)
                .into_iter()
                .chain([0.0, 0.5, 1.0].map(|part| part * cohesion_pa))
            {
                let expected = (cohesion_pa + sigma_pa * friction_deg.to_radians().tan()).max(0.0);
                let found = strength_pa(friction_deg, cohesion_pa, sigma_pa);
                let error = (found - expected).abs() / cohesion_pa;
                println!(
                    "c/σ_t {ratio}, φ {friction_deg}°, σ {sigma_pa:e} Pa: {found:.5e} Pa, {expected:.5e} expected"
                );
                assert!(
                    error <= 1e-2,
                    "c/σ_t {ratio}, φ {friction_deg}°, σ {sigma_pa:e}: {found:e} for {expected:e}"
                );
            }
        }
    }
}

#[test]
fn a_joint_of_friction_alone_has_no_strength_to_exceed_and_cohesion_or_tension_has() {
    for sigma_pa in [1e6, 1e3] {
        let pressed = Plates::opening_m(sigma_pa) * Vec3::z();
        let overload = |law: SofteningCoulomb, part: f64| {
            let mut plates = Plates::of(Box::new(law));
            plates.shifted(pressed);
            assert_eq!(plates.overload, 0.0);
            plates.shifted(pressed + part * sigma_pa / SHEAR_PA_M * across());
            assert!(plates.history.bonds.is_empty());
            plates.overload
        };
        let soft = |cohesion_pa| SofteningCoulomb::new(SHEAR_PA_M, (45.0, cohesion_pa), (30.0, 0.0), 1e-3);
        // Friction goes on where such a bond breaks, so that it does not matter when.
        assert_eq!(overload(soft(0.0), 3.0), 0.0);
        let found = overload(soft(sigma_pa), 2.04);
        assert!((found - 0.02).abs() < 1e-2, "{found} at {sigma_pa} Pa");
    }
    // Pulled open, it has no strength either.
    let mut plates = Plates::of(Box::new(SofteningCoulomb::new(SHEAR_PA_M, (45.0, 0.0), (30.0, 0.0), 1e-3)));
    plates.shifted(1e-6 * Vec3::z());
    assert!(plates.overload == 0.0 && plates.history.bonds.is_empty());
}

#[test]
fn the_two_cases_of_a_hanging_plate_break_at_the_cohesion() {
    for (cohesion_pa, tension_pa, pull_pa) in [(1e5, 1e6, 1e5), (1e6, 1e5, 1e4)] {
        let mut plates = Plates::new(0.0, cohesion_pa);
        let law = MohrCoulomb::new(0.0, SHEAR_PA_M, cohesion_pa, tension_pa);
        plates.model = PotentialContact::new(PENALTY_PA)
            .with_potential(Box::new(SmoothPotential { reference_m: 1.0 }))
            .with_friction(Box::new(law));
        let lifted = Plates::opening_m(-pull_pa) * Vec3::z();
        let slips = (0..1000).map(|k| 2e-3 * f64::from(k) * cohesion_pa / SHEAR_PA_M * across());
        let strength = slips.map(|slip| plates.shifted(lifted + slip).1.xy().norm()).fold(0.0, f64::max);
        assert!((strength / cohesion_pa - 1.0).abs() <= 1e-2, "{strength:e} for {cohesion_pa:e}");
    }
}

#[test]
fn tension_breaks_at_the_tensile_strength_and_shear_survives_a_change_of_sign() {
    let mut plates = Plates::new(30.0, 2.0 * TENSION_PA);
    // Sheared while pressed, then opened, closed and opened again: the shear stays what it was.
    let slip = TENSION_PA / SHEAR_PA_M * Vec3::x();
    for sigma_pa in [0.5, 0.1, -0.1, -0.5, 0.5, -0.5].map(|part| part * TENSION_PA) {
        let (total, bonds) = plates.shifted(slip + Plates::opening_m(sigma_pa) * Vec3::z());
        // Walls of plates that overlap by the depth press, too: 1e-6 of the pressure per micrometre.
        assert!(
            (bonds.x / -TENSION_PA - 1.0).abs() <= 1e-4 && bonds.y.abs() <= 1e-4 * TENSION_PA,
            "{bonds:?}"
        );
        assert!((total.z / sigma_pa - 1.0).abs() <= 2e-3, "{total:?} at {sigma_pa}");
    }
    assert!(plates.shifted(-1.01 * Plates::opening_m(TENSION_PA) * 2.0 * Vec3::z()).0 == Vec3::zeros());
    assert!(plates.history.bonds.is_empty());
    assert!(plates.work_j < 0.0, "breaking takes work: {} J", plates.work_j);
}

#[test]
fn loading_and_unloading_below_the_strength_takes_no_work_and_breaking_takes_what_was_stored() {
    let mut plates = Plates::new(20.0, TENSION_PA);
    let stretch = 0.5 * TENSION_PA / SHEAR_PA_M;
    let path = |t: f64| stretch * (t.sin() * across() + 0.5 * (1.0 - t.cos()) * Vec3::z());
    for k in 1..=400u32 {
        plates.shifted(path(f64::from(k) * std::f64::consts::TAU / 400.0));
    }
    let stored_j = 0.5 * SHEAR_PA_M * stretch * stretch;
    assert!(plates.work_j.abs() <= 1e-3 * stored_j, "{} of {stored_j} J", plates.work_j);
    let steps = 1000;
    for k in 1..=steps {
        plates.shifted(1.1 * f64::from(k) / f64::from(steps) * TENSION_PA / SHEAR_PA_M * Vec3::z());
    }
    let breaking_j = -0.5 * TENSION_PA * TENSION_PA / SHEAR_PA_M;
    assert!((plates.work_j / breaking_j - 1.0).abs() <= 5e-3, "{} for {breaking_j} J", plates.work_j);
}

#[test]
fn a_bonded_pair_that_turns_keeps_its_bonds_and_its_forces_turn_with_it() {
    let mut plates = Plates::new(20.0, TENSION_PA);
    let shift = 0.5 * TENSION_PA / SHEAR_PA_M * (Vec3::x() + Vec3::z());
    let first = plates.shifted(shift).0;
    let bonds = plates.history.bonds.len();
    let (start, upper) = (plates.blocks.rest_position.clone(), plates.upper());
    for k in 1..=90u32 {
        let turn: Mat3 =
            *nalgebra::Rotation3::new(f64::from(k).to_radians() * Vec3::new(0.6, 0.0, 0.8)).matrix();
        let moved =
            |(i, x): (usize, &Vec3)| turn * (x + if upper.contains(&i) { shift } else { Vec3::zeros() });
        let force = plates.at(start.iter().enumerate().map(moved).collect()).0;
        assert_eq!(plates.history.bonds.len(), bonds);
        // The offset of half a micrometre is known to the rounding of coordinates of a metre.
        assert!((force - turn * first).norm() <= 1e-8 * first.norm(), "{k}°: {force:?} for {first:?}");
    }
}

#[test]
fn a_bond_has_the_area_that_touches_not_that_of_the_facet() {
    // A small block at the corner of a large facet, whose centroid is elsewhere.
    let blocks = test_set(vec![
        test_box([0.0; 3], [3.0, 3.0, 1.0], [1, 1, 1]),
        test_box([0.1, 0.2, 1.0], [0.5, 0.4, 0.3], [1, 1, 1]),
    ]);
    let velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
    for affine in [&[][..], &[true, true]] {
        let law = MohrCoulomb::new(0.0, SHEAR_PA_M, TENSION_PA, TENSION_PA);
        let mut model = PotentialContact::new(PENALTY_PA)
            .with_potential(Box::new(SmoothPotential { reference_m: 1.0 }))
            .with_friction(Box::new(law));
        let mut history = ContactHistory::default();
        let input =
            |position| ContactInput { affine, ..ContactInput::new(&blocks, position, &velocity, 1.0) };
        evaluate(&mut model, &input(&blocks.rest_position), &mut history);
        let mut lifted = blocks.rest_position.clone();
        let upper = blocks.nodes_of(BlockId(1));
        lifted[upper.clone()].iter_mut().for_each(|x| x.z += 1e-7);
        let pull: Vec3 = evaluate(&mut model, &input(&lifted), &mut history).force[upper].iter().sum();
        assert!((pull.z / (-SHEAR_PA_M * 1e-7 * 0.2) - 1.0).abs() <= 1e-5, "{pull:?}");
        assert_eq!(model.energy_j(&input(&lifted), &history), Ok(0.0));
    }
}

/// A joint of 30° that loses nothing by slip and opens by 1 mm at its tensile strength, which is more than c/tan φ.
fn plastic(cohesion_pa: f64) -> Plates {
    let strength = (30.0, cohesion_pa);
    let law = SofteningCoulomb::new(SHEAR_PA_M, strength, strength, 0.0);
    Plates::of(Box::new(law.with_tension(1e9, 1e9).that_opens(1e-3)))
}

#[test]
fn a_joint_that_yields_in_tension_bears_its_apex_until_it_has_opened() {
    let mut plates = plastic(1e5);
    let apex_n = 1e5 / 30f64.to_radians().tan();
    for opening_m in [1e-5, 5e-4, 9e-4] {
        let (force, _) = plates.shifted(opening_m * Vec3::z());
        assert!((force.z / -apex_n - 1.0).abs() < 1e-6, "{force:?} at {opening_m} m");
    }
    // Closed by a tenth of what its springs are stretched by.
    let (unloaded, _) = plates.shifted((9e-4 - 0.1 * apex_n / SHEAR_PA_M) * Vec3::z());
    assert!((unloaded.z / (-0.9 * apex_n) - 1.0).abs() < 1e-6, "{unloaded:?}");
    assert_eq!(plates.shifted(2e-3 * Vec3::z()).0, Vec3::zeros());
}

/// Of a plate that is turned about its middle, a half is pressed and the other pulled open: c A + N tan φ, wherever its facets are pressed.
#[test]
fn a_face_that_yields_in_tension_bears_cohesion_everywhere_however_unevenly_it_is_pressed() {
    let cohesion_pa = 1e5;
    for (turn_rad, sunk_m) in [(2e-7, 1e-7), (1e-6, 1e-7), (4e-6, 1e-6), (4e-6, 0.0)] {
        let mut plates = plastic(cohesion_pa);
        let turned: Vec<Vec3> = (plates.blocks.rest_position.iter())
            .map(|x| Vec3::new(x.x, x.y, x.z + turn_rad * (x.x - 0.5) - sunk_m))
            .collect();
        let mut forces = Vec::new();
        for slip in 0..100 {
            let mut position = plates.blocks.rest_position.clone();
            let upper = plates.upper();
            position[upper.clone()].copy_from_slice(&turned[upper.clone()]);
            position[upper].iter_mut().for_each(|x| x.y += 1e-7 * f64::from(slip));
            forces.push(plates.at(position).0);
        }
        let [last, before] = [1, 2].map(|k| forces[forces.len() - k]);
        assert!((last - before).norm() < 1e-3 * last.norm(), "it slips: {last:?} and {before:?}");
        let strength_n = cohesion_pa + last.z * 30f64.to_radians().tan();
        assert!((-last.y / strength_n - 1.0).abs() < 1e-3, "{} and {strength_n} at {turn_rad}", -last.y);
    }
}
