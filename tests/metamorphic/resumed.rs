//! A run that is killed goes on from its checkpoint to the same end, bit for bit: what is not in the file is lost.

use ndda::build;
use ndda_io::{OutputFolder, checkpoint};
use ndda_solver::Snapshot;

use crate::generator::{Wanted, build};
use crate::motion::{ROWS, run, run_to};
use crate::random::Random;
use crate::search::{Found, search};

#[test]
fn resumed_runs_are_the_run() {
    search("resumed", 40, &Wanted::default(), |case| {
        let (whole, stopped) = run(&case.text);
        let steps = build::steps(&case.scene.time);
        let place = tempfile::tempdir().expect("a folder");
        let folder = OutputFolder::create(&place.path().join("out"), false).expect("a folder");
        let (mut random, mut killed_at) = (Random::new(!case.seed), 0);
        // Killed and resumed three times over.
        for _ in 0..3 {
            let mut ready = build(&case.text).unwrap();
            if killed_at > 0 {
                let (snapshot, _) = folder.read_checkpoint::<Snapshot>(|_| Ok(())).expect("a checkpoint");
                ready.simulation.restore(snapshot).expect("of this scene");
            }
            killed_at += u64::from(random.whole(1, (steps / 4) as u32));
            if run_to(&mut ready.simulation, killed_at, steps, ROWS).is_some() {
                return Found::Skipped("stops before the kill");
            }
            folder.write_checkpoint(&ready.simulation.snapshot()).expect("room on the disk");
        }
        let mut last = build(&case.text).unwrap();
        let (snapshot, _) = folder.read_checkpoint::<Snapshot>(|_| Ok(())).expect("a checkpoint");
        last.simulation.restore(snapshot).expect("of this scene");
        let also = run_to(&mut last.simulation, steps, steps, ROWS);
        let same = checkpoint::fingerprint(whole.simulation.state())
            == checkpoint::fingerprint(last.simulation.state());
        if stopped != also || (stopped.is_none() && !same) {
            return Found::Fails(format!(
                "killed last at step {killed_at} of {steps}, the end is another one"
            ));
        }
        Found::Holds
    });
}
