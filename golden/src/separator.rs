//! What stands between the values of a line, in all files of numbers.

/// What stands between the values of a line.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Separator {
    /// This character.
    Byte(u8),
    /// Spaces, as many as there are.
    Spaces,
}

impl Separator {
    /// The separator of a line: the first of those that it has, a space being one only where there is no other.
    pub(crate) fn of(line: &[u8]) -> Self {
        let byte = b";\t,".iter().copied().find(|byte| line.contains(byte));
        byte.map_or(Self::Spaces, Self::Byte)
    }

    pub(crate) fn split(self, line: &[u8]) -> Vec<&[u8]> {
        match self {
            Self::Byte(separator) => line.split(|&byte| byte == separator).map(bare).collect(),
            Self::Spaces => line.split(u8::is_ascii_whitespace).filter(|field| !field.is_empty()).map(bare).collect(),
        }
    }

    /// The fields of a line, of which the last one may end with the separator, too.
    pub(crate) fn fields(self, line: &[u8]) -> Vec<&[u8]> {
        let mut fields = self.split(line);
        if fields.len() > 1 && fields.last().is_some_and(|field| field.is_empty()) {
            fields.pop();
        }
        fields
    }

    /// The number of any kind that a field holds.
    pub(crate) fn value(self, field: &[u8]) -> Option<f64> {
        let text = std::str::from_utf8(field).ok()?;
        match self {
            // Where it separates nothing, a comma is a decimal point.
            Self::Byte(b';' | b'\t') => text.replace(',', ".").parse().ok(),
            _ => text.parse().ok(),
        }
    }
}

/// A field without the quotes that some programs put around each.
fn bare(field: &[u8]) -> &[u8] {
    let field = field.trim_ascii();
    field.strip_prefix(b"\"").and_then(|field| field.strip_suffix(b"\"")).unwrap_or(field)
}
