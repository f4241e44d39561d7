//! Bonds that break gradually, by prescribed motion: two plates of a square metre, bonded over unlike meshes, are pulled apart, turned and sheared.

use ndda_contact::testing::{evaluate, test_box, test_set};
use ndda_contact::{
    ContactHistory, ContactInput, ContactModel, Fracture, PotentialContact, SmoothPotential, SofteningBond,
};
use ndda_mesh::{BlockId, BlockSet, Mat3, Vec3};

const PENALTY_PA: f64 = 1e12;
const FRACTURE: Fracture =
    Fracture { stiffness_pa_m: 1e12, strength_pa: [1e6, 2e6], energy_j_m2: [100.0, 400.0] };
const FRICTION_DEG: f64 = 30.0;

struct Plates {
    blocks: BlockSet,
    model: PotentialContact,
    history: ContactHistory,
    last: Vec<Vec3>,
    friction: Vec<Vec3>,
    /// Work of bonds and friction so far [J], by the trapezoidal rule.
    work_j: f64,
}

impl Plates {
    /// `cells` of the upper plate along both sides.
    fn new(cells: [u32; 2]) -> Self {
        let lower = test_box([0.0; 3], [1.0, 1.0, 0.1], [3, 2, 1]);
        let upper = test_box([0.0, 0.0, 0.1], [1.0, 1.0, 0.1], [cells[0], cells[1], 1]);
        let blocks = test_set(vec![lower, upper]);
        let model = PotentialContact::new(PENALTY_PA)
            .with_potential(Box::new(SmoothPotential { reference_m: 1.0 }))
            .with_friction(Box::new(SofteningBond::new(FRICTION_DEG, FRACTURE)));
        let (last, none) = (blocks.rest_position.clone(), vec![Vec3::zeros(); blocks.rest_position.len()]);
        let history = ContactHistory::default();
        let mut plates = Self { blocks, model, history, last, friction: none, work_j: 0.0 };
        plates.moved(|x| x);
        plates
    }

    /// Force on the upper plate and its torque about the middle of the joint, with the upper plate moved so.
    fn moved(&mut self, motion: impl Fn(Vec3) -> Vec3) -> [Vec3; 2] {
        let mut position = self.blocks.rest_position.clone();
        let upper = self.blocks.nodes_of(BlockId(1));
        position[upper.clone()].iter_mut().for_each(|x| *x = motion(*x));
        let velocity: Vec<Vec3> = position.iter().zip(&self.last).map(|(x, old)| x - old).collect();
        let input = ContactInput::new(&self.blocks, &position, &velocity, 1.0);
        let answer = evaluate(&mut self.model, &input, &mut self.history);
        let pairs = answer.friction_force.iter().zip(&self.friction).zip(&velocity);
        self.work_j += pairs.map(|((new, old), moved)| 0.5 * (new + old).dot(moved)).sum::<f64>();
        let scale: f64 = answer.force.iter().map(|f| f.norm()).sum();
        assert!(answer.force.iter().sum::<Vec3>().norm() <= 1e-12 * scale, "action is not reaction");
        let middle = Vec3::new(0.5, 0.5, 0.1);
        let force = answer.force[upper.clone()].iter().sum();
        let torque = upper.map(|n| (position[n] - middle).cross(&answer.force[n])).sum();
        (self.last, self.friction) = (position, answer.friction_force);
        [force, torque]
    }

    fn shifted(&mut self, shift: Vec3) -> Vec3 {
        self.moved(|x| x + shift)[0]
    }
}

#[test]
fn pulling_a_joint_apart_takes_its_fracture_energy_whatever_its_mesh() {
    let [last_m, _] = FRACTURE.last_m();
    for cells in [[1, 1], [2, 2], [4, 1]] {
        let mut plates = Plates::new(cells);
        let steps = 4000;
        let mut most_pa = 0.0f64;
        for k in 1..=steps {
            let opening_m = 1.01 * last_m * f64::from(k) / f64::from(steps);
            let stress_pa = -plates.shifted(opening_m * Vec3::z()).z;
            let expected_pa = (1.0 - FRACTURE.damage(opening_m, 0.0)) * FRACTURE.stiffness_pa_m * opening_m;
            assert!((stress_pa - expected_pa).abs() <= 1e-6 * 1e6, "{stress_pa:e} for {expected_pa:e}");
            most_pa = most_pa.max(stress_pa);
        }
        assert!((most_pa / 1e6 - 1.0).abs() < 1e-2, "{most_pa:e}");
        assert!((plates.work_j / -100.0 - 1.0).abs() < 1e-3, "{} J", plates.work_j);
        assert!(plates.history.bonds.is_empty());
        assert_eq!(plates.shifted(1e-6 * Vec3::z()), Vec3::zeros(), "what is broken stays so");
    }
}

#[test]
fn a_joint_that_is_half_broken_unloads_to_its_start_and_takes_no_more_work() {
    let mut plates = Plates::new([2, 2]);
    let steps = 500;
    let mut work_j = [0.0; 3];
    for (way, work) in [[0.0, 1.0], [1.0, 0.0], [0.0, 1.0]].into_iter().zip(&mut work_j) {
        for k in 0..=steps {
            let part = f64::from(k) / f64::from(steps);
            plates.shifted(100e-6 * (way[0] + part * (way[1] - way[0])) * Vec3::z());
        }
        *work = plates.work_j;
    }
    let stored_j = 0.5 * 1e12 * (1.0 - FRACTURE.damage(100e-6, 0.0)) * 100e-6 * 100e-6;
    assert!((work_j[1] - work_j[0] - stored_j).abs() < 1e-3 * stored_j, "{work_j:?}, {stored_j}");
    assert!((work_j[2] - work_j[0]).abs() < 1e-3 * stored_j, "{work_j:?}");
}

/// Change of the force on the upper plate per length of its shift along a direction, by the stiffness [N/m].
fn given(plates: &mut Plates, along: Vec3) -> Vec3 {
    let velocity = vec![Vec3::zeros(); plates.last.len()];
    let input = ContactInput::new(&plates.blocks, &plates.last, &velocity, 1.0);
    let mut pairs = Vec::new();
    plates.model.add_stiffness(&input, &plates.history, &mut pairs).expect("sound blocks");
    let upper = plates.blocks.nodes_of(BlockId(1));
    let (mut shift, mut change) = (velocity.clone(), velocity);
    shift[upper.clone()].fill(along);
    pairs.iter().for_each(|pair| pair.add_times(&shift, &mut change));
    change[upper].iter().sum()
}

#[test]
fn the_stiffness_of_a_bond_is_the_slope_of_its_force_while_it_is_damaged_and_while_it_unloads() {
    for direction in [Vec3::z(), Vec3::x(), Vec3::new(0.6, 0.0, 0.8)] {
        let mut plates = Plates::new([2, 2]);
        let (way_m, step_m) = (30e-6, 1e-9);
        plates.shifted(way_m * direction);
        for step_m in [step_m, -step_m] {
            let before = plates.shifted(way_m * direction);
            let stiffness = given(&mut plates, direction).dot(&direction);
            // Where damage has been reached again, what follows may be either.
            let history = plates.history.clone();
            let after = plates.shifted((way_m + step_m) * direction);
            let slope = (after - before).dot(&direction) / step_m;
            if step_m > 0.0 {
                assert!(slope > 0.0, "what is damaged bears less the farther it opens: {slope:e}");
                assert!((stiffness / slope - 1.0).abs() < 1e-3, "{direction:?}: {stiffness:e} and {slope:e}");
                plates.history = history;
            } else {
                let stiffness = given(&mut plates, direction).dot(&direction);
                assert!(slope < 0.0 && (stiffness / slope - 1.0).abs() < 1e-3, "{stiffness:e} and {slope:e}");
            }
        }
    }
}

#[test]
fn three_bonds_of_a_facet_carry_the_moment_of_a_joint() {
    let mut plates = Plates::new([2, 2]);
    // Opened all over, and turned about its middle by less than would close it.
    let (lift, turn) = (0.5e-6 * Vec3::z(), 1e-7);
    for axis in [Vec3::x(), Vec3::y()] {
        let rotation: Mat3 = *nalgebra::Rotation3::new(turn * axis).matrix();
        let middle = Vec3::new(0.5, 0.5, 0.1);
        let [force, torque] = plates.moved(|x| middle + lift + rotation * (x - middle));
        let expected = -FRACTURE.stiffness_pa_m * turn / 12.0 * axis;
        assert!((torque - expected).norm() <= 1e-5 * expected.norm(), "{torque:?} for {expected:?}");
        assert!((force.z / -0.5e6 - 1.0).abs() < 1e-5, "{force:?}");
    }
}

#[test]
fn a_pressed_joint_shears_over_its_cohesion_to_the_friction_of_what_is_broken() {
    let mut plates = Plates::new([2, 2]);
    let (stress_pa, [_, last_m]) = (1e6, FRACTURE.last_m());
    let sunk = -stress_pa / (2.0 * PENALTY_PA) * Vec3::z();
    let steps = 4000;
    let (mut most_pa, mut end_pa, mut work_j) = (0.0f64, 0.0, 0.0);
    plates.shifted(sunk);
    for k in 1..=steps {
        let slip_m = 1.2 * last_m * f64::from(k) / f64::from(steps);
        let force = plates.shifted(sunk + slip_m * Vec3::new(0.6, 0.8, 0.0));
        end_pa = force.xy().norm();
        most_pa = most_pa.max(end_pa);
        assert!(plates.work_j <= work_j + 1e-6, "friction and bonds give {} J", plates.work_j - work_j);
        work_j = plates.work_j;
    }
    let friction_pa = stress_pa * FRICTION_DEG.to_radians().tan();
    // Walls of plates that overlap by the depth press, too.
    assert!((end_pa / friction_pa - 1.0).abs() < 1e-2, "{end_pa:e} for {friction_pa:e}");
    assert!(most_pa > 2e6 && most_pa < 2e6 + friction_pa, "{most_pa:e}");
    assert!(plates.history.bonds.is_empty());
}
