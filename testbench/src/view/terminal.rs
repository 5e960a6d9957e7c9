//! What a terminal can show, and frames that play on it.

use std::io::{self, IsTerminal, Write};
use std::str::FromStr;
use std::time::Duration;

use super::View;

/// Clears the screen; begins in its corner; and after a page, clears what an earlier one left below.
const CLEAR: &str = "\x1b[2J";
const HOME: &str = "\x1b[H";
const CLEAR_LINE: &str = "\x1b[K";
const CLEAR_BELOW: &str = "\x1b[J";

/// Whether standard output is a terminal, and its user has nothing against colours.
pub fn wants_colour() -> bool {
    io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}

/// Characters in a line of the terminal, where standard output is one that says so.
#[cfg(unix)]
pub fn columns() -> Option<usize> {
    let size = rustix::termios::tcgetwinsize(io::stdout()).ok()?;
    (size.ws_col > 0).then(|| usize::from(size.ws_col))
}

/// Characters in a line of the terminal: not known.
#[cfg(not(unix))]
pub fn columns() -> Option<usize> {
    None
}

/// Frames a second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rate(Duration);

/// What to write where a text is not a rate.
const USAGE: &str = "the rate is from 0.1 to 1000 frames a second";

impl FromStr for Rate {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, &'static str> {
        let hertz: f64 = text.parse().map_err(|_| USAGE)?;
        if (0.1..=1000.0).contains(&hertz) { Ok(Self(Duration::from_secs_f64(1.0 / hertz))) } else { Err(USAGE) }
    }
}

/// Shows one frame after the other, all to one scale: in one place of a terminal, at a rate; else page after page.
///
/// # Errors
/// That of standard output.
pub fn play(views: &[View], compact: bool, rate: Rate) -> io::Result<()> {
    let largest = views.iter().map(View::largest).fold(0.0, f64::max);
    let mut out = io::stdout().lock();
    let alone = out.is_terminal() && views.len() > 1;
    for (index, view) in views.iter().enumerate() {
        let page = view.page(largest, compact);
        if alone {
            write!(out, "{}{HOME}", if index == 0 { CLEAR } else { "" })?;
            for line in page.lines() {
                writeln!(out, "{line}{CLEAR_LINE}")?;
            }
            write!(out, "{CLEAR_BELOW}")?;
            out.flush()?;
            if index + 1 < views.len() {
                std::thread::sleep(rate.0);
            }
        } else {
            write!(out, "{}{page}", if index > 0 { "\n" } else { "" })?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_is_a_pause() {
        let pause = |text: &str| text.parse::<Rate>().ok().map(|rate| rate.0);
        assert_eq!(["10", "0.5"].map(pause), [100, 2000].map(|ms| Some(Duration::from_millis(ms))));
        assert_eq!(["0", "-1", "2000", "nan", "fast"].map(pause), [None; 5]);
    }
}
