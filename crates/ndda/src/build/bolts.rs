//! Bolts of a scene: rows become single bolts, and heads go to the face.

use ndda_io::scene::{Bolt, BoltPlace, Scene, Stage, matches};
use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, BlockSet, Vec3};
use ndda_solver::{BoltSetup, Dowel, Grout, Plate, Steel, first_rock_m};

use super::presence::Presence;
use super::{Fault, vec3};

/// All bolts of a scene one by one, in the coordinates of the blocks; those of other stages, too.
pub(super) fn bolts(scene: &Scene, blocks: &BlockSet, stage: usize) -> Result<Vec<BoltSetup>, Vec<Fault>> {
    let (mut found, mut faults) = (Vec::new(), Vec::new());
    for (i, bolt) in scene.bolts.iter().enumerate() {
        let life = Life::of(scene, &bolt.name);
        let absent = absent_at(scene, blocks, life.from)?;
        match places(bolt, blocks, &absent) {
            Ok(places) => {
                let setups = places.into_iter().map(|(name, from_m, to_m)| BoltSetup {
                    is_installed: life.holds(stage),
                    absent: absent.clone(),
                    ..setup(bolt, name, (from_m, to_m))
                });
                found.extend(setups);
            }
            Err(message) => faults.push(Fault::new(format!("bolts[{i}].at"), message)),
        }
    }
    if faults.is_empty() { Ok(found) } else { Err(faults) }
}

/// The stages, counted from 1, between which a bolt is there; 0 is before the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Life {
    /// That it is installed in.
    pub from: usize,
    /// That releases it.
    pub until: Option<usize>,
}

impl Life {
    /// Of an entry of `bolts`.
    pub(super) fn of(scene: &Scene, name: &str) -> Self {
        let first = |patterns: fn(&Stage) -> &Vec<String>| {
            let speaks = |stage: &Stage| patterns(stage).iter().any(|pattern| matches(pattern, name));
            scene.stages.iter().position(speaks).map(|k| k + 1)
        };
        Self { from: first(|stage| &stage.install).unwrap_or(0), until: first(|stage| &stage.release) }
    }

    fn holds(self, stage: usize) -> bool {
        self.from <= stage && self.until.is_none_or(|until| stage < until)
    }
}

/// Blocks that are not there in a stage, ascending.
fn absent_at(scene: &Scene, blocks: &BlockSet, stage: usize) -> Result<Vec<BlockId>, Vec<Fault>> {
    let presence = Presence::of(scene, blocks, stage)?;
    Ok(blocks.ids().filter(|block| presence.absent[block.index()]).collect())
}

/// Refuses bolts that are bonded in a block which is not there in a stage, counted from 1.
pub(super) fn refuse_loose(scene: &Scene, blocks: &BlockSet, stage: usize) -> Result<(), Vec<Fault>> {
    let absent = absent_at(scene, blocks, stage)?;
    let mut faults = Vec::new();
    for setup in bolts(scene, blocks, stage)?.iter().filter(|setup| setup.is_installed) {
        // What is wrong with a bolt itself is said when it is built.
        let Ok(portions) = setup.portions(blocks) else { continue };
        if let Some(portion) = portions.iter().find(|portion| absent.binary_search(&portion.block).is_ok()) {
            let (name, entry) = (&setup.name, entry(scene, &setup.name));
            let (block, stage) = (&blocks.names[portion.block.index()], &scene.stages[stage - 1].name);
            let message = format!(
                "bolt `{name}` is bonded in block `{block}`, which is not there in stage `{stage}`: release it in that stage or before \
                 (`release: [\"{}\"]`), install it later, or end it before that block",
                scene.bolts[entry].name
            );
            faults.push(Fault::new(format!("bolts[{entry}]"), message));
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

/// The entry of a scene that a bolt comes from.
pub(crate) fn entry(scene: &Scene, name: &str) -> usize {
    let is_of = |bolt: &Bolt| {
        let rest = name.strip_prefix(&bolt.name);
        rest.is_some_and(|rest| {
            rest.is_empty() || rest.starts_with('_') && matches!(bolt.at, BoltPlace::Rows { .. })
        })
    };
    scene.bolts.iter().position(is_of).unwrap_or(0)
}

/// Head and end of each bolt that is there in any stage, in the coordinates of the blocks.
///
/// # Errors
/// Rows of bolts that meet no block.
#[cfg(feature = "plots")]
pub(crate) fn lines(scene: &Scene, blocks: &BlockSet) -> Result<Vec<[Vec3; 2]>, Vec<Fault>> {
    Ok(bolts(scene, blocks, 0)?.into_iter().map(|bolt| [bolt.from_m, bolt.to_m]).collect())
}

type Place = (String, Vec3, Vec3);

fn places(bolt: &Bolt, blocks: &BlockSet, absent: &[BlockId]) -> Result<Vec<Place>, String> {
    match &bolt.at {
        BoltPlace::Line { from_m, to_m } => {
            let (from_m, to_m) = (vec3(*from_m) - blocks.origin_m, vec3(*to_m) - blocks.origin_m);
            Ok(vec![(bolt.name.clone(), from_m, to_m)])
        }
        BoltPlace::Rows { corner_m, along_m, up_m, spacing_m, direction, length_m, staggered } => {
            let (along, up) = (vec3(*along_m), vec3(*up_m));
            let direction = vec3(*direction).normalize();
            let reach_m = Aabb::around(&blocks.rest_position).diagonal() + along.norm() + up.norm();
            let (mut found, mut missing) = (Vec::new(), Vec::new());
            for (row, rise) in spread(up.norm(), spacing_m.1).into_iter().enumerate() {
                for (column, offset) in columns(along.norm(), spacing_m.0, *staggered && row % 2 == 1) {
                    let along_axis = along.try_normalize(0.0).unwrap_or_default();
                    let up_axis = up.try_normalize(0.0).unwrap_or_default();
                    let point = vec3(*corner_m) - blocks.origin_m + offset * along_axis + rise * up_axis;
                    let name = format!("{}_{}_{}", bolt.name, row + 1, column + 1);
                    let is_there = |block: BlockId| absent.binary_search(&block).is_err();
                    let ahead_m = first_rock_m(blocks, is_there, &point, &(point + reach_m * direction));
                    let Some(ahead_m) = ahead_m else {
                        missing.push((name, point + blocks.origin_m));
                        continue;
                    };
                    let head = point + ahead_m * direction;
                    found.push((name, head, head + *length_m * direction));
                }
            }
            if missing.is_empty() { Ok(found) } else { Err(meets_nothing(&missing, found.len())) }
        }
    }
}

/// That bolts of rows meet no block: their names and places, beside so many that do.
fn meets_nothing(missing: &[(String, Vec3)], others: usize) -> String {
    let (name, at) = &missing[0];
    let first = format!("`{name}`, from ({:.4}, {:.4}, {:.4}) along its direction,", at.x, at.y, at.z);
    let what = match missing.len() {
        1 => format!("{first} meets no block"),
        count => format!("{count} of its {} bolts meet no block, the first {first}", count + others),
    };
    format!("{}: move the rectangle or turn `direction`", what.trim_end_matches(','))
}

/// Distances along a side, what is left over being shared by both ends.
fn spread(length_m: f64, spacing_m: f64) -> Vec<f64> {
    let gaps = (length_m / spacing_m * (1.0 + 4.0 * f64::EPSILON)).floor();
    let rest_m = 0.5 * (length_m - gaps * spacing_m);
    (0..=gaps as usize).map(|k| rest_m + k as f64 * spacing_m).collect()
}

fn columns(length_m: f64, spacing_m: f64, shifted: bool) -> Vec<(usize, f64)> {
    let places = spread(length_m, spacing_m);
    let between = || places.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
    let places: Vec<f64> = if shifted && places.len() > 1 { between() } else { places.clone() };
    places.into_iter().enumerate().collect()
}

fn setup(bolt: &Bolt, name: String, (from_m, to_m): (Vec3, Vec3)) -> BoltSetup {
    let never = |value: Option<f64>| value.unwrap_or(f64::INFINITY);
    BoltSetup {
        name,
        from_m,
        to_m,
        steel: Steel {
            young_pa: bolt.steel.young_pa,
            area_m2: bolt.steel.area_m2,
            yield_n: never(bolt.steel.yield_n),
            break_strain: never(bolt.steel.break_strain),
        },
        grout: Grout {
            stiffness_n_m2: bolt.grout.stiffness_n_m2,
            strength_n_m: bolt.grout.strength_n_m,
            from_m: bolt.grout.from_m,
            to_m: never(bolt.grout.to_m),
        },
        dowel: bolt
            .dowel
            .map(|dowel| Dowel { stiffness_n_m: dowel.stiffness_n_m, capacity_n: dowel.capacity_n }),
        pretension_n: bolt.pretension_n,
        plate: bolt.plate.map(|plate| Plate { strength_n: never(plate.strength_n) }),
        segment_m: bolt.segment_m,
        is_installed: true,
        absent: Vec::new(),
    }
}
