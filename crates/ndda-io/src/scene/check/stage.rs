//! Checks of stages of construction.

use std::path::Path;

use super::{Check, Code, MOST_STEPS, problems};
use crate::scene::{
    By, Contact, Integrator, Ramp, Scene, SettleDamping, Stage, Support, Then, is_unset, matches,
};

impl Check<'_> {
    pub(super) fn stages(&mut self, folder: Option<&Path>) {
        let scene = self.scene;
        if scene.stages.is_empty() {
            return;
        }
        let names: Vec<&str> = scene.stages.iter().map(|stage| stage.name.as_str()).collect();
        self.names("stages", &names);
        self.names_apart_in_case(&names);
        if !matches!(scene.time.integrator, Integrator::Midpoint { .. }) {
            let message = "this integrator carries accelerations from step to step, and they jump when a stage takes blocks out";
            self.misfit("time.integrator", message, "use Midpoint() in a scene with stages");
        }
        if scene.reference.is_some() {
            let help = "leave out the reference, or the stages";
            self.misfit("reference", "no closed form follows a scene through its stages", help);
        }
        for (k, stage) in scene.stages.iter().enumerate() {
            self.stage(k, stage);
            self.in_stage(k, stage, folder);
        }
        self.bolts_in_stages();
    }

    /// Bolts are installed once, and released once after that.
    fn bolts_in_stages(&mut self) {
        let scene = self.scene;
        let mut times = vec![[None; 2]; scene.bolts.len()];
        for (k, stage) in scene.stages.iter().enumerate() {
            let install = stage.install.iter().enumerate().map(|(i, pattern)| ("install", i, pattern));
            let release = stage.release.iter().enumerate().map(|(i, pattern)| ("release", i, pattern));
            for (list, i, pattern) in install.chain(release) {
                let path = format!("stages[{k}].{list}[{i}]");
                let is_named = |bolt: &usize| matches(pattern, &scene.bolts[*bolt].name);
                let named: Vec<usize> = (0..scene.bolts.len()).filter(is_named).collect();
                if named.is_empty() {
                    self.unknown_bolts(&path, pattern);
                }
                for bolt in named {
                    if let Some(message) = self.repeated(bolt, (k, list), times[bolt]) {
                        let help = "each entry is installed once and released once: give `bolts` a second entry for a second time";
                        self.misfit(&path, message, help);
                    }
                    times[bolt][usize::from(list == "release")].get_or_insert(k);
                }
            }
        }
    }

    /// Why stage `k` cannot install or release these bolts: they have been installed or released before, in the stages `times`.
    fn repeated(&self, bolt: usize, (k, list): (usize, &str), times: [Option<usize>; 2]) -> Option<String> {
        let (name, stages) = (&self.scene.bolts[bolt].name, &self.scene.stages);
        let in_stage = |k: usize| format!("stage `{}`", stages[k].name);
        match (list, times) {
            ("install", [Some(first), _]) => {
                Some(format!("bolts `{name}` are installed in {} already", in_stage(first)))
            }
            ("install", [None, Some(first)]) => {
                Some(format!("{} releases bolts `{name}` before they are installed", in_stage(first)))
            }
            ("release", [_, Some(first)]) => {
                Some(format!("bolts `{name}` are released in {} already", in_stage(first)))
            }
            ("release", [Some(first), None]) if first == k => {
                Some(format!("bolts `{name}` are installed in this stage"))
            }
            _ => None,
        }
    }

    fn unknown_bolts(&mut self, path: &str, pattern: &str) {
        let names: Vec<&str> = self.scene.bolts.iter().map(|bolt| bolt.name.as_str()).collect();
        let help = match names.is_empty() {
            true => "the scene has no `bolts`".into(),
            false => format!("the entries of `bolts` are {}", names.join(", ")),
        };
        self.report(Code::UnknownName, path, format!("there are no bolts `{pattern}`"), help);
    }

    /// Refuses names that differ in case only: each becomes the name of a checkpoint, and not every file system tells them apart.
    fn names_apart_in_case(&mut self, names: &[&str]) {
        for (i, name) in names.iter().enumerate() {
            let is_like = |other: &&&str| *other != name && other.to_lowercase() == name.to_lowercase();
            if let Some(other) = names[..i].iter().find(is_like) {
                let message = format!("the names `{other}` and `{name}` differ in case only");
                let help =
                    "stages write files by these names, which some systems do not tell apart: change one";
                self.report(Code::BadName, format!("stages[{i}].name"), message, help);
            }
        }
    }

    fn stage(&mut self, k: usize, stage: &Stage) {
        let path = |field: &str| format!("stages[{k}].{field}");
        for (list, patterns) in [("remove", &stage.remove), ("add", &stage.add)] {
            for (i, pattern) in patterns.iter().enumerate() {
                self.known_blocks(path(&format!("{list}[{i}]")), pattern);
            }
        }
        if !(stage.over_s >= 0.0 && stage.over_s.is_finite()) {
            let message = format!("{} s: must not be negative", stage.over_s);
            self.error(path("over_s"), message, "0 changes everything at once");
        }
        match stage.then {
            Then::Run(run_s) => {
                self.positive(path("then"), run_s, "s");
                if stage.over_s > run_s && run_s > 0.0 {
                    let message = format!("{} s are longer than the stage, {run_s} s", stage.over_s);
                    self.misfit(
                        path("over_s"),
                        message,
                        "Run(…) is measured from the beginning of the stage: make it longer",
                    );
                }
                let step_s = self.scene.time.step_s;
                if !is_unset(&step_s) && run_s / step_s > MOST_STEPS {
                    let message = format!("{:.1e} steps", run_s / step_s);
                    self.error(path("then"), message, "at most 1e9 steps are taken: make the stage shorter");
                }
            }
            Then::Settle { tolerance, most_steps, damping, ramp } => {
                let supports = stage.supports.as_ref().unwrap_or(&self.scene.supports);
                let moved = supports.iter().find(|support| support.hold.is_moved());
                if let (Some(support), Ramp::Damped, true) = (moved, ramp, stage.over_s > 0.0) {
                    let message = format!(
                        "a damped ramp takes `{}`, which a support moves, to its new place without its velocity, so that what lies on it is left behind",
                        support.block
                    );
                    let help = "write `ramp: Dynamic`, or leave over_s out";
                    self.misfit(path("then.ramp"), message, help);
                }
                if !(0.0 < tolerance && tolerance < 1.0) {
                    let message = format!("{tolerance}: must be between 0 and 1");
                    self.error(
                        path("then.tolerance"),
                        message,
                        "1e-4 leaves a ten-thousandth of the largest speed",
                    );
                }
                if most_steps == 0 {
                    let help = "1000000 is the default; Run(…) goes on without coming to rest";
                    self.error(path("then.most_steps"), "0 steps bring nothing to rest", help);
                }
                if let Some(SettleDamping::Local { factor }) = damping
                    && !(0.0 < factor && factor <= 1.0)
                {
                    let message = format!("{factor}: must be above 0 and at most 1");
                    self.error(path("then.damping.factor"), message, "0.8 is usual");
                }
            }
        }
        if stage.laws.is_some() && !matches!(self.scene.contact, Some(Contact::Potential { .. })) {
            self.misfit(
                path("laws"),
                "the scene has no contact whose laws could change",
                "give contact: Potential(…)",
            );
        }
    }

    /// Checks the supports, loads and laws of a stage as those of a scene are checked.
    fn in_stage(&mut self, k: usize, stage: &Stage, folder: Option<&Path>) {
        let scene = Scene { stages: Vec::new(), ..self.scene.in_stage(k + 1) };
        for mut found in problems(&scene, folder) {
            if let Some(path) = stage.path_of(k, &found.path) {
                found.path = path;
                self.found.push(found);
            }
        }
        let known = self.scene.in_stage(k).supports;
        let is_new = |support: &&Support| {
            (support.hold.is_moved() || matches!(support.by, By::Springs { .. })) && !known.contains(support)
        };
        let Some(i) = scene.supports.iter().position(|support| is_new(&support)) else { return };
        if let Some(path) = stage.path_of(k, &format!("supports[{i}]")) {
            let message = "springs and motions count from the start of the run and cannot begin with a stage";
            let help = "hold nodes where they are (Fixed, Normal, Direction), or give it in the scene's own `supports`";
            self.misfit(path, message, help);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::read::load_text;

    #[test]
    fn a_damped_ramp_is_refused_where_a_support_moves_in_it() {
        let refused = |ramp: &str, over_s: &str| {
            let text = format!(
                "(title: \"t\", time: (step_s: 1e-4, end_s: 0.1), gravity_m_s2: (0, 0, -9.81),
                materials: [(name: \"rock\", density_kg_m3: 2700, young_pa: 2e10, poisson: 0.2)],
                blocks: [
                    (name: \"base\", material: \"rock\", body: Fixed, at_m: (0, 0, -1), shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))),
                    (name: \"a\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))),
                ],
                supports: [(block: \"base\", on: All, hold: Motion([(time_s: 0, displacement_m: (0, 0, 0)), (time_s: 2, displacement_m: (0.02, 0, 0))]))],
                contact: Potential(penalty_pa: 1e9, friction: (friction_deg: 30)),
                stages: [(name: \"move\"{over_s}, then: Settle({ramp}))])"
            );
            load_text("s.ron", &text, &[], None).err().map(|errors| errors.to_string())
        };
        let message = refused("ramp: Damped", ", over_s: 1").expect("an error");
        assert!(message.contains("without its velocity") && message.contains("ramp: Dynamic"), "{message}");
        assert_eq!(refused("ramp: Damped", ""), None);
        assert_eq!(refused("ramp: Dynamic", ", over_s: 1"), None);
    }
}
