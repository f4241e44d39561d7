//! STL, ASCII and binary.

use ndda_mesh::Vec3;
use ndda_mesh::cut::DomainFace;

use super::{ONLY_NAME, Surface};
use crate::mesh::FileProblem;
use crate::mesh::error::Fault;
use crate::mesh::lines::Lines;

/// Bytes before the triangles of a binary file, and of each triangle.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// Triangles with three vertices of their own each. A file whose length fits its binary count is binary, whatever it
/// begins with.
pub(super) fn read(bytes: &[u8]) -> Result<Surface, Fault> {
    let count = bytes.get(80..HEADER).and_then(|count| count.first_chunk());
    let count = count.map(|count| u64::from(u32::from_le_bytes(*count)));
    let is_whole = |count: u64| HEADER as u64 + count * TRIANGLE as u64 == bytes.len() as u64;
    match count {
        Some(count) if is_whole(count) => binary(&bytes[HEADER..]),
        _ if bytes.trim_ascii_start().starts_with(b"solid") => text(bytes),
        Some(count) => Err(FileProblem::TooShort { what: "triangles", count }.into()),
        None => Err(Fault::unexpected(1, "`solid` or a binary STL", &bytes[..bytes.len().min(40)])),
    }
}

/// Normal, three vertices and an attribute, lowest byte first.
fn binary(bytes: &[u8]) -> Result<Surface, Fault> {
    let mut surface = Surface::default();
    for triangle in bytes.chunks_exact(TRIANGLE) {
        let numbers: Vec<f64> = triangle[12..48]
            .chunks_exact(4)
            .map(|b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])))
            .collect();
        if let Some(bad) = numbers.iter().find(|x| !x.is_finite()) {
            let (expected, found) = ("finite coordinates".into(), bad.to_string());
            return Err(FileProblem::Unexpected { expected, found }.into());
        }
        let corners = numbers.chunks_exact(3).map(Vec3::from_column_slice);
        add(&mut surface, ONLY_NAME, corners);
    }
    Ok(surface)
}

fn add(surface: &mut Surface, name: &str, corners: impl Iterator<Item = Vec3>) {
    let first = surface.vertices.len() as u32;
    surface.vertices.extend(corners);
    let vertices = (first..surface.vertices.len() as u32).collect();
    surface.faces.push(DomainFace { name: name.to_string(), vertices });
}

/// `solid name`, then `vertex x y z` three times between `outer loop` and `endloop`.
fn text(bytes: &[u8]) -> Result<Surface, Fault> {
    let mut surface = Surface::default();
    let (mut name, mut corners, mut is_open) = (ONLY_NAME.to_string(), Vec::new(), false);
    for mut line in Lines::new(bytes, b'\n') {
        let word = line.word().unwrap_or_default().to_ascii_lowercase();
        match word.as_slice() {
            b"solid" => {
                let given = String::from_utf8_lossy(line.text).trim().to_string();
                name = if given.is_empty() { ONLY_NAME.to_string() } else { given };
                is_open = true;
            }
            b"vertex" => corners.push(line.point()?),
            b"endloop" if corners.len() == 3 => add(&mut surface, &name, corners.drain(..)),
            b"endsolid" => is_open = false,
            b"facet" | b"outer" | b"endfacet" if corners.is_empty() => {}
            other => {
                let expected = format!("a line of a triangle, after {} vertices", corners.len());
                return Err(Fault::unexpected(line.number, expected, other));
            }
        }
    }
    if is_open { Err(Fault::truncated("`endsolid`")) } else { Ok(surface) }
}
