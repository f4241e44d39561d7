//! Files in and out: RON scenes with their diagnostics, Gmsh meshes, VTU fields, history and summary.

pub mod msh;
pub mod scene;
