//! How many blocks and tetrahedra a scene will have, and what they take, before anything is built.
//!
//! Counts are those of the generators, or expected ones. For planes of spacings s_i and normals n_i through a domain of
//! volume V, whose shadow along d is A(d) and whose extent along n is L(n), the mean number of blocks is
//!
//! ```text
//! 1 + Σ L(n_i)/s_i + Σ A(n_i × n_j) |n_i × n_j|/(s_i s_j) + Σ V |n_i · n_j × n_k|/(s_i s_j s_k)
//! ```
//!
//! (Santaló 1976, §III.16), and a block has 8 corners and 6 faces. Voronoi cells have 15.5 faces and 27 corners (Meijering 1953).
//! Bytes are measured: `ndda check` on boxes of 20³ to 60³ cells, grids of 12³ and 24³ blocks, 500 and 2000 cells, under
//! `/usr/bin/time -f %M`; see `docs/reference/limits.md`.

use ndda_io::scene::{
    Axis, Body, Contact, Discontinuity, Domain, Fill, Grading, Pattern, Potential, Rock, Scene, Shape,
    Solver, Towards,
};
use ndda_mesh::Vec3;
use std::path::Path;

/// Of the program itself [B].
pub(super) const PROGRAM_B: f64 = 1.2e7;
/// Of a tetrahedron in arrays, and of one that deforms [B].
pub(super) const TET_B: f64 = 260.0;
const ELASTIC_TET_B: f64 = 1500.0;
/// Of a factor of n unknowns: the lesser of 12 n² (dense) and 230 n^(4/3) (nested dissection in space) [B].
const DENSE_B: f64 = 12.0;
const SPARSE_B: f64 = 230.0;
/// Of a block [B].
pub(super) const BLOCK_B: f64 = 8000.0;
/// Of a triangle that touches other blocks, of one of a block that is taken whole, and of one of a block of its own, of whose
/// surface a part touches [B].
const TOUCHING_B: f64 = 3000.0;
const WHOLE_B: f64 = 2000.0;
const SOME_TOUCH_B: f64 = 1000.0;
/// Tetrahedra per cube of the edge, and triangles per square of it, where edges have a length.
const TETS_PER_SIZE3: f64 = 12.3;
const TRIANGLES_PER_SIZE2: f64 = 2.5;
/// Bytes of a mesh file per tetrahedron, of one that is packed, and of a surface per triangle.
const FILE_TET_B: f64 = 25.0;
const PACKED_TET_B: f64 = 10.0;
const FILE_TRIANGLE_B: f64 = 30.0;
/// Bytes of a height in a grid, of which there are two triangles.
const HEIGHT_B: f64 = 8.0;
/// Most triangles of a terrain that is sampled from a surface: two for each of 200 heights by 200.
const SAMPLED_TRIANGLES: f64 = 8e4;
/// Of a convex part of a domain, which is glued to the others: the prism below a triangle of a terrain.
const PART: Count = Count { blocks: 0.0, nodes: 2.0, tets: 8.0, triangles: 4.0, build_s: 8.0 * TET_S };
/// Seconds per tetrahedron, and per Voronoi cell.
const TET_S: f64 = 1e-5;
const CELL_S: f64 = 3e-3;
/// Size of a part of a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Count {
    /// Blocks.
    pub blocks: f64,
    /// Nodes.
    pub nodes: f64,
    /// Tetrahedra.
    pub tets: f64,
    /// Boundary triangles.
    pub triangles: f64,
    /// Time to cut and mesh it [s].
    pub build_s: f64,
}

/// A part of a scene, and what it takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Path in the scene.
    pub path: String,
    /// How many.
    pub count: Count,
    /// Memory of a run [B].
    pub bytes: f64,
    /// Remedy.
    pub cure: &'static str,
}

/// All parts of a scene; those that name files are sized by them, which are in `folder`.
pub fn parts(scene: &Scene, folder: &Path) -> Vec<Part> {
    let alone = scene.blocks.len() + scene.rock.len() < 2 && scene.rock.is_empty();
    let blocks = scene.blocks.iter().enumerate().map(|(i, block)| {
        let (count, cure) = of_shape(&block.shape, folder);
        let touching_b = if alone { 0.0 } else { SOME_TOUCH_B };
        part(scene, format!("blocks[{i}].shape"), count, block.body, touching_b, cure)
    });
    let rocks = scene.rock.iter().enumerate().map(|(i, rock)| {
        let (count, field, cure) = of_rock(rock, folder);
        let touching_b = if is_affine(scene, rock.body) { WHOLE_B } else { TOUCHING_B };
        part(scene, format!("rock[{i}]{field}"), count, rock.body, touching_b, cure)
    });
    blocks.chain(rocks).collect()
}

/// Memory of a run of the scene [B].
pub fn bytes(parts: &[Part]) -> f64 {
    PROGRAM_B + parts.iter().map(|part| part.bytes).sum::<f64>()
}

fn part(scene: &Scene, path: String, count: Count, body: Body, touching_b: f64, cure: &'static str) -> Part {
    let deforms = matches!(body, Body::Elastic | Body::Affine);
    let has_contact = matches!(scene.contact, Some(Contact::Potential { .. }));
    let tets = count.tets * if deforms { ELASTIC_TET_B } else { TET_B };
    let unknowns = 3.0 * count.nodes / count.blocks.max(1.0);
    let is_factored = body == Body::Elastic && scene.time.solver == Solver::Cholesky;
    let factor = (DENSE_B * unknowns * unknowns).min(SPARSE_B * unknowns.powf(4.0 / 3.0));
    let factors = if is_factored { count.blocks * factor } else { 0.0 };
    let contact = if has_contact { count.triangles * touching_b } else { 0.0 };
    let bytes = tets + factors + contact + count.blocks * BLOCK_B;
    Part { path, count, bytes, cure }
}

/// Whether contact sees convex blocks of this kind without their tetrahedra.
fn is_affine(scene: &Scene, body: Body) -> bool {
    let smooth =
        matches!(scene.contact, Some(Contact::Potential { potential: Potential::Smooth { .. }, .. }));
    smooth && body != Body::Elastic
}

fn one_block(nodes: f64, tets: f64, triangles: f64) -> Count {
    Count { blocks: 1.0, nodes, tets, triangles, build_s: tets * TET_S }
}

fn of_shape(shape: &Shape, folder: &Path) -> (Count, &'static str) {
    let cells = "use fewer cells";
    match shape {
        Shape::Box { cells: n, pattern, .. }
        | Shape::Hexahedron { cells: n, pattern, .. }
        | Shape::Voussoir { cells: n, pattern, .. } => (of_cells(n.map(f64::from), *pattern), cells),
        Shape::Prism { cells: [n, m], .. } => {
            let (n, m) = (f64::from(*n), f64::from(*m));
            let nodes = 0.5 * (n + 1.0) * (n + 2.0) * (m + 1.0);
            (one_block(nodes, 3.0 * n * n * m, 2.0 * n * n + 6.0 * n * m), cells)
        }
        Shape::Cylinder { cells: [n, m], .. } => {
            let (n, m) = (f64::from(*n), f64::from(*m));
            let nodes = (1.0 + 3.0 * n * (n + 1.0)) * (m + 1.0);
            (one_block(nodes, 18.0 * n * n * m, 12.0 * n * n + 12.0 * n * m), cells)
        }
        Shape::Sphere { levels, .. } => {
            let tets = 8f64.powi(*levels as i32 + 1);
            (one_block(0.2 * tets + 7.0, tets, 8.0 * 4f64.powi(*levels as i32)), "use fewer levels")
        }
        Shape::Polyhedron { corners_m, faces, fill } => {
            let triangles = faces.iter().map(|face| face.len().saturating_sub(2) as f64).sum();
            let bare = one_block(corners_m.len() as f64, 2.0 * triangles, triangles);
            let extent = extent(corners_m);
            (filled(bare, fill, volume(&extent), area(&extent)), "use a larger size")
        }
        Shape::Surface { file, .. } => {
            let triangles = file_b(folder, file) / FILE_TRIANGLE_B;
            (one_block(0.5 * triangles, 5.0 * triangles, triangles), "use a surface of fewer triangles")
        }
        Shape::Mesh { file, .. } => {
            let tets = tets_of_file(&folder.join(file));
            (one_block(0.2 * tets, tets, 0.2 * tets), "use a coarser mesh")
        }
    }
}

fn of_cells([x, y, z]: [f64; 3], pattern: Pattern) -> Count {
    let (cells, corners) = (x * y * z, (x + 1.0) * (y + 1.0) * (z + 1.0));
    let sides = 2.0 * (x * y + y * z + z * x);
    match pattern {
        Pattern::Six => one_block(corners, 6.0 * cells, 2.0 * sides),
        Pattern::TwentyFour => one_block(corners + 4.0 * cells + 0.5 * sides, 24.0 * cells, 4.0 * sides),
    }
}

/// Tetrahedra that a mesh file of its length holds.
pub(super) fn tets_of_file(file: &Path) -> f64 {
    let is_packed = file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("vtu"));
    file_b(Path::new(""), file) / if is_packed { PACKED_TET_B } else { FILE_TET_B }
}

/// Length of a file [B].
fn file_b(folder: &Path, file: impl AsRef<Path>) -> f64 {
    std::fs::metadata(folder.join(file)).map_or(0.0, |file| file.len() as f64)
}

fn of_rock(rock: &Rock, folder: &Path) -> (Count, &'static str, &'static str) {
    let (count, field, cure) = of_cut_rock(rock, folder);
    match rock.into {
        Some(_) => (taken_apart(count), ".into", "use a larger size"),
        None => (count, field, cure),
    }
}

/// Blocks as pieces of one tetrahedron each.
pub(super) fn taken_apart(count: Count) -> Count {
    let each = 4.0 * count.tets;
    Count { blocks: count.tets, nodes: each, triangles: each, ..count }
}

fn of_cut_rock(rock: &Rock, folder: &Path) -> (Count, &'static str, &'static str) {
    let fill = &rock.filling();
    let (extent, parts) = of_domain(&rock.domain, folder);
    let (volume_m3, mut area_m2) = (volume(&extent), area(&extent));
    if let Some(voronoi) = rock.voronoi {
        let cells = f64::from(voronoi.count);
        let bare = Count { nodes: 27.0, tets: 35.0, triangles: 50.0, ..Count::default() };
        // A cell of volume v has a surface of 5.82 v^(2/3) (Meijering 1953).
        area_m2 += 5.82 * cells * (volume_m3 / cells).powf(2.0 / 3.0);
        let mut count = with_parts(filled(times(bare, cells), fill, volume_m3, area_m2), parts);
        count.build_s += CELL_S * cells;
        return (count, ".voronoi", "use a smaller count");
    }
    let sets = sets(rock);
    let blocks = cells_of(&sets, &extent);
    area_m2 += sets.iter().map(|(_, per_m)| 2.0 * volume_m3 * per_m).sum::<f64>();
    let bare = Count { nodes: 8.0, tets: 6.0, triangles: 12.0, ..Count::default() };
    let count = with_parts(filled(times(bare, blocks), fill, volume_m3, area_m2), parts);
    if parts > blocks {
        return (count, ".domain", "use a coarser grid or surface");
    }
    (count, ".joints", "use wider spacings, or a coarser fill")
}

/// Blocks of a domain that falls into convex parts, which are glued together where no joint parts them.
fn with_parts(count: Count, parts: f64) -> Count {
    if parts <= 1.0 {
        return count;
    }
    Count {
        nodes: count.nodes + parts * PART.nodes,
        tets: count.tets + parts * PART.tets,
        triangles: count.triangles + parts * PART.triangles,
        build_s: count.build_s + parts * PART.build_s,
        ..count
    }
}

pub(super) fn times(one: Count, blocks: f64) -> Count {
    let (nodes, tets) = (one.nodes * blocks, one.tets * blocks);
    Count { blocks, nodes, tets, triangles: one.triangles * blocks, build_s: tets * TET_S }
}

/// Extents of a domain [m], and the convex parts that it falls into.
fn of_domain(domain: &Domain, folder: &Path) -> (Vec3, f64) {
    match domain {
        Domain::Box { min_m, max_m } => (Vec3::from(*max_m) - Vec3::from(*min_m), 1.0),
        Domain::Column { outline_m, axis, start_m, end_m } => {
            let place = |a: f64, b: f64, along: f64| match axis {
                Axis::X => [along, a, b],
                Axis::Y => [a, along, b],
                Axis::Z => [a, b, along],
            };
            let ends = |[a, b]: &[f64; 2]| [*start_m, *end_m].map(|along| place(*a, *b, along));
            let corners: Vec<[f64; 3]> = outline_m.iter().flat_map(ends).collect();
            (extent(&corners), 1.0)
        }
        Domain::Polyhedron { corners_m, .. } => (extent(corners_m), 1.0),
        Domain::File { file, .. } => (Vec3::zeros(), 1.0 + file_b(folder, file) / FILE_TRIANGLE_B),
        Domain::Terrain { step_m, heights_m, base_m, .. } => {
            let (rows, columns) = (heights_m.len(), heights_m.first().map_or(0, Vec::len));
            let highest = heights_m.iter().flatten().fold(*base_m, |most, z| most.max(*z));
            let along = |count: usize, step: f64| count.saturating_sub(1) as f64 * step;
            let extent = Vec3::new(along(columns, step_m[0]), along(rows, step_m[1]), highest - base_m);
            (extent, 2.0 * along(columns, 1.0) * along(rows, 1.0))
        }
        Domain::TerrainFile { file, .. } => {
            let is_surface =
                Path::new(file).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("stl"));
            let triangles = 2.0 * file_b(folder, file) / HEIGHT_B;
            (Vec3::zeros(), 1.0 + if is_surface { SAMPLED_TRIANGLES } else { triangles })
        }
    }
}

fn extent(corners_m: &[[f64; 3]]) -> Vec3 {
    let range = |i: usize| {
        let fold = |(least, most): (f64, f64), x: &[f64; 3]| (least.min(x[i]), most.max(x[i]));
        let (least, most) = corners_m.iter().fold((f64::INFINITY, f64::NEG_INFINITY), fold);
        (most - least).max(0.0)
    };
    Vec3::new(range(0), range(1), range(2))
}

fn volume(extent: &Vec3) -> f64 {
    extent.x * extent.y * extent.z
}

fn area(extent: &Vec3) -> f64 {
    2.0 * (extent.x * extent.y + extent.y * extent.z + extent.z * extent.x)
}

/// Normal, and planes per metre along it that cut what they cross, of each joint set.
fn sets(rock: &Rock) -> Vec<(Vec3, f64)> {
    let set = |joint: &Discontinuity| match joint {
        Discontinuity::Set { dip_deg, dip_direction_deg, spacing_m, persistence, .. } => {
            let (dip, azimuth) = (dip_deg.to_radians(), dip_direction_deg.to_radians());
            let normal = Vec3::new(dip.sin() * azimuth.sin(), dip.sin() * azimuth.cos(), dip.cos());
            Some((normal, persistence / spacing_m))
        }
        _ => None,
    };
    rock.joints.iter().filter_map(set).collect()
}

/// Mean number of blocks that sets make of a box: the formula of the module.
fn cells_of(sets: &[(Vec3, f64)], extent: &Vec3) -> f64 {
    let shadow = |d: &Vec3| {
        d.x.abs() * extent.y * extent.z + d.y.abs() * extent.z * extent.x + d.z.abs() * extent.x * extent.y
    };
    let mut cells = 1.0;
    for (i, (a, per_a)) in sets.iter().enumerate() {
        cells += per_a * a.abs().dot(extent);
        for (j, (b, per_b)) in sets.iter().enumerate().take(i) {
            cells += per_a * per_b * shadow(&a.cross(b));
            let triples = sets.iter().take(j).map(|(c, per_c)| per_c * a.dot(&b.cross(c)).abs());
            cells += per_a * per_b * volume(extent) * triples.sum::<f64>();
        }
    }
    cells
}

/// Blocks with as few tetrahedra as there can be, as a fill makes them.
pub(super) fn filled(bare: Count, fill: &Fill, volume_m3: f64, area_m2: f64) -> Count {
    let (tets, triangles) = match fill {
        Fill::Fewest => return bare,
        Fill::Centre => {
            let (nodes, tets) = (bare.nodes + bare.blocks, bare.triangles);
            return Count { nodes, tets, ..bare };
        }
        Fill::Size { size_m, finer } => {
            let finer = finer.iter().map(|place| finer_tets(place, *size_m, volume_m3)).sum::<f64>();
            let tets = TETS_PER_SIZE3 * volume_m3 / size_m.powi(3) + finer;
            (tets, TRIANGLES_PER_SIZE2 * area_m2 / (size_m * size_m) + 0.1 * finer)
        }
        Fill::TetGen { size_m, .. } => {
            let cubes = volume_m3 / size_m.powi(3);
            (TETS_PER_SIZE3 * cubes, TRIANGLES_PER_SIZE2 * area_m2 / (size_m * size_m))
        }
    };
    let (tets, triangles) = (tets.max(bare.tets), triangles.max(bare.triangles));
    let nodes = bare.nodes.max(0.22 * tets + 0.3 * triangles);
    Count { tets, triangles, nodes, build_s: tets * TET_S, ..bare }
}

/// Tetrahedra around a place where edges have the length f + g r: TETS ∫ dV/(f + g r)³, at most all of the volume at f.
fn finer_tets(place: &Grading, size_m: f64, volume_m3: f64) -> f64 {
    let (f, g) = (place.size_m, place.growth);
    let all = TETS_PER_SIZE3 * volume_m3 / f.powi(3);
    if f >= size_m {
        return 0.0;
    }
    let near = match place.towards {
        Towards::Point(_) => 4.0 * std::f64::consts::PI / g.powi(3) * (size_m / f).ln(),
        Towards::Plane { .. } => volume_m3.powf(2.0 / 3.0) / (g * f * f),
    };
    if g > 0.0 { all.min(TETS_PER_SIZE3 * near) } else { all }
}

/// A count with two digits.
pub(super) fn rounded(count: f64) -> String {
    if count < 1e4 { format!("{count:.0}") } else { format!("{count:.1e}") }
}
