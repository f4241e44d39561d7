//! How far a run is: a bar with the time left on a terminal, a plain line per tenth elsewhere.

use std::fmt;
use std::io::IsTerminal;
use std::ops::ControlFlow;
use std::time::Instant;

use ndda_solver::{Sink, SinkError, View};
use serde::Serialize;

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

/// How a run is getting on.
#[derive(Serialize)]
struct Now {
    step: u64,
    steps: u64,
    time_s: f64,
    spent_s: f64,
    left_s: f64,
    contacts: usize,
    h: f64,
    penetration_ratio: f64,
    energy_gain: f64,
}

impl fmt::Display for Now {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { time_s, contacts, h, .. } = self;
        let (depth, gain) = (100.0 * self.penetration_ratio, 100.0 * self.energy_gain);
        write!(
            f,
            "t = {time_s:.4} s  {contacts} contacts  h = {h:.2}  depth {depth:.2} %  energy +{gain:.1e} %"
        )
    }
}

impl Progress {
    fn now(&self, view: &View) -> Now {
        let step = view.simulation.state().step;
        let spent_s = self.started.elapsed().as_secs_f64();
        let (done, to_do) = (step - self.first, self.steps.saturating_sub(step));
        Now {
            step,
            steps: self.steps,
            time_s: view.simulation.time_s(),
            spent_s,
            left_s: spent_s * to_do as f64 / done.max(1) as f64,
            contacts: view.report.contact.contact_pairs,
            h: view.report.h,
            penetration_ratio: view.report.contact.max_penetration_ratio,
            energy_gain: view.simulation.invariants().energy_gain,
        }
    }
}

impl Sink for Progress {
    fn step_done(&mut self, view: &mut View) -> Result<ControlFlow<()>, SinkError> {
        let step = view.simulation.state().step;
        if self.bar.as_ref().is_some_and(Bar::is_due) {
            let now = self.now(view).to_string();
            self.bar.iter_mut().for_each(|bar| bar.draw(step, &now));
        }
        let tenths = 10 * step / self.steps;
        if self.plain && step > self.first && tenths > self.tenths {
            self.tenths = tenths;
            let now = self.now(view);
            let (spent, left) = (now.spent_s, now.left_s);
            complain(&format!("{:3} %  {now}  {spent:.1} s spent, {left:.1} s left", 10 * tenths));
        }
        let percent = 100 * step / self.steps;
        if self.events.are_read() && percent > self.percent {
            self.percent = percent;
            self.events.emit("progress", &self.now(view));
        }
        Ok(ControlFlow::Continue(()))
    }
}
