//! A triangle against a convex block whose nodes move by one affine map: half-spaces instead of tetrahedra.

use ndda_mesh::Vec3;
use pulp::{Arch, Simd, WithSimd};

use crate::affine::half_spaces::{HalfSpaces, Planes};
use crate::integration::clip::Outline;
use crate::integration::queue::RegionQueue;
use crate::integration::region::Region;

/// A look at a block that is an affine convex target.
pub(super) struct EvaluateHalfSpaces<'a> {
    pub(super) sides: &'a mut HalfSpaces,
    pub(super) planes: &'a [Planes],
    pub(super) corners: &'a [Vec3; 3],
    pub(super) normal: &'a Vec3,
    pub(super) outline: &'a Outline,
}

impl WithSimd for EvaluateHalfSpaces<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> bool {
        self.sides.look(simd, self.planes, self.corners, self.normal, self.outline)
    }
}

/// The regions that are seen then.
pub(super) struct PushRegions<'a> {
    pub(super) sides: &'a mut HalfSpaces,
    pub(super) region: &'a mut Region,
    pub(super) batches: &'a mut RegionQueue,
    pub(super) outline: &'a Outline,
    pub(super) arch: Arch,
    pub(super) at: u32,
    pub(super) area_m2: f64,
}

impl WithSimd for PushRegions<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { sides, region, batches, outline, arch, at, area_m2 } = self;
        for k in 0..sides.len() {
            if sides.set_region(simd, k, outline, region) {
                batches.push(arch, at, area_m2, region, outline);
            }
        }
    }
}
