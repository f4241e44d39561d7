//! The time step: blocks that deform and move, contact between them, and what a run keeps account of.
//!
//! [`Simulation`] is made of a [`Setup`] and goes on with [`Simulation::step`], which reads like the paper's page: loads, contact,
//! each block alone, account. Contact is known only through [`ContactModel`](ndda_contact::ContactModel), time through
//! [`TimeIntegrator`], linear algebra through [`LinearSolver`].
//!
//! A block that falls for a tenth of a second:
//!
//! ```
//! use std::sync::Arc;
//!
//! use ndda_fem::LinearElastic;
//! use ndda_mesh::generate::{BoxPattern, box_block};
//! use ndda_mesh::{BlockSet, Vec3};
//! use ndda_solver::{BodyKind, BodySetup, Direct, Mass, Newmark, Setup, Simulation};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let block = BodySetup {
//!     kind: BodyKind::Elastic,
//!     material: Arc::new(LinearElastic::new(50e9, 0.25, 2650.0)?),
//!     supports: Vec::new(),
//!     initial_stress: None,
//!     tractions: Vec::new(),
//!     pressures: Vec::new(),
//!     ties: Vec::new(),
//!     quiet: Vec::new(),
//!     forces: Vec::new(),
//!     velocity_m_s: Vec3::zeros(),
//!     spin_rad_s: Vec3::zeros(),
//! };
//! let mut simulation = Simulation::new(Setup {
//!     blocks: BlockSet::new(vec![("block".into(), box_block([1.0; 3], [1, 1, 1], BoxPattern::Six)?)])?,
//!     bodies: vec![block],
//!     gravity_m_s2: Vec3::new(0.0, 0.0, -9.81),
//!     gravity_factor: None,
//!     mass: Mass::Consistent,
//!     step_s: 1e-3,
//!     integrator: Box::new(Newmark { alpha: 0.25, delta: 0.5 }),
//!     contact: None,
//!     implicit_contact: None,
//!     solver: Box::new(Direct),
//!     auto_step: None,
//!     bolts: Vec::new(),
//! })?;
//! let start_m = simulation.state().position[0].z;
//! for _ in 0..100 {
//!     simulation.step()?;
//! }
//! let fallen_m = start_m - simulation.state().position[0].z;
//! assert!((fallen_m - 0.5 * 9.81 * 0.1 * 0.1).abs() < 1e-9);
//! # Ok(())
//! # }
//! ```
//!
//! | chapter | |
//! |---|---|
//! | `step` | the step, its control, contact at its end, settling, what changes ([`State`]) |
//! | `bolts` | rock bolts, solved statically in each step |
//! | `bodies` | one step of one block: elastic, affine, rigid, fixed; damping |
//! | `integrators` | Newmark, midpoint, generalised α |
//! | `linear` | factors and solves: supernodal, dense, conjugate gradients |
//! | `diagnostics` | balances of energy and momentum ([`Invariants`]), ringing, creep, lateral drift |
//! | [`testing`] | contract suites for integrators and solvers of other people |

#![warn(unreachable_pub)]

mod bodies;
mod bolts;
mod diagnostics;
mod error;
mod integrators;
mod linear;
mod sink;
mod step;
pub mod testing;

pub use bodies::kind::BodyKind;
pub use bodies::prototype::{
    BodySetup, ForceSetup, Mass, PressureSetup, Prototype, QuietSetup, TractionSetup,
};
pub use bodies::step_damping::StepDamping;
pub use bodies::unknowns::Unknowns;
pub use bolts::embedding::{Portion, first_rock_m};
pub use bolts::error::BoltError;
pub use bolts::memory::BoltMemory;
pub use bolts::report::{BoltPiece, BoltState, BoltStatus, PieceState};
pub use bolts::setup::{BoltSetup, Grout, Plate, Steel};
pub use bolts::span::Dowel;
pub use diagnostics::energies::Sample;
pub use diagnostics::invariants::Invariants;
pub use diagnostics::worst::Worst;
pub use error::{BlockError, SetupError, StepError, shown_time_s};
pub use integrators::generalized_alpha::GeneralizedAlpha;
pub use integrators::midpoint::Midpoint;
pub use integrators::newmark::Newmark;
pub use integrators::time_integrator::{Inertia, StepWeights, TimeIntegrator};
pub use linear::conjugate_gradients::ConjugateGradients;
pub use linear::dense_inverse::DenseInverse;
pub use linear::direct::Direct;
pub use linear::linear_solver::{
    Factor, FactorError, LinearSolver, MULTI, Scratch, SolveError, SymmetricMatrix,
};
pub use linear::supernodal::{Supernodal, SupernodalFactor};
pub use sink::{RunError, Sink, SinkError, View, advance, resume, run, show, show_start, unseen_step};
pub use step::Simulation;
pub use step::change::TakeOverError;
pub use step::control::AutoStep;
pub use step::drive::DriveError;
pub use step::implicit_contact::ImplicitContact;
pub use step::local_damping::LocalDamping;
pub use step::plan::{FactorPlan, KindPlan, Plan};
pub use step::report::{Iterations, StageTimes, StepCounts, StepReport};
pub use step::settle::{Settle, Settled, Settling};
pub use step::settling_progress::Damping;
pub use step::setup::Setup;
pub use step::snapshot::{RestoreError, Snapshot, SnapshotView};
pub use step::stage::{LeaveOutError, StageStart};
pub use step::stage_state::StageState;
pub use step::start_snapshot::StartSnapshot;
pub use step::state::State;
pub use step::unsettled::Unsettled;
