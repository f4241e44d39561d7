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
