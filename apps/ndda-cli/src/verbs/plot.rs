//! `ndda plot`: columns of histories over time, or over each other.

use ndda::plot::{self, Columns, Plot, PlotError};
use serde_json::{Value, json};

use crate::args::PlotArgs;
use crate::exit;
use crate::terminal::console::say;
use crate::terminal::events::{self, Events};

/// Runs `ndda plot`; returns the exit code.
pub fn plot(args: &PlotArgs) -> u8 {
    let events = Events::new(args.json, events::PLOT);
    match plot_or_list(args) {
        Ok((words, done)) => {
            events.emit("finished", &done);
            if !args.json {
                say(&words);
            }
            exit::DONE
        }
        Err(error) => {
            let code = error.of_file().map_or(exit::BAD_INPUT, exit::of_write);
            events.fail(code, &error.to_string())
        }
    }
}

/// What was drawn, or the columns that there are to draw, in words and as an event.
fn plot_or_list(args: &PlotArgs) -> Result<(String, Value), PlotError> {
    if args.columns.is_empty() {
        let tables = plot::columns(&args.inputs)?;
        let list = |table: &Columns| format!("{}: {}", table.file.display(), table.columns.join(", "));
        let words = tables.iter().map(list).collect::<Vec<_>>().join("\n")
            + "\nto draw some of them: --columns NAME,NAME";
        return Ok((words, json!({"exit_code": exit::DONE, "tables": tables})));
    }
    let (inputs, columns) = (args.inputs.clone(), args.columns.clone());
    plot::plot(&Plot { inputs, columns, against: args.against.clone(), log: args.log }, &args.out)?;
    Ok((args.out.display().to_string(), json!({"exit_code": exit::DONE, "picture": args.out})))
}
