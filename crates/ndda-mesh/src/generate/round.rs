//! Round blocks, as facets: cylinders and spheres.

use std::collections::{BTreeMap, HashMap};
use std::f64::consts::TAU;

use super::{GenerateError, check_cells, check_counts, check_length, fraction};
use crate::{BlockMesh, Vec3};

/// A cylinder about the z axis from z = 0 to `height_m`: `cells[0]` rings around the axis, `cells[1]` layers.
///
/// Ring k has 6 k nodes, so that triangles stay near equilateral; the outline is a polygon of 6 `cells[0]` corners.
/// Node sets: `side z_min z_max`.
///
/// # Errors
/// [`GenerateError`] when a length is not positive and finite, or the cells are none or too many.
pub fn cylinder(radius_m: f64, height_m: f64, cells: [u32; 2]) -> Result<BlockMesh, GenerateError> {
    check_length("radius", radius_m)?;
    check_length("height", height_m)?;
    check_cells("the radius", cells[0])?;
    check_cells("the height", cells[1])?;
    let [rings, layers] = cells.map(u128::from);
    let per_layer = 1 + 3 * rings * (rings + 1);
    check_counts(per_layer * (layers + 1), 18 * rings * rings * layers)?;
    let disc = disc(cells[0]);
    let per_layer = per_layer as u32;
    let mut nodes = Vec::new();
    for layer in 0..=cells[1] {
        let z = fraction(height_m, layer, cells[1]);
        for ring in 0..=cells[0] {
            let radius_m = fraction(radius_m, ring, cells[0]);
            let count = (6 * ring).max(1);
            nodes.extend((0..count).map(|i| {
                let (sin, cos) = (TAU * f64::from(i) / f64::from(count)).sin_cos();
                Vec3::new(radius_m * cos, radius_m * sin, z)
            }));
        }
    }
    let mut tets = Vec::new();
    for layer in 0..cells[1] {
        for triangle in &disc {
            // Each side of a prism is cut from its lower node below to its higher node above.
            let mut order = *triangle;
            order.sort_unstable();
            let [a, b, c] = order.map(|node| node + layer * per_layer);
            let [p, q, r] = [a, b, c].map(|node| node + per_layer);
            let is_even =
                [[0, 1, 2], [1, 2, 0], [2, 0, 1]].iter().any(|turn| turn.map(|i| order[i]) == *triangle);
            for mut tet in [[a, b, c, r], [a, b, r, q], [a, p, q, r]] {
                if !is_even {
                    tet.swap(1, 2);
                }
                tets.push(tet);
            }
        }
    }
    let all = || (0..=cells[1]).flat_map(|layer| (0..per_layer).map(move |node| (layer, node)));
    let collect = |is_in: &dyn Fn(u32, u32) -> bool| -> Vec<u32> {
        (0..).zip(all()).filter(|&(_, (layer, node))| is_in(layer, node)).map(|(id, _)| id).collect()
    };
    let outer = per_layer - 6 * cells[0];
    let node_sets = BTreeMap::from([
        ("side".into(), collect(&|_, node| node >= outer)),
        ("z_min".into(), collect(&|layer, _| layer == 0)),
        ("z_max".into(), collect(&|layer, _| layer == cells[1])),
    ]);
    Ok(BlockMesh { nodes, tets, node_sets, ..BlockMesh::default() })
}

/// Counter-clockwise triangles of a disc of rings; ring k starts at node 1 + 3 k (k − 1).
fn disc(rings: u32) -> Vec<[u32; 3]> {
    let node = |ring: u32, i: u32| if ring == 0 { 0 } else { 1 + 3 * ring * (ring - 1) + i % (6 * ring) };
    let mut triangles = Vec::new();
    for ring in 1..=rings {
        for sector in 0..6 {
            let (inner, outer) = (sector * (ring - 1), sector * ring);
            for i in 0..ring {
                triangles.push([node(ring - 1, inner + i), node(ring, outer + i), node(ring, outer + i + 1)]);
                if i + 1 < ring {
                    let (a, b) = (node(ring - 1, inner + i), node(ring - 1, inner + i + 1));
                    triangles.push([a, node(ring, outer + i + 1), b]);
                }
            }
        }
    }
    triangles
}

/// A sphere about the origin: an octahedron of 8 tetrahedra, each cut in eight `levels` times, and rounded.
///
/// It has 8^(levels + 1) tetrahedra. Node set: `surface`.
///
/// # Errors
/// [`GenerateError`] when the radius is not positive and finite, or the levels are too many.
pub fn sphere(radius_m: f64, levels: u32) -> Result<BlockMesh, GenerateError> {
    check_length("radius", radius_m)?;
    let tets = 1u128.checked_shl(3 * (levels.min(40) + 1)).unwrap_or(u128::MAX);
    check_counts(tets, tets)?;
    let mut octahedron = Octahedron { steps: 1 << levels, places: Vec::new(), index: HashMap::new() };
    let far = octahedron.steps;
    let centre = octahedron.node([0; 3]);
    let mut tets = Vec::new();
    for octant in 0..8 {
        let sign = |bit: i32| if octant >> bit & 1 == 1 { -far } else { far };
        let [x, y, z] = [[sign(0), 0, 0], [0, sign(1), 0], [0, 0, sign(2)]].map(|at| octahedron.node(at));
        let is_right_handed = (0..3).filter(|bit| octant >> bit & 1 == 1).count() % 2 == 0;
        tets.push(if is_right_handed { [centre, x, y, z] } else { [centre, y, x, z] });
    }
    for _ in 0..levels {
        tets = tets.into_iter().flat_map(|tet| octahedron.eight(tet)).collect();
    }
    let surface =
        (0..).zip(&octahedron.places).filter(|(_, at)| sum(at) == far).map(|(node, _)| node).collect();
    let nodes = octahedron.places.iter().map(|at| octahedron.rounded(at) * radius_m).collect();
    let node_sets = BTreeMap::from([("surface".into(), surface)]);
    Ok(BlockMesh { nodes, tets, node_sets, ..BlockMesh::default() })
}

/// |x| + |y| + |z|.
fn sum(at: &[i32; 3]) -> i32 {
    at.iter().map(|c| c.abs()).sum()
}

/// Points of a lattice in the octahedron |x| + |y| + |z| ≤ steps.
struct Octahedron {
    steps: i32,
    places: Vec<[i32; 3]>,
    index: HashMap<[i32; 3], u32>,
}

impl Octahedron {
    fn node(&mut self, at: [i32; 3]) -> u32 {
        *self.index.entry(at).or_insert_with(|| {
            self.places.push(at);
            self.places.len() as u32 - 1
        })
    }

    /// Where a lattice point goes in the unit ball: octahedra become spheres.
    fn rounded(&self, at: &[i32; 3]) -> Vec3 {
        let x = Vec3::from(at.map(f64::from));
        let length = x.norm();
        if length == 0.0 { x } else { x * (f64::from(sum(at)) / (f64::from(self.steps) * length)) }
    }

    /// Four corners and the octahedron between them, cut along its shortest diagonal (Bey 1995).
    fn eight(&mut self, tet: [u32; 4]) -> [[u32; 4]; 8] {
        let mut middle = |i: usize, j: usize| {
            let (a, b) = (self.places[tet[i] as usize], self.places[tet[j] as usize]);
            self.node(std::array::from_fn(|axis| (a[axis] + b[axis]) / 2))
        };
        let [a, b, c, d] = tet;
        let (ab, ac, ad) = (middle(0, 1), middle(0, 2), middle(0, 3));
        let (bc, bd, cd) = (middle(1, 2), middle(1, 3), middle(2, 3));
        // The ends of each diagonal and the ring around it, clockwise seen from the second end.
        let diagonals =
            [([ab, cd], [ac, bc, bd, ad]), ([ac, bd], [ab, ad, cd, bc]), ([ad, bc], [ab, bd, cd, ac])];
        let length = |[p, q]: [u32; 2]| {
            let [p, q] = [p, q].map(|node| self.rounded(&self.places[node as usize]));
            (p - q).norm()
        };
        let shortest = diagonals.into_iter().min_by(|x, y| length(x.0).total_cmp(&length(y.0)));
        let ([p, q], ring) = shortest.unwrap_or(diagonals[0]);
        let around = |i: usize| [p, q, ring[(i + 1) % 4], ring[i]];
        let corners = [[a, ab, ac, ad], [ab, b, bc, bd], [ac, bc, c, cd], [ad, bd, cd, d]];
        std::array::from_fn(|i| if i < 4 { corners[i] } else { around(i - 4) })
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::super::testing::{check_closed_conforming, volume};
    use super::*;
    use crate::quality::dihedral_angles_deg;

    fn sharpest_deg(mesh: &BlockMesh) -> f64 {
        let angles = |tet: &[u32; 4]| dihedral_angles_deg(&tet.map(|n| mesh.nodes[n as usize]));
        mesh.tets.iter().flat_map(angles).fold(180.0, f64::min)
    }

    #[test]
    fn a_cylinder_is_the_prism_of_its_polygon() {
        for cells in [[1, 1], [2, 3], [5, 4]] {
            let mesh = cylinder(2.0, 3.0, cells).unwrap();
            check_closed_conforming(&mesh);
            assert_eq!(crate::validate::problems(&mesh), vec![]);
            let n = 6.0 * f64::from(cells[0]);
            let exact = 3.0 * n / 2.0 * 4.0 * (TAU / n).sin();
            assert!((volume(&mesh) / exact - 1.0).abs() < 1e-12);
            assert_eq!(mesh.node_sets["side"].len() as u32, 6 * cells[0] * (cells[1] + 1));
        }
        assert!(sharpest_deg(&cylinder(1.0, 1.0, [5, 5]).unwrap()) > 20.0);
    }

    #[test]
    fn a_sphere_tends_to_its_volume() {
        for levels in 0..5 {
            let mesh = sphere(2.0, levels).unwrap();
            check_closed_conforming(&mesh);
            assert_eq!(crate::validate::problems(&mesh), vec![]);
            assert_eq!(mesh.tets.len(), 8usize.pow(levels + 1));
            let on = &mesh.node_sets["surface"];
            assert!(on.iter().all(|&n| (mesh.nodes[n as usize].norm() - 2.0).abs() < 1e-14));
            assert!(sharpest_deg(&mesh) > 20.0, "{levels}: {}", sharpest_deg(&mesh));
        }
        let exact = 4.0 / 3.0 * PI * 8.0;
        assert!((volume(&sphere(2.0, 4).unwrap()) / exact - 1.0).abs() < 0.01);
    }

    #[test]
    fn bad_numbers_are_named() {
        assert!(matches!(sphere(-1.0, 1), Err(GenerateError::Length { what: "radius", .. })));
        assert!(matches!(sphere(1.0, u32::MAX), Err(GenerateError::TooMany { .. })));
        assert!(matches!(sphere(1.0, 10), Err(GenerateError::TooMany { .. })));
        assert!(matches!(cylinder(1.0, f64::NAN, [1, 1]), Err(GenerateError::Length { .. })));
        assert!(matches!(cylinder(1.0, 1.0, [0, 1]), Err(GenerateError::NoCells { .. })));
        assert!(matches!(cylinder(1.0, 1.0, [u32::MAX; 2]), Err(GenerateError::TooMany { .. })));
    }
}
