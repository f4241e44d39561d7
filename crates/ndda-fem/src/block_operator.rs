//! K and M of one block in its rest frame.

use nalgebra::Matrix6;
use ndda_mesh::{Mat3, Vec3};
use pulp::{Arch, Simd, WithSimd};

use crate::material::Material;
use crate::tet4::Tet4;

/// Stiffness K and consistent mass M of one block (eq 6), by node pairs, in the rest frame.
///
/// The rest shape X is relative to the mass centre, so that K (y − X) sees only small numbers.
#[derive(Clone, Debug)]
pub struct BlockOperator {
    /// Rest position X per node, relative to the mass centre [m].
    pub rest: Vec<Vec3>,
    /// Four node indices per element.
    pub tets: Vec<[u32; 4]>,
    /// Row sums of M per node [kg].
    pub node_mass: Vec<f64>,
    /// Mass of the block [kg].
    pub mass_kg: f64,
    row_start: Vec<u32>,
    column: Vec<u32>,
    stiffness: Vec<Mat3>,
    mass: Vec<f64>,
}

impl BlockOperator {
    /// Assembles K and M over the elements of a validated block; `position` is per node [m].
    pub fn new(position: &[Vec3], tets: Vec<[u32; 4]>, material: &dyn Material) -> Self {
        Self::assembled(position, tets, material.density_kg_m3(), Some(&material.moduli()))
    }

    /// M alone, for a block that does not deform: K is zero and takes no room.
    pub fn rigid(position: &[Vec3], tets: Vec<[u32; 4]>, density_kg_m3: f64) -> Self {
        Self::assembled(position, tets, density_kg_m3, None)
    }

    /// The operator with all of a row's mass on its node.
    pub fn with_lumped_mass(mut self) -> Self {
        self.mass.fill(0.0);
        for node in 0..self.nodes() as u32 {
            let slot = self.slot(node, node);
            self.mass[slot] = self.node_mass[node as usize];
        }
        self
    }

    /// Multiplies M by a factor; K and the rest shape stay.
    pub fn scale_mass(&mut self, factor: f64) {
        self.node_mass.iter_mut().chain(&mut self.mass).for_each(|mass| *mass *= factor);
        self.mass_kg *= factor;
    }

    fn assembled(
        position: &[Vec3],
        tets: Vec<[u32; 4]>,
        density: f64,
        moduli: Option<&Matrix6<f64>>,
    ) -> Self {
        let (row_start, column) = neighbours(position.len(), &tets);
        let blocks = if moduli.is_some() { column.len() } else { 0 };
        let mut operator = Self {
            rest: position.to_vec(),
            node_mass: vec![0.0; position.len()],
            mass_kg: 0.0,
            stiffness: vec![Mat3::zeros(); blocks],
            mass: vec![0.0; column.len()],
            tets,
            row_start,
            column,
        };
        operator.assemble(density, moduli);
        let center = operator.center(position);
        operator.rest.iter_mut().for_each(|x| *x -= center);
        operator
    }

    fn assemble(&mut self, density: f64, moduli: Option<&Matrix6<f64>>) {
        for tet in self.tets.clone() {
            let element = Tet4::new(&tet.map(|n| self.rest[n as usize]));
            for (a, &row) in tet.iter().enumerate() {
                for (b, &column) in tet.iter().enumerate() {
                    let slot = self.slot(row, column);
                    let mass = element.mass(density, a, b);
                    if let Some(moduli) = moduli {
                        self.stiffness[slot] += element.stiffness(moduli, a, b);
                    }
                    self.mass[slot] += mass;
                    self.node_mass[row as usize] += mass;
                }
            }
        }
        self.mass_kg = self.node_mass.iter().sum();
    }

    fn slot(&self, row: u32, column: u32) -> usize {
        let range = self.row_start[row as usize] as usize..self.row_start[row as usize + 1] as usize;
        range.start + self.column[range.clone()].binary_search(&column).expect("node pair of an element")
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.rest.len()
    }

    /// Neighbours of a node in ascending order, itself included: (node, K_ij [N/m], M_ij [kg]); none if rigid.
    pub fn row(&self, node: usize) -> impl Iterator<Item = (usize, &Mat3, f64)> {
        let range = self.row_start[node] as usize..self.row_start[node + 1] as usize;
        let stiffness = self.stiffness.get(range.clone()).unwrap_or(&[]).iter();
        let columns = self.column[range.clone()].iter();
        columns.zip(stiffness).zip(&self.mass[range]).map(|((&j, k), &m)| (j as usize, k, m))
    }

    /// out ← K w [N].
    pub fn stiffness_times(&self, w: &[Vec3], out: &mut [Vec3]) {
        Arch::new().dispatch(StiffnessTimes { operator: self, w, out });
    }

    /// (M w)ᵢ of one node, w being an acceleration [N] or a velocity [kg m/s].
    pub fn mass_row_times(&self, node: usize, w: &[Vec3]) -> Vec3 {
        let range = self.row_start[node] as usize..self.row_start[node + 1] as usize;
        let pairs = self.column[range.clone()].iter().zip(&self.mass[range]);
        pairs.fold(Vec3::zeros(), |sum, (&j, &m)| sum + m * w[j as usize])
    }

    /// Mass centre of positions [m], and mean of any field: a uniform one comes out to the last bit.
    pub fn center(&self, position: &[Vec3]) -> Vec3 {
        let first = position[0];
        let offset: Vec3 = self.node_mass.iter().zip(position).map(|(&m, x)| m * (x - first)).sum();
        first + offset / self.mass_kg
    }

    /// Linear momentum Σᵢⱼ Mᵢⱼ vⱼ [kg m/s].
    pub fn momentum(&self, velocity: &[Vec3]) -> Vec3 {
        self.node_mass.iter().zip(velocity).map(|(&m, v)| m * v).sum()
    }

    /// Angular momentum Σᵢⱼ Mᵢⱼ (xᵢ − about) × vⱼ [kg m²/s].
    pub fn angular_momentum(&self, about: &Vec3, position: &[Vec3], velocity: &[Vec3]) -> Vec3 {
        let arm = |i: usize| position[i] - about;
        (0..self.nodes()).map(|i| arm(i).cross(&self.mass_row_times(i, velocity))).sum()
    }

    /// The rigid motion with the momentum and angular momentum of the nodes, masses lumped.
    pub fn rigid_motion(&self, position: &[Vec3], velocity: &[Vec3]) -> RigidMotion {
        let center = self.center(position);
        let mean = self.momentum(velocity) / self.mass_kg;
        let (mut moment, mut angular) = (Mat3::zeros(), Vec3::zeros());
        for ((&m, x), v) in self.node_mass.iter().zip(position).zip(velocity) {
            let arm = x - center;
            moment += m * arm * arm.transpose();
            angular += m * arm.cross(&(v - mean));
        }
        let inertia = Mat3::identity() * moment.trace() - moment;
        let inverse_inertia = inertia.try_inverse().unwrap_or_else(Mat3::zeros);
        RigidMotion { center, velocity_m_s: mean, spin_rad_s: inverse_inertia * angular, inverse_inertia }
    }

    /// Kinetic energy ½ vᵀ M v [J].
    pub fn kinetic_energy_j(&self, velocity: &[Vec3]) -> f64 {
        0.5 * (0..self.nodes()).map(|i| velocity[i].dot(&self.mass_row_times(i, velocity))).sum::<f64>()
    }

    /// Σᵢⱼ Mᵢⱼ ((yᵢ·zⱼ) I − zⱼ yᵢᵀ) of arms from the mass centre [kg m²], so that Σ y × M (ω × z) is its product
    /// with ω; for y = z the moment of inertia.
    pub fn inertia(&self, y: &[Vec3], z: &[Vec3]) -> Mat3 {
        let mut second_moment = Mat3::zeros();
        for (i, y_i) in y.iter().enumerate() {
            second_moment += self.mass_row_times(i, z) * y_i.transpose();
        }
        Mat3::identity() * second_moment.trace() - second_moment
    }
}

/// The rigid part of a block's motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidMotion {
    /// Mass centre [m].
    pub center: Vec3,
    /// Its velocity [m/s].
    pub velocity_m_s: Vec3,
    /// Rate of rotation [rad/s].
    pub spin_rad_s: Vec3,
    /// Inverse of the inertia about the mass centre [1/(kg m²)].
    pub inverse_inertia: Mat3,
}

/// Compressed rows of the node graph, each node being its own neighbour.
fn neighbours(nodes: usize, tets: &[[u32; 4]]) -> (Vec<u32>, Vec<u32>) {
    let mut pairs: Vec<(u32, u32)> = Vec::with_capacity(16 * tets.len());
    for tet in tets {
        for &a in tet {
            pairs.extend(tet.iter().map(|&b| (a, b)));
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    let mut row_start = vec![0u32; nodes + 1];
    for &(row, _) in &pairs {
        row_start[row as usize + 1] += 1;
    }
    for i in 0..nodes {
        row_start[i + 1] += row_start[i];
    }
    (row_start, pairs.into_iter().map(|(_, column)| column).collect())
}

/// out ← K w, compiled for each kind of processor.
struct StiffnessTimes<'a> {
    operator: &'a BlockOperator,
    w: &'a [Vec3],
    out: &'a mut [Vec3],
}

impl WithSimd for StiffnessTimes<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { operator: BlockOperator { row_start, column, stiffness, .. }, w, out } = self;
        for (i, out) in out.iter_mut().enumerate() {
            let range = row_start[i] as usize..row_start[i + 1] as usize;
            let mut sum = [0.0; 3];
            for (k, &j) in stiffness[range.clone()].iter().zip(&column[range]) {
                let (&[[x, y, z]], [a, b, c]) = (&w[j as usize].data.0, &k.data.0);
                for i in 0..3 {
                    sum[i] += a[i] * x + b[i] * y + c[i] * z;
                }
            }
            out.data.0 = [sum];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear_elastic::LinearElastic;

    fn two_tets() -> BlockOperator {
        let nodes = [
            Vec3::new(0.0, 0.0, 0.0),
            Vec3::new(1.0, 0.0, 0.0),
            Vec3::new(0.0, 1.0, 0.0),
            Vec3::new(0.0, 0.0, 1.0),
            Vec3::new(1.0, 1.0, 1.2),
        ];
        let rock = LinearElastic::new(20e9, 0.25, 2650.0).unwrap();
        BlockOperator::new(&nodes, vec![[0, 1, 2, 3], [1, 2, 3, 4]], &rock)
    }

    #[test]
    fn a_uniform_strain_is_in_balance_inside() {
        let operator = two_tets();
        let strain = Mat3::new(1e-4, 2e-5, 0.0, 2e-5, -1e-4, 3e-5, 0.0, 3e-5, 2e-4);
        let w: Vec<Vec3> = operator.rest.iter().map(|x| strain * x).collect();
        let mut force = vec![Vec3::zeros(); 5];
        operator.stiffness_times(&w, &mut force);
        let scale: f64 = force.iter().map(|f| f.norm()).sum();
        assert!(force.iter().sum::<Vec3>().norm() < 1e-13 * scale);
        let torque: Vec3 = operator.rest.iter().zip(&force).map(|(x, f)| x.cross(f)).sum();
        assert!(torque.norm() < 1e-13 * scale);
    }

    #[test]
    fn a_rigid_rotation_has_the_energy_of_its_inertia() {
        let operator = two_tets();
        let spin = Vec3::new(0.3, -1.0, 0.5);
        let velocity: Vec<Vec3> = operator.rest.iter().map(|x| spin.cross(x)).collect();
        let expected = 0.5 * spin.dot(&(operator.inertia(&operator.rest, &operator.rest) * spin));
        assert!((operator.kinetic_energy_j(&velocity) - expected).abs() < 1e-13 * expected);
        let angular = operator.angular_momentum(&Vec3::zeros(), &operator.rest, &velocity);
        assert!(
            (angular - operator.inertia(&operator.rest, &operator.rest) * spin).norm()
                < 1e-13 * angular.norm()
        );
    }
}
