//! Looking does not change what is seen: fewer rows of the history, the same motion.

use ndda::build;

use crate::generator::{Wanted, build};
use crate::motion::{run, run_to};
use crate::search::{Found, search};

#[test]
fn rows_do_not_change_the_motion() {
    search("rows", 40, &Wanted::default(), |case| {
        let (many, stopped) = run(&case.text);
        let mut few = build(&case.text).unwrap();
        let steps = build::steps(&case.scene.time);
        let also = run_to(&mut few.simulation, steps, steps, 3);
        if many.simulation.state().step != few.simulation.state().step {
            return match stopped {
                // An inverted element is noticed when it is evaluated.
                Some(why) if why.contains("inverted") => Found::Skipped("stops where it is looked at"),
                why => Found::Fails(format!("{why:?} is {also:?}")),
            };
        }
        if stopped.is_none() && many.simulation.state() != few.simulation.state() {
            return Found::Fails("the end is another one".into());
        }
        Found::Holds
    });
}
