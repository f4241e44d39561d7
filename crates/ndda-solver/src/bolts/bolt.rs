//! One bolt in its blocks: its static solve, and the forces that follow.

use ndda_mesh::{BlockId, Vec3};

use crate::bolts::chain::{Chain, Holder, Workspace};
use crate::bolts::embedding::{Anchor, Portion};
use crate::bolts::law::Law;
use crate::bolts::memory::{MemoryOf, Sizes};
use crate::bolts::span::{Crossing, Dowel, Frame};

/// Strain at which the steel breaks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Break {
    /// Over the gauge length.
    pub strain: f64,
    /// E A [N].
    pub ea_n: f64,
}

/// What is between neighbouring points of the rock.
#[derive(Clone, Debug)]
pub(crate) enum Span {
    /// A straight line.
    Straight {
        /// Its length at the start [m].
        rest_m: f64,
    },
    /// From one block to the next.
    Crossing {
        /// Its points.
        crossing: Box<Crossing>,
        /// How far the blocks are apart along the bolt at the start [m].
        rest_m: f64,
    },
}

impl Crossing {
    pub(crate) fn frame(&self, position: &[Vec3]) -> Frame {
        Frame::new(&[0, 1, 2, 3, 4, 5].map(|k| self.points[k].place(position)))
    }
}

/// A bolt in its blocks.
#[derive(Clone, Debug)]
pub(crate) struct Bolt {
    pub name: String,
    /// Whether it is there now: before it is installed and once it is released, it does nothing.
    pub is_installed: bool,
    /// From head to end [m].
    pub length_m: f64,
    /// Distance of each node of the bar from the head [m].
    pub nodes_m: Vec<f64>,
    pub steel: Vec<Law>,
    pub rest_m: Vec<f64>,
    pub breaks: Break,
    /// Length over which the strain at break is taken, for each piece of steel [m].
    pub gauges_m: Vec<f64>,
    /// Grout in order, then the plate.
    pub holders: Vec<Holder>,
    /// Point of the rock of each.
    pub held_at: Vec<u32>,
    pub points: Vec<Anchor>,
    pub point_block: Vec<BlockId>,
    /// Between point k and k + 1.
    pub spans: Vec<Span>,
    pub dowel: Option<Dowel>,
    pub has_plate: bool,
    pub pretension_n: f64,
    pub portions: Vec<Portion>,
    pub bonded: Vec<Portion>,
}

/// Memory of all bolts' solves, sized for the largest.
#[derive(Clone, Debug, Default)]
pub(crate) struct Work {
    pub workspace: Workspace,
    /// Displacement of the rock along the bolt at its points and at its holders [m].
    pub along_m: Vec<f64>,
    pub rock_m: Vec<f64>,
    /// Tension between points [N].
    pub span_n: Vec<f64>,
    pub trial: Vec<f64>,
    /// Forces between two blocks: that on the first [N].
    pub pairs: Vec<(BlockId, BlockId, Vec3)>,
}

impl Bolt {
    /// How much it remembers.
    pub(crate) fn sizes(&self) -> Sizes {
        Sizes { nodes: self.nodes_m.len(), holders: self.holders.len(), crossings: self.crossings() }
    }

    /// Number of places where it crosses from one block to the next.
    pub(crate) fn crossings(&self) -> usize {
        self.each_crossing().count()
    }

    /// Where it crosses from one block to the next, from its head.
    pub(crate) fn each_crossing(&self) -> impl Iterator<Item = &Crossing> {
        self.spans.iter().filter_map(|span| match span {
            Span::Crossing { crossing, .. } => Some(&**crossing),
            Span::Straight { .. } => None,
        })
    }

    /// Springs of grout, without the plate.
    pub(crate) fn grouted(&self) -> usize {
        self.holders.len() - usize::from(self.has_plate)
    }

    pub(crate) fn chain<'a>(&'a self, memory: &'a MemoryOf<'_>, rock_m: &'a [f64]) -> Chain<'a> {
        self.chain_of((memory.slip_m, memory.yielded_m, memory.broken), rock_m)
    }

    /// The bar alone, for what does not depend on the rock.
    pub(crate) fn chain_without_rock<'a>(&'a self, memory: &'a MemoryOf<'_>) -> Chain<'a> {
        Chain { holders: &[], rock_m: &[], ..self.chain(memory, memory.slip_m) }
    }

    fn chain_of<'a>(
        &'a self,
        (slip_m, yielded_m, broken): (&'a [f64], &'a [f64], &'a [bool]),
        rock_m: &'a [f64],
    ) -> Chain<'a> {
        let rock_m = &rock_m[..self.holders.len()];
        Chain {
            steel: &self.steel,
            rest_m: &self.rest_m,
            yielded_m,
            broken,
            holders: &self.holders,
            slip_m,
            rock_m,
        }
    }

    /// Finds where the bar is in balance.
    fn balance(&self, memory: &mut MemoryOf, rock_m: &[f64], workspace: &mut Workspace) {
        let MemoryOf { displacement_m, slip_m, yielded_m, broken, .. } = memory;
        self.chain_of((slip_m, yielded_m, broken), rock_m).solve(displacement_m, workspace);
    }

    /// Displacements of the rock along the bolt since it was installed.
    fn follow_rock(&self, position: &[Vec3], start_m: &[f64], work: &mut Work) {
        let mut along_m = 0.0;
        work.along_m[0] = 0.0;
        let mut before = self.points[0].place(position);
        for (k, span) in self.spans.iter().enumerate() {
            let here = self.points[k + 1].place(position);
            along_m += match span {
                Span::Straight { rest_m } => (here - before).norm() - rest_m,
                Span::Crossing { crossing, rest_m } => crossing.frame(position).along_m() - rest_m,
            };
            work.along_m[k + 1] = along_m;
            before = here;
        }
        for ((rock_m, point), start_m) in work.rock_m.iter_mut().zip(&self.held_at).zip(start_m) {
            *rock_m = work.along_m[*point as usize] - start_m;
        }
    }

    /// Installs the bolt where the rock is now: nothing but its pretension strains it.
    pub(crate) fn install(&self, position: &[Vec3], memory: MemoryOf, work: &mut Work) {
        memory.displacement_m.fill(0.0);
        memory.slip_m.fill(0.0);
        memory.start_m.fill(0.0);
        memory.yielded_m.fill(0.0);
        memory.broken.fill(false);
        *memory.gave_way_m = [0.0; 2];
        self.follow_rock(position, memory.start_m, work);
        memory.start_m.copy_from_slice(&work.rock_m[..self.holders.len()]);
        for (crossing, slip_m) in self.each_crossing().zip(memory.dowel_slip_m.iter_mut()) {
            *slip_m = crossing.frame(position).across_m();
        }
        self.tension(position, memory, work);
    }

    /// Tensions the bolt with its plate as a jack, and locks it: what slips in this is slip from the start on.
    pub(crate) fn tension(&self, position: &[Vec3], mut memory: MemoryOf, work: &mut Work) {
        if self.pretension_n == 0.0 {
            return;
        }
        self.follow_rock(position, memory.start_m, work);
        let (plate, taken_j) = (self.holders.len() - 1, *memory.dissipated_j);
        let mut jacked = self.clone();
        let stiffness_n_m = self.holders[plate].law.stiffness_n_m;
        jacked.holders[plate].law = Law::constant(stiffness_n_m, self.pretension_n);
        jacked.balance(&mut memory, &work.rock_m, &mut work.workspace);
        let head_m = memory.displacement_m[0] - work.rock_m[plate];
        memory.slip_m[plate] = head_m - self.pretension_n / stiffness_n_m;
        self.yield_parts(&mut memory, work);
        *memory.dissipated_j = taken_j;
    }

    /// Balances the bar where the rock is now; what yields or breaks is remembered. Adds forces to the nodes.
    pub(crate) fn act(&self, position: &[Vec3], mut memory: MemoryOf, work: &mut Work, force: &mut [Vec3]) {
        self.follow_rock(position, memory.start_m, work);
        self.balance(&mut memory, &work.rock_m, &mut work.workspace);
        self.yield_parts(&mut memory, work);
        while self.break_steel(&mut memory, work) {}
        self.find_tensions(&memory, work);
        let mut crossing_index = 0;
        for (k, span) in self.spans.iter().enumerate() {
            match span {
                Span::Straight { .. } => {
                    let (a, b) = (&self.points[k], &self.points[k + 1]);
                    let apart = b.place(position) - a.place(position);
                    let length_m = apart.norm();
                    if length_m > 0.0 {
                        let pull = work.span_n[k] / length_m * apart;
                        add(a, &pull, force);
                        add(b, &-pull, force);
                        self.note_pair(k, pull, &mut work.pairs);
                    }
                }
                Span::Crossing { crossing, .. } => {
                    let frame = crossing.frame(position);
                    let slip_m = &mut memory.dowel_slip_m[crossing_index];
                    crossing_index += 1;
                    let shear_n = self.dowel.map_or([0.0; 2], |dowel| {
                        let (shear_n, more_m, work_j) = dowel.respond(frame.across_m(), *slip_m);
                        *slip_m = [slip_m[0] + more_m[0], slip_m[1] + more_m[1]];
                        memory.gave_way_m[1] += more_m[0].hypot(more_m[1]);
                        *memory.dissipated_j += work_j;
                        shear_n
                    });
                    let forces = frame.forces(work.span_n[k], shear_n);
                    self.note_pair(k, forces[0] + forces[1], &mut work.pairs);
                    crossing.points.iter().zip(&forces).for_each(|(point, f)| add(point, f, force));
                }
            }
        }
    }

    fn note_pair(&self, span: usize, force: Vec3, pairs: &mut Vec<(BlockId, BlockId, Vec3)>) {
        let (a, b) = (self.point_block[span], self.point_block[span + 1]);
        if a != b {
            pairs.push((a, b, force));
        }
    }

    /// Remembers what has yielded.
    fn yield_parts(&self, memory: &mut MemoryOf, work: &Work) {
        let mut taken_j = 0.0;
        for (k, holder) in self.holders.iter().enumerate() {
            let offset_m = self.chain(memory, &work.rock_m).offset_m(k, memory.displacement_m);
            let (more_m, work_j) = holder.law.yielding(offset_m);
            memory.slip_m[k] += more_m;
            if k >= self.grouted() {
                memory.gave_way_m[0] += more_m.abs();
            }
            taken_j += work_j;
        }
        for (i, law) in self.steel.iter().enumerate().filter(|(i, _)| !memory.broken[*i]) {
            let stretch_m = self.chain(memory, &work.rock_m).stretch_m(i, memory.displacement_m);
            let (more_m, work_j) = law.yielding(stretch_m);
            memory.yielded_m[i] += more_m;
            taken_j += work_j;
        }
        *memory.dissipated_j += taken_j;
    }

    /// Breaks what is stretched too far, and balances the rest; the energy set free is gone, since nothing of a bolt has mass.
    fn break_steel(&self, memory: &mut MemoryOf, work: &mut Work) -> bool {
        if self.breaks.strain.is_infinite() {
            return false;
        }
        let before_j = self.stored_j(memory, &work.rock_m);
        let mut breaks = false;
        for i in 0..self.steel.len() {
            if memory.broken[i] {
                continue;
            }
            let tension_n = self.chain(memory, &work.rock_m).tension_n(i, memory.displacement_m);
            let strain = tension_n / self.breaks.ea_n + memory.yielded_m[i] / self.gauges_m[i];
            if strain >= self.breaks.strain {
                memory.broken[i] = true;
                breaks = true;
            }
        }
        if breaks {
            self.balance(memory, &work.rock_m, &mut work.workspace);
            let kept_j = self.chain(memory, &work.rock_m).potential_j(memory.displacement_m);
            let known_j = *memory.dissipated_j;
            // Slip that goes on as the pieces draw back is part of the energy set free.
            self.yield_parts(memory, work);
            let freed_j = before_j - kept_j + (*memory.dissipated_j - known_j);
            *memory.dissipated_j = known_j + freed_j.max(0.0);
        }
        breaks
    }

    /// Elastic energy of steel, grout and plate, nothing of which yields further [J].
    fn stored_j(&self, memory: &MemoryOf, rock_m: &[f64]) -> f64 {
        let chain = self.chain(memory, rock_m);
        let u = &*memory.displacement_m;
        let of = |force_n: f64, law: &Law| 0.5 * force_n * force_n / law.stiffness_n_m;
        let steel = (0..self.steel.len()).map(|i| of(chain.tension_n(i, u), &self.steel[i])).sum::<f64>();
        let holders = self.holders.iter().enumerate().map(|(k, one)| of(chain.hold_n(k, u), &one.law));
        steel + holders.sum::<f64>()
    }

    /// Tension between the points of the rock: the sum of what holds the bar before [N].
    fn find_tensions(&self, memory: &MemoryOf, work: &mut Work) {
        let Work { rock_m, span_n, .. } = work;
        span_n[..self.points.len()].fill(0.0);
        let chain = self.chain(memory, rock_m);
        for (k, point) in self.held_at.iter().enumerate() {
            span_n[*point as usize] += chain.hold_n(k, memory.displacement_m);
        }
        let mut sum_n = 0.0;
        for tension_n in &mut span_n[..self.points.len()] {
            sum_n += *tension_n;
            *tension_n = sum_n;
        }
    }

    /// Energy stored and work of yielding further, with the rock at `position` [J]; nothing is remembered.
    pub(crate) fn potential_j(&self, position: &[Vec3], memory: &MemoryOf, work: &mut Work) -> f64 {
        self.follow_rock(position, memory.start_m, work);
        let Work { workspace, rock_m, trial, .. } = work;
        let rock_m = &rock_m[..];
        let u = &mut trial[..self.nodes_m.len()];
        u.copy_from_slice(memory.displacement_m);
        let chain = self.chain(memory, rock_m);
        chain.solve(u, workspace);
        let mut energy_j = chain.potential_j(u);
        let Some(dowel) = self.dowel else { return energy_j };
        for (crossing, slip_m) in self.each_crossing().zip(memory.dowel_slip_m.iter()) {
            energy_j += dowel.potential_j(crossing.frame(position).across_m(), *slip_m);
        }
        energy_j
    }
}

fn add(point: &Anchor, pull: &Vec3, force: &mut [Vec3]) {
    for (node, weight) in point.nodes.iter().zip(point.weights) {
        force[*node as usize] += weight * pull;
    }
}
