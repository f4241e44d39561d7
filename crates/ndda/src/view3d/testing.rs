//! Boxes that have moved, for tests.

use ndda_io::results::{Array, FieldFrame};
use ndda_mesh::generate::{BoxPattern, box_block};
use ndda_mesh::{BlockSet, Vec3};

use super::film::{Colouring, Film, Moment, moving, range};
use crate::surface::{BLOCK_ID, Surface};

/// Lowest corner, size and displacement of a box [m].
pub type Moved = ([f64; 3], [f64; 3], [f64; 3]);

/// Boxes after their displacements, coloured by them.
pub fn boxes(boxes: &[Moved]) -> Film {
    let mesh = |(i, (at, size, _)): (usize, &Moved)| {
        let mut mesh = box_block(*size, [1; 3], BoxPattern::Six).unwrap();
        mesh.nodes.iter_mut().for_each(|x| *x += Vec3::from(*at));
        (format!("box_{i}"), mesh)
    };
    let blocks = BlockSet::new(boxes.iter().enumerate().map(mesh).collect()).unwrap();
    let ids = blocks.tet_block.iter().map(|block| f64::from(block.0)).collect();
    let frame = FieldFrame {
        points: blocks.rest_position.iter().map(|x| x + blocks.origin_m).collect(),
        tets: blocks.tets.iter().map(|tet| tet.map(|node| node.0)).collect(),
        cell_data: [(BLOCK_ID.to_string(), Array { components: 1, values: ids })].into(),
        ..FieldFrame::default()
    };
    let surface = Surface::new(&frame);
    let start: Vec<Vec3> = surface.nodes.iter().map(|&n| frame.points[n as usize]).collect();
    let mut film = Film {
        title: "Boxes".into(),
        start: start.clone(),
        moves: vec![true; boxes.len()],
        colouring: Colouring::Scale {
            label: "displacement".into(),
            unit: "m",
            of_nodes: true,
            with_resting: false,
            range: [0.0; 2],
        },
        moments: Vec::new(),
        moved: None,
        movable: None,
        surface,
    };
    let of_node = film.block_of_node();
    let moved = |node: usize| Vec3::from(boxes[of_node[node] as usize].2);
    let values: Vec<f32> = (0..start.len()).map(|node| moved(node).norm() as f32).collect();
    if let Colouring::Scale { range: ends, .. } = &mut film.colouring {
        *ends = range(values.iter().copied());
    }
    let positions = start.iter().enumerate().map(|(node, x)| x + moved(node)).collect();
    film.moments.push(Moment { time_s: Some(1.0), positions, values, ..Moment::default() });
    film.moves = moving(&film.surface, &film.start, &film.moments);
    film
}
