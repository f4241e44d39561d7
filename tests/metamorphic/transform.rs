//! Scenes moved as a whole, and compared with what they were.

use ndda_io::scene::{Contact, ContactAt, Hold, Region, Scene, Turn};
use ndda_mesh::{Mat3, Vec3};

use crate::generator::{Case, build};
use crate::motion::{Motion, disturb, extent_m, run};
use crate::search::{Found, text_of};

/// Part of the scene's size and speed by which a twin is disturbed.
const DISTURBED: f64 = 1e-9;
/// Rounding relative to that disturbance: 2e-13 of the size of coordinates, in each of a hundred steps.
const ROUNDING: f64 = 2e-2;
/// Effect of friction on velocities relative to size and speed: it is found to 1e-7 of the largest force in each step, and thus the change of speed by an impact to as much of that.
const FRICTION: f64 = 1e-7;
/// Growth of the disturbance beyond which nothing can be said.
const CHAOS: f64 = 1e5;

/// x' = Q x + t and v' = Q v + u.
pub struct Map {
    pub turn: Mat3,
    pub shift_m: Vec3,
    pub boost_m_s: Vec3,
    /// Effect of friction on velocities relative to size and speed.
    pub friction: f64,
}

impl Map {
    pub fn of_turn(turn: Mat3) -> Self {
        Self { turn, shift_m: Vec3::zeros(), boost_m_s: Vec3::zeros(), friction: FRICTION }
    }

    /// A motion as it is after the map, at a time [s].
    pub fn apply(&self, motion: &Motion, time_s: f64) -> Motion {
        let shift_m = self.shift_m + time_s * self.boost_m_s;
        Motion {
            position: motion.position.iter().map(|x| self.turn * x + shift_m).collect(),
            velocity: motion.velocity.iter().map(|v| self.turn * v + self.boost_m_s).collect(),
        }
    }
}

/// Compares the run of a case, mapped, with that of its twin; `reorder` gives the twin's node for each node.
///
/// Both may be apart by what rounding makes of them: measured by a third run, disturbed by 1e-9 of size and speed.
pub fn compare(case: &Case, twin: &Scene, map: &Map, reorder: impl Fn(&Motion) -> Motion) -> Found {
    let (ready, stopped) = run(&case.text);
    let mut start = build(&case.text).expect("it has been built");
    let begun = build(&text_of(twin));
    if let Ok(begun) = &begun {
        let (mapped, there) =
            (map.apply(&Motion::of(&start.simulation), 0.0), reorder(&Motion::of(&begun.simulation)));
        if mapped.apart(&there, extent_m(&start.simulation), f64::INFINITY) > DISTURBED {
            return Found::Skipped("rock is cut in another order");
        }
    }
    let (steps, length_m) = (ready.simulation.state().step, extent_m(&ready.simulation));
    let end = Motion::of(&ready.simulation);
    let first_m_s = Motion::of(&start.simulation).speed_m_s();
    let speed_m_s = end.speed_m_s().max(first_m_s).max(map.boost_m_s.norm());
    disturb(&mut start.simulation, DISTURBED * length_m, DISTURBED * speed_m_s);
    let disturbed_stop = crate::motion::run_to(&mut start.simulation, steps, steps, 1);
    let (other, other_stop) = run(&text_of(twin));
    match (stopped, other_stop) {
        (Some(_), Some(_)) => return Found::Holds,
        (None, None) => {}
        _ if disturbed_stop.is_some() => return Found::Skipped("stops when disturbed"),
        (a, b) => return Found::Fails(format!("one stops, its twin does not: {a:?} {b:?}")),
    }
    if disturbed_stop.is_some() {
        return Found::Skipped("stops when disturbed");
    }
    let time_s = ready.simulation.time_s();
    let growth = end.apart(&Motion::of(&start.simulation), length_m, speed_m_s) / DISTURBED;
    let found = map.apply(&end, time_s).apart(&reorder(&Motion::of(&other.simulation)), length_m, speed_m_s);
    let farthest_m = |motion: &Motion| motion.position.iter().map(|x| x.amax()).fold(length_m, f64::max);
    let coordinates = farthest_m(&end).max(farthest_m(&reorder(&Motion::of(&other.simulation)))) / length_m;
    let friction = if has_velocity_friction(&case.scene) { map.friction } else { 0.0 };
    let searched = end_search_m_s(&case.scene) / speed_m_s;
    let bound = (ROUNDING * DISTURBED * coordinates + friction + searched) * (1.0 + growth);
    if found <= bound {
        Found::Holds
    } else if growth > CHAOS {
        Found::Skipped("too sensitive to say")
    } else {
        Found::Fails(format!(
            "apart by {found:.2e} of size and speed, rounding explains {bound:.1e}: a disturbance of 1e-9 grows {growth:.1e} times"
        ))
    }
}

/// Error of speeds that the tolerance of contact at the end of the step allows over a whole run [m/s]: each step finds forces to a part of the weight,
/// and thus speeds to that part of g Δt; the errors of all steps add up.
fn end_search_m_s(scene: &Scene) -> f64 {
    let ContactAt::End { tolerance, .. } = scene.time.contact_at else { return 0.0 };
    tolerance * Vec3::from(scene.gravity_m_s2).norm() * scene.time.end_s
}

fn has_velocity_friction(scene: &Scene) -> bool {
    let Some(Contact::Potential { friction: Some(friction), .. }) = &scene.contact else { return false };
    friction.shear_penalty_pa_m.is_none()
}

/// The axis and the angle [°] of a rotation.
pub fn turn_of(axis: Vec3, angle_deg: f64) -> (Mat3, Turn) {
    let axis = axis.normalize();
    let rotation =
        nalgebra::Rotation3::from_axis_angle(&nalgebra::Unit::new_normalize(axis), angle_deg.to_radians());
    (*rotation.matrix(), Turn { axis: axis.into(), angle_deg })
}

/// All vectors of a scene with a direction only: velocities, gravity, loads and motions.
pub fn each_direction(scene: &mut Scene, map: &mut impl FnMut(&mut [f64; 3])) {
    map(&mut scene.gravity_m_s2);
    scene.blocks.iter_mut().for_each(|block| map(&mut block.velocity_m_s));
    scene.tractions.iter_mut().for_each(|traction| map(&mut traction.traction_pa));
    scene.forces.iter_mut().for_each(|force| map(&mut force.force_n));
    for support in &mut scene.supports {
        match &mut support.hold {
            Hold::Direction(direction) | Hold::Acceleration { direction, .. } => map(direction),
            Hold::Motion(rows) => rows.iter_mut().for_each(|row| map(&mut row.displacement_m)),
            Hold::Shaking(parts) => parts.iter_mut().for_each(|part| map(&mut part.direction)),
            Hold::Fixed | Hold::Normal => {}
        }
        if let Region::Plane { normal, .. } = &mut support.on {
            map(normal);
        }
    }
}

/// A matrix on three numbers.
pub fn by(matrix: &Mat3, v: &mut [f64; 3]) {
    *v = (matrix * Vec3::from(*v)).into();
}
