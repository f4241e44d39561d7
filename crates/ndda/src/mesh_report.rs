//! The report of a set of blocks.

use std::fmt;
use std::path::Path;

use ndda_io::scene::Scene;
use ndda_mesh::quality::{Histogram, QualityReport, quality};
use ndda_mesh::stats::stats;
use ndda_mesh::validate::problems;
use ndda_mesh::{BlockMesh, BlockSet, MeshError, MeshProblem};
use serde::Serialize;

use crate::build::RockReport;
use crate::forecast::step::{self, AdvisedStep};
use crate::forecast::{gaps, held, slivers};
use crate::numbers::{counted, four_figures};

/// Most bars of the histogram of volumes.
const MOST_BARS: i32 = 24;

/// All defects of blocks, and what may cure them.
pub fn refusal(input: &Path, error: &MeshError) -> String {
    let line = |(block, problem): &(String, _)| format!("\n  {block}: {problem}");
    let lines: String = error.problems.iter().map(line).collect();
    format!("{} is not fit to run:{lines}{}", input.display(), fixes(error))
}

/// What `--fix` can do about defects of blocks, in a line; nothing about others.
fn fixes(error: &MeshError) -> String {
    let has = |is: fn(&MeshProblem) -> bool| error.problems.iter().any(|(_, problem)| is(problem));
    let orient = has(|problem| matches!(problem, MeshProblem::Inverted(_)));
    let merge = has(|problem| matches!(problem, MeshProblem::Coincident { .. }));
    let orient = orient.then_some("--fix orient turns inverted tetrahedra round");
    let merge = merge.then_some("--fix merge joins coincident nodes");
    let words: Vec<&str> = orient.into_iter().chain(merge).collect();
    if words.is_empty() { String::new() } else { format!("\n  {}", words.join(", ")) }
}

/// Counts, sizes and quality of blocks.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MeshReport {
    /// Number of blocks.
    pub blocks: usize,
    /// Number of nodes.
    pub nodes: usize,
    /// Number of boundary triangles.
    pub triangles: usize,
    /// Volume of all blocks [m³].
    pub volume_m3: f64,
    /// Sizes of blocks.
    pub block_size: BlockSizes,
    /// Number and quality of the tetrahedra.
    #[serde(flatten)]
    pub quality: QualityReport,
    /// Steps that contact requires; empty without a scene, or where contact is stable at any step.
    pub steps: Vec<AdvisedStep>,
    /// The cut of each rock.
    pub rock: Vec<RockReport>,
    /// Changes made by `--fix`.
    pub fixes: Vec<String>,
    /// Blocks of a scene that nothing holds, or that may leave through the rim of the model.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
}

/// Volumes of blocks.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct BlockSizes {
    /// Smallest volume [m³] and its block.
    pub smallest_m3: (f64, String),
    /// The volume that half of the blocks are below [m³].
    pub median_m3: f64,
    /// Largest volume [m³] and its block.
    pub largest_m3: (f64, String),
    /// Blocks by volume [m³], in bars that double.
    pub volume_m3: Histogram,
}

impl MeshReport {
    /// Measures blocks; those with defects count in nodes, tetrahedra and quality only.
    pub fn new(meshes: &[(String, BlockMesh)]) -> Self {
        let quality = quality(meshes.iter().map(|(name, mesh)| (name.as_str(), mesh)));
        let sound: Vec<_> = meshes.iter().filter(|(_, mesh)| problems(mesh).is_empty()).collect();
        let measured: Vec<_> = sound.iter().map(|(name, mesh)| (stats(mesh), name)).collect();
        Self {
            blocks: meshes.len(),
            nodes: meshes.iter().map(|(_, mesh)| mesh.nodes.len()).sum(),
            triangles: measured.iter().map(|(stats, _)| stats.triangles).sum(),
            // The empty sum is −0.
            volume_m3: measured.iter().map(|(stats, _)| stats.volume_m3).sum::<f64>() + 0.0,
            block_size: sizes(
                measured.iter().map(|(stats, name)| (stats.volume_m3, name.as_str())).collect(),
            ),
            quality,
            steps: Vec::new(),
            rock: Vec::new(),
            fixes: Vec::new(),
            warnings: Vec::new(),
        }
    }

    /// Adds what the scene of the blocks says about them.
    pub fn of_scene(&mut self, scene: &Scene, blocks: &BlockSet) {
        self.steps = step::advise_materials(scene, blocks);
        self.warnings = held::sentences(scene, blocks);
        self.warnings.extend(slivers::sentences(&self.rock));
        self.warnings.extend(gaps::sentences(&self.rock));
    }

    /// The report as JSON.
    pub fn json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_else(|error| format!("{{\"error\": \"{error}\"}}"))
    }
}

fn sizes(mut volumes: Vec<(f64, &str)>) -> BlockSizes {
    volumes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (Some(first), Some(last)) = (volumes.first(), volumes.last()) else { return BlockSizes::default() };
    let alone: Vec<f64> = volumes.iter().map(|(volume, _)| *volume).collect();
    BlockSizes {
        smallest_m3: (first.0, first.1.into()),
        median_m3: volumes[volumes.len() / 2].0,
        largest_m3: (last.0, last.1.into()),
        volume_m3: Histogram::doubling(&alone, MOST_BARS),
    }
}

impl fmt::Display for MeshReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.warnings.iter().try_for_each(|warning| writeln!(f, "warning: {warning}"))?;
        self.fixes.iter().try_for_each(|fix| writeln!(f, "fixed {fix}"))?;
        let Self { blocks, nodes, quality, triangles, volume_m3, block_size: size, .. } = self;
        let tets = counted(quality.tets, "tetrahedron", "tetrahedra");
        writeln!(
            f,
            "{}, {nodes} nodes, {tets}, {triangles} boundary triangles, {} m³",
            counted(*blocks, "block", "blocks"),
            four_figures(*volume_m3)
        )?;
        for rock in &self.rock {
            writeln!(f, "{rock}")?;
        }
        let ((smallest, first), (largest, last)) = (&size.smallest_m3, &size.largest_m3);
        writeln!(
            f,
            "blocks of {} m³ ({first}) to {} m³ ({last}), median {} m³",
            four_figures(*smallest),
            four_figures(*largest),
            four_figures(size.median_m3)
        )?;
        size.volume_m3.show(f, "blocks by volume [m³]")?;
        write!(f, "{quality}")?;
        self.steps.iter().try_for_each(|step| writeln!(f, "{step}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndda_mesh::validate::Found;

    #[test]
    fn only_defects_that_fix_can_mend_are_told_of_it() {
        let told = |problem: MeshProblem| {
            refusal(Path::new("a.msh"), &MeshError { problems: vec![("a".into(), problem)] })
        };
        let one = || [(6, -1.0)].into_iter().collect::<Found<_>>();
        assert!(!told(MeshProblem::Flat(one())).contains("--fix"));
        let inverted = told(MeshProblem::Inverted(one()));
        assert!(inverted.contains("--fix orient") && !inverted.contains("merge"), "{inverted}");
        let pairs = [(0, 1)].into_iter().collect();
        let twice = told(MeshProblem::Coincident { pairs, tolerance_m: 1e-9 });
        assert!(twice.contains("--fix merge") && !twice.contains("orient"), "{twice}");
    }
}
