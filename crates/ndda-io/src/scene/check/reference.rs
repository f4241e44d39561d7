//! Checks of closed forms to compare with.

use super::Check;
use crate::scene::Reference;

impl Check<'_> {
    pub(super) fn reference(&mut self) {
        let scene = self.scene;
        let monitors: Vec<&str> = scene.monitors.iter().map(|m| m.name.as_str()).collect();
        let path = |field: &str| format!("reference.{field}");
        match &scene.reference {
            Some(Reference::SlidingBlock {
                monitor,
                downhill,
                slope_deg,
                friction_deg,
                thickness_m,
                after_s,
            }) => {
                self.known(path("monitor"), "monitor", monitor, &monitors);
                self.direction(path("downhill"), downhill);
                if !(*slope_deg > 0.0 && *slope_deg < 90.0) {
                    self.error(
                        path("slope_deg"),
                        format!("{slope_deg}°: must be between 0 and 90"),
                        "α of the ramp",
                    );
                }
                if !(0.0..90.0).contains(friction_deg) {
                    let message = format!("{friction_deg}°: must be from 0 to below 90");
                    self.error(path("friction_deg"), message, "as in `contact`");
                }
                if slope_deg.to_radians().tan() <= friction_deg.to_radians().tan() {
                    let message = "the block does not slide: the closed form is 0 and has no relative error";
                    self.misfit(path("friction_deg"), message, "choose slope_deg larger than friction_deg");
                }
                if let Some(thickness) = thickness_m {
                    self.positive(path("thickness_m"), *thickness, "m");
                }
                self.after(*after_s);
            }
            Some(Reference::Collision { first, second, along, after_s }) => {
                self.known_block(path("first"), first);
                self.known_block(path("second"), second);
                self.direction(path("along"), along);
                self.after(*after_s);
            }
            Some(Reference::FreeFall { monitor, after_s }) => {
                self.known(path("monitor"), "monitor", monitor, &monitors);
                self.after(*after_s);
            }
            Some(Reference::FreeSpin { block }) => self.known_block(path("block"), block),
            Some(Reference::BarImpact { block, along, length_m, gap_m, after_s }) => {
                self.bar_impact(block, *length_m, *gap_m);
                self.direction(path("along"), along);
                self.after(*after_s);
            }
            Some(Reference::Displacement { monitor, displacement_m, after_s }) => {
                self.known(path("monitor"), "monitor", monitor, &monitors);
                self.direction(path("displacement_m"), displacement_m);
                self.after(*after_s);
            }
            None => {}
        }
    }

    fn bar_impact(&mut self, block: &str, length_m: f64, gap_m: f64) {
        self.known_block("reference.block".into(), block);
        self.positive("reference.length_m".into(), length_m, "m");
        if !(gap_m >= 0.0 && gap_m.is_finite()) {
            let message = format!("{gap_m} m: must not be negative");
            self.error("reference.gap_m", message, "0 for a bar that touches the wall");
        }
        let scene = self.scene;
        let material = scene.blocks.iter().find(|b| b.name == block).map(|b| &b.material);
        let poisson = scene.materials.iter().find(|m| Some(&m.name) == material).map(|m| m.poisson);
        if poisson.is_some_and(|poisson| poisson != 0.0) {
            let help = "set the bar's `poisson` to 0";
            self.misfit("reference", "the closed form is that of a bar without lateral strain", help);
        }
    }

    fn after(&mut self, after_s: f64) {
        let end_s = self.scene.time.end_s;
        if !(0.0..end_s).contains(&after_s) {
            let message = format!("{after_s} s is outside the run, which ends at {end_s} s");
            self.error("reference.after_s", message, "the largest error is taken from here to the end");
        }
    }
}
