//! Makes the runs of a certificate, those only that are needed, and puts the certificate together.

use ndda_io::scene::{Step, Turning};
use ndda_io::table::Table;

use super::certificate::{self, Basis, Certificate, Certified, ClosedForm, Histories, RunRecord, SCHEMA};
use super::chaos::{self, Chaos};
use super::error::CertifyError;
use super::extrapolate::Behaviour;
use super::plan::{Plan, finer, not_refined, order};
use super::quantities::{quantities, unresolved_energy_j};
use super::report::vanishes;
use crate::judge::reasons;
use crate::study::case::Case;
use crate::study::error::StudyError;
use crate::study::launch::Launch;
use crate::study::record::{RESULTS, RunOutcome, folder};
use crate::summary::{LabelWord, Summary};

/// Steps that may stop before three are found that do not.
const MOST_STOPPED: u32 = 2;

/// Errors to estimate beside that of the time step.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// Finer meshes: 0, 1 or 2.
    pub meshes: u32,
    /// Stiffer contact: 0, 1 or 2.
    pub penalties: u32,
    /// Beginnings of names of more columns of the history.
    pub of: Vec<String>,
}

/// A run that has ended.
pub struct Ended {
    /// Its summary.
    pub summary: Summary,
    /// Its history.
    pub history: Table,
}

/// Makes the runs and the certificate of a scene called `name`.
///
/// # Errors
/// [`CertifyError`] when runs fail or what is asked for is not there.
pub fn certify(
    launch: &Launch,
    plan: &Plan,
    name: &str,
    wanted: &Wanted,
) -> Result<Certificate, CertifyError> {
    if !plan.scene.stages.is_empty() {
        return Err(CertifyError::Stages);
    }
    if wanted.meshes > 0 && finer(&plan.scene, 1).is_empty() {
        return Err(CertifyError::NoMesh);
    }
    if wanted.penalties > 0 && plan.stiffer(0, 1).is_none() {
        return Err(CertifyError::NoContact);
    }
    plan.check_names(&wanted.of)?;
    let mut remarks = Vec::new();
    let first = levels(launch, plan, &mut remarks)?;
    let more = more_cases(plan, first, wanted);
    launch.run_all(&more)?;
    let mut records = Vec::new();
    let mut ended = |case: &Case| -> Result<Ended, CertifyError> {
        let ended = read(launch, case)?;
        records.push(run_record(&case.name, &ended.summary));
        Ok(ended)
    };
    let [a, b, c] =
        [ended(&plan.level(first))?, ended(&plan.level(first + 1))?, ended(&plan.level(first + 2))?];
    let moving = quantities(&c.history, &[]);
    let tables = [&a.history, &b.history, &c.history];
    let (mut twin, mut chaos) = (None, None);
    if chaos::is_suspect(&moving, tables, plan.rounding_m(first)) {
        let case = plan.twin(first, largest_speed_m_s(&a));
        launch.run_all(std::slice::from_ref(&case))?;
        let run = ended(&case)?;
        chaos = chaos::judge(&moving, tables, &run.history);
        twin = Some(run.history);
    }
    let (meshes, penalties) = more.split_at(wanted.meshes as usize);
    let mut tables_of = |cases: &[Case]| -> Result<Vec<Table>, CertifyError> {
        cases.iter().map(|case| Ok(ended(case)?.history)).collect()
    };
    let (meshes, penalties) = (tables_of(meshes)?, tables_of(penalties)?);
    let unresolved_energy_j = unresolved_energy_j(&b.history, &c.history);
    let closed_form = c.summary.reference.as_ref().map(|exact| ClosedForm {
        kind: exact.kind.clone(),
        error_end: exact.error_end,
        error_max: exact.error_max,
    });
    let least_mass_kg = c.summary.blocks.0.iter().map(|(_, end)| end.mass).fold(f64::INFINITY, f64::min);
    let basis = Basis {
        order: order(&plan.scene),
        steps: plan.steps(first + 2),
        step_s: plan.step_s(first),
        least_mass_kg: if least_mass_kg.is_finite() { least_mass_kg } else { 0.0 },
        of: &wanted.of,
        is_chaotic: chaos.is_some(),
        is_unseen: plan.turning(first).is_some(),
    };
    let steps = [a.history, b.history, c.history];
    let quantities = certificate::certify(&Histories { steps, meshes, penalties, twin }, &basis);
    let mut certificate = Certificate {
        schema: SCHEMA.into(),
        scene: name.into(),
        title: plan.scene.title.clone(),
        estimates: estimates(wanted),
        order_of_scheme: basis.order,
        wall_s: records.iter().map(|run| run.wall_s).sum(),
        processor_s: records.iter().map(|run| run.processor_s).sum(),
        runs: records,
        quantities,
        closed_form,
        chaos,
        unresolved_energy_j,
        remarks,
    };
    certificate.remarks.extend(plan.turning(first).map(|turning| unseen(&turning, plan.step_s(first + 2))));
    remark(&mut certificate, plan, wanted, &c.summary);
    Ok(certificate)
}

/// Runs three steps that halve, beginning with the longest that does not stop; returns its level.
fn levels(launch: &Launch, plan: &Plan, remarks: &mut Vec<String>) -> Result<u32, CertifyError> {
    let mut first = 0;
    loop {
        let cases = [first, first + 1, first + 2].map(|level| plan.level(level));
        launch.run_all(&cases)?;
        let mut stopped = None;
        for (level, case) in (first..).zip(&cases) {
            if let Some(reason) = failure(launch, case)? {
                stopped = Some((level, reason));
            }
        }
        let Some((level, reason)) = stopped else { return Ok(first) };
        let step_s = plan.step_s(level);
        if level >= MOST_STOPPED {
            return Err(CertifyError::Stopped { step_s, reason });
        }
        remarks.push(format!(
            "the run with steps of {step_s:e} s stopped: {reason}; the errors are those of shorter steps"
        ));
        first = level + 1;
    }
}

/// The runs of finer meshes and of stiffer contact.
fn more_cases(plan: &Plan, first: u32, wanted: &Wanted) -> Vec<Case> {
    let meshes = (1..=wanted.meshes).map(|times| plan.finer_mesh(first, times));
    let penalties = (1..=wanted.penalties).filter_map(|times| plan.stiffer(first, times));
    meshes.chain(penalties).collect()
}

/// Why a case did not end; none if it did.
fn failure(launch: &Launch, case: &Case) -> Result<Option<String>, CertifyError> {
    Ok(match launch.record(case)?.map(|record| record.outcome) {
        Some(RunOutcome::Failed { reason, .. }) => Some(reason),
        Some(RunOutcome::Done { .. }) => None,
        None => Some("it has not run".into()),
    })
}

/// Summary and history of a case that has ended.
///
/// # Errors
/// [`CertifyError::Failed`] when it has not, or a file of it cannot be read.
pub fn read(launch: &Launch, case: &Case) -> Result<Ended, CertifyError> {
    let failed = |reason: String| CertifyError::Failed { name: case.name.clone(), reason };
    let record = launch.record(case)?;
    let summary = match record.map(|record| record.outcome) {
        Some(RunOutcome::Done { summary, .. }) => summary,
        Some(RunOutcome::Failed { reason, .. }) => return Err(failed(reason)),
        None => return Err(failed("it has not run".into())),
    };
    let file = folder(launch.out, &case.name).join(RESULTS).join(ndda_io::OutputFolder::HISTORY);
    let history = Table::read(&file).map_err(StudyError::from)?;
    let summary = serde_json::from_value(summary).map_err(|e| failed(e.to_string()))?;
    Ok(Ended { summary, history })
}

fn run_record(name: &str, summary: &Summary) -> RunRecord {
    RunRecord {
        name: name.into(),
        step_s: summary.step_s,
        steps: summary.steps,
        label: summary.label.word.as_str().into(),
        wall_s: summary.wall_s,
        processor_s: summary.machine.processor_time_s,
        state_crc32: summary.state_crc32.clone(),
    }
}

/// √(2 K/m) of the largest kinetic energy and the mass of all blocks [m/s].
fn largest_speed_m_s(run: &Ended) -> f64 {
    let mass_kg: f64 = run.summary.blocks.0.iter().map(|(_, end)| end.mass).sum();
    let kinetic_j = run.history.column("kinetic_j").unwrap_or_default().iter().copied().fold(0.0, f64::max);
    if mass_kg > 0.0 { (2.0 * kinetic_j / mass_kg).sqrt() } else { 0.0 }
}

/// Which errors are estimated.
fn estimates(wanted: &Wanted) -> String {
    match (wanted.meshes > 0, wanted.penalties > 0) {
        (false, false) => {
            "the error of the time step, for the laws, the mesh and the penalty that the scene has"
        }
        (true, false) => {
            "the errors of the time step and of the mesh, for the laws and the penalty that the scene has"
        }
        (false, true) => {
            "the errors of the time step and of the penalty, for the laws and the mesh that the scene has"
        }
        (true, true) => {
            "the errors of the time step, of the mesh and of the penalty, for the laws that the scene has"
        }
    }
    .into()
}

/// The remark on a table that turns back within the shortest step.
fn unseen(Turning { path, within_s }: &Turning, step_s: f64) -> String {
    format!(
        "{path} turns back within {within_s:.2e} s, less than the shortest step of {step_s:e} s, which sees its mean only: all runs may be wrong alike. Error \
         bars of displacements are at least the largest speed times that step; those of other quantities are not to be believed. \
         Steps that follow the table: --set time.step_s={within_s:.0e}"
    )
}

/// The remark on energy that is lost or gained in every step.
fn unresolved(energy_j: f64, deforms: bool) -> String {
    let what = match deforms {
        true => format!("{energy_j:.1e} J of vibration is damped by the scheme at every one of these steps"),
        false => format!("the energy is off by up to {energy_j:.1e} J at every one of these steps"),
    };
    format!("{what}; the error bars of energies, velocities and displacements hold what it may add")
}

/// Says what a person should know before using a certificate.
fn remark(certificate: &mut Certificate, plan: &Plan, wanted: &Wanted, summary: &Summary) {
    let is_spread = |q: &&Certified| q.behaviour == Behaviour::Spreads && !vanishes(certificate, q);
    let spread = certificate.quantities.iter().filter(is_spread).count();
    let mut say = |text: String| certificate.remarks.push(text);
    if let Some(Chaos { growth, predictable_until_s }) = certificate.chaos {
        say(format!(
            "the motion is chaotic: a disturbance of gravity by 1e-9 grew {growth:.1e} times, and no step brings runs \
             together. Single trajectories agree to 1 % until {predictable_until_s:.3} s; later only statistics of many runs \
             mean something. Values marked chaotic are mean and twice the standard deviation of these runs"
        ));
    }
    let (all, spread) = (certificate.quantities.len(), spread);
    if spread > 0 && certificate.chaos.is_none() {
        say(format!(
            "{spread} of {all} quantities {} three times the largest difference. \
             Shorter steps may help: --set time.step_s={:e}",
            match spread {
                1 => "does not converge at these steps; its error bar is",
                _ => "do not converge at these steps; their error bars are",
            },
            plan.step_s(2)
        ));
    }
    if certificate.unresolved_energy_j > 0.0 {
        say(unresolved(certificate.unresolved_energy_j, plan.deforms));
    }
    let left = not_refined(&plan.scene);
    if wanted.meshes > 0 && !left.is_empty() {
        say(format!(
            "the mesh of {} cannot be refined by a value of the scene and is left out of the error",
            left.join(", ")
        ));
    }
    if matches!(plan.scene.time.step, Step::Auto { .. }) {
        say("the scene uses Auto(): what was halved is time.step_s, which Auto() divides further".into());
    }
    if summary.label.word == LabelWord::Inaccurate {
        say(format!(
            "the run of the shortest step is inaccurate: {}",
            reasons::in_a_line(&summary.label.reasons)
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::unresolved;

    #[test]
    fn energy_that_is_missing_is_vibration_only_where_blocks_deform() {
        let [rigid, elastic] = [false, true].map(|deforms| unresolved(2.2e-6, deforms));
        assert!(rigid.starts_with("the energy is off by up to 2.2e-6 J at every one"), "{rigid}");
        assert!(
            elastic.starts_with("2.2e-6 J of vibration is damped by the scheme at every one"),
            "{elastic}"
        );
    }
}
