//! Blocks of a scene before any run.

use std::path::Path;

use ndda_io::read;
use ndda_io::results::{Array, FieldFrame};
use ndda_mesh::BlockSet;

use super::Colour;
use super::error::ViewError;
use super::film::{Colouring, Film, Moment};
use crate::surface::{BLOCK_ID, Surface};
use crate::{build, forecast};

/// Reads a scene and builds its blocks.
///
/// # Errors
/// [`ViewError::Scene`] with all that is wrong with it; [`ViewError::NoResults`] for colours that only a run has.
pub fn read(file: &Path, overrides: &[String], colour: &Colour) -> Result<Film, ViewError> {
    let loaded = read::load(file, overrides)?;
    let folder = file.parent().unwrap_or(Path::new("."));
    forecast::admit::admit(&loaded, folder).map_err(|refused| loaded.errors(vec![refused]))?;
    let blocks = build::blocks(&loaded.scene, folder).map_err(|faults| {
        let diagnostics = faults.into_iter().map(|f| loaded.diagnose(&f.path, f.message)).collect();
        loaded.errors(diagnostics)
    })?;
    let scene = &loaded.scene;
    let colouring = match colour {
        Colour::Block => by_block(&blocks, false),
        Colour::Material => Colouring::Groups {
            names: scene.materials.iter().map(|material| material.name.clone()).collect(),
            plural: "materials",
            of_block: build::materials_of(scene, &blocks),
            with_resting: true,
        },
        other => return Err(ViewError::NoResults(other.to_string())),
    };
    let mut moves: Vec<bool> = build::moving(scene, &blocks).iter().map(Option::is_some).collect();
    if !moves.contains(&true) {
        moves.fill(true);
    }
    Ok(film(scene.title.clone(), &blocks, colouring, moves))
}

/// Blocks of no scene, in a colour each.
pub fn of_blocks(title: &str, blocks: &BlockSet) -> Film {
    film(title.into(), blocks, by_block(blocks, true), vec![true; blocks.len()])
}

fn by_block(blocks: &BlockSet, with_resting: bool) -> Colouring {
    let of_block = (0..blocks.names.len() as u32).collect();
    Colouring::Groups { names: blocks.names.clone(), plural: "blocks", of_block, with_resting }
}

fn film(title: String, blocks: &BlockSet, colouring: Colouring, moves: Vec<bool>) -> Film {
    let surface = Surface::new(&frame(blocks));
    let positions: Vec<_> = surface.nodes.iter().map(|&n| blocks.rest_position[n as usize]).collect();
    let moment =
        Moment { time_s: None, positions: positions.clone(), absent: Vec::new(), values: Vec::new() };
    Film { title, surface, start: positions, moves, colouring, moments: vec![moment] }
}

/// Blocks as a frame of a run holds them.
fn frame(blocks: &BlockSet) -> FieldFrame {
    let ids = blocks.tet_block.iter().map(|block| f64::from(block.0)).collect();
    FieldFrame {
        points: blocks.rest_position.clone(),
        tets: blocks.tets.iter().map(|tet| tet.map(|node| node.0)).collect(),
        cell_data: [(BLOCK_ID.to_string(), Array { components: 1, values: ids })].into(),
        ..FieldFrame::default()
    }
}
