//! Heights of a surface of triangles, sampled on a grid by vertical rays.

use ndda_mesh::Vec3;

use super::{MOST_HEIGHTS, TerrainGrid};
use crate::mesh::error::{Fault, FileProblem};
use crate::mesh::surface_file::Surface;

/// Samples along the longer side where no distance is given.
const SAMPLES: f64 = 200.0;
/// Heights at one place that differ by less than this part of the extent are the same.
const SAME: f64 = 1e-6;

/// Lowest and highest height of the faces that look down, by place of the grid; none where there is none.
type Below = Vec<Vec<Option<[f64; 2]>>>;

/// Samples the faces that look up, and where there is none, as in a surface of triangles that turn either way, the one that looks down. The base and the walls of
/// a closed surface do not count.
pub(super) fn sample(surface: &Surface, sample_m: Option<f64>) -> Result<TerrainGrid, Fault> {
    let low = surface.vertices.iter().fold(Vec3::repeat(f64::INFINITY), |low, x| low.inf(x));
    let high = surface.vertices.iter().fold(Vec3::repeat(f64::NEG_INFINITY), |high, x| high.sup(x));
    let extent = high - low;
    let step = sample_m.unwrap_or(extent.x.max(extent.y) / SAMPLES);
    let counts = [extent.x, extent.y].map(|side| (side / step * (1.0 + 1e-12)).floor() as u64 + 1);
    let is_step = step > 0.0;
    if !is_step || counts[0] < 2 || counts[1] < 2 || counts[0].saturating_mul(counts[1]) > MOST_HEIGHTS {
        let what = format!("a surface of {:.4} × {:.4} m at every {step} m", extent.x, extent.y);
        return Err(FileProblem::NotRead { what, cure: "give a distance of samples that fits it" }.into());
    }
    let [nx, ny] = counts.map(|n| n as usize);
    let mut grid =
        TerrainGrid { origin_m: [low.x, low.y], step_m: [step; 2], heights_m: vec![vec![None; nx]; ny] };
    let (mut below, same): (Below, f64) = (vec![vec![None; nx]; ny], SAME * extent.amax());
    for face in &surface.faces {
        for k in 1..face.vertices.len().saturating_sub(1) {
            let corners = [0, k, k + 1].map(|c| surface.vertices[face.vertices[c] as usize]);
            add(&mut grid, &mut below, &corners, same)?;
        }
    }
    take_from_below(&mut grid, &below, same)?;
    Ok(grid)
}

/// Gives places without a face that looks up the height of the one that looks down.
fn take_from_below(grid: &mut TerrainGrid, below: &Below, same: f64) -> Result<(), Fault> {
    let TerrainGrid { origin_m, step_m, heights_m } = grid;
    for (j, (heights, below)) in heights_m.iter_mut().zip(below).enumerate() {
        for (i, (height, below)) in heights.iter_mut().zip(below).enumerate() {
            let Some([low, high]) = *below else { continue };
            let [x, y] = [origin_m[0] + i as f64 * step_m[0], origin_m[1] + j as f64 * step_m[1]];
            match *height {
                None if high - low > same => return Err(overhang([x, y], [low, high])),
                None => *height = Some(high),
                Some(up) if high > up + same => {
                    let what = format!(
                        "a triangle at ({x}, {y}) that looks down, at {high} m, over one that looks up, at {up} m"
                    );
                    let cure = "turn the triangles of the closed surface, which look inwards";
                    return Err(FileProblem::NotRead { what, cure }.into());
                }
                Some(_) => {}
            }
        }
    }
    Ok(())
}

fn overhang([x, y]: [f64; 2], [one, other]: [f64; 2]) -> Fault {
    let what = format!("an overhang at ({x}, {y}), with ground at {one} and {other} m");
    FileProblem::NotRead { what, cure: "cut it off: ground has one height at each place" }.into()
}

/// Adds the heights of a triangle at the places of the grid that it is above.
fn add(grid: &mut TerrainGrid, below: &mut Below, [a, b, c]: &[Vec3; 3], same: f64) -> Result<(), Fault> {
    let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if area.is_nan() || area == 0.0 {
        return Ok(());
    }
    let step = grid.step_m[0];
    let [(i0, i1), (j0, j1)] = [0, 1].map(|axis| {
        let along = [a[axis], b[axis], c[axis]].map(|x| (x - grid.origin_m[axis]) / step);
        let (low, high) = (along[0].min(along[1]).min(along[2]), along[0].max(along[1]).max(along[2]));
        let last = if axis == 0 { grid.heights_m[0].len() } else { grid.heights_m.len() } - 1;
        // Places on an edge of triangles are of both, in spite of rounding.
        ((low - 1e-9).ceil().max(0.0) as usize, ((high + 1e-9).floor().max(0.0) as usize).min(last))
    });
    for (j, i) in (j0..=j1).flat_map(|j| (i0..=i1).map(move |i| (j, i))) {
        let [x, y] = [grid.origin_m[0] + i as f64 * step, grid.origin_m[1] + j as f64 * step];
        let of_b = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / area;
        let of_c = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / area;
        if of_b < -1e-9 || of_c < -1e-9 || of_b + of_c > 1.0 + 1e-9 {
            continue;
        }
        let z = a.z + of_b * (b.z - a.z) + of_c * (c.z - a.z);
        if area < 0.0 {
            let [low, high] = below[j][i].unwrap_or([z; 2]);
            below[j][i] = Some([low.min(z), high.max(z)]);
            continue;
        }
        let height = &mut grid.heights_m[j][i];
        if let Some(known) = height.filter(|known| (known - z).abs() > same) {
            return Err(overhang([x, y], [known, z]));
        }
        *height = Some(z);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndda_mesh::cut::DomainFace;
    use std::path::Path;

    fn surface(vertices: &[[f64; 3]], faces: &[[u32; 3]]) -> Surface {
        let face = |vertices: &[u32; 3]| DomainFace { name: "s".into(), vertices: vertices.to_vec() };
        Surface {
            vertices: vertices.iter().map(|x| Vec3::from(*x)).collect(),
            faces: faces.iter().map(face).collect(),
        }
    }

    #[test]
    fn a_slope_has_its_heights_and_faces_that_look_down_do_not_count() {
        let corners = [[0.0, 0.0, 0.0], [4.0, 0.0, 4.0], [4.0, 2.0, 4.0], [0.0, 2.0, 0.0], [0.0, 0.0, -9.0]];
        let slope = surface(&corners, &[[0, 1, 2], [0, 2, 3], [4, 2, 1]]);
        let grid = sample(&slope, Some(1.0)).unwrap();
        assert_eq!(grid.step_m, [1.0; 2]);
        let row: Vec<_> = (0..5).map(|i| Some(f64::from(i))).collect();
        assert_eq!(grid.heights_m, vec![row; 3]);
        assert_eq!(sample(&slope, None).unwrap().heights_m[0].len(), 201);
    }

    #[test]
    fn triangles_may_turn_either_way_and_a_closed_surface_turned_inwards_is_refused() {
        let corners = [[0.0, 0.0, 0.0], [4.0, 0.0, 4.0], [4.0, 2.0, 4.0], [0.0, 2.0, 0.0], [4.0, 2.0, -9.0]];
        let whole = sample(&surface(&corners, &[[0, 1, 2], [0, 2, 3]]), Some(1.0)).unwrap();
        for faces in [[[0, 1, 2], [0, 3, 2]], [[1, 0, 2], [0, 2, 3]], [[2, 1, 0], [3, 2, 0]]] {
            assert_eq!(sample(&surface(&corners, &faces), Some(1.0)).unwrap().heights_m, whole.heights_m);
        }
        let inwards = surface(&corners, &[[2, 1, 0], [3, 2, 0], [0, 1, 4], [0, 4, 3]]);
        let error = sample(&inwards, Some(1.0)).unwrap_err().of(Path::new("a.stl")).to_string();
        assert!(error.contains("look inwards"), "{error}");
    }

    #[test]
    fn overhangs_and_steps_that_do_not_fit_are_refused() {
        let corners = [
            [0.0, 0.0, 0.0],
            [4.0, 0.0, 0.0],
            [0.0, 4.0, 0.0],
            [0.0, 0.0, 3.0],
            [4.0, 0.0, 3.0],
            [0.0, 4.0, 3.0],
        ];
        let twice = surface(&corners, &[[0, 1, 2], [3, 4, 5]]);
        let said = |fault: Fault| fault.of(Path::new("a.stl")).to_string();
        assert!(said(sample(&twice, Some(1.0)).unwrap_err()).contains("an overhang at (0, 0)"));
        assert!(said(sample(&twice, Some(9.0)).unwrap_err()).contains("that fits it"));
        assert!(said(sample(&twice, Some(1e-6)).unwrap_err()).contains("that fits it"));
    }
}
