//! How slips answer to the friction of all patches, block by block.

use ndda_mesh::{Mat3, Vec3};
use rayon::prelude::*;

use crate::friction::patches::GRAIN_BODIES;
use crate::friction::patches::nodal::BlockSides;
use crate::friction::patches::solve::{CoupledPatch, Motion};
use crate::model::Body;

/// A side of a patch on a block.
struct Side {
    /// Row of its patch, and whether the block is its target.
    row: u32,
    is_target: bool,
    /// Slip for each of six motions of the block by itself, each of which has the same energy at the same speed: L Jᵀ, its mobility within the time of friction
    /// being L Lᵀ; zero for a block that deforms.
    slips: [[f64; 6]; 3],
}

/// The sides of all patches on one block.
#[derive(Default)]
struct Answer {
    is_nodal: bool,
    sides: Vec<Side>,
    /// By how much the last friction has changed the slip of each.
    found: Vec<Vec3>,
}

/// For each of the two sides of a patch, its block and its index among the sides of that block; none where the block does not move.
pub(super) type Places = [Option<(u32, u32)>; 2];

/// The sides of all patches.
#[derive(Default)]
pub(super) struct Coupling {
    answers: Vec<Answer>,
}

impl Coupling {
    /// Takes the patches of a stage, whose friction acts for `time_s`, and tells where the sides of each are.
    pub(super) fn begin(
        &mut self,
        patches: &[CoupledPatch],
        bodies: &[Body],
        time_s: f64,
        mut tell: impl FnMut(Places),
    ) {
        self.answers.resize_with(bodies.len(), Answer::default);
        self.answers.iter_mut().for_each(|answer| answer.sides.clear());
        for (row, patch) in (0..).zip(patches) {
            let mut places = [None; 2];
            for (k, (block, place)) in patch.blocks().into_iter().zip(&mut places).enumerate() {
                let (body, answer) = (&bodies[block.index()], &mut self.answers[block.index()]);
                let is_nodal = patch.sides[k].is_some();
                if is_nodal || body.mass_kg.is_finite() {
                    *place = Some((block.0, answer.sides.len() as u32));
                    answer.sides.push(Side { row, is_target: k == 1, slips: [[0.0; 6]; 3] });
                    answer.is_nodal = is_nodal;
                }
            }
            tell(places);
        }
        let answers = self.answers.par_iter_mut().zip(bodies).with_min_len(GRAIN_BODIES);
        answers.for_each(|(answer, body)| answer.fit(patches, body, time_s));
    }

    /// Finds by how much friction changes slips, `friction` being that of a row.
    pub(super) fn answer(
        &mut self,
        patches: &[CoupledPatch],
        motion: &mut Motion,
        time_s: f64,
        friction: impl Fn(u32) -> Vec3 + Sync,
    ) {
        let part = time_s / motion.dt_s;
        let answers = self.answers.par_iter_mut().zip(motion.nodal.blocks_mut());
        answers.with_min_len(GRAIN_BODIES).for_each(|(answer, (sides, columns))| {
            if answer.is_nodal {
                answer.of_nodes(patches, (sides, columns), part, &friction);
            } else {
                answer.of_body(&friction);
            }
        });
    }

    /// Change of the slip of a patch.
    pub(super) fn slip(&self, places: &Places) -> Vec3 {
        let of = |&(block, place): &(u32, u32)| self.answers[block as usize].found[place as usize];
        places.iter().flatten().map(of).sum()
    }
}

impl Answer {
    fn fit(&mut self, patches: &[CoupledPatch], body: &Body, time_s: f64) {
        self.found.resize(self.sides.len(), Vec3::zeros());
        if self.is_nodal || self.sides.is_empty() {
            return;
        }
        let (shift, turn) = ((time_s / body.mass_kg).sqrt(), time_s.sqrt() * root(&body.inverse_inertia));
        for side in &mut self.sides {
            let (patch, k) = (&patches[side.row as usize], usize::from(side.is_target));
            let sign = [1.0, -1.0][k];
            let [s, t, n] = patch.axes;
            let turns = [patch.arms[k].cross(&s), patch.arms[k].cross(&t), patch.surface.radius_m * n];
            for ((slips, axis), arm) in side.slips.iter_mut().zip([s, t, Vec3::zeros()]).zip(turns) {
                let (by_shift, by_turn) = (sign * shift * axis, sign * turn.tr_mul(&arm));
                slips[..3].copy_from_slice(by_shift.as_slice());
                slips[3..].copy_from_slice(by_turn.as_slice());
            }
        }
    }

    fn of_body(&mut self, friction: &impl Fn(u32) -> Vec3) {
        let mut motion = [0.0; 6];
        for side in &self.sides {
            let f = friction(side.row);
            let [a, b, c] = &side.slips;
            for (((v, a), b), c) in motion.iter_mut().zip(a).zip(b).zip(c) {
                *v += f.x * a + f.y * b + f.z * c;
            }
        }
        for (found, side) in self.found.iter_mut().zip(&self.sides) {
            let slip = |row: &[f64; 6]| {
                let sums: [f64; 3] = std::array::from_fn(|i| row[i] * motion[i] + row[i + 3] * motion[i + 3]);
                sums[0] + sums[1] + sums[2]
            };
            *found = Vec3::new(slip(&side.slips[0]), slip(&side.slips[1]), slip(&side.slips[2]));
        }
    }

    fn of_nodes(
        &mut self,
        patches: &[CoupledPatch],
        (sides, columns): (&BlockSides, &mut [Vec3]),
        part: f64,
        friction: &impl Fn(u32) -> Vec3,
    ) {
        let nodal = |side: &Side| patches[side.row as usize].sides[usize::from(side.is_target)].as_ref();
        let sign = |side: &Side| if side.is_target { -1.0 } else { 1.0 };
        if let Some(first) = self.sides.first().and_then(nodal) {
            first.velocities(columns).fill(Vec3::zeros());
        }
        for side in &self.sides {
            if let Some(place) = nodal(side) {
                place.push(columns, &friction(side.row), sign(side) * part);
            }
        }
        for (found, side) in self.found.iter_mut().zip(&self.sides) {
            *found = nodal(side).map_or(Vec3::zeros(), |place| sign(side) * place.slip(sides, columns));
        }
    }
}

/// L of a symmetric L Lᵀ that is not negative.
fn root(product: &Mat3) -> Mat3 {
    if let Some(found) = product.cholesky() {
        return found.l();
    }
    let found = product.symmetric_eigen();
    found.eigenvectors * Mat3::from_diagonal(&found.eigenvalues.map(|part| part.max(0.0).sqrt()))
}
