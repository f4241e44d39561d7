//! The order of elimination: nested dissection (George 1973), and least degree in the parts that are left.

use super::graph::Graph;
use super::separator::{SEPARATOR, separate};

/// Vertices of a part that is not dissected further.
const LEAF: usize = 100;
/// Separators that are tried for each part.
const ATTEMPTS: u64 = 3;

/// Vertices in the order in which to eliminate them.
pub(super) fn dissect(graph: &Graph) -> Vec<u32> {
    let mut order = Vec::with_capacity(graph.len());
    let mut place = vec![u32::MAX; graph.len()];
    enum Task {
        Part(Vec<u32>),
        Separator(Vec<u32>),
    }
    let mut tasks = vec![Task::Part((0..graph.len() as u32).collect())];
    while let Some(task) = tasks.pop() {
        match task {
            Task::Separator(vertices) => order.extend(vertices),
            Task::Part(vertices) if vertices.len() <= LEAF => {
                order.extend(least_degree(graph, &vertices, &mut place));
            }
            Task::Part(vertices) => {
                let label = separate(&graph.part(&vertices, &mut place), ATTEMPTS);
                let with = |wanted: u8| -> Vec<u32> {
                    vertices.iter().zip(&label).filter(|&(_, &l)| l == wanted).map(|(&v, _)| v).collect()
                };
                let [a, b, separator] = [with(0), with(1), with(SEPARATOR)];
                // A part without a separator, as all are coupled to all, has no good order.
                if a.is_empty() || b.is_empty() {
                    order.extend(vertices);
                    continue;
                }
                tasks.extend([Task::Separator(separator), Task::Part(b), Task::Part(a)]);
            }
        }
    }
    order
}

/// A set of vertices of a small part.
type Bits = Vec<u64>;

fn members(bits: &Bits) -> impl Iterator<Item = usize> + '_ {
    bits.iter().enumerate().flat_map(|(word, &bits)| {
        std::iter::successors(Some(bits), |b| Some(b & (b.wrapping_sub(1))))
            .take_while(|&b| b != 0)
            .map(move |b| 64 * word + b.trailing_zeros() as usize)
    })
}

/// Eliminates the vertex with the least weight around it first; the neighbours outside count but stay.
fn least_degree(graph: &Graph, vertices: &[u32], place: &mut [u32]) -> Vec<u32> {
    let inner = vertices.len();
    let mut all = vertices.to_vec();
    (0..).zip(vertices).for_each(|(k, &v)| place[v as usize] = k);
    for &v in vertices {
        for &u in graph.of(v) {
            if place[u as usize] == u32::MAX {
                place[u as usize] = all.len() as u32;
                all.push(u);
            }
        }
    }
    let mut around: Vec<Bits> = vec![vec![0; all.len().div_ceil(64)]; all.len()];
    for (k, &v) in vertices.iter().enumerate() {
        for other in graph.of(v).iter().map(|&u| place[u as usize] as usize) {
            around[k][other / 64] |= 1 << (other % 64);
            around[other][k / 64] |= 1 << (k % 64);
        }
    }
    all.iter().for_each(|&v| place[v as usize] = u32::MAX);
    let weight = |k: usize| graph.weight[all[k] as usize];
    let mut degree: Vec<u32> = around.iter().map(|bits| members(bits).map(weight).sum()).collect();
    let mut left: Vec<usize> = (0..inner).collect();
    let mut order = Vec::with_capacity(inner);
    while let Some((at, &k)) = left.iter().enumerate().min_by_key(|&(_, &k)| (degree[k], k)) {
        left.swap_remove(at);
        order.push(all[k]);
        let clique = std::mem::take(&mut around[k]);
        for u in members(&clique) {
            around[u].iter_mut().zip(&clique).for_each(|(bits, c)| *bits |= c);
            around[u][u / 64] &= !(1 << (u % 64));
            around[u][k / 64] &= !(1 << (k % 64));
            degree[u] = members(&around[u]).map(weight).sum();
        }
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::linear_solver::SymmetricMatrix;
    use crate::linear::supernodal::graph::Compressed;

    /// A grid of n × n points with the five-point pattern.
    fn grid(n: usize) -> Graph {
        let matrix = SymmetricMatrix::from_lower(n * n, |j, out| {
            out.push((j, 4.0));
            if j % n + 1 < n {
                out.push((j + 1, -1.0));
            }
            if j + n < n * n {
                out.push((j + n, -1.0));
            }
        });
        Compressed::new(&matrix).graph
    }

    #[test]
    fn every_vertex_is_eliminated_once() {
        let graph = grid(30);
        let mut order = dissect(&graph);
        order.sort_unstable();
        assert_eq!(order, (0..900).collect::<Vec<u32>>());
    }

    #[test]
    fn the_separator_of_a_grid_is_about_as_long_as_its_side_and_separates() {
        let graph = grid(40);
        let label = separate(&graph, 2);
        let count = label.iter().filter(|&&l| l == SEPARATOR).count();
        assert!(count <= 44, "{count}");
        for v in 0..1600u32 {
            let apart = |&u: &u32| label[u as usize] + label[v as usize] != 1;
            assert!(graph.of(v).iter().all(apart));
        }
    }

    #[test]
    fn parts_without_a_connection_need_no_separator() {
        let two = SymmetricMatrix::from_lower(400, |j, out| {
            out.push((j, 4.0));
            if j % 200 != 199 {
                out.push((j + 1, -1.0));
            }
        });
        let graph = Compressed::new(&two).graph;
        assert!(separate(&graph, 2).iter().filter(|&&l| l == SEPARATOR).count() <= 1);
    }
}
