//! How far a run is: a bar with the time left on a terminal, a plain line per tenth elsewhere.

use std::io::IsTerminal;
use std::ops::ControlFlow;
use std::time::Instant;

use ndda::run::Pace;
use ndda_solver::{Sink, SinkError, View};

use crate::terminal::bar::Bar;
use crate::terminal::console::complain;
use crate::terminal::events::Events;

/// Shows progress on standard error.
pub struct Progress {
    steps: u64,
    bar: Option<Bar>,
    plain: bool,
    started: Instant,
    tenths: u64,
    percent: u64,
    events: Events,
    /// Step at which this part of the run began.
    first: u64,
}

impl Progress {
    /// Progress from step `first` towards `steps`; shows nothing when it has to be quiet.
    pub fn new(first: u64, steps: u64, quiet: bool, events: Events) -> Self {
        let terminal = std::io::stderr().is_terminal();
        let bar = if terminal && !quiet { Bar::new(steps) } else { None };
        Self {
            steps,
            plain: bar.is_none() && !quiet,
            bar,
            started: Instant::now(),
            tenths: 10 * first / steps.max(1),
            percent: 100 * first / steps.max(1),
            events,
            first,
        }
    }

    /// Clears the bar.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish();
        }
    }
}

impl Sink for Progress {
    fn step_done(&mut self, view: &mut View) -> Result<ControlFlow<()>, SinkError> {
        let step = view.simulation.state().step;
        if self.bar.as_ref().is_some_and(Bar::is_due) {
            let now = Pace::of(view, self.first..self.steps, self.started).to_string();
            self.bar.iter_mut().for_each(|bar| bar.draw(step, &now));
        }
        let tenths = 10 * step / self.steps;
        if self.plain && step > self.first && tenths > self.tenths {
            self.tenths = tenths;
            let now = Pace::of(view, self.first..self.steps, self.started);
            let (spent, left) = (now.spent_s, now.left_s);
            complain(&format!("{:3} %  {now}  {spent:.1} s spent, {left:.1} s left", 10 * tenths));
        }
        let percent = 100 * step / self.steps;
        if self.events.are_read() && percent > self.percent {
            self.percent = percent;
            self.events.emit("progress", &Pace::of(view, self.first..self.steps, self.started));
        }
        Ok(ControlFlow::Continue(()))
    }
}
