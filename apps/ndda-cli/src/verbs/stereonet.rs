//! `ndda stereonet`: orientations of joints, their statistics, and kinematic checks of a slope.

use ndda::stereonet::{Request, StereonetError, make};

use crate::args::StereonetArgs;
use crate::exit;
use crate::terminal::console::say;
use crate::terminal::events::{self, Events};

/// Runs `ndda stereonet`; returns the exit code.
pub fn stereonet(args: &StereonetArgs) -> u8 {
    let events = Events::new(args.json, events::STEREONET);
    let request = Request {
        input: args.input.clone(),
        overrides: args.overrides.clone(),
        net: args.net,
        slope: args.slope,
        friction_deg: args.friction,
        lateral_deg: args.lateral,
        out: args.out.clone(),
    };
    match make(&request) {
        Ok(stereonet) => {
            events.emit("finished", &stereonet);
            if !args.json {
                say(&stereonet.to_string());
            }
            exit::DONE
        }
        Err(StereonetError::Scene(errors)) => events.refuse(&errors),
        Err(StereonetError::Write(error)) => events.fail(exit::of_write(&error), &error.to_string()),
        Err(error) => events.fail(exit::BAD_INPUT, &error.to_string()),
    }
}
