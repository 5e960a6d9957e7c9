//! Parameters of an instance: names and what stands for them in Verilog.

use std::fmt::Write;

/// Columns that a list has beside its name, and on lines of its own below that.
const BESIDE: usize = 80;
const BELOW: usize = 108;

/// Parameters of an instance, in the order of the module's declaration.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[must_use]
pub struct Parameters(Vec<(&'static str, String)>);

impl Parameters {
    /// None yet.
    pub fn new() -> Self {
        Self::default()
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

    /// A number of at most 32 bits.
    pub fn number(self, name: &'static str, value: i64) -> Self {
        self.with(name, value.to_string())
    }

    /// A count or a width.
    pub fn count(self, name: &'static str, value: usize) -> Self {
        self.number(name, value as i64)
    }

    /// A latency.
    pub fn cycles(self, name: &'static str, value: u64) -> Self {
        self.number(name, value as i64)
    }

    /// 1 or 0.
    pub fn flag(self, name: &'static str, value: bool) -> Self {
        self.number(name, i64::from(value))
    }

    /// A number of a stated width, with its sign.
    pub fn signed(self, name: &'static str, bits: u32, value: i64) -> Self {
        let sign = if value < 0 { "-" } else { "" };
        self.with(name, format!("{sign}{bits}'sd{}", value.unsigned_abs()))
    }

    /// An unsigned number of a stated width.
    pub fn unsigned(self, name: &'static str, bits: u32, value: u64) -> Self {
        self.digits(name, bits, 'd', &value.to_string())
    }

    /// A pattern of so many bits.
    pub fn pattern(self, name: &'static str, bits: u32, value: u64) -> Self {
        self.digits(name, bits, 'h', &format!("{value:0digits$x}", digits = bits as usize / 4))
    }

    /// One bit each, the first lowest.
    pub fn mask(self, name: &'static str, bits: &[bool]) -> Self {
        let digits: String = bits.iter().rev().map(|&bit| if bit { '1' } else { '0' }).collect();
        self.digits(name, bits.len() as u32, 'b', &digits)
    }

    /// An unsigned number of a stated width, by its digits: binary, decimal or hexadecimal as the base `b`, `d` or `h` says.
    pub fn digits(self, name: &'static str, bits: u32, base: char, digits: &str) -> Self {
        self.with(name, format!("{bits}'{base}{digits}"))
    }

    /// Unsigned numbers of `bits` bits each, the first in the lowest bits, each on a line of its own with what it is of.
    pub fn table(self, name: &'static str, bits: u32, entries: &[(u64, String)]) -> Self {
        self.lines(name, entries, |value| format!("{bits}'d{value}"))
    }

    /// The same of 32 bits each in hexadecimal.
    pub fn words(self, name: &'static str, entries: &[(u64, String)]) -> Self {
        self.lines(name, entries, |value| format!("32'h{value:08x}"))
    }

    fn lines(self, name: &'static str, entries: &[(u64, String)], shown: impl Fn(u64) -> String) -> Self {
        let mut text = "{".to_owned();
        let mut left = entries;
        while let Some(((value, comment), before)) = left.split_last() {
            // Of entries without a comment those that are alike stand in one line.
            let is_alike = |entry: &&(u64, String)| comment.is_empty() && entry.1.is_empty() && entry.0 == *value;
            let alike = 1 + before.iter().rev().take_while(is_alike).count();
            left = &left[..left.len() - alike];
            let comma = if left.is_empty() { "" } else { "," };
            let number = if alike > 1 { format!("{{{alike}{{{}}}}}", shown(*value)) } else { shown(*value) };
            let comment = if comment.is_empty() { String::new() } else { format!(" // {}: {comment}", left.len()) };
            // Writing to a string cannot fail.
            let _ = write!(text, "\n            {number}{comma}{comment}");
        }
        self.with(name, text + "\n        }")
    }

    /// Unsigned numbers of `bits` bits each, the first in the lowest bits.
    pub fn list(self, name: &'static str, bits: u32, numbers: impl IntoIterator<Item = u64>) -> Self {
        self.listed(name, numbers.into_iter().map(|number| format!("{bits}'d{number}")))
    }

    /// Numbers of `bits` bits each in two's complement, the first in the lowest bits.
    pub fn numbers(self, name: &'static str, bits: u32, numbers: impl IntoIterator<Item = i64>) -> Self {
        self.list(name, bits, numbers.into_iter().map(|number| (number & ((1 << bits) - 1)).cast_unsigned()))
    }

    /// A text.
    pub fn text(self, name: &'static str, text: &str) -> Self {
        self.with(name, format!("\"{text}\""))
    }

    /// Texts of as many characters each, the first in the lowest bits.
    pub fn texts(self, name: &'static str, texts: impl IntoIterator<Item = String>) -> Self {
        self.listed(name, texts.into_iter().map(|text| format!("\"{text}\"")))
    }

    /// The parameter of the same name of the module around the instance.
    pub fn outer(self, name: &'static str) -> Self {
        self.with(name, name.to_owned())
    }

    /// Also those of `of`, if there is one.
    pub fn some<T>(self, of: Option<T>, parameters: impl FnOnce(Self, T) -> Self) -> Self {
        match of {
            Some(of) => parameters(self, of),
            None => self,
        }
    }

    /// Also others on a condition.
    pub fn when(self, condition: bool, parameters: impl FnOnce(Self) -> Self) -> Self {
        if condition { parameters(self) } else { self }
    }

    /// The first value in the lowest bits.
    fn listed(self, name: &'static str, values: impl Iterator<Item = String>) -> Self {
        let mut values: Vec<String> = values.collect();
        values.reverse();
        let whole = values.join(", ");
        if whole.len() <= BESIDE {
            return self.with(name, format!("{{{whole}}}"));
        }
        let longest = values.iter().map(String::len).max().unwrap_or(0);
        let lines: Vec<String> =
            values.chunks((BELOW / (longest + 2)).max(1)).map(|values| values.join(", ")).collect();
        self.with(name, format!("{{\n            {}\n        }}", lines.join(",\n            ")))
    }

    fn with(mut self, name: &'static str, value: String) -> Self {
        self.0.push((name, value));
        self
    }
}

#[cfg(test)]
mod tests {
    use super::Parameters;

    #[test]
    fn parameters_read_as_verilog() {
        let entries = [(3, "first".to_owned()), (5, String::new())];
        let parameters = Parameters::new().count("ROWS", 10).signed("BOUND", 40, -7).table("LENGTHS", 8, &entries);
        let expected = "#(\n        .ROWS    (10),\n        .BOUND   (-40'sd7),\n        .LENGTHS ({\n            8'd5,\n            \
                        8'd3 // 0: first\n        })\n    ) ";
        assert_eq!(parameters.verilog(), expected);
        assert_eq!(Parameters::new().verilog(), "");
        let bare = Parameters::new().list("WAITS", 4, [1, 2]);
        assert_eq!(bare.verilog(), "#(\n        .WAITS ({4'd2, 4'd1})\n    ) ");
        let many = Parameters::new().numbers("KNOTS", 4, [-1; 16]).verilog();
        let fifteen = ["4'd15"; 15].join(", ");
        assert_eq!(
            many,
            format!("#(\n        .KNOTS ({{\n            {fifteen},\n            4'd15\n        }})\n    ) ")
        );
    }
}
