//! Results of a sweep: a table of all cases, and the statistics of the samples at each point of the grid.

use ndda_io::study::{Axis, Sampling};
use serde::Serialize;

use super::Sweep;
use super::cases::{self, Role};
use super::condition::Condition;
use super::quantity::{self, FIXED, LABEL, SAFETY, SAFETY_LOWER, SAFETY_UPPER, Values};
use super::record::SweepOutcome;
use super::statistics::{Index, Moments, Part, indices};
use crate::study::case::grid;
use crate::study::error::StudyError;

/// Results of a sweep.
#[derive(Clone, Debug, Serialize)]
pub struct Results {
    /// `ndda.sweep/1`.
    pub schema: &'static str,
    /// Name of the sweep.
    pub name: String,
    /// Its title, or that of its file.
    pub title: String,
    /// Names of the axes.
    pub axes: Vec<String>,
    /// How samples were drawn; left out where nothing is random.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drawn: Option<Drawn>,
    /// Names of the quantities.
    pub quantities: Vec<String>,
    /// Whether the label is asked for.
    pub has_label: bool,
    /// All cases, in order.
    pub cases: Vec<Row>,
    /// Statistics of the samples at each point of the grid; none where nothing is random.
    pub groups: Vec<Group>,
}

/// How samples were drawn.
#[derive(Clone, Debug, Serialize)]
pub struct Drawn {
    /// Samples at a point of the grid.
    pub samples: u32,
    /// How they are spread.
    pub sampling: Sampling,
    /// Their seed.
    pub seed: u64,
    /// The condition whose probability is wanted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fails_when: Option<String>,
}

/// A case.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Its name.
    pub name: String,
    /// Value of each axis.
    pub labels: Vec<String>,
    /// Why it has no quantities; left out where it has.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Label of its run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
    /// Its quantities, in the order of [`Results::quantities`].
    pub values: Vec<Option<f64>>,
    /// Whether the condition holds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fails: Option<bool>,
    /// Whether its factor of safety is below or above all factors that are tried, so that its value is a bound.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub safety_is_bound: bool,
    #[serde(skip)]
    point: usize,
    #[serde(skip)]
    role: Option<Role>,
}

/// Statistics of the samples at one point of the grid.
#[derive(Clone, Debug, Serialize)]
pub struct Group {
    /// Axes and values of the point; empty where there is no grid.
    pub labels: Vec<(String, String)>,
    /// Moments of each quantity that has values.
    pub moments: Vec<(String, Moments)>,
    /// Samples for which the condition holds; none where no sample has a value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure: Option<Part>,
    /// Samples without a value: their scene is wrong, or their run stopped.
    pub undecided: usize,
    /// How much each random axis matters.
    pub sensitivity: Vec<Index>,
}

/// Schema of [`Results`]; it changes when a key does.
const SCHEMA: &str = "ndda.sweep/1";

impl Results {
    /// Puts outcomes together, in the order of the cases.
    ///
    /// # Errors
    /// [`StudyError::NoQuantity`] when no case has a quantity that is asked for, [`StudyError::AmbiguousCondition`] when the condition may
    /// be on several.
    pub fn new(sweep: &Sweep, outcomes: Vec<SweepOutcome>) -> Result<Self, StudyError> {
        let study = &sweep.loaded.study;
        let (quantities, has_label) = quantities(sweep, &outcomes)?;
        if let Some(condition) = &sweep.fails_when {
            unambiguous(condition, &outcomes, study.fails_when.as_deref().unwrap_or_default())?;
        }
        let row = |(case, outcome): (&cases::SweepCase, SweepOutcome)| {
            let (values, reason) = match outcome {
                SweepOutcome::Done(values) => (values, None),
                SweepOutcome::Failed { reason, .. } => (Values::default(), Some(reason)),
            };
            let number = |name: &str| values.numbers.iter().find(|(known, _)| known == name).map(|v| v.1);
            let has_both = number(SAFETY_LOWER).is_some() && number(SAFETY_UPPER).is_some();
            Row {
                name: case.case.name.clone(),
                labels: case.case.labels.iter().map(|(_, label)| label.clone()).collect(),
                reason,
                values: quantities.iter().map(|name| number(name)).collect(),
                safety_is_bound: number(SAFETY).is_some() && !has_both,
                fails: sweep.fails_when.as_ref().and_then(|condition| condition.holds(&values)),
                label: values.label,
                point: case.point,
                role: Some(case.role),
            }
        };
        let rows: Vec<Row> = sweep.cases.iter().zip(outcomes).map(row).collect();
        let is_random = study.axes.iter().any(|axis| matches!(axis, Axis::Random { .. }));
        let drawn = Drawn {
            samples: study.samples,
            sampling: study.sampling,
            seed: study.seed,
            fails_when: study.fails_when.clone(),
        };
        let title = if study.title.is_empty() { sweep.name.clone() } else { study.title.clone() };
        let mut axes: Vec<String> = Vec::new();
        axes.extend(sweep.cases.first().into_iter().flat_map(|c| c.case.labels.iter().map(|l| l.0.clone())));
        Ok(Self {
            schema: SCHEMA,
            name: sweep.name.clone(),
            title,
            axes,
            drawn: is_random.then_some(drawn),
            groups: if is_random { groups(sweep, &quantities, &rows) } else { Vec::new() },
            quantities,
            has_label,
            cases: rows,
        })
    }

    /// Whether any case has values.
    pub fn has_values(&self) -> bool {
        self.cases.iter().any(|row| row.reason.is_none())
    }

    /// Rows of one point of the grid that are independent samples.
    pub fn samples(&self, point: usize) -> impl Iterator<Item = &Row> {
        self.cases.iter().filter(move |row| row.point == point && row.is_sample())
    }
}

impl Row {
    /// Whether it is drawn at random, and not mixed of two that are.
    fn is_sample(&self) -> bool {
        matches!(self.role, Some(Role::Sample(_) | Role::Second(_)))
    }
}

/// Names of the numbers that are asked for, and whether the label is.
fn quantities(sweep: &Sweep, outcomes: &[SweepOutcome]) -> Result<(Vec<String>, bool), StudyError> {
    let done = || {
        outcomes.iter().filter_map(|outcome| match outcome {
            SweepOutcome::Done(values) => Some(values),
            SweepOutcome::Failed { .. } => None,
        })
    };
    let mut names: Vec<String> = Vec::new();
    let has_label = sweep.of.iter().any(|name| name == LABEL);
    for wanted in sweep.of.iter().filter(|name| *name != LABEL) {
        let before = names.len();
        let mut is_there = false;
        for values in done() {
            for i in values.named(wanted) {
                is_there = true;
                let name = &values.numbers[i].0;
                if !names[before..].contains(name) && !names[..before].contains(name) {
                    names.push(name.clone());
                }
            }
        }
        if let (false, Some(first)) = (is_there, done().next()) {
            return Err(no_quantity(wanted, first));
        }
    }
    Ok((names, has_label))
}

fn no_quantity(name: &str, of: &Values) -> StudyError {
    let (near, known) = (quantity::near(name, &of.numbers), quantity::listed(&of.numbers));
    StudyError::NoQuantity { name: name.into(), near, known }
}

/// Checks the names that are asked for against those that there will be.
///
/// # Errors
/// As [`Results::new`].
pub fn check_names(sweep: &Sweep, known: Values) -> Result<(), StudyError> {
    let text = sweep.loaded.study.fails_when.as_deref().unwrap_or_default();
    let condition = sweep.fails_when.as_ref().map(|condition| &condition.quantity);
    for name in sweep.of.iter().chain(condition).filter(|name| !FIXED.contains(&name.as_str())) {
        if known.named(name).is_empty() {
            return Err(no_quantity(name, &known));
        }
    }
    let known = [SweepOutcome::Done(known)];
    sweep.fails_when.as_ref().map_or(Ok(()), |condition| unambiguous(condition, &known, text))
}

/// A condition is on one quantity.
fn unambiguous(condition: &Condition, outcomes: &[SweepOutcome], text: &str) -> Result<(), StudyError> {
    for outcome in outcomes {
        let SweepOutcome::Done(values) = outcome else { continue };
        let named = values.named(&condition.quantity);
        if named.len() > 1 && condition.quantity != SAFETY {
            let known: Vec<&str> = named.iter().map(|&i| values.numbers[i].0.as_str()).collect();
            return Err(StudyError::AmbiguousCondition { condition: text.into(), known: known.join(", ") });
        }
    }
    Ok(())
}

fn groups(sweep: &Sweep, quantities: &[String], rows: &[Row]) -> Vec<Group> {
    let grid = grid(&sweep.loaded).into_iter().enumerate();
    let group = |(point, (labels, _)): (usize, (Vec<(String, String)>, _))| {
        let here: Vec<&Row> = rows.iter().filter(|row| row.point == point).collect();
        let samples: Vec<&Row> = here.iter().copied().filter(|row| row.is_sample()).collect();
        let of = |i: usize| samples.iter().filter_map(|row| row.values[i]).collect::<Vec<f64>>();
        let moments = quantities.iter().enumerate();
        let moments = moments.filter_map(|(i, name)| Some((name.clone(), Moments::of(&of(i))?)));
        let judged = samples.iter().filter_map(|row| row.fails).count();
        let failed = samples.iter().filter(|row| row.fails == Some(true)).count();
        let decided = match &sweep.fails_when {
            Some(_) => judged,
            None => samples.iter().filter(|row| row.reason.is_none()).count(),
        };
        Group {
            labels,
            moments: moments.collect(),
            failure: (sweep.fails_when.is_some() && judged > 0).then(|| Part::new(failed, judged)),
            undecided: samples.len() - decided,
            sensitivity: sensitivity(sweep, quantities, &here),
        }
    };
    grid.map(group).collect()
}

/// Indices of each quantity, from the samples of which all mixtures have a value.
fn sensitivity(sweep: &Sweep, quantities: &[String], here: &[&Row]) -> Vec<Index> {
    let study = &sweep.loaded.study;
    if !study.sensitivity {
        return Vec::new();
    }
    let axes: Vec<&str> =
        study.axes.iter().filter(|a| matches!(a, Axis::Random { .. })).map(Axis::name).collect();
    let n = study.samples as usize;
    let mut found = Vec::new();
    for (q, quantity) in quantities.iter().enumerate() {
        let mut table = vec![vec![None; axes.len() + 2]; n];
        for row in here {
            match row.role {
                Some(Role::Sample(k)) => table[k][0] = row.values[q],
                Some(Role::Second(k)) => table[k][1] = row.values[q],
                Some(Role::Mixed(k, i)) => table[k][2 + i] = row.values[q],
                _ => {}
            }
        }
        let whole: Vec<Vec<f64>> = table.into_iter().filter_map(|row| row.into_iter().collect()).collect();
        let column = |i: usize| whole.iter().map(|row| row[i]).collect::<Vec<f64>>();
        for (i, axis) in axes.iter().enumerate() {
            let ([first_order, total], half_widths95) = indices(&column(0), &column(1), &column(2 + i));
            let (quantity, parameter) = (quantity.clone(), axis.to_string());
            found.push(Index { quantity, parameter, first_order, total, half_widths95 });
        }
    }
    found
}
