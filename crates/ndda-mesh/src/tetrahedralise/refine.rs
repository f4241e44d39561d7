//! A coarse mesh brought to the size requested.

use super::pool::Pool;
use super::size::SizeField;
use super::{Filled, improve};
use crate::Vec3;

/// Edges longer than this many times the size are split.
const TOO_LONG: f64 = 1.35;
/// Edges shorter than this many times the size collapse.
const TOO_SHORT: f64 = 0.55;
/// A round splits edges down to this fraction of the longest.
const ROUND: f64 = 0.7;
/// While refining, tetrahedra below this are improved: sin 25°.
const WANTED_SINE: f64 = 0.42;
/// At the end, tetrahedra below this are improved: sin 35°.
const FINAL_SINE: f64 = 0.57;
/// A collapse may not leave anything worse than this, or than what was: sin 20°.
const COLLAPSE_SINE: f64 = 0.34;
/// Tetrahedra below this get a node of their own as a last resort: sin 15°.
const POOR_SINE: f64 = 0.26;
/// Refining stops with an error at this many times the tetrahedra expected.
const MOST_PER_EXPECTED: f64 = 30.0;
/// Added to the tetrahedra expected: below some thousand nothing is out of hand.
const FEW_TETS: f64 = 1000.0;
/// Most sweeps at the end.
const SWEEPS: usize = 12;

/// Refines `filled`, a mesh between faces of these `normals`, until its edges have the length of `size`; the number of tetrahedra if they get out of hand.
pub(super) fn refine(normals: Vec<Vec3>, filled: Filled, size: &SizeField) -> Result<Filled, usize> {
    let mut pool = Pool::new(normals, filled);
    let ratio = |pool: &Pool, (a, b): (u32, u32)| {
        let (x, y) = (pool.nodes[a as usize], pool.nodes[b as usize]);
        (x - y).norm() / size.at(&((x + y) * 0.5))
    };
    loop {
        let mut long: Vec<(f64, (u32, u32))> =
            edges(&pool).into_iter().map(|edge| (ratio(&pool, edge), edge)).collect();
        long.retain(|(ratio, _)| *ratio > TOO_LONG);
        long.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let Some(&(longest, _)) = long.first() else { break };
        for &(_, (a, b)) in long.iter().take_while(|(ratio, _)| *ratio >= ROUND * longest) {
            split_edge(&mut pool, a, b);
        }
        let tets = pool.alive().count();
        if tets as f64 > MOST_PER_EXPECTED * (size.tets + FEW_TETS) {
            return Err(tets);
        }
        for _ in 0..2 {
            improve::sweep(&mut pool, WANTED_SINE);
        }
    }
    for round in 0..3 {
        for edge in edges(&pool) {
            if ratio(&pool, edge) < TOO_SHORT {
                let _ =
                    collapse(&mut pool, edge.0, edge.1, size) || collapse(&mut pool, edge.1, edge.0, size);
            }
        }
        for _ in 0..SWEEPS {
            if improve::sweep(&mut pool, FINAL_SINE) == 0 {
                break;
            }
        }
        if round == 2 || !rescue(&mut pool, size) {
            break;
        }
    }
    Ok(pool.finish())
}

/// All edges, sorted.
fn edges(pool: &Pool) -> Vec<(u32, u32)> {
    let mut edges = Vec::new();
    for tet in pool.alive() {
        let nodes = pool.tets[tet as usize];
        for i in 0..4 {
            edges.extend((0..i).map(|j| (nodes[i].min(nodes[j]), nodes[i].max(nodes[j]))));
        }
    }
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// Puts a node in the middle of an edge, on the faces that hold both ends; `None` if the edge is gone.
fn split_edge(pool: &mut Pool, a: u32, b: u32) -> Option<u32> {
    let tets = pool.at_edge(a, b);
    if tets.is_empty() {
        return None;
    }
    let middle = (pool.nodes[a as usize] + pool.nodes[b as usize]) * 0.5;
    let on = pool.shared(a, b);
    let node = pool.add_node(middle, on);
    for tet in tets {
        let old = pool.tets[tet as usize];
        pool.remove(tet);
        pool.add(old.map(|n| if n == a { node } else { n }));
        pool.add(old.map(|n| if n == b { node } else { n }));
    }
    Some(node)
}

/// Moves node `a` into `b`, if `b` lies on all faces of `a` and what is left is sound.
fn collapse(pool: &mut Pool, a: u32, b: u32, size: &SizeField) -> bool {
    let gone = pool.at_edge(a, b);
    if gone.is_empty() || pool.shared(a, b).len() < pool.on[a as usize].len() {
        return false;
    }
    let least = pool.worst_around(a).min(COLLAPSE_SINE);
    let kept: Vec<u32> = pool.around[a as usize].iter().copied().filter(|t| !gone.contains(t)).collect();
    let new: Vec<[u32; 4]> =
        kept.iter().map(|&t| pool.tets[t as usize].map(|n| if n == a { b } else { n })).collect();
    let is_long = |n: u32| {
        let (x, y) = (pool.nodes[n as usize], pool.nodes[b as usize]);
        n != b && (x - y).norm() > TOO_LONG * size.at(&((x + y) * 0.5))
    };
    if new.iter().any(|&t| pool.quality(t) <= least) || new.iter().flatten().any(|&n| is_long(n)) {
        return false;
    }
    gone.into_iter().chain(kept).for_each(|t| pool.remove(t));
    new.into_iter().for_each(|t| pool.add(t));
    true
}

/// Tries to help poor tetrahedra: collapses their short edges, or splits their longest; whether there were any.
fn rescue(pool: &mut Pool, size: &SizeField) -> bool {
    let poor: Vec<u32> = pool.alive().filter(|&t| pool.sine[t as usize] < POOR_SINE).collect();
    for &tet in &poor {
        if !pool.is_alive(tet) || pool.sine[tet as usize] >= POOR_SINE {
            continue;
        }
        let nodes = pool.tets[tet as usize];
        let mut edges: Vec<(f64, u32, u32)> = Vec::new();
        for i in 0..4 {
            for j in 0..i {
                let length = (pool.nodes[nodes[i] as usize] - pool.nodes[nodes[j] as usize]).norm();
                edges.push((length, nodes[i], nodes[j]));
            }
        }
        edges.sort_by(|a, b| a.0.total_cmp(&b.0));
        let done =
            edges[..3].iter().any(|&(_, a, b)| collapse(pool, a, b, size) || collapse(pool, b, a, size));
        if !done && let Some(node) = split_edge(pool, edges[5].1, edges[5].2) {
            improve::smooth(pool, node);
        }
    }
    !poor.is_empty()
}
