//! Nodes that move alike: the sides of level ground.

use ndda_mesh::Vec3;

use super::{HeldNode, SupportError, add_direction};

/// Merges groups of nodes that share one, and leaves out nodes that are alone: each group ascending, ordered by its first.
pub(super) fn merged(nodes: usize, groups: &[Vec<u32>]) -> Vec<Vec<u32>> {
    if groups.is_empty() {
        return Vec::new();
    }
    let mut first: Vec<u32> = (0..nodes as u32).collect();
    let root = |first: &[u32], mut node: u32| {
        while first[node as usize] != node {
            node = first[node as usize];
        }
        node
    };
    for group in groups {
        for pair in group.windows(2) {
            let (a, b) = (root(&first, pair[0]), root(&first, pair[1]));
            first[a.max(b) as usize] = a.min(b);
        }
    }
    let mut members: Vec<Vec<u32>> = vec![Vec::new(); nodes];
    (0..nodes as u32).for_each(|node| members[root(&first, node) as usize].push(node));
    members.retain(|group| group.len() > 1);
    members
}

/// Gives all nodes of a group the directions in which any of them is held.
///
/// # Errors
/// [`SupportError::TiedAndMoved`] where one of them is moved.
pub(super) fn hold_alike(groups: &[Vec<u32>], held: &mut [Option<HeldNode>]) -> Result<(), SupportError> {
    for group in groups {
        let mut all: Vec<Vec3> = Vec::new();
        for &node in group {
            let Some(entry) = &held[node as usize] else { continue };
            if entry.motion.is_some() {
                return Err(SupportError::TiedAndMoved { node });
            }
            entry.held.iter().for_each(|n| add_direction(&mut all, n));
        }
        if !all.is_empty() {
            for &node in group {
                let (held_along, free) = (all.clone(), Vec::new());
                held[node as usize] = Some(HeldNode { node, held: held_along, free, motion: None });
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_that_share_a_node_are_one() {
        let groups = [vec![4, 1], vec![2, 3], vec![1, 0], vec![5]];
        assert_eq!(merged(6, &groups), [vec![0, 1, 4], vec![2, 3]]);
    }
}
