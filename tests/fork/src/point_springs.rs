//! A contact model from scratch: blocks as points that repel each other.

use ndda_contact::{
    ContactAudit, ContactError, ContactHistory, ContactInput, ContactModel, ContactOutput, ContactReport,
};
use ndda_mesh::{BlockId, Vec3};

/// Every two blocks repel along the line of their mean points x̄ while these are nearer than `reach_m`:
/// f = k (reach − |x̄_b − x̄_a|), spread evenly over the nodes.
pub struct PointSprings {
    /// k [N/m].
    pub stiffness_n_m: f64,
    /// Reach [m].
    pub reach_m: f64,
}

impl PointSprings {
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

impl ContactAudit for PointSprings {}

impl ContactModel for PointSprings {
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

#[cfg(test)]
mod tests {
    use super::*;
    use ndda_contact::testing::check_model;

    #[test]
    fn it_keeps_the_contract_of_a_contact_model() {
        check_model(&mut PointSprings { stiffness_n_m: 1e6, reach_m: 0.9 });
    }

    /// Met after 20 ms, apart half a period π √(m/2k) = 11 ms later.
    #[test]
    fn two_equal_blocks_exchange_their_velocities() {
        let scene =
            std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/collision_equal_free.ron");
        let loaded = ndda_io::read::load(&scene, &["time.step_s=1e-4".into()]).unwrap();
        let contact = PointSprings { stiffness_n_m: 1e8, reach_m: 1.0 };
        let choices = ndda::build::Choices { contact: Some(Box::new(contact)), ..Default::default() };
        let model = ndda::Model::with(loaded, scene.parent().unwrap(), choices).unwrap();
        let outcome = ndda::Run::new(model).finish(&mut []).unwrap();
        let along = |monitor: &str| outcome.monitor(monitor).unwrap().velocity[0];
        let (first, second) = (along("centre_A"), along("centre_B"));
        assert!(first.abs() < 1e-4 && (second - 1.0).abs() < 1e-4, "{first} and {second} m/s");
    }

    /// Presses one block only.
    #[test]
    #[should_panic(expected = "forces do not balance")]
    fn a_model_without_reaction_is_found_out() {
        struct OneSided(PointSprings);
        impl ContactAudit for OneSided {}
        impl ContactModel for OneSided {
            fn add_forces(
                &mut self,
                input: &ContactInput,
                history: &mut ContactHistory,
                output: &mut ContactOutput,
            ) -> Result<ContactReport, ContactError> {
                let report = self.0.add_forces(input, history, output);
                output.force[input.blocks.nodes_of(BlockId(0))].fill(Vec3::zeros());
                report
            }

            fn energy_j(
                &mut self,
                input: &ContactInput,
                history: &ContactHistory,
            ) -> Result<f64, ContactError> {
                self.0.energy_j(input, history)
            }
        }
        check_model(&mut OneSided(PointSprings { stiffness_n_m: 1e6, reach_m: 0.9 }));
    }
}
