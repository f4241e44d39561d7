//! How slips answer to the friction of all patches, block by block.

use ndda_mesh::{Mat3, Vec3};

use crate::friction::patches::GRAIN_BODIES;
use crate::friction::patches::nodal::{BlockSides, NodalSide};
use crate::friction::patches::solve::{CoupledPatch, Motion};
use crate::model::Body;

/// A side of a patch on a block.
#[derive(Clone, Copy)]
struct Side {
    /// Row of its patch, and 1, or −1 where the block is its target.
    row: u32,
    sign: f64,
    /// Where it is on a block that deforms.
    nodal: Option<NodalSide>,
}

/// Slips of a side for each of six motions of the block by itself, each of which has the same energy at the same speed: L Jᵀ, the mobility of the block
/// within the time of friction being L Lᵀ.
type Slips = [[f64; 6]; 3];

/// A block, the end of its sides among all, and that of its velocities where it deforms.
#[derive(Clone, Copy)]
struct Answer {
    block: u32,
    sides: u32,
    /// Place among the blocks that answer.
    slot: Option<u32>,
    rows: u32,
    /// End of the answers to its sides.
    answers: usize,
}

/// For each of the two sides of a patch, its place among all sides; none where the block does not move.
pub(super) type Places = [Option<u32>; 2];

/// The sides of all patches, block by block.
#[derive(Default)]
pub(super) struct Coupling {
    answers: Vec<Answer>,
    sides: Vec<Side>,
    /// Of sides on blocks that do not deform; empty where all do.
    slips: Vec<Slips>,
    /// By how much the last friction has changed the slip of each side.
    found: Vec<Vec3>,
    /// How blocks that deform answer to sides, block by block and side by side: what is sought is but a step of Newton's method, which visits correct, and half as
    /// many bytes take half the time to read.
    answers_of_sides: Vec<[f32; 3]>,
    /// Room for the velocities, or slips, of blocks that deform.
    velocities: Vec<Vec3>,
    /// First side of each block, while sides are counted; then the end of its sides.
    starts: Vec<u32>,
}

impl Coupling {
    /// Takes the patches of a stage, whose friction acts for `time_s`, and tells where the sides of each are.
    pub(super) fn begin(
        &mut self,
        patches: &[CoupledPatch],
        motion: &Motion,
        time_s: f64,
        mut tell: impl FnMut(Places),
    ) {
        let bodies = &*motion.bodies;
        let moves =
            |patch: &CoupledPatch, k: usize| (!patch.is_held(k, bodies)).then_some(patch.blocks()[k].index());
        let Self { answers, sides, slips, found, answers_of_sides, velocities, starts } = self;
        starts.clear();
        starts.resize(bodies.len() + 1, 0);
        for patch in patches {
            (0..2).filter_map(|k| moves(patch, k)).for_each(|block| starts[block + 1] += 1);
        }
        (0..bodies.len()).for_each(|block| starts[block + 1] += starts[block]);
        let count = starts[bodies.len()] as usize;
        sides.clear();
        sides.resize(count, Side { row: 0, sign: 0.0, nodal: None });
        for (row, patch) in (0..).zip(patches) {
            tell([0, 1].map(|k| {
                let place = &mut starts[moves(patch, k)?];
                sides[*place as usize] = Side { row, sign: [1.0, -1.0][k], nodal: patch.sides[k] };
                *place += 1;
                Some(*place - 1)
            }));
        }
        // Each entry has moved on to where its block ends.
        let (mut begin, mut rows) = (0, 0);
        let (_, columns) = motion.nodal.blocks();
        answers.clear();
        answers_of_sides.clear();
        for (block, &end) in (0..).zip(&starts[..bodies.len()]) {
            if end > begin {
                let nodal = sides[begin as usize].nodal;
                rows += nodal.map_or(0, |side| side.rows() as u32);
                for side in sides[begin as usize..end as usize].iter().filter_map(|side| side.nodal.as_ref())
                {
                    let single = |v: &Vec3| [v.x as f32, v.y as f32, v.z as f32];
                    answers_of_sides.extend(side.columns(&columns[side.slot as usize]).iter().map(single));
                }
                let (slot, answers_end) = (nodal.map(|side| side.slot), answers_of_sides.len());
                answers.push(Answer { block, sides: end, slot, rows, answers: answers_end });
            }
            begin = end;
        }
        found.clear();
        found.resize(count, Vec3::zeros());
        velocities.clear();
        velocities.resize(rows as usize, Vec3::zeros());
        slips.clear();
        if answers.iter().any(|answer| answer.slot.is_none()) {
            slips.resize(count, Slips::default());
            self.fit(patches, bodies, time_s);
        }
    }

    /// Finds the slips of sides on blocks that do not deform.
    fn fit(&mut self, patches: &[CoupledPatch], bodies: &[Body], time_s: f64) {
        let mut begin = 0;
        for answer in &self.answers {
            let places = begin..answer.sides as usize;
            begin = places.end;
            if answer.slot.is_none() {
                let sides = self.sides[places.clone()].iter().zip(&mut self.slips[places]);
                fit(sides, patches, &bodies[answer.block as usize], time_s);
            }
        }
    }

    /// Finds by how much friction changes slips, `friction` being that of each row.
    pub(super) fn answer(&mut self, motion: &Motion, time_s: f64, friction: &[Vec3]) {
        let Self { answers, sides, slips, found, answers_of_sides, velocities, .. } = self;
        let (blocks, _) = motion.nodal.blocks();
        let part = time_s / motion.dt_s;
        let scene = AnswerScene { sides, slips, blocks, answers: answers_of_sides, part, friction };
        scene.answer(answers, [0; 2], (&mut found[..], &mut velocities[..]));
    }

    /// Change of the slip of a patch.
    pub(super) fn slip(&self, places: &Places) -> Vec3 {
        places.iter().flatten().map(|place| self.found[*place as usize]).sum()
    }
}

/// Sides, answers and friction that the change of slips is computed from.
#[derive(Clone, Copy)]
struct AnswerScene<'a> {
    sides: &'a [Side],
    slips: &'a [Slips],
    blocks: &'a [BlockSides],
    answers: &'a [[f32; 3]],
    part: f64,
    friction: &'a [Vec3],
}

impl AnswerScene<'_> {
    /// The answers of some blocks, whose sides and velocities begin at `first`.
    fn answer(
        &self,
        answers: &[Answer],
        [first, first_row]: [u32; 2],
        (found, velocities): (&mut [Vec3], &mut [Vec3]),
    ) {
        if answers.len() > GRAIN_BODIES {
            let (head, tail) = answers.split_at(answers.len() / 2);
            let last = &head[head.len() - 1];
            let (middle, row) = (last.sides, last.rows);
            let (here, rest) = found.split_at_mut((middle - first) as usize);
            let (own, others) = velocities.split_at_mut((row - first_row) as usize);
            rayon::join(
                || self.answer(head, [first, first_row], (here, own)),
                || self.answer(tail, [middle, row], (rest, others)),
            );
            return;
        }
        let (mut begin, mut row, mut found, mut left) = (first, first_row, found, velocities);
        for answer in answers {
            let (here, rest) = found.split_at_mut((answer.sides - begin) as usize);
            let (own, others) = left.split_at_mut((answer.rows - row) as usize);
            let sides = begin as usize..answer.sides as usize;
            match answer.slot {
                Some(slot) => {
                    let answers = &self.answers[..answer.answers];
                    self.of_nodes(slot as usize, (&self.sides[sides], answers), here, own);
                }
                None => self.of_body(sides, here),
            }
            (begin, row, found, left) = (answer.sides, answer.rows, rest, others);
        }
    }

    fn of_body(&self, sides: std::ops::Range<usize>, found: &mut [Vec3]) {
        let mut motion = [0.0; 6];
        let each = || self.sides[sides.clone()].iter().zip(&self.slips[sides.clone()]);
        for (side, [a, b, c]) in each() {
            let f = self.friction[side.row as usize];
            for (((v, a), b), c) in motion.iter_mut().zip(a).zip(b).zip(c) {
                *v += f.x * a + f.y * b + f.z * c;
            }
        }
        for (found, (_, slips)) in found.iter_mut().zip(each()) {
            let slip = |row: &[f64; 6]| {
                let sums: [f64; 3] = std::array::from_fn(|i| row[i] * motion[i] + row[i + 3] * motion[i + 3]);
                sums[0] + sums[1] + sums[2]
            };
            *found = Vec3::new(slip(&slips[0]), slip(&slips[1]), slip(&slips[2]));
        }
    }

    /// The answers of a block that deforms; those to its sides are the last of `answers`.
    fn of_nodes(
        &self,
        slot: usize,
        (sides, answers): (&[Side], &[[f32; 3]]),
        found: &mut [Vec3],
        velocities: &mut [Vec3],
    ) {
        velocities.fill(Vec3::zeros());
        let (rows, part) = (velocities.len(), self.part);
        let answers = &answers[answers.len() - 3 * rows * sides.len()..];
        for (Side { row, sign, .. }, answers) in sides.iter().zip(answers.chunks_exact(3 * rows)) {
            let force = sign * part * self.friction[*row as usize];
            let ([first, second, third], wide) =
                ([0, 1, 2].map(|k| &answers[k * rows..][..rows]), |v: &[f32; 3]| {
                    Vec3::from(v.map(f64::from))
                });
            for (((v, a), b), c) in velocities.iter_mut().zip(first).zip(second).zip(third) {
                *v += force.x * wide(a) + force.y * wide(b) + force.z * wide(c);
            }
        }
        for (found, Side { sign, nodal, .. }) in found.iter_mut().zip(sides) {
            let slip = |place: &NodalSide| *sign * place.slip(&self.blocks[slot], velocities);
            *found = nodal.as_ref().map_or(Vec3::zeros(), slip);
        }
    }
}

/// Finds the slips of the sides of one block.
fn fit<'a>(
    sides: impl Iterator<Item = (&'a Side, &'a mut Slips)>,
    patches: &[CoupledPatch],
    body: &Body,
    time_s: f64,
) {
    let (shift, turn) = ((time_s / body.mass_kg).sqrt(), time_s.sqrt() * root(&body.inverse_inertia));
    for (side, slips) in sides {
        let (patch, k) = (&patches[side.row as usize], usize::from(side.sign < 0.0));
        let [s, t, n] = patch.axes;
        let turns = [patch.arms[k].cross(&s), patch.arms[k].cross(&t), patch.surface.radius_m * n];
        for ((slips, axis), arm) in slips.iter_mut().zip([s, t, Vec3::zeros()]).zip(turns) {
            let (by_shift, by_turn) = (side.sign * shift * axis, side.sign * turn.tr_mul(&arm));
            slips[..3].copy_from_slice(by_shift.as_slice());
            slips[3..].copy_from_slice(by_turn.as_slice());
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
