//! Scenes of boxes that the tests of steps begin with.

use std::sync::Arc;

use ndda_contact::{
    BodyMemory, ContactAudit, ContactError, ContactHistory, ContactInput, ContactModel, ContactOutput,
    ContactReport,
};
use ndda_fem::LinearElastic;
use ndda_mesh::generate::{BoxPattern, box_block};
use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, BlockSet, Mat3, Vec3};

use crate::bodies::kind::BodyKind;
use crate::bodies::prototype::{BodySetup, Mass};
use crate::integrators::midpoint::Midpoint;
use crate::linear::direct::Direct;
use crate::step::setup::Setup;

/// Density of the boxes [kg/m³].
pub(crate) const DENSITY_KG_M3: f64 = 2500.0;

/// The setup of boxes in contact under a gravity of 10 m/s², each of one cell, given by its kind, sides [m] and lower corner [m].
pub(crate) fn boxes(boxes: &[(BodyKind, [f64; 3], [f64; 3])]) -> Setup {
    let block = |(k, (_, size_m, at_m)): (usize, &(BodyKind, [f64; 3], [f64; 3]))| {
        let mesh = box_block(*size_m, [1; 3], BoxPattern::Six).expect("a box");
        (format!("box {k}"), mesh.placed(&Mat3::identity(), &Vec3::from(*at_m)))
    };
    let material = Arc::new(LinearElastic::new(1e9, 0.25, DENSITY_KG_M3).expect("rock"));
    let body = |kind| BodySetup {
        kind,
        material: material.clone(),
        supports: Vec::new(),
        initial_stress: None,
        tractions: Vec::new(),
        pressures: Vec::new(),
        ties: Vec::new(),
        quiet: Vec::new(),
        forces: Vec::new(),
        velocity_m_s: Vec3::zeros(),
        spin_rad_s: Vec3::zeros(),
    };
    Setup {
        blocks: BlockSet::new(boxes.iter().enumerate().map(block).collect()).expect("blocks"),
        bodies: boxes.iter().map(|(kind, ..)| body(*kind)).collect(),
        gravity_m_s2: Vec3::new(0.0, 0.0, -10.0),
        gravity_factor: None,
        mass: Mass::Consistent,
        step_s: 1e-3,
        integrator: Box::new(Midpoint { theta: 0.5 }),
        contact: Some(Box::new(BoxSprings::default())),
        implicit_contact: None,
        solver: Box::new(Direct),
        auto_step: None,
        bolts: Vec::new(),
    }
}

/// Contact of boxes one above the other: f = k d at a depth d, spread evenly over the nodes of both.
#[derive(Default)]
pub(crate) struct BoxSprings {
    /// Whether it keeps how blocks moved, as a law that damps contact does.
    pub(crate) keeps_motions: bool,
}

/// Stiffness k of contact between boxes [N/m].
const STIFFNESS_N_M: f64 = 1e8;

impl BoxSprings {
    /// The upper and the lower box of every two that overlap, and their depth d [m].
    fn for_each_pair(&self, input: &ContactInput, mut pair: impl FnMut(BlockId, BlockId, f64)) {
        let bounds = |block: BlockId| Aabb::around(&input.position[input.blocks.nodes_of(block)]);
        for upper in input.blocks.ids() {
            for lower in input.blocks.ids() {
                let (above, below) = (bounds(upper), bounds(lower));
                if above.min.z > below.min.z && above.touches(&below) {
                    pair(upper, lower, below.max.z - above.min.z);
                }
            }
        }
    }
}

impl ContactAudit for BoxSprings {}

impl ContactModel for BoxSprings {
    fn add_forces(
        &mut self,
        input: &ContactInput,
        history: &mut ContactHistory,
        output: &mut ContactOutput,
    ) -> Result<ContactReport, ContactError> {
        let mut report = ContactReport::default();
        self.for_each_pair(input, |upper, lower, depth_m| {
            for (block, sign) in [(upper, 1.0), (lower, -1.0)] {
                let nodes = input.blocks.nodes_of(block);
                let share = STIFFNESS_N_M / nodes.len() as f64;
                output.force[nodes.clone()].iter_mut().for_each(|f| f.z += sign * share * depth_m);
                output.stiffness[nodes].iter_mut().for_each(|k| *k += share);
            }
            report.contact_pairs += 1;
        });
        if self.keeps_motions {
            history.bodies = input.bodies.iter().map(|body| BodyMemory::new(body, input.dt_s)).collect();
        }
        Ok(report)
    }

    fn energy_j(&mut self, input: &ContactInput, _history: &ContactHistory) -> Result<f64, ContactError> {
        let mut energy_j = 0.0;
        self.for_each_pair(input, |_, _, depth_m| energy_j += 0.5 * STIFFNESS_N_M * depth_m * depth_m);
        Ok(energy_j)
    }

    fn needs_bodies(&self) -> bool {
        self.keeps_motions
    }
}
