//! The command that runs a case, by one process or by several ranks of `ndda-mpi`.

use std::ffi::OsString;
use std::io;
use std::path::Path;
use std::process::{Command, Stdio};

use ndda_io::WriteError;

use super::error::StudyError;
use super::runner::CaseRun;
use crate::forecast::memory;

/// The program that starts the ranks of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Starter {
    /// `srun`, within a job of Slurm.
    Slurm,
    /// `mpirun`.
    Mpirun,
}

impl Starter {
    /// That of this process: a job of Slurm has a number.
    pub fn here() -> Self {
        if std::env::var_os("SLURM_JOB_ID").is_some() { Self::Slurm } else { Self::Mpirun }
    }

    /// Words that start so many ranks with so many threads each of the program that follows.
    pub fn words(self, ranks: u16, threads: u16) -> Vec<String> {
        match self {
            Self::Slurm => [
                "srun".into(),
                format!("--ntasks={ranks}"),
                format!("--cpus-per-task={threads}"),
                "--cpu-bind=cores".into(),
            ]
            .into(),
            Self::Mpirun => {
                ["mpirun", "--bind-to", "none", "-n", &ranks.to_string()].map(String::from).into()
            }
        }
    }
}

/// The command by which a case runs. For one rank it is that of `program`, the words that start `ndda`. Otherwise [`Starter::here`] starts `ndda-mpi`, that of the
/// folder of this process's program if it is there.
///
/// # Errors
/// [`WriteError`] when a file of values cannot be written.
pub fn command(run: &CaseRun, program: &[OsString], ranks: u16) -> Result<Command, WriteError> {
    let mut words = program.to_vec();
    if ranks > 1 {
        words = Starter::here().words(ranks, run.threads).into_iter().map(OsString::from).collect();
        let beside = std::env::current_exe().ok().map(|file| file.with_file_name("ndda-mpi"));
        let found = beside.filter(|file| file.is_file());
        words.push(found.as_deref().unwrap_or(Path::new("ndda-mpi")).into());
    }
    let mut command = Command::new(words.first().map_or("ndda".as_ref(), OsString::as_os_str));
    command.args(words.iter().skip(1)).arg("run").arg(run.scene).arg("--out").arg(run.out);
    let (again, threads) = (run.sensitivity.to_string(), run.threads.to_string());
    command.args(["--force", "--quiet", "--sensitivity", &again, "--threads", &threads]);
    // Ranks have no such option: each takes what the scene needs.
    if let Some(bytes) = memory::asked().filter(|_| ranks == 1) {
        command.args(["--memory", &bytes.to_string()]);
    }
    for one in run.set_words()? {
        command.args(["--set", &one]);
    }
    command.stdin(Stdio::null());
    Ok(command)
}

/// The error of a [`command`] that cannot be started, with the program that could not.
pub fn not_started(command: &Command, error: &io::Error) -> StudyError {
    StudyError::Start(io::Error::new(error.kind(), format!("{}: {error}", command.get_program().display())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::Sensitivity;

    #[test]
    fn one_rank_is_the_program_itself_and_several_are_started_by_mpirun_outside_a_job() {
        let overrides = ["time.end_s=(1)".to_string()];
        let run = CaseRun {
            scene: Path::new("s.ron"),
            overrides: &overrides,
            out: Path::new("o"),
            threads: 3,
            sensitivity: Sensitivity::Never,
        };
        let words = |ranks| {
            let command = command(&run, &["ndda".into()], ranks).expect("a short command");
            let words = std::iter::once(command.get_program()).chain(command.get_args());
            words.map(|word| word.to_string_lossy().into_owned()).collect::<Vec<_>>().join(" ")
        };
        let rest = "run s.ron --out o --force --quiet --sensitivity never --threads 3 --set time.end_s=(1)";
        assert_eq!(words(1), format!("ndda {rest}"));
        if Starter::here() == Starter::Mpirun {
            assert!(words(4).starts_with("mpirun --bind-to none -n 4 "), "{}", words(4));
        }
        assert!(words(4).ends_with(&format!("ndda-mpi {rest}")), "{}", words(4));
    }

    #[test]
    fn slurm_is_told_ranks_and_threads() {
        let words = Starter::Slurm.words(2, 16).join(" ");
        assert_eq!(words, "srun --ntasks=2 --cpus-per-task=16 --cpu-bind=cores");
    }
}
