//! `ndda explain`: what a run of a scene does, what it leaves out, and why.

use crate::args::ExplainArgs;
use crate::terminal::console::{complain, say};
use crate::terminal::events::Events;
use crate::{exit, input};

/// Explains a scene; returns the exit code.
pub fn explain(args: &ExplainArgs) -> u8 {
    let mut model = match input::model(&args.input, Events::default()) {
        Ok(model) => model,
        Err(code) => return code,
    };
    let mut explanation = ndda::explain::explain(&mut model);
    explanation.features.extend([
        ("schema", cfg!(feature = "schema")),
        ("shell", cfg!(feature = "shell")),
        ("terminal", cfg!(feature = "terminal")),
    ]);
    if !args.json {
        say(explanation.to_string().trim_end());
        return exit::DONE;
    }
    match serde_json::to_string_pretty(&explanation) {
        Ok(json) => {
            say(&json);
            exit::DONE
        }
        Err(error) => {
            complain(&format!("error: the plan cannot be written as JSON: {error}"));
            exit::INPUT_OUTPUT
        }
    }
}
