//! `ndda schema`: what a scene may say.

use ndda_io::schema;

use crate::args::SchemaArgs;
use crate::exit;
use crate::terminal::console::say;

/// Prints the schema, or the reference in words; returns the exit code.
pub fn schema(args: &SchemaArgs) -> u8 {
    if args.markdown {
        say(schema::reference().trim_end());
    } else {
        say(&format!("{:#}", schema::schema()));
    }
    exit::DONE
}
