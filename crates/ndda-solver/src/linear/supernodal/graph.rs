//! Which unknowns are coupled, with those merged that are coupled to the same others: the three of a node, as a rule.

use crate::linear::linear_solver::SymmetricMatrix;

/// An undirected graph with weights on its vertices and edges.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Graph {
    /// First neighbour of each vertex (one more value than vertices).
    pub start: Vec<usize>,
    /// Neighbours, without the vertex itself.
    pub neighbour: Vec<u32>,
    /// Weight of the edge to each neighbour.
    pub edge: Vec<u32>,
    /// Unknowns of each vertex.
    pub weight: Vec<u32>,
}

/// The graph of a matrix and the unknowns behind its vertices.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Compressed {
    /// Graph of the vertices.
    pub graph: Graph,
    /// Unknowns of each vertex, ascending.
    pub unknowns: Vec<Vec<u32>>,
}

impl Graph {
    /// Number of vertices.
    pub(super) fn len(&self) -> usize {
        self.weight.len()
    }

    /// Neighbours of a vertex.
    pub(super) fn of(&self, vertex: u32) -> &[u32] {
        &self.neighbour[self.start[vertex as usize]..self.start[vertex as usize + 1]]
    }

    /// Neighbours of a vertex with the weights of the edges.
    pub(super) fn edges(&self, vertex: u32) -> impl Iterator<Item = (u32, u32)> + '_ {
        let range = self.start[vertex as usize]..self.start[vertex as usize + 1];
        self.neighbour[range.clone()].iter().copied().zip(self.edge[range].iter().copied())
    }

    /// The part among `vertices`, numbered as they stand there; `place` is scratch of one `u32::MAX` per vertex.
    pub(super) fn part(&self, vertices: &[u32], place: &mut [u32]) -> Self {
        (0..).zip(vertices).for_each(|(k, &v)| place[v as usize] = k);
        let mut part = Self { start: vec![0], ..Self::default() };
        for &v in vertices {
            for (other, edge) in self.edges(v).filter(|&(u, _)| place[u as usize] != u32::MAX) {
                part.neighbour.push(place[other as usize]);
                part.edge.push(edge);
            }
            part.start.push(part.neighbour.len());
            part.weight.push(self.weight[v as usize]);
        }
        vertices.iter().for_each(|&v| place[v as usize] = u32::MAX);
        part
    }
}

/// Rows of each column of the whole matrix, diagonal included, ascending.
fn whole_pattern(matrix: &SymmetricMatrix) -> (Vec<usize>, Vec<u32>) {
    let n = matrix.n;
    let mut start = vec![0; n + 1];
    let entries = |j: usize| matrix.row[matrix.column_start[j]..matrix.column_start[j + 1]].iter().copied();
    for j in 0..n {
        for i in entries(j) {
            start[i + 1] += 1;
            start[j + 1] += usize::from(i != j);
        }
    }
    (0..n).for_each(|j| start[j + 1] += start[j]);
    let (mut end, mut row) = (start.clone(), vec![0; start[n]]);
    let mut push = |j: usize, i: usize| {
        row[end[j]] = i as u32;
        end[j] += 1;
    };
    for j in 0..n {
        for i in entries(j) {
            push(j, i);
            if i != j {
                push(i, j);
            }
        }
    }
    (start, row)
}

impl Compressed {
    /// Merges unknowns with equal patterns.
    pub(super) fn new(matrix: &SymmetricMatrix) -> Self {
        let (start, row) = whole_pattern(matrix);
        let pattern = |j: usize| &row[start[j]..start[j + 1]];
        let mut vertex = vec![u32::MAX; matrix.n];
        let mut unknowns: Vec<Vec<u32>> = Vec::new();
        for j in 0..matrix.n {
            if vertex[j] != u32::MAX {
                continue;
            }
            let id = unknowns.len() as u32;
            // Unknowns with equal patterns are in each other's, so they need not be sought elsewhere.
            let twin = |&&i: &&u32| vertex[i as usize] == u32::MAX && pattern(i as usize) == pattern(j);
            let twins: Vec<u32> = pattern(j).iter().filter(twin).copied().collect();
            twins.iter().for_each(|&i| vertex[i as usize] = id);
            unknowns.push(twins);
        }
        let mut graph = Graph { start: vec![0], ..Graph::default() };
        let mut seen = vec![u32::MAX; unknowns.len()];
        for (id, twins) in (0..).zip(&unknowns) {
            seen[id as usize] = id;
            for &i in pattern(twins[0] as usize) {
                let other = vertex[i as usize];
                if std::mem::replace(&mut seen[other as usize], id) != id {
                    graph.neighbour.push(other);
                    graph.edge.push(1);
                }
            }
            graph.start.push(graph.neighbour.len());
            graph.weight.push(twins.len() as u32);
        }
        Self { graph, unknowns }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_unknowns_of_a_node_make_one_vertex() {
        // A chain of four nodes with three unknowns each.
        let matrix = SymmetricMatrix::from_lower(12, |j, out| {
            let last = (3 * (j / 3) + 6).min(12);
            out.extend((j..last).map(|i| (i, if i == j { 10.0 } else { -1.0 })));
        });
        let Compressed { graph, unknowns } = Compressed::new(&matrix);
        assert_eq!(unknowns, [[0, 1, 2], [3, 4, 5], [6, 7, 8], [9, 10, 11]]);
        assert_eq!(graph.neighbour, [1, 0, 2, 1, 3, 2]);
        assert_eq!(graph.weight, [3; 4]);
    }
}
