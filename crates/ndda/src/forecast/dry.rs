//! Water that presses on no face where blocks are at the start: its level or its field leaves all faces dry that a scene calls wet. Blocks that move may come into it later.

use ndda_io::code::Code;
use ndda_io::diagnostic::{Diagnostic, Severity};
use ndda_io::read::LoadedScene;
use ndda_io::scene::{LinearPressure, Pressure, Scene, Water};
use ndda_mesh::Vec3;
use ndda_solver::{BodyKind, Simulation};

use crate::build::water;

/// Warnings of water that presses on nothing, in a scene and its stages, at their places in the scene.
pub fn warnings(loaded: &LoadedScene, simulation: &Simulation) -> Vec<Diagnostic> {
    let scene = &loaded.scene;
    let mut found = of_list(&scene.water, "", scene, simulation);
    for (i, stage) in scene.stages.iter().enumerate() {
        found.extend(of_list(stage.water.iter().flatten(), &format!("stages[{i}]."), scene, simulation));
    }
    let warning = |(path, message, cure): (String, String, String)| {
        let found = loaded.diagnose_as(Code::NoEffect, &path, message).with_help(cure);
        Diagnostic { severity: Severity::Warning, ..found }
    };
    found.into_iter().map(warning).collect()
}

/// Path, message and cure.
type Found = (String, String, String);

fn of_list<'a>(
    list: impl IntoIterator<Item = &'a Water>,
    before: &str,
    scene: &Scene,
    simulation: &Simulation,
) -> Vec<Found> {
    let blocks = simulation.blocks();
    let dry = |(i, water): (usize, &Water)| {
        let places = water::wet_places(blocks, &water.on)?;
        let stay = water::wet_blocks(blocks, &water.on).all(|b| simulation.shape(b).kind == BodyKind::Fixed);
        let (message, cure) = if_dry(&water.pressure, scene.gravity_m_s2, (&places, !stay))?;
        Some((format!("{before}water[{i}].pressure"), message, cure))
    };
    list.into_iter().enumerate().filter_map(dry).collect()
}

/// What is said of a pressure that is nowhere above zero on the faces with these corners, of blocks that may move or do not.
fn if_dry(
    pressure: &Pressure,
    gravity_m_s2: [f64; 3],
    (places, may_move): (&[Vec3], bool),
) -> Option<(String, String)> {
    let value = |pressure_pa: f64, at_m: [f64; 3], gradient: [f64; 3], place: &Vec3| {
        pressure_pa + Vec3::from(gradient).dot(&(place - Vec3::from(at_m)))
    };
    let is_dry = |f: &LinearPressure| {
        places.iter().all(|place| value(f.pressure_pa, f.at_m, f.gradient_pa_m, place) <= 0.0)
    };
    match pressure {
        pressure if is_none(pressure) => None,
        Pressure::Level { at_m, .. } => above_level(*at_m, Vec3::from(gravity_m_s2), (places, may_move)),
        Pressure::Linear { pressure_pa, at_m, gradient_pa_m } => {
            let field =
                LinearPressure { pressure_pa: *pressure_pa, at_m: *at_m, gradient_pa_m: *gradient_pa_m };
            is_dry(&field).then(|| nowhere(may_move))
        }
        // The least of all is not above any of them.
        Pressure::Least(fields) => fields.iter().any(is_dry).then(|| nowhere(may_move)),
        Pressure::Points { along, at_m, rows } => {
            let along = Vec3::from(*along).normalize();
            let distances = places.iter().map(|place| along.dot(&(place - Vec3::from(*at_m))));
            let (from, to) =
                distances.fold((f64::INFINITY, f64::NEG_INFINITY), |(from, to), d| (from.min(d), to.max(d)));
            is_zero_between(rows, from, to).then(|| nowhere(may_move))
        }
    }
}

/// Whether a pressure is written as none, as one that is varied may be.
fn is_none(pressure: &Pressure) -> bool {
    match pressure {
        Pressure::Linear { pressure_pa, gradient_pa_m, .. } => {
            *pressure_pa == 0.0 && *gradient_pa_m == [0.0; 3]
        }
        Pressure::Points { rows, .. } => rows.iter().all(|row| row.1 == 0.0),
        _ => false,
    }
}

/// What is said where all faces are above a level.
fn above_level(
    at_m: [f64; 3],
    gravity: Vec3,
    (places, may_move): (&[Vec3], bool),
) -> Option<(String, String)> {
    let down = gravity.try_normalize(0.0)?;
    let deep = |place: &Vec3| down.dot(&(place - Vec3::from(at_m)));
    let lowest = places.iter().max_by(|a, b| deep(a).total_cmp(&deep(b)))?;
    let above_m = -deep(lowest);
    (above_m > 0.0).then(|| {
        let place = lowest.map(|x| (1e6 * x).round() / 1e6 + 0.0);
        (
            format!(
                "no wet face lies below the level{}: the lowest point of them, at ({}, {}, {}), is {above_m:.4} m above it",
                without_effect(may_move), place.x, place.y, place.z
            ),
            format!(
                "give at_m a place on the water table above that point, in the coordinates of the scene{}",
                otherwise(may_move)
            ),
        )
    })
}

fn nowhere(may_move: bool) -> (String, String) {
    (
        format!("is nowhere above 0 Pa on the wet faces{}", without_effect(may_move)),
        format!(
            "correct its at_m or the sign of its gradient or direction; pressure grows along gradient_pa_m, and distances along `along`{}",
            otherwise(may_move)
        ),
    )
}

/// What dry faces mean, of blocks that may move into the water or do not.
fn without_effect(may_move: bool) -> &'static str {
    match may_move {
        true => " at the start, so this water has no effect until blocks move into it",
        false => ", so this water has no effect",
    }
}

/// What else may be meant.
fn otherwise(may_move: bool) -> &'static str {
    match may_move {
        true => ", unless blocks are to come into it only later",
        false => "; or leave the water out",
    }
}

/// Whether a table is zero from one distance to another.
fn is_zero_between(rows: &[(f64, f64)], from: f64, to: f64) -> bool {
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else { return false };
    let is_wet = |two: &[(f64, f64)]| two[1].0 > from && two[0].0 < to && (two[0].1 > 0.0 || two[1].1 > 0.0);
    let before = from <= first.0 && first.1 > 0.0;
    let beyond = to >= last.0 && last.1 > 0.0;
    !before && !beyond && !rows.windows(2).any(is_wet)
}

#[cfg(test)]
mod tests {
    use crate::Model;

    /// The warning of water on the lower face of a cube from 0 to 1 m.
    fn told(pressure: &str) -> Option<String> {
        told_of("Elastic", pressure)
    }

    fn told_of(body: &str, pressure: &str) -> Option<String> {
        let text = format!(
            "(title: \"wet\", time: (step_s: 1e-4, end_s: 1e-3), gravity_m_s2: (0, 0, -9.81),
            materials: [(name: \"rock\", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
            blocks: [(name: \"b\", material: \"rock\", body: {body}, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (5, 0, 0))],
            water: [(on: Part(block: \"b\", region: Set(\"z_min\")), pressure: {pressure})])"
        );
        let warnings = Model::from_text(&text).unwrap().loaded.warnings;
        let mut found = warnings.into_iter().filter(|warning| warning.path == "water[0].pressure");
        found.next().map(|warning| format!("{}: {}: {:?}", warning.code, warning.message, warning.help))
    }

    #[test]
    fn water_whose_level_lies_below_all_wet_faces_is_warned_of() {
        let deep = told("Level(at_m: (0, 0, -100))").unwrap();
        assert!(deep.starts_with("no-effect: no wet face lies below the level"), "{deep}");
        assert!(deep.contains("0), is 100.0000 m above it"), "{deep}");
        assert!(
            deep.contains("at the start") && !deep.contains("leave the water out"),
            "it may fall: {deep}"
        );
        let held = told_of("Fixed", "Level(at_m: (0, 0, -100))").unwrap();
        assert!(!held.contains("at the start") && held.contains("leave the water out"), "{held}");
        assert_eq!(told("Level(at_m: (0, 0, 1e-3))"), None);
        assert_eq!(told("Level(at_m: (0, 0, 0))"), None, "a level at the face is meant to leave it dry");
    }

    #[test]
    fn pressures_that_are_nowhere_above_zero_are_warned_of() {
        for (pressure, is_dry) in [
            ("Linear(pressure_pa: 0, at_m: (0, 0, 5), gradient_pa_m: (0, 0, 9810))", true),
            ("Linear(pressure_pa: 0, at_m: (0, 0, 5), gradient_pa_m: (0, 0, -9810))", false),
            (
                "Least([(pressure_pa: 1e5), (pressure_pa: 0, at_m: (0, 0, 5), gradient_pa_m: (0, 0, 9810))])",
                true,
            ),
            ("Least([(pressure_pa: 1e5), (pressure_pa: 2e5)])", false),
            ("Linear(pressure_pa: 0)", false),
            ("Points(along: (1, 0, 0), rows: [(0, 1e5), (5, 0)])", true),
            ("Points(along: (1, 0, 0), rows: [(0, 1e5), (5.5, 0)])", false),
            ("Points(along: (1, 0, 0), rows: [(5.2, 0), (5.3, 1e5), (5.4, 0)])", false),
            ("Points(along: (-1, 0, 0), rows: [(0, 0), (1, 1e5)])", true),
        ] {
            assert_eq!(told(pressure).is_some(), is_dry, "{pressure}");
        }
    }
}
