//! What a person at a terminal sees of long work. Nothing is drawn when standard error is not a terminal.

use std::borrow::Cow;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

const REDRAW: Duration = Duration::from_millis(100);

/// One line that changes.
#[derive(Clone, Debug)]
pub struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// On standard error.
    pub fn new() -> Self {
        let bar = ProgressBar::new_spinner();
        bar.enable_steady_tick(REDRAW);
        Self { bar }
    }

    /// Silent, for machines and tests.
    pub fn hidden() -> Self {
        Self { bar: ProgressBar::hidden() }
    }

    /// Work of unknown length begins.
    pub fn stage(&self, what: impl Into<Cow<'static, str>>) {
        self.bar.set_message(what);
    }

    /// Work of a known number of frames begins.
    pub fn counted(&self, what: impl Into<Cow<'static, str>>, steps: u64) {
        self.counted_in("frames", what, steps);
    }

    /// Work of a known number of `unit` begins.
    pub fn counted_in(&self, unit: &str, what: impl Into<Cow<'static, str>>, steps: u64) {
        if let Ok(style) =
            ProgressStyle::with_template(&format!("{{msg}} {{wide_bar}} {{pos}}/{{len}} {unit}, {{eta}} left"))
        {
            self.bar.set_style(style);
        }
        self.bar.set_length(steps);
        self.bar.set_position(0);
        self.bar.set_message(what);
    }

    /// One step of it is done.
    pub fn step(&self) {
        self.bar.inc(1);
    }
}

impl Default for Progress {
    fn default() -> Self {
        Self::new()
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
