//! The hardware's blocks: one file each, with what a design decides of it.
//!
//! The Verilog of a block is the same in every design (`hdl-gen/rtl`). Its file here states the parameters of its
//! instance, and whatever else the plan has to know of it: latencies, memories, multipliers.

pub mod registers;

use std::fmt::Write;

use serde::{Serialize, Serializer};

/// Parameters of an instance: names and Verilog expressions, in the order of the module's declaration.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Parameters(Vec<(&'static str, String)>);

impl Parameters {
    /// None yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// A number, as a plain decimal one of at most 32 bits.
    #[must_use]
    pub fn number(self, name: &'static str, value: i64) -> Self {
        self.expression(name, value.to_string())
    }

    /// A count or a width.
    #[must_use]
    pub fn count(self, name: &'static str, value: usize) -> Self {
        self.expression(name, value.to_string())
    }

    /// 1 or 0.
    #[must_use]
    pub fn flag(self, name: &'static str, value: bool) -> Self {
        self.number(name, i64::from(value))
    }

    /// A number of a stated width, for those of more than 32 bits, with its sign.
    #[must_use]
    pub fn wide(self, name: &'static str, bits: u32, value: i64) -> Self {
        let sign = if value < 0 { "-" } else { "" };
        self.expression(name, format!("{sign}{bits}'sd{}", value.unsigned_abs()))
    }

    /// A table: numbers of `bits` bits each, the first in the lowest bits, each with a comment that says what it is of.
    #[must_use]
    pub fn table(self, name: &'static str, bits: u32, entries: &[(u64, String)]) -> Self {
        let mut text = "{".to_owned();
        for (index, (value, comment)) in entries.iter().enumerate().rev() {
            let comma = if index == 0 { "" } else { "," };
            let comment = if comment.is_empty() { String::new() } else { format!(" // {index}: {comment}") };
            // Writing to a string cannot fail.
            let _ = write!(text, "\n            {bits}'d{value}{comma}{comment}");
        }
        self.expression(name, text + "\n        }")
    }

    /// Any expression, for instance a parameter of the module around it.
    #[must_use]
    pub fn expression(mut self, name: &'static str, value: impl Into<String>) -> Self {
        self.0.push((name, value.into()));
        self
    }

    /// `#(` to `) ` as it stands between module and instance, for an instance that is indented once; nothing without
    /// parameters.
    pub fn verilog(&self) -> String {
        if self.0.is_empty() {
            return String::new();
        }
        let width = self.0.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
        let lines: Vec<String> =
            self.0.iter().map(|(name, value)| format!("        .{name:width$} ({value})")).collect();
        format!("#(\n{}\n    ) ", lines.join(",\n"))
    }
}

impl Serialize for Parameters {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.verilog())
    }
}

#[cfg(test)]
mod tests {
    use super::Parameters;

    #[test]
    fn parameters_read_as_verilog() {
        let entries = [(3, "first".to_owned()), (5, String::new())];
        let parameters = Parameters::new().count("ROWS", 10).wide("BOUND", 40, -7).table("LENGTHS", 8, &entries);
        let expected = "#(\n        .ROWS    (10),\n        .BOUND   (-40'sd7),\n        .LENGTHS ({\n            8'd5,\n            \
                        8'd3 // 0: first\n        })\n    ) ";
        assert_eq!(parameters.verilog(), expected);
        assert_eq!(Parameters::new().verilog(), "");
    }
}
