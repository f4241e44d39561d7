//! Sink of fields: a frame at even intervals, of what the scene requests; nothing else is computed.

use std::ops::ControlFlow;
use std::time::Instant;

use ndda_fem::stress::von_mises_pa;
use ndda_io::scene::{Field, Precision, Scene};
use ndda_io::vtu::{Topology, Values};
use ndda_io::{FieldSeries, Frame, OutputFolder, WriteError};
use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockSet, Vec3};
use ndda_solver::{Simulation, Sink, SinkError, StepError, View};
use serde::{Deserialize, Serialize};

use crate::build;
use crate::run::schedule::Schedule;

/// Cell data that is 0 where a stage of construction has taken a block out, or has not yet put it in.
pub(crate) const PRESENT: &str = "present";

/// Friction state of a node that a facet holds, and of one where a facet slides.
const STICKS: u8 = 1;
const SLIDES: u8 = 2;

/// Writes a frame of fields at even intervals.
pub struct FieldWriter {
    series: FieldSeries,
    fields: Vec<Field>,
    precision: Precision,
    schedule: Schedule,
    /// Per tetrahedron; empty unless some field needs it.
    stress_pa: Vec<[f64; 6]>,
    /// Seconds spent.
    pub spent_s: f64,
}

/// State of a [`FieldWriter`] in a checkpoint.
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
        schedule: Schedule,
        saved: Option<SavedFields>,
    ) -> Result<Self, WriteError> {
        let fields = scene.output.fields.clone();
        let topology = topology(scene, simulation.blocks());
        let stress_pa = room_for_stress(&fields, simulation.blocks());
        let spent_s = saved.as_ref().map_or(0.0, |saved| saved.spent_s);
        Ok(Self {
            series: match saved {
                None => FieldSeries::create(folder, topology)?,
                Some(saved) => FieldSeries::resume(folder, topology, saved.times_s)?,
            },
            fields,
            precision: scene.output.precision,
            schedule,
            stress_pa,
            spent_s,
        })
    }

    /// Its state for a checkpoint, all frames being on the disk.
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
        let mut stress_pa = room_for_stress(fields, simulation.blocks());
        let frame = frame(fields, precision, simulation, &mut stress_pa)?;
        let topology = topology(scene, simulation.blocks());
        Ok(frame.encode("frame.vtu".as_ref(), &topology)?)
    }
}

impl Sink for FieldWriter {
    fn wants_contacts(&self, step: u64) -> bool {
        let of_facets =
            |field| matches!(field, &Field::FrictionState | &Field::ContactForce | &Field::ContactTraction);
        self.fields.iter().any(of_facets) && self.schedule.is_due(step)
    }

    fn step_done(&mut self, view: &mut View) -> Result<ControlFlow<()>, SinkError> {
        if !self.schedule.is_due(view.simulation.state().step) {
            return Ok(ControlFlow::Continue(()));
        }
        let started = Instant::now();
        let frame = frame(&self.fields, self.precision, view.simulation, &mut self.stress_pa)?;
        self.series.push(view.simulation.time_s(), &frame)?;
        self.spent_s += started.elapsed().as_secs_f64();
        Ok(ControlFlow::Continue(()))
    }
}

/// A stress for each tetrahedron, if a field needs it.
fn room_for_stress(fields: &[Field], blocks: &BlockSet) -> Vec<[f64; 6]> {
    vec![[0.0; 6]; if need_stress(fields) { blocks.tets.len() } else { 0 }]
}

/// Whether some field is made of stresses.
pub fn need_stress(fields: &[Field]) -> bool {
    fields.iter().any(|field| matches!(field, Field::Stress | Field::VonMises))
}

/// The part that does not change from frame to frame.
fn topology(scene: &Scene, blocks: &BlockSet) -> Topology {
    let mut topology = Topology::new(blocks, scene.output.format);
    for field in &scene.output.fields {
        topology = match field {
            Field::BlockId => topology.with_blocks(blocks),
            Field::Material => {
                let materials = build::materials_of(scene, blocks);
                let of_tets = blocks.tet_block.iter().map(|block| materials[block.index()]);
                topology.with_numbers("material", of_tets)
            }
            _ => topology,
        };
    }
    // Which blocks are not there is said by their numbers.
    let numbers_blocks = scene.output.fields.contains(&Field::BlockId);
    if scene.stages.is_empty() || numbers_blocks { topology } else { topology.with_blocks(blocks) }
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
    let mut frame = Frame::new(simulation.blocks(), &simulation.state().position);
    if simulation.has_stages() {
        let of_tets = simulation.blocks().tet_block.iter();
        let present = of_tets.map(|block| u8::from(!simulation.is_absent(*block))).collect();
        frame.add_cells(Values::states(PRESENT, present));
    }
    for field in fields {
        match field {
            Field::Stress => frame.add_cells(Values::new("stress_pa", stress_pa.iter().copied(), precision)),
            Field::VonMises => {
                let von_mises = stress_pa.iter().map(|s| [von_mises_pa(s)]);
                frame.add_cells(Values::new("von_mises_pa", von_mises, precision));
            }
            // Of the topology.
            Field::BlockId | Field::Material => {}
            Field::FrictionState => {
                frame.add_points(Values::states("friction_state", friction_states(simulation)));
            }
            Field::ContactForce => {
                let force = simulation.contact_forces_n().into_iter();
                frame.add_points(Values::vectors("contact_force_n", force, precision));
            }
            Field::ContactTraction => frame.add_points(traction(simulation, precision)),
            Field::Displacement | Field::Velocity | Field::Acceleration => {
                frame.add_points(motion(*field, simulation, precision));
            }
        }
    }
    Ok(frame)
}

/// Displacement, velocity or acceleration of the nodes.
fn motion(field: Field, simulation: &Simulation, precision: Precision) -> Values {
    let state = simulation.state();
    match field {
        Field::Velocity => Values::vectors("velocity_m_s", state.velocity.iter().copied(), precision),
        Field::Acceleration => {
            Values::vectors("acceleration_m_s2", state.acceleration.iter().copied(), precision)
        }
        _ => {
            let moved = state.position.iter().zip(simulation.counted_from()).map(|(x, start)| x - start);
            Values::vectors("displacement_m", moved, precision)
        }
    }
}

/// Contact force over the surface of the nodes; none inside.
fn traction(simulation: &Simulation, precision: Precision) -> Values {
    let areas = node_areas_m2(simulation.blocks(), &simulation.state().position);
    let over = |(force, &area): (Vec3, &f64)| if area > 0.0 { force / area } else { Vec3::zeros() };
    Values::vectors(
        "contact_traction_pa",
        simulation.contact_forces_n().into_iter().zip(&areas).map(over),
        precision,
    )
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
        for node in simulation.pressing_triangle(contact) {
            states[node.index()] = state.max(states[node.index()]);
        }
    }
    states
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stresses_are_recovered_only_for_fields_that_need_them() {
        let mesh = ndda_contact::testing::test_box([0.0; 3], [1.0; 3], [1, 1, 1]);
        let blocks = BlockSet::new(vec![("a".into(), mesh)]).expect("a block");
        for (field, tets) in [(Field::Velocity, 0), (Field::Stress, 6), (Field::VonMises, 6)] {
            assert_eq!(room_for_stress(&[Field::Displacement, field], &blocks).len(), tets, "{field:?}");
        }
    }

    #[test]
    fn frames_of_stages_number_their_blocks() {
        let numbers = |stages: &str| {
            let text = format!(
                r#"(title: "t", time: (step_s: 1e-4, end_s: 1e-3), output: (fields: [Displacement]), {stages}
                    materials: [(name: "rock", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
                    blocks: [(name: "a", material: "rock", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))])"#
            );
            let mut model = crate::Model::from_text(&text).unwrap();
            let scene = model.loaded.scene.clone();
            let topology = topology(&scene, model.simulation.blocks());
            let frame =
                frame(&scene.output.fields, scene.output.precision, &mut model.simulation, &mut []).unwrap();
            let bytes = frame.encode(std::path::Path::new("a.vtu"), &topology).unwrap();
            String::from_utf8_lossy(&bytes).contains("block_id")
        };
        assert!(!numbers("") && numbers(r#"stages: [(name: "next", then: Run(1e-3))],"#));
    }
}
