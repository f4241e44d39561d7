//! A triangle extruded along z: ramps, wedges, slabs on joints.

use std::collections::BTreeMap;

use super::{GenerateError, LENGTHS_M, check_cells, check_counts, check_length, fraction};
use crate::{BlockMesh, Vec3};

/// Least area of an outline over its longest edge squared; below it the sign of the area is rounding.
const LEAST_AREA: f64 = 1e-12;

/// A triangle in the x-y plane, corners counter-clockwise, extruded from z = 0 to `height_m`.
///
/// `cells[0]` pieces along each edge of the triangle, `cells[1]` layers along z. Every small prism is cut in
/// three by the order of its nodes, so that neighbours cut their common side along the same diagonal.
/// Node sets: `edge_i` over the edge from corner i to corner i + 1 (`edge_0 edge_1 edge_2`), `z_min`, `z_max`.
///
/// # Errors
/// [`GenerateError`] when the outline is clockwise, flat or not finite, the height is not positive and finite,
/// a number of cells is zero, or the mesh would be too large.
pub fn prism(outline_m: [[f64; 2]; 3], height_m: f64, cells: [u32; 2]) -> Result<BlockMesh, GenerateError> {
    check_outline(&outline_m)?;
    check_length("height", height_m)?;
    check_cells("the edges of the triangle", cells[0])?;
    check_cells("the height", cells[1])?;
    let [n, layers] = cells.map(u128::from);
    check_counts((n + 1) * (n + 2) / 2 * (layers + 1), 3 * n * n * layers)?;
    let outline = Outline { corners_m: outline_m, cells: cells[0] };
    let mut nodes = Vec::new();
    for layer in 0..=cells[1] {
        let z = fraction(height_m, layer, cells[1]);
        nodes.extend(outline.positions().map(|at| {
            let [x, y] = outline.point(at);
            Vec3::new(x, y, z)
        }));
    }
    let node_sets = side_sets(&outline, cells[1]);
    Ok(BlockMesh { nodes, tets: tets(&outline, cells[1]), node_sets, ..BlockMesh::default() })
}

/// The area of the outline [m²], if it is finite, positive and not a line.
fn check_outline(outline_m: &[[f64; 2]; 3]) -> Result<f64, GenerateError> {
    for (corner, &at_m) in outline_m.iter().enumerate() {
        if !at_m.iter().all(|c| c.abs() <= *LENGTHS_M.end()) {
            return Err(GenerateError::Corner { corner, at_m });
        }
    }
    let [a, b, c] = outline_m;
    let edge = |p: &[f64; 2], q: &[f64; 2]| (q[0] - p[0], q[1] - p[1]);
    let ((ux, uy), (vx, vy)) = (edge(a, b), edge(a, c));
    let area_m2 = 0.5 * (ux * vy - uy * vx);
    let length = |(x, y): (f64, f64)| x.hypot(y);
    let edge_m = length(edge(a, b)).max(length(edge(b, c))).max(length(edge(c, a)));
    if edge_m > 0.0 {
        check_length("longest edge of the outline", edge_m)?;
    }
    if area_m2.abs() <= LEAST_AREA * edge_m * edge_m {
        return Err(GenerateError::NoArea { area_m2, edge_m });
    }
    if area_m2 < 0.0 {
        return Err(GenerateError::Clockwise { area_m2 });
    }
    Ok(area_m2)
}

/// The triangle and its subdivision. Node (i, j) is i steps from corner 0 towards 1 and j steps towards 2.
struct Outline {
    corners_m: [[f64; 2]; 3],
    cells: u32,
}

impl Outline {
    /// Nodes of one layer.
    fn len(&self) -> u32 {
        let n = u64::from(self.cells);
        ((n + 1) * (n + 2) / 2) as u32
    }

    /// All (i, j) in the order of their indices.
    fn positions(&self) -> impl Iterator<Item = (u32, u32)> + use<> {
        let n = self.cells;
        (0..=n).flat_map(move |j| (0..=n - j).map(move |i| (i, j)))
    }

    /// Index of node (i, j) in its layer: rows of falling length, one per j.
    fn index(&self, i: u32, j: u32) -> u32 {
        let [i, j, n] = [i, j, self.cells].map(u64::from);
        (j * (2 * n + 3 - j) / 2 + i) as u32
    }

    /// Where node (i, j) is [m]; exact at the corners, and on an edge along x or y exactly on it.
    fn point(&self, (i, j): (u32, u32)) -> [f64; 2] {
        let n = self.cells;
        let [a, b, c] = self.corners_m;
        std::array::from_fn(|axis| {
            let (a, b, c) = (a[axis], b[axis], c[axis]);
            match (i, j) {
                _ if i == n => b,
                _ if j == n => c,
                _ if i + j == n => b + fraction(c - b, j, n),
                _ => a + fraction(b - a, i, n) + fraction(c - a, j, n),
            }
        })
    }

    /// Small triangles by rising index, and whether that order is counter-clockwise.
    fn triangles(&self) -> impl Iterator<Item = ([u32; 3], bool)> {
        self.positions().flat_map(move |(i, j)| {
            let upright = (i + j < self.cells)
                .then(|| ([self.index(i, j), self.index(i + 1, j), self.index(i, j + 1)], true));
            let inverted = (i + j + 1 < self.cells)
                .then(|| ([self.index(i + 1, j), self.index(i, j + 1), self.index(i + 1, j + 1)], false));
            [upright, inverted].into_iter().flatten()
        })
    }
}

/// Each side of a small prism is cut from its lower node below to its higher node above.
fn tets(outline: &Outline, layers: u32) -> Vec<[u32; 4]> {
    let mut tets = Vec::new();
    for layer in 0..layers {
        for (triangle, counter_clockwise) in outline.triangles() {
            let [a, b, c] = triangle.map(|node| node + layer * outline.len());
            let [p, q, r] = [a, b, c].map(|node| node + outline.len());
            for mut tet in [[a, b, c, r], [a, b, r, q], [a, p, q, r]] {
                if !counter_clockwise {
                    tet.swap(1, 2);
                }
                tets.push(tet);
            }
        }
    }
    tets
}

fn side_sets(outline: &Outline, layers: u32) -> BTreeMap<String, Vec<u32>> {
    let n = outline.cells;
    let collect = |is_in: &dyn Fn(u32, u32, u32) -> bool| -> Vec<u32> {
        let all = (0..=layers).flat_map(|layer| outline.positions().map(move |(i, j)| (layer, i, j)));
        (0..).zip(all).filter(|&(_, (layer, i, j))| is_in(layer, i, j)).map(|(node, _)| node).collect()
    };
    BTreeMap::from([
        ("edge_0".into(), collect(&|_, _, j| j == 0)),
        ("edge_1".into(), collect(&|_, i, j| i + j == n)),
        ("edge_2".into(), collect(&|_, i, _| i == 0)),
        ("z_min".into(), collect(&|layer, _, _| layer == 0)),
        ("z_max".into(), collect(&|layer, _, _| layer == layers)),
    ])
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::testing::{check_closed_conforming, surface_area, volume};
    use super::*;

    const RIGHT: [[f64; 2]; 3] = [[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]];

    proptest! {
        #[test]
        fn the_prism_fills_its_volume_and_closes(
            corner in prop::array::uniform2(-100.0..100.0f64),
            edge_m in 0.01..100.0f64,
            ratio in 0.1..5.0f64,
            direction in 0.0..std::f64::consts::TAU,
            angle in 0.1..3.0f64,
            height_m in 0.01..100.0f64,
            cells in prop::array::uniform2(1..6u32),
        ) {
            let to = |length: f64, angle: f64| [corner[0] + length * angle.cos(), corner[1] + length * angle.sin()];
            let outline = [corner, to(edge_m, direction), to(ratio * edge_m, direction + angle)];
            let mesh = prism(outline, height_m, cells).unwrap();
            check_closed_conforming(&mesh);
            let area = check_outline(&outline).unwrap();
            let perimeter: f64 = (0..3)
                .map(|i| (outline[(i + 1) % 3][0] - outline[i][0]).hypot(outline[(i + 1) % 3][1] - outline[i][1]))
                .sum();
            prop_assert!((volume(&mesh) / (area * height_m) - 1.0).abs() < 1e-9);
            prop_assert!((surface_area(&mesh) / (2.0 * area + perimeter * height_m) - 1.0).abs() < 1e-9);
            prop_assert_eq!(crate::validate::problems(&mesh), vec![]);
        }

        #[test]
        fn no_input_panics(
            outline in prop::array::uniform3(prop::array::uniform2(any::<f64>())),
            height_m in any::<f64>(),
            cells in prop::array::uniform2(prop_oneof![0..4u32, (u32::MAX - 2)..=u32::MAX]),
        ) {
            if let Ok(mesh) = prism(outline, height_m, cells) {
                prop_assert!(mesh.nodes.iter().all(|x| x.iter().all(|c| c.is_finite())));
            }
        }
    }

    #[test]
    fn a_prism_has_three_tetrahedra_per_small_prism() {
        assert_eq!(prism(RIGHT, 1.0, [3, 2]).unwrap().tets.len(), 3 * 9 * 2);
    }

    #[test]
    fn node_sets_are_complete_and_on_their_sides() {
        let mesh = prism(RIGHT, 0.7, [3, 2]).unwrap();
        let on = |is_in: &dyn Fn(&Vec3) -> bool| -> Vec<u32> {
            (0..mesh.nodes.len() as u32).filter(|&i| is_in(&mesh.nodes[i as usize])).collect()
        };
        assert_eq!(mesh.node_sets.len(), 5);
        assert_eq!(mesh.node_sets["edge_0"], on(&|x| x.y == 0.0));
        assert_eq!(mesh.node_sets["edge_1"], on(&|x| (3.0 * x.x + 4.0 * x.y - 12.0).abs() < 1e-12));
        assert_eq!(mesh.node_sets["edge_2"], on(&|x| x.x == 0.0));
        assert_eq!(mesh.node_sets["z_min"], on(&|x| x.z == 0.0));
        assert_eq!(mesh.node_sets["z_max"], on(&|x| x.z == 0.7));
        for edge in ["edge_0", "edge_1", "edge_2"] {
            assert_eq!(mesh.node_sets[edge].len(), 4 * 3);
        }
    }

    #[test]
    fn an_edge_along_an_axis_is_exactly_straight() {
        let mesh = prism([[0.1, 0.2], [0.7, 0.2], [0.7, 0.9]], 0.3, [7, 1]).unwrap();
        assert!(mesh.node_sets["edge_0"].iter().all(|&i| mesh.nodes[i as usize].y == 0.2));
        assert!(mesh.node_sets["edge_1"].iter().all(|&i| mesh.nodes[i as usize].x == 0.7));
    }

    #[test]
    fn bad_outlines_heights_and_cells_are_named() {
        let [a, b, c] = RIGHT;
        assert_eq!(prism([a, c, b], 1.0, [1, 1]), Err(GenerateError::Clockwise { area_m2: -6.0 }));
        let line = [a, b, [2.0, 1e-13]];
        assert!(matches!(prism(line, 1.0, [1, 1]), Err(GenerateError::NoArea { .. })));
        assert!(matches!(prism([a, a, a], 1.0, [1, 1]), Err(GenerateError::NoArea { .. })));
        let nan = [a, [f64::NAN, 0.0], c];
        assert!(matches!(prism(nan, 1.0, [1, 1]), Err(GenerateError::Corner { corner: 1, .. })));
        assert!(matches!(prism(RIGHT, 0.0, [1, 1]), Err(GenerateError::Length { .. })));
        assert!(matches!(prism(RIGHT, 1.0, [0, 1]), Err(GenerateError::NoCells { .. })));
        assert!(matches!(prism(RIGHT, 1.0, [1, 0]), Err(GenerateError::NoCells { along: "the height" })));
    }

    #[test]
    fn huge_cell_counts_are_refused_before_anything_is_allocated() {
        for cells in [[u32::MAX; 2], [u32::MAX, 1], [1, u32::MAX]] {
            assert!(matches!(prism(RIGHT, 1.0, cells), Err(GenerateError::TooMany { .. })));
        }
    }
}
