//! What bolts carry, for tables and pictures.

use ndda_mesh::Vec3;
use serde::{Deserialize, Serialize};

use crate::bolts::bolt::Bolt;
use crate::bolts::memory::MemoryOf;

/// State of a piece of a bolt.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum PieceState {
    /// Nothing has yielded.
    #[default]
    Elastic,
    /// Its grout has slipped.
    Debonded,
    /// Its steel has yielded.
    Yielding,
    /// Its steel is broken.
    Broken,
}

impl PieceState {
    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Elastic => "elastic",
            Self::Debonded => "debonded",
            Self::Yielding => "yielding",
            Self::Broken => "broken",
        }
    }
}

/// A piece of a bolt between two nodes of its bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoltPiece {
    /// Index of the bolt.
    pub bolt: usize,
    /// Index of the piece, from the head.
    pub piece: usize,
    /// Distance of its ends from the head [m].
    pub along_m: [f64; 2],
    /// Where its ends are [m], relative to the origin of the blocks.
    pub ends_m: [Vec3; 2],
    /// Block in which it begins.
    pub block: u32,
    /// Tension [N].
    pub axial_n: f64,
    /// Tension over the force at which the steel yields; zero where it never does.
    pub utilisation: f64,
    /// Largest slip of the grout at its ends [m].
    pub slip_m: f64,
    /// Its state.
    pub state: PieceState,
}

/// State of a bolt as a whole: the worst that has happened to it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum BoltState {
    /// Nothing has yielded.
    #[default]
    Elastic,
    /// Grout has slipped.
    Debonded,
    /// Its plate has been loaded to its strength and has yielded.
    PlateYielding,
    /// A dowel has been loaded to its capacity and has yielded.
    DowelYielding,
    /// Steel has yielded.
    Yielding,
    /// Steel is broken.
    Broken,
}

impl BoltState {
    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Elastic => "elastic",
            Self::Debonded => "debonded",
            Self::PlateYielding => "plate yielding",
            Self::DowelYielding => "dowel yielding",
            Self::Yielding => "yielding",
            Self::Broken => "broken",
        }
    }
}

impl From<PieceState> for BoltState {
    fn from(state: PieceState) -> Self {
        match state {
            PieceState::Elastic => Self::Elastic,
            PieceState::Debonded => Self::Debonded,
            PieceState::Yielding => Self::Yielding,
            PieceState::Broken => Self::Broken,
        }
    }
}

/// A bolt as a whole.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BoltStatus {
    /// Largest tension of its pieces, the sign kept [N].
    pub axial_n: f64,
    /// Largest tension over the force at which it yields.
    pub utilisation: f64,
    /// Largest shear force of its dowels [N].
    pub shear_n: f64,
    /// How far its plate has yielded [m].
    pub plate_yielded_m: f64,
    /// How far its dowels have yielded in all [m].
    pub dowel_yielded_m: f64,
    /// Its state.
    pub state: BoltState,
    /// Part of the bonded length whose grout has slipped.
    pub debonded: f64,
    /// Energy taken by slip, yielding and breaks [J].
    pub dissipated_j: f64,
}

impl Bolt {
    /// Adds its pieces.
    pub(crate) fn add_pieces(
        &self,
        index: usize,
        position: &[Vec3],
        memory: &MemoryOf,
        out: &mut Vec<BoltPiece>,
    ) {
        // Steel does not depend on where the rock is but through its nodes.
        let chain = self.chain_without_rock(memory);
        for i in 0..self.steel.len() {
            let axial_n = chain.tension_n(i, memory.displacement_m);
            let ends = [self.last_point(i), self.first_point(i + 1)];
            let held = |k: &usize| [i, i + 1].contains(&(self.holders[*k].node as usize));
            let slips = (0..self.grouted()).filter(held).map(|k| memory.slip_m[k].abs());
            let slip_m = slips.fold(0.0, f64::max);
            let state = if memory.broken[i] {
                PieceState::Broken
            } else if memory.yielded_m[i] != 0.0 {
                PieceState::Yielding
            } else if slip_m > 0.0 {
                PieceState::Debonded
            } else {
                PieceState::Elastic
            };
            out.push(BoltPiece {
                bolt: index,
                piece: i,
                along_m: [self.nodes_m[i], self.nodes_m[i + 1]],
                ends_m: ends.map(|point| self.points[point].place(position)),
                block: self.point_block[ends[0]].0,
                axial_n,
                utilisation: axial_n.abs() / self.steel[i].most_n,
                slip_m,
                state,
            });
        }
    }

    /// The last point of the rock at a node of the bar, seen from the head; of the node after it, the first.
    fn last_point(&self, node: usize) -> usize {
        let found = self.points_at(node).last();
        found.unwrap_or(0)
    }

    fn first_point(&self, node: usize) -> usize {
        let found = self.points_at(node).next();
        found.unwrap_or(self.points.len() - 1)
    }

    fn points_at(&self, node: usize) -> impl Iterator<Item = usize> + '_ {
        let grout = self.holders[..self.grouted()].iter().zip(&self.held_at);
        grout.filter(move |(one, _)| one.node as usize == node).map(|(_, point)| *point as usize)
    }

    /// The bolt as a whole.
    pub(crate) fn status(&self, position: &[Vec3], memory: &MemoryOf, pieces: &[BoltPiece]) -> BoltStatus {
        let [plate_yielded_m, dowel_yielded_m] = *memory.gave_way_m;
        let plate = if plate_yielded_m > 0.0 { BoltState::PlateYielding } else { BoltState::Elastic };
        let dowel = if dowel_yielded_m > 0.0 { BoltState::DowelYielding } else { BoltState::Elastic };
        let mut status = BoltStatus {
            dissipated_j: *memory.dissipated_j,
            plate_yielded_m,
            dowel_yielded_m,
            state: plate.max(dowel),
            ..BoltStatus::default()
        };
        for piece in pieces {
            if piece.axial_n.abs() > status.axial_n.abs() {
                status.axial_n = piece.axial_n;
            }
            status.utilisation = status.utilisation.max(piece.utilisation);
            status.state = status.state.max(piece.state.into());
        }
        let (mut slipped, mut all) = (0.0, 0.0);
        for (k, holder) in self.holders[..self.grouted()].iter().enumerate() {
            all += holder.law.stiffness_n_m;
            slipped += if memory.slip_m[k] == 0.0 { 0.0 } else { holder.law.stiffness_n_m };
        }
        status.debonded = slipped / all;
        for (crossing, slip_m) in self.each_crossing().zip(memory.dowel_slip_m.iter()) {
            let across_m = crossing.frame(position).across_m();
            let shear_n = self.dowel.map_or([0.0; 2], |dowel| dowel.respond(across_m, *slip_m).0);
            status.shear_n = status.shear_n.max(shear_n[0].hypot(shear_n[1]));
        }
        status
    }
}
