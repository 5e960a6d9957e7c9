//! Boards with a Zynq, as data: what the block design and the device tree say of each.

use std::path::Path;

use golden::design::{DesignError, syntax_position};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::EmitError;

/// Boards that `block_design.tcl` knows, by their word on its command line.
const BOARDS: [(&str, &str); 4] = [
    ("zcu102", include_str!("../../boards/zcu102.toml")),
    ("zcu104", include_str!("../../boards/zcu104.toml")),
    ("kv260", include_str!("../../boards/kv260.toml")),
    ("pynq-z2", include_str!("../../boards/pynq-z2.toml")),
];

/// Other words on that command line.
const WORDS: [&str; 2] = ["bitstream", "queue"];

/// What Tcl or a device tree would take for something else than a letter.
const SPECIAL: [char; 10] = ['{', '}', '[', ']', '(', ')', '"', '\\', '$', ';'];

/// From the DMA's registers to the core's, in bytes.
const CORE_OFFSET: u32 = 0x1_0000;

/// The IP of a board's processor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Processor {
    /// Zynq UltraScale+.
    ZynqUltraPsE,
    /// Zynq-7000.
    #[serde(rename = "processing_system7")]
    ProcessingSystem7,
}

/// Why a file is no board's.
#[derive(Debug, Error)]
pub enum BoardError {
    /// Its text is not that of a board.
    #[error("{0}; the keys are those of hdl-gen/boards/zcu102.toml")]
    Text(DesignError),
    /// A key has a value that no board can have.
    #[error("{file}: {key}: {what}; {remedy}")]
    Value {
        /// The file.
        file: String,
        /// The key, or the file's name.
        key: &'static str,
        /// What is wrong.
        what: String,
        /// What to do.
        remedy: &'static str,
    },
}

/// A file of `boards/`, or of a user's own.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Board {
    /// Its word on the command line, from the file's name.
    #[serde(skip_deserializing)]
    pub name: String,
    /// What people call it.
    pub title: String,
    /// Its name among the board parts of Vivado, with `*` for what differs between versions.
    pub pattern: String,
    /// Of a module on a carrier, what Vivado's `board_connections` says of them; else nothing.
    #[serde(default)]
    pub connection: String,
    /// Its part, as in `hardware.part`.
    pub part: String,
    /// DSP blocks of the part's device.
    pub dsp: usize,
    /// Its RAMB36.
    pub bram36: usize,
    /// IP of its processor.
    pub processor: Processor,
    /// Where the processor sees the DMA's registers.
    pub registers: u32,
}

impl Board {
    /// Every board there is.
    ///
    /// # Errors
    /// [`EmitError::Board`] if a board's file is wrong.
    pub fn all() -> Result<Vec<Self>, EmitError> {
        let read = |&(name, text): &(&str, &str)| {
            toml::from_str(text).map(|board: Self| Self { name: name.to_owned(), ..board }).map_err(EmitError::Board)
        };
        BOARDS.iter().map(read).collect()
    }

    /// A user's own board, from the text of the file at `path`, whose name is the board's.
    ///
    /// # Errors
    /// [`BoardError`] if a key is missing, unknown or has a value that no board can have.
    pub fn from_toml(text: &str, path: &Path) -> Result<Self, BoardError> {
        let file = path.display().to_string();
        let board: Self =
            toml::from_str(text).map_err(|error| BoardError::Text(syntax_position(&error, text, &file)))?;
        let name = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default().to_owned();
        let board = Self { name, ..board };
        board.check().map_err(|(key, what, remedy)| BoardError::Value { file, key, what, remedy })?;
        Ok(board)
    }

    /// Key, what is wrong with its value, and what to do about it.
    fn check(&self) -> Result<(), (&'static str, String, &'static str)> {
        let legal = |character: char| character.is_ascii_lowercase() || character.is_ascii_digit() || character == '-';
        if self.name.is_empty() || !self.name.chars().all(legal) {
            let remedy = "name the file in small letters, digits and hyphens: it is the board's word on command lines";
            return Err(("file name", format!("is {:?}", self.name), remedy));
        }
        if WORDS.contains(&&*self.name) || BOARDS.iter().any(|&(name, _)| name == self.name) {
            return Err(("file name", format!("{:?} has a meaning already", self.name), "give the file another name"));
        }
        let texts = [
            ("title", &self.title),
            ("pattern", &self.pattern),
            ("connection", &self.connection),
            ("part", &self.part),
        ];
        for (key, value) in texts {
            let special = |character: char| character.is_control() || SPECIAL.contains(&character);
            let spaced = ["pattern", "part"].contains(&key) && value.contains(' ');
            let missing = value.trim().is_empty() && key != "connection";
            if missing || spaced || value.contains(special) {
                let remedy = "write plain letters, in a pattern also `*`, as in hdl-gen/boards/zcu102.toml";
                return Err((key, format!("is {value:?}"), remedy));
            }
        }
        for (key, count) in [("dsp", self.dsp), ("bram36", self.bram36)] {
            if count == 0 {
                return Err((key, "is 0".to_owned(), "give the number that the part's data sheet has"));
            }
        }
        let has_room = (1..=u32::MAX - 2 * CORE_OFFSET + 1).contains(&self.registers);
        if !has_room || !self.registers.is_multiple_of(CORE_OFFSET) {
            let remedy = "give an address that the processor's port to registers has, in whole steps of 0x10000";
            return Err(("registers", format!("is {:#X}", self.registers), remedy));
        }
        Ok(())
    }

    /// The first board with the device of `part`, if one here has it: what that device holds.
    pub fn of_device(part: &str) -> Option<Self> {
        Self::all().ok()?.into_iter().find(|board| device(&board.part) == device(part))
    }

    /// Where the processor sees the core's registers.
    pub fn core_registers(&self) -> u32 {
        self.registers + CORE_OFFSET
    }

    /// Whether a design for `part` runs on it: speed grade and package are the board's own.
    pub fn has(&self, part: &str) -> bool {
        device(&self.part) == device(part)
    }
}

/// The device of a part's name. AMD's newer names have a hyphen before the package, those of the 7-series do not.
fn device(part: &str) -> &str {
    let before_hyphen = part.split('-').next().unwrap_or(part);
    if !part.starts_with("xc7") {
        return before_hyphen;
    }
    // `xc7z020` of `xc7z020clg400`, `xc7k325t` of `xc7k325tffg900`.
    let digits = before_hyphen.char_indices().skip(4).find(|(_, character)| !character.is_ascii_digit());
    let end = digits.map_or(before_hyphen.len(), |(at, character)| if character == 't' { at + 1 } else { at });
    &before_hyphen[..end]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_device_is_found_whatever_its_package() {
        for (part, expected) in [
            ("xczu9eg-ffvb1156-2-e", Some((2520, 912))),
            ("xczu9eg-ffvc900-1-i", Some((2520, 912))),
            ("xczu7ev-ffvc1156-2-e", Some((1728, 312))),
            ("xck26-sfvc784-2LV-c", Some((1248, 144))),
            ("xc7z020clg400-1", Some((220, 140))),
            ("xc7z020clg484-3", Some((220, 140))),
            ("xc7z010clg400-1", None),
            ("xc7k325tffg900-2", None),
            ("xczu7eg-ffvc1156-2-e", None),
            ("LFE5U-25F-6BG256C", None),
            ("xc7", None),
            ("", None),
        ] {
            assert_eq!(Board::of_device(part).map(|board| (board.dsp, board.bram36)), expected, "{part}");
        }
        assert_eq!(device("xc7k325tffg900-2"), "xc7k325t");
    }
}
