//! The contract suite of contact models, and blocks to run it on.

mod contact_model;
mod shapes;

pub use contact_model::{Answer, check_model, evaluate};
pub use shapes::{Random, test_box, test_horseshoe, test_set};
