//! Values that a scene leaves out: the penalty from the size of blocks, their loads and speeds, the step from the stability of contact.
//!
//! **Penalty.** Contact at rest under a pressure σ lies σ L/(2 k_n) deep, where L is L₀ for `Smooth` and `Closure` and a quarter of the
//! smallest height of a tetrahedron for `Element`. A block of size s that hits another at the speed v goes v √(ρ s L/(2 k_n)) deep. With
//! k_n = L (ρ (v² + 2 g H) + 2 σ_l)/(2 ε s) the first is at most ε s, and the second √ε s: ρ is the largest density, g gravity, H the height
//! of the scene along it, v the largest initial speed or that of a support that follows rows, σ_l the largest pressure of loads (`choose/pressures.rs`), ε the `depth_ratio` of the scene. s is the size that
//! blocks of a twentieth of the volume are below, so that a sliver does not decide. Under large loads k_n = E L/s is enough, where contact is as
//! compliant as half a block. The result is rounded up to 1, 2 or 5 times a power of ten.
//! Columns that stand free tilt on contact that gives way: with the width b and the height H of the box that has the second moments of a block, 3 b²/H takes the place of s
//! in the first where it is smaller. A column whose weight acts d inside the edge of its base stands as long as
//! M = N H L₀/(18 k_n w d³) < 4/27, N being its weight and w the length of the edge (`docs/theory/contact.md`).
//!
//! **Step.** The smallest of these, rounded down in the same way: a quarter of what the contact stability number allows (half of the step that `forecast::step` advises), a
//! hundredth of the run, a tenth of the ramp of gravity and of the shortest time between rows of loads, the time between two rows of a record,
//! what waves want (`waves/steps.rs`), a tenth of the height of a tetrahedron at the largest initial speed, and a twentieth of a radian of rotation.

mod loads;
mod pressures;
mod rounded;

use std::path::Path;

use ndda_io::diagnostic::{Diagnostic, SceneErrors};
use ndda_io::read::Chosen;
use ndda_io::read::{self, LoadedScene};
use ndda_io::scene::{Contact, ContactAt, Integrator, Scene, is_unset};
use ndda_mesh::geometry::{Aabb, tet_volume, triangle_area_vector};
use ndda_mesh::{BlockId, BlockSet, Mat3, Vec3};

use crate::build::{self, Fault, RockReport};
use crate::forecast::held::NOTHING_MOVES;
use crate::forecast::{admit, step};
use crate::waves;
use pressures::Load;
pub(crate) use rounded::rounded_up;
use rounded::{metres, rounded_down};

/// Part of the volume that is in blocks smaller than the size that counts.
const SMALL: f64 = 0.05;
/// Penalty of rock without loads or speeds, over Young's modulus, for a potential of the size of a block.
const OF_YOUNG: f64 = 1e-3;
/// The same for rock under large loads, at most: contact is then as compliant as half a block, E L₀/(2 k_n) = s/2.
const MOST_OF_YOUNG: f64 = 1.0;
/// Steps of a run, at least.
const FEWEST_STEPS: f64 = 100.0;
/// Steps in which gravity grows, or a load goes from row to row.
const STEPS_OF_LOADS: f64 = 10.0;
/// Part of the step that is advised for contact: half of it is stable, and not always accurate.
const OF_ADVISED: f64 = 0.5;
/// Way in a step over the smallest height of a tetrahedron.
const WAY: f64 = 0.1;
/// Rotation in a step.
const TURN: f64 = 0.05;
/// Height over width of blocks from which on they are columns, nearly.
const SLENDER: f64 = 3.0;

/// Blocks, and what rock was cut into.
type Cut = (BlockSet, Vec<RockReport>);

/// The scene with all values that it leaves out; the scene itself where it leaves out none.
///
/// # Errors
/// Errors of its blocks, and of the scene with what was chosen.
pub fn complete(loaded: LoadedScene, folder: &Path) -> Result<LoadedScene, SceneErrors> {
    complete_on_blocks(loaded, folder).map(|(loaded, _)| loaded)
}

/// As [`complete`], with the blocks and what rock was cut into, where values were chosen on them.
pub(crate) fn complete_on_blocks(
    loaded: LoadedScene,
    folder: &Path,
) -> Result<(LoadedScene, Option<Cut>), SceneErrors> {
    if loaded.is_complete() {
        return Ok((loaded, None));
    }
    let located = |faults: Vec<Fault>| {
        let diagnostics: Vec<Diagnostic> =
            faults.into_iter().map(|fault| loaded.diagnose(&fault.path, fault.message)).collect();
        loaded.errors(diagnostics)
    };
    admit::admit(&loaded, folder).map_err(|refused| loaded.errors(vec![refused]))?;
    let (mut blocks, rock) = build::blocks_and_rock(&loaded.scene, folder).map_err(located)?;
    let mut scene = loaded.scene.clone();
    let sizes = Sizes::new(&scene, &blocks);
    let mut chosen = Vec::new();
    if let Some(choice) = penalty(&mut scene, &sizes) {
        chosen.push(choice);
    }
    if is_unset(&scene.time.step_s) {
        let (choice, used) = step_of(&mut scene, &sizes, blocks, folder).map_err(located)?;
        chosen.push(choice);
        blocks = used;
    }
    Ok((loaded.with_chosen(chosen, folder)?, Some((blocks, rock))))
}

/// The values that were chosen, as `path=value`.
pub fn as_overrides(chosen: &[Chosen]) -> Vec<String> {
    chosen.iter().map(|choice| format!("{}={:e}", choice.path, choice.value)).collect()
}

/// Writes values that were chosen into the file of a scene, with their reasons as comments.
///
/// # Errors
/// Why the file cannot be read or written, or has no place for a value.
pub fn write(file: &Path, chosen: &[Chosen]) -> Result<(), String> {
    if chosen.is_empty() {
        return Ok(());
    }
    if read::is_standard_input(file) {
        return Err("standard input is not a file to write to: save the scene, and name its file".into());
    }
    let text = read::text_of(file).map_err(|errors| errors.render(false))?;
    let text = read::with_values(&text, chosen).map_err(|refused| refused.message)?;
    ndda_io::atomic::write_named(file, text.as_bytes()).map_err(|error| error.to_string())
}

/// What the blocks of a scene and their loads amount to.
struct Sizes {
    /// Size that blocks of a twentieth of the volume are below [m].
    block_m: f64,
    /// Least 3 b²/H of the larger blocks of a scene, of width b and height H, that are not cut from rock [m].
    column_m: f64,
    /// Smallest height of a tetrahedron of blocks that move [m].
    height_m: f64,
    /// Extent of all blocks along gravity [m].
    fall_m: f64,
    gravity_m_s2: f64,
    density_kg_m3: f64,
    young_pa: f64,
    /// Largest initial speed [m/s] and spin [rad/s].
    speed_m_s: f64,
    spin_rad_s: f64,
    /// Largest speed of supports that follow rows of displacements [m/s].
    support_m_s: f64,
    /// Largest load that lasts, and largest blast.
    load: Load,
    blast: Load,
}

impl Sizes {
    fn new(scene: &Scene, blocks: &BlockSet) -> Self {
        let moving = build::moving(scene, blocks);
        let moves: Vec<bool> = moving.iter().map(Option::is_some).collect();
        let extent = Aabb::around(&blocks.rest_position);
        let extent_m = extent.max - extent.min;
        let weighs_more =
            |a: Vec3, b: Vec3| if b.abs().dot(&extent_m) > a.abs().dot(&extent_m) { b } else { a };
        let gravity = pressures::gravities(scene).reduce(weighs_more).expect("a scene has a gravity");
        let (mut volumes, mut height_m, mut materials) = (Vec::new(), f64::INFINITY, Vec::new());
        let mut columns = Vec::new();
        for (block, moves) in blocks.ids().zip(&moving) {
            let Some((material, _)) = moves else { continue };
            materials.push(&scene.materials[*material]);
            let mut volume = 0.0;
            for tet in blocks.tets_of(block) {
                let corners = blocks.tets[tet].map(|n| blocks.rest_position[n.index()]);
                let own = tet_volume(&corners);
                volume += own;
                height_m = height_m.min(height(&corners, own));
            }
            // Blocks of rock that is cut hold each other.
            if block.index() < scene.blocks.len() {
                columns.push((volume, column(blocks, block, volume, &gravity)));
            }
            volumes.push(volume);
        }
        let most = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        let norm = |v: [f64; 3]| Vec3::from(v).norm();
        let small_m3 = small(volumes);
        let block_m = small_m3.cbrt();
        let columns = columns.into_iter().filter(|(volume_m3, _)| *volume_m3 >= small_m3);
        Self {
            block_m,
            column_m: columns.map(|(_, column_m)| column_m).fold(f64::INFINITY, f64::min),
            height_m,
            fall_m: gravity.abs().dot(&extent_m) / gravity.norm().max(f64::MIN_POSITIVE),
            gravity_m_s2: gravity.norm(),
            density_kg_m3: most(&mut materials.iter().map(|material| material.density_kg_m3)),
            young_pa: most(&mut materials.iter().map(|material| material.young_pa)),
            speed_m_s: most(&mut scene.blocks.iter().map(|block| norm(block.velocity_m_s))),
            spin_rad_s: most(&mut scene.blocks.iter().map(|block| norm(block.spin_rad_s))),
            support_m_s: pressures::speed_of_supports_m_s(scene),
            load: pressures::at_rest(scene, blocks, &moves, block_m),
            blast: pressures::of_blasts(scene, block_m),
        }
    }

    /// Largest pressure of weight and loads at rest [Pa].
    fn rest_pa(&self) -> f64 {
        self.weight_pa() + self.load.pa
    }

    fn weight_pa(&self) -> f64 {
        self.density_kg_m3 * self.gravity_m_s2 * self.fall_m
    }

    /// What presses on contacts beside a load, in words.
    fn weight_and(&self, load: &Load) -> String {
        match (self.fall_m > 0.0, load.pa > 0.0) {
            (false, true) => load.in_words(),
            (_, true) => format!("the weight of rock {} high and {}", metres(self.fall_m), load.in_words()),
            (_, false) => format!("the weight of rock {} high", metres(self.fall_m)),
        }
    }
}

/// 3 b²/H of a block, from the box of the same second moments: H is its side that is nearest to gravity, b the shorter of the others.
fn column(blocks: &BlockSet, block: BlockId, volume_m3: f64, gravity: &Vec3) -> f64 {
    let corners = |tet: usize| blocks.tets[tet].map(|n| blocks.rest_position[n.index()]);
    let centre_of = |corners: &[Vec3; 4]| corners.iter().sum::<Vec3>() / 4.0;
    let weighted = blocks.tets_of(block).map(|tet| tet_volume(&corners(tet)) * centre_of(&corners(tet)));
    let centre = weighted.sum::<Vec3>() / volume_m3;
    let mut moment = Mat3::zeros();
    for tet in blocks.tets_of(block) {
        let arms = corners(tet).map(|x| x - centre);
        let sum: Vec3 = arms.iter().sum();
        let squares = arms.iter().map(|x| x * x.transpose()).sum::<Mat3>() + sum * sum.transpose();
        moment += tet_volume(&corners(tet)) / 20.0 * squares;
    }
    let eigen = (moment / volume_m3).symmetric_eigen();
    let side = |k: usize| (12.0 * eigen.eigenvalues[k].max(0.0)).sqrt();
    let along = |k: usize| eigen.eigenvectors.column(k).dot(gravity).abs();
    let up = (0..3).max_by(|a, b| along(*a).total_cmp(&along(*b))).expect("there are three axes");
    let width_m = (0..3).filter(|k| *k != up).map(side).fold(f64::INFINITY, f64::min);
    SLENDER * width_m * width_m / side(up)
}

/// Smallest height of a tetrahedron [m].
fn height(corners: &[Vec3; 4], volume_m3: f64) -> f64 {
    let faces = [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]];
    let area = |face: [usize; 3]| triangle_area_vector(&face.map(|i| corners[i])).norm();
    3.0 * volume_m3 / faces.into_iter().map(area).fold(0.0, f64::max)
}

/// The volume of the block below which lies a twentieth of all; 1 m³ where nothing moves.
fn small(mut volumes: Vec<f64>) -> f64 {
    volumes.sort_by(f64::total_cmp);
    let limit = SMALL * volumes.iter().sum::<f64>();
    let mut below = 0.0;
    for volume in volumes {
        below += volume;
        if below >= limit {
            return volume;
        }
    }
    1.0
}

/// How deep contact lies at rest.
pub(crate) struct Resting {
    /// Overlap over the size of blocks, at most.
    pub overlap: f64,
    /// The rock and loads above, as a phrase for a message.
    pub under: String,
    /// The penalty with which the overlap is the `depth_ratio` of the scene [Pa].
    pub penalty_pa: f64,
}

/// How deep contact lies under weight and loads; none where nothing presses, or its stiffness depends on the mesh.
pub(crate) fn resting(scene: &Scene, blocks: &BlockSet) -> Option<Resting> {
    let Some(Contact::Potential { penalty_pa, potential, depth_ratio, .. }) = &scene.contact else {
        return None;
    };
    let reference_m = potential.reference_m()?;
    let sizes = Sizes::new(scene, blocks);
    let overlap = reference_m * sizes.rest_pa() / (2.0 * penalty_pa * sizes.block_m);
    let penalty_pa = rounded_up(penalty_pa * overlap / depth_ratio);
    (overlap > 0.0).then(|| Resting { overlap, under: sizes.weight_and(&sizes.load), penalty_pa })
}

/// Chooses the penalty where it is left out.
fn penalty(scene: &mut Scene, sizes: &Sizes) -> Option<Chosen> {
    // Where nothing moves, any penalty serves.
    let of_all = scene.materials.iter().map(|material| material.young_pa).fold(0.0, f64::max);
    let Some(Contact::Potential { penalty_pa, potential, depth_ratio, .. }) = &mut scene.contact else {
        return None;
    };
    if !is_unset(penalty_pa) {
        return None;
    }
    let length_m = potential.reference_m().unwrap_or(0.25 * sizes.height_m);
    if sizes.young_pa == 0.0 {
        *penalty_pa = rounded_up(OF_YOUNG * of_all);
        let reason = format!("{NOTHING_MOVES}; {OF_YOUNG:e} of Young's modulus");
        return Some(Chosen { path: "contact.penalty_pa".into(), value: *penalty_pa, reason });
    }
    let Sizes { block_m, column_m, density_kg_m3: rho, .. } = *sizes;
    let load = pressures::larger(&sizes.load, &sizes.blast);
    let v = sizes.speed_m_s.max(sizes.support_m_s);
    let (impact_pa, rest_pa) = (rho * v * v, sizes.weight_pa() + load.pa);
    let pressure_pa = impact_pa + 2.0 * rest_pa;
    let weight = sizes.weight_and(load);
    // Columns matter where they rest on each other, and lean.
    let is_slender = column_m < block_m && sizes.rest_pa() > 0.0;
    let overlaps_m = if is_slender { column_m } else { block_m };
    let shallow_pa = length_m * pressure_pa / (2.0 * *depth_ratio * overlaps_m);
    let stiff_pa = MOST_OF_YOUNG * sizes.young_pa * length_m / overlaps_m;
    let (value, why) = if pressure_pa <= 0.0 {
        let why = "no loads and no speeds: ";
        (
            OF_YOUNG / MOST_OF_YOUNG * stiff_pa,
            format!("{why}{OF_YOUNG:e} of Young's modulus for blocks of {}", metres(block_m)),
        )
    } else if shallow_pa > stiff_pa {
        (
            stiff_pa,
            format!(
                "as stiff as half a block of {}; blocks overlap by at most {:.0e} of their size at rest under {}",
                metres(overlaps_m),
                length_m * pressure_pa / (2.0 * rounded_up(stiff_pa) * overlaps_m),
                weight
            ),
        )
    } else {
        let size = metres(overlaps_m);
        let why = match is_slender {
            _ if rest_pa == 0.0 => format!(
                "blocks of {size} that meet at {v:.2} m/s overlap by at most {:.0e} of their size",
                depth_ratio.sqrt()
            ),
            true => format!(
                "so that columns hardly lean: contact at rest under {weight} is at most {depth_ratio:e} of {size} deep; {size} is 3 × width²/height of the slenderest"
            ),
            false => format!(
                "blocks of {size} overlap by at most {depth_ratio:e} of their size at rest under {weight}"
            ),
        };
        (shallow_pa, why)
    };
    *penalty_pa = rounded_up(value);
    Some(Chosen { path: "contact.penalty_pa".into(), value: *penalty_pa, reason: why })
}

/// Chooses the step, and gives the blocks back.
fn step_of(
    scene: &mut Scene,
    sizes: &Sizes,
    blocks: BlockSet,
    folder: &Path,
) -> Result<(Chosen, BlockSet), Vec<Fault>> {
    let end_s = scene.time.end_s;
    let mut limits = vec![(end_s / FEWEST_STEPS, "a hundredth of the run".to_string())];
    limits.extend(loads::limits(scene, sizes.block_m, sizes.density_kg_m3));
    if sizes.speed_m_s > 0.0 && sizes.height_m.is_finite() {
        let way_s = WAY * sizes.height_m / sizes.speed_m_s;
        limits.push((way_s, "blocks move by a tenth of the height of a tetrahedron in one step".into()));
    }
    if sizes.spin_rad_s > 0.0 {
        limits.push((TURN / sizes.spin_rad_s, "blocks rotate by 0.05 rad in one step".into()));
    }
    // Any step serves to ask for the stability of contact, which does not depend on it.
    scene.time.step_s = limits[0].0;
    let mut asked = scene.clone();
    // Schemes that are stable with any step resolve contact with those of the default one.
    if matches!(scene.time.integrator, Integrator::Newmark { .. })
        || scene.time.contact_at != ContactAt::Predicted
    {
        (asked.time.integrator, asked.time.contact_at) = Default::default();
    }
    let mut simulation = build::simulation(&asked, blocks, folder)?;
    if let Some(advice) = step::advise(&asked, &mut simulation) {
        let block = &advice.worst().block;
        limits.push((
            OF_ADVISED * advice.step_s,
            format!("a quarter of the largest stable step of contact, at block `{block}`"),
        ));
    }
    limits.extend(waves::steps::limits(&simulation));
    let least = limits.into_iter().reduce(|a, b| if b.0 < a.0 { b } else { a });
    let (step_s, reason) = least.expect("there is one limit at least");
    scene.time.step_s = rounded_down(step_s);
    let chosen = Chosen { path: "time.step_s".into(), value: scene.time.step_s, reason };
    Ok((chosen, simulation.into_blocks()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sliver_does_not_decide_on_the_size_of_blocks() {
        assert_eq!(small(vec![1e-9, 1.0, 1.0, 1.0]), 1.0);
        assert_eq!(small(vec![0.5, 1.0, 1.0]), 0.5);
        assert_eq!(small(Vec::new()), 1.0);
    }
}
