//! Changes of a trial to the scene.

use ndda_io::scene::{By as SupportBy, Contact, FactorRow, Friction, Residual, Scene, Support};
use ndda_mesh::Vec3;
use serde::{Deserialize, Serialize};

use super::SafetyError;

/// The quantity to be changed, as it is asked.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Question {
    /// The strength of all joints.
    #[default]
    Strength,
    /// Forces and tractions.
    Load,
    /// The direction of gravity.
    Gravity {
        /// Where to; without it, down the steepest plane that blocks stand on.
        towards: Option<[f64; 3]>,
    },
}

/// The quantity that is changed by a factor F.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum By {
    /// The strength of all joints is divided: tan φ/F, c/F, σ_t/F.
    Strength,
    /// Forces and tractions are multiplied.
    Load,
    /// Gravity is turned towards a direction by atan(F tan α) − α, where α is its angle to the normal of the plane that
    /// blocks stand on: on that plane the ratio of shear to normal force is multiplied by F.
    Gravity {
        /// The direction, of any length; its part across gravity counts.
        towards: [f64; 3],
        /// α [°].
        slope_deg: f64,
    },
}

/// A scene at rest under its constant loads: nothing moves at the start, gravity is there at once, loads have the last of their values over time, there are no blasts
/// and no waves, and no damping in proportion to mass holds back what would accelerate.
pub fn at_rest(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    for rows in factors(&mut scene) {
        rows.drain(..rows.len().saturating_sub(1));
    }
    scene.materials.iter_mut().for_each(|material| material.damping.mass_per_s = 0.0);
    scene.gravity_ramp_s = 0.0;
    scene.reference = None;
    scene.blasts.clear();
    scene.quiet.iter_mut().for_each(|quiet| quiet.incident.clear());
    for block in &mut scene.blocks {
        (block.velocity_m_s, block.spin_rad_s) = ([0.0; 3], [0.0; 3]);
    }
    scene
}

/// Factors over time of loads.
fn factors(scene: &mut Scene) -> impl Iterator<Item = &mut Vec<FactorRow>> {
    let forces = scene.forces.iter_mut().map(|load| &mut load.factor);
    let tractions = scene.tractions.iter_mut().map(|load| &mut load.factor);
    forces.chain(tractions).chain(scene.water.iter_mut().map(|water| &mut water.factor))
}

/// Notes on loads and damping of the scene that trials do not take as a run does.
pub fn taken_otherwise(scene: &Scene) -> Vec<String> {
    let varies = |rows: &mut Vec<FactorRow>| rows.windows(2).any(|pair| pair[0].factor != pair[1].factor);
    let mut words = Vec::new();
    if factors(&mut scene.clone()).any(varies) {
        words.push("loads with a `factor` over time act with the last of its values".into());
    }
    if !scene.blasts.is_empty() {
        words.push("`blasts` are left out: trials are of a scene at rest under loads that last".into());
    }
    if scene.quiet.iter().any(|quiet| !quiet.incident.is_empty()) {
        words.push("`incident` waves of quiet faces are left out: trials are of a scene at rest".into());
    }
    if scene.materials.iter().any(|material| material.damping.mass_per_s > 0.0) {
        words.push("`mass_per_s` of materials is left out: it would hold back what accelerates".into());
    }
    words
}

/// Name of a block whose support moves.
pub fn moved_support(scene: &Scene) -> Option<String> {
    scene.supports.iter().find(|support| support.hold.is_moved()).map(|support| support.block.clone())
}

/// Whether blocks hang on bolts or springs, which stretch far more than contact gives way before they hold or fail.
pub fn hangs_on_springs(scene: &Scene) -> bool {
    let is_spring = |support: &Support| matches!(support.by, SupportBy::Springs { .. });
    !scene.bolts.is_empty() || scene.supports.iter().any(is_spring)
}

/// The scene with joints as strong as theirs over `factor`.
pub fn weaken(scene: &mut Scene, factor: f64) {
    for friction in frictions(scene) {
        if let Some(roughness) = &mut friction.roughness {
            roughness.strength_factor /= factor;
            continue;
        }
        friction.friction_deg = (friction.friction_deg.to_radians().tan() / factor).atan().to_degrees();
        friction.cohesion_pa /= factor;
        friction.tension_pa /= factor;
        if let Some(residual) = &mut friction.residual {
            residual.friction_deg = (residual.friction_deg.to_radians().tan() / factor).atan().to_degrees();
            residual.cohesion_pa /= factor;
            residual.tension_pa /= factor;
        }
        // A joint then breaks at the same opening and slip.
        if let Some(fracture) = &mut friction.fracture {
            fracture.tension_j_m2 /= factor;
            fracture.shear_j_m2 /= factor;
        }
        if let Some(dilation) = &mut friction.dilation {
            let residual_deg = friction.residual.map_or(friction.friction_deg, |r| r.friction_deg);
            dilation.psi_deg = dilation.psi_deg.min(friction.friction_deg).min(residual_deg);
        }
    }
}

/// Whether joints have any strength.
pub fn has_strength(scene: &Scene) -> bool {
    let holds = |f: &&mut Friction| {
        f.roughness.is_some() || f.friction_deg > 0.0 || f.cohesion_pa > 0.0 || f.tension_pa > 0.0
    };
    frictions(&mut scene.clone()).iter().any(holds)
}

/// Whether all friction of a scene is by shear springs.
pub fn has_springs_only(scene: &Scene) -> bool {
    let frictions = &mut scene.clone();
    self::frictions(frictions).iter().all(|friction| friction.shear_penalty_pa_m.is_some())
}

/// Whether slip weakens some joint, or opens it: what is pushed then is not what it was.
pub fn weakens_by_slip(scene: &Scene) -> bool {
    frictions(&mut scene.clone()).iter().any(|friction| {
        let holds = friction.cohesion_pa > 0.0 || friction.tension_pa > 0.0;
        let is_kept = friction.residual.is_some_and(|residual| keeps_all(friction, &residual));
        let weakens = (holds || friction.residual.is_some()) && !is_kept;
        weakens || friction.roughness.is_some() || friction.fracture.is_some() || friction.dilation.is_some()
    })
}

/// Whether a joint has all of its strength after any slip, and a little opening.
fn keeps_all(friction: &Friction, residual: &Residual) -> bool {
    let peak = [friction.friction_deg, friction.cohesion_pa, friction.tension_pa];
    let opens = friction.tension_pa == 0.0 || residual.opening_m > 0.0;
    peak == [residual.friction_deg, residual.cohesion_pa, residual.tension_pa] && opens
}

/// Whether some joint has cohesion or tensile strength.
pub fn has_cohesion(scene: &Scene) -> bool {
    let frictions = &mut scene.clone();
    self::frictions(frictions).iter().any(|friction| friction.cohesion_pa > 0.0 || friction.tension_pa > 0.0)
}

/// Whether some joint has cohesion that it keeps while it slips.
pub fn keeps_cohesion(scene: &Scene) -> bool {
    let keeps =
        |friction: &&mut Friction| friction.residual.is_some_and(|residual| residual.cohesion_pa > 0.0);
    frictions(&mut scene.clone()).iter().any(keeps)
}

/// Whether some joint has cohesion that it loses at once where it is exceeded.
pub fn has_brittle_cohesion(scene: &Scene) -> bool {
    let is_brittle = |friction: &&mut Friction| {
        friction.cohesion_pa > 0.0 && friction.residual.is_none() && friction.fracture.is_none()
    };
    frictions(&mut scene.clone()).iter().any(is_brittle)
}

fn frictions(scene: &mut Scene) -> Vec<&mut Friction> {
    let Some(Contact::Potential { friction, material_pairs, rock_joints, .. }) = &mut scene.contact else {
        return Vec::new();
    };
    let pairs = material_pairs.iter_mut().filter_map(|pair| pair.friction.as_mut());
    let laws = rock_joints.iter_mut().filter_map(|law| law.friction.as_mut());
    friction.iter_mut().chain(pairs).chain(laws).collect()
}

/// Smallest shear stiffness of the scene's joints [Pa/m].
pub fn shear_stiffness_pa_m(scene: &mut Scene) -> Option<f64> {
    frictions(scene).iter().filter_map(|friction| friction.shear_penalty_pa_m).reduce(f64::min)
}

/// Smallest slope that can be made steeper [°].
const LEVEL_DEG: f64 = 0.1;

impl Question {
    /// Whether the scene has what is to be changed.
    ///
    /// # Errors
    /// [`SafetyError`] that names what is missing.
    pub fn check(&self, scene: &mut Scene) -> Result<(), SafetyError> {
        match self {
            Self::Strength if has_strength(scene) => Ok(()),
            Self::Strength => Err(SafetyError::NoStrength),
            Self::Load if scene.forces.is_empty() && scene.tractions.is_empty() => Err(SafetyError::NoLoad),
            Self::Load => Ok(()),
            Self::Gravity { towards } => {
                let towards = towards.unwrap_or([0.0; 3]);
                let tilts =
                    towards == [0.0; 3] || across(scene, &towards).norm() > 1e-6 * Vec3::from(towards).norm();
                let falls = scene.gravity_m_s2 != [0.0; 3];
                if tilts && falls { Ok(()) } else { Err(SafetyError::NoTilt { towards }) }
            }
        }
    }

    /// The change, where blocks rest on planes of these normals into them.
    ///
    /// # Errors
    /// [`SafetyError::NoSlope`] where gravity is to be tilted and all planes are level.
    pub fn on(&self, scene: &Scene, normals: &[Vec3]) -> Result<By, SafetyError> {
        let Self::Gravity { towards } = self else {
            return Ok(if *self == Self::Load { By::Load } else { By::Strength });
        };
        let up = -Vec3::from(scene.gravity_m_s2).normalize();
        let slope = |normal: &Vec3| normal.cross(&up).norm().atan2(normal.dot(&up));
        let leans = |normal: &&Vec3| match towards {
            Some(towards) => normal.dot(&across(scene, towards)) > 0.0,
            None => true,
        };
        let steepest = normals.iter().filter(|normal| normal.dot(&up) > 0.0).filter(leans);
        let steepest = steepest.max_by(|a, b| slope(a).total_cmp(&slope(b)));
        let slope_deg = steepest.map_or(0.0, |normal| slope(normal).to_degrees());
        match steepest {
            Some(normal) if slope_deg > LEVEL_DEG => {
                let down: [f64; 3] = across(scene, &(*normal).into()).into();
                Ok(By::Gravity { towards: towards.unwrap_or(down), slope_deg })
            }
            _ => Err(SafetyError::NoSlope { slope_deg }),
        }
    }
}

impl By {
    /// Whether loads change, and not joints.
    pub fn changes_loads(&self) -> bool {
        *self != Self::Strength
    }

    /// Changes a scene by a factor.
    pub fn change(&self, scene: &mut Scene, factor: f64) {
        match self {
            Self::Strength => weaken(scene, factor),
            Self::Load => {
                scene.forces.iter_mut().for_each(|force| force.force_n.iter_mut().for_each(|f| *f *= factor));
                let tractions = scene.tractions.iter_mut();
                tractions.for_each(|traction| traction.traction_pa.iter_mut().for_each(|t| *t *= factor));
            }
            Self::Gravity { towards, slope_deg } => {
                let tilt = (factor * slope_deg.to_radians().tan()).atan() - slope_deg.to_radians();
                let gravity = Vec3::from(scene.gravity_m_s2);
                // Water stays as it is: a slope that is made steeper in this way has no other water table.
                for water in &mut scene.water {
                    water.pressure = water.pressure.held(scene.gravity_m_s2);
                }
                let across = across(scene, towards).normalize() * gravity.norm();
                scene.gravity_m_s2 = (gravity * tilt.cos() + across * tilt.sin()).into();
            }
        }
    }
}

/// The part of a direction across gravity.
fn across(scene: &Scene, towards: &[f64; 3]) -> Vec3 {
    let (gravity, towards) = (Vec3::from(scene.gravity_m_s2), Vec3::from(*towards));
    if gravity == Vec3::zeros() {
        Vec3::zeros()
    } else {
        towards - gravity * (gravity.dot(&towards) / gravity.norm_squared())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blasts_and_waves_are_taken_out_of_a_scene_at_rest_and_told() {
        let text = r#"(
            title: "Shaken and blown up", time: (step_s: 1e-4, end_s: 1e-3),
            materials: [(name: "rock", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
            blocks: [(name: "cube", material: "rock", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
            quiet: [(block: "cube", on: Set("z_min"), incident: [(wave: P, record: (file: "quake.csv"))])],
            blasts: [(block: "cube", on: Part(Set("x_min")), pressure: Rows([(0, 0), (0.05, 3e4), (0.1, 1e4)]))],
        )"#;
        let scene = ndda_io::read::load_text("t.ron", text, &[], None).unwrap().scene;
        let told = taken_otherwise(&scene);
        assert!(told[0].contains("`blasts`") && told[1].contains("`incident` waves"), "{told:?}");
        let rest = at_rest(&scene);
        assert!(rest.blasts.is_empty() && rest.quiet.len() == 1 && rest.quiet[0].incident.is_empty());
        assert!(taken_otherwise(&rest).is_empty());
    }
}
