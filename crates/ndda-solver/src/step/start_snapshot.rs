//! A snapshot of the start, which a run keeps to its end, in little memory.

use ndda_mesh::Vec3;

use crate::step::Simulation;
use crate::step::snapshot::Snapshot;

/// A [`Snapshot`] of a simulation at its start, of which it does not keep where nodes are at rest, nor arrays of zeros: of a large scene
/// next to nothing is left.
#[derive(Clone, Debug)]
pub struct StartSnapshot {
    /// What is left.
    snapshot: Snapshot,
    is_at_rest: bool,
    /// Lengths of arrays that were left out: velocities, accelerations, and balances of blocks; zero for those that were not.
    zeros: [usize; 3],
}

/// Takes an array out that is all zeros, and gives its length; leaves any other.
fn take_zeros(values: &mut Vec<Vec3>) -> usize {
    // A negative zero is another number to those who promise the same bits.
    let are_zeros = values.iter().all(|v| v.iter().all(|x| x.to_bits() == 0));
    if are_zeros { std::mem::take(values).len() } else { 0 }
}

impl Simulation {
    /// A copy of all that changes, to be kept for long.
    pub fn start_snapshot(&self) -> StartSnapshot {
        let mut snapshot = self.snapshot();
        let state = &mut snapshot.state;
        let rest = &self.problem.blocks.rest_position;
        let same = |(now, rest): (&Vec3, &Vec3)| now.map(f64::to_bits) == rest.map(f64::to_bits);
        let is_at_rest = state.position.iter().zip(rest).all(same);
        if is_at_rest {
            state.position = Vec::new();
        }
        let zeros = [
            take_zeros(&mut state.velocity),
            take_zeros(&mut state.acceleration),
            snapshot.ledger.blocks().take_empty(),
        ];
        StartSnapshot { snapshot, is_at_rest, zeros }
    }

    /// The snapshot of a start of this simulation.
    pub fn whole(&self, start: &StartSnapshot) -> Snapshot {
        let StartSnapshot { snapshot, is_at_rest, zeros: [velocity, acceleration, balances] } = start;
        let mut snapshot = snapshot.clone();
        if *is_at_rest {
            snapshot.state.position.clone_from(&self.problem.blocks.rest_position);
        }
        for (values, count) in
            [(&mut snapshot.state.velocity, *velocity), (&mut snapshot.state.acceleration, *acceleration)]
        {
            if count > 0 {
                values.resize(count, Vec3::zeros());
            }
        }
        if *balances > 0 {
            snapshot.ledger.blocks().put_empty(*balances);
        }
        snapshot
    }
}
