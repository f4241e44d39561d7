//! Runs of one scene at any size, in other units and anywhere.

use ndda::Model;
use ndda_io::code::Code;
use ndda_mesh::Vec3;

use super::{advance, extreme};
use crate::displacements;
use crate::evidence::Answer::AtMost;
use crate::evidence::{rounding, row};

/// Factors on lengths, times and masses.
struct Units {
    length: f64,
    time: f64,
    mass: f64,
}

impl Units {
    /// The glancing collision with every number in these units, or at this size.
    fn scene(&self) -> Model {
        let Self { length: l, time: t, mass: m } = self;
        let vector = |factor: f64, v: [f64; 3]| {
            format!("({:e}, {:e}, {:e})", factor * v[0], factor * v[1], factor * v[2])
        };
        let pressure = m / (l * t * t);
        let set = [
            format!("time.step_s={:e}", 2e-4 * t),
            format!("time.end_s={:e}", 0.1 * t),
            format!("gravity_m_s2={}", vector(l / (t * t), [0.0, 0.0, -9.8])),
            format!("materials.rock.young_pa={:e}", 1e9 * pressure),
            format!("materials.rock.density_kg_m3={:e}", 2500.0 * m / l.powi(3)),
            format!("blocks.a.shape.size_m={}", vector(*l, [1.0, 1.0, 1.0])),
            format!("blocks.a.velocity_m_s={}", vector(l / t, [2.0, 0.0, 0.3])),
            format!("blocks.a.spin_rad_s={}", vector(1.0 / t, [0.5, 2.0, -1.0])),
            format!("blocks.b.shape.size_m={}", vector(*l, [1.0, 0.5, 1.0])),
            format!("blocks.b.at_m={}", vector(*l, [1.01, 0.6, 0.7])),
            format!("contact.penalty_pa={:e}", 1e7 * pressure),
            format!("contact.potential.reference_m={l:e}"),
            format!("contact.friction.shear_penalty_pa_m={:e}", 1e7 * pressure / l),
        ];
        extreme("scale", &set.iter().map(String::as_str).collect::<Vec<_>>())
    }

    /// Displacements over lengths and velocities over speeds of these units after 500 steps.
    fn run(&self) -> Vec<Vec3> {
        let mut simulation = self.scene().simulation;
        advance(&mut simulation, 500);
        let velocity = simulation.state().velocity.iter().map(|v| v * (self.time / self.length));
        displacements(&simulation).iter().map(|u| u / self.length).chain(velocity).collect()
    }
}

/// The largest difference of two lists of vectors over the largest of them.
fn difference(a: &[Vec3], b: &[Vec3]) -> f64 {
    let largest = a.iter().map(|x| x.norm()).fold(0.0, f64::max);
    a.iter().zip(b).map(|(x, y)| (x - y).norm()).fold(0.0, f64::max) / largest
}

#[test]
fn a_collision_is_the_same_at_any_size_and_in_any_units() {
    let metre = Units { length: 1.0, time: 1.0, mass: 1.0 }.run();
    // Stresses are equal, so that times go with lengths, and masses with volumes.
    let size = |l: f64| Units { length: l, time: l, mass: l.powi(3) };
    let units = Units { length: 1e3, time: 1.0, mass: 1e-3 };
    let cases = [
        ("extreme: units and sizes", "1 mm", size(1e-3)),
        ("far blocks, resumed runs, rest", "0.1 m", size(0.1)),
        ("far blocks, resumed runs, rest", "10 m", size(10.0)),
        ("extreme: units and sizes", "1 km", size(1e3)),
        ("extreme: units and sizes", "mm, t, s", units),
    ];
    // The run is the same but for rounding: in each of 500 steps ε of an edge, over the depth of contact, a hundredth of an edge, twentyfold.
    let rounds = 20.0 * rounding(500) / 1e-2;
    for (id, name, other) in cases {
        let what = format!("difference of a collision at 1 m and at {name}, relative");
        row(id, &what, difference(&metre, &other.run()), AtMost(rounds));
    }
}

#[test]
fn a_collision_in_map_coordinates_is_the_one_at_the_origin_until_a_warning_says_otherwise() {
    let moved = |far: f64| {
        let [a, b] = [0.0, 1.06].map(|x| format!("at_m=({}, {far}, {})", x + far, -far));
        extreme("far_away", &[&format!("blocks.a.{a}"), &format!("blocks.b.{b}")])
    };
    let run = |mut ready: Model| {
        advance(&mut ready.simulation, 200);
        displacements(&ready.simulation)
    };
    let here = run(moved(0.0));
    for far in [1e3, 1e6, 4.5e6] {
        let ready = moved(far);
        assert!(ready.loaded.warnings.is_empty(), "{:?}", ready.loaded.warnings);
        let what = format!("difference of a collision here and {far:e} m away, relative");
        // Places in the file are rounded to ε of their distance, once; a hundred times that in what contact makes of the gap.
        let rounds = 100.0 * f64::EPSILON * far;
        row("extreme: map coordinates", &what, difference(&here, &run(ready)), AtMost(rounds));
    }
    let warnings = moved(1e9).loaded.warnings;
    assert!(
        warnings.iter().any(|w| w.code == Code::Inexact && w.message.contains("digits are lost")),
        "{warnings:?}"
    );
}
