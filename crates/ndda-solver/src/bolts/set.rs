//! All bolts of a simulation, and what a step does with them.

use std::mem::take;

use ndda_mesh::{BlockId, BlockSet, Vec3};

use crate::bodies::kind::BodyKind;
use crate::bolts::bolt::{Bolt, Span, Work};
use crate::bolts::chain::Room;
use crate::bolts::memory::BoltMemory;
use crate::bolts::setup::{BoltError, BoltSetup};
use crate::error::SetupError;
use crate::step::Simulation;
use crate::step::first_step::seen;

/// All bolts, and memory that every step uses again.
#[derive(Default)]
pub(crate) struct Bolts {
    pub list: Vec<Bolt>,
    /// Nodes that bolts act on, in order, and bounds of Σ|k| there [N/m].
    rows: Vec<(u32, f64)>,
    work: Work,
    /// Forces on all nodes [N].
    force: Vec<Vec3>,
    /// What was remembered before a step whose end is being looked for.
    before: BoltMemory,
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
            room: Room::new(most(|bolt| bolt.nodes_m.len())),
            along_m: vec![0.0; most(|bolt| bolt.points.len())],
            rock_m: vec![0.0; most(|bolt| bolt.holders.len())],
            span_n: vec![0.0; most(|bolt| bolt.points.len())],
            trial: vec![0.0; most(|bolt| bolt.nodes_m.len())],
            pairs: Vec::with_capacity(list.iter().map(|bolt| bolt.spans.len()).sum()),
        };
        let mut rows = Vec::new();
        for bolt in &list {
            bolt.add_row_sums(blocks, kinds, &mut rows);
            // Nodes that it acts on without stiffness are listed too.
            let nodes = bolt.points.iter().flat_map(|point| point.nodes);
            rows.extend(nodes.map(|node| (node, 0.0)));
            rows.extend(bolt.edge_nodes().map(|node| (node, 0.0)));
        }
        rows.sort_by_key(|(node, _)| *node);
        rows.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
        let mut memory = BoltMemory::new(&list);
        memory.each(&list, |bolt, memory| bolt.tension(&blocks.rest_position, memory, &mut work));
        let force = vec![Vec3::zeros(); blocks.rest_position.len()];
        Ok((Self { list, rows, work, force, before: memory.clone() }, memory))
    }

    /// Forces that bolts exert on the first of two blocks, and against on the second.
    pub(crate) fn pairs(&self) -> &[(BlockId, BlockId, Vec3)] {
        &self.work.pairs
    }

    /// Force on each node, as last found [N].
    pub(crate) fn force(&self) -> &[Vec3] {
        &self.force
    }
}

impl Bolt {
    fn edge_nodes(&self) -> impl Iterator<Item = u32> + '_ {
        self.spans.iter().flat_map(|span| match span {
            Span::Crossing { crossing, .. } => crossing.points[4].nodes.to_vec(),
            Span::Straight { .. } => Vec::new(),
        })
    }
}

impl Simulation {
    /// Finds the forces of bolts where contact is evaluated; what yields is remembered.
    pub(crate) fn find_bolt_forces(&mut self) {
        let Some(mut bolts) = self.bolts.take() else { return };
        let mut room = take(&mut self.scratch.seen_position);
        let position =
            seen(&self.problem.blocks, &self.state.contact_offset, &self.scratch.contact_position, &mut room);
        let Bolts { list, rows, work, force, .. } = &mut *bolts;
        rows.iter().for_each(|(node, _)| force[*node as usize] = Vec3::zeros());
        work.pairs.clear();
        self.state.bolts.each(list, |bolt, memory| bolt.act(position, memory, work, force));
        self.scratch.seen_position = room;
        self.bolts = Some(bolts);
    }

    /// force ← force + bolts, and their stiffness.
    pub(crate) fn add_bolt_forces(&mut self) {
        let Some(bolts) = &self.bolts else { return };
        if !std::mem::replace(&mut self.scratch.contact_has_acted, true) || self.contact.is_none() {
            self.scratch.friction_force.fill(Vec3::zeros());
            self.scratch.contact_stiffness.fill(0.0);
        }
        for (node, stiffness_n_m) in &bolts.rows {
            let node = *node as usize;
            self.scratch.force[node] += bolts.force[node];
            self.scratch.contact_stiffness[node] += stiffness_n_m;
        }
    }

    /// Keeps what bolts remember before the end of a step is looked for, or goes back to it.
    pub(crate) fn keep_bolts(&mut self) {
        if let Some(bolts) = &mut self.bolts {
            bolts.before.copy_from(&self.state.bolts);
        }
    }

    /// Goes back to what was [kept](Self::keep_bolts).
    pub(crate) fn put_bolts_back(&mut self) {
        if let Some(bolts) = &self.bolts {
            self.state.bolts.copy_from(&bolts.before);
        }
    }

    /// Energy stored in bolts where blocks are now, and what they have taken [J].
    pub(crate) fn bolt_energies_j(&mut self) -> (f64, f64) {
        let Some(mut bolts) = self.bolts.take() else { return (0.0, 0.0) };
        let mut room = take(&mut self.scratch.seen_position);
        let position =
            seen(&self.problem.blocks, &self.state.contact_offset, &self.state.position, &mut room);
        let mut stored_j = 0.0;
        let Bolts { list, work, .. } = &mut *bolts;
        self.state.bolts.each(list, |bolt, memory| stored_j += bolt.potential_j(position, &memory, work));
        self.scratch.seen_position = room;
        self.bolts = Some(bolts);
        (stored_j, self.state.bolts.dissipated_j())
    }

    /// Whether there are bolts.
    pub(crate) fn has_bolts(&self) -> bool {
        self.bolts.is_some()
    }

    /// Sets bolts, if there are any.
    pub(crate) fn set_bolts(&mut self, setups: &[BoltSetup]) -> Result<(), SetupError> {
        if setups.is_empty() {
            return Ok(());
        }
        let kinds: Vec<BodyKind> = self.problem.blocks.ids().map(|block| self.shape(block).kind).collect();
        let (bolts, memory) = Bolts::new(setups, &self.problem.blocks, &kinds)?;
        self.state.bolts = memory;
        self.bolts = Some(Box::new(bolts));
        Ok(())
    }
}
