//! A simulation that somebody else steps: a script, a notebook, another program.

use ndda_contact::FacetContact;
use ndda_io::checkpoint;
use ndda_io::summary::Label;
use ndda_solver::{DriveError, RestoreError, Sample, Simulation, Snapshot, StepError};

pub use ndda_mesh::{BlockId, Vec3};

use crate::Model;
use crate::judge::verdict;
use crate::run::contact_rows::{COLUMNS, contact_rows};
use crate::run::schedule::is_due;

/// A simulation that is stepped from outside and judged as [`Run`](crate::Run) judges it.
///
/// Energies are sampled at the steps at which a run of the same scene samples them, whatever the caller looks at, so that state
/// and label after the scene's last step are those of the run.
///
/// ```
/// use ndda::{Model, driver::Driver};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let (_, text) = ndda::driver::EXAMPLE;
/// let mut driver = Driver::new(Model::from_text(text)?)?;
/// driver.step(50)?;
/// let fallen_m = driver.simulation().state().position[0].z - driver.simulation().start_position()[0].z;
/// assert!((fallen_m + 0.5 * 9.81 * 0.25).abs() < 1e-9);
/// # Ok(())
/// # }
/// ```
pub struct Driver {
    model: Model,
    /// Steps of the scene, and how many rows of history it requests.
    steps: u64,
    rows: u64,
    /// Why the simulation cannot go on; its state is then not to be used.
    stopped: Option<StepError>,
    facets: Vec<FacetContact>,
}

/// State of a [`Driver`]; it can be restored in any driver of the same scene.
#[derive(Clone, Debug)]
pub struct DriverSnapshot {
    /// Text of the scene.
    scene: String,
    snapshot: Snapshot,
    stopped: Option<StepError>,
}

/// Why a snapshot cannot be restored.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DriverRestoreError {
    /// The snapshot is of another scene.
    #[error("the snapshot is of another scene: restore it in a simulation of the scene that it was taken of")]
    OtherScene,
    /// Meshes that the scene names have changed.
    #[error(transparent)]
    OtherProblem(#[from] RestoreError),
}

/// Name and text of a scene for examples: a rigid block falls for a second.
pub const EXAMPLE: (&str, &str) = (
    "fall.ron",
    r#"Scene(
    title: "A block falls for a second",
    time: (step_s: 0.01, end_s: 1.0), gravity_m_s2: (0, 0, -9.81), contact: Off,
    materials: [(name: "rock", density_kg_m3: 2600, young_pa: 1e9, poisson: 0.25)],
    blocks: [(name: "block", material: "rock", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
)"#,
);

impl Driver {
    /// Takes a model to its start; a scene that begins at rest is settled first.
    ///
    /// # Errors
    /// [`StepError`] when the scene does not settle, or its start cannot be sampled.
    pub fn new(mut model: Model) -> Result<Self, StepError> {
        let scene = &model.loaded.scene;
        let rows = u64::from(scene.output.history_rows);
        if let Some(settle) = scene.settle {
            let settle = crate::build::settle(settle);
            model.simulation.settle_watched(&settle, &mut |_| std::ops::ControlFlow::Continue(()))?;
        }
        model.simulation.sample()?;
        Ok(Self { steps: model.steps(), rows, model, stopped: None, facets: Vec::new() })
    }

    /// Takes so many steps.
    ///
    /// # Errors
    /// [`StepError`]; the same one again at every later call, until a snapshot is restored.
    pub fn step(&mut self, count: u64) -> Result<(), StepError> {
        (0..count).try_for_each(|_| self.one_step())
    }

    fn one_step(&mut self) -> Result<(), StepError> {
        if let Some(error) = &self.stopped {
            return Err(error.clone());
        }
        let simulation = &mut self.model.simulation;
        let mut done = simulation.step().map(|_| ());
        if done.is_ok() && is_due(simulation.state().step, self.steps, self.rows) {
            done = simulation.sample().map(|_| ());
        }
        self.stopped = done.clone().err();
        done
    }

    /// Energies and momenta now.
    ///
    /// # Errors
    /// [`StepError`] when an element is inside out, or the simulation has stopped before.
    pub fn sample(&mut self) -> Result<Sample, StepError> {
        if let Some(error) = &self.stopped {
            return Err(error.clone());
        }
        self.model.simulation.sample().inspect_err(|error| self.stopped = Some(error.clone()))
    }

    /// The simulation's label so far: a sample is taken first, so that nothing since the last one is missed.
    pub fn label(&mut self) -> Label {
        let stopped_by = self.sample().err().map(|error| format!("[{}] {error}", error.code()));
        verdict::label(&self.model.simulation, stopped_by.as_deref())
    }

    /// Cauchy stress xx, yy, zz, xy, yz, zx of each tetrahedron \[Pa\].
    ///
    /// # Errors
    /// [`StepError`] when stresses cannot be recovered, or the simulation has stopped before.
    pub fn stress_pa(&mut self) -> Result<Vec<[f64; 6]>, StepError> {
        if let Some(error) = &self.stopped {
            return Err(error.clone());
        }
        let mut stress_pa = vec![[0.0; 6]; self.model.simulation.blocks().tets.len()];
        self.model.simulation.recover_stress(&mut stress_pa)?;
        Ok(stress_pa)
    }

    /// Whether contacts are kept from the next step on.
    pub fn watch_contacts(&mut self, wanted: bool) {
        self.model.simulation.watch_contacts(wanted);
    }

    /// The pairs that touched in the last step, a row of [`COLUMNS`] each; none where contacts are not watched.
    pub fn contacts(&mut self) -> Vec<[f64; COLUMNS.len()]> {
        contact_rows(&self.model.simulation, &mut self.facets)
    }

    /// Lets a force [N] act at a block's centre of mass from now on ([`Simulation::set_force`]).
    ///
    /// # Errors
    /// [`DriveError`]; nothing has changed then.
    pub fn set_force(&mut self, block: BlockId, force_n: Vec3) -> Result<(), DriveError> {
        self.model.simulation.set_force(block, force_n)
    }

    /// Gives a block a velocity [m/s] and a spin [rad/s] now ([`Simulation::set_velocity`]).
    ///
    /// # Errors
    /// [`DriveError`]; nothing has changed then.
    pub fn set_velocity(
        &mut self,
        block: BlockId,
        velocity_m_s: Vec3,
        spin_rad_s: Vec3,
    ) -> Result<(), DriveError> {
        self.model.simulation.set_velocity(block, velocity_m_s, spin_rad_s)
    }

    /// A copy of all that changes.
    pub fn snapshot(&self) -> DriverSnapshot {
        let scene = self.model.loaded.text.clone();
        DriverSnapshot { scene, snapshot: self.model.simulation.snapshot(), stopped: self.stopped.clone() }
    }

    /// Goes on from a snapshot of the same scene, bit for bit.
    ///
    /// # Errors
    /// [`DriverRestoreError`] when it is of another scene; nothing has changed then.
    pub fn restore(&mut self, snapshot: &DriverSnapshot) -> Result<(), DriverRestoreError> {
        if snapshot.scene != self.model.loaded.text {
            return Err(DriverRestoreError::OtherScene);
        }
        self.model.simulation.restore(snapshot.snapshot.clone())?;
        self.stopped.clone_from(&snapshot.stopped);
        Ok(())
    }

    /// CRC-32 of the state in hexadecimal, as in the summary of a run.
    pub fn state_crc32(&self) -> String {
        format!("{:08x}", checkpoint::fingerprint(self.simulation().state()))
    }

    /// The simulation.
    pub fn simulation(&self) -> &Simulation {
        &self.model.simulation
    }

    /// The scene with its simulation and monitors.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Why the simulation cannot go on.
    pub fn stopped(&self) -> Option<&StepError> {
        self.stopped.as_ref()
    }

    /// Steps to the end of the scene.
    pub fn steps(&self) -> u64 {
        self.steps
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::Run;

    /// The cube of `scenes/bounce.ron` just past its first impact.
    fn bounce() -> Model {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/bounce.ron");
        Model::open(&file, &["time.end_s=0.12".into()]).unwrap()
    }

    #[test]
    fn single_steps_give_state_and_label_of_a_run() {
        let outcome = Run::new(bounce()).finish(&mut []).unwrap();
        let mut driver = Driver::new(bounce()).unwrap();
        for _ in 0..driver.steps() {
            driver.step(1).unwrap();
        }
        assert_eq!(driver.state_crc32(), outcome.summary.state_crc32);
        assert_eq!(driver.label(), outcome.summary.label);
    }

    #[test]
    fn a_cube_that_is_struck_and_pushed_stays_accurate() {
        let mut driver = Driver::new(bounce()).unwrap();
        driver.step(100).unwrap();
        let blocks = driver.simulation().blocks();
        let cube = blocks.ids().find(|id| blocks.names[id.index()] == "cube").unwrap();
        driver.set_velocity(cube, Vec3::new(0.1, 0.0, -0.5), Vec3::new(0.0, 0.2, 0.0)).unwrap();
        driver.set_force(cube, Vec3::new(1.0, 0.0, 0.0)).unwrap();
        driver.step(300).unwrap();
        assert_eq!(driver.label().reasons, Vec::<String>::new());
    }

    #[test]
    fn a_snapshot_of_another_scene_is_refused() {
        let fall = Driver::new(Model::from_text(EXAMPLE.1).unwrap()).unwrap();
        let mut driver = Driver::new(bounce()).unwrap();
        assert_eq!(driver.restore(&fall.snapshot()), Err(DriverRestoreError::OtherScene));
    }

    #[test]
    fn a_restored_snapshot_goes_on_with_the_same_bits() {
        let mut driver = Driver::new(bounce()).unwrap();
        driver.step(1900).unwrap();
        let snapshot = driver.snapshot();
        driver.step(300).unwrap();
        let end = driver.state_crc32();
        driver.restore(&snapshot).unwrap();
        assert_ne!(driver.state_crc32(), end);
        driver.step(300).unwrap();
        assert_eq!(driver.state_crc32(), end);
    }
}
