//! How a bond is deformed, and what it bears.

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{TetId, Vec3};

use crate::friction::fracture::Fracture;
use crate::friction::law::{FacetSlip, FrictionLaw, ShearMemory};
use crate::integration::tet_frame::TetFrame;
use crate::model::{Bond, ContactInput};

/// Offsets below this part of the coordinates are rounding.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// How a bond breaks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Break {
    /// By how much its strength is exceeded, over that under the present normal stress or without any, whichever is more.
    pub(crate) overload: f64,
    /// Whether the joint opens there, so that it is broken: in shear alone it may keep a part of its strength.
    pub(crate) opens: bool,
}

/// How a bond is deformed.
pub(crate) struct Stretch {
    /// The bonded point of the facet [m].
    pub(crate) center: Vec3,
    /// λ of that point in the target's tetrahedron.
    pub(crate) lambda: [f64; 4],
    /// Outward unit normal of the facet.
    pub(crate) normal: Vec3,
    /// Distance along it to the point that it is bonded to [m]; negative while pressed.
    pub(crate) opening_m: f64,
    /// Offset of that point across the normal [m].
    pub(crate) offset_m: Vec3,
    /// Half of the bonded area [m²].
    pub(crate) half_area: f64,
    /// Rounding of lengths [m].
    pub(crate) rounding_m: f64,
    /// Part of it that is not broken.
    pub(crate) whole: f64,
}

impl Stretch {
    pub(crate) fn of(input: &ContactInput, bond: &Bond) -> Self {
        let corners = input.blocks.triangle_corners(bond.facet, input.position);
        let tet = input.blocks.tet_corners(bond.tet, input.position);
        let anchor: Vec3 = tet.iter().zip(bond.lambda).map(|(x, l)| l * x).sum();
        let center = mean(&corners, &bond.weights);
        let area_vector = triangle_area_vector(&corners);
        let normal = area_vector.normalize();
        let stretch = anchor - center;
        let opening_m = stretch.dot(&normal);
        let largest = corners.iter().chain(&tet).map(Vec3::amax).fold(0.0, f64::max);
        Self {
            center,
            lambda: TetFrame::new(&tet).lambda_at(&center),
            normal,
            opening_m,
            offset_m: stretch - opening_m * normal,
            half_area: 0.5 * bond.share * area_vector.norm(),
            rounding_m: ROUNDING * largest,
            whole: 1.0 - bond.damage,
        }
    }

    /// The point that it is bonded to [m].
    pub(crate) fn anchor(&self) -> Vec3 {
        self.center + self.opening_m * self.normal + self.offset_m
    }

    /// Opening and slip without what may be rounding [m].
    pub(crate) fn beyond_rounding_m(&self) -> (f64, f64) {
        (self.opening_m - self.rounding_m, (self.offset_m.norm() - self.rounding_m).max(0.0))
    }

    /// Its direction and how much more it gives along that while it is being damaged than what is whole of it [Pa/m]; damage that depends on the ratio of opening
    /// to slip is taken as that of a constant ratio.
    pub(crate) fn softening(&self, fracture: &Fracture, damage: f64) -> Option<(Vec3, f64)> {
        let (opening_m, slip_m) = self.beyond_rounding_m();
        let is_loaded = damage > 0.0 && fracture.damage(opening_m, slip_m) >= damage;
        let direction = (self.opening_m.max(0.0) * self.normal + self.offset_m).try_normalize(0.0)?;
        is_loaded.then(|| (direction, fracture.stiffness_pa_m * fracture.softening(opening_m, slip_m)))
    }

    /// Tension ½ S k_b max(δ, 0) of what is not broken [N].
    pub(crate) fn tension_n(&self, law: &dyn FrictionLaw) -> f64 {
        self.whole * law.bond_stiffness_pa_m() * self.half_area * self.opening_m.max(0.0)
    }

    /// Shear ½ S k_s s of what is not broken on the facet [N].
    pub(crate) fn shear_n(&self, law: &dyn FrictionLaw) -> Vec3 {
        self.whole * law.shear_stiffness_pa_m() * self.half_area * self.offset_m
    }

    /// The state of the friction law after a slip of the bond [m].
    pub(crate) fn memory<'a>(
        &self,
        (law, slip_m): (&dyn FrictionLaw, f64),
        state: &'a mut Vec<f64>,
    ) -> ShearMemory<'a> {
        state.resize(law.state_len(), 0.0);
        law.begin(state);
        set_slip(law, state, slip_m);
        ShearMemory { broken: false, state, ..ShearMemory::default() }
    }

    /// How the joint's strength is exceeded; none while it holds: k_b δ ≤ σ_t and |k_s s| ≤ max(0, c + σ tan φ), to rounding. The overload is 0 where neither cohesion nor tensile strength is left: friction, which is all that there is,
    /// goes on unchanged when such a bond breaks, so that it does not matter when.
    pub(crate) fn overload(
        &self,
        law: &dyn FrictionLaw,
        (pressed_n, tension_pa, slip_m): (f64, f64, f64),
        state: &mut Vec<f64>,
    ) -> Option<Break> {
        let whole = self.memory((law, slip_m), state);
        let capacity_n = |normal_n: f64| {
            let slip = FacetSlip { normal_n, area_m2: 2.0 * self.half_area, ..FacetSlip::default() };
            law.capacity_n(&slip, &whole)
        };
        let tensile_pa = law.bond_stiffness_pa_m() * (self.opening_m - self.rounding_m);
        let rounding_n = law.shear_stiffness_pa_m() * self.half_area * self.rounding_m;
        let present_n = capacity_n(pressed_n - self.tension_n(law));
        let tensile_n = (tensile_pa - tension_pa) * self.half_area;
        let excess_n = tensile_n.max(self.shear_n(law).norm() - present_n - rounding_n);
        let without_friction_n = capacity_n(0.0).max(tension_pa * self.half_area);
        let overload = || {
            if without_friction_n > 0.0 { excess_n / present_n.max(without_friction_n) } else { 0.0 }
        };
        // Friction alone has nothing to lose where contact still presses.
        let opens = tensile_n > 0.0 && (without_friction_n > 0.0 || self.is_pulled(law, pressed_n));
        (excess_n > 0.0).then(|| Break { overload: overload(), opens })
    }

    /// Whether it pulls by more than contact presses, by more than rounding: it was pressed where it formed, and gives way before it is open.
    pub(crate) fn is_pulled(&self, law: &dyn FrictionLaw, pressed_n: f64) -> bool {
        self.opening_m > self.rounding_m && self.tension_n(law) > pressed_n
    }
}

/// Makes the plastic slip of a law that softens by it at least that of a bond [m]; other laws have no such number.
pub(crate) fn set_slip(law: &dyn FrictionLaw, state: &mut [f64], slip_m: f64) {
    if let (true, Some(first)) = (slip_m > 0.0 && law.survives_slip(), state.first_mut()) {
        *first = first.max(slip_m);
    }
}

pub(crate) fn frame_of(tet: TetId, input: &ContactInput) -> TetFrame {
    TetFrame::new(&input.blocks.tet_corners(tet, input.position))
}

pub(crate) fn mean(corners: &[Vec3; 3], weights: &[f64; 3]) -> Vec3 {
    corners.iter().zip(weights).map(|(x, weight)| *weight * x).sum()
}
