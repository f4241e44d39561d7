//! Random scenes: a seed gives a plan, the plan a scene's text, as a person would write it.

use std::path::Path;

use ndda::Model;
use ndda::forecast::step;
use ndda_io::read::load_text;
use ndda_io::scene::Scene;

use crate::families;
use crate::laws;
use crate::random::{Random, few_digits};

/// Requirements of a relation on its scenes.
#[derive(Clone, Copy, Default)]
pub struct Wanted {
    /// Boxes whose meshes are their own mirror images, and no other shape.
    pub symmetric: bool,
    /// No rock that is cut, whose cuts belong to the axes.
    pub uncut: bool,
    /// Only blocks that fly, hit and slide: no supports on parts of blocks, no loads on places.
    pub free: bool,
    /// So many nodes that steps are shared among threads.
    pub large: bool,
    /// Contacts with a coefficient of restitution below 1.
    pub damped: bool,
}

/// A block as it is written.
pub struct Piece {
    pub name: String,
    pub shape: String,
    pub body: &'static str,
    pub turns: String,
    pub at_m: [f64; 3],
    /// Direction in which the block is moved by the gap, a multiple of it.
    pub away: [f64; 3],
    /// Velocity over the speed of the scene.
    pub velocity: [f64; 3],
    /// Rotation over the speed of the scene per its length.
    pub spin: [f64; 3],
}

/// A scene without its time scale, which follows from the stiffness of its contact.
pub struct Plan {
    pub family: &'static str,
    /// Size of blocks [m].
    pub length_m: f64,
    pub pieces: Vec<Piece>,
    pub rock: String,
    /// Direction and size of gravity, over what brings the scene's speed within the run.
    pub gravity: [f64; 3],
    /// Supports, tractions and forces, in which `{T}`, `{H}`, `{D}`, `{F}`, `{K}` and `{P}`
    /// stand for the run's time and half of it, way, force, stiffness and pressure.
    pub loads: String,
    pub contact: String,
    pub material: String,
}

/// A random scene.
pub struct Case {
    pub seed: u64,
    pub family: &'static str,
    /// Step over the advised one.
    pub factor: f64,
    pub text: String,
    pub scene: Scene,
}

/// Time scale of a scene.
struct Pace {
    step_s: f64,
    steps: u32,
    speed_m_s: f64,
    gap_m: f64,
    time: String,
}

/// The first of the seeds whose contacts have a coefficient of restitution below 1.
pub const FIRST_DAMPED: u64 = 1_000_000;

/// The scene of a seed; attempts that cannot be built are followed by the next.
pub fn case(seed: u64, wanted: &Wanted) -> Case {
    let mut random = Random::new(seed);
    let wanted = Wanted { damped: wanted.damped || seed >= FIRST_DAMPED, ..*wanted };
    for _ in 0..100 {
        if let Some(case) = attempt(seed, &mut random, &wanted) {
            return case;
        }
    }
    panic!("seed {seed} gives no scene in 100 attempts");
}

fn attempt(seed: u64, random: &mut Random, wanted: &Wanted) -> Option<Case> {
    let plan = families::plan(random, wanted);
    let advised_s = advised_step_s(&plan)?;
    let factor = random.decades(0.1, 8.0);
    let pace = pace(&plan, random, advised_s, factor);
    let text = write(&plan, &pace);
    let ready = build(&text).ok()?;
    Some(Case { seed, family: plan.family, factor, scene: ready.loaded.scene, text })
}

/// Reads, checks and builds the text of a scene.
pub fn build(text: &str) -> Result<Model, String> {
    let folder = Path::new(".");
    let loaded = load_text("random.ron", text, &[], Some(folder)).map_err(|e| e.render(false))?;
    Model::new(loaded, folder).map_err(|e| e.render(false))
}

/// The step that contact requires [s]; that of waves where there is no contact.
fn advised_step_s(plan: &Plan) -> Option<f64> {
    let still = Pace {
        step_s: 1e-6,
        steps: 1,
        speed_m_s: 1e-6,
        gap_m: 0.05 * plan.length_m,
        time: "step_s: 1e-6, end_s: 1e-6".into(),
    };
    let mut ready = build(&write(plan, &still)).ok()?;
    let wave_m_s = 2000.0;
    let waves_s = 0.05 * plan.length_m / wave_m_s;
    Some(step::advise(&ready.loaded.scene, &mut ready.simulation).map_or(waves_s, |advice| advice.step_s))
}

/// Speeds are such that blocks meet once or twice and go a thousandth to a tenth of their size into each other.
fn pace(plan: &Plan, random: &mut Random, advised_s: f64, factor: f64) -> Pace {
    let step_s = few_digits(advised_s * factor);
    let steps = random.whole(30, 150);
    let end_s = step_s * f64::from(steps);
    let speed_m_s = few_digits(random.decades(3e-4, 0.03) * 0.3 * plan.length_m / advised_s);
    let gap_m = few_digits(random.between(0.02, 0.5) * speed_m_s * end_s);
    let time = format!("step_s: {step_s}, end_s: {end_s}, {}", laws::time(random));
    Pace { step_s, steps, speed_m_s, gap_m, time }
}

fn vector(v: [f64; 3]) -> String {
    format!("({}, {}, {})", v[0], v[1], v[2])
}

fn write(plan: &Plan, pace: &Pace) -> String {
    let end_s = pace.step_s * f64::from(pace.steps);
    let scaled = |v: [f64; 3], by: f64| v.map(|x| few_digits(x * by));
    let blocks: String = plan.pieces.iter().map(|piece| piece.text(plan, pace)).collect();
    let loads = plan
        .loads
        .replace("{T}", &end_s.to_string())
        .replace("{H}", &(0.5 * end_s).to_string())
        .replace("{D}", &few_digits(0.5 * pace.speed_m_s * end_s).to_string())
        .replace("{F}", &few_digits(2650.0 * plan.length_m.powi(3) * pace.speed_m_s / end_s).to_string())
        .replace("{K}", &few_digits(1e10 * plan.length_m).to_string())
        .replace("{P}", &few_digits(2650.0 * 2000.0 * pace.speed_m_s).to_string());
    let cohesion_pa = few_digits(2650.0 * plan.length_m * pace.speed_m_s / end_s);
    let contact = plan.contact.replace("{C}", &cohesion_pa.to_string());
    format!(
        "(\n    title: \"A random scene: {}\",\n    time: ({}),\n    gravity_m_s2: {},\n    materials: [{}],\n    \
         blocks: [\n{blocks}    ],\n    rock: [{}],\n    {loads}\n    contact: {contact},\n    output: (frames: 0),\n)\n",
        plan.family,
        pace.time,
        vector(scaled(plan.gravity, pace.speed_m_s / end_s)),
        plan.material,
        plan.rock,
    )
}

impl Piece {
    fn text(&self, plan: &Plan, pace: &Pace) -> String {
        let at_m: [f64; 3] = std::array::from_fn(|i| self.at_m[i] + pace.gap_m * self.away[i]);
        let velocity = self.velocity.map(|v| few_digits(v * pace.speed_m_s));
        let spin = self.spin.map(|w| few_digits(w * pace.speed_m_s / plan.length_m));
        let moves = if self.body == "Fixed" {
            String::new()
        } else {
            format!("velocity_m_s: {}, spin_rad_s: {}, ", vector(velocity), vector(spin))
        };
        format!(
            "        (\n            name: \"{}\", material: \"rock\", body: {},\n            shape: {},\n            \
             turns: [{}], at_m: {}, {moves}\n        ),\n",
            self.name,
            self.body,
            self.shape,
            self.turns,
            vector(at_m)
        )
    }
}
