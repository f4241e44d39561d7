//! Cases that are measured, by the clock and by counting instructions.
#![allow(dead_code)] // each bench takes some of it

use nalgebra::Rotation3;
use ndda_fem::loads::{add_gravity, add_traction, initial_stress_force};
use ndda_fem::stress::{cauchy_stress, smallest_volume_ratio};
use ndda_fem::tet4::Tet4;
use ndda_fem::{
    BlockOperator, BlockSupports, Frame, Hold, InitialStress, LinearElastic, Material, NodeSupport, Voigt,
};
use ndda_mesh::generate::{BoxPattern, box_block};
use ndda_mesh::surface::boundary_faces;
use ndda_mesh::{BlockMesh, Mat3, Vec3};

/// Granite.
pub fn rock() -> LinearElastic {
    LinearElastic::new(20e9, 0.25, 2650.0).expect("rock")
}

/// A cube of a metre, of 6 n³ tetrahedra.
pub fn cube(n: u32) -> BlockMesh {
    box_block([1.0; 3], [n; 3], BoxPattern::Six).expect("a cube")
}

/// K and M of a cube.
pub fn assemble(mesh: &BlockMesh) -> BlockOperator {
    BlockOperator::new(&mesh.nodes, mesh.tets.clone(), &rock())
}

/// Stiffness and mass of one element, all pairs of its nodes.
pub fn element(corners: &[Vec3; 4]) -> (Mat3, f64) {
    let (element, moduli) = (Tet4::new(corners), rock().moduli());
    let pairs = (0..16).map(|k| (k / 4, k % 4));
    let one = |(a, b)| (element.stiffness(&moduli, a, b), element.mass(2650.0, a, b));
    pairs.map(one).fold((Mat3::zeros(), 0.0), |sum, (stiffness, mass)| (sum.0 + stiffness, sum.1 + mass))
}

/// A cube that is turned and strained, and room for what is found of it.
pub struct Deformed {
    /// K and M.
    pub operator: BlockOperator,
    frame: Frame,
    triangles: Vec<[u32; 3]>,
    displacement: Vec<Vec3>,
    position: Vec<Vec3>,
    initial_pa: Vec<Voigt>,
    stress: Vec<[f64; 6]>,
    force: Vec<Vec3>,
}

impl Deformed {
    /// Of 6 n³ tetrahedra.
    pub fn new(n: u32) -> Self {
        let mesh = cube(n);
        let operator = assemble(&mesh);
        let strain = Mat3::new(1e-4, 2e-5, 0.0, 2e-5, -1e-4, 3e-5, 0.0, 3e-5, 2e-4);
        let turn = Rotation3::new(Vec3::new(0.3, -0.2, 0.5)).into_inner();
        let displacement: Vec<Vec3> = operator.rest.iter().map(|x| strain * x).collect();
        let moved = operator.rest.iter().zip(&displacement).map(|(x, u)| turn * (x + u) + Vec3::x());
        let uniform = InitialStress::uniform(Voigt::new(1e6, 1e6, 2e6, 0.0, 0.0, 0.0));
        Self {
            position: moved.collect(),
            frame: Frame::free(&operator),
            triangles: boundary_faces(&mesh.tets).iter().map(|face| face.nodes).collect(),
            initial_pa: uniform.of_elements(&operator, &mesh.nodes),
            stress: vec![[0.0; 6]; operator.tets.len()],
            force: vec![Vec3::zeros(); operator.nodes()],
            displacement,
            operator,
        }
    }

    /// R of the best affine map.
    pub fn rotation(&self) -> Mat3 {
        let center = self.operator.center(&self.position);
        self.frame.rotation(&self.operator, &self.position, &center).expect("a block that is right side out")
    }

    /// Stresses of all elements.
    pub fn stresses(&mut self) -> f64 {
        let turn = Mat3::identity();
        cauchy_stress(&self.operator, &rock(), &self.initial_pa, &turn, &self.displacement, &mut self.stress);
        self.stress[0][0]
    }

    /// K w.
    pub fn stiffness_times(&mut self) -> Vec3 {
        self.operator.stiffness_times(&self.displacement, &mut self.force);
        self.force[0]
    }

    /// ½ vᵀ M v and the angular momentum.
    pub fn motion(&self) -> f64 {
        let angular = self.operator.angular_momentum(&Vec3::zeros(), &self.position, &self.displacement);
        self.operator.kinetic_energy_j(&self.displacement) + angular.x
    }

    /// Smallest det F.
    pub fn volume_ratio(&self) -> f64 {
        smallest_volume_ratio(&self.operator, &self.position).0
    }

    /// Weight, a traction on all of the surface, and an initial stress.
    pub fn loads(&mut self) -> Vec3 {
        add_gravity(&self.operator, &Vec3::new(0.0, 0.0, -9.8), &mut self.force);
        add_traction(&self.triangles, &self.operator.rest, &Vec3::x(), &mut self.force);
        initial_stress_force(&self.operator, &self.initial_pa)[0]
    }

    /// A block whose lower face is held.
    pub fn supports(&self) -> BlockSupports {
        let nodes = (0..self.operator.nodes() as u32).filter(|&n| self.operator.rest[n as usize].z < -0.49);
        let held = NodeSupport { nodes: nodes.collect(), hold: Hold::Fixed, spring_n_m: None };
        BlockSupports::new(&self.operator, &[held], &[]).expect("a foot")
    }
}
