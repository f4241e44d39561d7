//! Bringing a scene to rest before time begins: with checkpoints on the way, and results where it ends on the way.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use ndda_io::{WriteError, checkpoint};
use ndda_ranks::Alone;
use ndda_solver::{Settled, Settling, StepError, StepReport};

use super::outputs::{Course, Earlier, Outputs, SavedRun};
use super::rest::{Resting, Watch};
use super::{Recording, Run, RunError, error, unless_ended, write_results};
use crate::judge::summary::{Ending, summarise};
use crate::summary::{Invariants, Label, LabelWord, Named, Summary};

/// A scene that was on its way to rest when its run was interrupted.
pub(super) struct OnTheWay {
    pub settling: Settling,
    /// Seconds that it had taken.
    pub wall_s: f64,
}

/// How far a scene has come on its way to rest, in words.
fn progress(settled: Settled, tolerance: f64) -> String {
    Resting { stage: None, settled, tolerance, left_s: None }.to_string()
}

impl Run {
    /// Steps of settling that the run has behind it, where it goes on before its first step.
    pub fn settling_steps(&self) -> Option<u64> {
        self.on_the_way.as_ref().map(|way| way.settling.settled().steps)
    }

    /// Brings the scene to rest, if it is to settle and has not yet.
    pub(super) fn settle(&mut self, tell: &mut dyn FnMut(&Resting)) -> Result<(), RunError> {
        let scene = &self.model.loaded.scene;
        let Some(given) = scene.settle.filter(|_| !self.goes_on()) else { return Ok(()) };
        let (settle, stop) = (crate::build::settle(given), self.stop.clone());
        let every = Duration::from_secs_f64(scene.output.checkpoint_wall_s);
        let writes = self.recording.is_some() && !every.is_zero();
        let mut settling = match self.on_the_way.take() {
            Some(way) => way.settling,
            None => self.model.simulation.begin_to_settle(&settle),
        };
        let mut watch = Watch::new(None, given.tolerance);
        let ranks = self.model.simulation.ranks().clone();
        loop {
            let began = Instant::now();
            let mut goes_on = |settled: &Settled| {
                watch.step(settled, tell);
                match unless_ended(&*ranks, &stop) {
                    ControlFlow::Continue(()) if writes && began.elapsed() >= every => ControlFlow::Break(()),
                    asked => asked,
                }
            };
            match self.model.simulation.go_on_settling(&settle, &mut settling, &mut goes_on) {
                Ok(true) => break,
                Ok(false) => self.save_on_the_way(&settling)?,
                Err(error) => {
                    self.leave_unsettled(&settling, Some(&error))?;
                    return Err(RunError::Settling(error));
                }
            }
            if stop.load(Ordering::Relaxed) {
                self.leave_unsettled(&settling, None)?;
                return Err(RunError::InterruptedWhileSettling);
            }
        }
        Ok(self.log_line(&progress(settling.settled(), given.tolerance))?)
    }

    /// A checkpoint from which settling goes on.
    fn save_on_the_way(&mut self, settling: &Settling) -> Result<(), WriteError> {
        let Some(Recording { identity, folder, .. }) = &self.recording else { return Ok(()) };
        let earlier = Earlier { wall_s: self.started.elapsed().as_secs_f64(), ..Earlier::default() };
        let snapshot = self.model.simulation.snapshot_view();
        let saved = SavedRun { identity: identity.clone(), snapshot, earlier, settling: Some(settling) };
        folder.write_checkpoint(&saved)
    }

    /// Summary, history and frames of a run that ends before its scene has come to rest: how it was at the start, and how it is now. Their
    /// times are those that the steps of settling would have taken.
    fn leave_unsettled(&mut self, settling: &Settling, error: Option<&StepError>) -> Result<(), WriteError> {
        let Some(Recording { identity, folder, mut log }) = self.recording.take() else { return Ok(()) };
        // Other ranks have no part in what is written now.
        self.model.simulation.share_steps(Arc::new(Alone));
        let (settled, started) = (settling.settled(), self.started);
        let (loaded, simulation) = (&self.model.loaded, &mut self.model.simulation);
        let monitors = std::mem::take(&mut self.model.monitors);
        let course = Course { steps: settled.steps, started, stop: self.stop.clone(), checkpoints: false };
        let place = (Some((identity, folder.clone())), None);
        let mut outputs =
            Outputs::new((&loaded.scene, simulation), (monitors, None), place, &mut [], course)?;
        let now = simulation.snapshot();
        let built = self.built.take().map(|built| simulation.whole(&built));
        let mut shown_s = None;
        for state in built.into_iter().chain([now]) {
            simulation.restore(state).expect("it is of this simulation");
            let time_s = simulation.time_s();
            // A first step of settling that fails leaves time where it was.
            if shown_s.replace(time_s) == Some(time_s) {
                continue;
            }
            let report = StepReport::default();
            match ndda_solver::show(simulation, settled.steps, &report, &mut [&mut outputs]) {
                Ok(_) => {}
                // A state whose contact cannot be computed, or that has numbers that are not finite, is not shown.
                Err(failed) => drop(error::numerical_stop(failed)?),
            }
        }
        outputs.flush()?;
        let ending = Ending {
            scene: &loaded.scene,
            name: &self.name,
            chosen: loaded.chosen.clone(),
            stopped_by: error.map(error::stop),
            interrupted: true,
            wall_s: started.elapsed().as_secs_f64(),
            threads: rayon::current_num_threads(),
            stages: vec![("output".into(), outputs.output_s())],
            warnings: loaded.warnings.iter().map(|w| w.message.clone()).collect(),
            strict: false,
            state_crc32: checkpoint::fingerprint(simulation.state()),
        };
        let mut summary = summarise(simulation, &outputs.recorder, ending);
        summary.warnings.truncate(loaded.warnings.len());
        unjudged(&mut summary, &progress(settled, loaded.scene.settle.map_or(0.0, |s| s.tolerance)));
        write_results(&folder, &loaded.scene.output, &summary, &mut log)
    }
}

/// The way to rest is not judged: its energy is taken on purpose.
fn unjudged(summary: &mut Summary, progress: &str) {
    summary.unsettled_steps = Some(summary.steps);
    (summary.steps, summary.end_s) = (0, 0.0);
    summary.verdicts = Named(Vec::new());
    let Invariants { max_penetration_ratio, max_h, .. } = summary.invariants;
    summary.invariants = Invariants { max_penetration_ratio, max_h, ..Invariants::default() };
    (summary.slow_error_m_s, summary.reference) = (None, None);
    if summary.label.word != LabelWord::Stopped {
        let reason = format!("the run ended before the scene had come to rest ({progress})");
        summary.label = Label { word: LabelWord::Inaccurate, reasons: vec![reason] };
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use ndda_mesh::Vec3;
    use ndda_solver::{Sink, SinkError, View};

    use crate::{Model, Run};

    /// Contact forces on a block in each step, from the nodes and from the facets, and pairs in contact [N].
    struct Presses(Vec<(Vec3, Vec3, u64)>);

    impl Sink for Presses {
        fn wants_contacts(&self, _: u64) -> bool {
            true
        }

        fn step_done(&mut self, view: &mut View) -> Result<ControlFlow<()>, SinkError> {
            let simulation = &*view.simulation;
            let (blocks, block) = (simulation.blocks(), simulation.blocks().ids().last().unwrap());
            let on_nodes = simulation.contact_forces_n()[blocks.nodes_of(block)].iter().sum();
            let mut of_facets = Vec3::zeros();
            for contact in simulation.contacts() {
                let force_n = contact.push_n + contact.friction_n;
                let is_own = blocks.triangle_block[contact.facet.index()] == block;
                of_facets += if is_own { force_n } else { -force_n };
            }
            self.0.push((on_nodes, of_facets, view.report.contact.contact_pairs as u64));
            Ok(ControlFlow::Continue(()))
        }
    }

    #[test]
    fn contact_and_reactions_of_a_settled_scene_are_known_before_its_first_step() {
        let (weight_n, tension_n) = (26_000.0, 5e4);
        for (body, bolts) in [("Rigid", 0), ("Elastic", 0), ("Rigid", 1), ("Elastic", 1)] {
            let bolt = [
                "",
                "(name: \"anchor\", at: Line(from_m: (0.5, 0.5, 1), to_m: (0.5, 0.5, -0.9)), pretension_n: 5e4, plate: (),
                steel: (young_pa: 2e11, area_m2: 5e-4, yield_n: 2e5), grout: (stiffness_n_m2: 2e9, strength_n_m: 4e5, from_m: 1))",
            ];
            let text = format!(
                "(title: \"a block at rest\", time: (step_s: 1e-4, end_s: 1e-3), gravity_m_s2: (0, 0, -10), settle: (damping: Local()),
                materials: [(name: \"rock\", young_pa: 1e10, poisson: 0.25, density_kg_m3: 2600)],
                blocks: [
                    (name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (3, 3, 1), cells: (1, 1, 1)), at_m: (-1, -1, -1)),
                    (name: \"cube\", material: \"rock\", body: {body}, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))),
                ],
                bolts: [{}], output: (reactions: true),
                contact: Potential(penalty_pa: 1e9, friction: (friction_deg: 30)))",
                bolt[bolts]
            );
            let mut presses = Presses(Vec::new());
            let outcome = Run::new(Model::from_text(&text).unwrap()).finish(&mut [&mut presses]).unwrap();
            let most_n = weight_n + tension_n * bolts as f64;
            let least_n = weight_n + 0.9 * tension_n * bolts as f64;
            for step in [0, 5] {
                let (on_nodes, of_facets, pairs) = presses.0[step];
                assert!(pairs > 0, "{body} {bolts} {step}");
                let differ_n = (on_nodes - of_facets).norm();
                assert!(differ_n < 1e-9 * most_n, "{body} {bolts} {step}: {on_nodes} and {of_facets}");
                assert!(
                    (0.999 * least_n..1.001 * most_n).contains(&on_nodes.z),
                    "{body} {bolts}: {on_nodes}"
                );
                assert!(on_nodes.xy().norm() < 1e-3 * most_n, "{body} {bolts}: {on_nodes}");
            }
            let history = outcome.history.unwrap();
            let column = |name: &str| {
                let column = history.names.iter().position(|known| known == name).unwrap();
                &history.columns[column]
            };
            assert!(["contact_pairs", "penetration_ratio", "h"].iter().all(|name| column(name)[0] > 0.0));
            // The floor weighs nine times as much.
            let held_n = &column("floor.reaction_z_n")[..2];
            assert!(
                held_n.iter().all(|n| (n - 10.0 * weight_n).abs() < 1e-3 * weight_n),
                "{body} {bolts}: {held_n:?}"
            );
        }
    }

    #[test]
    fn a_slab_that_damped_contact_keeps_vibrating_is_told_how_it_comes_to_rest() {
        let slab = |settle: &str| {
            let text = format!(
                "(title: \"slab\", time: (step_s: 1e-4, end_s: 1e-3), gravity_m_s2: (0, 0, -9.81), settle: ({settle}),
                materials: [(name: \"rock\", young_pa: 2e10, poisson: 0.25, density_kg_m3: 2600)],
                blocks: [
                    (name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (6, 4, 1), cells: (1, 1, 1)), at_m: (-1.5, -1.5, -1)),
                    (name: \"a\", material: \"rock\", body: Affine, shape: Box(size_m: (1, 1, 0.3), cells: (1, 1, 1))),
                ],
                contact: Potential(penalty_pa: 1e9, potential: Smooth(), friction: (friction_deg: 30), restitution: 0.3))"
            );
            Run::new(Model::from_text(&text).unwrap())
                .finish(&mut [])
                .map(drop)
                .map_err(|error| error.to_string())
        };
        let error = slab("").unwrap_err();
        assert!(
            error.contains("under friction on damped contact, write settle: (damping: Local())"),
            "{error}"
        );
        assert_eq!(slab("damping: Local()"), Ok(()));
    }
}
