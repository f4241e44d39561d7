//! A bar on a terminal, with the time left; a build without the feature `terminal` has none, and says plain lines.

#[cfg(feature = "terminal")]
pub use drawn::Bar;
#[cfg(not(feature = "terminal"))]
pub use missing::Bar;

#[cfg(feature = "terminal")]
mod drawn {
    use std::time::{Duration, Instant};

    use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

    /// How often the bar is redrawn.
    const REDRAW: Duration = Duration::from_millis(100);

    /// The bar, on standard error.
    pub struct Bar {
        bar: ProgressBar,
        drawn: Instant,
    }

    impl Bar {
        /// A bar of `steps`.
        pub fn new(steps: u64) -> Option<Self> {
            let style = "{bar:40} {percent:>3} %  {eta} left  {msg}";
            let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::stderr());
            let bar = bar.with_style(ProgressStyle::with_template(style).expect("a fixed template"));
            Some(Self { bar, drawn: Instant::now() })
        }

        /// Whether it is time to draw it again.
        pub fn is_due(&self) -> bool {
            self.drawn.elapsed() >= REDRAW
        }

        /// Draws it at `step`, with a message.
        pub fn draw(&mut self, step: u64, message: &str) {
            self.drawn = Instant::now();
            self.bar.set_position(step);
            self.bar.set_message(message.to_owned());
        }

        /// Clears it.
        pub fn finish(&self) {
            self.bar.finish_and_clear();
        }
    }
}

#[cfg(not(feature = "terminal"))]
mod missing {
    /// There is none.
    pub enum Bar {}

    impl Bar {
        /// None.
        pub fn new(_steps: u64) -> Option<Self> {
            None
        }

        /// Never called.
        pub fn is_due(&self) -> bool {
            match *self {}
        }

        /// Never called.
        pub fn draw(&mut self, _step: u64, _message: &str) {
            match *self {}
        }

        /// Never called.
        pub fn finish(&self) {
            match *self {}
        }
    }
}
