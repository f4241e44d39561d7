//! Scenes of boxes that the tests of steps begin with.

use std::sync::Arc;

use ndda_contact::PotentialContact;
use ndda_fem::LinearElastic;
use ndda_mesh::generate::{BoxPattern, box_block};
use ndda_mesh::{BlockSet, Mat3, Vec3};

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
        contact: Some(Box::new(PotentialContact::new(1e8))),
        implicit_contact: None,
        solver: Box::new(Direct),
        auto_step: None,
        bolts: Vec::new(),
    }
}
