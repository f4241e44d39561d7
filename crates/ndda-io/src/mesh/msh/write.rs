//! Writes format 4.1, ASCII.

use std::fmt::Write;
use std::path::Path;

use ndda_mesh::BlockMesh;
use ndda_mesh::geometry::Aabb;

use crate::atomic;
use crate::mesh::join::Joined;
use crate::write_error::WriteError;

/// Writes a mesh in format 4.1, ASCII, numbered from 1.
///
/// Each body is a volume in a physical volume of its name; each node set is a physical group of points.
///
/// # Errors
/// [`WriteError`] for a number that is not finite, a name that cannot be kept, and what the operating system refuses.
pub(crate) fn write(path: &Path, bodies: &[(String, BlockMesh)]) -> Result<(), WriteError> {
    let joined = Joined::new(path, bodies)?;
    let mut text = String::from("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    let written = groups(&mut text, &joined)
        .and_then(|()| nodes(&mut text, &joined))
        .and_then(|()| elements(&mut text, &joined));
    written.expect("a String takes all that is written to it");
    atomic::write_named(path, text.as_bytes())
}

/// Names of the groups, and an entity for each.
fn groups(text: &mut String, joined: &Joined) -> std::fmt::Result {
    writeln!(text, "$PhysicalNames\n{}", joined.sets.len() + joined.names.len())?;
    for (tag, name) in (1..).zip(joined.sets.keys()) {
        writeln!(text, "0 {tag} \"{name}\"")?;
    }
    for (tag, name) in (1..).zip(&joined.names) {
        writeln!(text, "3 {tag} \"{name}\"")?;
    }
    writeln!(text, "$EndPhysicalNames\n$Entities\n{} 0 0 {}", joined.sets.len(), joined.names.len())?;
    for (tag, nodes) in (1..).zip(joined.sets.values()) {
        let x = nodes.first().map_or_else(ndda_mesh::Vec3::zeros, |&node| joined.nodes[node as usize]);
        writeln!(text, "{tag} {:?} {:?} {:?} 1 {tag}", x.x, x.y, x.z)?;
    }
    for (tag, range) in (1..).zip(joined.first_node.windows(2)) {
        let Aabb { min, max } = Aabb::around(&joined.nodes[range[0] as usize..range[1] as usize]);
        write!(text, "{tag} {:?} {:?} {:?} {:?} {:?} {:?} ", min.x, min.y, min.z, max.x, max.y, max.z)?;
        writeln!(text, "1 {tag} 0")?;
    }
    writeln!(text, "$EndEntities")
}

fn nodes(text: &mut String, joined: &Joined) -> std::fmt::Result {
    let count = joined.nodes.len();
    writeln!(text, "$Nodes\n{} {count} 1 {count}", joined.names.len())?;
    for (tag, range) in (1..).zip(joined.first_node.windows(2)) {
        writeln!(text, "3 {tag} 0 {}", range[1] - range[0])?;
        for node in range[0]..range[1] {
            writeln!(text, "{}", u64::from(node) + 1)?;
        }
        for x in &joined.nodes[range[0] as usize..range[1] as usize] {
            writeln!(text, "{:?} {:?} {:?}", x.x, x.y, x.z)?;
        }
    }
    writeln!(text, "$EndNodes")
}

fn elements(text: &mut String, joined: &Joined) -> std::fmt::Result {
    let count = joined.tets.len() + joined.sets.values().map(Vec::len).sum::<usize>();
    writeln!(text, "$Elements\n{} {count} 1 {count}", joined.sets.len() + joined.names.len())?;
    let mut element = 0u64;
    for (tag, nodes) in (1..).zip(joined.sets.values()) {
        writeln!(text, "0 {tag} 15 {}", nodes.len())?;
        for &node in nodes {
            element += 1;
            writeln!(text, "{element} {}", u64::from(node) + 1)?;
        }
    }
    for (tag, range) in (1..).zip(joined.first_tet.windows(2)) {
        writeln!(text, "3 {tag} 4 {}", range[1] - range[0])?;
        for tet in &joined.tets[range[0]..range[1]] {
            element += 1;
            let [a, b, c, d] = tet.map(|node| u64::from(node) + 1);
            writeln!(text, "{element} {a} {b} {c} {d}")?;
        }
    }
    writeln!(text, "$EndElements")
}
