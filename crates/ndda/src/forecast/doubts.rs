//! Parts of a scene that are probably not meant: no error, and worth a question before a long run.

use std::path::Path;

use ndda_io::scene::{Contact, Friction, Material, Potential, Scene};
use ndda_solver::BodyKind;
use ndda_solver::Simulation;

use super::ground_stress;
use super::idle;
use super::points;
use super::step::Advice;
use crate::bolt_report::BoltReports;
use crate::build;
use crate::choose;
use crate::lean;
use crate::rocking::{self, Rocking};
use crate::waves;

/// Penalties over Young's modulus, for a potential of 1 m, outside of which contact is deep or requires short steps.
const SOFT: f64 = 1e-6;
const HARD: f64 = 1.0;
/// Young's modulus below which no rock has one [Pa].
const SOFTEST_PA: f64 = 1e6;
/// Overlap at rest over the size of blocks from which on it is a doubt.
pub const DEEP: f64 = 0.05;

/// Doubts about a scene whose files are in `folder`; `advice` is the forecast of its contact, `rocking` that of [`rocking::worst`].
pub fn doubts(
    scene: &Scene,
    simulation: &Simulation,
    advice: Option<&Advice>,
    rocking: Option<&Rocking>,
    folder: &Path,
) -> Vec<String> {
    let unstable = advice.filter(|advice| advice.worst().h > advice.bound).map(ToString::to_string);
    let mut doubts: Vec<String> = unstable.into_iter().collect();
    let coarse = waves::findings(simulation).into_iter().filter(|found| found.value > found.limit);
    doubts.extend(coarse.map(|found| found.reason));
    let let_in = waves::steps::through_quiet_faces(simulation).filter(|found| found.value > found.limit);
    doubts.extend(let_in.map(|found| found.reason));
    doubts.extend(BoltReports::new(simulation).doubts(|name| build::bolts::entry(scene, name)));
    doubts.extend(idle::findings(scene, simulation.blocks(), folder));
    doubts.extend(points::findings(scene, simulation.blocks()));
    doubts.extend(ground_stress::finding(scene, simulation));
    let falls = scene.gravity_m_s2 != [0.0; 3];
    doubts.extend(ramp(scene).filter(|_| falls));
    let Some(Contact::Potential { penalty_pa, potential, .. }) = &scene.contact else { return doubts };
    if falls && !has_friction(scene) {
        doubts.push(
            "contact has no friction, so blocks slide freely on each other: give contact.friction: (friction_deg: 30) if that is not meant".into(),
        );
    }
    let touch = advice.is_some_and(|advice| advice.at_start.is_some());
    if falls && scene.settle.is_some() && !touch {
        doubts.push(
            "no blocks touch at the start, so they fall while the scene settles: move them together".into(),
        );
    }
    let depth = depth(scene, simulation).map(|(_, words)| words);
    let lean = lean::worst(scene, simulation);
    // Of two penalties that are too small only the larger one is a cure.
    let enough_pa = choose::resting(scene, simulation.blocks()).map_or(0.0, |resting| resting.penalty_pa);
    let leans_more = lean.as_ref().is_some_and(|lean| lean.penalty_pa > enough_pa);
    doubts.extend(lean.filter(|_| leans_more || depth.is_none()).map(|lean| lean.to_string()));
    doubts.extend(rocking.filter(|rocking| rocking.is_doubtful()).map(Rocking::to_string));
    // The depth of contact at rest says more than the ratio of two stiffnesses.
    let depth = depth.or_else(|| penalty(scene, simulation, *penalty_pa, potential));
    doubts.extend(depth.filter(|_| !leans_more));
    doubts
}

/// Whether the run ends before gravity has grown to what it is to be.
fn ramp(scene: &Scene) -> Option<String> {
    let (ramp_s, end_s) = (scene.gravity_ramp_s, scene.time.end_s);
    (scene.stages.is_empty() && scene.settle.is_none() && ramp_s > end_s).then(|| {
        format!(
            "the run ends at {end_s} s with {:.0} % of gravity, which grows until gravity_ramp_s = {ramp_s} s: raise time.end_s, or shorten the ramp",
            100.0 * end_s / ramp_s
        )
    })
}

/// Whether the weight of the rock presses blocks far into each other: by what part of their size, and in words.
pub fn depth(scene: &Scene, simulation: &Simulation) -> Option<(f64, String)> {
    let resting = choose::resting(scene, simulation.blocks())?;
    (resting.overlap > DEEP).then(|| {
        let words = format!(
            "blocks overlap by up to {:.0} % of their size at rest under {}, and may sink through each other: give a penalty_pa of {:.0e}, or leave it out",
            100.0 * resting.overlap,
            resting.under,
            resting.penalty_pa
        );
        (resting.overlap, words)
    })
}

/// Whether some contacts of a scene have friction.
pub fn has_friction(scene: &Scene) -> bool {
    let Some(Contact::Potential { friction, material_pairs, rock_joints, .. }) = &scene.contact else {
        return false;
    };
    let is_given = |friction: &Option<Friction>| friction.is_some();
    is_given(friction)
        || material_pairs.iter().any(|pair| is_given(&pair.friction))
        || rock_joints.iter().any(|joint| is_given(&joint.friction))
}

/// Whether contact is far too soft or too hard for the rock of blocks that move.
fn penalty(scene: &Scene, simulation: &Simulation, penalty_pa: f64, potential: &Potential) -> Option<String> {
    let per_metre_pa = penalty_pa / potential.reference_m()?;
    let deforms = simulation.blocks().ids().any(|block| simulation.shape(block).kind != BodyKind::Fixed);
    let stiffest_pa = scene.materials.iter().map(|material: &Material| material.young_pa).fold(0.0, f64::max);
    let ratio = per_metre_pa / stiffest_pa;
    // Contact of bonded pieces is to be as stiff as their bonds.
    let is_bonded = scene.rock.iter().any(|rock| rock.into.is_some());
    let what = match ratio {
        // A modulus in another unit is told as such.
        _ if !deforms || is_bonded || stiffest_pa < SOFTEST_PA => return None,
        r if r < SOFT => "soft for this rock: blocks sink deep into each other",
        r if r > HARD => "stiff for this rock: steps have to be short, and nothing is gained",
        _ => return None,
    };
    let resting = choose::resting(scene, simulation.blocks());
    let enough_pa = resting.as_ref().map_or(1e-2 * stiffest_pa, |resting| resting.penalty_pa);
    if ratio > HARD && is_too_soft(scene, simulation, enough_pa) {
        return None;
    }
    let advised = match resting {
        Some(resting) => {
            format!("{:.0e} suits this scene; it is chosen if penalty_pa is left out", resting.penalty_pa)
        }
        None => format!("{:.0e} to {:.0e} suits most scenes", 1e-4 * stiffest_pa, 1e-2 * stiffest_pa),
    };
    Some(format!(
        "contact is very {what} (penalty_pa over the reference length is {ratio:.0e} of Young's modulus per metre); a penalty_pa of {advised}"
    ))
}

/// Whether blocks lean or rock by too much with another penalty, or joints take too much of the stress in the ground.
fn is_too_soft(scene: &Scene, simulation: &Simulation, other_pa: f64) -> bool {
    let mut softer = scene.clone();
    if let Some(Contact::Potential { penalty_pa, .. }) = &mut softer.contact {
        *penalty_pa = other_pa;
    }
    lean::worst(&softer, simulation).is_some()
        || ground_stress::is_lost(&softer, simulation)
        || rocking::worst(&softer, simulation).is_some_and(|rocking| rocking.is_doubtful())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Model;

    #[test]
    fn of_two_penalties_that_are_too_small_only_the_larger_cure_is_named() {
        let told = |penalty_pa: &str| {
            let text = format!(
                "(title: \"column\", time: (step_s: 1e-3, end_s: 1), gravity_m_s2: (1.5, 0, -9.81),
                 materials: [(name: \"rock\", young_pa: 2e10, poisson: 0.25, density_kg_m3: 2500)],
                 blocks: [(name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (4, 3, 1), cells: (1, 1, 1)), at_m: (-2, -1, -1)),
                          (name: \"column\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 4), cells: (1, 1, 1)))],
                 contact: Potential(penalty_pa: {penalty_pa}, potential: Smooth(reference_m: 1), friction: (friction_deg: 60)))"
            );
            let model = Model::from_text(&text).unwrap();
            let (scene, simulation) = (&model.loaded.scene, &model.simulation);
            let all = doubts(scene, simulation, None, None, Path::new("."));
            let cures = all.into_iter().filter(|doubt| doubt.contains("penalty_pa")).collect::<Vec<_>>();
            (lean::worst(scene, simulation).is_some(), depth(scene, simulation).is_some(), cures)
        };
        let (leans, is_deep, cures) = told("1");
        assert!(leans && is_deep && cures.len() == 1, "{leans} {is_deep} {cures:?}");
    }

    #[test]
    fn contact_is_not_called_stiff_where_less_would_take_the_stress_in_the_ground() {
        let cures = |penalty_pa: &str, in_situ: &str| {
            let block = |k: u32| {
                format!(
                    "(name: \"b{k}\", material: \"rock\", shape: Box(size_m: (0.5, 0.5, 0.5), cells: (1, 1, 1)), at_m: (0, 0, {}))",
                    0.5 * f64::from(k)
                )
            };
            let text = format!(
                "(title: \"ground\", time: (step_s: 1e-6, end_s: 1e-5), settle: (), {in_situ}
                 materials: [(name: \"rock\", young_pa: 2e10, poisson: 0.25, density_kg_m3: 2500)],
                 blocks: [{}, {}],
                 supports: [(block: \"*\", on: Set(\"z_min\"), hold: Direction((0, 0, 1)))],
                 contact: Potential(penalty_pa: {penalty_pa}, potential: Smooth(reference_m: 1), friction: (friction_deg: 60)))",
                block(0), block(1)
            );
            let model = Model::from_text(&text).unwrap();
            let all = doubts(&model.loaded.scene, &model.simulation, None, None, Path::new("."));
            all.into_iter().filter(|doubt| doubt.contains("penalty_pa")).collect::<Vec<_>>()
        };
        let in_situ = "in_situ: (stress_pa: (zz: -5e6)),";
        let lost = cures("5e10", in_situ);
        assert!(lost.len() == 1 && lost[0].contains("is lost as joints close"), "{lost:?}");
        // With the penalty that was advised nothing is said.
        assert_eq!(cures("1e12", in_situ), Vec::<String>::new());
        assert!(cures("1e12", "")[0].contains("nothing is gained"));
    }
}
