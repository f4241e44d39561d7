//! A contact model of a fork: blocks as points on linear springs. See docs/swapping-a-crate.md.

use std::path::Path;

use ndda::build;
use ndda_contact::testing::check_model;
use ndda_contact::{ContactError, ContactHistory, ContactInput, ContactModel, ContactOutput, ContactReport};
use ndda_mesh::{BlockId, Vec3};

/// Every two blocks repel along the line of their mean points x̄ while these are nearer than `reach_m`:
/// f = k (reach − |x̄_b − x̄_a|), spread evenly over the nodes.
struct LinearSprings {
    stiffness_n_m: f64,
    reach_m: f64,
}

impl LinearSprings {
    /// Unit vector from a to b and compression [m] of every spring that is compressed.
    fn for_each_spring(&self, input: &ContactInput, mut spring: impl FnMut(BlockId, BlockId, Vec3, f64)) {
        let mean = |block: BlockId| {
            let nodes = input.blocks.nodes_of(block);
            input.position[nodes.clone()].iter().sum::<Vec3>() / nodes.len() as f64
        };
        for a in input.blocks.ids() {
            for b in input.blocks.ids().skip(a.index() + 1) {
                let line = mean(b) - mean(a);
                let compression_m = self.reach_m - line.norm();
                if compression_m > 0.0 {
                    spring(a, b, line.normalize(), compression_m);
                }
            }
        }
    }
}

impl ContactModel for LinearSprings {
    fn add_forces(
        &mut self,
        input: &ContactInput,
        _history: &mut ContactHistory,
        output: &mut ContactOutput,
    ) -> Result<ContactReport, ContactError> {
        let mut report = ContactReport::default();
        self.for_each_spring(input, |a, b, line, compression_m| {
            let force = self.stiffness_n_m * compression_m * line;
            for (block, total) in [(a, -force), (b, force)] {
                let nodes = input.blocks.nodes_of(block);
                let share = 1.0 / nodes.len() as f64;
                output.force[nodes.clone()].iter_mut().for_each(|f| *f += share * total);
                output.stiffness[nodes].iter_mut().for_each(|k| *k += share * self.stiffness_n_m);
            }
            report.contact_pairs += 1;
        });
        report.candidate_pairs = report.contact_pairs;
        Ok(report)
    }

    fn energy_j(&mut self, input: &ContactInput, _history: &ContactHistory) -> Result<f64, ContactError> {
        let mut energy_j = 0.0;
        self.for_each_spring(input, |_, _, _, compression_m| {
            energy_j += 0.5 * self.stiffness_n_m * compression_m * compression_m;
        });
        Ok(energy_j)
    }
}

#[test]
fn the_model_of_a_fork_keeps_the_contract() {
    check_model(&mut LinearSprings { stiffness_n_m: 1e6, reach_m: 0.9 });
}

#[test]
fn two_blocks_on_the_model_of_a_fork_exchange_their_velocities() {
    let scene = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/collision_equal_free.ron");
    let loaded = ndda_io::read::load(&scene, &["time.step_s=1e-4".into()]).unwrap();
    let blocks = build::blocks(&loaded.scene, scene.parent().unwrap()).unwrap();
    let model = LinearSprings { stiffness_n_m: 1e8, reach_m: 1.0 };
    let mut simulation =
        build::simulation_with(&loaded.scene, blocks, Path::new("."), Some(Box::new(model))).unwrap();
    // Met after 20 ms, apart half a period π √(m/2k) = 11 ms later.
    for _ in 0..400 {
        simulation.step().unwrap();
    }
    let mean = |block: BlockId| {
        let operator = &simulation.shape(block).operator;
        let nodes = simulation.blocks().nodes_of(block);
        operator.momentum(&simulation.state().velocity[nodes]) / operator.mass_kg
    };
    let (a, b) = (mean(BlockId(0)), mean(BlockId(1)));
    assert!((a - Vec3::zeros()).norm() < 1e-4 && (b - Vec3::x()).norm() < 1e-4, "{a:?} {b:?}");
}
