//! Sink of fields: a frame at even intervals, of what the scene asks for; nothing else is computed.

use std::ops::ControlFlow;
use std::time::Instant;

use ndda_io::scene::{Field, Precision, Scene};
use ndda_io::vtu::{Topology, Values, von_mises_pa};
use ndda_io::{FieldSeries, Frame, OutputFolder, WriteError};
use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockSet, Vec3};
use ndda_solver::{Simulation, Sink, SinkError, StepError, View};
use serde::{Deserialize, Serialize};

use crate::recorder::is_due;
use crate::wiring;

/// Friction state of a node that a facet holds, and of one where a facet slides.
const STICKS: u8 = 1;
const SLIDES: u8 = 2;

/// Writes a frame of fields at even intervals.
pub struct FieldWriter {
    series: FieldSeries,
    fields: Vec<Field>,
    precision: Precision,
    steps: u64,
    frames: u64,
    /// Per tetrahedron; empty unless some field needs it.
    stress_pa: Vec<[f64; 6]>,
    /// Seconds spent.
    pub spent_s: f64,
}

/// What a checkpoint keeps of a [`FieldWriter`].
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct SavedFields {
    times_s: Vec<f64>,
    spent_s: f64,
}

impl FieldWriter {
    /// Begins a series of frames, or goes on with a saved one.
    ///
    /// # Errors
    /// [`WriteError`] when its folder cannot be made.
    pub fn new(
        folder: &OutputFolder,
        simulation: &Simulation,
        scene: &Scene,
        steps: u64,
        saved: Option<SavedFields>,
    ) -> Result<Self, WriteError> {
        let fields = scene.output.fields.clone();
        let topology = topology(scene, simulation.blocks());
        let needs_stress = fields.iter().any(|f| matches!(f, Field::Stress | Field::VonMises));
        let tets = if needs_stress { simulation.blocks().tets.len() } else { 0 };
        let spent_s = saved.as_ref().map_or(0.0, |saved| saved.spent_s);
        Ok(Self {
            series: match saved {
                None => FieldSeries::create(folder, topology)?,
                Some(saved) => FieldSeries::resume(folder, topology, saved.times_s)?,
            },
            fields,
            precision: scene.output.precision,
            steps,
            frames: u64::from(scene.output.frames),
            stress_pa: vec![[0.0; 6]; tets],
            spent_s,
        })
    }

    /// What a checkpoint keeps of it, all frames being on the disk.
    ///
    /// # Errors
    /// [`WriteError`] when one of them is not.
    pub fn save(&mut self) -> Result<SavedFields, WriteError> {
        self.series.sync()?;
        Ok(SavedFields { times_s: self.series.times_s().to_vec(), spent_s: self.spent_s })
    }

    /// The file of a frame of now, without writing it.
    ///
    /// # Errors
    /// [`StepError`] when stresses cannot be recovered, [`WriteError`] for a number that is not finite.
    pub fn encode(scene: &Scene, simulation: &mut Simulation) -> Result<Vec<u8>, SinkError> {
        let (fields, precision) = (&scene.output.fields, scene.output.precision);
        let mut stress_pa = vec![[0.0; 6]; simulation.blocks().tets.len()];
        let frame = frame(fields, precision, simulation, &mut stress_pa)?;
        let topology = topology(scene, simulation.blocks());
        Ok(ndda_io::vtu::encode("frame.vtu".as_ref(), &topology, &frame)?)
    }
}

impl Sink for FieldWriter {
    fn wants_contacts(&self, step: u64) -> bool {
        self.fields.contains(&Field::FrictionState) && is_due(step, self.steps, self.frames)
    }

    fn step_done(&mut self, view: &mut View) -> Result<ControlFlow<()>, SinkError> {
        if !is_due(view.simulation.state().step, self.steps, self.frames) {
            return Ok(ControlFlow::Continue(()));
        }
        let started = Instant::now();
        let frame = frame(&self.fields, self.precision, view.simulation, &mut self.stress_pa)?;
        self.series.push(view.simulation.time_s(), &frame)?;
        self.spent_s += started.elapsed().as_secs_f64();
        Ok(ControlFlow::Continue(()))
    }
}

/// What does not change from frame to frame.
fn topology(scene: &Scene, blocks: &BlockSet) -> Topology {
    let mut topology = Topology::new(blocks, scene.output.format);
    for field in &scene.output.fields {
        topology = match field {
            Field::BlockId => topology.with_blocks(blocks),
            Field::Material => {
                let materials = wiring::materials_of(scene, blocks);
                let of_tets = blocks.tet_block.iter().map(|block| materials[block.index()]);
                topology.with_numbers("material", of_tets)
            }
            _ => topology,
        };
    }
    topology
}

/// The fields of now; `stress_pa` is room for stresses, and has none where no field needs them.
fn frame(
    fields: &[Field],
    precision: Precision,
    simulation: &mut Simulation,
    stress_pa: &mut [[f64; 6]],
) -> Result<Frame, StepError> {
    if !stress_pa.is_empty() {
        simulation.recover_stress(stress_pa)?;
    }
    let (state, blocks) = (simulation.state(), simulation.blocks());
    let mut frame = Frame::new(blocks, &state.position);
    for field in fields {
        match field {
            Field::Displacement => {
                let moved =
                    state.position.iter().zip(simulation.start_position()).map(|(x, start)| x - start);
                frame.add_points(Values::vectors("displacement_m", moved, precision));
            }
            Field::Velocity => {
                let velocity = state.velocity.iter().copied();
                frame.add_points(Values::vectors("velocity_m_s", velocity, precision));
            }
            Field::Acceleration => {
                let acceleration = state.acceleration.iter().copied();
                frame.add_points(Values::vectors("acceleration_m_s2", acceleration, precision));
            }
            Field::ContactForce => {
                let force = simulation.contact_forces_n();
                frame.add_points(Values::vectors("contact_force_n", force, precision));
            }
            Field::ContactTraction => {
                let areas = node_areas_m2(blocks, &state.position);
                let over =
                    |(force, &area): (Vec3, &f64)| if area > 0.0 { force / area } else { Vec3::zeros() };
                let traction = simulation.contact_forces_n().zip(&areas).map(over);
                frame.add_points(Values::vectors("contact_traction_pa", traction, precision));
            }
            Field::FrictionState => {
                frame.add_points(Values::states("friction_state", friction_states(simulation)));
            }
            Field::Stress => frame.add_cells(Values::new("stress_pa", stress_pa.iter().copied(), precision)),
            Field::VonMises => {
                let von_mises = stress_pa.iter().map(|s| [von_mises_pa(s)]);
                frame.add_cells(Values::new("von_mises_pa", von_mises, precision));
            }
            Field::BlockId | Field::Material => {}
        }
    }
    Ok(frame)
}

/// Each node's share of the surface, a third of its triangles.
fn node_areas_m2(blocks: &BlockSet, position: &[Vec3]) -> Vec<f64> {
    let mut areas = vec![0.0; position.len()];
    for triangle in &blocks.triangles {
        let area = triangle_area_vector(&triangle.map(|n| position[n.index()])).norm();
        triangle.iter().for_each(|n| areas[n.index()] += area / 3.0);
    }
    areas
}

/// Whether facets at each node are held by friction, or slide.
fn friction_states(simulation: &Simulation) -> Vec<u8> {
    let blocks = simulation.blocks();
    let mut states = vec![0; blocks.rest_position.len()];
    for contact in simulation.contacts() {
        let state = if contact.sticks { STICKS } else { SLIDES };
        for node in blocks.triangles[contact.facet.index()] {
            states[node.index()] = state.max(states[node.index()]);
        }
    }
    states
}
