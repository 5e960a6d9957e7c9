//! What a command has to say, and how it is shown.

use std::error::Error;

use golden::output::print_text;
use serde::Serialize;

/// Text for standard output, and what is wrong, for standard error.
#[derive(Debug, Default)]
pub struct Message {
    /// The report.
    pub text: String,
    /// Each is an error of its own; with any the exit code is 1.
    pub faults: Vec<String>,
}

/// A message, or why there is none.
pub type Result = std::result::Result<Message, Box<dyn Error>>;

impl From<String> for Message {
    fn from(text: String) -> Self {
        Self { text, faults: Vec::new() }
    }
}

/// The value as JSON where that was asked for, else the text for people.
///
/// # Errors
///
/// When the value has no JSON.
pub fn json_or<T: Serialize>(
    value: &T,
    json: bool,
    text: impl FnOnce(&T) -> String,
) -> std::result::Result<String, serde_json::Error> {
    if json { Ok(serde_json::to_string_pretty(value)? + "\n") } else { Ok(text(value)) }
}

/// Prints a message and returns the exit code.
pub fn show(message: Result) -> u8 {
    let printed = message.and_then(|Message { text, faults }| Ok(print_text(&text).map(|()| faults)?));
    let faults = printed.unwrap_or_else(|error| vec![error.to_string()]);
    for fault in &faults {
        eprintln!("error: {fault}");
    }
    u8::from(!faults.is_empty())
}

/// Adds a line to a text, formatted like `println!`.
macro_rules! say {
    ($text:expr, $($part:tt)*) => {{
        use std::fmt::Write as _;
        // Writing to a String cannot fail.
        let _ = writeln!($text, $($part)*);
    }};
}
pub(crate) use say;
