//! `ndda picture`: blocks in 3D as a picture or an animation, without a browser.

use ndda::view3d::{self, Frames, Look, Request, ViewError};
use serde_json::json;

use crate::args::PictureArgs;
use crate::exit;
use crate::terminal::console::say;
use crate::terminal::events::{self, Events};

/// Runs `ndda picture`; returns the exit code.
pub fn picture(args: &PictureArgs) -> u8 {
    let events = Events::new(args.json, events::PICTURE);
    let out = args.out.clone().unwrap_or_else(|| view3d::default_file(&args.input, args.animate));
    match view3d::draw(&request(args), &out) {
        Ok(written) => {
            events.emit("written", &written);
            events.emit("finished", &json!({"exit_code": exit::DONE, "picture": out}));
            if !args.json {
                say(&written.to_string());
            }
            exit::DONE
        }
        Err(ViewError::Scene(errors)) => events.refuse(&errors),
        Err(error @ (ViewError::Write(_) | ViewError::Encode { .. } | ViewError::Ffmpeg { .. })) => {
            events.fail(exit::INPUT_OUTPUT, &error.to_string())
        }
        Err(error) => events.fail(exit::BAD_INPUT, &error.to_string()),
    }
}

fn request(args: &PictureArgs) -> Request {
    let size = args.size.unwrap_or(if args.animate { (800, 560) } else { (1200, 800) });
    Request {
        input: args.input.clone(),
        overrides: args.overrides.clone(),
        frames: if args.animate { Frames::Most(args.frames.into()) } else { Frames::One(args.frame) },
        colour: args.color.clone(),
        look: Look {
            view: args.view,
            resting: args.resting,
            whole: args.whole,
            magnify: args.magnify,
            outlines: !args.no_outlines,
            bolts: args.bolts,
            dark: args.dark,
            size,
        },
        per_second: args.fps,
    }
}
