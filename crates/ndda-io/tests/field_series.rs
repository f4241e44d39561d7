//! Writes a small series of fields, which `tests/read_vtk.py` then opens with VTK's own reader.
//!
//! The files stay in `target/tmp/field_series` for that.

use std::path::Path;

use ndda_io::scene::{FieldFormat, Precision};
use ndda_io::vtu::{Topology, Values};
use ndda_io::{FieldSeries, Frame, OutputFolder};
use ndda_mesh::{BlockMesh, BlockSet, Mat3, Vec3};

/// Two tetrahedra that share a face, in map coordinates.
fn blocks() -> BlockSet {
    let mesh = BlockMesh {
        nodes: vec![Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z(), Vec3::repeat(1.0)],
        tets: vec![[0, 1, 2, 3], [1, 2, 3, 4]],
        ..BlockMesh::default()
    };
    let at = |x, y| mesh.clone().placed(&Mat3::identity(), &Vec3::new(x, y, 0.0));
    BlockSet::new(vec![("low".into(), at(4.5e6, 1.0e6)), ("high".into(), at(4.5e6, 1.0e6 + 3.0))]).unwrap()
}

#[test]
fn a_series_of_frames_is_written() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("field_series");
    let output = OutputFolder::create(&folder, true).unwrap();
    let blocks = blocks();
    let topology = Topology::new(&blocks, FieldFormat::Compressed).with_blocks(&blocks);
    let mut series = FieldSeries::create(&output, topology).unwrap();
    let velocity: Vec<Vec3> = blocks.rest_position.iter().map(|x| Vec3::new(1.0 / 3.0, -x.z, x.y)).collect();
    for frame in 0..4 {
        let time_s = 0.1 * f64::from(frame);
        let displacement: Vec<Vec3> = velocity.iter().map(|v| time_s * v).collect();
        let position: Vec<Vec3> =
            blocks.rest_position.iter().zip(&displacement).map(|(x, u)| x + u).collect();
        let factors = || (0..blocks.tets.len()).map(|tet| time_s * tet as f64);
        let stress_pa = factors().map(|factor| [1.0, 2.0, 3.0, 4.0, 5.0, 6.0].map(|s| s * factor));
        // √(½ [1 + 1 + 4] + 3 [16 + 25 + 36])
        let von_mises_pa = factors().map(|factor| [234f64.sqrt() * factor]);
        let mut frame = Frame::new(&blocks, &position);
        let precision = Precision::F64;
        frame.add_points(Values::vectors("displacement_m", displacement.iter().copied(), precision));
        frame.add_points(Values::vectors("velocity_m_s", velocity.iter().copied(), precision));
        frame.add_cells(Values::new("von_mises_pa", von_mises_pa, precision));
        frame.add_cells(Values::new("stress_pa", stress_pa, precision));
        series.push(time_s, &frame).unwrap();
    }
    assert_eq!(series.times_s().len(), 4);
    assert!(output.fields_index().is_file());
}
