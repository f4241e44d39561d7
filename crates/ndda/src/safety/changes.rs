//! Changes of a trial to the scene.

use ndda_io::scene::{By as SupportBy, Contact, FactorRow, Friction, Residual, Scene, Support};
use ndda_mesh::Vec3;
use serde::{Deserialize, Serialize};

use super::SafetyError;
use super::slide::{Slide, tilt_rad};

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
        /// Where to; without it, down the steepest plane, or line of two planes, that blocks slide down.
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
    /// Gravity is turned towards a direction by so much that on the plane that blocks slide down the ratio of shear to normal force is multiplied by F; on the line of two planes,
    /// that of the part of the weight that drives blocks down it to the part that presses them on the planes.
    Gravity {
        /// The direction, of any length; its part across gravity counts.
        towards: [f64; 3],
        /// Dip of the plane, or plunge of the line [°]: the tangent of this is the ratio as drawn.
        slope_deg: f64,
        /// Normals into blocks of the two planes; one plane is there twice.
        normals: [[f64; 3]; 2],
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

/// Smallest angle to a level and to a vertical plane of a slope that can be made steeper [°].
const LEVEL_DEG: f64 = 0.1;
/// Cosine of a direction to a way down, up to which it is across it: blocks turn by less as they come to rest.
const ACROSS: f64 = 1e-3;

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
                let is_across =
                    |towards: [f64; 3]| across(scene, &towards).norm() > 1e-6 * Vec3::from(towards).norm();
                let falls = scene.gravity_m_s2 != [0.0; 3];
                let refused = SafetyError::NoTilt { towards: towards.unwrap_or_default() };
                if falls && towards.is_none_or(is_across) { Ok(()) } else { Err(refused) }
            }
        }
    }

    /// The change, where each block rests on planes of some normals into it.
    ///
    /// # Errors
    /// Gravity is to be tilted, and all planes are level, or none lets blocks slide that way.
    pub fn on(&self, scene: &Scene, blocks: &[Vec<Vec3>]) -> Result<By, SafetyError> {
        let Self::Gravity { towards } = self else {
            return Ok(if *self == Self::Load { By::Load } else { By::Strength });
        };
        let leans = |slide: &&Slide| match towards {
            Some(towards) => slide.direction.dot(&across(scene, towards).normalize()) > ACROSS,
            None => true,
        };
        let slides = slides(Vec3::from(scene.gravity_m_s2), blocks);
        let steep = || slides.iter().filter(|slide| is_steep(slide));
        let steeper = |a: &&Slide, b: &&Slide| a.slope_rad.total_cmp(&b.slope_rad);
        if let Some(slide) = steep().filter(leans).max_by(steeper) {
            let towards = towards.unwrap_or(across(scene, &slide.direction.into()).into());
            let (slope_deg, normals) = (slide.slope_rad.to_degrees(), slide.normals.map(Into::into));
            return Ok(By::Gravity { towards, slope_deg, normals });
        }
        Err(match steep().max_by(steeper) {
            Some(slide) => SafetyError::NoSlopeTowards {
                towards: towards.unwrap_or_default(),
                down: slide.direction.into(),
            },
            None => SafetyError::NoSlope {
                slope_deg: slides.iter().map(|slide| slide.slope_rad.to_degrees()).fold(0.0, f64::max),
            },
        })
    }
}

/// Ways in which blocks slide that rest on planes of some normals each; where steps below hold all of them, down each plane by itself.
fn slides(gravity: Vec3, blocks: &[Vec<Vec3>]) -> Vec<Slide> {
    let whole: Vec<Slide> = blocks.iter().filter_map(|normals| Slide::down(gravity, normals)).collect();
    if whole.iter().any(is_steep) {
        return whole;
    }
    let single = blocks.iter().flatten().filter_map(|normal| Slide::down(gravity, &[*normal]));
    single.collect()
}

/// Whether a slope can be made steeper.
fn is_steep(slide: &Slide) -> bool {
    (LEVEL_DEG..90.0 - LEVEL_DEG).contains(&slide.slope_rad.to_degrees())
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
            Self::Gravity { towards, normals, .. } => {
                let (gravity, normals) = (Vec3::from(scene.gravity_m_s2), normals.map(Vec3::from));
                // A slope is made less steep straight away from the way down: in others it may not become so.
                let down = Slide::down(gravity, &normals).filter(|_| factor < 1.0);
                let across = across(scene, &down.map_or(*towards, |slide| slide.direction.into()));
                let across = across.normalize() * gravity.norm();
                let tilt = tilt_rad(gravity, across, &normals, factor);
                // Water stays as it is: a slope that is made steeper in this way has no other water table.
                for water in &mut scene.water {
                    water.pressure = water.pressure.held(scene.gravity_m_s2);
                }
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
