//! What of a scene may change between two steps.

use ndda_io::diagnostic::SceneErrors;
use ndda_io::scene::{Contact, Scene, Time};
use ndda_solver::{StepError, TakeOverError};

use super::Driver;
use super::judged::Disturbance;

/// Why a scene cannot change between two steps.
#[derive(Debug, thiserror::Error)]
pub enum ChangeError {
    /// The changed scene is none that can be used.
    #[error("{}", .0.render(false))]
    Scene(#[from] SceneErrors),
    /// It is something that the state depends on.
    #[error(
        "{what} cannot change between steps: begin a new simulation. Gravity, forces, tractions, water, friction, monitors, output and \
         time.end_s can change, and supports can be added and removed"
    )]
    Fixed {
        /// The part of the scene.
        what: &'static str,
    },
    /// The scene would have ended before now.
    #[error(
        "time.end_s is {end_s} s, and it is {time_s} s already: give a later end, or restore a snapshot from before it"
    )]
    Past {
        /// The end \[s\].
        end_s: f64,
        /// The time now \[s\].
        time_s: f64,
    },
    /// The simulation cannot go on.
    #[error("the simulation has stopped ({0}): restore a snapshot first")]
    Stopped(StepError),
    /// The simulation cannot take the state over.
    #[error(transparent)]
    TakeOver(#[from] TakeOverError),
}

impl Driver {
    /// Changes values of the scene from now on, as `ndda run --set` takes them: gravity, loads, laws of friction, supports.
    ///
    /// The simulation is built anew and goes on from the present state ([`take_over`](ndda_solver::Simulation::take_over)): the
    /// energy of what changes at once is in the balance as work of loads. Snapshots from before can still be restored.
    ///
    /// # Errors
    /// [`ChangeError`]; nothing has changed then.
    pub fn change(&mut self, overrides: &[String]) -> Result<(), ChangeError> {
        if let Some(stop) = &self.stopped {
            return Err(ChangeError::Stopped(stop.clone()));
        }
        let mut model = self.build(&self.model.loaded.text, overrides)?;
        if let Some(what) = fixed_part(&self.model.loaded.scene, &model.loaded.scene) {
            return Err(ChangeError::Fixed { what });
        }
        self.refuse_past(model.loaded.scene.time.end_s, crate::build::steps(&model.loaded.scene.time))?;
        let moves_on = moves_alike(&self.model.loaded.scene, &model.loaded.scene);
        model.simulation.take_over(&mut self.model.simulation)?;
        self.put(model);
        match moves_on {
            true => self.course.forget_label(),
            false => self.note_change(Disturbance::Scene),
        }
        Ok(())
    }

    /// Refuses another end than the scene has, after so many steps, that lies before the present one.
    fn refuse_past(&self, end_s: f64, steps: u64) -> Result<(), ChangeError> {
        let simulation = &self.model.simulation;
        if steps < simulation.state().step && steps != self.steps {
            return Err(ChangeError::Past { end_s, time_s: simulation.time_s() });
        }
        Ok(())
    }
}

/// The first part of a scene that differs though it may not change between steps.
fn fixed_part(old: &Scene, new: &Scene) -> Option<&'static str> {
    let mut time = old.time.clone();
    time.end_s = new.time.end_s;
    let parts = [
        ("time", time != new.time),
        ("gravity_ramp_s", old.gravity_ramp_s != new.gravity_ramp_s),
        ("in_situ", old.in_situ != new.in_situ),
        ("settle", old.settle != new.settle),
        ("materials", old.materials != new.materials),
        ("blocks", old.blocks != new.blocks),
        ("rock", old.rock != new.rock),
        ("quiet", old.quiet != new.quiet),
        ("ties", old.ties != new.ties),
        ("blasts", old.blasts != new.blasts),
        ("bolts", old.bolts != new.bolts),
        ("stages", old.stages != new.stages),
        ("contact, but for its friction,", without_friction(&old.contact) != without_friction(&new.contact)),
    ];
    parts.into_iter().find_map(|(what, differs)| differs.then_some(what))
}

/// Whether blocks move in both scenes alike: what differs is written, watched or judged, but acts on none.
fn moves_alike(old: &Scene, new: &Scene) -> bool {
    let time = Time { end_s: new.time.end_s, ..old.time.clone() };
    let watched = Scene {
        title: new.title.clone(),
        parameters: new.parameters.clone(),
        time,
        monitors: new.monitors.clone(),
        output: new.output.clone(),
        reference: new.reference.clone(),
        ..old.clone()
    };
    watched == *new
}

/// Contact without its laws of friction.
fn without_friction(contact: &Option<Contact>) -> Option<Contact> {
    let mut contact = contact.clone();
    if let Some(Contact::Potential { friction, material_pairs, rock_joints, .. }) = &mut contact {
        *friction = None;
        material_pairs.clear();
        rock_joints.clear();
    }
    contact
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Model;
    use crate::driver::EXAMPLE;
    use crate::summary::LabelWord;

    fn fall(more: &str) -> Driver {
        let text = EXAMPLE.1.replace("contact: Off,", more).replace("body: Rigid, ", "");
        Driver::new(Model::from_text(&text).unwrap()).unwrap()
    }

    /// Falls ½ g t² and is stopped by the opposite gravity after the same time; the work that the reversal books is 2 m g s.
    #[test]
    fn gravity_that_turns_round_is_work_of_loads() {
        let mut driver = fall("contact: Off,");
        driver.step(50).unwrap();
        driver.change(&["gravity_m_s2=(0, 0, 9.81)".into()]).unwrap();
        driver.step(50).unwrap();
        let sample = driver.sample().unwrap();
        let work_j = 2.0 * 2600.0 * 9.81 * (0.5 * 9.81 * 0.25);
        assert!((sample.load_work_j - work_j).abs() < 1e-9 * work_j, "{}", sample.load_work_j);
        assert!(sample.kinetic_j < 1e-12 * work_j && sample.balance_j.abs() < 1e-9 * work_j);
        assert_eq!(driver.label().word, LabelWord::Accurate);
    }

    #[test]
    fn loads_of_an_integrator_that_remembers_accelerations_stay() {
        let text = EXAMPLE.1.replace("end_s: 1.0", "end_s: 1.0, integrator: GeneralizedAlpha()");
        let mut driver = Driver::new(Model::from_text(&text).unwrap()).unwrap();
        let refused = driver.change(&["gravity_m_s2=(0, 0, 9.81)".into()]);
        assert!(
            matches!(refused, Err(ChangeError::TakeOver(TakeOverError::RemembersAccelerations))),
            "{refused:?}"
        );
        driver.change(&["output.frames=3".into()]).unwrap();
    }

    #[test]
    fn an_end_that_is_past_is_refused_and_the_present_one_is_not() {
        let mut driver = fall("contact: Off,");
        driver.step(50).unwrap();
        let refused = driver.change(&["time.end_s=0.4".into()]);
        assert!(matches!(refused, Err(ChangeError::Past { end_s: 0.4, .. })), "{refused:?}");
        assert_eq!(driver.steps(), 100);
        driver.change(&["time.end_s=0.5".into()]).unwrap();
        assert_eq!(driver.steps(), 50);
        driver.step(10).unwrap();
        driver.change(&["title=\"beyond the end\"".into()]).unwrap();
    }

    #[test]
    fn parts_that_the_state_depends_on_cannot_change_between_steps() {
        let old = ndda_io::read::load_text("fall.ron", EXAMPLE.1, &[], None).unwrap().scene;
        for (what, value) in [
            ("quiet", "[(block: \"block\", on: Set(\"z_min\"))]"),
            ("ties", "[(block: \"block\", on: [Set(\"x_min\"), Set(\"x_max\")])]"),
            ("blasts", "[(block: \"block\", on: Part(Set(\"x_min\")), pressure: Rows([(0, 0), (1, 1)]))]"),
            (
                "bolts",
                "[(name: \"b\", at: Line(from_m: (0.5, 0.5, 0.9), to_m: (0.5, 0.5, 0.1)), steel: (young_pa: 2e11, area_m2: 5e-4), \
                 grout: (stiffness_n_m2: 1e9, strength_n_m: 2e5))]",
            ),
            ("stages", "[(name: \"s\", then: Run(1))]"),
        ] {
            let text = EXAMPLE.1.replace("blocks:", &format!("{what}: {value}, blocks:"));
            let text = text.replace("contact: Off", "contact: Potential(penalty_pa: 1e9)");
            let text = text.replace("body: Rigid, ", "");
            let new = ndda_io::read::load_text("fall.ron", &text, &[], None);
            let mut new = new.unwrap_or_else(|errors| panic!("{what}: {}", errors.render(false))).scene;
            (new.contact, new.blocks) = (old.contact.clone(), old.blocks.clone());
            assert_eq!(fixed_part(&old, &new), Some(what));
        }
    }

    #[test]
    fn loads_that_vary_stay_at_the_present_time_with_an_integrator_that_remembers_accelerations() {
        let pushed = |is: &str, force_n: u32, later: u32| {
            format!(
                "forces{is}[(block: \"block\", force_n: ({force_n}, 0, 0), factor: [(time_s: 0, factor: 1), (time_s: 0.5, factor: 1), (time_s: 1, factor: {later})])]"
            )
        };
        let text = EXAMPLE.1.replace("end_s: 1.0", "end_s: 1.0, integrator: GeneralizedAlpha()");
        let text = text.replace("blocks:", &format!("{}, blocks:", pushed(": ", 1000, 1)));
        let mut driver = Driver::new(Model::from_text(&text).unwrap()).unwrap();
        driver.step(3).unwrap();
        let refused = driver.change(&[pushed("=", 2000, 1)]);
        assert!(
            matches!(refused, Err(ChangeError::TakeOver(TakeOverError::RemembersAccelerations))),
            "{refused:?}"
        );
        // Loads that change only later do not contradict the remembered accelerations.
        driver.change(&[pushed("=", 1000, 3)]).unwrap();
    }

    const HOLD: &str = "supports=[(block: \"block\", on: Set(\"z_min\"), hold: Fixed)]";

    /// A block that falls has ½ m v² and m v, which supports take in two steps: a face that stops, then all nodes.
    #[test]
    fn a_block_that_is_held_in_its_fall_stops() {
        for body in ["Elastic", "Affine"] {
            let text = EXAMPLE.1.replace("body: Rigid", &format!("body: {body}")).replace("0.01", "0.0001");
            let mut driver = Driver::new(Model::from_text(&text).unwrap()).unwrap();
            driver.step(5000).unwrap();
            let falling = driver.sample().unwrap();
            driver.change(&[HOLD.into()]).unwrap();
            let held = driver.sample().unwrap();
            assert!(held.kinetic_j < 0.9 * falling.kinetic_j, "{body}: {} J", held.kinetic_j);
            driver.change(&[HOLD.replace("Set(\"z_min\")", "All")]).unwrap();
            driver.step(10).unwrap();
            let stopped = driver.sample().unwrap();
            assert!(stopped.kinetic_j < 1e-20 * falling.kinetic_j, "{body}: {} J", stopped.kinetic_j);
            assert!(stopped.balance_j.abs() < 1e-9 * falling.kinetic_j, "{body}: {} J", stopped.balance_j);
            assert_eq!(driver.label().reasons, Vec::<String>::new(), "{body}");
        }
    }

    #[test]
    fn a_corner_that_is_held_from_now_on_stays_where_it_is_then() {
        let corner =
            "supports=[(block: \"block\", on: Plane(point_m: (0, 0, 0), normal: (1, 1, 1)), hold: Fixed)]";
        let text = EXAMPLE.1.replace("body: Rigid", "body: Affine").replace("0.01", "0.0001");
        let mut driver = Driver::new(Model::from_text(&text).unwrap()).unwrap();
        driver.step(3000).unwrap();
        driver.change(&[corner.into()]).unwrap();
        let there = driver.simulation().state().position[0];
        driver.step(1000).unwrap();
        let sample = driver.sample().unwrap();
        let moved_m = (driver.simulation().state().position[0] - there).norm();
        assert!(moved_m < 1e-12, "{moved_m} m");
        assert!(
            sample.balance_j.abs() < 1e-3 * sample.kinetic_j,
            "{} of {} J",
            sample.balance_j,
            sample.kinetic_j
        );
    }

    #[test]
    fn a_spring_between_steps_and_the_turning_of_a_turned_block_are_refused() {
        let mut driver = fall("contact: Off,");
        let spring = HOLD.replace("hold: Fixed", "hold: Fixed, by: Springs()");
        let refused = driver.change(&[spring]);
        assert!(matches!(refused, Err(ChangeError::TakeOver(TakeOverError::Supports { .. }))), "{refused:?}");
        let block = ndda_mesh::BlockId(0);
        let (still, spin) = (ndda_mesh::Vec3::zeros(), ndda_mesh::Vec3::new(0.0, 0.0, 1.0));
        driver.set_velocity(block, still, spin).unwrap();
        driver.step(30).unwrap();
        let refused = driver.change(&[HOLD.into()]);
        assert!(matches!(refused, Err(ChangeError::TakeOver(TakeOverError::Turned { .. }))), "{refused:?}");
    }
}
