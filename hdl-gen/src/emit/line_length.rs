//! Breaks long lines of Verilog. How long a line becomes is decided by widths, names and lists that templates fill in.

/// Longest line that is emitted, in columns.
pub const MOST_COLUMNS: usize = 120;
/// A line is not broken before this column, unless it must be.
const LEAST_COLUMNS: usize = 60;
const STEP: &str = "    ";
/// A line may be broken in front of these; with the space before them they are no part of another token.
const OPERATORS: [&str; 9] = [" || ", " && ", " ? ", " : ", " + ", " - ", " | ", " & ", " ^ "];

/// The same Verilog in lines of at most [`MOST_COLUMNS`], where there is a place to break them.
pub fn wrap(text: &str) -> String {
    let mut lines = Vec::new();
    for line in text.lines() {
        if line.chars().count() <= MOST_COLUMNS {
            lines.push(line.to_owned());
        } else {
            wrap_line(line, &mut lines);
        }
    }
    lines.join("\n") + "\n"
}

fn wrap_line(line: &str, lines: &mut Vec<String>) {
    let indent = &line[..line.len() - line.trim_start().len()];
    let (code, comment) = line.split_at(comment_start(line));
    if !comment.is_empty() {
        wrap_comment(indent, comment, lines);
    }
    let mut rest = code.trim_end().to_owned();
    let continues = OPERATORS.iter().any(|operator| rest.trim_start().starts_with(operator.trim_start()));
    let further = if continues { indent.to_owned() } else { format!("{indent}{STEP}") };
    while let Some(at) = (rest.chars().count() > MOST_COLUMNS).then(|| place(&rest)).flatten() {
        let (line, tail) = rest.split_at(at);
        lines.push(line.trim_end().to_owned());
        rest = format!("{further}{}", tail.trim_start());
    }
    if !rest.trim().is_empty() {
        lines.push(rest);
    }
}

/// A comment in lines of its own; one that stood behind code now stands above it.
fn wrap_comment(indent: &str, comment: &str, lines: &mut Vec<String>) {
    let mut line = String::new();
    for word in comment.split(' ') {
        if indent.len() + line.chars().count() + word.chars().count() + 1 > MOST_COLUMNS {
            lines.push(format!("{indent}{line}"));
            line = format!("// {word}");
        } else {
            line = if line.is_empty() { word.to_owned() } else { format!("{line} {word}") };
        }
    }
    lines.push(format!("{indent}{line}"));
}

/// Where the comment begins, or the end of the line.
fn comment_start(line: &str) -> usize {
    let mut quoted = false;
    for (at, byte) in line.bytes().enumerate() {
        quoted ^= byte == b'"';
        if !quoted && line.as_bytes()[at..].starts_with(b"//") {
            return at;
        }
    }
    line.len()
}

/// Where to break a line of code: outside strings, in as few brackets as possible, as far right as possible.
fn place(line: &str) -> Option<usize> {
    let start = line.len() - line.trim_start().len();
    let mut best: Option<(bool, usize, usize)> = None;
    let (mut depth, mut quoted) = (0_usize, false);
    for (at, byte) in line.bytes().enumerate().take(MOST_COLUMNS) {
        match byte {
            b'"' => quoted = !quoted,
            b'(' | b'[' | b'{' if !quoted => depth += 1,
            b')' | b']' | b'}' if !quoted => depth = depth.saturating_sub(1),
            b' ' if !quoted && at > start => {
                let breaks =
                    line[..at].ends_with(',') || OPERATORS.iter().any(|operator| line[at..].starts_with(operator));
                let early = at < LEAST_COLUMNS;
                if breaks && best.is_none_or(|(late, deep, _)| (early, depth) <= (late, deep)) {
                    best = Some((early, depth, at));
                }
            }
            _ => {}
        }
    }
    best.map(|(_, _, at)| at)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Everything but the white space.
    fn squeezed(text: &str) -> String {
        text.split_whitespace().collect()
    }

    #[test]
    fn short_lines_stay() {
        let text = "module m;\n\n    // words\n    assign a = b;  // more\nendmodule\n";
        assert_eq!(wrap(text), text);
    }

    #[test]
    fn code_is_broken_at_its_outermost_operators() {
        let terms = |name: &str, count: usize| {
            (0..count).map(|index| format!("({name} == 4'd{index} + 4'd1)")).collect::<Vec<_>>().join(" || ")
        };
        let line = format!("    assign chosen = valid && ({}) && ({});\n", terms("a", 2), terms("index", 3));
        let wrapped = wrap(&line);
        assert_eq!(squeezed(&wrapped), squeezed(&line));
        let lines: Vec<&str> = wrapped.lines().collect();
        assert!(lines.len() == 2 && lines[1].starts_with("        && ((index == "), "{wrapped}");
        let deep = wrap(&format!("    assign chosen = ({});\n", terms("index", 9)));
        let lines: Vec<&str> = deep.lines().collect();
        assert!(lines.iter().all(|line| line.len() <= MOST_COLUMNS), "{deep}");
        assert!(lines.len() == 3 && lines[1..].iter().all(|line| line.starts_with("        || (index")), "{deep}");
    }

    #[test]
    fn strings_and_parts_of_words_are_left_alone() {
        let text = format!("    (* INFO = \"{}\", PARAMETER = \"{}\" *)\n", "a, b || c ".repeat(8), "d, e ".repeat(10));
        let wrapped = wrap(&text);
        let expected = format!(
            "    (* INFO = \"{}\",\n        PARAMETER = \"{}\" *)\n",
            "a, b || c ".repeat(8),
            "d, e ".repeat(10)
        );
        assert_eq!(wrapped, expected);
        let parts = (0..9).map(|index| format!("word[27*{index} +: 27]")).collect::<Vec<_>>().join(", ");
        let wrapped = wrap(&format!("        case_item: value <= {{{parts}}};\n"));
        assert!(wrapped.lines().count() == 2 && wrapped.lines().all(|line| !line.trim().starts_with('+')), "{wrapped}");
    }

    #[test]
    fn comments_are_broken_between_words_and_stand_above_code() {
        let words = "word ".repeat(30);
        let wrapped = wrap(&format!("    // {}\n", words.trim_end()));
        assert!(wrapped.lines().all(|line| line.starts_with("    // word") && line.len() <= MOST_COLUMNS));
        assert_eq!(wrapped.matches("word").count(), 30);
        let wrapped = wrap(&format!("    input wire a, // {}\n", words.trim_end()));
        assert!(wrapped.lines().next_back() == Some("    input wire a,"), "{wrapped}");
        assert_eq!(wrap(&format!("{}\n", "x".repeat(130))), format!("{}\n", "x".repeat(130)), "no place to break");
    }
}
