//! How far a run is: a bar with the time left on a terminal, a plain line per tenth elsewhere.

use std::io::IsTerminal;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use ndda_solver::{Sink, SinkError, View};

use crate::console::complain;

/// How often the bar is redrawn.
const REDRAW: Duration = Duration::from_millis(100);

/// Shows progress on standard error.
pub struct Progress {
    steps: u64,
    bar: Option<ProgressBar>,
    plain: bool,
    started: Instant,
    drawn: Instant,
    tenths: u64,
    /// Step at which this part of the run began.
    first: u64,
}

impl Progress {
    /// Progress from step `first` towards `steps`; shows nothing when `quiet`.
    pub fn new(first: u64, steps: u64, quiet: bool) -> Self {
        let terminal = std::io::stderr().is_terminal();
        let bar = (terminal && !quiet).then(|| {
            let style = "{bar:40} {percent:>3} %  {eta} left  {msg}";
            let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::stderr());
            bar.with_style(ProgressStyle::with_template(style).expect("a fixed template"))
        });
        let now = Instant::now();
        Self {
            steps,
            bar,
            plain: !terminal && !quiet,
            started: now,
            drawn: now,
            tenths: 10 * first / steps.max(1),
            first,
        }
    }

    /// Clears the bar.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

impl Sink for Progress {
    fn step_done(&mut self, view: &mut View) -> Result<ControlFlow<()>, SinkError> {
        let step = view.simulation.state().step;
        if let Some(bar) = &self.bar
            && self.drawn.elapsed() >= REDRAW
        {
            self.drawn = Instant::now();
            bar.set_position(step);
            let (pairs, h) = (view.report.contact.contact_pairs, view.report.h);
            bar.set_message(format!("t = {:.4} s  {pairs} contacts  h = {h:.2}", view.simulation.time_s()));
        }
        let tenths = 10 * step / self.steps;
        if self.plain && step > self.first && tenths > self.tenths {
            self.tenths = tenths;
            let spent = self.started.elapsed().as_secs_f64();
            let left = spent * (self.steps - step) as f64 / (step - self.first) as f64;
            let t = view.simulation.time_s();
            complain(&format!("{:3} %  t = {t:.4} s  {spent:.1} s spent, {left:.1} s left", 10 * tenths));
        }
        Ok(ControlFlow::Continue(()))
    }
}
