//! A simulation that somebody else steps: a script, a notebook, another program.

mod change;
mod drive;
mod judged;
mod saved;
mod snapshot;

use std::ops::ControlFlow;
use std::sync::Arc;

use ndda_contact::FacetContact;
use ndda_io::diagnostic::SceneErrors;
use ndda_io::{checkpoint, read};
use ndda_solver::{Sample, Settled, Simulation, SinkError, StartSnapshot, StepError};

pub use change::ChangeError;
pub use judged::{Disturbance, Disturbed};
pub use ndda_mesh::{BlockId, Vec3};
pub use saved::{LoadError, SaveError};
pub use snapshot::{DriverRestoreError, DriverSnapshot};

use judged::Course;

use crate::Model;
use crate::build::Choices;
use crate::run::contact_rows::{COLUMNS, contact_rows};
use crate::run::fields::FieldWriter;
use crate::run::schedule::is_due;

/// Rows of a history that there is room for from the start.
const ORDINARY_ROWS: u64 = 10_000;

/// A simulation that is stepped from outside, up to the first of its stages if it has any, and judged as [`Run`](crate::Run) judges it.
///
/// Energies are sampled at the steps at which a run of the same scene samples them, whatever the caller looks at, and the scene is run again
/// where the run repeats it, so that state and label after the scene's last step are those of the run.
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
    /// What was sampled so far.
    history: Vec<Sample>,
    watches_contacts: bool,
    course: Course,
    /// Text of the scene as it was at the start, before any [`change`](Driver::change).
    origin: Arc<str>,
    parts: Option<Parts>,
    /// Parts that the scene does not name, in words.
    own: Option<String>,
}

/// Parts of a program's own, made anew whenever a simulation is built.
pub type Parts = Arc<dyn Fn() -> Choices + Send + Sync>;

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
    pub fn new(model: Model) -> Result<Self, StepError> {
        Self::with_parts(model, None, &mut |_| ControlFlow::Continue(()))
    }

    /// Takes a model to its start that was built with `parts`; `settling` is shown how far a scene has settled, and may break it off.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_parts(
        mut model: Model,
        parts: Option<Parts>,
        settling: &mut dyn FnMut(&Settled) -> ControlFlow<()>,
    ) -> Result<Self, StepError> {
        let built = model.simulation.start_snapshot();
        if let Some(settle) = model.loaded.scene.settle {
            model.simulation.settle_watched(&crate::build::settle(settle), settling)?;
        }
        let start = model.simulation.sample()?;
        let origin = model.loaded.text.as_str().into();
        let mut driver = Self::around(model, (origin, built, None), parts);
        driver.history.push(start);
        Ok(driver)
    }

    /// A driver of a model, with the text and the state at its start, and what other than steps has changed it since.
    fn around(
        model: Model,
        (origin, built, disturbed): (Arc<str>, StartSnapshot, Option<Disturbed>),
        parts: Option<Parts>,
    ) -> Self {
        let rows = u64::from(model.loaded.scene.output.history_rows);
        let steps = crate::build::steps(&model.loaded.scene.time);
        // Room for all rows of an ordinary run: a step allocates nothing.
        let history = Vec::with_capacity(rows.min(steps).min(ORDINARY_ROWS) as usize + 2);
        let (stopped, facets, watches_contacts) = (None, Vec::new(), false);
        let course = Course::new(built, disturbed);
        let own = choices(parts.as_ref()).own();
        Self { model, steps, rows, stopped, facets, history, watches_contacts, course, origin, parts, own }
    }

    /// Builds a text of the scene with the parts that the driver was begun with.
    fn build(&self, text: &str, overrides: &[String]) -> Result<Model, SceneErrors> {
        let (file, folder) = (&self.model.loaded.file, self.model.folder.as_path());
        let loaded = read::load_text(file, text, overrides, Some(folder))?;
        Model::resuming_with(loaded, folder, choices(self.parts.as_ref()))
    }

    /// Puts another model in the place of the present one.
    fn put(&mut self, model: Model) {
        self.steps = crate::build::steps(&model.loaded.scene.time);
        self.rows = u64::from(model.loaded.scene.output.history_rows);
        self.model = model;
        self.model.simulation.watch_contacts(self.watches_contacts);
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
        self.course.forget_label();
        let simulation = &mut self.model.simulation;
        let mut done = simulation.step().map(|_| ());
        if done.is_ok() && is_due(simulation.state().step, self.steps, self.rows) {
            done = simulation.sample().map(|sample| self.history.push(sample));
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

    /// Samples at the steps at which a run of the scene samples, the start included; a driver that was loaded begins anew.
    pub fn history(&self) -> &[Sample] {
        &self.history
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
        self.watches_contacts = wanted;
        self.model.simulation.watch_contacts(wanted);
    }

    /// The pairs that touched in the last step, a row of [`COLUMNS`] each; none where contacts are not watched.
    pub fn contacts(&mut self) -> Vec<[f64; COLUMNS.len()]> {
        contact_rows(&self.model.simulation, &mut self.facets)
    }

    /// A frame of the present state as a VTK file (`.vtu`), with the fields that the scene's `output` names.
    ///
    /// # Errors
    /// [`SinkError`] when stresses cannot be recovered, or a number is not finite.
    pub fn frame(&mut self) -> Result<Vec<u8>, SinkError> {
        FieldWriter::encode(&self.model.loaded.scene, &mut self.model.simulation)
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

/// Parts of a program's own, or none.
fn choices(parts: Option<&Parts>) -> Choices {
    parts.map_or_else(Choices::default, |make| make())
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::Run;

    /// The cube of `scenes/bounce.ron` just past its first impact.
    pub(super) fn bounce() -> Model {
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
    fn a_simulation_with_a_law_of_its_own_goes_on_only_with_that_law() {
        use crate::build::Choices;
        let slippery = || {
            let law = ndda_contact::Coulomb::new(5.0, 1e10);
            Choices { friction: Some(Box::new(law)), ..Choices::default() }
        };
        let parts: Parts = Arc::new(slippery);
        let model = || {
            let loaded = bounce().loaded;
            Model::with(loaded, &bounce().folder, slippery()).unwrap()
        };
        let begin = || Driver::with_parts(model(), Some(parts.clone()), &mut |_| ControlFlow::Continue(()));
        let mut driver = begin().unwrap();
        driver.step(10).unwrap();
        let (folder, mut plain) = (tempfile::tempdir().unwrap(), Driver::new(bounce()).unwrap());
        let file = folder.path().join("state");
        driver.save(&file).unwrap();
        let refused = plain.restore(&driver.snapshot());
        assert!(matches!(refused, Err(DriverRestoreError::Own { .. })), "{refused:?}");
        assert_eq!(plain.simulation().state().step, 0);
        assert!(matches!(Driver::load(&file, None), Err(LoadError::Own { .. })));
        Driver::load(&file, Some(parts.clone())).unwrap().restore(&driver.snapshot()).unwrap();
        begin().unwrap().restore(&driver.snapshot()).unwrap();
    }
}
