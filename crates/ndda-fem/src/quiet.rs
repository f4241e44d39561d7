//! Quiet boundaries: faces behind which rock goes on for ever, and plane waves that arrive through them (Lysmer & Kuhlemeyer 1969).
//!
//! With A(n, k)ᵢₖ = Cᵢⱼₖₗ nⱼ kₗ, the traction that a face of normal n bears when displacements change along k, a plane wave that leaves along n
//! has t = −Z v with the matrix of impedances
//!
//! ```text
//! Z(n) = √(ρ A(n, n))        isotropic: ρ c_p n nᵀ + ρ c_s (1 − n nᵀ)
//! ```
//!
//! so that a face with the traction −Z v lets waves along its normal out, of any polarisation and in bedded rock, too. A wave of velocity
//! v(t − k·(x − x₀)/c) that arrives from outside has the traction −A(n, k) v/c of its own; the face then bears −Z u̇ + (Z − A(n, k)/c) v, which is
//! 2 ρ c v where the wave arrives along the inward normal.
//!
//! Both are lumped: a third of a triangle goes to each corner. A plane wave along the normal moves all nodes of a flat face alike, so that
//! consistent matrices would give the same forces, and lumped ones change the diagonal of a block's equations only.

use nalgebra::{Matrix6x3, SymmetricEigen};
use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{Mat3, Vec3};

use crate::material::Material;
use crate::motion::Motion;

/// d is the polarisation of a wave along k if A(k, k) d differs from ρ c² d by at most this part of ρ c².
const POLARISATION_TOLERANCE: f64 = 1e-6;

/// A plane wave that arrives from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneWave {
    /// Displacement that it brings, where it is that of the record [m].
    pub motion: Motion,
    /// Direction in which it travels, of length one.
    pub along: Vec3,
    /// A place that it passes at the times of the record [m].
    pub from: Vec3,
    /// Direction in which it moves the rock.
    pub moves: Vec3,
}

/// A direction of motion that is none of a plane wave.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "no plane wave that travels in direction ({:.4}, {:.4}, {:.4}) moves this rock in direction ({:.4}, {:.4}, {:.4}): in isotropic rock \
     give P waves a motion along their direction of travel, and S waves one across it; in bedded rock take a direction of travel along or across the bedding",
    along.x, along.y, along.z, moves.x, moves.y, moves.z
)]
pub struct NoWave {
    /// Direction in which it should travel.
    pub along: Vec3,
    /// Direction in which it should move the rock.
    pub moves: Vec3,
}

/// Faces behind which rock goes on for ever.
#[derive(Clone, Debug, PartialEq)]
pub struct QuietFaces {
    /// Triangles by nodes, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Waves that arrive through them.
    pub waves: Vec<PlaneWave>,
}

/// The force of an incident wave at a node, and its delay there.
#[derive(Clone, Debug, PartialEq)]
pub struct Incident {
    /// Index into [`Quiet::waves`].
    pub wave: usize,
    /// Force per velocity of the wave, Σ (Z − A(n, k)/c) A/3 [N s/m].
    pub force: Mat3,
    /// Time after which the wave is here [s].
    pub delay_s: f64,
}

/// A node of some quiet faces.
#[derive(Clone, Debug, PartialEq)]
pub struct Dashpot {
    /// The node, counted from the block's first.
    pub node: u32,
    /// Σ Z A/3, in the rest frame of the block [N s/m].
    pub drag: Mat3,
    /// Waves that arrive here.
    pub incident: Vec<Incident>,
}

/// All quiet faces of one block.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Quiet {
    /// Their nodes: those of some faces after those of others, so that each knows what arrives through its own.
    pub dashpots: Vec<Dashpot>,
    /// Displacements of the waves.
    pub waves: Vec<Motion>,
    /// Of each wave, the direction in which it travels and that in which it moves the rock.
    pub directions: Vec<(Vec3, Vec3)>,
}

impl Quiet {
    /// Lumps faces onto nodes; each with the rock beyond it, on nodes at rest at `rest` [m].
    ///
    /// # Errors
    /// [`NoWave`] of the first wave that the rock beyond does not carry.
    pub fn new(rest: &[Vec3], faces: &[(&QuietFaces, &dyn Material)]) -> Result<Self, NoWave> {
        let mut quiet = Self::default();
        for (faces, beyond) in faces {
            let mut drag = vec![Mat3::zeros(); rest.len()];
            let mut incident: Vec<Vec<Incident>> = vec![Vec::new(); rest.len()];
            let speeds: Vec<f64> =
                faces.waves.iter().map(|wave| speed_m_s(*beyond, wave)).collect::<Result<_, _>>()?;
            let first = quiet.waves.len();
            quiet.waves.extend(faces.waves.iter().map(|wave| wave.motion.clone()));
            quiet.directions.extend(faces.waves.iter().map(|wave| (wave.along, wave.moves)));
            for triangle in &faces.triangles {
                let area = triangle_area_vector(&triangle.map(|n| rest[n as usize]));
                let (third, normal) = (area.norm() / 3.0, area.normalize());
                let impedance = impedance(*beyond, &normal);
                for &node in triangle {
                    drag[node as usize] += third * impedance;
                    for (k, (wave, c)) in faces.waves.iter().zip(&speeds).enumerate() {
                        let force = third * (impedance - traction(*beyond, &normal, &wave.along) / *c);
                        let delay_s = (rest[node as usize] - wave.from).dot(&wave.along) / c;
                        add(&mut incident[node as usize], Incident { wave: first + k, force, delay_s });
                    }
                }
            }
            let nodes = drag.into_iter().zip(incident).enumerate();
            let some = nodes.filter(|(_, (drag, _))| *drag != Mat3::zeros());
            let dashpot = |(node, (drag, incident))| Dashpot { node: node as u32, drag, incident };
            quiet.dashpots.extend(some.map(dashpot));
        }
        Ok(quiet)
    }

    /// Force of the waves that arrive at a node [N], and their velocity there [m/s]: the mean between two times.
    pub fn incident(&self, dashpot: &Dashpot, (from_s, to_s): (f64, f64)) -> (Vec3, Vec3) {
        let (mut force, mut velocity) = (Vec3::zeros(), Vec3::zeros());
        if to_s > from_s {
            for incident in &dashpot.incident {
                let motion = &self.waves[incident.wave];
                let place = |time_s: f64| motion.displacement(time_s - incident.delay_s);
                let mean = (place(to_s) - place(from_s)) / (to_s - from_s);
                force += incident.force * mean;
                velocity += mean;
            }
        }
        (force, velocity)
    }
}

/// Adds the force of a wave on one triangle of a node to that on its other triangles.
fn add(incident: &mut Vec<Incident>, new: Incident) {
    match incident.iter_mut().find(|known| known.wave == new.wave) {
        Some(known) => known.force += new.force,
        None => incident.push(new),
    }
}

/// Speed of a plane wave, ρ c² d = A(k, k) d [m/s].
///
/// # Errors
/// [`NoWave`] where d is none of its directions of motion.
pub fn speed_m_s(material: &dyn Material, wave: &PlaneWave) -> Result<f64, NoWave> {
    let moves = wave.moves.normalize();
    let push = traction(material, &wave.along, &wave.along) * moves;
    let modulus = push.dot(&moves);
    if (push - modulus * moves).norm() > POLARISATION_TOLERANCE * modulus {
        return Err(NoWave { along: wave.along, moves });
    }
    Ok((modulus / material.density_kg_m3()).sqrt())
}

/// A(n, k) = B(n)ᵀ D B(k) [Pa].
fn traction(material: &dyn Material, n: &Vec3, k: &Vec3) -> Mat3 {
    strain_of(n).transpose() * material.moduli() * strain_of(k)
}

/// Z(n) = √(ρ A(n, n)) [Pa s/m].
pub fn impedance(material: &dyn Material, normal: &Vec3) -> Mat3 {
    let eigen = SymmetricEigen::new(material.density_kg_m3() * traction(material, normal, normal));
    let root = Mat3::from_diagonal(&eigen.eigenvalues.map(f64::sqrt));
    eigen.eigenvectors * root * eigen.eigenvectors.transpose()
}

/// B(k): the strain of displacements that change by u per metre along k.
fn strain_of(k: &Vec3) -> Matrix6x3<f64> {
    Matrix6x3::new(
        k.x, 0.0, 0.0, //
        0.0, k.y, 0.0, //
        0.0, 0.0, k.z, //
        k.y, k.x, 0.0, //
        0.0, k.z, k.y, //
        k.z, 0.0, k.x,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Bedding, LinearElastic, TransverselyIsotropic};

    fn rock() -> LinearElastic {
        LinearElastic::new(20e9, 0.25, 2650.0).unwrap()
    }

    fn wave(along: Vec3, moves: Vec3) -> PlaneWave {
        PlaneWave { motion: Motion::Rows(Vec::new()), along, from: Vec3::zeros(), moves }
    }

    #[test]
    fn impedances_of_isotropic_rock_are_those_of_p_and_s_waves() {
        let n = Vec3::new(0.36, 0.48, -0.8);
        let (p, s) = (2650.0 * 3009.419f64, 2650.0 * 1737.489f64);
        let exact = p * n * n.transpose() + s * (Mat3::identity() - n * n.transpose());
        assert!((impedance(&rock(), &n) - exact).amax() < 1e-6 * p);
        assert!((speed_m_s(&rock(), &wave(n, n)).unwrap() - 3009.419).abs() < 1e-3);
        let across = n.cross(&Vec3::z());
        assert!((speed_m_s(&rock(), &wave(n, across)).unwrap() - 1737.489).abs() < 1e-3);
        // The stress that a face must bear to send an S wave of 0.1 m/s up.
        assert!((2.0 * 0.1 * s - 0.920869e6).abs() < 1.0);
    }

    #[test]
    fn a_wave_that_arrives_along_the_inward_normal_brings_twice_its_stress() {
        let (n, third) = (-Vec3::z(), 1.0 / 6.0);
        let rest = [Vec3::zeros(), Vec3::y(), Vec3::x()];
        for moves in [Vec3::z(), Vec3::x()] {
            let faces = QuietFaces { triangles: vec![[0, 1, 2]], waves: vec![wave(Vec3::z(), moves)] };
            let quiet = Quiet::new(&rest, &[(&faces, &rock())]).unwrap();
            for dashpot in &quiet.dashpots {
                let exact = 2.0 * third * impedance(&rock(), &n) * moves;
                assert!((dashpot.incident[0].force * moves - exact).norm() < 1e-9 * exact.norm());
            }
        }
    }

    #[test]
    fn a_wave_along_a_face_loads_it_with_its_own_shear_stress() {
        // σ_xz = −ρ c_s v_x of an S wave along z is the traction of a face of normal x along z.
        let (n, k) = (Vec3::x(), Vec3::z());
        let c = speed_m_s(&rock(), &wave(k, n)).unwrap();
        let t = -traction(&rock(), &n, &k) / c * n;
        assert!((t + 2650.0 * c * Vec3::z()).norm() < 1e-6 * 2650.0 * c, "{t}");
    }

    #[test]
    fn bedded_rock_has_impedances_of_its_own_and_refuses_a_motion_that_no_wave_has() {
        let bedding =
            Bedding { normal: Vec3::z(), young_across_pa: 5e9, poisson_across: 0.1, shear_across_pa: 2e9 };
        let bedded = TransverselyIsotropic::new(&rock(), &bedding).unwrap();
        let c = speed_m_s(&bedded, &wave(Vec3::z(), Vec3::x())).unwrap();
        assert!((c - (2e9f64 / 2650.0).sqrt()).abs() < 1e-9 * c);
        let slanting = Vec3::new(0.6, 0.0, 0.8);
        assert!(speed_m_s(&bedded, &wave(slanting, slanting)).is_err());
        let z = impedance(&bedded, &slanting);
        let square = 2650.0 * traction(&bedded, &slanting, &slanting);
        assert!((z * z - square).amax() < 1e-9 * square.amax());
    }
}
