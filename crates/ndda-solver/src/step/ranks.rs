//! Steps that several processes take together: each solves for its share of the blocks, and all have the state of all.

use std::ops::Range;
use std::sync::Arc;

use ndda_mesh::{BlockId, Vec3};
use ndda_ranks::{Alone, Communicator, Gathered, Packer, RanksError, Topic, Unpacker, agree, divide, share};

use crate::bodies::batch::ENOUGH_TOGETHER;
use crate::bodies::body::Body;
use crate::bodies::congruent_groups::NodeSlices;
use crate::bodies::prototype::Prototype;
use crate::bodies::report::BlockReport;
use crate::step::Simulation;

/// Unknowns from which on a block is solved for by one rank: sending the others what it reports takes longer than smaller ones do.
const ENOUGH_UNKNOWNS: usize = 24;

/// The ranks that steps are shared with, and who solves for which blocks.
pub(crate) struct Ranks {
    all: Arc<dyn Communicator>,
    /// First block of each rank, with the end appended; empty in a process that is alone.
    starts: Vec<usize>,
}

impl Default for Ranks {
    fn default() -> Self {
        Self { all: Arc::new(Alone), starts: Vec::new() }
    }
}

impl Ranks {
    /// The others, if there are any.
    pub(crate) fn partners(&self) -> Option<&dyn Communicator> {
        (!self.starts.is_empty()).then_some(&*self.all)
    }
}

/// Work of a block's solve, in units of no meaning: that of a sparse factor grows with about n^1.5. Nothing where all ranks solve for it.
fn weight(shape: &Prototype) -> u64 {
    let unknowns = shape.unknowns.len();
    let is_shared = shape.factor.is_some() && unknowns >= ENOUGH_UNKNOWNS;
    if is_shared { unknowns as u64 * (1 + (unknowns as u64).isqrt()) } else { 0 }
}

impl Simulation {
    /// Shares the steps from now on with other ranks, which have the same scene in the same state. All of them must then take the same steps.
    pub fn share_steps(&mut self, ranks: Arc<dyn Communicator>) {
        self.ranks = Ranks::default();
        if ranks.size() > 1 {
            let weights = (0..self.bodies.len()).map(|block| self.weight_of(block));
            let starts = divide(weights, ranks.size());
            // Blocks that are solved for together have the bits of those that are solved for one by one.
            self.problem.runs.split(&starts);
            let few = self.problem.runs.ranges().filter(|run| run.len() < ENOUGH_TOGETHER);
            few.for_each(|run| self.bodies[run.start].batch = None);
            self.ranks.starts = starts;
        }
        self.ranks.all = ranks;
    }

    /// The ranks that share the steps of this simulation.
    pub fn ranks(&self) -> &Arc<dyn Communicator> {
        &self.ranks.all
    }

    /// Whether any rank wants something; all must ask at the same place.
    ///
    /// # Errors
    /// [`RanksError`] when the ranks cannot go on.
    pub fn agree(&self, wanted: bool) -> Result<bool, RanksError> {
        agree(&*self.ranks.all, wanted)
    }

    fn weight_of(&self, block: usize) -> u64 {
        weight(&self.problem.shapes[self.bodies[block].shape])
    }

    /// Each block alone, those that are much work by one of the ranks. A run in which a block fails is stepped by all, so that all have its error.
    pub(super) fn solve_shared_blocks(&mut self) -> Result<(), RanksError> {
        let mut outcome = Ok(());
        self.with_bodies(|simulation, bodies, mut slices| {
            let Some(ranks) = simulation.ranks.partners() else { return };
            let shapes = &simulation.problem.shapes;
            let own = share(&simulation.ranks.starts, ranks.rank());
            let is_shared = |body: &Body| weight(&shapes[body.shape]) > 0;
            simulation.step_runs(bodies, slices.again(), &|first, run: &[Body]| {
                !is_shared(&run[0]) || own.contains(&first)
            });
            let (mut packer, mut all) = (Packer::default(), Gathered::default());
            for run in simulation.runs_within(own).filter(|run| is_shared(&bodies[run.start])) {
                simulation.pack_run(run, bodies, &slices, &mut packer);
            }
            outcome = ranks.exchange(Topic::Blocks, packer.bytes(), &mut all);
            if outcome.is_err() {
                return;
            }
            let mut failed = vec![false; bodies.len()];
            for rank in (0..ranks.size()).filter(|rank| *rank != ranks.rank()) {
                let mut found = Unpacker::new(all.of(rank));
                let theirs = simulation.runs_within(share(&simulation.ranks.starts, rank));
                for run in theirs.filter(|run| is_shared(&bodies[run.start])).collect::<Vec<_>>() {
                    failed[run.start] =
                        !simulation.unpack_run(run.clone(), bodies, slices.again(), &mut found);
                }
            }
            if failed.contains(&true) {
                simulation.step_runs(bodies, slices, &|first, _| failed[first]);
            }
        });
        outcome
    }

    /// The runs that begin within some blocks.
    fn runs_within(&self, blocks: Range<usize>) -> impl Iterator<Item = Range<usize>> {
        self.problem.runs.ranges().filter(move |run| blocks.contains(&run.start))
    }

    /// Whether none of a run has failed, and if so where its blocks are and what they report.
    fn pack_run(&self, run: Range<usize>, bodies: &[Body], slices: &NodeSlices, packer: &mut Packer) {
        let is_sound = bodies[run.clone()].iter().all(|body| body.error.is_none());
        packer.put(&u8::from(is_sound));
        for block in run.filter(|_| is_sound) {
            let nodes = self.problem.blocks.nodes_of(BlockId(block as u32));
            let NodeSlices { position, velocity, acceleration, internal_force } = slices;
            for values in [position, velocity, acceleration, internal_force] {
                let values = values.get(nodes.clone()).unwrap_or(&[]);
                packer.put_each(values, |x| <[f64; 3]>::from(*x));
            }
            bodies[block].report.pack(packer);
        }
    }

    /// Takes what another rank has packed of a run; false where it has failed.
    fn unpack_run(
        &self,
        run: Range<usize>,
        bodies: &mut [Body],
        slices: NodeSlices,
        found: &mut Unpacker,
    ) -> bool {
        if found.take::<u8>() == 0 {
            return false;
        }
        let NodeSlices { position, velocity, acceleration, internal_force } = slices;
        for block in run {
            let nodes = self.problem.blocks.nodes_of(BlockId(block as u32));
            for values in [&mut *position, &mut *velocity, &mut *acceleration, &mut *internal_force] {
                found
                    .take_into(values.get_mut(nodes.clone()).unwrap_or(&mut []), |v: [f64; 3]| Vec3::from(v));
            }
            bodies[block].report = BlockReport::unpack(found);
        }
        true
    }
}
