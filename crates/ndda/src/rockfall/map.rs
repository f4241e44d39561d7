//! Results on the map: runout, and the probability that a cell is reached.

use super::Model;
use super::fall::Fall;

/// Distance on the map from the release of a boulder to its end [m].
pub fn runout_m(fall: &Fall) -> f64 {
    let (Some(start), Some(end)) = (fall.path.first(), fall.path.last()) else { return 0.0 };
    (end.at_m[0] - start.at_m[0]).hypot(end.at_m[1] - start.at_m[1])
}

/// Part of the boulders that were in each cell, row by row from the south.
pub fn reach(model: &Model, falls: &[Fall]) -> Vec<f64> {
    let [nx, ny] = model.reach_cells();
    let mut counts = vec![0u32; nx * ny];
    falls.iter().flat_map(|fall| &fall.cells).for_each(|&cell| counts[cell as usize] += 1);
    let all = falls.len().max(1) as f64;
    counts.into_iter().map(|count| f64::from(count) / all).collect()
}

/// The map of reach as an ESRI ASCII grid, in the coordinates of the terrain's file; 0 where no boulder was, and −1, no data, where the ground has no height.
pub fn esri_grid(model: &Model, reach: &[f64]) -> String {
    let [nx, ny] = model.reach_cells();
    let terrain = &model.terrain;
    let cell_m = model.cell_m();
    let [x, y] = [0, 1].map(|axis| terrain.origin_m[axis] + terrain.zero_m[axis]);
    let mut text =
        format!("ncols {nx}\nnrows {ny}\nxllcorner {x}\nyllcorner {y}\ncellsize {cell_m}\nNODATA_value -1\n");
    for (j, row) in reach.chunks(nx).enumerate().rev() {
        let cell = |(i, &part): (usize, &f64)| {
            let middle = [(0, i), (1, j)].map(|(axis, k)| terrain.origin_m[axis] + (k as f64 + 0.5) * cell_m);
            match part {
                part if part > 0.0 => format!("{part:.6}"),
                _ if terrain.at(middle).is_some() => "0".into(),
                _ => "-1".into(),
            }
        };
        let cells: Vec<String> = row.iter().enumerate().map(cell).collect();
        text += &cells.join(" ");
        text.push('\n');
    }
    text
}
