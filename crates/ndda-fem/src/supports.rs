//! Where a block is held or moved, and what of its motion is left.

mod ties;

use nalgebra::{Matrix6, SymmetricEigen, Vector6};
use ndda_mesh::{Mat3, Vec3};

use crate::block_operator::BlockOperator;
use crate::frame::Frame;
use crate::motion::Motion;
use crate::quiet::Quiet;

/// Two directions closer than this (sine of the angle) are the same; far above round-off, far below any joint.
const SAME_DIRECTION: f64 = 1e-6;

/// The constraint that a support puts on its nodes.
#[derive(Clone, Debug, PartialEq)]
pub enum Hold {
    /// No motion.
    Fixed,
    /// No motion along a direction (a roller).
    Along(Vec3),
    /// A prescribed displacement.
    Motion(Motion),
}

/// One support of a block as requested.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeSupport {
    /// Nodes of the block, counted from its first.
    pub nodes: Vec<u32>,
    /// The constraint.
    pub hold: Hold,
    /// Stiffness per node of the springs that impose it [N/m]; `None` eliminates the unknowns.
    pub spring_n_m: Option<f64>,
}

/// Why supports are refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SupportError {
    /// Rollers that would have to turn with the block.
    #[error(
        "the supports leave the block {freedom} independent rotation(s), which would turn the held directions: hold it at \
         more nodes, or fix the nodes fully"
    )]
    TurnsHeldDirections {
        /// How many independent rotations the supports leave.
        freedom: usize,
    },
    /// A node moves like others, and as prescribed.
    #[error(
        "node {node} is tied to others and also moved by a support: take it out of the tie or out of the support"
    )]
    TiedAndMoved {
        /// The node, counted from the block's first.
        node: u32,
    },
    /// Two supports want different things of one node.
    #[error(
        "node {node} is moved by one support, and held or moved differently by another: take it out of one of the two supports"
    )]
    Conflict {
        /// The node, counted from the block's first.
        node: u32,
    },
}

/// A node whose motion is partly or fully given.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldNode {
    /// The node, counted from the block's first.
    pub node: u32,
    /// Orthonormal directions that are held.
    pub held: Vec<Vec3>,
    /// Orthonormal directions that stay free.
    pub free: Vec<Vec3>,
    /// Index into [`BlockSupports::motions`] when the held displacement is prescribed.
    pub motion: Option<usize>,
}

/// A spring that pulls a node back to its rest place or along a prescribed motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    /// The node, counted from the block's first.
    pub node: u32,
    /// Direction; `None` acts in all three.
    pub along: Option<Vec3>,
    /// Stiffness [N/m].
    pub stiffness_n_m: f64,
    /// Index into [`BlockSupports::motions`].
    pub motion: Option<usize>,
}

/// All supports of one block.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockSupports {
    /// Nodes with eliminated unknowns, ascending.
    pub held: Vec<HeldNode>,
    /// Springs, in the order requested.
    pub springs: Vec<Spring>,
    /// Prescribed motions.
    pub motions: Vec<Motion>,
    /// How the block's frame may turn under these supports.
    pub frame: Frame,
    /// Groups of nodes that move alike, each ascending.
    pub ties: Vec<Vec<u32>>,
    /// Quiet faces, which resist velocities and hold nothing.
    pub quiet: Quiet,
}

/// Rigid motions with less than this part of the stiffness of the best held one are free.
const RIGID: f64 = 1e-9;

impl BlockSupports {
    /// Whether no rigid motion is left: Σ c cᵀ over the held components c = (n, x × n) has full rank.
    pub fn hold_all_rigid_motions(&self, operator: &BlockOperator) -> bool {
        let size = operator.rest.iter().map(|x| x.norm()).fold(0.0, f64::max);
        let mut held = nalgebra::Matrix6::<f64>::zeros();
        let mut add = |node: u32, n: &Vec3| {
            let turn = operator.rest[node as usize].cross(n) / size;
            let c = nalgebra::Vector6::new(n.x, n.y, n.z, turn.x, turn.y, turn.z);
            held += c * c.transpose();
        };
        for node in &self.held {
            node.held.iter().for_each(|n| add(node.node, n));
        }
        for spring in &self.springs {
            match &spring.along {
                Some(n) => add(spring.node, n),
                None => [Vec3::x(), Vec3::y(), Vec3::z()].iter().for_each(|n| add(spring.node, n)),
            }
        }
        let stiffness = held.symmetric_eigenvalues();
        stiffness.min() > RIGID * stiffness.max()
    }

    /// Merges the supports and the tied nodes of one block, and finds how its frame may turn.
    ///
    /// # Errors
    /// [`SupportError::Conflict`] and [`SupportError::TiedAndMoved`] for contradictory prescriptions, [`SupportError::TurnsHeldDirections`] when a
    /// roller direction would not stay constant in the block's frame.
    pub fn new(
        operator: &BlockOperator,
        supports: &[NodeSupport],
        tied: &[Vec<u32>],
    ) -> Result<Self, SupportError> {
        let mut merged = Self {
            held: Vec::new(),
            springs: Vec::new(),
            motions: Vec::new(),
            frame: Frame::Held,
            ties: ties::merged(operator.nodes(), tied),
            quiet: Quiet::default(),
        };
        let mut held: Vec<Option<HeldNode>> = vec![None; operator.nodes()];
        for support in supports {
            let motion = match &support.hold {
                Hold::Motion(motion) => {
                    merged.motions.push(motion.clone());
                    Some(merged.motions.len() - 1)
                }
                _ => None,
            };
            for &node in &support.nodes {
                match support.spring_n_m {
                    Some(stiffness_n_m) => {
                        let along = direction(&support.hold);
                        merged.springs.push(Spring { node, along, stiffness_n_m, motion });
                    }
                    None => merged.hold_node(&mut held[node as usize], node, &support.hold, motion)?,
                }
            }
        }
        ties::hold_alike(&merged.ties, &mut held)?;
        merged.held = held.into_iter().flatten().collect();
        for node in &mut merged.held {
            node.free = complement(&node.held);
        }
        merged.frame = merged.choose_frame(operator)?;
        Ok(merged)
    }

    fn hold_node(
        &self,
        slot: &mut Option<HeldNode>,
        node: u32,
        hold: &Hold,
        motion: Option<usize>,
    ) -> Result<(), SupportError> {
        let entry = slot.get_or_insert(HeldNode { node, held: Vec::new(), free: Vec::new(), motion: None });
        let moves =
            |index: Option<usize>, along: Option<&Vec3>| index.is_some_and(|i| self.motions[i].moves(along));
        let along = direction(hold);
        if !entry.held.is_empty() {
            let same = entry.motion.map(|i| &self.motions[i]) == motion.map(|i| &self.motions[i]);
            let old_moves_against = moves(entry.motion, along.as_ref());
            let new_moves_against = motion.is_some() && moves(motion, None);
            if !same && (old_moves_against || new_moves_against) {
                return Err(SupportError::Conflict { node });
            }
        }
        entry.motion = entry.motion.or(motion);
        match along {
            Some(n) => add_direction(&mut entry.held, &n),
            None => entry.held = vec![Vec3::x(), Vec3::y(), Vec3::z()],
        }
        Ok(())
    }

    /// The frame is free where only whole nodes are held, unless they cannot move against each other and leave no rotation; it is held where rollers or springs along a
    /// direction leave none, and turns about one axis where that axis leaves all held directions alone.
    fn choose_frame(&self, operator: &BlockOperator) -> Result<Frame, SupportError> {
        // Nodes apart from each other that move alike keep the block from turning, but about a line of them.
        if !self.ties.is_empty() {
            return Ok(Frame::Held);
        }
        let holds = self.all_holds();
        if holds.iter().all(|(_, held)| held.len() == 3) {
            return Ok(if self.keeps_from_turning(operator) { Frame::Held } else { Frame::free(operator) });
        }
        let rotations = free_rotations(operator, &holds);
        match rotations.as_slice() {
            [] => Ok(Frame::Held),
            [axis] if holds.iter().all(|(_, held)| invariant_about(axis, held)) => {
                Ok(Frame::About { axis: *axis })
            }
            _ => Err(SupportError::TurnsHeldDirections { freedom: rotations.len() }),
        }
    }

    /// Whether whole nodes are held, all in one place or by one motion, that leave no rotation: they do not lie on one line. Springs give way, and motions that
    /// differ may turn the block.
    fn keeps_from_turning(&self, operator: &BlockOperator) -> bool {
        let Some(first) = self.held.first() else { return false };
        let motion_of = |node: &HeldNode| node.motion.map(|i| &self.motions[i]);
        let moves_alike =
            |node: &HeldNode| node.motion == first.motion || motion_of(node) == motion_of(first);
        let place = |node: &HeldNode| operator.rest[node.node as usize];
        let arms = || self.held.iter().map(|node| place(node) - place(first));
        let longer = |a: Vec3, b: Vec3| if b.norm_squared() > a.norm_squared() { b } else { a };
        let Some(line) = arms().fold(Vec3::zeros(), longer).try_normalize(0.0) else { return false };
        let off_line_m = arms().map(|arm| arm.cross(&line).norm()).fold(0.0, f64::max);
        let size_m = operator.rest.iter().map(|x| x.norm()).fold(0.0, f64::max);
        self.held.iter().all(moves_alike) && off_line_m > SAME_DIRECTION * size_m
    }

    /// Held directions per support, eliminated and sprung alike.
    fn all_holds(&self) -> Vec<(u32, Vec<Vec3>)> {
        let all = || vec![Vec3::x(), Vec3::y(), Vec3::z()];
        let eliminated = self.held.iter().map(|h| (h.node, h.held.clone()));
        let sprung = self.springs.iter().map(|s| (s.node, s.along.map_or_else(all, |n| vec![n])));
        eliminated.chain(sprung).collect()
    }
}

fn direction(hold: &Hold) -> Option<Vec3> {
    match hold {
        Hold::Along(n) => Some(n.normalize()),
        Hold::Fixed | Hold::Motion(_) => None,
    }
}

/// Adds the part of `n` that is new, by Gram–Schmidt.
fn add_direction(held: &mut Vec<Vec3>, n: &Vec3) {
    let new = held.iter().fold(*n, |rest, h| rest - h * h.dot(&rest));
    if new.norm() > SAME_DIRECTION {
        held.push(new.normalize());
    }
}

/// Orthonormal directions that complete `held` to a basis of space.
fn complement(held: &[Vec3]) -> Vec<Vec3> {
    let mut basis = held.to_vec();
    while basis.len() < 3 {
        let rest = |e: &Vec3| basis.iter().fold(*e, |rest, h| rest - h * h.dot(&rest));
        let candidates = [Vec3::x(), Vec3::y(), Vec3::z()].map(|e| rest(&e));
        let longest = candidates.iter().fold(candidates[0], |a, b| if b.norm() > a.norm() { *b } else { a });
        basis.push(longest.normalize());
    }
    basis.split_off(held.len())
}

/// Axes of the rotations (with any translation) that move no node along its held directions.
fn free_rotations(operator: &BlockOperator, holds: &[(u32, Vec<Vec3>)]) -> Vec<Vec3> {
    let size = operator.rest.iter().map(|x| x.norm()).fold(0.0, f64::max);
    let mut normal_matrix = Matrix6::zeros();
    for (node, held) in holds {
        let arm = operator.rest[*node as usize] / size;
        for n in held {
            let turn = arm.cross(n);
            let row = Vector6::new(n.x, n.y, n.z, turn.x, turn.y, turn.z);
            normal_matrix += row * row.transpose();
        }
    }
    let eigen = SymmetricEigen::new(normal_matrix);
    let negligible = SAME_DIRECTION * SAME_DIRECTION;
    let largest = eigen.eigenvalues.amax();
    // Null vectors mix translations and rotations: take the directions that their rotations span.
    let mut spanned = Mat3::zeros();
    for (i, &value) in eigen.eigenvalues.iter().enumerate() {
        if value <= negligible * largest {
            let axis = eigen.eigenvectors.fixed_view::<3, 1>(3, i);
            spanned += axis * axis.transpose();
        }
    }
    let turns = SymmetricEigen::new(spanned);
    let kept = (0..3).filter(|&i| turns.eigenvalues[i] > negligible);
    kept.map(|i| turns.eigenvectors.column(i).into_owned()).collect()
}

/// Whether turning about `axis` maps the span of `held` onto itself.
fn invariant_about(axis: &Vec3, held: &[Vec3]) -> bool {
    let along = |n: &Vec3| n.cross(axis).norm() <= SAME_DIRECTION;
    let across = |n: &Vec3| n.dot(axis).abs() <= SAME_DIRECTION;
    match held {
        [n] => along(n),
        [a, b] => across(a) && across(b),
        _ => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear_elastic::LinearElastic;

    fn corner() -> BlockOperator {
        let nodes = [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()];
        BlockOperator::new(&nodes, vec![[0, 1, 2, 3]], &LinearElastic::new(1e9, 0.2, 6e3).unwrap())
    }

    fn along(nodes: &[u32], n: Vec3) -> NodeSupport {
        NodeSupport { nodes: nodes.to_vec(), hold: Hold::Along(n), spring_n_m: None }
    }

    #[test]
    fn a_block_without_supports_turns_freely() {
        let supports = BlockSupports::new(&corner(), &[], &[]).unwrap();
        assert!(matches!(supports.frame, Frame::Free { .. }));
    }

    #[test]
    fn a_block_on_one_roller_plane_turns_about_its_normal() {
        let supports = BlockSupports::new(&corner(), &[along(&[0, 1, 2], Vec3::z())], &[]).unwrap();
        let Frame::About { axis } = supports.frame else { panic!("{:?}", supports.frame) };
        assert!(axis.cross(&Vec3::z()).norm() < 1e-12);
    }

    #[test]
    fn three_roller_planes_hold_the_frame_and_merge_at_the_corner() {
        let planes =
            [along(&[0, 1, 2], Vec3::z()), along(&[0, 1, 3], Vec3::y()), along(&[0, 2, 3], -Vec3::x())];
        let supports = BlockSupports::new(&corner(), &planes, &[]).unwrap();
        assert_eq!(supports.frame, Frame::Held);
        assert_eq!(supports.held[0].held.len(), 3);
        assert_eq!(supports.held[1].free, vec![Vec3::x()]);
    }

    #[test]
    fn a_fixed_corner_leaves_a_pendulum_and_a_single_roller_is_refused() {
        let fixed = NodeSupport { nodes: vec![0], hold: Hold::Fixed, spring_n_m: None };
        let supports = BlockSupports::new(&corner(), &[fixed], &[]).unwrap();
        assert!(matches!(supports.frame, Frame::Free { .. }));
        let refused = BlockSupports::new(&corner(), &[along(&[0], Vec3::z())], &[]);
        assert!(matches!(refused, Err(SupportError::TurnsHeldDirections { .. })));
    }

    #[test]
    fn whole_nodes_keep_a_block_from_turning_only_if_they_are_held_and_move_alike() {
        let frame = |supports: &[NodeSupport]| BlockSupports::new(&corner(), supports, &[]).unwrap().frame;
        let fixed = NodeSupport { nodes: vec![0, 1, 2], hold: Hold::Fixed, spring_n_m: None };
        let sprung = NodeSupport { spring_n_m: Some(1e5), ..fixed.clone() };
        assert_eq!(frame(std::slice::from_ref(&fixed)), Frame::Held);
        assert!(matches!(frame(std::slice::from_ref(&sprung)), Frame::Free { .. }));
        assert_eq!(frame(&[fixed, sprung]), Frame::Held);
        let moved = |nodes: &[u32], z: f64| NodeSupport {
            nodes: nodes.to_vec(),
            hold: Hold::Motion(Motion::Rows(vec![(0.0, Vec3::zeros()), (1.0, Vec3::z() * z)])),
            spring_n_m: None,
        };
        assert_eq!(frame(&[moved(&[0, 1], 1.0), moved(&[2], 1.0)]), Frame::Held);
        assert!(matches!(frame(&[moved(&[0, 1], 1.0), moved(&[2], 2.0)]), Frame::Free { .. }));
    }

    #[test]
    fn a_motion_against_a_roller_is_a_conflict() {
        let motion = Motion::Rows(vec![(0.0, Vec3::zeros()), (1.0, Vec3::z())]);
        let moved = NodeSupport { nodes: vec![0, 1, 2], hold: Hold::Motion(motion), spring_n_m: None };
        let clash = BlockSupports::new(&corner(), &[moved.clone(), along(&[0], Vec3::z())], &[]);
        assert_eq!(clash, Err(SupportError::Conflict { node: 0 }));
        assert!(BlockSupports::new(&corner(), &[moved, along(&[0], Vec3::x())], &[]).is_ok());
    }
}
