//! Blocks by name, and parts of them.

use std::collections::HashSet;

use ndda_io::scene::suggest::nearest;
use ndda_io::scene::{self, Region};
use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, BlockSet};

use super::{ON_PLANE, vec3};

/// Blocks by a name, or by a pattern with `*`.
pub(super) fn find_all(blocks: &BlockSet, pattern: &str) -> Result<Vec<BlockId>, String> {
    let found: Vec<BlockId> =
        blocks.ids().filter(|b| scene::matches(pattern, &blocks.names[b.index()])).collect();
    if found.is_empty() { Err(format!("there is no block `{pattern}`")) } else { Ok(found) }
}

/// Parts of all blocks that a name or pattern stands for; those of a pattern that have no such part are left out.
pub(super) fn in_region<T>(
    blocks: &BlockSet,
    pattern: &str,
    part: impl Fn(BlockId) -> Result<T, String>,
) -> Result<Vec<(BlockId, T)>, String> {
    let found = find_all(blocks, pattern)?;
    if !pattern.contains('*') {
        return found.into_iter().map(|block| Ok((block, part(block)?))).collect();
    }
    let parts: Vec<_> = found.into_iter().filter_map(|block| Some((block, part(block).ok()?))).collect();
    if parts.is_empty() { Err(format!("no block `{pattern}` has a part in this region")) } else { Ok(parts) }
}

/// One block by its name.
pub(super) fn find(blocks: &BlockSet, name: &str) -> Result<BlockId, String> {
    blocks.find(name).ok_or_else(|| format!("there is no block `{name}`"))
}

/// Nodes of a region, counted from the block's first, ascending.
pub(super) fn region_nodes(blocks: &BlockSet, block: BlockId, region: &Region) -> Result<Vec<u32>, String> {
    let range = blocks.nodes_of(block);
    let name = &blocks.names[block.index()];
    let nodes: Vec<u32> = match region {
        Region::All => (0..range.len() as u32).collect(),
        Region::Set(set) => {
            let sets = || blocks.node_sets_of(block);
            let (_, found) = sets().find(|(known, _)| known == set).ok_or_else(|| {
                let known: Vec<&str> = sets().map(|(known, _)| known).collect();
                match nearest(set, &known) {
                    Some(meant) => format!("block `{name}` has no set `{set}`: did you mean `{meant}`?"),
                    None => format!("block `{name}` has no set `{set}`; it has {}", known.join(", ")),
                }
            })?;
            found.iter().map(|n| n.0 - range.start as u32).collect()
        }
        Region::Plane { point_m, normal } => {
            let size = Aabb::around(&blocks.rest_position[range.clone()]).diagonal();
            let (point, normal) = (vec3(*point_m) - blocks.origin_m, vec3(*normal).normalize());
            let near = |n: &u32| {
                let x = blocks.rest_position[range.start + *n as usize];
                (x - point).dot(&normal).abs() <= ON_PLANE * size
            };
            boundary_nodes(blocks, block).into_iter().filter(near).collect()
        }
    };
    if nodes.is_empty() {
        return Err(format!("no node of block `{name}` is in this region: check its place"));
    }
    Ok(nodes)
}

fn boundary_nodes(blocks: &BlockSet, block: BlockId) -> Vec<u32> {
    let first = blocks.nodes_of(block).start as u32;
    let triangles = &blocks.triangles[blocks.triangles_of(block)];
    let mut nodes: Vec<u32> = triangles.iter().flatten().map(|n| n.0 - first).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// Boundary triangles of a block with their numbers, counter-clockwise seen from outside, by nodes counted from the block's first.
pub(super) fn boundary(blocks: &BlockSet, block: BlockId) -> impl Iterator<Item = (usize, [u32; 3])> {
    let first = blocks.nodes_of(block).start as u32;
    blocks.triangles_of(block).map(move |t| (t, blocks.triangles[t].map(|n| n.0 - first)))
}

/// As [`loaded_triangles`], counter-clockwise seen from outside.
pub(super) fn outward_triangles(
    blocks: &BlockSet,
    block: BlockId,
    on: &Region,
) -> Result<Vec<[u32; 3]>, String> {
    let sorted = |mut nodes: [u32; 3]| {
        nodes.sort_unstable();
        nodes
    };
    let loaded: HashSet<[u32; 3]> = loaded_triangles(blocks, block, on)?.into_iter().map(sorted).collect();
    let outward = boundary(blocks, block).map(|(_, nodes)| nodes);
    Ok(outward.filter(|nodes| loaded.contains(&sorted(*nodes))).collect())
}

/// Boundary triangles of a block in a region: those of the named surface, or else those whose corners are all in it.
pub(super) fn loaded_triangles(
    blocks: &BlockSet,
    block: BlockId,
    on: &Region,
) -> Result<Vec<[u32; 3]>, String> {
    if let Region::Set(set) = on
        && let Some(triangles) = blocks.surfaces_of(block).remove(set)
    {
        return Ok(triangles);
    }
    let nodes = region_nodes(blocks, block, on)?;
    let first = blocks.nodes_of(block).start as u32;
    let local = blocks.triangles[blocks.triangles_of(block)].iter().map(|t| t.map(|n| n.0 - first));
    let inside = |t: &[u32; 3]| t.iter().all(|n| nodes.binary_search(n).is_ok());
    let triangles: Vec<[u32; 3]> = local.filter(inside).collect();
    if triangles.is_empty() {
        return Err(format!(
            "no boundary triangle of block `{}` lies in this region",
            blocks.names[block.index()]
        ));
    }
    Ok(triangles)
}

#[cfg(test)]
mod tests {
    use crate::Model;

    #[test]
    fn a_set_that_is_misspelt_is_told_with_the_one_that_was_meant() {
        let told = |set: &str| {
            let text = format!(
                "(title: \"held\", time: (step_s: 1e-4, end_s: 1e-3),
                materials: [(name: \"rock\", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
                blocks: [(name: \"a\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
                supports: [(block: \"a\", on: Set(\"{set}\"), hold: Fixed)])"
            );
            Model::from_text(&text).err().expect("there is no such set").to_string()
        };
        let near = told("zmin");
        assert!(near.contains("has no set `zmin`") && near.contains("did you mean `z_min`?"), "{near}");
        assert!(!near.contains("ndda mesh"), "{near}");
        assert!(told("lid").contains("it has x_max, x_min"), "{}", told("lid"));
    }
}
