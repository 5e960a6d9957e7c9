//! Parameters of an instance as Verilog has them.

use std::fmt::Write;

use crate::parameters::{Base, Parameters, Value};

/// `#(` to `) ` as it stands between module and instance, for an instance that is indented once; nothing without
/// parameters.
pub(super) fn verilog(parameters: &Parameters) -> String {
    let entries = parameters.entries();
    if entries.is_empty() {
        return String::new();
    }
    let width = entries.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let line = |(name, value): &(&str, Value)| format!("        .{name:width$} ({})", expression(name, value));
    let lines: Vec<String> = entries.iter().map(line).collect();
    format!("#(\n{}\n    ) ", lines.join(",\n"))
}

fn expression(name: &str, value: &Value) -> String {
    match value {
        Value::Number(value) => value.to_string(),
        Value::Signed { bits, value } => signed(*bits, *value),
        Value::Digits { bits, base, digits } => {
            let base = match base {
                Base::Binary => 'b',
                Base::Decimal => 'd',
                Base::Hexadecimal => 'h',
            };
            format!("{bits}'{base}{digits}")
        }
        Value::Table { bits, entries } => table(*bits, entries),
        Value::Numbers { bits, numbers } => lines_of_numbers(*bits, numbers),
        Value::Text(text) => format!("\"{text}\""),
        Value::Texts(texts) => {
            let texts: Vec<String> = texts.iter().rev().map(|text| format!("\"{text}\"")).collect();
            format!("{{{}}}", texts.join(", "))
        }
        Value::Outer => name.to_owned(),
    }
}

fn signed(bits: u32, value: i64) -> String {
    let sign = if value < 0 { "-" } else { "" };
    format!("{sign}{bits}'sd{}", value.unsigned_abs())
}

/// Each number on a line of its own if there are comments that say what it is of.
fn table(bits: u32, entries: &[(u64, String)]) -> String {
    if entries.iter().all(|(_, comment)| comment.is_empty()) {
        let values: Vec<String> = entries.iter().rev().map(|(value, _)| format!("{bits}'d{value}")).collect();
        return format!("{{{}}}", values.join(", "));
    }
    // Of entries without a comment those that are alike stand in one line.
    let mut text = "{".to_owned();
    let mut left = entries;
    while let Some(((value, comment), before)) = left.split_last() {
        let is_alike = |entry: &&(u64, String)| comment.is_empty() && entry.1.is_empty() && entry.0 == *value;
        let alike = 1 + before.iter().rev().take_while(is_alike).count();
        left = &left[..left.len() - alike];
        let comma = if left.is_empty() { "" } else { "," };
        let number = if alike > 1 { format!("{{{alike}{{{bits}'d{value}}}}}") } else { format!("{bits}'d{value}") };
        let comment = if comment.is_empty() { String::new() } else { format!(" // {}: {comment}", left.len()) };
        // Writing to a string cannot fail.
        let _ = write!(text, "\n            {number}{comma}{comment}");
    }
    text + "\n        }"
}

/// Some on each line.
fn lines_of_numbers(bits: u32, numbers: &[i64]) -> String {
    const ON_A_LINE: usize = 7;
    let unsigned = |number: &i64| number & ((1 << bits) - 1);
    let numbers: Vec<String> = numbers.iter().rev().map(|number| format!("{bits}'d{}", unsigned(number))).collect();
    let lines: Vec<String> = numbers.chunks(ON_A_LINE).map(|numbers| numbers.join(", ")).collect();
    format!("{{\n            {}\n        }}", lines.join(",\n            "))
}

#[cfg(test)]
mod tests {
    use super::{Parameters, verilog};

    #[test]
    fn parameters_read_as_verilog() {
        let entries = [(3, "first".to_owned()), (5, String::new())];
        let parameters =
            Parameters::new().count("ROWS", 10).signed("BOUND", 40, -7).table("LENGTHS", 8, entries.to_vec());
        let expected = "#(\n        .ROWS    (10),\n        .BOUND   (-40'sd7),\n        .LENGTHS ({\n            8'd5,\n            \
                        8'd3 // 0: first\n        })\n    ) ";
        assert_eq!(verilog(&parameters), expected);
        assert_eq!(verilog(&Parameters::new()), "");
        let bare = Parameters::new().list("WAITS", 4, [1, 2]);
        assert_eq!(verilog(&bare), "#(\n        .WAITS ({4'd2, 4'd1})\n    ) ");
    }
}
