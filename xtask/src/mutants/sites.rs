//! Where the emitted design can be made wrong, and how: one small change each.

use std::fmt;
use std::path::Path;

use serde::Serialize;

use testbench::verilate::RtlSources;

/// Kinds of changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// A number one larger or one smaller: a constant, an address, a bound, a shift.
    Number,
    /// An addition for a subtraction, or the other way round.
    Sum,
    /// A comparison for another.
    Comparison,
    /// And for or, or the other way round.
    Logic,
    /// A condition negated.
    Condition,
    /// The two sides of a choice swapped: a clipping, a multiplexer.
    Choice,
    /// Always the same side of a choice: a clipping that is dropped.
    Side,
    /// The operands of a subtraction swapped.
    Operands,
    /// An assignment in a clocked block left out: a clear, a step, a hold.
    Assignment,
    /// A ready or valid that never changes.
    Stuck,
    /// A bit of a ROM word.
    Rom,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::Number,
        Self::Sum,
        Self::Comparison,
        Self::Logic,
        Self::Condition,
        Self::Choice,
        Self::Side,
        Self::Operands,
        Self::Assignment,
        Self::Stuck,
        Self::Rom,
    ];
}

/// One possible change of one line of a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Mutation {
    /// What kind.
    pub kind: Kind,
    /// The file.
    pub file: String,
    /// Its line, from 1.
    pub line: usize,
    /// The line as generated, without indentation.
    pub before: String,
    /// The line instead.
    pub after: String,
}

impl fmt::Display for Mutation {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}:{}: `{}` became `{}`", self.file, self.line, self.before, self.after)
    }
}

impl Mutation {
    /// The design with this change.
    pub fn apply(&self, sources: &RtlSources) -> RtlSources {
        let mut mutant = sources.clone();
        if let Some(contents) = mutant.files.get_mut(&self.file) {
            let text = String::from_utf8_lossy(contents);
            let changed = text.lines().enumerate().map(|(index, line)| {
                let line =
                    if index + 1 == self.line { line.replacen(&self.before, &self.after, 1) } else { line.into() };
                line + "\n"
            });
            *contents = changed.collect::<String>().into_bytes();
        }
        mutant
    }
}

/// Every possible change of a design, in the order of its files.
pub fn all(sources: &RtlSources) -> Vec<Mutation> {
    let mut found = Vec::new();
    for (file, contents) in &sources.files {
        let text = String::from_utf8_lossy(contents);
        let verilog = Path::new(file).extension().is_some_and(|ending| ending == "v");
        // Checks that only simulation has are no part of the hardware.
        let mut hardware = true;
        for (index, line) in text.lines().enumerate() {
            match line.trim() {
                "`ifdef SIMULATION" => hardware = false,
                "`endif" => hardware = true,
                _ => {}
            }
            if !hardware {
                continue;
            }
            let changes = if verilog { verilog_changes(line) } else { rom_changes(line, index) };
            found.extend(changes.into_iter().map(|(kind, after)| Mutation {
                kind,
                file: file.clone(),
                line: index + 1,
                before: line.trim().to_owned(),
                after: after.trim().to_owned(),
            }));
        }
    }
    found.retain(|mutation| mutation.before != mutation.after && !mutation.before.is_empty());
    found
}

/// A bit of the word flips; which one depends on its place, so that all positions come.
fn rom_changes(line: &str, index: usize) -> Vec<(Kind, String)> {
    let mut digits: Vec<char> = line.trim().chars().collect();
    if digits.is_empty() || !digits.iter().all(char::is_ascii_hexdigit) {
        return Vec::new();
    }
    let place = digits.len() - 1 - index % digits.len().min(4);
    let value = digits[place].to_digit(16).unwrap_or_default() ^ 1;
    digits[place] = char::from_digit(value, 16).unwrap_or('0');
    vec![(Kind::Rom, digits.into_iter().collect())]
}

fn verilog_changes(line: &str) -> Vec<(Kind, String)> {
    let code = line.split("//").next().unwrap_or_default();
    let trimmed = code.trim();
    let skip = [
        "input",
        "output",
        "module",
        "genvar",
        "(*",
        "`",
        "parameter",
        ".",
        "localparam [1:0] ",
        "localparam [2:0] ",
        "for (",
    ];
    if trimmed.is_empty()
        || trimmed.contains("_unused")
        || trimmed.contains("begin : gen_check")
        || skip.iter().any(|start| trimmed.starts_with(start))
    {
        return Vec::new();
    }
    let mut changes = numbers(code);
    for (kind, from, to) in [
        (Kind::Sum, " + ", " - "),
        (Kind::Sum, " - ", " + "),
        (Kind::Comparison, " == ", " != "),
        (Kind::Comparison, " != ", " == "),
        (Kind::Comparison, " < ", " <= "),
        (Kind::Comparison, " > ", " >= "),
        (Kind::Comparison, " >= ", " > "),
        (Kind::Logic, " && ", " || "),
        (Kind::Logic, " || ", " && "),
        (Kind::Logic, " & ", " | "),
        (Kind::Logic, " | ", " & "),
    ] {
        changes.extend(code.match_indices(from).map(|(at, _)| {
            let (head, tail) = (&code[..at], &code[at + from.len()..]);
            (kind, format!("{head}{to}{tail}"))
        }));
    }
    changes.extend(code.match_indices(" - ").filter_map(|(at, minus)| swapped(code, at, minus.len())));
    if let Some(condition) = trimmed.strip_prefix("if (").and_then(|rest| rest.strip_suffix(") begin")) {
        changes.push((Kind::Condition, format!("if (!({condition})) begin")));
    }
    if let (Some((target, expression)), true) = (assignment(trimmed), trimmed.ends_with(';')) {
        if let Some((question, sides)) = expression.split_once(" ? ").filter(|(question, _)| balanced(question)) {
            changes.push((Kind::Choice, format!("{target}!({question}) ? {sides}")));
            let plain = |side: &&str| balanced(side) && !side.contains('?');
            if let Some((yes, no)) = sides.split_once(" : ").filter(|(yes, no)| plain(yes) && plain(no)) {
                changes.push((Kind::Side, format!("{target}{yes};")));
                changes.push((Kind::Side, format!("{target}{no}")));
            }
        }
        if target.ends_with(" <= ") {
            changes.push((Kind::Assignment, "// left out".to_owned()));
        }
        let stream = ["ready", "valid"].iter().any(|word| target.contains(word));
        if target.starts_with("assign ") && stream && !target.contains('[') {
            changes.push((Kind::Stuck, format!("{target}1'b1;")));
            changes.push((Kind::Stuck, format!("{target}1'b0;")));
        }
    }
    changes
}

/// The line with the operands of the subtraction at `at` swapped, where both are plain names or bits of them.
fn swapped(code: &str, at: usize, length: usize) -> Option<(Kind, String)> {
    let part = |letter: char| !(letter.is_ascii_alphanumeric() || "_[]:".contains(letter));
    let from = code[..at].rfind(part).map_or(0, |before| before + 1);
    let rest = &code[at + length..];
    let end = rest.find(part).unwrap_or(rest.len());
    let (left, right) = (&code[from..at], &rest[..end]);
    let name = |text: &str| text.starts_with(|letter: char| letter.is_ascii_alphabetic()) && balanced(text);
    (name(left) && name(right) && left != right)
        .then(|| (Kind::Operands, format!("{}{right} - {left}{}", &code[..from], &rest[end..])))
}

/// An assignment's target with its sign, and its expression.
fn assignment(code: &str) -> Option<(&str, &str)> {
    let at = code.find(" = ").map(|at| at + 3).or_else(|| code.find(" <= ").map(|at| at + 4))?;
    let (target, expression) = code.split_at(at);
    let plain = !target.starts_with("if") && !target.starts_with("for") && !target.contains('?') && balanced(target);
    plain.then_some((target, expression))
}

fn balanced(text: &str) -> bool {
    [('(', ')'), ('{', '}'), ('[', ']')]
        .into_iter()
        .all(|(open, close)| text.matches(open).count() == text.matches(close).count())
}

/// Each number with a width, such as 4'd9, one larger and one smaller.
fn numbers(code: &str) -> Vec<(Kind, String)> {
    let mut changes = Vec::new();
    for (at, mark) in ["'d", "'sd"].into_iter().flat_map(|mark| code.match_indices(mark)) {
        let digits = &code[at + mark.len()..];
        let end = digits.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(digits.len());
        let width_at = code[..at].rfind(|letter: char| !letter.is_ascii_digit()).map_or(0, |before| before + 1);
        let (Ok(value), Ok(width)) = (digits[..end].parse::<u128>(), code[width_at..at].parse::<u32>()) else {
            continue;
        };
        let largest = if width > 100 { u128::MAX } else { (1u128 << (width - u32::from(mark == "'sd")).max(1)) - 1 };
        let head = &code[..at + mark.len()];
        let tail = &digits[end..];
        let smaller = value.checked_sub(1);
        let larger = Some(value + 1).filter(|&larger| larger <= largest);
        changes.extend([larger, smaller].into_iter().flatten().map(|n| (Kind::Number, format!("{head}{n}{tail}"))));
    }
    changes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn changes(line: &str) -> Vec<String> {
        verilog_changes(line).into_iter().map(|(_, after)| after.trim().to_owned()).collect()
    }

    #[test]
    fn numbers_stay_within_their_width() {
        assert_eq!(changes("    wire last = count[3:0] ^ 2'd3;"), ["wire last = count[3:0] ^ 2'd2;"]);
        assert_eq!(changes("    x <= 1'd0;"), ["x <= 1'd1;", "// left out"]);
    }

    #[test]
    fn each_operator_is_changed_in_its_turn() {
        let found = changes("assign ready = a && b || c;");
        let expected = [
            "assign ready = a || b || c;",
            "assign ready = a && b && c;",
            "assign ready = 1'b1;",
            "assign ready = 1'b0;",
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn sides_of_a_choice_are_swapped() {
        let found = changes("y <= above ? top : sum;");
        assert_eq!(found, ["y <= !(above) ? top : sum;", "y <= top;", "y <= sum;", "// left out"]);
        assert_eq!(changes("if (go) begin"), ["if (!(go)) begin"]);
    }

    #[test]
    fn operands_of_a_subtraction_are_swapped() {
        assert!(changes("d = sum[7:0] - part;").contains(&"d = part - sum[7:0];".to_owned()));
        let expected = ["d = a + {1'b0, b};", "d = a - {1'd0, b};"];
        assert!(changes("d = a - {1'b0, b};").iter().all(|change| expected.contains(&change.as_str())));
    }

    #[test]
    fn comments_ports_and_unused_bits_are_left_alone() {
        for line in ["// a && b", "input wire [3:0] a, // 4'd3", "wire _unused = &{1'b0, a && b};", ".WIDTH (4'd3),"] {
            assert!(changes(line).is_empty(), "{line}");
        }
    }

    #[test]
    fn checks_of_the_simulation_are_left_alone() {
        let text = "a <= b + c;\n`ifdef SIMULATION\nif (d) begin\n`endif\ne <= f;\n";
        let files = [("rtl/t.v".to_owned(), text.as_bytes().to_vec())].into_iter().collect();
        let found = all(&RtlSources { top: "t".to_owned(), files });
        let lines: Vec<usize> = found.iter().map(|mutation| mutation.line).collect();
        assert_eq!(lines, [1, 1, 5]);
    }

    #[test]
    fn a_rom_word_keeps_its_length() {
        assert_eq!(rom_changes("3fa0", 0), [(Kind::Rom, "3fa1".to_owned())]);
        assert_eq!(rom_changes("3fa0", 1), [(Kind::Rom, "3fb0".to_owned())]);
        assert!(rom_changes("// comment", 0).is_empty());
    }
}
