//! `ndda plot`: columns of histories over time, or over each other.

use std::path::PathBuf;

use ndda::plot::{self, Columns, Plot, PlotError};
use serde::Serialize;

use crate::args::PlotArgs;
use crate::exit;
use crate::terminal::console::say;
use crate::terminal::events::{self, Events};

/// Outcome of drawing.
#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum Done {
    /// Columns that there are to draw.
    Tables(Vec<Columns>),
    /// The file of what is drawn.
    Picture(PathBuf),
}

#[derive(Serialize)]
struct Finished<'a> {
    exit_code: u8,
    #[serde(flatten)]
    done: &'a Done,
}

/// Runs `ndda plot`; returns the exit code.
pub fn plot(args: &PlotArgs) -> u8 {
    let events = Events::new(args.json, events::PLOT);
    match plot_or_list(args) {
        Ok(done) => {
            events.emit("finished", &Finished { exit_code: exit::DONE, done: &done });
            if !args.json {
                say(&words(&done));
            }
            exit::DONE
        }
        Err(error) => {
            let code =
                if matches!(error, PlotError::Write(_)) { exit::INPUT_OUTPUT } else { exit::BAD_INPUT };
            events.fail(code, &error.to_string())
        }
    }
}

fn plot_or_list(args: &PlotArgs) -> Result<Done, PlotError> {
    if args.columns.is_empty() {
        return Ok(Done::Tables(plot::columns(&args.inputs)?));
    }
    let (inputs, columns) = (args.inputs.clone(), args.columns.clone());
    plot::plot(&Plot { inputs, columns, against: args.against.clone(), log: args.log }, &args.out)?;
    Ok(Done::Picture(args.out.clone()))
}

fn words(done: &Done) -> String {
    let list = |table: &Columns| format!("{}: {}", table.file.display(), table.columns.join(", "));
    match done {
        Done::Tables(tables) => tables.iter().map(list).collect::<Vec<_>>().join("\n"),
        Done::Picture(file) => file.display().to_string(),
    }
}
