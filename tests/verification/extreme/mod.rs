//! Extreme cases: each runs a scene of `scenes/extreme/`, whose header says what is expected. The promise: a bounded, reported
//! answer, or a clean stop that names the cause; a run that is wrong and calls itself accurate is the only failure.

mod initial_overlap;
mod label;
mod labelled;
mod shear_penalty;
mod stability;
mod tunnelling;
