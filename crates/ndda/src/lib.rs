//! Runs scenes of rock blocks that slide, topple, collide and fall.
//!
//! A scene is a description of blocks, materials, contact, supports and time; [`Model`] builds its simulation, [`Run`] steps
//! it to the end, shows each step to observers, records results if asked to, and judges what came out.
//!
//! ```
//! use ndda::{Model, Run};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = r#"Scene(
//!     title: "A block falls for a second",
//!     time: (step_s: 0.01, end_s: 1.0), gravity_m_s2: (0, 0, -9.81), contact: Off,
//!     materials: [(name: "rock", density_kg_m3: 2600, young_pa: 1e9, poisson: 0.25)],
//!     blocks: [(name: "block", material: "rock", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
//!     monitors: [(name: "centre", block: "block")],
//! )"#;
//! let outcome = Run::new(Model::from_text(scene)?).finish(&mut [])?;
//! let fallen_m = outcome.monitor("centre").expect("the scene has it").displacement[2];
//! assert!((fallen_m + 0.5 * 9.81).abs() < 1e-9);
//! # Ok(())
//! # }
//! ```
//!
//! # Map
//!
//! | module | contents |
//! |---|---|
//! | [`build`] | scene → blocks, materials, supports, contact model, simulation: the place where names become objects |
//! | [`forecast`] | what is known before the first step: memory, run time, stable time step |
//! | [`run`] | a run with its history, fields, contacts, checkpoints and log |
//! | [`driver`] | a simulation that a script or another program steps |
//! | [`judge`] | closed forms, verdicts, the label `accurate` or `inaccurate` |
//! | [`summary`] | what a run did, what it cost and whether it can be trusted |
//! | [`checked`] | what `ndda check` finds in a scene without errors |
//! | [`explain`] | what a run will do, what it leaves out and why |
//! | [`study`] | many runs of one scene: error against time |
//! | [`sweep`] | quantities over values and distributions of parameters: tables, probability of failure |
//! | [`certify`] | every result as value ± error |
//! | [`safety`] | the factor of safety of a slope, and how its blocks fail |
//! | [`rockfall`] | boulders over terrain: paths, reach, heights, speeds and energies at lines |
//! | [`joint`] | direct shear and closure of one joint, without blocks |
//! | [`stereonet`] | orientations of joints on a net, and kinematic checks of a slope |
//! | [`shaking`] | records of ground motion: measures, response spectra, slip of a rigid block |
//! | [`numbers`] | numbers as command lines take them |
//! | [`tune`] | the cheapest settings that reach an error |
//! | [`examples`], [`templates`] | scenes that come with the program |
//! | `report` | a run as a page of HTML (feature `report`) |
//! | `picture` | pictures as SVG and PNG (features `plots`, `png`) |
//! | `view3d` | pictures and animations of blocks in 3D (features `plots`, `png`) |

mod base_of_block;
pub mod body_counts;
pub mod bolt_report;
pub mod build;
pub mod certify;
pub mod checked;
pub mod choose;
pub mod columns;
mod documents;
pub mod driver;
pub mod examples;
pub mod explain;
#[cfg(any(feature = "plots", feature = "report"))]
mod field;
pub mod forecast;
#[cfg(any(feature = "plots", feature = "report"))]
mod frames;
pub mod joint;
pub mod judge;
mod lean;
pub mod machine;
pub mod mesh_export;
pub mod mesh_files;
pub mod mesh_input;
#[cfg(feature = "plots")]
pub mod mesh_picture;
pub mod mesh_report;
mod model;
pub mod numbers;
#[cfg(feature = "plots")]
pub mod picture;
pub mod places;
#[cfg(feature = "plots")]
pub mod plot;
#[cfg(feature = "report")]
pub mod report;
pub mod rockfall;
pub mod rocking;
pub mod run;
pub mod safety;
pub mod shaking;
pub mod stereonet;
pub mod study;
pub mod summary;
#[cfg(any(feature = "plots", feature = "report"))]
mod surface;
pub mod sweep;
pub mod templates;
pub mod tune;
#[cfg(feature = "plots")]
pub mod view3d;
mod waves;

pub use model::Model;
pub use run::{Outcome, Run, RunError};
