//! Files of `ndda mesh`: the blocks, their report, and pictures.

use std::fmt::Write as _;
use std::path::Path;

use ndda_io::scene::FieldFormat;
use ndda_io::vtu::{Frame, Topology};
use ndda_io::{OutputFolder, WriteError};
use ndda_mesh::BlockSet;

use crate::build::{CutRock, Meshes};
use crate::mesh_export::{self, Export};
use crate::mesh_report::MeshReport;

/// Picture of the blocks.
const DRAWN: &str = if cfg!(feature = "png") { "blocks.png" } else { "blocks.svg" };

/// What is written of measured blocks.
pub struct MeshFiles<'a> {
    /// Scene or mesh file.
    pub input: &'a Path,
    /// Other formats to write them in.
    pub also: &'a [Export],
    /// Their report.
    pub measured: &'a MeshReport,
    /// Their meshes, for other formats.
    pub meshes: &'a Meshes,
    /// Rock that some were cut from.
    pub rock: &'a [CutRock],
}

impl MeshFiles<'_> {
    /// Writes pictures and blocks to a folder; returns a line that says where.
    ///
    /// # Errors
    /// [`WriteError`] when the folder is in use, or a file cannot be written.
    pub fn write(&self, folder: &Path, force: bool, blocks: &BlockSet) -> Result<String, WriteError> {
        let folder = OutputFolder::create(folder, force)?;
        let folder = folder.path();
        let path = folder.join("blocks.vtu");
        let topology = Topology::new(blocks, FieldFormat::default()).with_blocks(blocks);
        let frame = Frame::new(blocks, &blocks.rest_position);
        ndda_io::atomic::write(&path, &frame.encode(&path, &topology)?)?;
        ndda_io::atomic::write(&folder.join(OutputFolder::MESH_REPORT), self.measured.json().as_bytes())?;
        #[cfg(feature = "plots")]
        {
            use crate::{mesh_picture, picture, view3d};
            let draw = |root: &picture::Area| mesh_picture::draw(self.measured, root);
            picture::write(&folder.join("mesh.svg"), mesh_picture::SIZE, draw)?;
            view3d::draw_blocks(&self.input.display().to_string(), blocks, &folder.join(DRAWN))?;
        }
        let mut exported = String::new();
        for export in self.also {
            for name in mesh_export::write(folder, *export, self.meshes, self.rock)? {
                let _ = write!(exported, ", {name}");
            }
        }
        let pictures = format!(", {DRAWN} (blocks), mesh.svg (histograms)");
        let pictures = if cfg!(feature = "plots") { &pictures } else { "" };
        Ok(format!("{}: blocks.vtu (open it in ParaView), mesh.json{pictures}{exported}", folder.display()))
    }
}
