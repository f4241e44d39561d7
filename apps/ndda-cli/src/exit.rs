//! Exit codes, so that scripts can tell what happened.

/// The run reached its end.
pub const DONE: u8 = 0;
/// The run reached its end, but a criterion was not met.
pub const FAILED: u8 = 1;
/// The command line is wrong.
pub const USAGE: u8 = 2;
/// The scene or a mesh is not usable.
pub const BAD_INPUT: u8 = 3;
/// The run stopped because going on would have given a wrong number.
pub const STOPPED: u8 = 4;
/// Files could not be written.
pub const INPUT_OUTPUT: u8 = 5;
/// Threads or memory could not be had.
pub const RESOURCE: u8 = 6;
/// Somebody asked the run to end; it can be resumed.
pub const INTERRUPTED: u8 = 130;
