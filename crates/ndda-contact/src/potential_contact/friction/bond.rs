//! Bonds: facets that hold to a point of another block by cohesion and tensile strength until they break.
//!
//! A bond forms where a facet touches another block when contact is first evaluated, over the area S that touches. It
//! is a spring from the centre of that area to the point of the other block that was there: along the facet's normal n
//! while it is open, across it always; compression is the potential's. With the opening δ and the offset s across n,
//!
//! ```text
//! f = ½ S (k_b max(δ, 0) n + k_s s)        σ = (f_n − ½ S k_b max(δ, 0)) / ½ S
//! ```
//!
//! the half because facets of both sides carry bonds. A facet has three, for a third of its area each, so that they carry moments; f_n is the bond's share of the facet's
//! contact force. A bond breaks for good when k_b δ > σ_t or |k_s s| > max(0, c + σ tan φ), and its shear becomes friction of the facet, which acts on what broken bonds
//! held. Where the law says that slip leaves a tensile strength, a bond that is overloaded in shear slips instead: the point that it holds to follows the facet. Where the
//! law has a fracture energy ([`Fracture`]), bonds break gradually. As shear is
//! measured from where the bond formed, it does not depend on whether the joint was open or closed on the way. Both
//! blocks feel f at the same place, so its torques balance, and its work is booked as that of friction.

use ndda_mesh::{BlockId, BlockSet, Mat3, TetId, TriangleId, Vec3};

use crate::friction::bond_overload::{damage, overload};
use crate::friction::bonds_of_facet::{self, Key, key};
use crate::friction::law::{FrictionLaw, facet_basis};
use crate::friction::law_table::FrictionLawTable;
use crate::friction::stretch::{Stretch, set_slip};
use crate::integration::integrals::Integrals;
use crate::model::{Bond, ContactHistory, ContactInput, ContactOutput, FacetContact, FacetMemory};
use crate::pair_stiffness::PairStiffness;

/// Breaks overloaded bonds, and hands their shear to the friction law of their facet; forgets the bonds of a facet once all of them are broken. Gives the largest
/// overload of those that break. Where bonds are to hold it breaks none, and counts those that would have broken or slipped.
pub(crate) fn break_overloaded(
    joints: &FrictionLawTable,
    integrals: &Integrals,
    penalty_of_facet: &[f64],
    input: &ContactInput,
    (history, scratch): (&mut ContactHistory, &mut Vec<f64>),
) -> (f64, usize) {
    let (mut largest, mut held) = (0.0f64, 0);
    let (blocks, touching) = (input.blocks, integrals.touching());
    let mut bonds = std::mem::take(&mut history.bonds);
    let mut opened = false;
    for place in 0..bonds.len() {
        if bonds[place].damage >= 1.0 {
            continue;
        }
        let law = law(joints, blocks, &bonds[place]);
        let before = bonds[place];
        if let Some(fracture) = law.and_then(|law| law.fracture()) {
            let bond = &mut bonds[place];
            let overload = damage(bond, fracture, input);
            if input.bonds_hold {
                held += usize::from(*bond != before);
                *bond = before;
                continue;
            }
            largest = largest.max(overload);
            opened |= bond.damage >= 1.0;
            continue;
        }
        let wanted = key(blocks, joints.memory, &bonds[place]);
        let touch = integrals.place_of(&wanted);
        let pressed_n = touch.map_or(0.0, |t| {
            let weights = integrals.sums_of(&touching[t]).weights;
            let facet = (blocks, joints.memory, wanted);
            penalty_of_facet[t] * bonds_of_facet::borne(&bonds, place, facet, &weights)
        });
        let bond = &mut bonds[place];
        let found = overload(bond, law, (pressed_n, input), scratch);
        if input.bonds_hold {
            held += usize::from(found.is_some() || *bond != before);
            *bond = before;
            continue;
        }
        let Some(found) = found else { continue };
        largest = largest.max(found.overload);
        let slip_m = bond.slip_m;
        let stretch = Stretch::of(input, bond);
        bond.damage = 1.0;
        opened = true;
        if let (Some(law), true) = (law, touch.is_some()) {
            let is_broken = found.opens || !law.survives_slip();
            hand_over(wanted, (&stretch, &stretch.shear_n(law)), (law, slip_m, is_broken), input, history);
        }
    }
    if opened {
        bonds_of_facet::forget_opened(&mut bonds, blocks, joints.memory);
    }
    history.bonds = bonds;
    (largest, held)
}

/// Makes shear of a bond, which it carries no longer, a part of the friction that its facet remembers; the law then limits it, by its residual strength where the joint
/// is broken.
pub(crate) fn hand_over(
    (facet, target, element): Key,
    (stretch, shear): (&Stretch, &Vec3),
    (law, slip_m, is_broken): (&dyn FrictionLaw, f64, bool),
    input: &ContactInput,
    history: &mut ContactHistory,
) {
    let basis = facet_basis(&input.blocks.triangle_corners(facet, input.position), &stretch.normal);
    let memory = FacetMemory {
        twist_n_m: 0.0,
        facet,
        target,
        element,
        shear_n: [shear.dot(&basis[0]), shear.dot(&basis[1])],
        area_m2: 2.0 * stretch.half_area,
        broken: is_broken,
    };
    let found = history.find(&(facet, target, element));
    let place = found.unwrap_or_else(|place| place);
    match found {
        // Beside bonds that hold, some of the facet may be left to friction already.
        Ok(place) => {
            let known = &mut history.facets[place];
            known.shear_n = [0, 1].map(|i| known.shear_n[i] + memory.shear_n[i]);
            known.broken |= memory.broken;
        }
        Err(place) => {
            history.insert(place, memory);
            law.begin(&mut history.state_of_mut(place)[..law.state_len()]);
        }
    };
    set_slip(law, &mut history.state_of_mut(place)[..law.state_len()], slip_m);
}

/// Force of an unbroken bond on its facet; its target feels the opposite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BondForce {
    facet: TriangleId,
    tet: TetId,
    /// Both blocks: that of the facet, and its target.
    pub blocks: [BlockId; 2],
    /// Shares of the nodes of the facet, and of those of the tetrahedron.
    weights: [f64; 3],
    lambda: [f64; 4],
    /// Where it acts [m].
    pub center: Vec3,
    /// Force on the facet [N].
    pub force_n: Vec3,
    /// Largest change of the force per displacement of the facet [N/m].
    stiffness_n_m: f64,
}

impl BondForce {
    /// Nodes of the facet (`k` = 0) or of the tetrahedron (1), each with its share of the force on the facet.
    pub(crate) fn shares(&self, blocks: &BlockSet, k: usize, mut add: impl FnMut(usize, f64)) {
        if k == 0 {
            let triangle = &blocks.triangles[self.facet.index()];
            triangle.iter().zip(self.weights).for_each(|(node, weight)| add(node.index(), weight));
        } else {
            let tet = &blocks.tets[self.tet.index()];
            tet.iter().zip(self.lambda).for_each(|(node, lambda)| add(node.index(), -lambda));
        }
    }
}

/// Adds the forces of unbroken bonds to a list.
pub(crate) fn find_forces(
    joints: &FrictionLawTable,
    input: &ContactInput,
    bonds: &[Bond],
    forces: &mut Vec<BondForce>,
) {
    let blocks = input.blocks;
    forces.extend(bonds.iter().filter_map(|bond| {
        let (law, stretch) = (law(joints, blocks, bond)?, Stretch::of(input, bond));
        let stiffness = law.shear_stiffness_pa_m().max(law.bond_stiffness_pa_m()) * stretch.half_area;
        Some(BondForce {
            facet: bond.facet,
            tet: bond.tet,
            blocks: [blocks.triangle_block[bond.facet.index()], blocks.tet_block[bond.tet.index()]],
            weights: bond.weights,
            lambda: stretch.lambda,
            center: stretch.center,
            force_n: stretch.tension_n(law) * stretch.normal + stretch.shear_n(law),
            stiffness_n_m: stretch.whole * stiffness,
        })
    }));
}

/// Adds the forces of bonds to the nodes.
pub(crate) fn add_forces(blocks: &BlockSet, forces: &[BondForce], output: &mut ContactOutput) {
    for bond in forces {
        let rows = 1.0 + bond.lambda.iter().map(|l| l.abs()).sum::<f64>();
        for k in 0..2 {
            bond.shares(blocks, k, |node, weight| {
                output.force[node] += weight * bond.force_n;
                output.friction_force[node] += weight * bond.force_n;
                output.stiffness[node] += rows * bond.stiffness_n_m * weight.abs();
            });
        }
    }
}

/// The law of the joint that a bond is in.
fn law<'a>(joints: &'a FrictionLawTable, blocks: &BlockSet, bond: &Bond) -> Option<&'a dyn FrictionLaw> {
    joints.law(blocks, bond.facet, blocks.tet_block[bond.tet.index()])
}

/// Adds what each bond does.
pub(crate) fn add_facets(
    joints: &FrictionLawTable,
    input: &ContactInput,
    bonds: &[Bond],
    facets: &mut Vec<FacetContact>,
) {
    let blocks = input.blocks;
    facets.extend(bonds.iter().filter_map(|bond| {
        let (law, stretch) = (law(joints, blocks, bond)?, Stretch::of(input, bond));
        Some(FacetContact {
            facet: bond.facet,
            target: blocks.tet_block[bond.tet.index()],
            area_m2: 0.0,
            normal: stretch.normal,
            center: stretch.center,
            push_n: stretch.tension_n(law) * stretch.normal,
            friction_n: stretch.shear_n(law),
            couple_n_m: Vec3::zeros(),
            sticks: true,
        })
    }));
}

/// Adds the stiffness of bonds.
pub(crate) fn add_stiffness(
    joints: &FrictionLawTable,
    input: &ContactInput,
    bonds: &[Bond],
    stiffness: &mut Vec<PairStiffness>,
) {
    let blocks = input.blocks;
    for bond in bonds {
        let (triangle, tet) = (&blocks.triangles[bond.facet.index()], &blocks.tets[bond.tet.index()]);
        let Some(law) = law(joints, blocks, bond) else { continue };
        let stretch = Stretch::of(input, bond);
        let Stretch { normal, opening_m, half_area, lambda, whole, .. } = stretch;
        let along = normal * normal.transpose();
        let normal_pa_m = if opening_m > 0.0 { law.bond_stiffness_pa_m() } else { 0.0 };
        let mut spring =
            whole * (normal_pa_m * along + law.shear_stiffness_pa_m() * (Mat3::identity() - along));
        let softening = law.fracture().and_then(|fracture| stretch.softening(fracture, bond.damage));
        if let Some((direction, pa_m)) = softening {
            spring -= pa_m * direction * direction.transpose();
        }
        let ([u, v, w], [a, b, c, d]) = (bond.weights, lambda);
        let mut pair = PairStiffness::new(triangle, tet);
        pair.add_spring(&[u, v, w, -a, -b, -c, -d], &(half_area * spring));
        stiffness.push(pair);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PotentialContact;
    use crate::testing::{evaluate, test_box, test_set};

    fn plate_on_a_slab() -> BlockSet {
        let lower = test_box([0.0; 3], [3.0, 3.0, 1.0], [3, 3, 1]);
        let upper = test_box([1.0, 1.0, 1.0], [1.0, 1.0, 0.5], [1, 1, 1]);
        test_set(vec![lower, upper])
    }

    #[test]
    fn a_bond_holds_its_tension_and_breaks_for_good() {
        let (stiffness, tension) = (1e9, 1e3);
        let law = crate::MohrCoulomb::new(30.0, stiffness, 0.0, tension);
        let mut model = PotentialContact::new(1e9).with_friction(Box::new(law));
        let blocks = plate_on_a_slab();
        let velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
        let mut history = ContactHistory::default();
        let upper = blocks.nodes_of(BlockId(1));
        let mut lifted = |gap_m: f64, history: &mut ContactHistory| -> (Vec3, f64) {
            let mut position = blocks.rest_position.clone();
            position[upper.clone()].iter_mut().for_each(|x| x.z += gap_m);
            let input = ContactInput::new(&blocks, &position, &velocity, 1e-3);
            let answer = evaluate(&mut model, &input, history);
            // The energy of a bond is counted as work of friction: from rest, −½ f·u.
            let moved = position.iter().zip(&blocks.rest_position).map(|(x, rest)| x - rest);
            let stored: f64 = answer.friction_force.iter().zip(moved).map(|(f, u)| -0.5 * f.dot(&u)).sum();
            assert!(answer.force.iter().sum::<Vec3>().norm() < 1e-9);
            (answer.force[upper.clone()].iter().sum(), stored)
        };
        lifted(0.0, &mut history);
        assert!(!history.bonds.is_empty());
        // A square metre of glue, seen by the facets of both sides.
        let gap = 0.9 * tension / stiffness;
        let (force, energy) = lifted(gap, &mut history);
        assert!((force.z / (-stiffness * gap) - 1.0).abs() < 1e-6, "{force:?}");
        assert!((energy / (0.5 * stiffness * gap * gap) - 1.0).abs() < 1e-6, "{energy}");
        assert_eq!(lifted(1.1 * tension / stiffness, &mut history), (Vec3::zeros(), 0.0));
        assert_eq!(lifted(gap, &mut history), (Vec3::zeros(), 0.0));
    }

    /// Pulled open by less than its strength, a joint slips at c − σ tan φ and holds on, also against the pull; beyond its tensile strength it opens.
    #[test]
    fn a_bond_that_slips_keeps_its_tensile_strength() {
        let (stiffness, cohesion) = (1e9, 1e4);
        let apex = cohesion / 30f64.to_radians().tan();
        let law = crate::SofteningCoulomb::new(stiffness, (30.0, cohesion), (30.0, cohesion), 0.0);
        let mut model = PotentialContact::new(1e9).with_friction(Box::new(law.with_tension(apex, apex)));
        let blocks = plate_on_a_slab();
        let velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
        let mut history = ContactHistory::default();
        let upper = blocks.nodes_of(BlockId(1));
        let mut force = |moved_m: Vec3, history: &mut ContactHistory| -> Vec3 {
            let mut position = blocks.rest_position.clone();
            position[upper.clone()].iter_mut().for_each(|x| *x += moved_m);
            let input = ContactInput::new(&blocks, &position, &velocity, 1e-3);
            evaluate(&mut model, &input, history).force[upper.clone()].iter().sum()
        };
        force(Vec3::zeros(), &mut history);
        let bonds = history.bonds.len();
        // A square metre that bears half of what it can.
        let gap = 0.5 * apex / stiffness;
        for slip in [1e-4, 2e-4] {
            let force = force(Vec3::new(slip, 0.0, gap), &mut history);
            assert!((force.x / (-0.5 * cohesion) - 1.0).abs() < 1e-6, "{force:?}");
            assert!((force.z / (-0.5 * apex) - 1.0).abs() < 1e-6, "{force:?}");
        }
        // Back by a tenth of what it was stretched by.
        let back = 2e-4 - 0.1 * 0.5 * cohesion / stiffness;
        let unloaded = force(Vec3::new(back, 0.0, gap), &mut history);
        assert!((unloaded.x / (-0.45 * cohesion) - 1.0).abs() < 1e-6, "{unloaded:?}");
        let slipped = 2e-4 - 0.5 * cohesion / stiffness;
        assert!(history.bonds.iter().all(|bond| (bond.slip_m / slipped - 1.0).abs() < 1e-6));
        assert_eq!(history.bonds.len(), bonds);
        assert_eq!(force(Vec3::new(back, 0.0, 2.1 * gap), &mut history), Vec3::zeros());
    }
}
