//! The worst hops, rebounds and ringing of all blocks.

use ndda_mesh::{BlockId, Vec3};

use super::{BlockBalance, BlockDiagnostics};
use crate::diagnostics::worst::Worst;

/// Hops at a smaller part of the largest speed are of a time before, when the block was slower.
const FAST: f64 = 0.5;

impl BlockDiagnostics {
    /// Most hops in a row that friction lets grow, and most short hops of a block that deforms. Those of rigid blocks are resolved; hops that rounding may have
    /// made do not count, nor those that are slow beside the largest speed.
    pub(crate) fn hops(&self, largest_m_s: f64, rounding_j: f64) -> (Worst, Worst) {
        let (mut growing, mut short) = (Worst::default(), Worst::default());
        for (block, (balance, scale)) in self.balances.iter().zip(&self.scales).enumerate() {
            growing.take(f64::from(balance.hops.most()), block);
            let (hops, speed_m_s) = balance.hops.short();
            let counts = scale.deforms && speed_m_s > FAST * largest_m_s;
            if counts && 0.5 * scale.mass_kg * speed_m_s * speed_m_s > rounding_j {
                short.take(f64::from(hops), block);
            }
        }
        (growing, short)
    }

    /// Most hops of a block with friction between them that could stop it, or the surface of a block that deforms; hops that rounding may have made do not count, nor those that are slow beside the largest speed.
    pub(crate) fn hops_with_friction(&self, largest_m_s: f64, rounding_j: f64) -> Worst {
        let mut worst = Worst::default();
        for (block, (balance, scale)) in self.balances.iter().zip(&self.scales).enumerate() {
            let (hops, speed_m_s) = balance.hops.with_friction(scale.deforms);
            let counts = speed_m_s > FAST * largest_m_s;
            if counts && 0.5 * scale.mass_kg * speed_m_s * speed_m_s > rounding_j {
                worst.take(f64::from(hops), block);
            }
        }
        worst
    }

    /// Records the normal force on a facet of a block, or of another that presses it [N], under its loads [m/s²].
    pub(crate) fn add_push(&mut self, block: BlockId, push_n: &Vec3, load_m_s2: &Vec3) {
        self.balances[block.index()].squeeze.press(push_n, load_m_s2);
    }

    /// Most times that a block nearly lost and regained the contact that presses it from opposite sides, friction acting; what rounding may have done does not count.
    pub(crate) fn squeezes(&self, rounding_j: f64) -> Worst {
        let mut worst = Worst::default();
        for (block, (balance, scale)) in self.balances.iter().zip(&self.scales).enumerate() {
            let (times, speed_m_s) = balance.squeeze.regained();
            if 0.5 * scale.mass_kg * speed_m_s * speed_m_s > rounding_j {
                worst.take(f64::from(times), block);
            }
        }
        worst
    }

    /// Largest of the second largest impacts of all blocks, over a speed; what rounding may have done does not count.
    pub(crate) fn second_impact(&self, speed_m_s: f64, rounding_j: f64) -> Worst {
        self.worst_speed(|_| speed_m_s, rounding_j, |balance| balance.hops.second_impact_m_s())
    }

    /// Largest impact of all blocks, over a speed; what rounding may have done does not count.
    pub(crate) fn impact(&self, speed_m_s: f64, rounding_j: f64) -> Worst {
        self.worst_speed(|_| speed_m_s, rounding_j, |balance| balance.hops.impact_m_s())
    }

    /// Most that steps may have left of loads that change along the way of a block which nothing touches: of its velocity, over a speed, and of its place, over the smallest
    /// height of its tetrahedra. What rounding may have done does not count.
    pub(crate) fn free_loads(&self, speed_m_s: f64, rounding_j: f64) -> (Worst, Worst) {
        let (mut speed, mut place) = (Worst::default(), Worst::default());
        for (block, (balance, scale)) in self.balances.iter().zip(&self.scales).enumerate() {
            let error_m_s = balance.free_loads.error_m_s();
            if 0.5 * scale.mass_kg * error_m_s * error_m_s > rounding_j {
                speed.take(error_m_s / speed_m_s, block);
                place.take(balance.free_loads.place_m() / scale.height_m, block);
            }
        }
        (speed, place)
    }

    /// Errors that changing loads may leave to a block that nothing touches: of its velocity over a speed, and of its place over its height.
    pub(crate) fn free_loads_of(&self, block: BlockId, speed_m_s: f64) -> (f64, f64) {
        let (balance, scale) = (&self.balances[block.index()], &self.scales[block.index()]);
        (balance.free_loads.error_m_s() / speed_m_s, balance.free_loads.place_m() / scale.height_m)
    }

    /// Largest speed that rebounds of contact have added to a block, over a speed: from the line of its speed, and from its impulse, which holds on one plane only. What
    /// rounding may have done does not count.
    pub(crate) fn rebound(&self, speed_m_s: f64, rounding_j: f64) -> (Worst, Worst) {
        let worst = |of: fn(&BlockBalance) -> f64| self.worst_speed(|_| speed_m_s, rounding_j, of);
        (worst(|balance| balance.rebound.gained_m_s()), worst(|balance| balance.rebound.across_m_s()))
    }

    /// Watches rebounds of all blocks from now on, as friction may have changed.
    pub(crate) fn watch_rebounds_anew(&mut self) {
        self.balances.iter_mut().for_each(|balance| balance.rebound.begin_anew());
    }

    /// Watches rebounds of blocks that have all been brought to rest.
    pub(crate) fn rest_rebounds(&mut self) {
        self.balances.iter_mut().for_each(|balance| balance.rebound.begin_at_rest());
    }

    /// Leaves the rebounds of a block alone to which somebody gives another velocity.
    pub(crate) fn lose_rebound(&mut self, block: BlockId) {
        self.balances[block.index()].rebound.lose();
    }

    /// Largest error of a velocity for ringing, over a speed or that below which a block is at rest; what rounding may have done does not count.
    pub(crate) fn ringing(&self, speed_m_s: f64, rounding_j: f64) -> Worst {
        let over_m_s = |block| speed_m_s.max(self.rest_speed_m_s(block));
        self.worst_speed(over_m_s, rounding_j, |balance| balance.ringing.error_m_s())
    }

    /// Speed below which a block that supports alone hold is at rest: that of vibrations of a hundredth of its strain; zero for others [m/s].
    pub(crate) fn rest_speed_m_s(&self, block: BlockId) -> f64 {
        match self.balances[block.index()].ringing.is_clamped() {
            true => self.strain_speed2(block, true).sqrt(),
            false => 0.0,
        }
    }

    /// Largest of a speed [m/s] of each block over another, where its kinetic energy is more than rounding.
    fn worst_speed(
        &self,
        over_m_s: impl Fn(BlockId) -> f64,
        rounding_j: f64,
        of: impl Fn(&BlockBalance) -> f64,
    ) -> Worst {
        let mut worst = Worst::default();
        for (block, (balance, scale)) in self.balances.iter().zip(&self.scales).enumerate() {
            let own_m_s = of(balance);
            if 0.5 * scale.mass_kg * own_m_s * own_m_s > rounding_j {
                worst.take(own_m_s / over_m_s(BlockId(block as u32)), block);
            }
        }
        worst
    }
}
