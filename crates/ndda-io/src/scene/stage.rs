//! Stages of construction of a scene.

use serde::{Deserialize, Serialize};

use super::{
    Contact, Force, Friction, JointLaw, MaterialPair, Scene, Settle, SettleDamping, Support, Traction, Water,
};

/// A stage of construction: blocks are taken out and added, bolts installed and released, supports, loads and laws change, then time goes on or the scene comes to rest.
///
/// Stages follow each other after `time.end_s`. What a stage changes stays changed in those after it; lists replace the whole list.
///
/// ```text
/// stages: [
///     (name: "heading", remove: ["heading_*"], over_s: 0.05, then: Settle()),
///     (name: "bolts", install: ["roof_bolts"], then: Settle()),
///     (name: "lining", add: ["lining_*"], then: Settle()),
///     (name: "bench", remove: ["bench_*"], over_s: 0.05, reset_displacements: true, then: Run(0.5)),
/// ],
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Stage {
    /// Its name, that of its checkpoint and of its row in the summary.
    pub name: String,
    /// Blocks that are taken out, by name, or many as in a support. Default: none.
    #[serde(default)]
    pub remove: Vec<String>,
    /// Blocks that are put in, without stress and at rest where they were meshed; until then they are not there. Default: none.
    #[serde(default)]
    pub add: Vec<String>,
    /// Bolts that are installed in the rock as it lies when the stage begins, by the name of their entry in `bolts`, or many as in a support; until
    /// then they are not there. Default: none.
    #[serde(default)]
    pub install: Vec<String>,
    /// Bolts that are let go; their forces ramp down over `over_s`. Default: none.
    #[serde(default)]
    pub release: Vec<String>,
    /// Supports from now on, in the place of all before. Default: as before.
    #[serde(default)]
    pub supports: Option<Vec<Support>>,
    /// Tractions from now on, in the place of all before. Default: as before.
    #[serde(default)]
    pub tractions: Option<Vec<Traction>>,
    /// Forces from now on, in the place of all before. Default: as before.
    #[serde(default)]
    pub forces: Option<Vec<Force>>,
    /// Water from now on, in the place of all before. Default: as before.
    #[serde(default)]
    pub water: Option<Vec<Water>>,
    /// Gravity from now on [m/s²]. Default: as before.
    #[serde(default)]
    pub gravity_m_s2: Option<[f64; 3]>,
    /// Laws of contact from now on. Default: as before.
    #[serde(default)]
    pub laws: Option<StageLaws>,
    /// Time over which forces of removed blocks and released bolts fall to nothing, and loads and pretension change to the new ones [s]: ten periods of what moves leave it at rest;
    /// 0 changes them at once, as a blast does. Default: 0.
    #[serde(default)]
    pub over_s: f64,
    /// How the stage goes on.
    pub then: Then,
    /// Whether displacements count from the beginning of this stage. Default: false.
    #[serde(default)]
    pub reset_displacements: bool,
}

/// Laws of contact in a stage; a list replaces the whole list.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct StageLaws {
    /// Friction between all blocks. Default: as before.
    pub friction: Option<Friction>,
    /// Friction between materials. Default: as before.
    pub material_pairs: Option<Vec<MaterialPair>>,
    /// Friction of joints. Default: as before.
    pub rock_joints: Option<Vec<JointLaw>>,
}

/// How a stage goes on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum Then {
    /// To rest: after `over_s`, and one step at least, time stands still until forces balance, with damping as in `settle`.
    Settle {
        /// Speed left over the largest speed on the way, and with `Adaptive` and `Local` damping unbalanced forces over loads, or over the largest unbalanced forces on the way where loads cancel or there are none [-]. Default: 1e-4.
        #[serde(default = "tolerance")]
        tolerance: f64,
        /// Steps after which it is given up. Default: 1000000.
        #[serde(default = "most_steps")]
        most_steps: u64,
        /// Damping on the way to rest. Default: `Adaptive` where blocks deform; `Kinetic` where none does, where friction acts on velocities, and where contact is taken at the end of the step.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        damping: Option<SettleDamping>,
        /// How blocks move during `over_s`. Default: `Dynamic`.
        #[serde(default)]
        ramp: Ramp,
    },
    /// So many seconds, `over_s` included.
    Run(f64),
}

/// How blocks move while forces and loads change in a stage that ends at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Ramp {
    /// As they would in this time: a change that is quick makes them oscillate.
    #[default]
    Dynamic,
    /// Damped, as on the way to rest, so that they hardly oscillate, and the time need not be long. Rows, frames and the label leave these steps out.
    Damped,
}

fn tolerance() -> f64 {
    Settle::default().tolerance
}

fn most_steps() -> u64 {
    Settle::default().most_steps
}

impl Stage {
    /// How it comes to rest, if it does.
    pub fn settle(&self) -> Option<Settle> {
        match self.then {
            Then::Settle { tolerance, most_steps, damping, .. } => {
                Some(Settle { tolerance, most_steps, damping, mass_scaling: None })
            }
            Then::Run(_) => None,
        }
    }

    /// Whether motion is damped while forces and loads change.
    pub fn damps_ramp(&self) -> bool {
        matches!(self.then, Then::Settle { ramp: Ramp::Damped, .. })
    }

    /// Its time [s].
    pub fn time_s(&self) -> f64 {
        match self.then {
            Then::Settle { .. } => self.over_s,
            Then::Run(run_s) => run_s,
        }
    }

    /// The path in the scene of a part that this stage, the `k`-th, gives, as in `supports[0].on`; none where it does not give it.
    pub fn path_of(&self, k: usize, part: &str) -> Option<String> {
        let gives = |key: &str| match key {
            "supports" => self.supports.is_some(),
            "tractions" => self.tractions.is_some(),
            "forces" => self.forces.is_some(),
            "water" => self.water.is_some(),
            "gravity_m_s2" => self.gravity_m_s2.is_some(),
            _ => false,
        };
        let laws = self.laws.as_ref();
        let gives_law = |key: &str| match key {
            "friction" => laws.is_some_and(|laws| laws.friction.is_some()),
            "material_pairs" => laws.is_some_and(|laws| laws.material_pairs.is_some()),
            "rock_joints" => laws.is_some_and(|laws| laws.rock_joints.is_some()),
            _ => false,
        };
        let key = |path: &str| path.split(['.', '[']).next().unwrap_or_default().to_owned();
        match part.strip_prefix("contact.") {
            Some(law) => gives_law(&key(law)).then(|| format!("stages[{k}].laws.{law}")),
            None => gives(&key(part)).then(|| format!("stages[{k}].{part}")),
        }
    }

    fn change(&self, scene: &mut Scene) {
        let Self { supports, tractions, forces, water, gravity_m_s2, laws, .. } = self.clone();
        replace(&mut scene.supports, supports);
        replace(&mut scene.tractions, tractions);
        replace(&mut scene.forces, forces);
        replace(&mut scene.water, water);
        replace(&mut scene.gravity_m_s2, gravity_m_s2);
        if let (Some(laws), Some(Contact::Potential { friction, material_pairs, rock_joints, .. })) =
            (laws, &mut scene.contact)
        {
            replace(friction, laws.friction.map(Some));
            replace(material_pairs, laws.material_pairs);
            replace(rock_joints, laws.rock_joints);
        }
    }
}

fn replace<T>(value: &mut T, by: Option<T>) {
    if let Some(by) = by {
        *value = by;
    }
}

impl Scene {
    /// The scene as it is in a stage, counted from 1; stage 0 is before the first.
    pub fn in_stage(&self, stage: usize) -> Self {
        let mut scene = self.clone();
        self.stages.iter().take(stage).for_each(|stage| stage.change(&mut scene));
        scene
    }
}
