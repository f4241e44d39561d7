//! Wavefront OBJ: surfaces in, blocks out.

use std::fmt::Write;
use std::path::Path;

use ndda_mesh::Vec3;
use ndda_mesh::cut::{Blocks, DomainFace};

use super::{ONLY_NAME, Surface};
use crate::atomic;
use crate::mesh::FileProblem;
use crate::mesh::error::Fault;
use crate::mesh::lines::{Line, Lines, parse};
use crate::write_error::WriteError;

/// `v x y z` and `f a b c …`, where `a` may be `a/texture/normal`, and counts back from the last vertex if negative.
/// `o`, `g` and `usemtl` name the faces that follow; the last of them counts. Other lines are skipped.
pub(super) fn read(bytes: &[u8]) -> Result<Surface, Fault> {
    let mut surface = Surface::default();
    let mut name = ONLY_NAME.to_string();
    for mut line in Lines::new(bytes, b'#') {
        match line.word() {
            Some(b"v") => surface.vertices.push(line.point()?),
            Some(b"o" | b"g" | b"usemtl") => {
                let given = String::from_utf8_lossy(line.text).trim().to_string();
                name = if given.is_empty() { ONLY_NAME.to_string() } else { given };
            }
            Some(b"f") => {
                let vertices = face(&mut line, surface.vertices.len())?;
                surface.faces.push(DomainFace { name: name.clone(), vertices });
            }
            _ => {}
        }
    }
    Ok(surface)
}

fn face(line: &mut Line, count: usize) -> Result<Vec<u32>, Fault> {
    let mut vertices = Vec::new();
    while let Some(word) = line.word() {
        let vertex = word.split(|&b| b == b'/').next().unwrap_or_default();
        let vertex: i64 = parse(vertex).ok_or_else(|| Fault::unexpected(line.number, "a vertex", word))?;
        let index = if vertex < 0 { count as i64 + vertex } else { vertex - 1 };
        if !(0..count as i64).contains(&index) {
            let what = "a face (vertices are counted from 1)".to_string();
            return Err(Fault::at(line.number, FileProblem::NoSuchNode { what, node: vertex }));
        }
        vertices.push(u32::try_from(index).map_err(|_| FileProblem::TooManyNodes)?);
    }
    let is_face = vertices.len() >= 3;
    if is_face {
        Ok(vertices)
    } else {
        Err(Fault::unexpected(line.number, "at least three vertices", b"fewer"))
    }
}

/// Writes blocks of a cut as objects `block_0`, `block_1`, … whose faces have the material of their surface's name.
///
/// # Errors
/// [`WriteError`] for a number that is not finite, and what the operating system refuses.
pub fn write_blocks(path: &Path, blocks: &Blocks) -> Result<(), WriteError> {
    let points = || blocks.blocks.iter().flat_map(|block| &block.vertices);
    if let Some(index) = points().position(|x: &Vec3| !x.iter().all(|c| c.is_finite())) {
        return Err(WriteError::not_finite(path, "vertex", Some(index)));
    }
    let text = objects(blocks).expect("a String takes all that is written to it");
    atomic::write_named(path, text.as_bytes())
}

fn objects(blocks: &Blocks) -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    let mut first = 1;
    for (i, block) in blocks.blocks.iter().enumerate() {
        writeln!(text, "o block_{i}")?;
        for x in &block.vertices {
            writeln!(text, "v {:?} {:?} {:?}", x.x, x.y, x.z)?;
        }
        for face in &block.faces {
            let name = blocks.name_of(face).replace(|c: char| c.is_whitespace() || c.is_control(), "_");
            write!(text, "usemtl {name}\nf")?;
            for &vertex in &face.vertices {
                write!(text, " {}", first + u64::from(vertex))?;
            }
            writeln!(text)?;
        }
        first += block.vertices.len() as u64;
    }
    Ok(text)
}
