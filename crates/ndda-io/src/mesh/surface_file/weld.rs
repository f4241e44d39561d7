//! Makes one surface of faces that have vertices of their own.

use std::collections::{BTreeMap, HashMap};

use ndda_mesh::Vec3;
use ndda_mesh::geometry::Aabb;

use super::Surface;
use crate::mesh::FileProblem;
use crate::mesh::error::Fault;

/// How many open edges a message names.
const NAMED: usize = 3;

/// Welded, without faces that have no area left, closed and outward.
pub(super) fn closed(raw: Surface, tolerance: f64) -> Result<Surface, Fault> {
    if u32::try_from(raw.vertices.len()).is_err() {
        return Err(FileProblem::TooManyNodes.into());
    }
    let mut surface = welded(raw, tolerance);
    if surface.faces.is_empty() {
        return Err(FileProblem::NoFaces.into());
    }
    check_closed(&surface)?;
    if surface.volume() < 0.0 {
        surface.faces.iter_mut().for_each(|face| face.vertices.reverse());
    }
    Ok(surface)
}

fn welded(raw: Surface, tolerance: f64) -> Surface {
    let reach = if tolerance > 0.0 { tolerance * Aabb::around(&raw.vertices).diagonal() } else { 0.0 };
    let first = first_of_each(&raw.vertices, reach);
    let mut surface = Surface::default();
    let mut index: HashMap<u32, u32> = HashMap::new();
    for mut face in raw.faces {
        face.vertices.iter_mut().for_each(|v| *v = first[*v as usize]);
        face.vertices.dedup();
        if face.vertices.len() > 1 && face.vertices.first() == face.vertices.last() {
            face.vertices.pop();
        }
        // A ring that goes there and back encloses nothing.
        if face.vertices.len() < 3 || face.vertices.len() == 4 && face.vertices[0] == face.vertices[2] {
            continue;
        }
        for vertex in &mut face.vertices {
            *vertex = *index.entry(*vertex).or_insert_with(|| {
                surface.vertices.push(raw.vertices[*vertex as usize]);
                surface.vertices.len() as u32 - 1
            });
        }
        surface.faces.push(face);
    }
    surface
}

/// The first vertex within `reach` of each, by a grid of cells of that size.
fn first_of_each(vertices: &[Vec3], reach: f64) -> Vec<u32> {
    let mut cells: HashMap<[u64; 3], Vec<u32>> = HashMap::new();
    // Adding 0 makes one zero of both.
    let exact = |x: &Vec3| [x.x, x.y, x.z].map(|c| (c + 0.0).to_bits());
    let cell = |x: &Vec3, shift: [i64; 3]| {
        let along = |i: usize| ((x[i] / reach).floor() as i64).wrapping_add(shift[i]) as u64;
        [along(0), along(1), along(2)]
    };
    let shifts: Vec<[i64; 3]> = (0..27).map(|i| [i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1]).collect();
    let mut first = Vec::with_capacity(vertices.len());
    for (i, x) in (0..).zip(vertices) {
        let (own, found) = if reach > 0.0 {
            let candidates = shifts.iter().filter_map(|&shift| cells.get(&cell(x, shift))).flatten();
            let within = |&&j: &&u32| (vertices[j as usize] - x).norm() <= reach;
            (cell(x, [0; 3]), candidates.filter(within).min().copied())
        } else {
            (exact(x), cells.get(&exact(x)).map(|same| same[0]))
        };
        if found.is_none() {
            cells.entry(own).or_default().push(i);
        }
        first.push(found.unwrap_or(i));
    }
    first
}

/// Every edge of a face runs the other way in exactly one other face.
fn check_closed(surface: &Surface) -> Result<(), Fault> {
    let mut edges: BTreeMap<(u32, u32), [u32; 2]> = BTreeMap::new();
    for face in &surface.faces {
        for (i, &a) in face.vertices.iter().enumerate() {
            let b = face.vertices[(i + 1) % face.vertices.len()];
            edges.entry((a.min(b), a.max(b))).or_default()[usize::from(a > b)] += 1;
        }
    }
    let open: Vec<_> = edges.iter().filter(|(_, ways)| **ways != [1, 1]).map(|(edge, _)| *edge).collect();
    if open.is_empty() {
        return Ok(());
    }
    let at = |v: u32| {
        let x = surface.vertices[v as usize];
        format!("({}, {}, {})", x.x, x.y, x.z)
    };
    let named: Vec<String> = open.iter().take(NAMED).map(|&(a, b)| format!("{}–{}", at(a), at(b))).collect();
    Err(FileProblem::Open { count: open.len(), edges: named.join(", ") }.into())
}
