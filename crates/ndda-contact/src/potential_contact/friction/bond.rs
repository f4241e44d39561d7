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
//! the half because facets of both sides carry bonds; f_n is the facet's contact force. The bond breaks for good when
//! k_b δ > σ_t or |k_s s| > max(0, c + σ tan φ). Its shear is then handed to the friction law of the facet. Where the law has a fracture energy
//! ([`Fracture`]), a facet has three bonds, each breaks gradually, and the facet's friction acts on the part of it that is broken. As shear is
//! measured from where the bond formed, it does not depend on whether the joint was open or closed on the way. Both
//! blocks feel f at the same place, so its torques balance, and its work is booked as that of friction.

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockId, BlockSet, Mat3, TetId, TriangleId, Vec3};

use crate::friction::fracture::Fracture;
use crate::friction::law::{FacetSlip, FrictionLaw, ShearMemory, facet_basis};
use crate::friction::law_table::{FrictionLawTable, Memory};
use crate::integration::integrals::Integrals;
use crate::integration::tet_frame::TetFrame;
use crate::model::{Bond, ContactHistory, ContactInput, ContactOutput, FacetContact, FacetMemory};
use crate::pair_stiffness::PairStiffness;

/// Offsets below this part of the coordinates are rounding.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Identifies a facet's contact: the triangle, the other block and, with memory per element, the element.
type Key = (TriangleId, BlockId, Option<TetId>);

/// Part of a facet's contact that no bond holds any more; none where there are no bonds.
pub(crate) fn broken_part(bonds: &[Bond], blocks: &BlockSet, memory: Memory, wanted: Key) -> Option<f64> {
    let first = bonds.partition_point(|bond| key(blocks, memory, bond) < wanted);
    let own = bonds[first..].iter().take_while(|bond| key(blocks, memory, bond) == wanted);
    let whole: f64 = own.map(|bond| (1.0 - bond.damage) * bond.part).sum();
    (whole > 0.0).then_some(1.0 - whole)
}

fn key(blocks: &BlockSet, memory: Memory, bond: &Bond) -> Key {
    let element = (memory == Memory::Element).then_some(bond.tet);
    (bond.facet, blocks.tet_block[bond.tet.index()], element)
}

/// Drops the bonds that break, and hands their shear to the friction law of their facet. Gives the largest overload of those that
/// break.
pub(crate) fn break_overloaded(
    joints: &FrictionLawTable,
    integrals: &Integrals,
    penalty_of_facet: &[f64],
    input: &ContactInput,
    (history, scratch): (&mut ContactHistory, &mut Vec<f64>),
) -> f64 {
    let mut largest = 0.0f64;
    let (blocks, touching) = (input.blocks, integrals.touching());
    let mut bonds = std::mem::take(&mut history.bonds);
    bonds.retain_mut(|bond| {
        let Some(law) = law(joints, blocks, bond) else { return false };
        if let Some(fracture) = law.fracture() {
            largest = largest.max(damage(bond, fracture, input));
            return bond.damage < 1.0;
        }
        let wanted = key(blocks, joints.memory, bond);
        let place = touching.binary_search_by_key(&wanted, |touch| {
            // With memory per element, all hits of a facet are in one.
            let element = wanted.2.map(|_| integrals.overlaps_of(touch)[0].tet);
            (touch.triangle, touch.target, element)
        });
        let pressed_n =
            place.map_or(0.0, |t| penalty_of_facet[t] * integrals.sums_of(&touching[t]).pressure.max(0.0));
        let stretch = Stretch::of(input, bond);
        let overload = stretch.overload(law, pressed_n, scratch);
        if overload <= 0.0 {
            return true;
        }
        largest = largest.max(overload);
        if place.is_ok() {
            hand_over(wanted, &stretch, law, input, history);
        }
        false
    });
    history.bonds = bonds;
    largest
}

/// Damages a bond by how far it is stretched. Gives its overload where it breaks at once.
fn damage(bond: &mut Bond, fracture: &Fracture, input: &ContactInput) -> f64 {
    let (opening_m, slip_m) = Stretch::of(input, bond).beyond_rounding_m();
    let reached = fracture.damage(opening_m, slip_m);
    let at_once = bond.damage == 0.0 && reached >= 1.0;
    bond.damage = bond.damage.max(reached);
    if at_once { fracture.load(opening_m, slip_m) - 1.0 } else { 0.0 }
}

/// Makes the shear of a bond that breaks the friction that its facet remembers; the law then limits it.
fn hand_over(
    (facet, target, element): Key,
    stretch: &Stretch,
    law: &dyn FrictionLaw,
    input: &ContactInput,
    history: &mut ContactHistory,
) {
    let basis = facet_basis(&input.blocks.triangle_corners(facet, input.position), &stretch.normal);
    let shear = stretch.shear_n(law);
    let memory = FacetMemory {
        facet,
        target,
        element,
        shear_n: [shear.dot(&basis[0]), shear.dot(&basis[1])],
        area_m2: 2.0 * stretch.half_area,
        broken: !law.survives_slip(),
    };
    let key = |known: &FacetMemory| (known.facet, known.target, known.element);
    let found = history.facets.binary_search_by_key(&(facet, target, element), key);
    let place = found.unwrap_or_else(|place| place);
    match found {
        Ok(place) => history.facets[place] = memory,
        Err(place) => history.insert(place, memory),
    };
    let state = history.state_of_mut(place);
    law.begin(&mut state[..law.state_len()]);
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

/// How a bond is deformed.
struct Stretch {
    /// The bonded point of the facet [m].
    center: Vec3,
    /// λ of that point in the target's tetrahedron.
    lambda: [f64; 4],
    /// Outward unit normal of the facet.
    normal: Vec3,
    /// Distance along it to the point that it is bonded to [m]; negative while pressed.
    opening_m: f64,
    /// Offset of that point across the normal [m].
    offset_m: Vec3,
    /// Half of the bonded area [m²].
    half_area: f64,
    /// Rounding of lengths [m].
    rounding_m: f64,
    /// Part of it that is not broken.
    whole: f64,
}

impl Stretch {
    fn of(input: &ContactInput, bond: &Bond) -> Self {
        let corners = input.blocks.triangle_corners(bond.facet, input.position);
        let tet = input.blocks.tet_corners(bond.tet, input.position);
        let anchor: Vec3 = tet.iter().zip(bond.lambda).map(|(x, l)| l * x).sum();
        let center = mean(&corners, &bond.weights);
        let area_vector = triangle_area_vector(&corners);
        let normal = area_vector.normalize();
        let stretch = anchor - center;
        let opening_m = stretch.dot(&normal);
        let largest = corners.iter().chain(&tet).map(Vec3::amax).fold(0.0, f64::max);
        Self {
            center,
            lambda: TetFrame::new(&tet).lambda_at(&center),
            normal,
            opening_m,
            offset_m: stretch - opening_m * normal,
            half_area: 0.5 * bond.share * area_vector.norm(),
            rounding_m: ROUNDING * largest,
            whole: 1.0 - bond.damage,
        }
    }

    /// Opening and slip without what may be rounding [m].
    fn beyond_rounding_m(&self) -> (f64, f64) {
        (self.opening_m - self.rounding_m, (self.offset_m.norm() - self.rounding_m).max(0.0))
    }

    /// Its direction and how much more it gives along that while it is being damaged than what is whole of it [Pa/m]; damage that depends on the ratio of opening
    /// to slip is taken as that of a constant ratio.
    fn softening(&self, fracture: &Fracture, damage: f64) -> Option<(Vec3, f64)> {
        let (opening_m, slip_m) = self.beyond_rounding_m();
        let is_loaded = damage > 0.0 && fracture.damage(opening_m, slip_m) >= damage;
        let direction = (self.opening_m.max(0.0) * self.normal + self.offset_m).try_normalize(0.0)?;
        is_loaded.then(|| (direction, fracture.stiffness_pa_m * fracture.softening(opening_m, slip_m)))
    }

    /// Tension ½ S k_b max(δ, 0) of what is not broken [N].
    fn tension_n(&self, law: &dyn FrictionLaw) -> f64 {
        self.whole * law.bond_stiffness_pa_m() * self.half_area * self.opening_m.max(0.0)
    }

    /// Shear ½ S k_s s of what is not broken on the facet [N].
    fn shear_n(&self, law: &dyn FrictionLaw) -> Vec3 {
        self.whole * law.shear_stiffness_pa_m() * self.half_area * self.offset_m
    }

    /// By how much the joint's strength is exceeded, over its strength without normal stress; not above zero while it holds:
    /// k_b δ ≤ σ_t and |k_s s| ≤ max(0, c + σ tan φ), to rounding.
    fn overload(&self, law: &dyn FrictionLaw, pressed_n: f64, state: &mut Vec<f64>) -> f64 {
        state.resize(law.state_len(), 0.0);
        law.begin(state);
        let whole = ShearMemory { broken: false, state, ..ShearMemory::default() };
        let capacity_n = |normal_n: f64| {
            let slip = FacetSlip { normal_n, area_m2: 2.0 * self.half_area, ..FacetSlip::default() };
            law.capacity_n(&slip, &whole)
        };
        let tensile_pa = law.bond_stiffness_pa_m() * (self.opening_m - self.rounding_m);
        let rounding_n = law.shear_stiffness_pa_m() * self.half_area * self.rounding_m;
        let strength_n = capacity_n(pressed_n - self.tension_n(law)) + rounding_n;
        let tensile_n = (tensile_pa - law.tension_pa()) * self.half_area;
        let excess_n = tensile_n.max(self.shear_n(law).norm() - strength_n);
        let unstressed_n = capacity_n(0.0).max(law.tension_pa() * self.half_area);
        if unstressed_n > 0.0 { excess_n / unstressed_n } else { excess_n }
    }
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

pub(crate) fn frame_of(tet: TetId, input: &ContactInput) -> TetFrame {
    TetFrame::new(&input.blocks.tet_corners(tet, input.position))
}

pub(crate) fn mean(corners: &[Vec3; 3], weights: &[f64; 3]) -> Vec3 {
    corners.iter().zip(weights).map(|(x, weight)| *weight * x).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PotentialContact;
    use crate::testing::{evaluate, test_box, test_set};

    #[test]
    fn a_bond_holds_its_tension_and_breaks_for_good() {
        let (stiffness, tension) = (1e9, 1e3);
        let law = crate::MohrCoulomb::new(30.0, stiffness, 0.0, tension);
        let mut model = PotentialContact::new(1e9).with_friction(Box::new(law));
        let lower = test_box([0.0; 3], [3.0, 3.0, 1.0], [3, 3, 1]);
        let upper = test_box([1.0, 1.0, 1.0], [1.0, 1.0, 0.5], [1, 1, 1]);
        let blocks = test_set(vec![lower, upper]);
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
}
