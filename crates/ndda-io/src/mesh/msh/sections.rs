//! The frame that both versions share: sections, the format header, the names of physical groups.

use super::cursor::{Cursor, Encoding, Fault};
use super::error::MshProblem;
use super::mesh::Mesh;
use super::{v2, v4};
use crate::mesh::error::{FileProblem, excerpt};

/// Versions that are read.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Version {
    V2,
    V4,
}

/// Sections that would change what the mesh is, and what to do about them.
const REFUSED: [(&str, &str); 2] = [
    ("$PartitionedEntities", "save the mesh without partitions"),
    ("$ParametricNodes", "save with Mesh.SaveParametric = 0"),
];

/// Reads all sections; those of no concern here are skipped.
pub(super) fn read(cursor: &mut Cursor) -> Result<Mesh, Fault> {
    if cursor.is_at_end() {
        return Err(MshProblem::Empty.into());
    }
    let mut mesh = Mesh::default();
    let mut groups = v4::EntityGroups::default();
    let mut version = None;
    while !cursor.is_at_end() {
        let word = cursor.word("a section")?;
        if !word.starts_with(b"$") {
            let found = excerpt(word);
            return Err(cursor.fault(match version {
                None => MshProblem::NotMsh(found).into(),
                Some(_) => FileProblem::Unexpected { expected: "the start of a section".into(), found },
            }));
        }
        // The rest of the line is empty; what follows may be binary.
        cursor.rest_of_line();
        if let Some(&(section, cure)) = REFUSED.iter().find(|(name, _)| name.as_bytes() == word) {
            return Err(cursor.fault(FileProblem::NotRead { what: format!("section {section}"), cure }));
        }
        match (word, version) {
            (b"$MeshFormat", None) => version = Some(format(cursor)?),
            (b"$NOD", None) => return Err(cursor.fault(MshProblem::Version("1".into()))),
            (b"$PhysicalNames", Some(_)) => names(cursor, &mut mesh)?,
            (b"$Nodes", Some(Version::V2)) => v2::nodes(cursor, &mut mesh)?,
            (b"$Elements", Some(Version::V2)) => v2::elements(cursor, &mut mesh)?,
            (b"$Entities", Some(Version::V4)) => groups = v4::entities(cursor)?,
            (b"$Nodes", Some(Version::V4)) => v4::nodes(cursor, &mut mesh)?,
            (b"$Elements", Some(Version::V4)) => v4::elements(cursor, &groups, &mut mesh)?,
            (b"$Comments", _) | (_, Some(_)) => {
                cursor.skip_past(&end_of(word))?;
                continue;
            }
            (_, None) => return Err(cursor.fault(MshProblem::NotMsh(excerpt(word)))),
        }
        cursor.keyword(&end_of(word))?;
    }
    Ok(mesh)
}

fn end_of(section: &[u8]) -> String {
    format!("$End{}", String::from_utf8_lossy(&section[1..]))
}

/// `version file-type data-size`, and in a binary file the number 1 that gives the byte order.
fn format(cursor: &mut Cursor) -> Result<Version, Fault> {
    let version = match cursor.word("the version of the format")? {
        b"2.2" => Version::V2,
        b"4.1" => Version::V4,
        other => return Err(cursor.fault(MshProblem::Version(excerpt(other)))),
    };
    let file_type: i64 = cursor.text("the file type, 0 or 1")?;
    if file_type != 0 && file_type != 1 {
        return Err(cursor.fault(MshProblem::FileType(file_type)));
    }
    let data_size: i64 = cursor.text("the data size")?;
    if data_size != 8 {
        return Err(cursor.fault(MshProblem::DataSize(data_size)));
    }
    if file_type == 1 {
        cursor.rest_of_line();
        let mark = cursor.raw_u32("the byte order mark")?;
        cursor.encoding = match mark {
            1 => Encoding::LittleEndian,
            0x0100_0000 => Encoding::BigEndian,
            other => return Err(cursor.fault(MshProblem::ByteOrder(other))),
        };
    }
    Ok(version)
}

/// `dimension tag "name"` per line; text even in binary files.
fn names(cursor: &mut Cursor, mesh: &mut Mesh) -> Result<(), Fault> {
    let count: u64 = cursor.text("the number of physical names")?;
    for _ in 0..cursor.fitting("physical names", count, 7, 7)? {
        let dim: u8 = cursor.text("the dimension of a physical group")?;
        let tag: i32 = cursor.text("the tag of a physical group")?;
        let line = cursor.rest_of_line();
        let name = std::str::from_utf8(line).ok().and_then(|text| text.strip_prefix('"')?.strip_suffix('"'));
        let Some(name) = name.filter(|name| !name.is_empty()) else {
            let expected = "a name in quotes, in UTF-8".to_string();
            return Err(cursor.fault(FileProblem::Unexpected { expected, found: excerpt(line) }));
        };
        mesh.names.insert((dim, tag.unsigned_abs()), name.to_string());
    }
    Ok(())
}
