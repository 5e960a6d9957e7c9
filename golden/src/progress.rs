//! What is seen of long work on standard error: on a terminal one line that changes, elsewhere a line every ten seconds.

use std::borrow::Cow;
use std::io::IsTerminal;
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

const REDRAW: Duration = Duration::from_millis(100);
/// Between the lines of a log.
const PERIOD: Duration = Duration::from_secs(10);

/// Says how far work is, until it is dropped.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    /// Who writes the lines where nobody sees the bar, and what ends it.
    log: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Progress {
    /// On standard error.
    pub fn new() -> Self {
        if std::io::stderr().is_terminal() {
            let bar = ProgressBar::new_spinner();
            bar.enable_steady_tick(REDRAW);
            return Self { bar, log: None };
        }
        Self::logged(PERIOD, |line| eprintln!("{line}"))
    }

    /// On standard error, for one piece of work of unknown length.
    pub fn of(what: &'static str) -> Self {
        let progress = Self::new();
        progress.stage(what);
        progress
    }

    /// Silent, for machines and tests.
    pub fn hidden() -> Self {
        Self { bar: ProgressBar::hidden(), log: None }
    }

    /// A line after every `period`.
    fn logged(period: Duration, write: impl Fn(String) + Send + 'static) -> Self {
        // Without an end of its own until it is counted.
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        let (end, ended) = mpsc::channel();
        let seen = bar.clone();
        let begin = Instant::now();
        let writer = thread::spawn(move || {
            while ended.recv_timeout(period) == Err(RecvTimeoutError::Timeout) {
                write(line(&seen.message(), seen.position(), seen.length(), begin.elapsed()));
            }
        });
        Self { bar, log: Some((end, writer)) }
    }

    /// Work of unknown length begins.
    pub fn stage(&self, what: impl Into<Cow<'static, str>>) {
        if self.bar.length().is_some() {
            self.bar.set_style(ProgressStyle::default_spinner());
            self.bar.unset_length();
        }
        self.bar.set_position(0);
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
        if let Some((end, writer)) = self.log.take() {
            drop(end);
            // A writer that panicked has no more to say.
            let _ = writer.join();
        }
    }
}

/// A line of a log: what is done, how much of it, since when.
fn line(what: &str, done: u64, of: Option<u64>, elapsed: Duration) -> String {
    let seconds = elapsed.as_secs();
    match of {
        Some(of) => format!("{what}: {done} of {of}, {seconds} s"),
        None => format!("{what}, {seconds} s"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_says_what_is_done_and_ends_with_the_work() {
        let (say, said) = mpsc::channel();
        let progress = Progress::logged(Duration::from_millis(20), move |line| drop(say.send(line)));
        // Lines of what was done before may still come.
        let says = |begin: &str| {
            let mut lines = (0..1000).map(|_| said.recv_timeout(Duration::from_mins(1)).unwrap());
            assert!(lines.any(|line| line.starts_with(begin)), "no {begin}");
        };
        progress.stage("planning");
        says("planning, ");
        progress.counted_in("points", "sweeping", 7);
        (0..3).for_each(|_| progress.step());
        says("sweeping: 3 of 7, ");
        progress.stage("drawing");
        says("drawing, ");
        drop(progress);
        said.try_iter().for_each(drop);
        assert_eq!(said.recv(), Err(mpsc::RecvError), "nothing more");
    }

    #[test]
    fn lines_count_where_there_is_something_to_count() {
        let minute = Duration::from_mins(1);
        assert_eq!(line("matrices", 0, None, minute), "matrices, 60 s");
        assert_eq!(line("sweeping", 12, Some(496), minute), "sweeping: 12 of 496, 60 s");
    }
}
