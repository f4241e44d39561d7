//! Blocks that creep because shear springs lose slip while contact rings.
//!
//! If the normal force oscillates about a mean N̄, the limit μ N of a spring falls below what the spring carries in each cycle, and what it
//! loses then does not come back, though in the mean it carries less than μ N̄ and a load at rest would be held. A cycle ends where the
//! limit, having been below its mean over the cycle, rises above it; what the spring stretches within it comes back by then. Slip counts as creep in cycles in which springs carry less than
//! they may in the mean, from the second of such cycles in a row: the only one is a block that slides and comes to rest. A
//! cycle of which more than half passes without contact is flight.

use ndda_contact::SpringSlip;
use ndda_mesh::{BlockId, Vec3};
use serde::{Deserialize, Serialize};

use crate::diagnostics::many::each_of_many;
use crate::diagnostics::worst::{BlockScale, Worst};

/// Part of the limit below which springs that are not all sliding could hold; above it a block slides, but for facets at its rim that come and go.
const STICKS: f64 = 0.95;

/// Slip and force of the springs between a block and heavier ones in a step, and in a cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Cycle {
    time_s: f64,
    parted_s: f64,
    /// Integrals over time of the limit, of what springs carry [N s], slip [m], and whether a spring ever slid.
    limit_n_s: f64,
    shear_n_s: f64,
    slip_m: Vec3,
    slides: bool,
    /// Whether the limit has been below its mean.
    has_fallen: bool,
}

impl Cycle {
    /// Whether springs slip, though they carry less than they may in the mean.
    fn creeps(&self) -> bool {
        self.slides && self.shear_n_s < STICKS * self.limit_n_s && self.parted_s <= 0.5 * self.time_s
    }
}

/// The creep of one block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct BlockCreep {
    /// Of the step: limit [N], what springs carry [N], limit times slip [N m], and whether any slides.
    limit_n: f64,
    shear_n: f64,
    slip_n_m: Vec3,
    slides: bool,
    cycle: Cycle,
    /// Whether the cycle before crept.
    crept_before: bool,
    /// Time since springs first touched the block [s].
    time_s: f64,
    crept_m: Vec3,
    farthest_m: f64,
}

impl BlockCreep {
    fn close_step(&mut self, dt_s: f64) {
        let (limit_n, shear_n, slip_n_m) = (self.limit_n, self.shear_n, self.slip_n_m);
        (self.limit_n, self.shear_n, self.slip_n_m) = (0.0, 0.0, Vec3::zeros());
        if self.time_s == 0.0 && limit_n == 0.0 {
            return;
        }
        self.time_s += dt_s;
        let mean_n_s = self.cycle.limit_n_s;
        let is_above = limit_n * self.cycle.time_s > mean_n_s;
        if self.cycle.has_fallen && is_above {
            self.close_cycle();
        }
        let cycle = &mut self.cycle;
        cycle.has_fallen |= limit_n * cycle.time_s < cycle.limit_n_s;
        cycle.time_s += dt_s;
        cycle.limit_n_s += dt_s * limit_n;
        cycle.shear_n_s += dt_s * shear_n;
        cycle.slides |= std::mem::take(&mut self.slides);
        if limit_n > 0.0 {
            cycle.slip_m += slip_n_m / limit_n;
        } else {
            cycle.parted_s += dt_s;
        }
    }

    fn close_cycle(&mut self) {
        let creeps = self.cycle.creeps();
        if creeps && self.crept_before {
            self.crept_m += self.cycle.slip_m;
            self.farthest_m = self.farthest_m.max(self.crept_m.norm());
        }
        self.crept_before = creeps;
        self.cycle = Cycle::default();
    }
}

/// The creep of all blocks; empty until a shear spring touches.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct CreepDiagnostics {
    books: Vec<BlockCreep>,
}

impl CreepDiagnostics {
    /// Makes room for so many blocks, once.
    pub(crate) fn make_room(&mut self, blocks: usize) {
        self.books.resize(blocks, BlockCreep::default());
    }

    /// Records the slip of a spring on the lighter of two blocks; `sign` is −1 where that is the target.
    pub(crate) fn add(&mut self, lighter: BlockId, sign: f64, spring: &SpringSlip) {
        let book = &mut self.books[lighter.index()];
        book.limit_n += spring.capacity_n;
        book.shear_n += spring.shear_n;
        book.slip_n_m += sign * spring.capacity_n * spring.slip_m;
        book.slides |= spring.slides;
    }

    /// Ends a step.
    pub(crate) fn close_step(&mut self, dt_s: f64) {
        each_of_many(&mut self.books, |_, book| book.close_step(dt_s));
    }

    /// Largest speed of creep in the mean since springs first touched, over a speed, and how far it took a block, over the smallest height
    /// of the block's tetrahedra.
    pub(crate) fn worst(&self, scales: &[BlockScale], speed_m_s: f64) -> (Worst, Worst) {
        let (mut speed, mut place) = (Worst::default(), Worst::default());
        for (block, (book, scale)) in self.books.iter().zip(scales).enumerate() {
            if book.farthest_m > 0.0 {
                speed.take(book.crept_m.norm() / book.time_s / speed_m_s, block);
                place.take(book.farthest_m / scale.height_m, block);
            }
        }
        (speed, place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Slip that is recorded as creep [m] where the limit oscillates between `least_n` and 2 N about 1 N, a hundred steps each, twenty times, and
    /// a spring carries `shear_n` or the limit, slipping by a thousandth in each step in which it carries that.
    fn crept_m(least_n: f64, shear_n: f64) -> f64 {
        let mut books = CreepDiagnostics::default();
        books.make_room(1);
        for step in 0..2000 {
            let phase = std::f64::consts::TAU * f64::from(step) / 100.0;
            let capacity_n = 1.0 - (1.0 - least_n) * phase.cos();
            let slides = shear_n >= capacity_n;
            let slip_m = if slides { Vec3::x() * 1e-3 } else { Vec3::zeros() };
            books.add(
                BlockId(0),
                1.0,
                &SpringSlip { capacity_n, shear_n: shear_n.min(capacity_n), slip_m, slides },
            );
            books.close_step(1e-3);
        }
        books.books[0].farthest_m
    }

    #[test]
    fn slip_in_cycles_that_would_be_held_in_the_mean_is_creep() {
        // A limit of 1 − cos is below ½ for a third of the time: 33 steps or so of each of the last 18 cycles.
        let crept = crept_m(0.0, 0.5);
        assert!((17.0 * 0.033..20.0 * 0.034).contains(&crept), "{crept} m");
    }

    #[test]
    fn what_holds_always_or_slides_always_does_not_creep() {
        assert_eq!(crept_m(0.5, 0.4), 0.0);
        assert_eq!(crept_m(0.5, 2.0), 0.0);
    }
}
