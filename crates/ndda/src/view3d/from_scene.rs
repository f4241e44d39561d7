//! Blocks of a scene before any run.

use std::collections::HashMap;
use std::path::Path;

use ndda_io::diagnostic::SceneErrors;
use ndda_io::read::{self, LoadedScene};
use ndda_io::results::{Array, FieldFrame};
use ndda_io::scene::{Discontinuity, Scene};
use ndda_mesh::BlockSet;

use super::Colour;
use super::bolts;
use super::error::ViewError;
use super::film::{Colouring, Film, Moment};
use crate::build::Fault;
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
    let blocks = build::blocks(&loaded.scene, folder).map_err(|faults| refused(&loaded, faults))?;
    let scene = &loaded.scene;
    let bolts = build::bolts::lines(scene, &blocks).map_err(|faults| refused(&loaded, faults))?;
    let bolts = bolts.into_iter().enumerate().map(|(i, ends)| bolts::plain(i, ends)).collect();
    if *colour == Colour::Joint {
        let mut film = by_joint(scene, &blocks).ok_or_else(|| ViewError::NoJoints(file.to_path_buf()))?;
        film.moments[0].bolts = bolts;
        return Ok(film);
    }
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
    // Where nothing moves, all blocks are drawn in colours.
    let none_moves = !moves.contains(&true);
    if none_moves {
        moves.fill(true);
    }
    let mut film = film(scene.title.clone(), &blocks, colouring, moves);
    film.moved = none_moves.then_some(0);
    film.moments[0].bolts = bolts;
    Ok(film)
}

fn refused(loaded: &LoadedScene, faults: Vec<Fault>) -> SceneErrors {
    loaded.errors(faults.into_iter().map(|fault| loaded.diagnose(&fault.path, fault.message)).collect())
}

/// Blocks of no scene, in a colour each.
pub fn of_blocks(title: &str, blocks: &BlockSet) -> Film {
    film(title.into(), blocks, by_block(blocks, true), vec![true; blocks.len()])
}

fn by_block(blocks: &BlockSet, with_resting: bool) -> Colouring {
    let of_block = (0..blocks.names.len() as u32).collect();
    Colouring::Groups { names: blocks.names.clone(), plural: "blocks", of_block, with_resting }
}

/// Names of the faces of a domain and of cells, which no joint made.
const NO_JOINTS: [&str; 12] = [
    "x_min", "x_max", "y_min", "y_max", "z_min", "z_max", "terrain", "base", "side", "start", "end", "cells",
];

/// The names of surfaces that joints made: those that the scene gives, and of tables of discs all that are no faces of the domain.
fn is_joint(scene: &Scene, name: &str) -> bool {
    let joints = || scene.rock.iter().flat_map(|rock| &rock.joints);
    let has_table = joints().any(|joint| matches!(joint, Discontinuity::Discs { .. }));
    joints().any(|joint| joint.name() == name)
        || has_table && !NO_JOINTS.contains(&name) && !name.starts_with("side_")
}

/// Faces on joints, in a colour for each joint or set, in rock that is seen through where it hides them; none where no face is on a joint. The
/// faces of each joint are what the picture takes for a block.
fn by_joint(scene: &Scene, blocks: &BlockSet) -> Option<Film> {
    let known = |surface: &u32| is_joint(scene, &blocks.surface_names[*surface as usize]);
    let mut joints: Vec<u32> = blocks.triangle_surface.iter().flatten().copied().filter(known).collect();
    joints.sort_unstable();
    joints.dedup();
    let sorted = |mut corners: [u32; 3]| {
        corners.sort_unstable();
        corners
    };
    let joint_of: HashMap<[u32; 3], u32> = blocks
        .triangles
        .iter()
        .zip(&blocks.triangle_surface)
        .filter_map(|(corners, surface)| {
            let place = joints.binary_search(&(*surface)?).ok()?;
            Some((sorted(corners.map(|node| node.0)), place as u32))
        })
        .collect();
    let mut names: Vec<String> =
        joints.iter().map(|&surface| blocks.surface_names[surface as usize].clone()).collect();
    let rock = (!names.is_empty()).then_some(names.len() as u32)?;
    names.push("rock".into());
    let moves = (0..=rock).map(|part| part < rock).collect();
    let of_block = (0..=rock).collect();
    let colouring = Colouring::Groups { names, plural: "joints", of_block, with_resting: false };
    let mut film = film(scene.title.clone(), blocks, colouring, moves);
    let Surface { nodes, triangles, blocks: parts, .. } = &mut film.surface;
    for (part, corners) in parts.iter_mut().zip(triangles.iter()) {
        let corners = sorted(corners.map(|place| nodes[place as usize]));
        *part = joint_of.get(&corners).copied().unwrap_or(rock);
    }
    Some(film)
}

fn film(title: String, blocks: &BlockSet, colouring: Colouring, moves: Vec<bool>) -> Film {
    let surface = Surface::new(&frame(blocks));
    let positions: Vec<_> = surface.nodes.iter().map(|&n| blocks.rest_position[n as usize]).collect();
    let moment = Moment { positions: positions.clone(), ..Moment::default() };
    let (moments, moved, movable) = (vec![moment], None, None);
    Film { title, surface, start: positions, moves, colouring, moments, moved, movable }
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
