//! Checks of blocks.

use std::path::Path;

use super::{Check, LIGHT_M_S, MOST_NODES};
use crate::scene::Body;

impl Check<'_> {
    pub(super) fn blocks(&mut self, folder: Option<&Path>) {
        let scene = self.scene;
        if scene.blocks.is_empty() && scene.rock.is_empty() && scene.rockfall.is_none() {
            self.misfit("blocks", "there is no block", "a scene has `blocks`, `rock` or `rockfall`");
        }
        self.names("blocks", &scene.blocks.iter().map(|b| b.name.as_str()).collect::<Vec<_>>());
        let materials: Vec<&str> = scene.materials.iter().map(|m| m.name.as_str()).collect();
        for (i, block) in scene.blocks.iter().enumerate() {
            let path = |field: &str| format!("blocks[{i}].{field}");
            self.known(path("material"), "material", &block.material, &materials);
            for (k, turn) in block.turns.iter().enumerate() {
                self.direction(path(&format!("turns[{k}].axis")), &turn.axis);
                self.numbers(&path(&format!("turns[{k}].angle_deg")), &[turn.angle_deg]);
            }
            self.numbers(&path("at_m"), &block.at_m);
            self.numbers(&path("velocity_m_s"), &block.velocity_m_s);
            if block.velocity_m_s.iter().any(|v| v.abs() > LIGHT_M_S) {
                self.error(path("velocity_m_s"), "is faster than light", "the unit is metres per second");
            }
            self.numbers(&path("spin_rad_s"), &block.spin_rad_s);
            if matches!(block.body, Body::Rigid | Body::Fixed) && block.initial_stress_pa.is_some() {
                let help = "leave it out, or make the body Elastic or Affine";
                self.misfit(path("initial_stress_pa"), "a block that does not deform has no stress", help);
            }
            if block.body == Body::Fixed && (block.velocity_m_s, block.spin_rad_s) != ([0.0; 3], [0.0; 3]) {
                let help = "leave it out, or give the block a support with a Motion";
                self.misfit(path("velocity_m_s"), "a fixed block does not start with a velocity", help);
            }
            self.shape(&path("shape"), &block.shape, folder);
        }
    }

    pub(super) fn cells(&mut self, path: &str, cells: &[u32]) {
        let nodes: f64 = cells.iter().map(|&n| f64::from(n) + 1.0).product();
        for (i, _) in cells.iter().enumerate().filter(|(_, n)| **n == 0) {
            self.error(format!("{path}.cells[{i}]"), "0 cells", "at least one cell is needed");
        }
        if nodes > MOST_NODES {
            self.error(format!("{path}.cells"), format!("about {nodes:.1e} nodes"), "at most 5e7 are made");
        }
    }
}
