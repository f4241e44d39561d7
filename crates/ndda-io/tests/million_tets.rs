//! Time and memory to read a mesh of a million tetrahedra. Measures, asserts no time:
//! `cargo test --release -p ndda-io --test million_tets -- --ignored --nocapture`.

use std::fs;
use std::time::Instant;

use ndda_io::mesh_file::{read, write};
use ndda_mesh::generate::{BoxPattern, box_block};

/// Most memory that the process held since the last [`forget_peak`] [MiB]; 0 where the system does not report it.
fn peak_mib() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|kib| kib.trim().trim_end_matches(" kB").parse::<u64>().ok()).unwrap_or(0) / 1024
}

/// Linux counts the peak anew from here.
fn forget_peak() {
    drop(fs::write("/proc/self/clear_refs", "5"));
}

#[test]
#[ignore = "measures; takes seconds and 1 GB of disk"]
fn a_million_tetrahedra_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let mut bodies = vec![("body".to_string(), box_block([1.0; 3], [56, 56, 54], BoxPattern::Six).unwrap())];
    bodies[0].1.node_sets.clear();
    for ending in ["msh", "ele", "vtu", "inp"] {
        let path = folder.path().join("a").with_extension(ending);
        let start = Instant::now();
        write(&path, &bodies).unwrap();
        let wrote_s = start.elapsed().as_secs_f64();
        forget_peak();
        let (before, start) = (peak_mib(), Instant::now());
        let found = read(&path).unwrap().bodies;
        let (read_s, peak) = (start.elapsed().as_secs_f64(), peak_mib());
        assert_eq!(found[0].1.tets.len(), bodies[0].1.tets.len());
        let size = fs::metadata(&path).unwrap().len() >> 20;
        println!(
            ".{ending}: {} tetrahedra, {size} MiB: written in {wrote_s:.2} s, read in {read_s:.2} s, \
             peak {peak} MiB ({} above the mesh before)",
            found[0].1.tets.len(),
            peak - before
        );
    }
}
