//! Resultants of each pair of touching blocks, as rows of a table.

use ndda_contact::{FacetContact, resultants};
use ndda_solver::Simulation;

/// Columns of the table; blocks are numbered from 0 in the order of `block_id` and of the summary.
pub const COLUMNS: [&str; 18] = [
    "time_s",
    "first_block",
    "second_block",
    "force_x_n",
    "force_y_n",
    "force_z_n",
    "friction_x_n",
    "friction_y_n",
    "friction_z_n",
    "center_x_m",
    "center_y_m",
    "center_z_m",
    "moment_x_n_m",
    "moment_y_n_m",
    "moment_z_n_m",
    "area_m2",
    "depth_m",
    "sliding",
];

/// The pairs that touched in the last step, a row of [`COLUMNS`] each; `facets` is room for them.
pub fn contact_rows(simulation: &Simulation, facets: &mut Vec<FacetContact>) -> Vec<[f64; COLUMNS.len()]> {
    let (time_s, blocks) = (simulation.time_s(), simulation.blocks());
    facets.clear();
    facets.extend_from_slice(simulation.contacts());
    let pairs = resultants(blocks, facets).into_iter();
    pairs
        .map(|pair| {
            let center = pair.center + blocks.origin_m;
            let (f, t, m) = (pair.force_n, pair.friction_n, pair.moment_n_m);
            let (first, second) = (f64::from(pair.first.0), f64::from(pair.second.0));
            [
                time_s,
                first,
                second,
                f.x,
                f.y,
                f.z,
                t.x,
                t.y,
                t.z,
                center.x,
                center.y,
                center.z,
                m.x,
                m.y,
                m.z,
                pair.area_m2,
                pair.depth_m,
                pair.sliding,
            ]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use ndda_mesh::{BlockId, Vec3};
    use ndda_solver::{Sink, SinkError, View};

    use super::*;
    use crate::{Model, Run};

    /// Impulse of contact on the first block and its moment about the origin, by the rows, and how both have changed by the motion; the largest part that slid.
    #[derive(Default)]
    struct Impulses {
        by_rows: [Vec3; 2],
        by_motion: Vec<[Vec3; 2]>,
        most_sliding: f64,
        largest_moment: f64,
    }

    impl Sink for Impulses {
        fn wants_contacts(&self, _: u64) -> bool {
            true
        }

        fn step_done(&mut self, view: &mut View) -> Result<ControlFlow<()>, SinkError> {
            let simulation = &*view.simulation;
            let (block, state) = (BlockId(0), simulation.state());
            let (nodes, operator) = (simulation.blocks().nodes_of(block), &simulation.shape(block).operator);
            let (position, velocity) = (&state.position[nodes.clone()], &state.velocity[nodes]);
            let turn = operator.angular_momentum(&Vec3::zeros(), position, velocity);
            self.by_motion.push([operator.momentum(velocity), turn]);
            let dt_s = simulation.step_s();
            for row in contact_rows(simulation, &mut Vec::new()) {
                let [.., area_m2, _, sliding] = row;
                let [force, center, moment] = [3, 9, 12].map(|k| Vec3::new(row[k], row[k + 1], row[k + 2]));
                let center = center - simulation.blocks().origin_m;
                self.by_rows[0] += dt_s * force;
                self.by_rows[1] += dt_s * (center.cross(&force) + moment);
                self.largest_moment = self.largest_moment.max(moment.norm());
                self.most_sliding = self.most_sliding.max(if area_m2 > 0.0 { sliding } else { 0.0 });
            }
            Ok(ControlFlow::Continue(()))
        }
    }

    #[test]
    fn rows_of_contacts_have_all_impulse_and_moment_by_which_a_block_changes_its_motion() {
        for (body, contact) in [
            ("Rigid", "friction: (friction_deg: 30)"),
            ("Rigid", "friction: (friction_deg: 30), restitution: 0.5"),
            ("Rigid", "restitution: 0.5"),
            ("Rigid", "friction: (friction_deg: 30, shear_penalty_pa_m: 1e10)"),
            ("Elastic", "friction: (friction_deg: 30)"),
            ("Affine", "friction: (friction_deg: 30), restitution: 0.5"),
        ] {
            let text = format!(
                "(title: \"a slab turns on a block\", time: (step_s: 1e-4, end_s: 0.02),
                materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.25, density_kg_m3: 2600)],
                blocks: [
                    (name: \"slab\", material: \"rock\", body: {body}, shape: Box(size_m: (1, 1, 0.4), cells: (2, 2, 1)), at_m: (0, 0, 1),
                        velocity_m_s: (0.05, 0.02, -0.1), spin_rad_s: (0.02, 0.01, 0.5)),
                    (name: \"block\", material: \"rock\", body: {body}, shape: Box(size_m: (2, 2, 1), cells: (2, 2, 1)), at_m: (-0.4, -0.6, 0)),
                ],
                contact: Potential(penalty_pa: 1e8, potential: Smooth(), {contact}))"
            );
            let mut impulses = Impulses::default();
            Run::new(Model::from_text(&text).unwrap()).finish(&mut [&mut impulses]).unwrap();
            let (first, last) = (impulses.by_motion[0], impulses.by_motion[impulses.by_motion.len() - 1]);
            let most_moment_n_m_s = 0.02 * impulses.largest_moment;
            for k in 0..2 {
                let change = last[k] - first[k];
                let differs = (impulses.by_rows[k] - change).norm();
                let size = change.norm().max(most_moment_n_m_s);
                assert!(differs < 1e-6 * size, "{body}, {contact}: {} and {change}", impulses.by_rows[k]);
            }
            assert!(impulses.most_sliding > 0.5, "{body}, {contact}: {}", impulses.most_sliding);
        }
    }
}
