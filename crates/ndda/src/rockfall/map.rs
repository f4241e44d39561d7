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

/// The map of reach as an ESRI ASCII grid, in the coordinates of the scene; −1 where no boulder was.
pub fn esri_grid(model: &Model, reach: &[f64]) -> String {
    let [nx, ny] = model.reach_cells();
    let [x, y] = model.terrain.origin_m;
    let mut text = format!(
        "ncols {nx}\nnrows {ny}\nxllcorner {x}\nyllcorner {y}\ncellsize {}\nNODATA_value -1\n",
        model.cell_m()
    );
    for row in reach.chunks(nx).rev() {
        let cells: Vec<String> =
            row.iter().map(|&part| if part > 0.0 { format!("{part:.6}") } else { "-1".into() }).collect();
        text += &cells.join(" ");
        text.push('\n');
    }
    text
}
