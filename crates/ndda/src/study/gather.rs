//! Records of cases become results: each is compared with what the study names.

use ndda_io::study::Clock;

use super::case::Case;
use super::error::StudyError;
use super::front::{Point, front};
use super::judge::Judge;
use super::launch::Launch;
use super::record::{Record, RunOutcome, folder};
use super::result::{CasePoint, Figures, Results};

impl Results {
    /// Reads the records of all cases and compares them.
    ///
    /// # Errors
    /// [`StudyError`] when there is nothing to compare with, or a file cannot be read.
    pub fn gather(
        launch: &Launch,
        name: &str,
        (cases, references): (&[Case], &[Case]),
    ) -> Result<Self, StudyError> {
        let loaded = launch.loaded;
        let judge = Judge::new(launch, references)?;
        let (mut points, mut missing) = (Vec::new(), Vec::new());
        let mut kind = String::new();
        for case in cases {
            match launch.finished(case)? {
                Some(record) => points.push(judge.point(launch, case, record, &mut kind)?),
                None => match unfinished(launch, case)? {
                    Some(point) => points.push(point),
                    None => missing.push(case.name.clone()),
                },
            }
        }
        let reference = judge.compared(kind);
        mark_fronts(&mut points, reference.floors());
        let scene = loaded.scene.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let title = loaded.study.title.clone();
        Ok(Self {
            name: name.into(),
            title,
            scene,
            curves: loaded.curves.clone(),
            clock: match loaded.study.clock {
                Clock::Wall => "wall",
                Clock::Processor => "processor",
            },
            reference,
            points,
            missing,
        })
    }
}

/// A case whose run ended in a way that another attempt may not: it is reported, and run again the next time.
fn unfinished(launch: &Launch, case: &Case) -> Result<Option<CasePoint>, StudyError> {
    let record = Record::read(&folder(launch.out, &case.name))?;
    let record = record.filter(|record| record.identity == launch.identity(case));
    Ok(record.and_then(|record| match record.outcome {
        RunOutcome::Failed { reason, .. } => Some(CasePoint::failed(case, reason)),
        RunOutcome::Done { .. } => None,
    }))
}

fn mark_fronts(points: &mut [CasePoint], floors: [f64; 2]) {
    for which in [0, 1] {
        let mut done: Vec<&mut Figures> = points.iter_mut().filter_map(|p| p.figures.as_mut()).collect();
        let all: Vec<Point> = done.iter().map(|figures| figures.point(which, floors[which])).collect();
        for i in front(&all) {
            done[i].on_front[which] = true;
        }
    }
}
