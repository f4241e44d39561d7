//! Friction of all facets at once, by a law that sees them as arrays: for trying an idea in a language that is slow per facet.

use ndda_mesh::{BlockId, BlockSet, Vec3};

use crate::audit::ContactAudit;
use crate::contact_model::ContactModel;
use crate::model::{ContactError, ContactHistory, ContactInput, ContactOutput, ContactReport, FacetContact};
use crate::pair_stiffness::PairStiffness;
use crate::plan::Part;

use super::PotentialContact;

/// A facet in contact as a batch law sees it; vectors are in global axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BatchFacet {
    /// Block of the facet.
    pub owner: BlockId,
    /// The block that it is pressed into.
    pub target: BlockId,
    /// Area in contact [m²].
    pub area_m2: f64,
    /// Outward normal of the facet.
    pub normal: Vec3,
    /// Normal force [N].
    pub normal_n: f64,
    /// Slip of this step, facet minus target, along the facet [m].
    pub slip_m: Vec3,
    /// Shear force of the last step, turned into the facet's plane [N]; zero where contact begins.
    pub shear_n: Vec3,
}

/// A friction law for all facets of a step.
pub trait BatchLaw: Send + Sync {
    /// Numbers that it keeps of each facet beside the shear force, zero where contact begins.
    fn state_len(&self) -> usize;

    /// Its name, for messages; that of its type if it does not say another.
    fn name(&self) -> &str {
        std::any::type_name::<Self>()
    }

    /// Stiffness against slip [Pa/m], for the bound of the time step; zero without springs.
    fn shear_stiffness_pa_m(&self) -> f64;

    /// Writes the shear force on each facet [N]; what is along a normal is left out. `state` has `state_len` numbers for each facet.
    ///
    /// # Errors
    /// Why there are no forces, in words.
    fn forces(
        &mut self,
        dt_s: f64,
        facets: &[BatchFacet],
        state: &mut [f64],
        force_n: &mut [Vec3],
    ) -> Result<(), String>;
}

/// Numbers of a facet in [`ContactHistory::own`] before those of the law: facet, target, shear force.
const HEAD: usize = 5;

/// The contact potential with a batch law for its friction.
///
/// Shear acts on a facet at its centre of pressure and on the element of the target there, so that forces and torques sum to zero.
pub struct BatchFriction {
    normal: PotentialContact,
    law: Box<dyn BatchLaw>,
    touching: Vec<FacetContact>,
    facets: Vec<BatchFacet>,
    hosts: Vec<Hosts>,
    force_n: Vec<Vec3>,
    state: Vec<f64>,
}

/// Nodes that carry the shear of a facet on both sides, with their weights.
#[derive(Clone, Copy)]
struct Hosts {
    facet: [(usize, f64); 3],
    target: [(usize, f64); 4],
}

impl BatchFriction {
    /// A model whose normal forces are those of `normal`, which has no friction of its own.
    pub fn new(normal: PotentialContact, law: Box<dyn BatchLaw>) -> Self {
        let (touching, facets, hosts) = (Vec::new(), Vec::new(), Vec::new());
        Self { normal, law, touching, facets, hosts, force_n: Vec::new(), state: Vec::new() }
    }

    /// Facets, their slips, and what they remember.
    fn gather(&mut self, input: &ContactInput, history: &ContactHistory) {
        self.touching.clear();
        self.normal.add_facets(input, history, &mut self.touching);
        let stride = HEAD + self.law.state_len();
        self.facets.clear();
        self.hosts.clear();
        self.state.clear();
        let mut at = 0;
        for contact in &self.touching {
            let hosts = Hosts::new(input, contact);
            let slip = input.dt_s * hosts.relative(input.velocity);
            let along = |v: Vec3| v - contact.normal * contact.normal.dot(&v);
            let old = remembered(&history.own, stride, contact, &mut at);
            let shear = old.map_or(Vec3::zeros(), |row| Vec3::new(row[2], row[3], row[4]));
            let turned = along(shear);
            // The force keeps its size while the facet turns.
            let kept = if turned.norm() > 0.0 { turned * (shear.norm() / turned.norm()) } else { turned };
            self.facets.push(BatchFacet {
                owner: input.blocks.triangle_block[contact.facet.index()],
                target: contact.target,
                area_m2: contact.area_m2,
                normal: contact.normal,
                normal_n: -contact.push_n.dot(&contact.normal),
                slip_m: along(slip),
                shear_n: kept,
            });
            self.hosts.push(hosts);
            match old {
                Some(row) => self.state.extend_from_slice(&row[HEAD..]),
                None => self.state.resize(self.state.len() + stride - HEAD, 0.0),
            }
        }
    }

    /// Adds the shear of all facets to the nodes.
    fn scatter(&self, output: &mut ContactOutput) {
        let stiffness_pa_m = self.law.shear_stiffness_pa_m();
        for ((facet, hosts), force) in self.facets.iter().zip(&self.hosts).zip(&self.force_n) {
            let sides = [(1.0, &hosts.facet[..]), (-1.0, &hosts.target[..])];
            for (node, signed, weight) in sides
                .into_iter()
                .flat_map(|(sign, nodes)| nodes.iter().map(move |&(node, w)| (node, sign * w, w.abs())))
            {
                output.force[node] += signed * force;
                output.friction_force[node] += signed * force;
                output.stiffness[node] += 2.0 * weight * stiffness_pa_m * facet.area_m2;
            }
        }
    }

    /// Keeps shear and numbers of the law, sorted by facet and target.
    fn remember(&self, own: &mut Vec<f64>) {
        let len = self.law.state_len();
        own.clear();
        for (i, (contact, force)) in self.touching.iter().zip(&self.force_n).enumerate() {
            own.extend([f64::from(contact.facet.0), f64::from(contact.target.0), force.x, force.y, force.z]);
            own.extend_from_slice(&self.state[i * len..(i + 1) * len]);
        }
    }
}

impl Hosts {
    fn new(input: &ContactInput, contact: &FacetContact) -> Self {
        let blocks = input.blocks;
        let triangle = blocks.triangles[contact.facet.index()].map(|n| n.index());
        let weights = triangle_weights(triangle.map(|n| input.position[n]), &contact.center);
        let facet = [0, 1, 2].map(|k| (triangle[k], weights[k]));
        let point: Vec3 = facet.iter().map(|&(node, w)| w * input.position[node]).sum();
        Self { facet, target: element_at(blocks, input.position, contact.target, &point) }
    }

    /// Velocity of the facet less that of its target [m/s].
    fn relative(&self, velocity: &[Vec3]) -> Vec3 {
        let sum = |nodes: &[(usize, f64)]| nodes.iter().map(|&(node, w)| w * velocity[node]).sum::<Vec3>();
        sum(&self.facet) - sum(&self.target)
    }
}

/// Barycentric coordinates of the projection of a point to the plane of a triangle.
fn triangle_weights([a, b, c]: [Vec3; 3], point: &Vec3) -> [f64; 3] {
    let area = (b - a).cross(&(c - a));
    let part = |p: Vec3, q: Vec3| area.dot(&(p - point).cross(&(q - point))) / area.norm_squared();
    let (u, v) = (part(b, c), part(c, a));
    [u, v, 1.0 - u - v]
}

/// The element of a block that a point is in, or least outside of, with barycentric coordinates.
fn element_at(blocks: &BlockSet, position: &[Vec3], block: BlockId, point: &Vec3) -> [(usize, f64); 4] {
    let mut best = (f64::NEG_INFINITY, [(0, 0.0); 4]);
    for tet in &blocks.tets[blocks.tets_of(block)] {
        let nodes = tet.map(|n| n.index());
        let [a, b, c, d] = nodes.map(|n| position[n]);
        let volume = |p: &Vec3, q: &Vec3, r: &Vec3, s: &Vec3| (q - p).cross(&(r - p)).dot(&(s - p));
        let whole = volume(&a, &b, &c, &d);
        let (u, v) = (volume(point, &b, &c, &d) / whole, volume(&a, point, &c, &d) / whole);
        let w = volume(&a, &b, point, &d) / whole;
        let weights = [u, v, w, 1.0 - u - v - w];
        let least = weights.into_iter().fold(f64::INFINITY, f64::min);
        if least > best.0 {
            best = (least, [0, 1, 2, 3].map(|k| (nodes[k], weights[k])));
        }
    }
    best.1
}

/// Memory of a facet and its target. Both lists have the same order, so that the search begins where the one before ended.
fn remembered<'a>(
    own: &'a [f64],
    stride: usize,
    contact: &FacetContact,
    at: &mut usize,
) -> Option<&'a [f64]> {
    let wanted = (f64::from(contact.facet.0), f64::from(contact.target.0));
    let rows = own.len() / stride;
    let row = |i: usize| &own[i * stride..(i + 1) * stride];
    let found = (*at..rows).chain(0..*at).find(|&i| (row(i)[0], row(i)[1]) == wanted)?;
    *at = (found + 1) % rows;
    Some(row(found))
}

impl ContactModel for BatchFriction {
    fn add_forces(
        &mut self,
        input: &ContactInput,
        history: &mut ContactHistory,
        output: &mut ContactOutput,
    ) -> Result<ContactReport, ContactError> {
        let report = self.normal.add_forces(input, history, output)?;
        self.gather(input, history);
        self.force_n.clear();
        self.force_n.resize(self.facets.len(), Vec3::zeros());
        if input.without_friction {
            // The stiffness of its springs is asked for all the same.
            self.scatter(output);
            return Ok(report);
        }
        if !self.facets.is_empty() {
            let done = self.law.forces(input.dt_s, &self.facets, &mut self.state, &mut self.force_n);
            done.map_err(ContactError::Law)?;
        }
        for (force, facet) in self.force_n.iter_mut().zip(&self.facets) {
            *force -= facet.normal * facet.normal.dot(force);
        }
        self.scatter(output);
        self.remember(&mut history.own);
        Ok(report)
    }

    fn energy_j(&mut self, input: &ContactInput, history: &ContactHistory) -> Result<f64, ContactError> {
        self.normal.energy_j(input, history)
    }

    fn add_stiffness(
        &mut self,
        input: &ContactInput,
        history: &ContactHistory,
        stiffness: &mut Vec<PairStiffness>,
    ) -> Result<(), ContactError> {
        self.normal.add_stiffness(input, history, stiffness)
    }

    fn leave_out(&mut self, absent: &[bool]) -> bool {
        self.normal.leave_out(absent)
    }

    fn uses_host_forces(&self, block: BlockId) -> bool {
        self.normal.uses_host_forces(block)
    }

    fn has_acted(&self) -> bool {
        self.normal.has_acted()
    }

    fn needs_bodies(&self) -> bool {
        self.normal.needs_bodies()
    }

    fn has_friction(&self) -> bool {
        true
    }
}

impl ContactAudit for BatchFriction {
    fn each_work(&mut self, blocks: &BlockSet, moved: &[Vec3], add: &mut dyn FnMut(BlockId, BlockId, f64)) {
        self.normal.each_work(blocks, moved, add);
    }

    fn each_push(&self, add: &mut dyn FnMut(BlockId, BlockId, &Vec3)) {
        self.normal.each_push(add);
    }

    fn damps(&self) -> bool {
        self.normal.damps()
    }

    fn damps_strongly(&self) -> bool {
        self.normal.damps_strongly()
    }

    fn each_damping_work(
        &mut self,
        blocks: &BlockSet,
        position: &[Vec3],
        moved: &[Vec3],
        add: &mut dyn FnMut(BlockId, BlockId, f64),
    ) {
        self.normal.each_damping_work(blocks, position, moved, add);
    }

    fn each_energy(&self, add: &mut dyn FnMut(BlockId, BlockId, f64)) {
        self.normal.each_energy(add);
    }

    fn width_m(&self, blocks: &BlockSet, block: BlockId) -> Option<f64> {
        self.normal.width_m(blocks, block)
    }

    fn closing_m_s(&self, input: &ContactInput, pair: (BlockId, BlockId)) -> Option<f64> {
        self.normal.closing_m_s(input, pair)
    }

    fn plan(&self) -> Vec<Part> {
        self.normal.plan()
    }

    fn add_facets(&self, input: &ContactInput, history: &ContactHistory, facets: &mut Vec<FacetContact>) {
        let first = facets.len();
        self.normal.add_facets(input, history, facets);
        for (facet, force) in facets[first..].iter_mut().zip(&self.force_n) {
            facet.friction_n = *force;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{check_model, evaluate, test_box, test_set};

    /// Sliding friction of 0.5, with a count of the steps as its state.
    struct Half;

    impl BatchLaw for Half {
        fn state_len(&self) -> usize {
            1
        }

        fn shear_stiffness_pa_m(&self) -> f64 {
            0.0
        }

        fn forces(
            &mut self,
            _dt_s: f64,
            facets: &[BatchFacet],
            state: &mut [f64],
            force_n: &mut [Vec3],
        ) -> Result<(), String> {
            for ((facet, count), force) in facets.iter().zip(state).zip(force_n) {
                *count += 1.0;
                if facet.slip_m.norm() > 0.0 {
                    *force = -0.5 * facet.normal_n * facet.slip_m.normalize();
                }
            }
            Ok(())
        }
    }

    #[test]
    fn it_keeps_the_contract_of_a_contact_model() {
        check_model(&mut BatchFriction::new(PotentialContact::new(1e9), Box::new(Half)));
    }

    #[test]
    fn where_friction_is_not_asked_for_its_law_does_not_act() {
        let blocks = test_set(vec![
            test_box([0.0; 3], [2.0, 2.0, 1.0], [1, 1, 1]),
            test_box([0.5, 0.5, 0.99], [1.0; 3], [1, 1, 1]),
        ]);
        let (position, mut velocity) =
            (&blocks.rest_position, vec![Vec3::zeros(); blocks.rest_position.len()]);
        velocity[blocks.nodes_of(BlockId(1))].fill(Vec3::x());
        let input = ContactInput::new(&blocks, position, &velocity, 1e-3);
        let mut model = BatchFriction::new(PotentialContact::new(1e9), Box::new(Half));
        let mut history = ContactHistory::default();
        assert!(evaluate(&mut model, &input, &mut history).friction_force.iter().any(|f| f.x != 0.0));
        let before = history.clone();
        let without = evaluate(&mut model, &ContactInput { without_friction: true, ..input }, &mut history);
        assert!(without.friction_force.iter().all(|f| *f == Vec3::zeros()));
        assert!(without.force.iter().any(|f| f.z > 0.0));
        assert_eq!(history, before);
    }

    #[test]
    fn weights_reproduce_a_point_of_the_plane() {
        let corners = [Vec3::zeros(), Vec3::new(2.0, 0.0, 0.0), Vec3::new(0.0, 3.0, 0.0)];
        let weights = triangle_weights(corners, &Vec3::new(0.7, -0.4, 5.0));
        let point: Vec3 = corners.iter().zip(weights).map(|(x, w)| w * x).sum();
        assert!((point - Vec3::new(0.7, -0.4, 0.0)).norm() < 1e-14);
    }
}
