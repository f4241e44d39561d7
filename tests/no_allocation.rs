//! The step after warm-up allocates nothing.
#![allow(unsafe_code)] // a global allocator cannot be had without

use std::alloc::{GlobalAlloc, Layout, System};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use ndda::Model;

/// Counts every request for memory of the whole process.
struct Counting;

static REQUESTS: AtomicUsize = AtomicUsize::new(0);

// SAFETY: every call is handed to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        REQUESTS.fetch_add(1, Ordering::Relaxed);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        unsafe { System.dealloc(memory, layout) }
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        REQUESTS.fetch_add(1, Ordering::Relaxed);
        unsafe { System.realloc(memory, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Requests for memory in `steps` steps of a scene after `warm_up` steps; the fewest of three such runs of steps, since a
/// thread of the pool that comes to work late makes room for itself once.
fn requests((scene, set): (&str, &[&str]), threads: usize, warm_up: usize, steps: usize) -> usize {
    let set: Vec<String> = set.iter().map(|set| (*set).into()).collect();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{scene}.ron"));
    let mut simulation = Model::open(&scene, &set).unwrap().simulation;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    // Threads make room for themselves when they start.
    pool.broadcast(|_| ());
    pool.install(|| {
        for _ in 0..warm_up {
            simulation.step().unwrap();
        }
        let mut run = || {
            let before = REQUESTS.load(Ordering::Relaxed);
            for _ in 0..steps / 2 {
                simulation.step().unwrap();
            }
            REQUESTS.load(Ordering::Relaxed) - before
        };
        run().min(run()).min(run())
    })
}

// One test: the counter belongs to the process, and tests run side by side.
#[test]
fn a_warm_step_with_contact_friction_and_supports_allocates_nothing() {
    let damped: &[&str] = &["contact.restitution=0.5"];
    for (scene, set, warm_up, steps) in [
        ("sliding_45_phi35", &[][..], 2000, 2000),
        ("collision_equal", &[], 2500, 200),
        ("spinning_block", &[], 5, 1000),
        ("sticking_30_phi35", &[], 50, 1000),
        ("sticking_30_phi35", damped, 500, 500),
        ("sticking_30_phi35_spring", damped, 500, 500),
        ("safety/plane_water", &[], 50, 1000),
        ("works/quiet_column", &[], 50, 1000),
    ] {
        for threads in [1, 2] {
            assert_eq!(
                requests((scene, set), threads, warm_up, steps),
                0,
                "{scene} {set:?} on {threads} thread(s)"
            );
        }
    }
}
