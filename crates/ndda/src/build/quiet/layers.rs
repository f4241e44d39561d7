//! Level ground of layers: plane waves that go straight up and down in each, are reflected at its borders and by the ground, and so make the motion of the free
//! field (Haskell 1953; Kramer 1996, chapter 7).

use ndda_io::record;

use super::refuse_too_many;

/// Fewest steps in which a wave goes through a layer.
const FEWEST_STEPS: u32 = 20;
/// Steps of the march in a spacing of the record, at least: a peak of one row loses a sixteenth at most.
const STEPS_PER_ROW: f64 = 8.0;
/// How many lengths of the step are tried, to find one that fits all layers.
const TRIALS: u32 = 60;

/// A layer, for waves of one kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Layer {
    /// ρ c [Pa s/m].
    pub impedance: f64,
    /// Time in which a wave goes through it [s]; through the lowest, from where the record is to its upper border.
    pub travel_s: f64,
}

/// Waves in a layer: accelerations [m/s²] at times [s].
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Waves {
    /// That goes up, at the lower border; in the lowest layer where the record is.
    pub up: Vec<(f64, f64)>,
    /// That goes down, at the upper border.
    pub down: Vec<(f64, f64)>,
}

/// The waves in layers, from the lowest on, when a record arrives in the lowest one; until a time [s].
///
/// At a border, a velocity that arrives from a layer of impedance z goes on with 2z/(z + z′) and comes back with (z − z′)/(z + z′); the ground sends all of it back.
/// Times in which waves go through layers are whole numbers of steps, as near as steps of some length allow.
///
/// # Errors
/// That so short a step has too many rows.
pub(super) fn waves(layers: &[Layer], rows: &[(f64, f64)], until_s: f64) -> Result<Vec<Waves>, String> {
    let spacing_s = rows.windows(2).map(|pair| pair[1].0 - pair[0].0).fold(f64::INFINITY, f64::min);
    let step_s = step_s(layers, spacing_s);
    let steps: Vec<usize> = layers.iter().map(|layer| (layer.travel_s / step_s).round() as usize).collect();
    let start_s = rows[0].0;
    refuse_too_many(until_s.max(rows[rows.len() - 1].0) - start_s, step_s).map_err(|message| {
        format!("following its wave through the layers {message}, or leave thin layers out")
    })?;
    let arriving = record::resampled(rows, step_s);
    let count = (((until_s - start_s) / step_s).ceil().max(0.0) as usize).max(arriving.len());
    let last = layers.len() - 1;
    let (mut up, mut down) = (vec![vec![0.0; count]; layers.len()], vec![vec![0.0; count]; layers.len()]);
    for i in 0..count {
        up[0][i] = arriving.get(i).map_or(0.0, |row| row.1);
        let before = |wave: &[f64], steps: usize| i.checked_sub(steps).map_or(0.0, |k| wave[k]);
        for k in 0..last {
            let (rising, sinking) = (before(&up[k], steps[k]), before(&down[k + 1], steps[k + 1]));
            let (z, above) = (layers[k].impedance, layers[k + 1].impedance);
            let back = (z - above) / (z + above);
            up[k + 1][i] = (1.0 + back) * rising - back * sinking;
            down[k][i] = back * rising + (1.0 - back) * sinking;
        }
        down[last][i] = before(&up[last], steps[last]);
    }
    // No finer than the record needs.
    let every = (spacing_s / (STEPS_PER_ROW * step_s)).floor().max(1.0) as usize;
    let kept = |wave: &[f64]| -> Vec<(f64, f64)> {
        let row = |(i, a): (usize, &f64)| (start_s + i as f64 * step_s, *a);
        wave.iter().enumerate().step_by(every).map(row).collect()
    };
    Ok(up.iter().zip(&down).map(|(up, down)| Waves { up: kept(up), down: kept(down) }).collect())
}

/// A step of which all layers above the lowest, and the way to its upper border, are nearly whole numbers.
fn step_s(layers: &[Layer], spacing_s: f64) -> f64 {
    let times = || layers.iter().map(|layer| layer.travel_s).filter(|time_s| *time_s > 0.0);
    let shortest_s = layers[1..].iter().map(|layer| layer.travel_s).fold(f64::INFINITY, f64::min);
    let shortest_s = if shortest_s.is_finite() { shortest_s } else { times().fold(spacing_s, f64::max) };
    let fewest = ((shortest_s / spacing_s * STEPS_PER_ROW).ceil() as u32).max(FEWEST_STEPS);
    let missed = |step_s: f64| -> f64 {
        times().map(|time_s| (time_s / step_s - (time_s / step_s).round()).abs() * step_s).sum()
    };
    let trials = (fewest..fewest + TRIALS).map(|parts| shortest_s / f64::from(parts));
    let better = |a: (f64, f64), b: (f64, f64)| if b.1 < 0.999 * a.1 { b } else { a };
    trials.map(|step_s| (step_s, missed(step_s))).reduce(better).map_or(spacing_s, |(step_s, _)| step_s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Two layers on rock.
    const LAYERS: [Layer; 3] = [
        Layer { impedance: 4.6e6, travel_s: 0.013 },
        Layer { impedance: 1.2e6, travel_s: 0.0317 },
        Layer { impedance: 0.35e6, travel_s: 0.0401 },
    ];

    /// Motion of the ground over that of the wave that arrives, by Haskell's matrices: with k h = ω τ and displacements u = A e^{ik(z−h)} + A e^{−ik(z−h)} below
    /// the ground, 1/(cos a cos b − β sin a sin b + i α (…)) of twice the wave.
    fn amplification(hz: f64) -> f64 {
        let w = TAU * hz;
        let [rock, deep, top] = LAYERS;
        let (a, b) = (w * top.travel_s, w * deep.travel_s);
        let (to_deep, to_rock) = (top.impedance / deep.impedance, deep.impedance / rock.impedance);
        // Displacement and stress over z ω of the layer at its lower border, over the displacement of the ground.
        let (u1, s1) = (a.cos(), to_deep * a.sin());
        let (u2, s2) = (u1 * b.cos() - s1 * b.sin(), u1 * b.sin() + s1 * b.cos());
        // In rock u = up + down and i (up − down) are known: up = ½ (u₂ + i z s₂).
        let up = 0.5 * u2.hypot(to_rock * s2);
        1.0 / up
    }

    #[test]
    fn two_layers_amplify_a_sine_as_the_closed_form_says() {
        for hz in [1.0, 3.7, 5.2, 8.0, 13.0] {
            let rows: Vec<(f64, f64)> = (0..=20_000)
                .map(|i| f64::from(i) * 5e-4)
                .map(|t| (t, (TAU * hz * t).sin() * (t / 2.0).min(1.0)))
                .collect();
            let found = waves(&LAYERS, &rows, 10.0).unwrap();
            // The ground moves twice as much as the wave that it sends back; after seconds the start is forgotten.
            let late = found[2].down.iter().filter(|(t, _)| (8.0..10.0).contains(t));
            let largest = late.map(|(_, a)| 2.0 * a.abs()).fold(0.0, f64::max);
            let exact = amplification(hz);
            assert!((largest / exact - 1.0).abs() < 5e-3, "{hz} Hz: {largest} for {exact}");
        }
    }

    #[test]
    fn a_record_that_would_have_too_many_rows_in_layers_is_refused() {
        let message = waves(&LAYERS, &[(0.0, 0.0), (1e-9, 1.0), (60.0, 0.0)], 1.0).unwrap_err();
        assert!(message.contains("limit 10000000") && message.contains("thin layers"), "{message}");
    }

    #[test]
    fn equal_layers_let_a_wave_through_and_the_ground_sends_it_back() {
        let layer = |travel_s: f64| Layer { impedance: 1e6, travel_s };
        let rows = [(0.0, 0.0), (0.01, 1.0), (0.02, 0.0)];
        let found = waves(&[layer(0.02), layer(0.05), layer(0.03)], &rows, 0.3).unwrap();
        let peak = |wave: &[(f64, f64)]| wave.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        for (wave, time_s) in [
            (&found[0].up, 0.01),
            (&found[1].up, 0.03),
            (&found[2].up, 0.08),
            (&found[2].down, 0.11),
            (&found[1].down, 0.14),
            (&found[0].down, 0.19),
        ] {
            let (at_s, largest) = peak(wave);
            assert!((at_s - time_s).abs() < 1e-3 && (largest - 1.0).abs() < 0.07, "{at_s} {largest}");
        }
        assert!(found[0].up.last().unwrap().0 > 0.29);
    }
}
