//! Whether a line on the map meets the terrain.

use super::terrain::Terrain;

impl Terrain {
    /// Whether a line through corners passes over some cell that has heights.
    pub fn is_crossed_by(&self, line_m: &[[f64; 2]]) -> bool {
        line_m.windows(2).any(|piece| self.crosses([piece[0], piece[1]]))
    }

    /// Whether a straight piece does: it is cut where it passes from cell to cell, and the middle of each part is looked at.
    fn crosses(&self, piece_m: [[f64; 2]; 2]) -> bool {
        let steps = piece_m.map(|at| [0, 1].map(|axis| (at[axis] - self.origin_m[axis]) / self.step_m[axis]));
        let along = [0, 1].map(|axis| steps[1][axis] - steps[0][axis]);
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for (axis, &last) in self.cells().iter().enumerate() {
            let ends = [0.0, last as f64].map(|end| (end - steps[0][axis]) / along[axis]);
            if along[axis] == 0.0 {
                if !(0.0..=last as f64).contains(&steps[0][axis]) {
                    return false;
                }
                continue;
            }
            (from, to) = (from.max(ends[0].min(ends[1])), to.min(ends[0].max(ends[1])));
        }
        if from.is_nan() || to.is_nan() || from > to {
            return false;
        }
        let mut cuts = vec![from, to];
        for (axis, &last) in self.cells().iter().enumerate().filter(|(axis, _)| along[*axis] != 0.0) {
            let cuts_of_axis = (0..=last).map(|line| (line as f64 - steps[0][axis]) / along[axis]);
            cuts.extend(cuts_of_axis.filter(|part| (from..=to).contains(part)));
        }
        cuts.sort_by(f64::total_cmp);
        cuts.windows(2).any(|part| {
            let middle = 0.5 * (part[0] + part[1]);
            self.at(self.map_m([0, 1].map(|axis| steps[0][axis] + middle * along[axis]))).is_some()
        })
    }

    /// That a line is not on the terrain.
    pub(super) fn is_missed_by(&self, what: &str) -> String {
        let [[west, south], [east, north]] = self.bounds_m();
        format!(
            "{what} is nowhere on the terrain, which reaches from ({west}, {south}) to ({east}, {north}) m"
        )
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use ndda_io::scene::Ground;

    use super::*;

    #[test]
    fn a_line_meets_the_terrain_where_it_passes_over_a_cell_with_heights() {
        let ground =
            Ground::Heights { origin_m: [100.0, 0.0], step_m: [10.0; 2], heights_m: vec![vec![0.0; 11]; 6] };
        let terrain = Terrain::new(&ground, Path::new("."), (&[], None)).expect("a grid");
        for (line, meets) in [
            (vec![[150.0, -20.0], [150.0, 70.0]], true),
            (vec![[120.0, 25.0], [121.0, 25.0]], true),
            (vec![[1300.0, 0.0], [1300.0, 50.0]], false),
            (vec![[90.0, 0.0], [90.0, 50.0]], false),
            // Around the south-eastern corner, and across it.
            (vec![[195.0, -6.0], [206.0, 5.0]], false),
            (vec![[195.0, -4.0], [204.0, 5.0]], true),
            (vec![[-1e300, 25.0], [1e300, 25.0]], true),
            (vec![[90.0, -10.0], [90.0, 60.0], [110.0, 60.0], [110.0, 40.0]], true),
        ] {
            assert_eq!(terrain.is_crossed_by(&line), meets, "{line:?}");
        }
    }
}
