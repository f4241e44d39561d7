//! Friction of patches that stick, found together.
//!
//! Where no patch slides, friction is the solution of a linear system: W Δf = −slip, W the change of all slips with all forces. Gauss–Seidel
//! sweeps carry a change from patch to patch only, and need as many of them as the square of the patches between a load and a support.
//! Conjugate gradients on the patches that stick, with the inverse of each one's own flexibility as preconditioner, need about as many
//! steps as there are patches in between. Patches that slide keep their friction meanwhile; the sweeps that follow correct them.

use ndda_mesh::Vec3;

use crate::friction::patches::solve::{CoupledPatch, GAMMA, Motion};

/// Steps of conjugate gradients at a time.
const MOST_STEPS: usize = 60;

/// Room for the vectors of conjugate gradients, one entry per sticking patch, and for the velocities of blocks meanwhile.
#[derive(Default)]
pub(in crate::friction::patches) struct Sticking {
    /// Their places among all patches.
    places: Vec<u32>,
    change: Vec<Vec3>,
    residual: Vec<Vec3>,
    direction: Vec<Vec3>,
    cause: Vec<Vec3>,
    product: Vec<Vec3>,
    /// Velocities and spins of blocks, and velocities of nodes.
    bodies: Vec<[Vec3; 2]>,
    nodes: Vec<Vec3>,
}

impl Sticking {
    /// Lets all patches that stick stop together, as far as friction within the tolerance of each needs it; how many steps that took.
    pub(super) fn stop(&mut self, patches: &mut [CoupledPatch], motion: &mut Motion, time_s: f64) -> usize {
        self.places.clear();
        self.places.extend((0..).zip(&*patches).filter(|(_, patch)| !patch.is_slight()).map(|(k, _)| k));
        let count = self.places.len();
        if count < 2 {
            return 0;
        }
        for vector in [&mut self.change, &mut self.residual, &mut self.direction, &mut self.product, &mut self.cause] {
            vector.clear();
            vector.resize(count, Vec3::zeros());
        }
        for (residual, &k) in self.residual.iter_mut().zip(&self.places) {
            let patch = &patches[k as usize];
            let free = patch.slip(motion) - GAMMA * (patch.flexibility * patch.force);
            *residual = patch.free_slip - free;
        }
        self.set_aside(motion);
        let steps = self.iterate(patches, motion, time_s);
        self.put_back(motion);
        for (change, &k) in self.change.iter().zip(&self.places) {
            let patch = &mut patches[k as usize];
            patch.force += change;
            patch.push(motion, change, time_s);
            patch.free_slip = if patch.response == patch.stiffness / GAMMA && patch.surface.holds(&patch.force) {
                -GAMMA * (patch.flexibility * patch.force)
            } else {
                Vec3::repeat(f64::INFINITY)
            };
        }
        steps
    }

    fn iterate(&mut self, patches: &[CoupledPatch], motion: &mut Motion, time_s: f64) -> usize {
        let (mut old, mut first) = (f64::INFINITY, 0.0);
        for step in 0..MOST_STEPS {
            let (mut now, mut is_found) = (0.0, true);
            for (k, residual) in self.places.iter().zip(&self.residual) {
                let patch = &patches[*k as usize];
                let local = patch.response * residual;
                is_found &= local.amax() <= 0.3 * patch.tolerance_n;
                now += residual.dot(&local);
            }
            if step == 0 { first = now; }
            if is_found || !(now > 1e-4 * first) {
                return step;
            }
            let back = if old.is_finite() { now / old } else { 0.0 };
            old = now;
            motion.stand_still();
            for (((k, residual), direction), cause) in
                self.places.iter().zip(&self.residual).zip(&mut self.direction).zip(&mut self.cause)
            {
                let patch = &patches[*k as usize];
                *direction = patch.response * residual + back * *direction;
                *cause = residual + back * *cause;
                patch.push(motion, direction, time_s);
            }
            let mut work = 0.0;
            for (((k, product), direction), cause) in
                self.places.iter().zip(&mut self.product).zip(&self.direction).zip(&self.cause)
            {
                let patch = &patches[*k as usize];
                *product = patch.slip(motion) + cause - GAMMA * (patch.flexibility * direction);
                work += product.dot(direction);
            }
            let length = now / work;
            if !(length > 0.0 && length.is_finite()) {
                return step;
            }
            for k in 0..self.places.len() {
                self.change[k] += length * self.direction[k];
                self.residual[k] -= length * self.product[k];
            }
        }
        MOST_STEPS
    }

    /// Keeps the velocities of all blocks.
    fn set_aside(&mut self, motion: &mut Motion) {
        self.bodies.clear();
        self.bodies.extend(motion.bodies.iter().map(|body| [body.velocity_m_s, body.spin_rad_s]));
        self.nodes.clear();
        motion.nodal.each_velocity(motion.blocks, |v| self.nodes.push(*v));
    }

    fn put_back(&self, motion: &mut Motion) {
        for (body, [velocity, spin]) in motion.bodies.iter_mut().zip(&self.bodies) {
            (body.velocity_m_s, body.spin_rad_s) = (*velocity, *spin);
        }
        let mut kept = self.nodes.iter();
        motion.nodal.each_velocity(motion.blocks, |v| *v = *kept.next().expect("as many as were kept"));
    }
}

impl Motion<'_> {
    fn stand_still(&mut self) {
        for body in &mut *self.bodies {
            (body.velocity_m_s, body.spin_rad_s) = (Vec3::zeros(), Vec3::zeros());
        }
        self.nodal.each_velocity(self.blocks, |v| *v = Vec3::zeros());
    }
}
