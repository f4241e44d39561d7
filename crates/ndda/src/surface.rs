//! Visible surface of the blocks: boundary triangles and the edges between faces.

use ndda_io::results::FieldFrame;
use ndda_mesh::Vec3;
use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::surface::boundary_faces;

use crate::run::fields::PRESENT;

/// Faces that meet at less than this angle [°] are drawn as one.
const SMOOTH_DEG: f64 = 20.0;
/// Cell data with the block of each tetrahedron.
pub const BLOCK_ID: &str = "block_id";

/// Surfaces of all blocks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// The points of the frame that are on it.
    pub nodes: Vec<u32>,
    /// Triangles by their places in `nodes`, outward.
    pub triangles: Vec<[u32; 3]>,
    /// The tetrahedron behind each triangle.
    pub tets: Vec<u32>,
    /// The block of each triangle.
    pub blocks: Vec<u32>,
    /// Edges by their places in `nodes`.
    pub edges: Vec<[u32; 2]>,
}

impl Surface {
    /// The surfaces in a frame.
    pub fn new(frame: &FieldFrame) -> Self {
        let faces = boundary_faces(&frame.tets);
        let mut nodes: Vec<u32> = faces.iter().flat_map(|face| face.nodes).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let place = |node: u32| nodes.partition_point(|&n| n < node) as u32;
        let triangles: Vec<[u32; 3]> = faces.iter().map(|face| face.nodes.map(place)).collect();
        let ids = frame.cell_data.get(BLOCK_ID).map(|array| array.values.as_slice()).unwrap_or_default();
        // There are no more blocks than tetrahedra; a damaged file may say so.
        let known = |id: &f64| (0.0..frame.tets.len() as f64).contains(id);
        let block = |tet: u32| ids.get(tet as usize).filter(|id| known(id)).map_or(0, |&id| id as u32);
        let positions: Vec<Vec3> = nodes.iter().map(|&n| frame.points[n as usize]).collect();
        Self {
            tets: faces.iter().map(|face| face.tet).collect(),
            blocks: faces.iter().map(|face| block(face.tet)).collect(),
            edges: edges(&triangles, &positions),
            nodes,
            triangles,
        }
    }

    /// The blocks that are not there in a frame, ascending.
    pub fn absent(&self, frame: &FieldFrame) -> Vec<u32> {
        // Without the numbers of blocks all are one.
        let present = frame.cell_data.get(PRESENT).filter(|_| frame.cell_data.contains_key(BLOCK_ID));
        let Some(present) = present else { return Vec::new() };
        let is_absent = |tet: u32| present.values.get(tet as usize) == Some(&0.0);
        let absent = self.tets.iter().zip(&self.blocks).filter(|(tet, _)| is_absent(**tet));
        let mut absent: Vec<u32> = absent.map(|(_, block)| *block).collect();
        absent.sort_unstable();
        absent.dedup();
        absent
    }

    /// Number of blocks, those without triangles included.
    pub fn block_count(&self) -> usize {
        self.blocks.iter().max().map_or(0, |&last| last as usize + 1)
    }
}

/// Edges of one triangle, of more than two, or of two that meet at an angle.
fn edges(triangles: &[[u32; 3]], positions: &[Vec3]) -> Vec<[u32; 2]> {
    let normals: Vec<Vec3> = triangles
        .iter()
        .map(|corners| triangle_area_vector(&corners.map(|n| positions[n as usize])).normalize())
        .collect();
    let mut sides: Vec<([u32; 2], usize)> = Vec::with_capacity(3 * triangles.len());
    for (i, &[a, b, c]) in triangles.iter().enumerate() {
        sides.extend([[a, b], [b, c], [c, a]].map(|[p, q]| ([p.min(q), p.max(q)], i)));
    }
    sides.sort_unstable();
    let smooth = SMOOTH_DEG.to_radians().cos();
    let is_smooth = |run: &&[([u32; 2], usize)]| match run {
        [(_, i), (_, j)] => normals[*i].dot(&normals[*j]) > smooth,
        _ => false,
    };
    sides.chunk_by(|a, b| a.0 == b.0).filter(|run| !is_smooth(run)).map(|run| run[0].0).collect()
}

#[cfg(test)]
mod tests {
    use ndda_io::results::Array;
    use ndda_mesh::BlockSet;
    use ndda_mesh::generate::{BoxPattern, box_block};

    use super::*;

    fn box_frame(cells: [u32; 3]) -> FieldFrame {
        let mesh = box_block([1.0, 2.0, 3.0], cells, BoxPattern::Six).unwrap();
        let blocks = BlockSet::new(vec![("a".into(), mesh.clone()), ("b".into(), mesh)]).unwrap();
        let ids = blocks.tet_block.iter().map(|b| f64::from(b.0)).collect();
        FieldFrame {
            points: blocks.rest_position.clone(),
            tets: blocks.tets.iter().map(|tet| tet.map(|n| n.0)).collect(),
            cell_data: [(BLOCK_ID.to_string(), Array { components: 1, values: ids })].into(),
            ..FieldFrame::default()
        }
    }

    #[test]
    fn a_box_shows_its_twelve_edges_and_no_diagonal() {
        let surface = Surface::new(&box_frame([1, 1, 1]));
        assert_eq!((surface.triangles.len(), surface.edges.len(), surface.nodes.len()), (24, 24, 16));
        assert_eq!(surface.block_count(), 2);
        assert_eq!(surface.blocks.iter().filter(|&&b| b == 1).count(), 12);
    }

    #[test]
    fn nodes_inside_are_left_out() {
        let frame = box_frame([3, 3, 3]);
        let surface = Surface::new(&frame);
        assert_eq!(frame.points.len() - surface.nodes.len(), 2 * 8);
        assert_eq!(surface.edges.len(), 2 * 12 * 3);
        let area: f64 = surface
            .triangles
            .iter()
            .map(|t| {
                triangle_area_vector(&t.map(|n| frame.points[surface.nodes[n as usize] as usize])).norm()
            })
            .sum();
        assert!((area - 2.0 * 22.0).abs() < 1e-12, "{area}");
    }
}
