//! Forces beside the pushes of contact: those of the last step.

use crate::model::{Body, BodyMemory, ContactHistory, ContactInput};
use crate::restitution::ContactDamping;
use crate::restitution::pair::Change;
use crate::restitution::scene::DampingScene;

impl ContactDamping {
    /// How each block moves in the step without damping: by the elastic pushes, and by all other forces and prescribed motions as in the last step, or by
    /// the loads in the first.
    pub(super) fn predict(&mut self, scene: &DampingScene, history: &ContactHistory) {
        let ContactInput { bodies, dt_s, .. } = *scene.input;
        self.changes.clear();
        self.changes.resize(bodies.len(), Change::default());
        for (block, (change, body)) in self.changes.iter_mut().zip(bodies).enumerate() {
            *change = match history.bodies.get(block) {
                _ if body.mass_kg.is_infinite() => {
                    Change { velocity_m_s: body.prescribed_change_m_s, ..Change::default() }
                }
                Some(memory) => memory.change_by_others(body, dt_s),
                None => Change {
                    velocity_m_s: dt_s / body.mass_kg * body.load_n,
                    spin_rad_s: dt_s * (body.inverse_inertia * body.torque_n_m),
                },
            };
        }
        for (t, (touch, push_pa)) in (0..).zip(scene.integrals.touching().iter().zip(&self.push_pa)) {
            let sums = scene.integrals.sums_of(touch);
            let center = scene.center(t);
            let force_n = sums.pressure * push_pa;
            for (block, force_n) in [(touch.owner.index(), force_n), (touch.target.index(), -force_n)] {
                self.changes[block].push(&bodies[block], &center, &force_n, dt_s);
            }
        }
    }

    /// Keeps how each block moves, and what contact pushes it by.
    pub(super) fn remember(&mut self, scene: &DampingScene, history: &mut ContactHistory) {
        let ContactInput { bodies, dt_s, .. } = *scene.input;
        history.bodies.clear();
        history.bodies.extend(bodies.iter().map(|body| BodyMemory::new(body, dt_s)));
        for (t, touch) in scene.integrals.touching().iter().enumerate() {
            let sums = scene.integrals.sums_of(touch);
            let center = scene.center(t as u32);
            let force_n = sums.pressure * (self.push_pa[t] - self.taken_pa[t]);
            for (block, sign) in [(touch.owner.index(), 1.0), (touch.target.index(), -1.0)] {
                let memory = &mut history.bodies[block];
                memory.push_n += sign * force_n;
                let torque = (center - bodies[block].center).cross(&force_n) + self.tilt_n_m[t];
                memory.push_torque_n_m += sign * torque;
            }
        }
    }
}

impl BodyMemory {
    /// Change of motion in a step of `dt_s` by all forces but the pushes of contact, if they are those of the last step.
    fn change_by_others(&self, body: &Body, dt_s: f64) -> Change {
        let part = dt_s / self.dt_s;
        let pushed = Change {
            velocity_m_s: dt_s / body.mass_kg * self.push_n,
            spin_rad_s: dt_s * (body.inverse_inertia * self.push_torque_n_m),
        };
        Change {
            velocity_m_s: part * (body.velocity_m_s - self.velocity_m_s) - pushed.velocity_m_s,
            spin_rad_s: part * (body.spin_rad_s - self.spin_rad_s) - pushed.spin_rad_s,
        }
    }
}
