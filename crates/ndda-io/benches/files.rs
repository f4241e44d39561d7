//! Files: scenes in, meshes in and out, frames, histories and checkpoints.
#![allow(missing_docs)] // criterion's macro makes public functions

use std::hint::black_box;
use std::path::Path;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use ndda_io::results::Table;
use ndda_io::scene::{FieldFormat, Precision};
use ndda_io::vtu::{Topology, Values};
use ndda_io::{Frame, History, OutputFolder, checkpoint, mesh_file, read};
use ndda_mesh::generate::{BoxPattern, box_block};
use ndda_mesh::{BlockMesh, BlockSet, Vec3};
use tempfile::TempDir;

/// Rows of a history.
const ROWS: usize = 1000;

/// A cube of 24 576 tetrahedra.
fn cube() -> BlockMesh {
    box_block([1.0; 3], [16; 3], BoxPattern::Six).expect("a cube")
}

fn folder() -> TempDir {
    tempfile::tempdir().expect("a place for files")
}

fn scenes(c: &mut Criterion) {
    for name in ["sliding_45", "pile_1000", "extreme/scale"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../scenes/{name}.ron"));
        let load = || read::load(&path, &[]).expect("a sound scene");
        c.bench_function(&format!("scene/read and check {name}"), |b| b.iter(load));
    }
}

fn meshes(c: &mut Criterion) {
    let mut group = c.benchmark_group("mesh of 24 576 tets");
    group.sample_size(10);
    let (folder, bodies) = (folder(), [("cube".to_string(), cube())]);
    for ending in ["msh", "ele", "vtu", "inp"] {
        let path = folder.path().join("cube").with_extension(ending);
        let write = || mesh_file::write(&path, &bodies).expect("room for a mesh");
        group.bench_function(BenchmarkId::new("write", ending), |b| b.iter(write));
        write();
        let read = || mesh_file::read(&path).expect("the mesh just written");
        group.bench_function(BenchmarkId::new("read", ending), |b| b.iter(read));
    }
    group.finish();
}

/// A frame with two vectors a node and a stress an element.
fn frame(blocks: &BlockSet) -> Frame {
    let mut frame = Frame::new(blocks, &blocks.rest_position);
    let moved = blocks.rest_position.iter().map(|x| Vec3::new(x.y.sin(), x.z, 1e-3 * x.x));
    frame.add_points(Values::vectors("displacement_m", moved.clone(), Precision::F32));
    frame.add_points(Values::vectors("velocity_m_s", moved, Precision::F32));
    let stress = (0..blocks.tets.len()).map(|tet| [1.0, 2.0, 3.0, 4.0, 5.0, 6.0].map(|s| s * tet as f64));
    frame.add_cells(Values::new("stress_pa", stress, Precision::F32));
    frame
}

fn frames(c: &mut Criterion) {
    let blocks = BlockSet::new(vec![("cube".into(), cube())]).expect("a cube");
    let mut group = c.benchmark_group("frame of 24 576 tets");
    group.sample_size(20);
    for format in [FieldFormat::Compressed, FieldFormat::Appended, FieldFormat::Base64] {
        let topology = Topology::new(&blocks, format).with_blocks(&blocks);
        let encode = || frame(&blocks).encode(Path::new("frame.vtu"), &topology).expect("numbers");
        group.bench_function(BenchmarkId::new("encode", format!("{format:?}")), |b| b.iter(encode));
    }
    group.finish();
}

fn histories(c: &mut Criterion) {
    let columns: Vec<String> = (0..20).map(|k| format!("column_{k}")).collect();
    let (folder, values) = (folder(), vec![1.0 / 3.0; 20]);
    let path = folder.path().join("history.csv");
    let write = || {
        let mut history = History::create(&path, &columns).expect("a file");
        (0..ROWS).for_each(|_| history.push(black_box(&values)).expect("room for a row"));
        history.finish().expect("room for the rest");
    };
    c.bench_function("history/write 1000 rows of 20", |b| b.iter(write));
    write();
    c.bench_function("history/read 1000 rows of 20", |b| b.iter(|| Table::read(&path).expect("the table")));
}

/// A value as long as the state of the cube: three vectors a node.
fn checkpoints(c: &mut Criterion) {
    let folder = folder();
    let output = OutputFolder::create(&folder.path().join("run"), false).expect("an empty folder");
    let state: Vec<[f64; 3]> = cube().nodes.iter().flat_map(|x| [[x.x, x.y, x.z]; 3]).collect();
    let mut group = c.benchmark_group("checkpoint of 14 739 vectors");
    group.sample_size(10);
    let write = || output.write_checkpoint(&state).expect("room for a checkpoint");
    group.bench_function("write", |b| b.iter(write));
    write();
    let read = || output.read_checkpoint::<Vec<[f64; 3]>>(|_| Ok(())).expect("the one just written");
    group.bench_function("read", |b| b.iter(read));
    group.bench_function("fingerprint", |b| b.iter(|| checkpoint::fingerprint(&state)));
    group.finish();
}

criterion_group!(benches, scenes, meshes, frames, histories, checkpoints);
criterion_main!(benches);
