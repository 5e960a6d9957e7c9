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
