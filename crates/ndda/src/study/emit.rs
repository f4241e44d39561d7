//! Hands the cases to a scheduler: a job array, GNU parallel, or a plain list of commands.

use std::path::Path;

use super::case::Case;

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

/// How a scheduler is to run the cases.
pub struct Plan<'a> {
    /// The study file.
    pub study: &'a Path,
    /// Its output folder.
    pub out: &'a Path,
    /// Cases at a time.
    pub jobs: u16,
    /// Threads of each run.
    pub threads: u16,
    /// Values that are set in its scene, as `path=value`.
    pub overrides: &'a [String],
}

/// A script that runs all cases.
pub fn script(plan: &Plan, cases: &[Case], emit: Emit) -> String {
    let study = quoted(&plan.study.display().to_string());
    let command = format!("ndda study case {study}");
    let mut options = format!("--out {} --threads {}", quoted(&plan.out.display().to_string()), plan.threads);
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
            "#!/bin/sh\n#SBATCH --array=0-{}%{}\n#SBATCH --cpus-per-task={}\n\
             # Afterwards: ndda study collect {study} {options}\nset -- \\\n  {}\nshift \"$SLURM_ARRAY_TASK_ID\"\n\
             exec {command} \"$1\" {options}",
            cases.len() - 1,
            plan.jobs,
            plan.threads,
            names.join(" \\\n  "),
        ),
    }
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

    fn emitted(emit: Emit) -> String {
        let case =
            |name: &str| Case { name: name.into(), labels: Vec::new(), overrides: Vec::new(), repeats: 1 };
        let overrides = ["time.end_s=(1)".into()];
        let (study, out) = (Path::new("it's.ron"), Path::new("out/s"));
        let plan = Plan { study, out, jobs: 3, threads: 2, overrides: &overrides };
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
    fn parallel_gets_the_names_and_gathers() {
        let script = emitted(Emit::Parallel);
        assert!(
            script.contains("parallel --jobs 3 ndda study case")
                && script.contains("::: \\\n  a=1 \\\n  a=2\n")
        );
        assert!(script.contains("ndda study collect"));
    }
}
