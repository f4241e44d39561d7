//! Hands the cases to a scheduler: a job array, GNU parallel, or a plain list of commands.

use std::path::Path;

use super::case::Case;
use super::ranks::Starter;

/// Scheduler or shell that is to run the cases.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Emit {
    /// A job array of Slurm.
    Slurm,
    /// GNU parallel.
    Parallel,
    /// One command per line.
    List,
}

impl Emit {
    /// Each with its name and what it prints.
    pub const KINDS: [(Self, &str, &str); 3] = [
        (Self::Slurm, "slurm", "A job array of Slurm"),
        (Self::Parallel, "parallel", "A script for GNU parallel"),
        (Self::List, "list", "One command per line"),
    ];

    /// The one of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::KINDS.iter().find(|(_, own, _)| *own == name).map(|(kind, ..)| *kind)
    }
}

/// How a scheduler is to run the cases.
pub struct Plan<'a> {
    /// The study file.
    pub study: &'a Path,
    /// Its output folder.
    pub out: &'a Path,
    /// Cases at a time.
    pub jobs: u16,
    /// Ranks that take a run together; one is the ordinary program.
    pub ranks: u16,
    /// Threads of each run, or of each of its ranks.
    pub threads: u16,
    /// Values that are set in its scene, as `path=value`.
    pub overrides: &'a [String],
}

/// A script that runs all cases.
pub fn script(plan: &Plan, cases: &[Case], emit: Emit) -> String {
    let study = quoted(&plan.study.display().to_string());
    let command = format!("ndda study case {study}");
    let mut options = format!("--out {} --threads {}", quoted(&plan.out.display().to_string()), plan.threads);
    if plan.ranks > 1 {
        options += &format!(" --ranks {}", plan.ranks);
    }
    plan.overrides.iter().for_each(|one| options += &format!(" --set {}", quoted(one)));
    let names: Vec<&str> = cases.iter().map(|case| case.name.as_str()).collect();
    match emit {
        Emit::List => {
            names.iter().map(|name| format!("{command} {name} {options}")).collect::<Vec<_>>().join("\n")
        }
        Emit::Parallel => format!(
            "#!/bin/sh\nparallel --jobs {} {command} {{}} {options} ::: \\\n  {}\nndda study collect {study} {options}",
            plan.jobs,
            names.join(" \\\n  "),
        ),
        Emit::Slurm => format!(
            "#!/bin/sh\n#SBATCH --array=0-{}%{}\n{}#SBATCH --cpus-per-task={}\n\
             # Afterwards: ndda study collect {study} {options}\nset -- \\\n  {}\nshift \"$SLURM_ARRAY_TASK_ID\"\n\
             exec {command} \"$1\" {options}",
            cases.len() - 1,
            plan.jobs,
            tasks(plan),
            plan.threads,
            names.join(" \\\n  "),
        ),
    }
}

/// Lines of the script that ask Slurm for the ranks and threads of each case, where several ranks run it.
fn tasks(plan: &Plan) -> String {
    if plan.ranks == 1 {
        return String::new();
    }
    let starter = Starter::Slurm.words(plan.ranks, plan.threads).join(" ");
    format!("# Each case runs by {starter} ndda-mpi run\n#SBATCH --ntasks={}\n", plan.ranks)
}

/// One word of a shell.
pub fn quoted(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "/._-+=".contains(c);
    if !text.is_empty() && text.chars().all(plain) {
        text.to_string()
    } else {
        format!("'{}'", text.replace('\'', "'\\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::Sensitivity;

    fn emitted(emit: Emit) -> String {
        emitted_for(emit, 1)
    }

    fn emitted_for(emit: Emit, ranks: u16) -> String {
        let case = |name: &str| Case {
            name: name.into(),
            labels: Vec::new(),
            overrides: Vec::new(),
            repeats: 1,
            sensitivity: Sensitivity::Never,
        };
        let overrides = ["time.end_s=(1)".into()];
        let (study, out) = (Path::new("it's.ron"), Path::new("out/s"));
        let plan = Plan { study, out, jobs: 3, ranks, threads: 2, overrides: &overrides };
        script(&plan, &[case("a=1"), case("a=2")], emit)
    }

    #[test]
    fn a_list_has_one_command_per_case() {
        let first = "ndda study case 'it'\\''s.ron' a=1 --out out/s --threads 2 --set 'time.end_s=(1)'";
        assert_eq!(emitted(Emit::List).lines().next(), Some(first));
        assert_eq!(emitted(Emit::List).lines().count(), 2);
    }

    #[test]
    fn an_array_has_one_task_per_case() {
        let script = emitted(Emit::Slurm);
        assert!(script.contains("#SBATCH --array=0-1%3\n#SBATCH --cpus-per-task=2\n"), "{script}");
        assert!(script.contains("set -- \\\n  a=1 \\\n  a=2\nshift"), "{script}");
    }

    #[test]
    fn several_ranks_are_tasks_of_an_array() {
        let script = emitted_for(Emit::Slurm, 4);
        let expected = "#SBATCH --array=0-1%3\n\
                        # Each case runs by srun --ntasks=4 --cpus-per-task=2 --cpu-bind=cores ndda-mpi run\n\
                        #SBATCH --ntasks=4\n#SBATCH --cpus-per-task=2\n";
        assert!(script.contains(expected), "{script}");
        assert!(
            script.ends_with("\"$1\" --out out/s --threads 2 --ranks 4 --set 'time.end_s=(1)'"),
            "{script}"
        );
        assert!(
            script.contains("ndda study collect 'it'\\''s.ron' --out out/s --threads 2 --ranks 4"),
            "{script}"
        );
        // One rank is the ordinary program.
        assert!(
            [Emit::Slurm, Emit::Parallel, Emit::List].iter().all(|kind| !emitted(*kind).contains("rank"))
        );
    }

    #[cfg(unix)]
    #[test]
    fn a_shell_reads_what_is_emitted() {
        use std::io::Write;
        for (kind, ranks) in
            [Emit::Slurm, Emit::Parallel, Emit::List].into_iter().flat_map(|k| [(k, 1), (k, 4)])
        {
            let mut shell = std::process::Command::new("sh");
            let mut shell = shell.arg("-n").stdin(std::process::Stdio::piped()).spawn().expect("a shell");
            let script = emitted_for(kind, ranks);
            shell.stdin.take().expect("its input").write_all(script.as_bytes()).expect("it reads");
            assert!(shell.wait().expect("it ends").success(), "{script}");
        }
    }

    #[test]
    fn parallel_gets_the_names_and_gathers() {
        let script = emitted(Emit::Parallel);
        assert!(
            script.contains("parallel --jobs 3 ndda study case")
                && script.contains("::: \\\n  a=1 \\\n  a=2\n")
        );
        assert!(script.contains("ndda study collect"));
    }
}
