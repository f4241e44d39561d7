//! Steps that resolve loads.

use ndda_io::scene::{BlastPressure, Scene};
use ndda_mesh::Vec3;

use super::pressures::all;
use super::{STEPS_OF_LOADS, TURN};

/// The longest steps [s] that resolve how loads change over time, and how water does with the depth of blocks of this size [m] and density, each with a reason.
pub(super) fn limits(scene: &Scene, block_m: f64, density_kg_m3: f64) -> Vec<(f64, String)> {
    let mut limits = Vec::new();
    let mut tenth =
        |time_s: f64, what: &str| limits.push((time_s / STEPS_OF_LOADS, format!("a tenth of {what}")));
    if scene.gravity_ramp_s > 0.0 {
        tenth(scene.gravity_ramp_s, "gravity_ramp_s");
    }
    let waters = || all(scene, &scene.water, |stage| stage.water.as_ref()).map(|(_, water)| water);
    let tractions = all(scene, &scene.tractions, |stage| stage.tractions.as_ref());
    let forces = all(scene, &scene.forces, |stage| stage.forces.as_ref());
    let rows = tractions.map(|(_, load)| &load.factor).chain(forces.map(|(_, load)| &load.factor));
    let rows = rows.chain(waters().map(|water| &water.factor));
    let gaps = rows.flat_map(|rows| rows.windows(2).map(|pair| pair[1].time_s - pair[0].time_s));
    if let Some(gap_s) = gaps.filter(|gap| *gap > 0.0).reduce(f64::min) {
        tenth(gap_s, "the time between two rows of a load");
    }
    if let Some(rise_s) = scene.blasts.iter().filter_map(|blast| shortest_s(&blast.pressure)).reduce(f64::min)
    {
        tenth(rise_s, "the time in which the pressure of a blast changes");
    }
    // A block that floats: ω² = ρ_w g/(ρ h).
    let water = waters().map(|water| gradient_pa_m(&water.pressure.held(scene.gravity_m_s2)));
    let rate2 = water.fold(0.0, f64::max) / (density_kg_m3 * block_m);
    if rate2 > 0.0 && rate2.is_finite() {
        limits.push((TURN / rate2.sqrt(), "a block that floats oscillates by 0.05 rad in one step".into()));
    }
    limits
}

/// Shortest time in which the pressure of a blast changes [s].
fn shortest_s(pressure: &BlastPressure) -> Option<f64> {
    match pressure {
        BlastPressure::Rows(rows) => {
            rows.windows(2).map(|pair| pair[1].0 - pair[0].0).filter(|gap| *gap > 0.0).reduce(f64::min)
        }
        BlastPressure::Duvall { beta_per_s, .. } => Some(1.0 / beta_per_s),
    }
}

/// Change of a pressure of water over a metre [Pa/m].
fn gradient_pa_m(pressure: &ndda_io::scene::Pressure) -> f64 {
    match pressure {
        ndda_io::scene::Pressure::Linear { gradient_pa_m, .. } => Vec3::from(*gradient_pa_m).norm(),
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use crate::Model;

    fn step_s(more: &str) -> f64 {
        let text = format!(
            "(title: \"loads\", time: (end_s: 30), gravity_m_s2: (0, 0, -9.81),
            materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 900)],
            blocks: [(name: \"raft\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, -0.85))],
            {more})"
        );
        Model::from_text(&text).unwrap().loaded.scene.time.step_s
    }

    #[test]
    fn steps_resolve_blocks_that_float_and_blasts() {
        let water = "water: [(on: Part(block: \"raft\", region: All), pressure: Level(at_m: (0, 0, 0)))]";
        // 0.05 rad of √(9810/900) = 3.30 rad/s.
        assert_eq!(step_s(water), 0.01);
        let blast = "blasts: [(block: \"raft\", on: Part(Set(\"z_min\")), pressure: Duvall(peak_pa: 5e6, alpha_per_s: 400, beta_per_s: 4000))]";
        assert!(step_s(blast) <= 2.5e-5, "{}", step_s(blast));
        assert!(step_s("") > 0.1);
        // A tenth of the time between two rows, at the start and in a stage.
        let rising = "water: [(on: Part(block: \"raft\", region: Set(\"z_min\")), pressure: Linear(pressure_pa: 1e3), factor: [(time_s: 0, factor: 0), (time_s: 1e-3, factor: 1)])]";
        assert!(step_s(rising) <= 1.0001e-4, "{}", step_s(rising));
        let force = "(block: \"raft\", force_n: (1, 0, 0), factor: [(time_s: 0, factor: 0), (time_s: 2e-3, factor: 1)])";
        let staged = format!("stages: [(name: \"push\", forces: [{force}], then: Run(1))]");
        assert!(step_s(&staged) <= 2.0001e-4, "{}", step_s(&staged));
    }
}
