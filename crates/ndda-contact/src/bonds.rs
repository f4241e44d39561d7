//! Joints that carry tension: facets glued to a point of the other block until the glue breaks.
//!
//! Bonds form where facets touch another block when contact is first evaluated. Compression is the potential's, shear
//! the friction law's; a bond acts when its facet moves away: a spring along its length d, ½ k S d, with half the
//! facet's area for each side. Past σ_t S it is gone for good, and so is the facet's cohesion.

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockSet, Mat3, TriangleId, Vec3};

use crate::candidates::Candidates;
use crate::friction::FrictionLaw;
use crate::hulls::Hulls;
use crate::joints::Joints;
use crate::model::{Bond, ContactHistory, ContactInput, ContactOutput, FacetContact};
use crate::pair::TetFrame;
use crate::pair_stiffness::PairStiffness;

/// A facet touches when its centroid is no further outside than this part of the tetrahedron.
const TOUCHING: f64 = 1e-6;

/// Adds the forces of bonds, and drops those that break.
pub fn add_forces(
    joints: &Joints,
    found: (&Candidates, &Hulls),
    input: &ContactInput,
    history: &mut ContactHistory,
    output: &mut ContactOutput,
) {
    if !history.begun {
        form(joints, found, input, &mut history.bonds);
    }
    let ContactHistory { bonds, facets, .. } = history;
    bonds.retain(|bond| {
        let holds = pull(joints, input, bond, output);
        if !holds {
            let of_bond = facets.iter_mut().filter(|memory| memory.facet == bond.facet);
            of_bond.for_each(|memory| memory.broken = true);
        }
        holds
    });
}

fn form(
    joints: &Joints,
    (candidates, hulls): (&Candidates, &Hulls),
    input: &ContactInput,
    bonds: &mut Vec<Bond>,
) {
    let blocks = input.blocks;
    for facet in &candidates.facets {
        let tension_pa = joints.law(blocks, facet.triangle, facet.target).map_or(0.0, |law| law.tension_pa());
        let known = bonds.last().is_some_and(|bond: &Bond| bond.facet == facet.triangle);
        if tension_pa <= 0.0 || known {
            continue;
        }
        let centroid = centroid(input, facet.triangle);
        let bond = facet.pairs.clone().find_map(|pair| {
            let tet = candidates.tet_of(pair as u32);
            let frame = TetFrame::new(&blocks.tet_corners(tet, input.position));
            let lambda = frame.lambda(&[centroid; 3]).map(|at| at[0]);
            let inside = match hulls.whole(facet.target) {
                Some(whole) => hulls.depth_phi(facet.target, &centroid) >= -TOUCHING * whole.most_phi,
                None => lambda.iter().all(|&l| l >= -TOUCHING),
            };
            inside.then_some(Bond { facet: facet.triangle, tet, lambda })
        });
        bonds.extend(bond);
    }
}

/// Adds the force of one bond; false when it breaks.
fn pull(joints: &Joints, input: &ContactInput, bond: &Bond, output: &mut ContactOutput) -> bool {
    let blocks = input.blocks;
    let Some(law) = law(joints, blocks, bond) else { return false };
    let Some(Opening { stretch, half_area, .. }) = opening(input, bond) else { return true };
    if law.bond_stiffness_pa_m() * stretch.norm() > law.tension_pa() {
        return false;
    }
    let force = law.bond_stiffness_pa_m() * half_area * stretch;
    for node in blocks.triangles[bond.facet.index()] {
        output.force[node.index()] += force / 3.0;
        output.stiffness[node.index()] += 2.0 * law.bond_stiffness_pa_m() * half_area / 3.0;
    }
    for (node, lambda) in blocks.tets[bond.tet.index()].iter().zip(bond.lambda) {
        output.force[node.index()] -= lambda * force;
        output.stiffness[node.index()] += 2.0 * law.bond_stiffness_pa_m() * half_area * lambda.abs();
    }
    true
}

/// The law of the joint that a bond is in.
fn law<'a>(joints: &'a Joints, blocks: &BlockSet, bond: &Bond) -> Option<&'a dyn FrictionLaw> {
    joints.law(blocks, bond.facet, blocks.tet_block[bond.tet.index()])
}

/// How far a bond has opened.
struct Opening {
    /// From the facet's centroid to the point that it is glued to [m].
    stretch: Vec3,
    /// Unit normal of the facet.
    normal: Vec3,
    /// Half of the facet's area [m²].
    half_area: f64,
}

/// How far a bond has opened; none unless it has.
fn opening(input: &ContactInput, bond: &Bond) -> Option<Opening> {
    let tet = input.blocks.tets[bond.tet.index()];
    let anchor: Vec3 = (0..4).map(|b| bond.lambda[b] * input.position[tet[b].index()]).sum();
    let area_vector = triangle_area_vector(&input.blocks.triangle_corners(bond.facet, input.position));
    let stretch = anchor - centroid(input, bond.facet);
    let opening =
        || Opening { stretch, normal: area_vector.normalize(), half_area: 0.5 * area_vector.norm() };
    (stretch.dot(&area_vector) > 0.0).then(opening)
}

/// What the bonds do that are stretched.
pub fn add_facets(joints: &Joints, input: &ContactInput, bonds: &[Bond], facets: &mut Vec<FacetContact>) {
    let blocks = input.blocks;
    facets.extend(bonds.iter().filter_map(|bond| {
        let Opening { stretch, normal, half_area } = opening(input, bond)?;
        let law = law(joints, blocks, bond)?;
        Some(FacetContact {
            facet: bond.facet,
            target: blocks.tet_block[bond.tet.index()],
            area_m2: 0.0,
            normal,
            center: centroid(input, bond.facet),
            push_n: law.bond_stiffness_pa_m() * half_area * stretch,
            friction_n: Vec3::zeros(),
            sticks: true,
        })
    }));
}

/// Adds the stiffness of bonds that are stretched.
pub fn add_stiffness(
    joints: &Joints,
    input: &ContactInput,
    bonds: &[Bond],
    stiffness: &mut Vec<PairStiffness>,
) {
    let blocks = input.blocks;
    for bond in bonds {
        let (triangle, tet) = (&blocks.triangles[bond.facet.index()], &blocks.tets[bond.tet.index()]);
        let Some(law) = law(joints, blocks, bond) else { continue };
        let Some(Opening { half_area, .. }) = opening(input, bond) else { continue };
        let [a, b, c, d] = bond.lambda;
        let weights = [1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, -a, -b, -c, -d];
        let mut spring = PairStiffness::new(triangle, tet);
        spring.add_spring(&weights, &Mat3::from_diagonal_element(law.bond_stiffness_pa_m() * half_area));
        stiffness.push(spring);
    }
}

fn centroid(input: &ContactInput, facet: TriangleId) -> Vec3 {
    input.blocks.triangle_corners(facet, input.position).iter().sum::<Vec3>() / 3.0
}

/// Energy stretched into bonds, ½ k ½S |d|² each [J].
pub fn energy_j(joints: &Joints, input: &ContactInput, bonds: &[Bond]) -> f64 {
    let blocks = input.blocks;
    let of_bond = |bond: &Bond| {
        let Some(Opening { stretch, half_area, .. }) = opening(input, bond) else { return 0.0 };
        let stiffness = law(joints, blocks, bond).map_or(0.0, |law| law.bond_stiffness_pa_m());
        0.5 * stiffness * half_area * stretch.norm_squared()
    };
    bonds.iter().map(of_bond).sum()
}
