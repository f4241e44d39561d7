//! Diagnostics of single blocks: spurious contact energy of the lighter one of each pair, rotation lag, lateral drift, creep, vibration.
//!
//! Energy of all blocks together hides the error of a small one. Contact of a pair brings energy from nowhere where the
//! work of its forces on both blocks differs from the loss of its potential energy. The lighter block is affected: where two collide at v,
//! an error of energy δE is one of its speed δv = δE/(m v), whatever the other weighs.

mod rebounds;
mod stages;
mod start;

use crate::diagnostics::worst::BlockScale;
use crate::diagnostics::worst::Worst;
use ndda_contact::SpringSlip;
use ndda_mesh::{BlockId, Vec3};
use serde::{Deserialize, Serialize};

use crate::bodies::report::LateralDrift;
use crate::bodies::report::RigidForcing;
use crate::diagnostics::creep::CreepDiagnostics;
use crate::diagnostics::free_loads::FreeLoads;
use crate::diagnostics::hops::Hops;
use crate::diagnostics::kept_turn::KeptTurn;
use crate::diagnostics::many::each_of_many;
use crate::diagnostics::rebound::Rebound;
use crate::diagnostics::ringing::{Quadrature, Ringing};
use crate::diagnostics::squeeze::{Fastest, Squeeze};

/// Vibrations of this part of the strain of a block that supports hold leave it at rest.
const AT_REST: f64 = 0.01;

/// Part of ½ m V² that an error of V/100 is measured by where blocks meet at next to no speed: m v δv + ½ m δv².
const SLOW: f64 = 0.005;

/// Energy balance and diagnostics of one block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct BlockBalance {
    /// Work of contact with heavier blocks, on both [J].
    work_j: f64,
    /// Energy of contact with heavier blocks at the last sample [J].
    contact_j: f64,
    /// Work and energy at the first sample [J].
    start_j: f64,
    largest_contact_j: f64,
    /// The work, times m over the reduced mass of each pair [J], and its largest so far.
    impact_work_j: f64,
    largest_impact_work_j: f64,
    /// Farthest that it fell below that: ½ m v² for the speed v of the impact.
    impact_j: f64,
    lasting_gain_j: f64,
    lasting_loss_j: f64,
    /// Energy that Coulomb friction with heavier blocks would have taken from their slips beyond what friction took [J].
    coulomb_gap_j: f64,
    /// Angle by which it is not where its spin would have taken it [rad].
    lag_rad: f64,
    /// How fast that grew at the last sample [rad/s].
    lag_rate_rad_s: f64,
    /// Rate of rotation at the last sample [rad/s], and its integral [rad], where lumped masses make it inexact.
    lumped_spin_rad_s: Vec3,
    lumped_turn_rad: Vec3,
    /// Largest error of a velocity [m/s] and of a place [m] for that.
    lumped_m_s: f64,
    lumped_m: f64,
    /// Unresolved lateral velocity of its mass centre and of its rotation [m/s], the largest, and the drift that they add up to [m].
    shift_m_s: Vec3,
    turn_m_s: Vec3,
    largest_lateral_m_s: f64,
    shift_m: Vec3,
    turn_m: Vec3,
    largest_lateral_m: f64,
    /// Elastic energy at the first sample, and at the last [J].
    strain_start_j: f64,
    strain_j: f64,
    /// Errors left by vibration and jumps of forces.
    ringing: Ringing,
    hops: Hops,
    squeeze: Squeeze,
    rebound: Rebound,
    free_loads: FreeLoads,
}

/// Energy balances and diagnostics of all blocks.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct BlockDiagnostics {
    scales: Vec<BlockScale>,
    balances: Vec<BlockBalance>,
    begun: bool,
    /// Whether contact is solved for: a collision may be over within a step then, and its speed is not resolved.
    solves_contact: bool,
    /// Largest error of a velocity for being turned too little [m/s].
    turned_m_s: f64,
    kept_turn: KeptTurn,
    creep: CreepDiagnostics,
}

impl BlockDiagnostics {
    /// No balances yet.
    pub(crate) fn new(scales: Vec<BlockScale>, solves_contact: bool) -> Self {
        let balances = vec![BlockBalance::default(); scales.len()];
        Self {
            scales,
            balances,
            begun: false,
            solves_contact,
            turned_m_s: 0.0,
            kept_turn: KeptTurn::default(),
            creep: CreepDiagnostics::default(),
        }
    }

    /// Number of blocks.
    pub(crate) fn len(&self) -> usize {
        self.balances.len()
    }

    fn lighter(&self, a: BlockId, b: BlockId) -> usize {
        let (first, second) = (a.min(b).index(), a.max(b).index());
        if self.scales[second].weight() < self.scales[first].weight() { second } else { first }
    }

    /// Records the work of contact between two blocks, on both [J].
    pub(crate) fn add_work(&mut self, a: BlockId, b: BlockId, work_j: f64) {
        let lighter = self.lighter(a, b);
        let heavier = if lighter == a.index() { b.index() } else { a.index() };
        let balance = &mut self.balances[lighter];
        balance.work_j += work_j;
        balance.impact_work_j +=
            work_j * (1.0 + self.scales[lighter].mass_kg / self.scales[heavier].weight());
    }

    /// Records the deviation of friction between two blocks from Coulomb's law in a step [J].
    pub(crate) fn add_coulomb_gap(&mut self, a: BlockId, b: BlockId, gap_j: f64) {
        let lighter = self.lighter(a, b);
        self.balances[lighter].coulomb_gap_j += gap_j;
    }

    /// Largest energy by which friction of a lighter block was off Coulomb's law, over ½ m V² or its largest energy of contact; what rounding may have done does not count.
    pub(crate) fn unresolved_friction(&self, speed_m_s: f64, rounding_j: f64) -> Worst {
        let mut worst = Worst::default();
        for (block, (balance, scale)) in self.balances.iter().zip(&self.scales).enumerate() {
            let moving_j = 0.5 * scale.mass_kg * speed_m_s * speed_m_s;
            let energy_j = moving_j.max(balance.largest_contact_j);
            let gap_j = balance.coulomb_gap_j - rounding_j;
            if gap_j > 0.0 && energy_j > 0.0 {
                worst.take(gap_j / energy_j, block);
            }
        }
        worst
    }

    /// Records the shear spring of a facet of `owner` in a step.
    pub(crate) fn add_spring_slip(&mut self, owner: BlockId, target: BlockId, spring: &SpringSlip) {
        self.creep.make_room(self.scales.len());
        // Of two equal ones the second counts, which may lie on the first.
        let lies_on = self.scales[target.index()].weight() < self.scales[owner.index()].weight();
        let ties = self.scales[target.index()].weight() == self.scales[owner.index()].weight();
        let (lighter, sign) = if lies_on || (ties && target > owner) { (target, -1.0) } else { (owner, 1.0) };
        self.creep.add(lighter, sign, spring);
    }

    /// Ends a step of shear springs.
    pub(crate) fn close_springs(&mut self, dt_s: f64) {
        self.creep.close_step(dt_s);
    }

    /// Largest speed of creep over a speed, and largest place over the smallest height of the block's tetrahedra.
    pub(crate) fn creep(&self, speed_m_s: f64) -> (Worst, Worst) {
        self.creep.worst(&self.scales, speed_m_s)
    }

    /// Keeps the energy of impact on each block, once all work of a step is recorded.
    pub(crate) fn close_step(&mut self) {
        each_of_many(&mut self.balances, |_, balance| {
            balance.largest_impact_work_j = balance.largest_impact_work_j.max(balance.impact_work_j);
            balance.impact_j = balance.impact_j.max(balance.largest_impact_work_j - balance.impact_work_j);
        });
    }

    /// Forgets the energies of contact before new ones are noted.
    pub(crate) fn clear_energies(&mut self) {
        self.balances.iter_mut().for_each(|balance| balance.contact_j = 0.0);
    }

    /// Notes the energy of contact between two blocks [J].
    pub(crate) fn add_energy(&mut self, a: BlockId, b: BlockId, energy_j: f64) {
        let lighter = self.lighter(a, b);
        self.balances[lighter].contact_j += energy_j;
    }

    /// Balances work against energies; `comes_back` is the part of contact's energy that explicit steps hold back.
    pub(crate) fn balance(&mut self, comes_back: f64) {
        for balance in &mut self.balances {
            let sum_j = balance.work_j + balance.contact_j;
            if !self.begun {
                balance.start_j = sum_j;
            }
            let (error_j, back_j) = (sum_j - balance.start_j, comes_back * balance.contact_j);
            balance.largest_contact_j = balance.largest_contact_j.max(balance.contact_j);
            balance.lasting_gain_j = balance.lasting_gain_j.max(error_j - back_j);
            balance.lasting_loss_j = balance.lasting_loss_j.max(-error_j - back_j);
        }
        self.begun = true;
    }

    /// Notes the elastic energy of a block [J].
    pub(crate) fn note_strain(&mut self, block: BlockId, energy_j: f64) {
        let balance = &mut self.balances[block.index()];
        balance.strain_j = energy_j.abs();
        if !self.begun {
            balance.strain_start_j = balance.strain_j;
        }
    }

    /// Square of the speed at which a block would have the elastic energy that it began with or, where vibrations die out, that it has
    /// now [m²/s²]. In a block that supports alone hold, that energy never becomes motion: a hundredth of the speed counts.
    pub(crate) fn strain_speed2(&self, block: BlockId, die_out: bool) -> f64 {
        let (balance, scale) = (&self.balances[block.index()], &self.scales[block.index()]);
        let borne_j =
            if die_out { balance.strain_start_j.max(balance.strain_j) } else { balance.strain_start_j };
        let part = if balance.ringing.is_clamped() { AT_REST * AT_REST } else { 1.0 };
        2.0 * part * borne_j / scale.mass_kg
    }

    /// Records how far a block's rotation lags, `since_s` after the last sample, at a spin [rad/s] and a rate [rad/s] now.
    pub(crate) fn add_lag(&mut self, block: BlockId, since_s: f64, spin_rad_s: f64, rate_rad_s: f64) {
        let (balance, scale) = (&mut self.balances[block.index()], &self.scales[block.index()]);
        balance.lag_rad += 0.5 * since_s * (balance.lag_rate_rad_s + rate_rad_s);
        balance.lag_rate_rad_s = rate_rad_s;
        self.turned_m_s = self.turned_m_s.max(balance.lag_rad * spin_rad_s * scale.radius_m);
    }

    /// Records an angle [rad] and a rate of rotation [rad/s] of a block that is computed as if it did not turn.
    pub(crate) fn add_kept_turn(&mut self, block: BlockId, turn_rad: f64, spin_rad_s: f64) {
        self.kept_turn.add(block, &self.scales[block.index()], turn_rad, spin_rad_s);
    }

    /// Errors of blocks that turn though they are computed as if they did not.
    pub(crate) fn kept_turn(&self) -> &KeptTurn {
        &self.kept_turn
    }

    /// Records the rotation of a block whose inertia is wrong by a part of it, `since_s` after the last sample, at a rate of rotation [rad/s] now:
    /// under given torques its rate of rotation and the angle that it turns by are wrong by as much.
    pub(crate) fn add_lumped_turn(&mut self, block: BlockId, since_s: f64, spin_rad_s: Vec3, error: f64) {
        let (balance, scale) = (&mut self.balances[block.index()], &self.scales[block.index()]);
        balance.lumped_turn_rad += 0.5 * since_s * (balance.lumped_spin_rad_s + spin_rad_s);
        balance.lumped_spin_rad_s = spin_rad_s;
        let radius_m = error * scale.radius_m;
        balance.lumped_m_s = balance.lumped_m_s.max(radius_m * spin_rad_s.norm());
        balance.lumped_m = balance.lumped_m.max(radius_m * balance.lumped_turn_rad.norm());
    }

    /// Largest error of a velocity for lumped masses over a speed, and of a place over the smallest height of the block's tetrahedra; what rounding
    /// may have done does not count.
    pub(crate) fn lumped(&self, speed_m_s: f64, rounding_j: f64) -> (Worst, Worst) {
        let (mut speed, mut place) = (Worst::default(), Worst::default());
        for (block, (balance, scale)) in self.balances.iter().zip(&self.scales).enumerate() {
            if 0.5 * scale.mass_kg * balance.lumped_m_s * balance.lumped_m_s > rounding_j {
                speed.take(balance.lumped_m_s / speed_m_s, block);
                place.take(balance.lumped_m / scale.height_m, block);
            }
        }
        (speed, place)
    }

    /// Records the forcing of each block in a step, and with it the error that the step leaves.
    pub(crate) fn add_ringing<'a>(
        &mut self,
        (step, fastest): (&Quadrature, &Fastest),
        drive_of: impl Fn(usize) -> &'a RigidForcing + Sync,
    ) {
        let Self { scales, balances, .. } = self;
        each_of_many(balances, |block, balance| {
            let drive = drive_of(block);
            balance.ringing.add(step, drive);
            balance.hops.add(step.dt_s, drive);
            balance.squeeze.close_step(step.dt_s, (scales[block].mass_kg, drive), fastest);
            balance.free_loads.add(step, drive);
            balance.rebound.add(step.dt_s, drive, scales[block].deforms);
        });
    }

    /// Records the lateral drift of a clamped block in a step.
    pub(crate) fn add_lateral_drift(&mut self, block: BlockId, dt_s: f64, drift: &LateralDrift) {
        let balance = &mut self.balances[block.index()];
        balance.shift_m_s += drift.shift_m_s;
        balance.turn_m_s += drift.turn_m_s;
        balance.shift_m += dt_s * balance.shift_m_s;
        balance.turn_m += dt_s * balance.turn_m_s;
        let larger = |shift: &Vec3, turn: &Vec3| shift.norm().max(turn.norm());
        balance.largest_lateral_m_s =
            balance.largest_lateral_m_s.max(larger(&balance.shift_m_s, &balance.turn_m_s));
        balance.largest_lateral_m = balance.largest_lateral_m.max(larger(&balance.shift_m, &balance.turn_m));
    }

    /// Largest unresolved lateral velocity of a block, over a speed, and largest lateral drift, over the smallest height of the block's
    /// tetrahedra; what rounding may have done does not count.
    pub(crate) fn lateral_drift(&self, speed_m_s: f64, rounding_j: f64) -> (Worst, Worst) {
        let (mut speed, mut place) = (Worst::default(), Worst::default());
        for (block, (balance, scale)) in self.balances.iter().zip(&self.scales).enumerate() {
            let lateral_m_s = balance.largest_lateral_m_s;
            if 0.5 * scale.mass_kg * lateral_m_s * lateral_m_s > rounding_j {
                speed.take(lateral_m_s / speed_m_s, block);
                place.take(balance.largest_lateral_m / scale.height_m, block);
            }
        }
        (speed, place)
    }

    /// Largest lasting gain and loss of a lighter block, over ½ m v V; what rounding may have done does not count. V is the largest speed of
    /// the run, v that of the impact, or V where that is not resolved. Where contact stores more than ½ m V², that is what counts.
    pub(crate) fn lasting(&self, speed_m_s: f64, rounding_j: f64) -> (Worst, Worst) {
        let (mut gain, mut loss) = (Worst::default(), Worst::default());
        for (block, (balance, scale)) in self.balances.iter().zip(&self.scales).enumerate() {
            let moving_j = 0.5 * scale.mass_kg * speed_m_s * speed_m_s;
            let unresolved_j = if self.solves_contact { moving_j } else { 0.0 };
            let impact_j = balance.impact_j.max(balance.largest_contact_j).max(unresolved_j);
            let energy_j =
                if impact_j < moving_j { (impact_j * moving_j).sqrt() } else { impact_j } + SLOW * moving_j;
            let over = |error_j: f64| {
                let counts = error_j > rounding_j && energy_j > 0.0;
                if counts { (error_j - rounding_j) / energy_j } else { 0.0 }
            };
            gain.take(over(balance.lasting_gain_j), block);
            loss.take(over(balance.lasting_loss_j), block);
        }
        (gain, loss)
    }

    /// Largest error of a place for being turned too little, over the smallest height of the block's tetrahedra.
    pub(crate) fn turned_over_height(&self) -> Worst {
        let mut worst = Worst::default();
        for (block, (balance, scale)) in self.balances.iter().zip(&self.scales).enumerate() {
            worst.take(balance.lag_rad * scale.radius_m / scale.height_m, block);
        }
        worst
    }

    /// Largest error of a velocity for being turned too little [m/s].
    pub(crate) fn turned_m_s(&self) -> f64 {
        self.turned_m_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn balances() -> BlockDiagnostics {
        let scale =
            |mass_kg, is_held| BlockScale { mass_kg, is_held, deforms: true, radius_m: 2.0, height_m: 0.5 };
        BlockDiagnostics::new(vec![scale(1e6, false), scale(2.0, false), scale(1.0, true)], false)
    }

    #[test]
    fn the_lighter_of_two_answers_for_what_contact_makes() {
        let mut balances = balances();
        balances.balance(0.0);
        // A block of 2 kg meets a held one at 5 m/s, and leaves it with 1 J more than it came with.
        balances.add_work(BlockId(1), BlockId(2), -25.0);
        balances.close_step();
        balances.add_work(BlockId(2), BlockId(1), 26.0);
        balances.close_step();
        balances.balance(0.0);
        let (gain, loss) = balances.lasting(10.0, 0.0);
        assert_eq!((gain, loss), (Worst { value: 1.0 / 50.5, block: 1 }, Worst::default()));
        assert_eq!(balances.lasting(10.0, 0.5).0.value, 0.5 / 50.5);
        assert_eq!(balances.lasting(1.0, 0.0).0.value, 1.0 / 25.005);
        balances.solves_contact = true;
        assert_eq!(balances.lasting(10.0, 0.0).0.value, 1.0 / 100.5);
    }

    #[test]
    fn what_contact_stores_is_not_lost() {
        let mut balances = balances();
        balances.balance(0.25);
        balances.add_work(BlockId(0), BlockId(1), -8.0);
        balances.add_energy(BlockId(0), BlockId(1), 8.0);
        balances.balance(0.25);
        assert_eq!(balances.lasting(1.0, 0.0), (Worst::default(), Worst::default()));
        // 2 J are missing while 8 J are stored: that part comes back. Once it is over, they are lost.
        balances.add_work(BlockId(0), BlockId(1), -2.0);
        balances.balance(0.25);
        assert_eq!(balances.lasting(1.0, 0.0).1.value, 0.0);
        balances.clear_energies();
        balances.add_work(BlockId(0), BlockId(1), 8.0);
        balances.balance(0.25);
        assert_eq!(balances.lasting(1.0, 0.0).1, Worst { value: 2.0 / 8.005, block: 1 });
    }

    #[test]
    fn a_lag_grows_by_the_mean_rate_and_moves_nodes_by_the_radius() {
        let mut balances = balances();
        balances.add_lag(BlockId(1), 0.0, 3.0, 0.2);
        balances.add_lag(BlockId(1), 0.5, 3.0, 0.4);
        let lag = 0.5 * 0.5 * 0.6;
        assert!((balances.turned_over_height().value - lag * 2.0 / 0.5).abs() < 1e-15);
        assert!((balances.turned_m_s() - lag * 6.0).abs() < 1e-15);
    }
}
