//! The time step.
//!
//! [`Simulation`] holds the constant problem and the changing [`State`]; [`Simulation::step`] reads like the paper's
//! page. Contact is known only through [`ContactModel`](ndda_contact::ContactModel), time through
//! [`TimeIntegrator`], linear algebra through [`LinearSolver`].

pub mod batch;
pub mod block_books;
pub mod body;
pub mod conjugate_gradients;
mod contact_fields;
pub mod contact_moments;
mod contact_rates;
pub mod creep;
pub mod damping;
mod deformation;
pub mod dense_inverse;
pub mod direct;
pub mod elastic_body;
pub mod end_contact;
mod first_step;
pub mod fixed_body;
pub mod for_each_block;
pub mod generalized_alpha;
pub mod ledger;
pub mod linear_solver;
pub mod loads;
pub mod mass_damping;
pub mod midpoint;
pub mod newmark;
pub mod plan;
pub mod rigid_body;
mod ringing;
pub mod sample;
pub mod settle;
pub mod setup;
pub mod shape;
pub mod simulation;
pub mod sink;
pub mod squeeze;
pub mod state;
pub mod step_control;
pub mod step_error;
pub mod stiffness_damping;
pub mod supernodal;
pub mod testing;
pub mod time_integrator;
mod travel;
pub mod unknowns;

pub use block_books::Worst;
pub use body::{BlockError, BodyKind};
pub use conjugate_gradients::ConjugateGradients;
pub use damping::StepDamping;
pub use dense_inverse::DenseInverse;
pub use direct::Direct;
pub use end_contact::{EndContact, Iterations};
pub use generalized_alpha::GeneralizedAlpha;
pub use ledger::{Invariants, Sample};
pub use linear_solver::{Factor, FactorError, LinearSolver, SolveError, SymmetricMatrix};
pub use midpoint::Midpoint;
pub use newmark::Newmark;
pub use plan::{FactorPlan, KindPlan, Plan};
pub use settle::{Settle, Settled};
pub use setup::Setup;
pub use shape::{BodySetup, ForceSetup, Mass, SetupError, Shape, TractionSetup};
pub use simulation::{RestoreError, Simulation, Snapshot, StageTimes, StepReport};
pub use sink::{RunError, Sink, SinkError, View, resume, run};
pub use state::State;
pub use step_control::{AutoStep, StepCounts};
pub use step_error::StepError;
pub use supernodal::{Supernodal, SupernodalFactor};
pub use time_integrator::{Inertia, StepWeights, TimeIntegrator};
