//! Flips and smoothing that raise the smallest dihedral angle.

use super::pool::Pool;
use crate::Vec3;
use crate::cut::plane_frame;
use crate::geometry::TET_FACES;

/// Tetrahedra whose smallest sine is above this are left alone: sin 40°.
const GOOD_SINE: f64 = 0.64;
/// A change must raise the quality by this factor.
const GAIN: f64 = 1.0 + 1e-3;
/// Rings longer than this are left alone.
const LONGEST_RING: usize = 9;
/// How often the step of a moving node is halved.
const HALVINGS: usize = 5;

/// One sweep of flips and smoothing over the tetrahedra below `wanted_sine`; how many changes it made.
pub(super) fn sweep(pool: &mut Pool, wanted_sine: f64) -> usize {
    let wanted_sine = wanted_sine.min(GOOD_SINE);
    let mut bad: Vec<(f64, u32)> =
        pool.alive().map(|t| (pool.sine[t as usize], t)).filter(|(sine, _)| *sine < wanted_sine).collect();
    bad.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut changes = 0;
    for &(sine, tet) in &bad {
        if pool.sine[tet as usize] == sine && pool.is_flip_due(tet) && flip(pool, tet) {
            changes += 1;
        }
    }
    let mut nodes: Vec<u32> =
        bad.iter().filter(|(_, t)| pool.is_alive(*t)).flat_map(|(_, t)| pool.tets[*t as usize]).collect();
    nodes.sort_unstable();
    nodes.dedup();
    for node in nodes {
        let is_due = pool.worst_around(node) < wanted_sine && pool.is_move_due(node);
        changes += usize::from(is_due && smooth(pool, node));
    }
    changes
}

/// Replaces a tetrahedron and some neighbours by better ones, if a flip can.
fn flip(pool: &mut Pool, tet: u32) -> bool {
    let nodes = pool.tets[tet as usize];
    for i in 0..4 {
        for j in 0..i {
            if remove_edge(pool, nodes[i], nodes[j]) {
                return true;
            }
        }
    }
    TET_FACES
        .into_iter()
        .enumerate()
        .any(|(i, face)| remove_face(pool, tet, nodes[i], face.map(|k| nodes[k])))
}

/// Fills the ring around an edge anew, without the edge (Klincsek 1980; Shewchuk 2002).
pub(super) fn remove_edge(pool: &mut Pool, a: u32, b: u32) -> bool {
    let tets = pool.at_edge(a, b);
    if tets.len() > LONGEST_RING {
        return false;
    }
    let shared = pool.shared(a, b);
    if shared.len() > 1 {
        return false;
    }
    let Some(ring) = pool.ring(a, b, &tets) else { return false };
    let n = ring.nodes.len();
    // An edge of the block stays; one in a face is exchanged for another in that face.
    let in_face = |node: u32| shared.iter().all(|face| pool.on[node as usize].contains(face));
    let may_go = if ring.is_closed {
        shared.is_empty()
    } else {
        shared.len() == 1 && in_face(ring.nodes[0]) && in_face(ring.nodes[n - 1])
    };
    if n < 3 || !may_go {
        return false;
    }
    let old = tets.iter().map(|&t| pool.sine[t as usize]).fold(f64::INFINITY, f64::min);
    let least = if old > 0.0 { old * GAIN } else { f64::MIN_POSITIVE };
    let Some(new) = best_filling(pool, &ring.nodes, [a, b], least) else { return false };
    tets.into_iter().for_each(|t| pool.remove(t));
    new.into_iter().for_each(|t| pool.add(t));
    true
}

/// Triangles of the ring, each with a tetrahedron to either end of the edge, the worst of them as good as can be;
/// `None` if that is not above `least`.
#[expect(clippy::needless_range_loop, reason = "k counts in a row and in a column of the table")]
fn best_filling(pool: &Pool, ring: &[u32], [a, b]: [u32; 2], least: f64) -> Option<Vec<[u32; 4]>> {
    let n = ring.len();
    let pair = |[i, k, j]: [usize; 3]| [[ring[i], ring[k], ring[j], b], [ring[j], ring[k], ring[i], a]];
    let mut best = [[(f64::INFINITY, 0usize); LONGEST_RING + 2]; LONGEST_RING + 2];
    for span in 2..n {
        for i in 0..n - span {
            let j = i + span;
            let mut choice = (f64::NEG_INFINITY, i + 1);
            for k in i + 1..j {
                let bound = best[i][k].0.min(best[k][j].0);
                if bound > choice.0.max(least) {
                    let [upper, lower] = pair([i, k, j]);
                    let value = bound.min(pool.quality(upper));
                    let value = if value > least { value.min(pool.quality(lower)) } else { value };
                    if value > choice.0 {
                        choice = (value, k);
                    }
                }
            }
            best[i][j] = choice;
        }
    }
    if best[0][n - 1].0 <= least {
        return None;
    }
    let (mut open, mut new) = (vec![(0, n - 1)], Vec::new());
    while let Some((i, j)) = open.pop() {
        if j - i >= 2 {
            let k = best[i][j].1;
            new.extend(pair([i, k, j]));
            open.extend([(i, k), (k, j)]);
        }
    }
    Some(new)
}

/// Exchanges the face between two tetrahedra for the edge between their far nodes: two become three.
fn remove_face(pool: &mut Pool, tet: u32, apex: u32, face: [u32; 3]) -> bool {
    let [p, q, r] = face;
    let has_face = |t: &u32| *t != tet && [q, r].iter().all(|n| pool.tets[*t as usize].contains(n));
    let Some(other) = pool.around[p as usize].iter().copied().find(has_face) else { return false };
    let Some(far) = pool.tets[other as usize].into_iter().find(|n| !face.contains(n)) else { return false };
    let old = pool.sine[tet as usize].min(pool.sine[other as usize]);
    let new = [[p, q], [q, r], [r, p]].map(|[u, v]| [u, v, far, apex]);
    let least = if old > 0.0 { old * GAIN } else { f64::MIN_POSITIVE };
    if new.iter().any(|&t| pool.quality(t) <= least) {
        return false;
    }
    pool.remove(tet);
    pool.remove(other);
    new.into_iter().for_each(|t| pool.add(t));
    true
}

/// Moves a node to where the worst tetrahedron around it is better; it stays on its faces.
pub(super) fn smooth(pool: &mut Pool, node: u32) -> bool {
    let directions = freedom(pool, node);
    if directions.is_empty() {
        return false;
    }
    let start = pool.nodes[node as usize];
    let mut around = pool.around[node as usize].clone();
    // The worst ones first: they refuse most attempts.
    around.sort_by(|&s, &t| pool.sine[s as usize].total_cmp(&pool.sine[t as usize]));
    let tets: Vec<[u32; 4]> = around.into_iter().map(|t| pool.tets[t as usize]).collect();
    let (centre, mut step_m) = neighbourhood(pool, node, &tets);
    let mut best = (pool.worst_around(node), start);
    let old = best.0;
    let attempt = |pool: &mut Pool, at: Vec3, best: &mut (f64, Vec3)| {
        pool.nodes[node as usize] = at;
        let mut worst = f64::INFINITY;
        for &tet in &tets {
            worst = worst.min(pool.quality(tet));
            if worst <= best.0 {
                return false;
            }
        }
        *best = (worst, at);
        true
    };
    let towards: Vec3 = directions.iter().map(|d| d * d.dot(&(centre - start))).sum();
    let mut is_lucky = attempt(pool, start + towards, &mut best);
    for _ in 0..HALVINGS {
        for direction in &directions {
            for sign in [1.0, -1.0] {
                let at = best.1 + direction * (sign * step_m);
                is_lucky |= attempt(pool, at, &mut best);
            }
        }
        step_m *= 0.5;
    }
    let gained = is_lucky && (old <= 0.0 || best.0 > old * GAIN);
    pool.nodes[node as usize] = start;
    if gained {
        pool.place(node, best.1);
    }
    gained
}

/// Orthonormal directions in which a node may move.
fn freedom(pool: &Pool, node: u32) -> Vec<Vec3> {
    let normal = |i: usize| pool.normals[pool.on[node as usize][i] as usize];
    match pool.on[node as usize].len() {
        0 => vec![Vec3::x(), Vec3::y(), Vec3::z()],
        1 => plane_frame(&normal(0)).to_vec(),
        2 => normal(0).cross(&normal(1)).try_normalize(0.0).into_iter().collect(),
        _ => Vec::new(),
    }
}

/// Mean of the nodes around a node, and a first step: a fifth of their mean distance.
fn neighbourhood(pool: &Pool, node: u32, tets: &[[u32; 4]]) -> (Vec3, f64) {
    let (mut sum, mut distance, mut count) = (Vec3::zeros(), 0.0, 0.0);
    for &other in tets.iter().flatten().filter(|&&other| other != node) {
        let x = pool.nodes[other as usize];
        sum += x;
        distance += (x - pool.nodes[node as usize]).norm();
        count += 1.0;
    }
    (sum / count, 0.2 * distance / count)
}
