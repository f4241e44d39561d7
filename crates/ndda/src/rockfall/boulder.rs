//! Boulders: convex polyhedra of a size and a shape that are drawn for each.

use std::f64::consts::PI;

use ndda_io::scene::{BoulderShape, BoulderSize, Boulders};
use ndda_mesh::{BlockMesh, Vec3};

use super::draw::{self, Draw, Of};

/// Places that are tried for each face of a random polyhedron; the one farthest from all faces before is taken (Mitchell 1991).
const CANDIDATES: usize = 12;
/// Least distance of the face of a random polyhedron from its middle, over that of the ellipsoid that it is about.
const NEAREST: f64 = 0.88;
/// A random polyhedron has only corners within this distance of its middle, the ellipsoid being at 1.
const FARTHEST: f64 = 2.0;
/// Corners nearer to each other than this are one; distances of faces are about 1.
const SAME: f64 = 1e-6;
/// Least distance of two corners of a random polyhedron.
const SHORTEST: f64 = 0.02;

/// A boulder, its mass centre at the origin.
#[derive(Clone, Debug, PartialEq)]
pub struct Boulder {
    /// Its tetrahedra: from the mass centre to each triangle of its surface.
    pub mesh: BlockMesh,
    /// Its volume [m³].
    pub volume_m3: f64,
    /// Distance of its farthest corner from the mass centre [m].
    pub radius_m: f64,
}

impl Boulder {
    /// Diameter of a sphere of the same volume [m].
    pub fn diameter_m(&self) -> f64 {
        diameter_of(self.volume_m3)
    }

    /// The boulder with this number, of rock of this density.
    pub(super) fn draw(boulders: &Boulders, density_kg_m3: f64, draw: &Draw) -> Self {
        let within = within(boulders);
        let size = |scatter| draw.value(Of::Size, 0, scatter, within);
        let volume_m3 = match &boulders.size {
            BoulderSize::Diameter { diameter_m } => PI / 6.0 * size(diameter_m).powi(3),
            BoulderSize::Volume { volume_m3 } => size(volume_m3),
            BoulderSize::Mass { mass_kg } => size(mass_kg) / density_kg_m3,
        };
        let which = draw.stream(Of::Shape, 0).uniform() * boulders.shapes.len() as f64;
        Self::of_shape(&boulders.shapes[which as usize], volume_m3, draw)
    }

    /// Part of the distribution of sizes that is beyond their limits: it is cut off.
    pub(super) fn sizes_cut_off(boulders: &Boulders) -> f64 {
        let (BoulderSize::Diameter { diameter_m: size }
        | BoulderSize::Volume { volume_m3: size }
        | BoulderSize::Mass { mass_kg: size }) = &boulders.size;
        draw::cut_off(size, within(boulders))
    }

    /// A cube of a volume [m³].
    #[cfg(test)]
    pub(super) fn cube(volume_m3: f64) -> Self {
        Self::of_shape(&BoulderShape::Cuboid { axes: [1.0; 3] }, volume_m3, &Draw::new(0, 0))
    }

    fn of_shape(shape: &BoulderShape, volume_m3: f64, draw: &Draw) -> Self {
        let (axes, surface) = match shape {
            BoulderShape::Cuboid { axes } => (axes, Surface::between(&cube())),
            BoulderShape::Ellipsoid { axes } => (axes, icosahedron()),
            BoulderShape::Polyhedron { faces, axes } => (axes, random(*faces as usize, draw)),
        };
        let corners: Vec<Vec3> =
            surface.corners.iter().map(|x| x.component_mul(&Vec3::from(*axes))).collect();
        let (volume, centre) = volume_and_centre(&corners, &surface.faces);
        let scale = (volume_m3 / volume).cbrt();
        let mut nodes = vec![Vec3::zeros()];
        nodes.extend(corners.iter().map(|x| scale * (x - centre)));
        let mut tets = Vec::new();
        for face in &surface.faces {
            let fan = (1..face.len() - 1).map(|k| [0, face[0] + 1, face[k] + 1, face[k + 1] + 1]);
            tets.extend(fan);
        }
        let radius_m = nodes.iter().map(|x| x.norm()).fold(0.0, f64::max);
        Self { mesh: BlockMesh { nodes, tets, ..BlockMesh::default() }, volume_m3, radius_m }
    }
}

/// Least and largest size.
fn within(boulders: &Boulders) -> (f64, f64) {
    boulders.within.unwrap_or((0.0, f64::INFINITY))
}

/// Diameter of a sphere of this volume [m].
pub(super) fn diameter_of(volume_m3: f64) -> f64 {
    (6.0 * volume_m3 / PI).cbrt()
}

/// A convex surface: corners, and faces counter-clockwise seen from outside.
struct Surface {
    corners: Vec<Vec3>,
    faces: Vec<Vec<u32>>,
}

impl Surface {
    /// What is behind all planes n·x = 1 that vectors n give: corners are where three of them meet behind all others.
    fn between(planes: &[Vec3]) -> Self {
        let mut corners: Vec<Vec3> = Vec::new();
        for (i, a) in planes.iter().enumerate() {
            for (j, b) in planes.iter().enumerate().skip(i + 1) {
                for c in &planes[j + 1..] {
                    let corner = meeting(a, b, c);
                    let is_corner = |x: &Vec3| planes.iter().all(|n| n.dot(x) <= 1.0 + SAME);
                    let is_new = |x: &Vec3| corners.iter().all(|known| (known - x).norm() > SAME);
                    corners.extend(corner.filter(|x| is_corner(x) && is_new(x)));
                }
            }
        }
        let ring = |n: &Vec3| {
            let on = |x: &Vec3| (n.dot(x) - 1.0).abs() <= 2.0 * SAME * x.norm().max(1.0) * n.norm();
            let mut ring: Vec<u32> = (0..).zip(&corners).filter(|(_, x)| on(x)).map(|(k, _)| k).collect();
            let middle = ring.iter().map(|&k| corners[k as usize]).sum::<Vec3>() / ring.len().max(1) as f64;
            let east = n.cross(&Vec3::ith(n.iamin(), 1.0));
            let north = n.cross(&east);
            let angle = |k: &u32| {
                let arm = corners[*k as usize] - middle;
                (arm.dot(&north) / north.norm()).atan2(arm.dot(&east) / east.norm())
            };
            ring.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
            ring
        };
        let faces = planes.iter().map(ring).filter(|ring| ring.len() >= 3).collect();
        Self { corners, faces }
    }

    /// Whether it is closed, with V − E + F = 2, no corner is far away, and no two are close together.
    fn is_sound(&self) -> bool {
        let mut edges: Vec<(u32, u32)> = Vec::new();
        for face in &self.faces {
            edges.extend((0..face.len()).map(|k| (face[k], face[(k + 1) % face.len()])));
        }
        edges.sort_unstable();
        let is_closed = edges.windows(2).all(|pair| pair[0] != pair[1])
            && edges.iter().all(|&(a, b)| edges.binary_search(&(b, a)).is_ok());
        let are_apart = |(k, a): (usize, &Vec3)| self.corners[..k].iter().all(|b| (a - b).norm() > SHORTEST);
        is_closed
            && self.corners.iter().enumerate().all(are_apart)
            && self.corners.len() + self.faces.len() == edges.len() / 2 + 2
            && self.corners.iter().all(|x| x.norm() <= FARTHEST)
    }
}

/// Where three planes n·x = 1 meet; nowhere if they are nearly parallel to one line.
fn meeting(a: &Vec3, b: &Vec3, c: &Vec3) -> Option<Vec3> {
    let normal = b.cross(c);
    let determinant = a.dot(&normal);
    let is_sharp = determinant.abs() > 1e-4 * a.norm() * b.norm() * c.norm();
    is_sharp.then(|| (normal + c.cross(a) + a.cross(b)) / determinant)
}

fn cube() -> Vec<Vec3> {
    [Vec3::x(), Vec3::y(), Vec3::z()].into_iter().flat_map(|n| [n, -n]).collect()
}

/// Twelve corners, twenty triangles.
fn icosahedron() -> Surface {
    let golden = 0.5 * (1.0 + 5f64.sqrt());
    // The faces of an icosahedron are where the corners of a dodecahedron are.
    let mut planes: Vec<Vec3> = Vec::new();
    let signs = [-1.0, 1.0];
    for (a, b) in signs.into_iter().flat_map(|a| signs.map(|b| (a, b))) {
        planes.extend(signs.map(|c| Vec3::new(a, b, c)));
        let (short, long) = (a / golden, b * golden);
        planes.extend([
            Vec3::new(0.0, short, long),
            Vec3::new(short, long, 0.0),
            Vec3::new(long, 0.0, short),
        ]);
    }
    planes.iter_mut().for_each(|n| *n = n.normalize());
    Surface::between(&planes)
}

/// A polyhedron whose faces touch the unit ball or come a bit nearer: the first sound one; most tries give one.
fn random(faces: usize, draw: &Draw) -> Surface {
    let drawn = |part| {
        let mut stream = draw.stream(Of::Shape, part);
        let mut normals: Vec<Vec3> = Vec::new();
        while normals.len() < faces {
            let mut candidate = || Vec3::from_fn(|_, _| stream.normal()).normalize();
            let candidates: Vec<Vec3> = (0..CANDIDATES).map(|_| candidate()).collect();
            let nearest = |x: &Vec3| normals.iter().map(|n| n.dot(x)).fold(-1.0, f64::max);
            normals.extend(candidates.iter().min_by(|a, b| nearest(a).total_cmp(&nearest(b))));
        }
        let planes: Vec<Vec3> = normals.iter().map(|n| n / stream.between(NEAREST, 1.0)).collect();
        Surface::between(&planes)
    };
    (1..).map(drawn).find(Surface::is_sound).expect("tries do not end")
}

/// Volume and its centre, from tetrahedra between the mean of the corners and fans of the faces.
fn volume_and_centre(corners: &[Vec3], faces: &[Vec<u32>]) -> (f64, Vec3) {
    let mean = corners.iter().sum::<Vec3>() / corners.len() as f64;
    let (mut volume, mut moment) = (0.0, Vec3::zeros());
    for face in faces {
        let at = |k: usize| corners[face[k] as usize] - mean;
        for k in 1..face.len() - 1 {
            let part = at(0).dot(&at(k).cross(&at(k + 1))) / 6.0;
            volume += part;
            moment += 0.25 * part * (at(0) + at(k) + at(k + 1));
        }
    }
    (volume, mean + moment / volume)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndda_mesh::geometry::tet_volume;
    use ndda_mesh::validate;

    fn drawn(shape: BoulderShape, boulder: u32) -> Boulder {
        Boulder::of_shape(&shape, 2.0, &Draw::new(5, boulder))
    }

    /// Volume, mass centre, and that the mesh is sound.
    fn check(boulder: &Boulder) {
        assert!(validate::problems(&boulder.mesh).is_empty(), "{:?}", validate::problems(&boulder.mesh));
        let (mut volume, mut moment) = (0.0, Vec3::zeros());
        for tet in &boulder.mesh.tets {
            let corners = tet.map(|n| boulder.mesh.nodes[n as usize]);
            let part = tet_volume(&corners);
            volume += part;
            moment += 0.25 * part * corners.iter().sum::<Vec3>();
        }
        assert!((volume - 2.0).abs() < 1e-12, "{volume}");
        assert!(moment.norm() < 1e-12, "{moment}");
    }

    #[test]
    fn boulders_have_their_volume_and_mass_centre() {
        let cuboid = drawn(BoulderShape::Cuboid { axes: [2.0, 1.0, 1.0] }, 0);
        check(&cuboid);
        assert_eq!((cuboid.mesh.nodes.len(), cuboid.mesh.tets.len()), (9, 12));
        assert!((cuboid.radius_m - (1.0f64 + 0.25 + 0.25).sqrt()).abs() < 1e-12);
        let ball = drawn(BoulderShape::Ellipsoid { axes: [1.0; 3] }, 0);
        check(&ball);
        assert_eq!((ball.mesh.nodes.len(), ball.mesh.tets.len()), (13, 20));
        for boulder in 0..60 {
            for faces in [6, 8, 14, 24] {
                check(&drawn(BoulderShape::Polyhedron { faces, axes: [1.0, 0.8, 0.65] }, boulder));
            }
        }
    }

    #[test]
    fn random_boulders_differ_and_are_those_of_their_number() {
        let shape = BoulderShape::Polyhedron { faces: 14, axes: [1.0; 3] };
        assert_eq!(drawn(shape, 3), drawn(shape, 3));
        assert_ne!(drawn(shape, 3), drawn(shape, 4));
    }
}
