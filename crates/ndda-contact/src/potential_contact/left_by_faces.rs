//! Friction that whole faces carried, left to the facets that other laws act on from now on.

use ndda_mesh::{BlockId, BlockSet, Vec3};

use crate::contact_model::ContactModel;
use crate::friction::law::facet_basis;
use crate::friction::law_table::Memory;
use crate::model::{ContactHistory, ContactInput, FacetContact, FacetMemory};

use super::PotentialContact;

/// Cosine between normals of facets that lie in one plane.
const SAME_PLANE: f64 = 0.99;

impl PotentialContact {
    /// Makes the friction of facets whose law acted on whole faces, and does so no longer, the shear that they remember; `carried` is what each facet did under the laws of
    /// before.
    pub(super) fn take_friction_of_faces(
        &self,
        input: &ContactInput,
        (before, carried): (&dyn ContactModel, &[FacetContact]),
        history: &mut ContactHistory,
    ) {
        let blocks = input.blocks;
        // With memory per element, laws that act on faces do not say what each element bears.
        if self.joints.as_ref().is_none_or(|joints| joints.memory != Memory::Body) {
            return;
        }
        let on_faces = |model: &dyn ContactModel, contact: &FacetContact| {
            let law = model.friction_law(blocks, contact.facet, contact.target);
            law.map(|law| law.acts_on_faces())
        };
        let is_left = |contact: &&FacetContact| {
            contact.area_m2 > 0.0
                && on_faces(before, contact) == Some(true)
                && on_faces(self, contact) == Some(false)
        };
        let mut left: Vec<FacetContact> = carried.iter().filter(is_left).copied().collect();
        share_between_sides(blocks, &mut left);
        left.iter().for_each(|contact| self.remember_friction(contact, input, history));
    }

    fn remember_friction(&self, contact: &FacetContact, input: &ContactInput, history: &mut ContactHistory) {
        let FacetContact { facet, target, area_m2, normal, friction_n, .. } = *contact;
        let found = history.find(&(facet, target, None));
        let (Err(place), Some(law)) = (found, self.friction_law(input.blocks, facet, target)) else { return };
        let basis = facet_basis(&input.blocks.triangle_corners(facet, input.position), &normal);
        let shear_n = [0, 1].map(|i| friction_n.dot(&basis[i]));
        history.insert(
            place,
            FacetMemory { facet, target, element: None, shear_n, twist_n_m: 0.0, area_m2, broken: true },
        );
        law.begin(&mut history.state_of_mut(place)[..law.state_len()]);
    }
}

/// Gives both sides of a plane in which two blocks touch half of its friction where one had all of it: springs and bonds are of both sides.
fn share_between_sides(blocks: &BlockSet, contacts: &mut [FacetContact]) {
    let owner = |contact: &FacetContact| blocks.triangle_block[contact.facet.index()];
    let pair = |contact: &FacetContact| -> (BlockId, BlockId) {
        (owner(contact).min(contact.target), owner(contact).max(contact.target))
    };
    contacts.sort_by_key(pair);
    for own in contacts.chunk_by_mut(|a, b| pair(a) == pair(b)) {
        let mut rest: Vec<usize> = (0..own.len()).collect();
        while let Some(&first) = rest.first() {
            let along = own[first].normal;
            let (plane, others): (Vec<usize>, Vec<usize>) =
                rest.into_iter().partition(|&k| k == first || own[k].normal.dot(&along).abs() > SAME_PLANE);
            let (lower, upper): (Vec<usize>, Vec<usize>) =
                plane.into_iter().partition(|&k| owner(&own[k]) < own[k].target);
            share(own, (&lower, &upper));
            share(own, (&upper, &lower));
            rest = others;
        }
    }
}

/// Gives a side without friction half of that of the other side, by what presses on its facets.
fn share(contacts: &mut [FacetContact], (without, with): (&[usize], &[usize])) {
    let push_n: f64 = without.iter().map(|&k| contacts[k].push_n.norm()).sum();
    if push_n <= 0.0 || without.iter().any(|&k| contacts[k].friction_n != Vec3::zeros()) {
        return;
    }
    with.iter().for_each(|&k| contacts[k].friction_n *= 0.5);
    let half: Vec3 = with.iter().map(|&k| contacts[k].friction_n).sum();
    without.iter().for_each(|&k| contacts[k].friction_n = -half * (contacts[k].push_n.norm() / push_n));
}

#[cfg(test)]
mod tests {
    use ndda_mesh::TriangleId;

    use super::*;
    use crate::testing::{test_box, test_set};

    #[test]
    fn a_side_that_had_no_friction_gets_half_of_it_and_the_force_on_each_block_stays() {
        let blocks = test_set(vec![
            test_box([0.0; 3], [1.0; 3], [1, 1, 1]),
            test_box([0.0, 0.0, 1.0], [1.0; 3], [1, 1, 1]),
        ]);
        let (below, above) = (blocks.triangles_of(BlockId(0)).start, blocks.triangles_of(BlockId(1)).start);
        let contact = |facet: usize, target: u32, push_n: f64, friction_n: f64| {
            let up = if target == 1 { 1.0 } else { -1.0 };
            FacetContact {
                facet: TriangleId(facet as u32),
                target: BlockId(target),
                area_m2: 0.5,
                normal: up * Vec3::z(),
                center: Vec3::zeros(),
                push_n: -up * push_n * Vec3::z(),
                friction_n: friction_n * Vec3::x(),
                couple_n_m: Vec3::zeros(),
                sticks: true,
            }
        };
        let mut contacts = vec![
            contact(above, 0, 5.0, -3.0),
            contact(below, 1, 1.0, 0.0),
            contact(above + 1, 0, 5.0, -1.0),
            contact(below + 1, 1, 9.0, 0.0),
        ];
        share_between_sides(&blocks, &mut contacts);
        let friction = |facet: usize| {
            contacts.iter().find(|contact| contact.facet.index() == facet).unwrap().friction_n.x
        };
        assert_eq!([above, above + 1].map(friction), [-1.5, -0.5]);
        assert!((friction(below) - 0.2).abs() < 1e-15 && (friction(below + 1) - 1.8).abs() < 1e-15);
        let before = contacts.clone();
        share_between_sides(&blocks, &mut contacts);
        assert_eq!(contacts, before);
    }
}
