//! Rock under a terrain model.

use std::collections::BTreeMap;

use super::CutError;
use super::domain::{Domain, check_extent, tolerance};
use super::plane::Plane;
use super::polyhedron::{Face, Polyhedron};
use super::surfaces::{Surface, SurfaceKind};
use crate::Vec3;
use crate::geometry::Aabb;

/// Names of the domain's faces.
const NAMES: [&str; 3] = ["terrain", "base", "side"];

impl Domain {
    /// The rock between a triangulated terrain and the level `base_m`: a column under each triangle, glued to its
    /// neighbours. Triangles are counter-clockwise seen from above. Faces: `terrain base side`.
    ///
    /// # Errors
    /// [`CutError`] when a triangle names a missing vertex, is clockwise, upright or below the base, or overlaps
    /// another along an edge.
    pub fn terrain(vertices_m: &[Vec3], triangles: &[[u32; 3]], base_m: f64) -> Result<Self, CutError> {
        let vertices = vertices_m.len();
        if let Some(face) = triangles.iter().position(|t| t.iter().any(|&v| v as usize >= vertices)) {
            return Err(CutError::FaceVertices { face, vertices });
        }
        let used = || triangles.iter().flatten().map(|&v| vertices_m[v as usize]);
        let corners: Vec<Vec3> = used().chain(used().map(|x| Vec3::new(x.x, x.y, base_m))).collect();
        let bounds = Aabb::around(&corners);
        check_extent(&bounds)?;
        let least_m = tolerance(&bounds).least_depth_m;
        let names = NAMES.map(String::from).to_vec();
        let mut domain = Self { parts: Vec::new(), surfaces: Vec::new(), names };
        let base = domain.add(Plane::new(Vec3::new(0.0, 0.0, base_m), -Vec3::z())?, 1);
        let mut sides: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        for (face, &triangle) in triangles.iter().enumerate() {
            let top = triangle.map(|v| vertices_m[v as usize]);
            let normal = (top[1] - top[0]).cross(&(top[2] - top[0]));
            let longest_m = (0..3).map(|i| (top[i] - top[(i + 1) % 3]).norm()).fold(0.0, f64::max);
            if normal.z <= 2.0 * least_m * longest_m || top.iter().any(|x| x.z <= base_m + least_m) {
                return Err(CutError::Column { face, base_m });
            }
            let terrain = domain.add(Plane::new(top[0], normal)?, 0);
            let mut column = Polyhedron::column(top, base_m, terrain, base);
            for i in 0..3 {
                let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
                let along = top[(i + 1) % 3] - top[i];
                let surface = match sides.get(&(b, a)) {
                    Some(&surface) => surface,
                    None => domain.add(Plane::new(top[i], along.cross(&Vec3::z()))?, 2),
                };
                if sides.insert((a, b), surface).is_some() {
                    return Err(CutError::Open { face, a, b });
                }
                column.faces[2 + i].surface = surface;
            }
            domain.parts.push(column);
        }
        Ok(domain)
    }

    fn add(&mut self, plane: Plane, name: u32) -> u32 {
        self.surfaces.push(Surface { plane, kind: SurfaceKind::Domain, name });
        self.surfaces.len() as u32 - 1
    }
}

impl Polyhedron {
    /// The column under a triangle: its faces are the top, the base and the three sides from corner i to i + 1.
    fn column(top: [Vec3; 3], base_m: f64, terrain: u32, base: u32) -> Self {
        let below = top.map(|x| Vec3::new(x.x, x.y, base_m));
        let face = |vertices: &[u32], surface| Face { vertices: vertices.to_vec(), surface };
        let mut faces = vec![face(&[0, 1, 2], terrain), face(&[5, 4, 3], base)];
        faces.extend((0..3).map(|i| {
            let j = (i + 1) % 3;
            face(&[i, i + 3, j + 3, j], terrain)
        }));
        Self { vertices: top.into_iter().chain(below).collect(), faces }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{CutOptions, Discontinuity, JointSet, cut_blocks};
    use super::*;
    use crate::tetrahedralise::Fill;

    /// A square of n × n cells with hills.
    fn hills(n: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let height = |x: f64, y: f64| 5.0 + (1.3 * x).sin() + (0.9 * y + x).cos();
        let vertices = (0..=n)
            .flat_map(|j| (0..=n).map(move |i| (f64::from(i), f64::from(j))))
            .map(|(x, y)| Vec3::new(x, y, height(x, y)))
            .collect();
        let node = |i: u32, j: u32| j * (n + 1) + i;
        let cells = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
        let triangles = cells.flat_map(|(i, j)| {
            let [a, b, c, d] = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
            [[a, b, c], [a, c, d]]
        });
        (vertices, triangles.collect())
    }

    #[test]
    fn hills_cut_by_joints_are_blocks_that_are_whole() {
        let (vertices, triangles) = hills(6);
        let domain = Domain::terrain(&vertices, &triangles, 0.0).unwrap();
        assert!(domain.parts().iter().all(|part| part.euler() == Some(2)));
        let uncut = cut_blocks(&domain, &[], &CutOptions::default()).unwrap();
        assert_eq!((uncut.blocks.len(), uncut.groups().len()), (72, 1));
        assert_eq!(uncut.neighbours.len(), (3 * 72 - 24) / 2);
        let set = |dip, to| Discontinuity::Set(JointSet::new("joint", dip, to, 2.5));
        let sets = [set(70.0, 80.0), set(65.0, 190.0), set(15.0, 300.0)];
        let blocks = cut_blocks(&domain, &sets, &CutOptions::default()).unwrap();
        let groups = blocks.groups();
        assert!(groups.iter().all(|group| blocks.mesh_glued(group, &Fill::Centre).is_ok()));
        assert!(groups.len() > 20 && groups.len() < blocks.blocks.len() / 2);
        assert!((blocks.report.volume_m3 / domain.volume_m3() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn bad_triangles_are_named() {
        let (vertices, mut triangles) = hills(2);
        assert!(matches!(Domain::terrain(&vertices, &triangles, 5.5), Err(CutError::Column { .. })));
        triangles[3].swap(0, 1);
        assert!(matches!(Domain::terrain(&vertices, &triangles, 0.0), Err(CutError::Column { face: 3, .. })));
        triangles[3] = triangles[2];
        assert!(matches!(Domain::terrain(&vertices, &triangles, 0.0), Err(CutError::Open { face: 3, .. })));
        triangles[3][0] = 99;
        assert!(matches!(
            Domain::terrain(&vertices, &triangles, 0.0),
            Err(CutError::FaceVertices { face: 3, .. })
        ));
        assert!(matches!(Domain::terrain(&vertices, &[], 0.0), Err(CutError::Extent { .. })));
    }
}
