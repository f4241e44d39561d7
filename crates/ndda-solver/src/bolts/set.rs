//! All bolts of a simulation, and what a step does with them.

use ndda_mesh::{BlockSet, Vec3};

use crate::bodies::kind::BodyKind;
use crate::bolts::bolt::{Bolt, Work};
use crate::bolts::chain::Workspace;
use crate::bolts::error::BoltError;
use crate::bolts::memory::{BoltMemory, Sizes};
use crate::bolts::setup::BoltSetup;
use crate::error::SetupError;

/// All bolts, and memory that every step uses again.
#[derive(Default)]
pub(crate) struct Bolts {
    pub list: Vec<Bolt>,
    /// How much each remembers.
    pub sizes: Vec<Sizes>,
    /// Nodes that bolts act on, in order, and bounds of Σ|k| there [N/m].
    pub rows: Vec<(u32, f64)>,
    pub work: Work,
    /// Forces on all nodes [N].
    pub force: Vec<Vec3>,
    /// What was remembered before a step whose end is being looked for.
    pub before: BoltMemory,
}

impl Bolts {
    /// Sets bolts in blocks at rest, and tensions them.
    pub(crate) fn new(
        setups: &[BoltSetup],
        blocks: &BlockSet,
        kinds: &[BodyKind],
    ) -> Result<(Self, BoltMemory), SetupError> {
        let build = |setup: &BoltSetup| {
            let of_bolt = |source: BoltError| SetupError::Bolt { bolt: setup.name.clone(), source };
            setup.build(blocks).map_err(of_bolt)
        };
        let list: Vec<Bolt> = setups.iter().map(build).collect::<Result<_, _>>()?;
        let most = |of: fn(&Bolt) -> usize| list.iter().map(of).max().unwrap_or(0);
        let mut work = Work {
            workspace: Workspace::new(most(|bolt| bolt.nodes_m.len())),
            along_m: vec![0.0; most(|bolt| bolt.points.len())],
            rock_m: vec![0.0; most(|bolt| bolt.holders.len())],
            span_n: vec![0.0; most(|bolt| bolt.points.len())],
            trial: vec![0.0; most(|bolt| bolt.nodes_m.len())],
            pairs: Vec::with_capacity(list.iter().map(|bolt| bolt.spans.len()).sum()),
        };
        let mut rows = Vec::new();
        for bolt in list.iter().filter(|bolt| bolt.is_installed) {
            bolt.add_row_sums(kinds, &mut rows);
            // Nodes that it acts on without stiffness are listed too.
            let nodes = bolt.points.iter().flat_map(|point| point.nodes);
            rows.extend(nodes.map(|node| (node, 0.0)));
            // The edge of a crossing is of one tetrahedron.
            let edges = bolt.each_crossing().flat_map(|crossing| crossing.points[4].nodes);
            rows.extend(edges.map(|node| (node, 0.0)));
        }
        rows.sort_by_key(|(node, _)| *node);
        rows.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
        let sizes: Vec<Sizes> = list.iter().map(Bolt::sizes).collect();
        let mut memory = BoltMemory::new(&sizes);
        memory.each(&sizes, |k, memory| {
            if list[k].is_installed {
                list[k].tension(&blocks.rest_position, memory, &mut work);
            }
        });
        let force = vec![Vec3::zeros(); blocks.rest_position.len()];
        Ok((Self { list, sizes, rows, work, force, before: memory.clone() }, memory))
    }

    /// Sum over all nodes of how large the forces on them are, where they cancel too [N].
    pub(crate) fn size_n(&self) -> f64 {
        self.rows.iter().map(|(node, _)| self.force[*node as usize].norm()).sum()
    }
}
