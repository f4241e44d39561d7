//! Abaqus input files (`.inp`): nodes, C3D4 elements and sets of a flat file or of one part.
//!
//! Format: Abaqus keywords reference, `*NODE`, `*ELEMENT`, `*NSET`, `*ELSET`, `*SOLID SECTION`. Other keywords are
//! skipped. Bodies are the sets of `*SOLID SECTION`s or, without any, all `ELSET`s that hold C3D4 elements, but for
//! those that hold all when others divide them. Elements on surfaces and lines serve as node sets by their `ELSET`s.

mod keyword;
mod sets;
mod write;

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use ndda_mesh::Vec3;

use crate::mesh::error::{Fault, bytes_of};
use crate::mesh::lines::{parse, real};
use crate::mesh::{FileProblem, MeshFile, MeshFileError};
use keyword::{Keyword, Records};

pub(crate) use write::write;

/// Reads a mesh.
///
/// # Errors
/// [`MeshFileError`] with the line; other elements of volumes than C3D4, several parts and moved instances are
/// refused.
pub(crate) fn read(path: &Path) -> Result<MeshFile, MeshFileError> {
    let bytes = bytes_of(path)?;
    let bodies = model(&bytes).and_then(|model| sets::parts(model)?.split());
    Ok(MeshFile { bodies: bodies.map_err(|fault| fault.of(path))? })
}

/// Nodes, elements and sets as in the file.
#[derive(Default)]
struct Model {
    nodes: Vec<Vec3>,
    node_of_label: HashMap<u64, u32>,
    tets: Vec<[u32; 4]>,
    /// Index of each C3D4 element by its number.
    tet_of_label: HashMap<u64, u32>,
    /// Corners of elements on surfaces and lines.
    facets: HashMap<u64, [u32; 4]>,
    node_sets: BTreeMap<String, Vec<u64>>,
    element_sets: BTreeMap<String, Vec<u64>>,
    /// Element sets of solid sections.
    sections: Vec<String>,
    /// How names of sets were first written; they are compared in capitals.
    spelling: HashMap<String, String>,
}

impl Model {
    fn set_name(&mut self, name: &str) -> String {
        self.spelling.entry(name.to_uppercase()).or_insert_with(|| name.to_string()).clone()
    }
}

fn model(bytes: &[u8]) -> Result<Model, Fault> {
    let mut model = Model::default();
    let mut records = Records::new(bytes);
    let mut parts = 0;
    while let Some(keyword) = records.keyword()? {
        match keyword.name.as_str() {
            "NODE" => nodes(&keyword, &mut records, &mut model)?,
            "ELEMENT" => elements(&keyword, &mut records, &mut model)?,
            "NSET" => set(&keyword, &mut records, &mut model, "NSET")?,
            "ELSET" => set(&keyword, &mut records, &mut model, "ELSET")?,
            "SOLID SECTION" => {
                let name = keyword.value("ELSET")?;
                let name = model.set_name(name);
                model.sections.push(name);
            }
            "PART" => {
                parts += 1;
                if parts > 1 {
                    return Err(not_read(
                        &keyword,
                        "a second *PART",
                        "export one part, or write the input file without parts and assemblies",
                    ));
                }
            }
            "INSTANCE" if records.data()?.is_some() => {
                return Err(not_read(
                    &keyword,
                    "a moved *INSTANCE",
                    "write the input file without parts and assemblies",
                ));
            }
            "INCLUDE" | "NGEN" | "NFILL" | "NCOPY" | "ELGEN" | "ELCOPY" | "SYSTEM" | "TRANSFORM" => {
                let what = format!("*{}", keyword.name);
                return Err(not_read(&keyword, &what, "write all nodes and elements into one file"));
            }
            _ => {}
        }
    }
    Ok(model)
}

fn not_read(keyword: &Keyword, what: &str, cure: &'static str) -> Fault {
    Fault::at(keyword.line, FileProblem::NotRead { what: what.to_string(), cure })
}

/// `label, x, y, z`.
fn nodes(keyword: &Keyword, records: &mut Records, model: &mut Model) -> Result<(), Fault> {
    let set = keyword.get("NSET").map(|name| model.set_name(name));
    while let Some(data) = records.data()? {
        let coordinate = |i: usize| {
            let word = data.words.get(i).copied().unwrap_or(b"end of line");
            real(word).ok_or_else(|| Fault::unexpected(data.line, "a finite coordinate", word))
        };
        let label = data.integer(0, "the number of a node")?;
        let at = Vec3::new(coordinate(1)?, coordinate(2)?, coordinate(3)?);
        let index = u32::try_from(model.nodes.len()).map_err(|_| FileProblem::TooManyNodes)?;
        if model.node_of_label.insert(label, index).is_some() {
            return Err(Fault::at(data.line, FileProblem::Twice { what: "node", id: label }));
        }
        model.nodes.push(at);
        if let Some(set) = &set {
            model.node_sets.entry(set.clone()).or_default().push(label);
        }
    }
    Ok(())
}

/// `label, node, node, …`.
fn elements(keyword: &Keyword, records: &mut Records, model: &mut Model) -> Result<(), Fault> {
    let kind = keyword.value("TYPE")?.to_uppercase();
    let is_tet = kind == "C3D4";
    if !is_tet && ["C3D", "CC3D", "DC3D", "AC3D", "SC"].iter().any(|solid| kind.starts_with(solid)) {
        let cure = "mesh with tetrahedra of first order, C3D4";
        return Err(not_read(keyword, &format!("an element of type {kind}"), cure));
    }
    let set = keyword.get("ELSET").map(|name| model.set_name(name));
    while let Some(data) = records.data()? {
        let label = data.integer(0, "the number of an element")?;
        if is_tet && data.words.len() != 5 {
            let found = format!("{} words", data.words.len());
            return Err(Fault::unexpected(data.line, "an element's number and four nodes", found.as_bytes()));
        }
        let corners = corners(&data, label, model)?;
        let is_new = if is_tet {
            let index = model.tets.len() as u32;
            model.tets.push(corners);
            model.tet_of_label.insert(label, index).is_none() && !model.facets.contains_key(&label)
        } else {
            model.facets.insert(label, corners).is_none() && !model.tet_of_label.contains_key(&label)
        };
        if !is_new {
            return Err(Fault::at(data.line, FileProblem::Twice { what: "element", id: label }));
        }
        if let Some(set) = &set {
            model.element_sets.entry(set.clone()).or_default().push(label);
        }
    }
    Ok(())
}

/// The first four nodes at most, which are corners; missing ones repeat the first.
fn corners(data: &keyword::Data, label: u64, model: &Model) -> Result<[u32; 4], Fault> {
    let index = |i: usize| {
        let node = data.integer(i, "the number of a node")?;
        let what = || format!("element {label}");
        let missing = || Fault::at(data.line, FileProblem::NoSuchNode { what: what(), node: node as i64 });
        model.node_of_label.get(&node).copied().ok_or_else(missing)
    };
    let mut corners = [index(1)?; 4];
    for (i, corner) in corners.iter_mut().enumerate().take(data.words.len() - 1) {
        *corner = index(i + 1)?;
    }
    Ok(corners)
}

/// Labels or names of other sets; with GENERATE, `first, last, step`.
fn set(keyword: &Keyword, records: &mut Records, model: &mut Model, kind: &'static str) -> Result<(), Fault> {
    let name = model.set_name(keyword.value(kind)?);
    let generate = keyword.has("GENERATE");
    let mut labels = Vec::new();
    while let Some(data) = records.data()? {
        if generate {
            let (first, last) = (data.integer(0, "the first label")?, data.integer(1, "the last label")?);
            let step = if data.words.len() > 2 { data.integer(2, "the step of labels")? } else { 1 };
            let known = model.node_of_label.len() + model.tets.len() + model.facets.len();
            if step == 0 || last < first || (last - first) / step > known as u64 {
                return Err(Fault::unexpected(data.line, "labels of what stands above", data.words[1]));
            }
            labels.extend((first..=last).step_by(usize::try_from(step).unwrap_or(usize::MAX)));
            continue;
        }
        let sets = if kind == "NSET" { &model.node_sets } else { &model.element_sets };
        for word in &data.words {
            if let Some(label) = parse(word) {
                labels.push(label);
                continue;
            }
            let other = keyword::unquoted(word).to_uppercase();
            let other = model.spelling.get(&other).and_then(|name| sets.get(name));
            let other = other.ok_or_else(|| Fault::unexpected(data.line, "a label or a set above", word))?;
            labels.extend(other);
        }
    }
    let sets = if kind == "NSET" { &mut model.node_sets } else { &mut model.element_sets };
    let labels_so_far = sets.entry(name).or_default();
    labels_so_far.extend(labels);
    // A set that names itself must not grow without end.
    labels_so_far.sort_unstable();
    labels_so_far.dedup();
    Ok(())
}
