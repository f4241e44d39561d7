//! What a step finds in contact, as damping sees it.

use ndda_mesh::{BlockId, Mat3, Vec3};

use crate::affine::convex_target::ConvexBlocks;
use crate::friction::bonds_of_facet;
use crate::friction::facet::relative_velocity;
use crate::friction::law::facet_basis;
use crate::friction::law_table::{FrictionLawTable, Memory};
use crate::friction::openings::Openings;
use crate::friction::patches::moments::{of_triangle, principal, second_moment_m2};
use crate::integration::integrals::Integrals;
use crate::integration::overlap_pair::ActiveFacet;
use crate::model::{Bond, ContactInput};
use crate::restitution::pair::{Point, four_points};

/// Input of the damping of a step.
#[derive(Clone, Copy)]
pub(crate) struct DampingScene<'a> {
    /// Blocks and their motion.
    pub input: &'a ContactInput<'a>,
    /// Integrals of the pairs.
    pub integrals: &'a Integrals,
    /// Blocks that are affine convex targets.
    pub hulls: &'a ConvexBlocks,
    /// By how much facets are moved out.
    pub openings: &'a Openings,
    /// Friction laws, if there are any.
    pub joints: Option<&'a FrictionLawTable>,
    /// k_n dw/dU of each touching facet [Pa].
    pub penalty_pa: &'a [f64],
    /// Stiffness per pressure of each touching facet, or none [Pa/m].
    pub curvature_pa_m: &'a [f64],
}

impl DampingScene<'_> {
    /// Centre of pressure of a facet [m].
    pub(super) fn center(&self, t: u32) -> Vec3 {
        let touch = &self.integrals.touching()[t as usize];
        let corners = self.input.blocks.triangle_corners(touch.triangle, self.input.position);
        self.integrals.sums_of(touch).center(&corners)
    }

    /// By how much the pushes of some facets, of which `points` are the points, grow with the depth along the force between the blocks [N/m]. Where the pressure grows with the
    /// overlap of the whole pair, it does with what all facets sweep along that force.
    pub(super) fn stiffness_n_m(&self, points: &[Point], push_pa: &[Vec3]) -> f64 {
        let (mut own_n_m, mut shared_n_m, mut along, mut all) = (0.0, 0.0, 0.0, 0.0);
        for four in points.chunks_exact(4) {
            let t = four[0].facet as usize;
            let sums = self.integrals.sums_of(&self.integrals.touching()[t]);
            let cosine = 4.0 * four[0].force_n / (sums.pressure * push_pa[t].norm());
            own_n_m += cosine * cosine * self.penalty_pa[t] * sums.slope.iter().sum::<f64>();
            shared_n_m += cosine * self.curvature_pa_m.get(t).copied().unwrap_or(0.0) * sums.pressure;
            along += cosine * sums.pressure;
            all += sums.pressure;
        }
        if shared_n_m > 0.0 { own_n_m + shared_n_m * along / all } else { own_n_m }
    }

    /// Stiffness of the shear spring of a facet [N/m]; zero where there is none, and where a bond bears the shear.
    pub(super) fn shear_stiffness_n_m(&self, t: u32, bonds: &[Bond]) -> f64 {
        let touch = &self.integrals.touching()[t as usize];
        let Some(joints) = self.joints else { return 0.0 };
        let Some(law) = joints.law(self.input.blocks, touch.triangle, touch.target) else { return 0.0 };
        let stiffness_n_m = 0.5 * law.shear_stiffness_pa_m() * self.integrals.sums_of(touch).area;
        if bonds.is_empty() {
            return stiffness_n_m;
        }
        let by_element = joints.memory == Memory::Element;
        let element = by_element.then(|| self.integrals.overlaps_of(touch)[0].tet);
        let key = (touch.triangle, touch.target, element);
        let broken = bonds_of_facet::broken_part(bonds, self.input.blocks, joints.memory, key);
        broken.unwrap_or(1.0) * stiffness_n_m
    }

    /// Shares of the nodes of one of both blocks in the push of a facet.
    pub(super) fn each_weight(&self, t: u32, block: BlockId, mut add: impl FnMut(usize, f64)) {
        let touch = &self.integrals.touching()[t as usize];
        let (blocks, sums) = (self.input.blocks, self.integrals.sums_of(touch));
        if touch.owner == block {
            let triangle = &blocks.triangles[touch.triangle.index()];
            triangle.iter().zip(sums.weights).for_each(|(node, w)| add(node.index(), w / sums.pressure));
            return;
        }
        for hit in self.integrals.overlaps_of(touch) {
            let tet = &blocks.tets[hit.tet.index()];
            let weights = tet.iter().zip(hit.on_target.pressure);
            weights.for_each(|(node, w)| add(node.index(), w / sums.pressure));
        }
    }

    /// Four points that stand for the pressure of a facet.
    pub(super) fn points(&self, t: u32, push_pa: &Vec3, (pair, factor): ([BlockId; 2], f64)) -> [Point; 4] {
        let touch: &ActiveFacet = &self.integrals.touching()[t as usize];
        let (overlaps, sums) = (self.integrals.overlaps_of(touch), self.integrals.sums_of(touch));
        let corners = self.input.blocks.triangle_corners(touch.triangle, self.input.position);
        let center = sums.center(&corners);
        let unit = push_pa.normalize();
        let moment = second_moment_m2((self.input, self.hulls), touch, sums.area, &center);
        let sign = if touch.owner == pair[0] { 1.0 } else { -1.0 };
        let velocity = relative_velocity(touch, (overlaps, sums), self.input) / sums.pressure;
        let bodies = self.input.bodies;
        let spin = bodies[touch.owner.index()].spin_rad_s - bodies[touch.target.index()].spin_rad_s;
        four_points(&moment, &axes_of(&moment, &corners, &-unit)).map(|arm| Point {
            facet: t,
            arm,
            x: center + arm,
            push: sign * unit,
            force_n: 0.25 * sums.pressure * push_pa.norm(),
            factor,
            velocity_m_s: sign * (velocity + spin.cross(&arm)),
            parting_m_s: unit.dot(&(velocity + spin.cross(&arm))),
            rate: 0.0,
            end: 0.0,
            free_m_s: 0.0,
            taken_n: 0.0,
        })
    }
}

/// Two unit vectors in the plane of a facet along the principal axes of its pressure or, where the pressure is alike in all directions, along those of the
/// facet. In the mirror image of a scene they are the mirror images of both.
fn axes_of(second_moment_m2: &Mat3, corners: &[Vec3; 3], normal: &Vec3) -> [Vec3; 2] {
    let basis = facet_basis(corners, normal);
    let angle = |second_moment_m2: &Mat3| principal(second_moment_m2, &basis).2;
    let found = angle(second_moment_m2).or_else(|| angle(&of_triangle(corners)));
    let (sin, cos) = found.unwrap_or(0.0).sin_cos();
    [cos * basis[0] + sin * basis[1], cos * basis[1] - sin * basis[0]]
}
