//! Quality of tetrahedra, and a report on the meshes of many blocks.

use std::fmt;

use serde::Serialize;

use crate::geometry::{TET_FACES, tet_heights, tet_volume, triangle_area_vector};
use crate::validate::longest_edge;
use crate::{BlockMesh, Vec3};

/// Which faces, by the corner opposite to them, meet at the edges 01, 02, 03, 12, 13, 23.
const FACES_OF_EDGES: [[usize; 2]; 6] = [[2, 3], [1, 3], [1, 2], [0, 3], [0, 2], [0, 1]];
/// How many of the worst tetrahedra a report lists.
const LISTED: usize = 10;
/// Width of a bar of the histogram of smallest dihedral angles [°]; the regular tetrahedron has 70.5°.
const BAR_DEG: f64 = 5.0;
/// Most bars of a histogram whose borders double.
const MOST_BARS: i32 = 64;
/// Longest bar, in characters.
const LONGEST_BAR: usize = 40;

/// Smallest sine of the six dihedral angles, with the sign of the volume: sin θ = 3 V l / (2 A₁ A₂).
///
/// 0 for a flat tetrahedron, 0.943 for the regular one. What is not finite counts as flat.
pub fn least_sine(corners: &[Vec3; 4]) -> f64 {
    // Written out, with squares and one root at the end: this is what improving a mesh spends its time on.
    let [a, b, c, d] = corners;
    let (ab, ac, ad, bc, bd, cd) = (b - a, c - a, d - a, c - b, d - b, d - c);
    let per_area2 = |u: &Vec3, v: &Vec3| 4.0 / u.cross(v).norm_squared();
    let (opposite_a, opposite_b) = (per_area2(&bc, &bd), per_area2(&ac, &ad));
    let (opposite_c, opposite_d) = (per_area2(&ab, &ad), per_area2(&ab, &ac));
    let least = (ab.norm_squared() * opposite_c * opposite_d)
        .min(ac.norm_squared() * opposite_b * opposite_d)
        .min(ad.norm_squared() * opposite_b * opposite_c)
        .min(bc.norm_squared() * opposite_a * opposite_d)
        .min(bd.norm_squared() * opposite_a * opposite_c)
        .min(cd.norm_squared() * opposite_a * opposite_b);
    let sine = 1.5 * tet_volume(corners) * least.sqrt();
    if sine.is_finite() { sine } else { 0.0 }
}

/// The six dihedral angles [°], in the order of edges 01, 02, 03, 12, 13, 23.
pub fn dihedral_angles_deg(corners: &[Vec3; 4]) -> [f64; 6] {
    let outward = TET_FACES.map(|face| triangle_area_vector(&face.map(|i| corners[i])));
    FACES_OF_EDGES.map(|[k, l]| {
        let (a, b) = (outward[k], outward[l]);
        a.cross(&b).norm().atan2(-a.dot(&b)).to_degrees()
    })
}

/// One tetrahedron in numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TetQuality {
    /// Name of the block.
    pub block: String,
    /// Index in the block.
    pub tet: u32,
    /// Centroid [m].
    pub at_m: [f64; 3],
    /// Smallest dihedral angle [°].
    pub dihedral_deg: f64,
    /// Largest dihedral angle [°].
    pub largest_dihedral_deg: f64,
    /// Longest edge over smallest height: 1.22 for the regular tetrahedron.
    pub aspect: f64,
    /// Smallest height [m].
    pub height_m: f64,
}

/// A histogram by fixed borders: bar i counts values from border i up to border i + 1, the last one all from there.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Histogram {
    /// Lower borders, rising.
    pub borders: Vec<f64>,
    /// Values per bar; those below the first border are in the first bar.
    pub counts: Vec<usize>,
}

impl Histogram {
    fn new(borders: Vec<f64>) -> Self {
        let counts = vec![0; borders.len()];
        Self { borders, counts }
    }

    /// Of values above 0, with borders that double: from the least up, or, if those were more than `most_bars`, from
    /// the largest down. Values that are not above 0 are in the first bar.
    pub fn doubling(values: &[f64], most_bars: i32) -> Self {
        let positive = values.iter().copied().filter(|v| *v > 0.0);
        let (least, most) = positive.fold((f64::INFINITY, 0.0), |(a, b): (f64, f64), v| (a.min(v), b.max(v)));
        let mut histogram = Self::new(vec![0.0]);
        if least.is_finite() && most.is_finite() {
            let wanted = (most / least).log2().floor() as i32 + 1;
            let bars = wanted.clamp(1, most_bars);
            let first = if wanted > bars { most * 2f64.powi(1 - bars) } else { least };
            histogram = Self::new((0..bars).map(|i| first * 2f64.powi(i)).collect());
        }
        values.iter().for_each(|&value| histogram.add(value));
        histogram
    }

    fn add(&mut self, value: f64) {
        let bar = self.borders.partition_point(|border| *border <= value);
        self.counts[bar.saturating_sub(1)] += 1;
    }

    /// Prints the bars that are not empty.
    ///
    /// # Errors
    /// Errors of the formatter.
    pub fn show(&self, f: &mut fmt::Formatter<'_>, title: &str) -> fmt::Result {
        let most = self.counts.iter().copied().max().unwrap_or(0).max(1);
        writeln!(f, "{title}")?;
        for (i, count) in self.counts.iter().enumerate().filter(|(_, count)| **count > 0) {
            let bar = "#".repeat((count * LONGEST_BAR).div_ceil(most));
            let from = short(self.borders[i]);
            match self.borders.get(i + 1) {
                Some(&to) => writeln!(f, "  {from:>9} to {:<9} {count:>9} {bar}", short(to))?,
                None => writeln!(f, "  {from:>9} and more   {count:>9} {bar}")?,
            }
        }
        Ok(())
    }
}

/// A number in four figures, without zeros at its end.
fn short(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        v if (1e-3..1e6).contains(&v) => {
            let text = format!("{value:.*}", (3 - v.log10().floor() as i32).max(0) as usize);
            if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
        }
        _ => format!("{value:.3e}"),
    }
}

/// Quality of the tetrahedra of many blocks; printed, it is histograms and the worst ten.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct QualityReport {
    /// Number of tetrahedra.
    pub tets: usize,
    /// Smallest dihedral angle of each [°], in bars of 5°.
    pub dihedral_deg: Histogram,
    /// Longest edge over smallest height, in bars that double.
    pub aspect: Histogram,
    /// Smallest height [m], in bars that double, from that of the worst up.
    pub height_m: Histogram,
    /// Up to ten with the smallest dihedral angles, worst first.
    pub worst: Vec<TetQuality>,
}

/// Measures named blocks. Tetrahedra that name missing nodes are left out; `validate` names them.
pub fn quality<'a>(blocks: impl IntoIterator<Item = (&'a str, &'a BlockMesh)>) -> QualityReport {
    let mut heights = Vec::new();
    let bars = (0..15).map(|i| BAR_DEG * f64::from(i)).collect();
    let mut report = QualityReport {
        tets: 0,
        dihedral_deg: Histogram::new(bars),
        aspect: Histogram::new((0..20).map(|i| 2f64.powi(i)).collect()),
        height_m: Histogram::default(),
        worst: Vec::new(),
    };
    for (block, mesh) in blocks {
        for (tet, nodes) in (0..).zip(&mesh.tets) {
            let Some(measured) = measure(block, tet, mesh, nodes) else { continue };
            report.tets += 1;
            report.dihedral_deg.add(measured.dihedral_deg);
            report.aspect.add(measured.aspect);
            heights.push(measured.height_m);
            let at = report.worst.partition_point(|w| w.dihedral_deg <= measured.dihedral_deg);
            if at < LISTED {
                report.worst.insert(at, measured);
                report.worst.truncate(LISTED);
            }
        }
    }
    report.height_m = Histogram::doubling(&heights, MOST_BARS);
    report
}

fn measure(block: &str, tet: u32, mesh: &BlockMesh, nodes: &[u32; 4]) -> Option<TetQuality> {
    let mut corners = [Vec3::zeros(); 4];
    for (corner, node) in corners.iter_mut().zip(nodes) {
        *corner = *mesh.nodes.get(*node as usize)?;
    }
    let angles = dihedral_angles_deg(&corners);
    let heights_m = tet_heights(&corners);
    // Without a face of an area there are no angles, and what is not finite counts as flat.
    let has_faces = heights_m.iter().all(|height_m| height_m.is_finite());
    let height_m = if has_faces { heights_m.into_iter().fold(f64::INFINITY, f64::min) } else { 0.0 };
    let angles = if has_faces { angles } else { [0.0; 6] };
    let (least, most) = angles.into_iter().fold((180.0, 0.0), |(a, b): (f64, f64), x| (a.min(x), b.max(x)));
    let is_inverted = tet_volume(&corners) < 0.0;
    Some(TetQuality {
        block: block.into(),
        tet,
        at_m: (corners.iter().sum::<Vec3>() / 4.0).into(),
        dihedral_deg: if is_inverted { -least } else { least },
        largest_dihedral_deg: most,
        aspect: longest_edge(&corners) / height_m,
        height_m,
    })
}

impl fmt::Display for QualityReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.dihedral_deg.show(f, "tetrahedra by smallest dihedral angle [°]")?;
        self.aspect.show(f, "tetrahedra by longest edge over smallest height (1.22 at best)")?;
        self.height_m.show(f, "tetrahedra by smallest height [m]")?;
        writeln!(f, "worst tetrahedra: dihedral angles, longest edge over smallest height, smallest height")?;
        for w in &self.worst {
            let [x, y, z] = w.at_m;
            writeln!(
                f,
                "  tetrahedron {} of {:?} at ({x:.4}, {y:.4}, {z:.4}) m: {:.2}° to {:.2}°, {:.1}, {} m",
                w.tet,
                w.block,
                w.dihedral_deg,
                w.largest_dihedral_deg,
                w.aspect,
                short(w.height_m)
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{BoxPattern, box_block};

    fn regular() -> [Vec3; 4] {
        [[1.0, 1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [-1.0, -1.0, 1.0]].map(Vec3::from)
    }

    #[test]
    fn the_regular_tetrahedron_has_its_known_numbers() {
        let corners = regular();
        assert!((least_sine(&corners) - 8f64.sqrt() / 3.0).abs() < 1e-14);
        let exact = (1f64 / 3.0).acos().to_degrees();
        assert!(dihedral_angles_deg(&corners).iter().all(|angle| (angle - exact).abs() < 1e-12));
        let mesh = BlockMesh { nodes: corners.to_vec(), tets: vec![[0, 1, 2, 3]], ..BlockMesh::default() };
        let report = quality([("a", &mesh)]);
        assert!((report.worst[0].aspect - 1.5f64.sqrt()).abs() < 1e-14);
        assert_eq!(report.dihedral_deg.counts[14], 1);
    }

    #[test]
    fn what_is_no_tetrahedron_is_the_worst_one() {
        let line = [0.0, 1.0, 2.0, 3.0].map(|x| Vec3::new(x, 0.0, 0.0));
        let missing = [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::new(0.0, f64::NAN, 1.0)];
        for corners in [line, missing] {
            let mut nodes = regular().to_vec();
            nodes.extend(corners);
            let mesh = BlockMesh { nodes, tets: vec![[0, 1, 2, 3], [4, 5, 6, 7]], ..BlockMesh::default() };
            let report = quality([("a", &mesh)]);
            assert_eq!(
                (report.worst[0].tet, report.worst[0].dihedral_deg, report.worst[0].height_m),
                (1, 0.0, 0.0)
            );
            assert_eq!(report.dihedral_deg.counts[0], 1);
        }
    }

    #[test]
    fn bars_are_named_by_both_of_their_borders() {
        let shown = quality([("a", &box_block([1.0; 3], [1; 3], BoxPattern::Six).unwrap())]).to_string();
        assert!(shown.contains("         45 to 50                6 ####"), "{shown}");
        let numbers = [0.0, 5.0, 0.120_56, 128.0, 1234.6, 2e6, 4.2e-5].map(short);
        assert_eq!(numbers, ["0", "5", "0.1206", "128", "1235", "2.000e6", "4.200e-5"]);
    }

    #[test]
    fn the_sine_is_that_of_the_angles() {
        let corners = [[0.0, 0.0, 0.0], [2.0, 0.1, 0.0], [0.3, 1.0, 0.2], [0.4, 0.3, 0.7]].map(Vec3::from);
        let least = dihedral_angles_deg(&corners).map(|angle| angle.to_radians().sin());
        assert!((least_sine(&corners) - least.into_iter().fold(1.0, f64::min)).abs() < 1e-14);
        let [a, b, c, d] = corners;
        assert!(least_sine(&[b, a, c, d]) < 0.0);
    }

    #[test]
    fn the_worst_ten_are_listed_with_their_block_and_place() {
        let good = box_block([1.0; 3], [2; 3], BoxPattern::TwentyFour).unwrap();
        let thin = box_block([1.0, 1.0, 0.01], [1; 3], BoxPattern::Six).unwrap();
        let report = quality([("good", &good), ("thin", &thin)]);
        assert_eq!((report.tets, report.worst.len()), (198, 10));
        assert!(report.worst[..6].iter().all(|w| w.block == "thin") && report.worst[9].block == "good");
        assert_eq!(report.height_m.counts.iter().sum::<usize>(), 198);
        assert!(report.to_string().contains("tetrahedron 0 of \"thin\""));
    }

    #[test]
    fn flat_inverted_and_broken_tetrahedra_are_measured_without_panic() {
        let mut mesh = box_block([1.0; 3], [1; 3], BoxPattern::Six).unwrap();
        mesh.tets[0].swap(0, 1);
        mesh.tets[1] = [0, 0, 1, 2];
        mesh.tets[2] = [0, 1, 2, 99];
        mesh.nodes[6].x = f64::NAN;
        let report = quality([("a", &mesh)]);
        assert_eq!(report.tets, 5);
        assert!(!report.to_string().is_empty());
    }
}
