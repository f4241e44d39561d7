//! Runs on several ranks: the same files to the byte, and no rank that waits for ever.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use ndda::run::Sensitivity;
use ndda::summary::{Status, Summary};
use ndda::{Model, Run};
use ndda_io::OutputFolder;
use ndda_ranks::{Communicator, RanksError, Threads};
use ndda_solver::{Sink, SinkError, StepError, View};

/// Does the same on each of some ranks, which are threads with so many threads of their own.
fn on_ranks<R: Send>(
    size: usize,
    threads: usize,
    work: impl Fn(Arc<dyn Communicator>) -> R + Sync,
) -> Vec<R> {
    let work = &work;
    std::thread::scope(|scope| {
        let rank = |rank| {
            scope.spawn(move || {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
                pool.install(|| work(Arc::new(rank)))
            })
        };
        let ranks: Vec<_> = Threads::group(size).into_iter().map(rank).collect();
        ranks.into_iter().map(|rank| rank.join().expect("no panic")).collect()
    })
}

/// A floor with blocks that fall, slide, hit each other and come to lie on each other.
fn heap(body: &str, time: &str, contact: &str, more: &str) -> String {
    let block = |k: u32| {
        let (x, y, z) =
            (f64::from(k % 3) * 1.05, f64::from(k / 3 % 2) * 0.9 + 0.1 * f64::from(k), f64::from(k / 3));
        format!(
            "(name: \"block_{k}\", material: \"rock\", body: {body}, shape: Box(size_m: (1, 1, 0.8), cells: (1, 1, 1)), \
             at_m: ({x}, {y}, {}), velocity_m_s: ({}, 0.1, -0.2), spin_rad_s: (0, 0.3, {})),",
            0.002 + 0.81 * z,
            0.5 - 0.4 * f64::from(k % 2),
            0.2 * f64::from(k % 3),
        )
    };
    let blocks: String = (0..9).map(block).collect();
    format!(
        "(title: \"A heap\", time: ({time}), gravity_m_s2: (1, 0, -9.81), {more}
        materials: [(name: \"rock\", young_pa: 2e9, poisson: 0.25, density_kg_m3: 2650)],
        blocks: [(name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (9, 9, 1), cells: (3, 3, 1)), at_m: (-3, -3, -1)), {blocks}],
        contact: {contact},
        monitors: [(name: \"first\", block: \"block_0\")],
        output: (frames: 0, history_rows: 50))"
    )
}

/// What a run leaves: its history as numbers, and its summary.
fn outcome(text: &str, ranks: Option<&Arc<dyn Communicator>>) -> (Vec<Vec<u64>>, Summary) {
    let mut run = Run::new(Model::from_text(text).unwrap()).sensitivity(Sensitivity::Never);
    if let Some(ranks) = ranks {
        run = run.on_ranks(ranks).expect("all have the same scene");
    }
    let outcome = run.finish(&mut []).expect("it runs");
    let history = outcome.history.expect("it is in memory");
    (
        history.columns.iter().map(|column| column.iter().map(|x| x.to_bits()).collect()).collect(),
        outcome.summary,
    )
}

/// The run of a scene, on one process and on ranks.
fn same_on(sizes: &[usize], text: &str) -> Summary {
    let (history, summary) = outcome(text, None);
    for &size in sizes {
        for (rank, (other, also)) in
            on_ranks(size, 1, |ranks| outcome(text, Some(&ranks))).into_iter().enumerate()
        {
            let case = format!("rank {rank} of {size}: {text}");
            assert_eq!(summary.state_crc32, also.state_crc32, "{case}");
            assert!(history == other, "history of {case}");
            assert_eq!((&summary.label, &summary.verdicts), (&also.label, &also.verdicts), "{case}");
            assert_eq!((&summary.invariants, summary.status), (&also.invariants, also.status), "{case}");
        }
    }
    summary
}

const PREDICTED: &str = "step_s: 4e-4, end_s: 0.08";
const SMOOTH: &str = "Potential(penalty_pa: 2e7, potential: Smooth(), friction: (friction_deg: 30))";

#[test]
fn two_hundred_steps_of_impacts_and_sliding_have_the_same_bits_on_any_number_of_ranks() {
    for body in ["Elastic", "Affine", "Rigid"] {
        let summary = same_on(&[1, 2, 3, 4, 7], &heap(body, PREDICTED, SMOOTH, ""));
        assert_eq!((summary.status, summary.steps), (Status::Done, 200), "{body}");
        assert!(summary.invariants.max_penetration_ratio > 0.0, "{body} never touch");
    }
}

#[test]
fn integrators_and_ways_to_take_contact() {
    for (body, time) in [
        ("Elastic", "step_s: 4e-4, end_s: 0.032, integrator: Newmark(alpha: 0.5, delta: 1.0)"),
        ("Rigid", "step_s: 4e-4, end_s: 0.032, integrator: GeneralizedAlpha(radius: 0.6)"),
        ("Affine", "step_s: 4e-4, end_s: 0.032, integrator: Newmark(alpha: 0.25, delta: 0.5)"),
        (
            "Elastic",
            "step_s: 1e-3, end_s: 0.03, integrator: Newmark(alpha: 0.5, delta: 1.0), contact_at: End()",
        ),
        (
            "Rigid",
            "step_s: 1e-3, end_s: 0.03, integrator: Newmark(alpha: 0.5, delta: 1.0), contact_at: End()",
        ),
        ("Elastic", "step_s: 2e-3, end_s: 0.08, step: Auto()"),
    ] {
        same_on(&[2, 3], &heap(body, time, SMOOTH, ""));
    }
}

#[test]
fn potentials_friction_and_damping_of_contact() {
    let springs = "friction_deg: 30, shear_penalty_pa_m: 2e7";
    for (body, contact) in [
        ("Elastic", "Potential(penalty_pa: 2e7, potential: Element)".to_string()),
        ("Elastic", format!("Potential(penalty_pa: 2e7, potential: Smooth(), friction: ({springs}))")),
        ("Affine", format!("Potential(penalty_pa: 2e7, potential: Element, friction: ({springs}), memory: Element)")),
        (
            "Elastic",
            "Potential(penalty_pa: 2e7, potential: Volume(exponent: 1.5, reference_m3: 1e-3), friction: (friction_deg: 30))"
                .into(),
        ),
        ("Rigid", format!("Potential(penalty_pa: 2e7, potential: Smooth(), friction: ({springs}, cohesion_pa: 1e4, tension_pa: 1e4))")),
        (
            "Elastic",
            "Potential(penalty_pa: 2e7, potential: Smooth(), friction: (friction_deg: 30), restitution: 0.3)".into(),
        ),
    ] {
        same_on(&[2, 4], &heap(body, "step_s: 4e-4, end_s: 0.04", &contact, ""));
    }
}

#[test]
fn scenes_that_settle_and_pass_through_stages() {
    for body in ["Elastic", "Rigid"] {
        let settle = "settle: (tolerance: 0.3, most_steps: 2000),";
        same_on(&[2], &heap(body, "step_s: 4e-4, end_s: 0.02", SMOOTH, settle));
    }
    let stages = "stages: [(name: \"taken out\", remove: [\"block_8\"], then: Run(0.01))],";
    same_on(&[3], &heap("Rigid", "step_s: 4e-4, end_s: 0.02", SMOOTH, stages));
}

#[test]
fn several_threads_on_each_rank() {
    let text = heap("Elastic", "step_s: 4e-4, end_s: 0.04", SMOOTH, "");
    let (_, summary) = outcome(&text, None);
    for (_, also) in on_ranks(2, 2, |ranks| outcome(&text, Some(&ranks))) {
        assert_eq!(summary.state_crc32, also.state_crc32);
    }
}

/// Raises a flag after a step.
struct Stop<'a>(u64, &'a AtomicBool);

impl Sink for Stop<'_> {
    fn step_done(&mut self, view: &mut View) -> Result<std::ops::ControlFlow<()>, SinkError> {
        let is_now = view.simulation.state().step == self.0;
        self.1.fetch_or(is_now, std::sync::atomic::Ordering::Relaxed);
        Ok(std::ops::ControlFlow::Continue(()))
    }
}

/// A scene's file in a folder of its own.
fn scene_file(folder: &Path, text: &str) -> PathBuf {
    let file = folder.join("heap.ron");
    std::fs::write(&file, text).unwrap();
    file
}

/// Runs a scene on ranks, the first of which records it; one of them asks for the end at a step.
fn record(file: &Path, out: &Path, size: usize, (rank_to_stop, at): (usize, u64)) -> Vec<Status> {
    on_ranks(size, 1, |ranks| {
        let mut run = Run::new(Model::open(file, &[]).unwrap());
        if ranks.rank() == 0 {
            run = run.record(OutputFolder::create(out, false).unwrap(), file.to_path_buf()).unwrap();
        }
        let stop = Arc::new(AtomicBool::new(false));
        let run = run.on_ranks(&ranks).unwrap().stop_when(stop.clone()).sensitivity(Sensitivity::Never);
        let mut stopper = Stop(if ranks.rank() == rank_to_stop { at } else { u64::MAX }, &stop);
        run.finish(&mut [&mut stopper]).unwrap().summary.status
    })
}

#[test]
fn a_checkpoint_of_two_ranks_goes_on_on_three_and_on_one() {
    let place = tempfile::tempdir().unwrap();
    let file = scene_file(place.path(), &heap("Elastic", PREDICTED, SMOOTH, ""));
    let (whole, out) = (place.path().join("whole"), place.path().join("out"));
    assert_eq!(record(&file, &whole, 1, (0, u64::MAX)), [Status::Done]);
    // The rank that is asked to end is not the one that writes the checkpoint.
    assert_eq!(record(&file, &out, 2, (1, 60)), [Status::Interrupted; 2]);
    let ended = on_ranks(3, 1, |ranks| {
        let stop = Arc::new(AtomicBool::new(false));
        let run = Run::resume_on_ranks(&out, &ranks).unwrap().run.sensitivity(Sensitivity::Never);
        assert_eq!(run.model().simulation.state().step, 60);
        let mut stopper = Stop(if ranks.rank() == 0 { 130 } else { u64::MAX }, &stop);
        run.stop_when(stop.clone()).finish(&mut [&mut stopper]).unwrap().summary.status
    });
    assert_eq!(ended, [Status::Interrupted; 3]);
    let last =
        Run::resume(&out).unwrap().run.sensitivity(Sensitivity::Never).finish(&mut []).unwrap().summary;
    assert_eq!(last.status, Status::Done);
    let history = |folder: &Path| std::fs::read(folder.join("history.csv")).unwrap();
    assert!(history(&whole) == history(&out), "the histories differ");
    let crc = |folder: &Path| {
        let text = std::fs::read_to_string(folder.join("summary.json")).unwrap();
        serde_json::from_str::<serde_json::Value>(&text).unwrap()["state_crc32"].clone()
    };
    assert_eq!(crc(&whole), crc(&out));
}

#[test]
fn a_rank_that_cannot_go_on_ends_all() {
    let text = heap("Elastic", PREDICTED, SMOOTH, "");
    let ends = on_ranks(3, 1, |ranks| {
        let run = Run::new(Model::from_text(&text).unwrap()).on_ranks(&ranks).unwrap();
        if ranks.rank() == 2 {
            ranks.give_up("no room on the disk");
            return None;
        }
        Some(run.finish(&mut []).map(|outcome| (outcome.summary.status, outcome.summary.stopped_by)))
    });
    for end in ends.into_iter().flatten() {
        let (status, why) = end.expect("the run says why");
        assert_eq!(status, Status::Stopped);
        let why = why.expect("a cause");
        assert!(why.contains("[rank-stopped] rank 2 has stopped: no room on the disk"), "{why}");
    }
}

#[test]
fn a_rank_that_panics_ends_all() {
    let text = heap("Rigid", PREDICTED, SMOOTH, "");
    let ends = on_ranks(2, 1, |ranks| {
        let mut simulation = Model::from_text(&text).unwrap().simulation;
        simulation.share_steps(ranks.clone());
        let rank = ranks.rank();
        drop(ranks);
        let work = std::panic::AssertUnwindSafe(|| {
            (0..20).try_for_each(|step| {
                assert!(rank == 0 || step < 10, "for the test");
                simulation.step().map(|_| ())
            })
        });
        let ended = std::panic::catch_unwind(work);
        // What it held is gone with it, as where a thread ends.
        drop(simulation);
        ended
    });
    assert!(ends[1].is_err());
    let ended = ends[0].as_ref().expect("no panic").as_ref().expect_err("nobody answers");
    assert!(matches!(ended, StepError::Ranks(RanksError::Stopped { rank: 1, .. })), "{ended}");
}

#[test]
fn a_block_that_fails_fails_on_all_ranks() {
    // So soft and so fast that a block is past what its material carries.
    let text =
        heap("Elastic", "step_s: 5e-2, end_s: 1", "Potential(penalty_pa: 1e11, potential: Element)", "");
    let run = |ranks: Option<Arc<dyn Communicator>>| {
        let mut simulation = Model::from_text(&text).unwrap().simulation;
        if let Some(ranks) = ranks {
            simulation.share_steps(ranks);
        }
        (0..20).find_map(|_| simulation.step().err()).expect("it stops")
    };
    let alone = run(None);
    for size in [2, 7] {
        for error in on_ranks(size, 1, |ranks| run(Some(ranks))) {
            assert_eq!(error, alone);
        }
    }
}

#[test]
fn ranks_with_other_scenes_do_not_begin() {
    let found = on_ranks(2, 1, |ranks| {
        let time = if ranks.rank() == 0 { PREDICTED } else { "step_s: 4e-4, end_s: 0.1" };
        let run = Run::new(Model::from_text(&heap("Rigid", time, SMOOTH, "")).unwrap());
        run.on_ranks(&ranks).err()
    });
    assert_eq!(found, [1, 0].map(|rank| Some(RanksError::OutOfStep { rank })));
}
