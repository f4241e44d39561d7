//! One step of one block, whatever kind of body it is.

pub(crate) mod batch;
pub(crate) mod body;
pub(crate) mod congruent_groups;
pub(crate) mod context;
pub(crate) mod elastic_body;
pub(crate) mod fixed_body;
pub(crate) mod kind;
pub(crate) mod mass_damping;
pub(crate) mod prototype;
pub(crate) mod record;
pub(crate) mod report;
pub(crate) mod rigid_body;
pub(crate) mod rigid_inertia;
pub(crate) mod spin_torque;
pub(crate) mod step_damping;
pub(crate) mod stiffness_damping;
pub(crate) mod unknowns;
pub(crate) mod workspaces;
