//! The contact model built without a line of friction: what switching friction off must be equal to.

use ndda_contact::affine::BlockFaces;
use ndda_contact::affine::ConvexBlocks;
use ndda_contact::assembly::BlockContactIndex;
use ndda_contact::assembly::Reporter;
use ndda_contact::assembly::{ScatterScene, add_nodal_forces};
use ndda_contact::broad_phase::Candidates;
use ndda_contact::friction::{FacetForce, Openings};
use ndda_contact::integration::Frames;
use ndda_contact::integration::Integrals;
use ndda_contact::integration::Scene;
use ndda_contact::{ContactInput, ContactOutput, ContactReport, PotentialField};
use ndda_mesh::geometry::triangle_area_vector;
use rayon::prelude::*;

/// The element potential's normal forces.
#[derive(Default)]
pub struct Frictionless {
    candidates: Candidates,
    frames: Frames,
    hulls: ConvexBlocks,
    integrals: Integrals,
    adjacency: BlockContactIndex,
    reporter: Reporter,
    forces: Vec<FacetForce>,
    stiffness_pa: Vec<f64>,
}

impl Frictionless {
    /// Adds the forces.
    pub fn add_forces(
        &mut self,
        input: &ContactInput,
        penalty_pa: f64,
        output: &mut ContactOutput,
    ) -> ContactReport {
        let blocks = input.blocks;
        if self.candidates.update(input, &self.hulls) {
            self.hulls.fit(blocks, &BlockFaces::of_all(blocks), None, &[], true);
        }
        self.hulls.place(blocks, input.position);
        self.hulls.separate(blocks, input.position, &self.candidates.neighbours, 0.0);
        self.frames.place(&self.candidates, &self.hulls, input).expect("tetrahedra with volume");
        let (candidates, frames, field) = (&self.candidates, &self.frames, &PotentialField::Element);
        let (hulls, position, openings) = (&self.hulls, input.position, &Openings::default());
        let scene = Scene { blocks, position, candidates, frames, field, hulls, openings };
        self.integrals.update(&scene, None).expect("no other ranks");
        let integrals = &self.integrals;
        let touching = integrals.touching();
        let report =
            self.reporter.report(input, candidates, integrals, frames, field).expect("finite forces");
        self.forces.resize(touching.len(), FacetForce::default());
        let push = |(t, force): (usize, &mut FacetForce)| {
            *force = FacetForce::default();
            if integrals.overlaps_of(&touching[t]).iter().flat_map(|hit| hit.on_target.pressure).sum::<f64>()
                > 0.0
            {
                let corners = blocks.triangle_corners(touching[t].triangle, input.position);
                force.push = -penalty_pa * triangle_area_vector(&corners).normalize();
                force.touches = true;
            }
        };
        if touching.len() > 128 {
            self.forces.par_iter_mut().enumerate().with_min_len(64).for_each(push);
        } else {
            self.forces.iter_mut().enumerate().for_each(push);
        }
        self.stiffness_pa.clear();
        self.stiffness_pa.resize(touching.len(), penalty_pa);
        self.adjacency.arrange(blocks.len(), touching.iter().map(|touch| (touch.owner, touch.target)));
        let scene = ScatterScene {
            blocks,
            position: None,
            integrals,
            adjacency: &self.adjacency,
            hulls: &self.hulls,
            forces: &self.forces,
            on_host: &[],
            tilt_n_m: &[],
            stiffness_pa: &self.stiffness_pa,
            curvature_pa_m: &[],
        };
        add_nodal_forces(&scene, output);
        report
    }
}
