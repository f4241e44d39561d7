//! What a set of blocks amounts to.

use std::fmt;

use ndda_mesh::BlockMesh;
use ndda_mesh::quality::{Histogram, quality};
use ndda_mesh::stats::stats;
use ndda_mesh::validate::problems;
use serde::Serialize;

use crate::wiring::RockReport;

/// Longest bar, in characters.
const LONGEST_BAR: usize = 40;
/// Most bars of the histogram of volumes.
const MOST_BARS: i32 = 24;

/// Counts, sizes and quality of blocks.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MeshReport {
    /// Number of blocks.
    pub blocks: usize,
    /// Number of nodes.
    pub nodes: usize,
    /// Number of tetrahedra.
    pub tets: usize,
    /// Number of boundary triangles.
    pub triangles: usize,
    /// Volume of all blocks [m³].
    pub volume_m3: f64,
    /// Sizes of blocks.
    pub block_size: BlockSizes,
    /// Smallest dihedral angle of each tetrahedron [°].
    pub dihedral_deg: Bars,
    /// Longest edge over smallest height of each tetrahedron.
    pub aspect: Bars,
    /// Smallest height of each tetrahedron [m].
    pub height_m: Bars,
    /// The tetrahedra with the smallest dihedral angles, worst first.
    pub worst: Vec<Worst>,
    /// What each rock was cut into.
    pub rock: Vec<RockReport>,
    /// What `--fix` did.
    pub fixes: Vec<String>,
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
    pub volume_m3: Bars,
}

/// A histogram: bar i counts from border i to border i + 1.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Bars {
    /// Lower borders.
    pub from: Vec<f64>,
    /// Counts.
    pub counts: Vec<usize>,
}

/// A tetrahedron and its place.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Worst {
    /// Its block.
    pub block: String,
    /// Its index there.
    pub tet: u32,
    /// Its centroid [m].
    pub at_m: [f64; 3],
    /// Smallest dihedral angle [°].
    pub dihedral_deg: f64,
    /// Longest edge over smallest height.
    pub aspect: f64,
    /// Smallest height [m].
    pub height_m: f64,
}

impl MeshReport {
    /// Measures blocks; those with defects count in nodes, tetrahedra and quality only.
    pub fn new(meshes: &[(String, BlockMesh)], rock: Vec<RockReport>, fixes: Vec<String>) -> Self {
        let report = quality(meshes.iter().map(|(name, mesh)| (name.as_str(), mesh)));
        let sound: Vec<_> = meshes.iter().filter(|(_, mesh)| problems(mesh).is_empty()).collect();
        let measured: Vec<_> = sound.iter().map(|(name, mesh)| (stats(mesh), name)).collect();
        let worst = report.worst.iter().map(|w| Worst {
            block: w.block.clone(),
            tet: w.tet,
            at_m: w.at_m.into(),
            dihedral_deg: w.dihedral_deg,
            aspect: w.aspect,
            height_m: w.height_m,
        });
        Self {
            blocks: meshes.len(),
            nodes: meshes.iter().map(|(_, mesh)| mesh.nodes.len()).sum(),
            tets: meshes.iter().map(|(_, mesh)| mesh.tets.len()).sum(),
            triangles: measured.iter().map(|(stats, _)| stats.triangles).sum(),
            // The empty sum is −0.
            volume_m3: measured.iter().map(|(stats, _)| stats.volume_m3).sum::<f64>() + 0.0,
            block_size: sizes(
                measured.iter().map(|(stats, name)| (stats.volume_m3, name.as_str())).collect(),
            ),
            dihedral_deg: Bars::from(&report.dihedral_deg),
            aspect: Bars::from(&report.aspect),
            height_m: Bars::from(&report.height_m),
            worst: worst.collect(),
            rock,
            fixes,
        }
    }

    /// The report as JSON.
    pub fn json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_else(|error| format!("{{\"error\": \"{error}\"}}"))
    }
}

fn sizes(mut volumes: Vec<(f64, &str)>) -> BlockSizes {
    volumes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (Some(first), Some(last)) = (volumes.first(), volumes.last()) else { return BlockSizes::default() };
    let bars = ((last.0 / first.0).log2().floor() as i32 + 1).clamp(1, MOST_BARS);
    // Borders double down from the largest, so that slivers, however small, share the first bar.
    let from: Vec<f64> =
        (0..bars).map(|i| first.0.max(last.0 * 2f64.powi(1 - bars)) * 2f64.powi(i)).collect();
    let mut counts = vec![0; from.len()];
    for (volume, _) in &volumes {
        counts[from.partition_point(|border| border <= volume).saturating_sub(1)] += 1;
    }
    BlockSizes {
        smallest_m3: (first.0, first.1.into()),
        median_m3: volumes[volumes.len() / 2].0,
        largest_m3: (last.0, last.1.into()),
        volume_m3: Bars { from, counts },
    }
}

impl From<&Histogram> for Bars {
    fn from(histogram: &Histogram) -> Self {
        Self { from: histogram.borders.clone(), counts: histogram.counts.clone() }
    }
}

impl Bars {
    fn show(&self, f: &mut fmt::Formatter<'_>, title: &str) -> fmt::Result {
        let most = self.counts.iter().copied().max().unwrap_or(0).max(1);
        writeln!(f, "{title}")?;
        for (from, count) in self.from.iter().zip(&self.counts).filter(|(_, count)| **count > 0) {
            writeln!(
                f,
                "  from {from:>9.3e} {count:>9} {}",
                "#".repeat((count * LONGEST_BAR).div_ceil(most))
            )?;
        }
        Ok(())
    }
}

impl fmt::Display for MeshReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.fixes.iter().try_for_each(|fix| writeln!(f, "fixed {fix}"))?;
        let Self { blocks, nodes, tets, triangles, volume_m3, block_size: size, .. } = self;
        writeln!(
            f,
            "{blocks} block(s), {nodes} nodes, {tets} tets, {triangles} boundary triangles, {volume_m3:.6e} m³"
        )?;
        for rock in &self.rock {
            writeln!(f, "{rock}")?;
        }
        let ((smallest, first), (largest, last)) = (&size.smallest_m3, &size.largest_m3);
        writeln!(
            f,
            "blocks of {smallest:.3e} m³ ({first}) to {largest:.3e} m³ ({last}), median {:.3e} m³",
            size.median_m3
        )?;
        size.volume_m3.show(f, "volume of blocks [m³]")?;
        self.dihedral_deg.show(f, "smallest dihedral angle of tetrahedra [°]")?;
        self.aspect.show(f, "longest edge over smallest height")?;
        self.height_m.show(f, "smallest height [m]")?;
        writeln!(f, "worst")?;
        for w in &self.worst {
            let [x, y, z] = w.at_m;
            writeln!(
                f,
                "  tet {} of {} at ({x:.4}, {y:.4}, {z:.4}) m: {:.2}°, aspect {:.1}, height {:.3e} m",
                w.tet, w.block, w.dihedral_deg, w.aspect, w.height_m
            )?;
        }
        Ok(())
    }
}
