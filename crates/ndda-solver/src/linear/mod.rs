//! Factors and solves of the matrix of one block.

pub(crate) mod conjugate_gradients;
pub(crate) mod dense_inverse;
pub(crate) mod direct;
pub(crate) mod linear_solver;
pub(crate) mod supernodal;
