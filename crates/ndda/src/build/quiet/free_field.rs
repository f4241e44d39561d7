//! Sides of a model beside level ground of layers.

use std::path::Path;
use std::sync::Arc;

use ndda_fem::quiet::speed_m_s;
use ndda_fem::{Material, Motion, PlaneWave, QuietFaces, Record};
use ndda_io::scene::{IncidentWave, Quiet, RecordedAs, Scene, Then, WaveKind};
use ndda_mesh::{BlockId, BlockSet, Vec3};
use ndda_solver::QuietSetup;

use super::layers::{Layer, Waves, waves};
use crate::build::vec3;

/// Faces by block.
pub(super) type Parts = Vec<(BlockId, Vec<[u32; 3]>)>;

/// A layer with its place.
struct Stratum {
    material: Arc<dyn Material>,
    /// Height of its upper border against gravity [m].
    top_m: f64,
}

/// A field of an entry of `quiet`, and what is wrong with it.
type Refused = (String, String);

/// Where a scene has its ground from.
pub(super) struct Ground<'a> {
    pub scene: &'a Scene,
    pub blocks: &'a BlockSet,
    pub folder: &'a Path,
}

impl Ground<'_> {
    /// Quiet faces beside the layers of an entry: those of each block and layer, with the waves that go up and down in it.
    pub(super) fn beside(
        &self,
        quiet: &Quiet,
        parts: &Parts,
        materials: &dyn Fn(&str) -> Option<Arc<dyn Material>>,
    ) -> Result<Vec<(BlockId, QuietSetup)>, Refused> {
        let up = upwards(self.scene);
        let mut strata: Vec<Stratum> = Vec::new();
        for layer in &quiet.layers {
            let material = materials(&layer.material);
            let top_m = (vec3(layer.top_m) - self.blocks.origin_m).dot(&up);
            strata.extend(material.map(|material| Stratum { material, top_m }));
        }
        strata.sort_by(|a, b| a.top_m.total_cmp(&b.top_m));
        if strata.windows(2).any(|pair| pair[0].top_m >= pair[1].top_m) {
            return Err(("layers".into(), "two layers have their upper border at the same height".into()));
        }
        let mut in_layers = vec![Vec::new(); strata.len()];
        for (k, wave) in quiet.incident.iter().enumerate() {
            let found = self.arriving(wave, (&strata, parts), &up);
            let found = found.map_err(|message| (format!("incident[{k}]"), message))?;
            in_layers.iter_mut().zip(found).for_each(|(known, new)| known.extend(new));
        }
        let mut setups = Vec::new();
        for (block, triangles) in parts {
            for (k, stratum) in strata.iter().enumerate() {
                let is_beside = |triangle: &&[u32; 3]| self.layer_of(&strata, *block, triangle, &up) == k;
                let triangles: Vec<[u32; 3]> = triangles.iter().filter(is_beside).copied().collect();
                if !triangles.is_empty() {
                    let faces = QuietFaces { triangles, waves: in_layers[k].clone() };
                    setups.push((*block, QuietSetup { faces, beyond: stratum.material.clone() }));
                }
            }
        }
        Ok(setups)
    }

    /// The layer that the middle of a triangle is in; what is above the ground is beside the uppermost.
    fn layer_of(&self, strata: &[Stratum], block: BlockId, triangle: &[u32; 3], up: &Vec3) -> usize {
        let first = self.blocks.nodes_of(block).start;
        let corner = |node: &u32| self.blocks.rest_position[first + *node as usize].dot(up);
        let middle = triangle.iter().map(corner).sum::<f64>() / 3.0;
        strata.partition_point(|stratum| stratum.top_m < middle).min(strata.len() - 1)
    }

    /// The waves that go up and down in each layer.
    fn arriving(
        &self,
        wave: &IncidentWave,
        (strata, parts): (&[Stratum], &Parts),
        up: &Vec3,
    ) -> Result<Vec<[PlaneWave; 2]>, String> {
        let moves = match wave.wave {
            WaveKind::P => *up,
            WaveKind::S(direction) => vec3(direction).normalize(),
        };
        if matches!(wave.wave, WaveKind::S(_)) && moves.dot(up).abs() > 1e-6 {
            return Err(
                "an S wave moves rock across its way, which is straight up: give S a level direction".into(),
            );
        }
        let from = match wave.from_m {
            Some(at) => vec3(at) - self.blocks.origin_m,
            None => first_met(self.blocks, parts, up),
        };
        let mut at_m = from.dot(up);
        if at_m > strata[0].top_m {
            return Err(format!(
                "the record begins {:.3} m above the upper border of the lowest layer: give from_m a place in that layer",
                at_m - strata[0].top_m
            ));
        }
        let plane = |along: Vec3, height_m: f64, rows: Vec<(f64, f64)>| PlaneWave {
            motion: Motion::Record(Record::new(moves, &rows)),
            along,
            from: from + (height_m - from.dot(up)) * up,
            moves,
        };
        let mut layers = Vec::new();
        for stratum in strata {
            let material = stratum.material.as_ref();
            let c = speed_m_s(material, &plane(*up, at_m, Vec::new())).map_err(|error| error.to_string())?;
            let travel_s = (stratum.top_m - at_m) / c;
            layers.push(Layer { impedance: material.density_kg_m3() * c, travel_s });
            at_m = stratum.top_m;
        }
        let prepared = wave.record.prepared(self.folder).map_err(|error| error.to_string())?;
        let share = if wave.motion == RecordedAs::Outcrop { 0.5 } else { 1.0 };
        let rows: Vec<(f64, f64)> = prepared.rows.iter().map(|(t, a)| (*t, share * a)).collect();
        let mut bottom_m = from.dot(up);
        let in_layer = |(Waves { up: rising, down: sinking }, stratum): (Waves, &Stratum)| {
            let pair = [plane(*up, bottom_m, rising), plane(-*up, stratum.top_m, sinking)];
            bottom_m = stratum.top_m;
            pair
        };
        Ok(waves(&layers, &rows, end_s(self.scene))?.into_iter().zip(strata).map(in_layer).collect())
    }
}

/// Time at which a run ends [s].
fn end_s(scene: &Scene) -> f64 {
    let of_stage = |stage: &ndda_io::scene::Stage| match stage.then {
        Then::Run(time_s) => time_s,
        Then::Settle { .. } => stage.over_s,
    };
    scene.time.end_s + scene.stages.iter().map(of_stage).sum::<f64>()
}

/// Against gravity, or along z without.
pub(super) fn upwards(scene: &Scene) -> Vec3 {
    let up = -vec3(scene.gravity_m_s2);
    if up.norm() > 0.0 { up.normalize() } else { Vec3::z() }
}

/// The place of the faces that a wave meets first.
pub(super) fn first_met(blocks: &BlockSet, parts: &Parts, along: &Vec3) -> Vec3 {
    let nodes = parts.iter().flat_map(|(block, triangles)| {
        let first = blocks.nodes_of(*block).start;
        triangles.iter().flatten().map(move |n| blocks.rest_position[first + *n as usize])
    });
    nodes.min_by(|a, b| a.dot(along).total_cmp(&b.dot(along))).unwrap_or_else(Vec3::zeros)
}
