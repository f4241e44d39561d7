//! Units mean nothing: a scene in other units of length, time and mass is the same scene. With powers of two not a bit of any
//! number changes, for all that is computed is exact or rounded alike; of mass four, because square roots are taken of it.

use ndda_io::scene::{
    Contact, Discontinuity, Domain, Fill, Hold, Potential, Region, Rock, Scene, Shape, Whereabouts,
};
use ndda_mesh::Mat3;

use crate::generator::Wanted;
use crate::motion::{Motion, run};
use crate::random::Random;
use crate::search::{Found, search, text_of};
use crate::transform::{Map, compare};

/// Factors on lengths, times and masses.
#[derive(Clone, Copy)]
struct Units {
    length: f64,
    time: f64,
    mass: f64,
}

impl Units {
    fn pressure(&self) -> f64 {
        self.mass / (self.length * self.time * self.time)
    }

    fn speed(&self) -> f64 {
        self.length / self.time
    }

    fn force(&self) -> f64 {
        self.mass * self.length / (self.time * self.time)
    }
}

fn times<const N: usize>(v: &mut [f64; N], by: f64) {
    v.iter_mut().for_each(|x| *x *= by);
}

fn scaled(scene: &Scene, units: &Units) -> Scene {
    let mut twin = scene.clone();
    twin.time.step_s *= units.time;
    twin.time.end_s *= units.time;
    times(&mut twin.gravity_m_s2, units.speed() / units.time);
    for material in &mut twin.materials {
        material.young_pa *= units.pressure();
        material.density_kg_m3 *= units.mass / units.length.powi(3);
        material.damping.mass_per_s /= units.time;
        material.damping.stiffness_s *= units.time;
    }
    for block in &mut twin.blocks {
        shape(&mut block.shape, units.length);
        times(&mut block.at_m, units.length);
        times(&mut block.velocity_m_s, units.speed());
        times(&mut block.spin_rad_s, 1.0 / units.time);
    }
    twin.rock.iter_mut().for_each(|rock| cut(rock, units.length));
    contact(&mut twin, units);
    loads(&mut twin, units);
    twin
}

fn shape(shape: &mut Shape, length: f64) {
    match shape {
        Shape::Box { size_m, .. } => times(size_m, length),
        Shape::Prism { outline_m, height_m, .. } => {
            outline_m.iter_mut().for_each(|corner| times(corner, length));
            *height_m *= length;
        }
        Shape::Cylinder { radius_m, height_m, .. } => {
            *radius_m *= length;
            *height_m *= length;
        }
        Shape::Sphere { radius_m, .. } => *radius_m *= length,
        Shape::Polyhedron { corners_m, fill, .. } => {
            assert!(matches!(fill, Fill::Fewest | Fill::Centre), "no other is made");
            corners_m.iter_mut().for_each(|corner| times(corner, length));
        }
        other => panic!("{other:?} is not made"),
    }
}

fn cut(rock: &mut Rock, length: f64) {
    if let Domain::Box { min_m, max_m } = &mut rock.domain {
        times(min_m, length);
        times(max_m, length);
    }
    rock.sliver_width_m *= length;
    rock.voronoi.iter_mut().for_each(|voronoi| voronoi.least_distance_m *= length);
    for joint in &mut rock.joints {
        if let Discontinuity::Set { spacing_m, origin_m, .. } = joint {
            *spacing_m *= length;
            times(origin_m, length);
        }
    }
    for place in &mut rock.fixed {
        if let Whereabouts::Beyond { point_m, .. } = place {
            times(point_m, length);
        }
    }
}

fn contact(twin: &mut Scene, units: &Units) {
    let Some(Contact::Potential { penalty_pa, potential, friction, .. }) = &mut twin.contact else { return };
    *penalty_pa *= units.pressure();
    match potential {
        Potential::Element => {}
        Potential::Smooth { reference_m } => *reference_m *= units.length,
        Potential::Closure { reference_m, max_closure_m } => {
            *reference_m *= units.length;
            *max_closure_m *= units.length;
        }
        Potential::Volume { reference_m3, .. } => *reference_m3 *= units.length.powi(3),
    }
    if let Some(friction) = friction {
        friction.shear_penalty_pa_m.iter_mut().for_each(|k| *k *= units.pressure() / units.length);
        friction.cohesion_pa *= units.pressure();
        friction.tension_pa *= units.pressure();
    }
}

fn loads(twin: &mut Scene, units: &Units) {
    for support in &mut twin.supports {
        if let Hold::Motion(rows) = &mut support.hold {
            for row in rows {
                row.time_s *= units.time;
                times(&mut row.displacement_m, units.length);
            }
        }
        if let ndda_io::scene::By::Springs { stiffness_n_m: Some(k) } = &mut support.by {
            *k *= units.mass / (units.time * units.time);
        }
        assert!(!matches!(support.on, Region::Plane { .. }), "no other is made");
    }
    for traction in &mut twin.tractions {
        times(&mut traction.traction_pa, units.pressure());
        traction.factor.iter_mut().for_each(|row| row.time_s *= units.time);
    }
    twin.forces.iter_mut().for_each(|force| times(&mut force.force_n, units.force()));
}

/// The motion in the old units.
fn back(motion: &Motion, units: &Units) -> Motion {
    Motion {
        position: motion.position.iter().map(|x| x / units.length).collect(),
        velocity: motion.velocity.iter().map(|v| v / units.speed()).collect(),
    }
}

#[test]
fn scaled_by_powers_of_two_not_a_bit_changes() {
    search("scaled", 40, &Wanted::default(), |case| {
        let mut random = Random::new(!case.seed);
        let mut power = |least, most, of: f64| of.powi(random.whole(least, most) as i32 - 10);
        let units = Units { length: power(4, 16, 2.0), time: power(4, 16, 2.0), mass: power(4, 16, 4.0) };
        let twin = scaled(&case.scene, &units);
        let (here, stopped) = run(&case.text);
        let (there, also) = run(&text_of(&twin));
        let (a, b) = (Motion::of(&here.simulation), back(&Motion::of(&there.simulation), &units));
        if stopped.is_some() == also.is_some() && a.position == b.position && a.velocity == b.velocity {
            return Found::Holds;
        }
        match compare(case, &twin, &Map::of_turn(Mat3::identity()), |motion| back(motion, &units)) {
            Found::Holds => Found::Skipped("holds to rounding"),
            other => other,
        }
    });
}
