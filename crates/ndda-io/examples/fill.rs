//! Fills the same blocks with our mesher and, where the feature `tetgen` is on, with TetGen; for benches/peers/mesh.sh.
//!
//! Usage: fill FOLDER CELLS SIZE_M: Voronoi cells of a cube of 10 m, written to FOLDER/blocks.obj, edges of SIZE_M. Prints
//! a line per program: its name, seconds, tetrahedra, those with a dihedral angle below 10°, and the smallest angle.

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use ndda_io::surface_file::write_blocks;
use ndda_mesh::BlockMesh;
use ndda_mesh::Vec3;
use ndda_mesh::cut::{Blocks, Domain, VoronoiOptions, random_seeds, voronoi_blocks};
use ndda_mesh::quality::quality;
use ndda_mesh::tetrahedralise::Fill;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [folder, cells, size_m] = arguments.as_slice() else {
        return Err("usage: fill FOLDER CELLS SIZE_M".into());
    };
    let (cells, size_m): (usize, f64) = (cells.parse()?, size_m.parse()?);
    let domain = Domain::cuboid(Vec3::zeros(), Vec3::repeat(10.0))?;
    let seeds = random_seeds(&domain, cells, 0.7 * 10.0 / (cells as f64).cbrt(), 1);
    let blocks = voronoi_blocks(&domain, &seeds, &VoronoiOptions::default())?;
    write_blocks(&Path::new(folder).join("blocks.obj"), &blocks)?;
    let fill = Fill::Size { size_m, finer: Vec::new() };
    report("ndda", blocks.blocks.len(), |block| Ok(blocks.mesh(block, &fill)?))?;
    by_tetgen(&blocks, size_m)
}

#[cfg(feature = "tetgen")]
fn by_tetgen(blocks: &Blocks, size_m: f64) -> Result<(), Box<dyn Error>> {
    use ndda_io::surface_file::Surface;
    use ndda_mesh::cut::DomainFace;
    report("TetGen", blocks.blocks.len(), |block| {
        let block = &blocks.blocks[block];
        let face = |face: &ndda_mesh::cut::Face| DomainFace {
            name: blocks.name_of(face).to_string(),
            vertices: face.vertices.clone(),
        };
        let surface =
            Surface { vertices: block.vertices.clone(), faces: block.faces.iter().map(face).collect() };
        Ok(ndda_io::tetgen_fill::fill(&surface, size_m)?)
    })
}

#[cfg(not(feature = "tetgen"))]
fn by_tetgen(_blocks: &Blocks, _size_m: f64) -> Result<(), Box<dyn Error>> {
    Ok(())
}

/// Fills all blocks, one after the other, and prints what came of it.
fn report(
    program: &str,
    blocks: usize,
    fill: impl Fn(usize) -> Result<BlockMesh, Box<dyn Error>>,
) -> Result<(), Box<dyn Error>> {
    let start = Instant::now();
    let meshes = (0..blocks).map(fill).collect::<Result<Vec<_>, _>>()?;
    let seconds = start.elapsed().as_secs_f64();
    let report = quality(meshes.iter().map(|mesh| ("", mesh)));
    let poor: usize = report.dihedral_deg.counts[..2].iter().sum();
    let worst = report.worst.first().map_or(0.0, |tet| tet.dihedral_deg);
    println!("{program} {seconds:.3} {} {poor} {worst:.2}", report.tets);
    Ok(())
}
