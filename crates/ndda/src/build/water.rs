//! Water of a scene: which faces are wet, and the field of its pressure.

use std::sync::Arc;

use ndda_fem::{LinearField, PressureField, PressurePiece};
use ndda_io::scene::{self, LinearPressure, Pressure, Scene, Water, Wet};
use ndda_mesh::{BlockId, BlockSet, Vec3};
use ndda_solver::{BodySetup, PressureSetup};

use super::regions::{boundary, in_region, outward_triangles};
use super::{Fault, table, vec3};

/// Triangles of a block, counter-clockwise seen from outside.
type Faces = (BlockId, Vec<[u32; 3]>);

/// Gives bodies the water on their faces.
pub(super) fn add_water(scene: &Scene, blocks: &BlockSet, bodies: &mut [BodySetup], faults: &mut Vec<Fault>) {
    for (i, water) in scene.water.iter().enumerate() {
        let field = Arc::new(field(scene.gravity_m_s2, blocks, &water.pressure));
        match wet(blocks, &water.on) {
            Ok(parts) => {
                for (block, triangles) in parts {
                    let (field, factor) = (field.clone(), table(&water.factor));
                    bodies[block.index()].pressures.push(PressureSetup { triangles, field, factor });
                }
            }
            Err(message) => faults.push(Fault::new(format!("water[{i}].on"), message)),
        }
    }
}

/// Corners of the faces that are wet, in the coordinates of the scene; none where no face is.
pub(crate) fn wet_places(blocks: &BlockSet, on: &Wet) -> Option<Vec<Vec3>> {
    let parts = wet(blocks, on).ok()?;
    let corners = parts.iter().flat_map(|(block, triangles)| {
        let nodes = &blocks.rest_position[blocks.nodes_of(*block)];
        triangles.iter().flatten().map(|node| nodes[*node as usize] + blocks.origin_m)
    });
    Some(corners.collect()).filter(|corners: &Vec<Vec3>| !corners.is_empty())
}

/// Largest pressure of water on blocks that move, at the corners of their faces and a factor of one [Pa].
pub(crate) fn largest_pa(gravity_m_s2: [f64; 3], blocks: &BlockSet, water: &Water, moves: &[bool]) -> f64 {
    let field = field(gravity_m_s2, blocks, &water.pressure);
    let parts = wet(blocks, &water.on).unwrap_or_default();
    let pressures_pa =
        parts.iter().filter(|(block, _)| moves[block.index()]).flat_map(|(block, triangles)| {
            let nodes = &blocks.rest_position[blocks.nodes_of(*block)];
            triangles.iter().flatten().map(|node| field.at(&nodes[*node as usize]).abs())
        });
    pressures_pa.fold(0.0, f64::max)
}

/// Blocks with wet faces.
pub(crate) fn wet_blocks(blocks: &BlockSet, on: &Wet) -> impl Iterator<Item = BlockId> {
    wet(blocks, on).into_iter().flatten().map(|(block, _)| block)
}

fn wet(blocks: &BlockSet, on: &Wet) -> Result<Vec<Faces>, String> {
    match on {
        Wet::Joint(pattern) => {
            let is_named: Vec<bool> =
                blocks.surface_names.iter().map(|name| scene::matches(pattern, name)).collect();
            let is_wet = |t: usize| blocks.triangle_surface[t].is_some_and(|s| is_named[s as usize]);
            let faces = |block| boundary(blocks, block).filter(|(t, _)| is_wet(*t)).map(|(_, nodes)| nodes);
            let parts: Vec<Faces> = blocks.ids().map(|block| (block, faces(block).collect())).collect();
            let parts: Vec<Faces> = parts.into_iter().filter(|(_, faces)| !faces.is_empty()).collect();
            if parts.is_empty() {
                Err(format!("no block has a face on joint `{pattern}`"))
            } else {
                Ok(parts)
            }
        }
        Wet::Part { block, region } => {
            in_region(blocks, block, |block| outward_triangles(blocks, block, region))
        }
    }
}

fn field(gravity_m_s2: [f64; 3], blocks: &BlockSet, pressure: &Pressure) -> PressureField {
    let place = |at_m: [f64; 3]| vec3(at_m) - blocks.origin_m;
    let linear = |pressure_pa: f64, at_m: [f64; 3], gradient_pa_m: [f64; 3]| {
        LinearField::through(&place(at_m), pressure_pa, vec3(gradient_pa_m))
    };
    match pressure.held(gravity_m_s2) {
        Pressure::Linear { pressure_pa, at_m, gradient_pa_m } => {
            least(&[linear(pressure_pa, at_m, gradient_pa_m)])
        }
        Pressure::Least(fields) => {
            let field = |f: &LinearPressure| linear(f.pressure_pa, f.at_m, f.gradient_pa_m);
            least(&fields.iter().map(field).collect::<Vec<_>>())
        }
        Pressure::Points { along, at_m, rows } => points(&vec3(along).normalize(), &place(at_m), &rows),
        Pressure::Level { .. } => unreachable!("a level that is held is a linear pressure"),
    }
}

/// The least of linear pressures, where it is not negative; where two are equal everywhere the first counts.
fn least(fields: &[LinearField]) -> PressureField {
    let is_again = |i: usize| fields[..i].contains(&fields[i]);
    let piece = |i: usize| {
        let others = (0..fields.len()).filter(|&j| j != i && fields[j] != fields[i]);
        let mut within: Vec<LinearField> = others.map(|j| fields[j].minus(&fields[i])).collect();
        within.push(fields[i]);
        PressurePiece { within, pressure_pa: fields[i] }
    };
    PressureField { pieces: (0..fields.len()).filter(|&i| !is_again(i)).map(piece).collect() }
}

/// A table along a direction of length one, from a place on.
fn points(along: &Vec3, from: &Vec3, rows: &[(f64, f64)]) -> PressureField {
    let beyond = |distance: f64| LinearField::through(from, -distance, *along);
    let before = |distance: f64| LinearField::through(from, distance, -along);
    let constant = |value: f64| LinearField { value, gradient: Vec3::zeros() };
    let (first, last) = (rows[0], rows[rows.len() - 1]);
    let mut pieces = vec![
        PressurePiece { within: vec![before(first.0)], pressure_pa: constant(first.1) },
        PressurePiece { within: vec![beyond(last.0)], pressure_pa: constant(last.1) },
    ];
    pieces.extend(rows.windows(2).map(|pair| {
        let ((a, p), (b, q)) = (pair[0], pair[1]);
        let rate = (q - p) / (b - a);
        let pressure_pa = LinearField::through(&(from + a * along), p, rate * along);
        PressurePiece { within: vec![beyond(a), before(b)], pressure_pa }
    }));
    PressureField { pieces }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_of_points_is_linear_between_them_and_constant_beyond() {
        let field = points(&Vec3::x(), &Vec3::new(1.0, 0.0, 0.0), &[(0.0, 3.0), (2.0, 7.0), (4.0, 1.0)]);
        for (x, exact) in [(-5.0, 3.0), (1.5, 4.0), (2.5, 6.0), (4.0, 4.0), (9.0, 1.0)] {
            assert!((field.at(&Vec3::new(x, 1.0, 2.0)) - exact).abs() < 1e-14, "{x}");
        }
    }

    #[test]
    fn the_least_of_several_pressures_has_no_suction_and_counts_equal_ones_once() {
        let plane = |value: f64, x: f64| LinearField { value, gradient: Vec3::new(x, 0.0, 0.0) };
        let field = least(&[plane(0.0, 1.0), plane(4.0, -1.0), plane(0.0, 1.0)]);
        for (x, exact) in [(-1.0, 0.0), (1.0, 1.0), (3.0, 1.0), (5.0, 0.0)] {
            assert_eq!(field.at(&Vec3::new(x, 0.0, 0.0)), exact, "{x}");
        }
    }
}
