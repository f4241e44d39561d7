//! Steps that resolve waves: their periods, the rows of their records, and the forces by which quiet faces let them in.
//!
//! A step takes the force F of a quiet face by its mean, which leaves π/24 Δt |Δ²F| of an impulse (`ringing.rs` of the solver), and the label adds these up without
//! regard to their direction. With accelerations a of the wave they add up to π/24 Δt² ∫|ä| dt, which is to be small beside the wave's largest speed.

use std::f64::consts::PI;

use ndda_fem::Motion;
use ndda_solver::Simulation;

use super::{Finding, MOST_STEP, coarsest, sources};
use crate::judge::verdict::SPEED;
use crate::numbers::two_figures_down;

/// Longest steps for the waves of a scene [s], and why.
pub(crate) fn limits(simulation: &Simulation) -> Vec<(f64, String)> {
    let mut limits = Vec::new();
    if let Some(step_s) = for_rows(simulation) {
        limits.push((step_s, "the time between two rows of a record".to_string()));
    }
    let sources = sources::of(simulation);
    let highest_hz = sources.iter().map(|source| source.hz).fold(0.0, f64::max);
    if coarsest(simulation, &sources).is_some() {
        let reason = format!(
            "{:.0} steps in a period of waves, at {highest_hz:.3} Hz (95 % of their energy is below it)",
            1.0 / MOST_STEP
        );
        limits.push((MOST_STEP / highest_hz, reason));
    }
    if let Some(step_s) = for_quiet_faces(simulation) {
        let reason = "the forces of quiet faces, which let waves in, then leave velocities right to 1 %";
        limits.push((step_s, reason.to_string()));
    }
    limits
}

/// How far wrong velocities become by the steps in which quiet faces let waves in, over the largest speed; none where they let none in.
pub(crate) fn through_quiet_faces(simulation: &Simulation) -> Option<Finding> {
    let longest_s = for_quiet_faces(simulation)?;
    let value = SPEED * (simulation.step_s() / longest_s).powi(2);
    let reason = format!(
        "the time step is too long for the waves that quiet faces let in: velocities may be wrong by {:.1} % of the largest speed, limit {:.0} %, and the run would be \
         labelled inaccurate: take a step_s of {} or less",
        100.0 * value,
        100.0 * SPEED,
        two_figures_down(longest_s)
    );
    Some(Finding { what: "error by quiet faces / largest speed", value, limit: SPEED, reason })
}

/// The longest step with which quiet faces let all waves in as the label wants it [s].
pub(super) fn for_quiet_faces(simulation: &Simulation) -> Option<f64> {
    let blocks = simulation.blocks().ids();
    let waves = blocks.flat_map(|block| &simulation.shape(block).supports.quiet.waves);
    let rate = waves.filter_map(bends_per_speed).fold(0.0, f64::max);
    (rate > 0.0).then(|| (24.0 * SPEED / (PI * rate)).sqrt())
}

/// ∫|ä| dt over the largest speed of a motion [1/s²].
fn bends_per_speed(motion: &Motion) -> Option<f64> {
    let (first_s, last_s, rows) = motion.extent()?;
    let accelerations = motion.accelerations();
    let spacing_s = (last_s - first_s) / rows.checked_sub(1)?.max(1) as f64;
    let bends = accelerations.windows(3).map(|a| (a[2] - 2.0 * a[1] + a[0]).norm()).sum::<f64>() / spacing_s;
    let time_s = |row: usize| first_s + row as f64 * spacing_s;
    let fastest = (0..rows).map(|row| motion.velocity(time_s(row)).norm()).fold(0.0, f64::max);
    Some(bends / fastest).filter(|rate| rate.is_finite())
}

/// The least mean distance between rows of the records of a scene [s].
fn for_rows(simulation: &Simulation) -> Option<f64> {
    let supports = |block| &simulation.shape(block).supports;
    let blocks = simulation.blocks().ids();
    let motions = blocks.flat_map(|block| supports(block).quiet.waves.iter().chain(&supports(block).motions));
    let mut records = Vec::new();
    motions.for_each(|motion| sources::add_records(motion, &mut records));
    let spacing = |motion: &Motion| {
        let (first_s, last_s, rows) = motion.extent()?;
        Some((last_s - first_s) / rows.checked_sub(1)? as f64)
    };
    let spacings = records.into_iter().filter_map(spacing).filter(|spacing_s| *spacing_s > 0.0);
    spacings.reduce(f64::min).filter(|spacing_s| spacing_s.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Model;

    /// A column of 60 m that a record shakes from below, with rows 10 ms apart, of a wave at 1.3 Hz and one at 4 Hz, with a step or without one.
    fn column(step: &str) -> Model {
        let folder = tempfile::tempdir().unwrap();
        let packet = |t: f64, hz: f64, at_s: f64, wide_s: f64| {
            (2.0 * PI * hz * t).sin() * (-((t - at_s) / wide_s).powi(2)).exp()
        };
        let acceleration = |t: f64| 3.0 * packet(t, 1.3, 4.0, 2.0) + packet(t, 4.0, 5.0, 1.0);
        let times = (0..=1000).map(|i| f64::from(i) * 1e-2);
        let rows: String = times.map(|t| format!("{t},{}\n", acceleration(t))).collect();
        std::fs::write(folder.path().join("q.csv"), format!("time_s,acceleration_m_s2\n{rows}")).unwrap();
        let text = format!(
            "(title: \"column\", time: ({step}end_s: 10), contact: Off,
              materials: [(name: \"r\", young_pa: 2.5e9, poisson: 0.25, density_kg_m3: 2500)],
              blocks: [(name: \"g\", material: \"r\", shape: Box(size_m: (2, 2, 60), cells: (1, 1, 20)))],
              ties: [(block: \"g\", on: [All])],
              quiet: [(block: \"g\", on: Set(\"z_min\"), incident: [(wave: S((1, 0, 0)), motion: Outcrop, record: (file: \"q.csv\"))])])"
        );
        std::fs::write(folder.path().join("s.ron"), text).unwrap();
        Model::open(&folder.path().join("s.ron"), &[]).unwrap()
    }

    /// Runs of this scene are labelled with errors of 42.5, 11.9, 3.1 and at most 1 %.
    #[test]
    fn steps_that_the_label_would_reject_are_foretold() {
        let error = |step_s: &str| {
            through_quiet_faces(&column(&format!("step_s: {step_s}, ")).simulation).unwrap().value
        };
        for (step_s, least, most) in [
            ("3.9e-2", 0.3, 0.6),
            ("2e-2", 0.09, 0.18),
            ("1e-2", 0.02, 0.05),
            ("5e-3", 0.0, 0.01),
            ("3e-3", 0.0, 0.01),
        ] {
            let found = error(step_s);
            assert!(found >= least && found <= most, "{step_s}: {found}");
        }
    }

    #[test]
    fn the_step_that_is_chosen_resolves_waves_and_the_rows_of_records() {
        let model = column("");
        let step_s = model.loaded.scene.time.step_s;
        assert!((3e-3..=6e-3).contains(&step_s), "{step_s}");
        assert!(super::super::findings(&model.simulation).iter().all(|found| found.value <= found.limit));
        let limits = limits(&model.simulation);
        assert!(limits.iter().all(|(longest_s, _)| step_s <= *longest_s), "{limits:?}");
        assert!(limits.iter().any(|(longest_s, _)| (longest_s / 1e-2 - 1.0).abs() < 1e-9), "{limits:?}");
    }

    #[test]
    fn a_cure_for_a_step_that_is_too_long_is_one_that_the_label_accepts() {
        let found = super::super::findings(&column("step_s: 1e-1, ").simulation);
        let step = found.iter().find(|found| found.value > found.limit).unwrap();
        assert!(step.reason.ends_with("take a step_s of 5.4e-3 or less"), "{}", step.reason);
    }
}
