//! Whether the mesh and the step resolve the waves that arrive through quiet faces.
//!
//! Linear tetrahedra carry a wave of ten nodes a wavelength 1.6 % too fast or too slow, (k h)²/24, and coarser ones far worse (Kuhlemeyer & Lysmer 1973).
//! The wave is judged at the frequency below which 95 % of its energy lies, which goes as the square of its velocity.

use std::f64::consts::TAU;
use std::fmt;

use ndda_fem::quiet::speed_m_s;
use ndda_fem::{Motion, PlaneWave};
use ndda_mesh::{BlockId, Vec3};
use ndda_solver::{BodyKind, Simulation};

/// Longest element along the way over the wavelength: ten nodes a wavelength.
const MOST_ELEMENT: f64 = 0.1;
/// Longest step over the period: Δt ω = 0.35 makes the period 1 % too long.
const MOST_STEP: f64 = 0.055;
/// Part of the energy of a wave that lies below the frequency at which it is judged.
const ENERGY: f64 = 0.95;
/// Most samples of a motion.
const MOST_SAMPLES: usize = 1 << 20;

/// How well something resolves waves.
pub(crate) struct Finding {
    /// What is measured.
    pub what: &'static str,
    /// Its value.
    pub value: f64,
    /// The largest one that resolves waves.
    pub limit: f64,
    /// What is wrong where it is larger, and the cure.
    pub reason: String,
}

/// How well the mesh and the step resolve the waves that arrive; empty where none do.
pub(crate) fn findings(simulation: &Simulation) -> Vec<Finding> {
    let waves = waves(simulation);
    let highest_hz = waves.iter().map(|wave| wave.0).fold(0.0, f64::max);
    let Some(coarsest) = coarsest(simulation, &waves) else { return Vec::new() };
    let step = highest_hz * simulation.step_s();
    let too_long = format!(
        "there are {:.1} steps in a period, fewer than {:.0}, of a wave with 95 % of its energy below {highest_hz:.3} Hz: take a step_s of {:.1e} or less",
        1.0 / step,
        1.0 / MOST_STEP,
        MOST_STEP / highest_hz
    );
    let (value, reason) = (coarsest.element_m / coarsest.wavelength_m, coarsest.to_string());
    vec![
        Finding { what: "element / wavelength", value, limit: MOST_ELEMENT, reason },
        Finding { what: "step / period of waves", value: step, limit: MOST_STEP, reason: too_long },
    ]
}

/// The wave that a scene resolves worst.
#[derive(Clone, Debug, PartialEq)]
struct Coarsest {
    /// The block that is too coarse for it.
    block: String,
    /// Frequency below which 95 % of its energy lies [Hz].
    hz: f64,
    /// Its wavelength in the block [m].
    wavelength_m: f64,
    /// Longest extent of an element of the block along its way [m].
    element_m: f64,
}

impl fmt::Display for Coarsest {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { block, hz, wavelength_m, element_m } = self;
        write!(
            f,
            "the mesh of block `{block}` has {:.1} nodes a wavelength, fewer than {:.0}, for a wave with 95 % of its energy below {hz:.3} Hz: its wavelength \
             is {wavelength_m:.3} m, and elements are up to {element_m:.3} m long on its way; take elements of {:.3} m, or filter the record (`filter_hz`)",
            wavelength_m / element_m,
            1.0 / MOST_ELEMENT,
            MOST_ELEMENT * wavelength_m
        )
    }
}

/// The wave and the block of the fewest nodes a wavelength among elastic blocks; none where no waves arrive. Blocks that do not carry
/// a wave of this polarisation are left out.
fn coarsest(simulation: &Simulation, waves: &[(f64, (Vec3, Vec3))]) -> Option<Coarsest> {
    let mut worst: Option<Coarsest> = None;
    for &(hz, (along, moves)) in waves {
        let still = PlaneWave { motion: Motion::Rows(Vec::new()), along, from: Vec3::zeros(), moves };
        for block in simulation.blocks().ids() {
            let shape = simulation.shape(block);
            if shape.kind != BodyKind::Elastic {
                continue;
            }
            let Ok(speed_m_s) = speed_m_s(shape.material.as_ref(), &still) else { continue };
            let (wavelength_m, element_m) = (speed_m_s / hz, longest_m(simulation, block, &along));
            if worst
                .as_ref()
                .is_none_or(|worst| element_m / wavelength_m > worst.element_m / worst.wavelength_m)
            {
                let block = simulation.blocks().names[block.index()].clone();
                worst = Some(Coarsest { block, hz, wavelength_m, element_m });
            }
        }
    }
    worst
}

/// Frequency [Hz] and way of all different waves.
fn waves(simulation: &Simulation) -> Vec<(f64, (Vec3, Vec3))> {
    let mut known: Vec<(&Motion, (Vec3, Vec3))> = Vec::new();
    for block in simulation.blocks().ids() {
        let quiet = &simulation.shape(block).supports.quiet;
        for (motion, way) in quiet.waves.iter().zip(&quiet.ways) {
            if !known.iter().any(|known| known.1 == *way && known.0 == motion) {
                known.push((motion, *way));
            }
        }
    }
    known.into_iter().filter_map(|(motion, way)| Some((highest_hz(motion)?, way))).collect()
}

/// Longest extent of an element along a direction [m].
fn longest_m(simulation: &Simulation, block: BlockId, along: &Vec3) -> f64 {
    let blocks = simulation.blocks();
    let extent_m = |tet: &[ndda_mesh::NodeId; 4]| {
        let places = tet.map(|node| blocks.rest_position[node.index()].dot(along));
        places.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b))
            - places.iter().fold(f64::INFINITY, |a, b| a.min(*b))
    };
    blocks.tets[blocks.tets_of(block)].iter().map(extent_m).fold(0.0, f64::max)
}

/// Frequency below which 95 % of the energy of a motion lies, by the square of its velocity less a straight line between its ends [Hz]; none where
/// nothing moves.
fn highest_hz(motion: &Motion) -> Option<f64> {
    let (start_s, end_s, rows) = motion.extent()?;
    let samples = (2 * rows).max(256).next_power_of_two().min(MOST_SAMPLES);
    let spacing_s = (end_s - start_s) / samples as f64;
    let velocity = |i: usize| motion.velocity(start_s + (i as f64 + 0.5) * spacing_s);
    let (first, last) = (velocity(0), velocity(samples - 1));
    let even: Vec<Vec3> =
        (0..samples).map(|i| velocity(i) - first.lerp(&last, i as f64 / (samples - 1) as f64)).collect();
    // As many zeros behind it keep its end from its start.
    let mut power = vec![0.0; samples];
    for axis in 0..3 {
        let mut real: Vec<f64> = even.iter().map(|v| v[axis]).collect();
        real.resize(2 * samples, 0.0);
        let mut imaginary = vec![0.0; 2 * samples];
        transform(&mut real, &mut imaginary);
        power.iter_mut().enumerate().for_each(|(k, power)| *power += real[k].powi(2) + imaginary[k].powi(2));
    }
    let total: f64 = power.iter().sum();
    let mut below = 0.0;
    let place = power.iter().position(|power| {
        below += power;
        below >= ENERGY * total
    })?;
    (total > 0.0 && total.is_finite()).then(|| place.max(1) as f64 / (2.0 * (end_s - start_s)))
}

/// The discrete Fourier transform of a power of two of values, in place (Cooley & Tukey 1965).
fn transform(real: &mut [f64], imaginary: &mut [f64]) {
    let n = real.len();
    let bits = n.trailing_zeros();
    for i in 0..n {
        let j = i.reverse_bits() >> (usize::BITS - bits);
        if i < j {
            real.swap(i, j);
            imaginary.swap(i, j);
        }
    }
    let mut half = 1;
    while half < n {
        for k in 0..half {
            let (sin, cos) = (-TAU * k as f64 / (2 * half) as f64).sin_cos();
            for i in (k..n).step_by(2 * half) {
                let j = i + half;
                let (re, im) = (cos * real[j] - sin * imaginary[j], cos * imaginary[j] + sin * real[j]);
                (real[j], imaginary[j]) = (real[i] - re, imaginary[i] - im);
                (real[i], imaginary[i]) = (real[i] + re, imaginary[i] + im);
            }
        }
        half *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndda_fem::Record;

    #[test]
    fn a_long_burst_has_its_energy_at_its_frequency_and_a_gaussian_where_its_integral_says() {
        let rows =
            |a: &dyn Fn(f64) -> f64| (0..=4000).map(|i| f64::from(i) * 1e-3).map(|t| (t, a(t))).collect();
        let of = |rows: Vec<(f64, f64)>| highest_hz(&Motion::Record(Record::new(Vec3::x(), &rows))).unwrap();
        let burst = of(rows(&|t| (TAU * 10.0 * t).cos()));
        assert!((burst / 10.0 - 1.0).abs() < 0.05, "{burst}");
        // v = exp(−½ (t/σ)²), |V|² = exp(−(ω σ)²): 95 % below ω σ = 1.3859, where erf is 0.95.
        let sigma_s = 0.05;
        let gaussian = of(rows(&|t| {
            let u = (t - 2.0) / sigma_s;
            -u / sigma_s * (-0.5 * u * u).exp()
        }));
        let exact = 1.3859 / (TAU * sigma_s);
        assert!((gaussian / exact - 1.0).abs() < 0.05, "{gaussian} {exact}");
        assert_eq!(highest_hz(&Motion::Record(Record::new(Vec3::x(), &[(0.0, 0.0), (1.0, 0.0)]))), None);
    }

    #[test]
    fn elements_and_steps_are_measured_by_the_wave_that_arrives() {
        let folder = tempfile::tempdir().unwrap();
        let rows: String = (0..=400)
            .map(|i| f64::from(i) * 1e-3)
            .map(|t| format!("{t},{}\n", (TAU * 50.0 * t).cos()))
            .collect();
        std::fs::write(folder.path().join("burst.csv"), format!("time_s,acceleration_m_s2\n{rows}")).unwrap();
        let found = |cells: u32| {
            let text = format!(
                r#"(title: "A column", time: (step_s: 1e-3, end_s: 1e-2),
                    materials: [(name: "rock", density_kg_m3: 2500, young_pa: 25e9, poisson: 0.25)],
                    blocks: [(name: "column", material: "rock", shape: Box(size_m: (1, 1, 100), cells: (1, 1, {cells})))],
                    quiet: [(block: "column", on: Set("z_min"), incident: [(wave: S((1, 0, 0)), record: (file: "burst.csv"))])])"#
            );
            std::fs::write(folder.path().join("scene.ron"), text).unwrap();
            let model = crate::Model::open(&folder.path().join("scene.ron"), &[]).unwrap();
            findings(&model.simulation)
        };
        // c_s = 2000 m/s: 40 m at 50 Hz, of which elements of 10 and 2 m are 0.25 and 0.05; a step of 1 ms is 0.05 of the period.
        let (coarse, fine) = (found(10), found(50));
        assert!((coarse[0].value / 0.25 - 1.0).abs() < 0.1, "{}", coarse[0].reason);
        assert!(coarse[0].value > coarse[0].limit && fine[0].value < fine[0].limit, "{}", fine[0].reason);
        assert!((fine[1].value / 0.05 - 1.0).abs() < 0.1, "{}", fine[1].reason);
    }
}
