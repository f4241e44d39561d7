//! `ndda check`: everything that can be wrong with a scene, without running it.

use std::path::Path;

use ndda::body_counts::BodyCounts;
use ndda::bolt_report::BoltReports;
use ndda::checked::Checked;
use ndda::forecast::{cost, doubts, step};
use ndda::{build, choose, rocking};

use crate::args::CheckArgs;
use crate::terminal::console::say;
use crate::terminal::events::{self, Events};
use crate::verbs::rockfall;
use crate::{exit, input};

/// Runs `ndda check`; returns the exit code.
pub fn check(args: &CheckArgs) -> u8 {
    let events = Events::new(args.json, events::CHECK);
    if let Some(code) = rockfall::check(&args.input, events) {
        return code;
    }
    let mut model = match input::model(&args.input, events) {
        Ok(model) => model,
        Err(code) => return code,
    };
    let (loaded, scene) = (&model.loaded, &model.loaded.scene);
    input::warn(loaded, events);
    let advice = step::advise(scene, &mut model.simulation);
    let rocking = rocking::worst(scene, &model.simulation);
    let doubts = doubts::doubts(scene, &model.simulation, advice.as_ref(), rocking.as_ref(), &model.folder);
    doubts.iter().for_each(|doubt| events.warn(doubt));
    let file = input::file(&args.input);
    let guess = match cost::guess(scene, &mut model.simulation) {
        Ok(guess) => guess,
        Err(error) => {
            return events.fail(exit::STOPPED, &format!("the run would stop in its first steps: {error}"));
        }
    };
    let (simulation, blocks) = (&model.simulation, model.simulation.blocks());
    let checked = Checked {
        exit_code: exit::DONE,
        scene: &file,
        warnings: loaded.warnings.len() + doubts.len(),
        blocks: blocks.len(),
        nodes: blocks.rest_position.len(),
        tets: blocks.tets.len(),
        bodies: BodyCounts::of(simulation),
        steps: model.steps(),
        advised_step_s: advice.as_ref().map(|advice| advice.step_s),
        contact_stability: advice.as_ref(),
        chosen: &loaded.chosen,
        records: &build::records(scene, file.parent().unwrap_or(Path::new(""))),
        rocking,
        rock: &model.rock,
        bolts: BoltReports::new(simulation),
        guess,
    };
    if args.write
        && let Err(reason) = choose::write(&file, &loaded.chosen)
    {
        return events.fail(exit::INPUT_OUTPUT, &reason);
    }
    events.emit("finished", &checked);
    // A step that is not stable has been warned of.
    let stable = advice.as_ref().filter(|advice| advice.worst().h <= advice.bound);
    if !args.json {
        let stable = stable.map_or_else(String::new, |advice| format!("\n{advice}"));
        let is_written = args.write && !checked.chosen.is_empty();
        let written = if is_written { format!("\nwritten into {}", file.display()) } else { String::new() };
        say(&format!("{checked}{stable}{written}"));
    }
    checked.exit_code
}
