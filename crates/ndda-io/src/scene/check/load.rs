//! Checks of tractions and forces.

use super::Check;
use crate::scene::Reference;
use crate::scene::turning::Rows;
use crate::scene::{ContactAt, FactorRow, SettleDamping};

impl Check<'_> {
    pub(super) fn loads(&mut self) {
        let scene = self.scene;
        if let Some(in_situ) = &scene.in_situ {
            self.numbers("in_situ.at_m", &in_situ.at_m);
            for (i, gradient) in in_situ.gradients.iter().enumerate() {
                self.direction(format!("in_situ.gradients[{i}].along"), &gradient.along);
            }
        }
        if !(scene.gravity_ramp_s >= 0.0 && scene.gravity_ramp_s.is_finite()) {
            let message = format!("{} s: must not be negative", scene.gravity_ramp_s);
            self.error("gravity_ramp_s", message, "0 applies gravity suddenly");
        }
        if scene.gravity_ramp_s > 0.0
            && matches!(scene.reference, Some(Reference::SlidingBlock { .. } | Reference::FreeFall { .. }))
        {
            let help = "leave out the ramp or the reference";
            self.misfit("gravity_ramp_s", "the closed form of `reference` has gravity act at once", help);
        }
        if let Some(settle) = scene.settle {
            if !(0.0 < settle.tolerance && settle.tolerance < 1.0) {
                let message = format!("{}: must be between 0 and 1", settle.tolerance);
                self.error("settle.tolerance", message, "1e-4 leaves a ten-thousandth of the largest speed");
            }
            if settle.most_steps == 0 {
                let help = "1000000 is the default; leave `settle` out for a run that begins without rest";
                self.error("settle.most_steps", "0 steps bring nothing to rest", help);
            }
            if let Some(SettleDamping::Local { factor }) = settle.damping
                && !(0.0 < factor && factor <= 1.0)
            {
                let message = format!("{factor}: must be above 0 and at most 1");
                self.error("settle.damping.factor", message, "0.8 is usual");
            }
            if settle.mass_scaling == Some(true) && matches!(scene.time.contact_at, ContactAt::End { .. }) {
                let help = "leave out `mass_scaling`, or write `contact_at: Predicted`";
                self.misfit("settle.mass_scaling", "contact at the end of the step needs true masses", help);
            }
            if scene.gravity_ramp_s > 0.0 {
                let help = "leave out gravity_ramp_s, so that the run begins at rest under full gravity; or leave out settle";
                self.misfit("gravity_ramp_s", "a scene settles under its full weight, without a ramp", help);
            }
        }
        for (i, force) in scene.forces.iter().enumerate() {
            self.known_blocks(format!("forces[{i}].block"), &force.block);
            self.numbers(&format!("forces[{i}].at_m"), force.at_m.as_slice().as_flattened());
            self.numbers(&format!("forces[{i}].force_n"), &force.force_n);
            self.factor(&format!("forces[{i}].factor"), &force.factor);
        }
        for (i, traction) in scene.tractions.iter().enumerate() {
            self.known_blocks(format!("tractions[{i}].block"), &traction.block);
            self.region(&format!("tractions[{i}].on"), &traction.on);
            self.numbers(&format!("tractions[{i}].traction_pa"), &traction.traction_pa);
            self.factor(&format!("tractions[{i}].factor"), &traction.factor);
        }
        self.water();
    }

    pub(super) fn factor(&mut self, path: &str, rows: &[FactorRow]) {
        if let Some(i) = (1..rows.len()).find(|&i| rows[i].time_s <= rows[i - 1].time_s) {
            let message = format!("{} s does not come after {} s", rows[i].time_s, rows[i - 1].time_s);
            self.error(format!("{path}[{i}].time_s"), message, "sort the rows by time_s");
        }
        self.turns(path, &Rows::of_factor(rows));
    }
}
