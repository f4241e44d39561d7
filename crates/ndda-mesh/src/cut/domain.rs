//! The rock before it is cut.

use std::collections::HashMap;

use super::decompose::{convex_parts, triangulate};
use super::plane::Plane;
use super::polyhedron::Polyhedron;
use super::split::Tolerance;
use super::surfaces::index_of;
use super::surfaces::{Surface, SurfaceKind};
use super::{CutError, decompose};
use super::{LEAST_DEPTH_RATIO, ON_PLANE_RATIO};
use crate::Vec3;
use crate::geometry::Aabb;

/// Coordinates beyond this leave the range of f64 in volumes [m].
const LARGEST_M: f64 = 1e50;

/// A solid as convex parts. Those of a concave one meet face to face and are glued there.
#[derive(Clone, Debug)]
pub struct Domain {
    pub(super) parts: Vec<Polyhedron>,
    pub(super) surfaces: Vec<Surface>,
    pub(super) names: Vec<String>,
}

/// A coordinate axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// East.
    X,
    /// North.
    Y,
    /// Up.
    Z,
}

/// A flat face of a closed surface.
#[derive(Clone, Debug, PartialEq)]
pub struct DomainFace {
    /// Name that boundary conditions go by; several faces may share one.
    pub name: String,
    /// Vertices, counter-clockwise seen from outside.
    pub vertices: Vec<u32>,
}

impl Domain {
    /// A box between two corners; faces `x_min x_max y_min y_max z_min z_max`.
    ///
    /// # Errors
    /// [`CutError::Extent`] when it has no volume.
    pub fn cuboid(min_m: Vec3, max_m: Vec3) -> Result<Self, CutError> {
        check_extent(&Aabb { min: min_m, max: max_m })?;
        let names = ["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"].map(String::from).to_vec();
        let surface = |face: u32| {
            let axis = face as usize / 2;
            let (corner, sign) = [(min_m, -1.0), (max_m, 1.0)][face as usize % 2];
            let plane = Plane::new(corner, Vec3::ith(axis, sign))?;
            Ok(Surface { plane, kind: SurfaceKind::Domain, name: face })
        };
        let surfaces = (0..6).map(surface).collect::<Result<_, CutError>>()?;
        Ok(Self { parts: vec![Polyhedron::cuboid(min_m, max_m)], surfaces, names })
    }

    /// A profile drawn along an axis between two places. The profile's coordinates are (y, z) for [`Axis::X`],
    /// (x, z) for [`Axis::Y`], (x, y) for [`Axis::Z`]; its corners go round in either sense and may be concave.
    /// Faces: `side_i` from corner i to i + 1, and `start` and `end`.
    ///
    /// # Errors
    /// [`CutError`] when the profile is no simple polygon or the length is not positive.
    pub fn extruded(profile_m: &[[f64; 2]], axis: Axis, start_m: f64, end_m: f64) -> Result<Self, CutError> {
        let place = |[u, v]: [f64; 2], w: f64| match axis {
            Axis::X => Vec3::new(w, u, v),
            Axis::Y => Vec3::new(u, w, v),
            Axis::Z => Vec3::new(u, v, w),
        };
        let n = profile_m.len() as u32;
        let vertices: Vec<Vec3> =
            [start_m, end_m].into_iter().flat_map(|w| profile_m.iter().map(move |&p| place(p, w))).collect();
        check_extent(&Aabb::around(&vertices))?;
        if end_m <= start_m {
            let (min_m, max_m) = (place([0.0; 2], start_m).into(), place([0.0; 2], end_m).into());
            return Err(CutError::Extent { min_m, max_m });
        }
        let area: f64 = (0..profile_m.len())
            .map(|i| {
                let ([ax, ay], [bx, by]) = (profile_m[i], profile_m[(i + 1) % profile_m.len()]);
                let [ox, oy] = profile_m[0];
                (ax - ox) * (by - oy) - (ay - oy) * (bx - ox)
            })
            .sum();
        // (x, z) is left-handed about y.
        let is_outward = (area > 0.0) != (axis == Axis::Y);
        let turned = |mut vertices: Vec<u32>| {
            if !is_outward {
                vertices.reverse();
            }
            vertices
        };
        let mut faces: Vec<DomainFace> = (0..n)
            .map(|i| {
                let j = (i + 1) % n;
                DomainFace { name: format!("side_{i}"), vertices: turned(vec![i, j, j + n, i + n]) }
            })
            .collect();
        faces.push(DomainFace { name: "start".into(), vertices: turned((0..n).rev().collect()) });
        faces.push(DomainFace { name: "end".into(), vertices: turned((n..2 * n).collect()) });
        if n < 3 || area == 0.0 {
            return Err(CutError::Profile { corners: profile_m.len() });
        }
        Self::polyhedral(&vertices, &faces)
    }

    /// A solid under a closed surface of flat faces, convex or not; triangles or polygons.
    ///
    /// Made for shapes with a few dozen reflex edges, whose planes cut all the parts that they meet. A rough surface
    /// falls into too many parts: use [`terrain`](Self::terrain) for one.
    ///
    /// # Errors
    /// [`CutError`] when the surface is open, inside out, cuts itself, or a face is not flat.
    pub fn polyhedral(vertices_m: &[Vec3], faces: &[DomainFace]) -> Result<Self, CutError> {
        Self::rounded(vertices_m, faces, 0.0)
    }

    /// As [`polyhedral`](Self::polyhedral), for a surface whose coordinates were rounded, to single precision for
    /// instance: neighbouring faces of one name that are flat together to within `flat_ratio` of the diagonal are one face.
    ///
    /// # Errors
    /// As [`polyhedral`](Self::polyhedral).
    pub fn rounded(vertices_m: &[Vec3], faces: &[DomainFace], flat_ratio: f64) -> Result<Self, CutError> {
        let bounds = Aabb::around(vertices_m);
        check_extent(&bounds)?;
        check_closed(vertices_m.len(), faces)?;
        let mut tolerance = tolerance(&bounds);
        tolerance.least_depth_m = tolerance.least_depth_m.max(flat_ratio * bounds.diagonal());
        let flat_m = tolerance.least_depth_m;
        let mut domain = Self { parts: Vec::new(), surfaces: Vec::new(), names: Vec::new() };
        let planes = planes(vertices_m, faces, flat_m)?;
        let merged = if flat_ratio > 0.0 {
            flat_together(vertices_m, faces, &planes, flat_m)
        } else {
            (0..faces.len()).collect()
        };
        let mut polygons = Vec::new();
        for (index, face) in faces.iter().enumerate() {
            let name = index_of(&mut domain.names, &face.name);
            domain.surfaces.push(Surface { plane: planes[index], kind: SurfaceKind::Domain, name });
            let ring: Vec<Vec3> = face.vertices.iter().map(|&v| vertices_m[v as usize]).collect();
            let triangles = triangulate(&ring, planes[index].normal());
            let triangles = triangles.ok_or(CutError::Profile { corners: ring.len() })?;
            let surface = merged[index] as u32;
            polygons.extend(triangles.into_iter().map(|triangle| (surface, triangle.to_vec())));
        }
        domain.parts = convex_parts(polygons, &domain.surfaces, &bounds, tolerance)?;
        Ok(domain)
    }

    /// Convex parts: one, unless the domain is concave.
    pub fn parts(&self) -> &[Polyhedron] {
        &self.parts
    }

    /// Volume [m³].
    pub fn volume_m3(&self) -> f64 {
        self.parts.iter().map(Polyhedron::volume_m3).sum()
    }

    /// Bounding box [m].
    pub fn bounds(&self) -> Aabb {
        Aabb::around(self.parts.iter().flat_map(|part| &part.vertices))
    }

    /// Tolerances of touching in this domain.
    pub(super) fn tolerance(&self) -> Tolerance {
        tolerance(&self.bounds())
    }
}

/// Fractions of the diagonal, or what rounding of coordinates far from the origin needs.
pub(super) fn tolerance(bounds: &Aabb) -> Tolerance {
    let rounding_m = 16.0 * f64::EPSILON * bounds.min.amax().max(bounds.max.amax());
    Tolerance {
        on_plane_m: rounding_m.max(ON_PLANE_RATIO * bounds.diagonal()),
        least_depth_m: (4.0 * rounding_m).max(LEAST_DEPTH_RATIO * bounds.diagonal()),
    }
}

pub(super) fn check_extent(bounds: &Aabb) -> Result<(), CutError> {
    let size = bounds.max - bounds.min;
    let good = bounds.min.amax().max(bounds.max.amax()) <= LARGEST_M
        && bounds.min.iter().chain(bounds.max.iter()).all(|x| x.is_finite())
        && size.iter().all(|&s| s > 1.0 / LARGEST_M && s > 4.0 * tolerance(bounds).least_depth_m);
    if good { Ok(()) } else { Err(CutError::Extent { min_m: bounds.min.into(), max_m: bounds.max.into() }) }
}

/// The mean plane of each face, which must be flat.
fn planes(vertices_m: &[Vec3], faces: &[DomainFace], flat_m: f64) -> Result<Vec<Plane>, CutError> {
    let mut planes = Vec::with_capacity(faces.len());
    for (index, face) in faces.iter().enumerate() {
        let ring: Vec<Vec3> = face.vertices.iter().map(|&v| vertices_m[v as usize]).collect();
        let normal = decompose::area_vector(&ring);
        let plane = Plane::new(ring.iter().sum::<Vec3>() / ring.len() as f64, normal)?;
        let gap_m = ring.iter().map(|x| plane.height_m(x).abs()).fold(0.0, f64::max);
        if gap_m > flat_m {
            return Err(CutError::NotFlat { face: index, gap_m });
        }
        planes.push(plane);
    }
    Ok(planes)
}

/// The face whose plane each face shares: the largest among neighbours that lie in it.
fn flat_together(vertices_m: &[Vec3], faces: &[DomainFace], planes: &[Plane], flat_m: f64) -> Vec<usize> {
    let mut across: HashMap<(u32, u32), usize> = HashMap::new();
    let edges = |face: usize| {
        let ring = &faces[face].vertices;
        (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()]))
    };
    (0..faces.len()).for_each(|face| across.extend(edges(face).map(|edge| (edge, face))));
    let ring = |face: usize| faces[face].vertices.iter().map(|&v| vertices_m[v as usize]);
    let area = |face: &usize| decompose::area_vector(&ring(*face).collect::<Vec<_>>()).norm();
    let mut order: Vec<usize> = (0..faces.len()).collect();
    order.sort_by(|a, b| area(b).total_cmp(&area(a)));
    let mut seed_of: Vec<Option<usize>> = vec![None; faces.len()];
    for seed in order {
        if seed_of[seed].is_some() {
            continue;
        }
        seed_of[seed] = Some(seed);
        let mut front = vec![seed];
        while let Some(face) = front.pop() {
            for other in edges(face).filter_map(|(a, b)| across.get(&(b, a)).copied()) {
                let lies_in = faces[other].name == faces[seed].name
                    && planes[other].normal().dot(planes[seed].normal()) > 0.0
                    && ring(other).all(|x| planes[seed].height_m(&x).abs() <= flat_m);
                if seed_of[other].is_none() && lies_in {
                    seed_of[other] = Some(seed);
                    front.push(other);
                }
            }
        }
    }
    seed_of.into_iter().enumerate().map(|(face, seed)| seed.unwrap_or(face)).collect()
}

fn check_closed(vertices: usize, faces: &[DomainFace]) -> Result<(), CutError> {
    let mut edges: Vec<(u32, u32, usize)> = Vec::new();
    for (index, face) in faces.iter().enumerate() {
        let ring = &face.vertices;
        let repeats = (1..ring.len()).any(|i| ring[..i].contains(&ring[i]));
        if ring.len() < 3 || repeats || ring.iter().any(|&v| v as usize >= vertices) {
            return Err(CutError::FaceVertices { face: index, vertices });
        }
        edges.extend((0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()], index)));
    }
    edges.sort_unstable();
    for (i, &(a, b, face)) in edges.iter().enumerate() {
        let twice = i > 0 && (edges[i - 1].0, edges[i - 1].1) == (a, b);
        if twice || edges.binary_search_by(|e| (e.0, e.1).cmp(&(b, a))).is_err() {
            return Err(CutError::Open { face, a, b });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_convex_profile_is_one_part_in_either_sense() {
        for axis in [Axis::X, Axis::Y, Axis::Z] {
            let mut profile = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [0.0, 3.0]];
            for _ in 0..2 {
                let domain = Domain::extruded(&profile, axis, 1.0, 3.0).unwrap();
                assert_eq!(domain.parts().len(), 1);
                assert!((domain.volume_m3() - 16.0).abs() < 1e-12);
                assert_eq!(domain.parts()[0].faces.len(), 6);
                profile.reverse();
            }
        }
    }

    #[test]
    fn concave_profiles_fall_into_convex_parts_of_the_same_volume() {
        let bench = [[0.0, 0.0], [10.0, 0.0], [10.0, 2.0], [6.0, 2.0], [5.0, 6.0], [0.0, 6.0]];
        let domain = Domain::extruded(&bench, Axis::Y, 0.0, 3.0).unwrap();
        assert!((2..=4).contains(&domain.parts().len()));
        assert!((domain.volume_m3() - 3.0 * 42.0).abs() < 1e-10, "{}", domain.volume_m3());
        let comb = [
            [0.0, 0.0],
            [5.0, 0.0],
            [5.0, 3.0],
            [4.0, 3.0],
            [4.0, 1.0],
            [3.0, 1.0],
            [3.0, 3.0],
            [2.0, 3.0],
            [2.0, 1.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [0.0, 3.0],
        ];
        let domain = Domain::extruded(&comb, Axis::X, 0.0, 1.0).unwrap();
        assert!(domain.parts().len() <= 12);
        assert!((domain.volume_m3() - 11.0).abs() < 1e-12);
        assert!(domain.parts().iter().all(|part| part.euler() == Some(2)));
    }

    #[test]
    fn triangles_rounded_to_single_precision_are_the_flat_faces_that_they_were() {
        let outline = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        let ground = [[0, 1, 2], [0, 2, 3], [0, 3, 5], [3, 4, 5]];
        let mut triangles: Vec<[u32; 3]> =
            ground.iter().flat_map(|&[a, b, c]| [[a, c, b], [a + 6, b + 6, c + 6]]).collect();
        triangles.extend((0..6).flat_map(|i| {
            let j = (i + 1) % 6;
            [[i, j, j + 6], [i, j + 6, i + 6]]
        }));
        let turn = nalgebra::Rotation3::new(Vec3::new(0.3, -0.7, 0.5));
        let vertex = |z: f64| move |p: &[f64; 2]| turn * Vec3::new(p[0] + 10.0, p[1], z);
        let exact = outline.iter().map(vertex(0.0)).chain(outline.iter().map(vertex(1.5)));
        let vertices: Vec<Vec3> = exact.map(|x| x.map(|c| f64::from(c as f32))).collect();
        let faces: Vec<DomainFace> =
            triangles.iter().map(|t| DomainFace { name: "rock".into(), vertices: t.to_vec() }).collect();
        let domain = Domain::rounded(&vertices, &faces, 1e-6).unwrap();
        assert!((domain.volume_m3() - 6.0).abs() < 1e-4, "{}", domain.volume_m3());
        let sides: Vec<usize> = domain.parts().iter().map(|part| part.faces.len()).collect();
        assert!(domain.parts().len() <= 3 && sides.iter().all(|&count| count == 6), "{sides:?}");
    }

    #[test]
    fn bad_surfaces_are_named() {
        let cube = Polyhedron::cuboid(Vec3::zeros(), Vec3::repeat(1.0));
        let faces: Vec<DomainFace> = cube
            .faces
            .iter()
            .map(|f| DomainFace { name: "wall".into(), vertices: f.vertices.clone() })
            .collect();
        let domain = Domain::polyhedral(&cube.vertices, &faces).unwrap();
        assert!((domain.volume_m3() - 1.0).abs() < 1e-14 && domain.names == ["wall"]);
        assert!(matches!(Domain::polyhedral(&cube.vertices, &faces[1..]), Err(CutError::Open { .. })));
        let mut bent = cube.vertices.clone();
        bent[7] += Vec3::repeat(0.01);
        assert!(matches!(Domain::polyhedral(&bent, &faces), Err(CutError::NotFlat { .. })));
        let mut inside_out = faces.clone();
        inside_out.iter_mut().for_each(|f| f.vertices.reverse());
        assert!(matches!(
            Domain::polyhedral(&cube.vertices, &inside_out),
            Err(CutError::Inconsistent { .. })
        ));
        assert!(Domain::cuboid(Vec3::zeros(), Vec3::new(1.0, 0.0, 1.0)).is_err());
        assert!(Domain::cuboid(Vec3::zeros(), Vec3::repeat(f64::NAN)).is_err());
        assert!(
            Domain::extruded(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]], Axis::Z, 0.0, 1.0).is_err()
        );
    }

    proptest! {
        #[test]
        fn star_shaped_profiles_keep_their_volume(radii in prop::collection::vec(0.3..1.0f64, 3..12)) {
            let n = radii.len() as f64;
            let at = |i: usize| (std::f64::consts::TAU * i as f64 / n).sin_cos();
            let profile: Vec<[f64; 2]> =
                radii.iter().enumerate().map(|(i, r)| [r * at(i).1, r * at(i).0]).collect();
            let wedge = |i: usize| radii[i] * radii[(i + 1) % radii.len()] * at(1).0 / 2.0;
            let area: f64 = (0..radii.len()).map(wedge).sum();
            let domain = Domain::extruded(&profile, Axis::Z, 0.0, 2.0).unwrap();
            prop_assert!((domain.volume_m3() - 2.0 * area).abs() < 1e-8);
        }

        #[test]
        fn no_profile_panics(
            profile in prop::collection::vec(prop::array::uniform2(prop_oneof![-2.0..2.0f64, any::<f64>()]), 0..8),
            end in prop_oneof![0.5..2.0f64, any::<f64>()],
        ) {
            let _ = Domain::extruded(&profile, Axis::Y, 0.0, end);
        }
    }
}
