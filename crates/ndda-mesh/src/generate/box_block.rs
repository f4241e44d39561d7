//! A box cut into cells, and cells into tetrahedra.

use std::collections::BTreeMap;

use super::{GenerateError, check_cells, check_counts, check_length, fraction};
use crate::{BlockMesh, Vec3};

/// How a box cell is cut into tetrahedra.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BoxPattern {
    /// Six tetrahedra around one diagonal (Kuhn 1960): fewest elements.
    #[default]
    Six,
    /// Twenty-four around the cell's centre, four on the centre of each face: as symmetric as the cell.
    TwentyFour,
}

/// A box with one corner at the origin, `cells` along its edges.
///
/// Node sets: `x_min x_max y_min y_max z_min z_max`. Nodes at `size · i / n`; opposite sides are exact.
///
/// # Errors
/// [`GenerateError`] when a size is not positive and finite, a number of cells is zero, or the mesh would
/// be too large.
pub fn box_block(size_m: [f64; 3], cells: [u32; 3], pattern: BoxPattern) -> Result<BlockMesh, GenerateError> {
    for (what, value_m) in ["size along x", "size along y", "size along z"].into_iter().zip(size_m) {
        check_length(what, value_m)?;
    }
    for (along, count) in ["x", "y", "z"].into_iter().zip(cells) {
        check_cells(along, count)?;
    }
    let (nodes, tets) = counts(cells, pattern);
    check_counts(nodes, tets)?;
    let (halves, tets) = match pattern {
        BoxPattern::Six => six(cells),
        BoxPattern::TwentyFour => twenty_four(cells),
    };
    let nodes = halves
        .iter()
        .map(|at| Vec3::from_fn(|axis, _| fraction(size_m[axis], at[axis], 2 * cells[axis])))
        .collect();
    Ok(BlockMesh { nodes, tets, node_sets: side_sets(&halves, cells), ..BlockMesh::default() })
}

/// Nodes and tetrahedra that the box would have.
fn counts(cells: [u32; 3], pattern: BoxPattern) -> (u128, u128) {
    let [nx, ny, nz] = cells.map(u128::from);
    let corners = (nx + 1) * (ny + 1) * (nz + 1);
    let cells = nx * ny * nz;
    match pattern {
        BoxPattern::Six => (corners, 6 * cells),
        BoxPattern::TwentyFour => {
            let faces = (nx + 1) * ny * nz + nx * (ny + 1) * nz + nx * ny * (nz + 1);
            (corners + cells + faces, 24 * cells)
        }
    }
}

/// Nodes as positions in half cells, and tetrahedra.
type Halves = (Vec<[u32; 3]>, Vec<[u32; 4]>);

/// A regular arrangement of nodes: `shape` of them from index `first` on, x running fastest.
struct Lattice {
    first: u32,
    shape: [u32; 3],
}

impl Lattice {
    /// Appends nodes at `2 · [i, j, k] + offset` half cells.
    fn new(halves: &mut Vec<[u32; 3]>, shape: [u32; 3], offset: [u32; 3]) -> Self {
        let first = halves.len() as u32;
        halves.extend(
            positions(shape).map(|[i, j, k]| [2 * i + offset[0], 2 * j + offset[1], 2 * k + offset[2]]),
        );
        Self { first, shape }
    }

    fn node(&self, [i, j, k]: [u32; 3]) -> u32 {
        self.first + i + self.shape[0] * (j + self.shape[1] * k)
    }
}

fn positions([nx, ny, nz]: [u32; 3]) -> impl Iterator<Item = [u32; 3]> {
    (0..nz).flat_map(move |k| (0..ny).flat_map(move |j| (0..nx).map(move |i| [i, j, k])))
}

/// Kuhn's cut: each tetrahedron walks from corner 000 to 111 along the axes in one of their six orders.
fn six(cells: [u32; 3]) -> Halves {
    const WALKS: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [1, 0, 2], [0, 2, 1], [2, 1, 0]];
    let mut halves = Vec::new();
    let corners = Lattice::new(&mut halves, cells.map(|n| n + 1), [0; 3]);
    let mut tets = Vec::new();
    for cell in positions(cells) {
        for (walk, axes) in WALKS.into_iter().enumerate() {
            let mut at = cell;
            let mut tet = [corners.node(cell); 4];
            for (step, axis) in axes.into_iter().enumerate() {
                at[axis] += 1;
                tet[step + 1] = corners.node(at);
            }
            // The last three orders are odd permutations: their walk is left-handed.
            if walk >= 3 {
                tet.swap(1, 2);
            }
            tets.push(tet);
        }
    }
    (halves, tets)
}

/// The symmetric cut: cell centre, face centre and one edge of the face. Neighbours share face centres.
fn twenty_four(cells: [u32; 3]) -> Halves {
    let mut halves = Vec::new();
    let corners = Lattice::new(&mut halves, cells.map(|n| n + 1), [0; 3]);
    let centres = Lattice::new(&mut halves, cells, [1; 3]);
    let faces: [Lattice; 3] = std::array::from_fn(|axis| {
        let mut shape = cells;
        let mut offset = [1; 3];
        shape[axis] += 1;
        offset[axis] = 0;
        Lattice::new(&mut halves, shape, offset)
    });
    let mut tets = Vec::new();
    for cell in positions(cells) {
        let centre = centres.node(cell);
        for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]) {
            let mut base = cell;
            base[axis] += side;
            let face = faces[axis].node(base);
            let ring = face_corners(base, axis).map(|corner| corners.node(corner));
            for i in 0..4 {
                let (a, b) = (ring[i], ring[(i + 1) % 4]);
                // The ring is counter-clockwise seen along −axis, so from outside only on the far side.
                tets.push(if side == 1 { [b, a, face, centre] } else { [a, b, face, centre] });
            }
        }
    }
    (halves, tets)
}

/// Corners of the cell face at `base` normal to `axis`, counter-clockwise seen from +`axis`.
fn face_corners(base: [u32; 3], axis: usize) -> [[u32; 3]; 4] {
    [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(u, v)| {
        let mut corner = base;
        corner[(axis + 1) % 3] += u;
        corner[(axis + 2) % 3] += v;
        corner
    })
}

fn side_sets(halves: &[[u32; 3]], cells: [u32; 3]) -> BTreeMap<String, Vec<u32>> {
    let mut sets = BTreeMap::new();
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        for (side, at) in [("min", 0), ("max", 2 * cells[axis])] {
            let on_side = (0..).zip(halves).filter(|(_, node)| node[axis] == at).map(|(i, _)| i);
            sets.insert(format!("{name}_{side}"), on_side.collect());
        }
    }
    sets
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use proptest::prelude::*;

    use super::super::testing::{check_closed_conforming, surface_area, volume};
    use super::*;

    fn patterns() -> impl Strategy<Value = BoxPattern> {
        prop_oneof![Just(BoxPattern::Six), Just(BoxPattern::TwentyFour)]
    }

    proptest! {
        #[test]
        fn the_box_fills_its_volume_and_closes(
            size_m in prop::array::uniform3(1e-3..1e3f64),
            cells in prop::array::uniform3(1..5u32),
            pattern in patterns(),
        ) {
            let mesh = box_block(size_m, cells, pattern).unwrap();
            let [x, y, z] = size_m;
            check_closed_conforming(&mesh);
            let (nodes, tets) = counts(cells, pattern);
            prop_assert_eq!((mesh.nodes.len() as u128, mesh.tets.len() as u128), (nodes, tets));
            prop_assert!((volume(&mesh) / (x * y * z) - 1.0).abs() < 1e-12);
            prop_assert!((surface_area(&mesh) / (2.0 * (x * y + y * z + z * x)) - 1.0).abs() < 1e-12);
            prop_assert_eq!(crate::validate::problems(&mesh), vec![]);
        }

        #[test]
        fn sides_are_complete_and_exact(
            size_m in prop::array::uniform3(1e-3..1e3f64),
            cells in prop::array::uniform3(1..5u32),
            pattern in patterns(),
        ) {
            let mesh = box_block(size_m, cells, pattern).unwrap();
            prop_assert_eq!(mesh.node_sets.len(), 6);
            for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
                for (side, at) in [("min", 0.0), ("max", size_m[axis])] {
                    let on: Vec<u32> =
                        (0..mesh.nodes.len() as u32).filter(|&i| mesh.nodes[i as usize][axis] == at).collect();
                    prop_assert_eq!(&mesh.node_sets[&format!("{name}_{side}")], &on);
                }
            }
        }

        #[test]
        fn no_input_panics(
            size_m in prop::array::uniform3(any::<f64>()),
            cells in prop::array::uniform3(prop_oneof![0..4u32, (u32::MAX - 2)..=u32::MAX]),
            pattern in patterns(),
        ) {
            if let Ok(mesh) = box_block(size_m, cells, pattern) {
                prop_assert!(mesh.nodes.iter().all(|x| x.iter().all(|c| c.is_finite())));
            }
        }
    }

    #[test]
    fn one_cell_has_as_many_tetrahedra_as_its_pattern_says() {
        assert_eq!(box_block([1.0; 3], [1; 3], BoxPattern::Six).unwrap().tets.len(), 6);
        assert_eq!(box_block([1.0; 3], [1; 3], BoxPattern::TwentyFour).unwrap().tets.len(), 24);
    }

    /// Tetrahedra as sorted lists of corners in half cells from the centre of the box.
    fn as_set(halves: &Halves, map: impl Fn([i64; 3]) -> [i64; 3], middle: i64) -> BTreeSet<Vec<[i64; 3]>> {
        let corner = |node: u32| map(halves.0[node as usize].map(|c| i64::from(c) - middle));
        let sorted = |tet: &[u32; 4]| {
            let mut corners = tet.map(corner).to_vec();
            corners.sort_unstable();
            corners
        };
        halves.1.iter().map(sorted).collect()
    }

    #[test]
    fn twenty_four_is_invariant_under_the_48_symmetries_of_the_cube() {
        for n in 1..=3 {
            let halves = twenty_four([n; 3]);
            let middle = i64::from(n);
            let original = as_set(&halves, |at| at, middle);
            assert_eq!(original.len(), halves.1.len());
            for axes in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [1, 0, 2], [0, 2, 1], [2, 1, 0]] {
                for signs in 0..8 {
                    let sign = |i: usize| if signs >> i & 1 == 1 { -1 } else { 1 };
                    let map = |at: [i64; 3]| std::array::from_fn(|i| sign(i) * at[axes[i]]);
                    assert_eq!(as_set(&halves, map, middle), original);
                }
            }
        }
    }

    #[test]
    fn bad_sizes_and_cells_are_named() {
        let bad = |size_m, cells| box_block(size_m, cells, BoxPattern::Six).unwrap_err();
        assert_eq!(
            bad([1.0, -2.0, 1.0], [1; 3]),
            GenerateError::Length { what: "size along y", value_m: -2.0 }
        );
        assert!(matches!(bad([f64::NAN, 1.0, 1.0], [1; 3]), GenerateError::Length { .. }));
        assert!(matches!(bad([1.0, f64::INFINITY, 1.0], [1; 3]), GenerateError::Length { .. }));
        assert_eq!(bad([1.0; 3], [1, 1, 0]), GenerateError::NoCells { along: "z" });
        assert!(matches!(bad([1e-200; 3], [1; 3]), GenerateError::Length { .. }));
        assert!(matches!(bad([1e200; 3], [1; 3]), GenerateError::Length { .. }));
    }

    #[test]
    fn huge_cell_counts_are_refused_before_anything_is_allocated() {
        for cells in [[u32::MAX; 3], [1000; 3], [1 << 30, 1, 1]] {
            for pattern in [BoxPattern::Six, BoxPattern::TwentyFour] {
                let error = box_block([1.0; 3], cells, pattern).unwrap_err();
                assert!(matches!(error, GenerateError::TooMany { .. }), "{error}");
            }
        }
    }
}
