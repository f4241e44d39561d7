//! Whether the mesh and the step resolve the waves that quiet faces let in, shaken bases send, and pressures such as those of blasts.
//!
//! Linear tetrahedra carry a wave of ten nodes a wavelength 1.6 % too fast or too slow, (k h)²/24, and coarser ones far worse (Kuhlemeyer & Lysmer 1973).
//! The wave is judged at the frequency below which 95 % of its energy lies, which goes as the square of its velocity.

mod sources;
mod spectrum;
pub(crate) mod steps;

use std::fmt;

use ndda_fem::quiet::speed_m_s;
use ndda_fem::{Motion, PlaneWave};
use ndda_mesh::{BlockId, Vec3};
use ndda_solver::{BodyKind, Simulation};
use sources::{Source, Way};

use crate::numbers::two_figures_down;

/// Longest element along the way over the wavelength: ten nodes a wavelength.
const MOST_ELEMENT: f64 = 0.1;
/// Longest step over the period: Δt ω = 0.35 makes the period 1 % too long.
const MOST_STEP: f64 = 0.055;

/// How well something resolves waves.
pub(crate) struct Finding {
    /// What is measured.
    pub what: &'static str,
    /// Its value.
    pub value: f64,
    /// The largest one that is right.
    pub limit: f64,
    /// What is wrong where it is larger, and the cure.
    pub reason: String,
}

/// How well the mesh and the step resolve the waves of a scene; empty where there are none, or no elastic blocks.
pub(crate) fn findings(simulation: &Simulation) -> Vec<Finding> {
    let sources = sources::of(simulation);
    let highest_hz = sources.iter().map(|source| source.hz).fold(0.0, f64::max);
    let Some(coarsest) = coarsest(simulation, &sources) else { return Vec::new() };
    let step = highest_hz * simulation.step_s();
    // A step that quiet faces do not bear would be no cure.
    let longest_s = steps::for_quiet_faces(simulation).unwrap_or(f64::INFINITY).min(MOST_STEP / highest_hz);
    let too_long = format!(
        "the time step is too long for the waves, with {:.1} steps per period instead of {:.0} (95 % of the energy is below {highest_hz:.3} Hz): take a step_s of {} or less",
        1.0 / step,
        1.0 / MOST_STEP,
        two_figures_down(longest_s)
    );
    let (value, reason) = (coarsest.part(), coarsest.to_string());
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
    /// What else helps.
    cure: &'static str,
}

impl Coarsest {
    fn part(&self) -> f64 {
        self.element_m / self.wavelength_m
    }
}

impl fmt::Display for Coarsest {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { block, hz, wavelength_m, element_m, cure } = self;
        write!(
            f,
            "the mesh of block `{block}` is too coarse for its waves, with {:.1} nodes per wavelength instead of {:.0} (95 % of the energy is below {hz:.3} Hz, \
             wavelength {wavelength_m:.3} m, elements up to {element_m:.3} m along the direction of travel): take elements of {:.3} m, or {cure}",
            wavelength_m / element_m,
            1.0 / MOST_ELEMENT,
            MOST_ELEMENT * wavelength_m
        )
    }
}

/// The wave and the block of the fewest nodes a wavelength among elastic blocks; none where there are no waves. Blocks that do not carry
/// a wave of this polarisation are left out.
fn coarsest(simulation: &Simulation, sources: &[Source]) -> Option<Coarsest> {
    let mut worst: Option<Coarsest> = None;
    for &Source { hz, way, cure } in sources {
        for block in simulation.blocks().ids() {
            if simulation.shape(block).kind != BodyKind::Elastic {
                continue;
            }
            let Some((speed_m_s, element_m)) = slowest(simulation, block, &way) else { continue };
            let name = simulation.blocks().names[block.index()].clone();
            let found = Coarsest { block: name, hz, wavelength_m: speed_m_s / hz, element_m, cure };
            if worst.as_ref().is_none_or(|worst| found.part() > worst.part()) {
                worst = Some(found);
            }
        }
    }
    worst
}

/// Speed of a wave in a block [m/s] and the longest extent of an element on its way [m], where an element takes it longest to cross; none where the
/// block does not carry it.
fn slowest(simulation: &Simulation, block: BlockId, way: &Way) -> Option<(f64, f64)> {
    let (blocks, material) = (simulation.blocks(), simulation.shape(block).material.as_ref());
    let speed = |along: Vec3, moves: Vec3| {
        let motion = Motion::Rows(Vec::new());
        speed_m_s(material, &PlaneWave { motion, along, from: Vec3::zeros(), moves }).ok()
    };
    let corners = blocks.tets_of(block).map(|tet| blocks.tets[tet].map(|n| blocks.rest_position[n.index()]));
    match way {
        Way::Plane { along, moves } => {
            let longest_m = corners.map(|corners| extent_m(&corners, along)).fold(0.0, f64::max);
            Some((speed(*along, *moves)?, longest_m))
        }
        Way::From(place) => {
            let of_element = |corners: [Vec3; 4]| {
                let along = (corners.iter().sum::<Vec3>() / 4.0 - place).try_normalize(0.0)?;
                Some((speed(along, along)?, extent_m(&corners, &along)))
            };
            corners.filter_map(of_element).max_by(|a, b| (a.1 / a.0).total_cmp(&(b.1 / b.0)))
        }
    }
}

/// Extent of an element along a direction [m].
fn extent_m(corners: &[Vec3; 4], along: &Vec3) -> f64 {
    let places = corners.map(|x| x.dot(along));
    places.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b))
        - places.iter().fold(f64::INFINITY, |a, b| a.min(*b))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    #[test]
    fn elements_and_steps_are_measured_by_the_wave_that_arrives() {
        let quiet = format!(
            r#"blocks: [{COLUMN}], quiet: [(block: "column", on: Set("z_min"), incident: [(wave: S((1, 0, 0)), record: (file: "burst.csv"))])]"#
        );
        let found = |cells: u32| on_foot(cells, &quiet);
        // c_s = 2000 m/s: 40 m at 50 Hz, of which elements of 10 and 2 m are 0.25 and 0.05; a step of 1 ms is 0.05 of the period.
        let (coarse, fine) = (found(10), found(50));
        assert!((coarse[0].value / 0.25 - 1.0).abs() < 0.1, "{}", coarse[0].reason);
        assert!(coarse[0].value > coarse[0].limit && fine[0].value < fine[0].limit, "{}", fine[0].reason);
        assert!((fine[1].value / 0.05 - 1.0).abs() < 0.1, "{}", fine[1].reason);
    }

    /// Findings on a column of 100 m in so many cells, on a foot that a scene describes and that may follow a burst at 50 Hz.
    fn on_foot(cells: u32, foot: &str) -> Vec<Finding> {
        let folder = tempfile::tempdir().unwrap();
        let rows: String = (0..=400)
            .map(|i| f64::from(i) * 1e-3)
            .map(|t| format!("{t},{}\n", (TAU * 50.0 * t).cos()))
            .collect();
        std::fs::write(folder.path().join("burst.csv"), format!("time_s,acceleration_m_s2\n{rows}")).unwrap();
        let text = format!(
            r#"(title: "A column", time: (step_s: 1e-3, end_s: 1e-2),
                materials: [(name: "rock", density_kg_m3: 2500, young_pa: 25e9, poisson: 0.25)],
                {})"#,
            foot.replace("CELLS", &cells.to_string())
        );
        std::fs::write(folder.path().join("scene.ron"), text).unwrap();
        findings(&crate::Model::open(&folder.path().join("scene.ron"), &[]).unwrap().simulation)
    }

    const COLUMN: &str =
        r#"(name: "column", material: "rock", shape: Box(size_m: (1, 1, 100), cells: (1, 1, CELLS)))"#;

    #[test]
    fn waves_of_shaken_bases_are_judged_as_those_that_arrive() {
        let record = r#"Shaking([(direction: (DIRECTION), record: (file: "burst.csv"))])"#;
        let held =
            format!(r#"blocks: [{COLUMN}], supports: [(block: "column", on: Set("z_min"), hold: {record})]"#);
        let table = format!(
            r#"blocks: [{COLUMN}, (name: "table", material: "rock", body: Fixed, at_m: (0, 0, -1), shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
               supports: [(block: "table", on: All, hold: {record})], contact: Potential(penalty_pa: 1e9)"#
        );
        // c_s = 2000 m/s and c_p = 3464 m/s: 40 and 69.28 m at 50 Hz.
        for foot in [held, table] {
            for (direction, wavelength_m) in [("1, 0, 0", 40.0), ("0, 0, 1", 69.28)] {
                let foot = foot.replace("DIRECTION", direction);
                let (coarse, fine) = (on_foot(10, &foot), on_foot(50, &foot));
                assert!((coarse[0].value * wavelength_m / 10.0 - 1.0).abs() < 0.1, "{}", coarse[0].reason);
                assert!(
                    coarse[0].value > coarse[0].limit && fine[0].value < fine[0].limit,
                    "{}",
                    fine[0].reason
                );
                assert!((fine[1].value / 0.05 - 1.0).abs() < 0.1, "{}", fine[1].reason);
            }
        }
        let slow = format!(
            r#"blocks: [{COLUMN}], supports: [(block: "column", on: Set("z_min"), hold: Motion([(time_s: 0, displacement_m: (0, 0, 0)), (time_s: 1e-3, displacement_m: (0, 0, 1e-3))]))]"#
        );
        assert!(on_foot(10, &slow).is_empty(), "a table of displacements is not a record");
    }

    /// A triangle of 2 T = 20 ms has 95 % of its energy below 0.5004/T = 50.04 Hz.
    #[test]
    fn waves_of_blasts_are_judged_from_a_plane_and_from_a_hole() {
        let blast = |on: &str| {
            format!(
                r#"blocks: [{COLUMN}], blasts: [(block: "column", on: {on}, pressure: Rows([(0, 0), (0.01, 1e6), (0.02, 0)]))]"#
            )
        };
        // From the foot the way is along the column; from its whole surface it is to all sides of its middle, nearly the same for elements far off.
        for on in [r#"Part(Set("z_min"))"#, "Part(All)"] {
            let (coarse, fine) = (on_foot(10, &blast(on)), on_foot(50, &blast(on)));
            assert!((coarse[0].value * 69.23 / 10.0 - 1.0).abs() < 0.1, "{}", coarse[0].reason);
            assert!(coarse[0].value > coarse[0].limit && fine[0].value < fine[0].limit, "{}", fine[0].reason);
            assert!(coarse[0].reason.contains("more slowly"), "{}", coarse[0].reason);
        }
    }
}
