//! What a person at a terminal sees of long work; nothing when standard error is no terminal.

use std::time::Duration;

use indicatif::ProgressBar;

const REDRAW: Duration = Duration::from_millis(100);

/// One line that says what is being done, gone when it is done.
pub struct Progress(ProgressBar);

impl Progress {
    /// On standard error.
    pub fn new() -> Self {
        Self(ProgressBar::new_spinner())
    }

    /// The next piece of work begins.
    pub fn stage(&self, what: String) {
        self.0.set_message(what);
        self.0.enable_steady_tick(REDRAW);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
