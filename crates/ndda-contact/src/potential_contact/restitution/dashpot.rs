//! Dashpots beside the shear springs between two blocks, found together.

use nalgebra::{Matrix6, Vector6};
use ndda_mesh::{BlockId, Vec3};

use crate::model::Body;
use crate::restitution::pair::{Change, response};

/// A dashpot beside the shear spring of a facet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dashpot {
    /// In the list of facets that touch.
    pub facet: u32,
    /// Place [m].
    pub x: Vec3,
    /// Unit normal of the facet, across which nothing is damped.
    pub normal: Vec3,
    /// Velocity of the first block on the second here at the start of the step [m/s].
    pub slip_m_s: Vec3,
    /// Force per velocity [N s/m], and where in the step the velocity counts.
    pub rate: f64,
    pub end: f64,
    /// Part of the dashpot that the step leaves out.
    pub lag: f64,
    /// Force on the first block [N].
    pub force_n: Vec3,
}

impl Dashpot {
    /// Force on the first block if the step changes the slip velocity by so much [N].
    fn force(&self, change_m_s: &Vec3) -> Vec3 {
        let slip_m_s = self.slip_m_s + self.end * change_m_s;
        -self.rate * (slip_m_s - self.normal * self.normal.dot(&slip_m_s))
    }
}

/// Two blocks with dashpots between them.
#[derive(Clone, Copy, Debug)]
pub(super) struct DashpotPair {
    pub blocks: [BlockId; 2],
    /// Its dashpots in the list of all.
    pub dashpots: [u32; 2],
    /// Point about which torques count [m].
    pub center: Vec3,
}

impl DashpotPair {
    /// Its dashpots in the list of all.
    pub(super) fn range(&self) -> std::ops::Range<usize> {
        self.dashpots[0] as usize..self.dashpots[1] as usize
    }

    /// Finds the forces of these dashpots while all others stay; returns the largest change [N].
    ///
    /// Forces are −c P (w + θ Δw), P being the projection on the face and Δw the change of the slip velocity w in the step, these forces included: six
    /// linear equations for the relative motion that they add, whatever the size of c Δt/m.
    pub(super) fn advance(
        &self,
        dashpots: &mut [Dashpot],
        (bodies, changes): (&[Body], &mut [Change]),
        dt_s: f64,
    ) -> f64 {
        let [a, b] = self.blocks.map(|block| block.index());
        let response = response([&bodies[a], &bodies[b]], &self.center, dt_s);
        let own: Vector6<f64> = dashpots.iter().map(|dashpot| self.wrench(dashpot, &dashpot.force_n)).sum();
        let own = response * own;
        let free_m_s = |dashpot: &Dashpot, changes: &[Change]| {
            let both = changes[a].at(&bodies[a], &dashpot.x) - changes[b].at(&bodies[b], &dashpot.x);
            both - self.velocity(dashpot, &own)
        };
        let (mut matrix, mut side) = (Matrix6::identity(), Vector6::zeros());
        for dashpot in &*dashpots {
            side += response * self.wrench(dashpot, &dashpot.force(&free_m_s(dashpot, changes)));
            for k in 0..6 {
                let unit = self.velocity(dashpot, &Vector6::ith(k, 1.0));
                let across = unit - dashpot.normal * dashpot.normal.dot(&unit);
                let braked = dashpot.rate * dashpot.end * across;
                let mut column = matrix.column_mut(k);
                column += response * self.wrench(dashpot, &braked);
            }
        }
        let motion = matrix.try_inverse().map_or_else(Vector6::zeros, |inverse| inverse * side);
        let (mut largest_n, mut added) = (0.0f64, Vector6::zeros());
        for dashpot in dashpots {
            let change_m_s = free_m_s(dashpot, changes) + self.velocity(dashpot, &motion);
            let force_n = dashpot.force(&change_m_s);
            let more_n = force_n - dashpot.force_n;
            largest_n = largest_n.max(more_n.norm());
            added += self.wrench(dashpot, &more_n);
            dashpot.force_n = force_n;
        }
        let (force, torque) = (added.fixed_rows::<3>(0).into_owned(), added.fixed_rows::<3>(3).into_owned());
        for (block, sign) in [(a, 1.0), (b, -1.0)] {
            changes[block].push(&bodies[block], &self.center, &(sign * force), dt_s);
            changes[block].spin_rad_s += sign * dt_s * (bodies[block].inverse_inertia * torque);
        }
        largest_n
    }

    /// Force and torque about the centre of a force on the first block.
    fn wrench(&self, dashpot: &Dashpot, force_n: &Vec3) -> Vector6<f64> {
        let torque = (dashpot.x - self.center).cross(force_n);
        Vector6::new(force_n.x, force_n.y, force_n.z, torque.x, torque.y, torque.z)
    }

    /// Velocity at a dashpot of a relative motion about the centre.
    fn velocity(&self, dashpot: &Dashpot, motion: &Vector6<f64>) -> Vec3 {
        let spin = motion.fixed_rows::<3>(3).into_owned();
        motion.fixed_rows::<3>(0) + spin.cross(&(dashpot.x - self.center))
    }
}
