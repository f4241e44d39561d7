//! Fans from a vertex and stars from the centroid.

use super::Filled;
use crate::Vec3;
use crate::cut::Polyhedron;
use crate::quality::least_sine;

/// A fan counts as sound if no dihedral angle is closer to 0 or 180° than this: sin 5°.
const SOUND_SINE: f64 = 0.087;

/// Sines closer than this are equal: by rounding, they differ with the place of a block.
const EQUAL_SINES: f64 = 1e-9;

/// The fan with the fewest sound tetrahedra, or the best of fans and star.
pub(super) fn fewest(block: &Polyhedron) -> Filled {
    let triangles = triangles(block);
    let fans = (0..block.vertices.len() as u32).map(|apex| fan(block, &triangles, apex));
    let graded = |filled: Filled| {
        let worst = filled.tets.iter().map(|tet| least_sine(&tet.map(|n| filled.nodes[n as usize])));
        (worst.fold(f64::INFINITY, f64::min), filled)
    };
    let all: Vec<(f64, Filled)> = fans.chain([centre(block)]).map(graded).collect();
    let sound = all.iter().filter(|(sine, _)| *sine >= SOUND_SINE);
    let least = sound.map(|(_, filled)| filled.tets.len()).min();
    // Where none is sound, all of them compete.
    let competes =
        |(sine, filled): &&(f64, Filled)| least.is_none_or(|n| *sine >= SOUND_SINE && filled.tets.len() == n);
    let best = all.iter().filter(competes).map(|(sine, _)| *sine).fold(f64::NEG_INFINITY, f64::max);
    let chosen = all.iter().filter(competes).find(|(sine, _)| *sine >= best - EQUAL_SINES);
    chosen.or(all.first()).map(|(_, filled)| filled.clone()).unwrap_or_default()
}

/// The star from the centroid.
pub(super) fn centre(block: &Polyhedron) -> Filled {
    let mut filled = corners(block);
    let centre = filled.nodes.len() as u32;
    filled.nodes.push(block.volume_and_centroid().1);
    filled.on.push(Vec::new());
    filled.tets = triangles(block).iter().flatten().map(|&[a, b, c]| [a, c, b, centre]).collect();
    filled
}

/// Tetrahedra from `apex` to all triangles of faces without it.
fn fan(block: &Polyhedron, triangles: &[Vec<[u32; 3]>], apex: u32) -> Filled {
    let mut filled = corners(block);
    for (face, triangles) in block.faces.iter().zip(triangles) {
        if !face.vertices.contains(&apex) {
            filled.tets.extend(triangles.iter().map(|&[a, b, c]| [a, c, b, apex]));
        }
    }
    filled
}

fn corners(block: &Polyhedron) -> Filled {
    let mut on = vec![Vec::new(); block.vertices.len()];
    for (index, face) in (0..).zip(&block.faces) {
        face.vertices.iter().for_each(|&v| on[v as usize].push(index));
    }
    Filled { nodes: block.vertices.clone(), on, tets: Vec::new() }
}

/// Triangles of each face.
fn triangles(block: &Polyhedron) -> Vec<Vec<[u32; 3]>> {
    let of_face = |face: &crate::cut::Face| {
        let ring: Vec<Vec3> = block.ring(face).collect();
        best_triangles(&ring).into_iter().map(|triangle| triangle.map(|i| face.vertices[i])).collect()
    };
    block.faces.iter().map(of_face).collect()
}

/// Triangles of a convex polygon with the largest smallest angle: Klincsek (1980). Long rings are cut as a fan.
pub(super) fn best_triangles(ring: &[Vec3]) -> Vec<[usize; 3]> {
    let n = ring.len();
    if n > 64 {
        return (1..n - 1).map(|i| [0, i, i + 1]).collect();
    }
    let mut best = vec![vec![(f64::INFINITY, 0); n]; n];
    for span in 2..n {
        for i in 0..n - span {
            let j = i + span;
            let value = |k: usize| {
                let sine = triangle_sine(&ring[i], &ring[k], &ring[j]);
                (sine.min(best[i][k].0).min(best[k][j].0), k)
            };
            let largest = (i + 1..j).map(|k| value(k).0).fold(f64::NEG_INFINITY, f64::max);
            let choice = (i + 1..j).rev().map(value).find(|(sine, _)| *sine >= largest - EQUAL_SINES);
            best[i][j] = choice.unwrap_or((0.0, i + 1));
        }
    }
    let mut triangles = Vec::new();
    let mut open = vec![(0, n - 1)];
    while let Some((i, j)) = open.pop() {
        if j - i >= 2 {
            let k = best[i][j].1;
            triangles.push([i, k, j]);
            open.extend([(i, k), (k, j)]);
        }
    }
    triangles
}

/// Smallest sine of an angle: 2 A over the product of the two longest edges.
fn triangle_sine(a: &Vec3, b: &Vec3, c: &Vec3) -> f64 {
    let mut edges = [(b - a).norm(), (c - b).norm(), (a - c).norm()];
    edges.sort_by(f64::total_cmp);
    (b - a).cross(&(c - a)).norm() / (edges[1] * edges[2])
}
