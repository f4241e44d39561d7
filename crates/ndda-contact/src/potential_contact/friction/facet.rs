//! One facet: normal force, slip and friction.

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockSet, TetId, TriangleId, Vec3};

use crate::assembly::couples::CoupleScene;
use crate::friction::bonds_of_facet::{self, Key};
use crate::friction::law::{FacetSlip, FrictionLaw, ShearMemory, capped, facet_basis, length};
use crate::friction::law_table::{FrictionLawTable, Memory};
use crate::friction::twist::{Twist, radius2_m2};
use crate::integration::overlap_pair::{ActiveFacet, FacetMoments, OverlapPair};
use crate::model::{ContactHistory, ContactInput, FacetMemory, SpringSlip};

/// A facet sticks while its friction is below this part of its strength.
pub(crate) const STICKS: f64 = 1.0 - 1e-9;

/// Places on either side at which a facet is looked for first.
const NEAR: usize = 8;

/// The forces of one facet per unit of ∫ φ N dA.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FacetForce {
    /// −k n: what the facet's normal force is made of [Pa].
    pub push: Vec3,
    /// Friction per unit of ∫ φ dA [Pa], or per unit of ∫ |∂φ/∂n| dA [N/m] where `shear_by_area` is set.
    pub shear: Vec3,
    /// Whether friction is spread in proportion to |∂φ/∂n| dA, not to the pressure.
    pub shear_by_area: bool,
    /// Torque of friction at the centre of pressure about the normal of the facet, or of its patch where friction acts on faces; `shear` does not have it
    /// [N m].
    pub couple_n_m: f64,
    /// ½ k_s S / ∫ φ dA: what a shift of the facet adds to `shear` [Pa/m].
    pub shear_slope: f64,
    /// Whether its friction is below what it may be.
    pub sticks: bool,
    /// Whether there is a force at all.
    pub touches: bool,
    /// Centre of pressure [m].
    pub center: Vec3,
    /// Its number among [`Candidates::facets`](crate::broad_phase::Candidates::facets).
    pub facet: u32,
}

/// Results of a friction law on a facet, besides its force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct FacetOutcome {
    /// Slip and work of the shear spring in the step, where there is one.
    pub spring: Option<SpringSlip>,
    /// Shear for the next step; none without friction or contact.
    pub memory: Option<KeptShear>,
    /// Energy that contact has taken up because the facet was moved out since it was clipped last [J].
    pub dilation_work_j: f64,
}

/// Shear of a facet, from which the next step goes on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct KeptShear {
    /// Shear force in the facet's basis [N].
    pub shear_n: [f64; 2],
    /// Torque about its normal [N m].
    pub twist_n_m: f64,
    /// Whether cohesion is gone.
    pub broken: bool,
}

/// Input of the evaluation of a facet.
#[derive(Clone, Copy)]
pub(crate) struct FacetScene<'a> {
    /// Blocks and their motion.
    pub input: &'a ContactInput<'a>,
    /// Friction, if there is any.
    pub joints: Option<&'a FrictionLawTable>,
    /// Memory of the last step.
    pub history: &'a ContactHistory,
    /// Normal penalty of contact without damping [Pa].
    pub elastic_pa: f64,
    /// Where couples act, for springs that bear torques.
    pub couples: Option<CoupleScene<'a>>,
}

/// Place of a facet among those remembered, which are in the order of their keys: mostly about where it is among those that touch now.
fn place_of(facets: &[FacetMemory], wanted: &Key, expected: usize) -> Option<usize> {
    let start = expected.saturating_sub(NEAR).min(facets.len());
    let near = &facets[start..(start + 2 * NEAR).min(facets.len())];
    match near {
        [first, .., last] if first.key() <= *wanted && *wanted <= last.key() => {
            near.binary_search_by_key(wanted, FacetMemory::key).ok().map(|place| start + place)
        }
        _ => facets.binary_search_by_key(wanted, FacetMemory::key).ok(),
    }
}

impl FacetForce {
    /// The shares of nodes in friction, out of theirs in ∫ φ dA and in ∫ |∂φ/∂n| dA.
    pub(crate) fn friction_shares<'a, const N: usize>(
        &self,
        pressure: &'a [f64; N],
        slope: &'a [f64; N],
    ) -> &'a [f64; N] {
        if self.shear_by_area { slope } else { pressure }
    }

    /// Friction on the facet [N].
    pub(crate) fn friction_n(&self, sums: &FacetMoments) -> Vec3 {
        sums.friction_weight(self.shear_by_area) * self.shear
    }

    /// Moment of friction about the centre of pressure: of that which is spread by area and acts beside it [N m].
    pub(crate) fn moment_of_friction(
        &self,
        sums: &FacetMoments,
        input: &ContactInput,
        triangle: TriangleId,
    ) -> Vec3 {
        if !self.shear_by_area {
            return Vec3::zeros();
        }
        let corners = input.blocks.triangle_corners(triangle, input.position);
        let center = sums.center_of_area(&corners).unwrap_or(self.center);
        (center - self.center).cross(&self.friction_n(sums))
    }
}

impl FacetScene<'_> {
    /// Normal force −k n ∫ φ dA and friction of one facet.
    #[inline]
    pub(crate) fn force(
        &self,
        touch: &ActiveFacet,
        hits: &[OverlapPair],
        sums: &FacetMoments,
        (number, penalty_pa, dashpot_n): (usize, f64, Option<&Vec3>),
        (outcome, state): (Option<&mut FacetOutcome>, &mut [f64]),
    ) -> FacetForce {
        let mut force = FacetForce { facet: touch.facet, ..FacetForce::default() };
        if sums.pressure <= 0.0 {
            return force;
        }
        let corners = self.input.blocks.triangle_corners(touch.triangle, self.input.position);
        let normal = triangle_area_vector(&corners).normalize();
        (force.push, force.touches) = (-penalty_pa * normal, true);
        force.center = sums.center(&corners);
        if let Some(joints) = self.joints {
            self.add_friction(
                joints,
                touch,
                (hits, sums),
                (penalty_pa, dashpot_n, (&corners, &normal)),
                (&mut force, outcome, state),
                number,
            );
        }
        force
    }

    /// Friction by the law of the facet, if it acts on facets; apart, so that it is no weight on scenes without.
    #[inline(never)]
    fn add_friction(
        &self,
        joints: &FrictionLawTable,
        touch: &ActiveFacet,
        (hits, sums): (&[OverlapPair], &FacetMoments),
        (penalty_pa, dashpot_n, (corners, normal)): (f64, Option<&Vec3>, (&[Vec3; 3], &Vec3)),
        (force, outcome, state): (&mut FacetForce, Option<&mut FacetOutcome>, &mut [f64]),
        number: usize,
    ) {
        let law = joints.law(self.input.blocks, touch.triangle, touch.target);
        let Some((law, outcome)) = law.filter(|law| !law.acts_on_faces()).zip(outcome) else { return };
        let basis = facet_basis(corners, normal);
        let state = &mut state[..law.state_len()];
        let key = (touch.triangle, touch.target, element_of(self.joints, hits));
        let (mut memory, twist_n_m, last_area_m2) = self.remembered((key, number), sums, (law, state));
        let bonds = &self.history.bonds;
        let bonded = !bonds.is_empty();
        let broken = bonded
            .then(|| bonds_of_facet::broken_part(bonds, self.input.blocks, joints.memory, key))
            .flatten();
        if broken == Some(0.0) {
            // The bond carries the shear.
            let kept = KeptShear { shear_n: memory.shear_n, ..KeptShear::default() };
            (force.sticks, outcome.memory) = (true, Some(kept));
            return;
        }
        let mut slip = self.slip(touch, (hits, sums), &basis, penalty_pa);
        slip.mean_area_m2 = 0.5 * (last_area_m2 + sums.area);
        if broken.is_some() && law.fracture().is_none() {
            let touches = (&sums.weights, sums.area, triangle_area_vector(corners).norm());
            let [pressure, area_m2] =
                bonds_of_facet::left_to_friction(bonds, (self.input.blocks, joints.memory, key), touches);
            slip = FacetSlip { normal_n: penalty_pa * pressure, area_m2, mean_area_m2: area_m2, ..slip };
        } else if let Some(part) = broken {
            slip = slip.of_part(part);
        }
        if law.dilates() {
            let [last_m, now_m] = law.openings_m(memory.state);
            // Force times way, as the push of the step does its work on blocks.
            outcome.dilation_work_j = self.elastic_pa * sums.pressure * (now_m - last_m);
        }
        let last = (memory.shear_n, twist_n_m);
        law.advance(&slip, &mut memory);
        let capacity_n = law.capacity_n(&slip, &memory);
        let mut size_n = length(memory.shear_n);
        let mut left_n = capacity_n;
        if let Some(twist) = self.twist(law, touch, (&slip, last, capacity_n), (normal, &force.center)) {
            (force.couple_n_m, memory.shear_n) = twist.bear(memory.shear_n);
            size_n = twist.size_n(memory.shear_n, force.couple_n_m);
            left_n = twist.left_n(force.couple_n_m);
        }
        force.sticks = size_n < STICKS * capacity_n;
        // With a dashpot, both together bear no more than the law.
        let beside = |n: &Vec3| capped([0, 1].map(|i| memory.shear_n[i] + basis[i].dot(n)), left_n).0;
        let shear_n = dashpot_n.map_or(memory.shear_n, beside);
        force.shear = (basis[0] * shear_n[0] + basis[1] * shear_n[1]) / sums.pressure;
        force.shear_slope = 0.5 * law.shear_stiffness_pa_m() * slip.area_m2 / sums.pressure;
        if force.shear_slope > 0.0 {
            let slip_m = basis[0] * slip.slip_m[0] + basis[1] * slip.slip_m[1];
            outcome.spring = Some(SpringSlip { capacity_n, shear_n: size_n, slip_m, slides: !force.sticks });
        }
        let ShearMemory { shear_n, broken, .. } = memory;
        outcome.memory = Some(KeptShear { shear_n, twist_n_m: force.couple_n_m, broken });
    }

    /// How a facet on a shear spring turns on its target; none without a spring, and where memory belongs to elements, as in the paper.
    fn twist(
        &self,
        law: &dyn FrictionLaw,
        touch: &ActiveFacet,
        (slip, last, capacity_n): (&FacetSlip, ([f64; 2], f64), f64),
        (normal, center): (&Vec3, &Vec3),
    ) -> Option<Twist> {
        let stiffness_pa_m = law.shear_stiffness_pa_m();
        let couples = self.couples.as_ref().filter(|_| stiffness_pa_m > 0.0 && slip.area_m2 > 0.0)?;
        let (velocity, mut spin_rad_s) = (self.input.velocity, 0.0);
        for (is_owner, axis) in [(true, *normal), (false, -normal)] {
            couples
                .each_force(touch, is_owner, &axis, |node, force| spin_rad_s += force.dot(&velocity[node]));
        }
        Some(Twist {
            spring_n_m: 0.5 * stiffness_pa_m * slip.mean_area_m2,
            radius2_m2: radius2_m2(couples, self.input, touch, (slip.area_m2, center)),
            turn_rad: slip.dt_s * spin_rad_s,
            last,
            slip_m: slip.slip_m,
            capacity_n,
        })
    }

    fn slip(
        &self,
        touch: &ActiveFacet,
        (hits, sums): (&[OverlapPair], &FacetMoments),
        basis: &[Vec3; 2],
        penalty_pa: f64,
    ) -> FacetSlip {
        let in_basis = |v: &Vec3| [v.dot(&basis[0]), v.dot(&basis[1])];
        let velocity = relative_velocity(touch, (hits, sums), self.input) / sums.pressure;
        FacetSlip {
            normal_n: penalty_pa * sums.pressure,
            area_m2: sums.area,
            mean_area_m2: sums.area,
            dt_s: self.input.dt_s,
            slip_m: in_basis(&(self.input.dt_s * velocity)),
            stopping_n: [0.0; 2],
        }
    }

    /// History of the facet on its target, its torque [N m], and the area of the last step; none when they did not touch before.
    fn remembered<'a>(
        &self,
        (wanted, number): (Key, usize),
        sums: &FacetMoments,
        (law, state): (&dyn FrictionLaw, &'a mut [f64]),
    ) -> (ShearMemory<'a>, f64, f64) {
        match place_of(&self.history.facets, &wanted, number) {
            Some(place) => {
                let FacetMemory { shear_n, twist_n_m, broken, area_m2, .. } = self.history.facets[place];
                state.copy_from_slice(&self.history.state_of(place)[..state.len()]);
                (ShearMemory { shear_n, broken, state }, twist_n_m, area_m2)
            }
            // Facets that touch from the start count as having touched before.
            None => {
                law.begin(state);
                let area_m2 = if self.history.begun { 0.0 } else { sums.area };
                (ShearMemory { state, ..ShearMemory::default() }, 0.0, area_m2)
            }
        }
    }
}

/// The element that memory belongs to, if it belongs to one: then all hits of a facet are in that.
pub(crate) fn element_of(joints: Option<&FrictionLawTable>, hits: &[OverlapPair]) -> Option<TetId> {
    let per_element = joints.is_some_and(|joints| joints.memory == Memory::Element);
    per_element.then(|| hits[0].tet)
}

/// ∫ φ (v_contactor − v_target) dA: slip velocity at the centre of pressure, times the pressure.
pub(crate) fn relative_velocity(
    touch: &ActiveFacet,
    found: (&[OverlapPair], &FacetMoments),
    input: &ContactInput,
) -> Vec3 {
    relative_motion(touch, found, (input.blocks, input.velocity))
}

/// Relative motion of any vectors per node.
pub(crate) fn relative_motion(
    touch: &ActiveFacet,
    (hits, sums): (&[OverlapPair], &FacetMoments),
    (blocks, velocity): (&BlockSet, &[Vec3]),
) -> Vec3 {
    let triangle = &blocks.triangles[touch.triangle.index()];
    let mut sum: Vec3 = triangle.iter().zip(sums.weights).map(|(node, w)| w * velocity[node.index()]).sum();
    for hit in hits {
        let tet = &blocks.tets[hit.tet.index()];
        for (node, w) in tet.iter().zip(hit.on_target.pressure) {
            sum -= w * velocity[node.index()];
        }
    }
    sum
}
