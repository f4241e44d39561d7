//! `ndda joint`: direct shear and closure of one joint of a scene.

use ndda::joint::{self, ClosureTest, Hold, NormalStiffness, SCENE_OF_A_LAW, ShearTest, TestOutcome, Which};
use ndda_io::read::{self, LoadedScene};

use crate::args::{JointArgs, JointTestKind, SceneArgs};
use crate::terminal::console::{complain, say};
use crate::terminal::events::Events;
use crate::{exit, input};

/// Tests a joint; the result is the exit code.
pub fn joint(args: &JointArgs) -> u8 {
    let done = match test(args) {
        Ok(done) => done,
        Err(code) => return code,
    };
    let rows = done.rows();
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

fn test(args: &JointArgs) -> Result<TestOutcome, u8> {
    let needs_no_scene = args.test == JointTestKind::Closure && args.joint_stiffness.is_some();
    if args.scene.is_none() && args.example.is_none() && args.friction.is_none() && !needs_no_scene {
        complain("error: no law to test: name a scene, or give --friction; see ndda joint --help");
        return Err(exit::USAGE);
    }
    let loaded = scene(args)?;
    input::warn(&loaded, Events::default());
    let normal = normal(args, &loaded);
    match args.test {
        JointTestKind::Closure => {
            let test = ClosureTest { stress_pa: args.normal_stress, normal, steps: args.steps };
            let is_given =
                [args.amplitude.is_some(), args.cycles > 0, args.constant_volume, args.spring.is_some()];
            let done = joint::refuse_of_shear(is_given).and_then(|()| TestOutcome::closure(&test));
            done.map_err(|error| error.to_string())
        }
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
        return read::load_text("--friction", SCENE_OF_A_LAW, &overrides, None)
            .map_err(|errors| events.refuse(&errors));
    }
    input::scene(&SceneArgs { scene: args.scene.clone(), example: args.example.clone(), overrides }, events)
}

/// The normal stiffness that was given, else that of the scene.
fn normal(args: &JointArgs, loaded: &LoadedScene) -> NormalStiffness {
    match (args.joint_stiffness, args.max_closure) {
        (Some(initial_pa_m), Some(most_m)) => NormalStiffness::Hyperbolic { initial_pa_m, most_m },
        (Some(stiffness_pa_m), None) => NormalStiffness::Linear { stiffness_pa_m },
        (None, _) => joint::normal_stiffness(&loaded.scene),
    }
}

fn shear(args: &JointArgs, loaded: &LoadedScene, normal: NormalStiffness) -> Result<TestOutcome, String> {
    let which = match (&args.of, &args.between) {
        (Some(name), _) => Which::Joint(name.clone()),
        (None, Some((a, b))) => Which::Between(a.clone(), b.clone()),
        (None, None) => Which::Everywhere,
    };
    let hold = match args.spring {
        _ if args.constant_volume => Hold::Volume,
        Some(stiffness_pa_m) => Hold::Stiffness { stiffness_pa_m },
        None => Hold::Stress,
    };
    let path_m = joint::path(args.amplitude, args.cycles, args.steps).map_err(|error| error.to_string())?;
    let test = ShearTest { stress_pa: args.normal_stress, hold, normal, path_m };
    let title = args.friction.is_none().then_some(&*loaded.scene.title);
    TestOutcome::shear(&loaded.scene, (&which, &which.describe(title)), &test)
}
