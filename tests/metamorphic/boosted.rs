//! Galilei: a scene that flies as a whole, what is fixed included, moves as before in its own frame.

use ndda_io::scene::{Body, Hold, MotionRow, Region, Scene, Step, Support};
use ndda_mesh::{Mat3, Vec3};

use crate::generator::Wanted;
use crate::random::Random;
use crate::search::{Found, search};
use crate::transform::{Map, compare};

/// The scene with a velocity added to all that it holds.
fn boosted(scene: &Scene, boost: [f64; 3]) -> Scene {
    let mut twin = scene.clone();
    let end_s = 2.0 * scene.time.end_s;
    let at = |row: &MotionRow| MotionRow {
        time_s: row.time_s,
        displacement_m: std::array::from_fn(|i| row.displacement_m[i] + row.time_s * boost[i]),
    };
    for support in &mut twin.supports {
        if let Hold::Motion(rows) = &mut support.hold {
            let last = rows.last().map(|row| MotionRow { time_s: end_s, ..row.clone() });
            rows.extend(last);
            rows.iter_mut().for_each(|row| *row = at(row));
        }
    }
    for block in &mut twin.blocks {
        if block.body != Body::Fixed {
            block.velocity_m_s = std::array::from_fn(|i| block.velocity_m_s[i] + boost[i]);
        } else if !scene.supports.iter().any(|support| support.block == block.name) {
            let row = |time_s| at(&MotionRow { time_s, displacement_m: [0.0; 3] });
            twin.supports.push(Support {
                block: block.name.clone(),
                on: Region::All,
                hold: Hold::Motion(vec![row(0.0), row(end_s)]),
                by: ndda_io::scene::By::Elimination,
            });
        }
    }
    twin
}

#[test]
fn boosted_scenes_move_as_before() {
    search("boosted", 40, &Wanted { uncut: true, free: true, ..Wanted::default() }, |case| {
        if case.scene.materials[0].damping.mass_per_s > 0.0 {
            return Found::Skipped("mass damping has a frame of rest");
        }
        if case.scene.time.step != Step::Fixed {
            return Found::Skipped("steps are divided by how far blocks travel");
        }
        let fastest = |v: [f64; 3]| Vec3::from(v).norm();
        let speed_m_s = case.scene.blocks.iter().map(|b| fastest(b.velocity_m_s)).fold(1e-3, f64::max);
        let boost = Random::new(!case.seed).vector(speed_m_s);
        let map = Map { boost_m_s: Vec3::from(boost), ..Map::of_turn(Mat3::identity()) };
        compare(case, &boosted(&case.scene, boost), &map, Clone::clone)
    });
}
