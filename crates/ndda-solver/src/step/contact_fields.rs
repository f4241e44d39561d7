//! Contact forces as somebody wants to see them: on the nodes that are pressed.

use ndda_contact::FacetContact;
use ndda_mesh::geometry::{distance_to_triangle, triangle_area_vector};
use ndda_mesh::{BlockId, NodeId, Vec3};

use crate::step::Simulation;

impl Simulation {
    /// Contact force on each node in the last step [N], friction included, bolts not; zero where contact has not been evaluated yet. At the start of a
    /// scene that has settled it is that of [`report_at_start`](Self::report_at_start).
    ///
    /// Where contact gathers the forces on a block on a few of its nodes, they are shown where facets press instead, on the nearest
    /// triangle of the block, if contacts of the step are kept because a [`Sink`](crate::sink::Sink) requires them.
    pub fn contact_forces_n(&self) -> Vec<Vec3> {
        if !self.audit.contact_is_known {
            return vec![Vec3::zeros(); self.scratch.force.len()];
        }
        let mut forces: Vec<Vec3> =
            self.scratch.force.iter().zip(self.loads.total()).map(|(f, load)| f - load).collect();
        if let Some(bolts) = &self.bolts {
            forces.iter_mut().zip(&bolts.force).for_each(|(force, pull)| *force -= pull);
        }
        let (Some(model), Some(contacts)) = (&self.contact, &self.audit.contacts) else { return forces };
        let gathered: Vec<bool> =
            self.problem.blocks.ids().map(|block| model.uses_host_forces(block)).collect();
        for block in self.problem.blocks.ids().filter(|block| gathered[block.index()]) {
            forces[self.problem.blocks.nodes_of(block)].fill(Vec3::zeros());
        }
        for contact in contacts {
            let own = self.problem.blocks.triangle_block[contact.facet.index()];
            let force_n = contact.push_n + contact.friction_n;
            if gathered[own.index()] {
                let pressing = self.nearest_triangle(own, contact);
                self.spread(&pressing, &contact.center, &force_n, &mut forces);
            }
            if gathered[contact.target.index()] {
                let pressed = self.nearest_triangle(contact.target, contact);
                self.spread(&pressed, &contact.center, &-force_n, &mut forces);
            }
        }
        forces
    }

    /// The triangle of the contactor that presses: where a contact acts on a block as a whole, its facet may stand for more than itself.
    pub fn pressing_triangle(&self, contact: &FacetContact) -> [NodeId; 3] {
        let own = self.problem.blocks.triangle_block[contact.facet.index()];
        let uses_host_forces = self.contact.as_ref().is_some_and(|model| model.uses_host_forces(own));
        if uses_host_forces {
            self.nearest_triangle(own, contact)
        } else {
            self.problem.blocks.triangles[contact.facet.index()]
        }
    }

    fn nearest_triangle(&self, block: BlockId, contact: &FacetContact) -> [NodeId; 3] {
        let contact_offset = self.state.contact_offset_of(block);
        let corners = |triangle: &[NodeId; 3]| {
            triangle.map(|n| self.scratch.contact_position[n.index()] + contact_offset)
        };
        let distance = |triangle: &[NodeId; 3]| distance_to_triangle(&contact.center, &corners(triangle));
        let nearer = |a: &&[NodeId; 3], b: &&[NodeId; 3]| distance(a).total_cmp(&distance(b));
        *self.problem.blocks.triangles[self.problem.blocks.triangles_of(block)]
            .iter()
            .min_by(nearer)
            .expect("a block has a surface")
    }

    /// Gives a force to the corners of a triangle, by the areas that the point makes with the other two.
    fn spread(&self, triangle: &[NodeId; 3], at: &Vec3, force_n: &Vec3, forces: &mut [Vec3]) {
        let contact_offset = self.state.contact_offset_of(self.problem.blocks.block_of(triangle[0]));
        let corners = triangle.map(|n| self.scratch.contact_position[n.index()] + contact_offset);
        let normal = triangle_area_vector(&corners);
        let opposite = |a: usize| {
            let part = triangle_area_vector(&[*at, corners[(a + 1) % 3], corners[(a + 2) % 3]]);
            part.dot(&normal).max(0.0)
        };
        let areas = [0, 1, 2].map(opposite);
        let total: f64 = areas.iter().sum();
        for (node, area) in triangle.iter().zip(areas) {
            forces[node.index()] += area / total * force_n;
        }
    }
}
