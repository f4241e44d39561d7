//! Pressure that follows the faces on which it acts.

use ndda_fem::{Between, CutRoom, PressureField, Table};
use ndda_mesh::Vec3;
use std::sync::Arc;

/// Pressure on faces of one block.
#[derive(Clone, Debug)]
pub(crate) struct FollowerPressure {
    /// Faces by nodes, counter-clockwise seen from outside.
    triangles: Vec<[u32; 3]>,
    /// Its field, in space.
    field: Arc<PressureField>,
    /// Its factor over time; constant without.
    factor: Option<Table>,
    /// How fast a factor of one makes the block [m/s²].
    pace_m_s2: f64,
    room: CutRoom,
}

/// Where nodes are when a load is taken: x + lead · v.
#[derive(Clone, Copy)]
pub(crate) struct Places<'a> {
    /// x [m].
    pub position: &'a [Vec3],
    /// v [m/s].
    pub velocity: &'a [Vec3],
    /// Time from x to where they are wanted [s].
    pub lead_s: f64,
}

impl Places<'_> {
    fn corners(&self, triangle: &[u32; 3]) -> [Vec3; 3] {
        triangle.map(|n| self.position[n as usize] + self.lead_s * self.velocity[n as usize])
    }
}

impl FollowerPressure {
    /// Pressure on faces of a block of a mass, at rest at `position`.
    pub(crate) fn new(
        triangles: Vec<[u32; 3]>,
        (field, factor): (Arc<PressureField>, Option<Table>),
        position: &[Vec3],
        mass_kg: f64,
    ) -> Self {
        let mut room = CutRoom::enough_for(&field);
        let corners = |t: &[u32; 3]| t.map(|n| position[n as usize]);
        let of_triangle = |t| field.forces(&corners(t), &mut room).iter().map(|f| f.norm()).sum::<f64>();
        let force_n: f64 = triangles.iter().map(of_triangle).sum();
        Self { triangles, field, factor, pace_m_s2: force_n / mass_kg, room }
    }

    /// Its faces and its factor over time, where it has one.
    pub(crate) fn over_time(&self) -> Option<(&[[u32; 3]], &Table)> {
        Some((&self.triangles, self.factor.as_ref()?))
    }

    /// A node of its block.
    pub(crate) fn first_node(&self) -> Option<u32> {
        self.triangles.first().map(|triangle| triangle[0])
    }

    /// Adds its mean between two times [s]; returns the speed that it brings and takes back unseen [m/s].
    pub(crate) fn add(&mut self, (from_s, to_s): (f64, f64), places: Places, force: &mut [Vec3]) -> f64 {
        let constant = Between { mean: 1.0, beyond_s: 0.0 };
        let Between { mean, beyond_s } = self.factor.as_ref().map_or(constant, |f| f.between(from_s, to_s));
        if mean != 0.0 {
            for triangle in &self.triangles {
                let parts = self.field.forces(&places.corners(triangle), &mut self.room);
                for (&node, part) in triangle.iter().zip(parts) {
                    force[node as usize] += mean * part;
                }
            }
        }
        self.pace_m_s2 * beyond_s
    }
}
