//! Separators and numbers of a line of text, in all files of numbers.
//!
//! By hand and not by a CSV library: the separator is found from the line, spaces count as one, a comma may be a decimal
//! point, and lines come one at a time from a port.

/// What stands between the values of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Separator {
    /// This character.
    Byte(u8),
    /// Spaces, as many as there are.
    Spaces,
}

/// What the commas, or the points, within a number are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Comma {
    /// A decimal point for certain.
    Decimal,
    /// A decimal point or a separator of thousands: three digits follow each.
    Unclear,
}

impl Comma {
    /// The marks of a field, commas or points; nothing if it has none.
    fn of(field: &[u8], mark: u8) -> Option<Self> {
        let digits = field.strip_prefix(b"-").or(field.strip_prefix(b"+")).unwrap_or(field);
        let mut groups = digits.split(|&byte| byte == mark);
        let first = groups.next()?;
        let mut groups = groups.peekable();
        groups.peek()?;
        let is_first = (1..=3).contains(&first.len()) && first[0] != b'0' && first.iter().all(u8::is_ascii_digit);
        // A point behind the last group is that of the fraction.
        let is_group = |group: &[u8]| {
            let whole = group.split(|&byte| byte == b'.').next().unwrap_or(group);
            whole.len() == 3 && whole.iter().all(u8::is_ascii_digit)
        };
        Some(if is_first && groups.all(is_group) { Self::Unclear } else { Self::Decimal })
    }
}

/// Commas and points in the numbers of a file: decimal ones, or separators of thousands.
#[derive(Clone, Debug, Default)]
pub(crate) struct Marks {
    /// Whether a comma, and a point, is a decimal one for certain.
    decimal: [bool; 2],
    /// The first of which that is not clear.
    unclear: [Option<Unclear>; 2],
}

/// A number whose comma, or point, may be a decimal one or a separator of thousands.
#[derive(Clone, Debug)]
pub(crate) struct Unclear {
    /// Line and column, from 1.
    pub(crate) place: [usize; 2],
    pub(crate) text: String,
    /// "comma" or "point".
    pub(crate) mark: &'static str,
}

impl Marks {
    /// Takes a field. Points count between semicolons and tabs, where a comma may be the decimal point.
    ///
    /// # Errors
    ///
    /// A field that is a number only with separators of thousands.
    pub(crate) fn take(&mut self, field: &[u8], separator: Separator, place: [usize; 2]) -> Result<(), Unclear> {
        let points = Some(field)
            .filter(|_| matches!(separator, Separator::Byte(b';' | b'\t')))
            .and_then(|field| Comma::of(field, b'.'));
        for (of, (mark, found)) in [("comma", Comma::of(field, b',')), ("point", points)].into_iter().enumerate() {
            let unclear = || Unclear { place, text: String::from_utf8_lossy(field).chars().take(40).collect(), mark };
            match (found, number(field)) {
                (Some(Comma::Decimal), Some(_)) => self.decimal[of] = true,
                (Some(Comma::Unclear), Some(_)) => {
                    self.unclear[of].get_or_insert_with(unclear);
                }
                (Some(Comma::Unclear), None) => return Err(unclear()),
                _ => {}
            }
        }
        Ok(())
    }

    /// What may still be either.
    pub(crate) fn open(&self) -> Option<&Unclear> {
        self.unclear.iter().zip(self.decimal).find_map(|(unclear, decimal)| unclear.as_ref().filter(|_| !decimal))
    }
}

impl Separator {
    /// The separator of a line: the first of those that it has, a space being one only where there is no other.
    pub(crate) fn of(line: &[u8]) -> Self {
        let byte = b";\t,".iter().copied().find(|byte| line.contains(byte));
        match byte {
            // Numbers with decimal commas, between spaces.
            Some(b',') if Self::Spaces.split(line).len() > 1 && is_row_of_decimals(line) => Self::Spaces,
            byte => byte.map_or(Self::Spaces, Self::Byte),
        }
    }

    /// A line without the white space around it. A tab that separates is none: a blank cell may stand at either end.
    pub(crate) fn trim(self, line: &[u8]) -> &[u8] {
        let Self::Byte(b'\t') = self else { return line.trim_ascii() };
        let is_cell = |byte: &u8| *byte == b'\t' || !byte.is_ascii_whitespace();
        let end = line.iter().rposition(is_cell).map_or(0, |last| last + 1);
        &line[line.iter().position(is_cell).unwrap_or(end)..end]
    }

    pub(crate) fn split(self, line: &[u8]) -> Vec<&[u8]> {
        match self {
            Self::Byte(separator) => {
                let mut quoted = false;
                let between = |&byte: &u8| {
                    quoted ^= byte == b'"';
                    byte == separator && !quoted
                };
                line.split(between).map(bare).collect()
            }
            Self::Spaces => line.split(u8::is_ascii_whitespace).filter(|field| !field.is_empty()).map(bare).collect(),
        }
    }

    /// The fields of a line without the blank ones behind its last value.
    pub(crate) fn fields(self, line: &[u8]) -> Vec<&[u8]> {
        self.at_most(1, line)
    }

    /// The fields of a line without the blank ones behind its last value, as long as there are more than `columns`.
    pub(crate) fn at_most(self, columns: usize, line: &[u8]) -> Vec<&[u8]> {
        let mut fields = self.split(line);
        while fields.len() > columns && fields.last().is_some_and(|field| field.is_empty()) {
            fields.pop();
        }
        fields
    }
}

/// The number of any kind that a field holds. A comma in it separates nothing and is a decimal point.
pub(crate) fn number(field: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(field).ok()?;
    if text.contains(',') { text.replace(',', ".").parse().ok() } else { text.parse().ok() }
}

/// Whether every word of a line is a number, and some have a decimal comma.
fn is_row_of_decimals(line: &[u8]) -> bool {
    let is_number = |word: &[u8]| !word.ends_with(b",") && !word.starts_with(b",") && number(word).is_some();
    Separator::Spaces.split(line).into_iter().all(is_number)
}

/// Whether a field stands for a reading that is not there.
pub(crate) fn is_unknown(field: &str) -> bool {
    ["", "-", "--", "---", "nan", "na", "n/a", "none", "null", "b"].contains(&field.to_ascii_lowercase().as_str())
}

/// The lines of a text: a line's end is that of Unix, Windows or, where there is no other, a carriage return alone.
pub(crate) fn lines(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    let end = if text.contains(&b'\n') { b'\n' } else { b'\r' };
    text.split(move |&byte| byte == end)
}

/// A field without the quotes that some programs put around each.
pub(crate) fn bare(field: &[u8]) -> &[u8] {
    let field = field.trim_ascii();
    field.strip_prefix(b"\"").and_then(|field| field.strip_suffix(b"\"")).unwrap_or(field)
}

/// What separates the numbers of a line, where that is nothing that separates values here.
pub(crate) fn foreign(content: &[u8]) -> Option<&'static str> {
    const SEPARATORS: [(char, &str); 5] = [
        ('|', "\"|\""),
        (':', "\":\""),
        ('/', "\"/\""),
        ('\u{a0}', "a no-break space"),
        ('\u{202f}', "a narrow no-break space"),
    ];
    let text = std::str::from_utf8(content).ok()?;
    let separates = |&(separator, _): &(char, &str)| {
        let ends = |c: char| c == separator || c.is_whitespace();
        let mut fields = text.trim_matches(ends).split(separator);
        fields.clone().nth(1).is_some() && fields.all(|field| field.trim().parse::<f64>().is_ok())
    };
    SEPARATORS.iter().find(|&separator| separates(separator)).map(|&(_, name)| name)
}

/// Whether a field is that of a header: text, of any encoding, and no number of any kind.
pub(crate) fn no_number(field: &[u8]) -> bool {
    String::from_utf8_lossy(field).replace(',', ".").parse::<f64>().is_err()
}
