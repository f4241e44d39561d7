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
    let loaded = &model.loaded;
    input::warn(loaded, events);
    let advice = step::advise(&loaded.scene, &mut model.simulation);
    let doubts = doubts::doubts(&loaded.scene, &model.simulation, advice.as_ref(), &model.folder);
    doubts.iter().for_each(|doubt| events.warn(doubt));
    let guess = cost::guess(&loaded.scene, &mut model.simulation);
    let file = input::file(&args.input);
    let guess = match guess {
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
        records: &build::records(&loaded.scene, file.parent().unwrap_or(Path::new(""))),
        rocking: rocking::worst(&loaded.scene, simulation),
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
