//! Boards with a Zynq, as data: what the block design and the device tree say of each.

use serde::{Deserialize, Serialize};

use super::EmitError;

/// Boards that `block_design.tcl` knows, by their word on its command line.
const BOARDS: [(&str, &str); 4] = [
    ("zcu102", include_str!("../../boards/zcu102.toml")),
    ("zcu104", include_str!("../../boards/zcu104.toml")),
    ("kv260", include_str!("../../boards/kv260.toml")),
    ("pynq-z2", include_str!("../../boards/pynq-z2.toml")),
];

/// From the DMA's registers to the core's, in bytes.
const CORE_OFFSET: u32 = 0x1_0000;

/// The IP of a board's processor.
#[derive(Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Processor {
    /// Zynq UltraScale+.
    ZynqUltraPsE,
    /// Zynq-7000.
    #[serde(rename = "processing_system7")]
    ProcessingSystem7,
}

/// A file of `boards/`.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Board {
    /// Its word on the command line, from the file's name.
    #[serde(default)]
    pub name: String,
    pub title: String,
    pub pattern: String,
    pub part: String,
    /// DSP blocks of the part's device.
    pub dsp: usize,
    /// Its RAMB36.
    pub bram36: usize,
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
        let device = |part: &str| part.split('-').next().map(str::to_owned);
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
