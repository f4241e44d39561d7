//! A test of a joint with all that came of it, as `ndda joint --json` writes it.

use ndda_io::scene::Scene;
use serde::Serialize;

use super::{
    ClosureRow, ClosureTest, Comparison, Hold, JointError, NormalStiffness, Rows, ShearRow, ShearTest, Which,
    closure_comparisons, friction, shear_comparisons,
};
use crate::build::friction::joint_law;
use crate::numbers::with_prefix;

/// Name and version of the JSON.
const SCHEMA: &str = "ndda.joint/1";

/// A scene for a law that is written by itself: two blocks, one on the other, whose normal stiffness is left open.
pub const SCENE_OF_A_LAW: &str = "Scene(
    title: \"a joint\", time: (step_s: 1e-3, end_s: 1),
    materials: [(name: \"rock\", young_pa: 50e9, poisson: 0.25, density_kg_m3: 2700)],
    blocks: [
        (name: \"lower\", material: \"rock\", body: Fixed, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))),
        (name: \"upper\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, 1)),
    ],
    contact: Potential(potential: Smooth(), friction: (friction_deg: 30)),
)";

/// A test and what came of it.
#[derive(Clone, Debug, Serialize)]
pub struct TestOutcome {
    schema: &'static str,
    /// The joint, its law and how it is held.
    pub title: String,
    law: Option<&'static str>,
    hold: Option<Hold>,
    normal_stress_pa: f64,
    normal_stiffness: NormalStiffness,
    /// Differences from closed forms.
    pub comparisons: Vec<Comparison>,
    rows: OwnedRows,
}

#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
enum OwnedRows {
    Shear(Vec<ShearRow>),
    Closure(Vec<ClosureRow>),
}

impl TestOutcome {
    /// Shears a joint of a scene; `name` is what the title calls it.
    ///
    /// # Errors
    /// There is no such joint, it has no strength, or the test cannot be done; in words.
    pub fn shear(scene: &Scene, (which, name): (&Which, &str), test: &ShearTest) -> Result<Self, String> {
        let friction = friction(scene, which).map_err(|error| error.to_string())?;
        let law = joint_law(friction).ok_or("this joint has no strength, and so nothing to test")?;
        let rows = test.run(law.as_ref()).map_err(|error: JointError| error.to_string())?;
        let held = match test.hold {
            Hold::Stress => "at a constant normal stress of".to_string(),
            Hold::Volume => "at constant volume from a normal stress of".to_string(),
            Hold::Stiffness { stiffness_pa_m } => {
                format!("held by {} from a normal stress of", with_prefix(stiffness_pa_m, "Pa/m"))
            }
        };
        Ok(Self {
            schema: SCHEMA,
            title: format!("{name}: {}, {held} {}", law.name(), with_prefix(test.stress_pa, "Pa")),
            law: Some(law.name()),
            hold: Some(test.hold),
            normal_stress_pa: test.stress_pa,
            normal_stiffness: test.normal,
            comparisons: shear_comparisons(friction, test, &rows),
            rows: OwnedRows::Shear(rows),
        })
    }

    /// Closes a joint.
    ///
    /// # Errors
    /// [`JointError`].
    pub fn closure(test: &ClosureTest) -> Result<Self, JointError> {
        let rows = test.run()?;
        Ok(Self {
            schema: SCHEMA,
            title: format!(
                "closure of a joint up to a normal stress of {}",
                with_prefix(test.stress_pa, "Pa")
            ),
            law: None,
            hold: None,
            normal_stress_pa: test.stress_pa,
            normal_stiffness: test.normal,
            comparisons: closure_comparisons(test, &rows),
            rows: OwnedRows::Closure(rows),
        })
    }

    /// Rows of the test.
    pub fn rows(&self) -> Rows<'_> {
        match &self.rows {
            OwnedRows::Shear(rows) => Rows::Shear(rows),
            OwnedRows::Closure(rows) => Rows::Closure(rows),
        }
    }
}
