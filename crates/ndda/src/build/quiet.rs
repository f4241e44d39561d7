//! Quiet faces of a scene, and the waves that arrive through them.

mod free_field;
mod layers;

use std::collections::HashSet;
use std::path::Path;
use std::sync::Arc;

use ndda_fem::quiet::speed_m_s;
use ndda_fem::{Material, Motion, PlaneWave, QuietFaces, Record};
use ndda_io::record;
use ndda_io::scene::{self, IncidentWave, RecordedAs, Region, Scene, WaveKind};
use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, BlockSet, Vec3};
use ndda_solver::{BodyKind, BodySetup, QuietSetup};

use super::regions::{in_region, outward_triangles, region_nodes};
use super::{Fault, ON_PLANE, vec3};
use free_field::{Ground, Parts, first_met, upwards};

/// Gives bodies their quiet faces.
pub(super) fn add_quiet(
    scene: &Scene,
    blocks: &BlockSet,
    folder: &Path,
    materials: &[Option<Arc<dyn Material>>],
    bodies: &mut [BodySetup],
    faults: &mut Vec<Fault>,
) {
    for (i, quiet) in scene.quiet.iter().enumerate() {
        let path = |field: &str| format!("quiet[{i}].{field}");
        let parts = match in_region(blocks, &quiet.block, |block| outward_triangles(blocks, block, &quiet.on))
        {
            Ok(parts) => parts,
            Err(message) => {
                faults.push(Fault::new(path("on"), message));
                continue;
            }
        };
        let known = |(block, triangles): &&(BlockId, Vec<[u32; 3]>)| {
            let known: HashSet<_> =
                bodies[block.index()].quiet.iter().flat_map(|known| &known.faces.triangles).collect();
            triangles.iter().any(|triangle| known.contains(triangle))
        };
        if let Some((block, _)) = parts.iter().find(known) {
            let message = format!(
                "faces of block `{}` are quiet already by an entry before this one: give all their waves in one entry",
                blocks.names[block.index()]
            );
            faults.push(Fault::new(path("on"), message));
            continue;
        }
        if let Some((block, _)) = parts.iter().find(|(b, _)| bodies[b.index()].kind != BodyKind::Elastic) {
            let name = &blocks.names[block.index()];
            let message =
                format!("block `{name}` is not Elastic, and has no waves that could leave: make it Elastic");
            faults.push(Fault::new(path("block"), message));
            continue;
        }
        let named =
            quiet.beyond.as_ref().and_then(|name| scene.materials.iter().position(|m| m.name == *name));
        let named = named.and_then(|index| materials[index].clone());
        if !quiet.layers.is_empty() {
            let material = |name: &str| {
                let index = scene.materials.iter().position(|material| material.name == name);
                index.and_then(|index| materials[index].clone())
            };
            let ground = Ground { scene, blocks, folder };
            match ground.beside(quiet, &parts, &material) {
                Ok(found) => {
                    found.into_iter().for_each(|(block, setup)| bodies[block.index()].quiet.push(setup))
                }
                Err((field, message)) => faults.push(Fault::new(path(&field), message)),
            }
            continue;
        }
        let mut waves = Vec::new();
        for (k, wave) in quiet.incident.iter().enumerate() {
            let beyond = named.clone().unwrap_or_else(|| bodies[parts[0].0.index()].material.clone());
            match arriving(scene, blocks, folder, (wave, &parts), beyond.as_ref()) {
                Ok(found) => waves.extend(found),
                Err(message) => faults.push(Fault::new(path(&format!("incident[{k}]")), message)),
            }
        }
        for (block, triangles) in parts {
            let body = &mut bodies[block.index()];
            let beyond = named.clone().unwrap_or_else(|| body.material.clone());
            body.quiet.push(QuietSetup { faces: QuietFaces { triangles, waves: waves.clone() }, beyond });
        }
    }
}

/// Ties the nodes of bodies that a scene wants to move alike.
pub(super) fn add_ties(scene: &Scene, blocks: &BlockSet, bodies: &mut [BodySetup], faults: &mut Vec<Fault>) {
    for (i, tie) in scene.ties.iter().enumerate() {
        let along = tie.along.map_or_else(|| upwards(scene), |along| vec3(along).normalize());
        match in_region(blocks, &tie.block, |block| level_groups(blocks, block, &tie.on, &along)) {
            Ok(parts) => {
                for (block, groups) in parts {
                    if bodies[block.index()].kind != BodyKind::Elastic {
                        let name = &blocks.names[block.index()];
                        let message =
                            format!("block `{name}` is not Elastic: make it Elastic to tie its nodes");
                        faults.push(Fault::new(format!("ties[{i}].block"), message));
                        break;
                    }
                    bodies[block.index()].ties.extend(groups);
                }
            }
            Err(message) => faults.push(Fault::new(format!("ties[{i}].on"), message)),
        }
    }
}

/// Nodes of regions of a block by their height, to within 1e-6 of its size.
fn level_groups(
    blocks: &BlockSet,
    block: BlockId,
    on: &[Region],
    along: &Vec3,
) -> Result<Vec<Vec<u32>>, String> {
    let rest = &blocks.rest_position[blocks.nodes_of(block)];
    let mut nodes = Vec::new();
    for region in on {
        nodes.extend(region_nodes(blocks, block, region)?);
    }
    nodes.sort_unstable();
    nodes.dedup();
    let height = |node: u32| rest[node as usize].dot(along);
    nodes.sort_by(|&a, &b| height(a).total_cmp(&height(b)).then(a.cmp(&b)));
    let near = ON_PLANE * Aabb::around(rest).diagonal();
    let groups = nodes.chunk_by(|&a, &b| height(b) - height(a) <= near);
    let groups: Vec<Vec<u32>> = groups.filter(|group| group.len() > 1).map(<[u32]>::to_vec).collect();
    if groups.is_empty() {
        let name = &blocks.names[block.index()];
        return Err(format!(
            "no two nodes of block `{name}` in these regions are at the same height: mesh both sides alike"
        ));
    }
    Ok(groups)
}

/// A wave of a scene, and its echo from level ground.
fn arriving(
    scene: &Scene,
    blocks: &BlockSet,
    folder: &Path,
    (wave, parts): (&IncidentWave, &Parts),
    beyond: &dyn Material,
) -> Result<Vec<PlaneWave>, String> {
    let along = wave.along.map_or_else(|| upwards(scene), |along| vec3(along).normalize());
    let moves = match wave.wave {
        WaveKind::P => along,
        WaveKind::S(direction) => vec3(direction).normalize(),
    };
    if matches!(wave.wave, WaveKind::S(_)) && moves.dot(&along).abs() > 1e-6 {
        return Err(
            "an S wave moves rock across its direction of travel: give S a direction at right angles to `along`".into()
        );
    }
    let from = wave.from_m.map_or_else(|| first_met(blocks, parts, &along), |at| vec3(at) - blocks.origin_m);
    let empty = PlaneWave { motion: Motion::Rows(Vec::new()), along, from, moves };
    let c = speed_m_s(beyond, &empty).map_err(|error| error.to_string())?;
    let ground = wave.ground_m.map(|at| (vec3(at) - blocks.origin_m - from).dot(&along));
    if let Some(height) = ground.filter(|height| *height <= 0.0) {
        return Err(format!(
            "ground_m lies {:.3} m behind where the wave begins: it must be ahead",
            height.abs()
        ));
    }
    let prepared = wave.record.prepared(folder).map_err(|error| error.to_string())?;
    let (rows, share) = match (wave.motion, ground) {
        (RecordedAs::Outcrop, _) => (prepared.rows, 0.5),
        (RecordedAs::Within, Some(height)) => (without_echo(&prepared.rows, 2.0 * height / c)?, 1.0),
        (RecordedAs::Within, None) => return Err("a record from within rock needs ground_m".into()),
        (RecordedAs::Upgoing, _) => (prepared.rows, 1.0),
    };
    let motion = Motion::Record(Record::new(share * moves, &rows));
    let mut waves = vec![PlaneWave { motion: motion.clone(), ..empty }];
    if let Some(height) = ground {
        // As from a mirror image of its start.
        waves.push(PlaneWave { motion, along: -along, from: from + 2.0 * height * along, moves });
    }
    Ok(waves)
}

/// Refuses a spacing of rows [s] of which a record of some length [s] would have too many.
fn refuse_too_many(length_s: f64, spacing_s: f64) -> Result<(), String> {
    let count = length_s / spacing_s;
    if count <= record::MOST_ROWS as f64 {
        return Ok(());
    }
    Err(format!(
        "would take a record of {count:.0} rows, {spacing_s:.3e} s apart, limit {}: give it a longer spacing by resample_s",
        record::MOST_ROWS
    ))
}

/// The wave in a motion that is it and its echo after a time: a(t) = w(t) − a(t − T), on rows of which a whole number makes T.
fn without_echo(rows: &[(f64, f64)], echo_s: f64) -> Result<Vec<(f64, f64)>, String> {
    let shortest_s = rows.windows(2).map(|pair| pair[1].0 - pair[0].0).fold(f64::INFINITY, f64::min);
    let parts = (echo_s / shortest_s).ceil().max(1.0);
    let spacing_s = echo_s / parts;
    refuse_too_many(rows[rows.len() - 1].0 - rows[0].0, spacing_s).map_err(|message| {
        format!("taking out its echo {echo_s:.3e} s later {message}, or put ground_m farther ahead")
    })?;
    let mut even = record::resampled(rows, spacing_s);
    for i in parts as usize..even.len() {
        even[i].1 -= even[i - parts as usize].1;
    }
    Ok(even)
}

/// What each record of a scene is, and what is done with it, in words.
pub fn records(scene: &Scene, folder: &Path) -> Vec<String> {
    let waves = scene.quiet.iter().flat_map(|quiet| &quiet.incident).map(|wave| &wave.record);
    let shaking = scene.supports.iter().filter_map(|support| match &support.hold {
        scene::Hold::Shaking(components) => Some(components.iter().map(|component| &component.record)),
        _ => None,
    });
    let mut told: Vec<String> = Vec::new();
    for record in waves.chain(shaking.flatten()) {
        if let Ok(prepared) = record.prepared(folder)
            && !told.contains(&prepared.told)
        {
            told.push(prepared.told);
        }
    }
    told
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_from_within_is_the_wave_and_its_echo() {
        let wave = |t: f64| if (0.0..1.0).contains(&t) { (std::f64::consts::TAU * t).sin() } else { 0.0 };
        let rows: Vec<_> =
            (0..=4000).map(|i| f64::from(i) * 1e-3).map(|t| (t, wave(t) + wave(t - 0.37))).collect();
        for (t, a) in without_echo(&rows, 0.37).unwrap() {
            assert!((a - wave(t)).abs() < 1e-4, "{t}: {a} {}", wave(t));
        }
    }

    #[test]
    fn a_record_of_which_an_echo_would_make_too_many_rows_is_refused() {
        // Two rows a nanosecond apart in a minute.
        let message = without_echo(&[(0.0, 0.0), (1e-9, 1.0), (60.0, 0.0)], 0.37).unwrap_err();
        assert!(message.contains("limit 10000000") && message.contains("resample_s"), "{message}");
        // Ground a tenth of a micrometre ahead.
        let message = without_echo(&[(0.0, 0.0), (0.01, 1.0), (60.0, 0.0)], 1e-10).unwrap_err();
        assert!(message.contains("ground_m"), "{message}");
    }

    /// A column of a cube, Elastic or Fixed, and what else a scene has.
    fn column(body: &str, rest: &str) -> String {
        format!(
            r#"(
                title: "A cube", time: (step_s: 1e-4, end_s: 1e-2),
                materials: [(name: "rock", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
                blocks: [(name: "cube", material: "rock", body: {body}, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
                {rest}
            )"#
        )
    }

    #[test]
    fn a_face_that_is_quiet_twice_is_refused() {
        let text = column(
            "Elastic",
            r#"quiet: [(block: "cube", on: Set("z_min")), (block: "c*", on: Set("z_min"))]"#,
        );
        let message =
            crate::Model::from_text(&text).err().expect("its dashpots would be twice as strong").to_string();
        assert!(message.contains("quiet already") && message.contains("quiet[1]"), "{message}");
    }

    #[test]
    fn a_blast_on_a_block_that_cannot_move_leaves_no_error_of_momentum() {
        let rest =
            r#"blasts: [(block: "cube", on: Part(Set("z_min")), pressure: Rows([(0, 0), (1e-3, 1e6)]))]"#;
        let model = crate::Model::from_text(&column("Fixed", rest)).unwrap();
        let summary = crate::Run::new(model).finish(&mut []).unwrap().summary;
        assert_eq!(summary.invariants.linear_momentum, 0.0);
        assert_eq!(summary.invariants.angular_momentum, 0.0);
    }
}
