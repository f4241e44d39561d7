//! Bytes that cross borders between ranks in a step.

use std::collections::{BTreeMap, BTreeSet};

use ndda_contact::ContactInput;
use ndda_contact::broad_phase::{Candidates, Facet};
use ndda_contact::integration::TetFrame;
use ndda_mesh::{BlockId, NodeId, TetId, Vec3};

use crate::split::Owners;

/// Position and velocity of a node.
const NODE: usize = 48;
/// Load, torque and area in contact of a block, which friction on velocities requires once normal forces are known.
const BODY: usize = 56;
/// Bytes that the evaluating side would send back if pairs were evaluated once: integrals of a hit at four nodes of the target, and
/// the number of the pair; of a facet at its three nodes; and the facet's pressure, friction and stiffness.
const HIT: usize = 8 * 8 + 4;
const FACET_NODES: usize = 6 * 8;
const FACET: usize = 7 * 8;

/// Data that one rank gets from another.
#[derive(Default)]
struct Message {
    /// Nodes of triangles and tetrahedra that are candidates.
    nodes: BTreeSet<NodeId>,
    blocks: BTreeSet<BlockId>,
    /// Bytes if the side with the lower number evaluates, and sends the others what it found.
    once: usize,
    /// Nodes that this side then still gets.
    nodes_once: BTreeSet<NodeId>,
}

/// Messages by the rank that gets and the one that sends.
pub struct Traffic {
    ranks: usize,
    blocks: Vec<usize>,
    pairs: usize,
    across: usize,
    hits_across: usize,
    messages: BTreeMap<(usize, usize), Message>,
    whole_bytes: usize,
}

/// Two blocks that are near: the one with the triangle and the other.
#[derive(Clone, Copy)]
struct Border {
    contactor: (BlockId, usize),
    target: (BlockId, usize),
}

impl Traffic {
    /// Headings of the columns.
    pub const HEADER: [&str; 10] = [
        "ranks",
        "blocks a rank",
        "pairs evaluated twice",
        "hits across",
        "messages a rank",
        "kB a rank gets, mean",
        "largest",
        "whole near blocks, kB",
        "B per hit across",
        "evaluated once: B per hit across",
    ];

    /// Traffic at the blocks' present positions.
    pub fn new(owners: &Owners, candidates: &Candidates, input: &ContactInput) -> Self {
        let mut traffic = Self {
            ranks: owners.ranks,
            blocks: (0..owners.ranks).map(|rank| owners.blocks_of(rank)).collect(),
            pairs: candidates.pairs(),
            across: 0,
            hits_across: 0,
            messages: BTreeMap::new(),
            whole_bytes: 0,
        };
        for facet in candidates.facets() {
            let contactor = facet.owner;
            let (Some(a), Some(b)) = (owners.of(contactor), owners.of(facet.target)) else { continue };
            if a != b {
                let border = Border { contactor: (contactor, a), target: (facet.target, b) };
                traffic.add(border, &facet, input);
            }
        }
        traffic.whole_bytes =
            traffic.messages.values().flat_map(|m| &m.blocks).map(|b| whole(input, *b)).sum();
        traffic
    }

    fn add(&mut self, border: Border, facet: &Facet, input: &ContactInput) {
        let Border { contactor: (contactor, a), target: (target, b) } = border;
        let tets: Vec<TetId> = facet.tets().collect();
        let hits = tets.iter().filter(|tet| hits(facet, **tet, input)).count();
        self.across += tets.len();
        self.hits_across += hits;
        let triangle = input.blocks.triangles[facet.triangle.index()];
        let tet_nodes = || tets.iter().flat_map(|tet| input.blocks.tets[tet.index()]);
        let to_target = self.messages.entry((b, a)).or_default();
        to_target.nodes.extend(triangle);
        to_target.blocks.insert(contactor);
        if target < contactor {
            to_target.nodes_once.extend(triangle);
        } else if hits > 0 {
            to_target.once += hits * HIT + FACET;
        }
        let to_contactor = self.messages.entry((a, b)).or_default();
        to_contactor.nodes.extend(tet_nodes());
        to_contactor.blocks.insert(target);
        if contactor < target {
            to_contactor.nodes_once.extend(tet_nodes());
        } else if hits > 0 {
            to_contactor.once += FACET_NODES + FACET;
        }
    }

    /// The row of a table.
    pub fn cells(&self) -> Vec<String> {
        let bytes = |message: &Message| NODE * message.nodes.len() + BODY * message.blocks.len();
        let got = |rank| self.messages.iter().filter(|(ends, _)| ends.0 == rank).map(|(_, m)| bytes(m)).sum();
        let got: Vec<usize> = (0..self.ranks).map(got).collect();
        let (total, ranks) = (got.iter().sum::<usize>(), self.ranks as f64);
        let once: usize = self.messages.values().map(|m| m.once + NODE * m.nodes_once.len()).sum();
        let of = |values: &[usize]| (values.iter().min().copied(), values.iter().max().copied());
        let (least, most) = of(&self.blocks);
        let per_hit = |bytes: usize| format!("{:.0}", bytes as f64 / self.hits_across.max(1) as f64);
        let kilo = |bytes: f64| format!("{:.1}", 1e-3 * bytes);
        vec![
            self.ranks.to_string(),
            format!("{} to {}", least.unwrap_or(0), most.unwrap_or(0)),
            format!(
                "{} of {}, {:.1} %",
                self.across,
                self.pairs,
                100.0 * self.across as f64 / self.pairs as f64
            ),
            self.hits_across.to_string(),
            format!("{:.1}", self.messages.len() as f64 / ranks),
            kilo(total as f64 / ranks),
            kilo(of(&got).1.unwrap_or(0) as f64),
            kilo(self.whole_bytes as f64 / ranks),
            per_hit(total),
            per_hit(once),
        ]
    }
}

/// Whether a candidate overlaps.
fn hits(facet: &Facet, tet: TetId, input: &ContactInput) -> bool {
    let corners: [Vec3; 3] = input.blocks.triangle_corners(facet.triangle, input.position);
    TetFrame::new(&input.blocks.tet_corners(tet, input.position)).lambda_inside(&corners).is_some()
}

/// Positions and velocities of all nodes of a block, and its body [B].
fn whole(input: &ContactInput, block: BlockId) -> usize {
    NODE * input.blocks.nodes_of(block).len() + BODY
}
