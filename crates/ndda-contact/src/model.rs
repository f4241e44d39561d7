//! Input, output and history of a contact model.

use ndda_mesh::{BlockId, BlockSet, Mat3, TetId, TriangleId, Vec3};
use ndda_ranks::{Communicator, RanksError};
use serde::{Deserialize, Serialize};

/// Input of a contact model: positions and velocities of the blocks, but neither materials nor integrators.
#[derive(Clone, Copy, Debug)]
pub struct ContactInput<'a> {
    /// Topology and block ranges.
    pub blocks: &'a BlockSet,
    /// Where contact is evaluated, x* per node [m].
    pub position: &'a [Vec3],
    /// Velocity v per node [m/s]; `dt_s · v` is the slip of this step.
    pub velocity: &'a [Vec3],
    /// Step Δt [s].
    pub dt_s: f64,
    /// Which blocks move by an affine map of their rest shape, whatever acts on them; empty if that is not known.
    pub affine: &'a [bool],
    /// Rigid motion of each block; empty unless the model [`needs_bodies`](ContactModel::needs_bodies).
    pub bodies: &'a [Body],
    /// How blocks that deform move in the step, for friction that acts on velocities; without it they count as rigid there.
    pub deformation: Option<&'a dyn Deformation>,
    /// Whether the solver iterates on the forces of a step, and compares those of one evaluation with the next: whatever the model finds by
    /// iterations of its own must then be found to far below the solver's tolerance.
    pub is_iterated: bool,
    /// Whether only normal forces and stiffness are asked for: friction that acts on velocities may be left out.
    pub without_friction: bool,
    /// Whether bonds hold whatever they carry, as while a scene comes to rest: how far it swings on the way must not break them.
    pub bonds_hold: bool,
    /// Tolerance of friction, as a fraction of the largest on a block, where only the final rest counts, as while a scene settles; zero where the motion itself
    /// counts.
    pub friction_tolerance: f64,
    /// The ranks that evaluate contact together, each with the same input and history; none where this process does so alone.
    pub ranks: Option<&'a dyn Communicator>,
}

/// Slip, force and work of the shear spring of a facet, or of several, in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpringSlip {
    /// Most that it carries [N].
    pub capacity_n: f64,
    /// Shear force [N].
    pub shear_n: f64,
    /// Slip of the contactor on the target [m].
    pub slip_m: Vec3,
    /// Whether it carries all that it may.
    pub slides: bool,
}

/// Response of deformable blocks to forces within a step, which friction on velocities needs from the solver.
pub trait Deformation: Sync {
    /// Answers in place for some blocks, ascending, at once. `columns` has an entry for each of them, with columns of one
    /// vector per node of the block. The first column is the force of contact on each node [N] and becomes the velocity at the end of the step under all
    /// loads [m/s]; each other one is a force that acts all through the step, and becomes what it adds to that velocity.
    fn answer(&self, blocks: &[BlockId], columns: &mut [Vec<Vec3>]);

    /// Gives the masses of the nodes of a block [kg] to `work`.
    fn masses(&self, block: BlockId, work: &mut dyn FnMut(&[f64]));
}

impl std::fmt::Debug for dyn Deformation + '_ {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str("Deformation")
    }
}

impl<'a> ContactInput<'a> {
    /// An input about blocks of which only the nodes' motion is known.
    pub fn new(blocks: &'a BlockSet, position: &'a [Vec3], velocity: &'a [Vec3], dt_s: f64) -> Self {
        Self {
            blocks,
            position,
            velocity,
            dt_s,
            affine: &[],
            bodies: &[],
            deformation: None,
            is_iterated: false,
            without_friction: false,
            bonds_hold: false,
            friction_tolerance: 0.0,
            ranks: None,
        }
    }
}

/// Rigid motion and inertia of a block, as far as contact needs them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Mass [kg]; infinite for a block that cannot move.
    pub mass_kg: f64,
    /// Inverse of the inertia about the mass centre [1/(kg m²)]; zero for a block that cannot move.
    pub inverse_inertia: Mat3,
    /// Sum of all loads but contact [N].
    pub load_n: Vec3,
    /// Their torque about the mass centre [N m].
    pub torque_n_m: Vec3,
    /// Mass centre [m].
    pub center: Vec3,
    /// Its velocity at the start of the step [m/s].
    pub velocity_m_s: Vec3,
    /// By how much that changes in the step where the block moves as prescribed [m/s].
    pub prescribed_change_m_s: Vec3,
    /// Rate of rotation [rad/s].
    pub spin_rad_s: Vec3,
    /// Whether it deforms, so that its surface answers to forces as [`Deformation`] says.
    pub deforms: bool,
}

impl Body {
    /// A block of this mass [kg] at rest at the origin, without loads, whose inertia is still to be given.
    pub fn at_rest(mass_kg: f64) -> Self {
        Self {
            mass_kg,
            inverse_inertia: Mat3::zeros(),
            load_n: Vec3::zeros(),
            torque_n_m: Vec3::zeros(),
            center: Vec3::zeros(),
            velocity_m_s: Vec3::zeros(),
            prescribed_change_m_s: Vec3::zeros(),
            spin_rad_s: Vec3::zeros(),
            deforms: false,
        }
    }

    /// Adds a force at a point.
    pub fn push(&mut self, x: &Vec3, force_n: &Vec3) {
        self.load_n += force_n;
        self.torque_n_m += (x - self.center).cross(force_n);
    }

    /// Adds −ω × J ω, which turns the axis of a block that spins.
    pub fn add_gyroscopic_torque(&mut self) {
        if let Some(inertia) = self.inverse_inertia.try_inverse() {
            self.torque_n_m -= self.spin_rad_s.cross(&(inertia * self.spin_rad_s));
        }
    }

    /// Takes the velocities to the end of a step under the loads.
    pub fn advance_velocity(&mut self, dt_s: f64) {
        self.velocity_m_s += dt_s / self.mass_kg * self.load_n;
        self.spin_rad_s += dt_s * (self.inverse_inertia * self.torque_n_m);
    }

    /// Velocity at a point [m/s].
    pub fn velocity_at(&self, x: &Vec3) -> Vec3 {
        self.velocity_m_s + self.spin_rad_s.cross(&(x - self.center))
    }
}

/// Where a contact model adds its results; every slice has one entry per node.
#[derive(Debug)]
pub struct ContactOutput<'a> {
    /// Total contact force [N], normal and friction; sums to zero over all blocks.
    pub force: &'a mut [Vec3],
    /// The part of `force` that friction does [N]; untouched by a model without friction.
    pub friction_force: &'a mut [Vec3],
    /// Row sum of the contact stiffness, Σⱼ |∂fᵢ/∂xⱼ| along the normal, and that of shear springs [N/m]; bounds
    /// ω_c = √(stiffness / mass).
    pub stiffness: &'a mut [f64],
}

/// Counts and extremes of one evaluation of contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactReport {
    /// Pairs of a boundary triangle and a tetrahedron that were looked at.
    pub candidate_pairs: usize,
    /// Candidate pairs that overlap.
    pub contact_pairs: usize,
    /// Largest penetration depth over the height of the tetrahedron it is in (1/4 at the centroid).
    pub max_penetration_ratio: f64,
    /// The pair with that penetration.
    pub deepest: Option<(TriangleId, TetId)>,
    /// A tetrahedron whose centroid is inside another block: the potential no longer pushes out.
    pub past_centroid: Option<(TriangleId, TetId)>,
    /// Largest |force on contactor + force on target| / |force| over all pairs. Where a model does not say, the solver takes the sum of all its
    /// forces over the sum of their sizes.
    pub action_reaction_error: Option<f64>,
    /// Energy that contact has taken up because joints opened by slip since it was evaluated last [J]; friction did that work.
    pub dilation_work_j: f64,
    /// Largest change of a slip velocity by friction when the search for friction ended before it was found [m/s]; zero where it was found.
    pub friction_left_m_s: f64,
    /// By how much damping of contact that the step leaves out lets blocks go too fast, at most [m/s].
    pub dashpot_error_m_s: f64,
    /// By how much the strength of a bond was exceeded that broke in this evaluation, over its strength under its normal stress or without
    /// any, whichever is more.
    pub bond_overload: f64,
    /// Bonds that would have broken or slipped in this evaluation, were they not to hold.
    pub overloaded_bonds: usize,
}

/// Why contact forces could not be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ContactError {
    /// A target tetrahedron has no volume, so points in it have no barycentric coordinates.
    #[error(
        "tetrahedron {tet:?} of block {block:?} is flat or inverted (volume {volume_m3:e} m³): reduce step_s or the load"
    )]
    CollapsedTet {
        /// The tetrahedron.
        tet: TetId,
        /// Its block.
        block: BlockId,
        /// Its volume [m³].
        volume_m3: f64,
    },
    /// The potential cannot serve a block.
    #[error("{0}")]
    Potential(String),
    /// The contact history belongs to other friction laws.
    #[error(
        "the friction laws are not those of the saved friction history (it has {kept} numbers per facet, these laws have \
         {expected}): resume with the laws that wrote it"
    )]
    OtherLaws {
        /// Numbers kept.
        kept: usize,
        /// Numbers that the laws expect.
        expected: usize,
    },
    /// The ranks that evaluate contact together cannot go on.
    #[error(transparent)]
    Ranks(#[from] RanksError),
    /// A friction law of the caller's own has failed.
    #[error("the friction law failed: {0}")]
    Law(String),
    /// The model cannot say how its forces change.
    #[error(
        "this contact model has no stiffness, which contact at the end of the step needs: give `contact_at: Predicted`"
    )]
    NoTangent,
    /// A force came out infinite or not a number.
    #[error(
        "the force between triangle {triangle:?} and tetrahedron {tet:?} is not finite: reduce step_s or penalty_pa"
    )]
    NotFinite {
        /// The contactor's triangle.
        triangle: TriangleId,
        /// The target's tetrahedron.
        tet: TetId,
    },
}

/// Tangential memory of one contactor facet on one target.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FacetMemory {
    /// The contactor's boundary triangle.
    pub facet: TriangleId,
    /// The body that it touches.
    pub target: BlockId,
    /// The element that it touches, where memory belongs to pairs of elements.
    pub element: Option<TetId>,
    /// Shear force on the contactor in the facet's own basis (first edge, normal × first edge) [N].
    /// The basis turns with the facet, so the force does too.
    pub shear_n: [f64; 2],
    /// Torque of its shear spring about its normal [N m].
    pub twist_n_m: f64,
    /// Area in contact [m²].
    pub area_m2: f64,
    /// Whether cohesion is gone.
    pub broken: bool,
}

/// Friction of one face on one block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FaceMemory {
    /// Number of the face.
    pub face: u32,
    /// The block that it touches.
    pub target: BlockId,
    /// Friction force on the face's block [N].
    pub force_n: Vec3,
    /// Friction torque about the normal [N m].
    pub torque_n_m: f64,
    /// Whether the face slides.
    pub slides: bool,
    /// Outward normal of the face then.
    pub normal: Vec3,
}

/// A facet that holds to a point of another block by cohesion and tensile strength until it breaks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bond {
    /// The facet.
    pub facet: TriangleId,
    /// The element that holds the other end.
    pub tet: TetId,
    /// Centre of the bonded area, as barycentric coordinates of the facet.
    pub weights: [f64; 3],
    /// The point that it holds to, as barycentric coordinates of the element.
    pub lambda: [f64; 4],
    /// Bonded area over the area of the facet.
    pub share: f64,
    /// Part of the facet's contact that it holds: one bond holds all of it, or three a third each.
    pub part: f64,
    /// Part of it that is broken: 1 once it has broken, less where bonds break gradually.
    pub damage: f64,
    /// By how much it has slipped, where bonds slip without breaking [m].
    pub slip_m: f64,
    /// By how much it has opened for good, where bonds yield in tension [m].
    pub opened_m: f64,
    /// Its share of a normal force that acts at the first, second or third corner of the facet; of one in between, linear interpolation.
    pub bears: [f64; 3],
}

/// Motion of a block at the start of a step, and the push of contact in it, for contact damping.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyMemory {
    /// Velocity of its mass centre [m/s].
    pub velocity_m_s: Vec3,
    /// Rate of rotation [rad/s].
    pub spin_rad_s: Vec3,
    /// Sum of the normal forces of contact [N].
    pub push_n: Vec3,
    /// Their torque about the mass centre [N m].
    pub push_torque_n_m: Vec3,
    /// Sum of the forces of dashpots beside shear springs [N].
    pub dashpot_n: Vec3,
    /// Their torque about the mass centre [N m].
    pub dashpot_torque_n_m: Vec3,
    /// Length of the step [s].
    pub dt_s: f64,
}

impl BodyMemory {
    /// Motion of a block at the start of a step of `dt_s`, before contact has pushed it.
    pub fn new(body: &Body, dt_s: f64) -> Self {
        Self {
            velocity_m_s: body.velocity_m_s,
            spin_rad_s: body.spin_rad_s,
            push_n: Vec3::zeros(),
            push_torque_n_m: Vec3::zeros(),
            dashpot_n: Vec3::zeros(),
            dashpot_torque_n_m: Vec3::zeros(),
            dt_s,
        }
    }
}

/// Contact history from step to step; part of the state, so it is saved and rolled back with it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactHistory {
    /// One entry per facet and target in contact, sorted by (facet, target, element).
    pub facets: Vec<FacetMemory>,
    /// One entry per face and target in contact, for laws that act on faces; sorted by (face, target).
    pub faces: Vec<FaceMemory>,
    /// Bonds that hold, sorted by (facet, target, element).
    pub bonds: Vec<Bond>,
    /// Motion of each block in the last step; empty where no contact is damped.
    pub bodies: Vec<BodyMemory>,
    /// Whether contact has been evaluated before: what touches then, and only that, may hold together.
    pub begun: bool,
    /// How many numbers friction laws keep of each facet.
    pub law_state_len: u32,
    /// The numbers of the laws, facet by facet.
    pub law_state: Vec<f64>,
    /// For contact models of other people: whatever they remember.
    pub own: Vec<f64>,
}

impl ContactHistory {
    /// Forgets the bonds of blocks that are not there any more.
    pub fn forget_bonds(&mut self, blocks: &BlockSet, is_absent: impl Fn(BlockId) -> bool) {
        self.bonds.retain(|bond| {
            let [own, other] =
                [blocks.triangle_block[bond.facet.index()], blocks.tet_block[bond.tet.index()]];
            !is_absent(own) && !is_absent(other)
        });
    }
}

/// Contact between a boundary triangle and a block that it is pressed into.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FacetContact {
    /// The triangle.
    pub facet: TriangleId,
    /// The block that it is in.
    pub target: BlockId,
    /// Area of the triangle that is inside [m²]; zero for a bond.
    pub area_m2: f64,
    /// Outward normal of the triangle.
    pub normal: Vec3,
    /// Point of application of the force: the centre of pressure, or the centroid of a glued facet [m].
    pub center: Vec3,
    /// Force on the triangle but for friction [N].
    pub push_n: Vec3,
    /// Friction on the triangle, or the shear of a bond [N].
    pub friction_n: Vec3,
    /// Moment on the triangle about `center`, besides that of both forces there: of friction of a face that turns, and of contact damping [N m].
    pub couple_n_m: Vec3,
    /// Whether friction holds it.
    pub sticks: bool,
}
