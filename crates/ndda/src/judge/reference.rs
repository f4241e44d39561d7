//! Closed forms that a run is compared with. Each is a short function of its own with its source.

use ndda_io::scene::{Contact, Reference, Scene};
use ndda_mesh::{BlockId, Vec3};
use ndda_solver::Simulation;
use serde::{Deserialize, Serialize};

use crate::run::monitor::Monitor;

/// s(t) of a rigid block on a ramp, ½ (sin α − μ cos α) g t², or 0 where it sticks [m] (paper, eq 20).
pub fn slide_m(slope_deg: f64, friction: f64, gravity_m_s2: f64, time_s: f64) -> f64 {
    let (sin, cos) = slope_deg.to_radians().sin_cos();
    0.5 * (sin - friction * cos).max(0.0) * gravity_m_s2 * time_s * time_s
}

/// s(t) of a rigid block of thickness L on a ramp whose friction begins as a shear spring of k_s [Pa/m]:
/// u = (g sin α / ω²)(1 − cos ωt) with ω² = k_s/(ρL) until ωt₁ = acos(1 − μ cot α), then ½ a (t − t₁)² on top.
pub fn slide_after_sticking_m(
    slope_deg: f64,
    friction: f64,
    gravity_m_s2: f64,
    omega_rad_s: f64,
    time_s: f64,
) -> f64 {
    let (sin, cos) = slope_deg.to_radians().sin_cos();
    let amplitude = gravity_m_s2 * sin / (omega_rad_s * omega_rad_s);
    let stick = |t: f64| amplitude * (1.0 - (omega_rad_s * t).cos());
    let slips_at = 1.0 - friction * cos / sin;
    if slips_at < -1.0 {
        return stick(time_s);
    }
    let slip_s = slips_at.acos() / omega_rad_s;
    if time_s <= slip_s {
        return stick(time_s);
    }
    let speed = amplitude * omega_rad_s * (omega_rad_s * slip_s).sin();
    let since = time_s - slip_s;
    stick(slip_s) + speed * since + 0.5 * (sin - friction * cos) * gravity_m_s2 * since * since
}

/// Velocities after a central elastic collision [m/s]: momentum and kinetic energy are kept.
pub fn collide_m_s(mass_kg: [f64; 2], velocity_m_s: [f64; 2]) -> [f64; 2] {
    let ([a, b], [va, vb]) = (mass_kg, velocity_m_s);
    let total = a + b;
    [((a - b) * va + 2.0 * b * vb) / total, ((b - a) * vb + 2.0 * a * va) / total]
}

/// Displacement in free flight, v₀ t + ½ g t² [m].
pub fn fall_m(velocity_m_s: &Vec3, gravity_m_s2: &Vec3, time_s: f64) -> Vec3 {
    velocity_m_s * time_s + 0.5 * gravity_m_s2 * time_s * time_s
}

/// Mean velocity [m/s] of an elastic bar of length L that flies at `speed_m_s`, touches a rigid wall at `touch_s` and is
/// pressed by ρ c v₀ while its wave of speed c runs there and back (Doyen, Ern & Piperno 2011).
pub fn bar_impact_m_s(speed_m_s: f64, touch_s: f64, there_and_back_s: f64, time_s: f64) -> f64 {
    let part = ((time_s - touch_s) / there_and_back_s).clamp(0.0, 1.0);
    speed_m_s * (1.0 - 2.0 * part)
}

/// Relative errors at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// Against the closed form.
    pub plain: f64,
    /// Against the closed form with the stick stage of the shear spring, where it applies.
    pub stick_stage: Option<f64>,
    /// After a collision: distance from where hard blocks would be, over the smallest tetrahedron height.
    pub place: Option<f64>,
}

/// A closed form bound to the blocks and monitors of a run.
pub enum Comparison {
    /// A block on a ramp.
    Slide {
        /// Index of the monitor.
        monitor: usize,
        /// Unit vector down the slope.
        downhill: Vec3,
        /// α [°].
        slope_deg: f64,
        /// μ.
        friction: f64,
        /// g [m/s²].
        gravity_m_s2: f64,
        /// ω of the shear spring [rad/s].
        omega_rad_s: Option<f64>,
    },
    /// Two blocks that collide.
    Collision {
        /// The blocks.
        blocks: [BlockId; 2],
        /// Unit vector along the line of motion.
        along: Vec3,
        /// Their final velocities [m/s].
        after_m_s: [f64; 2],
        /// Their velocities at the start [m/s].
        before_m_s: [f64; 2],
        /// Their distance at the start along the line [m].
        gap_m: f64,
        /// Smallest height of their tetrahedra [m].
        height_m: f64,
    },
    /// Free flight.
    Fall {
        /// Index of the monitor.
        monitor: usize,
        /// v₀ [m/s].
        velocity_m_s: Vec3,
        /// g [m/s²].
        gravity_m_s2: Vec3,
    },
    /// Free spin.
    Spin {
        /// The block.
        block: BlockId,
        /// L about its mass centre at the start [kg m²/s].
        start: Vec3,
    },
    /// A bar that hits a wall.
    Impact {
        /// The bar.
        block: BlockId,
        /// Its unit axis.
        along: Vec3,
        /// Its velocity at the start [m/s].
        speed_m_s: f64,
        /// When it touches the wall [s].
        touch_s: f64,
        /// 2 L/c [s].
        there_and_back_s: f64,
    },
    /// A known displacement.
    Displacement {
        /// Index of the monitor.
        monitor: usize,
        /// Exact value [m].
        exact_m: Vec3,
    },
}

/// Mass-mean velocity of a block [m/s].
pub fn block_velocity(simulation: &Simulation, block: BlockId) -> Vec3 {
    let operator = &simulation.shape(block).operator;
    let range = simulation.blocks().nodes_of(block);
    operator.momentum(&simulation.state().velocity[range]) / operator.mass_kg
}

/// Mass-mean displacement of a block since the start [m].
fn block_displacement(simulation: &Simulation, block: BlockId) -> Vec3 {
    let operator = &simulation.shape(block).operator;
    let range = simulation.blocks().nodes_of(block);
    operator.center(&simulation.state().position[range.clone()])
        - operator.center(&simulation.start_position()[range])
}

/// Distance from the first block to the second along a line [m].
fn gap_m(simulation: &Simulation, blocks: [BlockId; 2], along: &Vec3) -> f64 {
    let places = blocks.map(|block| {
        let nodes = &simulation.state().position[simulation.blocks().nodes_of(block)];
        nodes
            .iter()
            .map(|x| x.dot(along))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), s| (a.min(s), b.max(s)))
    });
    places[1].0 - places[0].1
}

/// Angular momentum of a block about its mass centre [kg m²/s].
pub fn block_spin(simulation: &Simulation, block: BlockId) -> Vec3 {
    let operator = &simulation.shape(block).operator;
    let range = simulation.blocks().nodes_of(block);
    let (position, velocity) =
        (&simulation.state().position[range.clone()], &simulation.state().velocity[range]);
    operator.angular_momentum(&operator.center(position), position, velocity)
}

impl Comparison {
    /// Binds the scene's reference to a simulation at its start; names were checked before.
    pub fn new(scene: &Scene, simulation: &Simulation, monitors: &[Monitor]) -> Option<Self> {
        let monitor = |name: &str| monitors.iter().position(|m| m.name == name).expect("a checked name");
        let block = |name: &str| simulation.blocks().find(name).expect("a checked name");
        Some(match scene.reference.as_ref()? {
            Reference::SlidingBlock {
                monitor: name, downhill, slope_deg, friction_deg, thickness_m, ..
            } => Self::Slide {
                monitor: monitor(name),
                downhill: Vec3::from(*downhill).normalize(),
                slope_deg: *slope_deg,
                friction: friction_deg.to_radians().tan(),
                gravity_m_s2: Vec3::from(scene.gravity_m_s2).norm(),
                omega_rad_s: thickness_m.and_then(|l| shear_omega(scene, name, l)),
            },
            Reference::Collision { first, second, along, .. } => {
                let blocks = [block(first), block(second)];
                let along = Vec3::from(*along).normalize();
                let mass = blocks.map(|b| simulation.shape(b).operator.mass_kg);
                let before = blocks.map(|b| block_velocity(simulation, b).dot(&along));
                Self::Collision {
                    blocks,
                    along,
                    after_m_s: collide_m_s(mass, before),
                    before_m_s: before,
                    gap_m: gap_m(simulation, blocks, &along),
                    height_m: f64::min(
                        simulation.shape(blocks[0]).smallest_height_m,
                        simulation.shape(blocks[1]).smallest_height_m,
                    ),
                }
            }
            Reference::FreeFall { monitor: name, .. } => {
                let index = monitor(name);
                let velocity_m_s = monitors[index].velocity(simulation);
                Self::Fall { monitor: index, velocity_m_s, gravity_m_s2: Vec3::from(scene.gravity_m_s2) }
            }
            Reference::FreeSpin { block: name } => {
                Self::Spin { block: block(name), start: block_spin(simulation, block(name)) }
            }
            Reference::BarImpact { block: name, along, length_m, gap_m, .. } => {
                let (block, along) = (block(name), Vec3::from(*along).normalize());
                let speed_m_s = block_velocity(simulation, block).dot(&along);
                let there_and_back_s = 2.0 * length_m / wave_speed_m_s(scene, name)?;
                let touch_s = gap_m / speed_m_s.abs();
                Self::Impact { block, along, speed_m_s, touch_s, there_and_back_s }
            }
            Reference::Displacement { monitor: name, displacement_m, .. } => {
                Self::Displacement { monitor: monitor(name), exact_m: Vec3::from(*displacement_m) }
            }
        })
    }

    /// Relative errors now; `None` where the closed form is zero.
    pub fn errors(&self, simulation: &Simulation, monitors: &[Monitor]) -> Option<Errors> {
        let time_s = simulation.time_s();
        let relative = |error: f64, scale: f64| (scale > 0.0).then_some(error / scale);
        match self {
            Self::Slide { monitor, downhill, slope_deg, friction, gravity_m_s2, omega_rad_s } => {
                let slid = monitors[*monitor].displacement(simulation).dot(downhill);
                let exact = slide_m(*slope_deg, *friction, *gravity_m_s2, time_s);
                // A block that sticks has no path of its own to compare with: take the frictionless one.
                let scale = if exact > 0.0 { exact } else { slide_m(*slope_deg, 0.0, *gravity_m_s2, time_s) };
                let plain = relative((slid - exact).abs(), scale)?;
                let stuck = |omega: f64| {
                    let exact = slide_after_sticking_m(*slope_deg, *friction, *gravity_m_s2, omega, time_s);
                    (slid - exact).abs() / scale
                };
                Some(Errors { plain, stick_stage: omega_rad_s.map(stuck), place: None })
            }
            Self::Collision { blocks, along, after_m_s, before_m_s, gap_m, height_m } => {
                let error =
                    |i: usize| (block_velocity(simulation, blocks[i]).dot(along) - after_m_s[i]).abs();
                let closing_m_s = before_m_s[0] - before_m_s[1];
                let plain = relative(error(0).max(error(1)), closing_m_s.abs())?;
                let hit_s = (gap_m / closing_m_s).max(0.0);
                let place = |i: usize| {
                    let exact = before_m_s[i] * hit_s + after_m_s[i] * (time_s - hit_s);
                    (block_displacement(simulation, blocks[i]).dot(along) - exact).abs() / height_m
                };
                let place = (time_s >= hit_s).then(|| place(0).max(place(1)));
                Some(Errors { plain, stick_stage: None, place })
            }
            Self::Fall { monitor, velocity_m_s, gravity_m_s2 } => {
                let exact = fall_m(velocity_m_s, gravity_m_s2, time_s);
                let error = (monitors[*monitor].displacement(simulation) - exact).norm();
                Some(Errors { plain: relative(error, exact.norm())?, stick_stage: None, place: None })
            }
            Self::Spin { block, start } => {
                let error = (block_spin(simulation, *block) - start).norm();
                Some(Errors { plain: relative(error, start.norm())?, stick_stage: None, place: None })
            }
            Self::Impact { block, along, speed_m_s, touch_s, there_and_back_s } => {
                let exact = bar_impact_m_s(*speed_m_s, *touch_s, *there_and_back_s, time_s);
                let error = (block_velocity(simulation, *block).dot(along) - exact).abs();
                Some(Errors { plain: relative(error, speed_m_s.abs())?, stick_stage: None, place: None })
            }
            Self::Displacement { monitor, exact_m } => {
                let error = (monitors[*monitor].displacement(simulation) - exact_m).norm();
                Some(Errors { plain: relative(error, exact_m.norm())?, stick_stage: None, place: None })
            }
        }
    }
}

/// √(E/ρ) of a block's material [m/s].
fn wave_speed_m_s(scene: &Scene, block: &str) -> Option<f64> {
    let material = &scene.blocks.iter().find(|b| b.name == block)?.material;
    let material = scene.materials.iter().find(|m| m.name == *material)?;
    Some((material.young_pa / material.density_kg_m3).sqrt())
}

/// ω of the shear spring under a block of thickness L, √(k_s/(ρL)); `None` without friction.
fn shear_omega(scene: &Scene, monitor: &str, thickness_m: f64) -> Option<f64> {
    let Some(Contact::Potential { friction: Some(friction), .. }) = &scene.contact else { return None };
    let block = &scene.monitors.iter().find(|m| m.name == monitor)?.block;
    let material = &scene.blocks.iter().find(|b| b.name == *block)?.material;
    let density = scene.materials.iter().find(|m| m.name == *material)?.density_kg_m3;
    Some((friction.shear_penalty_pa_m? / (density * thickness_m)).sqrt())
}

/// Name of a reference and the time from which its largest error counts [s].
pub fn kind(reference: &Reference) -> (&'static str, f64) {
    match reference {
        Reference::SlidingBlock { after_s, .. } => ("SlidingBlock", *after_s),
        Reference::Collision { after_s, .. } => ("Collision", *after_s),
        Reference::FreeFall { after_s, .. } => ("FreeFall", *after_s),
        Reference::FreeSpin { .. } => ("FreeSpin", 0.0),
        Reference::BarImpact { after_s, .. } => ("BarImpact", *after_s),
        Reference::Displacement { after_s, .. } => ("Displacement", *after_s),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_accelerations_come_out() {
        for (slope, friction_deg, acceleration) in
            [(45.0, 0.0, 6.9296), (45.0, 35.0, 2.0775), (30.0, 0.0, 4.9), (30.0, 25.0, 0.9424)]
        {
            let friction = f64::to_radians(friction_deg).tan();
            assert!((2.0 * slide_m(slope, friction, 9.8, 1.0) - acceleration).abs() < 1e-4);
        }
        assert_eq!(slide_m(30.0, f64::to_radians(35.0).tan(), 9.8, 1.0), 0.0);
    }

    #[test]
    fn a_stiff_shear_spring_gives_the_plain_slide() {
        let friction = f64::to_radians(35.0).tan();
        let plain = slide_m(45.0, friction, 9.8, 0.1);
        let sprung = slide_after_sticking_m(45.0, friction, 9.8, 1e9, 0.1);
        assert!((sprung / plain - 1.0).abs() < 1e-6);
        // The offset of the stick stage in the notes: 4.4e-3 for k_s = E, L = 1 m, t = 0.1 s.
        let omega = f64::sqrt(200e9 / 2650.0);
        let error = slide_after_sticking_m(45.0, friction, 9.8, omega, 0.1) / plain - 1.0;
        assert!((error - 4.4e-3).abs() < 1e-4, "{error}");
    }

    #[test]
    fn a_bar_stops_when_its_wave_has_run_to_its_end_and_turns_when_it_is_back() {
        for (time_s, velocity) in [(0.0, -2.0), (1.0, -2.0), (2.0, -1.0), (3.0, 0.0), (5.0, 2.0), (9.0, 2.0)]
        {
            assert_eq!(bar_impact_m_s(-2.0, 1.0, 4.0, time_s), velocity);
        }
    }

    #[test]
    fn collisions_exchange_velocity_or_share_it_by_mass() {
        assert_eq!(collide_m_s([2.0, 2.0], [1.0, 0.0]), [0.0, 1.0]);
        let [a, b] = collide_m_s([2650.0, 1325.0], [1.0, 0.0]);
        assert!((a - 1.0 / 3.0).abs() < 1e-15 && (b - 4.0 / 3.0).abs() < 1e-15);
    }
}
