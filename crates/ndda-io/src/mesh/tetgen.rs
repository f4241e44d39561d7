//! TetGen's `.node`, `.ele` and `.face` files. Format: TetGen 1.6 manual, "File Formats".
//!
//! The region attribute of a tetrahedron is its body, `region_<attribute>`; the marker of a face is a node set,
//! `face_<marker>`, 0 for none. Node sets of ours are attributes 0 or 1 of nodes. A comment can name either, which
//! TetGen skips: `# region 2 = upper block`, `# marker 3 = base`, `# attribute 1 = base`.

mod write;

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use ndda_mesh::Vec3;

use crate::mesh::error::{Fault, bytes_of};
use crate::mesh::lines::{Line, Lines};
use crate::mesh::parts::Parts;
use crate::mesh::{FileProblem, MeshFile, MeshFileError};

pub(crate) use write::write;

/// Reads `.node` and `.ele` of the same name, and `.face` if it is there; `path` is any of the three.
///
/// # Errors
/// [`MeshFileError`] with file and line.
pub(crate) fn read(path: &Path) -> Result<MeshFile, MeshFileError> {
    let [node, ele, face] = ["node", "ele", "face"].map(|ending| path.with_extension(ending));
    let mut parts = Parts::default();
    let nodes = bytes_of(&node)?;
    let indices = read_nodes(&nodes, &mut parts).map_err(|fault| fault.of(&node))?;
    let elements = bytes_of(&ele)?;
    read_tets(&elements, &indices, &mut parts).map_err(|fault| fault.of(&ele))?;
    if face.exists() {
        let faces = bytes_of(&face)?;
        read_faces(&faces, &indices, &mut parts).map_err(|fault| fault.of(&face))?;
    }
    Ok(MeshFile { bodies: parts.split().map_err(|fault| fault.of(&ele))? })
}

/// Indices of nodes by their numbers in the file.
type Indices = HashMap<i64, u32>;

/// `count dimension attributes markers`, then `number x y z attributes… marker` per node.
fn read_nodes(bytes: &[u8], parts: &mut Parts) -> Result<Indices, Fault> {
    let names = names(bytes, "attribute");
    let mut lines = Lines::new(bytes, b'#');
    let mut header = lines.expect("the number of nodes")?;
    let count = fitting(&lines, "nodes", header.number("the number of nodes")?)?;
    let dimension: u32 = header.number("the dimension, 3")?;
    if dimension != 3 {
        return Err(Fault::unexpected(header.number, "the dimension 3", dimension.to_string().as_bytes()));
    }
    let attributes: usize = optional(&mut header)?;
    let mut indices = Indices::with_capacity(count);
    parts.nodes.reserve(count);
    for _ in 0..count {
        let mut line = lines.expect("a node")?;
        let number: i64 = line.number("the number of a node")?;
        let at: Vec3 = line.point()?;
        let index = u32::try_from(parts.nodes.len()).map_err(|_| FileProblem::TooManyNodes)?;
        if indices.insert(number, index).is_some() {
            return Err(Fault::at(
                line.number,
                FileProblem::Twice { what: "node", id: number.unsigned_abs() },
            ));
        }
        parts.nodes.push(at);
        if names.is_empty() {
            continue;
        }
        for attribute in 1..=attributes {
            let value = line.finite("an attribute")?;
            if let Some(name) = names.get(&(attribute as i64)).filter(|_| value == 1.0) {
                parts.sets.entry(name.clone()).or_default().push([index; 4]);
            }
        }
    }
    Ok(indices)
}

/// `count nodes-per-tetrahedron attributes`, then `number a b c d attribute` per tetrahedron.
fn read_tets(bytes: &[u8], indices: &Indices, parts: &mut Parts) -> Result<(), Fault> {
    let names = names(bytes, "region");
    let mut lines = Lines::new(bytes, b'#');
    let mut header = lines.expect("the number of tetrahedra")?;
    let count = fitting(&lines, "tetrahedra", header.number("the number of tetrahedra")?)?;
    let corners: u32 = header.number("the number of nodes per tetrahedron")?;
    if corners != 4 {
        let what = format!("a tetrahedron of {corners} nodes");
        return Err(Fault::at(header.number, FileProblem::NotRead { what, cure: "run TetGen without -o2" }));
    }
    let has_region = optional(&mut header)? > 0;
    let mut bodies: BTreeMap<i64, u32> = BTreeMap::new();
    let mut regions = Vec::new();
    parts.tets.reserve(count);
    for _ in 0..count {
        let mut line = lines.expect("a tetrahedron")?;
        line.number::<i64>("the number of a tetrahedron")?;
        let mut tet = [0; 4];
        for corner in &mut tet {
            *corner = node(&mut line, indices, "a tetrahedron")?;
        }
        parts.tets.push(tet);
        if has_region {
            // Written with a point by some programs.
            let region = line.finite("a region")?;
            if region.fract() != 0.0 || region.abs() > 1e15 {
                return Err(Fault::unexpected(
                    line.number,
                    "a whole region number",
                    region.to_string().as_bytes(),
                ));
            }
            bodies.insert(region as i64, 0);
            regions.push(region as i64);
        }
    }
    for (index, body) in (0..).zip(bodies.values_mut()) {
        *body = index;
    }
    let name = |region: &i64| names.get(region).cloned().unwrap_or_else(|| format!("region_{region}"));
    parts.names = bodies.keys().map(name).collect();
    parts.body = regions.iter().map(|region| bodies[region]).collect();
    Ok(())
}

/// `count markers`, then `number a b c marker` per face.
fn read_faces(bytes: &[u8], indices: &Indices, parts: &mut Parts) -> Result<(), Fault> {
    let names = names(bytes, "marker");
    let mut lines = Lines::new(bytes, b'#');
    let mut header = lines.expect("the number of faces")?;
    let count = fitting(&lines, "faces", header.number("the number of faces")?)?;
    if optional(&mut header)? == 0 {
        return Ok(());
    }
    for _ in 0..count {
        let mut line = lines.expect("a face")?;
        line.number::<i64>("the number of a face")?;
        let mut next = || node(&mut line, indices, "a face");
        let (a, b, c) = (next()?, next()?, next()?);
        let marker: i64 = line.number("the marker of a face")?;
        if marker != 0 {
            let name = names.get(&marker).cloned().unwrap_or_else(|| format!("face_{marker}"));
            parts.sets.entry(name).or_default().push([a, b, c, a]);
        }
    }
    Ok(())
}

/// A number of a header that may be missing, which is 0.
fn optional(header: &mut crate::mesh::lines::Line) -> Result<usize, Fault> {
    if header.text.is_empty() { Ok(0) } else { header.number("a count") }
}

fn node(line: &mut Line, indices: &Indices, what: &str) -> Result<u32, Fault> {
    let node: i64 = line.number("the number of a node")?;
    let missing = || Fault::at(line.number, FileProblem::NoSuchNode { what: what.to_string(), node });
    indices.get(&node).copied().ok_or_else(missing)
}

/// A count that the rest of the text can hold: an item takes four bytes at least.
fn fitting(lines: &Lines, what: &'static str, count: u64) -> Result<usize, Fault> {
    match usize::try_from(count) {
        Ok(fits) if fits <= lines.bytes_left() / 4 => Ok(fits),
        _ => Err(FileProblem::TooShort { what, count }.into()),
    }
}

/// Names in comments of the form `# kind number = name`.
fn names(bytes: &[u8], kind: &str) -> HashMap<i64, String> {
    let mut names = HashMap::new();
    let mut lines = Lines::new(bytes, b'\n');
    while let Some(line) = lines.raw() {
        // They stand at the top.
        if !line.text.starts_with(b"#") && !line.text.is_empty() {
            break;
        }
        let named = std::str::from_utf8(line.text).ok().and_then(|text| {
            let (number, name) = text.strip_prefix("# ")?.strip_prefix(kind)?.split_once(" = ")?;
            Some((number.trim().parse().ok()?, name.to_string()))
        });
        names.extend(named);
    }
    names
}
