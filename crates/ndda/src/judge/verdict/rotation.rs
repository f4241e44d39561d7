//! Whether blocks turn as they should.

use ndda_solver::Simulation;

use super::{Entry, PLACE, SPEED, name, warned};

/// A part of a limit that need not be shown.
const NEGLIGIBLE: f64 = 1e-4;

/// Whether blocks have turned as far as their spin takes them.
pub(super) fn turns(simulation: &Simulation) -> [Entry; 2] {
    let worst = simulation.invariants();
    let (place, speed) = (worst.turn_place, worst.turn_speed);
    let where_it_is = format!(
        "block `{}` rotates too far in a step: its surface is misplaced by {:.2} of its smallest element size, limit {PLACE}; reduce step_s",
        name(simulation, place),
        place.value
    );
    let how_fast = format!(
        "a block rotates too far in a step: its velocities may be wrong by {:.1} % of the largest speed, limit {:.0} %; reduce step_s",
        100.0 * speed,
        100.0 * SPEED
    );
    [
        warned("rotation error / element size", place.value, PLACE, where_it_is),
        warned("rotation error / largest speed", speed, SPEED, how_fast),
    ]
}

/// Whether blocks turn wrongly because lumped masses have too large an inertia of rotation.
pub(super) fn lumped_rotation(simulation: &Simulation) -> [Entry; 2] {
    let worst = simulation.invariants();
    let (place, speed) = (worst.lumped_place, worst.lumped_speed);
    let cure = "because lumped masses have too large an inertia of rotation: set mass: Consistent, or use more cells";
    let where_it_is = format!(
        "the rotation of block `{}` may misplace its surface by {:.2} of its smallest element size, limit {PLACE}, {cure}",
        name(simulation, place),
        place.value
    );
    let how_fast = format!(
        "the rotation of block `{}` may be wrong by {:.1} % of the largest speed, limit {:.0} %, {cure}",
        name(simulation, speed),
        100.0 * speed.value,
        100.0 * SPEED
    );
    [
        warned("lumped-mass rotation error / element size", place.value, PLACE, where_it_is),
        warned("lumped-mass rotation error / largest speed", speed.value, SPEED, how_fast),
    ]
}

/// Whether blocks turn though their supports are taken to keep them from it; said only where one turns by more than rounding.
pub(super) fn kept_from_turning(simulation: &Simulation) -> Option<[Entry; 2]> {
    let worst = simulation.invariants();
    let (place, speed) = (worst.kept_turn_place, worst.kept_turn_speed);
    let cure = "because it turns, and is computed as if its supports kept it from turning: hold nodes in all directions instead of by ties, rollers or springs along one \
                direction, or load it less";
    let where_it_is = format!(
        "the surface of block `{}` is misplaced by {:.2} of its smallest element size, limit {PLACE}, {cure}",
        name(simulation, place),
        place.value
    );
    let how_fast = format!(
        "velocities of block `{}` may be wrong by {:.1} % of the largest speed, limit {:.0} %, {cure}",
        name(simulation, speed),
        100.0 * speed.value,
        100.0 * SPEED
    );
    (place.value > NEGLIGIBLE || speed.value > NEGLIGIBLE).then(|| {
        [
            warned("rotation left out / element size", place.value, PLACE, where_it_is),
            warned("rotation left out / largest speed", speed.value, SPEED, how_fast),
        ]
    })
}
