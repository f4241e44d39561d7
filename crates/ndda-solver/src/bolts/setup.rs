//! What a bolt is made of, and how it is cut into segments.

use ndda_mesh::{BlockId, BlockSet, Vec3};

use crate::bolts::bolt::{Bolt, Break, Span};
use crate::bolts::chain::Holder;
use crate::bolts::embedding::{Anchor, Line, Portion};
use crate::bolts::error::{BoltError, MOST_SEGMENTS};
use crate::bolts::law::Law;
use crate::bolts::span::{Crossing, Dowel};

/// Segments per length 1/λ over which grout takes up the force of the steel, if none are asked for: 0.2 % too stiff.
const SEGMENTS: f64 = 8.0;

/// The fewest: 0.8 % too stiff.
const LEAST_SEGMENTS: f64 = 4.0;

/// Length over which the strain at break is measured, over √A: proportional test pieces of ISO 6892-1.
const GAUGE: f64 = 5.65;

/// Stiffness of plates, and of steel between two sides of a closed joint, over that of the steel next to it.
const RIGID: f64 = 1e4;

/// Gaps below this part of a bolt are none.
const CLOSED: f64 = 1e-6;

/// The bar of a bolt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steel {
    /// Young's modulus [Pa].
    pub young_pa: f64,
    /// Area of its section [m²].
    pub area_m2: f64,
    /// Force at which it yields [N]; infinite if it never does.
    pub yield_n: f64,
    /// Strain at which it breaks, over a gauge length of 5.65 √A; infinite if it never does.
    pub break_strain: f64,
}

impl Steel {
    /// E A [N].
    pub fn axial_stiffness_n(&self) -> f64 {
        self.young_pa * self.area_m2
    }
}

/// The bond between a bolt and the rock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grout {
    /// k_b: shear force per length of bolt and slip [N/m²].
    pub stiffness_n_m2: f64,
    /// s_b = π D τ: largest shear force per length of bolt [N/m].
    pub strength_n_m: f64,
    /// Where the bonded length begins, from the head [m].
    pub from_m: f64,
    /// Where it ends [m].
    pub to_m: f64,
}

/// A plate that ties the head of a bolt to the face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plate {
    /// Force at which it gives way [N]; infinite if it never does.
    pub strength_n: f64,
}

/// A bolt.
#[derive(Clone, Debug, PartialEq)]
pub struct BoltSetup {
    /// Its name.
    pub name: String,
    /// Head [m], in the coordinates of the blocks.
    pub from_m: Vec3,
    /// End [m].
    pub to_m: Vec3,
    /// Its bar.
    pub steel: Steel,
    /// Its bond.
    pub grout: Grout,
    /// Resistance to shear where it crosses joints; none without.
    pub dowel: Option<Dowel>,
    /// Tension at the start, jacked against the plate [N].
    pub pretension_n: f64,
    /// Its plate; none without.
    pub plate: Option<Plate>,
    /// Longest segment of its bonded length [m]; an eighth of 1/λ without.
    pub segment_m: Option<f64>,
    /// Whether it is there: a bolt that a later stage installs, or an earlier one has released, does nothing.
    pub is_installed: bool,
    /// Blocks that are not there when it is installed, ascending: it passes through them unbonded.
    pub absent: Vec<BlockId>,
}

impl BoltSetup {
    /// λ = √(k_b/EA) [1/m].
    pub fn lambda(&self) -> f64 {
        (self.grout.stiffness_n_m2 / self.steel.axial_stiffness_n()).sqrt()
    }

    /// The pieces of the bolt in blocks, in order from its head.
    ///
    /// # Errors
    /// [`BoltError`] when it lies in none, or in two at once.
    pub fn portions(&self, blocks: &BlockSet) -> Result<Vec<Portion>, BoltError> {
        let found = self.line().portions(blocks, &self.absent).map_err(|(first, second)| {
            BoltError::BetweenBlocks {
                first: blocks.names[first.index()].clone(),
                second: blocks.names[second.index()].clone(),
            }
        })?;
        if found.is_empty() { Err(BoltError::Nowhere) } else { Ok(found) }
    }

    fn line(&self) -> Line {
        Line { from_m: self.from_m, to_m: self.to_m }
    }

    /// Longest segment [m].
    fn segment_m(&self) -> Result<f64, BoltError> {
        let gauge_m = if self.steel.break_strain.is_finite() { self.gauge_m() } else { f64::INFINITY };
        let most_m = (1.0 / (LEAST_SEGMENTS * self.lambda())).min(gauge_m);
        match self.segment_m {
            Some(asked_m) if asked_m > most_m * (1.0 + 4.0 * f64::EPSILON) => {
                Err(BoltError::Coarse { asked_m, most_m })
            }
            Some(asked_m) => Ok(asked_m),
            None => Ok((1.0 / (SEGMENTS * self.lambda())).min(gauge_m)),
        }
    }

    fn gauge_m(&self) -> f64 {
        GAUGE * self.steel.area_m2.sqrt()
    }

    fn refuse_pretension(&self, bonded_m: f64) -> Result<(), BoltError> {
        let pretension_n = self.pretension_n;
        if pretension_n == 0.0 {
            return Ok(());
        }
        let Some(plate) = &self.plate else { return Err(BoltError::NoPlate) };
        let parts = [
            ("steel", self.steel.yield_n),
            ("plate", plate.strength_n),
            ("grout", self.grout.strength_n_m * bonded_m),
        ];
        match parts.into_iter().find(|(_, most_n)| pretension_n > *most_n) {
            Some((part, most_n)) => Err(BoltError::Overstressed { pretension_n, part, most_n }),
            None => Ok(()),
        }
    }

    /// The bolt in its blocks, not yet tensioned.
    pub(crate) fn build(&self, blocks: &BlockSet) -> Result<Bolt, BoltError> {
        let portions = self.portions(blocks)?;
        let (first, last) = (portions[0], portions[portions.len() - 1]);
        let Grout { from_m, to_m, .. } = self.grout;
        let bonded: Vec<Portion> = portions
            .iter()
            .map(|p| Portion { from_m: p.from_m.max(from_m), to_m: p.to_m.min(to_m), ..*p })
            .filter(|p| p.to_m - p.from_m > CLOSED * self.line().length_m())
            .collect();
        if bonded.is_empty() {
            let (enters_m, ends_m) = (first.from_m, last.to_m);
            let to_m = to_m.min(self.line().length_m());
            return Err(BoltError::Unbonded { from_m, to_m, enters_m, ends_m });
        }
        self.refuse_pretension(bonded.iter().map(|p| p.to_m - p.from_m).sum())?;
        let segment_m = self.segment_m()?;
        let count = bonded.iter().map(|p| p.to_m - p.from_m).sum::<f64>() / segment_m;
        if count > MOST_SEGMENTS {
            return Err(BoltError::Fine { segment_m, count });
        }
        let mut maker = Maker::new(self, blocks);
        if self.plate.is_some() && bonded[0].from_m - first.from_m > maker.closed_m {
            maker.add_head(&first);
        }
        for (k, portion) in bonded.iter().enumerate() {
            let before = k.checked_sub(1).map(|k| bonded[k]);
            // Two pieces meet at a joint where both are bonded up to it, and no block is between them.
            let meets = before.filter(|before| portions.iter().all(|p| !is_between(p, before, portion)));
            maker.add_portion(portion, meets.is_some(), segment_m);
        }
        Ok(maker.finish(portions, bonded))
    }
}

/// Whether a piece of the bolt lies between two others.
fn is_between(piece: &Portion, before: &Portion, after: &Portion) -> bool {
    let middle_m = 0.5 * (piece.from_m + piece.to_m);
    middle_m > before.to_m && middle_m < after.from_m
        || piece.block == before.block && piece.to_m > before.to_m && piece.from_m < before.to_m
        || piece.block == after.block && piece.from_m < after.from_m && piece.to_m > after.from_m
}

/// A bolt under construction.
struct Maker<'a> {
    setup: &'a BoltSetup,
    blocks: &'a BlockSet,
    line: Line,
    closed_m: f64,
    /// Distance of each node of the bar from the head [m].
    nodes: Vec<f64>,
    holders: Vec<Holder>,
    /// Point of the rock of each holder.
    held_at: Vec<u32>,
    points: Vec<Anchor>,
    point_block: Vec<BlockId>,
    spans: Vec<Span>,
}

impl<'a> Maker<'a> {
    fn new(setup: &'a BoltSetup, blocks: &'a BlockSet) -> Self {
        let line = setup.line();
        Self {
            setup,
            blocks,
            line,
            closed_m: CLOSED * line.length_m(),
            nodes: Vec::new(),
            holders: Vec::new(),
            held_at: Vec::new(),
            points: Vec::new(),
            point_block: Vec::new(),
            spans: Vec::new(),
        }
    }

    fn add_point(&mut self, block: BlockId, along_m: f64) -> Vec3 {
        let anchor = self.line.anchor(self.blocks, block, along_m);
        self.points.push(anchor);
        self.point_block.push(block);
        anchor.place(&self.blocks.rest_position)
    }

    /// The head of a bolt that is not bonded there.
    fn add_head(&mut self, portion: &Portion) {
        self.nodes.push(portion.from_m);
        self.add_point(portion.block, portion.from_m);
    }

    fn add_portion(&mut self, portion: &Portion, meets: bool, longest_m: f64) {
        let length_m = portion.to_m - portion.from_m;
        let count = (length_m / longest_m * (1.0 - 1e-12)).ceil().max(1.0) as usize;
        let first_point = self.points.len();
        for i in 0..=count {
            let along_m = portion.from_m + length_m * i as f64 / count as f64;
            // Both sides of a joint have nodes of their own, so that steel may break between them.
            let joins =
                i == 0 && !meets && self.nodes.last().is_some_and(|last| along_m - last <= self.closed_m);
            if !joins {
                self.nodes.push(along_m);
            }
            let share = if i == 0 || i == count { 0.5 } else { 1.0 };
            let part_m = share * length_m / count as f64;
            let Grout { stiffness_n_m2, strength_n_m, .. } = self.setup.grout;
            let law = Law::symmetric(stiffness_n_m2 * part_m, strength_n_m * part_m);
            self.add_point(portion.block, along_m);
            self.holders.push(Holder { node: self.nodes.len() as u32 - 1, law });
            self.held_at.push(self.points.len() as u32 - 1);
            if i > 0 || !meets && first_point > 0 {
                self.add_straight();
            }
        }
        if meets {
            self.add_crossing(first_point);
        }
    }

    /// The span that ends at the last point.
    fn add_straight(&mut self) {
        let rest = &self.blocks.rest_position;
        let [a, b] = [2, 1].map(|back| self.points[self.points.len() - back].place(rest));
        self.spans.push(Span::Straight { rest_m: (b - a).norm() });
    }

    /// The span between the point before `first` and that point, once all of the portion after it is there.
    fn add_crossing(&mut self, first: usize) {
        let rest = &self.blocks.rest_position;
        let block = self.point_block[first - 1];
        let begin = (0..first).rev().take_while(|k| self.point_block[*k] == block).last();
        let begin = begin.unwrap_or(first - 1);
        let points = [begin, first - 1, first, self.points.len() - 1].map(|k| self.points[k]);
        let axis = (self.line.to_m - self.line.from_m).normalize();
        let nodes = self.points[first - 1].nodes;
        let edge = |[i, j]: [usize; 2]| rest[nodes[j] as usize] - rest[nodes[i] as usize];
        let across = |ends: &[usize; 2]| edge(*ends).cross(&axis).norm();
        let edges = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
        let best = edges.into_iter().max_by(|a, b| across(a).total_cmp(&across(b))).unwrap_or([0, 1]);
        let [m0, m1] = best.map(|corner| {
            let mut weights = [0.0; 4];
            weights[corner] = 1.0;
            Anchor { nodes, weights }
        });
        let [p0, p1, p2, p3] = points;
        let crossing = Crossing { points: [p0, p1, p2, p3, m0, m1] };
        let rest_m = crossing.frame(rest).along_m();
        // It comes before the spans within the portion.
        self.spans.insert(first - 1, Span::Crossing { crossing: Box::new(crossing), rest_m });
    }

    fn finish(mut self, portions: Vec<Portion>, bonded: Vec<Portion>) -> Bolt {
        let ea_n = self.setup.steel.axial_stiffness_n();
        let lengths_m: Vec<f64> = self.nodes.windows(2).map(|pair| pair[1] - pair[0]).collect();
        if let Some(plate) = &self.setup.plate {
            let stiffness_n_m = RIGID * ea_n / lengths_m[0];
            let law = Law { stiffness_n_m, least_n: 0.0, most_n: plate.strength_n, opens: true };
            self.holders.push(Holder { node: 0, law });
            self.held_at.push(0);
        }
        let longest_m = lengths_m.iter().copied().fold(0.0, f64::max);
        let closed_n_m = RIGID * ea_n / longest_m;
        let stiffness_n_m = |h: f64| if h > self.closed_m { ea_n / h } else { closed_n_m };
        let yield_n = self.setup.steel.yield_n;
        let steel = lengths_m.iter().map(|h| Law::symmetric(stiffness_n_m(*h), yield_n)).collect();
        let begins_bonded = self.holders.first().is_some_and(|one| one.node == 0) && self.held_at[0] == 0;
        let strain =
            if begins_bonded && self.setup.plate.is_some() { -self.setup.pretension_n / ea_n } else { 0.0 };
        let gauge_m = self.setup.gauge_m();
        Bolt {
            name: self.setup.name.clone(),
            is_installed: self.setup.is_installed,
            length_m: self.line.length_m(),
            rest_m: lengths_m.iter().map(|h| strain * h).collect(),
            steel,
            breaks: Break { strain: self.setup.steel.break_strain, ea_n },
            gauges_m: lengths_m.iter().map(|h| h.max(gauge_m)).collect(),
            nodes_m: self.nodes,
            holders: self.holders,
            held_at: self.held_at,
            points: self.points,
            point_block: self.point_block,
            spans: self.spans,
            dowel: self.setup.dowel,
            has_plate: self.setup.plate.is_some(),
            pretension_n: self.setup.pretension_n,
            portions,
            bonded,
        }
    }
}
