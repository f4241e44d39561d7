//! Mechanics has no handedness: a scene in a mirror moves as the mirror image.

use ndda_io::scene::{Scene, Shape};
use ndda_mesh::{Mat3, NodeId, Vec3};
use ndda_solver::Simulation;

use crate::generator::{Wanted, build};
use crate::motion::Motion;
use crate::search::{Found, search, text_of};
use crate::transform::{Map, by, compare, each_direction, turn_of};

/// The mirror image at x = 0. Axes of turns and spins are no vectors: what is along x stays, what is across changes sign.
fn mirrored(scene: &Scene) -> Scene {
    let mirror = Mat3::from_diagonal(&Vec3::new(-1.0, 1.0, 1.0));
    let mut twin = scene.clone();
    each_direction(&mut twin, &mut |v| by(&mirror, v));
    for block in &mut twin.blocks {
        by(&-mirror, &mut block.spin_rad_s);
        by(&mirror, &mut block.at_m);
        let mut whole = Mat3::identity();
        for turn in &mut block.turns {
            by(&-mirror, &mut turn.axis);
            whole = turn_of(turn.axis.into(), turn.angle_deg).0 * whole;
        }
        // The mirror image of a box lies on the other side of its corner.
        if let Shape::Box { size_m, .. } = block.shape {
            let back = whole * Vec3::new(-size_m[0], 0.0, 0.0);
            block.at_m = (Vec3::from(block.at_m) + back).into();
        }
    }
    for region in
        twin.supports.iter_mut().map(|s| &mut s.on).chain(twin.tractions.iter_mut().map(|t| &mut t.on))
    {
        if let ndda_io::scene::Region::Set(name) = region {
            *name = match name.as_str() {
                "x_min" => "x_max".into(),
                "x_max" => "x_min".into(),
                other => other.into(),
            };
        }
    }
    twin
}

/// For each node of a scene the node of its twin, in the same block, that begins where its image is.
fn images(start: &Simulation, twin: &Simulation, map: &Map) -> Option<Vec<usize>> {
    let (mapped, there) = (map.apply(&Motion::of(start), 0.0).position, Motion::of(twin).position);
    let image = |node: usize| {
        let x = mapped[node];
        let block = start.blocks().block_of(NodeId(node as u32));
        let nodes = twin.blocks().nodes_of(block);
        let distances = nodes.map(|i| ((x - there[i]).norm(), i));
        let nearest = distances.min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.filter(|(far, _)| *far < 1e-9 * (1.0 + x.norm())).map(|(_, i)| i)
    };
    (0..mapped.len()).map(image).collect()
}

#[test]
fn mirrored_scenes_move_as_the_mirror_image() {
    search("mirrored", 40, &Wanted { symmetric: true, uncut: true, ..Wanted::default() }, |case| {
        let map = Map::of_turn(Mat3::from_diagonal(&Vec3::new(-1.0, 1.0, 1.0)));
        let twin = mirrored(&case.scene);
        let start = |text: &str| build(text).unwrap_or_else(|e| panic!("{e}")).simulation;
        let Some(order) = images(&start(&case.text), &start(&text_of(&twin)), &map) else {
            return Found::Fails("the twin is not the mirror image at its start".into());
        };
        compare(case, &twin, &map, |motion| Motion {
            position: order.iter().map(|&i| motion.position[i]).collect(),
            velocity: order.iter().map(|&i| motion.velocity[i]).collect(),
        })
    });
}
