//! The program `ndda-mpi`: a scene run or resumed by several processes.
//!
//! `mpirun -n 4 ndda-mpi run scene.ron` leaves the files that `ndda run scene.ron` leaves, to the bit.

mod args;
mod mpi_ranks;
mod verbs;

use std::process::ExitCode;
use std::sync::Arc;

use clap::Parser;
use mpi::Threading;
use ndda_ranks::{Communicator, Gathered, Topic};

use args::{Args, Verb};
use mpi_ranks::MpiRanks;
use verbs::Failure;

/// The run reached its end.
const DONE: u8 = 0;
/// The command line is wrong.
const USAGE: u8 = 2;
/// The run stopped because going on would have given a wrong number, or a rank had stopped.
const STOPPED: u8 = 4;
/// A rank has panicked.
const PANICKED: i32 = 101;

fn main() -> ExitCode {
    // All calls of MPI are made by this thread, which is the first of its pool.
    let Some((universe, _)) = mpi::initialize_with_threading(Threading::Funneled) else {
        eprintln!("error: MPI cannot be started: run `mpirun -n 4 ndda-mpi run SCENE`");
        return ExitCode::from(STOPPED);
    };
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        usual(panic);
        MpiRanks::abort(PANICKED);
    }));
    let ranks: Arc<dyn Communicator> = Arc::new(MpiRanks::new());
    let code = end(&*ranks, on_rank(&ranks));
    drop(universe);
    ExitCode::from(code)
}

/// What a rank does; all of them do the same.
fn on_rank(ranks: &Arc<dyn Communicator>) -> Result<u8, Failure> {
    let args = match Args::try_parse() {
        Ok(args) => args,
        Err(answer) if !answer.use_stderr() => {
            if ranks.rank() == 0 {
                print!("{answer}");
            }
            return Ok(DONE);
        }
        Err(error) => return Err(Failure { code: USAGE, message: error.to_string() }),
    };
    let how = match &args.verb {
        Verb::Run(run) => &run.how,
        Verb::Resume(resume) => &resume.how,
        Verb::Other(words) => return Err(verbs::refuse(words)),
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(how.threads.into()).use_current_thread().build();
    let pool = pool.map_err(|error| Failure {
        code: verbs::RESOURCE,
        message: format!("error: cannot start {} threads: {error}; use a smaller --threads", how.threads),
    })?;
    pool.install(|| match &args.verb {
        Verb::Run(run) => verbs::run(run, ranks),
        Verb::Resume(resume) => verbs::resume(resume, ranks),
        Verb::Other(words) => Err(verbs::refuse(words)),
    })
}

/// Ends all ranks together; the exit code is that of the lowest rank that has failed.
fn end(ranks: &dyn Communicator, outcome: Result<u8, Failure>) -> u8 {
    let is_first = ranks.rank() == 0;
    let (code, message) = match outcome {
        Ok(code) => match ranks.exchange(Topic::End, &[code], &mut Gathered::default()) {
            Ok(()) => return code,
            // It has said already what went wrong.
            Err(_) if code == STOPPED => return code,
            Err(error) => (STOPPED, format!("error: {error}")),
        },
        Err(Failure { code, message }) => {
            ranks.give_up(message.trim_start_matches("error: "));
            (code, message)
        }
    };
    if is_first {
        eprintln!("{}", message.trim_end());
    }
    code
}
