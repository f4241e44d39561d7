//! Parts of a scene that do nothing: loads and supports of blocks that are not there, motions, blasts and records beyond the run, and records with gaps.

use std::path::Path;

use ndda_io::record::{Gap, Prepared};
use ndda_io::scene::{Hold, Record, Scene, Stage, matches};
use ndda_mesh::BlockSet;

use crate::build;
use crate::build::presence::Presence;

/// Part of a record's peak that is worth a word when the run ends before it.
const MATTERS: f64 = 0.01;

/// What does nothing, in words.
pub fn findings(scene: &Scene, blocks: &BlockSet, folder: &Path) -> Vec<String> {
    let mut found = absent(scene, blocks);
    found.extend(too_late(scene));
    found.extend(records(scene, folder));
    found
}

/// Blocks that supports, tractions and forces name, list by list.
type Lists<'a> = [(&'static str, Option<Vec<&'a str>>); 3];

fn lists_of_scene(scene: &Scene) -> Lists<'_> {
    [
        ("supports", Some(scene.supports.iter().map(|support| support.block.as_str()).collect())),
        ("tractions", Some(scene.tractions.iter().map(|traction| traction.block.as_str()).collect())),
        ("forces", Some(scene.forces.iter().map(|force| force.block.as_str()).collect())),
    ]
}

fn lists_of_stage(stage: &Stage) -> Lists<'_> {
    let Stage { supports, tractions, forces, .. } = stage;
    [
        ("supports", supports.as_ref().map(|all| all.iter().map(|one| one.block.as_str()).collect())),
        ("tractions", tractions.as_ref().map(|all| all.iter().map(|one| one.block.as_str()).collect())),
        ("forces", forces.as_ref().map(|all| all.iter().map(|one| one.block.as_str()).collect())),
    ]
}

/// Supports and loads of blocks that are absent in all stages in which they hold.
fn absent(scene: &Scene, blocks: &BlockSet) -> Vec<String> {
    if scene.stages.is_empty() {
        return Vec::new();
    }
    let mut given: Vec<Lists> = vec![lists_of_scene(scene)];
    given.extend(scene.stages.iter().map(lists_of_stage));
    let present: Vec<Vec<bool>> = (0..given.len())
        .filter_map(|stage| Presence::of(scene, blocks, stage).ok())
        .map(|presence| presence.absent.iter().map(|absent| !absent).collect())
        .collect();
    let mut found = Vec::new();
    for (from, lists) in given.iter().enumerate() {
        for (list, (key, patterns)) in lists.iter().enumerate() {
            // What a stage gives holds until a later one gives the same list.
            let until = (from + 1..given.len()).find(|&next| given[next][list].1.is_some());
            let stages = from..until.unwrap_or(given.len()).min(present.len());
            for (i, pattern) in patterns.iter().flatten().enumerate() {
                let acts = |stage: usize| {
                    blocks
                        .names
                        .iter()
                        .zip(&present[stage])
                        .any(|(name, there)| *there && matches(pattern, name))
                };
                if !stages.clone().any(acts) {
                    let path = match from {
                        0 => format!("{key}[{i}]"),
                        _ => format!("stages[{}].{key}[{i}]", from - 1),
                    };
                    found.push(format!(
                        "{path} has no effect: block `{pattern}` is not in the model while this entry acts; give the entry in the stage that adds the block, or leave it out"
                    ));
                }
            }
        }
    }
    found
}

/// Motions and blasts that begin after the end of the run.
fn too_late(scene: &Scene) -> Vec<String> {
    let end_s = build::all_steps(scene) as f64 * scene.time.step_s;
    let motions = scene.supports.iter().enumerate().filter_map(|(i, support)| {
        let Hold::Motion(rows) = &support.hold else { return None };
        let moves = rows.windows(2).find(|two| two[0].displacement_m != two[1].displacement_m)?;
        Some((format!("supports[{i}].hold"), "moves", moves[0].time_s))
    });
    let blasts = scene.blasts.iter().enumerate();
    let blasts = blasts.map(|(i, blast)| (format!("blasts[{i}]"), "detonates", blast.start_s));
    let late = motions.chain(blasts).filter(|(.., from_s)| *from_s >= end_s);
    late.map(|(path, does, from_s)| {
        format!("{path} has no effect: it {does} from {from_s:.4} s on, after the end of the run at {end_s:.4} s: raise time.end_s, or begin sooner")
    })
    .collect()
}

/// Records that the run does not use to their end, or that have gaps.
fn records(scene: &Scene, folder: &Path) -> Vec<String> {
    let end_s = build::all_steps(scene) as f64 * scene.time.step_s;
    let mut found = Vec::new();
    for (file, rows, gap) in rows(scene, folder) {
        found.extend(beyond(&file, &rows, end_s));
        found.extend(gap.map(|Gap { from_s, length_s, usual_s }| {
            format!(
                "record {file} has no row for {length_s:.4} s after {from_s:.4} s, where rows are {usual_s:.4} s apart: acceleration is taken to be \
                 linear across the gap; fill it, or begin the record after it"
            )
        }));
    }
    found.sort();
    found.dedup();
    found
}

/// File, rows and longest gap of a record.
type Known = (String, Vec<(f64, f64)>, Option<Gap>);

/// All records of a scene that can be read.
fn rows(scene: &Scene, folder: &Path) -> Vec<Known> {
    let known = |file: &str, prepared: Prepared| (file.to_string(), prepared.rows, prepared.gap);
    let prepared = |record: &Record| record.prepared(folder).ok().map(|found| known(&record.file, found));
    let waves = scene.quiet.iter().flat_map(|quiet| &quiet.incident).map(|wave| prepared(&wave.record));
    let mut all: Vec<_> = waves.flatten().collect();
    for support in &scene.supports {
        match &support.hold {
            Hold::Shaking(components) => {
                all.extend(components.iter().filter_map(|one| prepared(&one.record)))
            }
            Hold::Acceleration { file, .. } => {
                all.extend(Prepared::as_written(&folder.join(file)).ok().map(|found| known(file, found)))
            }
            _ => {}
        }
    }
    all
}

/// A record that begins after the run, or of which something that matters comes after it.
fn beyond(file: &str, rows: &[(f64, f64)], end_s: f64) -> Option<String> {
    let (first, last) = (rows.first()?, rows.last()?);
    if first.0 >= end_s {
        return Some(format!(
            "record {file} begins at {:.4} s, after the end of the run at {end_s:.4} s, and has no effect: raise time.end_s, or shift its times",
            first.0
        ));
    }
    let most = |of: &dyn Fn(f64) -> bool| {
        rows.iter().filter(|row| of(row.0)).map(|row| row.1.abs()).fold(0.0, f64::max)
    };
    let (peak, left) = (most(&|_| true), most(&|time_s| time_s > end_s));
    (left > MATTERS * peak).then(|| {
        format!(
            "record {file} lasts to {:.4} s, but the run ends at {end_s:.4} s: later shaking of up to {left:.3} m/s² is not used; time.end_s: {} \
             uses all of it",
            last.0, last.0
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Model;

    fn column(rest: &str) -> String {
        let block = |name: &str, body: &str, z: f64| {
            format!(
                "(name: \"{name}\", material: \"rock\", body: {body}, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, {z})),"
            )
        };
        format!(
            "(title: \"column\", time: (step_s: 1e-4, end_s: 1e-3),
            materials: [(name: \"rock\", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
            blocks: [{}{}{}], contact: Potential(penalty_pa: 1e9), {rest})",
            block("foot", "Fixed", 0.0),
            block("middle", "Rigid", 1.0),
            block("top", "Rigid", 2.0)
        )
    }

    fn found(text: &str) -> Vec<String> {
        let model = Model::from_text(text).unwrap();
        findings(&model.loaded.scene, model.simulation.blocks(), &model.folder)
    }

    #[test]
    fn loads_on_blocks_that_are_never_there_are_named_and_others_not() {
        let text = column(
            "forces: [(block: \"top\", force_n: (1, 0, 0)), (block: \"middle\", force_n: (1, 0, 0))],
            stages: [
                (name: \"out\", remove: [\"middle\"], over_s: 1e-4, then: Run(2e-4)),
                (name: \"push\", forces: [(block: \"middle\", force_n: (1, 0, 0)), (block: \"t*\", force_n: (1, 0, 0))], then: Run(2e-4)),
            ]",
        );
        let found = found(&text);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(
            found[0].starts_with("stages[1].forces[0] has no effect: block `middle` is not in the model"),
            "{found:?}"
        );
    }

    #[test]
    fn a_load_that_waits_for_its_block_is_not_named() {
        let text = column(
            "forces: [(block: \"top\", force_n: (1, 0, 0))],
            stages: [(name: \"in\", add: [\"top\"], then: Run(2e-4))]",
        );
        assert_eq!(found(&text), Vec::<String>::new());
    }

    #[test]
    fn a_motion_and_a_blast_after_the_end_of_the_run_are_named_and_those_within_are_not() {
        let at = |late_s: f64, start_s: f64| {
            found(&column(&format!(
                "supports: [(block: \"foot\", on: All, hold: Motion([
                    (time_s: 0, displacement_m: (0, 0, 0)), (time_s: {late_s}, displacement_m: (0, 0, 0)), (time_s: 1, displacement_m: (0.1, 0, 0))]))],
                blasts: [(block: \"top\", on: Part(All), pressure: Rows([(0, 0), (1e-3, 1e3)]), start_s: {start_s})]"
            )))
        };
        assert_eq!(at(5e-4, 0.0), Vec::<String>::new());
        let late = at(0.5, 0.2);
        assert!(late[0].starts_with("supports[0].hold has no effect: it moves from 0.5000 s on"), "{late:?}");
        assert!(late[1].starts_with("blasts[0] has no effect: it detonates from 0.2000 s on"), "{late:?}");
    }

    #[test]
    fn a_record_that_the_run_cuts_off_is_named_where_it_matters() {
        let rows = |last: f64| vec![(0.0, 1.0), (1.0, -1.0), (2.0, 0.5), (3.0, last)];
        assert_eq!(beyond("quake.csv", &rows(0.001), 2.5), None);
        assert!(beyond("quake.csv", &rows(0.3), 2.5).unwrap().contains("time.end_s: 3 uses all of it"));
        assert!(
            beyond("quake.csv", &rows(0.3)[1..], 1.0).unwrap().contains("begins at 1.0000 s, after the end")
        );
        assert_eq!(beyond("quake.csv", &rows(0.3), 3.0), None);
    }
}
