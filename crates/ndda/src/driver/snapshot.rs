//! The state of a driver, to go back to.

use std::sync::Arc;

use ndda_io::diagnostic::SceneErrors;
use ndda_solver::{RestoreError, Sample, Snapshot, StepError};

use super::{Disturbed, Driver};

/// State of a [`Driver`]; it can be restored in any driver of the same scene.
#[derive(Clone, Debug)]
pub struct DriverSnapshot {
    /// Text of the scene at the start, and now.
    origin: Arc<str>,
    scene: String,
    snapshot: Snapshot,
    stopped: Option<StepError>,
    /// Samples of energies and momenta from the start up to this state.
    history: Vec<Sample>,
    pub(super) disturbed: Option<Disturbed>,
    /// Parts that the scene does not name, in words.
    own: Option<String>,
}

/// Why a snapshot cannot be restored.
#[derive(Debug, thiserror::Error)]
pub enum DriverRestoreError {
    /// The snapshot is of another scene.
    #[error("the snapshot is of another scene: restore it in a simulation of the scene that it was taken of")]
    OtherScene,
    /// It is of a simulation with other parts than the scene's.
    #[error(
        "the snapshot is of a simulation with {own}, and this one has {here}: restore it in a simulation that has it"
    )]
    Own {
        /// The parts that the snapshot was computed with.
        own: String,
        /// The parts of the simulation that it is restored in.
        here: String,
    },
    /// Meshes that the scene names have changed.
    #[error(transparent)]
    OtherProblem(#[from] RestoreError),
    /// The scene as it was cannot be built any more.
    #[error(transparent)]
    Scene(#[from] SceneErrors),
}

/// The parts of a saved state and those of a simulation, in words, where the state cannot go on there: it has parts of its own, and not those.
pub(super) fn other_parts(saved: Option<&str>, present: Option<&str>) -> Option<(String, String)> {
    let own = saved.filter(|own| present != Some(own))?;
    Some((own.into(), present.unwrap_or("no law of its own").into()))
}

impl Driver {
    /// A copy of all that changes, and of the history so far.
    pub fn snapshot(&self) -> DriverSnapshot {
        let (origin, scene) = (self.origin.clone(), self.model.loaded.text.clone());
        let (snapshot, stopped) = (self.model.simulation.snapshot(), self.stopped.clone());
        let (history, disturbed, own) = (self.history.clone(), self.course.disturbed, self.own.clone());
        DriverSnapshot { origin, scene, snapshot, stopped, history, disturbed, own }
    }

    /// Goes on from a snapshot of the same scene, bit for bit, with the history that led to it.
    ///
    /// # Errors
    /// [`DriverRestoreError`] when it is of another scene; nothing has changed then.
    pub fn restore(&mut self, snapshot: &DriverSnapshot) -> Result<(), DriverRestoreError> {
        if snapshot.origin != self.origin {
            return Err(DriverRestoreError::OtherScene);
        }
        if let Some((own, here)) = other_parts(snapshot.own.as_deref(), self.own.as_deref()) {
            return Err(DriverRestoreError::Own { own, here });
        }
        if snapshot.scene == self.model.loaded.text {
            self.model.simulation.restore(snapshot.snapshot.clone())?;
        } else {
            let mut model = self.build(&snapshot.scene, &[])?;
            model.simulation.restore(snapshot.snapshot.clone())?;
            self.put(model);
        }
        self.stopped.clone_from(&snapshot.stopped);
        self.course.forget_label();
        self.course.disturbed = snapshot.disturbed;
        self.history.clone_from(&snapshot.history);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use ndda_mesh::{BlockId, Vec3};

    use super::*;
    use crate::Model;
    use crate::driver::EXAMPLE;
    use crate::driver::tests::bounce;

    #[test]
    fn a_snapshot_of_another_scene_is_refused() {
        let fall = Driver::new(Model::from_text(EXAMPLE.1).unwrap()).unwrap();
        let mut driver = Driver::new(bounce()).unwrap();
        assert!(matches!(driver.restore(&fall.snapshot()), Err(DriverRestoreError::OtherScene)));
    }

    #[test]
    fn a_snapshot_brings_the_history_that_led_to_it_and_not_that_of_another_run() {
        let fall = || Driver::new(Model::from_text(EXAMPLE.1).unwrap()).unwrap();
        let (mut struck, mut plain) = (fall(), fall());
        struck.set_velocity(BlockId(0), Vec3::x(), Vec3::zeros()).unwrap();
        struck.step(20).unwrap();
        let (snapshot, history) = (struck.snapshot(), struck.history().to_vec());
        plain.step(30).unwrap();
        assert_ne!(plain.history()[10], history[10]);
        plain.restore(&snapshot).unwrap();
        assert_eq!(plain.history(), history);
        plain.step(10).unwrap();
        struck.step(10).unwrap();
        assert_eq!(plain.history(), struck.history());
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
