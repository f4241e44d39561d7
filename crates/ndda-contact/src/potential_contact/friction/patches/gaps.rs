//! How far friction was from Coulomb's law, once it is known how the nodes have moved.

use ndda_mesh::{BlockId, BlockSet, Vec3};
use rayon::prelude::*;

use crate::friction::facet::FacetForce;
use crate::friction::patches::patch::{ContactPatch, Moved, PatchFacets};
use crate::friction::patches::{FrictionPatches, GRAIN_PATCHES};
use crate::integration::integrals::Integrals;
use crate::room::make_room;

impl FrictionPatches {
    /// How far friction of the last [`add`](Self::add) was from Coulomb's law over displacements of the nodes [m]: blocks and energy [J], one call for
    /// each patch.
    pub(crate) fn each_coulomb_gap(
        &mut self,
        (blocks, integrals, forces): (&BlockSet, &Integrals, &[FacetForce]),
        moved: &[Vec3],
        add: &mut dyn FnMut(BlockId, BlockId, f64),
    ) {
        let scene = Moved { blocks, integrals, moved };
        let Self { patches, details, runs, order, gaps_j, .. } = self;
        make_room(gaps_j, patches.len());
        gaps_j.resize(patches.len(), 0.0);
        let gap = |((gap_j, patch), run): ((&mut f64, &ContactPatch), &PatchFacets)| {
            let detail = patch.detail.map(|detail| &details[detail as usize]);
            *gap_j = patch.coulomb_gap_j(detail, run.of(order), &scene, forces);
        };
        gaps_j.par_iter_mut().zip(&*patches).zip(&*runs).with_min_len(GRAIN_PATCHES).for_each(gap);
        for (patch, &gap_j) in patches.iter().zip(&*gaps_j) {
            add(patch.owner, patch.target, gap_j);
        }
    }
}
