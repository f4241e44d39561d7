//! The scene at rest, from which trials begin.

use ndda_mesh::Vec3;
use ndda_solver::{Simulation, Snapshot, StepError};

use crate::safety::free_blocks::{Moved, free};
use crate::safety::mechanism;
use crate::safety::slender::Slender;

/// The scene at rest, from which trials begin.
pub struct Start {
    /// Its state.
    pub snapshot: Snapshot,
    /// Places of its nodes [m].
    pub position: Vec<Vec3>,
    /// Elastic displacement u [m].
    pub elastic_m: f64,
    /// Gravity or, where there is none, contact forces over the mass that they hold [m/s²].
    pub gravity_m_s2: f64,
    /// Normals into each free block of the faces of fixed ones that it rests on.
    pub normals: Vec<Vec<Vec3>>,
    /// CRC-32 of the blocks at rest.
    pub blocks_crc32: u32,
    /// Blocks that came to rest elsewhere, even with the largest strength.
    pub moved: Vec<Moved>,
    /// Whether these do not come to rest at all, so that no trial can begin.
    pub still_moves: bool,
    /// Free blocks.
    pub free: usize,
    /// The block that would topple first if the slope were made steeper.
    pub slender: Option<Slender>,
}

impl Start {
    /// Measures a scene that has come to rest under gravity [m/s²]; `softest_pa_m` is the shear stiffness of its springs.
    ///
    /// # Errors
    /// [`StepError`].
    pub fn new(
        simulation: &mut Simulation,
        gravity: Vec3,
        softest_pa_m: Option<f64>,
    ) -> Result<Self, StepError> {
        let snapshot = simulation.snapshot();
        let position = simulation.state().position.clone();
        simulation.watch_contacts(true);
        simulation.step()?;
        let sample = simulation.sample()?;
        let contacts = simulation.contacts();
        // Both sides of a contact are in the list.
        let force_n = 0.5 * contacts.iter().map(|contact| contact.push_n.norm()).sum::<f64>();
        let stored_j = sample.contact_j.abs() + sample.strain_j.abs();
        let normal_m = if force_n > 0.0 { 2.0 * stored_j / force_n } else { 0.0 };
        let shear_pa = contacts
            .iter()
            .filter(|contact| contact.area_m2 > 0.0)
            .map(|contact| contact.friction_n.norm() / contact.area_m2)
            .fold(0.0, f64::max);
        let shear_m = softest_pa_m.map_or(0.0, |stiffness| shear_pa / stiffness);
        let mass_kg: f64 = free(simulation).map(|block| simulation.shape(block).operator.mass_kg).sum();
        let gravity_m_s2 = if gravity.norm() > 0.0 { gravity.norm() } else { force_n / mass_kg };
        // No size is smaller than its own rounding.
        let size_m = position.iter().map(|x| x.amax()).fold(0.0, f64::max);
        let elastic_m = normal_m.max(shear_m).max(1e-12 * size_m);
        let normals = mechanism::normals(simulation);
        let slender = Slender::first(simulation, gravity);
        let rest: Vec<[f64; 3]> = simulation.blocks().rest_position.iter().map(|x| (*x).into()).collect();
        let blocks_crc32 = ndda_io::checkpoint::fingerprint(&rest);
        Ok(Self {
            snapshot,
            position,
            elastic_m,
            gravity_m_s2,
            normals,
            blocks_crc32,
            moved: Vec::new(),
            still_moves: false,
            free: free(simulation).count(),
            slender,
        })
    }
}
