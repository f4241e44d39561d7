//! Files in and out: RON scenes with their diagnostics, meshes of other programs, VTU fields, history and checkpoints.
//!
//! A scene is read with its values in any unit, and each mistake is found at its place:
//!
//! ```
//! use ndda_io::read::load_text;
//!
//! let scene = r#"(
//!     title: "A block falls",
//!     time: (step_s: Millisecond(1), end_s: 1),
//!     materials: [(name: "rock", density_kg_m3: 2600, young_pa: Gigapascal(50), poisson: 0.25)],
//!     blocks: [(name: "block", material: "rock", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
//! )"#;
//! let loaded = load_text("fall.ron", scene, &[], None).expect("a valid scene");
//! assert_eq!(loaded.scene.materials[0].young_pa, 50e9);
//!
//! let errors = load_text("fall.ron", &scene.replace("0.25", "0.75"), &[], None).unwrap_err();
//! assert_eq!(errors.diagnostics[0].path, "materials[0].poisson");
//! ```
//!
//! | module | contents |
//! |---|---|
//! | [`scene`] | the scene's types, reading and checking them, messages with their places, studies, records |
//! | [`mesh`] | meshes of tetrahedra and surfaces in the formats of Gmsh, TetGen, VTK, Abaqus, STL and OBJ |
//! | [`results`] | fields, history, tables and checkpoints: written, and read back |
//! | [`atomic`] | whole files or none |

#![warn(unreachable_pub)]

pub mod atomic;
mod csv_text;
mod limited;
pub mod mesh;
pub mod results;
pub mod scene;
mod write_error;

#[cfg(feature = "tetgen")]
pub use mesh::tetgen_fill;
pub use mesh::{self as mesh_file, gmsh_program, msh, surface_file};
pub use results::{checkpoint, table, vtu};
#[cfg(feature = "schema")]
pub use scene::schema;
pub use scene::{code, diagnostic, joint_table, locate, outside_files, read, record, study};

pub use results::bolt_lines::{BoltLine, BoltSeries};
pub use results::folder::OutputFolder;
pub use results::history::History;
pub use results::pvd::FieldSeries;
pub use vtu::Frame;
pub use write_error::WriteError;
