//! Cases of a sweep: each sample at each point of the grid.

use ndda_io::study::{Axis, LoadedStudy, Sampling};

use super::distribution::{correlated, factor, quantile};
use super::points::{MOST_DIMENSIONS, points};
use crate::study::case::{Case, LONGEST_NAME, grid, name, set_first};
use crate::study::error::StudyError;

/// Part of a case in the statistics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A point of the grid, where nothing is random.
    Point,
    /// The k-th sample.
    Sample(usize),
    /// The k-th sample of the second set, which sensitivity takes.
    Second(usize),
    /// The k-th sample with the i-th random axis from the second set.
    Mixed(usize, usize),
}

/// One scene to compute.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepCase {
    /// Name, values of all axes and overrides.
    pub case: Case,
    /// Number of its point of the grid.
    pub point: usize,
    /// Its part in the statistics.
    pub role: Role,
}

/// All cases; `overrides` are set in the scene before what the study sets.
///
/// # Errors
/// [`StudyError::Names`] when two points of the grid have one name, [`StudyError::Samples`] where they cannot be drawn.
pub fn cases(loaded: &LoadedStudy, overrides: &[String]) -> Result<Vec<SweepCase>, StudyError> {
    let samples = samples(loaded)?;
    let sensitivity = loaded.study.second_runs;
    let mut all = Vec::new();
    for (point, (labels, own)) in grid(loaded).iter().enumerate() {
        let of_point = name(labels);
        for (role, values) in &samples {
            let (mut labels, mut own) = (labels.clone(), own.clone());
            let parts = [Some(of_point.clone()), role_name(*role)].into_iter().flatten();
            let parts: Vec<String> = parts.filter(|part| !part.is_empty()).collect();
            for (axis, value) in random(loaded).zip(values) {
                let Axis::Random { path, .. } = axis else { continue };
                labels.push((axis.name().to_string(), format!("{value:e}")));
                own.push(format!("{path}={value:e}"));
            }
            let case = Case { name: parts.join("__"), labels, overrides: own, repeats: 1, sensitivity };
            all.push(SweepCase { case, point, role: *role });
        }
    }
    let mut names = std::collections::HashSet::new();
    for case in &all {
        if case.case.name.len() > LONGEST_NAME || !names.insert(case.case.name.clone()) {
            return Err(StudyError::Names(case.case.name.clone()));
        }
    }
    for case in &mut all {
        set_first(std::slice::from_mut(&mut case.case), overrides);
    }
    Ok(all)
}

fn random(loaded: &LoadedStudy) -> impl Iterator<Item = &Axis> {
    loaded.study.axes.iter().filter(|axis| matches!(axis, Axis::Random { .. }))
}

fn role_name(role: Role) -> Option<String> {
    match role {
        Role::Point => None,
        Role::Sample(k) => Some(format!("sample_{:05}", k + 1)),
        Role::Second(k) => Some(format!("second_{:05}", k + 1)),
        Role::Mixed(k, i) => Some(format!("mixed_{:05}_{}", k + 1, i + 1)),
    }
}

/// Roles and values of the random axes, the same ones at each point of the grid.
fn samples(loaded: &LoadedStudy) -> Result<Vec<(Role, Vec<f64>)>, StudyError> {
    let study = &loaded.study;
    let distributions: Vec<_> = random(loaded)
        .filter_map(|axis| match axis {
            Axis::Random { distribution, .. } => Some(*distribution),
            _ => None,
        })
        .collect();
    let d = distributions.len();
    if d == 0 {
        return Ok(vec![(Role::Point, Vec::new())]);
    }
    let dimensions = if study.sensitivity { 2 * d } else { d };
    if dimensions > MOST_DIMENSIONS && study.sampling == Sampling::Sobol {
        return Err(StudyError::Samples(format!(
            "there are {d} random parameters, and Sobol' points have at most {MOST_DIMENSIONS}, or half as many with sensitivity: \
             draw them by `sampling: LatinHypercube` (`--sampling lhs`)"
        )));
    }
    let lower = correlation_factor(loaded)?;
    let values = |uniform: &[f64]| -> Vec<f64> {
        let uniform = lower.as_ref().map_or_else(|| uniform.to_vec(), |lower| correlated(uniform, lower));
        distributions.iter().zip(uniform).map(|(distribution, u)| quantile(distribution, u)).collect()
    };
    let drawn = points(study.sampling, study.samples as usize, dimensions, study.seed);
    let first = drawn.iter().map(|p| values(&p[..d]));
    let mut all: Vec<_> = first.enumerate().map(|(k, values)| (Role::Sample(k), values)).collect();
    if study.sensitivity {
        all.extend(drawn.iter().enumerate().map(|(k, p)| (Role::Second(k), values(&p[d..]))));
        for i in 0..d {
            all.extend(drawn.iter().enumerate().map(|(k, p)| {
                let mut mixed = p[..d].to_vec();
                mixed[i] = p[d + i];
                (Role::Mixed(k, i), values(&mixed))
            }));
        }
    }
    Ok(all)
}

/// Factor of the correlation matrix; none where nothing is correlated.
fn correlation_factor(loaded: &LoadedStudy) -> Result<Option<Vec<Vec<f64>>>, StudyError> {
    if loaded.study.correlations.is_empty() {
        return Ok(None);
    }
    let names: Vec<&str> = random(loaded).map(Axis::name).collect();
    let mut matrix = vec![vec![0.0; names.len()]; names.len()];
    (0..names.len()).for_each(|i| matrix[i][i] = 1.0);
    let place = |name: &str| names.iter().position(|known| *known == name);
    for correlation in &loaded.study.correlations {
        let (a, b) = &correlation.between;
        if let (Some(i), Some(j)) = (place(a), place(b)) {
            (matrix[i][j], matrix[j][i]) = (correlation.coefficient, correlation.coefficient);
        }
    }
    let refuse = || StudyError::Samples("the correlations contradict each other: make them smaller".into());
    factor(&matrix).map(Some).ok_or_else(refuse)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndda_io::study::{self, Study};

    fn loaded(vary: &[&str], change: impl FnOnce(&mut Study)) -> LoadedStudy {
        let vary: Vec<String> = vary.iter().map(|text| text.to_string()).collect();
        let mut study = Study::of_scene("s.ron".into());
        study.axes = Axis::from_words(&vary).unwrap();
        change(&mut study);
        LoadedStudy { study, curves: Vec::new(), scene: "s.ron".into(), scene_text: String::new() }
    }

    #[test]
    fn every_sample_is_at_every_point_of_the_grid() {
        let loaded = loaded(&["a.x=1,2", "phi=Normal(30, 2)", "a.y=u,v,w"], |study| study.samples = 5);
        let cases = cases(&loaded, &["z=0".into()]).unwrap();
        assert_eq!(cases.len(), 30);
        let last = cases.last().unwrap();
        assert_eq!((last.case.name.as_str(), last.point), ("x=2__y=w__sample_00005", 5));
        assert_eq!(last.case.overrides[..3], ["z=0", "a.x=2", "a.y=w"]);
        assert_eq!(last.case.overrides[3], format!("phi={}", last.case.labels[2].1));
        let values = |point: usize| -> Vec<&str> {
            cases.iter().filter(|c| c.point == point).map(|c| c.case.labels[2].1.as_str()).collect()
        };
        assert_eq!(values(0), values(5));
    }

    #[test]
    fn mixed_samples_have_one_value_of_the_second_set() {
        let loaded = loaded(&["a=Uniform(0, 1)", "b=Uniform(0, 1)"], |study| {
            (study.samples, study.sensitivity) = (4, true);
        });
        let cases = cases(&loaded, &[]).unwrap();
        assert_eq!(cases.len(), 4 * (2 + 2));
        let of = |role: Role| -> Vec<String> {
            let case = cases.iter().find(|case| case.role == role).unwrap();
            case.case.labels.iter().map(|(_, value)| value.clone()).collect()
        };
        for k in 0..4 {
            let (first, second) = (of(Role::Sample(k)), of(Role::Second(k)));
            assert_eq!(of(Role::Mixed(k, 0)), [second[0].clone(), first[1].clone()]);
            assert_eq!(of(Role::Mixed(k, 1)), [first[0].clone(), second[1].clone()]);
        }
    }

    #[test]
    fn too_many_axes_and_contradictions_are_refused() {
        let many: Vec<String> = (0..11).map(|i| format!("a{i}=Uniform(0, 1)")).collect();
        let many: Vec<&str> = many.iter().map(String::as_str).collect();
        let drawn = |sampling| {
            let change = |study: &mut Study| {
                (study.sensitivity, study.sampling, study.samples) = (true, sampling, 2);
            };
            cases(&loaded(&many, change), &[])
        };
        let refused = drawn(Sampling::Sobol).unwrap_err().to_string();
        assert!(refused.contains("11 random parameters") && refused.contains("--sampling lhs"), "{refused}");
        assert_eq!(drawn(Sampling::LatinHypercube).unwrap().len(), 2 * (2 + 11));
        let pair =
            |a: &str, b: &str, coefficient| study::Correlation { between: (a.into(), b.into()), coefficient };
        let three = loaded(&["a=Normal(0,1)", "b=Normal(0,1)", "c=Normal(0,1)"], |study| {
            study.correlations = vec![pair("a", "b", 0.9), pair("b", "c", 0.9), pair("a", "c", -0.9)];
        });
        assert!(cases(&three, &[]).unwrap_err().to_string().contains("contradict"));
    }
}
