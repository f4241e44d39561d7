//! Space has no middle: a scene that is moved as a whole moves as before.

use ndda_io::scene::{Domain, Scene, Whereabouts};
use ndda_mesh::{Mat3, Vec3};

use crate::generator::Wanted;
use crate::random::Random;
use crate::search::search;
use crate::transform::{Map, compare};

/// The scene a way further on.
fn shifted(scene: &Scene, shift: [f64; 3]) -> Scene {
    let mut twin = scene.clone();
    let add = |v: &mut [f64; 3]| (0..3).for_each(|i| v[i] += shift[i]);
    twin.blocks.iter_mut().for_each(|block| add(&mut block.at_m));
    for force in twin.forces.iter_mut().filter_map(|force| force.at_m.as_mut()) {
        add(force);
    }
    for rock in &mut twin.rock {
        if let Domain::Box { min_m, max_m } = &mut rock.domain {
            add(min_m);
            add(max_m);
        }
        for place in rock.fixed.iter_mut().chain(&mut rock.removed) {
            match place {
                Whereabouts::Inside { min_m, max_m } => {
                    add(min_m);
                    add(max_m);
                }
                Whereabouts::Beyond { point_m, .. } => add(point_m),
            }
        }
        for joint in &mut rock.joints {
            match joint {
                ndda_io::scene::Discontinuity::Set { origin_m, .. } => add(origin_m),
                ndda_io::scene::Discontinuity::Plane { point_m, .. } => add(point_m),
                ndda_io::scene::Discontinuity::Disc { center_m, .. } => add(center_m),
                // Scenes here have no tables.
                ndda_io::scene::Discontinuity::Discs { .. } => {}
            }
        }
    }
    twin
}

#[test]
fn shifted_scenes_move_as_before() {
    search("shifted", 40, &Wanted::default(), |case| {
        let mut random = Random::new(!case.seed);
        // Farther away the coordinates of the scene have fewer digits, and so another shape.
        let shift = random.vector(100.0);
        let map = Map { shift_m: Vec3::from(shift), ..Map::of_turn(Mat3::identity()) };
        compare(case, &shifted(&case.scene, shift), &map, Clone::clone)
    });
}
