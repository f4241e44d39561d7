//! Where waves come from: quiet faces that let them in, shaken bases, and faces that something presses on.

use ndda_fem::{Motion, Table};
use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockId, BlockSet, NodeId, Vec3};
use ndda_solver::{BodyKind, Simulation};

use super::spectrum;

/// Faces whose area vectors add up to this part of their areas are one plane, from which a wave goes straight.
const FLAT: f64 = 0.99;
/// Cosine of the angle to its way within which a motion is that of a P wave.
const ALONG: f64 = 0.999;

/// Waves of one record or pressure.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Source {
    /// Frequency below which 95 % of its energy lies [Hz].
    pub hz: f64,
    pub way: Way,
    /// What to do where the mesh is too coarse for it, beside making it finer.
    pub cure: &'static str,
}

/// How waves go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Way {
    /// As plane waves.
    Plane {
        /// Direction in which they travel.
        along: Vec3,
        /// Direction in which they move the rock.
        moves: Vec3,
    },
    /// As P waves, to all sides from a place [m].
    From(Vec3),
}

/// All that sends waves into a scene.
pub(super) fn of(simulation: &Simulation) -> Vec<Source> {
    let mut sources = incident(simulation);
    sources.extend(shaken(simulation));
    sources.extend(pressed(simulation));
    sources
}

/// Waves that arrive through quiet faces.
fn incident(simulation: &Simulation) -> Vec<Source> {
    let mut known: Vec<(&Motion, (Vec3, Vec3))> = Vec::new();
    for block in simulation.blocks().ids() {
        let quiet = &simulation.shape(block).supports.quiet;
        for (motion, way) in quiet.waves.iter().zip(&quiet.directions) {
            if !known.iter().any(|known| known.1 == *way && known.0 == motion) {
                known.push((motion, *way));
            }
        }
    }
    let source = |(motion, (along, moves)): (&Motion, (Vec3, Vec3))| {
        let way = Way::Plane { along, moves };
        Some(Source { hz: spectrum::of_motion(motion)?, way, cure: "filter the record (`filter_hz`)" })
    };
    known.into_iter().filter_map(source).collect()
}

/// Waves of blocks, or parts of them, that follow records: they go to the middle of the elastic rock.
fn shaken(simulation: &Simulation) -> Vec<Source> {
    let blocks = simulation.blocks();
    let mut known: Vec<(&Motion, Vec<Vec3>)> = Vec::new();
    for block in blocks.ids() {
        for (motion, places) in moved_places(simulation, block) {
            let mut records = Vec::new();
            add_records(motion, &mut records);
            for record in records {
                match known.iter_mut().find(|known| known.0 == record) {
                    Some(known) => known.1.extend(&places),
                    None => known.push((record, places.clone())),
                }
            }
        }
    }
    let Some(middle) = elastic_middle(simulation).filter(|_| !known.is_empty()) else { return Vec::new() };
    let source = |(motion, places): (&Motion, Vec<Vec3>)| {
        let Motion::Record(record) = motion else { return None };
        let moves = record.direction.try_normalize(0.0)?;
        let from = places.iter().sum::<Vec3>() / places.len().max(1) as f64;
        let along = (middle - from).try_normalize(0.0).unwrap_or(moves);
        let across = moves - moves.dot(&along) * along;
        let is_p = moves.dot(&along).abs() > ALONG;
        let moves = if is_p { along } else { across.normalize() };
        let way = Way::Plane { along, moves };
        Some(Source { hz: spectrum::of_motion(motion)?, way, cure: "filter the record (`filter_hz`)" })
    };
    known.into_iter().filter_map(source).collect()
}

pub(super) fn add_records<'a>(motion: &'a Motion, records: &mut Vec<&'a Motion>) {
    match motion {
        Motion::Rows(_) => {}
        Motion::Record(_) => records.push(motion),
        Motion::Sum(parts) => parts.iter().for_each(|part| add_records(part, records)),
    }
}

/// The motions that nodes of a block follow, and where these nodes are at rest [m].
fn moved_places(simulation: &Simulation, block: BlockId) -> Vec<(&Motion, Vec<Vec3>)> {
    let (blocks, shape) = (simulation.blocks(), simulation.shape(block));
    let (rest, supports) = (&blocks.rest_position[blocks.nodes_of(block)], &shape.supports);
    if shape.kind == BodyKind::Fixed {
        return supports.motions.iter().map(|motion| (motion, rest.to_vec())).collect();
    }
    let held = supports.held.iter().map(|held| (held.motion, held.node));
    let sprung = supports.springs.iter().map(|spring| (spring.motion, spring.node));
    let mut moved: Vec<(&Motion, Vec<Vec3>)> = Vec::new();
    for (motion, node) in held.chain(sprung) {
        let Some(motion) = motion.map(|k| &supports.motions[k]) else { continue };
        let place = rest[node as usize];
        match moved.iter_mut().find(|known| known.0 == motion) {
            Some(known) => known.1.push(place),
            None => moved.push((motion, vec![place])),
        }
    }
    moved
}

/// The mean place of the nodes of elastic blocks; none without such blocks.
fn elastic_middle(simulation: &Simulation) -> Option<Vec3> {
    let blocks = simulation.blocks();
    let elastic = blocks.ids().filter(|block| simulation.shape(*block).kind == BodyKind::Elastic);
    let (sum, count) = elastic
        .flat_map(|block| blocks.nodes_of(block))
        .fold((Vec3::zeros(), 0usize), |(s, n), i| (s + blocks.rest_position[i], n + 1));
    (count > 0).then(|| sum / count as f64)
}

/// Waves of pressures that change over time.
fn pressed(simulation: &Simulation) -> Vec<Source> {
    let mut known: Vec<(&Table, Vec<[NodeId; 3]>)> = Vec::new();
    for (triangles, factor) in simulation.pressures_over_time() {
        let triangles = triangles.iter().map(|triangle| triangle.map(NodeId));
        match known.iter_mut().find(|known| known.0 == factor) {
            Some(known) => known.1.extend(triangles),
            None => known.push((factor, triangles.collect())),
        }
    }
    let source = |(factor, triangles): (&Table, Vec<[NodeId; 3]>)| {
        let way = way_from(simulation.blocks(), &triangles);
        Some(Source { hz: spectrum::of_pressure(factor)?, way, cure: "let the pressure change more slowly" })
    };
    known.into_iter().filter_map(source).collect()
}

/// The way of waves that begin at faces: straight from a plane, to all sides from others.
fn way_from(blocks: &BlockSet, triangles: &[[NodeId; 3]]) -> Way {
    let (mut area, mut outward, mut moment) = (0.0, Vec3::zeros(), Vec3::zeros());
    for triangle in triangles {
        let corners = triangle.map(|n| blocks.rest_position[n.index()]);
        let own = triangle_area_vector(&corners);
        area += own.norm();
        outward += own;
        moment += own.norm() / 3.0 * corners.iter().sum::<Vec3>();
    }
    match outward.norm() > FLAT * area {
        true => Way::Plane { along: -outward.normalize(), moves: -outward.normalize() },
        false => Way::From(moment / area),
    }
}
