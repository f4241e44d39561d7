//! The seam for friction laws, and the memory that they keep.

use ndda_mesh::Vec3;

use crate::friction::fracture::Fracture;

/// Motion of a facet, or a whole face, on its target in this step; vectors are in the facet's own basis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FacetSlip {
    /// Normal force f_n on the facet [N]; negative for tension, which only an unbroken contact carries.
    pub normal_n: f64,
    /// Area in contact S [m²].
    pub area_m2: f64,
    /// Mean of that and of the area in the last step, of which the shear spring is that the slip stretches [m²].
    pub mean_area_m2: f64,
    /// Step Δt [s].
    pub dt_s: f64,
    /// Slip of this step, contactor minus target, predicted from the velocities [m].
    pub slip_m: [f64; 2],
    /// Change of the shear force on the contactor that would leave no slip velocity at the end of the step [N].
    pub stopping_n: [f64; 2],
}

impl FacetSlip {
    /// That of a part of the facet.
    pub(crate) fn of_part(self, part: f64) -> Self {
        let [normal_n, area_m2, mean_area_m2] =
            [self.normal_n, self.area_m2, self.mean_area_m2].map(|whole| part * whole);
        Self { normal_n, area_m2, mean_area_m2, ..self }
    }
}

/// History of a facet on its target.
#[derive(Debug, PartialEq)]
pub struct ShearMemory<'a> {
    /// Shear force on the contactor in the facet's own basis (first edge, normal × first edge) [N].
    /// The basis turns with the facet, so the force does too.
    pub shear_n: [f64; 2],
    /// Whether cohesion is gone; it never comes back.
    pub broken: bool,
    /// Numbers of the law's own: as many as its [`state_len`](FrictionLaw::state_len) says, kept from step to step and in
    /// checkpoints.
    pub state: &'a mut [f64],
}

impl Default for ShearMemory<'_> {
    /// A contact that begins during a run: no shear, and nothing that could hold it together.
    fn default() -> Self {
        Self { shear_n: [0.0; 2], broken: true, state: &mut [] }
    }
}

/// A law for the shear force of one contactor facet, or one face, on one target.
///
/// Contract (checked by [`check_friction`](crate::friction::testing::check_friction)): the force never exceeds what the law
/// says it can carry, takes energy from the slip, turns with it, and is zero without contact; a law whose strength is constant holds what
/// it held, and its force grows with a steady slip until it slides.
pub trait FrictionLaw: Send + Sync {
    /// Its name, for a person who asks.
    fn name(&self) -> &'static str;

    /// How many numbers the law keeps of each facet and target beside the shear force. A law that acts on whole faces keeps none.
    fn state_len(&self) -> usize {
        0
    }

    /// Meaning of these numbers and how many have it, in their order. Where another law takes over, numbers of the same meaning go on, and the others begin anew.
    fn state_parts(&self) -> Vec<(&'static str, usize)> {
        vec![(self.name(), self.state_len())]
    }

    /// Sets the law's own numbers where a contact begins; zeros unless a law says otherwise.
    fn begin(&self, state: &mut [f64]) {
        state.fill(0.0);
    }

    /// Whether the strength depends on nothing but the normal force, the area, and whether the contact is broken; not so where it changes with slip, its
    /// rate, or time.
    fn has_constant_strength(&self) -> bool {
        self.state_len() == 0
    }

    /// Advances the shear force by one step.
    fn advance(&self, slip: &FacetSlip, memory: &mut ShearMemory);

    /// Most that the law carries [N].
    fn capacity_n(&self, slip: &FacetSlip, memory: &ShearMemory) -> f64;

    /// Stiffness of the law against slip, of both sides together [Pa/m]: with it a step has to be short enough.
    fn shear_stiffness_pa_m(&self) -> f64 {
        0.0
    }

    /// Whether what touches when contact is first evaluated holds together until it breaks.
    fn holds_together(&self) -> bool {
        false
    }

    /// Whether a facet whose bond breaks keeps the strength that it has, and softens from there. The first of such a law's own numbers is the plastic slip [m].
    fn survives_slip(&self) -> bool {
        false
    }

    /// Tension that an unbroken contact carries [Pa].
    fn tension_pa(&self) -> f64 {
        0.0
    }

    /// Tension that a bond carries which has slipped by so much [m], where bonds slip without breaking ([Pa]); none where slip breaks a bond. A law with
    /// such bonds keeps the plastic slip, and nothing else, as its own number.
    fn tension_after_slip_pa(&self, _slip_m: f64) -> Option<f64> {
        None
    }

    /// How far a bond may open beyond the stretch of its spring, at the tension that it carries, before it breaks [m].
    fn opens_m(&self) -> f64 {
        0.0
    }

    /// Stiffness of a bond that carries tension [Pa/m].
    fn bond_stiffness_pa_m(&self) -> f64 {
        0.0
    }

    /// How bonds break, where they do so gradually; the law itself is then that of what is broken, and sees only its part of the force and the area.
    fn fracture(&self) -> Option<&Fracture> {
        None
    }

    /// Angle by which a joint opens while it slips, as far as the law itself says [°]: see [`Dilating`](crate::Dilating).
    fn dilation_deg(&self, _slip: &FacetSlip, _memory: &ShearMemory) -> f64 {
        0.0
    }

    /// By how much a joint has opened by slip [m].
    fn dilation_m(&self, _memory: &ShearMemory) -> f64 {
        0.0
    }

    /// Whether a joint may open by slip at all.
    fn dilates(&self) -> bool {
        false
    }

    /// By how much a joint had opened by slip when it was clipped last, and by how much it is open from now on [m], from the law's own numbers; the facet is moved
    /// out by the latter before it is clipped.
    fn openings_m(&self, _state: &[f64]) -> [f64; 2] {
        [0.0; 2]
    }

    /// Whether the law acts on whole faces through [`FacetSlip::stopping_n`], not on each facet by its slip.
    fn acts_on_faces(&self) -> bool {
        false
    }
}

/// √(x² + y²).
pub(crate) fn length([x, y]: [f64; 2]) -> f64 {
    (x * x + y * y).sqrt()
}

/// The vector no longer than `most`, along its own direction; whether it was.
pub(crate) fn capped(trial: [f64; 2], most: f64) -> ([f64; 2], bool) {
    let size = length(trial);
    if size > most {
        let scale = most / size;
        ([trial[0] * scale, trial[1] * scale], true)
    } else {
        (trial, false)
    }
}

/// Two unit vectors in the facet that turn with it as a whole, whichever corner is the first: along
/// a = x₀ + R(−120°) x₁ + R(120°) x₂, R being turns about the normal, and across. Other first corners turn a by 120°; it does not
/// vanish where the facet has an area.
pub(crate) fn facet_basis(corners: &[Vec3; 3], normal: &Vec3) -> [Vec3; 2] {
    let [x0, x1, x2] = corners;
    let half_root_of_3 = 0.5 * 3f64.sqrt();
    let along = 0.5 * ((x0 - x1) + (x0 - x2)) + half_root_of_3 * normal.cross(&(x2 - x1));
    let along = (along - normal * normal.dot(&along)).normalize();
    [along, normal.cross(&along)]
}
