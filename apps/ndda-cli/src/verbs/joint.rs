//! `ndda joint`: direct shear and closure of one joint of a scene.

use ndda::build::friction::joint_law;
use ndda::joint::{
    self, ClosureRow, ClosureTest, Comparison, Hold, JointError, NormalStiffness, Rows, ShearRow, ShearTest,
    Which,
};
use ndda_io::read::{self, LoadedScene};
use serde::Serialize;

use crate::args::{JointArgs, JointTestKind, SceneArgs};
use crate::terminal::console::{complain, say};
use crate::terminal::events::Events;
use crate::{exit, input};

/// The scene of a law that is written on the command line, but for the law.
const BARE: &str = "Scene(
    title: \"a joint\", time: (step_s: 1e-3, end_s: 1),
    materials: [(name: \"rock\", young_pa: 50e9, poisson: 0.25, density_kg_m3: 2700)],
    blocks: [
        (name: \"lower\", material: \"rock\", body: Fixed, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))),
        (name: \"upper\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, 1)),
    ],
    contact: Potential(penalty_pa: 1e9, friction: (friction_deg: 30)),
)";

/// A test and what came of it.
#[derive(Serialize)]
struct Done {
    schema: &'static str,
    title: String,
    law: Option<&'static str>,
    hold: Option<Hold>,
    normal_stress_pa: f64,
    normal_stiffness: NormalStiffness,
    comparisons: Vec<Comparison>,
    rows: DoneRows,
}

#[derive(Serialize)]
#[serde(untagged)]
enum DoneRows {
    Shear(Vec<ShearRow>),
    Closure(Vec<ClosureRow>),
}

/// Tests a joint; the result is the exit code.
pub fn joint(args: &JointArgs) -> u8 {
    let done = match test(args) {
        Ok(done) => done,
        Err(code) => return code,
    };
    let rows = match &done.rows {
        DoneRows::Shear(rows) => Rows::Shear(rows),
        DoneRows::Closure(rows) => Rows::Closure(rows),
    };
    let json = serde_json::to_string_pretty(&done).expect("a test has no NaN");
    if let Some(Err(error)) = args.out.as_deref().map(|out| joint::write(out, &rows, &done.title, &json)) {
        complain(&format!("error: {error}"));
        return exit::of_write(&error);
    }
    if args.json {
        say(&json);
        return exit::DONE;
    }
    let files = args.out.as_ref().map_or(String::new(), |out| format!("results in {}", out.display()));
    say(format!("{}\n{}{files}", done.title, joint::text(&rows, &done.comparisons)).trim_end());
    exit::DONE
}

fn test(args: &JointArgs) -> Result<Done, u8> {
    let needs_no_scene = args.test == JointTestKind::Closure && args.joint_stiffness.is_some();
    if args.scene.is_none() && args.example.is_none() && args.friction.is_none() && !needs_no_scene {
        complain(
            "error: no law to test: name a scene, or write a law with --friction; see ndda joint --help",
        );
        return Err(exit::USAGE);
    }
    let loaded = scene(args)?;
    let normal = normal(args, &loaded);
    match args.test {
        JointTestKind::Closure => closure(args, normal),
        JointTestKind::Shear => shear(args, &loaded, normal),
    }
    .map_err(|message| {
        complain(&format!("error: {message}"));
        exit::BAD_INPUT
    })
}

/// The scene of the law, with the law that was written in place of its own.
fn scene(args: &JointArgs) -> Result<LoadedScene, u8> {
    let events = Events::default();
    let mut overrides = args.overrides.clone();
    overrides.extend(args.friction.as_ref().map(|law| format!("contact.friction={law}")));
    if args.scene.is_none() && args.example.is_none() {
        return read::load_text("--friction", BARE, &overrides, None)
            .map_err(|errors| events.refuse(&errors));
    }
    let (scene, example) = (args.scene.clone(), args.example.clone());
    input::scene(&SceneArgs { scene, example, overrides }, events)
}

/// The normal stiffness that was given, else that of the scene.
fn normal(args: &JointArgs, loaded: &LoadedScene) -> NormalStiffness {
    match (args.joint_stiffness, args.max_closure) {
        (Some(initial_pa_m), Some(most_m)) => NormalStiffness::Hyperbolic { initial_pa_m, most_m },
        (Some(stiffness_pa_m), None) => NormalStiffness::Linear { stiffness_pa_m },
        (None, _) => joint::normal_stiffness(&loaded.scene),
    }
}

fn shear(args: &JointArgs, loaded: &LoadedScene, normal: NormalStiffness) -> Result<Done, String> {
    let which = match (&args.of, &args.between) {
        (Some(name), _) => Which::Joint(name.clone()),
        (None, Some((a, b))) => Which::Between(a.clone(), b.clone()),
        (None, None) => Which::Everywhere,
    };
    let friction = joint::friction(&loaded.scene, &which).map_err(|error| error.to_string())?;
    let law = joint_law(friction).ok_or("this joint has no strength, and so nothing to test")?;
    let hold = match args.spring {
        _ if args.constant_volume => Hold::Volume,
        Some(stiffness_pa_m) => Hold::Stiffness { stiffness_pa_m },
        None => Hold::Stress,
    };
    let words = |error: JointError| error.to_string();
    let path_m = joint::path(args.amplitude, args.cycles, args.steps).map_err(words)?;
    let test = ShearTest { stress_pa: args.normal_stress, hold, normal, path_m };
    let rows = test.run(law.as_ref()).map_err(words)?;
    let held = match hold {
        Hold::Stress => "at a constant normal stress of".to_string(),
        Hold::Volume => "at constant volume from a normal stress of".to_string(),
        Hold::Stiffness { stiffness_pa_m } => {
            format!("held by {:e} GPa/m from a normal stress of", 1e-9 * stiffness_pa_m)
        }
    };
    Ok(Done {
        schema: "ndda.joint/1",
        title: format!("{}: {}, {held} {} MPa", name(args, loaded), law.name(), 1e-6 * args.normal_stress),
        law: Some(law.name()),
        hold: Some(hold),
        normal_stress_pa: args.normal_stress,
        normal_stiffness: normal,
        comparisons: joint::shear_comparisons(friction, &test, &rows),
        rows: DoneRows::Shear(rows),
    })
}

fn closure(args: &JointArgs, normal: NormalStiffness) -> Result<Done, String> {
    let test = ClosureTest { stress_pa: args.normal_stress, normal, steps: args.steps };
    let rows = test.run().map_err(|error| error.to_string())?;
    Ok(Done {
        schema: "ndda.joint/1",
        title: format!("closure of a joint up to a normal stress of {} MPa", 1e-6 * args.normal_stress),
        law: None,
        hold: None,
        normal_stress_pa: args.normal_stress,
        normal_stiffness: normal,
        comparisons: joint::closure_comparisons(&test, &rows),
        rows: DoneRows::Closure(rows),
    })
}

/// Name of the joint in the output.
fn name(args: &JointArgs, loaded: &LoadedScene) -> String {
    match (&args.of, &args.between, &args.friction) {
        (Some(name), ..) => format!("joint `{name}`"),
        (_, Some((a, b)), _) => format!("joint of `{a}` and `{b}`"),
        (.., Some(_)) => "a joint".into(),
        _ => format!("all joints of `{}`", loaded.scene.title),
    }
}
